//! Product of transforms: T = T₁·T₂·…·Tₙ (Shao & Ng-Thow-Hing 2003, section 4.1).
//!
//! The first factor is nearest to the parent. Generators: those of each factor, transformed by the
//! product of the factors before it.

use super::Signal;

/// A product of motions.
#[derive(Clone, Debug, PartialEq)]
pub struct Product {
    /// The factors, the one nearest to the parent first.
    pub factors: Vec<Signal>,
}
