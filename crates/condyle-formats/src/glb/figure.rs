//! The bones of a file, made from its nodes, and frames of their motion from keys and back.
//!
//! With the rest R0, T0 of a node, its transform T, R, S at a time, the product f of the scales above it that never change,
//! and the metres u in a unit of length, the numbers of a bone are
//!
//! ```text
//! places = R0⁻¹·(T - T0)·f·u      orientation = R0⁻¹·R      sizes = S
//! ```

use super::clip::{Clip, Path};
use super::reanimate::{NodeMotion, NodeTrack};
use super::scene::LocalPose;
use super::tree::Tree;
use crate::skeleton::{Assumed, Bone, Freedom, FreedomKind, Skeleton, UnitGuess, facing_of};
use condyle_diagnostics::{Diagnostic, Error, Warnings};
use condyle_math::{Affine, Quat, Vec3};
use condyle_model::UpAxis;
use condyle_model::model::Facing;
use condyle_motion::Motion;

/// What nodes are while nothing moves them.
pub(crate) struct Still {
    /// Whether each node is a joint.
    pub(crate) joint: Vec<bool>,
    /// Where each node is in its parent at rest.
    pub(crate) rest: Vec<LocalPose>,
}

/// How one node moves.
#[derive(Clone, Copy, Debug, Default)]
struct Moved {
    places: bool,
    turns: bool,
    sizes: bool,
}

/// The bones and what they are made from.
pub(crate) struct Figure {
    pub(crate) skeleton: Skeleton,
    /// The node of each bone.
    nodes: Vec<usize>,
    moved: Vec<Moved>,
    /// What lengths in the parent of each bone are multiplied by, until its figure is in metres and after.
    factors: Vec<f64>,
    /// Where each bone is while the animation does not move it.
    still: Vec<LocalPose>,
}

impl Figure {
    pub(crate) fn new(tree: &Tree, bound: &Still, clip: &Clip, warnings: &mut Warnings) -> Self {
        let count = tree.nodes.len();
        // Values that channels hold throughout.
        let mut still: Vec<LocalPose> = tree.nodes.iter().map(|node| node.local).collect();
        clip.pose(f64::NEG_INFINITY, &mut still);
        let mut moved = vec![Moved::default(); count];
        let mut animated = vec![false; count];
        for channel in &clip.channels {
            let moves = !channel.is_still();
            animated[channel.node] = true;
            let of = &mut moved[channel.node];
            match channel.path {
                Path::Translation => of.places |= moves,
                Path::Rotation => of.turns |= moves,
                Path::Scale => of.sizes |= moves,
            }
        }
        let chosen = chosen_nodes(tree, &bound.joint, &animated, warnings);
        let (mut bone_of, mut factor_below) = (vec![None; count], vec![1.0; count]);
        let mut figure = Self {
            skeleton: Skeleton::default(),
            nodes: vec![],
            moved: vec![],
            factors: vec![],
            still: vec![],
        };
        let mut scaled: Option<(usize, f64)> = None;
        for &index in tree.order.iter().filter(|index| chosen[**index]) {
            let node = &tree.nodes[index];
            let (rest, now) = (bound.rest[index], still[index]);
            let factor = node.parent.map_or(1.0, |parent| factor_below[parent]);
            let mut of = moved[index];
            of.places |= far(now.translation, rest.translation);
            let turn = Quat::from(now.rotation).angle_to(Quat::from(rest.rotation));
            of.turns |= bound.joint[index] || turn > 1e-6;
            // What the figure hangs on is where it goes, whether the animation moves it or not.
            of.places |=
                bound.joint[index] && !node.parent.is_some_and(|parent| bound.joint[parent]);
            let [x, y, z] = now.scale;
            let uniform = x > 0.0 && (x - y).abs().max((x - z).abs()) <= 1e-5 * x;
            if !of.sizes && uniform {
                let own = (x + y + z) / 3.0;
                let own = if (own - 1.0).abs() < 1e-5 { 1.0 } else { own };
                factor_below[index] = factor * own;
                if own != 1.0 {
                    scaled = scaled.or(Some((index, own)));
                }
            } else {
                of.sizes = true;
                factor_below[index] = factor;
            }
            let linear = Quat::from(rest.rotation).to_mat3();
            let joint = Affine::new(linear, Vec3::from(rest.translation) * factor);
            let parent = node.parent.and_then(|parent| bone_of[parent]);
            let mut bone =
                Bone { joint_in_parent: joint, ..Bone::at(&node.name, parent, Vec3::ZERO) };
            bone.freedoms = freedoms(of, now.scale);
            bone_of[index] = Some(figure.nodes.len());
            figure.skeleton.bones.push(bone);
            figure.nodes.push(index);
            figure.moved.push(of);
            figure.factors.push(factor);
            figure.still.push(now);
        }
        add_ends(&mut figure.skeleton, tree, &bone_of, &factor_below);
        if let Some((index, own)) = scaled {
            let message = format!("node `{}` has a scale of {own:.6}", tree.nodes[index].name);
            warnings.push(
                Diagnostic::warning("skeleton/scale", message)
                    .with_help("the lengths below it are multiplied by it, the bones are rigid"),
            );
        }
        figure
    }

