//! Which joint moves which body: the file's joints as a tree with the ground as its root.
//!
//! A joint may be defined from either end, and a body may be the child of two joints. The tree
//! contains each body once, by the fewest joints from the ground and, among those, by the joint
//! that comes first in the file; a joint whose child is already in the tree but whose parent is not
//! is reversed, and a joint between two bodies that are both in the tree closes a loop: it moves a
//! massless copy of its child, which a closure connects to the child itself. Bodies that no joint
//! connects to the ground get a free joint to it. OpenSim makes the same choices, so both programs
//! have the same coordinates.

use super::frame::Frames;
use super::{Base, Reader, is_joint, triple};
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

/// The joints wherever they stand. One inside `<Joint>` of a body carries that body; all others name
/// what they connect.
fn stated_joints<'d>(reader: &mut Reader<'d, '_>) -> Result<Vec<Stated<'d>>, Error> {
    let carriers: HashMap<u32, Base> =
        reader.frames.bodies().map(|(body, base)| (body.number(), base)).collect();
    let (mut stated, mut inside) = (vec![], vec![]);
    let mut held = HashSet::new();
    for element in reader.parts(is_joint) {
        let mut around = std::iter::successors(element.parent(), |e| e.parent());
        let holder = around.next().filter(|holder| holder.is("Joint"));
        let carrier = around.next().filter(|_| holder.is_some());
        let carried = carrier.and_then(|body| Some((body, *carriers.get(&body.number())?)));
        let set = element.parent().is_some_and(|e| e.is("objects") || e.is("JointSet"));
        let parent = Frames::reference(element, &["parent_frame", "parent_body"]);
        // What has no parent in an unknown place is no joint of the model.
        if parent.is_err() && !set && carried.is_none() {
            continue;
        }
        let from = ends(reader, element, ["location_in_parent"; 2], ["orientation_in_parent"; 2])?;
        let to = ends(
            reader,
            element,
            ["location_in_child", "location"],
            ["orientation_in_child", "orientation"],
        )?;
        let (parent, frame) = reader.frames.resolve(element, parent?)?;
        let parent = (parent, frame * from);
        let name = element.attribute("name").unwrap_or_default().to_owned();
        let kind = element.name();
        match carried {
            // The second joint of a body is left to be told as unused.
            Some((body, _)) if !held.insert(body.number()) => {}
            Some((body, base)) => {
                reader.uses(element);
                let own = body.attribute("name").unwrap_or_default();
                let name = if name.is_empty() { format!("{own}_joint") } else { name };
                inside.push(Stated { element, kind, name, parent, child: (base, to) });
            }
            None => {
                reader.uses(element);
                let (child, frame) =
                    reader.frames.of_part(element, &["child_frame", "child_body"])?;
                stated.push(Stated { element, kind, name, parent, child: (child, frame * to) });
            }
        }
    }
    stated.extend(inside);
    Ok(stated)
}

/// The end of a joint in the frame that it names, which versions before 3.05.05 state in the joint.
fn ends(
    reader: &mut Reader<'_, '_>,
    joint: Element<'_>,
    places: [&str; 2],
    turns: [&str; 2],
) -> Result<Affine, Error> {
    let given = |names: [&str; 2]| -> Result<Vec3, Error> {
        let found = names.into_iter().find(|name| joint.child_text(name).is_some());
        triple(joint, found.unwrap_or(names[0]))
    };
    let (origin, angles) = (given(places)?, given(turns)?);
    if origin == Vec3::ZERO && angles == Vec3::ZERO {
        return Ok(Affine::IDENTITY);
    }
    let new = Frames::socket(joint, "parent_frame").is_some();
    if new && reader.version.is_none_or(|version| version >= FRAMES_IN_JOINTS) {
        let message = format!("<{}> of {} is not used", places[0], joint.describe());
        let help = "since version 4 a joint states its ends as frames: use a PhysicalOffsetFrame";
        reader.warn("osim/unused-property", joint, message, help);
        return Ok(Affine::IDENTITY);
    }
    Ok(Affine::new(EulerOrder::XYZ.to_mat3(six_digits(angles).to_array()), six_digits(origin)))
}

/// The first version whose joints state their ends as frames.
const FRAMES_IN_JOINTS: u32 = 30505;

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
