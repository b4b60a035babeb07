//! A field as rotations that are inside and outside.

use crate::limits::{Field, uniform};
use condyle_math::{Quat, Vec3};

/// A rotation of a region.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Place {
    pub(super) rotation: Quat,
    /// Signed distance to the boundary in radians, positive inside.
    pub(super) distance: f64,
    /// For how many even rotations it stands.
    pub(super) weight: f64,
}

/// What is inside of a limit and what outside, by even rotations with their signed distances.
///
/// Two sets: one to fit to, one that fits do not see, to tell what they lose.
#[derive(Clone, Debug)]
pub struct Region {
    /// For fits: all that is inside or near, others thinned.
    pub(super) fitted: Vec<Place>,
    /// For losses: all.
    pub(super) judged: Vec<(Quat, f64)>,
    /// The share of all rotations that is inside.
    pub(super) share: f64,
    /// The deepest of the first set and how deep it is.
    pub(super) deepest: (f64, Quat),
}

/// Rotations inside to fit to, and to judge by.
const FITTED: f64 = 5000.0;
const JUDGED: f64 = 20_000.0;
/// At most so many even rotations, and at least.
const MOST: f64 = 1_500_000.0;
const LEAST: f64 = 40_000.0;
/// Of what is farther outside than this only every so many are fitted to, in radians.
const FAR: f64 = 0.35;
const THINNED: usize = 6;

impl Region {
    /// Of a learned field; its holes are outside.
    #[must_use]
    pub fn of(field: &Field) -> Self {
        Self::new(&|q| field.distance(q))
    }

    /// Of a signed distance in radians, positive inside.
    #[must_use]
    pub fn new(distance: &dyn Fn(Quat) -> f64) -> Self {
        let few = uniform(20_000).filter(|q| distance(*q) >= 0.0).count();
        let share = (few as f64 / 20_000.0).max(2e-4);
        let count = |inside: f64| (inside / share).clamp(LEAST, MOST) as usize;
        let mut fitted = vec![];
        let (mut far, mut deepest) = (0, (f64::NEG_INFINITY, Quat::IDENTITY));
        for rotation in uniform(count(FITTED)) {
            let distance = distance(rotation);
            if distance > deepest.0 {
                deepest = (distance, rotation);
            }
            let mut weight = 1.0;
            if distance < -FAR {
                far += 1;
                if far % THINNED != 0 {
                    continue;
                }
                weight = THINNED as f64;
            }
            fitted.push(Place { rotation, distance, weight });
        }
        // Other rotations than those of the fit: turned by some amount that is no fraction of theirs.
        let turn = Quat::exp(Vec3::new(0.7, -1.1, 0.4));
        let judged: Vec<(Quat, f64)> = uniform(count(JUDGED))
            .map(|q| turn * q)
            .map(|rotation| (rotation, distance(rotation)))
            .collect();
        let inside = judged.iter().filter(|(_, d)| *d >= 0.0).count();
        let share = inside as f64 / judged.len() as f64;
        Self { fitted, judged, share, deepest }
    }

    /// The share of all rotations that is inside.
    #[must_use]
    pub fn share(&self) -> f64 {
        self.share
    }
}
