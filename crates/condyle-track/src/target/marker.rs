//! Markers that should be where the recording has them: `w |e|²`, divided by the sum of weights seen.
//!
//! The markers of a rigid segment are summed into second [moments](super::moments) first, and these over
//! all segments that a [pair](super::pairs) of motions moves; those of one that deforms are taken one by
//! one.

use super::Target;
use super::moments::Moments;
use super::pairs::Pairs;
use crate::problem::{Buffers, Frame};
use crate::tracker::FIXED;
use condyle_math::Vec3;
use condyle_model::{Model, Pose, Program, SegmentId};
use condyle_solve::least_squares::LocalModel;

/// One marker of the model that should be where the recording has it.
#[derive(Clone, Debug, PartialEq)]
pub struct MarkerTarget {
    /// Position among the model's markers.
    pub marker: usize,
    /// Its weight; must be positive and finite.
    pub weight: f64,
}

/// One target with its place and the group of those on the same segment.
#[derive(Clone, Debug)]
pub(crate) struct Placed {
    pub weight: f64,
    point: Vec3,
    segment: Option<SegmentId>,
    /// Position among the groups; `None` for markers of the world, which nothing moves.
    pub group: Option<usize>,
}

impl Placed {
    /// Where the marker is in a pose.
    pub(crate) fn at(&self, pose: &Pose) -> Vec3 {
        pose.frame(self.segment) * self.point
    }

    /// Where a point of its segment is that lies off it by `offset`, in the segment's axes.
    pub(crate) fn beside(&self, pose: &Pose, offset: Vec3) -> Vec3 {
        pose.frame(self.segment) * (self.point + offset)
    }

    /// How far a point of the world lies off it, in the segment's axes; not finite where the segment
    /// is flat.
    pub(crate) fn offset_to(&self, pose: &Pose, seen: Vec3) -> Vec3 {
        let frame = pose.frame(self.segment);
        let (off, axes) = (seen - frame.translation, frame.linear);
        let rows = [axes.y.cross(axes.z), axes.z.cross(axes.x), axes.x.cross(axes.y)];
        let volume = axes.x.dot(rows[0]);
        Vec3::new(rows[0].dot(off), rows[1].dot(off), rows[2].dot(off)) * (1.0 / volume)
            - self.point
    }

    /// Whether it belongs to the world, which no coordinate moves.
    pub(crate) fn of_world(&self) -> bool {
        self.segment.is_none()
    }
}

/// The markers of one segment: which unknowns move them.
#[derive(Clone, Debug)]
pub(crate) struct Group {
    /// (unknown, twist), sorted by unknown.
    pub entries: Vec<(u32, u32)>,
    /// Whether the segment hangs below a scale or a shear, where moments do not add up.
    pub deforms: bool,
}

/// The marker targets, laid out by segment.
#[derive(Clone, Debug, Default)]
pub(crate) struct Markers {
    pub placed: Vec<Placed>,
    pub groups: Vec<Group>,
    pub pairs: Pairs,
}

impl Markers {
    /// Lays targets out for a model whose directions have these unknowns.
    pub(crate) fn new(
        targets: &[MarkerTarget],
        model: &Model,
        program: &Program,
        unknowns: &[u32],
    ) -> Self {
        let mut group_of: Vec<Option<usize>> = vec![None; model.segments().len()];
        let mut groups = vec![];
        let mut place = |target: &MarkerTarget| {
            let Some(marker) = model.markers().get(target.marker) else {
                return Placed { weight: 0.0, point: Vec3::ZERO, segment: None, group: None };
            };
            let group = marker.segment.map(|segment| {
                *group_of[segment.index()].get_or_insert_with(|| {
                    let entries = program.segment_directions(segment).iter();
                    let entries = entries.filter_map(|&(direction, twist)| {
                        let unknown = unknowns[direction as usize];
                        (unknown != FIXED).then_some((unknown, twist))
                    });
                    let deforms = program.deforms(segment);
                    groups.push(Group { entries: entries.collect(), deforms });
                    groups.len() - 1
                })
            });
            let (point, segment) = (marker.point, marker.segment);
            Placed { weight: target.weight, point, segment, group }
        };
        let placed = targets.iter().map(&mut place).collect();
        let pairs = Pairs::new(&groups, unknowns.iter().filter(|&&u| u != FIXED).count());
        Self { placed, groups, pairs }
    }
}

impl Target for Markers {
    fn value(&self, frame: &mut Frame<'_>) -> f64 {
        let Buffers { pose, weights, points, errors, .. } = &mut *frame.buffers;
        let mut sum = 0.0;
        for (i, marker) in self.placed.iter().enumerate() {
            let Some(seen) = frame.seen.get(i).copied().flatten() else { continue };
            let point = marker.at(pose);
            let error = point - Vec3::from(seen);
            points[i] = point;
            errors[i] = error;
            sum += weights[i] * error.norm_squared();
        }
        sum
    }

    fn linearise(&self, frame: &mut Frame<'_>, local: &mut LocalModel) {
        let scale = 2.0 * frame.marker_scale();
        let Buffers { jacobian, weights, points, errors, moments, summed, .. } =
            &mut *frame.buffers;
        moments.fill(Moments::ZERO);
        for (i, marker) in self.placed.iter().enumerate() {
            if let Some(group) = marker.group
                && weights[i] > 0.0
            {
                moments[group].add(weights[i], points[i], errors[i]);
            }
        }
        self.pairs.add(jacobian, moments, summed, scale, local);
        self.add_deforming(frame, local, scale);
    }
}

impl Markers {
    /// Markers of segments below a scale or a shear, one by one.
    fn add_deforming(&self, frame: &Frame<'_>, local: &mut LocalModel, scale: f64) {
        let (program, buffers) = (&frame.tracker.part, &*frame.buffers);
        let n = frame.tracker.unknown_len();
        for (i, marker) in self.placed.iter().enumerate() {
            let Some(group) = marker.group.map(|group| &self.groups[group]) else { continue };
            let weight = scale * buffers.weights[i];
            if !group.deforms || weight <= 0.0 {
                continue;
            }
            let (point, error) = (buffers.points[i], buffers.errors[i]);
            let velocity = |twist| buffers.jacobian.velocity_at(program, twist, point);
            for (position, &(row, twist)) in group.entries.iter().enumerate() {
                let along = velocity(twist) * weight;
                local.gradient[row as usize] += along.dot(error);
                let line = &mut local.hessian[row as usize * n..(row as usize + 1) * n];
                for &(column, other) in &group.entries[..=position] {
                    line[column as usize] += along.dot(velocity(other));
                }
            }
        }
    }
}
