//! Points of the figure that should be somewhere: `w |p - p*|²`, part of F.
//!
//! As markers, but with a weight of their own: they are not divided by the sum of all.

use super::Target;
use crate::problem::Frame;
use condyle_math::Vec3;
use condyle_model::SegmentId;
use condyle_solve::least_squares::LocalModel;

/// One point that should be somewhere.
#[derive(Clone, Debug, PartialEq)]
pub struct PlaceTarget {
    /// The segment that it is fixed in.
    pub segment: SegmentId,
    /// Its place in the segment, in metres.
    pub point: Vec3,
    /// Its weight, m² per m²; positive and finite.
    pub weight: f64,
    /// For each frame where it should be, in metres in the world, if that is known.
    pub wanted: Vec<Option<Vec3>>,
}

impl PlaceTarget {
    /// Where it is and the way from where it should be.
    fn off(&self, frame: &Frame<'_>) -> Option<(Vec3, Vec3)> {
        let wanted = (*self.wanted.get(frame.index)?)?;
        let place = frame.buffers.pose.segment(self.segment) * self.point;
        Some((place, place - wanted))
    }
}

impl Target for Vec<PlaceTarget> {
    fn value(&self, frame: &mut Frame<'_>) -> f64 {
        let offs = self.iter().filter_map(|t| Some((t.weight, t.off(frame)?.1)));
        offs.map(|(weight, off)| weight * off.norm_squared()).sum()
    }

    fn linearise(&self, frame: &mut Frame<'_>, local: &mut LocalModel) {
        let tracker = frame.tracker;
        let n = tracker.unknown_len();
        for target in self {
            let Some((place, off)) = target.off(frame) else { continue };
            let entries = tracker.part.segment_directions(target.segment).iter();
            let moves = || {
                entries.clone().filter_map(|&(direction, twist)| {
                    let unknown = tracker.unknowns[direction as usize] as usize;
                    let jacobian = &frame.buffers.jacobian;
                    (unknown < n)
                        .then(|| (unknown, jacobian.velocity_at(&tracker.part, twist, place)))
                })
            };
            let weight = 2.0 * target.weight;
            for (row, velocity) in moves() {
                local.gradient[row] += weight * off.dot(velocity);
                for (column, other) in moves().filter(|(column, _)| *column <= row) {
                    local.hessian[row * n + column] += weight * velocity.dot(other);
                }
            }
        }
    }
}
