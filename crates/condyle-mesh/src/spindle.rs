//! Bones of which only the ends are known.

use crate::mesh::{Mesh, beside, unit};
use condyle_math::Vec3;

/// A long octahedron from one point to another, thickest near the first: widest at 15 % of its length, a tenth of
/// it wide, 4 to 30 mm.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spindle {
    /// The thick end, in metres.
    pub from: Vec3,
    /// The thin end.
    pub to: Vec3,
}

impl Spindle {
    pub(crate) fn mesh(&self) -> Mesh {
        let mut mesh = Mesh::default();
        let along = self.to - self.from;
        let length = along.norm();
        let Some(axis) = unit(along).filter(|_| length >= 1e-4) else { return mesh };
        let side = beside(axis);
        let front = axis.cross(side);
        let half = (0.1 * length).clamp(0.004, 0.03).min(0.4 * length) / 2.0;
        let waist = self.from + axis * (0.15 * length);
        let ring = [(side, half), (front, half), (side, -half), (front, -half)]
            .map(|(direction, distance)| waist + direction * distance);
        for i in 0..4 {
            let (a, b) = (ring[i], ring[(i + 1) % 4]);
            mesh.flat([a, b, self.to]);
            mesh.flat([b, a, self.from]);
        }
        mesh
    }
}
