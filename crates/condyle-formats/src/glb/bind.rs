//! Where the joints of skins are at rest.
//!
//! A skin holds for each joint j the inverse of the transform B at which the joint is bound: where the mesh is as it was
//! modelled. Many files have their nodes at the first frame of a motion instead, so the pose in which the figure
//! is bound is taken as rest wherever it can be one: of node and parent, both bound or both not,
//! `rest = B_parent⁻¹ · B`.

use super::accessor::Accessors;
use super::figure::Still;
use super::json::Item;
use super::scene::LocalPose;
use super::tree::{Tree, affine};
use condyle_diagnostics::{Diagnostic, Error, Warnings};
use condyle_math::{Affine, Mat3, Quat, Vec3};
use std::collections::HashMap;

impl Still {
    /// Reads the skins: their joints, and where those are bound. The scale of a node is its own.
    ///
    /// # Errors
    /// `glb/json`, `glb/reference`, `glb/no-joints` for a skin without joints.
    pub(super) fn read(
        root: &Item<'_>,
        tree: &Tree,
        accessors: &mut Accessors<'_, '_, '_>,
        warnings: &mut Warnings,
    ) -> Result<Self, Error> {
        let world = tree.world();
        let count = tree.nodes.len();
        let mut rank = vec![0usize; count];
        tree.order.iter().enumerate().for_each(|(at, index)| rank[*index] = at);
        let meshes = tree.nodes.iter().enumerate().rev();
        let mesh_of: HashMap<usize, usize> =
            meshes.filter_map(|(index, node)| Some((node.skin?, index))).collect();
        let mut joint = vec![false; count];
        let mut bound: Vec<Option<Affine>> = vec![None; count];
        for (number, skin) in root.list("skins")?.iter().enumerate() {
            let joints = skin.list("joints")?;
            if joints.is_empty() {
                let message = format!("{} has no joints", skin.shown());
                return Err(Error::new("glb/no-joints", message)
                    .with_help("a skin names the nodes that move it"));
            }
            let mut nodes = Vec::with_capacity(joints.len());
            for item in &joints {
                let node = item.below(count, "node")?;
                joint[node] = true;
                nodes.push(node);
            }
            let matrices = matrices(skin, joints.len(), accessors, warnings)?;
            // Meshes stand in the scene, or where their node is, or where the figure hangs.
            let first = (0..nodes.len()).min_by_key(|at| rank[nodes[*at]]);
            let mesh = mesh_of.get(&number).copied();
            let far = |base: Affine| {
                let place = first.and_then(|at| Some(base * (*matrices.get(at)?)?));
                let at = first.and_then(|at| world.get(*nodes.get(at)?));
                place.zip(at).map_or(f64::INFINITY, |(a, b)| distance(a, *b))
            };
            // Which of them is told by the topmost joint: where it is bound there is nearest to where it stands.
            let above = first.and_then(|at| tree.nodes.get(*nodes.get(at)?)?.parent);
            let places = [mesh, above].into_iter().flatten().filter_map(|at| world.get(at));
            let mut base = Affine::IDENTITY;
            for place in places {
                if far(*place) < far(base) {
                    base = *place;
                }
            }
            for (node, matrix) in nodes.into_iter().zip(matrices) {
                bound[node] = bound[node].or(matrix.map(|matrix| base * matrix));
            }
        }
        let rest = rest(tree, &bound, warnings);
        check_roots(tree, &joint, warnings);
        Ok(Self { joint, rest })
    }
}

