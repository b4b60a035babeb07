//! Rotation by an orientation: T = \[R(q) | 0\].
//!
//! The coordinate stores four numbers and has three tangents: with the retraction q ⊕ δ = q·exp(δ)
//! the generators are rotations about the axes of the child, R·x, R·y and R·z.

use super::Signal;

/// A ball joint, without singularities.
#[derive(Clone, Debug, PartialEq)]
pub struct Ball {
    /// An orientation coordinate.
    pub orientation: Signal,
}