    /// The bone of each node; by what lengths in each bone's own node are multiplied in it; the metres in a unit of the scene.
    pub(super) fn scales(&self, nodes: usize) -> (Vec<Option<usize>>, Vec<f64>, f64) {
        let mut bones = vec![None; nodes];
        let mut scales = Vec::with_capacity(self.nodes.len());
        let mut unit = 1.0;
        for (bone, &node) in self.nodes.iter().enumerate() {
            if let Some(at) = bones.get_mut(node) {
                *at = Some(bone);
            }
            if self.skeleton.bones[bone].parent.is_none() {
                unit = self.factors[bone];
            }
            let [x, y, z] = self.still[bone].scale;
            let own = if self.moved[bone].sizes { 1.0 } else { (x + y + z) / 3.0 };
            scales.push(self.factors[bone] * own);
        }
        (bones, scales, unit)
    }

    /// Lengths become metres.
    pub(crate) fn settle_unit(&mut self, assumed: &Assumed, warnings: &mut Warnings) {
        let rest = self.skeleton.rest();
        let points = rest.iter().flat_map(|(_, joint, ends)| ends.iter().copied().chain([*joint]));
        let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
        for (axis, x) in points.flat_map(|point| point.to_array().into_iter().enumerate()) {
            low[axis] = low[axis].min(x);
            high[axis] = high[axis].max(x);
        }
        let size = (0..3).map(|axis| high[axis] - low[axis]).fold(0.0, f64::max);
        let guess = UnitGuess::of(size);
        let people = self.nodes.len() >= 10 && guess.fits && ["cm", "mm"].contains(&guess.name);
        let unit = match assumed.metres_per_unit {
            Some(unit) => unit,
            None if people => {
                let message = format!(
                    "the figure would be {size:.0} m large, which is the size of a person in {}",
                    guess.name
                );
                let help = "read so, though glTF is in metres; --length-unit m keeps its size";
                warnings.push(Diagnostic::warning("skeleton/unit", message).with_help(help));
                guess.metres
            }
            None => 1.0,
        };
        let joints: Vec<(&str, Vec3)> = rest.iter().map(|(name, at, _)| (*name, *at)).collect();
        let facing = facing_of(&joints, UpAxis::Y).unwrap_or(Facing::PlusZ);
        self.skeleton.facing = facing;
        for bone in &mut self.skeleton.bones {
            bone.joint_in_parent.translation = bone.joint_in_parent.translation * unit;
            bone.ends.iter_mut().for_each(|end| end.1 = end.1 * unit);
        }
        self.factors.iter_mut().for_each(|factor| *factor *= unit);
    }

