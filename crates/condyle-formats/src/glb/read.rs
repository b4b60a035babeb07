//! The skeleton of a file, and what it does.

use super::accessor::{Accessors, Beside};
use super::bind::Bound;
use super::clip::{Clip, Path};
use super::container::Container;
use super::json::{self, Item};
use super::scene::LocalPose;
use super::tree::Tree;
use crate::skeleton::{Assumed, Bone, Freedom, FreedomKind, Skeleton, UnitGuess, facing_of};
use condyle_diagnostics::{Diagnostic, Error, Read, Warnings, did_you_mean};
use condyle_math::{Affine, Quat, Vec3};
use condyle_model::UpAxis;
use condyle_model::model::Facing;
use condyle_motion::{Animation, Motion};

/// What of a file is read.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct Options {
    /// The animation, by its name or its number, counted from 1; the first of the file where it is not told.
    pub animation: Option<String>,
    /// What the user knows: glTF is in metres and y up, but not every program keeps to that.
    pub assumed: Assumed,
}

/// Reads the skeleton of a GLB, or of glTF whose buffers are inside of it, and its first animation.
///
/// # Errors
/// As [`read`]; `glb/buffer` for a buffer in a file of its own.
pub fn from_bytes(bytes: &[u8]) -> Result<Read<Animation>, Error> {
    read(bytes, &Options::default(), &mut |_| Err("the file is read alone".to_owned()))
}

/// Reads the skeleton of a GLB or of glTF in JSON, and one of its animations.
///
/// Bones are the joints of all skins, what they hang on, and what moves below them; without a skin, what is animated.
/// The [contract](crate::skeleton) says what they become. A joint has an orientation, places and sizes where
/// the animation changes them, all from the rest of the skin. A scale that never changes and is the same along all axes is
/// multiplied into the lengths below it, so that bones are rigid and in metres.
///
/// Frames are at the times of the keys; a curve or a step between keys that are far apart is sampled 60 times a second
/// and more. The key of a frame has the value that the specification gives it at that time.
///
/// `beside` gives the bytes of another file by its path as seen from this one.
///
/// # Warnings
/// `glb/animations` where the file holds several and none was asked for, `glb/rest` where rest is not where
/// nodes stand, `glb/scale` for lengths that are multiplied, `skeleton/unit` for a figure in centimetres,
/// `glb/left-out` for what moves and is no part of the skeleton; repairs: `glb/length`, `glb/chunk`, `glb/parents`, `glb/roots`,
/// `glb/rotation`, `glb/shear`, `glb/bind`, `glb/channel`, `glb/time`, `glb/uneven`, `glb/frames`, `skeleton/name`.
///
/// # Errors
/// `glb/json`, `glb/version`, `glb/chunk`, `glb/reference`, `glb/cycle`, `glb/buffer`, `glb/accessor`, `glb/size`,
/// `glb/keys`, `glb/time`, `glb/interpolation`, `glb/no-joints`, `glb/no-skeleton` without skin and animation,
/// `glb/animation` if there is none of the wanted name.
///
/// ```
/// use condyle_formats::glb::{self, Options};
/// // A root that turns by a right angle about z within a second, and its child 2 m above it.
/// let keys: [f32; 10] = [0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.5f32.sqrt(), 0.5f32.sqrt()];
/// let bytes: Vec<u8> = keys.iter().flat_map(|x| x.to_le_bytes()).collect();
/// let text = r#"{"asset": {"version": "2.0"},
///   "nodes": [{"name": "root", "children": [1]}, {"name": "tip", "translation": [0, 2, 0]}],
///   "skins": [{"joints": [0, 1]}],
///   "buffers": [{"uri": "keys.bin", "byteLength": 40}],
///   "bufferViews": [{"buffer": 0, "byteLength": 8}, {"buffer": 0, "byteOffset": 8, "byteLength": 32}],
///   "accessors": [{"bufferView": 0, "componentType": 5126, "count": 2, "type": "SCALAR"},
///                 {"bufferView": 1, "componentType": 5126, "count": 2, "type": "VEC4"}],
///   "animations": [{"samplers": [{"input": 0, "output": 1}],
///                   "channels": [{"sampler": 0, "target": {"node": 0, "path": "rotation"}}]}]}"#;
/// let read = glb::read(text.as_bytes(), &Options::default(), &mut |_| Ok(bytes.clone()))?;
/// let animation = read.value;
/// assert_eq!(animation.motion.times, [0.0, 1.0]);
/// assert_eq!(animation.model.stored_len(), 8);
/// assert!((animation.motion.frames[1][2] - 0.5f64.sqrt()).abs() < 1e-7);
/// # Ok::<(), condyle_formats::Error>(())
/// ```
pub fn read(
    bytes: &[u8],
    options: &Options,
    beside: &mut Beside<'_>,
) -> Result<Read<Animation>, Error> {
    let mut warnings = Warnings::default();
    let container = Container::find(bytes, &mut warnings)?;
    let value = json::parse(bytes.get(container.json.clone()).unwrap_or_default())?;
    let root = Item::root(&value);
    check_version(&root)?;
    let binary = container.binary.and_then(|range| bytes.get(range));
    let mut accessors = Accessors::new(&value, binary, beside, bytes.len());
    let tree = Tree::read(&root, &mut warnings)?;
    let bound = Bound::read(&root, &tree, &mut accessors, &mut warnings)?;
    let chosen = chosen(&root, options, &mut warnings)?;
    if chosen.is_none() && !bound.joint.contains(&true) {
        let message = "the file has neither a skin nor an animation";
        return Err(Error::new("glb/no-skeleton", message)
            .with_help("a figure that moves is read, not a still scene"));
    }
    let clip = match &chosen {
        Some(item) => Clip::read(item, tree.nodes.len(), &mut accessors, &mut warnings)?,
        None => Clip::default(),
    };
    let named = chosen.as_ref().and_then(|item| item.text("name")).filter(|name| !name.is_empty());
    let mut figure = Figure::new(&tree, &bound, &clip, &mut warnings);
    figure.skeleton.name = name(&root, &tree, &bound).or(named).unwrap_or("figure").to_owned();
    let unit = figure.settle_unit(&options.assumed, &mut warnings);
    let motion = figure.motion(&tree, &bound, &clip, unit, bytes.len(), &mut warnings);
    let Read { value: model, warnings: told } = figure.skeleton.build()?;
    warnings.extend(told);
    Ok(Read { value: Animation { model, motion }, warnings: warnings.finish() })
}

