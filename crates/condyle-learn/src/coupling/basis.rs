//! Terms of controls of which a law is a sum.

use condyle_math::function::{
    Curve, Function, FunctionOfSeveral, MultivariatePolynomial, SimmSpline,
};

/// Which terms a law has.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Basis {
    /// The controls themselves (Pronost et al. 2010).
    #[default]
    Linear,
    /// All products of controls up to a total order.
    Polynomial(usize),
    /// For each control a spline through so many knots, at even shares of its values: the spline of OpenSim, so that
    /// the law leaves as it was fitted.
    Spline(usize),
}

impl Basis {
    /// Its name, as on the command line.
    #[must_use]
    pub fn name(self) -> String {
        match self {
            Self::Linear => "linear".to_owned(),
            Self::Polynomial(order) => format!("polynomial:{order}"),
            Self::Spline(knots) => format!("spline:{knots}"),
        }
    }

    /// The basis of that name; `polynomial` alone is of order 2, `spline` alone has 5 knots.
    ///
    /// ```
    /// use condyle_learn::coupling::Basis;
    /// assert_eq!(Basis::named("polynomial:3"), Some(Basis::Polynomial(3)));
    /// assert_eq!(Basis::named("spline"), Some(Basis::Spline(5)));
    /// assert_eq!(Basis::named("polynomial:0"), None);
    /// ```
    #[must_use]
    pub fn named(name: &str) -> Option<Self> {
        let (word, count) = match name.split_once(':') {
            Some((word, count)) => (word, Some(count.parse().ok()?)),
            None => (name, None),
        };
        match word {
            "linear" if count.is_none() => Some(Self::Linear),
            "polynomial" => Some(Self::Polynomial(count.unwrap_or(2))),
            "spline" => Some(Self::Spline(count.unwrap_or(5))),
            _ => None,
        }
        .filter(|basis| match basis {
            Self::Linear => true,
            Self::Polynomial(order) => (1..=6).contains(order),
            Self::Spline(knots) => (3..=20).contains(knots),
        })
    }
}

/// The function that a law is.
#[derive(Clone, Debug, PartialEq)]
pub enum LawFunction {
    /// A linear function or a polynomial of the controls.
    Several(FunctionOfSeveral),
    /// A constant and one function of each control.
    Sum {
        /// The constant.
        intercept: f64,
        /// One function for each control.
        parts: Vec<Function>,
    },
}

impl LawFunction {
    /// The value for controls in their order.
    #[must_use]
    pub fn value(&self, controls: &[f64]) -> f64 {
        match self {
            Self::Several(function) => function.apply(controls),
            Self::Sum { intercept, parts } => parts
                .iter()
                .zip(controls)
                .fold(*intercept, |sum, (part, x)| sum + part.value_and_slope(*x).0),
        }
    }

    /// The slope by one of the controls.
    #[must_use]
    pub fn slope(&self, controls: &[f64], control: usize) -> f64 {
        match self {
            Self::Several(function) => function.slope(controls, control),
            Self::Sum { parts, .. } => match (parts.get(control), controls.get(control)) {
                (Some(part), Some(x)) => part.value_and_slope(*x).1,
                _ => 0.0,
            },
        }
    }
}

/// The terms of a basis over some controls.
#[derive(Clone, Debug)]
pub(super) enum Terms {
    Linear(usize),
    /// The exponents of each term, in the order of [`MultivariatePolynomial::up_to_order`], the constant left out.
    Powers {
        controls: usize,
        order: usize,
        exponents: Vec<Vec<u32>>,
    },
    /// For each control the splines that are 1 at one knot and 0 at the others; the first knot is left out, so that a
    /// constant is no sum of them.
    Splines(Vec<Vec<SimmSpline>>),
}

impl Terms {
    /// `values` are those of each control, from which the knots of splines follow; `None` where a control has not as many
    /// different values as there are knots.
    pub(super) fn new(basis: Basis, values: &[Vec<f64>]) -> Option<Self> {
        let controls = values.len();
        match basis {
            Basis::Linear => Some(Self::Linear(controls)),
            Basis::Polynomial(order) => {
                // The constant is the first term.
                let exponents = exponents(controls, order).split_off(1);
                Some(Self::Powers { controls, order, exponents })
            }
            Basis::Spline(knots) => {
                let splines = values.iter().map(|values| cardinal(values, knots));
                splines.collect::<Option<_>>().map(Self::Splines)
            }
        }
    }

    pub(super) fn count(&self) -> usize {
        match self {
            Self::Linear(controls) => *controls,
            Self::Powers { exponents, .. } => exponents.len(),
            Self::Splines(all) => all.iter().map(Vec::len).sum(),
        }
    }

    /// Adds the terms at some controls to a row.
    pub(super) fn at(&self, controls: &[f64], row: &mut Vec<f64>) {
        match self {
            Self::Linear(_) => row.extend_from_slice(controls),
            Self::Powers { exponents, .. } => row.extend(exponents.iter().map(|powers| {
                powers
                    .iter()
                    .zip(controls)
                    .fold(1.0, |product, (power, x)| product * x.powi(*power as i32))
            })),
            Self::Splines(all) => {
                for (splines, x) in all.iter().zip(controls) {
                    row.extend(splines.iter().map(|spline| spline.value_and_slope(*x).0));
                }
            }
        }
    }

