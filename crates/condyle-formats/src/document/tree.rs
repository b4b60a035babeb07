//! TOML to a tree of values that know where they stand, with included texts grafted in.

use super::keys::KINDS;
use super::source::{Angles, Name, Sources, Spot};
use condyle_diagnostics::nearest;
use std::collections::HashMap;
use toml::de::{DeTable, DeValue};

/// The longest text that is read, in bytes.
const LONGEST: usize = 1 << 26;
/// How deep brackets may nest, and how many parts a dotted key may have.
const DEEPEST: usize = 16;
const LONGEST_KEY: usize = 32;
/// How many texts may be included, one in the other and all together.
const MOST_NESTED: usize = 8;
const MOST_INCLUDED: usize = 64;

/// A value and where it stands.
#[derive(Debug)]
pub(super) struct Node {
    pub(super) value: Value,
    pub(super) spot: Spot,
}

#[derive(Debug)]
pub(super) enum Value {
    Text(String),
    Number(f64),
    Bool(bool),
    Date,
    List(Vec<Node>),
    Table(Vec<Entry>),
}

/// A key with its value.
#[derive(Debug)]
pub(super) struct Entry {
    pub(super) key: Name,
    pub(super) node: Node,
}

impl Node {
    /// What it is, with an article.
    pub(super) fn describe(&self) -> &'static str {
        match self.value {
            Value::Text(_) => "a text",
            Value::Number(_) => "a number",
            Value::Bool(_) => "true or false",
            Value::Date => "a date",
            Value::List(_) => "a list",
            Value::Table(_) => "a table",
        }
    }
}

/// Loads a text and all that it includes into one table, or reports why not.
pub(super) fn load(
    sources: &mut Sources,
    text: &str,
    include: &mut dyn FnMut(&str) -> Result<String, String>,
) -> Option<Vec<Entry>> {
    let mut loader = Loader { sources, include, open: vec![] };
    loader.load("", text, None)
}

struct Loader<'a> {
    sources: &'a mut Sources,
    include: &'a mut dyn FnMut(&str) -> Result<String, String>,
    /// The texts that are being read, each included by the one before it.
    open: Vec<String>,
}

