//! Models as `.osim` files of version 4, for OpenSim.
//!
//! Every segment is a body; its chain of plain joints ([`crate::plain`]) is cut into custom joints of three slides
//! and three turns, with bodies of next to no mass between them where one is not enough.
//!
//! | in the model | in the file |
//! | --- | --- |
//! | a coordinate that turns or slides something by itself | the coordinate of that joint |
//! | a function of a coordinate of the same joint | the function of an axis |
//! | any other value | a coordinate of the joint, coupled (`CoordinateCouplerConstraint`) |
//! | a number on the way to such a value; a coordinate that only drives others | a coordinate of a body of its own that nothing hangs from |
//! | ranges, defaults, locks, markers, closures | the same |
//! | masses | none are known: 1 kg for each segment |
//!
//! Numbers have the fewest digits that give them back.

mod coupling;
pub(in crate::opensim) mod function;
mod joint;

use crate::plain::{
    Choice, Piece, Rule, Source, Tree, Value, Written, build, escaped, fit, pieces,
};
use condyle_diagnostics::{Diagnostic, Read, listed};
use condyle_math::{Affine, EulerOrder, Vec3};
use condyle_model::model::Condition;
use condyle_model::{Model, SegmentId};
use coupling::Coordinates;
use function::numbers;
use std::fmt::Write as _;

/// A model as an `.osim` file, with what was fitted or dropped as warnings.
///
/// ```
/// let mut b = condyle_model::ModelBuilder::new("arm");
/// let forearm = b.segment("forearm", None);
/// b.hinge("elbow", forearm, "flexion", condyle_math::Vec3::Z);
/// let text = condyle_formats::opensim::write(&b.build().unwrap()).value;
/// let again = condyle_formats::opensim::model::read(text.as_bytes()).unwrap().value;
/// assert_eq!(again.coordinates()[0].name, "flexion");
/// ```
#[must_use]
pub fn write(model: &Model) -> Read<String> {
    written(model).into_read()
}

/// A model as an `.osim` file, with the tree that it says.
#[must_use]
pub fn written(model: &Model) -> Written {
    let mut tree = build(model, Choice::default());
    fit(model, &mut tree);
    let mut remarks = std::mem::take(&mut tree.remarks);
    remarks.extend(defaults_moved(model));
    let mut file = File::new(model, tree, remarks);
    let text = file.text();
    let File { tree, coordinates, bodies, remarks, .. } = file;
    Written {
        text,
        joints: coordinates.into_named(),
        balls: vec![],
        base: Affine::IDENTITY,
        tree,
        bodies,
        remarks,
    }
}

/// What is said of defaults that OpenSim refuses: those outside a range that holds.
fn defaults_moved(model: &Model) -> Option<Diagnostic> {
    let moved = model.coordinate_ids().filter(|&id| {
        let (range, default) = (model.coordinate(id).range, model.value(&model.defaults(), id));
        range.nearest(default) != default
    });
    let names: Vec<String> = moved.map(|id| model.coordinate_key(id)).collect();
    let message = format!("outside their ranges are the defaults of {}", listed(&names));
    let said = Diagnostic::warning("osim/default", message);
    (!names.is_empty()).then(|| said.with_help("OpenSim refuses that: they are at the nearest end"))
}

/// One joint of the file with the body that it moves.
struct Moved {
    /// The path of the frame it hangs from.
    parent: String,
    body: String,
    joint: String,
    piece: Piece,
    /// Whether the body is the segment's, not one in between.
    whole: bool,
}

struct File<'m> {
    model: &'m Model,
    tree: Tree,
    moved: Vec<Moved>,
    /// The body of each link.
    bodies: Vec<String>,
    coordinates: Coordinates,
    remarks: Vec<Diagnostic>,
}

impl<'m> File<'m> {
    fn new(model: &'m Model, tree: Tree, remarks: Vec<Diagnostic>) -> Self {
        let mut names = crate::plain::Names::default();
        names.take("ground");
        let mut joints = crate::plain::Names::default();
        let bodies: Vec<String> = tree.links.iter().map(|link| names.take(&link.name)).collect();
        let mut moved = vec![];
        for (place, link) in tree.links.iter().enumerate() {
            let mut parent = match link.parent.and_then(|parent| bodies.get(parent)) {
                Some(body) => format!("/bodyset/{body}"),
                None => "/ground".to_owned(),
            };
            let pieces = pieces(&link.steps);
            let last = pieces.len() - 1;
            for (number, piece) in pieces.into_iter().enumerate() {
                let whole = number == last;
                let body = match whole {
                    true => bodies[place].clone(),
                    false => names.take(&format!("{}_part_{}", link.name, number + 1)),
                };
                let joint = joints.take(&match whole {
                    true => link.joint.clone(),
                    false => format!("{}_part_{}", link.joint, number + 1),
                });
                let next = format!("/bodyset/{body}");
                moved.push(Moved { parent, body, joint, piece, whole });
                parent = next;
            }
        }
        let coordinates = Coordinates::new(model, &tree, &moved);
        Self { model, tree, moved, bodies, coordinates, remarks }
    }

