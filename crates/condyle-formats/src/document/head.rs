//! The head of a document: version, kind, and unit of angles.

use super::texts::{Angles, Spot, Texts};
use super::tree::{Entry, Node, Value, head_end, too_deep};
use condyle_diagnostics::did_you_mean;
use toml::de::{DeTable, DeValue};

/// The keys that every kind of document takes at its top.
pub(super) const HEAD: &[&str] = &["condyle", "kind", "name", "angles", "include", "constants"];
/// How many bytes of a text [`kind`] looks at.
const LONGEST_HEAD: usize = 1 << 16;

/// What a document describes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Kind {
    /// A model: segments, joints and markers.
    Model,
    /// A limit of joints.
    Limit,
    /// A law that couples coordinates.
    Law,
    /// A recipe that makes a model.
    Recipe,
    /// Settings of an analysis.
    Setup,
    /// Names in one model or recording, and what they are called in another.
    Names,
    /// What a pose should do.
    Goals,
    /// Where a law is carried to.
    Landmarks,
}

/// Each kind, its name in a document, and what a sentence calls one.
const KINDS: [(Kind, &str, &str); 8] = [
    (Kind::Model, "model", "a model"),
    (Kind::Limit, "limit", "a limit"),
    (Kind::Law, "law", "a law"),
    (Kind::Recipe, "recipe", "a recipe"),
    (Kind::Setup, "setup", "a setup"),
    (Kind::Names, "names", "a list of names"),
    (Kind::Goals, "goals", "a list of goals"),
    (Kind::Landmarks, "landmarks", "a list of landmarks"),
];

impl Kind {
    /// The value of `kind` in a document's head.
    #[must_use]
    pub fn name(self) -> &'static str {
        KINDS[self as usize].1
    }

    fn named(name: &str) -> Option<Self> {
        KINDS.iter().find(|(_, n, _)| *n == name).map(|(kind, ..)| *kind)
    }
}

fn names() -> impl Iterator<Item = &'static str> {
    KINDS.iter().map(|(_, name, _)| *name)
}

/// The kind of a document, from its first 64 KiB; `None` if the text is not a document.
///
/// A document has the keys `condyle` and `kind` before its first table. Any bytes may be given; a
/// syntax error elsewhere does not matter.
///
/// ```
/// use condyle_formats::document::{Kind, kind};
/// assert_eq!(kind("condyle = 1\nkind = \"setup\"\n[task"), Some(Kind::Setup));
/// assert_eq!(kind("[package]\nkind = \"model\""), None);
/// ```
#[must_use]
pub fn kind(text: impl AsRef<[u8]>) -> Option<Kind> {
    let bytes = text.as_ref();
    let text = String::from_utf8_lossy(&bytes[..bytes.len().min(LONGEST_HEAD)]);
    let head = &text[..head_end(&text)];
    if too_deep(head).is_some() {
        return None;
    }
    let (table, _) = DeTable::parse_recoverable(head);
    let table = table.get_ref();
    table.get("condyle")?;
    match table.get("kind")?.get_ref() {
        DeValue::String(name) => Kind::named(name),
        _ => None,
    }
}

/// Checks the head of one text of a document of the expected kind.
pub(super) fn check(texts: &mut Texts, file: u32, entries: &[Entry], expected: Kind) -> Option<()> {
    let (_, name, noun) = KINDS[expected as usize];
    let start = Spot::new(file, 0);
    let find = |key: &str| entries.iter().find(|e| e.key.text == key).map(|e| &e.node);
    match find("condyle") {
        Some(Node { value: Value::Number(1.0), .. }) => {}
        Some(node) => {
            let help = "write `condyle = 1`, or use a newer version of condyle";
            texts.error(node.spot, "document/version", "unknown version of the format", help);
            return None;
        }
        None => {
            let help = format!("begin with the lines `condyle = 1` and `kind = \"{name}\"`");
            texts.error(start, "document/version", "the document has no line `condyle = 1`", help);
            return None;
        }
    }
    let all = || format!("kinds are: `{}`", names().collect::<Vec<_>>().join("`, `"));
    let (spot, message, help) = match find("kind") {
        Some(Node { value: Value::Text(found), spot }) => match Kind::named(found) {
            Some(kind) if kind == expected => return angles(texts, file, find("angles")),
            Some(_) => {
                let message = format!("this is a document of kind `{found}`, not {noun}");
                (*spot, message, format!("give a document of `kind = \"{name}\"`"))
            }
            None => {
                let message = format!("unknown kind of document `{found}`");
                (*spot, message, did_you_mean(found, names(), all))
            }
        },
        other => {
            let message = match other {
                Some(node) => format!("`kind` is {}", node.describe()),
                None => "the document has no `kind`".to_owned(),
            };
            let help = format!("write `kind = \"{name}\"` ({})", all());
            (other.map_or(start, |n| n.spot), message, help)
        }
    };
    texts.error(spot, "document/kind", message, help);
    None
}

fn angles(texts: &mut Texts, file: u32, node: Option<&Node>) -> Option<()> {
    match node {
        None => {}
        Some(Node { value: Value::Text(unit), .. }) if unit == "rad" => {}
        Some(Node { value: Value::Text(unit), .. }) if unit == "deg" => {
            texts.set_angles(file, Angles::Degrees);
        }
        Some(node) => {
            let help = "write `angles = \"deg\"` or `angles = \"rad\"`";
            texts.error(node.spot, "document/angles", "unknown unit of angles", help);
        }
    }
    Some(())
}
