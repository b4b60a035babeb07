//! Templates: tables that are written once, and repeated for each row of a list.
//!
//! ```text
//! template.T = parameters (names), defaults (of some of them), instances (rows of values in the
//!              order of the parameters, or tables of values by name), and the tables to repeat
//! "{name}"   = in a key or a string: the value of a parameter, a name or a whole number
//! "$name"    = alone: the value of any type; in a sum of products: the number
//! ```
//!
//! Instances are filled in and joined with the other tables before anything is read, so that all that
//! follows (names, mirrored sides, checks) knows nothing of them. A node of an instance keeps the place
//! in the template, a value the place in its row; the other one of the two is its [`Context`].

mod fill;
mod join;

#[cfg(feature = "edit")]
pub(super) use fill::dollars;
pub(super) use fill::shallow;

use super::fields::{Fields, Reader};
use super::texts::{Context, Name, Spot};
use super::tree::{Entry, Node, Value};
use condyle_diagnostics::{did_you_mean, listed};
use fill::Filler;
use std::collections::HashMap;

/// The keys of a template, beside the tables that it repeats.
pub(super) const TEMPLATE: &[&str] = &["parameters", "defaults", "instances"];
/// How large all instances together may be, in bytes.
const LARGEST: usize = 1 << 24;
/// What a value counts, beside the letters of its text.
const VALUE: usize = 64;

/// What an instance gives for the parameters of its template.
pub(super) type Given = HashMap<String, Node>;

struct Template<'t> {
    name: &'t Name,
    parameters: Vec<Parameter<'t>>,
    /// The tables to repeat.
    body: Vec<&'t Entry>,
}

struct Parameter<'t> {
    name: Name,
    default: Option<&'t Node>,
}

/// A row of a template.
struct Instance<'t> {
    name: String,
    spot: Spot,
    /// One for each parameter.
    values: Vec<&'t Node>,
}

/// Replaces the templates among the entries by their instances; `None` after an error.
///
/// `repeated` are the tables that a template may hold. Where an instance and the document give the
/// same key, the document's value is kept.
pub(super) fn expand(
    reader: &mut Reader<'_>,
    repeated: &[&str],
    mut entries: Vec<Entry>,
) -> Option<Vec<Entry>> {
    let Some(index) = entries.iter().position(|e| e.key.text == "template") else {
        return Some(entries);
    };
    let templates = entries.remove(index).node;
    let before = reader.texts.count();
    let (mut made, mut left) = (vec![], LARGEST);
    for entry in reader.entries(&templates, "template") {
        let Some((template, instances)) = reader.template(entry, repeated) else { continue };
        let filled = reader.instances(&template, &instances, &mut left, &mut made);
        if filled.is_none() {
            let name = &template.name.text;
            let message = format!("the instances of template `{name}` are too large");
            let help = format!("write fewer, or shorter names: all have at most {LARGEST} bytes");
            reader.texts.error(template.name.spot, "document/template-size", message, help);
            break;
        }
    }
    // Whatever names a wrong instance is not wrong itself.
    if reader.texts.count() > before {
        return None;
    }
    entries.extend(made);
    let entries = join::join(reader.texts, entries);
    (reader.texts.count() == before).then_some(entries)
}

