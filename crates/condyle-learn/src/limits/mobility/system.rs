//! A set of rotations in the angles of a joint coordinate system.

use super::extent::arc;
use condyle_math::{EulerOrder, Quat, Vec3};
use std::f64::consts::PI;

/// What a set of rotations is in three angles.
#[derive(Clone, Debug, PartialEq)]
pub struct InSystem {
    /// The share of all rotations, integrated over the angles with the density of Haar's measure.
    pub share: f64,
    /// The share of the box of all angles, as if all boxes of equal edges held equally many rotations.
    pub share_of_angles: f64,
    /// Of each angle the smallest arc that holds 99 % of the set: where it starts and where it ends, radians.
    pub ranges: [[f64; 2]; 3],
}

/// Integrates a set over three angles with `steps` of the first and the last, half as many of the second.
///
/// Two equal axes: dV = sin β dα dβ dγ / 8π² with β from 0 to π; three different ones: cos β with β within a right
/// angle.
///
/// ```
/// use condyle_learn::limits::mobility::in_system;
/// use condyle_math::{EulerOrder, Quat};
/// // Turns by less than 70 degrees: (θ - sin θ)/π of all, in any angles.
/// let most = 70f64.to_radians();
/// let inside = |q: Quat| q.angle_to(Quat::IDENTITY) < most;
/// let expected = (most - most.sin()) / std::f64::consts::PI;
/// for order in ["yxy", "zxy", "xyz"] {
///     let found = in_system(&inside, order.parse::<EulerOrder>().unwrap(), 180);
///     assert!((found.share / expected - 1.0).abs() < 0.01, "{found:?}");
/// }
/// ```
#[must_use]
pub fn in_system(inside: &dyn Fn(Quat) -> bool, order: EulerOrder, steps: usize) -> InSystem {
    let [first, second, third] = order.axes();
    let proper = first == third;
    let axis = |index: usize| [Vec3::X, Vec3::Y, Vec3::Z][index % 3];
    let turns = |index: usize| -> Vec<(f64, Quat)> {
        let angle = |i: usize| -PI + 2.0 * PI * (i as f64 + 0.5) / steps as f64;
        (0..steps).map(|i| (angle(i), Quat::from_axis_angle(axis(index), angle(i)))).collect()
    };
    let (outer, inner) = (turns(first), turns(third));
    let rows = (steps / 2).max(1);
    let from = if proper { 0.0 } else { -0.5 * PI };
    let (mut share, mut boxes) = (0.0, 0usize);
    let mut weights = [vec![0.0; steps], vec![0.0; rows], vec![0.0; steps]];
    for row in 0..rows {
        let low = from + PI * row as f64 / rows as f64;
        let high = from + PI * (row as f64 + 1.0) / rows as f64;
        // The integral of the density over the row.
        let mass = if proper { low.cos() - high.cos() } else { high.sin() - low.sin() };
        let mass = mass / (2.0 * (steps * steps) as f64);
        let middle = Quat::from_axis_angle(axis(second), 0.5 * (low + high));
        for (i, (_, a)) in outer.iter().enumerate() {
            let left = *a * middle;
            for (k, (_, c)) in inner.iter().enumerate() {
                if inside(left * *c) {
                    share += mass;
                    boxes += 1;
                    weights[0][i] += mass;
                    weights[1][row] += mass;
                    weights[2][k] += mass;
                }
            }
        }
    }
    let [alpha, beta, gamma] = &weights;
    let cell = PI / rows as f64;
    let around = |weights: &[f64]| {
        let mut angles = repeated(weights, |i| 2.0 * PI * (i as f64 + 0.5) / steps as f64);
        let half = PI / steps as f64;
        let [start, length] = arc(&mut angles, 0.99);
        let start = if start - PI - half < -PI - 1e-9 { start + PI } else { start - PI };
        [start - half, start + length + half]
    };
    let mut rows_of = repeated(beta, |i| from + cell * (i as f64 + 0.5));
    rows_of.sort_by(f64::total_cmp);
    // The second angle has ends: half a percent is left out at either.
    let at = |part: f64| {
        let last = rows_of.len().saturating_sub(1);
        rows_of.get((part * last as f64).round() as usize).copied().unwrap_or(0.0)
    };
    InSystem {
        share,
        share_of_angles: boxes as f64 / (steps * steps * rows) as f64,
        ranges: [around(alpha), [at(0.005) - 0.5 * cell, at(0.995) + 0.5 * cell], around(gamma)],
    }
}

/// Each angle as often as its weight asks for, of a few thousand altogether.
fn repeated(weights: &[f64], angle: impl Fn(usize) -> f64) -> Vec<f64> {
    let sum: f64 = weights.iter().sum();
    if sum <= 0.0 {
        return vec![];
    }
    let times = |weight: f64| (weight / sum * 4000.0).round() as usize;
    let parts = weights.iter().enumerate();
    parts.flat_map(|(i, w)| std::iter::repeat_n(angle(i), times(*w))).collect()
}
