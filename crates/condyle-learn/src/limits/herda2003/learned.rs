//! A limit of spheres as files hold it.

use super::SphereLimit;
use crate::limits::field::About;
use crate::limits::uniform;
use condyle_math::Quat;

/// Spheres, whose rotation they limit, and the samples that they were fitted to.
#[derive(Clone, Debug, PartialEq)]
pub struct LearnedSpheres {
    /// What people want to know of it.
    pub about: About,
    /// The spheres.
    pub limit: SphereLimit,
    /// The rotations that they were fitted to, as files hold them.
    pub samples: Vec<Quat>,
    /// How many of them, in their order, are from each take.
    pub takes: Vec<u32>,
    /// The least angle between two of them that was asked for, in radians.
    pub thinned: f64,
}

impl LearnedSpheres {
    /// The share of all rotations that is possible, to about a thousandth.
    #[must_use]
    pub fn share(&self) -> f64 {
        let count = 100_000;
        let inside = uniform(count).filter(|q| self.limit.allows(*q)).count();
        inside as f64 / count as f64
    }

    /// The angle from a rotation to the nearest sample, in radians; half a turn without samples.
    #[must_use]
    pub fn nearest_sample(&self, q: Quat) -> f64 {
        let cosine = self.samples.iter().map(|p| q.dot(*p).abs()).fold(0.0, f64::max);
        2.0 * cosine.clamp(0.0, 1.0).acos()
    }
}
