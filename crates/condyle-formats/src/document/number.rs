//! Numbers: plain, or sums of products of numbers and constants.

use super::fields::Reader;
use super::template::shallow;
use super::texts::Spot;
use super::tree::{Node, Value};
use condyle_diagnostics::nearest;
use std::collections::HashMap;

/// The value of a named constant.
#[derive(Clone, Copy)]
pub(super) enum Constant {
    Is(f64),
    /// Defined further down than what is being read.
    Below,
    /// Wrong, and reported.
    Wrong,
}

impl Reader<'_> {
    /// A finite number, or an expression of numbers and constants.
    pub(super) fn number(&mut self, node: &Node, label: &str) -> Option<f64> {
        match &node.value {
            Value::Number(n) if n.is_finite() => Some(*n),
            Value::Number(_) => {
                let message = format!("`{label}` is not a finite number");
                self.texts.error(node.spot, "document/not-finite", message, "give a number");
                None
            }
            Value::Text(text) if text.contains(['$', '*']) => self.sum(text, node.spot),
            _ => {
                self.wrong(node, label, "a number");
                None
            }
        }
    }

    /// A sum of products, such as `-$thigh - 0.5 * $height`, with spaces around each sign.
    pub(super) fn sum(&mut self, text: &str, spot: Spot) -> Option<f64> {
        let mut sum = Some(0.0);
        let mut sign = 1.0;
        let mut rest = text.trim();
        loop {
            let next = [" + ", " - "].into_iter().filter_map(|op| Some((rest.find(op)?, op))).min();
            let (at, op) = next.unwrap_or((rest.len(), ""));
            // Read to the end, so that every error is reported.
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
        // Read to the end, so that every error is reported.
        let factors: Vec<Option<f64>> =
            rest.split('*').map(|factor| self.factor(factor.trim(), spot)).collect();
        for factor in factors {
            product *= factor?;
        }
        if product.is_finite() {
            return Some(product);
        }
        let message = format!("`{text}` is not a finite number");
        self.texts.error(spot, "document/not-finite", message, "give smaller numbers");
        None
    }

    fn factor(&mut self, factor: &str, spot: Spot) -> Option<f64> {
        let Some(name) = factor.strip_prefix('$') else {
            let plain = factor.starts_with(|c: char| c.is_ascii_digit() || c == '.');
            if let Some(number) = factor.parse().ok().filter(|_| plain) {
                return Some(number);
            }
            let message = match factor {
                "" => "a factor is missing beside `*`".to_owned(),
                _ => format!("`{factor}` is neither a number nor a constant"),
            };
            let help = "write a product of numbers and constants, such as \"0.245 * $stature\"";
            self.texts.error(spot, "document/number", message, help);
            return None;
        };
        if let Some(node) = self.given.get(&spot.context).and_then(|given| given.get(name)) {
            let (value, at) = (shallow(node).value, node.spot);
            return self.parameter(name, &value, spot, at);
        }
        match self.constants.get(name) {
            Some(Constant::Is(value)) => return Some(*value),
            Some(Constant::Wrong) => return None,
            Some(Constant::Below) => {
                let message = format!("constant `${name}` is defined further down");
                let help = "move it up: a constant may use only those above it";
                self.texts.error(spot, "document/unknown-name", message, help);
                return None;
            }
            None => {}
        }
        let parameters = self.given.get(&spot.context);
        let known = self.constants.keys().chain(parameters.into_iter().flat_map(HashMap::keys));
        self.texts.error_with(spot, "document/unknown-name", || {
            let help = match nearest(name, known.map(String::as_str)) {
                Some(near) => format!("did you mean `${near}`?"),
                None => "define it in the table `constants`".to_owned(),
            };
            let what = if parameters.is_some() { "parameter or constant" } else { "constant" };
            (format!("unknown {what} `${name}`"), help)
        });
        None
    }

    /// The number that an instance gives at `at` for a parameter of its template.
    fn parameter(&mut self, name: &str, value: &Value, spot: Spot, at: Spot) -> Option<f64> {
        match value {
            Value::Number(number) if number.is_finite() => Some(*number),
            Value::Text(text) if text.contains(['$', '*']) => self.sum(text, at),
            value => {
                let message = match value {
                    Value::Number(_) => format!("`${name}` is not a finite number"),
                    Value::Text(text) => format!("`${name}` is `{text}`, not a number"),
                    value => format!("`${name}` is {}, not a number", value.describe()),
                };
                let help = "give a number in the instance";
                self.texts.error(spot, "document/type", message, help);
                None
            }
        }
    }

    /// Defines the constants in the order of the text: each may use those before it.
    pub(super) fn define(&mut self, node: &Node) {
        let entries = self.entries(node, "constants");
        self.constants = entries.iter().map(|e| (e.key.text.clone(), Constant::Below)).collect();
        for entry in entries {
            let number = self.number(&entry.node, &entry.key.text);
            let constant = number.map_or(Constant::Wrong, Constant::Is);
            self.constants.insert(entry.key.text.clone(), constant);
        }
    }
}
