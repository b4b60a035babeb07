//! Musculoskeletal models of OpenSim (`.osim`), as far as they describe the motion of bones.
//!
//! Two generations are read into the same [`Model`]. Files of version 4 keep a `JointSet` whose
//! joints name their frames by paths; older ones keep each joint inside the body that it moves:
//!
//! ```text
//! OpenSimDocument Version=4xxxx          OpenSimDocument Version=1xxxx … 3xxxx
//! └ Model                                └ Model
//!   ├ BodySet/objects/Body                 ├ BodySet/objects/Body
//!   ├ JointSet/objects/<X>Joint            │   └ Joint/<X>Joint: parent_body, location_in_parent, …
//!   │   ├ socket_parent_frame, …           ├ ConstraintSet/objects/<X>Constraint
//!   │   ├ coordinates/Coordinate           └ MarkerSet/objects/Marker: body, location
//!   │   └ frames/PhysicalOffsetFrame
//!   ├ ConstraintSet, MarkerSet
//! ```
//!
//! Between them, versions 3.05.00 to 3.05.04 name the bodies of a joint by connectors and state its ends
//! in numbers. Bodies, joints, constraints and markers count wherever they stand: in their sets, in sets
//! that are files of their own, and among the components of the model, of a body or of any other part.
//!
//! Every joint becomes a joint set of the same components as in other models: a pin is a `rotate`,
//! a custom joint a product of `translate` and `rotate` components whose numbers come from `map`
//! components, a coordinate coupler lets one coordinate follow another. Constraints that close
//! loops are kept as closures. Masses, muscles and forces are skipped without a warning; anything
//! that would change the motion and is not supported is an error or a warning.
//!
//! What moves a body, and what is made of it:
//!
//! | property | versions | here |
//! | --- | --- | --- |
//! | `location_in_parent`, `orientation_in_parent`, `location(_in_child)`, `orientation(_in_child)` of a joint | before 3.05.05 | the ends of the joint, in six digits as OpenSim keeps them; a warning in later versions |
//! | `translation`, `orientation` of a `PhysicalOffsetFrame` | since 3.05 | body-fixed xyz, then its place |
//! | points and axes of a `StationDefinedFrame` | since 4.5 | its stations may be markers |
//! | `reverse` of a joint | before 4 | the inverse motion; an error where that has no form |
//! | `TransformAxis`: coordinates, axis, function, `is_rotation` | all | of the functions named in the error for others |
//! | `scale` of a `MultiplierFunction`, nested too | since 2 | multiplies |
//! | `scale_factors` of a joint | before 2 | stretch translations that are functions; a warning in later versions |
//! | `scale_factors` of a body | all | of its geometry alone: nothing moves |
//! | `radii_x_y_z`, `thoracic_ellipsoid_radii_x_y_z`, winging, `neutral_angle_x_z_y`, `length` | since 3 | the surface or arc of the joint |
//! | `default_value`, once `initial_value` | all | the default |
//! | `range`, `clamped` | all | bounds that tracking enforces only where clamped |
//! | `locked` | all | held at its default |
//! | `prescribed`, `prescribed_function` | all | locked at its value where that is a constant, else at the default with a warning |
//! | `motion_type` | before 4 | determined anew from the axes, as OpenSim does |
//! | `is_free_to_satisfy_constraints` | since 3 | nothing: tracking moves every coordinate that is not locked |
//! | couplers: dependent, independents, function, `scale_factor` | all | the dependent follows; one that closes a circle is a closure |
//! | `PointConstraint`, `WeldConstraint`, `ConstantDistanceConstraint` | all | closures |
//! | other constraints, such as rolling and points on lines | all | a warning with their number |
//! | `isDisabled`, `isEnforced` of a constraint | all | left out as stated |
//! | `length_units` | all | a warning unless metres |
//! | joints that close a loop, bodies without a joint | all | a copy and a closure; a free joint: each a warning |
//! | coordinates, axes, joints that nothing takes | all | a warning for each class with their number |

