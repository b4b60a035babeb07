//! Places on the boundary, and for every other node the one that is nearest.
//!
//! The nearest rotation on a boundary is found by steps along it, which end at whatever minimum is near their start. So the
//! start is the nearest of thousands of places all over the boundary, about as far apart as two thirds of the step of the
//! lattice: among those that are nearest to the eight nodes about a rotation there is one on the part of the boundary that is
//! nearest to it. Where others are nearly as near and elsewhere, the search begins at them too.

use super::Lattice;
use condyle_math::Quat;

/// Places on a boundary, in the map's axes.
#[derive(Clone, Debug, Default)]
pub struct Boundary {
    places: Vec<[f32; 4]>,
    /// For every other node along each axis the position of the nearest place.
    nearest: Vec<u32>,
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
            places: places.iter().map(|q| q.to_array().map(|c| c as f32)).collect(),
            nearest: (0..half * half * half)
                .map(|i| nearest.get(node(i)).copied().unwrap_or(u32::MAX))
                .collect(),
        }
    }

    /// How many places there are.
    #[must_use]
    pub fn places(&self) -> usize {
        self.places.len()
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
        let quat =
            |place: [f32; 4]| super::chart::signed(Quat::from(place.map(f64::from)).normalized());
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
