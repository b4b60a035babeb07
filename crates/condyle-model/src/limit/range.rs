//! The range of one coordinate.

/// The lowest and highest value of a coordinate, each optional.
///
/// Radians for rotations, metres for translations. A range that is not `enforced` is only a hint
/// for user interfaces: neither posed mode nor tracking clamps the coordinate to it (in `.osim`
/// files, a coordinate whose `clamped` is false).
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct Range {
    /// The lowest value; `None` for no lower limit.
    pub lower: Option<f64>,
    /// The highest value; `None` for no upper limit.
    pub upper: Option<f64>,
    /// Whether the limits apply.
    pub enforced: bool,
}

impl Range {
    /// No limit on either side.
    pub const FREE: Self = Self { lower: None, upper: None, enforced: false };

    /// An enforced range with both sides.
    pub fn new(lower: f64, upper: f64) -> Self {
        Self { lower: Some(lower), upper: Some(upper), enforced: true }
    }

    /// The effective bounds: infinite if a side is absent or the range is not enforced.
    ///
    /// ```
    /// use condyle_model::Range;
    /// let elbow = Range { lower: Some(0.0), upper: None, enforced: true };
    /// assert_eq!(elbow.bounds(), (0.0, f64::INFINITY));
    /// ```
    pub fn bounds(&self) -> (f64, f64) {
        if !self.enforced {
            return (f64::NEG_INFINITY, f64::INFINITY);
        }
        (self.lower.unwrap_or(f64::NEG_INFINITY), self.upper.unwrap_or(f64::INFINITY))
    }

    /// The nearest value that the bounds allow.
    pub fn nearest(&self, value: f64) -> f64 {
        let (lower, upper) = self.bounds();
        value.max(lower).min(upper)
    }

    /// The distance of a value from the nearer bound: negative outside, infinite without bounds.
    pub fn distance(&self, value: f64) -> f64 {
        let (lower, upper) = self.bounds();
        (value - lower).min(upper - value)
    }
}
