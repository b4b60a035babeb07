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

    /// Of the places that are nearest to the nodes about a rotation of the map: the nearest, then up to two others that
    /// are nearly as near and on other parts of the boundary.
    #[inline]
    pub(super) fn starts(&self, lattice: &Lattice, q: Quat) -> [Option<Quat>; 3] {
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
            return [None; 3];
        }
        let quat =
            |place: [f32; 4]| super::chart::signed(Quat::from(place.map(f64::from)).normalized());
        let mut starts = [Some(quat(place)), None, None];
        // cos(θ/2 + ε) = cos θ/2 cos ε - sin θ/2 sin ε.
        let least = nearest * COSINE - (1.0 - nearest * nearest).max(0.0).sqrt() * SINE;
        let (mut taken, mut count) = ([place; 3], 1);
        for (near, place) in found {
            let apart = |p: &[f32; 4]| dot(p, &place) < APART;
            if near > least && count < 3 && taken[..count].iter().all(apart) {
                taken[count] = place;
                starts[count] = Some(quat(place));
                count += 1;
            }
        }
        starts
    }
}

/// cos and sin of half of 1.5°: by so much the places, which are up to 2° apart, may be wrong about which part of the
/// boundary is nearest.
const COSINE: f32 = 0.999_914_3;
const SINE: f32 = 0.013_089_6;
/// cos of half of 6°: places that are farther apart are on other parts of the boundary.
const APART: f32 = 0.998_629_5;

#[inline(always)]
pub(super) fn dot(p: &[f32; 4], q: &[f32; 4]) -> f32 {
    (p[0] * q[0] + p[1] * q[1] + p[2] * q[2] + p[3] * q[3]).abs()
}
