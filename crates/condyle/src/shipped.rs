//! The models that come with the library, by name.
//!
//! Each is a text that a person wrote, with the source of its numbers; what it is and how many
//! coordinates it has stands in `docs/shipped-models.md`. Texts that include others find them here
//! by file name. Where a model is asked for by path, as in [`open::model`](crate::open::model), the
//! name of a shipped one does as well.
//!
//! ```
//! use condyle::{open, shipped};
//! use std::path::Path;
//! assert!(shipped::names().any(|name| name == "spine"));
//! let spine = open::model(Path::new("spine")).unwrap().value;
//! assert!(spine.find_segment("skull").is_ok());
//! ```

use condyle_formats::document::{self, Document};
use condyle_formats::{Diagnostic, Read};
use std::path::Path;

/// Name and text of every shipped model, by name.
const MODELS: &[(&str, &str)] = &[
    ("arms", include_str!("../models/arms.toml")),
    ("knee", include_str!("../models/knee.toml")),
    ("knee-three-rotations", include_str!("../models/knee-three-rotations.toml")),
    ("legs", include_str!("../models/legs.toml")),
    ("spine", include_str!("../models/spine.toml")),
    ("spine-shao2003", include_str!("../models/spine-shao2003.toml")),
];

/// The names of all shipped models, in alphabetical order.
pub fn names() -> impl Iterator<Item = &'static str> {
    MODELS.iter().map(|(name, _)| *name)
}

/// The text of a shipped model as it was written, comments and all; none if there is none of that
/// name.
pub fn text(name: &str) -> Option<&'static str> {
    MODELS.iter().find(|(known, _)| *known == name).map(|(_, text)| *text)
}

/// A shipped model with all that it includes; none if there is none of that name.
///
/// # Errors
/// Everything that is wrong with its text.
pub fn document(name: &str) -> Option<Result<Read<Document>, Vec<Diagnostic>>> {
    let text = text(name)?;
    Some(document::read(text, &mut |file| included(file).map(str::to_owned)))
}

/// A text of a shipped model that needs no other: the text itself where it includes none, else its
/// head of comments and the whole model, written out.
///
/// # Errors
/// Everything that is wrong with its text.
pub fn standalone(name: &str) -> Option<Result<String, Vec<Diagnostic>>> {
    let text = text(name)?;
    let mut parts: Vec<String> = vec![];
    let read = document::read(text, &mut |file| {
        parts.push(file.to_owned());
        included(file).map(str::to_owned)
    });
    Some(read.map(|read| {
        if parts.is_empty() {
            return read.value.source;
        }
        let head: String =
            text.lines().take_while(|l| l.starts_with('#')).map(|l| format!("{l}\n")).collect();
        let parts = parts.join(", ");
        let model = document::write(&read.value.model);
        format!("{head}#\n# Written out with {parts}, in metres and radians.\n{model}")
    }))
}

/// The text of an included file: another shipped model.
fn included(file: &str) -> Result<&'static str, String> {
    file.strip_suffix(".toml").and_then(text).ok_or_else(|| format!("no model `{file}` is shipped"))
}

/// The name that a path is if it is no file but may be a shipped model: one word without an ending.
pub(crate) fn asked(path: &Path) -> Option<&str> {
    let name = path.to_str()?;
    let word =
        !name.is_empty() && name.chars().all(|c| c.is_alphanumeric() || c == '-' || c == '_');
    (word && !path.exists()).then_some(name)
}
