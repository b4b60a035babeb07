//! Which rotations of a set are near a rotation: a hash of cells in the space of unit quaternions.

use condyle_math::Quat;
use std::collections::HashMap;

/// Rotations in cubes of the map x = √2 v/√(1 + w), of which one unit is at least √2 rad of rotation.
pub(super) struct Spread {
    cell: f64,
    cells: HashMap<[i32; 3], Vec<u32>>,
}

/// Where a quaternion with w ≥ 0 is in the map.
fn mapped(q: Quat) -> [f64; 3] {
    let scale = (2.0 / (1.0 + q.w)).sqrt();
    [q.x * scale, q.y * scale, q.z * scale]
}

/// Of q and -q the one with w ≥ 0.
pub(super) fn upper(q: Quat) -> Quat {
    if q.w < 0.0 { -q } else { q }
}

impl Spread {
    /// No rotations yet; they will be looked up within `radius`, in radians.
    pub(super) fn new(radius: f64) -> Self {
        // Less than √2, for just beyond the half turns a unit is a little less.
        Self { cell: (radius / 1.3).max(1e-6), cells: HashMap::new() }
    }

    fn key(&self, x: [f64; 3]) -> [i32; 3] {
        // The map is within a ball of radius 2, so this fits.
        x.map(|c| (c / self.cell).floor() as i32)
    }

    pub(super) fn insert(&mut self, q: Quat, index: u32) {
        let key = self.key(mapped(upper(q)));
        self.cells.entry(key).or_default().push(index);
    }

    /// Calls for all rotations that may be within the radius of `q`, and for some others; some twice.
    /// Stops where `visit` says so.
    pub(super) fn visit(&self, q: Quat, mut visit: impl FnMut(u32) -> bool) {
        let q = upper(q);
        // Near the half turns, w < the chord of the radius, what is near may be held under the other sign.
        let twice = q.w < self.cell;
        for x in [mapped(q), mapped(-q)].into_iter().take(if twice { 2 } else { 1 }) {
            let [a, b, c] = self.key(x);
            for i in a - 1..=a + 1 {
                for j in b - 1..=b + 1 {
                    for k in c - 1..=c + 1 {
                        for &index in self.cells.get(&[i, j, k]).map_or(&[][..], Vec::as_slice) {
                            if visit(index) {
                                return;
                            }
                        }
                    }
                }
            }
        }
    }
}