    /// The frames: for each bone where it is beside its rest.
    pub(crate) fn motion(
        &self,
        tree: &Tree,
        bound: &Still,
        clip: &Clip,
        size: usize,
        warnings: &mut Warnings,
    ) -> Motion {
        let freedoms = self.skeleton.bones.iter().flat_map(|bone| &bone.freedoms);
        let stored: usize = freedoms.map(Freedom::stored).sum();
        // Three times the size of the file and 24 MB.
        let most = (3 * size + (24 << 20)) / (8 * stored + 48);
        let (mut times, mut asked) = clip.times(most.max(2), warnings);
        let nodes: Vec<LocalPose> = tree.nodes.iter().map(|node| node.local).collect();
        if times.is_empty()
            && self.moved.iter().zip(&self.nodes).any(|(of, node)| {
                let (now, rest) = (nodes[*node], bound.rest[*node]);
                let turn = Quat::from(now.rotation).angle_to(Quat::from(rest.rotation));
                of.places || turn > 1e-6
            })
        {
            // A still figure that does not stand at its rest.
            times.push(0.0);
            asked.push(0.0);
        }
        let mut frames: Vec<Vec<f64>> = Vec::with_capacity(times.len());
        let mut last = vec![Quat::IDENTITY; self.nodes.len()];
        let mut locals = nodes;
        for &time in &asked {
            clip.pose(time, &mut locals);
            let mut frame = Vec::with_capacity(stored);
            for (bone, &node) in self.nodes.iter().enumerate() {
                let (now, rest, of) = (&locals[node], &bound.rest[node], self.moved[bone]);
                let back = Quat::from(rest.rotation).conjugate();
                if of.places {
                    let step = Vec3::from(now.translation) - Vec3::from(rest.translation);
                    let step = back.to_mat3() * step * self.factors[bone];
                    frame.extend(step.to_array());
                }
                if of.turns {
                    let turn = (back * Quat::from(now.rotation)).normalized();
                    // Signs never jump.
                    let turn = if turn.dot(last[bone]) < 0.0 { -turn } else { turn };
                    last[bone] = turn;
                    frame.extend(turn.to_array());
                }
                if of.sizes {
                    frame.extend(now.scale);
                }
            }
            frames.push(frame);
        }
        Motion { times, frames }
    }

    /// The frames of a motion as transforms of the nodes that move, or do not stand where their nodes do.
    ///
    /// # Errors
    /// `glb/track` if a frame has not the numbers of the skeleton, `glb/pose` if one is not finite.
    pub(super) fn tracks(
        &self,
        tree: &Tree,
        bound: &Still,
        motion: &Motion,
    ) -> Result<NodeMotion, Error> {
        let freedoms = self.skeleton.bones.iter().flat_map(|bone| &bone.freedoms);
        let stored: usize = freedoms.map(Freedom::stored).sum();
        if let Some(bad) = motion.frames.iter().position(|frame| frame.len() != stored) {
            let message = format!("frame {bad} has {} numbers", motion.frames[bad].len());
            return Err(Error::new("glb/track", message)
                .with_help(format!("the skeleton of the file has {stored}")));
        }
        let mut tracks = Vec::with_capacity(self.nodes.len());
        let mut start = 0;
        for (bone, &node) in self.nodes.iter().enumerate() {
            let (rest, of) = (&bound.rest[node], self.moved[bone]);
            let (still, local) = (self.still[bone], tree.nodes[node].local);
            let turn = Quat::from(rest.rotation);
            let ahead = turn.to_mat3();
            let back = 1.0 / self.factors[bone];
            let mut track =
                NodeTrack { name: tree.nodes[node].name.clone(), ..NodeTrack::default() };
            let numbers =
                |at: usize, frame: &Vec<f64>| frame.get(at..).unwrap_or_default().to_vec();
            let three = |at| {
                let part = move |frame: &Vec<f64>| match numbers(at, frame)[..] {
                    [x, y, z, ..] => [x, y, z],
                    _ => [0.0; 3],
                };
                motion.frames.iter().map(part)
            };
            if of.places {
                let place = |step: [f64; 3]| {
                    (Vec3::from(rest.translation) + ahead * Vec3::from(step) * back).to_array()
                };
                track.translations = three(start).map(place).collect();
                start += 3;
            } else if far(still.translation, local.translation) {
                track.translations = vec![still.translation; motion.frames.len()];
            }
            let other = Quat::from(still.rotation).angle_to(Quat::from(local.rotation)) > 1e-6;
            if of.turns {
                let at = start;
                let turned = |frame: &Vec<f64>| match numbers(at, frame)[..] {
                    [x, y, z, w, ..] => (turn * Quat::from([x, y, z, w]).normalized()).to_array(),
                    _ => rest.rotation,
                };
                track.rotations = motion.frames.iter().map(turned).collect();
                start += 4;
            } else if other {
                track.rotations = vec![still.rotation; motion.frames.len()];
            }
            if of.sizes {
                track.scales = three(start).collect();
                start += 3;
            } else if far(still.scale, local.scale) {
                track.scales = vec![still.scale; motion.frames.len()];
            }
            if !(track.translations.is_empty()
                && track.rotations.is_empty()
                && track.scales.is_empty())
            {
                tracks.push(track);
            }
        }
        Ok(NodeMotion { times: motion.times.clone(), tracks, ..NodeMotion::default() })
    }
}

