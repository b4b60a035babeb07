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

const MERIDIANS: usize = 16;
const PARALLELS: usize = 10;

impl Ball {
    pub(crate) fn mesh(&self) -> Mesh {
        let ring = |parallel: usize| -> Vec<Vec3> {
            let (sin, cos) = (PI * parallel as f64 / PARALLELS as f64).sin_cos();
            let meridians = (0..MERIDIANS).map(|m| TAU * m as f64 / MERIDIANS as f64);
            meridians.map(|a| Vec3::new(sin * a.cos(), cos, -sin * a.sin())).collect()
        };
        let rings: Vec<_> = (1..PARALLELS).map(ring).collect();
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
