//! Functions of one scalar and of several, by which coordinates drive motions.
//!
//! The tibia translates by a spline of knee flexion, the patella follows a polynomial, the last
//! joint of a finger rotates by two thirds of the angle of the joint before it. Each of these is a
//! [`Function`]: a [`Curve`] times a constant factor. Functions of several coordinates are a
//! [`FunctionOfSeveral`].
//!
//! A [`Function`] returns its value and its exact derivative, and is applied to any [`Scalar`]
//! through [`Scalar::chain`].

mod piecewise_linear;
mod polynomial;
mod several;
mod simm_spline;

pub use piecewise_linear::PiecewiseLinear;
pub use polynomial::Polynomial;
pub use several::{FunctionOfSeveral, MultivariatePolynomial};
pub use simm_spline::SimmSpline;

use crate::Scalar;
use std::fmt;

/// A function of one scalar: `factor · curve(x)`.
#[derive(Clone, Debug, PartialEq)]
pub struct Function {
    /// Constant factor in front of the curve.
    pub factor: f64,
    /// The curve.
    pub curve: Curve,
}

/// The curve of a [`Function`].
#[derive(Clone, Debug, PartialEq)]
pub enum Curve {
    /// The same value everywhere.
    Constant(f64),
    /// `slope · x + intercept`.
    Linear {
        /// Change per unit of x.
        slope: f64,
        /// Value at 0.
        intercept: f64,
    },
    /// A polynomial.
    Polynomial(Polynomial),
    /// Linear interpolation between knots.
    PiecewiseLinear(PiecewiseLinear),
    /// The interpolating cubic spline of SIMM and OpenSim.
    SimmSpline(SimmSpline),
}

impl From<Curve> for Function {
    fn from(curve: Curve) -> Self {
        Self { factor: 1.0, curve }
    }
}

impl Function {
    /// The function `x ↦ x`.
    pub fn identity() -> Self {
        Self::linear(1.0, 0.0)
    }

    /// The function `x ↦ slope · x + intercept`.
    pub fn linear(slope: f64, intercept: f64) -> Self {
        Curve::Linear { slope, intercept }.into()
    }

    /// The same value everywhere.
    pub fn constant(value: f64) -> Self {
        Curve::Constant(value).into()
    }

    /// Makes it x ↦ `result`·f(x/`argument`): the same function where result and argument are
    /// measured in other units, or on a body of another size.
    ///
    /// ```
    /// use condyle_math::function::Function;
    /// let mut glide = Function::linear(0.02, 0.005);
    /// glide.stretch(2.0, 4.0);
    /// assert_eq!(glide.value_and_slope(4.0), (0.05, 0.01));
    /// ```
    pub fn stretch(&mut self, result: f64, argument: f64) {
        if result != 1.0 {
            self.factor *= result;
        }
        if argument == 1.0 {
            return;
        }
        match &mut self.curve {
            Curve::Constant(_) => {}
            Curve::Linear { slope, .. } => *slope /= argument,
            Curve::Polynomial(p) => {
                let mut power = 1.0;
                let all = p.ascending().iter().map(|c| {
                    let c = c / power;
                    power *= argument;
                    c
                });
                *p = Polynomial::from_ascending(all.collect());
            }
            Curve::PiecewiseLinear(p) => {
                let (x, y) = p.knots().map(|(x, y)| (x * argument, y)).unzip();
                if let Ok(wider) = PiecewiseLinear::new(x, y) {
                    *p = wider;
                }
            }
            Curve::SimmSpline(s) => s.stretch(1.0, argument),
        }
    }

    /// Value and derivative at `x`.
    ///
    /// ```
    /// use condyle_math::function::Function;
    /// let two_thirds = Function::linear(2.0 / 3.0, 0.0);
    /// assert_eq!(two_thirds.value_and_slope(1.5), (1.0, 2.0 / 3.0));
    /// ```
    #[inline]
    pub fn value_and_slope(&self, x: f64) -> (f64, f64) {
        let (value, slope) = match &self.curve {
            Curve::Constant(value) => (*value, 0.0),
            Curve::Linear { slope, intercept } => (slope * x + intercept, *slope),
            Curve::Polynomial(p) => p.value_and_slope(x),
            Curve::PiecewiseLinear(p) => p.value_and_slope(x),
            Curve::SimmSpline(s) => s.value_and_slope(x),
        };
        (self.factor * value, self.factor * slope)
    }

    /// The function applied to any scalar.
    #[inline(always)]
    pub fn apply<S: Scalar>(&self, x: S) -> S {
        x.chain(|x| self.value_and_slope(x))
    }

    /// The value, if the function is known to be constant: constant or linear with slope 0, or with
    /// factor 0.
    pub fn as_constant(&self) -> Option<f64> {
        match &self.curve {
            _ if self.factor == 0.0 => Some(0.0),
            Curve::Constant(value) => Some(self.factor * value),
            Curve::Linear { slope, intercept } if *slope == 0.0 => Some(self.factor * intercept),
            _ => None,
        }
    }