fn check_version(root: &Item<'_>) -> Result<(), Error> {
    let asset = root.get("asset");
    let version = asset.as_ref().and_then(|asset| asset.text("version")).unwrap_or("");
    match version.split('.').next() {
        Some("2") => Ok(()),
        _ if asset.is_none() => Err(Error::new("glb/json", "there is no `asset`: this is no glTF")),
        _ => Err(Error::new("glb/version", format!("the file is of version `{version}` of glTF"))
            .with_help("version 2 is read: export it again")),
    }
}

/// The animation that is wanted; `None` in a file without any.
fn chosen<'j>(
    root: &Item<'j>,
    options: &Options,
    warnings: &mut Warnings,
) -> Result<Option<Item<'j>>, Error> {
    let mut all = root.list("animations")?;
    let name = |(index, item): (usize, &Item<'_>)| {
        item.text("name").map_or_else(|| (index + 1).to_string(), str::to_owned)
    };
    let names: Vec<String> = all.iter().enumerate().map(name).collect();
    let listed = || condyle_diagnostics::listed(&names);
    let Some(wanted) = &options.animation else {
        if all.len() > 1 {
            let message = format!("the file holds {} animations: {}", all.len(), listed());
            warnings.push(
                Diagnostic::warning("glb/animations", message)
                    .with_help("the first is read; another is chosen by --animation"),
            );
        }
        return Ok((!all.is_empty()).then(|| all.swap_remove(0)));
    };
    let number = wanted.parse::<usize>().ok().and_then(|number| number.checked_sub(1));
    let named = names.iter().position(|name| name == wanted);
    match named.or(number.filter(|number| *number < all.len())) {
        Some(index) => Ok(Some(all.swap_remove(index))),
        None => {
            let help =
                did_you_mean(wanted, names.iter().map(String::as_str), || match names.is_empty() {
                    true => "the file has none".to_owned(),
                    false => format!("the file holds {}", listed()),
                });
            let message = format!("there is no animation `{wanted}`");
            Err(Error::new("glb/animation", message).with_help(help))
        }
    }
}

