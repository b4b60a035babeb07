//! Model documents: a model as a person writes it, in TOML 1.0.
//!
//! ```text
//! document   = condyle = 1, kind = "model", name, up = "y"|"z", angles = "deg"|"rad",
//!              include = ["other.toml"], constants, mirror, and the tables below
//! segment.S  = parent, at, turn, order, matrix (the joint in the parent),
//!              joint_at, joint_turn, joint_order, joint_matrix (the joint in itself)
//! joint.J    = segment, type and what that takes, coordinates, coordinate.C
//! joint_set.J.coordinate.C   = kind, default, range, enforced, locked, unit, source, follows
//! joint_set.J.component.K.X  = the inputs and parameters of a component of kind X
//! joint_set.J.output         = SEGMENT = "K", or a list of factors
//! marker.M   = segment, at
//! size.G     = segments (that grow together when a figure is scaled)
//! closure.L  = points (and distance), frames, or coupling
//! port       = "name" in the same joint set, "set.name" elsewhere, ".2" for a second output
//! function   = number | { constant|linear|ends|polynomial|spline|lines = ..., factor = ... }
//! number     = a number, or a product of numbers and constants: "$name", "-0.5 * $name"
//! ```
//!
//! The manual with examples is in `docs/model-format/`. Lengths are metres; angles are radians, or
//! degrees where the document says so; arguments and values of functions are radians and metres
//! unless their `in` and `out` say otherwise.
//!
//! [`read`] reports everything that is wrong at once, each with its line and column: wrong types,
//! unknown keys and names with the nearest known one, missing inputs, names given twice, and what
//! [`ModelBuilder`](condyle_model::ModelBuilder) finds. No input makes it panic, and nothing
//! recurses deeper than the parser's own bound. A [`Document`] keeps the text it was read from, so
//! that saving it loses nothing; [`write()`] writes a model that never was text, expanded.

mod draft;
mod fields;
mod function;
mod joint;
mod keys;
mod law;
mod mirror;
mod read;
mod render;
mod resolve;
mod source;
mod tree;
mod write;

pub use keys::keys;
pub use render::render;
pub use write::write;

use condyle_diagnostics::{Error, Read};
use condyle_model::Model;
use condyle_model::component::Registry;
use fields::Reader;
use source::Texts;
use std::collections::HashMap;

/// A model document: what it says, and how it says it.
#[derive(Clone, Debug, PartialEq)]
pub struct Document {
    /// The model, with all that is included, named once, or mirrored worked out.
    pub model: Model,
    /// The text, comments and all. Saving a document writes this.
    pub source: String,
}

impl Document {
    /// A document of a model that never was text.
    #[must_use]
    pub fn of(model: Model) -> Self {
        let source = write(&model);
        Self { model, source }
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
/// use condyle_model::component::{Law, Registry};
///
/// /// A bone that is lifted with the square of an angle.
/// #[derive(Debug)]
/// struct Lift(f64);
/// impl Law for Lift {
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
    let mut sources = Texts::default();
    let model = tree::load(&mut sources, text, include).and_then(|entries| {
        let mut reader = Reader { sources: &mut sources, constants: HashMap::new(), laws };
        let draft = reader.draft(entries);
        resolve::build(draft, &mut sources)
    });
    let warnings = sources.finish()?;
    match model {
        Some(model) => Ok(Read { value: Document { model, source: text.to_owned() }, warnings }),
        None => Err(Error::new("model/unknown", "the document holds no model")),
    }
}
