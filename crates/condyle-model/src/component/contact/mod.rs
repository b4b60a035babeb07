//! Gliding contact of the scapula with the rib cage (Shao & Ng-Thow-Hing 2003, sections 4.7 and
//! 5.2).
//!
//! The ribs of one side, with the muscle and fat on them, are modelled by an ellipsoid. Two points
//! P₁ and P₂ of the scapula, whose joint with the clavicle is at its origin O, are in contact with
//! it. Starting from the pose F given by the joint, the scapula is rotated by θ about the fixed
//! axis x₁ until P₁ is on the ellipsoid, and then by ψ about x₂ = P₁/|P₁|, which does not move P₁,
//! until P₂ is on it as well:
//!
//! ```text
//! R = R(x₁, θ)·R(x₂, ψ),   scapula_in_ellipsoid = F·R
//! ```
//!
//! P₁ and P₂ are interpolated between up to four pairs of points, so that the contact moves over
//! the scapula with up to two drivers, for example the elevation of the shoulder and the rotation
//! of the scapula (`pairs.rs`).
//!
//! A point that rotates about an axis meets an ellipsoid at 0, 2 or 4 angles (`quartic.rs`). The
//! one nearest to rest (angle 0) is used; the paper does not specify which one its binary search
//! finds. If there is none, the angle of closest approach is used, the extremum of f(θ) =
//! |p(θ)/radii|² - 1 with the smallest |f|, and the remaining distance is reported as a gap
//! (`closest.rs`). Two roots that merge do so at that extremum, so the angle is continuous there.
//!
//! Derivatives follow from the implicit function theorem: one Newton step θ - f(θ)/f′(θ) in the
//! caller's number type changes the value only by rounding, and has the derivatives of the root.
//! Without contact the step is θ - f′(θ)/f″(θ). Kinks: where contact begins or ends, the angle
//! varies like a square root, so its derivative is unbounded; it is limited by using at least 10⁻⁶
//! of the largest harmonic for |f′|. Discontinuities: where the selected pair of roots vanishes
//! while another remains, and where two roots are equally near; [`Glide::next`] is the distance
//! from the latter.

mod closest;
mod extrema;
mod lines;
mod pairs;
mod quartic;

pub use pairs::ContactPair;

use super::{Contract, Fault, Geometry, Kind, Mirrored, Port, PortType, Reflection};
use closest::distance;
use condyle_diagnostics::Severity;
use condyle_math::{Affine, Growth, Lane, Mat3, Scalar, Vec3};
use pairs::Places;
use quartic::{Quartic, Turn};

/// A segment that glides on an ellipsoid fixed in another segment, like the scapula on the thorax.
///
/// Its ports are the `segment` that glides, the scapula; the `surface`, the segment in which the
/// ellipsoid is fixed: the thorax, or a bone that moves with it; the transform of the segment's own joint
/// `before` the two rotations; and at most two `drivers` that interpolate between the pairs.
#[derive(Clone, Debug, PartialEq)]
pub struct Contact {
    /// Whether there is a transform before the two rotations.
    pub before: bool,
    /// The largest distance of the two points from the ellipsoid in metres, inside and outside: four
    /// limit rows, two for each point. `None` bounds nothing.
    pub most_gap: Option<f64>,
    /// Ellipsoid, axis and pairs of points.
    pub law: Gliding,
}

impl Contact {
    pub(crate) const KIND: Kind = Kind {
        name: "contact",
        ports: &[
            Port::one("segment", PortType::Joint),
            Port::one("surface", PortType::Segment),
            Port::perhaps("before", PortType::Transform),
            Port::perhaps_list("drivers", PortType::Scalar).at_most(2),
        ],
    };
}

impl Contract for Contact {
    fn has(&self, port: &Port) -> bool {
        self.before || port.name != "before"
    }

    fn faults(&self) -> Vec<Fault> {
        match self.most_gap {
            Some(gap) if gap.is_nan() || gap < 0.0 => vec![Fault {
                severity: Severity::Error,
                code: "model/gap",
                said: format!("allows a gap of at most {gap} m"),
                help: "give the largest distance of its points from the ellipsoid, at least 0",
            }],
            _ => vec![],
        }
    }

