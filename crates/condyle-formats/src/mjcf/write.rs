//! Models to bodies and joints.

use crate::plain::pieces_of_one::Joint;
use crate::plain::{Choice, Joints, Names, Step, Tree, Written, build, escaped, upright};
use condyle_diagnostics::{Diagnostic, Read, listed};
use condyle_math::{Affine, Quat, Vec3};
use condyle_model::model::Condition;
use condyle_model::{Model, SegmentId, UpAxis};
use std::fmt::Write as _;

/// The most directions of motion of one body.
const MOST_DIRECTIONS: usize = 6;
/// The highest power of a coupling.
const ORDER: usize = 4;
/// Inertia of every joint itself, in kg or kg·m²: several joints of one body about nearly the same axis have none
/// between them, and MuJoCo could not solve for their accelerations.
const ARMATURE: f64 = 1e-3;
/// A side of a range that has no bound.
const FAR: f64 = 1e6;

/// A model as MJCF, with what was fitted, freed or dropped as warnings.
///
/// ```
/// let mut b = condyle_model::ModelBuilder::new("arm");
/// let forearm = b.segment("forearm", None);
/// b.hinge("elbow", forearm, "flexion", condyle_math::Vec3::Z);
/// let text = condyle_formats::mjcf::write(&b.build().unwrap()).value;
/// assert!(text.contains("<joint name=\"flexion\" type=\"hinge\""));
/// ```
#[must_use]
pub fn write(model: &Model) -> Read<String> {
    written(model).into_read()
}

/// A model as MJCF, with the tree that it says.
#[must_use]
pub fn written(model: &Model) -> Written {
    let mut tree = build(model, Choice { balls: true });
    let joints = Joints::new(model, &tree, ORDER);
    let mut remarks = std::mem::take(&mut tree.remarks);
    remarks.extend(joints.remarks("MJCF", "mjcf/not-said"));
    let base = if tree.up == UpAxis::Y { upright() } else { Affine::IDENTITY };
    let mut file = File {
        model,
        tree: &tree,
        joints: &joints,
        out: String::new(),
        balls: vec![],
        defaults: String::new(),
        depth: 2,
        closures: String::new(),
        sites: vec![],
    };
    file.closures(&mut remarks);
    file.text(base);
    let File { out: text, balls, .. } = file;
    Written {
        text,
        joints: joints.named(),
        balls,
        bodies: joints.bodies.clone(),
        base,
        tree,
        remarks,
    }
}

/// A joint of a body.
enum Motion<'t> {
    One { joint: &'t Joint, axis: Vec3, at: Vec3 },
    Ball { name: String, at: Vec3, default: Quat },
}

struct File<'t> {
    model: &'t Model,
    tree: &'t Tree,
    joints: &'t Joints,
    out: String,
    balls: Vec<(String, usize)>,
    /// The positions of all joints in the order of the file.
    defaults: String,
    depth: usize,
    closures: String,
    /// Points and frames of closures, by segment.
    sites: Vec<(Option<SegmentId>, String)>,
}

impl<'t> File<'t> {
    fn line(&mut self, text: &str) {
        let _ = writeln!(self.out, "{:width$}{text}", "", width = 2 * self.depth.min(40));
    }

    fn text(&mut self, base: Affine) {
        let name = escaped(&self.tree.name);
        let _ = writeln!(
            self.out,
            "<mujoco model=\"{name}\">\n  <compiler angle=\"radian\" autolimits=\"false\"/>\n  <default>\n    <joint armature=\"{}\"/>\n  </default>\n  <worldbody>",
            numbers([ARMATURE])
        );
        let world = self.joints.world.clone();
        self.line(&format!("<body name=\"{world}\"{}>", frame(&base)));
        self.depth += 1;
        self.say_sites(None);
        let holders = self.joints.holders.clone();
        for holder in holders {
            let joint = &self.joints.all[holder.joint];
            self.line(&format!("<body name=\"{}\">", holder.body));
            self.depth += 1;
            self.line(&inertial(1e-3));
            self.one(joint, Vec3::X, Vec3::ZERO);
            self.depth -= 1;
            self.line("</body>");
        }
        self.bodies();
        self.depth -= 1;
        self.line("</body>");
        self.out.push_str("  </worldbody>\n");
        self.couplings();
        let _ = writeln!(
            self.out,
            "  <keyframe>\n    <key name=\"default\" qpos=\"{}\"/>\n  </keyframe>\n</mujoco>",
            self.defaults.trim()
        );
    }

