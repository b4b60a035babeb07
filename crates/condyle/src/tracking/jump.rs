//! Where a segment turns more in one frame than a body does, and what is known of why.

use super::{Faulty, Swap, trust_in};
use condyle_math::{Mat3, Quat, Vec3};
use condyle_model::{CoordinateId, CoordinateKind, Mode, Pose, SegmentId};
use condyle_track::{Answers, FrameStatus, Recorded, Tracker, Trust};
use std::fmt;

/// A segment that turns by more than this from one frame to the next has jumped: 60°.
const JUMP: f64 = std::f64::consts::FRAC_PI_3;
/// A coordinate has a share in a jump if it turns by this much, 20°, or so many metres.
const SHARE: f64 = JUMP / 3.0;
const SHARE_LENGTH: f64 = 0.1;
/// A marker moves at once if it moves by more than this, in metres, and by so many times as much as in the
/// frame before.
const AT_ONCE: f64 = 0.05;
const TIMES_BEFORE: f64 = 4.0;

/// A segment with markers that turns by more than 60° from one frame to the next.
#[derive(Clone, Debug, PartialEq)]
pub struct Jump {
    /// The frame of the recording, from 0, after the jump.
    pub frame: usize,
    /// The segment that turns the most.
    pub segment: String,
    /// By how much, in radians.
    pub turn: f64,
    /// Of the coordinates that move the segment the one that turns the most, and by how much, in radians.
    pub coordinate: Option<(String, f64)>,
    /// What is known of why.
    pub cause: JumpCause,
}

/// Why a segment may have jumped; of several that hold the first.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum JumpCause {
    /// One of the two frames was not solved.
    NotSolved(FrameStatus),
    /// These labels are exchanged from here on, or up to here.
    Exchanged(Vec<String>),
    /// These labels of the segment are missing in one of the two frames, or left out as faulty.
    Missing(Vec<String>),
    /// This label of the segment moves by so many millimetres at once.
    MovesAtOnce(String, u32),
    /// These coordinates, which turn much, are held at a limit.
    AtLimit(Vec<String>),
    /// These coordinates, which turn much, are not determined by the markers.
    NotDetermined(Vec<String>),
    /// None of these.
    Unknown,
}

impl fmt::Display for Jump {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { frame, segment, turn, coordinate, cause } = self;
        write!(f, "frame {frame}: `{segment}` turns by {:.0}°", turn.to_degrees())?;
        if let Some((key, change)) = coordinate {
            write!(f, ", `{key}` by {:.0}°", change.to_degrees())?;
        }
        write!(f, " ({cause})")
    }
}

impl fmt::Display for JumpCause {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let list = |names: &[String]| {
            names.iter().map(|name| format!("`{name}`")).collect::<Vec<_>>().join(", ")
        };
        match self {
            Self::NotSolved(status) => write!(f, "a frame is not solved: {}", status.name()),
            Self::Exchanged(labels) => write!(f, "labels exchanged: {}", list(labels)),
            Self::Missing(labels) => write!(f, "not seen: {}", list(labels)),
            Self::MovesAtOnce(label, mm) => write!(f, "`{label}` moves by {mm} mm at once"),
            Self::AtLimit(keys) => write!(f, "at a limit: {}", list(keys)),
            Self::NotDetermined(keys) => write!(f, "not determined: {}", list(keys)),
            Self::Unknown => f.write_str("cause not known"),
        }
    }
}

/// What a jump is judged by.
pub(super) struct Judged<'a> {
    pub tracker: &'a Tracker,
    pub recorded: &'a dyn Recorded,
    pub answers: &'a Answers,
    /// Frame by frame.
    pub trust: &'a [Trust],
    /// Labels of the marker targets.
    pub labels: Vec<&'a str>,
    pub swaps: &'a [Swap],
    pub faulty: &'a [Faulty],
    /// The number of the first frame in the recording.
    pub first: usize,
}

