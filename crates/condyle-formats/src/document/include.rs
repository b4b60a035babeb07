//! A document and the texts that it includes, merged into one table.

use super::Form;
use super::head;
use super::texts::{Name, Spot, Texts};
use super::tree::{Entry, Node, Value, parse, too_deep};
use std::collections::HashMap;
use std::ops::Range;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

/// How deep includes may nest, and how many texts may be included in all.
const MOST_NESTED: usize = 8;
const MOST_INCLUDED: usize = 64;

/// Loads a text and all that it includes into one table; `None` after an error of the text itself.
pub(super) fn load(
    texts: &mut Texts,
    form: &Form,
    text: &str,
    include: &mut dyn FnMut(&str) -> Result<String, String>,
) -> Option<Vec<Entry>> {
    Loader { texts, form, include, open: vec![] }.load("", text, None)
}

struct Loader<'a> {
    texts: &'a mut Texts,
    form: &'a Form,
    include: &'a mut dyn FnMut(&str) -> Result<String, String>,
    /// The texts that are being read, each included by the one before it.
    open: Vec<String>,
}

impl Loader<'_> {
    /// Recursive over includes, at most [`MOST_NESTED`] deep.
    fn load(&mut self, name: &str, text: &str, at: Option<Spot>) -> Option<Vec<Entry>> {
        let file = self.texts.add(name, text, at);
        let mut entries = parse(self.texts, file, text)?;
        head::check(self.texts, file, &entries, self.form.kind)?;
        let included = entries.iter().position(|e| e.key.text == "include");
        let included = included.map(|index| entries.remove(index));
        if at.is_some() {
            let own = [&["condyle", "kind", "angles", "name"], self.form.own].concat();
            entries.retain(|e| !own.contains(&e.key.text.as_str()));
        }
        self.open.push(name.to_owned());
        for wanted in included.map(|e| self.paths(e.node)).unwrap_or_default() {
            // Errors of nested includes are reported at the line of the document itself.
            let line = at.unwrap_or(wanted.spot);
            if let Some(more) = self.included(name, &wanted, line) {
                let (constants, more) =
                    more.into_iter().partition(|entry| entry.key.text == "constants");
                merge(self.texts, &mut entries, more, Keep::Given { by: file });
                merge(self.texts, &mut entries, constants, Keep::First);
            }
        }
        self.open.pop();
        Some(entries)
    }

    fn included(&mut self, from: &str, wanted: &Name, line: Spot) -> Option<Vec<Entry>> {
        let path = beside(from, &wanted.text);
        let (code, message, help) = if self.open.contains(&path) {
            let mut circle: Vec<&str> =
                self.open.iter().skip_while(|n| **n != path).map(String::as_str).collect();
            circle.push(&path);
            let message = format!("texts include each other in a circle: {}", circle.join(" -> "));
            ("document/include-cycle", message, "remove one of these includes".to_owned())
        } else if self.texts.has(&path) {
            return None;
        } else if self.open.len() > MOST_NESTED || self.texts.len() > MOST_INCLUDED {
            let message = format!("too many includes: `{path}` is not read");
            let help = format!(
                "include at most {MOST_INCLUDED} documents, nested at most {MOST_NESTED} deep"
            );
            ("document/include-depth", message, help)
        } else {
            match (self.include)(&path) {
                Ok(text) => return self.load(&path, &text, Some(line)),
                Err(why) => {
                    let message = format!("`{path}` cannot be included: {why}");
                    let kind = self.form.kind.name();
                    let help = format!(
                        "give the path of another document of kind `{kind}`, from this one's folder"
                    );
                    ("document/include", message, help)
                }
            }
        };
        self.texts.error(wanted.spot, code, message, help);
        None
    }

    fn paths(&mut self, node: Node) -> Vec<Name> {
        let mut paths = vec![];
        let spot = node.spot;
        let list = match node.value {
            Value::List(list) => list,
            value => vec![Node { value, spot }],
        };
        for node in list {
            match node.value {
                Value::Text(text) => paths.push(Name { text, spot: node.spot }),
                _ => self.texts.error(
                    node.spot,
                    "document/type",
                    format!("`include` holds {}", node.describe()),
                    "give the paths of other documents, such as [\"hand.toml\"]",
                ),
            }
        }
        paths
    }
}

