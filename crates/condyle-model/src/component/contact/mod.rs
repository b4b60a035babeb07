//! The scapula glides on the ribs (Shao & Ng-Thow-Hing 2003, sections 4.7 and 5.2).
//!
//! The ribs of one side, with the muscle and fat on them, are an ellipsoid; two points P₁ and P₂ of
//! the scapula, which hangs on the clavicle at its origin O, touch it. From the pose F that the
//! joint itself gives, the scapula turns by θ about the fixed axis x₁ until P₁ is on the ellipsoid,
//! and then by ψ about x₂ = P₁/|P₁|, which leaves P₁ where it is, until P₂ is on it as well:
//!
//! ```text
//! R = R(x₁, θ)·R(x₂, ψ),   scapula_in_ellipsoid = F·R
//! ```
//!
//! P₁ and P₂ are blended from up to four pairs, so that the place of contact wanders over the scapula
//! with up to two drivers, say the lift of the shoulder and the rotation of the scapula (`pairs.rs`).
//!
//! A point that turns meets an ellipsoid at 0, 2 or 4 angles (`quartic.rs`). The one nearest to rest
//! (angle 0) is taken; the source's binary search takes one it does not name. Where there is none,
//! the angle is that of closest approach: the extremum of f(θ) = |p(θ)/radii|² - 1 that is nearest
//! to 0, and the distance that is left over is told as a gap (`closest.rs`). As two roots merge they
//! merge into that extremum, so the angle is continuous there.
//!
//! Derivatives come from one Newton step in the caller's number, θ - f(θ)/f′(θ), which changes the
//! value by rounding only (implicit functions); where there is no contact, θ - f′(θ)/f″(θ). Kinks: as
//! the point begins or ceases to touch, the angle goes like the square root of what is missing, so
//! its slope grows without bound; it is cut off where |f′| is below 10⁻⁶ of the largest harmonic.
//! Jumps: where the chosen pair of roots vanishes while another remains, and where two choices are
//! equally near; [`Glide::next`] tells how close that is.

mod closest;
mod extrema;
mod lines;
mod pairs;
mod quartic;

pub use pairs::ContactPair;

use super::Source;
use crate::position::SegmentId;
use closest::distance;
use condyle_math::{Affine, Mat3, Scalar, Vec3};
use pairs::Places;
use quartic::{Quartic, Turn};

/// A segment that glides on an ellipsoid carried by another, as the scapula does on the thorax.
#[derive(Clone, Debug, PartialEq)]
pub struct Contact {
    /// The segment that glides: the scapula.
    pub segment: SegmentId,
    /// The segment that carries the ellipsoid: the thorax, or a bone that moves with it.
    pub surface: SegmentId,
    /// The transform of the segment's own joint, applied before the two rotations.
    pub before: Option<Source>,
    /// What moves the contact from pair to pair: at most two.
    pub drivers: Vec<Source>,
    /// Ellipsoid, axis and pairs.
    pub law: Gliding,
}

/// The ellipsoid, the first axis and the pairs of points of a [`Contact`].
#[derive(Clone, Debug, PartialEq)]
pub struct Gliding {
    ellipsoid_in_surface: Affine,
    radii: Vec3,
    per_radius: Vec3,
    axis: Vec3,
    pairs: Vec<ContactPair>,
    places: Places,
}

/// What [`Gliding::glide`] answers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Glide<S = f64> {
    /// The rotation R = R(x₁, θ)·R(x₂, ψ) to apply after the segment's pose.
    pub rotation: Mat3<S>,
    /// θ and ψ in radians, each in [-π, π].
    pub angles: [S; 2],
    /// How far the two points are from the ellipsoid, in metres and positive outside: 0 in contact,
    /// infinite where the pose is not a finite one.
    pub gaps: [S; 2],
    /// By how much the second-nearest angle of contact lies farther from rest than the one taken, in
    /// radians and for the closer call of the two rotations; infinite where neither touches.
    pub next: f64,
}

