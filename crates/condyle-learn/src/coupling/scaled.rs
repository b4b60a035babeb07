//! Laws on a body of another size, from three landmarks of the parent.
//!
//! Pronost, Sandholm & Thalmann 2010, equation (3), multiply every coefficient of every axis by one number:
//!
//! ```text
//! c' = c·(s₁ + s₂)/2      s₁ = |GT' - LFE'|/|GT - LFE|      s₂ = |MFE' - LFE'|/|MFE - LFE|
//! ```
//!
//! with GT the landmark at the parent's origin (great trochanter), LFE and MFE those at the lateral and the medial end of the
//! joint's axis, and ' for the other body. A long thin thigh is then as wrong along as across. [`ScaleRule::PerAxis`] multiplies
//! the law of each axis by the ratio of the distance that lies along it: s₁ for y (along the bone), s₂ for z (across), their mean
//! for x, along which no landmarks lie apart.

use super::LawFunction;
use condyle_diagnostics::Error;
use condyle_math::Vec3;
use condyle_math::function::{
    Curve, Function, FunctionOfSeveral, MultivariatePolynomial, PiecewiseLinear, SimmSpline,
};

/// How laws are scaled.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum ScaleRule {
    /// Equation (3) of Pronost et al. 2010: one number for all axes.
    Mean,
    /// s₁ for y, s₂ for z, their mean for x.
    #[default]
    PerAxis,
}

/// How much larger a body is, from the distances of three landmarks.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SizeRatios {
    /// s₁: between the landmark at the origin and the lateral one.
    pub along: f64,
    /// s₂: between the medial and the lateral one.
    pub across: f64,
}

impl SizeRatios {
    /// The ratios of two bodies whose landmarks are given in the order origin, medial, lateral; each in any frame, in metres.
    ///
    /// # Errors
    /// `transfer/landmarks` where two landmarks of a body are within 0.1 mm or a number is not finite.
    ///
    /// ```
    /// use condyle_learn::coupling::{ScaleRule, SizeRatios};
    /// use condyle_math::Vec3;
    /// let small = [Vec3::ZERO, Vec3::new(0.0, -0.4, -0.04), Vec3::new(0.0, -0.4, 0.04)];
    /// // Twice as wide, and 1.5 times the distance from the origin to the lateral end.
    /// let along = 1.5 * (0.4f64 * 0.4 + 0.04 * 0.04).sqrt();
    /// let y = -(along * along - 0.08f64 * 0.08).sqrt();
    /// let large = [Vec3::ZERO, Vec3::new(0.0, y, -0.08), Vec3::new(0.0, y, 0.08)];
    /// let ratios = SizeRatios::between(small, large)?;
    /// assert!((ratios.along - 1.5).abs() < 1e-12 && (ratios.across - 2.0).abs() < 1e-12);
    /// assert_eq!(ratios.factors(ScaleRule::Mean), [1.75; 3]);
    /// assert_eq!(ratios.factors(ScaleRule::PerAxis), [1.75, 1.5, 2.0]);
    /// # Ok::<(), condyle_diagnostics::Error>(())
    /// ```
    pub fn between(from: [Vec3; 3], to: [Vec3; 3]) -> Result<Self, Error> {
        let lengths = |[origin, medial, lateral]: [Vec3; 3], whose: &str| {
            let both = [(origin - lateral).norm(), (medial - lateral).norm()];
            if both.iter().all(|length| length.is_finite() && *length > 1e-4) {
                return Ok(both);
            }
            let message = format!("two landmarks of {whose} are at the same place");
            Err(Error::new("transfer/landmarks", message)
                .with_help("give three points that are not on a line, in metres"))
        };
        let [from, to] = [lengths(from, "the law's parent")?, lengths(to, "the target's parent")?];
        Ok(Self { along: to[0] / from[0], across: to[1] / from[1] })
    }

