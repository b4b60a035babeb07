//! The twist of a rotation, and its bounds as functions of the direction.
//!
//! The twist of R about r is the angle of the rotation about r that is nearest to R. With v = R·r,
//!
//! ```text
//! τ = atan2(vee(R - Rᵀ)·r, trace R - r·v)        dτ/dω = (v + r) / (1 + v·r)   for Ṙ = [ω]× R
//! ```
//!
//! the same angle as that of `condyle_math::SwingTwist`. Its bounds are given at rest, b₀, and at
//! the points of the boundary. With i the edge in whose wedge v lies,
//!
//! ```text
//! b(v) = (1 - s)·b₀ + s·((1 - t)·bᵢ + t·bᵢ₊₁)        s = ρ²·(3 - 2ρ)
//! t = β / (α + β)    α = -e·(r × pᵢ₊₁)    β = e·(r × pᵢ)      where the meridian meets the chord
//! ρ = θ / θ*         θ = angle(r, v)      θ* = atan2(n·r, -n·e)      clamped to 1 beyond the edge
//! ```
//!
//! e is the direction at r of the meridian through v. The bounds are continuous everywhere except
//! at
//! -r. They have no kink at rest and at the boundary, where the slope of s is 0; between two wedges
//! their derivative with respect to the azimuth is discontinuous.

use super::boundary::Boundary;
use condyle_math::{Mat3, Vec3};
use std::f64::consts::{PI, TAU};

/// Below this value of 1 + v·r the bone points opposite to rest and its twist is undetermined.
const HALF_TURN: f64 = 1e-14;

/// The twist of a rotation about `rest`, in (-π, π]; 0 if the swing is a half turn.
///
/// `direction` is the rotation's image of `rest`; both have length 1.
#[inline]
pub(super) fn twist(rotation: &Mat3, rest: Vec3, direction: Vec3) -> f64 {
    if half_turn(rest, direction) {
        return 0.0;
    }
    let Mat3 { x, y, z } = *rotation;
    let turn = Vec3::new(y.z - z.y, z.x - x.z, x.y - y.x).dot(rest);
    let angle = turn.atan2(x.x + y.y + z.z - rest.dot(direction));
    if !angle.is_finite() {
        // Possible only for a matrix that is far from a rotation.
        return 0.0;
    }
    if angle <= -PI { PI } else { angle }
}

/// The derivative of the twist with respect to ω, Ṙ = \[ω\]× R; zero at a half turn of swing.
#[inline]
pub(super) fn twist_rate(rest: Vec3, direction: Vec3) -> Vec3 {
    if half_turn(rest, direction) {
        return Vec3::ZERO;
    }
    (direction + rest) * (1.0 / (1.0 + direction.dot(rest)))
}

fn half_turn(rest: Vec3, direction: Vec3) -> bool {
    1.0 + direction.dot(rest) < HALF_TURN
}

/// The rotation with this direction and this twist: the shortest swing after the twist.
pub(super) fn rotation(rest: Vec3, direction: Vec3, twist: f64) -> Mat3 {
    let axis = rest.cross(direction);
    let (sine, cosine) = (axis.norm(), rest.dot(direction));
    let swing = if sine > 1e-12 {
        Mat3::rotation_about(axis * (1.0 / sine), (sine, cosine))
    } else {
        // The direction is never opposite to rest here. A rotation by less than 1e-12 equals, to
        // rounding, the product of three with the components of its vector as sines.
        Mat3::rotation_about(Vec3::X, (axis.x, 1.0))
            * Mat3::rotation_about(Vec3::Y, (axis.y, 1.0))
            * Mat3::rotation_about(Vec3::Z, (axis.z, 1.0))
    };
    swing * Mat3::rotation_about(rest, twist.sin_cos())
}

