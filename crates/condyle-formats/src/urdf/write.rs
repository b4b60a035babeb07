//! Models to robot descriptions.
//!
//! Every step of a chain becomes a joint of one number with a link after it; the last link of a chain is the
//! segment's. A joint whose value is linear in one coordinate mimics the joint of that coordinate. Others are fitted
//! by a line where that is within 0.5 mm or 0.1° of what they are, and else free, and told.
//!
//! URDF has z up: a model with y up hangs from a link that is turned by a quarter turn about x. Defaults, markers,
//! locks and closures have no place; a range that is not enforced is none.

use super::read::zyx;
use crate::plain::{Choice, Joints, Step, Tree, Written, build, is_still, pieces_of_one, upright};
use condyle_diagnostics::{Diagnostic, Read, listed};
use condyle_math::Affine;
use condyle_model::{Model, UpAxis};
use std::fmt::Write as _;

/// A model as a robot description, with what was fitted, freed or dropped as warnings.
///
/// ```
/// let mut b = condyle_model::ModelBuilder::new("arm");
/// b.up(condyle_model::UpAxis::Z);
/// let base = b.segment("base", None);
/// let forearm = b.segment("forearm", Some(base));
/// b.hinge("elbow", forearm, "flexion", condyle_math::Vec3::Z);
/// let text = condyle_formats::urdf::write(&b.build().unwrap()).value;
/// assert!(text.contains("<joint name=\"flexion\" type=\"continuous\">"));
/// ```
#[must_use]
pub fn write(model: &Model) -> Read<String> {
    written(model).into_read()
}

/// A model as a robot description, with the tree that it says.
#[must_use]
pub fn written(model: &Model) -> Written {
    let mut tree = build(model, Choice { balls: true });
    if !tree.links.iter().all(|link| balls_float(&tree, &link.steps)) {
        tree = build(model, Choice { balls: false });
    }
    let joints = Joints::new(model, &tree, 1);
    let mut remarks = std::mem::take(&mut tree.remarks);
    remarks.extend(joints.remarks("URDF", "urdf/not-said"));
    let turned = tree.up == UpAxis::Y;
    let base = if turned { upright() } else { Affine::IDENTITY };
    let mut file =
        File { out: String::new(), tree: &tree, joints: &joints, balls: vec![], root: None };
    file.text(base);
    let File { out: text, balls, .. } = file;
    dropped(model, &mut remarks);
    let (named, bodies) = (joints.named(), joints.bodies.clone());
    Written { text, joints: named, balls, bodies, base, tree, remarks }
}

/// Whether every ball of a chain comes after slides along x, y and z, as a floating joint has it.
fn balls_float(tree: &Tree, steps: &[Step]) -> bool {
    steps.iter().enumerate().all(|(place, step)| {
        !matches!(step, Step::Ball { .. }) || floats(tree, steps, place).is_some()
    })
}

/// The position of the first slide of a floating joint whose ball is here.
fn floats(tree: &Tree, steps: &[Step], ball: usize) -> Option<usize> {
    use condyle_math::Vec3;
    let Step::Ball { inverse: false, .. } = steps.get(ball)? else { return None };
    let first = ball.checked_sub(3)?;
    let slides = steps.get(first..ball)?.iter().zip([Vec3::X, Vec3::Y, Vec3::Z]);
    let mut all = slides.map(|(step, along)| match step {
        Step::Slide { axis, value } => {
            *axis == along && matches!(tree.rules.rule(*value), crate::plain::Rule::Variable(_))
        }
        _ => false,
    });
    all.all(|fits| fits).then_some(first)
}

struct File<'t> {
    out: String,
    tree: &'t Tree,
    joints: &'t Joints,
    balls: Vec<(String, usize)>,
    /// The link that is the world, where it is no segment.
    root: Option<String>,
}

