//! Where a bone may point, and how far it may then turn about itself.
//!
//! A ball joint's rotation R (the bone's frame in the joint's) takes the bone's long axis at rest,
//! the direction r, to v = R·r. R is split as `swing · twist`: the bone turns about r by the angle
//! τ, then swings from r to v along the shortest arc. A cone allows v inside a polygon of great
//! arcs, and τ between two bounds that depend on v: a raised arm turns less about itself than a
//! hanging one.
//!
//! ```text
//! g₁ = signed angle from v to the polygon      g₂ = τ - lower(v)      g₃ = upper(v) - τ
//! legal: g ≥ 0        dg₁/dω = v × ∇d        dg₂/dω = (v + r)/(1 + v·r) - v × ∇lower
//! ```
//!
//! for Ṙ = \[ω\]× R. The polygon may be concave and larger than a hemisphere; r sees all of it
//! (no edge runs along a meridian), and -r is always outside. Its corners are control points, refined by an interpolating scheme
//! (`outline.rs`); `boundary.rs` and `twist.rs` hold the geometry and say where it has kinks. The
//! distance has kinks where two points of the boundary are equally near.
//!
//! An illegal rotation is made legal in this order: the direction is moved to the boundary, the
//! twist is carried along unchanged, and then held to the bounds at the *new* direction. Moving the
//! direction to the nearest point of the boundary is the default. Toward the rest direction, as in
//! Shao & Ng-Thow-Hing 2003, section 4.6, is the other choice: it is continuous wherever v ≠ -r
//! even where the polygon is concave, and moves farther. Their text leaves open how the polygon is
//! subdivided, what happens to the twist, and what is done at -r; these are the readings above.

mod block;
mod boundary;
mod error;
mod outline;
mod twist;

pub use error::ConeError;

use boundary::Boundary;
use condyle_math::{Mat3, Vec3};
use outline::unit;
use twist::TwistBounds;

/// A twist that is outside by less than this is left alone.
///
/// Making a rotation from a legal twist rounds; without room the answer would be moved again.
const TWIST_ROOM: f64 = 1e-10;

/// A corner of a cone: a direction the bone can just reach.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ConePoint {
    /// Where the bone points, of any length but zero, in the joint's frame in the parent.
    pub direction: Vec3,
    /// Lowest and highest twist there in radians; those at rest if none.
    pub twist: Option<[f64; 2]>,
}

/// Where a direction outside a cone goes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Projection {
    /// To the nearest point of the boundary.
    #[default]
    Nearest,
    /// To where the meridian from rest through the direction crosses the boundary.
    ///
    /// Opposite to rest, where every meridian passes, to the nearest point of the boundary.
    TowardRest,
}

/// A legal direction for any direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Projected {
    /// The same vector if that was inside, else one of length 1 at the boundary, just inside.
    pub direction: Vec3,
    /// By how many radians it was moved; 0 if it was inside.
    pub distance: f64,
    /// How near the place is where the answer jumps, in radians; infinite if there is none.
    ///
    /// For [`Projection::Nearest`] how much farther the best separate point of the boundary is: a
    /// move by half of it or less does not make the answer jump. Where the boundary is 87 to 93
    /// degrees away it is 0, for an edge is nearly equally far there all along. It is infinite
    /// outside a convex polygon up to there. For [`Projection::TowardRest`] the angle to the
    /// direction opposite to rest.
    pub margin: f64,
}

/// A legal rotation for any rotation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Legal {
    /// The same matrix, bit for bit, if it was legal.
    pub rotation: Mat3,
    /// Whether it was changed.
    pub moved: bool,
    /// How near the place is where the answer jumps, in radians; infinite if there is none.
    ///
    /// The smallest of the direction's margin, the angle of a moved direction to the one opposite
    /// to rest (where the twist turns fast), and for a moved twist twice its angle to the one from
    /// which both bounds are equally far.
    pub margin: f64,
}

