//! Search for the nearest edge in blocks of eight edges, without a branch per edge (SIMD lanes).
//!
//! A block has a bounding ball of its edges. By the triangle inequality, with chords between points
//! of the unit sphere,
//!
//! ```text
//! |v - x| ≥ |v - centre| - radius      for every x on the block's edges
//! ```
//!
//! so a block is skipped if that is more than the chord to the nearest corner found so far.

use super::boundary::Edge;
use condyle_math::Vec3;

/// The number of edges of a block.
const LANES: usize = 8;
/// Up to this number of blocks, all are measured.
const FEW: usize = 4;
/// A margin for the rounding of √(2 - 2·cos): the square root of the rounding of a number near 2.
const ROOM: f64 = 1e-7;

/// Eight consecutive edges, as a structure of arrays; if fewer remain, the last one fills the other
/// lanes, with a NaN cosine.
#[derive(Clone, Debug)]
struct Block {
    /// The start of the first edge; the others start at the end of the previous edge.
    start: Vec3,
    end: [[f64; LANES]; 3],
    normal: [[f64; LANES]; 3],
    /// The cosine of each edge's length; NaN in unused lanes, so that no foot is found there.
    cosine: [f64; LANES],
    centre: Vec3,
    radius: f64,
}

/// All edges of a boundary in blocks.
#[derive(Clone, Debug)]
pub(super) struct Blocks(Vec<Block>);

/// The result of a search.
#[derive(Clone, Copy, Debug)]
pub(super) struct Found {
    /// The edge whose end is the nearest corner.
    pub(super) corner: usize,
    /// The cosine of the angle to it.
    pub(super) cosine: f64,
    /// The edge with the smallest angle to its plane, of those on which the foot of the
    /// perpendicular from the direction lies.
    pub(super) arc: usize,
    /// The squared sine of that angle; infinite if there is no such edge.
    pub(super) square: f64,
}

impl Block {
    fn new(edges: &[Edge]) -> Self {
        let lane = |k: usize| edges[k.min(edges.len() - 1)];
        let rows = |of: fn(&Edge) -> Vec3| {
            [0, 1, 2].map(|axis| std::array::from_fn(|k| of(&lane(k)).to_array()[axis]))
        };
        let cosine = |k: usize| edges.get(k).map_or(f64::NAN, |edge| edge.cosine);
        // A point of a chord is no farther from the centre than its ends; the arc lies above the
        // chord by the sagitta 1 - cos(length/2) at most.
        let sum = edges.iter().fold(edges[0].start, |sum, edge| sum + edge.end);
        let centre = sum * (1.0 / (edges.len() + 1) as f64);
        let radius = edges.iter().fold(0.0f64, |radius, edge| {
            let bulge = 1.0 - (0.5 * (1.0 + edge.cosine)).max(0.0).sqrt();
            let ends = (edge.start - centre).norm().max((edge.end - centre).norm());
            radius.max(ends + bulge)
        });
        Self {
            start: edges[0].start,
            end: rows(|edge| edge.end),
            normal: rows(|edge| edge.normal),
            cosine: std::array::from_fn(cosine),
            centre,
            radius: radius + ROOM,
        }
    }

    /// The cosines of the angles to the ends, and the squared sines of the angles to the planes of
    /// the edges, infinite where the foot is not on the edge.
    #[inline(always)]
    fn measure(&self, v: Vec3) -> ([f64; LANES], [f64; LANES]) {
        let along = |rows: &[[f64; LANES]; 3], k: usize| {
            v.x * rows[0][k] + v.y * rows[1][k] + v.z * rows[2][k]
        };
        let mut ends = [0.0; LANES];
        for k in 0..LANES {
            ends[k] = along(&self.end, k);
        }
        let mut starts = [v.dot(self.start); LANES];
        starts[1..].copy_from_slice(&ends[..LANES - 1]);
        let mut squares = [0.0; LANES];
        for k in 0..LANES {
            let sine = along(&self.normal, k);
            // The signs of v·(n × p) = (v·p′ - cos·v·p)/sin and v·(p′ × n) = (v·p - cos·v·p′)/sin,
            // with the length of the edge as angle. `&` instead of `&&`: no branch.
            let on_edge =
                (ends[k] >= self.cosine[k] * starts[k]) & (starts[k] >= self.cosine[k] * ends[k]);
            squares[k] = if on_edge { sine * sine } else { f64::INFINITY };
        }
        (ends, squares)
    }
}

/// The first position of a number that is in the array.
#[inline(always)]
fn place(numbers: &[f64; LANES], number: f64) -> usize {
    let mut place = 0;
    for k in (0..LANES).rev() {
        place = if numbers[k] == number { k } else { place };
    }
    place
}

/// The smallest number, by pairs: the comparisons of a level are independent.
#[inline(always)]
fn least(numbers: &[f64; LANES]) -> f64 {
    let min = |a: f64, b: f64| if a < b { a } else { b };
    let [a, b, c, d, e, f, g, h] = *numbers;
    min(min(min(a, e), min(c, g)), min(min(b, f), min(d, h)))
}

#[inline(always)]
fn largest(numbers: &[f64; LANES]) -> f64 {
    let max = |a: f64, b: f64| if a > b { a } else { b };
    let [a, b, c, d, e, f, g, h] = *numbers;
    max(max(max(a, e), max(c, g)), max(max(b, f), max(d, h)))
}

impl Blocks {
    pub(super) fn new(edges: &[Edge]) -> Self {
        Self(edges.chunks(LANES).map(Block::new).collect())
    }

    /// The nearest corner and the nearest foot.
    #[inline]
    pub(super) fn search(&self, v: Vec3) -> Found {
        // For few blocks, measuring all is as fast as selecting some.
        let choose = self.0.len() > FEW;
        let mut first = 0;
        // Start with the block of the nearest centre, so that `reach` is small from the beginning.
        if choose {
            let mut nearest = f64::INFINITY;
            for (i, block) in self.0.iter().enumerate() {
                let off = (v - block.centre).norm_squared();
                if off < nearest {
                    (first, nearest) = (i, off);
                }
            }
        }
        let (mut ends, mut squares) = self.0[first].measure(v);
        let (mut cosine, mut square) = (largest(&ends), least(&squares));
        let (mut corner_block, mut arc_block) = (first, first);
        // The chord to the nearest corner so far: |v - p|² = 2 - 2·v·p.
        let mut reach = (2.0 - 2.0 * cosine).max(0.0).sqrt();
        for (i, block) in self.0.iter().enumerate() {
            if i == first {
                continue;
            }
            if choose {
                let bound = block.radius + reach;
                if (v - block.centre).norm_squared() > bound * bound {
                    continue;
                }
            }
            let (new_ends, new_squares) = block.measure(v);
            let (new_cosine, new_square) = (largest(&new_ends), least(&new_squares));
            if new_cosine > cosine {
                (corner_block, cosine, ends) = (i, new_cosine, new_ends);
                if choose {
                    reach = (2.0 - 2.0 * cosine).max(0.0).sqrt();
                }
            }
            if new_square < square {
                (arc_block, square, squares) = (i, new_square, new_squares);
            }
        }
        let corner = corner_block * LANES + place(&ends, cosine);
        Found { corner, cosine, arc: arc_block * LANES + place(&squares, square), square }
    }
}
