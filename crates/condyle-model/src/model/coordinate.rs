//! Coordinates: the few numbers that a user sets.

use super::JointSetId;
use crate::component::Signal;
use crate::limit::Range;

/// What a coordinate measures.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CoordinateKind {
    /// An angle in radians.
    Rotation,
    /// A distance in metres.
    Translation,
    /// A scale factor without unit; 1 by default.
    Scale,
    /// None of these: a weight, or an angle mixed with a distance.
    Other,
    /// A rotation in space: four stored numbers x, y, z, w with three degrees of freedom.
    Orientation,
}

impl CoordinateKind {
    /// How many numbers are stored.
    pub fn stored(self) -> usize {
        if self == Self::Orientation { 4 } else { 1 }
    }

    /// The value that changes nothing.
    pub fn neutral(self) -> [f64; 4] {
        match self {
            Self::Orientation => [0.0, 0.0, 0.0, 1.0],
            Self::Scale => [1.0, 0.0, 0.0, 0.0],
            _ => [0.0; 4],
        }
    }

    /// The number of independent directions in which it moves.
    pub fn tangent(self) -> usize {
        if self == Self::Orientation { 3 } else { 1 }
    }

    /// The word for it in tables and files.
    pub fn name(self) -> &'static str {
        match self {
            Self::Rotation => "rotation",
            Self::Translation => "translation",
            Self::Scale => "scale",
            Self::Other => "other",
            Self::Orientation => "orientation",
        }
    }
}

/// One meaningful degree of freedom, such as the flexion of a knee.
#[derive(Clone, Debug, PartialEq)]
pub struct Coordinate {
    /// The coordinate's name; unique in its joint set.
    pub name: String,
    /// The joint set it belongs to.
    pub joint_set: JointSetId,
    /// What it measures.
    pub kind: CoordinateKind,
    /// Its value unless another is given: one number, or x, y, z, w.
    pub default: [f64; 4],
    /// Its range, of a kind that is one number.
    pub range: Range,
    /// What the people of its source reach on average, lowest and highest: no limit, but what a motion is compared
    /// with.
    pub typical: Option<[f64; 2]>,
    /// Whether tracking keeps it at its default.
    pub locked: bool,
    /// What determines it, if it is coupled to others; requests for it are then ignored.
    pub follows: Option<Signal>,
    /// What it drives outside the model, such as a morph or a muscle, where it moves nothing itself.
    pub drives: Option<String>,
    /// Where its numbers come from.
    pub source: Option<String>,
}