    /// All bodies, each inside its parent.
    fn bodies(&mut self) {
        let mut below: Vec<Vec<usize>> = vec![vec![]; self.tree.links.len()];
        let mut open: Vec<(usize, usize)> = vec![];
        let mut roots = vec![];
        for (place, link) in self.tree.links.iter().enumerate() {
            match link.parent {
                Some(parent) => below[parent].push(place),
                None => roots.push(place),
            }
        }
        for root in roots {
            let bodies = self.begin(root);
            open.push((root, bodies));
            let mut next = vec![0usize; self.tree.links.len()];
            while let Some(&(here, bodies)) = open.last() {
                if let Some(&child) = below[here].get(next[here]) {
                    next[here] += 1;
                    let bodies = self.begin(child);
                    open.push((child, bodies));
                } else {
                    open.pop();
                    for _ in 0..bodies {
                        self.depth -= 1;
                        self.line("</body>");
                    }
                }
            }
        }
    }

    /// Opens the bodies of a link; their number.
    fn begin(&mut self, place: usize) -> usize {
        let (tree, joints) = (self.tree, self.joints);
        let link = &tree.links[place];
        let parts = parts(&link.steps);
        let last = parts.len() - 1;
        for (number, range) in parts.iter().enumerate() {
            let whole = number == last;
            let name = match whole {
                true => joints.bodies[place].clone(),
                false => format!("{}_part_{}", joints.bodies[place], number + 1),
            };
            let steps = &link.steps[range.clone()];
            let fixed = |steps: &[Step]| {
                steps.iter().fold(Affine::IDENTITY, |so_far, step| match step {
                    Step::Fixed(frame) => so_far * *frame,
                    _ => so_far,
                })
            };
            self.line(&format!("<body name=\"{name}\"{}>", frame(&fixed(steps))));
            self.depth += 1;
            self.line(&inertial(if whole { 1.0 } else { 1e-3 }));
            for (at, step) in steps.iter().enumerate() {
                // Axes and centres are given in the body's own frame.
                let back = fixed(&steps[at..]).rigid_inverse();
                match step {
                    Step::Turn { axis, .. } | Step::Slide { axis, .. } => {
                        if let Some(joint) = joints.at(place, range.start + at) {
                            self.motion(&Motion::One {
                                joint,
                                axis: back.linear * *axis,
                                at: back.translation,
                            });
                        }
                    }
                    Step::Ball { orientation, .. } => {
                        let name = format!("{}_ball", link.joint);
                        let default = tree
                            .orientations
                            .get(*orientation)
                            .map(|&id| self.model.coordinate(id).default);
                        let default = default.map_or(Quat::IDENTITY, Quat::from);
                        self.balls.push((name.clone(), *orientation));
                        self.motion(&Motion::Ball { name, at: back.translation, default });
                    }
                    Step::Fixed(_) => {}
                }
            }
        }
        self.say_sites(Some(link.segment));
        for marker in self.model.markers().iter().filter(|m| m.segment == Some(link.segment)) {
            let (name, point) = (escaped(&marker.name), numbers(marker.point.to_array()));
            self.line(&format!("<site name=\"{name}\" pos=\"{point}\" size=\"0.005\"/>"));
        }
        parts.len()
    }

    fn motion(&mut self, motion: &Motion<'t>) {
        match motion {
            Motion::One { joint, axis, at } => self.one(joint, *axis, *at),
            Motion::Ball { name, at, default } => {
                let text = format!(
                    "<joint name=\"{name}\" type=\"ball\" pos=\"{}\"/>",
                    numbers(at.to_array())
                );
                self.line(&text);
                let _ = write!(self.defaults, "{} ", quaternion(*default));
            }
        }
    }

    fn one(&mut self, joint: &Joint, axis: Vec3, at: Vec3) {
        let (lower, upper) = joint.range.bounds();
        let limits = match lower.is_finite() || upper.is_finite() {
            true => format!(
                " limited=\"true\" range=\"{}\"",
                numbers([lower.max(-FAR), upper.min(FAR)])
            ),
            false => String::new(),
        };
        let text = format!(
            "<joint name=\"{}\" type=\"{}\" axis=\"{}\" pos=\"{}\"{limits}/>",
            joint.name,
            if joint.turns { "hinge" } else { "slide" },
            numbers(axis.to_array()),
            numbers(at.to_array()),
        );
        self.line(&text);
        let _ = write!(self.defaults, "{} ", numbers([joint.default]));
    }

    /// Equalities, and the tendons that some of them hold.
    fn couplings(&mut self) {
        let (mut tendons, mut equalities) = (String::new(), String::new());
        for joint in &self.joints.all {
            let name = &joint.name;
            if let Some((leader, coefficients)) = &joint.coupled {
                let mut all = coefficients.clone();
                all.resize(ORDER + 1, 0.0);
                let leader = &self.joints.all[*leader].name;
                let _ = writeln!(
                    equalities,
                    "    <joint joint1=\"{name}\" joint2=\"{leader}\" polycoef=\"{}\"/>",
                    numbers(all)
                );
            } else if let Some((terms, constant)) = &joint.sum {
                let _ = write!(
                    tendons,
                    "    <fixed name=\"{name}_sum\"><joint joint=\"{name}\" coef=\"1\"/>"
                );
                for (leader, factor) in terms {
                    let leader = &self.joints.all[*leader].name;
                    let factor = numbers([-factor]);
                    let _ = write!(tendons, "<joint joint=\"{leader}\" coef=\"{factor}\"/>");
                }
                tendons.push_str("</fixed>\n");
                let _ = writeln!(
                    equalities,
                    "    <tendon tendon1=\"{name}_sum\" polycoef=\"{} 0 0 0 0\"/>",
                    numbers([*constant])
                );
            }
        }
        if !tendons.is_empty() {
            let _ = write!(self.out, "  <tendon>\n{tendons}  </tendon>\n");
        }
        equalities.push_str(&self.closures);
        if !equalities.is_empty() {
            let _ = write!(self.out, "  <equality>\n{equalities}  </equality>\n");
        }
    }

