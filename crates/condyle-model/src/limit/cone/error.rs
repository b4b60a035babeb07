//! Errors of the construction of a cone.

use std::fmt;

/// Why points do not make a [`Cone`](super::Cone), with the positions of the points concerned.
///
/// Positions count from 0 in the order in which the points were given.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ConeError {
    /// The rest direction is zero or not finite.
    NoRest,
    /// The direction of a point is zero or not finite.
    NoDirection {
        /// The point.
        point: usize,
    },
    /// There are fewer than three points.
    TooFewPoints {
        /// How many were given.
        count: usize,
    },
    /// The refined boundary would have more points than [`Cone::MOST_POINTS`](super::Cone::MOST_POINTS).
    TooManyPoints {
        /// How many were given.
        count: usize,
        /// How often their number would be doubled.
        subdivisions: u32,
    },
    /// A lower twist bound is above the upper one.
    TwistCrossing {
        /// The point; `None` for the bounds at rest.
        point: Option<usize>,
    },
    /// A twist bound is not in [-2π, 2π].
    TwistRange {
        /// The point; `None` for the bounds at rest.
        point: Option<usize>,
    },
    /// A point has twist bounds and the rest direction has none.
    NoTwistAtRest {
        /// The first such point.
        point: usize,
    },
    /// Two consecutive points have the same direction.
    Coincident {
        /// The first of the two.
        from: usize,
        /// The second of the two.
        to: usize,
    },
    /// Two consecutive points are opposite: the shortest arc between them is not unique.
    HalfTurn {
        /// The first of the two.
        from: usize,
        /// The second of the two.
        to: usize,
    },
    /// A point is opposite to the rest direction; that direction is always outside.
    OppositeRest {
        /// The point.
        point: usize,
    },
    /// The rest direction is not strictly inside.
    RestOutside,
    /// Part of the edge between two points is not visible from the rest direction: the polygon is
    /// not star-shaped about it.
    ///
    /// An edge at less than 0.06 degrees to a meridian counts as not visible.
    Hidden {
        /// Where the edge starts.
        from: usize,
        /// Where it ends.
        to: usize,
        /// Whether the refined boundary between the points is hidden, not the arc.
        refined: bool,
    },
    /// The boundary runs around the rest direction more than once.
    WoundTwice,
}

impl fmt::Display for ConeError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let place = |point: Option<usize>| match point {
            Some(point) => format!("at point {point}"),
            None => "at rest".to_owned(),
        };
        match *self {
            Self::NoRest => {
                write!(f, "the rest direction is zero or not finite; give the bone's long axis")
            }
            Self::NoDirection { point } => {
                write!(f, "the direction of point {point} is zero or not finite")
            }
            Self::TooFewPoints { count } => {
                write!(f, "{count} points enclose nothing; give at least 3")
            }
            Self::TooManyPoints { count, subdivisions } => write!(
                f,
                "{count} points doubled {subdivisions} times are more than {}; subdivide less often",
                super::Cone::MOST_POINTS
            ),
            Self::TwistCrossing { point } => write!(
                f,
                "{} the lower twist bound lies above the upper one; exchange them",
                place(point)
            ),
            Self::TwistRange { point } => write!(
                f,
                "{} a twist bound is not within a full turn either way; bounds are in radians, from \
                 -2π to 2π",
                place(point)
            ),
            Self::NoTwistAtRest { point } => write!(
                f,
                "point {point} has twist bounds and the rest direction has none; give bounds at rest \
                 or remove those of the points"
            ),
            Self::Coincident { from, to } => {
                write!(f, "points {from} and {to} have the same direction; remove one of them")
            }
            Self::HalfTurn { from, to } => write!(
                f,
                "points {from} and {to} point opposite ways, so the edge between them is not \
                 determined; put a point between them"
            ),
            Self::OppositeRest { point } => write!(
                f,
                "point {point} lies opposite to the rest direction, which is always outside; move it \
                 toward the rest direction"
            ),
            Self::RestOutside => write!(
                f,
                "the rest direction is not strictly inside the points; choose one inside, or give \
                 the points in their order around it"
            ),
            Self::Hidden { from, to, refined: false } => write!(
                f,
                "the rest direction does not see all of the edge from point {from} to point {to}; \
                 put the points in their order around it, or move one of the two"
            ),
            Self::Hidden { from, to, refined: true } => write!(
                f,
                "after subdivision the rest direction does not see all of the boundary from point \
                 {from} to point {to}; subdivide less often, or put a point between them"
            ),
            Self::WoundTwice => write!(
                f,
                "the points run around the rest direction more than once; put them in their order \
                 around it"
            ),
        }
    }
}

impl std::error::Error for ConeError {}