/// Where each joint of a skin is bound, in the space of the mesh; `None` where that cannot be said.
fn matrices(
    skin: &Item<'_>,
    joints: usize,
    accessors: &mut Accessors<'_, '_, '_>,
    warnings: &mut Warnings,
) -> Result<Vec<Option<Affine>>, Error> {
    let Some(index) = skin.get("inverseBindMatrices") else {
        // All of them are the identity, by the specification: they are where their parents are, and so tell nothing.
        return Ok(vec![None; joints]);
    };
    let mut ignored = |why: String| {
        let message = format!("where the joints of {} are bound is not known: {why}", skin.shown());
        let help = "they rest where their nodes are";
        warnings.push(Diagnostic::warning("glb/bind", message).with_help(help));
        vec![None; joints]
    };
    let numbers = match accessors.numbers(index.index()?) {
        Ok(numbers) => numbers,
        Err(error) => return Ok(ignored(error.to_string())),
    };
    if numbers.width != 16 || numbers.count() < joints {
        let why = format!("there are {} matrices for {joints} joints", numbers.count());
        return Ok(ignored(why));
    }
    let matrix = |m: &[f64]| {
        let column = |c: usize| Vec3::new(m[4 * c], m[4 * c + 1], m[4 * c + 2]);
        let linear = Mat3::from_columns(column(0), column(1), column(2));
        let back = linear.inverse();
        let affine = Affine::new(back, -(back * column(3)));
        let last = [m[3], m[7], m[11], m[15] - 1.0];
        let finite = [back.x, back.y, back.z, affine.translation].iter().all(|v| v.is_finite());
        (finite && last.iter().all(|x| x.abs() < 1e-3)).then_some(affine)
    };
    let all: Vec<Option<Affine>> =
        numbers.values.chunks_exact(16).take(joints).map(matrix).collect();
    let wrong = all.iter().filter(|matrix| matrix.is_none()).count();
    if wrong > 0 {
        let why = format!("{wrong} of {joints} matrices have no inverse");
        ignored(why);
    }
    Ok(all)
}

/// Angles in radians and shares of a length beyond which a pose is another.
const SAME: f64 = 0.01;

fn rest(tree: &Tree, bound: &[Option<Affine>], warnings: &mut Warnings) -> Vec<LocalPose> {
    let mut world = vec![Affine::IDENTITY; tree.nodes.len()];
    let mut rest: Vec<LocalPose> = tree.nodes.iter().map(|node| node.local).collect();
    let (mut other, mut most) = (0usize, 0.0f64);
    for &index in &tree.order {
        let node = &tree.nodes[index];
        let parent = node.parent.map_or(Affine::IDENTITY, |parent| world[parent]);
        if let Some(place) = bound[index].and_then(|bound| placed(parent, bound, &node.local)) {
            let turn = Quat::from(place.rotation).angle_to(Quat::from(node.local.rotation));
            if turn > SAME {
                other += 1;
                most = most.max(turn);
            }
            rest[index] = place;
        }
        world[index] = parent * affine(&rest[index]);
    }
    if other > 0 {
        let message = format!(
            "{other} joints are bound in another pose than their nodes stand in, by up to {:.0}°",
            most.to_degrees()
        );
        warnings.push(
            Diagnostic::warning("glb/rest", message)
                .with_help("rest is the pose in which the figure is bound"),
        );
    }
    rest
}

/// A bound joint in its parent, with the scale of its node; `None` where the scales differ.
fn placed(parent: Affine, bound: Affine, node: &LocalPose) -> Option<LocalPose> {
    let back = parent.linear.inverse();
    let step = back * (bound.translation - parent.translation);
    let (place, shear) = LocalPose::nearest(Affine::new(back * bound.linear, step));
    let finite = place.translation.iter().chain(&place.rotation).all(|x| x.is_finite());
    let alike = |a: f64, b: f64| (a - b).abs() < 0.02 * b.abs();
    let sizes = place.scale.iter().zip(node.scale).all(|(a, b)| alike(*a, b));
    (finite && sizes && shear < SAME).then_some(LocalPose { scale: node.scale, ..place })
}

fn distance(a: Affine, b: Affine) -> f64 {
    let d = [a.linear.x - b.linear.x, a.linear.y - b.linear.y, a.linear.z - b.linear.z];
    d.iter().map(|v| v.norm()).sum::<f64>() + (a.translation - b.translation).norm()
}

/// Tells of joints that hang on several roots.
fn check_roots(tree: &Tree, joint: &[bool], warnings: &mut Warnings) {
    let mut root_of: Vec<usize> = (0..tree.nodes.len()).collect();
    for &index in &tree.order {
        if let Some(parent) = tree.nodes[index].parent {
            root_of[index] = root_of[parent];
        }
    }
    let mut roots: Vec<usize> =
        (0..joint.len()).filter(|index| joint[*index]).map(|index| root_of[index]).collect();
    roots.sort_unstable();
    roots.dedup();
    if roots.len() > 1 {
        let message = format!("the joints hang on {} nodes that have no common root", roots.len());
        warnings.push(
            Diagnostic::warning("glb/roots", message).with_help("each is a root of the skeleton"),
        );
    }
}