/// What the figure is called: its skin, or the node above its first joint.
fn name<'j>(root: &Item<'j>, tree: &'j Tree, bound: &Bound) -> Option<&'j str> {
    let skin = root.element("skins", 0).ok().and_then(|skin| skin.text("name"));
    let above = || {
        let first = tree.order.iter().find(|index| bound.joint[**index])?;
        let parent = tree.nodes[*first].parent?;
        Some(tree.nodes[parent].name.as_str()).filter(|name| !name.starts_with("node_"))
    };
    skin.filter(|name| !name.trim().is_empty()).or_else(above)
}

/// How one node moves.
#[derive(Clone, Copy, Debug, Default)]
struct Moved {
    places: bool,
    turns: bool,
    sizes: bool,
}

/// The bones and what they are made from.
struct Figure {
    skeleton: Skeleton,
    /// The node of each bone.
    nodes: Vec<usize>,
    moved: Vec<Moved>,
    /// What lengths in the parent of each bone are multiplied by.
    factors: Vec<f64>,
}

impl Figure {
    fn new(tree: &Tree, bound: &Bound, clip: &Clip, warnings: &mut Warnings) -> Self {
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
        let mut figure =
            Self { skeleton: Skeleton::default(), nodes: vec![], moved: vec![], factors: vec![] };
        let mut scaled: Option<(usize, f64)> = None;
        for &index in tree.order.iter().filter(|index| chosen[**index]) {
            let node = &tree.nodes[index];
            let (rest, now) = (bound.rest[index], still[index]);
            let factor = node.parent.map_or(1.0, |parent| factor_below[parent]);
            let mut of = moved[index];
            of.places |= far(now.translation, rest.translation);
            let turn = Quat::from(now.rotation).angle_to(Quat::from(rest.rotation));
            of.turns |= bound.joint[index] || turn > 1e-6;
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
        }
        add_ends(&mut figure.skeleton, tree, &bone_of, &factor_below);
        if let Some((index, own)) = scaled {
            let message = format!("node `{}` has a scale of {own:.6}", tree.nodes[index].name);
            warnings.push(
                Diagnostic::warning("glb/scale", message)
                    .with_help("the lengths below it are multiplied by it, the bones are rigid"),
            );
        }
        figure
    }

    /// Lengths become metres; by what they are multiplied.
    fn settle_unit(&mut self, assumed: &Assumed, warnings: &mut Warnings) -> f64 {
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
        unit
    }

    /// The frames: for each bone where it is beside its rest.
    fn motion(
        &self,
        tree: &Tree,
        bound: &Bound,
        clip: &Clip,
        unit: f64,
        size: usize,
        warnings: &mut Warnings,
    ) -> Motion {
        let freedoms = self.skeleton.bones.iter().flat_map(|bone| &bone.freedoms);
        let stored: usize = freedoms.map(Freedom::stored).sum();
        // Three times the size of the file and 24 MB.
        let most = (3 * size + (24 << 20)) / (8 * stored + 48);
        let mut times = clip.times(most.max(2), warnings);
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
        }
        let mut frames: Vec<Vec<f64>> = Vec::with_capacity(times.len());
        let mut last = vec![Quat::IDENTITY; self.nodes.len()];
        let mut locals = nodes;
        for &time in &times {
            clip.pose(time, &mut locals);
            let mut frame = Vec::with_capacity(stored);
            for (bone, &node) in self.nodes.iter().enumerate() {
                let (now, rest, of) = (&locals[node], &bound.rest[node], self.moved[bone]);
                let back = Quat::from(rest.rotation).conjugate();
                if of.places {
                    let step = Vec3::from(now.translation) - Vec3::from(rest.translation);
                    let step = back.to_mat3() * step * (self.factors[bone] * unit);
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
        warnings.push(Diagnostic::warning("glb/left-out", message));
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
