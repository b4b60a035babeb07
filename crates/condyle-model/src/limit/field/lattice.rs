//! Nodes in the map, and smooth functions given by numbers at them.

use super::chart::{self, OVERLAP, mapped, reach, slope, unmapped};
use condyle_math::Quat;

/// Equally spaced nodes in a cube about the map.
#[derive(Clone, Debug)]
pub struct Lattice {
    /// Nodes along an edge.
    pub edge: usize,
    /// Units of the map between two nodes.
    pub step: f64,
    origin: f64,
    per_step: f64,
}

impl Lattice {
    /// Nodes about all rotations, so many along an edge: at least 8.
    #[must_use]
    pub fn new(edge: usize) -> Self {
        // Of the nodes along an edge, two at either end are beyond the reach: cubic splines use one, their
        // coefficients another.
        let step = 2.0 * reach() / (edge as f64 - 6.1);
        Self { edge, step, origin: -reach() - 2.05 * step, per_step: 1.0 / step }
    }

    /// How many nodes there are.
    #[expect(clippy::len_without_is_empty, reason = "there are always nodes")]
    #[must_use]
    pub fn len(&self) -> usize {
        self.edge * self.edge * self.edge
    }

    /// The angle between neighbouring nodes in the middle, in radians.
    #[must_use]
    pub fn angle(&self) -> f64 {
        2.0 * self.step
    }

    /// Quaternions of the nodes, `None` where none is asked for a value.
    #[must_use]
    pub fn nodes(&self) -> Vec<Option<Quat>> {
        let used = reach() + 3.5 * self.step;
        let place = |i: usize| self.origin + self.step * i as f64;
        let mut nodes = Vec::with_capacity(self.len());
        for k in 0..self.edge {
            for j in 0..self.edge {
                for i in 0..self.edge {
                    let x = [place(i), place(j), place(k)];
                    let square = x[0] * x[0] + x[1] * x[1] + x[2] * x[2];
                    nodes.push(if square < used * used { unmapped(x) } else { None });
                }
            }
        }
        nodes
    }

    /// Of every other node, as [`super::Boundary`] counts them, the rotation with the sign that has w ≥ 0; `None` of those beyond.
    pub(super) fn every_other_node(&self, at: [usize; 3]) -> Option<Quat> {
        let q = unmapped(at.map(|i| self.origin + self.step * (2 * i) as f64))?;
        (q.w >= 0.0).then(|| chart::signed(q.normalized()))
    }

    /// The volume about each node in rad³; that of all rotations is 8π².
    #[must_use]
    pub fn volume(&self, q: Quat) -> f64 {
        // dV = 8 cos(θ/4) dx³, up to the half turns, |x| = √2.
        let square = 2.0 * (1.0 - q.w);
        let within = (2f64.sqrt() - square.sqrt()) / self.step + 0.5;
        self.around_node(q) * within.clamp(0.0, 1.0)
    }

    /// The volume about a node in rad³, also of one that is beyond the half turns.
    #[must_use]
    pub fn around_node(&self, q: Quat) -> f64 {
        let square = 2.0 * (1.0 - q.w);
        8.0 * (1.0 - square / 4.0).max(0.0).sqrt() * self.step.powi(3)
    }

    /// The eight nodes about a quaternion; its w must be above -`OVERLAP`.
    #[inline]
    #[must_use]
    pub fn corners(&self, q: Quat) -> [usize; 8] {
        let ([i, j, k], _) = self.cell(mapped(q));
        let edge = self.edge;
        let first = (k * edge + j) * edge + i;
        let above = first + edge * edge;
        [
            first,
            first + 1,
            first + edge,
            first + edge + 1,
            above,
            above + 1,
            above + edge,
            above + edge + 1,
        ]
    }

    /// The eight of every other node about a quaternion, as [`super::Boundary`] counts them.
    #[inline]
    pub(super) fn every_other(&self, q: Quat) -> [usize; 8] {
        let (cell, _) = self.cell(mapped(q));
        let [i, j, k] = cell.map(|c| c / 2);
        let half = self.edge.div_ceil(2);
        let first = (k * half + j) * half + i;
        let above = first + half * half;
        let row = |start| [start, start + 1, start + half, start + half + 1];
        let ([a, b, c, d], [e, f, g, h]) = (row(first), row(above));
        [a, b, c, d, e, f, g, h]
    }

