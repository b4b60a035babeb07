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

/// Twists that are asked before the deepest are refined.
const TWISTS: usize = 72;
/// The most refined, and how often the interval about each is cut to two thirds.
const PEAKS: usize = 3;
const CUTS: usize = 12;

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
    for (i, value) in values.iter_mut().enumerate() {
        *value = at(twist(i));
    }
    let value = |i: usize| values[i % TWISTS];
    let mut width = 0.0;
    let mut peaks = [(f64::NEG_INFINITY, 0usize); PEAKS];
    for i in 0..TWISTS {
        let (here, next) = (value(i), value(i + 1));
        width += match (here >= 0.0, next >= 0.0) {
            (true, true) => step,
            (true, false) => step * here / (here - next),
            (false, true) => step * next / (next - here),
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
        let (mut low, mut high) = (twist(i) - step, twist(i) + step);
        for _ in 0..CUTS {
            let [a, b] = [low + (high - low) / 3.0, high - (high - low) / 3.0];
            if at(a) < at(b) { low = a } else { high = b }
        }
        let middle = 0.5 * (low + high);
        let found = at(middle);
        if found > best.0 {
            best = (found, middle);
        }
    }
    Fibre { deepest: best.0, at: best.1, width }
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
