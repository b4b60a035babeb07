//! The part of a sphere on which a function of direction is positive.
//!
//! The sphere is an icosahedron whose triangles are cut in four several times. Triangles that the boundary crosses are cut there: corners
//! on their edges and one between these are brought to the zero of the function, so that a boundary of piecewise great arcs
//! is off by its bend within a quarter of a triangle.

use crate::Mesh;
use condyle_math::Vec3;
use std::collections::HashMap;

/// A part of the unit sphere in triangles.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Patch {
    /// Directions of length 1.
    pub corners: Vec<Vec3>,
    /// Three corners each, counter-clockwise from outside.
    pub triangles: Vec<[u32; 3]>,
    /// The boundary in pieces, with the part on the left seen from outside.
    pub edges: Vec<[u32; 2]>,
}

/// A corner on an edge is no nearer to an end than this share, so that no triangle is without area.
const APART: f64 = 1e-3;
/// How often an interval about the boundary is halved: a triangle's edge becomes a billionth.
const HALVINGS: usize = 30;
/// Triangles are cut in four no more often: 655 362 corners.
const DEEPEST: u32 = 8;

impl Patch {
    /// The part where `value` is positive; each triangle of an icosahedron is cut in four `level` times (5: corners 2 degrees
    /// apart; at most 8).
    ///
    /// ```
    /// use condyle_math::Vec3;
    /// use condyle_mesh::Patch;
    /// // A cap of 40 degrees about y: its boundary is on the circle, also between corners.
    /// let reach = 40f64.to_radians();
    /// let patch = Patch::of(&|v: Vec3| reach - v.y.acos(), 4);
    /// for [a, b] in &patch.edges {
    ///     let middle = patch.corners[*a as usize] + patch.corners[*b as usize];
    ///     let angle = middle.normalized().y.acos();
    ///     assert!((angle - reach).abs().to_degrees() < 0.03);
    /// }
    /// // A cap's area is 2π(1 - cos).
    /// let shell = patch.shell(1.0, 0.5).0;
    /// let volume = 2.0 * std::f64::consts::PI * (1.0 - reach.cos()) * (1.0 - 0.125) / 3.0;
    /// assert!((shell.volume() / volume - 1.0).abs() < 0.01);
    /// ```
    #[must_use]
    pub fn of(value: &dyn Fn(Vec3) -> f64, level: u32) -> Self {
        let (directions, triangles) = sphere(level.min(DEEPEST));
        let values: Vec<f64> = directions.iter().map(|v| value(*v)).collect();
        let mut cutter = Cutter {
            value,
            directions: &directions,
            values: &values,
            kept: vec![u32::MAX; directions.len()],
            cuts: HashMap::new(),
            patch: Self::default(),
        };
        for triangle in triangles {
            cutter.triangle(triangle);
        }
        cutter.patch
    }

    /// The boundary as closed lines, each as the corners it runs through; the first is not repeated.
    #[must_use]
    pub fn loops(&self) -> Vec<Vec<u32>> {
        let mut next: HashMap<u32, u32> = self.edges.iter().map(|[a, b]| (*a, *b)).collect();
        let mut loops = vec![];
        for [start, _] in &self.edges {
            let mut line = vec![];
            let mut at = *start;
            while let Some(to) = next.remove(&at) {
                line.push(at);
                at = to;
            }
            if line.len() > 2 {
                loops.push(line);
            }
        }
        loops
    }

