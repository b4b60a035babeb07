//! Ports: what a law reads, by name and type, and the signals that are connected to them.

use crate::position::{ComponentId, CoordinateId, SegmentId};

/// What is at a port of a component, or moves a segment.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Signal {
    /// The requested value of a coordinate, of any joint set; in posed mode clamped to its range.
    /// If a limit component acts on the coordinate, the limited value is that component's output.
    Coordinate(CoordinateId),
    /// One output of a component, of any joint set.
    Output(ComponentId, u32),
    /// The place of a segment.
    Segment(SegmentId),
}

impl Signal {
    /// The segment, where it is the place of one.
    pub fn segment(self) -> Option<SegmentId> {
        match self {
            Self::Segment(id) => Some(id),
            Self::Coordinate(_) | Self::Output(..) => None,
        }
    }
}

impl From<CoordinateId> for Signal {
    fn from(id: CoordinateId) -> Self {
        Self::Coordinate(id)
    }
}

impl From<SegmentId> for Signal {
    fn from(id: SegmentId) -> Self {
        Self::Segment(id)
    }
}

/// The type of what is at a port.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PortType {
    /// One number: an angle, a distance, a factor.
    Scalar,
    /// A unit quaternion.
    Orientation,
    /// A transform.
    Transform,
    /// The place of a segment in the world.
    Segment,
    /// The place of the joint of a segment, which the segment's own motion does not move.
    Joint,
}

/// How many signals a port takes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Arity {
    /// One.
    One,
    /// One, in some laws of the kind.
    Perhaps,
    /// A list.
    List,
    /// A list that is left out where it is empty, or in some laws of the kind.
    PerhapsList,
}

/// A port of a law.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Port {
    /// Its name, as in files.
    pub name: &'static str,
    /// What it takes.
    pub takes: PortType,
    /// How many of them.
    pub arity: Arity,
    /// The longest list that it takes.
    pub most: usize,
}

impl Port {
    pub(crate) const fn one(name: &'static str, takes: PortType) -> Self {
        Self { name, takes, arity: Arity::One, most: 1 }
    }

    pub(crate) const fn perhaps(name: &'static str, takes: PortType) -> Self {
        Self { name, takes, arity: Arity::Perhaps, most: 1 }
    }

    pub(crate) const fn list(name: &'static str, takes: PortType) -> Self {
        Self { name, takes, arity: Arity::List, most: usize::MAX }
    }

    pub(crate) const fn perhaps_list(name: &'static str, takes: PortType) -> Self {
        Self { name, takes, arity: Arity::PerhapsList, most: usize::MAX }
    }

    /// The same port for lists of at most so many.
    pub(crate) const fn at_most(self, most: usize) -> Self {
        Self { most, ..self }
    }

    /// Whether it takes a list; a law has one such port at most.
    pub fn is_list(&self) -> bool {
        matches!(self.arity, Arity::List | Arity::PerhapsList)
    }
}

/// The signature of a kind of law: its name, and every port that a law of this kind can have.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Kind {
    /// Its name in files and messages.
    pub name: &'static str,
    /// Its ports, in the order of the inputs.
    pub ports: &'static [Port],
}
