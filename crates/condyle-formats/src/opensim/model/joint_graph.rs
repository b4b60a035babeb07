//! Which joint moves which body: the file's joints as a tree with the ground as its root.
//!
//! A joint may be defined from either end, and a body may be the child of two joints. The tree
//! contains each body once, by the fewest joints from the ground and, among those, by the joint
//! that comes first in the file; a joint whose child is already in the tree but whose parent is not
//! is reversed, and a joint between two bodies that are both in the tree closes a loop: it moves a
//! massless copy of its child, which a closure connects to the child itself. Bodies that no joint
//! connects to the ground get a free joint to it. OpenSim makes the same choices, so both programs
//! have the same coordinates.

use super::{Base, Reader};
use crate::opensim::model::triple;
use crate::xml::Element;
use condyle_diagnostics::Error;
use condyle_math::{Affine, EulerOrder, Vec3};
use condyle_model::SegmentId;
use condyle_model::model::{Closure, Condition};
use std::collections::{BTreeSet, HashMap, HashSet};

/// A joint with its place in the tree.
pub(super) struct PlacedJoint<'d> {
    pub element: Element<'d>,
    /// Its type, such as `PinJoint`.
    pub kind: &'d str,
    pub name: String,
    /// The segment that it moves.
    pub moved: SegmentId,
    /// Whether the file states it from the moved segment towards the ground.
    pub backwards: bool,
}

struct Stated<'d> {
    element: Element<'d>,
    kind: &'d str,
    name: String,
    parent: (Base, Affine),
    child: (Base, Affine),
}