    /// The lines on which numbers at the corners, linear between them, have a value.
    #[must_use]
    pub fn contour(&self, numbers: &[f64], value: f64) -> Vec<Vec<Vec3>> {
        let number = |i: u32| numbers.get(i as usize).copied().unwrap_or(f64::NAN);
        let corner = |i: u32| self.corners.get(i as usize).copied().unwrap_or(Vec3::ZERO);
        // From one edge of the triangulation to the next, with the greater numbers on the left.
        let mut next: HashMap<[u32; 2], [u32; 2]> = HashMap::new();
        let mut entered: HashMap<[u32; 2], bool> = HashMap::new();
        for [a, b, c] in &self.triangles {
            let (mut from, mut to) = (None, None);
            for [p, q] in [[*a, *b], [*b, *c], [*c, *a]] {
                let key = [p.min(q), p.max(q)];
                match (number(p) > value, number(q) > value) {
                    (true, false) => from = Some(key),
                    (false, true) => to = Some(key),
                    _ => {}
                }
            }
            if let (Some(from), Some(to)) = (from, to) {
                next.insert(from, to);
                entered.insert(to, true);
            }
        }
        let place = |[p, q]: [u32; 2]| {
            let share = (value - number(p)) / (number(q) - number(p));
            let share = if share.is_finite() { share.clamp(0.0, 1.0) } else { 0.5 };
            (corner(p) * (1.0 - share) + corner(q) * share).normalized()
        };
        let mut starts: Vec<[u32; 2]> = next.keys().copied().collect();
        // Lines that begin at the boundary first, then closed ones; in an order that does not depend on chance.
        starts.sort_by_key(|key| (entered.contains_key(key), *key));
        let mut lines = vec![];
        for start in starts {
            let mut line = vec![];
            let mut at = start;
            while let Some(to) = next.remove(&at) {
                line.push(place(at));
                at = to;
            }
            if !line.is_empty() {
                line.push(place(at));
                lines.push(line);
            }
        }
        lines
    }

    /// The part as a shell between two radii: closed and facing outward; and for each corner of the shell the patch's.
    #[must_use]
    pub fn shell(&self, outer: f64, inner: f64) -> (Mesh, Vec<u32>) {
        let mut mesh = Mesh::default();
        let mut own = vec![];
        let count = self.corners.len() as u32;
        for (radius, side) in [(outer, 1.0), (inner, -1.0)] {
            mesh.positions.extend(self.corners.iter().map(|v| *v * radius));
            mesh.normals.extend(self.corners.iter().map(|v| *v * side));
            own.extend(0..count);
        }
        for [a, b, c] in &self.triangles {
            mesh.triangles.push([*a, *b, *c]);
            mesh.triangles.push([count + a, count + c, count + b]);
        }
        for [a, b] in &self.edges {
            let [p, q] = [*a, *b].map(|i| self.corners[i as usize]);
            // To the right of the way: away from the part.
            let normal = (q - p).cross(p + q).normalized();
            let first = mesh.positions.len() as u32;
            mesh.positions.extend([p * outer, q * outer, q * inner, p * inner]);
            mesh.normals.extend([normal; 4]);
            own.extend([*a, *b, *b, *a]);
            mesh.triangles.push([first, first + 3, first + 2]);
            mesh.triangles.push([first, first + 2, first + 1]);
        }
        (mesh, own)
    }
}

struct Cutter<'a> {
    value: &'a dyn Fn(Vec3) -> f64,
    directions: &'a [Vec3],
    values: &'a [f64],
    /// Where corners of the sphere are in the patch.
    kept: Vec<u32>,
    /// Corners on edges of the sphere, by the inner and the outer end.
    cuts: HashMap<(u32, u32), u32>,
    patch: Patch,
}

