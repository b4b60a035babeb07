//! Joint cones: limits of the swing and the twist of a ball joint.
//!
//! The rotation R of a ball joint (the bone's frame in the joint's) maps the long axis of the bone
//! at rest, the direction r, to v = R·r. R is decomposed as `swing · twist`: a rotation about r by
//! the angle τ, followed by the swing from r to v along the shortest arc. A cone allows v inside a
//! spherical polygon of great arcs, and τ between two bounds that depend on v: the twist of a
//! raised arm is more limited than that of a hanging arm.
//!
//! ```text
//! g₁ = signed angle from v to the polygon      g₂ = τ - lower(v)      g₃ = upper(v) - τ
//! legal: g ≥ 0        dg₁/dω = v × ∇d        dg₂/dω = (v + r)/(1 + v·r) - v × ∇lower
//! ```
//!
//! for Ṙ = \[ω\]× R. The polygon may be concave and larger than a hemisphere. It is star-shaped
//! about r (no edge runs along a meridian), and -r is always outside. Its corners are control
//! points, refined by an interpolating subdivision scheme (`outline.rs`); the geometry and its
//! kinks are described in `boundary.rs` and `twist.rs`. The distance has kinks where two points of
//! the boundary are equally near.
//!
//! An illegal rotation is made legal in this order: the direction is projected to the boundary with
//! the twist unchanged, then the twist is clamped to the bounds at the *new* direction. The default
//! projection is to the nearest point of the boundary. The alternative, along the meridian toward
//! the rest direction as in Shao & Ng-Thow-Hing 2003, section 4.6, is continuous for v ≠ -r even if
//! the polygon is concave, but moves farther. The paper does not specify the subdivision of the
//! polygon, the treatment of the twist, and the case -r; the choices are those described here.

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

/// A twist that violates its bounds by less than this counts as legal.
///
/// A rotation computed from a legal twist has rounding errors; without a tolerance it would be
/// moved again.
const TWIST_ROOM: f64 = 1e-10;

/// A corner of a cone: a direction at the limit of the bone's reach.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ConePoint {
    /// The direction of the bone, of any length except zero, in the joint's frame in the parent.
    pub direction: Vec3,
    /// Lowest and highest twist there in radians; `None` for those at rest.
    pub twist: Option<[f64; 2]>,
}

/// How a direction outside a cone is projected to its boundary.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Projection {
    /// To the nearest point of the boundary.
    #[default]
    Nearest,
    /// Along the meridian from rest through the direction, to its crossing with the boundary.
    ///
    /// The direction opposite to rest, which is on every meridian, is projected to the nearest
    /// point of the boundary.
    TowardRest,
}

/// The projection of a direction, from [`Cone::project`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Projected {
    /// The given vector if it is inside, otherwise a vector of length 1 at the boundary, just
    /// inside.
    pub direction: Vec3,
    /// The angle in radians by which it was moved; 0 if it is inside.
    pub distance: f64,
    /// A measure, in radians, of the distance to the nearest input where the projection is
    /// discontinuous; infinite if there is none.
    ///
    /// For [`Projection::Nearest`] it is by how much the second nearest local minimum of the
    /// distance to the boundary exceeds the nearest: the projection is continuous within half of
    /// it. It is 0 if the boundary is 87 to 93 degrees away, because all points of an edge are
    /// nearly equally far there, and infinite at smaller distances from a convex polygon. For
    /// [`Projection::TowardRest`] it is the angle to the direction opposite to rest.
    pub margin: f64,
}

/// The legal rotation for a rotation, from [`Cone::legal`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Legal {
    /// The given matrix, unchanged, if it is legal.
    pub rotation: Mat3,
    /// Whether it was changed.
    pub moved: bool,
    /// A measure, in radians, of the distance to the nearest input where the result is
    /// discontinuous; infinite if there is none.
    ///
    /// The smallest of: the margin of a moved direction, as in [`Projected::margin`]; the angle of
    /// a moved direction to the one opposite to rest, near which the twist varies fast; and, for a
    /// clamped twist, twice its angle to the twist from which both bounds are equally far.
    pub margin: f64,
}

/// The limit of a ball joint: a spherical polygon of directions with bounds of twist.
///
/// A rotation R (the bone's frame in the joint's) maps the long axis at rest r to the direction
/// v = R·r, and R = swing · twist with the shortest swing from r to v and a rotation by τ about r.
/// R is legal if v is inside the polygon, which may be concave and larger than a hemisphere, and
/// lower(v) ≤ τ ≤ upper(v). The polygon passes through all given points. Twist bounds are
/// interpolated along each meridian between b₀ at rest and b₁ on the boundary by
/// (1 - s)·b₀ + s·b₁, s = ρ²·(3 - 2ρ), with ρ the fraction of the angle. After Shao & Ng-Thow-Hing
/// 2003, section 4.6.
///
/// A degenerate direction or rotation (zero or not finite) violates no limit: it counts as inside,
/// at an infinite distance, and is returned unchanged.
///
/// ```
/// use condyle_math::{Mat3, Vec3};
/// use condyle_model::limit::{Cone, ConePoint, Projection};
/// // A bone along x that swings by 45 degrees to four sides and twists by ±0.5.
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

