//! What a limit depends on: the values of a driver, one for each sample, and how they are used.

use crate::CoordinateKind;
use condyle_math::Quat;

/// A value of what a limit depends on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Driver {
    /// A coordinate, in radians or metres.
    Scalar(f64),
    /// The rotation of a segment in another, a unit quaternion; q and -q are one.
    Rotation(Quat),
}

/// The driver at each sample.
#[derive(Clone, Debug, PartialEq)]
pub enum Drivers {
    /// Values of a coordinate.
    Scalars(Vec<f64>),
    /// Rotations of a segment in another.
    Rotations(Vec<Quat>),
}

impl Drivers {
    /// How many there are.
    #[must_use]
    pub fn len(&self) -> usize {
        match self {
            Self::Scalars(values) => values.len(),
            Self::Rotations(values) => values.len(),
        }
    }

    /// Whether there are none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// What they measure if nothing else is said: an angle, or a rotation in space.
    #[must_use]
    pub fn usual_kind(&self) -> CoordinateKind {
        match self {
            Self::Scalars(_) => CoordinateKind::Rotation,
            Self::Rotations(_) => CoordinateKind::Orientation,
        }
    }

    /// The driver at a sample.
    #[must_use]
    pub fn get(&self, sample: usize) -> Option<Driver> {
        match self {
            Self::Scalars(values) => values.get(sample).copied().map(Driver::Scalar),
            Self::Rotations(values) => values.get(sample).copied().map(Driver::Rotation),
        }
    }

    /// How many numbers a value has at a port: 1, or 4 of a rotation.
    #[must_use]
    pub fn numbers(&self) -> usize {
        match self {
            Self::Scalars(_) => 1,
            Self::Rotations(_) => 4,
        }
    }
}

impl Driver {
    /// How far two values are apart: their difference, or the angle between two rotations in radians.
    #[must_use]
    pub fn distance(self, other: Self) -> f64 {
        match (self, other) {
            (Self::Scalar(a), Self::Scalar(b)) => (a - b).abs(),
            (Self::Rotation(a), Self::Rotation(b)) => a.angle_to(b),
            _ => f64::INFINITY,
        }
    }
}

/// How a dependence is learned.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DependenceSettings {
    /// By how much a boundary may move with the driver, in radians per unit of it: a sample that was taken at another value
    /// counts for as much less.
    pub slope: f64,
    /// How far the values are apart at which fields are learned, in units of the driver.
    pub step: f64,
    /// Nodes along an edge of the map of each of these fields, 24 to 128.
    pub nodes: usize,
    /// With fewer samples within a step, nothing is known of a value.
    pub few: u32,
    /// The thickness of the layer about each field, in radians; found by leaving samples out if not given.
    pub gap: Option<f64>,
}

impl DependenceSettings {
    /// What is usual for drivers of a kind.
    #[must_use]
    pub fn of(drivers: &Drivers) -> Self {
        let (step, nodes) = match drivers {
            Drivers::Scalars(_) => (0.25, 64),
            Drivers::Rotations(_) => (0.4, 40),
        };
        Self { slope: 0.5, step, nodes, few: 12, gap: None }
    }
}

/// Numbers that follow from samples, and of which a rounding decides too much to find them again.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DependenceKnown {
    /// The radius of empty balls, in radians.
    pub radius: f64,
    /// The thickness of the layer, in radians.
    pub gap: f64,
}

/// What a limit depends on.
#[derive(Clone, Debug, PartialEq)]
pub struct Dependence {
    /// The coordinate, or the segment whose rotation it is.
    pub name: String,
    /// Of a rotation, the segment in which it is seen; `None` for the laboratory, or what was not said.
    pub reference: Option<String>,
    /// What a coordinate measures, and so its unit; of a rotation an orientation.
    pub kind: CoordinateKind,
    /// The driver at each of the limit's samples.
    pub drivers: Drivers,
    /// How it is learned.
    pub settings: DependenceSettings,
    /// What was learned before and is not to be found anew.
    pub known: Option<DependenceKnown>,
}
