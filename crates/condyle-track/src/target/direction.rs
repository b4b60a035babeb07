//! Lines between two points of the figure that should point somewhere: `w |d - v|²`, part of F.
//!
//! With a and b the two points in the world, d = (b - a)/|b - a| is where the line points and v where it
//! should, both of length 1, so that |d - v| = 2 sin(θ/2) for the angle θ between them. With the
//! velocities u of the points along a direction, ∂d = (I - d dᵀ)(u_b - u_a)/|b - a|. The points may be
//! on segments that glide or are many joints apart: a forearm from elbow to wrist, a trunk from the hips to
//! the neck.

use super::Target;
use crate::problem::{Buffers, Frame};
use condyle_math::Vec3;
use condyle_model::SegmentId;
use condyle_solve::least_squares::LocalModel;

/// One line that should point somewhere.
#[derive(Clone, Debug, PartialEq)]
pub struct DirectionTarget {
    /// Where it begins: a segment, and a point of it in metres.
    pub from: (SegmentId, Vec3),
    /// Where it ends.
    pub to: (SegmentId, Vec3),
    /// Its weight, m² per rad²; positive and finite.
    pub weight: f64,
    /// For each frame where it should point, of length 1 in the world, if that is known.
    pub wanted: Vec<Option<Vec3>>,
}

/// A line shorter than this, in metres, points nowhere.
const SHORTEST: f64 = 1e-9;

/// A line of the pose that was evaluated last.
struct Line {
    ends: [Vec3; 2],
    direction: Vec3,
    length: f64,
    off: Vec3,
}

impl DirectionTarget {
    fn line(&self, frame: &Frame<'_>) -> Option<Line> {
        let wanted = (*self.wanted.get(frame.index)?)?;
        let pose = &frame.buffers.pose;
        let ends = [self.from, self.to].map(|(segment, point)| pose.segment(segment) * point);
        let along = ends[1] - ends[0];
        let length = along.norm();
        if length < SHORTEST {
            return None;
        }
        let direction = along * (1.0 / length);
        Some(Line { ends, direction, length, off: direction - wanted })
    }
}

impl Target for Vec<DirectionTarget> {
    fn value(&self, frame: &mut Frame<'_>) -> f64 {
        let lines = self.iter().filter_map(|t| Some((t.weight, t.line(frame)?)));
        lines.map(|(weight, line)| weight * line.off.norm_squared()).sum()
    }

    fn linearise(&self, frame: &mut Frame<'_>, local: &mut LocalModel) {
        let tracker = frame.tracker;
        let n = tracker.unknown_len();
        for target in self {
            let Some(line) = target.line(frame) else { continue };
            let Buffers { jacobian, velocities, touched, .. } = &mut *frame.buffers;
            touched.clear();
            for ((segment, end), sign) in [(target.from.0, -1.0), (target.to.0, 1.0)]
                .into_iter()
                .zip([0, 1])
                .map(|((segment, sign), end)| ((segment, line.ends[end]), sign))
            {
                for &(direction, twist) in tracker.part.segment_directions(segment) {
                    let unknown = tracker.unknowns[direction as usize];
                    if unknown as usize >= n {
                        continue;
                    }
                    let moved = jacobian.velocity_at(&tracker.part, twist, end) * sign;
                    match &mut velocities[unknown as usize] {
                        Some(velocity) => *velocity += moved,
                        place => {
                            *place = Some(moved);
                            touched.push(unknown);
                        }
                    }
                }
            }
            let (d, scale) = (line.direction, 1.0 / line.length);
            for &unknown in &*touched {
                if let Some(velocity) = &mut velocities[unknown as usize] {
                    *velocity = (*velocity - d * d.dot(*velocity)) * scale;
                }
            }
            let weight = 2.0 * target.weight;
            for &row in &*touched {
                let Some(slope) = velocities[row as usize] else { continue };
                local.gradient[row as usize] += weight * line.off.dot(slope);
                for &column in touched.iter().filter(|&&column| column <= row) {
                    if let Some(other) = velocities[column as usize] {
                        local.hessian[row as usize * n + column as usize] +=
                            weight * slope.dot(other);
                    }
                }
            }
            touched.iter().for_each(|&unknown| velocities[unknown as usize] = None);
        }
    }
}
