//! Segments: the bones of a character.

use super::{JointSetId, SegmentId};
use crate::component::Signal;
use condyle_math::Affine;

/// A bone, or any part that moves as one.
///
/// `segment_in_parent = joint_in_parent · motion · joint_in_segment⁻¹`, where the motion is the
/// identity for a segment that is welded to its parent.
#[derive(Clone, Debug, PartialEq)]
pub struct Segment {
    /// The segment's name, unique in its model.
    pub name: String,
    /// The segment it moves with; `None` for one that moves relative to the world.
    pub parent: Option<SegmentId>,
    /// The fixed end of its joint, in the parent (in the world where there is none).
    pub joint_in_parent: Affine,
    /// The moving end of its joint, in the segment.
    pub joint_in_segment: Affine,
    /// What moves it: a transform, or nothing.
    pub motion: Option<Signal>,
    /// The joint set that moves it.
    pub joint_set: Option<JointSetId>,
}