impl Loader<'_> {
    /// Recursive over includes, at most [`MOST_NESTED`] deep.
    fn load(&mut self, name: &str, text: &str, at: Option<Spot>) -> Option<Vec<Entry>> {
        let file = self.sources.add(name, text, at);
        let mut entries = parse(self.sources, file, text)?;
        self.header(file, &entries)?;
        let included = take(&mut entries, "include");
        if at.is_some() {
            for key in ["condyle", "kind", "angles", "name", "up"] {
                take(&mut entries, key);
            }
        }
        self.open.push(name.to_owned());
        for wanted in included.map(|e| self.names(e.node)).unwrap_or_default() {
            // What an included text includes is said of the line in the document itself.
            let line = at.unwrap_or(wanted.spot);
            if let Some(more) = self.included(name, &wanted, line) {
                let (constants, more) =
                    more.into_iter().partition(|entry| entry.key.text == "constants");
                merge(self.sources, &mut entries, more, false);
                merge(self.sources, &mut entries, constants, true);
            }
        }
        self.open.pop();
        Some(entries)
    }

    fn included(&mut self, from: &str, wanted: &Name, line: Spot) -> Option<Vec<Entry>> {
        let path = beside(from, &wanted.text);
        if self.open.contains(&path) {
            let mut circle: Vec<&str> =
                self.open.iter().skip_while(|n| **n != path).map(String::as_str).collect();
            circle.push(&path);
            let message = format!("texts include each other in a circle: {}", circle.join(" -> "));
            self.sources.error(wanted.spot, "model/include-cycle", message, "remove one of these");
            return None;
        }
        if self.sources.has(&path) {
            return None;
        }
        if self.open.len() > MOST_NESTED || self.sources.len() > MOST_INCLUDED {
            let message = format!("`{path}` is one text too many");
            let help = format!("include at most {MOST_INCLUDED}, {MOST_NESTED} in each other");
            self.sources.error(wanted.spot, "model/include-depth", message, help);
            return None;
        }
        match (self.include)(&path) {
            Ok(text) => self.load(&path, &text, Some(line)),
            Err(why) => {
                let message = format!("`{path}` cannot be included: {why}");
                let help = "give the path of another model document, from this one's folder";
                self.sources.error(wanted.spot, "model/include", message, help);
                None
            }
        }
    }

    fn names(&mut self, node: Node) -> Vec<Name> {
        let mut names = vec![];
        let spot = node.spot;
        let list = match node.value {
            Value::List(list) => list,
            value => vec![Node { value, spot }],
        };
        for node in list {
            match node.value {
                Value::Text(text) => names.push(Name { text, spot: node.spot }),
                _ => self.sources.error(
                    node.spot,
                    "model/type",
                    format!("`include` holds {}", node.describe()),
                    "give the paths of other documents, such as [\"hand.toml\"]",
                ),
            }
        }
        names
    }

    /// The lines that say what a document is.
    fn header(&mut self, file: u32, entries: &[Entry]) -> Option<()> {
        let start = Spot { file, start: 0 };
        let find = |key: &str| entries.iter().find(|e| e.key.text == key).map(|e| &e.node);
        match find("condyle") {
            Some(Node { value: Value::Number(1.0), .. }) => {}
            Some(node) => {
                let message = "this version of the format is not known";
                let help = "write `condyle = 1`, or use a newer program";
                self.sources.error(node.spot, "model/version", message, help);
                return None;
            }
            None => {
                let message = "the document does not say that it is one";
                let help = "begin it with the lines `condyle = 1` and `kind = \"model\"`";
                self.sources.error(start, "model/version", message, help);
                return None;
            }
        }
        let kinds = KINDS.join("`, `");
        match find("kind") {
            Some(Node { value: Value::Text(kind), .. }) if kind == "model" => {}
            Some(Node { value: Value::Text(kind), spot }) => {
                let (message, help) = if KINDS.contains(&kind.as_str()) {
                    let message = format!("this is a document of kind `{kind}`, not a model");
                    (message, "give a document of `kind = \"model\"`".to_owned())
                } else {
                    let help = match nearest(kind, KINDS.iter().copied()) {
                        Some(near) => format!("did you mean `{near}`?"),
                        None => format!("kinds are: `{kinds}`"),
                    };
                    (format!("unknown kind of document `{kind}`"), help)
                };
                self.sources.error(*spot, "model/kind", message, help);
                return None;
            }
            other => {
                let help = format!("write `kind = \"model\"` (kinds are: `{kinds}`)");
                let spot = other.map_or(start, |n| n.spot);
                let message = "the document does not say of what kind it is";
                self.sources.error(spot, "model/kind", message, help);
                return None;
            }
        }
        match find("angles") {
            None => {}
            Some(Node { value: Value::Text(unit), .. }) if unit == "rad" => {}
            Some(Node { value: Value::Text(unit), .. }) if unit == "deg" => {
                self.sources.set_angles(file, Angles::Degrees);
            }
            Some(node) => self.sources.error(
                node.spot,
                "model/angles",
                "the unit of angles is not known",
                "write `angles = \"deg\"` or `angles = \"rad\"`",
            ),
        }
        Some(())
    }
}

fn take(entries: &mut Vec<Entry>, key: &str) -> Option<Entry> {
    let index = entries.iter().position(|e| e.key.text == key)?;
    Some(entries.remove(index))
}

