//! Sudden changes of rotations from frame to frame, judged by how far the segments turn.
//!
//! Near a gimbal lock, and where an angle passes half a turn, angles change by a lot while the posture goes
//! on: such changes are told apart from those of the posture.

use super::MotionCheck;
use crate::{finding, rounded};
use condyle_diagnostics::{Diagnostic, Severity, Subject};
use condyle_math::{Mat3, Quat};
use condyle_model::{CoordinateId, CoordinateKind, Model, Pose, Program, SegmentId};
use std::f64::consts::{PI, TAU};

/// A rotation by more than this from one frame to the next is reported as a jump.
const JUMP: f64 = PI / 3.0;

/// A rotation that changes by more than 60° from one frame to the next.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Jump {
    /// The coordinate.
    pub coordinate: CoordinateId,
    /// The frame after the jump.
    pub frame: usize,
    /// Its time in seconds.
    pub time: f64,
    /// The change in radians.
    pub by: f64,
    /// By how much the segment that it moves turns in its parent meanwhile, in radians: less where several
    /// angles change together without much motion.
    pub turned: f64,
    /// Whether it is a whole number of turns, so that the posture hardly changes.
    pub wrap: bool,
}

/// What a sudden change of an angle is.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Leap {
    /// The segment turns that much.
    Jump,
    /// A whole turn.
    Wrap,
    /// Several angles change together, and the segment hardly turns.
    Rename,
}

impl Jump {
    fn leap(&self) -> Leap {
        match (self.wrap, self.turned > JUMP) {
            (true, _) => Leap::Wrap,
            (false, true) => Leap::Jump,
            (false, false) => Leap::Rename,
        }
    }
}

/// By how much segments turn in their parents from one frame to the next.
pub(super) struct Turned<'m> {
    model: &'m Model,
    /// For each coordinate the segments that it moves in their parents: those of its joint set.
    moved: Vec<Vec<SegmentId>>,
    /// The rotations of the last two frames.
    rotations: [Vec<Mat3>; 2],
}

impl<'m> Turned<'m> {
    pub(super) fn new(model: &'m Model, program: &Program) -> Self {
        let moved = |id: CoordinateId| {
            let along = model.tangent_range(id);
            let moves = |segment: &SegmentId| {
                let own = |s: SegmentId| {
                    let directions = program.segment_directions(s).iter();
                    directions.map(|(d, _)| *d as usize).filter(|d| along.contains(d)).count()
                };
                let parent = model.segment(*segment).parent.map_or(0, own);
                // A parent that it moves as well hands its motion on; the joint itself decides.
                own(*segment) > 0
                    && (parent == 0
                        || model.segment(*segment).joint_set
                            == Some(model.coordinate(id).joint_set))
            };
            model.segment_ids().filter(moves).collect()
        };
        let moved = model.coordinate_ids().map(moved).collect();
        Self { model, moved, rotations: [vec![], vec![]] }
    }

    pub(super) fn frame(&mut self, pose: &Pose) {
        self.rotations.swap(0, 1);
        let turn = |id| pose.segment_in_parent(self.model, id).linear;
        self.rotations[1] = self.model.segment_ids().map(turn).collect();
    }

    /// The largest turn of the segments that a coordinate moves.
    fn of(&self, id: CoordinateId) -> f64 {
        let [before, now] = &self.rotations;
        let turn = |segment: &SegmentId| {
            let at = segment.index();
            let (Some(before), Some(now)) = (before.get(at), now.get(at)) else { return 0.0 };
            Quat::from_mat3(*before).normalized().angle_to(Quat::from_mat3(*now).normalized())
        };
        self.moved[id.index()].iter().map(turn).fold(0.0, f64::max)
    }
}

impl MotionCheck {
    pub(super) fn jump(
        &mut self,
        model: &Model,
        id: CoordinateId,
        frame: usize,
        time: f64,
        [before, now]: [&[f64]; 2],
        turned: &Turned<'_>,
    ) {
        let place = model.stored_range(id);
        let by = match model.coordinate(id).kind {
            CoordinateKind::Rotation => now[place.start] - before[place.start],
            CoordinateKind::Orientation => {
                let quat = |stored: &[f64]| {
                    let q: [f64; 4] = std::array::from_fn(|i| stored[place.start + i]);
                    Quat::from(q).normalized()
                };
                quat(before).angle_to(quat(now))
            }
            _ => return,
        };
        if by.is_finite() && by.abs() > JUMP {
            let turns = (by / TAU).round();
            let wrap = turns != 0.0 && (by - turns * TAU).abs() < JUMP;
            let turned = turned.of(id);
            self.jumps.push(Jump { coordinate: id, frame, time, by, turned, wrap });
        }
    }

    pub(super) fn say_jumps(&self, model: &Model, findings: &mut Vec<Diagnostic>) {
        let degrees = |radians: f64| format!("{}°", rounded(radians.to_degrees(), 1));
        for id in model.coordinate_ids() {
            // What is judged is how far the segment turns, not what its angles are called.
            for kind in [Leap::Jump, Leap::Wrap, Leap::Rename] {
                let own = || self.jumps.iter().filter(|j| j.coordinate == id && j.leap() == kind);
                let size = |j: &Jump| if kind == Leap::Jump { j.turned } else { j.by.abs() };
                let Some(worst) = own().max_by(|a, b| size(a).total_cmp(&size(b))) else {
                    continue;
                };
                let key = model.coordinate_key(id);
                let count = own().count();
                let times = if count == 1 { "once".to_owned() } else { format!("{count} times") };
                let at = format!("most at frame {} ({} s)", worst.frame, rounded(worst.time, 4));
                let (by, turned) = (degrees(worst.by), degrees(worst.turned));
                let (severity, code, message, help) = match kind {
                    Leap::Jump => (
                        Severity::Warning,
                        "motion/jump",
                        format!(
                            "`{key}` jumps {times}; {at}, by {by}: its segment turns by {turned}"
                        ),
                        "a turn by 60° in one frame is implausible: is a frame missing?",
                    ),
                    Leap::Wrap => (
                        Severity::Warning,
                        "motion/wrap",
                        format!("`{key}` wraps around {times}; {at}, by {by}"),
                        "add or subtract 360° to make it continuous",
                    ),
                    Leap::Rename => (
                        Severity::Note,
                        "motion/renamed",
                        format!(
                            "`{key}` changes abruptly {times}; {at}, by {by}, while its segment turns by {turned}"
                        ),
                        "the posture goes on: near a gimbal lock other angles name it",
                    ),
                };
                findings.push(finding(severity, code, [Subject::Coordinate(key)], message, help));
            }
        }
    }

    /// Leaves out what is said of changes from frame to frame: the frames are separate poses.
    pub fn forget_jumps(&mut self) {
        self.jumps.clear();
        self.findings
            .retain(|f| !matches!(f.code, "motion/jump" | "motion/wrap" | "motion/renamed"));
    }
}