/// What nothing can glide with.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum ContactError {
    /// A number is not finite.
    NotFinite,
    /// A half axis of the ellipsoid is not positive.
    Radii,
    /// The first axis has no direction.
    Axis,
    /// There is no pair of points.
    NoPairs,
    /// There are more pairs than [`Gliding::MOST_PAIRS`]: this many.
    TooManyPairs(usize),
    /// Two pairs (positions from 0) touch at the same values of the drivers.
    EqualPlaces(usize, usize),
    /// The first point of a pair (position from 0) is the segment's origin, about which it turns.
    FirstOnOrigin(usize),
}

impl std::fmt::Display for ContactError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::NotFinite => f.write_str("a number of the contact is not finite"),
            Self::Radii => {
                f.write_str("the radii are not all positive: give three half axes in metres")
            }
            Self::Axis => f.write_str("the axis has no direction: give one such as [0, 0, 1]"),
            Self::NoPairs => f.write_str("no pair of points is given: at least one is needed"),
            Self::TooManyPairs(count) => {
                write!(f, "{count} pairs are given, {} are the most", Gliding::MOST_PAIRS)
            }
            Self::EqualPlaces(i, j) => write!(
                f,
                "pairs {} and {} touch at the same values of the drivers: leave out one or move it",
                i + 1,
                j + 1
            ),
            Self::FirstOnOrigin(i) => write!(
                f,
                "the first point of pair {} is the segment's origin and cannot be turned: give a \
                 point away from the joint",
                i + 1
            ),
        }
    }
}

impl std::error::Error for ContactError {}

impl Gliding {
    /// The most pairs of points.
    pub const MOST_PAIRS: usize = 4;

    /// A gliding contact.
    ///
    /// `ellipsoid_in_surface` is the rigid pose of the ellipsoid's centre and axes in the segment
    /// that carries it, `radii` are its half axes in metres, `axis` is x₁ in the gliding segment's
    /// frame, of any length.
    ///
    /// # Errors
    /// [`ContactError`] for numbers that are not finite, radii that are not positive, an axis of
    /// length 0, no pair or too many, two pairs at one place, a first point at the origin.
    pub fn new(
        ellipsoid_in_surface: Affine,
        radii: Vec3,
        axis: Vec3,
        pairs: Vec<ContactPair>,
    ) -> Result<Self, ContactError> {
        let whole = |pair: &ContactPair| {
            pair.first.is_finite()
                && pair.second.is_finite()
                && pair.at.iter().all(|x| x.is_finite())
        };
        let pose = ellipsoid_in_surface.to_rows();
        let finite = pose.iter().all(|x| x.is_finite()) && radii.is_finite() && axis.is_finite();
        if !finite || !pairs.iter().all(whole) {
            return Err(ContactError::NotFinite);
        }
        if !radii.to_array().iter().all(|&r| r > 0.0) {
            return Err(ContactError::Radii);
        }
        let length = axis.norm();
        if !(length.is_finite() && length > 1e-9) {
            return Err(ContactError::Axis);
        }
        if pairs.is_empty() {
            return Err(ContactError::NoPairs);
        }
        if pairs.len() > Self::MOST_PAIRS {
            return Err(ContactError::TooManyPairs(pairs.len()));
        }
        if let Some(i) = pairs.iter().position(|pair| pair.first.norm() < LEAST_ARM) {
            return Err(ContactError::FirstOnOrigin(i));
        }
        let places = Places::new(&pairs);
        if let Some((i, j)) = places.equal(&pairs) {
            return Err(ContactError::EqualPlaces(i, j));
        }
        let per_radius = Vec3::new(1.0 / radii.x, 1.0 / radii.y, 1.0 / radii.z);
        let axis = axis * (1.0 / length);
        Ok(Self { ellipsoid_in_surface, radii, per_radius, axis, pairs, places })
    }

