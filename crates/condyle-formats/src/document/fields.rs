//! Typed access to the tree: every wrong type, unknown key and unknown constant is reported once,
//! and reading goes on.

use super::source::{Angles, Name, Texts, Spot};
use super::tree::{Entry, Node, Value};
use condyle_diagnostics::nearest;
use condyle_math::{Affine, EulerOrder, Mat3, Vec3};
use condyle_model::component::Registry;
use std::collections::HashMap;

/// What the tree is read with.
pub(super) struct Reader<'s> {
    pub(super) texts: &'s mut Texts,
    pub(super) constants: HashMap<String, Constant>,
    /// The laws that components of kind `custom` may name.
    pub(super) laws: &'s Registry,
}

/// A table whose keys were looked at.
pub(super) struct Fields<'t> {
    entries: &'t [Entry],
    /// Where its name stands.
    pub(super) spot: Spot,
    /// Its name in messages, such as `segment.tibia_r`.
    pub(super) label: String,
}

impl<'t> Fields<'t> {
    pub(super) fn get(&self, key: &str) -> Option<&'t Node> {
        self.entries.iter().find(|e| e.key.text == key).map(|e| &e.node)
    }

    pub(super) fn entries(&self) -> &'t [Entry] {
        self.entries
    }
}

impl Reader<'_> {
    pub(super) fn wrong(&mut self, node: &Node, label: &str, wanted: &str) {
        let message = format!("`{label}` is {}", node.describe());
        self.texts.error(node.spot, "model/type", message, format!("give {wanted}"));
    }

    /// The entries of a table with any keys.
    pub(super) fn entries<'t>(&mut self, node: &'t Node, label: &str) -> &'t [Entry] {
        match &node.value {
            Value::Table(entries) => entries,
            _ => {
                self.wrong(node, label, "a table");
                &[]
            }
        }
    }

    /// A table with known keys; others are reported.
    pub(super) fn table<'t>(
        &mut self,
        node: &'t Node,
        spot: Spot,
        label: String,
        known: &'static [&'static str],
    ) -> Fields<'t> {
        let entries = self.entries(node, &label);
        for entry in entries {
            if !known.contains(&entry.key.text.as_str()) {
                self.unknown_key(&entry.key, &label, known);
            }
        }
        Fields { entries, spot, label }
    }

    pub(super) fn unknown_key(&mut self, key: &Name, label: &str, known: &[&str]) {
        let help = match nearest(&key.text, known.iter().copied()) {
            Some(near) => format!("did you mean `{near}`?"),
            None => format!("known keys are: {}", known.join(", ")),
        };
        let message = match label {
            "" => format!("unknown key `{}`", key.text),
            label => format!("unknown key `{}` in [{label}]", key.text),
        };
        self.texts.error(key.spot, "model/unknown-key", message, help);
    }

    pub(super) fn missing(&mut self, fields: &Fields<'_>, key: &str, wanted: &str) {
        let message = format!("[{}] has no `{key}`", fields.label);
        self.texts.error(fields.spot, "model/missing", message, format!("give {wanted}"));
    }

    /// What a number at this spot has to be multiplied with, if it is an angle.
    pub(super) fn angle_unit(&self, spot: Spot) -> f64 {
        match self.texts.angles(spot) {
            Angles::Degrees => std::f64::consts::PI / 180.0,
            Angles::Radians => 1.0,
        }
    }

    pub(super) fn text(&mut self, node: &Node, label: &str) -> Option<Name> {
        match &node.value {
            Value::Text(text) => Some(Name { text: text.clone(), spot: node.spot }),
            _ => {
                self.wrong(node, label, "a text");
                None
            }
        }
    }

    pub(super) fn flag(&mut self, node: Option<&Node>, label: &str, default: bool) -> bool {
        match node {
            None => default,
            Some(Node { value: Value::Bool(b), .. }) => *b,
            Some(node) => {
                self.wrong(node, label, "true or false");
                default
            }
        }
    }

    /// A whole number from 0.
    pub(super) fn count(&mut self, node: &Node, label: &str) -> Option<usize> {
        let n = self.number(node, label)?;
        if (0.0..=1e6).contains(&n) && n.fract() == 0.0 {
            return Some(n as usize);
        }
        let message = format!("`{label}` is {n}");
        self.texts.error(node.spot, "model/type", message, "give a whole number from 0");
        None
    }

    pub(super) fn list<'t>(&mut self, node: &'t Node, label: &str) -> Option<&'t [Node]> {
        match &node.value {
            Value::List(list) => Some(list),
            _ => {
                self.wrong(node, label, "a list");
                None
            }
        }
    }

    pub(super) fn numbers(&mut self, node: &Node, label: &str) -> Option<Vec<f64>> {
        let list = self.list(node, label)?;
        // All of them are read, so that all that are wrong are named.
        let numbers: Vec<Option<f64>> = list.iter().map(|n| self.number(n, label)).collect();
        numbers.into_iter().collect()
    }

    /// Exactly `N` numbers.
    pub(super) fn some<const N: usize>(&mut self, node: &Node, label: &str) -> Option<[f64; N]> {
        let numbers = self.numbers(node, label)?;
        let count = numbers.len();
        match numbers.try_into() {
            Ok(numbers) => Some(numbers),
            Err(_) => {
                let message = format!("`{label}` has {count} numbers");
                self.texts.error(node.spot, "model/length", message, format!("give {N}"));
                None
            }
        }
    }

    pub(super) fn vector(&mut self, node: &Node, label: &str) -> Option<Vec3> {
        self.some::<3>(node, label).map(Vec3::from)
    }

    /// A list of pairs: the knots of a curve.
    pub(super) fn pairs(&mut self, node: &Node, label: &str) -> Option<(Vec<f64>, Vec<f64>)> {
        let list = self.list(node, label)?;
        let pairs: Vec<Option<[f64; 2]>> = list.iter().map(|n| self.some(n, label)).collect();
        let pairs: Option<Vec<[f64; 2]>> = pairs.into_iter().collect();
        Some(pairs?.into_iter().map(|[x, y]| (x, y)).unzip())
    }

    /// A name, or a list of names; the second answer tells whether it was a list.
    pub(super) fn names(&mut self, node: &Node, label: &str) -> (Vec<Name>, bool) {
        match &node.value {
            Value::List(list) => (list.iter().filter_map(|n| self.text(n, label)).collect(), true),
            _ => (self.text(node, label).into_iter().collect(), false),
        }
    }

    /// A rigid (or any) frame from keys such as `at`, `turn`, `order`, `matrix`.
    pub(super) fn frame(&mut self, fields: &Fields<'_>, keys: [&str; 4]) -> Affine {
        let [at, turn, order, matrix] = keys;
        let point = fields.get(at).and_then(|n| self.vector(n, at)).unwrap_or(Vec3::ZERO);
        let mut linear = Mat3::IDENTITY;
        if let Some(node) = fields.get(turn) {
            let unit = self.angle_unit(node.spot);
            let named = fields.get(order).and_then(|n| self.order(n, order));
            let angles = self.some::<3>(node, turn).unwrap_or_default().map(|a| unit * a);
            linear = named.unwrap_or(EulerOrder::XYZ).to_mat3(angles);
        } else if let Some(node) = fields.get(order) {
            let message = format!("`{order}` stands without `{turn}`");
            let help = format!("give the three angles of `{turn}`, or leave `{order}` away");
            self.texts.error(node.spot, "model/missing", message, help);
        }
        if let Some(node) = fields.get(matrix) {
            if fields.get(turn).is_some() {
                let message = format!("both `{turn}` and `{matrix}` are given");
                self.texts.error(node.spot, "model/exclusive", message, "give one of them");
            }
            let rows = self.list(node, matrix).unwrap_or_default();
            let rows: Vec<Vec3> = rows.iter().filter_map(|n| self.vector(n, matrix)).collect();
            match rows[..] {
                [x, y, z] => linear = Mat3::from_columns(x, y, z).transpose(),
                _ => {
                    let message = format!("`{matrix}` has {} rows", rows.len());
                    self.texts.error(node.spot, "model/length", message, "give 3 rows of 3");
                }
            }
        }
        Affine::new(linear, point)
    }

    pub(super) fn order(&mut self, node: &Node, label: &str) -> Option<EulerOrder> {
        let name = self.text(node, label)?;
        match name.text.parse() {
            Ok(order) => Some(order),
            Err(_) => {
                let message = format!("unknown rotation order `{}`", name.text);
                let help = "give three of x, y, z with none twice in a row, such as `zxy`";
                self.texts.error(name.spot, "model/order", message, help);
                None
            }
        }
    }
}
