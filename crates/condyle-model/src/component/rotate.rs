//! Rotation about a fixed axis through the origin: T = \[R(a, θ) | 0\].
//!
//! Generator: (a, 0). An axis through another point is a [`Place`](super::Place) before and its
//! inverse after.

use super::Source;
use condyle_math::Vec3;

/// A hinge: one angle turns about one axis.
#[derive(Clone, Debug, PartialEq)]
pub struct Rotate {
    /// The angle in radians.
    pub angle: Source,
    /// The axis; its length is normalised when the model is built.
    pub axis: Vec3,
}
