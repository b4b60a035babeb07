//! A template filled in with the values of an instance.

use super::{Instance, Template, VALUE};
use crate::document::fields::Reader;
use crate::document::texts::{Context, Name, Spot, Texts};
use crate::document::tree::{Entry, Node, Value};
use condyle_diagnostics::{Diagnostic, Severity, did_you_mean};
use std::collections::{HashMap, HashSet};

/// A part of a string of a template.
#[derive(Debug, PartialEq)]
enum Piece<'t> {
    Text(&'t str),
    /// The value of a parameter: `{name}`.
    Value(&'t str),
    /// A brace that is not closed or not open.
    Brace,
}

/// Splits a string at its parameters in braces; a double brace is a single one.
fn pieces(text: &str) -> Vec<Piece<'_>> {
    let mut pieces = vec![];
    let mut rest = text;
    while let Some(at) = rest.find(['{', '}']) {
        let (before, brace) = rest.split_at(at);
        pieces.push(Piece::Text(before));
        let (piece, used) = if brace.starts_with("{{") || brace.starts_with("}}") {
            (Piece::Text(&brace[..1]), 2)
        } else {
            match brace.find('}') {
                Some(end) if end > 0 => (Piece::Value(&brace[1..end]), end + 1),
                _ => (Piece::Brace, 1),
            }
        };
        pieces.push(piece);
        rest = &brace[used..];
    }
    pieces.push(Piece::Text(rest));
    pieces.retain(|piece| *piece != Piece::Text(""));
    pieces
}

/// The parameters and constants that a string names as `$name`.
pub(in super::super) fn dollars(text: &str) -> impl Iterator<Item = &str> {
    let letter = |c: char| c.is_alphanumeric() || c == '_';
    text.split('$')
        .skip(1)
        .map(move |rest| &rest[..rest.find(|c| !letter(c)).unwrap_or(rest.len())])
}

/// The node without what it holds.
pub(in super::super) fn shallow(node: &Node) -> Node {
    let value = match &node.value {
        Value::Text(text) => Value::Text(text.clone()),
        Value::Number(number) => Value::Number(*number),
        Value::Bool(flag) => Value::Bool(*flag),
        Value::Date => Value::Date,
        Value::List(_) => Value::List(vec![]),
        Value::Table(_) => Value::Table(vec![]),
    };
    Node { value, spot: node.spot }
}

impl Reader<'_> {
    /// Reports names in braces that are no parameters, and parameters that are not used.
    pub(super) fn uses(&mut self, template: &Template<'_>) {
        let mut used = HashSet::new();
        for entry in &template.body {
            self.uses_of(template, &entry.node, &mut used);
        }
        for parameter in &template.parameters {
            let name = &parameter.name;
            if !used.contains(&name.text) {
                let template = &template.name.text;
                let message = format!("template `{template}` does not use `{}`", name.text);
                let help = format!("write \"${0}\" for its value, {{{0}}} in a name", name.text);
                self.hint(name.spot, message, help);
            }
        }
    }

    pub(super) fn hint(&mut self, spot: Spot, message: String, help: impl Into<String>) {
        let said = self.texts.said(spot, Severity::Warning, "document/template", message);
        self.texts.warn(spot, Diagnostic::with_help(said, help));
    }

    fn uses_of(&mut self, template: &Template<'_>, node: &Node, used: &mut HashSet<String>) {
        match &node.value {
            Value::Text(text) => {
                used.extend(dollars(text).map(str::to_owned));
                self.braces(template, text, node.spot, used);
            }
            Value::List(list) => list.iter().for_each(|node| self.uses_of(template, node, used)),
            Value::Table(entries) => {
                for entry in entries {
                    self.braces(template, &entry.key.text, entry.key.spot, used);
                    self.uses_of(template, &entry.node, used);
                }
            }
            Value::Number(_) | Value::Bool(_) | Value::Date => {}
        }
    }

    fn braces(
        &mut self,
        template: &Template<'_>,
        text: &str,
        spot: Spot,
        used: &mut HashSet<String>,
    ) {
        for piece in pieces(text) {
            let known = || template.parameters.iter().map(|p| p.name.text.as_str());
            match piece {
                Piece::Value(name) if known().any(|k| k == name) => {
                    _ = used.insert(name.to_owned())
                }
                Piece::Value(name) => {
                    let label = &template.name.text;
                    let message = format!("template `{label}` has no parameter `{name}`");
                    let all = || "add it to `parameters`, or write {{ for a brace".to_owned();
                    let help = did_you_mean(name, known(), all);
                    self.texts.error(spot, "document/unknown-name", message, help);
                }
                Piece::Brace => {
                    let message = format!("`{text}` has a brace without its other half");
                    let help = "write {name} for a parameter, {{ or }} for a brace";
                    self.texts.error(spot, "document/template", message, help);
                }
                Piece::Text(_) => {}
            }
        }
    }
}