/// The position of a twist relative to its bounds, the short way around the circle.
#[derive(Clone, Copy, Debug)]
pub(super) struct Standing {
    /// The twist less the lower bound.
    pub(super) above_lower: f64,
    /// The upper bound less the twist.
    pub(super) below_upper: f64,
    /// Twice the angle to the twist from which both bounds are equally far.
    pub(super) margin: f64,
}

/// Measures a twist against bounds; `above_lower` and `below_upper` are never both negative.
#[inline]
pub(super) fn standing(twist: f64, [lower, upper]: [f64; 2]) -> Standing {
    let (middle, half) = (0.5 * (lower + upper), 0.5 * (upper - lower));
    let mut off = twist - middle;
    // |twist| ≤ π and |middle| ≤ 2π, so the difference is within 3π: at most two turns are removed.
    for _ in 0..2 {
        off -= if off > PI { TAU } else { 0.0 };
        off += if off <= -PI { TAU } else { 0.0 };
    }
    let margin = if half < PI { 2.0 * (PI - off.abs()) } else { f64::INFINITY };
    Standing { above_lower: off + half, below_upper: half - off, margin }
}

/// Bounds of twist at rest and at the points of the boundary.
#[derive(Clone, Debug)]
pub(super) struct TwistBounds {
    pub(super) at_rest: [f64; 2],
    /// At the start of each edge.
    pub(super) at_points: Vec<[f64; 2]>,
    /// The intersection of all bounds; empty (lower above upper) if it is not used.
    core: [f64; 2],
}

impl TwistBounds {
    pub(super) fn new(at_rest: [f64; 2], at_points: Vec<[f64; 2]>) -> Self {
        let all = || at_points.iter().chain([&at_rest]);
        let plain = all().all(|b| b[0] > -PI && b[1] < PI);
        let lower = all().map(|b| b[0]).fold(-PI, f64::max);
        let upper = all().map(|b| b[1]).fold(PI, f64::min);
        let core = if plain { [lower, upper] } else { [PI, -PI] };
        Self { at_rest, at_points, core }
    }

    /// Whether a twist in (-π, π] is inside the bounds of every direction, which are convex
    /// combinations of the given ones. Always false if bounds extend to ±π, where the twist wraps.
    #[inline]
    pub(super) fn always_holds(&self, twist: f64) -> bool {
        self.core[0] <= twist && twist <= self.core[1]
    }

