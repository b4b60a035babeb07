//! Typed access to the tree: every wrong type, unknown key and unknown constant is reported once,
//! and reading goes on.

use super::source::{Angles, Name, Sources, Spot};
use super::tree::{Entry, Node, Value};
use condyle_diagnostics::nearest;
use condyle_math::{Affine, EulerOrder, Mat3, Vec3};
use condyle_model::component::Registry;
use std::collections::HashMap;

/// What the tree is read with.
pub(super) struct Reader<'s> {
    pub(super) sources: &'s mut Sources,
    pub(super) constants: HashMap<String, Constant>,
    /// The laws that components of kind `custom` may name.
    pub(super) laws: &'s Registry,
}

/// A number with a name.
#[derive(Clone, Copy)]
pub(super) enum Constant {
    Is(f64),
    /// Its text has not come yet.
    Below,
    /// Something is wrong with it, which was said.
    Wrong,
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
        self.sources.error(node.spot, "model/type", message, format!("give {wanted}"));
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
        self.sources.error(key.spot, "model/unknown-key", message, help);
    }

    pub(super) fn missing(&mut self, fields: &Fields<'_>, key: &str, wanted: &str) {
        let message = format!("[{}] has no `{key}`", fields.label);
        self.sources.error(fields.spot, "model/missing", message, format!("give {wanted}"));
    }

    /// A finite number, or the name of one.
    pub(super) fn number(&mut self, node: &Node, label: &str) -> Option<f64> {
        match &node.value {
            Value::Number(n) if n.is_finite() => Some(*n),
            Value::Number(_) => {
                let message = format!("`{label}` is not a finite number");
                self.sources.error(node.spot, "model/not-finite", message, "give a number");
                None
            }
            Value::Text(text) if text.contains(['$', '*']) => self.sum(text, node.spot),
            _ => {
                self.wrong(node, label, "a number");
                None
            }
        }
    }

    /// A sum of products, such as `-$thigh - 0.5 * $height`; its signs stand between spaces.
    fn sum(&mut self, text: &str, spot: Spot) -> Option<f64> {
        let mut sum = Some(0.0);
        let mut sign = 1.0;
        let mut rest = text.trim();
        loop {
            let next = [" + ", " - "].into_iter().filter_map(|op| Some((rest.find(op)?, op))).min();
            let (at, op) = next.unwrap_or((rest.len(), ""));
            // All of them are read, so that all that are wrong are named.
            let term = self.product(&rest[..at], spot);
            sum = sum.zip(term).map(|(sum, term)| sum + sign * term);
            if op.is_empty() {
                return sum;
            }
            sign = if op == " - " { -1.0 } else { 1.0 };
            rest = &rest[at + op.len()..];
        }
    }

    /// A product of numbers and constants, such as `-0.5 * $half`.
    fn product(&mut self, text: &str, spot: Spot) -> Option<f64> {
        let (sign, rest) = match text.trim_start().strip_prefix('-') {
            Some(rest) => (-1.0, rest),
            None => (1.0, text),
        };
        let mut product = sign;
        // All of them are read, so that all that are wrong are named.
        let factors: Vec<Option<f64>> =
            rest.split('*').map(|factor| self.factor(factor.trim(), spot)).collect();
        for factor in factors {
            product *= factor?;
        }
        if product.is_finite() {
            return Some(product);
        }
        let message = format!("`{text}` is not a finite number");
        self.sources.error(spot, "model/not-finite", message, "give smaller numbers");
        None
    }

    fn factor(&mut self, factor: &str, spot: Spot) -> Option<f64> {
        let Some(name) = factor.strip_prefix('$') else {
            let plain = factor.starts_with(|c: char| c.is_ascii_digit() || c == '.');
            if let Some(number) = factor.parse().ok().filter(|_| plain) {
                return Some(number);
            }
            let message = match factor {
                "" => "a number is missing beside a `*`".to_owned(),
                _ => format!("`{factor}` is neither a number nor a constant"),
            };
            let help = "write a product of them, such as \"0.245 * $stature\"";
            self.sources.error(spot, "model/number", message, help);
            return None;
        };
        match self.constants.get(name) {
            Some(Constant::Is(value)) => return Some(*value),
            Some(Constant::Wrong) => return None,
            Some(Constant::Below) => {
                let message = format!("constant `${name}` is given further down");
                let help = "move it up: a constant may use those above it";
                self.sources.error(spot, "model/unknown-name", message, help);
                return None;
            }
            None => {}
        }
        let known = self.constants.keys().map(String::as_str);
        self.sources.error_with(spot, "model/unknown-name", || {
            let help = match nearest(name, known) {
                Some(near) => format!("did you mean `${near}`?"),
                None => "name it in the table `constants`".to_owned(),
            };
            (format!("unknown constant `${name}`"), help)
        });
        None
    }

    /// What a number at this spot has to be multiplied with, if it is an angle.
    pub(super) fn angle_unit(&self, spot: Spot) -> f64 {
        match self.sources.angles(spot) {
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
        self.sources.error(node.spot, "model/type", message, "give a whole number from 0");
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
                self.sources.error(node.spot, "model/length", message, format!("give {N}"));
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
            self.sources.error(node.spot, "model/missing", message, help);
        }
        if let Some(node) = fields.get(matrix) {
            if fields.get(turn).is_some() {
                let message = format!("both `{turn}` and `{matrix}` are given");
                self.sources.error(node.spot, "model/exclusive", message, "give one of them");
            }
            let rows = self.list(node, matrix).unwrap_or_default();
            let rows: Vec<Vec3> = rows.iter().filter_map(|n| self.vector(n, matrix)).collect();
            match rows[..] {
                [x, y, z] => linear = Mat3::from_columns(x, y, z).transpose(),
                _ => {
                    let message = format!("`{matrix}` has {} rows", rows.len());
                    self.sources.error(node.spot, "model/length", message, "give 3 rows of 3");
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
                self.sources.error(name.spot, "model/order", message, help);
                None
            }
        }
    }
}
