//! The limit as a spherical polygon of swing with a range of twist (section 5.1).
//!
//! "Sampling the surface of a sphere, validating each point with respect to the implicit surface, and
//! constructing the spherical polygon from all valid points", with the twist as a function of the swing. The
//! rotation relative to a reference, R′ = m⁻¹ R, is a turn τ about the bone's axis followed by a swing β
//! toward an azimuth α. On each of a number of meridians α:
//!
//! ```text
//! reach     the largest β up to which some τ is possible at every β; the polygon's corner
//! range     [lower, upper](β), the longest run of possible τ, nearest to that at β = 0
//! corner    b₁ = min Σ sin β ((1 - s) b₀ + s b₁ - bound(β))²,  s = ρ² (3 - 2ρ),  ρ = β/reach
//! ```
//!
//! The last line is how [`Cone`] interpolates between its rest b₀ and its corners, so that it is fitted along
//! the whole meridian. What the sphere cannot say is lost: parts beyond a gap of the swing, a second range of
//! twist, and where the range does not follow s.

use super::fitting::SphereLimit;
use condyle_math::{Quat, Vec3};
use condyle_model::limit::{Cone, ConeError, ConePoint, Projection};
use std::f64::consts::{PI, TAU};
use std::fmt;

/// Samples of the twist around the circle.
const TWISTS: usize = 72;
/// Samples of the swing from 0 to π.
const SWINGS: usize = 72;

/// Why a limit cannot be written as a polygon.
#[derive(Clone, Debug, PartialEq)]
pub enum PolygonError {
    /// The bone's axis is zero or not finite.
    NoAxis,
    /// No twist is possible with the bone in its reference direction: the polygon would have no inside.
    RestImpossible,
    /// The corners make no cone.
    Cone(ConeError),
}

impl fmt::Display for PolygonError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NoAxis => write!(f, "the bone's axis is zero; give its direction in the segment"),
            Self::RestImpossible => write!(
                f,
                "no twist is possible in the reference direction, about which the polygon is drawn"
            ),
            Self::Cone(error) => write!(f, "the corners make no cone: {error}"),
        }
    }
}

impl std::error::Error for PolygonError {}

/// A spherical polygon of swing with bounds of twist, about a reference rotation.
#[derive(Clone, Debug, PartialEq)]
pub struct SwingPolygon {
    /// The rotation m from which swing and twist are measured.
    pub reference: Quat,
    /// The limit of m⁻¹ R.
    pub cone: Cone,
}

impl SwingPolygon {
    /// The polygon of a limit with a corner on each of `corners` meridians about the bone's long `axis`.
    ///
    /// # Errors
    /// [`PolygonError`] if nothing is possible around the reference or the corners make no cone.
    pub fn new(
        limit: &SphereLimit,
        axis: Vec3,
        reference: Quat,
        corners: usize,
    ) -> Result<Self, PolygonError> {
        let length = axis.norm();
        if !(length > 0.0 && length.is_finite()) {
            return Err(PolygonError::NoAxis);
        }
        let axis = axis * (1.0 / length);
        let sphere = Sphere::new(limit, axis, reference);
        let at_rest = sphere.range(0.0, 0.0, 0.0).ok_or(PolygonError::RestImpossible)?;
        let points =
            (0..corners).map(|i| sphere.corner(TAU * i as f64 / corners as f64, at_rest)).collect();
        let cone = Cone::new(axis, Some(at_rest), points, 0, Projection::Nearest)
            .map_err(PolygonError::Cone)?;
        Ok(Self { reference, cone })
    }

    /// Whether a rotation is inside.
    pub fn allows(&self, rotation: Quat) -> bool {
        let relative = (self.reference.conjugate() * rotation).to_mat3();
        self.cone.rows(relative).iter().all(|(g, _)| *g >= 0.0)
    }
}

/// The limit in swing and twist.
struct Sphere<'a> {
    limit: &'a SphereLimit,
    axis: Vec3,
    /// Perpendicular to the axis and to each other.
    across: [Vec3; 2],
    reference: Quat,
}

impl<'a> Sphere<'a> {
    fn new(limit: &'a SphereLimit, axis: Vec3, reference: Quat) -> Self {
        // Of x, y, z the one that is farthest from the axis.
        let [x, y, z] = axis.to_array().map(f64::abs);
        let other = if x <= y && x <= z {
            Vec3::X
        } else if y <= z {
            Vec3::Y
        } else {
            Vec3::Z
        };
        let first = axis.cross(other);
        let first = first * (1.0 / first.norm());
        Self { limit, axis, across: [first, axis.cross(first)], reference }
    }

