//! Translation along a fixed axis: T = \[I | d·a\].
//!
//! Generator: (0, a).

use super::Signal;
use condyle_math::Vec3;

/// A slider: translation by one distance along one axis.
#[derive(Clone, Debug, PartialEq)]
pub struct Translate {
    /// The distance in metres.
    pub distance: Signal,
    /// The axis; it is normalised when the model is built.
    pub axis: Vec3,
}
