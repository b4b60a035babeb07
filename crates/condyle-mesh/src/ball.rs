//! Ellipsoids.

use crate::mesh::Mesh;
use condyle_math::{Mat3, Vec3};
use std::f64::consts::{PI, TAU};

/// An ellipsoid, such as the head of a thigh bone.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ball {
    /// Its centre, in metres.
    pub at: Vec3,
    /// Its semi-axes, in metres.
    pub radii: Vec3,
    /// The directions of its axes.
    pub turn: Mat3,
}

impl Ball {
    pub(crate) fn mesh(&self) -> Mesh {
        let widest = self.radii.to_array().into_iter().fold(0.0, f64::max);
        // About 7 mm from corner to corner, 12 to 40 of them around.
        let meridians = ((TAU * widest / 0.007) as usize).clamp(12, 40);
        let parallels = (0.6 * meridians as f64) as usize;
        let ring = |parallel: usize| -> Vec<Vec3> {
            let (sin, cos) = (PI * parallel as f64 / parallels as f64).sin_cos();
            let around = (0..meridians).map(|m| TAU * m as f64 / meridians as f64);
            around.map(|a| Vec3::new(sin * a.cos(), cos, -sin * a.sin())).collect()
        };
        let rings: Vec<_> = (1..parallels).map(ring).collect();
        let mut mesh = Mesh::of_rings(&rings, Vec3::Y, -Vec3::Y);
        for (p, n) in mesh.positions.iter_mut().zip(&mut mesh.normals) {
            // The gradient of the ellipsoid's equation.
            let gradient = Vec3::new(p.x / self.radii.x, p.y / self.radii.y, p.z / self.radii.z);
            *n = gradient.normalized();
            *p = p.times(self.radii);
        }
        mesh.placed(self.turn, self.at)
    }
}
