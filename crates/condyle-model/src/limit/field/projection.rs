//! The nearest rotation at which a spline is not negative.
//!
//! From a place on the boundary that is near the answer, each step goes at once to where the slope expects the boundary and
//! along it towards the rotation that is asked for. How far along depends on how the boundary is curved, which is told by what the
//! step before did (Barzilai & Borwein); two or three steps are enough. The answer is inside by the same arithmetic
//! that judges it, so projecting it again returns it as it is.
//!
//! Where that does not settle, steps along the slope, each kept only if it comes nearer; where the slope is of
//! no use, at ridges of the distance, the way to the nearest sample is halved until it crosses the boundary.

use super::lattice::Lattice;
use condyle_math::{Quat, Vec3};

/// How far inside steps aim, in radians: far above rounding, far below what matters.
const AIM: f64 = 1e-5;
/// What is inside by less than this may be outside once it was taken to other axes and back.
const SURE: f64 = 1e-9;
/// What is nearer to the boundary than this, in radians, has landed.
const LANDED: f64 = 6e-5;
/// Steps along the boundary that are shorter than this, in radians, are left out.
const SETTLED: f64 = 1e-3;

/// A smooth function on rotations of the map, given with the sign that [`super::chart::signed`] gives.
pub(super) trait Surface {
    /// Its value, positive inside.
    fn value(&self, q: Quat) -> f64;
    /// The value with its slope by the components of the quaternion.
    fn value_and_slope(&self, q: Quat) -> (f64, [f64; 4]);
}

/// A spline by its lattice and its coefficients.
pub(super) struct Spline<'a>(pub(super) &'a Lattice, pub(super) &'a [f32]);

impl Surface for Spline<'_> {
    #[inline]
    fn value(&self, q: Quat) -> f64 {
        self.0.value(self.1, q)
    }

    #[inline]
    fn value_and_slope(&self, q: Quat) -> (f64, [f64; 4]) {
        self.0.value_and_slope(self.1, q)
    }
}

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
fn landed(surface: &impl Surface, mut q: Quat, steps: usize) -> Option<(Quat, Vec3)> {
    for _ in 0..steps {
        let (distance, g) = surface.value_and_slope(q);
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

/// The nearest rotation inside to `from` that is outside, from a place near it on the boundary; `None` if steps do not
/// settle, or lead away.
#[inline]
fn approach(surface: &impl Surface, from: Quat, start: Quat) -> Option<Quat> {
    let mut at = start;
    // Moving by δ along a boundary of curvature κ turns what is left of the way along it by (1 + κ·distance) δ; most
    // boundaries are convex, with κ of about 1.
    let mut part = 1.0 / (1.0 + towards(at, from).norm());
    let mut before: Option<(Vec3, Vec3)> = None;
    for _ in 0..9 {
        let (distance, g) = surface.value_and_slope(at);
        let slope = tangent(at, g);
        let square = slope.norm_squared();
        if square < 0.04 {
            return None;
        }
        let to = towards(at, from);
        let along = to - slope * (to.dot(slope) / square);
        if let Some((moved, was)) = before {
            let change = (was - along).dot(moved);
            let ratio = moved.norm_squared() / change.max(1e-12);
            part = ratio.clamp(0.05, 3.0);
        }
        let mut step = along * part;
        let length = step.norm();
        if length < SETTLED && (SURE..LANDED).contains(&distance) {
            let nearer = from.dot(at).abs() > from.dot(start).abs() - 1e-4;
            return nearer.then_some(at);
        }
        if length > 0.06 {
            step = step * (0.06 / length);
        }
        // Less than this is not worth a turn, and would undo the landing.
        before = (length > 0.2 * SETTLED).then_some((step, along));
        let off = ((AIM - distance) / square).clamp(-0.2, 0.2);
        at = turned(at, slope * off + step);
    }
    None
}

/// The nearest rotation inside, of `from` that is outside, and whether it is inside by more than what rounding moves.
/// `starts` are places near the boundary; `anchor` gives a rotation inside.
#[inline]
pub(super) fn project(
    surface: &impl Surface,
    from: Quat,
    starts: impl IntoIterator<Item = Option<Quat>>,
    anchor: impl FnOnce() -> Option<Quat>,
) -> Option<(Quat, bool)> {
    let mut best: Option<(Quat, bool)> = None;
    for start in starts.into_iter().flatten() {
        let found = match approach(surface, from, start) {
            Some(found) => Some((found, true)),
            None => {
                landed(surface, start, 12).map(|landed| (descended(surface, from, landed), false))
            }
        };
        let nearer = |p: Quat| best.is_none_or(|(q, _)| from.dot(p).abs() > from.dot(q).abs());
        best = found.filter(|(p, _)| nearer(*p)).or(best);
    }
    if best.is_some() {
        return best;
    }
    let landed = match landed(surface, from, 12) {
        Some(found) => found,
        None => {
            let found = crossing(surface, from, anchor()?);
            (found, tangent(found, surface.value_and_slope(found).1))
        }
    };
    Some((descended(surface, from, landed), false))
}

/// From a rotation on the boundary and the slope there, along the boundary while that comes nearer to `from`.
#[cold]
fn descended(surface: &impl Surface, from: Quat, landed_at: (Quat, Vec3)) -> Quat {
    let (mut at, mut slope) = landed_at;
    let mut nearness = from.dot(at).abs();
    let mut share = 1.0;
    for _ in 0..40 {
        let to = towards(at, from);
        let along = to - slope * (to.dot(slope) / slope.norm_squared().max(1e-12));
        // Half a thousandth of the way: what is left to gain is a ten-millionth of it.
        if along.norm_squared() < 2.5e-7 * to.norm_squared().max(1e-6) || share < 0.002 {
            break;
        }
        let next = landed(surface, turned(at, along * share), 3);
        match next.filter(|(q, _)| from.dot(*q).abs() > nearness) {
            Some((q, g)) => {
                (at, slope) = (q, g);
                nearness = from.dot(q).abs();
            }
            None => share *= 0.4,
        }
    }
    at
}

/// The last rotation inside on the way from `inside` to `outside`.
fn crossing(surface: &impl Surface, outside: Quat, inside: Quat) -> Quat {
    let way = (inside.conjugate() * outside).log();
    let (mut near, mut far) = (0.0, 1.0);
    let at = |part: f64| super::chart::signed((inside * Quat::exp(way * part)).normalized());
    // To 2⁻³⁰ of at most half a turn.
    for _ in 0..30 {
        let middle = 0.5 * (near + far);
        if surface.value(at(middle)) >= 0.0 { near = middle } else { far = middle }
    }
    if near == 0.0 { inside } else { at(near) }
}