    fn allows(&self, azimuth: f64, swing: f64, twist: f64) -> bool {
        let (sine, cosine) = azimuth.sin_cos();
        // Turning about axis × u moves the axis toward u.
        let toward = self.across[0] * cosine + self.across[1] * sine;
        let swing = Quat::from_axis_angle(self.axis.cross(toward), swing);
        let twist = Quat::from_axis_angle(self.axis, twist);
        self.limit.allows(self.reference * (swing * twist))
    }

    fn reachable(&self, azimuth: f64, swing: f64) -> bool {
        (0..TWISTS).any(|i| self.allows(azimuth, swing, TAU * i as f64 / TWISTS as f64))
    }

    /// The longest run of possible twists, its middle moved by full turns to be nearest to `near`.
    fn range(&self, azimuth: f64, swing: f64, near: f64) -> Option<[f64; 2]> {
        let step = TAU / TWISTS as f64;
        let possible: Vec<bool> =
            (0..TWISTS).map(|i| self.allows(azimuth, swing, step * i as f64)).collect();
        let Some(gap) = possible.iter().position(|p| !p) else {
            // No bound: one full turn.
            return Some([near - PI, near + PI]);
        };
        // Runs are found going round once from a gap.
        let (mut longest, mut run) = ((0, 0), 0);
        for i in 1..=TWISTS {
            if possible[(gap + i) % TWISTS] {
                run += 1;
                if run > longest.1 {
                    longest = (gap + i + 1 - run, run);
                }
            } else {
                run = 0;
            }
        }
        let (first, count) = longest;
        if count == 0 {
            return None;
        }
        let refine = |mut inside: f64, mut outside: f64| {
            for _ in 0..20 {
                let middle = 0.5 * (inside + outside);
                let possible = self.allows(azimuth, swing, middle);
                if possible { inside = middle } else { outside = middle }
            }
            inside
        };
        let start = step * first as f64;
        let end = step * (first + count - 1) as f64;
        let (low, high) = (refine(start, start - step), refine(end, end + step));
        let turns = ((near - 0.5 * (low + high)) / TAU).round() * TAU;
        Some([low + turns, high + turns])
    }

    /// The corner on a meridian, with its fitted twist.
    fn corner(&self, azimuth: f64, at_rest: [f64; 2]) -> ConePoint {
        let step = PI / SWINGS as f64;
        // The direction opposite to rest is always outside of a cone.
        let steps = (1..SWINGS).take_while(|i| self.reachable(azimuth, step * *i as f64)).count();
        let mut inside = step * steps as f64;
        let mut outside = (inside + step).min(PI - 0.02);
        for _ in 0..12 {
            let middle = 0.5 * (inside + outside);
            if self.reachable(azimuth, middle) { inside = middle } else { outside = middle }
        }
        let reach = inside.max(0.02);
        let mut sums = [(0.0, 0.0); 2];
        let mut near = 0.5 * (at_rest[0] + at_rest[1]);
        for i in 1..=24 {
            let rho = f64::from(i) / 24.0;
            let swing = rho * reach;
            let Some(range) = self.range(azimuth, swing, near) else { continue };
            near = 0.5 * (range[0] + range[1]);
            let s = rho * rho * (3.0 - 2.0 * rho);
            for ((product, square), (bound, rest)) in
                sums.iter_mut().zip(range.into_iter().zip(at_rest))
            {
                *product += swing.sin() * s * (bound - (1.0 - s) * rest);
                *square += swing.sin() * s * s;
            }
        }
        let [low, high] = sums.map(|(product, square)| {
            let bound = if square > 0.0 { product / square } else { 0.0 };
            bound.clamp(-TAU, TAU)
        });
        // Where nothing is left of the range, its middle.
        let twist = if low <= high { [low, high] } else { [0.5 * (low + high); 2] };
        let (sine, cosine) = azimuth.sin_cos();
        let toward = self.across[0] * cosine + self.across[1] * sine;
        ConePoint { direction: self.axis * reach.cos() + toward * reach.sin(), twist: Some(twist) }
    }
}
