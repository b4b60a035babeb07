//! Places on the boundary, and for every other node the one that is nearest.
//!
//! The nearest rotation on a boundary is found by steps along it, which end at whatever minimum is near their start. So the
//! start is the nearest of thousands of places all over the boundary, about as far apart as two thirds of the step of the
//! lattice: among those that are nearest to the eight nodes about a rotation there is one on the part of the boundary that is
//! nearest to it, unless two parts are equally far to within what is between nodes.

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

    /// The nearest of the places that are nearest to the nodes about a rotation of the map.
    #[inline]
    pub(super) fn nearest(&self, lattice: &Lattice, q: Quat) -> Option<Quat> {
        let (mut best, mut found, mut last) = (-1.0, None, u32::MAX);
        for node in lattice.every_other(q) {
            let &index = self.nearest.get(node)?;
            if index == last {
                continue;
            }
            last = index;
            let Some(place) = self.places.get(index as usize) else { continue };
            let p = Quat::from(place.map(f64::from));
            let near = q.dot(p).abs();
            if near > best {
                (best, found) = (near, Some(p));
            }
        }
        found.map(|p| super::chart::signed(p.normalized()))
    }
}
