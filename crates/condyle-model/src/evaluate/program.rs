//! A model flattened for evaluation.

use super::derivative_plan::DerivativePlan;
use super::instruction::Code;
use crate::model::{ComponentId, CoordinateId, Model, SegmentId};
use std::fmt;

/// Whether limits move the coordinates.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mode {
    /// Limits move the coordinates first: what is asked for is brought into its range.
    Posed,
    /// Coordinates are taken as given.
    Open,
}

/// A model compiled for evaluation: flat, sorted, and shared by all poses.
#[derive(Clone, Debug)]
pub struct Program {
    /// How many numbers the coordinates store.
    pub(super) stored: usize,
    pub(super) segments: usize,
    /// Registers that hold the same number at every evaluation.
    pub(super) constants: Vec<(u32, f64)>,
    /// Coordinates that a limit component holds: their own register, and the one for what was
    /// asked for.
    pub(super) asked: Vec<(u32, u32)>,
    /// Register, lower and upper bound of every coordinate that posed mode holds.
    pub(super) limits: Vec<(u32, f64, f64)>,
    pub(super) code: Code,
    pub(super) plan: DerivativePlan,
}

/// A buffer of the wrong length.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SizeMismatch {
    /// Which buffer.
    pub buffer: &'static str,
    /// The length it must have.
    pub expected: usize,
    /// The length it has.
    pub found: usize,
}

impl fmt::Display for SizeMismatch {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} has {} numbers but must have {}", self.buffer, self.found, self.expected)
    }
}

impl std::error::Error for SizeMismatch {}

impl SizeMismatch {
    /// Checks one buffer.
    pub(super) fn check(
        buffer: &'static str,
        expected: usize,
        found: usize,
    ) -> Result<(), SizeMismatch> {
        if expected == found { Ok(()) } else { Err(Self { buffer, expected, found }) }
    }
}

impl Program {
    /// How many numbers [`Program::evaluate`] takes: one for each coordinate, four for an
    /// orientation.
    pub fn stored_len(&self) -> usize {
        self.stored
    }

    /// How many directions the coordinates move in.
    pub fn tangent_len(&self) -> usize {
        self.plan.tangents
    }

    /// How many segments there are.
    pub fn segment_len(&self) -> usize {
        self.segments
    }

    /// Directions that move a segment, each with the number of its twist in a [`Jacobian`].
    ///
    /// [`Jacobian`]: super::Jacobian
    pub fn segment_directions(&self, segment: SegmentId) -> &[(u32, u32)] {
        self.plan.segment_entries(segment.index())
    }

    /// The contacts that move something: [`Pose::contact`](super::Pose::contact) reports on them by
    /// their number in this list.
    pub fn contacts(&self) -> impl ExactSizeIterator<Item = ComponentId> {
        self.code.contacts.iter().map(|call| call.component)
    }

    /// Whether a segment hangs below a scale or a shear, so that its transform is not rigid.
    pub fn deforms(&self, segment: SegmentId) -> bool {
        self.plan.deforming[segment.index()]
    }

    /// Directions that move the effective value of a coordinate of one number, each with the slot
    /// of its derivative in a [`Jacobian`]: itself, or the leaders of one that follows.
    ///
    /// [`Jacobian`]: super::Jacobian
    pub fn coordinate_directions(&self, model: &Model, coordinate: CoordinateId) -> &[(u32, u32)] {
        self.plan.coordinate_entries(model.stored_range(coordinate).start)
    }

    /// How many limits there are that bounds of single coordinates do not express.
    ///
    /// Each is a number that a legal posture does not make negative, in radians or metres: the
    /// distance of a passive angle from the bound that its driver sets, or of a coordinate that
    /// follows others from its range. [`Pose::limit_row`](super::Pose::limit_row) has the
    /// number of the last evaluation.
    pub fn limit_row_len(&self) -> usize {
        self.code.rows.len()
    }

    /// Directions that move a limit row, each with the slot of its derivative in a [`Jacobian`].
    ///
    /// [`Jacobian`]: super::Jacobian
    pub fn limit_row_directions(&self, row: usize) -> &[(u32, u32)] {
        self.plan.row_entries(row)
    }
}