    /// What laws along x, y and z of the landmarks' frame are multiplied by.
    #[must_use]
    pub fn factors(self, rule: ScaleRule) -> [f64; 3] {
        let mean = 0.5 * (self.along + self.across);
        match rule {
            ScaleRule::Mean => [mean; 3],
            ScaleRule::PerAxis => [mean, self.along, self.across],
        }
    }

    /// By what share the two ratios differ from their mean: 0 for bodies of one shape.
    #[must_use]
    pub fn difference(self) -> f64 {
        (self.along - self.across).abs() / (self.along + self.across)
    }
}

/// A law whose values are `factor` times as large; its controls, which are angles, stay.
///
/// ```
/// use condyle_learn::coupling::{LawFunction, scaled};
/// use condyle_math::function::FunctionOfSeveral;
/// let law = LawFunction::Several(FunctionOfSeveral::Linear { slopes: vec![0.005, 0.035], intercept: 0.048 });
/// assert!((scaled(&law, 1.1).value(&[0.2, 1.0]) - 1.1 * (0.001 + 0.035 + 0.048)).abs() < 1e-15);
/// ```
#[must_use]
pub fn scaled(function: &LawFunction, factor: f64) -> LawFunction {
    match function {
        LawFunction::Several(FunctionOfSeveral::Linear { slopes, intercept }) => {
            let slopes = slopes.iter().map(|slope| slope * factor).collect();
            LawFunction::Several(FunctionOfSeveral::Linear {
                slopes,
                intercept: intercept * factor,
            })
        }
        LawFunction::Several(FunctionOfSeveral::Polynomial(p)) => {
            let all: Vec<f64> = p.coefficients().iter().map(|c| c * factor).collect();
            // As many coefficients as it had are right again.
            let polynomial = MultivariatePolynomial::up_to_order(p.dimension(), p.order(), &all)
                .unwrap_or_else(|_| p.clone());
            LawFunction::Several(FunctionOfSeveral::Polynomial(polynomial))
        }
        LawFunction::Sum { intercept, parts } => {
            let mut parts = parts.clone();
            parts.iter_mut().for_each(|part| part.stretch(factor, 1.0));
            LawFunction::Sum { intercept: intercept * factor, parts }
        }
    }
}

/// The law as a function of the negative of one of its controls: f'(…, x, …) = f(…, -x, …).
///
/// ```
/// use condyle_learn::coupling::{LawFunction, of_opposite};
/// use condyle_math::function::{FunctionOfSeveral, MultivariatePolynomial};
/// let p = MultivariatePolynomial::up_to_order(2, 2, &[1.0, 2.0, 3.0, 4.0, 5.0, 6.0]).unwrap();
/// let law = LawFunction::Several(FunctionOfSeveral::Polynomial(p));
/// let turned = of_opposite(&law, 1);
/// assert!((turned.value(&[0.3, 0.7]) - law.value(&[0.3, -0.7])).abs() < 1e-15);
/// ```
#[must_use]
pub fn of_opposite(function: &LawFunction, control: usize) -> LawFunction {
    match function {
        LawFunction::Several(FunctionOfSeveral::Linear { slopes, intercept }) => {
            let mut slopes = slopes.clone();
            slopes.iter_mut().skip(control).take(1).for_each(|slope| *slope = -*slope);
            LawFunction::Several(FunctionOfSeveral::Linear { slopes, intercept: *intercept })
        }
        LawFunction::Several(FunctionOfSeveral::Polynomial(p)) => {
            let mut powers = vec![0usize; p.dimension()];
            let mut all = vec![];
            for c in p.coefficients() {
                let odd = powers.get(control).is_some_and(|power| power % 2 == 1);
                all.push(if odd { -c } else { *c });
                let mut place = powers.len();
                while place > 0 {
                    place -= 1;
                    powers[place] += 1;
                    if powers.iter().sum::<usize>() <= p.order() {
                        break;
                    }
                    powers[place] = 0;
                }
            }
            let polynomial = MultivariatePolynomial::up_to_order(p.dimension(), p.order(), &all)
                .unwrap_or_else(|_| p.clone());
            LawFunction::Several(FunctionOfSeveral::Polynomial(polynomial))
        }
        LawFunction::Sum { intercept, parts } => {
            let mut parts = parts.clone();
            parts.iter_mut().skip(control).take(1).for_each(mirror);
            LawFunction::Sum { intercept: *intercept, parts }
        }
    }
}

