//! A fixed transform: T = const.

use condyle_math::Affine;

/// A fixed transform, such as an oblique joint axis or a shifted centre.
#[derive(Clone, Debug, PartialEq)]
pub struct Place {
    /// The child frame in its parent.
    pub child_in_parent: Affine,
}