impl Cutter<'_> {
    fn inside(&self, corner: u32) -> bool {
        self.values[corner as usize] > 0.0
    }

    fn add(&mut self, direction: Vec3) -> u32 {
        self.patch.corners.push(direction);
        self.patch.corners.len() as u32 - 1
    }

    fn keep(&mut self, corner: u32) -> u32 {
        if self.kept[corner as usize] == u32::MAX {
            self.kept[corner as usize] = self.add(self.directions[corner as usize]);
        }
        self.kept[corner as usize]
    }

    /// The corner on an edge between an inner and an outer end.
    fn cut(&mut self, inner: u32, outer: u32) -> u32 {
        if let Some(found) = self.cuts.get(&(inner, outer)) {
            return *found;
        }
        let [a, b] = [inner, outer].map(|i| self.directions[i as usize]);
        let at = |share: f64| (a * (1.0 - share) + b * share).normalized();
        let share = self.zero(&at, 0.0, 1.0).clamp(APART, 1.0 - APART);
        let found = self.add(at(share));
        self.cuts.insert((inner, outer), found);
        found
    }

    /// Where the value turns from positive at `inside` to what is not.
    fn zero(&self, at: &dyn Fn(f64) -> Vec3, mut inside: f64, mut outside: f64) -> f64 {
        for _ in 0..HALVINGS {
            let middle = 0.5 * (inside + outside);
            if (self.value)(at(middle)) > 0.0 { inside = middle } else { outside = middle }
        }
        0.5 * (inside + outside)
    }

    /// The part of a triangle that is inside, as a polygon with a corner more on the boundary.
    fn triangle(&mut self, triangle: [u32; 3]) {
        let inside = triangle.map(|corner| self.inside(corner));
        if inside == [false; 3] {
            return;
        }
        let mut polygon: Vec<u32> = vec![];
        let (mut start, mut end) = (None, None);
        for i in 0..3 {
            let (here, next) = (triangle[i], triangle[(i + 1) % 3]);
            if inside[i] {
                let kept = self.keep(here);
                polygon.push(kept);
            }
            match (inside[i], inside[(i + 1) % 3]) {
                (true, false) => {
                    let cut = self.cut(here, next);
                    polygon.push(cut);
                    start = Some((polygon.len(), cut));
                }
                (false, true) => {
                    let cut = self.cut(next, here);
                    polygon.push(cut);
                    end = Some(cut);
                }
                _ => {}
            }
        }
        let mut first = 0;
        if let (Some((at, from)), Some(to)) = (start, end) {
            let between = self.between(from, to);
            polygon.insert(at, between);
            self.patch.edges.extend([[from, between], [between, to]]);
            // A fan from the corner between the two: one from either would have a triangle without area.
            first = at;
        }
        let count = polygon.len();
        for step in 1..count - 1 {
            let corner = |by: usize| polygon[(first + by) % count];
            self.patch.triangles.push([corner(0), corner(step), corner(step + 1)]);
        }
    }

    /// A corner on the boundary between two on it, sought to both sides of their middle.
    fn between(&mut self, from: u32, to: u32) -> u32 {
        let [p, q] = [from, to].map(|i| self.patch.corners[i as usize]);
        let middle = (p + q).normalized();
        // To the right of the way is outside.
        let out = (q - p).cross(middle) * 0.4;
        let at = |share: f64| (middle + out * share).normalized();
        let side = if (self.value)(middle) > 0.0 { 1.0 } else { -1.0 };
        let found = [0.25, 1.0].into_iter().find_map(|far| {
            let there = (self.value)(at(side * far)) > 0.0;
            match (side > 0.0, there) {
                (true, false) => Some(self.zero(&at, 0.0, far)),
                (false, true) => Some(self.zero(&at, -far, 0.0)),
                _ => None,
            }
        });
        let place = at(found.unwrap_or(0.0));
        self.add(place)
    }
}

