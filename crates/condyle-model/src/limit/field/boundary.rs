//! Places on the boundary, and for every other node the one that is nearest.
//!
//! The nearest rotation on a boundary is found by steps along it, which end at whatever minimum is near their start. So the
//! start is the nearest of thousands of places all over the boundary, about as far apart as two thirds of the step of the
//! lattice: among those that are nearest to the eight nodes about a rotation there is one on the part of the boundary that is
//! nearest to it. Where others are nearly as near and elsewhere, the search begins at them too. Nodes that are far outside have the very
//! rotation that is nearest to them, since of what is far several parts of the boundary are nearly as near.

use super::{Lattice, chart};
use condyle_math::Quat;

/// Places on a boundary, in the map's axes.
#[derive(Clone, Debug, Default)]
pub struct Boundary {
    places: Vec<[f32; 4]>,
    /// For every other node along each axis the position of the nearest place.
    nearest: Vec<u32>,
    /// How many of the places were given; those behind are of nodes that are far outside.
    given: usize,
}

impl Boundary {
    /// Of unit quaternions in the map's axes, and for all nodes of a lattice the position of the nearest of them.
    #[must_use]
    pub fn new(lattice: &Lattice, places: &[Quat], nearest: &[u32]) -> Self {
        let half = lattice.edge.div_ceil(2);
        let node = |i: usize| {
            let (x, y, z) = (i % half, i / half % half, i / half / half);
            ((2 * z) * lattice.edge + 2 * y) * lattice.edge + 2 * x
        };
        Self {
            given: places.len(),
            places: places.iter().map(|q| q.to_array().map(|c| c as f32)).collect(),
            nearest: (0..half * half * half)
                .map(|i| nearest.get(node(i)).copied().unwrap_or(u32::MAX))
                .collect(),
        }
    }

    /// How many places there are.
    #[must_use]
    pub fn places(&self) -> usize {
        self.given
    }

    /// Gives nodes that are far outside the very rotation that is nearest to them, as `foot` finds it from the places about.
    ///
    /// Between places an edge or a corner is cut off, by up to a degree. Of what is far away other parts of the boundary are as
    /// near as that, and a search that begins there ends there.
    pub(super) fn refine(
        &mut self,
        lattice: &Lattice,
        foot: impl Fn(Quat, [Option<Quat>; STARTS]) -> Option<Quat>,
    ) {
        let half = lattice.edge.div_ceil(2);
        let at = |[i, j, k]: [usize; 3]| (k * half + j) * half + i;
        let nodes = (0..half * half * half).map(|n| [n % half, n / half % half, n / half / half]);
        let mut far = vec![];
        for place in nodes {
            let Some(q) = lattice.every_other_node(place) else { continue };
            let starts = self.starts(lattice, q);
            let [Some(start), ..] = starts else { continue };
            if start.dot(q).abs() as f32 > FAR {
                continue;
            }
            if let Some(foot) = foot(q, starts) {
                far.push((place, q, foot));
            }
        }
        for (place, _, foot) in &far {
            self.put(at(*place), *foot);
        }
        // What is nearer from a node beside is nearer from here, too, if the search about here ended on another part.
        for _ in 0..ROUNDS {
            let mut better = vec![];
            for (index, (place, q, own)) in far.iter().enumerate() {
                let near = |axis: usize| place[axis].saturating_sub(1)..(place[axis] + 2).min(half);
                let mut best = (own.dot(*q).abs() + 1e-7, None);
                for k in near(2) {
                    for j in near(1) {
                        for i in near(0) {
                            let beside = self.nearest.get(at([i, j, k])).copied();
                            let beside = self.places.get(beside.unwrap_or(u32::MAX) as usize);
                            let Some(beside) = beside else { continue };
                            let beside =
                                chart::signed(Quat::from(beside.map(f64::from)).normalized());
                            if beside.dot(*q).abs() > best.0 {
                                best = (beside.dot(*q).abs(), Some(beside));
                            }
                        }
                    }
                }
                if let Some(start) = best.1 {
                    let mut starts = [None; STARTS];
                    starts[0] = Some(start);
                    better.extend(foot(*q, starts).map(|foot| (index, foot)));
                }
            }
            for (index, found) in better {
                far[index].2 = found;
                self.put(at(far[index].0), found);
            }
        }
    }

    /// A place of its own for a node.
    fn put(&mut self, node: usize, place: Quat) {
        if let Some(nearest) = self.nearest.get_mut(node) {
            *nearest = self.places.len() as u32;
            self.places.push(place.to_array().map(|c| c as f32));
        }
    }

    /// Of the places that are nearest to the nodes about a rotation of the map: the nearest, then up to four others that
    /// are nearly as near and on other parts of the boundary. Of what is far from the boundary more parts of it are nearly as near.
    #[inline]
    pub(super) fn starts(&self, lattice: &Lattice, q: Quat) -> [Option<Quat>; STARTS] {
        let small = q.to_array().map(|c| c as f32);
        let mut found = [(0.0, [0.0; 4]); 8];
        let mut best = 0;
        for (slot, node) in lattice.every_other(q).into_iter().enumerate() {
            let index = self.nearest.get(node).copied().unwrap_or(u32::MAX);
            let Some(place) = self.places.get(index as usize) else { continue };
            found[slot] = (dot(place, &small), *place);
            if found[slot].0 > found[best].0 {
                best = slot;
            }
        }
        let (nearest, place) = found[best];
        if nearest <= 0.0 {
            return [None; STARTS];
        }
        let quat = |place: [f32; 4]| chart::signed(Quat::from(place.map(f64::from)).normalized());
        let mut starts = [None; STARTS];
        starts[0] = Some(quat(place));
        let reach = if nearest < FAR { &WIDE } else { &CLOSE };
        // cos(θ/2 + ε) = cos θ/2 cos ε - sin θ/2 sin ε.
        let least = nearest * reach.cosine - (1.0 - nearest * nearest).max(0.0).sqrt() * reach.sine;
        let (mut taken, mut count) = ([place; STARTS], 1);
        for (near, place) in found {
            let apart = |p: &[f32; 4]| dot(p, &place) < reach.apart;
            if near > least && count < reach.count && taken[..count].iter().all(apart) {
                taken[count] = place;
                starts[count] = Some(quat(place));
                count += 1;
            }
        }
        starts
    }
}

/// Searches begin at most at so many places.
pub(super) const STARTS: usize = 5;

/// Rounds in which far nodes take over what nodes beside them found.
const ROUNDS: usize = 2;

/// cos of half of 20°: what is farther from the boundary is far from it.
const FAR: f32 = 0.984_807_8;

/// Which places are worth a search beside the nearest.
struct Reach {
    /// cos and sin of half the angle by which a place may be farther: so much may places be wrong about which part of the
    /// boundary is nearest.
    cosine: f32,
    sine: f32,
    /// cos of half the angle from which on two places are on different parts.
    apart: f32,
    count: usize,
}

/// 1.5°, for places are up to 2° apart; 6°.
const CLOSE: Reach = Reach { cosine: 0.999_914_3, sine: 0.013_089_6, apart: 0.998_629_5, count: 3 };
/// 2.5° and 2.5°.
const WIDE: Reach = Reach { cosine: 0.999_762, sine: 0.021_814_9, apart: 0.999_762, count: 5 };

#[inline(always)]
pub(super) fn dot(p: &[f32; 4], q: &[f32; 4]) -> f32 {
    (p[0] * q[0] + p[1] * q[1] + p[2] * q[2] + p[3] * q[3]).abs()
}
