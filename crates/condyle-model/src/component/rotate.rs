//! Rotation about a fixed axis through the origin: T = \[R(a, θ) | 0\].
//!
//! Generator: (a, 0). For an axis through another point, put a [`Place`](super::Place) before it
//! and its inverse after it.

use super::Signal;
use condyle_math::Vec3;

/// A hinge: rotation by one angle about one axis.
#[derive(Clone, Debug, PartialEq)]
pub struct Rotate {
    /// The angle in radians.
    pub angle: Signal,
    /// The axis; it is normalised when the model is built.
    pub axis: Vec3,
}