    fn geometry(&mut self) -> Vec<Geometry<'_>> {
        vec![]
    }

    fn grow(&mut self, _: &Growth, segments: &[Growth]) {
        let &[own, below, ..] = segments else { return };
        self.most_gap = self.most_gap.map(|gap| gap * below.mean());
        // Rebuilt only where it changes, so that factor 1 keeps every bit.
        if own.is_none() && below.is_none() {
            return;
        }
        let mut place = self.law.ellipsoid_in_surface();
        place.translation = below.point(place.translation);
        let axes = [Vec3::X, Vec3::Y, Vec3::Z].map(|axis| below.length(place.linear * axis));
        let radii = self.law.radii().times(Vec3::from(axes));
        let pair = |p: &ContactPair| ContactPair {
            first: own.point(p.first),
            second: own.point(p.second),
            at: p.at,
        };
        let pairs = self.law.pairs().iter().map(pair).collect();
        if let Ok(law) = Gliding::new(place, radii, self.law.axis(), pairs) {
            self.law = law;
        }
    }

    fn mirror(&mut self, at: Reflection) -> Result<Mirrored, String> {
        let pair = |p: &ContactPair| ContactPair {
            first: at.point(p.first),
            second: at.point(p.second),
            at: p.at,
        };
        let pairs = self.law.pairs().iter().map(pair).collect();
        let pose = at.frame(self.law.ellipsoid_in_surface());
        self.law = Gliding::new(pose, self.law.radii(), at.turning(self.law.axis()), pairs)
            .map_err(|_| "write both sides".to_owned())?;
        Ok(Mirrored::default())
    }
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

/// The result of [`Gliding::glide`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Glide<S = f64> {
    /// The rotation R = R(x₁, θ)·R(x₂, ψ) to apply after the segment's pose.
    pub rotation: Mat3<S>,
    /// θ and ψ in radians, each in [-π, π].
    pub angles: [S; 2],
    /// The signed distances of the two points from the ellipsoid in metres, positive outside: 0 in
    /// contact, infinite if the pose is not finite.
    pub gaps: [S; 2],
    /// By how many radians the second-nearest angle of contact is farther from rest than the one
    /// used: the smaller value of the two rotations, infinite if neither point is in contact. At 0
    /// the choice is ambiguous.
    pub next: f64,
}

