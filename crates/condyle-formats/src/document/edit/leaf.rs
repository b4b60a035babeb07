//! The numbers of a merged document, each with its place.

use super::Step;
use super::expression::{Affine, Followed, Literal, constants, followed, literal};
use super::unit::{Scope, Unit};
use crate::document::fields::{Fields, Reader};
use crate::document::model::text as quoted;
use crate::document::texts::{Angles, Context, Spot};
use crate::document::tree::{Entry, Node, Value};
use std::collections::{HashMap, HashSet};

/// Keys of the head, which no number of the model is under.
const HEAD: &[&str] =
    &["condyle", "kind", "name", "angles", "up", "facing", "mirror", "include", "template", "size"];
/// Keys whose values are texts, whatever stands in them.
const TEXTS: &[&str] = &["source", "name", "law", "file", "unit", "parent", "segment", "drives"];
/// How many numbers are listed.
const MOST: usize = 1 << 17;

/// A number where it stands.
pub(in crate::document) struct Leaf {
    pub(super) path: Vec<Step>,
    pub(super) value: f64,
    pub(super) unit: Unit,
    /// Whether the text's angles are degrees.
    pub(super) degrees: bool,
    pub(super) spot: Spot,
    pub(super) context: Option<Context>,
    pub(super) expression: Option<Expression>,
    /// The place of its key among the [`Keyed`].
    pub(super) key: usize,
}

/// An expression that gives a number.
pub(super) struct Expression {
    pub(super) text: String,
    pub(super) literal: Option<(Literal, Affine)>,
    pub(super) followed: Option<Followed>,
}

/// A key with a number, or a list that holds some: what an including text gives anew.
pub(super) struct Keyed {
    pub(super) path: Vec<String>,
    pub(super) pieces: Vec<Piece>,
    /// Whether an including text must give `enforced` with it, and with what value.
    pub(super) enforced: Option<bool>,
}

/// A part of the text of a value.
pub(super) enum Piece {
    Text(String),
    /// The number of a leaf.
    Leaf(usize),
}

/// All that is known of a document's numbers.
#[derive(Default)]
pub(in crate::document) struct Found {
    pub(super) leaves: Vec<Leaf>,
    pub(super) keyed: Vec<Keyed>,
    /// The paths of the texts by their numbers.
    pub(super) files: Vec<String>,
    /// How many numbers follow each constant.
    pub(super) followers: HashMap<String, usize>,
    /// How a written side's names end, and those of the mirrored side.
    pub(super) mirror: Option<(String, String)>,
    /// The names at the top of each family of tables.
    pub(super) names: HashSet<(String, String)>,
    /// Whether the document's own angles are degrees.
    pub(super) degrees: bool,
}

/// Lists the numbers of a document that was read without an error.
pub(in crate::document) fn gather(reader: &mut Reader<'_>, top: &Fields<'_>) -> Found {
    let constants = match top.get("constants").map(|node| &node.value) {
        Some(Value::Table(entries)) => &entries[..],
        _ => &[],
    };
    let defined = constants.iter().map(|e| (e.key.text.as_str(), &e.node)).collect();
    let files = (0..reader.texts.len() as u32).map(|f| Spot::new(f, 0));
    let files = files.map(|spot| reader.texts.path(spot).to_owned()).collect();
    let degrees = reader.texts.angles(Spot::default()) == Angles::Degrees;
    let found = Found { files, degrees, mirror: mirror(top), ..Found::default() };
    let mut walk = Walk { reader, defined, found, path: vec![] };
    for entry in top.entries() {
        let family = entry.key.text.as_str();
        if HEAD.contains(&family) {
            continue;
        }
        if let Value::Table(entries) = &entry.node.value {
            for inner in entries {
                walk.found.names.insert((family.to_owned(), inner.key.text.clone()));
            }
            walk.path.push(Step::Key(family.to_owned()));
            walk.table(entries, &Scope::top());
            walk.path.pop();
        }
    }
    walk.found
}

fn mirror(top: &Fields<'_>) -> Option<(String, String)> {
    let Value::Table(entries) = &top.get("mirror")?.value else { return None };
    let text = |key: &str| {
        entries.iter().find(|e| e.key.text == key).and_then(|e| match &e.node.value {
            Value::Text(text) => Some(text.clone()),
            _ => None,
        })
    };
    Some((text("from")?, text("to")?))
}