impl Reader<'_> {
    /// A template and its instances; `None` after an error.
    fn template<'t>(
        &mut self,
        entry: &'t Entry,
        repeated: &[&str],
    ) -> Option<(Template<'t>, Vec<Instance<'t>>)> {
        let before = self.texts.count();
        let name = &entry.key;
        let label = format!("template.{}", name.text);
        let known = [TEMPLATE, repeated, &["template"]].concat();
        let fields = self.table(&entry.node, name.spot, label, &known);
        if let Some(nested) = fields.entries().iter().find(|e| e.key.text == "template") {
            let message = "a template cannot hold templates";
            let help = "write both side by side, each with its instances";
            self.texts.error(nested.key.spot, "document/template", message, help);
        }
        let parameters = self.declared(&fields)?;
        let is_body = |e: &&Entry| repeated.contains(&e.key.text.as_str());
        let body = fields.entries().iter().filter(is_body).collect();
        let template = Template { name, parameters, body };
        self.uses(&template);
        let rows = match fields.get("instances") {
            Some(node) => self.list(node, "instances").unwrap_or_default(),
            // An included template may be there for others.
            None if name.spot.file > 0 => &[],
            None => {
                let message = format!("template `{}` has no instances", name.text);
                let help = "list them as `instances`: a row of values for each";
                self.hint(name.spot, message, help);
                &[]
            }
        };
        // To the end, so that every error is reported.
        let instances: Vec<Option<Instance<'_>>> =
            rows.iter().map(|row| self.instance(&template, row)).collect();
        let instances = instances.into_iter().collect::<Option<Vec<_>>>()?;
        (self.texts.count() == before).then_some((template, instances))
    }

    /// The parameters with their defaults; `None` after an error.
    fn declared<'t>(&mut self, fields: &Fields<'t>) -> Option<Vec<Parameter<'t>>> {
        let before = self.texts.count();
        let wanted = "the names of what differs between its instances, such as [\"name\"]";
        let node = self.required(fields, "parameters", wanted)?;
        let names = self.names(node, "parameters").0;
        let mut parameters: Vec<Parameter<'t>> = vec![];
        for name in names {
            let letter = |c: char| c.is_alphanumeric() || c == '_';
            if name.text.is_empty() || !name.text.chars().all(letter) {
                let message = format!("a parameter cannot be called `{}`", name.text);
                let help = "use letters, digits and underscores";
                self.texts.error(name.spot, "document/template", message, help);
            } else if parameters.iter().any(|p| p.name.text == name.text) {
                let message = format!("there are two parameters `{}`", name.text);
                self.texts.error(name.spot, "document/duplicate", message, "remove one of them");
            } else {
                parameters.push(Parameter { name, default: None });
            }
        }
        if let Some(node) = fields.get("defaults") {
            for entry in self.entries(node, "defaults") {
                match parameters.iter_mut().find(|p| p.name.text == entry.key.text) {
                    Some(parameter) => parameter.default = Some(&entry.node),
                    None => self.unknown_parameter(&entry.key, &fields.label, &parameters),
                }
            }
        }
        (self.texts.count() == before).then_some(parameters)
    }

    fn unknown_parameter(&mut self, key: &Name, label: &str, parameters: &[Parameter<'_>]) {
        let known: Vec<&str> = parameters.iter().map(|p| p.name.text.as_str()).collect();
        let all = || match &known[..] {
            [] => "it has none".to_owned(),
            known => format!("its parameters are: {}", known.join(", ")),
        };
        let help = did_you_mean(&key.text, known.iter().copied(), all);
        let message = format!("[{label}] has no parameter `{}`", key.text);
        self.texts.error(key.spot, "document/unknown-name", message, help);
    }

    /// A row: values in the order of the parameters or by name, or the value of the first.
    fn instance<'t>(&mut self, template: &Template<'t>, row: &'t Node) -> Option<Instance<'t>> {
        let parameters = &template.parameters;
        let label = format!("template.{}", template.name.text);
        let before = self.texts.count();
        let mut values: Vec<Option<&Node>> = parameters.iter().map(|p| p.default).collect();
        match &row.value {
            Value::List(cells) => {
                if cells.len() > parameters.len() {
                    let (has, takes) = (cells.len(), parameters.len());
                    let message = format!("an instance of [{label}] has {has} values, not {takes}");
                    let help = format!("give {}", listed(parameters.iter().map(|p| &p.name.text)));
                    self.texts.error(row.spot, "document/length", message, help);
                }
                values.iter_mut().zip(cells).for_each(|(value, cell)| *value = Some(cell));
            }
            Value::Table(cells) => {
                for cell in cells {
                    match parameters.iter().position(|p| p.name.text == cell.key.text) {
                        Some(index) => values[index] = Some(&cell.node),
                        None => self.unknown_parameter(&cell.key, &label, parameters),
                    }
                }
            }
            Value::Text(_) | Value::Number(_) => {
                if let Some(first) = values.first_mut() {
                    *first = Some(row);
                }
            }
            _ => self.wrong(row, "instances", "a list of values, or a table of them by name"),
        }
        let absent = parameters.iter().zip(&values).filter(|(_, value)| value.is_none());
        let absent: Vec<&str> = absent.map(|(p, _)| p.name.text.as_str()).collect();
        let name = match values.first().copied().flatten().map(|node| &node.value) {
            Some(Value::Text(text)) => text.clone(),
            Some(Value::Number(number)) => number.to_string(),
            _ => self.texts.line(row.spot),
        };
        if !absent.is_empty() && self.texts.count() == before {
            let message = format!("instance `{name}` of [{label}] has no {}", listed(absent));
            let all = listed(parameters.iter().map(|p| &p.name.text));
            let help = format!("give {all}, or a default in `defaults`");
            self.texts.error(row.spot, "document/missing", message, help);
        }
        let values = values.into_iter().collect::<Option<Vec<_>>>()?;
        Some(Instance { name, spot: row.spot, values })
    }

    /// Adds what the instances give; `None` if it is too large.
    fn instances(
        &mut self,
        template: &Template<'_>,
        instances: &[Instance<'_>],
        left: &mut usize,
        made: &mut Vec<Entry>,
    ) -> Option<()> {
        let mut uses = HashMap::new();
        for instance in instances {
            let cost = VALUE * (1 + instance.values.len());
            *left = left.checked_sub(cost + instance.name.len())?;
            let context = self.texts.add_context(Context::Instance {
                template: template.name.text.clone(),
                name: instance.name.clone(),
                at: instance.spot,
                of: instances.len(),
            });
            let given: Given = template
                .parameters
                .iter()
                .zip(&instance.values)
                .map(|(parameter, node)| (parameter.name.text.clone(), shallow(node)))
                .collect();
            for node in given.values() {
                if let Value::Text(text) = &node.value {
                    *left = left.checked_sub(text.len())?;
                }
            }
            self.given.insert(context, given);
            let mut filler =
                Filler { texts: self.texts, template, instance, context, left, uses: &mut uses };
            for entry in &template.body {
                made.push(filler.entry(entry)?);
            }
        }
        Some(())
    }
}
