//! Numbers: plain, or sums of products of numbers and constants.

use super::fields::Reader;
use super::texts::Spot;
use super::tree::{Node, Value};
use condyle_diagnostics::nearest;

/// A number with a name.
#[derive(Clone, Copy)]
pub(super) enum Constant {
    Is(f64),
    /// Its text has not come yet.
    Below,
    /// Something is wrong with it, which was said.
    Wrong,
}

impl Reader<'_> {
    /// A finite number, or the name of one.
    pub(super) fn number(&mut self, node: &Node, label: &str) -> Option<f64> {
        match &node.value {
            Value::Number(n) if n.is_finite() => Some(*n),
            Value::Number(_) => {
                let message = format!("`{label}` is not a finite number");
                self.texts.error(node.spot, "model/not-finite", message, "give a number");
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
        self.texts.error(spot, "model/not-finite", message, "give smaller numbers");
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
            self.texts.error(spot, "model/number", message, help);
            return None;
        };
        match self.constants.get(name) {
            Some(Constant::Is(value)) => return Some(*value),
            Some(Constant::Wrong) => return None,
            Some(Constant::Below) => {
                let message = format!("constant `${name}` is given further down");
                let help = "move it up: a constant may use those above it";
                self.texts.error(spot, "model/unknown-name", message, help);
                return None;
            }
            None => {}
        }
        let known = self.constants.keys().map(String::as_str);
        self.texts.error_with(spot, "model/unknown-name", || {
            let help = match nearest(name, known) {
                Some(near) => format!("did you mean `${near}`?"),
                None => "name it in the table `constants`".to_owned(),
            };
            (format!("unknown constant `${name}`"), help)
        });
        None
    }
}