struct Walk<'r, 's, 't> {
    reader: &'r mut Reader<'s>,
    defined: HashMap<&'t str, &'t Node>,
    found: Found,
    path: Vec<Step>,
}

impl Walk<'_, '_, '_> {
    /// Recursive as deep as the tree is.
    fn table(&mut self, entries: &[Entry], scope: &Scope<'_>) {
        let scope = scope.within(entries);
        for entry in entries {
            let key = entry.key.text.as_str();
            self.path.push(Step::Key(key.to_owned()));
            match &entry.node.value {
                Value::Table(inner) => self.table(inner, &scope),
                _ if TEXTS.contains(&key) => {}
                _ => {
                    let (mut pieces, first) = (vec![], self.found.leaves.len());
                    self.value(&entry.node, &scope, &mut pieces);
                    if self.found.leaves.len() > first {
                        let path = self.path.iter().map(Step::to_string).collect();
                        let enforced = enforced(entry, entries);
                        self.found.keyed.push(Keyed { path, pieces, enforced });
                    }
                }
            }
            self.path.pop();
        }
    }

    /// A value that is no table, or one in a list. Recursive as deep as the tree is.
    fn value(&mut self, node: &Node, scope: &Scope<'_>, pieces: &mut Vec<Piece>) {
        let mut plain = |text: &str| match pieces.last_mut() {
            Some(Piece::Text(before)) => before.push_str(text),
            _ => pieces.push(Piece::Text(text.to_owned())),
        };
        match &node.value {
            Value::Number(value) => self.leaf(*value, None, node, scope, pieces),
            Value::Text(text) if text.contains(['$', '*']) => {
                match self.reader.sum(text, node.spot) {
                    Some(value) => {
                        let expression = Expression {
                            text: text.clone(),
                            literal: literal(self.reader, text, node.spot),
                            followed: followed(self.reader, &self.defined, text, node.spot),
                        };
                        for name in constants(&self.defined, text) {
                            *self.found.followers.entry(name).or_default() += 1;
                        }
                        self.leaf(value, Some(expression), node, scope, pieces);
                    }
                    None => plain(&quoted(text)),
                }
            }
            Value::Text(text) => plain(&quoted(text)),
            Value::Bool(flag) => plain(if *flag { "true" } else { "false" }),
            Value::Date => plain("1970-01-01"),
            Value::List(list) => {
                plain("[");
                for (index, node) in list.iter().enumerate() {
                    if index > 0 {
                        push(pieces, ", ");
                    }
                    self.path.push(Step::Index(index));
                    self.value(node, scope, pieces);
                    self.path.pop();
                }
                push(pieces, "]");
            }
            Value::Table(entries) => {
                plain("{ ");
                let scope = scope.within(entries);
                for (index, entry) in entries.iter().enumerate() {
                    let comma = if index > 0 { ", " } else { "" };
                    push(pieces, &format!("{comma}{} = ", super::key_text(&entry.key.text)));
                    self.path.push(Step::Key(entry.key.text.clone()));
                    self.value(&entry.node, &scope, pieces);
                    self.path.pop();
                }
                push(pieces, " }");
            }
        }
    }

    fn leaf(
        &mut self,
        value: f64,
        expression: Option<Expression>,
        node: &Node,
        scope: &Scope<'_>,
        pieces: &mut Vec<Piece>,
    ) {
        if self.found.leaves.len() >= MOST || !value.is_finite() {
            return push(pieces, &super::change::number(value));
        }
        pieces.push(Piece::Leaf(self.found.leaves.len()));
        self.found.leaves.push(Leaf {
            path: self.path.clone(),
            value,
            unit: scope.unit(&self.path),
            degrees: self.reader.texts.angles(node.spot) == Angles::Degrees,
            spot: node.spot,
            context: self.reader.texts.context(node.spot).cloned(),
            expression,
            key: self.found.keyed.len(),
        });
    }
}

fn push(pieces: &mut Vec<Piece>, text: &str) {
    match pieces.last_mut() {
        Some(Piece::Text(before)) => before.push_str(text),
        _ => pieces.push(Piece::Text(text.to_owned())),
    }
}

/// A range in an included text has a flag there, which does not hold for that of an including one.
fn enforced(entry: &Entry, beside: &[Entry]) -> Option<bool> {
    if entry.key.text != "range" {
        return None;
    }
    let flag = beside.iter().find(|e| e.key.text == "enforced")?;
    match flag.node.value {
        Value::Bool(on) if flag.node.spot.file > 0 => Some(on),
        _ => None,
    }
}
