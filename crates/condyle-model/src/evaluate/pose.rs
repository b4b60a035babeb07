//! The buffers and results of one evaluation.

use super::instruction::{Number, Turn};
use super::program::{Bound, Program};
use crate::model::{CoordinateId, Model, SegmentId};
use condyle_math::{Affine, Mat3, Scalar};
use std::ops::Range;

/// The result of a contact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactReport<S = f64> {
    /// The two rotation angles in radians: about the given axis, and about the line to the first
    /// point.
    pub angles: [S; 2],
    /// The signed distance of each point from the surface in metres, positive outside; 0 in
    /// contact.
    pub gaps: [S; 2],
}

/// The buffers of one evaluation: effective coordinates and the transforms of all segments.
///
/// Allocated once for a program and used for any number of evaluations. Each character needs its
/// own pose; the program is shared.
#[derive(Clone, Debug)]
pub struct Pose<S = f64> {
    pub(super) scalars: Vec<S>,
    pub(super) transforms: Vec<Affine<S>>,
    /// The angles of all rotation steps, and their sines and cosines.
    angles: Vec<S>,
    turns: Vec<(S, S)>,
    segments: usize,
    stored: usize,
    rows: Vec<Number>,
    base: usize,
    reports: Vec<Number>,
}

impl<S: Scalar> Pose<S> {
    /// Buffers for this program.
    pub fn new(program: &Program) -> Self {
        Self {
            scalars: vec![S::zero(); program.code.scalars],
            transforms: vec![Affine::identity(); program.code.transforms],
            angles: vec![S::zero(); program.code.turns.len()],
            turns: vec![(S::zero(), S::one()); program.code.turns.len()],
            segments: program.segments,
            stored: program.stored,
            rows: program.code.rows.clone(),
            base: program.code.base.index(),
            reports: program.code.contacts.iter().map(|c| c.report).collect(),
        }
    }

    /// The size of the buffers in bytes: all scalars and transforms, including intermediate ones.
    pub fn bytes(&self) -> usize {
        let turns = size_of_val(&self.angles[..]) + size_of_val(&self.turns[..]);
        size_of_val(&self.scalars[..]) + size_of_val(&self.transforms[..]) + turns
    }

    /// The world transform of a segment: `p_world = T · p_segment`.
    #[inline]
    pub fn segment(&self, segment: SegmentId) -> Affine<S> {
        self.transforms[segment.index()]
    }

    /// The world transform of a segment, or for `None` that of the model's root frame.
    #[inline]
    pub fn frame(&self, segment: Option<SegmentId>) -> Affine<S> {
        self.transforms[segment.map_or(self.base, SegmentId::index)]
    }

    /// The transform of a segment in its parent, or in the model's root frame: what its joint does, with
    /// the fixed frames before and after it.
    ///
    /// Not finite where a scale has made the parent flat.
    pub fn segment_in_parent(&self, model: &Model, segment: SegmentId) -> Affine<S> {
        let parent = self.frame(model.segment(segment).parent);
        let back = parent.linear.inverse();
        let own = self.segment(segment);
        Affine::new(back * own.linear, back * (own.translation - parent.translation))
    }

    /// The matrix that carries a surface normal of a segment to the world: the inverse transpose of its
    /// linear part (Rotenberg, *Skeletons*, section 2.2.5), which for a rigid segment is its rotation.
    ///
    /// Where the segment is not rigid the result has to be normalised; it is not finite where a scale
    /// has made the segment flat.
    pub fn normal(&self, segment: SegmentId) -> Mat3<S> {
        self.segment(segment).linear.inverse().transpose()
    }

    /// Computes sine and cosine of angles in one loop, which the compiler can vectorise.
    pub(super) fn take_turns(&mut self, registers: &[Number], of: Range<usize>) {
        let (registers, angles) = (&registers[of.clone()], &mut self.angles[of.clone()]);
        let turns = &mut self.turns[of];
        // Gathered first, so that the second loop runs over contiguous memory.
        for (angle, &register) in angles.iter_mut().zip(registers) {
            *angle = self.scalars[register.index()];
        }
        for (turn, angle) in turns.iter_mut().zip(&*angles) {
            *turn = angle.sin_cos();
        }
    }

    /// Sine and cosine of a rotation angle, by its position in `Code::turns`.
    #[inline(always)]
    pub(super) fn turn(&self, turn: Turn) -> (S, S) {
        self.turns[turn.0 as usize]
    }

    /// Sets the rigid transform of the model's root frame, to place the model in a scene or in
    /// camera space. It takes effect at the next evaluation; initially it is the identity.
    pub fn place(&mut self, world: Affine<S>) {
        self.transforms[self.base] = world;
    }

    /// The result of a contact, by its position in [`Program::contacts`].
    pub fn contact(&self, number: usize) -> Option<ContactReport<S>> {
        let at = self.reports.get(number)?.index();
        let [a, b, c, d] = *self.scalars[at..].first_chunk()?;
        Some(ContactReport { angles: [a, b], gaps: [c, d] })
    }

    /// The world transforms of all segments, in the model's order.
    pub fn segments(&self) -> &[Affine<S>] {
        &self.transforms[..self.segments]
    }

    /// The effective stored numbers of all coordinates: limits applied in posed mode, and
    /// coordinates that follow others as their leaders determine them.
    pub fn effective(&self) -> &[S] {
        &self.scalars[..self.stored]
    }

    /// The value of a limit row, in radians or metres: negative if the last evaluation violates
    /// that limit.
    ///
    /// Intended for open mode. In posed mode the row of a bound or a range is that of the requested
    /// value, and the rows of a cone are 0.
    pub fn limit_row(&self, row: usize) -> S {
        self.scalars[self.rows[row].index()]
    }

    /// The numbers that a limit bounds, as they were before it: scalars in the order of its inputs, or an
    /// orientation as x, y, z, w. Of a dependency its driver follows; of a contact there are none.
    pub fn bounded(&self, bound: &Bound) -> impl Iterator<Item = S> {
        bound.numbers.iter().map(|number| self.scalars[number.index()])
    }

    /// The effective stored numbers of one coordinate.
    pub fn coordinate(&self, model: &Model, id: CoordinateId) -> &[S] {
        &self.scalars[model.stored_range(id)]
    }
}
