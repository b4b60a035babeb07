//! The size of a set of rotations.

use crate::limits::uniform;
use condyle_math::{Quat, Vec3};
use std::f64::consts::PI;

/// The share of all rotations that are in a set, from `count` even ones.
///
/// ```
/// use condyle_learn::limits::mobility::share;
/// use condyle_math::Quat;
/// // Turns by less than 70 degrees: (θ - sin θ)/π.
/// let most = 70f64.to_radians();
/// let found = share(&|q| q.angle_to(Quat::IDENTITY) < most, 50_000);
/// assert!((found / ((most - most.sin()) / std::f64::consts::PI) - 1.0).abs() < 5e-3);
/// ```
pub fn share(inside: &dyn Fn(Quat) -> bool, count: usize) -> f64 {
    uniform(count).filter(|q| inside(*q)).count() as f64 / count.max(1) as f64
}

/// How far a set goes about an axis, in radians.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Extent {
    /// From the middle about the child's axis, backward, to the first rotation that is outside; 0 or less.
    pub backward: f64,
    /// The same forward.
    pub forward: f64,
}

/// How far a set goes from a rotation about an axis of the child, m·exp(θ a), to the first rotation outside, to a
/// thousandth of a degree; half a turn at most.
#[must_use]
pub fn about(inside: &dyn Fn(Quat) -> bool, middle: Quat, axis: Vec3) -> Extent {
    let step = 0.5f64.to_radians();
    let at = |angle: f64| middle * Quat::from_axis_angle(axis, angle);
    let reach = |sign: f64| {
        if !inside(middle) {
            return 0.0;
        }
        let mut held = 0.0;
        while held < PI {
            let next = (held + step).min(PI);
            if !inside(at(sign * next)) {
                let (mut low, mut high) = (held, next);
                for _ in 0..12 {
                    let half = 0.5 * (low + high);
                    if inside(at(sign * half)) { low = half } else { high = half }
                }
                return low;
            }
            held = next;
        }
        PI
    };
    Extent { backward: -reach(-1.0), forward: reach(1.0) }
}

/// The smallest arc that holds a share of the twists about an axis of the child, in radians: where it starts
/// and how long it is. The twist is that of q = swing·twist, where the swing turns the axis and the twist turns about it.
#[must_use]
pub fn twists(rotations: &[Quat], axis: Vec3, share: f64) -> [f64; 2] {
    let axis = axis.normalized();
    let mut angles: Vec<f64> = rotations
        .iter()
        .map(|q| (2.0 * q.vector().dot(axis).atan2(q.w)).rem_euclid(2.0 * PI))
        .collect();
    arc(&mut angles, share)
}

/// The smallest arc that holds a share of angles in [0, 2π): its start and its length.
pub(super) fn arc(angles: &mut [f64], share: f64) -> [f64; 2] {
    angles.sort_by(f64::total_cmp);
    let count = angles.len();
    if count == 0 {
        return [0.0; 2];
    }
    let kept = ((share * count as f64).ceil() as usize).clamp(1, count);
    let mut best = [0.0, f64::INFINITY];
    for start in 0..count {
        let end = start + kept - 1;
        let around = if end >= count { 2.0 * PI } else { 0.0 };
        let length = angles[end % count] + around - angles[start];
        if length < best[1] {
            best = [angles[start], length];
        }
    }
    if best[0] > PI {
        best[0] -= 2.0 * PI;
    }
    best
}

/// The largest angle between any two of some rotations, in radians, of at most 3000 of them.
#[must_use]
pub fn largest_angle(rotations: &[Quat]) -> f64 {
    let step = rotations.len().div_ceil(3000).max(1);
    let some: Vec<Quat> = rotations.iter().copied().step_by(step).collect();
    let mut least: f64 = 1.0;
    for (index, q) in some.iter().enumerate() {
        for p in some.iter().skip(index + 1) {
            least = least.min(q.dot(*p).abs());
        }
    }
    2.0 * least.clamp(0.0, 1.0).acos()
}

/// The deepest of some rotations by a distance that is positive inside, moved on uphill.
#[must_use]
pub fn middle(distance: &dyn Fn(Quat) -> f64, among: &[Quat]) -> Option<Quat> {
    let deep = |q: &Quat| distance(*q);
    let mut best = among.iter().copied().max_by(|a, b| deep(a).total_cmp(&deep(b)))?;
    climb(&mut best, &deep);
    Some(best)
}

/// Moves a rotation to where a function is largest near it.
pub(super) fn climb(at: &mut Quat, value: &dyn Fn(&Quat) -> f64) {
    let mut here = value(at);
    let mut step = 0.1;
    while step > 1e-3 {
        let mut moved = false;
        for axis in [Vec3::X, Vec3::Y, Vec3::Z, -Vec3::X, -Vec3::Y, -Vec3::Z] {
            let next = (*at * Quat::exp(axis * step)).normalized();
            let there = value(&next);
            if there > here {
                (*at, here, moved) = (next, there, true);
            }
        }
        if !moved {
            step *= 0.5;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_range_about_one_axis_is_found() {
        // Turns about y from -20 to 50 degrees, with 10 degrees of swing.
        let inside = |q: Quat| {
            let twist = 2.0 * q.y.atan2(q.w);
            let swing = (q * Quat::from_axis_angle(Vec3::Y, -twist)).angle_to(Quat::IDENTITY);
            (-20f64.to_radians()..=50f64.to_radians()).contains(&twist)
                && swing < 10f64.to_radians()
        };
        let extent = about(&inside, Quat::IDENTITY, Vec3::Y);
        assert!((extent.backward.to_degrees() + 20.0).abs() < 1e-3, "{extent:?}");
        assert!((extent.forward.to_degrees() - 50.0).abs() < 1e-3, "{extent:?}");
        let across = about(&inside, Quat::IDENTITY, Vec3::X);
        assert!((across.forward.to_degrees() - 10.0).abs() < 1e-3, "{across:?}");
    }

    #[test]
    fn arcs_go_across_the_half_turn() {
        let mut angles: Vec<f64> =
            (0..100).map(|i| (170.0 + 0.2 * f64::from(i)).to_radians()).collect();
        let [start, length] = arc(&mut angles, 1.0);
        assert!(
            (start.to_degrees() - 170.0).abs() < 1e-9 && (length.to_degrees() - 19.8).abs() < 1e-9
        );
        let mut across: Vec<f64> = (0..100)
            .map(|i| (-10.0 + 0.2 * f64::from(i)).to_radians().rem_euclid(2.0 * PI))
            .collect();
        let [start, length] = arc(&mut across, 1.0);
        assert!((start.to_degrees() + 10.0).abs() < 1e-9, "{start}");
        assert!((length.to_degrees() - 19.8).abs() < 1e-9);
    }

    #[test]
    fn the_largest_angle_of_turns_about_an_axis_is_their_span() {
        let turns: Vec<Quat> =
            (0..50).map(|i| Quat::from_axis_angle(Vec3::Z, 0.03 * f64::from(i))).collect();
        assert!((largest_angle(&turns) - 0.03 * 49.0).abs() < 1e-9);
    }
}
