//! Functions of coordinates.

use crate::xml::Element;
use condyle_diagnostics::Error;
use condyle_math::function::{
    Curve, Function, FunctionOfSeveral, KnotError, MultivariatePolynomial, PiecewiseLinear,
    Polynomial, SimmSpline,
};

/// A function as a file states it: of one coordinate or of several.
pub(in crate::opensim) enum AnyFunction {
    One(Function),
    Several(FunctionOfSeveral),
}

/// The function inside an element that wraps one, directly or in a `<function>`; `None` if there
/// is none.
pub(in crate::opensim) fn inside(owner: Element<'_>) -> Result<Option<AnyFunction>, Error> {
    let wrapped = owner.child("function").unwrap_or(owner);
    match wrapped.children().find(|e| is_function(*e)) {
        Some(element) => read(element).map(Some),
        None => match wrapped.children().next() {
            Some(other) if wrapped.is("function") => Err(unknown(other)),
            _ => Ok(None),
        },
    }
}

/// Whether the function inside an element is a multiple of another, even with factor 1.
pub(in crate::opensim) fn is_multiplied(owner: Element<'_>) -> bool {
    owner.child("function").unwrap_or(owner).child("MultiplierFunction").is_some()
}

pub(in crate::opensim) fn is_function(element: Element<'_>) -> bool {
    let name = element.name();
    name.ends_with("Function")
        || name.to_lowercase().ends_with("spline")
        || matches!(name, "Constant" | "Sine")
}

fn unknown(element: Element<'_>) -> Error {
    element
        .error("osim/unknown-function", format!("the function {} is not known", element.describe()))
        .with_help(
            "use Constant, LinearFunction, PolynomialFunction, SimmSpline, PiecewiseLinearFunction, \
             MultiplierFunction or MultivariatePolynomialFunction",
        )
}

fn read(mut element: Element<'_>) -> Result<AnyFunction, Error> {
    let mut factor = 1.0;
    // Multipliers may be nested: their factors multiply.
    while element.is("MultiplierFunction") {
        factor *= element.child_f64("scale")?.unwrap_or(1.0);
        let inner = element.child("function").unwrap_or(element);
        element = inner.children().find(|e| is_function(*e)).ok_or_else(|| {
            element.error("osim/no-function", "a MultiplierFunction contains no function")
        })?;
    }
    let knots =
        |error: KnotError| element.error("osim/knots", format!("{}: {error}", element.describe()));
    let coefficients = |least: usize| -> Result<Vec<f64>, Error> {
        let list = element.require("coefficients")?;
        let numbers = finite(list)?;
        if numbers.len() < least {
            return Err(list.error(
                "osim/coefficients",
                format!("{} has {} coefficients, needs {least}", element.describe(), numbers.len()),
            ));
        }
        Ok(numbers)
    };
    let table = || -> Result<(Vec<f64>, Vec<f64>), Error> {
        Ok((element.require("x")?.f64s()?, element.require("y")?.f64s()?))
    };
    let curve = match element.name() {
        "Constant" => Curve::Constant(element.child_f64("value")?.unwrap_or(0.0)),
        "LinearFunction" => {
            let list = coefficients(2)?;
            match list[..] {
                [slope, intercept] => Curve::Linear { slope, intercept },
                _ => {
                    let scaled: Vec<f64> = list.iter().map(|c| factor * c).collect();
                    let (slopes, last) = scaled.split_at(scaled.len() - 1);
                    return Ok(AnyFunction::Several(FunctionOfSeveral::Linear {
                        slopes: slopes.to_vec(),
                        intercept: last.first().copied().unwrap_or(0.0),
                    }));
                }
            }
        }
        "PolynomialFunction" => Curve::Polynomial(Polynomial::from_descending(coefficients(1)?)),
        "SimmSpline" | "NaturalCubicSpline" | "natCubicSpline" => {
            let (x, y) = table()?;
            Curve::SimmSpline(SimmSpline::new(x, y).map_err(knots)?)
        }
        "PiecewiseLinearFunction" => {
            let (x, y) = table()?;
            Curve::PiecewiseLinear(PiecewiseLinear::new(x, y).map_err(knots)?)
        }
        "MultivariatePolynomialFunction" => {
            let whole = |name: &str, least: f64| -> Result<usize, Error> {
                let value = element.child_f64(name)?.unwrap_or(0.0);
                if value.fract() != 0.0 || !(least..=64.0).contains(&value) {
                    return Err(element.error(
                        "osim/coefficients",
                        format!("<{name}> of {} is {value}", element.describe()),
                    ));
                }
                Ok(value as usize)
            };
            let (dimension, order) = (whole("dimension", 1.0)?, whole("order", 0.0)?);
            let list: Vec<f64> = coefficients(0)?.iter().map(|c| factor * c).collect();
            let polynomial = MultivariatePolynomial::up_to_order(dimension, order, &list);
            return match polynomial {
                Ok(polynomial) => {
                    Ok(AnyFunction::Several(FunctionOfSeveral::Polynomial(polynomial)))
                }
                Err(expected) => Err(element.error(
                    "osim/coefficients",
                    format!(
                        "{} has {} coefficients, needs {expected}",
                        element.describe(),
                        list.len()
                    ),
                )),
            };
        }
        _ => return Err(unknown(element)),
    };
    Ok(AnyFunction::One(Function { factor, curve }))
}

fn finite(list: Element<'_>) -> Result<Vec<f64>, Error> {
    let numbers = list.f64s()?;
    match numbers.iter().position(|v| !v.is_finite()) {
        None => Ok(numbers),
        Some(i) => Err(list
            .error(
                "osim/not-finite",
                format!("number {} of {} is not finite", i + 1, list.describe()),
            )
            .with_help("give numbers that are neither NaN nor infinite")),
    }
}