/// Compares the arguments of [`Cone::new`]; the other fields are computed from them.
impl PartialEq for Cone {
    fn eq(&self, other: &Self) -> bool {
        let given =
            |cone: &Self| (cone.rest, cone.twist_at_rest, cone.subdivisions, cone.projection);
        given(self) == given(other) && self.points == other.points
    }
}

impl Cone {
    /// The largest number of points of a refined boundary.
    pub const MOST_POINTS: usize = 512;

    /// The cone around a rest direction, with a boundary through points in cyclic order around it,
    /// clockwise or counter-clockwise.
    ///
    /// `rest` is the long axis of the bone at rest, of any length except zero. Twist bounds are in
    /// radians, from -2π to 2π, lower first. The number of points is doubled `subdivisions` times.
    ///
    /// # Errors
    /// [`ConeError`] with the positions of the points that do not make a cone.
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

    /// The long axis of the bone at rest, as given.
    pub fn rest(&self) -> Vec3 {
        self.rest
    }

    /// The twist bounds at rest in radians; `None` if the twist is unlimited.
    pub fn twist_at_rest(&self) -> Option<[f64; 2]> {
        self.twist_at_rest
    }

    /// The control points, as given.
    pub fn points(&self) -> &[ConePoint] {
        &self.points
    }

    /// The number of subdivisions, each of which doubled the number of points.
    pub fn subdivisions(&self) -> u32 {
        self.subdivisions
    }

    /// How a direction outside is projected.
    pub fn projection(&self) -> Projection {
        self.projection
    }

    /// The corners of the refined polygon, of length 1, counter-clockwise around rest.
    ///
    /// Connected by great arcs they are exactly the boundary that is tested.
    pub fn boundary(&self) -> impl ExactSizeIterator<Item = Vec3> {
        self.boundary.edges.iter().map(|edge| edge.start)
    }

    /// Whether the bone may point in a direction of any length.
    pub fn contains(&self, direction: Vec3) -> bool {
        unit(direction).is_none_or(|v| self.boundary.contains(v))
    }

    /// The signed distance of a direction from the boundary in radians, and its gradient.
    ///
    /// The distance is the geodesic angle to the nearest point of the boundary, negative outside.
    /// The gradient has length 1 and is tangent to the sphere at the normalised direction; on a
    /// corner it is the mean of the normals of its edges. It is discontinuous where two points are
    /// equally near.
    pub fn distance(&self, direction: Vec3) -> (f64, Vec3) {
        let Some(v) = unit(direction) else { return (f64::INFINITY, Vec3::ZERO) };
        let nearest = self.boundary.nearest(v);
        (nearest.distance, nearest.gradient)
    }

    /// The direction itself if it is inside, otherwise its projection to the boundary.
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
                // The angle from v to -r.
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

    /// The lowest and highest twist in radians for a direction, and their gradients.
    ///
    /// The gradients are tangent to the sphere at the normalised direction. Outside the polygon the
    /// bounds are those at the crossing of the meridian from rest. `None` if the twist is unlimited
    /// or the direction is degenerate.
    pub fn twist_bounds(&self, direction: Vec3) -> Option<([f64; 2], [Vec3; 2])> {
        Some(self.twist.as_ref()?.at(&self.boundary, unit(direction)?))
    }

    /// The rotation itself if it is legal, otherwise a legal one near it.
    ///
    /// The direction is projected, with the twist unchanged; then the twist is clamped to the
    /// nearer of the bounds at the new direction, the short way around the circle. If the bone
    /// points opposite to rest, its twist is undetermined and taken as 0. A twist that violates its
    /// bounds by less than 1e-10 counts as legal.
    pub fn legal(&self, rotation: Mat3) -> Legal {
        let unchanged = Legal { rotation, moved: false, margin: f64::INFINITY };
        let rest = self.boundary.rest;
        let Some(v) = unit(rotation * rest) else { return unchanged };
        let inside = self.boundary.contains(v);
        if inside && self.twist.is_none() {
            return unchanged;
        }
        // The common case first: no bounds are evaluated if the twist is legal in every direction.
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
                    // Rounding of the new matrix must not move the direction outside.
                    direction = self.boundary.settle_inside(v);
                    at = bounds.at(&self.boundary, direction).0;
                }
                twist = if standing.above_lower < 0.0 { at[0] } else { at[1] };
                margin = margin.min(standing.margin);
            }
        }
        Legal { rotation: twist::rotation(rest, direction, twist), moved: true, margin }
    }

    /// The three limit rows g of a rotation, with their gradients: the rotation is legal if none is
    /// negative.
    ///
    /// The signed distance of the direction, τ - lower and upper - τ, in radians, with twists
    /// measured the short way around the circle. Each gradient is the derivative with respect to
    /// the angular velocity ω in the parent's frame, Ṙ = \[ω\]× R. An absent limit has the value ∞
    /// and the gradient 0. `rotation` must be a rotation matrix.
    pub fn rows(&self, rotation: Mat3) -> [(f64, Vec3); 3] {
        let rest = self.boundary.rest;
        let free = (f64::INFINITY, Vec3::ZERO);
        let Some(v) = unit(rotation * rest) else { return [free; 3] };
        let nearest = self.boundary.nearest(v);
        // v̇ = ω × v, so ḋ = ∇d·(ω × v) = ω·(v × ∇d); likewise for the bounds of twist.
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
