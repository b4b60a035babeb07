//! The compiled form of a model.

use super::behind::Behind;
use super::derivative_plan::DerivativePlan;
use super::instruction::{Code, Frame, Number};
use super::pose::Pose;
use crate::model::{ComponentId, CoordinateId, Model, SegmentId};
use std::fmt;
use std::ops::Range;

/// Whether limits are applied to the coordinates.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mode {
    /// Limits are applied: requested coordinates are first moved into their ranges, bounds and
    /// cones.
    Posed,
    /// Coordinates are used as given.
    Open,
}

/// A model compiled for evaluation: a sorted list of instructions, shared by all poses.
#[derive(Clone, Debug)]
pub struct Program {
    /// The number of stored numbers of all coordinates.
    pub(super) stored: usize,
    pub(super) segments: usize,
    /// Scalar registers with constant values.
    pub(super) constants: Vec<(Number, f64)>,
    /// For each number of a coordinate that a limit component holds, its own register and that of
    /// the requested value.
    pub(super) asked: Vec<(Number, Number)>,
    /// Register, lower and upper bound of every coordinate that posed mode clamps.
    pub(super) limits: Vec<(Number, f64, f64)>,
    /// The limit rows that posed mode does not keep.
    pub(super) measured_rows: Vec<usize>,
    pub(super) bounds: Vec<Bound>,
    /// Coordinates whose limits act behind maps.
    pub(super) behind: Vec<Behind>,
    pub(super) code: Code,
    pub(super) plan: DerivativePlan,
    /// For each component the numbers that it gives: a constant, or where it is.
    pub(super) outputs: Vec<Vec<Result<f64, Number>>>,
}

/// A component that limits something, in a compiled model.
#[derive(Clone, Debug, PartialEq)]
pub struct Bound {
    /// The component.
    pub component: ComponentId,
    /// Its limit rows.
    pub rows: Range<usize>,
    /// The numbers at its ports: what it bounds, and of a dependency the driver after it; none of a contact.
    pub(super) numbers: Vec<Number>,
}

/// The error for a buffer of the wrong length.
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
    /// The number of stored numbers that [`Program::evaluate`] takes: one for each coordinate, four
    /// for an orientation.
    pub fn stored_len(&self) -> usize {
        self.stored
    }

    /// The numbers that a component gives in an evaluated pose, in the order of its outputs: those of laws that
    /// compute scalars or an orientation, or let them through. None of one that nothing needs.
    pub fn outputs<'p>(
        &'p self,
        pose: &'p Pose,
        component: ComponentId,
    ) -> impl Iterator<Item = f64> + 'p {
        let own = self.outputs.get(component.index()).map_or(&[][..], |own| own);
        own.iter().filter_map(|of| match of {
            Ok(constant) => Some(*constant),
            Err(number) => pose.scalars.get(number.index()).copied(),
        })
    }

    /// The number of directions (tangents) of all coordinates.
    pub fn tangent_len(&self) -> usize {
        self.plan.tangents
    }

    /// The number of segments.
    pub fn segment_len(&self) -> usize {
        self.segments
    }

    /// The directions that move a segment, each with the index of its twist in a [`Jacobian`].
    ///
    /// [`Jacobian`]: super::Jacobian
    pub fn segment_directions(&self, segment: SegmentId) -> &[(u32, u32)] {
        self.plan.frame_entries(Frame::new(segment.index()))
    }

    /// The contacts that move a segment: [`Pose::contact`](super::Pose::contact) takes a position
    /// in this list.
    pub fn contacts(&self) -> impl ExactSizeIterator<Item = ComponentId> {
        self.code.contacts.iter().map(|call| call.component)
    }

    /// The values of the drivers of a contact in an evaluated pose, by its position in
    /// [`Program::contacts`]; of one that is not there, none. [`Gliding::points`] takes them.
    ///
    /// [`Gliding::points`]: crate::component::Gliding::points
    pub fn contact_drivers<'p>(
        &'p self,
        pose: &'p Pose,
        number: usize,
    ) -> impl Iterator<Item = f64> + 'p {
        let drivers = self.code.contacts.get(number).map_or(&[][..], |call| &call.drivers);
        drivers.iter().filter_map(|driver| pose.scalars.get(driver.index()).copied())
    }

    /// Whether a segment is below a scale or a shear, so that its transform is not rigid.
    pub fn deforms(&self, segment: SegmentId) -> bool {
        self.plan.deforming[segment.index()]
    }

    /// The directions on which the effective value of a scalar coordinate depends, each with the
    /// slot of its derivative in a [`Jacobian`]: its own direction, or those of its leaders.
    ///
    /// [`Jacobian`]: super::Jacobian
    pub fn coordinate_directions(&self, model: &Model, coordinate: CoordinateId) -> &[(u32, u32)] {
        self.plan.coordinate_entries(model.stored_range(coordinate).start)
    }

    /// The number of limit rows: limits that are not bounds of single free coordinates.
    ///
    /// Each is a number in radians or metres that is not negative in a legal posture: the distance
    /// of a passive angle from the bound that its driver sets, of a coordinate that follows others
    /// from the ends of its range, or of a ball joint from the boundary of its cone.
    /// [`Pose::limit_row`](super::Pose::limit_row) gives the values of the last evaluation.
    pub fn limit_row_len(&self) -> usize {
        self.code.rows.len()
    }

    /// The limit rows that depend on what is measured between segments, or that bound a contact's gap:
    /// posed mode does not keep them.
    pub fn measured_limit_rows(&self) -> &[usize] {
        &self.measured_rows
    }

    /// The components that limit something, each with its rows; [`Pose::bounded`](super::Pose::bounded) gives
    /// the numbers that they limit.
    pub fn bounds(&self) -> &[Bound] {
        &self.bounds
    }

    /// The directions on which a limit row depends, each with the slot of its derivative in a
    /// [`Jacobian`].
    ///
    /// [`Jacobian`]: super::Jacobian
    pub fn limit_row_directions(&self, row: usize) -> &[(u32, u32)] {
        self.plan.row_entries(row)
    }
}
