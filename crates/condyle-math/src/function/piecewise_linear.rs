//! Linear interpolation between knots.

use super::{KnotError, check_knots, interval};

/// Linear interpolation between knots, extrapolated with the end slopes.
///
/// Two knots at the same argument make a step. At a knot the slope is that of the segment to its
/// right.
#[derive(Clone, Debug, PartialEq)]
pub struct PiecewiseLinear {
    x: Vec<f64>,
    y: Vec<f64>,
}

impl PiecewiseLinear {
    /// The interpolation through the knots (x, y), with x not decreasing.
    ///
    /// # Errors
    /// [`KnotError`] for no knots, lists of different length, decreasing or non-finite numbers.
    pub fn new(x: Vec<f64>, y: Vec<f64>) -> Result<Self, KnotError> {
        check_knots(&x, &y, false)?;
        Ok(Self { x, y })
    }

    /// Value and derivative at `at`.
    ///
    /// ```
    /// use condyle_math::function::PiecewiseLinear;
    /// // Clavicle elevation against humeral abduction in degrees (Shao & Ng-Thow-Hing 2003, 5.2).
    /// let lift = PiecewiseLinear::new(vec![0.0, 60.0, 120.0, 180.0], vec![-10.0, -6.7, 4.85, 23.0]);
    /// let (value, slope) = lift.unwrap().value_and_slope(90.0);
    /// assert!((value + 0.925).abs() < 1e-12 && (slope - 0.1925).abs() < 1e-12);
    /// ```
    #[inline]
    pub fn value_and_slope(&self, at: f64) -> (f64, f64) {
        if self.x.len() == 1 {
            return (self.y[0], 0.0);
        }
        let i = interval(&self.x, at);
        let width = self.x[i + 1] - self.x[i];
        // Only for a step at the first or the last knot; beyond it the value stays constant.
        if width == 0.0 {
            return (self.y[if at < self.x[i] { i } else { i + 1 }], 0.0);
        }
        let slope = (self.y[i + 1] - self.y[i]) / width;
        (self.y[i] + slope * (at - self.x[i]), slope)
    }

    /// The knots, argument and value.
    pub fn knots(&self) -> impl ExactSizeIterator<Item = (f64, f64)> + '_ {
        self.x.iter().copied().zip(self.y.iter().copied())
    }

    /// First and last argument.
    pub fn domain(&self) -> (f64, f64) {
        (self.x[0], self.x[self.x.len() - 1])
    }
}
