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
//! Every joint becomes a joint set of the same components as in other models: a pin is a `rotate`,
//! a custom joint a product of `translate` and `rotate` components whose numbers come from `map`
//! components, a coordinate coupler lets one coordinate follow another. Constraints that close
//! loops are kept as closures. Masses, muscles and forces are skipped without a warning; anything
//! that would change the motion and is not supported is an error or a warning.

mod constraint;
mod frame;
mod function;
mod joint;
mod joint_graph;

use crate::xml::{Element, XmlDocument};
use condyle_diagnostics::{Diagnostic, Error, Place, Read, Severity, Warnings};
use condyle_math::Vec3;
use condyle_model::model::{AXIS_LENGTH, LOOKS_LIKE_DEGREES};
use condyle_model::{CoordinateKind, Model, ModelBuilder, SegmentId};
use frame::Frames;

/// Reads a model from the bytes of an `.osim` file.
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
    from_document(XmlDocument::from_bytes(bytes)?)
}

/// The model's element, bare or in its document.
pub(super) fn of(root: Element<'_>) -> Option<Element<'_>> {
    if root.is("Model") { Some(root) } else { root.child("Model") }
}

pub(super) fn from_document(document: Read<XmlDocument>) -> Result<Read<Model>, Error> {
    let mut warnings = Warnings::default();
    warnings.extend(document.warnings);
    let root = document.value.root();
    let model = of(root).ok_or_else(|| {
        root.error("osim/no-model", format!("{} holds no <Model>", root.describe()))
            .with_help("give an OpenSim model, not a setup or a results file")
    })?;
    let model = Reader::new(model, &mut warnings)?.read()?;
    Ok(Read { value: model, warnings: warnings.finish() })
}

/// The model file while it is read.
struct Reader<'d, 'w> {
    element: Element<'d>,
    builder: ModelBuilder,
    frames: Frames<'d>,
    warnings: &'w mut Warnings,
}

impl<'d, 'w> Reader<'d, 'w> {
    fn new(element: Element<'d>, warnings: &'w mut Warnings) -> Result<Self, Error> {
        let mut builder = ModelBuilder::new(element.attribute("name").unwrap_or("model"));
        let frames = Frames::collect(element, &mut builder)?;
        Ok(Self { element, builder, frames, warnings })
    }

    fn read(mut self) -> Result<Model, Error> {
        let joints = joint_graph::collect(&mut self)?;
        for joint in &joints {
            joint::build(&mut self, joint)?;
        }
        constraint::read_all(&mut self)?;
        self.markers()?;
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

    /// All elements `kind` of the set of that name, in order.
    fn set_objects(&self, set: &str) -> Vec<Element<'d>> {
        self.element
            .children_named(set)
            .flat_map(|set| set.child("objects").into_iter().chain(Some(set)))
            .flat_map(|list| list.children())
            .filter(|e| !matches!(e.name(), "objects" | "groups" | "defaults"))
            .collect()
    }

    fn markers(&mut self) -> Result<(), Error> {
        let mut seen = std::collections::HashSet::new();
        for element in self.set_objects("MarkerSet") {
            if !element.is("Marker") {
                continue;
            }
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
            let point = triple(element, "location")?;
            let (base, frame) = self.frames.of_part(element, "parent_frame", "body")?;
            self.builder.marker(&name, base, frame * point);
        }
        Ok(())
    }
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
type Base = Option<SegmentId>;

/// A finite triple of numbers, or its default.
fn triple(element: Element<'_>, name: &str) -> Result<Vec3, Error> {
    let found = Vec3::from(element.child_numbers::<3>(name)?.unwrap_or_default());
    if found.is_finite() {
        return Ok(found);
    }
    let at = element.child(name).unwrap_or(element);
    Err(at
        .error("osim/not-finite", format!("<{name}> of {} is not finite", element.describe()))
        .with_help("give three numbers that are neither NaN nor infinite"))
}
