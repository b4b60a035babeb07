//! Rotation by an orientation: T = \[R(q) | 0\].
//!
//! The coordinate stores four numbers and moves in three: q ⊕ δ = q·exp(δ), so the generators are
//! the child's own axes, R·x, R·y and R·z.

use super::Source;

/// A ball joint without a singular posture.
#[derive(Clone, Debug, PartialEq)]
pub struct Ball {
    /// An orientation coordinate.
    pub orientation: Source,
}