/// Fills in one instance.
pub(super) struct Filler<'f, 't> {
    pub(super) texts: &'f mut Texts,
    pub(super) template: &'f Template<'t>,
    pub(super) instance: &'f Instance<'t>,
    pub(super) context: u32,
    /// How many bytes may still be made.
    pub(super) left: &'f mut usize,
    /// The context of each value that is used, by where it is used.
    pub(super) uses: &'f mut HashMap<Spot, u32>,
}

impl<'t> Filler<'_, 't> {
    /// An entry of the template for this instance; `None` if it is too large. Recursive as deep as
    /// the tree is.
    pub(super) fn entry(&mut self, entry: &Entry) -> Option<Entry> {
        let text = self.text(&entry.key.text, entry.key.spot)?;
        let spot = entry.key.spot.within(self.context);
        Some(Entry { key: Name { text, spot }, node: self.node(&entry.node)? })
    }

    fn node(&mut self, node: &Node) -> Option<Node> {
        let value = match &node.value {
            Value::Text(text) => {
                if let Some((name, value)) = self.whole(text) {
                    return self.value(name, value, node.spot);
                }
                Value::Text(self.text(text, node.spot)?)
            }
            Value::List(list) => {
                Value::List(list.iter().map(|node| self.node(node)).collect::<Option<_>>()?)
            }
            Value::Table(entries) => {
                Value::Table(entries.iter().map(|e| self.entry(e)).collect::<Option<_>>()?)
            }
            _ => return self.pay(0).map(|()| shallow(node).moved(self.context)),
        };
        self.pay(0)?;
        Some(Node { value, spot: node.spot.within(self.context) })
    }

    fn pay(&mut self, letters: usize) -> Option<()> {
        *self.left = self.left.checked_sub(VALUE + letters)?;
        Some(())
    }

    fn given(&self, name: &str) -> Option<&'t Node> {
        let index = self.template.parameters.iter().position(|p| p.name.text == name)?;
        self.instance.values.get(index).copied()
    }

    /// The parameter for whose value a string stands: `"$name"`, or `"{name}"` of a name.
    fn whole<'n>(&self, text: &'n str) -> Option<(&'n str, &'t Node)> {
        if let Some(name) = text.strip_prefix('$') {
            return Some((name, self.given(name)?));
        }
        match pieces(text)[..] {
            [Piece::Value(name)] => {
                let node = self.given(name)?;
                matches!(node.value, Value::Text(_)).then_some((name, node))
            }
            _ => None,
        }
    }

    /// A copy of a value, which keeps its own place.
    fn value(&mut self, name: &str, value: &Node, at: Spot) -> Option<Node> {
        let context = match self.uses.get(&at) {
            Some(known) => *known,
            None => {
                let template = self.template.name.text.clone();
                let context = Context::Parameter { template, name: name.to_owned(), at };
                let context = self.texts.add_context(context);
                self.uses.insert(at, context);
                context
            }
        };
        self.copy(value, context)
    }

    fn copy(&mut self, node: &Node, context: u32) -> Option<Node> {
        self.pay(if let Value::Text(text) = &node.value { text.len() } else { 0 })?;
        let value = match &node.value {
            Value::List(list) => {
                Value::List(list.iter().map(|n| self.copy(n, context)).collect::<Option<_>>()?)
            }
            Value::Table(entries) => {
                let copy = |e: &Entry| {
                    let spot = e.key.spot.within(context);
                    let key = Name { text: e.key.text.clone(), spot };
                    self.pay(key.text.len())?;
                    Some(Entry { key, node: self.copy(&e.node, context)? })
                };
                Value::Table(entries.iter().map(copy).collect::<Option<_>>()?)
            }
            _ => return Some(shallow(node).moved(context)),
        };
        Some(Node { value, spot: node.spot.within(context) })
    }

    /// A string with its parameters filled in.
    fn text(&mut self, text: &str, spot: Spot) -> Option<String> {
        let mut filled = String::new();
        for piece in pieces(text) {
            let name = match piece {
                Piece::Text(text) => {
                    filled.push_str(text);
                    continue;
                }
                Piece::Value(name) => name,
                Piece::Brace => continue,
            };
            let Some(node) = self.given(name) else { continue };
            match &node.value {
                Value::Text(text) => filled.push_str(text),
                Value::Number(n) if n.fract() == 0.0 && n.abs() < 1e15 => {
                    filled.push_str(&n.to_string());
                }
                _ => {
                    let what = node.describe();
                    let message = format!("`{{{name}}}` in a name is {what}");
                    let help = format!(
                        "give a string or a whole number, or write \"${name}\" alone for its value"
                    );
                    let spot = spot.within(self.context);
                    self.texts.error(spot, "document/type", message, help);
                }
            }
            self.left.checked_sub(filled.len())?;
        }
        self.pay(filled.len())?;
        Some(filled)
    }
}

impl Node {
    fn moved(self, context: u32) -> Self {
        Self { spot: self.spot.within(context), ..self }
    }
}
