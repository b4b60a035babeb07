//! TOML to a tree of values, each with its place in the text.

use super::texts::{Name, Spot, Texts};
use toml::de::{DeTable, DeValue};

/// How many bytes a text may have.
const LONGEST: usize = 1 << 26;
/// How deep brackets may nest, and how many parts a dotted key may have.
const DEEPEST: usize = 16;
const LONGEST_KEY: usize = 32;

/// A value and its place.
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
    /// Its type, with an article.
    pub(super) fn describe(&self) -> &'static str {
        self.value.describe()
    }
}

impl Value {
    pub(super) fn describe(&self) -> &'static str {
        match self {
            Self::Text(_) => "a string",
            Self::Number(_) => "a number",
            Self::Bool(_) => "a boolean",
            Self::Date => "a date",
            Self::List(_) => "a list",
            Self::Table(_) => "a table",
        }
    }
}

/// Parses one text; `None` after an error.
pub(super) fn parse(texts: &mut Texts, file: u32, text: &str) -> Option<Vec<Entry>> {
    let at = |start: usize| Spot::new(file, start);
    if text.len() > LONGEST {
        let message = format!("the document has {} bytes", text.len());
        let help = format!("at most {LONGEST} are read");
        texts.error(at(0), "document/size", message, help);
        return None;
    }
    if let Some(start) = too_deep(text) {
        let help = format!(
            "nest at most {DEEPEST} brackets; a dotted key has at most {LONGEST_KEY} parts"
        );
        texts.error(at(start), "document/depth", "this is nested too deeply", help);
        return None;
    }
    let (table, errors) = DeTable::parse_recoverable(text);
    if !errors.is_empty() {
        for error in errors {
            let start = error.span().map_or(0, |s| s.start);
            let message = error.message().lines().next().unwrap_or_default().to_owned();
            let help = match bare_word(&text[start.min(text.len())..]) {
                Some(word) => format!("text stands in quotes: \"{word}\""),
                None => "documents are written in TOML 1.0".to_owned(),
            };
            texts.error(at(start), "document/syntax", message, help);
        }
        return None;
    }
    let spot = at(table.span().start);
    match convert(file, DeValue::Table(table.into_inner()), spot).value {
        Value::Table(entries) => Some(entries),
        _ => None,
    }
}

/// A word where a value is expected that is none of TOML: a text without its quotes.
fn bare_word(text: &str) -> Option<&str> {
    let in_words = |c: char| c.is_alphanumeric() || matches!(c, '_' | '-' | '.');
    let word = &text[..text.find(|c| !in_words(c)).unwrap_or(text.len())];
    let line = text[word.len()..].lines().next().unwrap_or_default().trim_start();
    let ends = line.is_empty() || line.starts_with(['#', ',', '}', ']']);
    (ends && word.starts_with(char::is_alphabetic)).then_some(word)
}

/// The bytes of a TOML text outside comments and strings, with their offsets. Of a string only its
/// opening quote is given.
///
/// An unclosed string ends with its line, as it does for the parser; a multi-line string ends where
/// it is closed.
struct Structure<'t> {
    bytes: &'t [u8],
    next: usize,
}

impl Iterator for Structure<'_> {
    type Item = (usize, u8);

    fn next(&mut self) -> Option<Self::Item> {
        let start = self.next;
        let first = *self.bytes.get(start)?;
        let rest = &self.bytes[start..];
        self.next = start + 1;
        match first {
            b'#' => {
                let comment = rest.iter().position(|b| *b == b'\n').unwrap_or(rest.len());
                self.next = start + comment;
                return self.next();
            }
            quote @ (b'"' | b'\'') => {
                let close: &[u8] =
                    if rest.starts_with(&[quote; 3]) { &[quote; 3] } else { &[quote] };
                let mut i = close.len();
                while i < rest.len() && !rest[i..].starts_with(close) {
                    if close.len() == 1 && rest[i] == b'\n' {
                        self.next = start + i;
                        return Some((start, quote));
                    }
                    i += if rest[i] == b'\\' && quote == b'"' { 2 } else { 1 };
                }
                self.next = start + i + close.len();
            }
            _ => {}
        }
        Some((start, first))
    }
}

/// Where brackets or dotted keys go deeper than any document needs.
///
/// Checked before parsing, since walking and dropping a deep tree overflows the stack.
pub(super) fn too_deep(text: &str) -> Option<usize> {
    let (mut depth, mut dots) = (0usize, 0usize);
    for (at, byte) in (Structure { bytes: text.as_bytes(), next: 0 }) {
        match byte {
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
            return Some(at);
        }
    }
    None
}

/// Where the first table begins: the keys before it are the document's own.
pub(super) fn head_end(text: &str) -> usize {
    let (mut depth, mut line_start) = (0usize, true);
    for (at, byte) in (Structure { bytes: text.as_bytes(), next: 0 }) {
        match byte {
            b'[' if line_start && depth == 0 => return at,
            b'[' | b'{' => depth += 1,
            b']' | b'}' => depth = depth.saturating_sub(1),
            _ => {}
        }
        line_start = byte == b'\n' || line_start && byte.is_ascii_whitespace();
    }
    text.len()
}

/// Recursive, no deeper than the parser itself went (80 brackets, 80 parts of a key).
fn convert(file: u32, value: DeValue<'_>, spot: Spot) -> Node {
    let at = |start: usize| Spot::new(file, start);
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

/// Where each value of a text ends, by where it begins.
#[cfg(feature = "edit")]
pub(super) fn ends(text: &str) -> std::collections::HashMap<usize, usize> {
    let mut ends = std::collections::HashMap::new();
    if too_deep(text).is_some() {
        return ends;
    }
    let (table, _) = DeTable::parse_recoverable(text);
    let mut open: Vec<&toml::Spanned<DeValue<'_>>> =
        table.get_ref().iter().map(|(_, v)| v).collect();
    while let Some(value) = open.pop() {
        ends.insert(value.span().start, value.span().end);
        match value.get_ref() {
            DeValue::Array(list) => open.extend(list.iter()),
            DeValue::Table(table) => open.extend(table.iter().map(|(_, value)| value)),
            _ => {}
        }
    }
    ends
}

/// The table at a path of keys, if it is there.
#[cfg(feature = "edit")]
pub(super) fn own_tables<'t, 'v>(top: &'t DeTable<'v>, path: &[String]) -> Option<&'t DeTable<'v>> {
    let mut here = top;
    for key in path {
        here = match here.get(key.as_str())?.get_ref() {
            DeValue::Table(inner) => inner,
            _ => return None,
        };
    }
    Some(here)
}
