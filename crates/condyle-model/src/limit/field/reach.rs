//! Whether a bone can point in a direction, and how far it can then twist.
//!
//! All rotations that bring a bone to a direction v are R(τ) = S·R(bone, τ), with S the shortest swing from the bone to v: a circle.
//! The greatest distance on it is positive where some twist is valid, and its zero is the boundary of the directions that are
//! reached.

use condyle_math::{Quat, Vec3};
use std::f64::consts::{PI, TAU};

/// The twists of a bone in one direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fibre {
    /// The greatest signed distance of any twist, in radians; not positive where the direction cannot be reached.
    pub deepest: f64,
    /// That twist in radians, from the shortest swing.
    pub at: f64,
    /// How much of the turn about the bone is valid, in radians, 2π where all is.
    pub width: f64,
}

/// Twists at which the distance is known; every other one is asked only where it may matter, by how much a distance may rise per
/// radian.
const TWISTS: usize = 72;
const STEEPEST: f64 = 1.5;
/// The most peaks that are refined, to this part of a radian, in so many steps.
const PEAKS: usize = 4;
const NEAR: f64 = 2e-4;
const STEPS: usize = 24;
/// Steps to where the distance is zero between two twists.
const CUTS: usize = 3;

/// The twists that a signed distance (positive inside) allows a bone along `bone` that points to `direction`; both of length 1.
///
/// ```
/// use condyle_math::{Quat, Vec3};
/// use condyle_model::limit::field::fibre;
/// // Turns by less than 60 degrees: cos(θ/2) = cos(s/2)·cos(τ/2) of a swing s and a twist τ.
/// let most = 60f64.to_radians();
/// let distance = |q: Quat| most - q.angle_to(Quat::IDENTITY);
/// let swing = 40f64.to_radians();
/// let found = fibre(&distance, Vec3::X, Vec3::new(swing.cos(), swing.sin(), 0.0));
/// assert!((found.deepest - 20f64.to_radians()).abs() < 1e-6);
/// let width = 4.0 * ((most / 2.0).cos() / (swing / 2.0).cos()).acos();
/// assert!((found.width - width).abs() < 2e-3);
/// ```
#[must_use]
pub fn fibre(distance: &dyn Fn(Quat) -> f64, bone: Vec3, direction: Vec3) -> Fibre {
    let swing = shortest(bone, direction);
    let at = |twist: f64| distance(swing * Quat::from_axis_angle(bone, twist));
    let step = TAU / TWISTS as f64;
    let twist = |i: usize| step * i as f64 - PI;
    let mut values = [0.0; TWISTS];
    let mut best = f64::NEG_INFINITY;
    for i in (0..TWISTS).step_by(2) {
        values[i] = at(twist(i));
        best = best.max(values[i]);
    }
    for i in (1..TWISTS).step_by(2) {
        let (before, after) = (values[i - 1], values[(i + 1) % TWISTS]);
        let [low, high] = [before.min(after), before.max(after)];
        let (least, most) = (low - STEEPEST * step, high + STEEPEST * step);
        let matters = most >= best || (least < 0.0 && most >= 0.0);
        values[i] = if matters { at(twist(i)) } else { 0.5 * (low + high) };
        best = best.max(values[i]);
    }
    let value = |i: usize| values[i % TWISTS];
    let mut width = 0.0;
    let mut peaks = [(f64::NEG_INFINITY, 0usize); PEAKS];
    for i in 0..TWISTS {
        let (here, next) = (value(i), value(i + 1));
        width += match (here >= 0.0, next >= 0.0) {
            (true, true) => step,
            (true, false) => step * crossing(&at, twist(i), step, [here, next]),
            (false, true) => step * crossing(&at, twist(i) + step, -step, [next, here]),
            (false, false) => 0.0,
        };
        if here >= next && here >= value(i + TWISTS - 1) && here > peaks[PEAKS - 1].0 {
            peaks[PEAKS - 1] = (here, i);
            peaks.sort_by(|a, b| b.0.total_cmp(&a.0));
        }
    }
    let mut best = (peaks[0].0, twist(peaks[0].1));
    for (height, i) in peaks {
        // A distance rises by no more than the angle.
        if height < best.0 - step {
            continue;
        }
        let found = highest(&at, twist(i), height, step);
        if found.0 > best.0 {
            best = found;
        }
    }
    Fibre { deepest: best.0, at: best.1, width }
}

