//! The nearest rotation at which a spline is not negative.
//!
//! Steps against the distance along its slope land on the boundary; from there steps along the boundary, each kept
//! only if it comes nearer, undo what the landing was off. Where the slope is of no use, at ridges of the distance,
//! the way to the nearest sample is halved until it crosses the boundary. The answer is inside by the same
//! arithmetic that judges it, so projecting it again returns it as it is.

use super::lattice::Lattice;
use condyle_math::{Quat, Vec3};

/// How far inside steps aim, in radians: far above rounding, far below what matters.
const AIM: f64 = 2e-6;
/// What is nearer to the boundary than this, in radians, has landed.
const LANDED: f64 = 2e-5;

/// The slope along turns about the child's own axes.
#[inline]
pub(super) fn tangent(q: Quat, g: [f64; 4]) -> Vec3 {
    // dq = ½ q·(ω, 0): the vector part of conj(q)·g, halved.
    let [x, y, z, w] = g;
    Vec3::new(
        q.w * x + q.z * y - q.y * z - q.x * w,
        q.w * y + q.x * z - q.z * x - q.y * w,
        q.w * z + q.y * x - q.x * y - q.z * w,
    ) * 0.5
}

/// q turned about its own axes by nearly `v`: 2 atan(|v|/2) instead of |v|.
#[inline]
fn turned(q: Quat, v: Vec3) -> Quat {
    let h = v * 0.5;
    super::chart::signed((q * Quat { x: h.x, y: h.y, z: h.z, w: 1.0 }).normalized())
}

/// The vector from `q` to `p` in q's axes, of length 2 sin(θ/2).
#[inline]
fn towards(q: Quat, p: Quat) -> Vec3 {
    let between = q.conjugate() * p;
    between.vector() * if between.w < 0.0 { -2.0 } else { 2.0 }
}

/// From outside along the slope to the boundary; `None` where that leads nowhere.
#[inline]
fn landed(lattice: &Lattice, spline: &[f32], mut q: Quat, steps: usize) -> Option<(Quat, Vec3)> {
    for _ in 0..steps {
        let (distance, g) = lattice.value_and_slope(spline, q);
        let slope = tangent(q, g);
        if (0.0..LANDED).contains(&distance) {
            return Some((q, slope));
        }
        let square = slope.norm_squared();
        if square < 0.04 {
            return None;
        }
        let length = ((AIM - distance) / square).clamp(-0.5 / square.sqrt(), 0.5 / square.sqrt());
        q = turned(q, slope * length);
    }
    None
}

/// The nearest rotation inside, of `from` that is outside. `anchor` gives a rotation inside.
pub(super) fn project(
    lattice: &Lattice,
    spline: &[f32],
    from: Quat,
    anchor: impl FnOnce() -> Option<Quat>,
) -> Option<Quat> {
    let start = landed(lattice, spline, from, 12);
    let (mut at, mut slope) = match start {
        Some(found) => found,
        None => {
            let found = crossing(lattice, spline, from, anchor()?);
            (found, tangent(found, lattice.value_and_slope(spline, found).1))
        }
    };
    let mut nearness = from.dot(at).abs();
    let mut share = 1.0;
    for _ in 0..8 {
        let to = towards(at, from);
        let along = to - slope * (to.dot(slope) / slope.norm_squared().max(1e-12));
        // Half a thousandth of the way: what is left to gain is a ten-millionth of it.
        if along.norm_squared() < 2.5e-7 * to.norm_squared().max(1e-6) || share < 0.05 {
            break;
        }
        let next = landed(lattice, spline, turned(at, along * share), 3);
        match next.filter(|(q, _)| from.dot(*q).abs() > nearness) {
            Some((q, g)) => {
                (at, slope) = (q, g);
                nearness = from.dot(q).abs();
            }
            None => share *= 0.4,
        }
    }
    Some(at)
}

/// The last rotation inside on the way from `inside` to `outside`.
fn crossing(lattice: &Lattice, spline: &[f32], outside: Quat, inside: Quat) -> Quat {
    let way = (inside.conjugate() * outside).log();
    let (mut near, mut far) = (0.0, 1.0);
    let at = |part: f64| super::chart::signed((inside * Quat::exp(way * part)).normalized());
    // To 2⁻³⁰ of at most half a turn.
    for _ in 0..30 {
        let middle = 0.5 * (near + far);
        if lattice.value(spline, at(middle)) >= 0.0 { near = middle } else { far = middle }
    }
    if near == 0.0 { inside } else { at(near) }
}