mod constraint;
pub(super) mod frame;
pub(super) mod function;
pub(super) mod include;
pub(super) mod joint;
mod joint_graph;

use crate::Include;
use crate::xml::{Element, XmlDocument};
use condyle_diagnostics::{Diagnostic, Error, Place, Read, Severity, Warnings};
use condyle_math::Vec3;
use condyle_model::model::{AXIS_LENGTH, LOOKS_LIKE_DEGREES};
use condyle_model::{CoordinateKind, Model, ModelBuilder, SegmentId};
use frame::Frames;
use std::collections::HashSet;

/// Reads a model from the bytes of an `.osim` file. Sets in files of their own are not read:
/// [`Format::read`](crate::Format::read) asks for these.
///
/// # Errors
/// What is wrong, with its line: not XML, not a model, names that are unknown or cyclic, joints or
/// functions that are not known, lists of the wrong length.
///
/// ```
/// let text = r#"<OpenSimDocument Version="40000"><Model name="arm">
///   <BodySet><objects><Body name="forearm"/></objects></BodySet>
///   <JointSet><objects><PinJoint name="elbow">
///     <socket_parent_frame>/ground</socket_parent_frame>
///     <socket_child_frame>/bodyset/forearm</socket_child_frame>
///     <coordinates><Coordinate name="flexion"><range>0 2.5</range></Coordinate></coordinates>
///   </PinJoint></objects></JointSet></Model></OpenSimDocument>"#;
/// let model = condyle_formats::opensim::model::read(text.as_bytes())?.value;
/// assert_eq!(model.coordinates()[0].range.upper, Some(2.5));
/// # Ok::<(), condyle_formats::Error>(())
/// ```
pub fn read(bytes: &[u8]) -> Result<Read<Model>, Error> {
    from_document(XmlDocument::from_bytes(bytes)?, &mut |_| Err("it is not given".to_owned()))
}