    /// For each cell, by its first node, a bit that says whether any of the coefficients that make its values differ.
    pub(super) fn differing(&self, one: &[f32], other: &[f32]) -> Vec<u64> {
        let mut differ: Vec<bool> =
            one.iter().zip(other).map(|(a, b)| a.to_bits() != b.to_bits()).collect();
        for stride in [1, self.edge, self.edge * self.edge] {
            let from = differ.clone();
            for (node, differ) in differ.iter_mut().enumerate() {
                let at = |n: usize| from.get(n).copied().unwrap_or(false);
                *differ = at(node.wrapping_sub(stride))
                    || at(node)
                    || at(node + stride)
                    || at(node + 2 * stride);
            }
        }
        let bits = |some: &[bool]| {
            some.iter().enumerate().fold(0, |bits, (at, differ)| bits | u64::from(*differ) << at)
        };
        differ.chunks(64).map(bits).collect()
    }

    /// The cell of a place, such that a cubic spline has all its coefficients, and the place in it.
    #[inline]
    fn cell(&self, x: [f64; 3]) -> ([usize; 3], [f64; 3]) {
        let mut cell = [0; 3];
        let mut part = [0.0; 3];
        for axis in 0..3 {
            let u = ((x[axis] - self.origin) * self.per_step).clamp(1.0, self.edge as f64 - 3.0);
            // Of what is no number the part is none either, and so is the value.
            let whole = (u as usize).clamp(1, self.edge - 3);
            cell[axis] = whole;
            part[axis] = u - whole as f64;
        }
        (cell, part)
    }

    /// Coefficients of the cubic spline that takes given values near the nodes: exact for polynomials
    /// of third degree, elsewhere wrong by the fourth power of the step.
    #[must_use]
    pub fn coefficients(&self, values: &[f32]) -> Vec<f32> {
        let mut from = values.to_vec();
        for stride in [1, self.edge, self.edge * self.edge] {
            let mut to = from.clone();
            for index in stride..from.len().saturating_sub(stride) {
                let sides = from[index - stride] + from[index + stride];
                if sides.is_finite() && from[index].is_finite() {
                    to[index] = from[index] * (4.0 / 3.0) - sides * (1.0 / 6.0);
                }
            }
            from = to;
        }
        from
    }

    /// The value of a spline at a rotation in the map's axes, with w ≥ 0.
    ///
    /// Near the half turns a rotation is in the map twice, once under each sign; there both values are
    /// blended, so that the function is smooth.
    #[inline]
    pub(super) fn value(&self, spline: &[f32], q: Quat) -> f64 {
        self.value_in_cells(spline, q).0
    }

    /// The same, with the first nodes of the cells whose coefficients make it: two near the half turns, else one twice.
    #[inline]
    pub(super) fn value_in_cells(&self, spline: &[f32], q: Quat) -> (f64, [usize; 2]) {
        let (here, cell) = self.value_at(spline, mapped(q));
        if q.w >= OVERLAP {
            return (here, [cell; 2]);
        }
        let (there, other) = self.value_at(spline, mapped(-q));
        (there + (here - there) * blend(q.w).0, [cell, other])
    }

    /// The same, with its slope by the components of the quaternion.
    #[inline]
    pub(super) fn value_and_slope(&self, spline: &[f32], q: Quat) -> (f64, [f64; 4]) {
        let (here, g) = self.slope_at(spline, mapped(q));
        let g = slope(q, g);
        if q.w >= OVERLAP {
            return (here, g);
        }
        let (there, h) = self.slope_at(spline, mapped(-q));
        let h = slope(-q, h);
        let (share, rate) = blend(q.w);
        let mut both = [0.0; 4];
        for i in 0..4 {
            both[i] = share * g[i] - (1.0 - share) * h[i];
        }
        both[3] += rate * (here - there);
        (there + (here - there) * share, both)
    }

    #[inline(always)]
    fn value_at(&self, spline: &[f32], x: [f64; 3]) -> (f64, usize) {
        let ([i, j, k], [a, b, c]) = self.cell(x);
        let edge = self.edge;
        let (u, v, w) = (weights(a), weights(b), weights(c));
        let mut sum = 0.0;
        for (n, w) in w.into_iter().enumerate() {
            let mut plane = 0.0;
            for (m, v) in v.into_iter().enumerate() {
                let start = ((k + n - 1) * edge + j + m - 1) * edge + i - 1;
                if let Some([p, q, r, s]) = spline.get(start..start + 4) {
                    let row = (f64::from(*p) * u[0] + f64::from(*q) * u[1])
                        + (f64::from(*r) * u[2] + f64::from(*s) * u[3]);
                    plane += v * row;
                }
            }
            sum += w * plane;
        }
        (sum, (k * edge + j) * edge + i)
    }