/// f(-x): knots in the other order, since they must rise.
fn mirror(part: &mut Function) {
    let turned = |knots: &mut dyn Iterator<Item = (f64, f64)>| {
        let mut all: Vec<(f64, f64)> = knots.map(|(x, y)| (-x, y)).collect();
        all.reverse();
        all.into_iter().unzip::<f64, f64, Vec<f64>, Vec<f64>>()
    };
    match &mut part.curve {
        Curve::SimmSpline(spline) => {
            let (x, y) = turned(&mut spline.knots());
            if let Ok(other) = SimmSpline::new(x, y) {
                *spline = other;
            }
        }
        Curve::PiecewiseLinear(lines) => {
            let (x, y) = turned(&mut lines.knots());
            if let Ok(other) = PiecewiseLinear::new(x, y) {
                *lines = other;
            }
        }
        Curve::Constant(_) | Curve::Linear { .. } | Curve::Polynomial(_) => part.stretch(1.0, -1.0),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_kind_of_law_is_multiplied_as_a_whole() {
        let spline = SimmSpline::new(vec![-1.0, 0.0, 0.7, 2.0], vec![0.01, 0.0, 0.02, -0.01]);
        let polynomial =
            MultivariatePolynomial::up_to_order(2, 2, &[0.1, 0.2, -0.3, 0.4, 0.5, -0.6]).unwrap();
        let all = [
            LawFunction::Several(FunctionOfSeveral::Linear {
                slopes: vec![0.3, -0.2],
                intercept: 0.05,
            }),
            LawFunction::Several(FunctionOfSeveral::Polynomial(polynomial)),
            LawFunction::Sum {
                intercept: -0.4,
                parts: vec![Curve::SimmSpline(spline.unwrap()).into(), Function::linear(2.0, 0.1)],
            },
        ];
        for law in all {
            let larger = scaled(&law, 0.83);
            for i in 0..20 {
                let at = [(0.7 * f64::from(i)).sin() * 2.0, (1.3 * f64::from(i)).cos()];
                assert!((larger.value(&at) - 0.83 * law.value(&at)).abs() < 1e-15, "{law:?}");
                let other = of_opposite(&law, 0).value(&[-at[0], at[1]]);
                assert!((other - law.value(&at)).abs() < 1e-15, "{law:?}");
            }
        }
    }

    /// Table 1 and equation 3 of the paper: a thigh of s₁ = 1.1 and s₂ = 0.9 has c' = c by equation 3 although it is another.
    #[test]
    fn one_number_hides_another_shape() {
        let thigh = [Vec3::ZERO, Vec3::new(0.0, -0.3, -0.4), Vec3::new(0.0, -0.3, 0.4)];
        let other = [Vec3::ZERO, Vec3::new(0.0, 0.0, 0.55 - 0.72), Vec3::new(0.0, 0.0, 0.55)];
        let ratios = SizeRatios::between(thigh, other).unwrap();
        assert!((ratios.along - 1.1).abs() < 1e-12 && (ratios.across - 0.9).abs() < 1e-12);
        assert!((ratios.factors(ScaleRule::Mean)[1] - 1.0).abs() < 1e-12);
        assert!((ratios.difference() - 0.1).abs() < 1e-12);
        assert!(SizeRatios::between(thigh, [Vec3::ZERO; 3]).is_err());
    }
}