    /// The bounds for a direction of length 1, and their gradients, tangent at it.
    #[inline]
    pub(super) fn at(&self, boundary: &Boundary, v: Vec3) -> ([f64; 2], [Vec3; 2]) {
        let rest = boundary.rest;
        let height = v.dot(rest);
        let outward = v - rest * height;
        let sine = outward.norm();
        // Near rest s ≈ 3·(θ/θ*)² is negligible; opposite to rest the bounds are undetermined.
        if sine < 1e-9 {
            let i = boundary.wedge(v);
            let bounds = if height > 0.0 { self.at_rest } else { self.at_points[i] };
            return (bounds, [Vec3::ZERO; 2]);
        }
        let i = boundary.wedge(v);
        let edge = &boundary.edges[i];
        let next = if i + 1 == self.at_points.len() { 0 } else { i + 1 };
        // e, and the direction of increasing azimuth φ: de/dφ = around, d around/dφ = -e.
        let outward = outward * (1.0 / sine);
        let around = rest.cross(outward);
        let (alpha, beta) = (around.dot(edge.end), -around.dot(edge.start));
        let (alpha_rate, beta_rate) = (-outward.dot(edge.end), outward.dot(edge.start));
        // Not 0: no edge runs along a meridian, so its ends differ in azimuth.
        let whole = alpha + beta;
        let t = (beta / whole).clamp(0.0, 1.0);
        let t_rate = (alpha * beta_rate - beta * alpha_rate) / (whole * whole);

        let (seen, tilt) = (edge.normal.dot(rest), -edge.normal.dot(outward));
        let (angle, reach) = (sine.atan2(height), seen.atan2(tilt));
        let rho = angle / reach;
        let (s, s_by_angle, s_by_azimuth) = if rho < 1.0 {
            let slope = 6.0 * rho * (1.0 - rho);
            let reach_rate = seen * edge.normal.dot(around) / (seen * seen + tilt * tilt);
            (rho * rho * (3.0 - 2.0 * rho), slope / reach, -slope * rho / reach * reach_rate)
        } else {
            (1.0, 0.0, 0.0)
        };
        // dv/dθ; a change of azimuth moves v by sin θ·dφ, hence the division by `sine` below.
        let away = outward * height - rest * sine;
        let mut answer = ([0.0; 2], [Vec3::ZERO; 2]);
        for k in 0..2 {
            let (b, c) = (self.at_points[i][k], self.at_points[next][k]);
            let at_edge = b + t * (c - b);
            let rise = at_edge - self.at_rest[k];
            let by_azimuth = s_by_azimuth * rise + s * t_rate * (c - b);
            answer.0[k] = self.at_rest[k] + s * rise;
            answer.1[k] = away * (s_by_angle * rise) + around * (by_azimuth / sine);
        }
        answer
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use condyle_math::{Quat, SwingTwist};
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn the_twist_is_the_one_that_swing_twist_splits_off(
            q in [-1.0..1.0, -1.0..1.0, -1.0..1.0, -1.0..1.0f64],
            a in [-1.0..1.0, -1.0..1.0, 0.1..1.0f64],
        ) {
            prop_assume!(q.iter().map(|c| c * c).sum::<f64>() > 1e-3);
            let (q, rest) = (Quat::from(q).normalized(), Vec3::from(a).normalized());
            let matrix = q.to_mat3();
            let direction = (matrix * rest).normalized();
            // Both are undetermined at the half turn; rounding grows toward it as 1 / (1 + v·r).
            prop_assume!(1.0 + direction.dot(rest) > 1e-4);
            let expected = SwingTwist::of(q, rest).twist_angle(rest);
            let ours = twist(&matrix, rest, direction);
            let gap = (ours - expected).sin().abs();
            prop_assert!(gap < 1e-11 && (ours - expected).cos() > 0.0, "{ours} {expected}");
            let again = rotation(rest, direction, ours);
            prop_assert!(Quat::from_mat3(again).angle_to(q) < 1e-11);
        }

        #[test]
        fn the_nearer_bound_is_the_one_nearer_on_the_circle(
            twist in -PI..PI, ends in [-PI..PI, -PI..PI],
        ) {
            let bounds = if ends[0] <= ends[1] { ends } else { [ends[1], ends[0]] };
            let around = |a: f64, b: f64| (a - b).sin().atan2((a - b).cos()).abs();
            let standing = standing(twist, bounds);
            let gap = standing.above_lower.min(standing.below_upper);
            let inside = bounds[0] <= twist && twist <= bounds[1];
            prop_assert!(gap.abs() < 1e-14 || inside == (gap > 0.0));
            if gap < 0.0 {
                let [lower, upper] = bounds.map(|bound| around(twist, bound));
                prop_assert!((lower.min(upper) + gap).abs() < 1e-14);
                let opposite = 0.5 * (bounds[0] + bounds[1]) + PI;
                prop_assert!((2.0 * around(twist, opposite) - standing.margin).abs() < 1e-13);
            }
        }
    }

    #[test]
    fn a_half_turn_of_swing_has_no_twist() {
        let half = Mat3::rotation_about(Vec3::X, (0.0, -1.0));
        assert_eq!(twist(&half, Vec3::Y, half * Vec3::Y), 0.0);
        assert_eq!(twist_rate(Vec3::Y, half * Vec3::Y), Vec3::ZERO);
    }

    #[test]
    fn a_turn_by_a_half_is_positive() {
        let half = Mat3::rotation_about(Vec3::Y, (-0.0, -1.0));
        assert_eq!(twist(&half, Vec3::Y, Vec3::Y), PI);
    }
}
