//! A learned limit of a shape with invented numbers, and rotations to ask it about.

use crate::random::Random;
use condyle_learn::limits::{Cloud, Field, Settings, learn};
use condyle_math::{Quat, Vec3};

/// Uniform over all rotations.
pub fn rotation(random: &mut Random) -> Quat {
    Quat::from([(); 4].map(|()| random.normal())).normalized()
}

/// Rotations within an ellipsoid of 85, 60 and 45 degrees about the child's axes, outside a ball of 25 degrees in it.
///
/// # Panics
/// Never: there are rotations.
pub fn cloud(count: usize) -> Cloud {
    let mut random = Random::new(3);
    let hole = Quat::exp(Vec3::new(0.3, 0.1, -0.1));
    let mut samples = vec![];
    while samples.len() < count {
        let q = rotation(&mut random);
        let v = q.log();
        let part = Vec3::new(v.x / 85.0, v.y / 60.0, v.z / 45.0) * 1f64.to_degrees();
        if part.norm() < 1.0 && q.angle_to(hole) > 25f64.to_radians() {
            samples.push(q);
        }
    }
    Cloud::gather(&[&samples], 0.0).expect("there are rotations")
}

/// The limit of a cloud, at so many nodes along an edge.
///
/// # Panics
/// For fewer than 24 or more than 256 nodes.
pub fn field(cloud: &Cloud, nodes: usize) -> Field {
    learn(cloud, &Settings { nodes, ..Settings::default() }).expect("settings that make sense")
}

/// Frames of a motion that goes in and out of the limit.
pub fn motion(frames: usize) -> Vec<Quat> {
    (0..frames)
        .map(|i| i as f64 * 0.05)
        .map(|t| Quat::exp(Vec3::new(t.sin(), (1.3 * t).cos(), (0.7 * t).sin()) * 1.2))
        .collect()
}

/// The bound of a value of a cubic spline: 64 numbers of a grid, each times a weight.
pub struct BareSpline {
    grid: Vec<f32>,
    weights: [f64; 4],
}

impl BareSpline {
    /// Over a grid of 96 numbers along an edge.
    #[expect(clippy::new_without_default, reason = "it is large")]
    pub fn new() -> Self {
        Self { grid: (0..96 * 96 * 96).map(|i| i as f32).collect(), weights: [0.1, 0.4, 0.4, 0.1] }
    }

    /// One sum, at a place that follows from a number.
    pub fn run(&self, number: usize) -> f64 {
        let first = (number.wrapping_mul(2_654_435_761) >> 7) % (92 * 96 * 96);
        let mut sum = 0.0;
        for (k, w) in self.weights.iter().enumerate() {
            for (j, v) in self.weights.iter().enumerate() {
                let start = first + k * 96 * 96 + j * 96;
                for (value, u) in self.grid.iter().skip(start).zip(&self.weights) {
                    sum += w * v * u * f64::from(*value);
                }
            }
        }
        sum
    }
}