    /// Slope and intercept, if the function is given as linear or as constant.
    pub fn as_linear(&self) -> Option<(f64, f64)> {
        match &self.curve {
            Curve::Linear { slope, intercept } => {
                Some((self.factor * slope, self.factor * intercept))
            }
            _ => self.as_constant().map(|value| (0.0, value)),
        }
    }

    /// The interval that the knots cover; `None` for a curve without knots.
    pub fn domain(&self) -> Option<(f64, f64)> {
        match &self.curve {
            Curve::PiecewiseLinear(p) => Some(p.domain()),
            Curve::SimmSpline(s) => Some(s.domain()),
            _ => None,
        }
    }
}

/// Why a list of knots defines no curve.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum KnotError {
    /// No knots.
    Empty,
    /// The lists of arguments and values differ in length.
    Lengths {
        /// Number of arguments.
        x: usize,
        /// Number of values.
        y: usize,
    },
    /// An argument is not above the previous one.
    NotIncreasing {
        /// Position of the knot, from 0.
        index: usize,
        /// The previous argument.
        before: f64,
        /// The argument of this knot.
        here: f64,
    },
    /// A number is infinite or not a number.
    NotFinite {
        /// Position of the knot, from 0.
        index: usize,
    },
}

impl fmt::Display for KnotError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Empty => f.write_str("no knots given: at least one is needed"),
            Self::Lengths { x, y } => {
                write!(f, "{x} arguments but {y} values: the two lists must have the same length")
            }
            Self::NotIncreasing { index, before, here } => write!(
                f,
                "knot {} at x = {here} does not lie above the one before it at x = {before}",
                index + 1
            ),
            Self::NotFinite { index } => write!(f, "knot {} is not a finite number", index + 1),
        }
    }
}

impl std::error::Error for KnotError {}

/// Checks the requirements common to all curves through knots; `strictly` forbids equal arguments.
fn check_knots(x: &[f64], y: &[f64], strictly: bool) -> Result<(), KnotError> {
    if x.len() != y.len() {
        return Err(KnotError::Lengths { x: x.len(), y: y.len() });
    }
    if x.is_empty() {
        return Err(KnotError::Empty);
    }
    if let Some(index) = (0..x.len()).find(|&i| !x[i].is_finite() || !y[i].is_finite()) {
        return Err(KnotError::NotFinite { index });
    }
    let wrong = |&i: &usize| if strictly { x[i] <= x[i - 1] } else { x[i] < x[i - 1] };
    match (1..x.len()).find(wrong) {
        Some(index) => {
            Err(KnotError::NotIncreasing { index, before: x[index - 1], here: x[index] })
        }
        None => Ok(()),
    }
}

/// The index of the interval that contains `at`, given at least two increasing knots.
///
/// The first and last intervals extend to infinity; a knot belongs to the interval to its right.
#[inline]
fn interval(x: &[f64], at: f64) -> usize {
    x[1..x.len() - 1].partition_point(|&knot| knot <= at)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_curve_has_the_slope_of_its_graph() {
        let x = vec![-1.0, -0.2, 0.3, 1.1, 2.0];
        let y = vec![0.3, -0.5, 0.7, 0.1, 0.9];
        let curves: Vec<Function> = vec![
            Function::constant(0.4),
            Function::linear(-1.5, 0.2),
            Curve::Polynomial(Polynomial::from_ascending(vec![0.1, -0.4, 0.3, 0.7])).into(),
            Curve::PiecewiseLinear(PiecewiseLinear::new(x.clone(), y.clone()).unwrap()).into(),
            Function {
                factor: -0.7,
                curve: Curve::SimmSpline(SimmSpline::new(x.clone(), y).unwrap()),
            },
        ];
        let h = 1e-6;
        for curve in &curves {
            for i in 0..400 {
                let at = -1.7 + 4.0 * f64::from(i) / 399.0 + 1e-5;
                if x.iter().any(|knot| (knot - at).abs() < 2.0 * h) {
                    continue;
                }
                let slope =
                    (curve.value_and_slope(at + h).0 - curve.value_and_slope(at - h).0) / (2.0 * h);
                assert!((slope - curve.value_and_slope(at).1).abs() < 1e-8, "{curve:?} at {at}");
            }
        }
    }

    #[test]
    fn knots_are_refused_with_their_number() {
        let refused = SimmSpline::new(vec![0.0, 1.0, 1.0], vec![0.0; 3]).unwrap_err();
        assert_eq!(refused, KnotError::NotIncreasing { index: 2, before: 1.0, here: 1.0 });
        assert_eq!(
            SimmSpline::new(vec![0.0], vec![]).unwrap_err(),
            KnotError::Lengths { x: 1, y: 0 }
        );
        assert_eq!(
            PiecewiseLinear::new(vec![0.0, f64::NAN], vec![0.0; 2]).unwrap_err(),
            KnotError::NotFinite { index: 1 }
        );
    }
}
