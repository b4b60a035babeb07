//! Functions as elements.

use condyle_math::function::{Curve, Function, FunctionOfSeveral};
use std::fmt::Write;

/// Numbers with the fewest digits that give them back.
pub(in crate::opensim) fn numbers(all: impl IntoIterator<Item = f64>) -> String {
    let mut text = String::new();
    for number in all {
        if !text.is_empty() {
            text.push(' ');
        }
        let _ = if number == 0.0 { write!(text, "0") } else { write!(text, "{number:?}") };
    }
    text
}

/// A function of one number; `coupled` keeps a slope of ±1 from being taken as the coordinate itself.
pub(in crate::opensim) fn one(function: &Function, coupled: bool) -> String {
    let Function { factor, curve } = function;
    let inner = match curve {
        Curve::Constant(value) => {
            return format!("<Constant><value>{}</value></Constant>", numbers([factor * value]));
        }
        Curve::Linear { slope, intercept } => {
            let (slope, intercept) = (factor * slope, factor * intercept);
            let text = numbers([slope, intercept]);
            let text =
                format!("<LinearFunction><coefficients>{text}</coefficients></LinearFunction>");
            return if coupled && slope.abs() == 1.0 { multiplied(&text, 1.0) } else { text };
        }
        Curve::Polynomial(p) => {
            let text = numbers(p.ascending().iter().rev().copied());
            format!("<PolynomialFunction><coefficients>{text}</coefficients></PolynomialFunction>")
        }
        Curve::PiecewiseLinear(p) => knots("PiecewiseLinearFunction", p.knots()),
        Curve::SimmSpline(s) => knots("SimmSpline", s.knots()),
    };
    if *factor == 1.0 { inner } else { multiplied(&inner, *factor) }
}

fn multiplied(inner: &str, factor: f64) -> String {
    let scale = numbers([factor]);
    format!(
        "<MultiplierFunction><function>{inner}</function><scale>{scale}</scale></MultiplierFunction>"
    )
}

fn knots(name: &str, knots: impl Iterator<Item = (f64, f64)>) -> String {
    let (x, y): (Vec<f64>, Vec<f64>) = knots.unzip();
    if let ([_], [y]) = (&x[..], &y[..]) {
        return format!("<Constant><value>{}</value></Constant>", numbers([*y]));
    }
    format!("<{name}><x>{}</x><y>{}</y></{name}>", numbers(x), numbers(y))
}

/// A function of several numbers.
pub(in crate::opensim) fn several(function: &FunctionOfSeveral) -> String {
    match function {
        FunctionOfSeveral::Linear { slopes, intercept } => {
            let text = numbers(slopes.iter().copied().chain([*intercept]));
            format!("<LinearFunction><coefficients>{text}</coefficients></LinearFunction>")
        }
        FunctionOfSeveral::Polynomial(p) => {
            let (dimension, order) = (p.dimension(), p.order());
            // OpenSim wants all coefficients of that order.
            let mut count = 1usize;
            for k in 1..=order {
                count = count * (dimension + k) / k;
            }
            let mut all = p.coefficients().to_vec();
            all.resize(count.max(all.len()), 0.0);
            let text = numbers(all);
            format!(
                "<MultivariatePolynomialFunction><coefficients>{text}</coefficients>\
                 <dimension>{dimension}</dimension><order>{order}</order></MultivariatePolynomialFunction>"
            )
        }
    }
}