/// A path that one text gives, from that text's own place.
fn beside(from: &str, name: &str) -> String {
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

/// Tables go on in another text; a key is given once. As deep as the trees are.
///
/// Of a constant that both give, that of the document which includes the other holds (`ours`).
fn merge(sources: &mut Sources, into: &mut Vec<Entry>, more: Vec<Entry>, ours: bool) {
    let index: HashMap<String, usize> =
        into.iter().enumerate().map(|(i, e)| (e.key.text.clone(), i)).collect();
    for entry in more {
        let Some(&known) = index.get(&entry.key.text) else {
            into.push(entry);
            continue;
        };
        match (&mut into[known].node.value, entry.node.value) {
            (Value::Table(known), Value::Table(more)) => {
                merge(sources, known, more, ours);
            }
            _ if ours => {}
            // Said twice alike, such as one mirror for several texts, it is said once.
            (Value::Text(known), Value::Text(more)) if *known == more => {}
            (Value::Number(known), Value::Number(more)) if *known == more => {}
            _ => sources.error(
                entry.key.spot,
                "model/duplicate",
                format!(
                    "`{}` is given by the document that includes this one, too",
                    entry.key.text
                ),
                "give it once",
            ),
        }
    }
}

fn parse(sources: &mut Sources, file: u32, text: &str) -> Option<Vec<Entry>> {
    let at = |start: usize| Spot { file, start };
    if text.len() > LONGEST {
        let message = format!("the document has {} bytes", text.len());
        let help = format!("at most {LONGEST} are read");
        sources.error(at(0), "model/size", message, help);
        return None;
    }
    if let Some(start) = too_deep(text) {
        let help = format!("nest at most {DEEPEST} brackets and {LONGEST_KEY} parts of a key");
        sources.error(at(start), "model/depth", "this is nested too deep", help);
        return None;
    }
    let (table, errors) = DeTable::parse_recoverable(text);
    if !errors.is_empty() {
        for error in errors {
            let start = error.span().map_or(0, |s| s.start);
            let message = error.message().lines().next().unwrap_or_default().to_owned();
            sources.error(at(start), "toml/syntax", message, "documents are written in TOML 1.0");
        }
        return None;
    }
    let spot = at(table.span().start);
    match convert(file, DeValue::Table(table.into_inner()), spot).value {
        Value::Table(entries) => Some(entries),
        _ => None,
    }
}

/// Where brackets or dotted keys go deeper than any model needs.
///
/// Walking and dropping a tree takes stack, so this is settled before there is one. Texts that are
/// not closed end with their line, as the parser takes them; a long one ends where it is closed.
fn too_deep(text: &str) -> Option<usize> {
    let bytes = text.as_bytes();
    let (mut depth, mut dots, mut i) = (0usize, 0usize, 0usize);
    while i < bytes.len() {
        match bytes[i] {
            b'#' => {
                while i < bytes.len() && bytes[i] != b'\n' {
                    i += 1;
                }
                continue;
            }
            quote @ (b'"' | b'\'') => {
                let long = bytes[i..].starts_with(&[quote; 3]);
                i += if long { 3 } else { 1 };
                while i < bytes.len() {
                    if bytes[i] == b'\\' && quote == b'"' {
                        i += 1;
                    } else if long && bytes[i..].starts_with(&[quote; 3]) {
                        i += 2;
                        break;
                    } else if !long && (bytes[i] == quote || bytes[i] == b'\n') {
                        break;
                    }
                    i += 1;
                }
            }
            b'[' | b'{' => {
                depth += 1;
                dots = 0;
            }
            b']' | b'}' => depth = depth.saturating_sub(1),
            b'.' => dots += 1,
            b'=' | b',' | b'\n' => dots = 0,
            _ => {}
        }
        if depth > DEEPEST || dots > LONGEST_KEY {
            return Some(i.min(bytes.len()));
        }
        i += 1;
    }
    None
}

/// Recursive, no deeper than the parser itself went (80 brackets, 80 parts of a key).
fn convert(file: u32, value: DeValue<'_>, spot: Spot) -> Node {
    let at = |start: usize| Spot { file, start };
    let value = match value {
        DeValue::String(text) => Value::Text(text.into_owned()),
        DeValue::Integer(n) => {
            Value::Number(i64::from_str_radix(n.as_str(), n.radix()).map_or(f64::NAN, |n| n as f64))
        }
        DeValue::Float(n) => Value::Number(n.as_str().parse().unwrap_or(f64::NAN)),
        DeValue::Boolean(b) => Value::Bool(b),
        DeValue::Datetime(_) => Value::Date,
        DeValue::Array(list) => Value::List(
            list.into_iter()
                .map(|node| {
                    let start = node.span().start;
                    convert(file, node.into_inner(), at(start))
                })
                .collect(),
        ),
        DeValue::Table(table) => {
            let mut entries: Vec<Entry> = table
                .into_iter()
                .map(|(key, node)| {
                    let (key_at, node_at) = (at(key.span().start), at(node.span().start));
                    let node = convert(file, node.into_inner(), node_at);
                    Entry { key: Name { text: key.into_inner().into_owned(), spot: key_at }, node }
                })
                .collect();
            entries.sort_by_key(|e| e.key.spot);
            Value::Table(entries)
        }
    };
    Node { value, spot }
}