    fn text(&mut self) -> String {
        let mut out = String::from(
            "<?xml version=\"1.0\" encoding=\"UTF-8\" ?>\n<OpenSimDocument Version=\"40000\">\n",
        );
        let name = named(&self.tree.name);
        let _ = writeln!(out, "<Model name=\"{name}\">");
        out.push_str(
            "<credits>written by condyle; masses are not known: 1 kg for each segment</credits>\n",
        );
        out.push_str("<length_units>meters</length_units>\n<force_units>N</force_units>\n");
        let gravity = match self.tree.up {
            condyle_model::UpAxis::Y => "0 -9.80665 0",
            condyle_model::UpAxis::Z => "0 0 -9.80665",
        };
        let _ = writeln!(out, "<gravity>{gravity}</gravity>\n<Ground name=\"ground\"/>");
        out.push_str("<BodySet name=\"bodyset\"><objects>\n");
        for moved in &self.moved {
            let (mass, inertia) = if moved.whole { (1.0, 0.01) } else { (1e-4, 1e-6) };
            body(&mut out, &moved.body, mass, inertia);
        }
        for holder in self.coordinates.holders() {
            body(&mut out, &holder.name, 1e-4, 1e-6);
        }
        out.push_str("</objects></BodySet>\n<JointSet name=\"jointset\"><objects>\n");
        for (number, moved) in self.moved.iter().enumerate() {
            joint::moved(&mut out, moved, number, &self.tree, &self.coordinates);
        }
        for holder in self.coordinates.holders() {
            joint::holder(&mut out, holder, &self.coordinates);
        }
        out.push_str("</objects></JointSet>\n<ConstraintSet name=\"constraintset\"><objects>\n");
        self.coordinates.couplers(&mut out, &self.tree);
        self.closures(&mut out);
        out.push_str("</objects></ConstraintSet>\n<MarkerSet name=\"markerset\"><objects>\n");
        for marker in self.model.markers() {
            let frame = self.frame(marker.segment);
            let _ = writeln!(
                out,
                "<Marker name=\"{}\"><socket_parent_frame>{frame}</socket_parent_frame><location>{}</location>\
                 <fixed>true</fixed></Marker>",
                named(&marker.name),
                numbers(marker.point.to_array())
            );
        }
        out.push_str("</objects></MarkerSet>\n</Model>\n</OpenSimDocument>\n");
        self.remark();
        out
    }

    /// The path of the frame of a segment, or of the ground.
    fn frame(&self, segment: Option<SegmentId>) -> String {
        let place =
            segment.and_then(|id| self.tree.links.iter().position(|link| link.segment == id));
        match place.and_then(|place| self.bodies.get(place)) {
            Some(body) => format!("/bodyset/{body}"),
            None => "/ground".to_owned(),
        }
    }

    fn closures(&mut self, out: &mut String) {
        let mut lost = vec![];
        for closure in self.model.closures() {
            let name = named(&closure.name);
            match &closure.condition {
                Condition::Points { at } => {
                    let text = self.points(at);
                    let _ =
                        writeln!(out, "<PointConstraint name=\"{name}\">{text}</PointConstraint>");
                }
                Condition::Distance { at, distance } => {
                    let text = self.points(at);
                    let distance = numbers([*distance]);
                    let _ = writeln!(
                        out,
                        "<ConstantDistanceConstraint name=\"{name}\">{text}\
                         <constant_distance>{distance}</constant_distance></ConstantDistanceConstraint>"
                    );
                }
                Condition::Frames { at } => {
                    let _ = write!(
                        out,
                        "<WeldConstraint name=\"{name}\"><socket_frame1>{name}_1</socket_frame1>\
                         <socket_frame2>{name}_2</socket_frame2><frames>"
                    );
                    for (number, (segment, frame)) in at.iter().enumerate() {
                        let base = self.frame(*segment);
                        offset(out, &format!("{name}_{}", number + 1), &base, frame);
                    }
                    out.push_str("</frames></WeldConstraint>\n");
                }
                Condition::Coupling { follower, driver, function } => {
                    let name_of = |id| {
                        let source = Source::Coordinate(id);
                        let place = self.tree.variables.iter().position(|v| v.source == source);
                        place.and_then(|place| self.coordinates.of_variable(place))
                    };
                    match (name_of(*follower), name_of(*driver)) {
                        (Some(follower), Some(driver)) => {
                            coupling::coupler(
                                out,
                                &name,
                                &function::one(function, false),
                                driver,
                                follower,
                            );
                        }
                        _ => lost.push(closure.name.clone()),
                    }
                }
            }
        }
        if !lost.is_empty() {
            let message = format!(
                "constraints of coordinates that move nothing are left out: {}",
                listed(lost)
            );
            self.remarks.push(Diagnostic::warning("osim/dropped", message));
        }
    }

