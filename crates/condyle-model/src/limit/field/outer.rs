//! The outer boundary alone: what is neither known to be possible nor outside counts as inside.

use super::{Field, projection};
use condyle_math::{Quat, Vec3};

impl Field {
    /// The signed distance to the outer boundary, in radians: positive in holes, too.
    #[inline]
    #[must_use]
    pub fn outer_distance(&self, q: Quat) -> f64 {
        self.lattice.value(&self.outer, self.chart.inward(q))
    }

    /// The same with its slope, as [`Field::distance_and_gradient`] has it.
    #[inline]
    #[must_use]
    pub fn outer_distance_and_gradient(&self, q: Quat) -> (f64, Vec3) {
        let q = self.chart.inward(q);
        let (distance, g) = self.lattice.value_and_slope(&self.outer, q);
        (distance, self.chart.tangent_outward(projection::tangent(q, g)))
    }

    /// The nearest rotation that is not outside, as [`Field::nearest`] has it: itself in a hole.
    #[must_use]
    pub fn outer_nearest(&self, q: Quat) -> Quat {
        let inward = self.chart.inward(q);
        let distance = self.lattice.value(&self.outer, inward);
        self.projected_on(&self.outer, q, inward, distance)
    }
}
