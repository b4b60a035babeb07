//! Loops that a tree of segments cannot express.

use super::{CoordinateId, SegmentId};
use condyle_math::function::Function;
use condyle_math::{Affine, Vec3};

/// A condition between segments that no component satisfies by construction.
///
/// Tracking enforces closures; evaluation does not. A segment of `None` is the world.
#[derive(Clone, Debug, PartialEq)]
pub struct Closure {
    /// Its name in messages.
    pub name: String,
    /// What must hold.
    pub condition: Condition,
}

/// The condition of a [`Closure`].
#[derive(Clone, Debug, PartialEq)]
pub enum Condition {
    /// Two points, each fixed in its segment, coincide: p₁ - p₂ = 0 (three rows, metres).
    Points {
        /// The two segments and the points in them.
        at: [(Option<SegmentId>, Vec3); 2],
    },
    /// Two frames, each fixed in its segment, coincide (three rows in metres, three in radians).
    Frames {
        /// The two segments and the frames in them.
        at: [(Option<SegmentId>, Affine); 2],
    },
    /// Two points keep a distance: |p₁ - p₂| - d = 0 (one row, metres).
    Distance {
        /// The two segments and the points in them.
        at: [(Option<SegmentId>, Vec3); 2],
        /// The distance in metres.
        distance: f64,
    },
    /// A coordinate equals a function of another: q - f(p) = 0 (one row). Only cyclic couplings
    /// become closures; all others are evaluated, exactly and without a solver.
    Coupling {
        /// The coordinate that should follow.
        follower: CoordinateId,
        /// The coordinate that should lead.
        driver: CoordinateId,
        /// The function.
        function: Function,
    },
}

impl Condition {
    /// The number of rows it adds to a solver.
    pub fn rows(&self) -> usize {
        match self {
            Self::Points { .. } => 3,
            Self::Frames { .. } => 6,
            Self::Distance { .. } | Self::Coupling { .. } => 1,
        }
    }
}
