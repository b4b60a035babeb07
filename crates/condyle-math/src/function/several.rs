//! Functions of several scalars.

use crate::Scalar;

/// A scalar function of several scalars, such as the angle of a vertebra as a function of three
/// trunk angles.
#[derive(Clone, Debug, PartialEq)]
pub enum FunctionOfSeveral {
    /// `intercept + Σ slopeᵢ · xᵢ`: OpenSim's coordinate coupler of several drivers, and the result
    /// of a linear regression over coordinates (Pronost et al. 2010, equation 2).
    Linear {
        /// One slope for each argument.
        slopes: Vec<f64>,
        /// Value at 0.
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

    /// The value at `x`, one number for each argument. For a linear function missing arguments
    /// count as 0.
    #[inline]
    pub fn apply<S: Scalar>(&self, x: &[S]) -> S {
        self.apply_to(x.iter().copied())
    }

    /// [`FunctionOfSeveral::apply`] for arguments that do not lie together.
    #[inline]
    pub fn apply_to<S: Scalar>(&self, x: impl Iterator<Item = S>) -> S {
        match self {
            Self::Linear { slopes, intercept } => slopes
                .iter()
                .zip(x)
                .fold(S::from_f64(*intercept), |sum, (&slope, x)| sum + x.scale(slope)),
            Self::Polynomial(p) => {
                let mut all = [S::zero(); MOST_VARIABLES];
                let mut count = 0;
                for (value, x) in all.iter_mut().zip(x) {
                    *value = x;
                    count += 1;
                }
                p.apply(&all[..count])
            }
        }
    }

    /// The partial derivative at `x` by argument `i`; 0 for an argument that it does not have.
    ///
    /// ```
    /// use condyle_math::function::FunctionOfSeveral;
    /// let sum = FunctionOfSeveral::Linear { slopes: vec![0.5, 2.0], intercept: 1.0 };
    /// assert_eq!(sum.slope(&[3.0, 4.0], 1), 2.0);
    /// ```
    pub fn slope(&self, x: &[f64], i: usize) -> f64 {
        self.slope_at(x.iter().copied(), i)
    }

    /// [`FunctionOfSeveral::slope`] for arguments that do not lie together.
    pub fn slope_at(&self, x: impl Iterator<Item = f64>, i: usize) -> f64 {
        match self {
            Self::Linear { slopes, .. } => slopes.get(i).copied().unwrap_or(0.0),
            Self::Polynomial(p) => {
                let mut all = [0.0; MOST_VARIABLES];
                for (value, x) in all.iter_mut().zip(x) {
                    *value = x;
                }
                p.slope(&all, i)
            }
        }
    }
}

/// The most variables of a polynomial.
const MOST_VARIABLES: usize = 16;

/// A polynomial of several variables: a sum of terms `c · Π xᵢ^eᵢ`.
#[derive(Clone, Debug, PartialEq)]
pub struct MultivariatePolynomial {
    dimension: usize,
    /// One coefficient for each term.
    coefficients: Vec<f64>,
    /// `dimension` exponents for each term, term by term.
    exponents: Vec<u8>,
    /// The terms that are not 0: the coefficient, and where the factors of its monomial end in `factors`. Most
    /// polynomials over many variables have few.
    terms: Vec<(f64, u32)>,
    /// The variables of those monomials, each as often as its exponent says.
    factors: Vec<u8>,
}

impl MultivariatePolynomial {
    /// A polynomial of all monomials up to a total order, the exponent of the last variable varying
    /// fastest.
    ///
    /// For two variables and order 2 the terms are 1, y, y², x, x·y, x². This is the order of
    /// OpenSim's `MultivariatePolynomialFunction`; missing coefficients are zero.
    ///
    /// # Errors
    /// The number of coefficients for this dimension and order, if more are given, if that number
    /// is above a million, if the dimension is 0 or above 16, or if the order is above 64.
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
        // The number of monomials is binomial(dimension + order, order). Every partial product is
        // itself a binomial coefficient, so each division is exact.
        let mut count: usize = 1;
        for k in 1..=order.min(64) {
            count = count.saturating_mul(dimension.saturating_add(k)) / k;
        }
        if dimension == 0
            || dimension > MOST_VARIABLES
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
        let mut sparse = vec![];
        let mut factors = vec![];
        for (&c, powers) in coefficients.iter().zip(terms.chunks_exact(dimension)) {
            if c != 0.0 {
                for (variable, &power) in powers.iter().enumerate() {
                    factors.extend(std::iter::repeat_n(variable as u8, usize::from(power)));
                }
                sparse.push((c, factors.len() as u32));
            }
        }
        let coefficients = coefficients.to_vec();
        Ok(Self { dimension, coefficients, exponents: terms, terms: sparse, factors })
    }

    /// The number of variables.
    pub fn dimension(&self) -> usize {
        self.dimension
    }

    /// The highest total power of a given term, terms with coefficient 0 included.
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
        let mut from = 0;
        for &(c, to) in &self.terms {
            let mut term = S::from_f64(c);
            for &variable in &self.factors[from..to as usize] {
                term *= x.get(usize::from(variable)).copied().unwrap_or_else(S::zero);
            }
            from = to as usize;
            sum += term;
        }
        sum
    }

    /// The partial derivative at `x` by variable `i`: of each factor of a term that is that variable, the product of
    /// the others.
    fn slope(&self, x: &[f64], i: usize) -> f64 {
        let mut sum = 0.0;
        let mut from = 0;
        for &(c, to) in &self.terms {
            let factors = &self.factors[from..to as usize];
            from = to as usize;
            for (left_out, _) in factors.iter().enumerate().filter(|(_, v)| usize::from(**v) == i) {
                let others = factors.iter().enumerate().filter(|(k, _)| *k != left_out);
                sum += others.fold(c, |product, (_, v)| product * x[usize::from(*v)]);
            }
        }
        sum
    }
}
