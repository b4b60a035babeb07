//! The part of a sphere on which a function of direction is positive.
//!
//! The sphere is an icosahedron whose triangles are cut in four several times. Triangles that the boundary crosses are cut there: corners
//! on their edges and between these are brought to the zero of the function, more of them where it bends.

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
/// A zero is found when a step is below this share of the interval that it is sought in, or after so many steps.
const STEP: f64 = 1e-6;
const STEPS: usize = 60;
/// A boundary that is farther than this from the arc between two of its corners gets another, in radians, so often.
const BEND: f64 = 5e-4;
const BENDS: u32 = 6;
/// A distance rises by no more than this per radian, what rounds it included.
const STEEPEST: f64 = 1.5;
/// Triangles are cut in four no more often: 655 362 corners.
const DEEPEST: u32 = 8;

impl Patch {
    /// Along these directions, and against them, there are corners at every level: (0, ±1, (1 + √5)/2). Between the two
    /// others follow each other.
    pub const CORNERS: [Vec3; 2] = [
        Vec3 { x: 0.0, y: 1.0, z: 1.618_033_988_749_895 },
        Vec3 { x: 0.0, y: -1.0, z: 1.618_033_988_749_895 },
    ];

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
        Self::cut(value, level, None)
    }

    /// The same of a signed distance in radians, positive inside: where that is far from zero it is not asked.
    ///
    /// It must not rise by more than 1.5 per radian.
    ///
    /// ```
    /// use condyle_math::Vec3;
    /// use condyle_mesh::Patch;
    /// let cap = |v: Vec3| 0.5 - v.y.acos();
    /// let (quick, whole) = (Patch::of_distance(&cap, 4), Patch::of(&cap, 4));
    /// assert_eq!(quick.triangles, whole.triangles);
    /// ```
    #[must_use]
    pub fn of_distance(value: &dyn Fn(Vec3) -> f64, level: u32) -> Self {
        Self::cut(value, level, Some(STEEPEST))
    }

    fn cut(value: &dyn Fn(Vec3) -> f64, level: u32, steepest: Option<f64>) -> Self {
        let Sphere { corners: directions, parents, triangles } = sphere(level.min(DEEPEST));
        let mut values: Vec<f64> = Vec::with_capacity(directions.len());
        for (v, parents) in directions.iter().zip(&parents) {
            // At most so much, where both corners that it is between are far outside.
            let most = steepest.zip(*parents).map(|(steepest, ends)| {
                let [p, q] = ends.map(|i| i as usize);
                let way = steepest * v.dot(directions[p]).clamp(-1.0, 1.0).acos();
                values[p].max(values[q]) + way
            });
            values.push(most.filter(|most| *most < 0.0).unwrap_or_else(|| value(*v)));
        }
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
        let [from, to] = [inner, outer].map(|i| self.values[i as usize]);
        let at = |share: f64| (a * (1.0 - share) + b * share).normalized();
        let share = self.zero(&at, (0.0, from), (1.0, to)).clamp(APART, 1.0 - APART);
        let found = self.add(at(share));
        self.cuts.insert((inner, outer), found);
        found
    }

    /// Where the value turns from positive at `inside` to what is not: by the line between both ends, with the
    /// end that stays weighed less (Illinois).
    fn zero(&self, at: &dyn Fn(f64) -> Vec3, inside: (f64, f64), outside: (f64, f64)) -> f64 {
        let ((mut a, mut from), (mut b, mut to)) = (inside, outside);
        let (whole, mut last, mut kept) = ((b - a).abs(), f64::INFINITY, 0i32);
        for _ in 0..STEPS {
            let share = from / (from - to);
            // In the middle where the line tells nothing.
            let share = if share > 0.0 && share < 1.0 { share } else { 0.5 };
            let middle = a + (b - a) * share;
            if (middle - last).abs() < STEP * whole {
                return middle;
            }
            last = middle;
            let found = (self.value)(at(middle));
            if found > 0.0 {
                (a, from) = (middle, found);
                to *= if kept > 0 { 0.5 } else { 1.0 };
                kept = 1;
            } else {
                (b, to) = (middle, found.min(-f64::MIN_POSITIVE));
                from *= if kept < 0 { 0.5 } else { 1.0 };
                kept = -1;
            }
        }
        0.5 * (a + b)
    }

    /// The part of a triangle that is inside.
    fn triangle(&mut self, triangle: [u32; 3]) {
        let inside = triangle.map(|corner| self.inside(corner));
        let turned = |by: usize| [0, 1, 2].map(|i| triangle[(i + by) % 3]);
        match inside.iter().filter(|inside| **inside).count() {
            3 => {
                let kept = triangle.map(|corner| self.keep(corner));
                self.patch.triangles.push(kept);
            }
            1 => {
                let [a, b, c] = turned(inside.iter().position(|inside| *inside).unwrap_or(0));
                let kept = self.keep(a);
                let (start, end) = (self.cut(a, b), self.cut(a, c));
                let line = self.boundary(start, end);
                self.fan(kept, &line);
            }
            2 => {
                let [c, a, b] = turned(inside.iter().position(|inside| !inside).unwrap_or(0));
                let (first, second) = (self.keep(a), self.keep(b));
                let (start, end) = (self.cut(b, c), self.cut(a, c));
                let line = self.boundary(start, end);
                // Both inner corners see the half that is nearer to them.
                let (near, far) = line.split_at(line.len() / 2);
                let middle = far[0];
                self.patch.triangles.push([first, second, middle]);
                self.fan(second, &[near, &[middle]].concat());
                self.fan(first, far);
            }
            _ => {}
        }
    }

    /// Triangles from a corner to the pieces of a line.
    fn fan(&mut self, corner: u32, line: &[u32]) {
        for ends in line.windows(2) {
            self.patch.triangles.push([corner, ends[0], ends[1]]);
        }
    }

    /// The boundary between two corners on it, both of them included.
    fn boundary(&mut self, start: u32, end: u32) -> Vec<u32> {
        // Pieces that are still to be looked at, the next one last.
        let (mut line, mut open) = (vec![start], vec![(start, end, 0)]);
        while let Some((from, to, depth)) = open.pop() {
            let bent = (depth < BENDS).then(|| self.between(from, to));
            match bent {
                // One corner at least, so that there is always a middle.
                Some((place, off)) if depth == 0 || off > BEND => {
                    let middle = self.add(place);
                    let depth = if off > BEND { depth + 1 } else { BENDS };
                    open.extend([(middle, to, depth), (from, middle, depth)]);
                }
                _ => {
                    self.patch.edges.push([from, to]);
                    line.push(to);
                }
            }
        }
        line
    }

    /// A place on the boundary between two corners on it, sought to both sides of their middle, and how far from that
    /// it is.
    fn between(&mut self, from: u32, to: u32) -> (Vec3, f64) {
        let [p, q] = [from, to].map(|i| self.patch.corners[i as usize]);
        let middle = (p + q).normalized();
        // To the right of the way is outside.
        let out = (q - p).cross(middle) * 0.4;
        let at = |share: f64| (middle + out * share).normalized();
        let here = (self.value)(middle);
        let side = if here > 0.0 { 1.0 } else { -1.0 };
        let found = [0.25, 1.0].into_iter().find_map(|far| {
            let there = (self.value)(at(side * far));
            match (side > 0.0, there > 0.0) {
                (true, false) => Some(self.zero(&at, (0.0, here), (far, there))),
                (false, true) => Some(self.zero(&at, (-far, there), (0.0, here))),
                _ => None,
            }
        });
        let place = at(found.unwrap_or(0.0));
        (place, (place - middle).norm())
    }
}

/// A sphere in triangles; corners that were made later are between two earlier ones.
struct Sphere {
    corners: Vec<Vec3>,
    parents: Vec<Option<[u32; 2]>>,
    triangles: Vec<[u32; 3]>,
}

/// An icosahedron whose triangles are cut in four so many times.
fn sphere(level: u32) -> Sphere {
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
    let mut parents = vec![None; corners.len()];
    for _ in 0..level {
        let mut middles: HashMap<(u32, u32), u32> = HashMap::new();
        let mut finer = Vec::with_capacity(4 * triangles.len());
        for [a, b, c] in triangles {
            let [d, e, f] = [(a, b), (b, c), (c, a)].map(|(p, q)| {
                *middles.entry((p.min(q), p.max(q))).or_insert_with(|| {
                    let middle = corners[p as usize] + corners[q as usize];
                    corners.push(middle.normalized());
                    parents.push(Some([p, q]));
                    corners.len() as u32 - 1
                })
            });
            finer.extend([[a, d, f], [d, b, e], [f, e, c], [d, e, f]]);
        }
        triangles = finer;
    }
    Sphere { corners, parents, triangles }
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