    fn points(&self, at: &[(Option<SegmentId>, Vec3); 2]) -> String {
        let mut text = String::new();
        for (number, (segment, point)) in at.iter().enumerate() {
            let (number, frame) = (number + 1, self.frame(*segment));
            let point = numbers(point.to_array());
            let _ = write!(
                text,
                "<socket_body_{number}>{frame}</socket_body_{number}>\
                 <location_body_{number}>{point}</location_body_{number}>"
            );
        }
        text
    }

    fn remark(&mut self) {
        let unused: Vec<&str> = (0..self.tree.variables.len())
            .filter(|&place| self.coordinates.of_variable(place).is_none())
            .map(|place| self.tree.variables[place].name.as_str())
            .collect();
        if !unused.is_empty() {
            let message = format!("coordinates that move nothing are left out: {}", listed(unused));
            self.remarks.push(Diagnostic::warning("osim/dropped", message));
        }
        let holders = self.coordinates.holders().len();
        let extra = self.moved.iter().filter(|moved| !moved.whole).count();
        if holders + extra > 0 {
            self.remarks.push(Diagnostic::note(
                "osim/extra-bodies",
                format!(
                    "{extra} bodies stand between the joints of one segment, {holders} hold numbers that drive \
                     others; each has 0.1 g"
                ),
            ));
        }
    }
}

/// The values that a piece takes, and whether each is a function of one variable that can stand at its axis.
fn own_function(tree: &Tree, value: Value) -> Option<usize> {
    match tree.rules.rule(value) {
        Rule::Variable(place) => Some(*place),
        Rule::One(_, of) => match tree.rules.rule(*of) {
            Rule::Variable(place) => Some(*place),
            _ => None,
        },
        _ => None,
    }
}

fn body(out: &mut String, name: &str, mass: f64, inertia: f64) {
    let _ = writeln!(
        out,
        "<Body name=\"{name}\"><mass>{mass:?}</mass><mass_center>0 0 0</mass_center>\
         <inertia>{inertia:?} {inertia:?} {inertia:?} 0 0 0</inertia></Body>"
    );
}

fn offset(out: &mut String, name: &str, base: &str, frame: &Affine) {
    let _ = write!(
        out,
        "<PhysicalOffsetFrame name=\"{name}\"><socket_parent>{base}</socket_parent><translation>{}</translation>\
         <orientation>{}</orientation></PhysicalOffsetFrame>",
        numbers(frame.translation.to_array()),
        numbers(EulerOrder::XYZ.from_mat3(frame.linear)),
    );
}

/// A name without the characters that OpenSim refuses in names: its separators of paths, and blanks.
fn named(name: &str) -> String {
    let refused = |c: char| c.is_whitespace() || matches!(c, '\\' | '/' | '*' | '+');
    escaped(&name.chars().map(|c| if refused(c) { '_' } else { c }).collect::<String>())
}

#[cfg(test)]
mod tests {
    use condyle_model::{ModelBuilder, Range};

    /// OpenSim refuses a file whose default is outside a clamped range.
    #[test]
    fn a_default_outside_its_range_is_moved_to_its_end_and_said() {
        let mut b = ModelBuilder::new("arm");
        let forearm = b.segment("forearm", None);
        let (_, flexion) = b.hinge("elbow", forearm, "flexion", condyle_math::Vec3::Z);
        let coordinate = b.coordinate_mut(flexion);
        coordinate.range = Range::new(0.5, 2.5);
        coordinate.default = [0.25, 0.0, 0.0, 0.0];
        let read = super::write(&b.build().unwrap());
        assert!(read.value.contains("<default_value>0.5</default_value>"), "{}", read.value);
        assert!(read.warnings.iter().any(|w| w.code == "osim/default"), "{:?}", read.warnings);
    }
}