    #[inline(always)]
    fn slope_at(&self, spline: &[f32], x: [f64; 3]) -> (f64, [f64; 3]) {
        let ([i, j, k], [a, b, c]) = self.cell(x);
        let (u, v, w) = (weights(a), weights(b), weights(c));
        let (du, dv, dw) = (rates(a), rates(b), rates(c));
        let edge = self.edge;
        let (mut sum, mut sx, mut sy, mut sz) = (0.0, 0.0, 0.0, 0.0);
        for n in 0..4 {
            let (mut plane, mut px, mut py) = (0.0, 0.0, 0.0);
            for m in 0..4 {
                let start = ((k + n - 1) * edge + j + m - 1) * edge + i - 1;
                if let Some([p, q, r, s]) = spline.get(start..start + 4) {
                    let cells = [f64::from(*p), f64::from(*q), f64::from(*r), f64::from(*s)];
                    let row =
                        (cells[0] * u[0] + cells[1] * u[1]) + (cells[2] * u[2] + cells[3] * u[3]);
                    let rise = (cells[0] * du[0] + cells[1] * du[1])
                        + (cells[2] * du[2] + cells[3] * du[3]);
                    plane += v[m] * row;
                    px += v[m] * rise;
                    py += dv[m] * row;
                }
            }
            sum += w[n] * plane;
            sx += w[n] * px;
            sy += w[n] * py;
            sz += dw[n] * plane;
        }
        (sum, [sx, sy, sz].map(|s| s * self.per_step))
    }

    /// The eight nodes about the same rotation under the other sign, if it is in the map twice.
    pub(super) fn twins(&self, q: Quat) -> Option<[usize; 8]> {
        let beyond = 2.0 * OVERLAP + 2.0 * self.step;
        (q.w.abs() < beyond).then(|| self.corners(-q))
    }

    /// The nodes about a rotation, under either sign where it is in the map twice.
    pub fn around(&self, q: Quat) -> impl Iterator<Item = usize> + use<> {
        let q = chart::signed(q);
        self.corners(q).into_iter().chain(self.twins(q).into_iter().flatten())
    }
}

/// Of the value under the sign with w > 0, its share, and the rate of the share.
#[inline]
fn blend(w: f64) -> (f64, f64) {
    let t = (0.5 + 0.5 * w / OVERLAP).clamp(0.0, 1.0);
    let share = t * t * t * (t * (6.0 * t - 15.0) + 10.0);
    let rate = 30.0 * t * t * (1.0 - t) * (1.0 - t);
    (share, rate * 0.5 / OVERLAP)
}

/// Weights of the cubic B-spline at a part of a cell.
#[inline(always)]
fn weights(t: f64) -> [f64; 4] {
    let s = 1.0 - t;
    let (a, d) = (s * s * s / 6.0, t * t * t / 6.0);
    let b = 2.0 / 3.0 - t * t * (1.0 - 0.5 * t);
    [a, b, 1.0 - a - b - d, d]
}

/// Their slopes.
#[inline(always)]
fn rates(t: f64) -> [f64; 4] {
    let s = 1.0 - t;
    let (a, d) = (-0.5 * s * s, 0.5 * t * t);
    let b = t * (1.5 * t - 2.0);
    [a, b, -a - b - d, d]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_nodes_fill_all_rotations() {
        let lattice = Lattice::new(48);
        let volume: f64 = lattice.nodes().into_iter().flatten().map(|q| lattice.volume(q)).sum();
        let all = 8.0 * std::f64::consts::PI.powi(2);
        assert!((volume / all - 1.0).abs() < 2e-3, "{volume}");
    }

    #[test]
    fn splines_take_cubic_polynomials_exactly() {
        let lattice = Lattice::new(24);
        let cubic =
            |[x, y, z]: [f64; 3]| 0.3 * x * x * y - 0.2 * z * z * z + 0.5 * x * y * z - x + 2.0;
        let values: Vec<f32> = lattice
            .nodes()
            .into_iter()
            .map(|q| q.map_or(f32::NAN, |q| cubic(mapped(q)) as f32))
            .collect();
        let spline = lattice.coefficients(&values);
        for i in 0..100 {
            let t = f64::from(i);
            let q =
                Quat { x: t.sin(), y: (1.3 * t).cos(), z: (2.1 * t).sin(), w: 1.0 }.normalized();
            assert!((lattice.value(&spline, q) - cubic(mapped(q))).abs() < 1e-5);
        }
    }
}