/// The model's element, bare or in its document.
pub(super) fn of(root: Element<'_>) -> Option<Element<'_>> {
    if root.is("Model") { Some(root) } else { root.child("Model") }
}

pub(super) fn from_document(
    document: Read<XmlDocument>,
    include: &mut Include<'_>,
) -> Result<Read<Model>, Error> {
    let document = include::put_in(document, include)?;
    let mut warnings = Warnings::default();
    warnings.extend(document.warnings);
    let root = document.value.root();
    let model = of(root).ok_or_else(|| {
        root.error("osim/no-model", format!("{} holds no <Model>", root.describe()))
            .with_help("give an OpenSim model, not a setup or a results file")
    })?;
    let model = from_element(model, &mut warnings)?;
    Ok(Read { value: model, warnings: warnings.finish() })
}

/// The model of an element that has all its sets inside.
pub(super) fn from_element(element: Element<'_>, warnings: &mut Warnings) -> Result<Model, Error> {
    Reader::new(element, warnings)?.read()
}

/// The model file while it is read.
struct Reader<'d, 'w> {
    element: Element<'d>,
    builder: ModelBuilder,
    frames: Frames<'d>,
    warnings: &'w mut Warnings,
    /// The version of the file, such as 30505; `None` if it does not say.
    version: Option<u32>,
    /// Parts that were taken into the model, or left out with a reason that was said.
    used: HashSet<u32>,
}

impl<'d, 'w> Reader<'d, 'w> {
    fn new(element: Element<'d>, warnings: &'w mut Warnings) -> Result<Self, Error> {
        let mut builder = ModelBuilder::new(element.attribute("name").unwrap_or("model"));
        let frames = Frames::collect(element, &mut builder)?;
        let version = element.parent().and_then(|root| root.attribute("Version"));
        let version = version.and_then(|version| version.trim().parse().ok());
        Ok(Self { element, builder, frames, warnings, version, used: HashSet::new() })
    }

    fn read(mut self) -> Result<Model, Error> {
        let joints = joint_graph::collect(&mut self)?;
        for joint in &joints {
            joint::build(&mut self, joint)?;
        }
        constraint::read_all(&mut self)?;
        self.markers()?;
        self.say_unused();
        self.length_unit();
        let line = self.element.place();
        let built = self.builder.build_with_warnings();
        let Read { value: model, warnings } = built.map_err(|error| at_model(error, line))?;
        warn_of_degrees(&model, self.element, self.warnings);
        let directions = directions(&model);
        if directions > MOST_DIRECTIONS {
            let message =
                format!("the model has {directions} pairs of a segment and a direction of motion");
            return Err(Error::new("osim/size", message)
                .with_help(format!("at most {MOST_DIRECTIONS} are allowed; use fewer bodies"))
                .at(line));
        }
        self.warnings.extend(warnings.into_iter().filter(|w| w.code != AXIS_LENGTH).collect());
        Ok(model)
    }

    /// OpenSim itself takes all lengths of a model as metres.
    fn length_unit(&mut self) {
        let Some(unit) = self.element.child("length_units") else { return };
        if !matches!(
            unit.text().to_ascii_lowercase().as_str(),
            "" | "unassigned" | "m" | "meters" | "metres" | "meter"
        ) {
            let message = format!("the unit of length is stated as `{}`", unit.text());
            self.warn(
                "osim/length-unit",
                unit,
                message,
                "lengths are taken as metres, as in OpenSim",
            );
        }
    }

    fn warn(
        &mut self,
        code: &'static str,
        at: Element<'_>,
        message: impl Into<String>,
        help: &str,
    ) {
        let said = Diagnostic::warning(code, message).at(at.place()).with_help(help);
        self.warnings.push(said);
    }

    /// The parts of a class wherever they stand, in file order: in their set, among the components of
    /// the model, of a body or of any other part.
    fn parts(&self, is_class: impl Fn(&str) -> bool) -> Vec<Element<'d>> {
        let parts = self.element.descendants().filter(|e| is_class(e.name()));
        parts.filter(|e| !frame::is_default(*e)).collect()
    }

    /// Notes that a part is in the model, or that it was said why it is not.
    fn uses(&mut self, element: Element<'_>) {
        self.used.insert(element.number());
    }

    fn markers(&mut self) -> Result<(), Error> {
        let mut seen = HashSet::new();
        for element in self.parts(|class| class == "Marker") {
            self.uses(element);
            let name = element.attribute("name").unwrap_or_default().to_owned();
            if !seen.insert(name.clone()) {
                self.warn(
                    "osim/duplicate-marker",
                    element,
                    format!("a second marker is named `{name}`"),
                    "the first one is used",
                );
                continue;
            }
            let (base, point) = self.frames.point(element)?;
            self.builder.marker(&name, base, point);
        }
        Ok(())
    }

    /// Says of each class that moves something how many of its parts were not used.
    fn say_unused(&mut self) {
        let unused: Vec<Element<'d>> = self
            .parts(is_kinematic)
            .into_iter()
            .filter(|e| !self.used.contains(&e.number()))
            .collect();
        self.say_of_each_class(
            &unused,
            "osim/unused",
            "not used",
            "they stand where OpenSim looks for none, or exceed what the joint takes",
        );
    }

    /// One warning for each class among these, with their number and the first names.
    fn say_of_each_class(
        &mut self,
        elements: &[Element<'d>],
        code: &'static str,
        what: &str,
        help: &str,
    ) {
        let mut classes: Vec<&str> = elements.iter().map(|e| e.name()).collect();
        classes.sort_unstable();
        classes.dedup();
        for class in classes {
            let all: Vec<Element<'d>> = elements.iter().copied().filter(|e| e.is(class)).collect();
            let names = all.iter().filter_map(|e| e.attribute("name"));
            let mut names: Vec<String> = names
                .filter(|n| !n.is_empty())
                .take(NAMES_SAID)
                .map(|n| format!("`{n}`"))
                .collect();
            if names.len() < all.len() && !names.is_empty() {
                names.push("…".to_owned());
            }
            let list =
                if names.is_empty() { String::new() } else { format!(": {}", names.join(", ")) };
            let message = format!("{} <{class}> {what}{list}", all.len());
            if let Some(first) = all.first() {
                self.warn(code, *first, message, help);
            }
        }
    }
}

/// How many names a warning lists.
const NAMES_SAID: usize = 5;

/// Whether parts of this class move something: all of them must be accounted for.
fn is_kinematic(class: &str) -> bool {
    is_joint(class)
        || is_constraint(class)
        || matches!(class, "Marker" | "Coordinate" | "TransformAxis")
}

pub(super) fn is_joint(class: &str) -> bool {
    class.ends_with("Joint") && class != "Joint"
}

fn is_constraint(class: &str) -> bool {
    class.ends_with("Constraint") && class != "Constraint"
}

/// The errors of a model that contradicts itself, at its element.
fn at_model(error: Error, line: Place) -> Error {
    let errors = error.into_diagnostics().into_iter().filter(|f| f.severity == Severity::Error);
    let located = errors.map(|error| error.at(line)).take(50).collect();
    let unsaid = || Error::new("osim/model", "the model cannot be built").at(line);
    Error::of(located).unwrap_or_else(unsaid).contradiction()
}

/// Angles in a model are radians: a range of several turns up to 360 was probably given in degrees.
fn warn_of_degrees(model: &Model, element: Element<'_>, warnings: &mut Warnings) {
    let turns = 4.0 * std::f64::consts::PI..=360.0;
    for coordinate in model.coordinates() {
        let range = coordinate.range;
        let most =
            [range.lower, range.upper].into_iter().flatten().map(f64::abs).fold(0.0, f64::max);
        if coordinate.kind != CoordinateKind::Rotation || !turns.contains(&most) {
            continue;
        }
        let stated = element.descendants().filter(|e| e.is("Coordinate"));
        let here = stated.into_iter().find(|e| e.attribute("name") == Some(&coordinate.name));
        let message = format!("the range of `{}` reaches {most} radians", coordinate.name);
        let place = here.unwrap_or(element).place();
        warnings.push(
            Diagnostic::warning(LOOKS_LIKE_DEGREES, message)
                .at(place)
                .with_help("is it in degrees? the file's angles must be in radians"),
        );
    }
}

/// How many pairs of a segment and a direction that moves it a model may have.
const MOST_DIRECTIONS: usize = 4_000_000;

/// Directions that move a segment, counted over all segments: what a Jacobian holds.
fn directions(model: &Model) -> usize {
    let mut own = vec![0usize; model.joint_sets().len()];
    for coordinate in model.coordinates() {
        own[coordinate.joint_set.index()] += coordinate.kind.tangent();
    }
    let mut below: Vec<Option<usize>> = vec![None; model.segments().len()];
    let mut path = vec![];
    for start in model.segment_ids() {
        let mut here = Some(start);
        while let Some(id) = here.filter(|id| below[id.index()].is_none()) {
            path.push(id);
            here = model.segment(id).parent;
        }
        let mut sum = here.and_then(|id| below[id.index()]).unwrap_or(0);
        while let Some(id) = path.pop() {
            sum += model.segment(id).joint_set.map_or(0, |set| own[set.index()]);
            below[id.index()] = Some(sum);
        }
    }
    below.into_iter().flatten().sum()
}

/// The world or one of the model's segments.
pub(super) type Base = Option<SegmentId>;

/// A finite triple of numbers, or its default.
pub(super) fn triple(element: Element<'_>, name: &str) -> Result<Vec3, Error> {
    let found = Vec3::from(element.child_numbers::<3>(name)?.unwrap_or_default());
    if found.is_finite() {
        return Ok(found);
    }
    let at = element.child(name).unwrap_or(element);
    Err(at
        .error("osim/not-finite", format!("<{name}> of {} is not finite", element.describe()))
        .with_help("give three numbers that are neither NaN nor infinite"))
}
