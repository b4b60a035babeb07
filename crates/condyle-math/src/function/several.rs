//! Functions of several scalars.

use crate::Scalar;

/// A law that makes one number of several, such as a vertebra that follows three trunk angles.
#[derive(Clone, Debug, PartialEq)]
pub enum FunctionOfSeveral {
    /// `intercept + Σ slopeᵢ · xᵢ`: OpenSim's coupler of several drivers, and what a regression
    /// over coordinates learns (Pronost et al. 2010, equation 2).
    Linear {
        /// One slope for each argument.
        slopes: Vec<f64>,
        /// Value where all arguments are 0.
        intercept: f64,
    },
    /// A polynomial of several variables.
    Polynomial(MultivariatePolynomial),
}

impl FunctionOfSeveral {
    /// The number of arguments.
    pub fn arity(&self) -> usize {
        match self {
            Self::Linear { slopes, .. } => slopes.len(),
            Self::Polynomial(p) => p.dimension,
        }
    }

    /// The value at `x` (one number for each argument; missing ones count as 0).
    #[inline]
    pub fn apply<S: Scalar>(&self, x: &[S]) -> S {
        match self {
            Self::Linear { slopes, intercept } => slopes
                .iter()
                .zip(x)
                .fold(S::from_f64(*intercept), |sum, (&slope, &x)| sum + x.scale(slope)),
            Self::Polynomial(p) => p.apply(x),
        }
    }
}

/// A polynomial of several variables: a sum of terms `c · Π xᵢ^eᵢ`.
#[derive(Clone, Debug, PartialEq)]
pub struct MultivariatePolynomial {
    dimension: usize,
    /// One coefficient for each term.
    coefficients: Vec<f64>,
    /// `dimension` exponents for each term, term by term.
    exponents: Vec<u8>,
}

impl MultivariatePolynomial {
    /// All monomials up to a total order, the last variable's power running fastest.
    ///
    /// For two variables and order 2 the terms are 1, y, y², x, x·y, x². This is the order of
    /// OpenSim's `MultivariatePolynomialFunction`; missing coefficients are zero.
    ///
    /// # Errors
    /// The number of coefficients that this dimension and order take, if more were given or if the
    /// polynomial would have more than a million terms.
    ///
    /// ```
    /// use condyle_math::function::MultivariatePolynomial;
    /// let p = MultivariatePolynomial::up_to_order(2, 2, &[1.0, 2.0, 3.0, 4.0, 5.0, 6.0]).unwrap();
    /// // 1 + 2y + 3y² + 4x + 5xy + 6x² at x = 2, y = 3
    /// assert_eq!(p.apply(&[2.0, 3.0]), 1.0 + 6.0 + 27.0 + 8.0 + 30.0 + 24.0);
    /// ```
    pub fn up_to_order(
        dimension: usize,
        order: usize,
        coefficients: &[f64],
    ) -> Result<Self, usize> {
        // Number of monomials: binomial(dimension + order, order).
        let mut count: usize = 1;
        for k in 1..=order.min(64) {
            count = count.saturating_mul(dimension.saturating_add(k)) / k;
        }
        if dimension == 0
            || dimension > 16
            || order > 64
            || count > 1_000_000
            || coefficients.len() > count
        {
            return Err(count);
        }
        let mut terms = Vec::with_capacity(coefficients.len() * dimension);
        let mut powers = vec![0u8; dimension];
        for _ in 0..coefficients.len() {
            terms.extend_from_slice(&powers);
            // The next exponents in lexicographic order with a total of at most `order`.
            let mut place = dimension;
            while place > 0 {
                place -= 1;
                powers[place] += 1;
                if powers.iter().map(|&p| usize::from(p)).sum::<usize>() <= order {
                    break;
                }
                powers[place] = 0;
            }
        }
        Ok(Self { dimension, coefficients: coefficients.to_vec(), exponents: terms })
    }

    /// The number of variables.
    pub fn dimension(&self) -> usize {
        self.dimension
    }

    /// The highest total power of a term that is given.
    pub fn order(&self) -> usize {
        let total = |powers: &[u8]| powers.iter().map(|&p| usize::from(p)).sum();
        self.exponents.chunks_exact(self.dimension).map(total).max().unwrap_or(0)
    }

    /// The coefficients, in the order of [`MultivariatePolynomial::up_to_order`].
    pub fn coefficients(&self) -> &[f64] {
        &self.coefficients
    }

    /// The value at `x` (one number for each variable).
    #[inline]
    pub fn apply<S: Scalar>(&self, x: &[S]) -> S {
        let mut sum = S::zero();
        for (&c, powers) in
            self.coefficients.iter().zip(self.exponents.chunks_exact(self.dimension))
        {
            if c == 0.0 {
                continue;
            }
            let mut term = S::from_f64(c);
            for (&x, &power) in x.iter().zip(powers) {
                for _ in 0..power {
                    term *= x;
                }
            }
            sum += term;
        }
        sum
    }
}
