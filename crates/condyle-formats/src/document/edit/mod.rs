//! Editing a model document in its text: one number changes, and every other byte stays.
//!
//! [`Editing::read`] reads a document with all that it includes and lists every number that can be changed, an
//! [`Editable`] each: its path in the document, its value and unit, where it stands, where it comes from ([`Origin`]),
//! and the [`Way`]s to change it, each with a sentence that says what would be written where. [`Editing::set`] computes
//! such a change and reads the document anew with it: what could not be read any more is refused, and nothing is changed.
//! [`Editing::put`] gives a key any value, such as a wire or a whole component. Nothing here touches a file.
//!
//! ```text
//! at = [0, -0.42, 0]             plain: the number
//! at = [0, "-0.98 * $shank", 0]  the factor, or the constant, or a number instead of the expression
//! at = [0, "$height", 0]         in a template: the value in the row of the instance
//! (in an included text)          that text, or a line of the document itself that stands in its place
//! (of the mirrored side)         the written side; both change
//! ```

mod change;
mod expression;
mod leaf;
mod put;
mod unit;
mod way;

pub use change::{Change, Edited, Refused};
pub use way::{Origin, Way, WayKind};

use super::Document;
use super::model::read_edited;
use condyle_diagnostics::Error;
pub(super) use leaf::{Found, gather};
use std::collections::HashMap;
use std::fmt;

/// A step of a path into a document: a key, or a position in a list counted from 0.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub enum Step {
    /// A key of a table.
    Key(String),
    /// A position in a list.
    Index(usize),
}

impl fmt::Display for Step {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Key(key) => f.write_str(key),
            Self::Index(index) => write!(f, "{index}"),
        }
    }
}

/// A path as people read it: `segment.shank.at[1]`.
#[must_use]
pub fn shown(path: &[Step]) -> String {
    let mut text = String::new();
    for step in path {
        match step {
            Step::Key(key) if text.is_empty() => text.push_str(key),
            Step::Key(key) => text.push_str(&format!(".{key}")),
            Step::Index(index) => text.push_str(&format!("[{index}]")),
        }
    }
    text
}

/// A number of a document that can be changed.
#[derive(Clone, Debug, PartialEq)]
pub struct Editable {
    /// Its place among the tables of the document, with includes and templates filled in.
    pub path: Vec<Step>,
    /// Its value, in its unit.
    pub value: f64,
    /// `m`, `cm`, `mm`, `deg` or `rad`; `1` for a ratio or a component of a direction; empty where the text does not
    /// tell, as for the argument of a function without `in`, which is in radians or metres.
    pub unit: &'static str,
    /// The text in which it stands, by its path from the document; empty for the document itself.
    pub file: String,
    /// The line there, counted from 1.
    pub line: usize,
    /// The column there, counted from 1.
    pub column: usize,
    /// How it is written there.
    pub written: String,
    /// Where it comes from.
    pub origin: Origin,
    /// The same path on the mirrored side, if that follows.
    pub mirrored: Option<Vec<Step>>,
    /// How it can be changed; the first is what an author most likely wants. None of a shipped text that nothing can
    /// stand in place of.
    pub ways: Vec<Way>,
}

/// A text of a document.
#[derive(Clone, Debug, PartialEq)]
pub struct Source {
    /// Its path from the document; empty for the document itself.
    pub name: String,
    /// What stands in it.
    pub text: String,
    /// Whether it may be changed: texts that are shipped may not.
    pub owned: bool,
}

/// A document that is being edited: its texts, the model that they describe, and its numbers.
#[derive(Clone, Debug)]
pub struct Editing {
    title: String,
    sources: Vec<Source>,
    document: Document,
    values: Vec<Editable>,
    /// The place in `values` of each path, and of each mirrored path.
    index: HashMap<Vec<Step>, (usize, bool)>,
}

