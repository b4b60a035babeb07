//! The surface on which a function of a place is zero.

use crate::Mesh;
use crate::mesh::unit;
use condyle_math::Vec3;
use std::collections::HashMap;

/// The six tetrahedra of a cell, by its corners: those from corner 0 to corner 7 along the edges of the cell, so that neighbouring
/// cells cut their common face alike. Corner c is at (c & 1, c >> 1 & 1, c >> 2).
const TETRAHEDRA: [[usize; 4]; 6] =
    [[0, 1, 3, 7], [0, 3, 2, 7], [0, 2, 6, 7], [0, 6, 4, 7], [0, 4, 5, 7], [0, 5, 1, 7]];
/// A corner of the surface is no nearer to a corner of the grid than this share of an edge, so that no triangle is without area.
const APART: f64 = 1e-3;
/// So many times a corner is brought nearer to the zero on its edge.
const STEPS: usize = 5;

impl Mesh {
    /// The boundary of where `value` is positive in the cube from -`half` to `half` along each axis, of so many cells
    /// along each: closed and facing outward, by marching tetrahedra (Doi & Koide 1991).
    ///
    /// `value` has to be negative on the faces of the cube; where it is not, it is taken to be.
    ///
    /// ```
    /// use condyle_math::Vec3;
    /// use condyle_mesh::Mesh;
    /// let ball = Mesh::of_level(&|p: Vec3| 0.5 - p.norm(), 1.0, 32);
    /// let volume = 4.0 / 3.0 * std::f64::consts::PI * 0.125;
    /// assert!((ball.volume() / volume - 1.0).abs() < 0.02);
    /// assert!(ball.positions.iter().all(|p| (p.norm() - 0.5).abs() < 0.01));
    /// ```
    #[must_use]
    pub fn of_level(value: &dyn Fn(Vec3) -> f64, half: f64, cells: usize) -> Self {
        let side = cells + 1;
        let at = |index: usize| {
            let [i, j, k] = [index % side, index / side % side, index / (side * side)];
            let along = |n: usize| half * (2.0 * n as f64 / cells.max(1) as f64 - 1.0);
            Vec3::new(along(i), along(j), along(k))
        };
        let on_face = |index: usize| {
            let places = [index % side, index / side % side, index / (side * side)];
            places.iter().any(|&place| place == 0 || place == cells)
        };
        let outside = -half / cells.max(1) as f64;
        let values: Vec<f64> = (0..side * side * side)
            .map(|index| match value(at(index)) {
                found if on_face(index) || found.is_nan() => found.min(outside),
                found => found,
            })
            .collect();
        let mut surface = Surface {
            value,
            values: &values,
            at: &at,
            cuts: HashMap::new(),
            mesh: Self::default(),
        };
        for k in 0..cells {
            for j in 0..cells {
                for i in 0..cells {
                    let first = i + side * (j + side * k);
                    let corner =
                        |c: usize| first + (c & 1) + side * ((c >> 1 & 1) + side * (c >> 2));
                    for tetrahedron in TETRAHEDRA {
                        surface.cut(tetrahedron.map(corner));
                    }
                }
            }
        }
        let mut mesh = surface.mesh.faced();
        // Small triangles beside corners of the grid do not tell where the surface faces; the function does.
        let step = 0.5 * half / cells.max(1) as f64;
        for (place, normal) in mesh.positions.iter().zip(&mut mesh.normals) {
            let slope =
                Vec3::UNITS.map(|axis| value(*place + axis * step) - value(*place - axis * step));
            if let Some(down) = unit(-Vec3::from(slope)) {
                *normal = down;
            }
        }
        mesh
    }
}

struct Surface<'a> {
    value: &'a dyn Fn(Vec3) -> f64,
    values: &'a [f64],
    at: &'a dyn Fn(usize) -> Vec3,
    /// The corner of the surface on an edge of the grid, by the ends of that.
    cuts: HashMap<(usize, usize), u32>,
    mesh: Mesh,
}

