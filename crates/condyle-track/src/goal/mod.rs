//! Posing by goals: the legal pose nearest to rest in which points are where they should be.
//!
//! Over the independent coordinates q within their ranges, with loops closed and limits kept,
//!
//! ```text
//! minimise   Σ_g w_g |r_g(q)|²  +  R(q)     subject to   r_e(q) = 0
//!            R(q) = Σ_c k_c |q_c - rest_c|²  +  Σ_p k_p (Σᵢ a_pᵢ qᵢ - rest_p)²
//! ```
//!
//! r_g are the residuals of goals with a weight, r_e those of goals without one, in metres and radians
//! ([`Aim`] has the formula of each). Among all poses that meet the goals, R chooses the one nearest to
//! rest: k is the stiffness that the model gives a coordinate or a sum of several, else [`REST_ANGLE`] or
//! [`REST_LENGTH`]; of an orientation |q - rest| is the angle between them.
//!
//! Goals without a weight are rows that must vanish, as loops are. A goal on one side of a plane is a row
//! that must not be negative. Where no pose meets them, the answer is the legal one with the least
//! Σ_e |r_e|², metres and radians alike, and says by how much each goal is missed.
//!
//! The descent begins at rest and, as a goal behind the back needs another way in, from a fixed list of
//! other starts within the ranges. The same question has the same bits for an answer.
//!
//! ```
//! use condyle_math::Vec3;
//! use condyle_model::ModelBuilder;
//! use condyle_track::goal::{Aim, Goal, Goals, solve};
//!
//! // A forearm of 25 cm whose end should be 15 cm in front of the elbow and 20 cm above it.
//! let mut b = ModelBuilder::new("arm");
//! let forearm = b.segment("forearm", None);
//! b.hinge("elbow", forearm, "flexion", Vec3::Z);
//! let model = b.build().unwrap();
//! let wrist = (Some(forearm), Vec3::new(0.25, 0.0, 0.0));
//! let aim = Aim::Point { point: wrist, at: (None, Vec3::new(0.15, 0.20, 0.0)) };
//! let mut goals = Goals::of(&model);
//! goals.goals.push(Goal { aim, weight: None });
//! let answer = solve(&model, &goals);
//! assert!(answer.is_met());
//! assert!((answer.coordinates[0] - f64::atan2(0.20, 0.15)).abs() < 1e-12);
//! ```

mod answer;
mod determined;
mod lagrange;
mod legal;
mod problem;
mod question;
mod rest;
mod rows;
mod search;
#[cfg(test)]
mod tests;

pub use answer::{Answer, By, Miss};
pub use legal::{nearest_closed, nearest_legal};
pub use rest::{REST_ANGLE, REST_LENGTH, Rest};
pub use search::{follow, misses, solve};

use condyle_math::{Quat, Vec3};
use condyle_model::{CoordinateId, CoordinateKind, Model, Program, SegmentId};

/// A goal without a weight counts as met if it is missed by at most this, in metres or radians.
pub const MET: f64 = 1e-6;

/// A point fixed in a segment, or in the world.
pub type Anchor = (Option<SegmentId>, Vec3);

/// What a pose should do.
#[derive(Clone, Debug, PartialEq)]
pub struct Goal {
    /// What should hold.
    pub aim: Aim,
    /// `None` for a goal that is met exactly; else its weight, per m² or rad², positive and finite.
    pub weight: Option<f64>,
}