/// The share of a step from a twist that is valid to one that is not at which the distance is zero.
fn crossing(at: &dyn Fn(f64) -> f64, start: f64, step: f64, [here, next]: [f64; 2]) -> f64 {
    let ((mut low, mut from), (mut high, mut to)) = ((0.0, here), (1.0, next));
    let mut share = from / (from - to);
    for _ in 0..CUTS {
        let found = at(start + step * share);
        if found >= 0.0 {
            (low, from, to) = (share, found, 0.5 * to);
        } else {
            (high, to, from) = (share, found, 0.5 * from);
        }
        share = low + (high - low) * from / (from - to);
    }
    share
}

/// The greatest distance within a step of a twist, and where, by parabolas and the golden section (Brent 1973).
fn highest(at: &dyn Fn(f64) -> f64, twist: f64, height: f64, step: f64) -> (f64, f64) {
    const GOLDEN: f64 = 0.381_966_011_250_105;
    let (mut low, mut high) = (twist - step, twist + step);
    let [mut x, mut w, mut v] = [(twist, height); 3];
    let (mut before, mut move_by) = (0.0f64, 0.0f64);
    for _ in 0..STEPS {
        let middle = 0.5 * (low + high);
        if (x.0 - middle).abs() <= 2.0 * NEAR - 0.5 * (high - low) {
            break;
        }
        let mut parabola = None;
        if before.abs() > NEAR {
            let r = (x.0 - w.0) * (v.1 - x.1);
            let q = (x.0 - v.0) * (w.1 - x.1);
            let p = (x.0 - v.0) * q - (x.0 - w.0) * r;
            let q = 2.0 * (q - r);
            let by = -p / q;
            let within = x.0 + by > low && x.0 + by < high;
            if within && by.abs() < 0.5 * before.abs() {
                let close = x.0 + by - low < 2.0 * NEAR || high - x.0 - by < 2.0 * NEAR;
                parabola = Some(if close { NEAR.copysign(middle - x.0) } else { by });
            }
        }
        (before, move_by) = match parabola {
            Some(by) => (move_by, by),
            None => {
                let rest = if x.0 >= middle { low - x.0 } else { high - x.0 };
                (rest, GOLDEN * rest)
            }
        };
        let by = if move_by.abs() >= NEAR { move_by } else { NEAR.copysign(move_by) };
        let there = (x.0 + by, at(x.0 + by));
        if there.1 >= x.1 {
            if by >= 0.0 {
                low = x.0
            } else {
                high = x.0
            }
            (v, w, x) = (w, x, there);
        } else {
            if by < 0.0 {
                low = there.0
            } else {
                high = there.0
            }
            if there.1 >= w.1 || w.0 == x.0 {
                (v, w) = (w, there);
            } else if there.1 >= v.1 || v.0 == x.0 || v.0 == w.0 {
                v = there;
            }
        }
    }
    (x.1, x.0)
}

/// The shortest swing from one direction to another; of opposite ones any.
fn shortest(from: Vec3, to: Vec3) -> Quat {
    let across = from.cross(to);
    let axis = if across.norm() > 1e-9 {
        across.normalized()
    } else {
        let sizes = from.to_array().map(f64::abs);
        let least = (0..3).min_by(|&i, &j| sizes[i].total_cmp(&sizes[j])).unwrap_or(0);
        from.cross(Vec3::UNITS[least]).normalized()
    };
    Quat::from_axis_angle(axis, across.norm().atan2(from.dot(to)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_twists_or_none() {
        let most = 30f64.to_radians();
        let swing = |q: Quat| 2.0 * q.y.hypot(q.z).atan2(q.x.hypot(q.w));
        let distance = |q: Quat| most - swing(q);
        for (angle, expected) in [(0.0, TAU), (0.5, TAU), (0.6, 0.0), (PI, 0.0)] {
            let direction = Vec3::new(f64::cos(angle), 0.0, f64::sin(angle));
            let found = fibre(&distance, Vec3::X, direction);
            assert!((found.width - expected).abs() < 1e-12);
            assert!((found.deepest - (most - angle)).abs() < 1e-9, "{angle}");
        }
    }
}