impl Judged<'_> {
    /// The jumps of all frames, in order.
    pub(super) fn jumps(&self) -> Vec<Jump> {
        let (model, program) = (self.tracker.model(), self.tracker.program());
        let targets = self.tracker.targets().markers.iter();
        let mut segments: Vec<SegmentId> =
            targets.filter_map(|t| model.markers()[t.marker].segment).collect();
        segments.sort_unstable_by_key(|segment| segment.index());
        segments.dedup();
        let mut pose = Pose::new(program);
        let mut before: Vec<Mat3> = vec![];
        let mut jumps = vec![];
        for frame in 0..self.answers.len() {
            let stored = self.answers.coordinates(frame);
            if program.evaluate(stored, Mode::Open, &mut pose).is_err() {
                continue;
            }
            let now: Vec<Mat3> = segments.iter().map(|&s| pose.segment(s).linear).collect();
            let turns = before.iter().zip(&now).map(|(a, b)| turn(a, b));
            let most = turns.zip(&segments).max_by(|a, b| a.0.total_cmp(&b.0));
            if let Some((turn, &segment)) = most.filter(|(turn, _)| *turn > JUMP) {
                jumps.push(self.jump(frame, segment, turn));
            }
            before = now;
        }
        jumps
    }

    fn jump(&self, frame: usize, segment: SegmentId, turn: f64) -> Jump {
        let model = self.tracker.model();
        let changes = self.changes(frame, segment);
        let turns = changes.iter().filter(|(id, _)| turns(model.coordinate(*id).kind));
        let most = turns.max_by(|a, b| a.1.abs().total_cmp(&b.1.abs()));
        Jump {
            frame: self.first + frame,
            segment: model.segment(segment).name.clone(),
            turn,
            coordinate: most.map(|&(id, change)| (model.coordinate_key(id), change)),
            cause: self.cause(frame, segment, &changes),
        }
    }

    /// The coordinates that move a segment, each with its change since the frame before.
    fn changes(&self, frame: usize, segment: SegmentId) -> Vec<(CoordinateId, f64)> {
        let model = self.tracker.model();
        let directions = self.tracker.program().segment_directions(segment);
        let moves = |id: &CoordinateId| {
            let own = model.tangent_range(*id);
            directions.iter().any(|(direction, _)| own.contains(&(*direction as usize)))
        };
        let change = |id: CoordinateId| {
            let place = model.stored_range(id);
            let [a, b] = [frame - 1, frame].map(|f| &self.answers.coordinates(f)[place.clone()]);
            match (model.coordinate(id).kind, a, b) {
                (CoordinateKind::Orientation, &[a, b, c, d], &[e, f, g, h]) => {
                    Quat::from([a, b, c, d]).angle_to(Quat::from([e, f, g, h]))
                }
                _ => b[0] - a[0],
            }
        };
        model.coordinate_ids().filter(moves).map(|id| (id, change(id))).collect()
    }

    fn cause(
        &self,
        frame: usize,
        segment: SegmentId,
        changes: &[(CoordinateId, f64)],
    ) -> JumpCause {
        let both = [frame - 1, frame];
        let unsolved = both.map(|f| self.answers.at(f).status).into_iter().find(|s| !s.is_solved());
        if let Some(status) = unsolved {
            return JumpCause::NotSolved(status);
        }
        let model = self.tracker.model();
        let targets = self.tracker.targets().markers.iter().enumerate();
        let own = targets.filter(|(_, t)| model.markers()[t.marker].segment == Some(segment));
        let own: Vec<usize> = own.map(|(target, _)| target).collect();
        let is_own = |label: &String| own.iter().any(|&target| self.labels[target] == label);
        let here = self.first + frame;
        let swap = self.swaps.iter().find(|swap| {
            let edge = swap.frames.start == here || swap.frames.end == here;
            edge && swap.labels.iter().any(is_own)
        });
        if let Some(swap) = swap {
            return JumpCause::Exchanged(swap.labels.clone());
        }
        let mut seen = [vec![], vec![], vec![]];
        for (seen, f) in seen.iter_mut().zip([frame.saturating_sub(2), frame - 1, frame]) {
            self.recorded.positions(f, seen);
        }
        let place =
            |at: usize, target: usize| seen[at].get(target).copied().flatten().map(Vec3::from);
        let left_out = |target: usize| {
            let of = |faulty: &&Faulty| faulty.label == self.labels[target];
            let mut faulty = self.faulty.iter().filter(of).filter(|f| f.fault.is_left_out());
            faulty.any(|f| f.frames.contains(&here) || f.frames.contains(&(here - 1)))
        };
        let missing = own.iter().filter(|&&target| {
            place(1, target).is_none() || place(2, target).is_none() || left_out(target)
        });
        let missing: Vec<String> = missing.map(|&t| self.labels[t].to_owned()).collect();
        if !missing.is_empty() {
            return JumpCause::Missing(missing);
        }
        let at_once = own.iter().filter_map(|&target| {
            let [a, b, c] = [0, 1, 2].map(|at| place(at, target));
            let moved = (c? - b?).norm();
            let before = a.zip(b).map_or(0.0, |(a, b)| (b - a).norm());
            (moved > AT_ONCE && moved > TIMES_BEFORE * before).then_some((target, moved))
        });
        if let Some((target, moved)) = at_once.max_by(|a, b| a.1.total_cmp(&b.1)) {
            let millimetres = (1e3 * moved).round() as u32;
            return JumpCause::MovesAtOnce(self.labels[target].to_owned(), millimetres);
        }
        let with = |kinds: &[Trust]| -> Vec<String> {
            let much = changes.iter().filter(|(id, change)| {
                let least = if turns(model.coordinate(*id).kind) { SHARE } else { SHARE_LENGTH };
                change.abs() > least
            });
            let such = much.filter(|(id, _)| {
                both.iter().any(|&f| {
                    let trust = trust_in(self.trust, self.answers.len(), f);
                    trust.get(id.index()).is_some_and(|trust| kinds.contains(trust))
                })
            });
            such.map(|(id, _)| model.coordinate_key(*id)).collect()
        };
        let [at_limit, unsure] = [with(&[Trust::AtLimit]), with(&[Trust::Held, Trust::Weak])];
        match (at_limit.is_empty(), unsure.is_empty()) {
            (false, _) => JumpCause::AtLimit(at_limit),
            (true, false) => JumpCause::NotDetermined(unsure),
            (true, true) => JumpCause::Unknown,
        }
    }
}