    /// The same contact with its axis and its points as a frame in the gliding segment has them.
    ///
    /// They are given in the segment's own frame, but it turns in that of its joint.
    pub(crate) fn seen_from(&self, joint_in_segment: Affine) -> Self {
        let back = joint_in_segment.rigid_inverse();
        let mut seen = self.clone();
        seen.axis = back.linear * self.axis;
        for pair in &mut seen.pairs {
            (pair.first, pair.second) = (back * pair.first, back * pair.second);
        }
        seen
    }

    /// The pose of the ellipsoid in the segment that carries it.
    pub fn ellipsoid_in_surface(&self) -> Affine {
        self.ellipsoid_in_surface
    }

    /// The half axes of the ellipsoid in metres.
    pub fn radii(&self) -> Vec3 {
        self.radii
    }

    /// The first axis x₁, of length 1, in the gliding segment's frame.
    pub fn axis(&self) -> Vec3 {
        self.axis
    }

    /// The pairs of points.
    pub fn pairs(&self) -> &[ContactPair] {
        &self.pairs
    }

    /// The two points that touch at these values of the drivers, in the gliding segment's frame.
    ///
    /// Drivers that are absent count as 0, those beyond the second not at all.
    #[inline]
    pub fn points<S: Scalar>(&self, drivers: &[S]) -> [Vec3<S>; 2] {
        if let [pair] = &self.pairs[..] {
            return [pair.first.cast(), pair.second.cast()];
        }
        let weights = self.places.weights(drivers);
        let mut points = [Vec3::zero(); 2];
        for (pair, weight) in self.pairs.iter().zip(weights) {
            points[0] += pair.first.cast() * weight;
            points[1] += pair.second.cast() * weight;
        }
        points
    }

    /// The two rotations that bring the points to the ellipsoid.
    ///
    /// `scapula_in_ellipsoid` is the rigid pose F of the gliding segment before them, its origin the
    /// joint about which it turns. Any numbers are answered; a pose that is not finite, with no
    /// rotation and infinite gaps. Where blending has brought the first point to the joint, there is
    /// no second axis and ψ is 0.
    #[inline]
    pub fn glide<S: Scalar>(&self, scapula_in_ellipsoid: Affine<S>, drivers: &[S]) -> Glide<S> {
        let [first, second] = self.points(drivers);
        // The scapula as seen where the ellipsoid is the sphere of radius 1.
        let per_radius = self.per_radius.cast();
        let pose = scapula_in_ellipsoid.linear;
        let scaled = Affine::new(
            Mat3::from_columns(
                pose.x.times(per_radius),
                pose.y.times(per_radius),
                pose.z.times(per_radius),
            ),
            scapula_in_ellipsoid.translation.times(per_radius),
        );
        let axis = self.axis.cast();
        let theta = self.turn(scaled, axis, first);
        let about_first = Mat3::rotation_about(axis, (theta.sin, theta.cos));
        let turned = Affine::new(scaled.linear * about_first, scaled.translation);
        let square = first.norm_squared();
        if square.value() < LEAST_ARM * LEAST_ARM {
            let gap = self.gap(turned * second);
            return Glide {
                rotation: about_first,
                angles: [theta.angle, S::zero()],
                gaps: [theta.gap, gap],
                next: radians_of(theta.next),
            };
        }
        let axis = first * (S::one() / square.sqrt());
        let psi = self.turn(turned, axis, second);
        Glide {
            rotation: about_first * Mat3::rotation_about(axis, (psi.sin, psi.cos)),
            angles: [theta.angle, psi.angle],
            gaps: [theta.gap, psi.gap],
            next: radians_of(if theta.next.0 > psi.next.0 { theta.next } else { psi.next }),
        }
    }