/// The limit of a ball joint: a spherical polygon of directions with bounds of twist.
///
/// A rotation R (the bone's frame in the joint's) takes the long axis at rest r to the direction
/// v = R·r, and R = swing · twist with the shortest swing from r to v and a turn by τ about r. Legal
/// is a v inside the polygon, which may be concave and larger than a hemisphere, with
/// lower(v) ≤ τ ≤ upper(v). The polygon goes through all points given; bounds at rest b₀ and on the
/// boundary b₁ are joined along each meridian by (1 - s)·b₀ + s·b₁, s = ρ²·(3 - 2ρ), with ρ the
/// fraction of the way. After Shao & Ng-Thow-Hing 2003, section 4.6.
///
/// A direction or a rotation that says nothing (zero, or not finite) breaks no limit: it is inside,
/// at an infinite distance, and is returned unchanged.
///
/// ```
/// use condyle_math::{Mat3, Vec3};
/// use condyle_model::limit::{Cone, ConePoint, Projection};
/// // A bone along x that can reach 45 degrees to four sides and turn by 0.5 either way.
/// let corner = |y, z| ConePoint { direction: Vec3::new(1.0, y, z), twist: None };
/// let corners = vec![corner(1.0, 0.0), corner(0.0, 1.0), corner(-1.0, 0.0), corner(0.0, -1.0)];
/// let cone = Cone::new(Vec3::X, Some([-0.5, 0.5]), corners, 0, Projection::Nearest).unwrap();
///
/// let turned = cone.legal(Mat3::rotation_x(0.8));
/// assert!((turned.rotation.y - Mat3::rotation_x(0.5).y).norm() < 1e-15);
/// let raised = cone.legal(Mat3::rotation_z(1.2));
/// assert!((raised.rotation.x - Mat3::rotation_z(1.2).x).norm() > 0.4);
/// assert!(!cone.legal(Mat3::rotation_z(0.6)).moved);
/// ```
#[derive(Clone, Debug)]
pub struct Cone {
    rest: Vec3,
    twist_at_rest: Option<[f64; 2]>,
    points: Vec<ConePoint>,
    subdivisions: u32,
    projection: Projection,
    boundary: Boundary,
    twist: Option<TwistBounds>,
}

/// All else follows from what was given.
impl PartialEq for Cone {
    fn eq(&self, other: &Self) -> bool {
        let given =
            |cone: &Self| (cone.rest, cone.twist_at_rest, cone.subdivisions, cone.projection);
        given(self) == given(other) && self.points == other.points
    }
}

impl Cone {
    /// The most points that a refined boundary may have.
    pub const MOST_POINTS: usize = 512;

    /// The cone around a rest direction through points in their order around it, either way round.
    ///
    /// `rest` is the bone's long axis at rest, of any length but zero; bounds of twist are in
    /// radians, from -2π to 2π, lower first. Their number of points is doubled `subdivisions`
    /// times.
    ///
    /// # Errors
    /// [`ConeError`] says which points do not make a cone, and what would.
    pub fn new(
        rest: Vec3,
        twist_at_rest: Option<[f64; 2]>,
        points: Vec<ConePoint>,
        subdivisions: u32,
        projection: Projection,
    ) -> Result<Self, ConeError> {
        let axis = unit(rest).ok_or(ConeError::NoRest)?;
        let outline = outline::outline(axis, twist_at_rest, &points, subdivisions)?;
        let directions: Vec<Vec3> = outline.iter().map(|point| point.direction).collect();
        let boundary = Boundary::new(axis, &directions);
        let twist = twist_at_rest.map(|at_rest| {
            let at_points = outline.iter().map(|point| point.twist.unwrap_or(at_rest)).collect();
            TwistBounds::new(at_rest, at_points)
        });
        Ok(Self { rest, twist_at_rest, points, subdivisions, projection, boundary, twist })
    }

    /// The bone's long axis at rest, as given.
    pub fn rest(&self) -> Vec3 {
        self.rest
    }

    /// The bounds of twist at rest in radians, if twist is bounded.
    pub fn twist_at_rest(&self) -> Option<[f64; 2]> {
        self.twist_at_rest
    }

    /// The control points, as given.
    pub fn points(&self) -> &[ConePoint] {
        &self.points
    }

    /// How often the number of points was doubled.
    pub fn subdivisions(&self) -> u32 {
        self.subdivisions
    }

    /// Where a direction outside goes.
    pub fn projection(&self) -> Projection {
        self.projection
    }

    /// The corners of the polygon that is tested, of length 1, counter-clockwise around rest.
    ///
    /// What is drawn from them, with great arcs between, is the limit itself.
    pub fn boundary(&self) -> impl ExactSizeIterator<Item = Vec3> {
        self.boundary.edges.iter().map(|edge| edge.start)
    }

    /// Whether the bone may point in a direction of any length.
    pub fn contains(&self, direction: Vec3) -> bool {
        unit(direction).is_none_or(|v| self.boundary.contains(v))
    }

    /// How far inside a direction is, in radians, and how that grows with it.
    ///
    /// The geodesic angle to the nearest point of the boundary, negative outside. The gradient has
    /// length 1 and is tangent to the sphere at the direction, taken with length 1; on a corner it
    /// is the mean of the normals of its edges. It jumps where two points are equally near.
    pub fn distance(&self, direction: Vec3) -> (f64, Vec3) {
        let Some(v) = unit(direction) else { return (f64::INFINITY, Vec3::ZERO) };
        let nearest = self.boundary.nearest(v);
        (nearest.distance, nearest.gradient)
    }