fn turns(kind: CoordinateKind) -> bool {
    matches!(kind, CoordinateKind::Rotation | CoordinateKind::Orientation)
}

/// The angle between two rotations, from the trace 1 + 2 cos of their difference.
fn turn(a: &Mat3, b: &Mat3) -> f64 {
    let trace = a.x.dot(b.x) + a.y.dot(b.y) + a.z.dot(b.z);
    (0.5 * (trace - 1.0)).clamp(-1.0, 1.0).acos()
}

#[cfg(test)]
mod tests {
    use super::*;
    use condyle_model::{Model, ModelBuilder};
    use condyle_track::robust::Fault;
    use condyle_track::{FrameAnswer, MarkerTarget, Rules, Targets};

    /// A hinge with three markers.
    fn hinge() -> Model {
        let mut b = ModelBuilder::new("arm");
        let arm = b.segment("arm", None);
        b.hinge("elbow", arm, "angle", Vec3::Z);
        for (name, at) in [("a", Vec3::X), ("b", Vec3::Y), ("c", -Vec3::X)] {
            b.marker(name, Some(arm), at);
        }
        b.build().unwrap()
    }

    /// The only jump of three frames, the last of which is turned by 1.5 rad, where the markers move with the
    /// arm, or stay, and some are not seen in the last.
    fn jump(
        status: FrameStatus,
        trust: Trust,
        moving: bool,
        hidden: &[usize],
        swaps: &[Swap],
        faulty: &[Faulty],
    ) -> Jump {
        let targets = (0..3).map(|marker| MarkerTarget { marker, weight: 1.0 });
        let targets = Targets { markers: targets.collect(), ..Targets::default() };
        let tracker = Tracker::new(hinge(), targets, Rules::default());
        let answer = |angle: f64, status| FrameAnswer { status, ..FrameAnswer::start(&[angle]) };
        let solved = FrameStatus::Solved;
        let answers = [answer(0.0, solved), answer(0.1, solved), answer(1.6, status)];
        let recorded = |frame: usize, seen: &mut Vec<Option<[f64; 3]>>| {
            let angle = if moving { answers[frame].coordinates[0] } else { 0.0 };
            let (s, c) = angle.sin_cos();
            let places = [[c, s, 0.0], [-s, c, 0.0], [-c, -s, 0.0]].into_iter().enumerate();
            seen.clear();
            seen.extend(places.map(|(i, p)| (frame < 2 || !hidden.contains(&i)).then_some(p)));
        };
        let judged = Judged {
            tracker: &tracker,
            recorded: &recorded,
            answers: &Answers::from(&answers[..]),
            trust: &[Trust::Determined, Trust::Determined, trust],
            labels: vec!["A", "B", "C"],
            swaps,
            faulty,
            first: 10,
        };
        let jumps = judged.jumps();
        assert_eq!(jumps.len(), 1);
        jumps.into_iter().next().unwrap()
    }

