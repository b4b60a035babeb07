//! Documents of kind `model`: segments, joints, and markers.
//!
//! ```text
//! document   = the head of every document, up = "y"|"z", facing = "+x"|"-x"|"+z"|"-z", mirror, and the tables below
//! segment.S  = parent, at, turn, order, matrix (the joint in the parent),
//!              joint_at, joint_turn, joint_order, joint_matrix (the joint in the segment)
//! joint.J    = segment, type and the keys of that type, coordinates, coordinate.C
//! joint_set.J.coordinate.C   = kind, default, range, enforced, locked, drives, unit, source,
//!                              follows, rest, stiffness
//! joint_set.J.component.K.X  = the inputs and parameters of a component of kind X
//! joint_set.J.output         = SEGMENT = "K", or a list of factors
//! marker.M   = segment, at
//! size.G     = segments (that are scaled by one factor)
//! closure.L  = points (and distance), frames, or coupling
//! posture.P  = sum (coordinates with factors), rest, stiffness, source
//! template.T = parameters, defaults, instances, and any of the tables above to repeat
//! port       = "name" in the same joint set, "set.name" in another, ".2" for a second output
//! ```
//!
//! The manual with examples is in `docs/model-format/`. Lengths are metres; angles are radians, or
//! degrees where the document says so; arguments and values of functions are radians and metres
//! unless their `in` and `out` say otherwise.
//!
//! [`read`] reports wrong types, unknown keys and names with the nearest known one, missing inputs,
//! duplicate names, and what [`ModelBuilder`](condyle_model::ModelBuilder) finds. A [`Document`]
//! keeps the text it was read from, so that saving it loses nothing; [`write()`] writes any model,
//! with everything expanded.

mod draft;
mod joint;
mod keys;
mod mirror;
mod read;
mod resolve;
mod write;

pub use keys::keys;
pub use write::write;
pub(super) use write::{function, number, numbers, several_of, text};

use self::read::ModelReader;
use super::{Form, Kind, read_kind};
use condyle_diagnostics::{Diagnostic, Error, Place, Read, Subject};
use condyle_model::Model;
use condyle_model::component::Registry;
use std::collections::HashMap;

const FORM: Form =
    Form { kind: Kind::Model, keys: keys::TOP, own: &["up", "facing"], repeated: keys::REPEATED };

/// A model document: the model, and the text that describes it.
#[derive(Clone, Debug, PartialEq)]
pub struct Document {
    /// The model, with includes, constants, templates and the mirrored side resolved.
    pub model: Model,
    /// The text, comments and all. Saving a document writes this.
    pub text: String,
    /// Where each part of the model stands.
    places: HashMap<Subject, Origin>,
}

/// Where a part of a model stands in its document.
#[derive(Clone, Debug, PartialEq)]
struct Origin {
    /// In the document itself; of an included text, the line that includes it.
    place: Place,
    /// In the included text, as `file:line:column: `; empty where it stands in the document itself.
    included: String,
}

impl Document {
    /// A document of a model that was not read from text.
    #[must_use]
    pub fn of(model: Model) -> Self {
        let text = write(&model);
        Self { model, text, places: HashMap::new() }
    }

    /// Adds to what is said about a part of the model where it stands in the text.
    pub fn locate(&self, said: &mut Diagnostic) {
        if said.place.is_some() {
            return;
        }
        if let Some(origin) = said.subjects.iter().find_map(|subject| self.places.get(subject)) {
            said.place = Some(origin.place);
            said.message.insert_str(0, &origin.included);
        }
    }
}