/// Whether places differ by more than single precision can tell.
fn far(a: [f64; 3], b: [f64; 3]) -> bool {
    let size = b.iter().fold(0.0, |most: f64, x| most.max(x.abs()));
    a.iter().zip(b).any(|(a, b)| (a - b).abs() > 5e-6 * size + 1e-7)
}

fn freedoms(of: Moved, scale: [f64; 3]) -> Vec<Freedom> {
    let mut freedoms = vec![];
    if of.places {
        freedoms.extend(Vec3::UNITS.map(|axis| Freedom::new(FreedomKind::Move(axis))));
    }
    if of.turns {
        freedoms.push(Freedom::new(FreedomKind::Ball));
    }
    if of.sizes {
        freedoms.extend(Vec3::UNITS.iter().zip(scale).map(|(axis, size)| Freedom {
            default: [size, 0.0, 0.0, 0.0],
            ..Freedom::new(FreedomKind::Size(*axis))
        }));
    }
    freedoms
}

/// The joints, what they hang on, and what moves below them; without joints, what moves.
fn chosen_nodes(
    tree: &Tree,
    joint: &[bool],
    animated: &[bool],
    warnings: &mut Warnings,
) -> Vec<bool> {
    let skinned = joint.contains(&true);
    let mut below = joint.to_vec();
    for &index in &tree.order {
        below[index] |= tree.nodes[index].parent.is_some_and(|parent| below[parent]);
    }
    let count = tree.nodes.len();
    let mut chosen: Vec<bool> =
        (0..count).map(|i| joint[i] || animated[i] && (below[i] || !skinned)).collect();
    for &index in tree.order.iter().rev() {
        if let (true, Some(parent)) = (chosen[index], tree.nodes[index].parent) {
            chosen[parent] = true;
        }
    }
    let left: Vec<String> = (0..count)
        .filter(|index| animated[*index] && !chosen[*index])
        .map(|index| tree.nodes[index].name.clone())
        .collect();
    if !left.is_empty() {
        let message = format!(
            "what moves beside the skeleton is not read: {}",
            condyle_diagnostics::listed(&left)
        );
        warnings.push(Diagnostic::warning("skeleton/left-out", message));
    }
    chosen
}

/// Nodes that only say where a bone ends: without children, and showing nothing.
fn add_ends(skeleton: &mut Skeleton, tree: &Tree, bone_of: &[Option<usize>], factors: &[f64]) {
    let mut leaf = vec![true; tree.nodes.len()];
    tree.nodes.iter().filter_map(|node| node.parent).for_each(|parent| leaf[parent] = false);
    for (index, node) in tree.nodes.iter().enumerate() {
        let Some(parent) = node.parent.filter(|_| leaf[index] && !node.shows) else { continue };
        let bone = bone_of[parent].filter(|_| bone_of[index].is_none());
        if let Some(bone) = bone.and_then(|bone| skeleton.bones.get_mut(bone)) {
            let point = Vec3::from(node.local.translation) * factors[parent];
            bone.ends.push((node.name.clone(), point));
        }
    }
}