impl Surface<'_> {
    /// Adds the triangles in one tetrahedron.
    fn cut(&mut self, corners: [usize; 4]) {
        let inside = |corner: &&usize| self.values[**corner] > 0.0;
        let inner: Vec<usize> = corners.iter().filter(inside).copied().collect();
        let outer: Vec<usize> = corners.iter().filter(|c| !inside(c)).copied().collect();
        match (&inner[..], &outer[..]) {
            (&[a], &[b, c, d]) => self.triangle([(a, b), (a, c), (a, d)]),
            (&[b, c, d], &[a]) => self.triangle([(b, a), (c, a), (d, a)]),
            (&[a, b], &[c, d]) => {
                self.triangle([(a, c), (a, d), (b, d)]);
                self.triangle([(a, c), (b, d), (b, c)]);
            }
            _ => {}
        }
    }

    /// A triangle with corners on edges from inside to outside, facing outward.
    fn triangle(&mut self, edges: [(usize, usize); 3]) {
        let mut corners = edges.map(|(inner, outer)| self.corner(inner, outer));
        let [a, b, c] = corners.map(|corner| self.mesh.positions[corner as usize]);
        let sum = |of: fn(&(usize, usize)) -> usize| {
            edges.iter().fold(Vec3::ZERO, |sum, edge| sum + (self.at)(of(edge)))
        };
        let outward = sum(|edge| edge.1) - sum(|edge| edge.0);
        if (b - a).cross(c - a).dot(outward) < 0.0 {
            corners.swap(1, 2);
        }
        self.mesh.triangles.push(corners);
    }

    fn corner(&mut self, inner: usize, outer: usize) -> u32 {
        if let Some(&known) = self.cuts.get(&(inner.min(outer), inner.max(outer))) {
            return known;
        }
        let (a, b) = ((self.at)(inner), (self.at)(outer));
        // The line between the values at the ends, then between those nearer to the zero (Illinois).
        let (mut low, mut from) = (0.0, self.values[inner]);
        let (mut high, mut to) = (1.0, self.values[outer]);
        let mut share = from / (from - to);
        for _ in 0..STEPS {
            let found = (self.value)(a + (b - a) * share);
            if found > 0.0 {
                (low, from, to) = (share, found, 0.5 * to);
            } else {
                (high, to, from) = (share, found.min(-f64::MIN_POSITIVE), 0.5 * from);
            }
            share = low + (high - low) * from / (from - to);
        }
        let share = share.clamp(APART, 1.0 - APART);
        let corner = self.mesh.positions.len() as u32;
        self.mesh.positions.push(a + (b - a) * share);
        self.cuts.insert((inner.min(outer), inner.max(outer)), corner);
        corner
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Every edge belongs to two triangles that go along it in opposite directions.
    fn is_closed(mesh: &Mesh) -> bool {
        let mut edges: HashMap<(u32, u32), i32> = HashMap::new();
        for t in &mesh.triangles {
            for (a, b) in [(t[0], t[1]), (t[1], t[2]), (t[2], t[0])] {
                *edges.entry((a, b)).or_default() += 1;
            }
        }
        edges.iter().all(|(&(a, b), &count)| count == 1 && edges.get(&(b, a)) == Some(&1))
    }

    #[test]
    fn a_shell_is_closed_inside_and_outside() {
        let shell = |p: Vec3| (0.8 - p.norm()).min(p.norm() - 0.4);
        let mesh = Mesh::of_level(&shell, 1.0, 40);
        assert!(is_closed(&mesh));
        // 4/3 π (0.8³ - 0.4³)
        let volume = 4.0 / 3.0 * std::f64::consts::PI * (0.512 - 0.064);
        assert!((mesh.volume() / volume - 1.0).abs() < 0.01, "{}", mesh.volume());
        for (place, normal) in mesh.positions.iter().zip(&mesh.normals) {
            let outward = if place.norm() > 0.6 { 1.0 } else { -1.0 };
            assert!(place.dot(*normal) * outward > 0.8 * place.norm(), "{place:?}");
        }
    }

    #[test]
    fn what_reaches_the_faces_of_the_cube_is_closed_there() {
        let mesh = Mesh::of_level(&|p: Vec3| 0.2 - p.x.abs(), 1.0, 20);
        assert!(is_closed(&mesh) && !mesh.triangles.is_empty());
        assert!(Mesh::of_level(&|_| f64::NAN, 1.0, 4).triangles.is_empty());
    }
}