/// An icosahedron whose triangles are cut in four so many times.
fn sphere(level: u32) -> (Vec<Vec3>, Vec<[u32; 3]>) {
    let golden = 0.5 * (1.0 + 5f64.sqrt());
    let mut corners: Vec<Vec3> = vec![];
    for (a, b) in [(1.0, golden), (-1.0, golden), (1.0, -golden), (-1.0, -golden)] {
        corners.extend([Vec3::new(0.0, a, b), Vec3::new(a, b, 0.0), Vec3::new(b, 0.0, a)]);
    }
    let mut corners: Vec<Vec3> = corners.into_iter().map(Vec3::normalized).collect();
    // Corners that are neighbours are 63 degrees apart, others 116 and more.
    let near = |a: usize, b: usize| corners[a].dot(corners[b]) > 0.4;
    let mut triangles: Vec<[u32; 3]> = vec![];
    for a in 0..12 {
        for b in a + 1..12 {
            for c in b + 1..12 {
                if near(a, b) && near(b, c) && near(a, c) {
                    let outward = corners[a].dot(corners[b].cross(corners[c])) > 0.0;
                    let [b, c] = if outward { [b, c] } else { [c, b] };
                    triangles.push([a as u32, b as u32, c as u32]);
                }
            }
        }
    }
    for _ in 0..level {
        let mut middles: HashMap<(u32, u32), u32> = HashMap::new();
        let mut finer = Vec::with_capacity(4 * triangles.len());
        for [a, b, c] in triangles {
            let [d, e, f] = [(a, b), (b, c), (c, a)].map(|(p, q)| {
                *middles.entry((p.min(q), p.max(q))).or_insert_with(|| {
                    let middle = corners[p as usize] + corners[q as usize];
                    corners.push(middle.normalized());
                    corners.len() as u32 - 1
                })
            });
            finer.extend([[a, d, f], [d, b, e], [f, e, c], [d, e, f]]);
        }
        triangles = finer;
    }
    (corners, triangles)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Every side of a triangle is met once the other way, by places.
    fn closed(mesh: &Mesh) -> bool {
        let key = |i: u32| mesh.positions[i as usize].to_array().map(f64::to_bits);
        let mut sides: HashMap<_, i32> = HashMap::new();
        for [a, b, c] in &mesh.triangles {
            for (p, q) in [(*a, *b), (*b, *c), (*c, *a)] {
                *sides.entry((key(p), key(q))).or_default() += 1;
                *sides.entry((key(q), key(p))).or_default() -= 1;
            }
        }
        sides.values().all(|sum| *sum == 0)
    }

    fn faces_outward(mesh: &Mesh) -> bool {
        mesh.triangles.iter().all(|t| {
            let [a, b, c] = t.map(|i| mesh.positions[i as usize]);
            let normals = t.map(|i| mesh.normals[i as usize]);
            let area = (b - a).cross(c - a);
            normals.iter().all(|n| area.dot(*n) >= -1e-12)
        })
    }

    /// A zone between two circles has two boundaries, the whole sphere none, an empty part nothing.
    #[test]
    fn shells_are_closed_and_face_outward() {
        let zone = |v: Vec3| (v.y + 0.3) * (0.6 - v.y);
        let whole = |_: Vec3| 1.0;
        let two = |v: Vec3| (v.x.abs() - 0.8).max(v.z - 0.9);
        for (value, loops) in [(&zone as &dyn Fn(Vec3) -> f64, 2), (&whole, 0), (&two, 3)] {
            let patch = Patch::of(value, 4);
            assert_eq!(patch.loops().len(), loops);
            let shell = patch.shell(1.0, 0.95).0;
            assert!(closed(&shell) && faces_outward(&shell));
            assert!(shell.volume() > 0.0);
        }
        assert_eq!(Patch::of(&|_| -1.0, 3), Patch::default());
        // Area of the zone: 2π·0.9, of a shell a third of the difference of the cubes.
        let volume = Patch::of(&zone, 5).shell(1.0, 0.5).0.volume();
        let expected = 2.0 * std::f64::consts::PI * 0.9 * (1.0 - 0.125) / 3.0;
        assert!((volume / expected - 1.0).abs() < 2e-3, "{volume} {expected}");
    }

    /// Numbers that are the height: contours are circles, closed inside, and end at the boundary where that cuts them.
    #[test]
    fn contours_are_where_numbers_have_the_value() {
        let half = Patch::of(&|v: Vec3| v.x + 1e-3, 4);
        let heights: Vec<f64> = half.corners.iter().map(|v| v.y).collect();
        let lines = half.contour(&heights, 0.4);
        assert_eq!(lines.len(), 1);
        assert!(lines[0].iter().all(|v| (v.y - 0.4).abs() < 2e-3));
        let radius = (1.0f64 - 0.16).sqrt();
        let length: f64 = lines[0].windows(2).map(|ends| (ends[1] - ends[0]).norm()).sum();
        assert!((length / (std::f64::consts::PI * radius) - 1.0).abs() < 5e-3, "{length}");
        let whole = Patch::of(&|_| 1.0, 4);
        let heights: Vec<f64> = whole.corners.iter().map(|v| v.y).collect();
        let lines = whole.contour(&heights, -0.2);
        assert_eq!(lines.len(), 1);
        assert!((lines[0][0] - lines[0][lines[0].len() - 1]).norm() < 1e-12, "closed");
    }
}