/// Reads a model document. `include` gives the text of another one by its path, as seen from the
/// place of this one; an error of it is a sentence.
///
/// # Errors
/// Everything that is wrong, in the order of the text.
///
/// ```
/// use condyle_formats::document;
/// let text = r#"
/// condyle = 1
/// kind = "model"
/// angles = "deg"
///
/// [segment.thigh]
/// [segment.shank]
/// parent = "thigh"
/// at = [0, -0.42, 0]
///
/// [joint.knee]
/// type = "hinge"
/// segment = "shank"
/// axis = [0, 0, -1]
/// coordinate.angle = { range = [0, 140] }
/// "#;
/// let document = document::read(text, &mut |_| Err("there is none".into())).unwrap().value;
/// let range = document.model.coordinates()[0].range;
/// assert_eq!(range.upper, Some(140f64.to_radians()));
///
/// let wrong = text.replace("parent", "parnet");
/// let errors = document::read(&wrong, &mut |_| Err("there is none".into())).unwrap_err();
/// assert_eq!(
///     errors[0].to_string(),
///     "line 8, column 1: unknown key `parnet` in [segment.shank] (did you mean `parent`?)",
/// );
/// ```
pub fn read(
    text: &str,
    include: &mut dyn FnMut(&str) -> Result<String, String>,
) -> Result<Read<Document>, Error> {
    read_with(text, include, &Registry::default())
}

/// Reads a model document whose components of kind `custom` name these laws.
///
/// # Errors
/// As [`read`], and laws that are not registered, or not with these parameters.
///
/// ```
/// use condyle_formats::document;
/// use condyle_math::{Affine, Scalar, Vec3};
/// use condyle_model::component::{MotionLaw, Registry};
///
/// /// A bone that is lifted with the square of an angle.
/// #[derive(Debug)]
/// struct Lift(f64);
/// impl MotionLaw for Lift {
///     fn transform<S: Scalar>(&self, inputs: &[S]) -> Affine<S> {
///         let height = inputs[0] * inputs[0] * S::from_f64(self.0);
///         Affine::from_translation(Vec3::new(S::zero(), height, S::zero()))
///     }
/// }
/// let mut laws = Registry::default();
/// laws.register("lift", &["angle"], |parameters| {
///     let height = parameters.get("height").and_then(|list| list.first());
///     Ok(Lift(*height.ok_or("it needs a `height` in metres")?))
/// });
///
/// let text = r#"
/// condyle = 1
/// kind = "model"
/// [segment.scapula]
/// [joint_set.girdle.coordinate.elevation]
/// [joint_set.girdle.component.raise.custom]
/// law = "lift"
/// inputs = ["elevation"]
/// parameters = { height = 0.02 }
/// [joint_set.girdle.output]
/// scapula = "raise"
/// "#;
/// let mut alone = |_: &str| Err("it stands alone".into());
/// assert!(document::read_with(text, &mut alone, &laws).is_ok());
/// let errors = document::read(text, &mut alone).unwrap_err();
/// assert!(errors[0].to_string().starts_with("line 7, column 7: no law `lift` is registered"));
/// ```
pub fn read_with(
    text: &str,
    include: &mut dyn FnMut(&str) -> Result<String, String>,
    laws: &Registry,
) -> Result<Read<Document>, Error> {
    let read = read_kind(&FORM, text, include, |reader, top| {
        let mut reader = ModelReader { reader, laws: laws.clone(), fields: HashMap::new() };
        let draft = reader.draft(top);
        resolve::build(draft, reader.texts)
    })?;
    Ok(read.map(|(model, places)| Document { model, text: text.to_owned(), places }))
}

/// Reads a model document together with the places of its numbers.
#[cfg(feature = "edit")]
pub(super) fn read_edited(
    text: &str,
    include: &mut dyn FnMut(&str) -> Result<String, String>,
) -> Result<(Document, super::edit::Found), Error> {
    let read = read_kind(&FORM, text, include, |reader, top| {
        let (laws, fields) = (Registry::default(), HashMap::new());
        let mut reader = ModelReader { reader, laws, fields };
        let draft = reader.draft(top);
        let found = match reader.reader.texts.failed() {
            true => super::edit::Found::default(),
            false => super::edit::gather(&mut reader.reader, top),
        };
        resolve::build(draft, reader.reader.texts).map(|built| (built, found))
    })?;
    let ((model, places), found) = read.value;
    Ok((Document { model, text: text.to_owned(), places }, found))
}