    /// The turn about an axis through the origin that brings a point to the sphere.
    #[inline(always)]
    fn turn<S: Scalar>(&self, scaled: Affine<S>, axis: Vec3<S>, point: Vec3<S>) -> Settled<S> {
        let along = axis * axis.dot(point);
        let centre = scaled * along;
        let u = scaled.linear * (point - along);
        let w = scaled.linear * axis.cross(point);
        let quartic = Quartic::of_circle(centre, u, w);
        let (mut settled, touches) = settle(&quartic);
        if !touches {
            settled.gap = self.gap(centre + u * settled.cos + w * settled.sin);
        }
        settled
    }

    /// The distance of a point, given where the ellipsoid is a sphere, from the ellipsoid.
    ///
    /// Its slope is the outward normal.
    #[cold]
    fn gap<S: Scalar>(&self, scaled: Vec3<S>) -> S {
        let point = scaled.times(self.radii.cast());
        let value = Vec3::new(point.x.value(), point.y.value(), point.z.value());
        let distance = distance(value, self.radii);
        if !distance.signed.is_finite() {
            return S::from_f64(f64::INFINITY);
        }
        S::from_f64(distance.signed) + (point - value.cast()).dot(distance.normal.cast())
    }
}

/// Closer to the joint than this, in metres, a point has no direction to turn about.
const LEAST_ARM: f64 = 1e-9;

/// The part of the largest harmonic below which a slope counts as this much.
const LEAST_SLOPE: f64 = 1e-6;

/// One of the two rotations.
struct Settled<S> {
    cos: S,
    sin: S,
    angle: S,
    gap: S,
    next: Turn,
}

/// The turn by which an angle's distance from rest exceeds another's.
#[inline(always)]
fn farther((c1, s1): Turn, (c2, s2): Turn) -> Turn {
    let (s1, s2) = (s1.abs(), s2.abs());
    (c1 * c2 + s1 * s2, s2 * c1 - c2 * s1)
}

/// In place of that where there is no second angle: a cosine below all others.
const NO_NEXT: Turn = (-2.0, 0.0);

fn radians_of(next: Turn) -> f64 {
    if next.0 < -1.5 { f64::INFINITY } else { next.1.atan2(next.0) }
}

/// The angle nearest to rest where f is 0, or else where it comes nearest to 0; and which it is.
#[inline]
fn settle<S: Scalar>(quartic: &Quartic<S>) -> (Settled<S>, bool) {
    let value = quartic.value();
    let rest =
        Settled { cos: S::one(), sin: S::zero(), angle: S::zero(), gap: S::zero(), next: NO_NEXT };
    if !value.is_sound() || value.is_constant() {
        return (rest, false);
    }
    let roots = value.roots();
    let mut next = NO_NEXT;
    let (turn, miss, slope) = if roots.as_slice().is_empty() {
        let turn = value.nearest_extremum();
        let slope = quartic.slope();
        (turn, slope.at(turn), value.slope().slope().at(turn))
    } else {
        // The largest cosines are nearest to rest.
        let (mut near, mut second) = ((-2.0, 0.0), (-2.0, 0.0));
        for &root in roots.as_slice() {
            if root.0 > near.0 {
                (near, second) = (root, near);
            } else if root.0 > second.0 {
                second = root;
            }
        }
        // By how much the second is farther; cosines alone cannot tell close ones apart.
        next = farther(near, second);
        if next.1 < 0.0 {
            (near, next) = (second, (next.0, -next.1));
        }
        (near, quartic.at(near), value.slope().at(near))
    };
    let least = LEAST_SLOPE * value.scale();
    let slope = if slope.abs() < least { least.copysign(slope) } else { slope };
    // The step is rounding and slope only, so that a parabola turns it exactly.
    let step = miss.scale(-1.0 / slope);
    let half = step * step.scale(0.5);
    let (c, s) = (S::from_f64(turn.0), S::from_f64(turn.1));
    let settled = Settled {
        cos: c - s * step - c * half,
        sin: s + c * step - s * half,
        angle: S::from_f64(turn.1.atan2(turn.0)) + step,
        gap: S::zero(),
        next,
    };
    (settled, !roots.as_slice().is_empty())
}