impl Editing {
    /// Reads a document. `title` is what sentences call it, such as `leg.toml`; `include` gives the texts that it
    /// names, as for [`read`](super::read), and `owned` says of such a text whether it may be changed.
    ///
    /// # Errors
    /// As [`read`](super::read).
    ///
    /// ```
    /// use condyle_formats::document::edit::{Editing, Step};
    /// let text = "condyle = 1\nkind = \"model\"\n[segment.shank]\nat = [0, -0.420, 0] # Dumas 2007\n";
    /// let editing = Editing::read("leg.toml", text, &mut |_| Err("none".into()), &|_| true).unwrap();
    /// let path = [Step::Key("segment".into()), Step::Key("shank".into()), Step::Key("at".into()), Step::Index(1)];
    /// assert_eq!(editing.find(&path).unwrap().value, -0.42);
    /// let edited = editing.set(&path, -0.43, None).unwrap();
    /// assert_eq!(edited.next.text(), text.replace("-0.420", "-0.43"));
    /// ```
    pub fn read(
        title: &str,
        text: &str,
        include: &mut dyn FnMut(&str) -> Result<String, String>,
        owned: &dyn Fn(&str) -> bool,
    ) -> Result<Self, Error> {
        let mut sources = vec![Source { name: String::new(), text: text.to_owned(), owned: true }];
        let mut noted = |name: &str| {
            let text = include(name)?;
            if !sources.iter().any(|source| source.name == name) {
                let (name, owned) = (name.to_owned(), owned(name));
                sources.push(Source { name, text: text.clone(), owned });
            }
            Ok(text)
        };
        let (document, found) = read_edited(text, &mut noted)?;
        let values = way::editables(title, &sources, found, &document);
        let mut index = HashMap::new();
        for (number, value) in values.iter().enumerate() {
            if let Some(path) = &value.mirrored {
                index.entry(path.clone()).or_insert((number, true));
            }
        }
        for (number, value) in values.iter().enumerate() {
            index.insert(value.path.clone(), (number, false));
        }
        Ok(Self { title: title.to_owned(), sources, document, values, index })
    }

    /// Reads the same document with another text of one of its sources.
    fn with(&self, name: &str, text: &str) -> Result<Self, Error> {
        let root = if name.is_empty() { text } else { self.text() };
        let mut include = |wanted: &str| match self.source(wanted) {
            Some(_) if wanted == name => Ok(text.to_owned()),
            Some(source) => Ok(source.text.clone()),
            None => {
                Err("it was not read before: save the document in an editor instead".to_owned())
            }
        };
        let owned = |wanted: &str| self.source(wanted).is_none_or(|source| source.owned);
        Self::read(&self.title, root, &mut include, &owned)
    }

    /// Every number that can be changed, in the order of the merged document.
    #[must_use]
    pub fn values(&self) -> &[Editable] {
        &self.values
    }

    /// The number at a path, which may be one of the mirrored side.
    #[must_use]
    pub fn find(&self, path: &[Step]) -> Option<&Editable> {
        self.values.get(self.index.get(path)?.0)
    }

    /// The path on the written side of one on the mirrored side; itself of any other.
    #[must_use]
    pub fn written_side<'p>(&'p self, path: &'p [Step]) -> &'p [Step] {
        self.find(path).map_or(path, |value| &value.path)
    }

    /// Whether a path is one of the mirrored side.
    #[must_use]
    pub fn is_mirrored(&self, path: &[Step]) -> bool {
        self.index.get(path).is_some_and(|(_, mirrored)| *mirrored)
    }

    /// The model that the document describes now.
    #[must_use]
    pub fn document(&self) -> &Document {
        &self.document
    }

    /// The text of the document itself.
    #[must_use]
    pub fn text(&self) -> &str {
        self.sources.first().map_or("", |source| &source.text)
    }

    /// All texts: the document itself, then what it names.
    #[must_use]
    pub fn sources(&self) -> &[Source] {
        &self.sources
    }

    /// A text by its name.
    #[must_use]
    pub fn source(&self, name: &str) -> Option<&Source> {
        self.sources.iter().find(|source| source.name == name)
    }
}

/// Line and column, counted from 1, of a byte of a text.
fn line_and_column(text: &str, at: usize) -> (usize, usize) {
    let mut at = at.min(text.len());
    while !text.is_char_boundary(at) {
        at -= 1;
    }
    let before = &text[..at];
    let from = before.rfind('\n').map_or(0, |end| end + 1);
    (before.bytes().filter(|b| *b == b'\n').count() + 1, before[from..].chars().count() + 1)
}

/// A key as TOML writes it.
fn key_text(key: &str) -> String {
    let bare = |c: char| c.is_ascii_alphanumeric() || c == '_' || c == '-';
    if !key.is_empty() && key.chars().all(bare) { key.to_owned() } else { super::model::text(key) }
}