    /// Whether a term depends on a control.
    pub(super) fn has(&self, term: usize, control: usize) -> bool {
        match self {
            Self::Linear(_) => term == control,
            Self::Powers { exponents, .. } => exponents[term][control] > 0,
            Self::Splines(all) => {
                let from: usize = all[..control].iter().map(Vec::len).sum();
                (from..from + all[control].len()).contains(&term)
            }
        }
    }

    /// The name of a term, such as `flexion*rotation^2`.
    pub(super) fn name(&self, term: usize, controls: &[String]) -> String {
        match self {
            Self::Linear(_) => controls[term].clone(),
            Self::Powers { exponents, .. } => {
                let factors = exponents[term].iter().zip(controls).filter(|(power, _)| **power > 0);
                let named = factors.map(|(power, name)| match power {
                    1 => name.clone(),
                    power => format!("{name}^{power}"),
                });
                named.collect::<Vec<_>>().join("*")
            }
            Self::Splines(all) => {
                let mut place = term;
                for (splines, name) in all.iter().zip(controls) {
                    match splines.get(place) {
                        Some(spline) => {
                            let knot = spline.knots().nth(place + 1).map_or(f64::NAN, |(x, _)| x);
                            return format!("{name}@{knot:.4}");
                        }
                        None => place -= splines.len(),
                    }
                }
                String::new()
            }
        }
    }

    /// The function of these coefficients.
    pub(super) fn function(&self, intercept: f64, coefficients: &[f64]) -> LawFunction {
        match self {
            Self::Linear(_) => LawFunction::Several(FunctionOfSeveral::Linear {
                slopes: coefficients.to_vec(),
                intercept,
            }),
            Self::Powers { controls, order, .. } => {
                let all = [&[intercept], coefficients].concat();
                let polynomial = MultivariatePolynomial::up_to_order(*controls, *order, &all);
                // There are as many coefficients as the order has terms.
                polynomial.map_or_else(
                    |_| LawFunction::Sum { intercept, parts: vec![] },
                    |p| LawFunction::Several(FunctionOfSeveral::Polynomial(p)),
                )
            }
            Self::Splines(all) => {
                let mut rest = coefficients;
                let parts = all.iter().map(|splines| {
                    let (own, others) = rest.split_at(splines.len().min(rest.len()));
                    rest = others;
                    let x: Vec<f64> = splines
                        .first()
                        .map(|s| s.knots().map(|(x, _)| x).collect())
                        .unwrap_or_default();
                    let y = [&[0.0], own].concat();
                    SimmSpline::new(x, y)
                        .map_or(Function::constant(0.0), |s| Curve::SimmSpline(s).into())
                });
                LawFunction::Sum { intercept, parts: parts.collect() }
            }
        }
    }
}

/// All exponents with a total of at most `order`, the last varying fastest.
fn exponents(controls: usize, order: usize) -> Vec<Vec<u32>> {
    let mut all = vec![];
    let mut powers = vec![0u32; controls];
    loop {
        all.push(powers.clone());
        let mut place = controls;
        loop {
            if place == 0 {
                return all;
            }
            place -= 1;
            powers[place] += 1;
            if powers.iter().sum::<u32>() as usize <= order {
                break;
            }
            powers[place] = 0;
        }
    }
}

fn cardinal(values: &[f64], knots: usize) -> Option<Vec<SimmSpline>> {
    let mut rising: Vec<f64> = values.to_vec();
    rising.sort_by(f64::total_cmp);
    let last = rising.len().checked_sub(1)?;
    let x: Vec<f64> =
        (0..knots).map(|k| rising[(last * k + (knots - 1) / 2) / (knots - 1)]).collect();
    (1..knots)
        .map(|k| {
            let mut y = vec![0.0; knots];
            y[k] = 1.0;
            SimmSpline::new(x.clone(), y).ok()
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_function_is_the_sum_of_its_terms() {
        let values: Vec<Vec<f64>> = vec![
            (0..50).map(|i| 0.02 * f64::from(i)).collect(),
            (0..50).map(|i| (0.3 * f64::from(i)).sin()).collect(),
        ];
        for basis in [Basis::Linear, Basis::Polynomial(3), Basis::Spline(6)] {
            let terms = Terms::new(basis, &values).unwrap();
            let coefficients: Vec<f64> =
                (0..terms.count()).map(|i| (i as f64 + 1.0).sin()).collect();
            let function = terms.function(0.25, &coefficients);
            for i in 0..50 {
                let controls = [values[0][i] * 1.2 - 0.1, values[1][i]];
                let mut row = vec![];
                terms.at(&controls, &mut row);
                assert_eq!(row.len(), terms.count());
                let sum: f64 = row.iter().zip(&coefficients).map(|(x, c)| x * c).sum();
                assert!((function.value(&controls) - 0.25 - sum).abs() < 1e-12, "{basis:?}");
            }
        }
    }

    #[test]
    fn terms_have_names() {
        let terms = Terms::new(Basis::Polynomial(2), &[vec![], vec![]]).unwrap();
        let names = ["a".to_owned(), "b".to_owned()];
        let all: Vec<String> = (0..terms.count()).map(|term| terms.name(term, &names)).collect();
        assert_eq!(all, ["b", "b^2", "a", "a*b", "a^2"]);
        assert!(terms.has(3, 0) && terms.has(3, 1) && !terms.has(1, 0));
    }
}