    fn say_sites(&mut self, segment: Option<SegmentId>) {
        let here: Vec<String> = self
            .sites
            .iter()
            .filter(|(of, _)| *of == segment)
            .map(|(_, text)| text.clone())
            .collect();
        here.iter().for_each(|text| self.line(text));
        if segment.is_none() {
            for marker in self.model.markers().iter().filter(|m| m.segment.is_none()) {
                let (name, point) = (escaped(&marker.name), numbers(marker.point.to_array()));
                self.line(&format!("<site name=\"{name}\" pos=\"{point}\" size=\"0.005\"/>"));
            }
        }
    }

    /// Loops of points and frames.
    fn closures(&mut self, remarks: &mut Vec<Diagnostic>) {
        let mut lost = vec![];
        let mut names = Names::default();
        for closure in self.model.closures() {
            let (word, at) = match &closure.condition {
                Condition::Points { at } => (
                    "connect",
                    at.map(|(segment, point)| (segment, Affine::from_translation(point))),
                ),
                Condition::Frames { at } => ("weld", *at),
                Condition::Distance { .. } | Condition::Coupling { .. } => {
                    lost.push(closure.name.clone());
                    continue;
                }
            };
            let name = names.take(&closure.name);
            for (number, (segment, place)) in at.iter().enumerate() {
                let text = format!(
                    "<site name=\"{name}_end_{}\"{} size=\"0.005\"/>",
                    number + 1,
                    frame(place)
                );
                self.sites.push((*segment, text));
            }
            let _ = writeln!(
                self.closures,
                "    <{word} name=\"{name}\" site1=\"{name}_end_1\" site2=\"{name}_end_2\"/>"
            );
        }
        if !lost.is_empty() {
            let message = format!(
                "loops of distances and couplings in a circle are left out: {}",
                listed(lost)
            );
            remarks.push(Diagnostic::warning("mjcf/dropped", message));
        }
        let hints: Vec<&str> = self
            .model
            .coordinates()
            .iter()
            .filter(|c| !c.range.enforced && (c.range.lower.is_some() || c.range.upper.is_some()))
            .map(|c| c.name.as_str())
            .collect();
        if !hints.is_empty() {
            let message =
                format!("ranges that are not enforced are not written: {}", listed(hints));
            remarks.push(Diagnostic::note("mjcf/dropped", message));
        }
    }
}

/// A chain cut into bodies: at most six directions each, and no turn in a body that has a ball.
fn parts(steps: &[Step]) -> Vec<std::ops::Range<usize>> {
    let mut parts = vec![];
    let (mut from, mut directions, mut turned, mut ball) = (0usize, 0usize, false, false);
    for (at, step) in steps.iter().enumerate() {
        let (own, turns, is_ball) = match step {
            Step::Fixed(_) => continue,
            Step::Slide { .. } => (1, false, false),
            Step::Turn { .. } => (1, true, false),
            Step::Ball { .. } => (3, true, true),
        };
        if directions + own > MOST_DIRECTIONS || ball || (is_ball && turned) {
            parts.push(from..at);
            (from, directions, turned, ball) = (at, 0, false, false);
        }
        directions += own;
        turned |= turns;
        ball |= is_ball;
    }
    parts.push(from..steps.len());
    parts
}

fn inertial(mass: f64) -> String {
    let inertia = numbers([0.01 * mass; 3]);
    format!("<inertial pos=\"0 0 0\" mass=\"{}\" diaginertia=\"{inertia}\"/>", numbers([mass]))
}

/// The attributes of a frame.
fn frame(frame: &Affine) -> String {
    let place = numbers(frame.translation.to_array());
    format!(" pos=\"{place}\" quat=\"{}\"", quaternion(Quat::from_mat3(frame.linear)))
}

fn quaternion(q: Quat) -> String {
    numbers([q.w, q.x, q.y, q.z])
}

fn numbers(all: impl IntoIterator<Item = f64>) -> String {
    let text = all.into_iter().map(|x| if x == 0.0 { "0".to_owned() } else { format!("{x:?}") });
    text.collect::<Vec<_>>().join(" ")
}
