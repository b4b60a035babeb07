//! Documents that people write, in TOML 1.0. There are several kinds, each with its own tables.
//!
//! ```text
//! document   = condyle = 1, kind = "model"|..., name, angles = "deg"|"rad",
//!              include = ["other.toml"], constants, and the tables of its kind
//! template.T = parameters, defaults, instances, and tables of its kind (of models only)
//! function   = number | { constant|linear|ends|polynomial|spline|lines = ..., factor = ... }
//! number     = a number, or a sum of products of numbers and constants: "$name", "-0.5 * $name"
//! ```
//!
//! This folder holds what all kinds share: the tree of values with their places, included texts,
//! templates, typed access to fields, numbers with units, functions, and messages shown beside the text. It
//! knows nothing of any kind. [`model`] is the kind that describes models; its functions are
//! available here, too. [`setup`] is how recordings are tracked, [`names`] what their labels are called
//! in models, [`goals`] what a pose should do, [`recipe`] which markers give the orientation of a segment,
//! [`limit`] which rotations of a segment in another are possible, [`law`] how coordinates follow others,
//! [`landmarks`] where such a law is carried to. [`kind()`] tells the kind of a text.
//! `edit` (a feature) changes single numbers of a model's text.
//!
//! Reading reports everything that is wrong at once, each with its line and column. Its codes are
//! `document/...` for what all kinds share, such as a missing key or a wrong type, and `KIND/...`
//! for what only that kind can get wrong. No input makes it panic, and nothing recurses deeper than
//! a fixed bound.
//!
//! A new kind needs a [`Kind`], a folder beside [`model`] with its `Form`, and a function that
//! reads its fields with the `Reader` from `read_kind`.

#[cfg(feature = "edit")]
pub mod edit;
mod fields;
mod findings;
mod function;
pub mod goals;
mod head;
mod include;
pub mod landmarks;
pub mod law;
pub mod limit;
pub mod model;
pub mod names;
mod number;
pub mod recipe;
mod region;
mod render;
pub mod setup;
mod template;
#[cfg(test)]
mod tests;
mod texts;
mod tree;
mod words;

pub use head::{Kind, kind};
pub use include::includes;
pub use model::{Document, keys, read, read_with, write};
pub use render::render;

use condyle_diagnostics::{Error, Read};
use fields::{Fields, Reader};
use std::collections::HashMap;
use texts::{Spot, Texts};
use tree::{Node, Value};

/// What the generic reader must know of a kind of document.
struct Form {
    kind: Kind,
    /// The keys at the top of a document, beside those of [`head::HEAD`].
    keys: &'static [&'static str],
    /// Those of them that are ignored in an included text.
    own: &'static [&'static str],
    /// Those of them whose tables a template may hold; none if this kind has no templates.
    repeated: &'static [&'static str],
}

/// Reads a document of one kind: its texts are merged and its head and constants read, then `read`
/// makes a value of its fields. `None` of `read` means that it reported an error.
fn read_kind<T>(
    form: &Form,
    text: &str,
    include: &mut dyn FnMut(&str) -> Result<String, String>,
    read: impl FnOnce(Reader<'_>, &Fields<'_>) -> Option<T>,
) -> Result<Read<T>, Error> {
    let mut texts = Texts::default();
    let value = include::load(&mut texts, form, text, include).and_then(|entries| {
        let mut reader = Reader {
            texts: &mut texts,
            constants: HashMap::new(),
            given: HashMap::new(),
            include: &mut *include,
        };
        if let Some(constants) = entries.iter().find(|e| e.key.text == "constants") {
            reader.define(&constants.node);
        }
        let entries = match form.repeated {
            [] => entries,
            repeated => template::expand(&mut reader, repeated, entries)?,
        };
        let root = Node { value: Value::Table(entries), spot: Spot::default() };
        let known = [head::HEAD, form.keys].concat();
        let top = reader.table(&root, root.spot, String::new(), &known);
        read(reader, &top)
    });
    let warnings = texts.finish()?;
    match value {
        Some(value) => Ok(Read { value, warnings }),
        None => Err(Error::new("document/unreadable", "the document could not be read")),
    }
}
