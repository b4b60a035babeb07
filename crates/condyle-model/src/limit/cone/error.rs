//! What cannot be a cone.

use std::fmt;

/// Why points do not make a [`Cone`](super::Cone), with the positions of the points meant.
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
    /// Less than three points enclose nothing.
    TooFewPoints {
        /// How many were given.
        count: usize,
    },
    /// The refined boundary would have more points than [`Cone::MOST_POINTS`](super::Cone::MOST_POINTS).
    TooManyPoints {
        /// How many were given.
        count: usize,
        /// How often their number is to be doubled.
        subdivisions: u32,
    },
    /// A lower twist bound lies above the upper one.
    TwistCrossing {
        /// The point; none for the bounds at rest.
        point: Option<usize>,
    },
    /// A twist bound is not finite, or lies beyond a full turn.
    TwistRange {
        /// The point; none for the bounds at rest.
        point: Option<usize>,
    },
    /// A point has twist bounds and the rest direction has none.
    NoTwistAtRest {
        /// The first such point.
        point: usize,
    },
    /// Two neighbours have one direction.
    Coincident {
        /// The first of the two.
        from: usize,
        /// The second of the two.
        to: usize,
    },
    /// Two neighbours point opposite ways: no shortest arc joins them.
    HalfTurn {
        /// The first of the two.
        from: usize,
        /// The second of the two.
        to: usize,
    },
    /// A point lies opposite to the rest direction, which is always outside.
    OppositeRest {
        /// The point.
        point: usize,
    },
    /// The rest direction is not strictly inside.
    RestOutside,
    /// The rest direction does not see the whole edge between two points.
    ///
    /// An edge seen at less than 0.06 degrees, one along a meridian, counts as not seen.
    Hidden {
        /// Where the edge starts.
        from: usize,
        /// Where it ends.
        to: usize,
        /// Whether it is the refined curve between the points that is hidden, not the plain arc.
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