    /// The direction itself if it is inside, else the legal one that the projection chooses.
    pub fn project(&self, direction: Vec3) -> Projected {
        match unit(direction) {
            Some(v) if !self.boundary.contains(v) => self.project_outside(v),
            _ => Projected { direction, distance: 0.0, margin: f64::INFINITY },
        }
    }

    fn project_outside(&self, v: Vec3) -> Projected {
        let boundary = &self.boundary;
        let crossing = match self.projection {
            Projection::Nearest => None,
            Projection::TowardRest => boundary.crossing(v),
        };
        let (direction, margin) = match crossing {
            Some(point) => {
                let opposite = v.cross(boundary.rest).norm().atan2(-v.dot(boundary.rest));
                (boundary.settle(point, boundary.rest), opposite)
            }
            None => {
                let nearest = boundary.nearest(v);
                let margin = match self.projection {
                    Projection::Nearest => boundary.margin(v, &nearest),
                    Projection::TowardRest => 0.0,
                };
                (boundary.settle_nearest(&nearest), margin)
            }
        };
        let distance = v.cross(direction).norm().atan2(v.dot(direction));
        Projected { direction, distance, margin }
    }

    /// Lowest and highest twist in radians for a direction, and how they grow with it.
    ///
    /// The gradients are tangent to the sphere at the direction, taken with length 1. Outside the
    /// polygon the bounds are those where the meridian from rest crosses it. None if twist is free.
    pub fn twist_bounds(&self, direction: Vec3) -> Option<([f64; 2], [Vec3; 2])> {
        Some(self.twist.as_ref()?.at(&self.boundary, unit(direction)?))
    }

    /// The rotation itself if it is legal, else a legal one near it.
    ///
    /// The direction is projected, the twist carried and then held to the nearer of the bounds at
    /// the new direction, the short way around the circle. Where the bone points opposite to rest
    /// its twist is undetermined and taken as 0. A twist outside by less than 1e-10 counts as legal.
    pub fn legal(&self, rotation: Mat3) -> Legal {
        let unchanged = Legal { rotation, moved: false, margin: f64::INFINITY };
        let rest = self.boundary.rest;
        let Some(v) = unit(rotation * rest) else { return unchanged };
        let inside = self.boundary.contains(v);
        if inside && self.twist.is_none() {
            return unchanged;
        }
        let mut twist = twist::twist(&rotation, rest, v);
        if inside && self.twist.as_ref().is_some_and(|bounds| bounds.always_holds(twist)) {
            return unchanged;
        }
        let (mut direction, mut margin) = (v, f64::INFINITY);
        if !inside {
            let projected = self.project_outside(v);
            direction = projected.direction;
            let opposite = v.cross(rest).norm().atan2(-v.dot(rest));
            margin = projected.margin.min(opposite);
        }
        if let Some(bounds) = &self.twist {
            let mut at = bounds.at(&self.boundary, direction).0;
            let standing = twist::standing(twist, at);
            let outside = standing.above_lower.min(standing.below_upper) < -TWIST_ROOM;
            if inside && !outside {
                return unchanged;
            }
            if outside {
                if inside {
                    // The new matrix rounds, which must not put the direction outside.
                    direction = self.boundary.settle_inside(v);
                    at = bounds.at(&self.boundary, direction).0;
                }
                twist = if standing.above_lower < 0.0 { at[0] } else { at[1] };
                margin = margin.min(standing.margin);
            }
        }
        Legal { rotation: twist::rotation(rest, direction, twist), moved: true, margin }
    }

    /// Three numbers that are none of them negative just where a rotation is legal, with gradients.
    ///
    /// Signed distance of the direction, twist above its lower bound, twist below its upper bound,
    /// in radians, the twist taken the short way around the circle. Each gradient is the derivative
    /// by the angular velocity ω in the parent's frame, Ṙ = \[ω\]× R. Infinite, with a gradient of
    /// zero, where nothing is bounded. `rotation` is taken to be a rotation.
    pub fn rows(&self, rotation: Mat3) -> [(f64, Vec3); 3] {
        let rest = self.boundary.rest;
        let free = (f64::INFINITY, Vec3::ZERO);
        let Some(v) = unit(rotation * rest) else { return [free; 3] };
        let nearest = self.boundary.nearest(v);
        let swing = (nearest.distance, v.cross(nearest.gradient));
        let Some(bounds) = &self.twist else { return [swing, free, free] };
        let (at, gradients) = bounds.at(&self.boundary, v);
        let standing = twist::standing(twist::twist(&rotation, rest, v), at);
        let rate = twist::twist_rate(rest, v);
        [
            swing,
            (standing.above_lower, rate - v.cross(gradients[0])),
            (standing.below_upper, v.cross(gradients[1]) - rate),
        ]
    }
}
