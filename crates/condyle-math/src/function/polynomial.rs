//! Polynomials of one variable.

/// A polynomial, such as the knee translations of Walker et al. 1988.
#[derive(Clone, Debug, PartialEq)]
pub struct Polynomial {
    /// Coefficients, the constant term first.
    ascending: Vec<f64>,
}

impl Polynomial {
    /// The polynomial c0 + c1·x + c2·x² + …; the zero polynomial for no coefficients.
    pub fn from_ascending(coefficients: Vec<f64>) -> Self {
        Self { ascending: coefficients }
    }

    /// The polynomial whose coefficients begin with the highest power, as in `.osim` files.
    ///
    /// ```
    /// use condyle_math::function::Polynomial;
    /// // x² + 2x + 3 at x = 2
    /// assert_eq!(Polynomial::from_descending(vec![1.0, 2.0, 3.0]).value_and_slope(2.0), (11.0, 6.0));
    /// ```
    pub fn from_descending(mut coefficients: Vec<f64>) -> Self {
        coefficients.reverse();
        Self { ascending: coefficients }
    }

    /// The coefficients, the constant term first.
    pub fn ascending(&self) -> &[f64] {
        &self.ascending
    }

    /// Value and derivative at `x`, by Horner's scheme.
    #[inline]
    pub fn value_and_slope(&self, x: f64) -> (f64, f64) {
        self.ascending
            .iter()
            .rev()
            .fold((0.0, 0.0), |(value, slope), c| (value * x + c, slope * x + value))
    }
}
