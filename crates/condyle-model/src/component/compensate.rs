//! A segment that keeps its orientation while ancestors turn (Shao & Ng-Thow-Hing 2003, section 4.3).
//!
//! Let the path from the topmost named ancestor down to the segment's parent have the rotations
//! Bᵢ·Rᵢ·Bᵢ′, fixed frames around each motion. With A their product, and A′ the same product with
//! Rᵢ^(1-w) in place of Rᵢ for every named ancestor, the rotation
//!
//! ```text
//! C = A⁻¹·A′
//! ```
//!
//! in the parent's frame takes the fraction w of the named motions away again. It turns about the
//! segment's own joint, so the segment stays attached; motions of ancestors that are not named, and
//! everything that the segment's own joint adds, go through. The output is F⁻¹·C·F with F the joint
//! frame in the parent: multiply it first, before the segment's own motion.
//!
//! Kinks: for a weight between 0 and 1, where a named motion reaches a half turn.

use crate::position::SegmentId;

/// The rotation that undoes what named ancestors did: an arm that hangs while the shoulder shrugs.
#[derive(Clone, Debug, PartialEq)]
pub struct Compensate {
    /// The segment whose joint the output is for.
    pub segment: SegmentId,
    /// The ancestors whose rotations are taken away, of whatever joint sets.
    pub ancestors: Vec<SegmentId>,
    /// How much of them, from 0 (nothing) to 1 (all).
    pub weight: f64,
}
