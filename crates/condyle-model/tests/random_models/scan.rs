//! Rotation of a point onto an ellipsoid by a scan over all angles.

use condyle_math::{Affine, Quat, Vec3};
use std::f64::consts::{PI, TAU};

/// The angle that [`turn`] found, and whether rounding could have changed the choice.
pub(crate) struct Found {
    pub(crate) angle: f64,
    pub(crate) doubtful: bool,
}

/// Turns `point` about `axis` (through the origin of `pose`) onto the ellipsoid, by the angle nearest
/// to 0, or by the one that brings |(p/radii)²| nearest to 1.
pub(crate) fn turn(pose: Affine, radii: Vec3, axis: Vec3, point: Vec3) -> Found {
    let place = |angle: f64| pose * (Quat::from_axis_angle(axis, angle).to_mat3() * point);
    let scaled = |p: Vec3| Vec3::new(p.x / radii.x, p.y / radii.y, p.z / radii.z);
    let f = |angle: f64| scaled(place(angle)).norm_squared() - 1.0;
    let world_axis = pose.linear * axis;
    let slope = |angle: f64| {
        let p = place(angle);
        let velocity = world_axis.cross(p - pose.translation);
        2.0 * scaled(p).dot(scaled(velocity))
    };
    const STEPS: usize = 2000;
    let at = |i: usize| -PI + TAU * i as f64 / STEPS as f64;
    let crossings = |g: &dyn Fn(f64) -> f64| -> Vec<f64> {
        let values: Vec<f64> = (0..=STEPS).map(|i| g(at(i))).collect();
        (0..STEPS)
            .filter(|&i| (values[i] < 0.0) != (values[i + 1] < 0.0))
            .map(|i| {
                let (mut low, mut high) = (at(i), at(i + 1));
                let below = values[i] < 0.0;
                for _ in 0..60 {
                    let middle = 0.5 * (low + high);
                    if (g(middle) < 0.0) == below { low = middle } else { high = middle }
                }
                0.5 * (low + high)
            })
            .collect()
    };
    let rank = |mut list: Vec<f64>, worth: &dyn Fn(f64) -> f64| -> (f64, f64) {
        list.sort_by(|a, b| worth(*a).total_cmp(&worth(*b)));
        let next = list.get(1).map_or(f64::INFINITY, |x| worth(*x) - worth(list[0]));
        (list[0], next)
    };
    let extrema = crossings(&slope);
    let size = extrema.iter().map(|&x| f(x).abs()).fold(0.0, f64::max);
    let near = extrema.iter().map(|&x| f(x).abs()).fold(f64::INFINITY, f64::min);
    let roots = crossings(&f);
    if extrema.is_empty() {
        return Found { angle: 0.0, doubtful: true };
    }
    // A root near a tangency, or a choice between equally near ones, cannot be compared to 12
    // digits.
    let touching = near < 1e-3 * size;
    if roots.is_empty() {
        let (angle, next) = rank(extrema, &|x| f(x).abs());
        let h = 1e-5;
        let bend = (slope(angle + h) - slope(angle - h)) / (2.0 * h);
        return Found { angle, doubtful: touching || next < 1e-6 || bend.abs() < 0.1 };
    }
    let (angle, next) = rank(roots, &|x| x.abs());
    Found { angle, doubtful: touching || next < 1e-6 || slope(angle).abs() < 0.1 }
}