/// Finds all joints, attaches every segment to its parent, and sets the joint frames.
pub(super) fn collect<'d>(reader: &mut Reader<'d, '_>) -> Result<Vec<PlacedJoint<'d>>, Error> {
    let mut stated = stated_joints(reader)?;
    let bodies: Vec<(Element<'d>, Base)> = reader.frames.bodies().collect();
    let ground = bodies.len();
    let number = |base: Base| base.map_or(ground, SegmentId::index);
    let mut touching: Vec<Vec<usize>> = vec![vec![]; ground + 1];
    let mut children = vec![0usize; ground];
    let mut carried = vec![false; ground];
    for (index, joint) in stated.iter().enumerate() {
        let (parent, child) = (number(joint.parent.0), number(joint.child.0));
        touching[parent].push(index);
        touching[child].push(index);
        if parent < ground {
            children[parent] += 1;
        }
        if child < ground {
            carried[child] = true;
        }
    }
    let mut placed = vec![false; ground + 1];
    let mut how: Vec<Option<bool>> = vec![None; stated.len()];
    placed[ground] = true;
    let mut level = vec![ground];
    // Candidates for a free joint to the ground, the likeliest base first: bodies that are the
    // child of the fewest joints, and among these the parent of the most.
    let mut bases: Vec<usize> = (0..ground).collect();
    bases.sort_by_key(|&body| (carried[body], std::cmp::Reverse(children[body])));
    let mut bases = bases.into_iter();
    loop {
        while !level.is_empty() {
            let reachable: BTreeSet<usize> =
                level.iter().flat_map(|&body| touching[body].iter().copied()).collect();
            let here: HashSet<usize> = level.drain(..).collect();
            for index in reachable {
                let (from, to) = (number(stated[index].parent.0), number(stated[index].child.0));
                let (backwards, next) = match (placed[from], placed[to]) {
                    (true, false) if here.contains(&from) => (false, to),
                    (false, true) if here.contains(&to) => (true, from),
                    _ => continue,
                };
                how[index] = Some(backwards);
                placed[next] = true;
                level.push(next);
            }
        }
        let Some(base) = bases.find(|&body| !placed[body]) else { break };
        let (element, segment) = bodies[base];
        reader.warn(
            "osim/unconnected-body",
            element,
            format!("{} is not connected to the ground by any joint", element.describe()),
            "it can move freely, as if a FreeJoint connected it",
        );
        let name = format!("free_{}", element.attribute("name").unwrap_or_default());
        let [parent, child] = [(None, Affine::IDENTITY), (segment, Affine::IDENTITY)];
        stated.push(Stated { element, kind: "FreeJoint", name, parent, child });
        how.push(Some(false));
        placed[base] = true;
        level.push(base);
    }
    name_apart(reader, &mut stated);
    let mut joints = vec![];
    for (joint, how) in stated.into_iter().zip(how) {
        joints.push(place(reader, joint, how)?);
    }
    Ok(joints)
}

/// OpenSim 4 rewrites the joint frames of older files as text of six significant digits before it
/// reads them: 2.0943951 rad becomes 2.0944, which moves a hand by 8 micrometres. We round in the
/// same way, so that both programs pose the same model.
fn six_digits(v: Vec3) -> Vec3 {
    let round = |x: f64| format!("{x:.5e}").parse().unwrap_or(x);
    Vec3::new(round(v.x), round(v.y), round(v.z))
}

fn stated_joints<'d>(reader: &mut Reader<'d, '_>) -> Result<Vec<Stated<'d>>, Error> {
    let mut stated = vec![];
    for element in reader.set_objects("JointSet") {
        if !element.name().ends_with("Joint") {
            continue;
        }
        let parent = reader.frames.of_part(element, "parent_frame", "parent_body")?;
        let child = reader.frames.of_part(element, "child_frame", "child_body")?;
        let name = element.attribute("name").unwrap_or_default().to_owned();
        stated.push(Stated { element, kind: element.name(), name, parent, child });
    }
    let bodies: Vec<(Element<'d>, Base)> = reader.frames.bodies().collect();
    for (body, base) in bodies {
        let Some(holder) = body.child("Joint") else { continue };
        let Some(element) = holder.children().find(|e| e.name().ends_with("Joint")) else {
            continue;
        };
        let reference = element.require("parent_body")?;
        let (parent, frame) = reader.frames.resolve(element, reference)?;
        let end = |place: &str, turn: &str| -> Result<Affine, Error> {
            let angles = six_digits(triple(element, turn)?);
            let origin = six_digits(triple(element, place)?);
            Ok(Affine::new(EulerOrder::XYZ.to_mat3(angles.to_array()), origin))
        };
        let parent = (parent, frame * end("location_in_parent", "orientation_in_parent")?);
        let child = (base, end("location", "orientation")?);
        let own = body.attribute("name").unwrap_or_default();
        let name = element.attribute("name").filter(|n| !n.is_empty());
        let name = name.map_or_else(|| format!("{own}_joint"), str::to_owned);
        stated.push(Stated { element, kind: element.name(), name, parent, child });
    }
    Ok(stated)
}

/// Gives unnamed and twice-named joints names of their own: `hip`, `hip_0`, `hip_1`.
fn name_apart(reader: &mut Reader<'_, '_>, stated: &mut [Stated<'_>]) {
    let mut taken: HashSet<String> = stated.iter().map(|joint| joint.name.clone()).collect();
    // For every name, the first number not yet tried: each is tried once, however many duplicates.
    let mut next: HashMap<String, usize> = HashMap::new();
    for joint in stated {
        let unnamed = joint.name.is_empty();
        if unnamed {
            joint.name = "joint".to_owned();
        }
        let Some(number) = next.get_mut(&joint.name) else {
            next.insert(joint.name.clone(), 0);
            continue;
        };
        let fresh = loop {
            let fresh = format!("{}_{number}", joint.name);
            *number += 1;
            if taken.insert(fresh.clone()) {
                break fresh;
            }
        };
        if !unnamed {
            let message = format!("a second joint is named `{}`", joint.name);
            let help = format!("it is read as `{fresh}`");
            reader.warn("osim/duplicate-joint", joint.element, message, &help);
        }
        joint.name = fresh;
    }
}

fn place<'d>(
    reader: &mut Reader<'d, '_>,
    joint: Stated<'d>,
    how: Option<bool>,
) -> Result<PlacedJoint<'d>, Error> {
    let Stated { element, kind, name, parent, child } = joint;
    // Before version 4 a joint could be marked as defined from child to parent.
    let reversed = element.child_bool("reverse")?.unwrap_or(false);
    let (from, to, backwards) = match how {
        Some(true) => (child, parent, true),
        _ => (parent, child, false),
    };
    let moved = match (how, to.0) {
        (Some(_), Some(segment)) => segment,
        _ => {
            let double = reader.builder.segment(&format!("{name}_end"), None);
            reader.warn(
                "osim/loop-joint",
                element,
                format!("{} joins two bodies that are connected already", element.describe()),
                "the loop is kept as a constraint, which tracking closes",
            );
            reader.builder.closure(Closure {
                name: name.clone(),
                condition: Condition::Frames {
                    at: [(Some(double), Affine::IDENTITY), (child.0, Affine::IDENTITY)],
                },
            });
            double
        }
    };
    reader.builder.set_parent(moved, from.0);
    reader.builder.place_joint_frames(moved, from.1, to.1);
    Ok(PlacedJoint { element, kind, name, moved, backwards: backwards != reversed })
}
