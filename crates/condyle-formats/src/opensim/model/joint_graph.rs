//! Which joint carries which body: the file's joints as a tree that grows from the ground.
//!
//! A joint may be stated from either end, and a body may hang on two joints. The tree takes each
//! body once, by the joint met first on the way from the ground; a joint whose child is already
//! there but whose parent is not is taken backwards, and a joint between two bodies that are both
//! there closes a loop: it carries a massless double of its child, which a closure ties to the
//! child itself.

use super::{Base, Reader};
use crate::diagnostic::Error;
use crate::opensim::model::triple;
use crate::xml::Element;
use condyle_math::{Affine, EulerOrder, Vec3};
use condyle_model::SegmentId;
use condyle_model::model::{Closure, Condition};
use std::collections::VecDeque;

/// A joint with its place in the tree.
pub(super) struct PlacedJoint<'d> {
    pub element: Element<'d>,
    pub name: String,
    /// The segment that it moves.
    pub moved: SegmentId,
    /// Whether the file states it from the moved segment towards the ground.
    pub backwards: bool,
}

struct Stated<'d> {
    element: Element<'d>,
    name: String,
    parent: (Base, Affine),
    child: (Base, Affine),
}

/// Finds all joints, hangs every segment on its parent, and sets the joint frames.
pub(super) fn collect<'d>(reader: &mut Reader<'d, '_>) -> Result<Vec<PlacedJoint<'d>>, Error> {
    let stated = stated_joints(reader)?;
    let bodies = reader.frames.bodies().count();
    let number = |base: Base| base.map_or(bodies, SegmentId::index);
    let mut touching: Vec<Vec<usize>> = vec![vec![]; bodies + 1];
    for (index, joint) in stated.iter().enumerate() {
        touching[number(joint.parent.0)].push(index);
        touching[number(joint.child.0)].push(index);
    }
    let mut placed = vec![false; bodies + 1];
    let mut how: Vec<Option<bool>> = vec![None; stated.len()];
    let elements: Vec<Element<'d>> = reader.frames.bodies().map(|(element, _)| element).collect();
    let carried: std::collections::HashSet<usize> =
        stated.iter().map(|joint| number(joint.child.0)).collect();
    // The ground, then every body that no joint carries.
    let roots = std::iter::once(bodies).chain((0..bodies).filter(|body| !carried.contains(body)));
    for root in roots {
        if placed[root] {
            continue;
        }
        placed[root] = true;
        if let Some(&element) = elements.get(root) {
            reader.warn(
                "osim/unconnected-body",
                element,
                format!("{} is not connected to the ground by any joint", element.describe()),
                "it is kept at the ground's origin",
            );
        }
        let mut queue = VecDeque::from([root]);
        while let Some(here) = queue.pop_front() {
            for backwards in [false, true] {
                for &index in &touching[here] {
                    let joint = &stated[index];
                    let (from, to) = (number(joint.parent.0), number(joint.child.0));
                    let (from, to) = if backwards { (to, from) } else { (from, to) };
                    if how[index].is_none() && from == here && !placed[to] {
                        how[index] = Some(backwards);
                        placed[to] = true;
                        queue.push_back(to);
                    }
                }
            }
        }
    }
    if let Some(root) = (0..bodies).find(|&body| !placed[body]) {
        let element = elements[root];
        return Err(element
            .error(
                "osim/body-cycle",
                format!("{} is its own ancestor by its joints", element.describe()),
            )
            .with_help("connect one body of the circle to the ground"));
    }
    let mut joints = vec![];
    for (joint, how) in stated.into_iter().zip(how) {
        joints.push(place(reader, joint, how)?);
    }
    Ok(joints)
}

/// OpenSim 4 rewrites the joint frames of older files as text of six significant digits before it
/// reads them, so that is where its bodies stand: 2.0943951 rad becomes 2.0944, which moves a hand
/// by 8 micrometres. We follow it, so that both programs pose the same model.
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
        stated.push(Stated { element, name, parent, child });
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
        stated.push(Stated { element, name, parent, child });
    }
    // Unnamed or twice-named joints get names of their own.
    let mut seen = std::collections::HashMap::<String, usize>::new();
    for joint in &mut stated {
        let count = seen.entry(joint.name.clone()).or_default();
        *count += 1;
        if *count > 1 || joint.name.is_empty() {
            joint.name = format!("{}#{count}", joint.name);
        }
    }
    Ok(stated)
}

fn place<'d>(
    reader: &mut Reader<'d, '_>,
    joint: Stated<'d>,
    how: Option<bool>,
) -> Result<PlacedJoint<'d>, Error> {
    let Stated { element, name, parent, child } = joint;
    // Before version 4 a joint could say itself that it is stated from child to parent.
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
    Ok(PlacedJoint { element, name, moved, backwards: backwards != reversed })
}
