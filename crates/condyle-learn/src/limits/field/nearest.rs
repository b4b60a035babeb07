//! For every node the nearest of many balls, by propagation from node to node.
//!
//! The value at q is min over balls of (angle to the centre - radius). The region of a ball is connected, so the best
//! ball of a node is nearly always that of a neighbour or its own: sweeps forth and back, as in raster
//! distance transforms, settle all of them, whatever the number of balls.

use condyle_math::Quat;
use condyle_model::limit::field::Lattice;

/// No ball yet.
pub(super) const NONE: u32 = u32::MAX;

/// A ball of rotations; of 32 bits, for there are as many as nodes: 0.02° of rounding.
#[derive(Clone, Copy, Debug)]
pub(super) struct Ball {
    centre: [f32; 4],
    /// In radians.
    pub(super) radius: f32,
}

impl Ball {
    pub(super) fn new(centre: Quat, radius: f64) -> Self {
        Self { centre: centre.to_array().map(|c| c as f32), radius: radius as f32 }
    }

    /// |p·q| with the centre: the larger, the nearer.
    pub(super) fn cosine(&self, q: &[f32; 4]) -> f32 {
        self.centre.iter().zip(q).map(|(a, b)| a * b).sum::<f32>().abs()
    }
}

/// What is nearest to each node.
#[derive(Clone, Debug)]
pub(super) struct Nearest {
    /// The angle to the centre less the radius, in radians; infinite where no node of use is.
    pub(super) value: Vec<f32>,
    /// The ball.
    pub(super) ball: Vec<u32>,
}

/// 2·acos|p·q|, to 1.4e-4 rad (Abramowitz & Stegun 4.4.45).
#[inline(always)]
fn angle(p: &[f32; 4], q: &[f32; 4]) -> f32 {
    let dot = (p[0] * q[0] + p[1] * q[1] + p[2] * q[2] + p[3] * q[3]).abs().min(1.0);
    let polynomial = 1.570_728_8 + dot * (-0.212_114_4 + dot * (0.074_261 - dot * 0.018_729_3));
    2.0 * (1.0 - dot).sqrt() * polynomial
}

/// The nodes as balls are measured to them.
#[derive(Clone, Debug)]
pub(super) struct Nodes<'a> {
    pub(super) lattice: &'a Lattice,
    pub(super) rotations: &'a [Option<Quat>],
    /// Nodes of use, in rising order, with what is needed of each.
    pub(super) used: Vec<(u32, [f32; 4])>,
    /// Those that are in the map twice, with the nodes about the other place.
    seam: Vec<(u32, [f32; 4], [usize; 8])>,
}

impl<'a> Nodes<'a> {
    pub(super) fn new(lattice: &'a Lattice, rotations: &'a [Option<Quat>]) -> Self {
        let (mut used, mut seam) = (vec![], vec![]);
        for (index, q) in (0u32..).zip(rotations) {
            let Some(q) = q else { continue };
            let small = q.to_array().map(|c| c as f32);
            used.push((index, small));
            // The map goes on for a few nodes beyond the half turns.
            if q.w.abs() < 0.25 {
                seam.push((index, small, lattice.corners(-*q)));
            }
        }
        Self { lattice, rotations, used, seam }
    }

    /// The nearest of balls. `seeds` are (node, ball) to begin with.
    pub(super) fn nearest(
        &self,
        balls: &[Ball],
        seeds: impl Iterator<Item = (usize, u32)>,
    ) -> Nearest {
        let count = self.lattice.len();
        let mut found = Nearest { value: vec![f32::INFINITY; count], ball: vec![NONE; count] };
        for (node, ball) in seeds {
            if let Some(Some(q)) = self.rotations.get(node) {
                found.consider(balls, node, &q.to_array().map(|c| c as f32), ball);
            }
        }
        let edge = self.lattice.edge as isize;
        let mut behind = [0isize; 13];
        for (slot, n) in behind.iter_mut().zip(0..13isize) {
            let (i, j, k) = (n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1);
            *slot = (k * edge + j) * edge + i;
        }
        for _ in 0..4 {
            let mut changed = 0usize;
            for (node, q, twins) in &self.seam {
                for twin in twins {
                    let ball = found.ball.get(*twin).copied().unwrap_or(NONE);
                    changed += usize::from(found.consider(balls, *node as usize, q, ball));
                }
            }
            for (node, q) in &self.used {
                changed += found.taken_from_neighbours(balls, *node as usize, q, &behind, 1);
            }
            for (node, q) in self.used.iter().rev() {
                changed += found.taken_from_neighbours(balls, *node as usize, q, &behind, -1);
            }
            if changed * 1000 < self.used.len() {
                break;
            }
        }
        found
    }
}

impl Nearest {
    #[inline(always)]
    fn consider(&mut self, balls: &[Ball], node: usize, q: &[f32; 4], ball: u32) -> bool {
        if ball == self.ball[node] {
            return false;
        }
        let Some(candidate) = balls.get(ball as usize) else { return false };
        let value = angle(q, &candidate.centre) - candidate.radius;
        if value < self.value[node] {
            self.value[node] = value;
            self.ball[node] = ball;
            return true;
        }
        false
    }

    #[inline(always)]
    fn taken_from_neighbours(
        &mut self,
        balls: &[Ball],
        node: usize,
        q: &[f32; 4],
        behind: &[isize; 13],
        way: isize,
    ) -> usize {
        let mut changed = 0;
        let mut last = NONE;
        for offset in behind {
            let neighbour = node.wrapping_add_signed(offset * way);
            let ball = self.ball.get(neighbour).copied().unwrap_or(NONE);
            if ball != last {
                last = ball;
                changed += usize::from(self.consider(balls, node, q, ball));
            }
        }
        changed
    }
}