/// Why arguments do not make a [`Gliding`] contact.
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
    /// Two pairs (positions from 0) have the same values of the drivers.
    EqualPlaces(usize, usize),
    /// The first point of a pair (position from 0) is at the segment's origin, the centre of
    /// rotation.
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
    /// The largest number of pairs of points.
    pub const MOST_PAIRS: usize = 4;

    /// A gliding contact.
    ///
    /// `ellipsoid_in_surface` is the rigid transform of the ellipsoid's frame in the segment in
    /// which it is fixed, `radii` are its half axes in metres, and `axis` is x₁ in the frame of the
    /// gliding segment, of any length except zero.
    ///
    /// # Errors
    /// [`ContactError`] for numbers that are not finite, radii that are not positive, an axis of
    /// length 0, no pairs or too many, two pairs with the same driver values, or a first point at
    /// the origin.
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
        let axis = super::unit(axis);
        Ok(Self { ellipsoid_in_surface, radii, per_radius, axis, pairs, places })
    }

    /// The same contact with its axis and points expressed in the joint frame of the gliding
    /// segment.
    ///
    /// They are given in the frame of the segment, but the rotations are about the joint.
    pub(crate) fn seen_from(&self, joint_in_segment: Affine) -> Self {
        let back = joint_in_segment.rigid_inverse();
        let mut seen = self.clone();
        seen.axis = back.linear * self.axis;
        for pair in &mut seen.pairs {
            (pair.first, pair.second) = (back * pair.first, back * pair.second);
        }
        seen
    }

    /// The transform of the ellipsoid in the segment in which it is fixed.
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

    /// The two points of contact for these values of the drivers, in the frame of the gliding
    /// segment.
    ///
    /// Missing drivers count as 0; those beyond the second are ignored.
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
    /// Which root is used is decided by values, so that this is for one lane.
    ///
    /// `scapula_in_ellipsoid` is the rigid transform F of the gliding segment before the rotations;
    /// its origin is the centre of rotation. For a pose that is not finite there is no rotation and
    /// the gaps are infinite. If interpolation moves the first point to the origin, there is no
    /// second axis and ψ is 0.
    #[inline]
    pub fn glide<S: Lane>(&self, scapula_in_ellipsoid: Affine<S>, drivers: &[S]) -> Glide<S> {
        let [first, second] = self.points(drivers);
        // F in the space in which the ellipsoid is the unit sphere: rows divided by the half axes.
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
        // The second rotation is about the line from the joint to the first point.
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

    /// The rotation about an axis through the origin that brings a point to the unit sphere.
    #[inline(always)]
    fn turn<S: Lane>(&self, scaled: Affine<S>, axis: Vec3<S>, point: Vec3<S>) -> Settled<S> {
        // The point moves on the circle centre + u·cos θ + w·sin θ, an ellipse in the scaled space.
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

    /// The signed distance from the ellipsoid, in metres, of a point given in the space in which
    /// the ellipsoid is the unit sphere.
    ///
    /// Its gradient is the outward normal.
    #[cold]
    fn gap<S: Lane>(&self, scaled: Vec3<S>) -> S {
        let point = scaled.times(self.radii.cast());
        let value = Vec3::new(point.x.value(), point.y.value(), point.z.value());
        let distance = distance(value, self.radii);
        if !distance.signed.is_finite() {
            return S::from_f64(f64::INFINITY);
        }
        // `point - value` has the value 0: the product contributes the derivatives only.
        S::from_f64(distance.signed) + (point - value.cast()).dot(distance.normal.cast())
    }
}

/// The distance from the joint, in metres, below which a point defines no axis.
const LEAST_ARM: f64 = 1e-9;

/// The smallest |f′| or |f″| that is divided by, as a fraction of the largest harmonic.
const LEAST_SLOPE: f64 = 1e-6;

/// One of the two rotations.
struct Settled<S> {
    cos: S,
    sin: S,
    angle: S,
    gap: S,
    next: Turn,
}

/// |θ₂| - |θ₁| of two angles, as cosine and sine, by the addition theorems.
#[inline(always)]
fn farther((c1, s1): Turn, (c2, s2): Turn) -> Turn {
    let (s1, s2) = (s1.abs(), s2.abs());
    (c1 * c2 + s1 * s2, s2 * c1 - c2 * s1)
}

/// Its value if there is no second angle: a cosine below all others.
const NO_NEXT: Turn = (-2.0, 0.0);

fn radians_of(next: Turn) -> f64 {
    if next.0 < -1.5 { f64::INFINITY } else { next.1.atan2(next.0) }
}

/// The root of f nearest to rest, or without roots the extremum of f nearest to 0; and whether it
/// is a root.
#[inline]
fn settle<S: Lane>(quartic: &Quartic<S>) -> (Settled<S>, bool) {
    let value = quartic.value();
    let rest =
        Settled { cos: S::one(), sin: S::zero(), angle: S::zero(), gap: S::zero(), next: NO_NEXT };
    if !value.is_sound() || value.is_constant() {
        return (rest, false);
    }
    let roots = value.roots();
    let mut next = NO_NEXT;
    let (turn, miss, slope) = if roots.as_slice().is_empty() {
        // The extremum is a root of f′: the same Newton step with f′ and f″.
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
        // Near 0 cosines of different angles are equal to rounding: the sine of the difference
        // decides which of the two is nearer.
        next = farther(near, second);
        if next.1 < 0.0 {
            (near, next) = (second, (next.0, -next.1));
        }
        (near, quartic.at(near), value.slope().at(near))
    };
    let least = LEAST_SLOPE * value.scale();
    let slope = if slope.abs() < least { least.copysign(slope) } else { slope };
    // The value of the step is of the order of rounding; it carries the derivatives. The rotation
    // by it, to second order, is exact to rounding, and needs no sine.
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