/// What should hold, with the residual r that should vanish.
///
/// Segments whose axes are turned or looked along must not be scaled or sheared ([`Aim::deformed`]).
#[derive(Clone, Debug, PartialEq)]
pub enum Aim {
    /// A point at a place: r = p - a in the world, metres.
    Point {
        /// The point p.
        point: Anchor,
        /// The place a, in the world or in another segment.
        at: Anchor,
    },
    /// Two points at a distance: r = |p₁ - p₂| - d, metres.
    Distance {
        /// The points.
        points: [Anchor; 2],
        /// The distance d; above 0.
        distance: f64,
    },
    /// A segment turned as given: r = log(R (R₂ W)ᵀ), the rotation vector between them, radians.
    Orientation {
        /// The segment, with its orientation R.
        segment: SegmentId,
        /// The segment whose axes W refers to, with its orientation R₂; `None` for the world.
        relative_to: Option<SegmentId>,
        /// The wanted orientation W.
        rotation: Quat,
    },
    /// An axis of a segment along a direction: |r| is the angle between them, radians.
    Axis {
        /// The segment.
        segment: SegmentId,
        /// The axis, fixed in the segment; of any length above 0.
        axis: Vec3,
        /// The segment in which the direction is fixed; `None` for the world.
        relative_to: Option<SegmentId>,
        /// The direction; of any length above 0.
        along: Vec3,
    },
    /// An axis of a segment, through a point of it, toward another point: |r| is the angle between the
    /// axis and the line to that point, radians.
    Look {
        /// The segment.
        segment: SegmentId,
        /// The axis, fixed in the segment; of any length above 0.
        axis: Vec3,
        /// The point of the segment through which it goes.
        through: Vec3,
        /// The point looked at.
        at: Anchor,
    },
    /// A point on a plane, or on that side of it to which its normal points: r = n·(p - o), metres, or
    /// the negative part of it.
    Plane {
        /// The point p.
        point: Anchor,
        /// A point o of the plane, and the segment in which the plane is fixed.
        origin: Anchor,
        /// The normal n, fixed in the same segment; of any length above 0.
        normal: Vec3,
        /// Where the point should be.
        side: Side,
    },
    /// A coordinate at a value: r = q - v, radians or metres.
    Coordinate {
        /// The coordinate; of one number.
        coordinate: CoordinateId,
        /// The value v.
        value: f64,
    },
}

/// Where a point should be.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// On the plane.
    On,
    /// On the plane, or on the side to which the normal points.
    Above,
}

impl Aim {
    /// The number of its residuals.
    pub(crate) fn rows(&self) -> usize {
        match self {
            Self::Point { .. } | Self::Orientation { .. } => 3,
            Self::Axis { .. } | Self::Look { .. } => 2,
            Self::Distance { .. } | Self::Plane { .. } | Self::Coordinate { .. } => 1,
        }
    }

    /// Whether it is missed by an angle and not by a length.
    pub fn is_angle(&self, model: &Model) -> bool {
        match self {
            Self::Point { .. } | Self::Distance { .. } | Self::Plane { .. } => false,
            Self::Orientation { .. } | Self::Axis { .. } | Self::Look { .. } => true,
            Self::Coordinate { coordinate, .. } => {
                model.coordinate(*coordinate).kind == CoordinateKind::Rotation
            }
        }
    }

    /// Whether it holds on one side: a residual that is not negative is met.
    pub(crate) fn is_one_sided(&self) -> bool {
        matches!(self, Self::Plane { side: Side::Above, .. })
    }

    /// The segments that it is about.
    pub fn segments(&self) -> impl Iterator<Item = SegmentId> + use<> {
        let both = match self {
            Self::Point { point, at } => [point.0, at.0],
            Self::Distance { points, .. } => points.map(|(segment, _)| segment),
            Self::Orientation { segment, relative_to, .. }
            | Self::Axis { segment, relative_to, .. } => [Some(*segment), *relative_to],
            Self::Look { segment, at, .. } => [Some(*segment), at.0],
            Self::Plane { point, origin, .. } => [point.0, origin.0],
            Self::Coordinate { .. } => [None; 2],
        };
        both.into_iter().flatten()
    }

    /// The segment of which the axes count although it is scaled or sheared, so that they are not at
    /// right angles; `None` if the goal can be used.
    pub fn deformed(&self, program: &Program) -> Option<SegmentId> {
        let turned = match self {
            Self::Orientation { segment, relative_to, .. }
            | Self::Axis { segment, relative_to, .. } => [Some(*segment), *relative_to],
            Self::Look { segment, .. } => [Some(*segment), None],
            Self::Plane { origin, .. } => [origin.0, None],
            Self::Point { .. } | Self::Distance { .. } | Self::Coordinate { .. } => [None; 2],
        };
        turned.into_iter().flatten().find(|&segment| program.deforms(segment))
    }
}

/// All that is asked of a pose.
#[derive(Clone, Debug, PartialEq)]
pub struct Goals {
    /// The goals.
    pub goals: Vec<Goal>,
    /// Coordinates that stay where they are at rest; those that follow others do so all the same.
    pub held: Vec<CoordinateId>,
    /// The pose to be near, and how near.
    pub rest: Rest,
    /// Keep ranges and limits.
    pub limits: bool,
}

impl Goals {
    /// No goals yet, at the rest of a model.
    pub fn of(model: &Model) -> Self {
        Self { goals: vec![], held: vec![], rest: Rest::of(model), limits: true }
    }
}