impl File<'_> {
    fn text(&mut self, base: Affine) {
        let name = crate::plain::escaped(&self.tree.name);
        let _ = writeln!(self.out, "<?xml version=\"1.0\"?>\n<robot name=\"{name}\">");
        let roots: Vec<usize> =
            (0..self.tree.links.len()).filter(|&i| self.tree.links[i].parent.is_none()).collect();
        let alone = match roots[..] {
            [root] => {
                self.tree.links[root].steps.is_empty()
                    && is_still(&base)
                    && self.joints.holders.is_empty()
            }
            _ => false,
        };
        if !alone {
            let root = self.joints.world.clone();
            let _ = writeln!(self.out, "  <link name=\"{root}\"/>");
            self.root = Some(root);
        }
        for place in 0..self.tree.links.len() {
            self.link(place, base);
        }
        let joints = self.joints;
        for holder in &joints.holders {
            let Some(root) = self.root.clone() else { continue };
            let link = &holder.body;
            let _ = writeln!(self.out, "  <link name=\"{link}\"/>");
            let joint = &joints.all[holder.joint];
            self.joint(joint, &root, link, &Affine::IDENTITY, condyle_math::Vec3::X);
        }
        self.out.push_str("</robot>\n");
    }

    fn link(&mut self, place: usize, base: Affine) {
        let (tree, joints) = (self.tree, self.joints);
        let link = &tree.links[place];
        let body = joints.bodies[place].clone();
        let parent = match link.parent {
            Some(parent) => Some(self.joints.bodies[parent].clone()),
            None => self.root.clone(),
        };
        let mut origin = if link.parent.is_none() { base } else { Affine::IDENTITY };
        let Some(mut here) = parent else {
            let _ = writeln!(self.out, "  <link name=\"{body}\"/>");
            return;
        };
        let steps = &link.steps;
        let last = steps.iter().rposition(|step| !matches!(step, Step::Fixed(_)));
        let ends_moving = last.is_some_and(|last| last + 1 == steps.len());
        let mut number = 0usize;
        for (at, step) in steps.iter().enumerate() {
            // The slides of a floating joint are said with its ball.
            let floating = (at..steps.len().min(at + 4)).find_map(|ball| {
                floats(self.tree, steps, ball).filter(|&first| first <= at && at < ball)
            });
            if floating.is_some() {
                continue;
            }
            if let Step::Fixed(frame) = step {
                origin = origin * *frame;
                continue;
            }
            number += 1;
            let next = match ends_moving && last == Some(at) {
                true => body.clone(),
                false => format!("{body}_part_{number}"),
            };
            let _ = writeln!(self.out, "  <link name=\"{next}\"/>");
            match step {
                Step::Turn { axis, .. } | Step::Slide { axis, .. } => {
                    if let Some(joint) = joints.at(place, at) {
                        self.joint(joint, &here, &next, &origin, *axis);
                    }
                }
                Step::Ball { orientation, .. } => {
                    let name = link.joint.clone();
                    self.ends("floating", &name, &here, &next, &origin, "");
                    self.balls.push((name, *orientation));
                }
                Step::Fixed(_) => {}
            }
            origin = Affine::IDENTITY;
            here = next;
        }
        if !ends_moving {
            let _ = writeln!(self.out, "  <link name=\"{body}\"/>");
            let name = format!("{body}_fixed");
            self.ends("fixed", &name, &here, &body, &origin, "");
        }
    }

    fn joint(
        &mut self,
        joint: &pieces_of_one::Joint,
        parent: &str,
        child: &str,
        origin: &Affine,
        axis: condyle_math::Vec3,
    ) {
        let (lower, upper) = self.bounds(joint);
        // Pinocchio takes a joint without bounds as a point on a circle, which nothing of one number can mimic.
        let coupled = joint.coupled.is_some() || self.is_mimicked(joint);
        let bounded = lower.is_finite() || upper.is_finite() || coupled;
        let kind = match (joint.turns, bounded) {
            (true, true) => "revolute",
            (true, false) => "continuous",
            (false, _) => "prismatic",
        };
        let numbers = |v: [f64; 3]| v.map(number).join(" ");
        let mut inside = format!("    <axis xyz=\"{}\"/>\n", numbers(axis.to_array()));
        if kind != "continuous" {
            let (lower, upper) = (number(lower.max(-1e9)), number(upper.min(1e9)));
            let _ = writeln!(
                inside,
                "    <limit lower=\"{lower}\" upper=\"{upper}\" effort=\"1000\" velocity=\"100\"/>"
            );
        }
        if let Some((leader, coefficients)) = &joint.coupled {
            let at = |i: usize| number(coefficients.get(i).copied().unwrap_or(0.0));
            let leader = &self.joints.all[*leader].name;
            let (slope, offset) = (at(1), at(0));
            let _ = writeln!(
                inside,
                "    <mimic joint=\"{leader}\" multiplier=\"{slope}\" offset=\"{offset}\"/>"
            );
        }
        self.ends(kind, &joint.name, parent, child, origin, &inside);
    }

    /// The range of a joint, or where that of the joint that it mimics takes it.
    fn bounds(&self, joint: &pieces_of_one::Joint) -> (f64, f64) {
        let Some((leader, coefficients)) = &joint.coupled else { return joint.range.bounds() };
        let (lower, upper) = self.joints.all[*leader].range.bounds();
        let at = |i: usize| coefficients.get(i).copied().unwrap_or(0.0);
        let ends = [lower, upper].map(|x| at(1) * x + at(0));
        match ends.iter().any(|x| x.is_nan()) {
            true => (f64::NEG_INFINITY, f64::INFINITY),
            false => (ends[0].min(ends[1]), ends[0].max(ends[1])),
        }
    }

    fn is_mimicked(&self, joint: &pieces_of_one::Joint) -> bool {
        self.joints.all.iter().any(|other| {
            let leader = other.coupled.as_ref().map(|(leader, _)| &self.joints.all[*leader]);
            leader.is_some_and(|leader| leader.name == joint.name)
        })
    }

    fn ends(
        &mut self,
        kind: &str,
        name: &str,
        parent: &str,
        child: &str,
        origin: &Affine,
        inside: &str,
    ) {
        let [yaw, pitch, roll] = zyx().from_mat3(origin.linear);
        let place = origin.translation.to_array().map(number).join(" ");
        let turn = [roll, pitch, yaw].map(number).join(" ");
        let _ = writeln!(
            self.out,
            "  <joint name=\"{name}\" type=\"{kind}\">\n    <parent link=\"{parent}\"/>\n    <child link=\"{child}\"/>\n    \
             <origin xyz=\"{place}\" rpy=\"{turn}\"/>\n{inside}  </joint>"
        );
    }
}

/// With the fewest digits that give it back.
fn number(value: f64) -> String {
    if value == 0.0 { "0".to_owned() } else { format!("{value:?}") }
}

fn dropped(model: &Model, remarks: &mut Vec<Diagnostic>) {
    let mut lost = vec![];
    if !model.markers().is_empty() {
        lost.push(format!("{} markers", model.markers().len()));
    }
    if !model.closures().is_empty() {
        lost.push(format!("{} loops", model.closures().len()));
    }
    let defaults = model.coordinates().iter().filter(|c| c.default != c.kind.neutral()).count();
    if defaults > 0 {
        lost.push(format!("{defaults} defaults that are not 0"));
    }
    if !lost.is_empty() {
        remarks.push(Diagnostic::warning(
            "urdf/dropped",
            format!("URDF has no place for {}", lost.join(", ")),
        ));
    }
    let hints: Vec<&str> = model
        .coordinates()
        .iter()
        .filter(|c| !c.range.enforced && (c.range.lower.is_some() || c.range.upper.is_some()))
        .map(|c| c.name.as_str())
        .collect();
    if !hints.is_empty() {
        let message = format!("ranges that are not enforced are not written: {}", listed(hints));
        remarks.push(Diagnostic::note("urdf/dropped", message));
    }
}
