//! One character at one moment.

use super::program::Program;
use crate::model::{CoordinateId, Model, SegmentId};
use condyle_math::{Affine, Scalar};

/// The buffers of one evaluation: effective coordinates and the transforms of all segments.
///
/// Made once for a program and used for any number of evaluations. A pose belongs to one character
/// in one moment; the model is shared.
#[derive(Clone, Debug)]
pub struct Pose<S = f64> {
    pub(super) scalars: Vec<S>,
    pub(super) transforms: Vec<Affine<S>>,
    segments: usize,
    stored: usize,
    rows: Vec<u32>,
}

impl<S: Scalar> Pose<S> {
    /// Buffers for this program.
    pub fn new(program: &Program) -> Self {
        Self {
            scalars: vec![S::zero(); program.code.scalars],
            transforms: vec![Affine::identity(); program.code.transforms],
            segments: program.segments,
            stored: program.stored,
            rows: program.code.rows.clone(),
        }
    }

    /// Bytes of the buffers: every scalar and transform, those that only components read included.
    pub fn bytes(&self) -> usize {
        size_of_val(&self.scalars[..]) + size_of_val(&self.transforms[..])
    }

    /// The world transform of a segment: `p_world = T · p_segment`.
    #[inline]
    pub fn segment(&self, segment: SegmentId) -> Affine<S> {
        self.transforms[segment.index()]
    }

    /// The world transform of a segment, or the identity for the world itself.
    #[inline]
    pub fn frame(&self, segment: Option<SegmentId>) -> Affine<S> {
        segment.map_or_else(Affine::identity, |id| self.segment(id))
    }

    /// The world transforms of all segments, in the model's order.
    pub fn segments(&self) -> &[Affine<S>] {
        &self.transforms[..self.segments]
    }

    /// The stored numbers of all coordinates as they took effect: limits applied in posed mode,
    /// coupled coordinates as their leaders determine them.
    pub fn effective(&self) -> &[S] {
        &self.scalars[..self.stored]
    }

    /// A limit row: negative where the posture of the last evaluation breaks that limit.
    pub fn limit_row(&self, row: usize) -> S {
        self.scalars[self.rows[row] as usize]
    }

    /// The effective stored numbers of one coordinate.
    pub fn coordinate(&self, model: &Model, id: CoordinateId) -> &[S] {
        &self.scalars[model.stored_range(id)]
    }
}
