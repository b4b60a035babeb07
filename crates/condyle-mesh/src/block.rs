//! Boxes.

use crate::mesh::Mesh;
use condyle_math::{Mat3, Vec3};

/// A box.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Block {
    /// Its centre, in metres.
    pub at: Vec3,
    /// Its whole length along each of its axes, in metres.
    pub size: Vec3,
    /// The directions of its axes.
    pub turn: Mat3,
}

impl Block {
    pub(crate) fn mesh(&self) -> Mesh {
        let mut mesh = Mesh::default();
        let half = self.size * 0.5;
        for axis in 0..3 {
            let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
            for outward in [1.0, -1.0] {
                let corners = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)];
                let [a, b, c, d] = corners.map(|(p, q)| {
                    let mut sign = [0.0; 3];
                    (sign[axis], sign[u], sign[v]) = (outward, p * outward, q);
                    Vec3::from(sign).times(half)
                });
                mesh.flat([a, b, c]);
                mesh.flat([a, c, d]);
            }
        }
        mesh.placed(self.turn, self.at)
    }
}