/// A path that a text gives relative to its own folder, relative to the document's folder.
pub(super) fn beside(from: &str, name: &str) -> String {
    let name = name.replace('\\', "/");
    let folder = from.rsplit_once('/').map_or("", |(folder, _)| folder);
    let whole =
        if name.starts_with('/') || folder.is_empty() { name } else { format!("{folder}/{name}") };
    let mut parts: Vec<&str> = vec![];
    for part in whole.split('/') {
        match part {
            "." => {}
            ".." if parts.last().is_some_and(|p| *p != ".." && !p.is_empty()) => {
                parts.pop();
            }
            _ => parts.push(part),
        }
    }
    parts.join("/")
}

/// The paths that a text names itself, each with the bytes of its string in the text, quotes and all: what it
/// includes, and the files of its learned limits.
///
/// None of a text that cannot be parsed.
///
/// ```
/// use condyle_formats::document::includes;
/// let text = "condyle = 1\nkind = \"model\"\ninclude = [\"hand.toml\"]\n";
/// let (place, path) = &includes(text)[0];
/// assert_eq!((&text[place.clone()], path.as_str()), ("\"hand.toml\"", "hand.toml"));
/// ```
#[must_use]
pub fn includes(text: &str) -> Vec<(Range<usize>, String)> {
    if too_deep(text).is_some() {
        return vec![];
    }
    let (table, _) = DeTable::parse_recoverable(text);
    let path = |value: &Spanned<DeValue<'_>>| match value.get_ref() {
        DeValue::String(path) => Some((value.span(), path.to_string())),
        _ => None,
    };
    let mut paths = match table.get_ref().get("include") {
        None => vec![],
        Some(value) => match value.get_ref() {
            DeValue::Array(list) => list.iter().filter_map(path).collect(),
            _ => path(value).into_iter().collect(),
        },
    };
    let top = table.get_ref();
    let templates = tables(top.get("template")).filter_map(|one| one.get("joint_set"));
    for sets in top.get("joint_set").into_iter().chain(templates) {
        for set in tables(Some(sets)) {
            for component in tables(set.get("component")) {
                let field = component.get("field").map(Spanned::get_ref);
                if let Some(DeValue::Table(field)) = field {
                    paths.extend(field.get("file").and_then(path));
                }
            }
        }
    }
    paths
}

/// The tables in a table.
fn tables<'t, 'v>(
    value: Option<&'t Spanned<DeValue<'v>>>,
) -> impl Iterator<Item = &'t DeTable<'v>> {
    let table = match value.map(Spanned::get_ref) {
        Some(DeValue::Table(table)) => Some(table),
        _ => None,
    };
    let inner = table.into_iter().flat_map(|table| table.iter().map(|(_, value)| value));
    inner.filter_map(|value| match value.get_ref() {
        DeValue::Table(table) => Some(table),
        _ => None,
    })
}

/// Which value is kept where two texts give one.
#[derive(Clone, Copy)]
enum Keep {
    /// That of the including text; two included texts that differ are an error.
    Given { by: u32 },
    /// That which is there already.
    First,
}

/// Adds the entries of an included text: tables are merged, and what the including text gives itself
/// stands in place of what is included. Recursive as deep as the trees are.
fn merge(texts: &mut Texts, into: &mut Vec<Entry>, more: Vec<Entry>, keep: Keep) {
    let index: HashMap<String, usize> =
        into.iter().enumerate().map(|(i, e)| (e.key.text.clone(), i)).collect();
    for entry in more {
        let Some(&known) = index.get(&entry.key.text) else {
            into.push(entry);
            continue;
        };
        let known = &mut into[known];
        let ours = match keep {
            Keep::Given { by } => known.key.spot.file == by,
            Keep::First => true,
        };
        match (&mut known.node.value, entry.node.value) {
            (Value::Table(known), Value::Table(more)) => merge(texts, known, more, keep),
            _ if ours => {}
            // Equal values are no conflict, such as one mirror repeated in several texts.
            (Value::Text(known), Value::Text(more)) if *known == more => {}
            (Value::Number(known), Value::Number(more)) if *known == more => {}
            _ => {
                let key = &entry.key.text;
                let other = texts.line(known.key.spot);
                let message = format!("`{key}` is also given by another included text ({other})");
                let help =
                    "give it in the including text, which is then kept, or in one of the two";
                texts.error(entry.key.spot, "document/duplicate", message, help);
            }
        }
    }
}
