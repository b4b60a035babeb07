//! Functions of one argument and of several.

use super::fields::Reader;
use super::tree::{Node, Value};
use condyle_math::function::{
    Curve, Function, FunctionOfSeveral, KnotError, MultivariatePolynomial, PiecewiseLinear,
    Polynomial, SimmSpline,
};

/// The keys of a function of one argument: a curve, and a factor.
pub(super) const FUNCTION: &[&str] =
    &["constant", "linear", "ends", "polynomial", "spline", "lines", "factor"];
/// The keys of a function of several arguments.
pub(super) const SEVERAL: &[&str] = &["slopes", "intercept", "dimension", "order", "coefficients"];

impl Reader<'_> {
    /// A number, or a table with one curve and an optional factor.
    pub(super) fn function(&mut self, node: &Node, label: &str) -> Option<Function> {
        if !matches!(node.value, Value::Table(_)) {
            let wanted = "a number, or a table such as { linear = [1, 0] }";
            if let Value::List(list) = &node.value {
                let message = format!("`{label}` is a list");
                let points = list.iter().all(|point| matches!(point.value, Value::List(_)));
                let help = match points && !list.is_empty() {
                    true => {
                        "write { lines = [...] } for straight lines through these points, or { spline = [...] }"
                    }
                    false => "give a number, or a table such as { linear = [1, 0] }",
                };
                self.texts.error(node.spot, "document/type", message, help);
                return None;
            }
            if !matches!(node.value, Value::Number(_) | Value::Text(_)) {
                self.wrong(node, label, wanted);
                return None;
            }
            return self.number(node, label).map(Function::constant);
        }
        let fields = self.table(node, node.spot, label.to_owned(), FUNCTION);
        let factor = self.number_or(&fields, "factor", 1.0)?;
        let mut curves = fields
            .entries()
            .iter()
            .filter(|e| e.key.text != "factor" && FUNCTION.contains(&e.key.text.as_str()));
        let (first, more) = (curves.next(), curves.next());
        if let Some(more) = more {
            let message = format!("`{label}` has two curves");
            self.texts.error(more.key.spot, "document/exclusive", message, "give one of them");
        }
        let Some(entry) = first else {
            let message = format!("`{label}` has no curve");
            let help = "give one of: constant, linear, ends, polynomial, spline, lines";
            self.texts.error(node.spot, "document/missing", message, help);
            return None;
        };
        let value = &entry.node;
        let curve = match entry.key.text.as_str() {
            "constant" => Curve::Constant(self.number(value, "constant")?),
            "linear" => {
                let [slope, intercept] = self.some::<2>(value, "linear")?;
                Curve::Linear { slope, intercept }
            }
            "polynomial" => {
                Curve::Polynomial(Polynomial::from_ascending(self.numbers(value, "polynomial")?))
            }
            "ends" => {
                // From -1 to 1 through 0, with one slope on each side.
                let [low, high] = self.some::<2>(value, "ends")?;
                let ends = PiecewiseLinear::new(vec![-1.0, 0.0, 1.0], vec![low, 0.0, high]);
                Curve::PiecewiseLinear(self.through(value, ends)?)
            }
            "spline" => {
                let (x, y) = self.pairs(value, "spline")?;
                Curve::SimmSpline(self.through(value, SimmSpline::new(x, y))?)
            }
            _ => {
                let (x, y) = self.pairs(value, "lines")?;
                Curve::PiecewiseLinear(self.through(value, PiecewiseLinear::new(x, y))?)
            }
        };
        Some(Function { factor, curve })
    }

    pub(super) fn through<T>(&mut self, node: &Node, curve: Result<T, KnotError>) -> Option<T> {
        match curve {
            Ok(curve) => Some(curve),
            Err(error) => {
                let spot = match (&node.value, &error) {
                    (
                        Value::List(list),
                        KnotError::NotIncreasing { index, .. } | KnotError::NotFinite { index },
                    ) => list.get(*index).map_or(node.spot, |n| n.spot),
                    _ => node.spot,
                };
                let help = "give pairs [x, y] with x increasing";
                self.texts.error(spot, "document/knots", error.to_string(), help);
                None
            }
        }
    }

    /// A table with slopes or with the coefficients of a polynomial.
    pub(super) fn several(&mut self, node: &Node, label: &str) -> Option<FunctionOfSeveral> {
        let fields = self.table(node, node.spot, label.to_owned(), SEVERAL);
        if let Some(slopes) = fields.get("slopes") {
            let slopes = self.numbers(slopes, "slopes")?;
            let intercept = self.number_or(&fields, "intercept", 0.0)?;
            return Some(FunctionOfSeveral::Linear { slopes, intercept });
        }
        let (Some(dimension), Some(order), Some(given)) =
            (fields.get("dimension"), fields.get("order"), fields.get("coefficients"))
        else {
            let message = format!("`{label}` has neither `slopes` nor a polynomial");
            let help = "give `slopes` (and `intercept`), or `dimension`, `order`, `coefficients`";
            self.texts.error(node.spot, "document/missing", message, help);
            return None;
        };
        let dimension = self.count(dimension, "dimension")?;
        let order = self.count(order, "order")?;
        let coefficients = self.numbers(given, "coefficients")?;
        match MultivariatePolynomial::up_to_order(dimension, order, &coefficients) {
            Ok(polynomial) => Some(FunctionOfSeveral::Polynomial(polynomial)),
            Err(most) => {
                let message = format!(
                    "{} coefficients for dimension {dimension} and order {order}",
                    coefficients.len()
                );
                let help = match most {
                    0..=1_000_000 if (1..=16).contains(&dimension) && order <= 64 => {
                        format!("give at most {most}")
                    }
                    _ => "use at most 16 variables, order 64 and a million terms".to_owned(),
                };
                self.texts.error(given.spot, "document/length", message, help);
                None
            }
        }
    }
}

/// The same function with argument and value in other units: s·f(x / r).
pub(super) fn rescaled(function: Function, argument: f64, value: f64) -> Function {
    let Function { factor, curve } = function;
    if argument == 1.0 && value == 1.0 {
        return Function { factor, curve };
    }
    let stretch = |knots: &mut dyn Iterator<Item = (f64, f64)>| -> (Vec<f64>, Vec<f64>) {
        knots.map(|(x, y)| (argument * x, value * y)).unzip()
    };
    let curve = match curve {
        Curve::Constant(c) => Curve::Constant(value * c),
        Curve::Linear { slope, intercept } => {
            Curve::Linear { slope: slope * value / argument, intercept: intercept * value }
        }
        Curve::Polynomial(p) => {
            let mut scale = value;
            let scaled = p.ascending().iter().map(|c| {
                let c = c * scale;
                scale /= argument;
                c
            });
            Curve::Polynomial(Polynomial::from_ascending(scaled.collect()))
        }
        Curve::PiecewiseLinear(p) => {
            let (x, y) = stretch(&mut p.knots());
            PiecewiseLinear::new(x, y).map_or(Curve::PiecewiseLinear(p), Curve::PiecewiseLinear)
        }
        Curve::SimmSpline(s) => {
            let (x, y) = stretch(&mut s.knots());
            SimmSpline::new(x, y).map_or(Curve::SimmSpline(s), Curve::SimmSpline)
        }
    };
    Function { factor, curve }
}