    #[test]
    fn a_jump_names_what_turned_and_the_likeliest_cause() {
        let (solved, sure) = (FrameStatus::Solved, Trust::Determined);
        let found = jump(solved, sure, false, &[], &[], &[]);
        assert_eq!((found.frame, &*found.segment), (12, "arm"));
        // From 0.1 to 1.6 rad.
        assert!((found.turn - 1.5).abs() < 1e-9);
        assert_eq!(found.coordinate, Some(("angle".to_owned(), 1.5)));
        assert_eq!(found.cause, JumpCause::Unknown);
        assert_eq!(
            found.to_string(),
            "frame 12: `arm` turns by 86°, `angle` by 86° (cause not known)"
        );
        let cause = |status, trust, moving, hidden: &[usize], swaps: &[Swap], faulty: &[Faulty]| {
            jump(status, trust, moving, hidden, swaps, faulty).cause
        };
        let lost = FrameStatus::Uncertain;
        let angle = vec!["angle".to_owned()];
        assert_eq!(cause(lost, sure, true, &[1], &[], &[]), JumpCause::NotSolved(lost));
        let b = JumpCause::Missing(vec!["B".to_owned()]);
        assert_eq!(cause(solved, Trust::Held, true, &[1], &[], &[]), b);
        // A chord of 1.5 rad at 1 m: 2 sin 0.75 = 1.3633 m.
        let at_once = cause(solved, Trust::Held, true, &[], &[], &[]);
        assert!(matches!(at_once, JumpCause::MovesAtOnce(_, 1363)), "{at_once}");
        let held = JumpCause::NotDetermined(angle.clone());
        assert_eq!(cause(solved, Trust::Weak, false, &[], &[], &[]), held);
        let limit = JumpCause::AtLimit(angle);
        assert_eq!(cause(solved, Trust::AtLimit, false, &[], &[], &[]), limit);
        let swap = |frames| Swap { labels: vec!["B".into(), "X".into()], frames };
        let swapped = JumpCause::Exchanged(vec!["B".into(), "X".into()]);
        assert_eq!(cause(solved, sure, true, &[1], &[swap(12..20)], &[]), swapped);
        assert_eq!(cause(solved, sure, false, &[], &[swap(3..12)], &[]), swapped);
        assert_eq!(cause(solved, sure, false, &[], &[swap(3..11)], &[]), JumpCause::Unknown);
        let ghost = |frames| Faulty { label: "B".into(), frames, fault: Fault::Elsewhere };
        assert_eq!(cause(solved, sure, false, &[], &[], &[ghost(12..13)]), b);
    }
}
