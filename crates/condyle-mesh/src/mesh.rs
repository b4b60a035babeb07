//! Triangles with a normal at every corner.

use condyle_math::{Mat3, Vec3};

/// A closed surface: metres, in the frame of what it belongs to.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Mesh {
    /// Corners.
    pub positions: Vec<Vec3>,
    /// One unit vector for each corner, outward.
    pub normals: Vec<Vec3>,
    /// Three corners each, counter-clockwise from outside.
    pub triangles: Vec<[u32; 3]>,
}

impl Mesh {
    /// The enclosed volume in cubic metres, by the divergence theorem: Σ a·(b × c) / 6.
    ///
    /// ```
    /// use condyle_math::{Mat3, Vec3};
    /// use condyle_mesh::{Block, Form};
    /// let brick = Block { at: Vec3::ZERO, size: Vec3::new(0.2, 0.3, 0.5), turn: Mat3::IDENTITY };
    /// assert!((Form::Block(brick).mesh().volume() - 0.03).abs() < 1e-12);
    /// ```
    #[must_use]
    pub fn volume(&self) -> f64 {
        let corner = |i: u32| self.positions[i as usize];
        let parts = self.triangles.iter().map(|t| {
            let [a, b, c] = t.map(corner);
            a.dot(b.cross(c)) / 6.0
        });
        parts.sum()
    }

    /// A grid of rings, each of `around` corners, joined to tubes; the first and the last ring close on a point.
    pub(crate) fn of_rings(rings: &[Vec<Vec3>], first: Vec3, last: Vec3) -> Self {
        let around = rings.first().map_or(0, Vec::len) as u32;
        let mut mesh = Self { positions: vec![first], ..Self::default() };
        for ring in rings {
            mesh.positions.extend(ring);
        }
        let end = mesh.positions.len() as u32;
        mesh.positions.push(last);
        let corner = |ring: u32, i: u32| 1 + ring * around + i % around;
        for i in 0..around {
            mesh.triangles.push([0, corner(0, i), corner(0, i + 1)]);
            for ring in 1..rings.len() as u32 {
                let (a, b) = (corner(ring - 1, i), corner(ring - 1, i + 1));
                let (c, d) = (corner(ring, i), corner(ring, i + 1));
                mesh.triangles.push([a, c, d]);
                mesh.triangles.push([a, d, b]);
            }
            let ring = rings.len() as u32 - 1;
            mesh.triangles.push([corner(ring, i), end, corner(ring, i + 1)]);
        }
        mesh.faced()
    }

    /// A surface of these triangles with smooth normals: at each corner the mean of its triangles' normals, weighted by their
    /// areas. Triangles of corners that are not there are left out.
    ///
    /// ```
    /// use condyle_math::Vec3;
    /// use condyle_mesh::Mesh;
    /// let mesh = Mesh::of(vec![Vec3::ZERO, Vec3::X, Vec3::Y], vec![[0, 1, 2], [0, 1, 3]]);
    /// assert_eq!((mesh.normals[2], mesh.triangles.len()), (Vec3::Z, 1));
    /// ```
    #[must_use]
    pub fn of(positions: Vec<Vec3>, mut triangles: Vec<[u32; 3]>) -> Self {
        triangles.retain(|triangle| triangle.iter().all(|i| (*i as usize) < positions.len()));
        Self { positions, normals: vec![], triangles }.smooth()
    }

    /// The same surface facing outward, with smooth normals: at each corner the mean of its triangles' normals,
    /// weighted by their areas.
    pub(crate) fn faced(mut self) -> Self {
        if self.volume() < 0.0 {
            for triangle in &mut self.triangles {
                triangle.swap(1, 2);
            }
        }
        self.smooth()
    }

    fn smooth(mut self) -> Self {
        self.normals = vec![Vec3::ZERO; self.positions.len()];
        for triangle in &self.triangles {
            let [a, b, c] = triangle.map(|i| self.positions[i as usize]);
            let area = (b - a).cross(c - a);
            for &i in triangle {
                self.normals[i as usize] += area;
            }
        }
        for normal in &mut self.normals {
            *normal = unit(*normal).unwrap_or(Vec3::Y);
        }
        self
    }

    /// Adds a triangle with the normal of its plane at every corner; nothing if it has no area.
    pub(crate) fn flat(&mut self, corners: [Vec3; 3]) {
        let [a, b, c] = corners;
        let Some(normal) = unit((b - a).cross(c - a)) else { return };
        let first = self.positions.len() as u32;
        self.positions.extend(corners);
        self.normals.extend([normal; 3]);
        self.triangles.push([first, first + 1, first + 2]);
    }

    /// Turned, then moved.
    pub(crate) fn placed(mut self, turn: Mat3, at: Vec3) -> Self {
        for p in &mut self.positions {
            *p = turn * *p + at;
        }
        for n in &mut self.normals {
            *n = turn * *n;
        }
        self
    }
}

/// The direction of a vector, unless it has none.
pub(crate) fn unit(v: Vec3) -> Option<Vec3> {
    let length = v.norm();
    (length > 1e-12 && length.is_finite()).then(|| v * length.recip())
}

/// A direction at a right angle to a unit vector: of the axes that are most so, the first.
pub(crate) fn beside(axis: Vec3) -> Vec3 {
    let size = axis.to_array().map(f64::abs);
    let least = (0..3).min_by(|&i, &j| size[i].total_cmp(&size[j])).unwrap_or(0);
    unit(axis.cross([Vec3::X, Vec3::Y, Vec3::Z][least])).unwrap_or(Vec3::X)
}
