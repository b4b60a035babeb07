//! Whether a tracking can be what happened, and if not, why: likely causes are tried.
//!
//! A cause is a change to the recording. A few frames, spread over the trial, are tracked from first
//! guesses with that change, and compared with the trial's answers for the same frames.
//!
//! That costs as much as hundreds of frames, and a trial that fits is not asked. Where the fit is worse
//! than [`WORTH_TRYING`] or that share of the body's size, a cause is tried if it makes the markers at least
//! as like those of the model at rest as they were ([`Cloud::likeness`]: what is mirrored, or has its sides
//! exchanged, is less like them); where it is worse than half of that, if it makes them clearly more alike;
//! where it is worse than the bound, always.

use super::cloud::{Cloud, Direction};
use super::variant::axis_name;
use super::{Tracking, Variant, sides};
use condyle_diagnostics::Diagnostic;
use condyle_math::Vec3;
use condyle_model::{CoordinateId, CoordinateKind, Mode, Pose, SegmentId, UpAxis};
use condyle_motion::{Observed, Recording};
use condyle_track::{FrameAnswer, Rules, Scratch, Tracker};
use std::ops::Range;
use std::sync::Arc;

mod labels;

/// Whether a trial's fit can be believed.
#[derive(Clone, Debug, PartialEq)]
pub struct Verdict {
    /// Whether the marker error is within [`Request::max_rms`](super::Request::max_rms), and no cause
    /// that was tried halves it.
    pub plausible: bool,
    /// What is probably the matter, where the fit is not plausible.
    pub cause: Option<Diagnostic>,
    /// The change to the recording that puts it right, where one does.
    pub remedy: Option<Variant>,
}

impl Verdict {
    /// Nothing speaks against it.
    pub const PLAUSIBLE: Self = Self { plausible: true, cause: None, remedy: None };

    fn because(cause: Diagnostic, remedy: Option<Variant>) -> Self {
        Self { plausible: false, cause: Some(cause), remedy }
    }
}

/// A fit is looked into from this RMS on, in metres, or from this share of the size of the body.
const WORTH_TRYING: f64 = 0.025;
const SHARE_OF_SIZE: f64 = 0.02;
/// How much more like the model at rest a cause must make the markers to be tried.
const AS_LIKE: f64 = -0.002;
const MORE_LIKE: f64 = 0.01;
/// How many frames are tried.
const FRAMES: usize = 12;
/// How many of them, those that fit worst, are tried before a cause without promise is given up.
const FIRST_FRAMES: usize = 3;
/// What lowers the error of the first frames to less than this share has promise.
const PROMISE: f64 = 0.75;
/// A cause lowers the error to at most this share.
const HALF: f64 = 0.5;
/// First guesses of each frame.
const GUESSES: usize = 4;
/// Another cause is named, too, where its error is less than so many times that of the best.
const AS_GOOD: f64 = 1.5;
/// Causes are tried at this tolerance of the solver: their errors are compared by halves.
const ROUGHLY: f64 = 1e-3;

/// The power of ten by which the lengths of a recording must be multiplied to be those of a body, as far
/// as that can be told from how far its markers are apart in a few frames; 0 where they are right.
pub(super) fn power_of_unit(
    tracker: &Tracker,
    recording: &Recording,
    frames: Range<usize>,
    labels: &[usize],
) -> i32 {
    let mut pose = Pose::new(tracker.program());
    let Some(places) = places(tracker, &tracker.model().defaults(), &mut pose) else { return 0 };
    let count = FRAMES.min(frames.len());
    let mut cloud = Cloud::default();
    for number in 0..count {
        let seen = recording.frame(frames.start + (2 * number + 1) * frames.len() / (2 * count));
        cloud += Cloud::of(seen_of(&places, labels, seen));
    }
    power_of(&cloud)
}

/// Pairs of a place at rest and where the marker was seen.
fn seen_of<'a>(
    places: &'a [Vec3],
    labels: &'a [usize],
    seen: &'a [Observed],
) -> impl Iterator<Item = (Vec3, Vec3)> + Clone + 'a {
    places
        .iter()
        .zip(labels)
        .filter_map(|(&place, &label)| Some((place, Vec3::from(seen.get(label)?.position()?))))
}

/// The power of ten that brings a cloud to the size of that at rest; 0 where that is beyond a million.
fn power_of(cloud: &Cloud) -> i32 {
    let power = cloud.ratio().map_or(0.0, |ratio| -ratio.log10().round());
    if power.abs() <= 6.0 { power as i32 } else { 0 }
}

/// Judges a tracking of a recording; warnings are about what is odd, but fits.
pub(super) fn judge(
    tracker: &Tracker,
    rules: Rules,
    recording: &Recording,
    tracking: &Tracking,
    max_rms: f64,
) -> (Verdict, Vec<Diagnostic>) {
    let rms = tracking.summary().rms;
    if let Some(why) = nothing_moves(tracker)
        && rms > 1e-3
    {
        return (Verdict::because(why, None), vec![]);
    }
    let Some(mut trial) = Trial::new(tracker, rules, recording, tracking) else {
        return (bound(tracking, rms, max_rms), vec![]);
    };
    let upward = trial.upward();
    let worth = WORTH_TRYING.min(SHARE_OF_SIZE * trial.size);
    let mut tried = match rms {
        _ if rms > max_rms => trial.try_causes(upward, f64::NEG_INFINITY),
        _ if rms > worth => trial.try_causes(upward, AS_LIKE),
        _ if rms > 0.5 * worth => trial.try_causes(upward, MORE_LIKE),
        _ => vec![],
    };
    let base = trial.rms();
    let least = |tried: &[(Variant, f64)]| tried.first().map_or(f64::INFINITY, |(_, rms)| *rms);
    if rms > max_rms && least(&tried) > PROMISE * base {
        tried = trial.permuted().into_iter().collect();
    }
    let least = least(&tried);
    if least <= HALF * base || (rms > max_rms && least <= PROMISE * base) {
        let cause = Diagnostic::error("track/implausible", trial.compared(&tried));
        let remedy = tried.into_iter().next().map(|(cause, _)| cause);
        return (Verdict::because(cause.with_help("nothing was changed"), remedy), vec![]);
    }
    let mut odd: Vec<Diagnostic> = vec![];
    if rms > worth {
        odd.extend(trial.exchanged());
    }
    if least <= PROMISE * base {
        let message = format!("perhaps {}", trial.compared(&tried));
        odd.push(Diagnostic::warning("track/perhaps", message));
    } else {
        odd.extend(upward.and_then(|direction| trial.lying(direction)));
    }
    (bound(tracking, rms, max_rms), odd)
}

/// The verdict by the bound alone, where no cause is known.
fn bound(tracking: &Tracking, rms: f64, max_rms: f64) -> Verdict {
    if rms <= max_rms {
        return Verdict::PLAUSIBLE;
    }
    let mut worst = tracking.marker_errors();
    worst.sort_by(|a, b| b.rms.total_cmp(&a.rms));
    let worst = worst.iter().take(3).map(|m| format!("`{}` ({:.0} mm)", m.name, 1e3 * m.rms));
    let message = format!(
        "the marker error is {:.1} mm RMS, more than {:.0} mm, for none of the reasons tried; farthest \
         off are {}",
        1e3 * rms,
        1e3 * max_rms,
        worst.collect::<Vec<_>>().join(", ")
    );
    let help = "does the model belong to this person, and do its markers sit where they sat?";
    Verdict::because(Diagnostic::error("track/bad-fit", message).with_help(help), None)
}

/// Why no marker that is tracked can move, if none can.
fn nothing_moves(tracker: &Tracker) -> Option<Diagnostic> {
    let (model, program) = (tracker.model(), tracker.program());
    let free = |id: &CoordinateId| {
        let coordinate = model.coordinate(*id);
        !coordinate.locked && coordinate.follows.is_none()
    };
    let free: Vec<_> = model.coordinate_ids().filter(free).collect();
    if free.is_empty() {
        let said = match model.coordinates().is_empty() {
            true => "nothing can move: the model has no coordinates",
            false => "nothing can move: every coordinate of the model is locked",
        };
        return Some(Diagnostic::error("track/nothing-moves", said).with_help("unlock some"));
    }
    let moves = |direction: u32| {
        free.iter().any(|&id| model.tangent_range(id).contains(&(direction as usize)))
    };
    let markers = || tracker.targets().markers.iter().map(|t| &model.markers()[t.marker]);
    let carried = |segment| program.segment_directions(segment).iter().any(|(d, _)| moves(*d));
    if markers().any(|m| m.segment.is_some_and(carried)) {
        return None;
    }
    let said = match markers().all(|m| m.segment.is_none()) {
        true => "nothing can move: all markers of the model that are tracked lie on the ground",
        false => "nothing can move: no free coordinate moves a marker that is tracked",
    };
    let help = "fix the markers in the segments that carry them";
    Some(Diagnostic::error("track/nothing-moves", said).with_help(help))
}

/// A few frames of a tracking, for trying causes on.
struct Trial<'a> {
    tracker: &'a Tracker,
    rules: Rules,
    /// The same at a rough tolerance, made when a frame is first tried.
    rough: Option<(Tracker, Scratch)>,
    /// For each marker target its label in the recording.
    labels: &'a [usize],
    /// The frames, with all labels, and their numbers among those tracked.
    sample: Recording,
    numbers: Vec<usize>,
    answers: Vec<FrameAnswer>,
    /// Names of the marker targets, and their places at rest.
    names: &'a [String],
    places: Vec<Vec3>,
    pose: Pose,
    /// How far the markers are apart at rest, in metres.
    size: f64,
}

impl<'a> Trial<'a> {
    /// Frames spread over a tracking, of those that see at least half as many markers as the best.
    fn new(
        tracker: &'a Tracker,
        rules: Rules,
        recording: &Recording,
        tracking: &'a Tracking,
    ) -> Option<Self> {
        let errors = |frame: usize| tracking.answers.marker_errors(frame).iter();
        let seen = |frame: usize| errors(frame).filter(|e| e.is_finite()).count();
        let frames = 0..tracking.answers.len();
        let most = frames.clone().map(seen).max()?;
        let good = || frames.clone().filter(|&frame| 2 * seen(frame) >= most.max(1));
        let of = good().count();
        let count = FRAMES.min(of);
        let at = |i: usize| (2 * i + 1) * of / (2 * count);
        let mut wanted = (0..count).map(at).peekable();
        let picked = good().enumerate().filter(|(place, _)| wanted.next_if_eq(place).is_some());
        let numbers: Vec<usize> = picked.map(|(_, frame)| frame).collect();
        if numbers.is_empty() {
            return None;
        }
        let frame = |&number: &usize| tracking.frames.start + number;
        let sample = Recording {
            labels: recording.labels.clone(),
            rate: recording.rate,
            times: numbers.iter().map(|n| tracking.times[*n]).collect(),
            positions: numbers.iter().flat_map(|n| recording.frame(frame(n)).to_vec()).collect(),
            units: recording.units,
            confidences: None,
        };
        let mut pose = Pose::new(tracker.program());
        let places = places(tracker, &tracker.model().defaults(), &mut pose)?;
        let middle =
            places.iter().fold(Vec3::ZERO, |sum, &p| sum + p) * (1.0 / places.len() as f64);
        let size = 2.0 * places.iter().map(|&p| (p - middle).norm()).fold(0.0, f64::max);
        Some(Self {
            tracker,
            rules,
            rough: None,
            labels: &tracking.labels,
            sample,
            answers: numbers.iter().map(|n| tracking.answers.at(*n)).collect(),
            numbers,
            names: &tracking.markers,
            places,
            pose,
            size,
        })
    }

    /// Mean over the frames of the RMS as recorded.
    fn rms(&self) -> f64 {
        mean(self.answers.iter().map(|a| a.rms()))
    }

    /// How like the markers at rest those of a sample are.
    fn likeness(&self, sample: &Recording) -> f64 {
        mean((0..self.numbers.len()).map(|frame| self.cloud(sample, frame).likeness(self.up()).0))
    }

    /// The places at rest and in one of the frames of a sample, of the markers seen.
    fn cloud(&self, sample: &Recording, frame: usize) -> Cloud {
        Cloud::of(seen_of(&self.places, self.labels, sample.frame(frame)))
    }

    fn up(&self) -> usize {
        match self.tracker.model().up() {
            UpAxis::Y => 1,
            UpAxis::Z => 2,
        }
    }

    /// Which way the body's upward axis points in all frames but one, where that is not up.
    fn upward(&self) -> Option<Direction> {
        let up = self.up();
        let directions: Vec<Option<Direction>> = (0..self.numbers.len())
            .map(|frame| self.cloud(&self.sample, frame).upward(up))
            .collect();
        let middle = directions.get(directions.len() / 2).copied().flatten()?;
        let others = directions.iter().filter(|d| **d != Some(middle)).count();
        (middle != (up, true) && others <= 1).then_some(middle)
    }

    /// A warning where the segment that carries all others lies, too, in three quarters of the frames.
    fn lying(&mut self, (axis, positive): Direction) -> Option<Diagnostic> {
        let root = self.root()?;
        let (tracker, up) = (self.tracker, self.up());
        let mut turned = |stored: &[f64]| {
            tracker.program().evaluate(stored, Mode::Open, &mut self.pose).ok()?;
            Some(self.pose.segment(root).linear)
        };
        let up_axis = [Vec3::X, Vec3::Y, Vec3::Z][up];
        let at_rest = turned(&tracker.model().defaults())?.inverse() * up_axis;
        let lies = |answer: &&FrameAnswer| {
            turned(&answer.coordinates).is_some_and(|now| (now * at_rest).dot(up_axis) < HALF)
        };
        let lying = self.answers.iter().filter(lies).count();
        if 4 * lying < 3 * self.answers.len() {
            return None;
        }
        let [sign, name] =
            [if positive { "" } else { "-" }.to_owned(), axis_name(axis).to_string()];
        let how = if axis == up { "stands on its head" } else { "lies on its side" };
        let message = format!(
            "the body {how} throughout: in the model up is {}, in the recording its body points along {sign}{name}",
            axis_name(up),
        );
        let help = format!("if the recording's up axis is {sign}{name}, turn it first");
        Some(Diagnostic::warning("track/lying", message).with_help(help))
    }

    /// The segment above all that carry markers, where it can move freely.
    fn root(&self) -> Option<SegmentId> {
        let model = self.tracker.model();
        let above = |segment| std::iter::successors(Some(segment), |&s| model.segment(s).parent);
        let mut carrying = self.tracker.targets().markers.iter();
        let first = model.markers()[carrying.next()?.marker].segment?;
        let mut common: Vec<SegmentId> = above(first).collect();
        for target in carrying {
            let of_this: Vec<SegmentId> = above(model.markers()[target.marker].segment?).collect();
            common.retain(|segment| of_this.contains(segment));
        }
        let lowest = *common.first()?;
        let moves = |&&(direction, _): &&(u32, u32)| {
            let mut ids = model.coordinate_ids();
            let id = ids.find(|&id| model.tangent_range(id).contains(&(direction as usize)));
            // Those of some files are of no known kind.
            let shifts = [CoordinateKind::Translation, CoordinateKind::Other];
            id.is_some_and(|id| shifts.contains(&model.coordinate(id).kind))
        };
        let directions = self.tracker.program().segment_directions(lowest);
        directions.iter().find(moves).map(|_| lowest)
    }

    /// The causes that may be, each with the RMS of the frames without it; the best first. Those
    /// that do not gain so much likeness, or without promise, are left out.
    fn try_causes(&mut self, upward: Option<Direction>, gain: f64) -> Vec<(Variant, f64)> {
        let mut cloud = Cloud::default();
        (0..self.numbers.len()).for_each(|frame| cloud += self.cloud(&self.sample, frame));
        let mut causes = vec![];
        let power = power_of(&cloud);
        if power != 0 {
            let scaled = Variant::Scaled(10f64.powi(power));
            match self.with(&scaled.of(&self.sample)) {
                // Nothing else makes a body larger or smaller.
                Some(rms) if rms <= HALF * self.rms() => return vec![(scaled, rms)],
                _ => {}
            }
        }
        causes.extend(upward.map(|direction| self.upright(direction, &cloud)));
        let up = [Vec3::X, Vec3::Y, Vec3::Z][self.up()];
        let pairs = sides::pairs(self.names, &self.places, up);
        if !pairs.is_empty() {
            let labels = pairs.iter().map(|pair| pair.map(|marker| self.labels[marker]));
            causes.push(Variant::Exchanged(labels.collect()));
        }
        causes.push(Variant::Mirrored(cloud.mirrored()));
        let now = self.likeness(&self.sample);
        let tried = causes.into_iter().filter_map(|cause| {
            // Turns make no difference to likeness; they are not guessed without a reason.
            let always = matches!(cause, Variant::Turned { .. });
            let changed = cause.of(&self.sample);
            if !always && self.likeness(&changed) < now + gain {
                return None;
            }
            let rms = self.with(&changed)?;
            Some((cause, rms))
        });
        let mut tried: Vec<_> = tried.collect();
        tried.sort_by(|a, b| a.1.total_cmp(&b.1));
        tried
    }

    /// The turn that brings what points in a direction up.
    fn upright(&self, (axis, positive): Direction, cloud: &Cloud) -> Variant {
        let up = self.up();
        if axis == up {
            return Variant::Turned { axis: cloud.half_turn(up), quarters: 2 };
        }
        // A quarter turn about the third axis takes each axis to the next.
        let next = (axis + 1) % 3 == up;
        Variant::Turned { axis: 3 - axis - up, quarters: if next == positive { 1 } else { 3 } }
    }

    /// RMS of the frames of a changed sample, tracked from first guesses; `None` if it has no promise.
    fn with(&mut self, changed: &Recording) -> Option<f64> {
        let count = self.numbers.len();
        let mut order: Vec<usize> = (0..count).collect();
        order.sort_by(|&a, &b| self.answers[b].rms().total_cmp(&self.answers[a].rms()));
        let mut sums = [0.0; 2];
        for (done, &frame) in order.iter().enumerate() {
            if done == FIRST_FRAMES && sums[0] > PROMISE * sums[1] {
                return None;
            }
            sums[0] += self.solved(changed, frame).rms();
            sums[1] += self.answers[frame].rms();
        }
        Some(sums[0] / count as f64)
    }

    /// The answer for one of the frames of a changed sample, from first guesses.
    fn solved(&mut self, sample: &Recording, frame: usize) -> FrameAnswer {
        let (seen, number) = (self.seen(sample, frame), self.numbers[frame]);
        let (tracker, scratch) = self.rough();
        tracker.solve_first(scratch, &seen, number, GUESSES)
    }

    /// The same from the posture of an answer.
    fn solved_from(
        &mut self,
        sample: &Recording,
        frame: usize,
        mut answer: FrameAnswer,
    ) -> FrameAnswer {
        let (seen, number) = (self.seen(sample, frame), self.numbers[frame]);
        let (tracker, scratch) = self.rough();
        tracker.solve_into(scratch, &seen, number, &mut answer);
        answer
    }

    fn seen(&self, sample: &Recording, frame: usize) -> Vec<Option<[f64; 3]>> {
        let row = sample.frame(frame);
        self.labels.iter().map(|&label| row.get(label)?.position()).collect()
    }

    /// The tracker at a rough tolerance.
    fn rough(&mut self) -> &mut (Tracker, Scratch) {
        let (tracker, rules) = (self.tracker, Rules { tolerance: ROUGHLY, ..self.rules });
        self.rough.get_or_insert_with(|| {
            let (model, targets) = (Arc::clone(tracker.model()), tracker.targets().clone());
            let tracker = Tracker::new(model, targets, rules);
            let scratch = Scratch::new(&tracker);
            (tracker, scratch)
        })
    }

    /// The best of the causes tried, and those that are as good, with the errors.
    fn compared(&self, tried: &[(Variant, f64)]) -> String {
        let least = tried.first().map_or(0.0, |(_, rms)| *rms);
        let alike = tried.iter().filter(|(_, other)| *other <= AS_GOOD * least);
        let names: Vec<String> = alike.map(|(variant, _)| variant.to_string()).collect();
        format!(
            "{}: put right, the marker error is {:.1} mm RMS instead of {:.1}",
            names.join(", or "),
            1e3 * least,
            1e3 * self.rms(),
        )
    }
}

fn mean(values: impl Iterator<Item = f64>) -> f64 {
    let (sum, n) = values.fold((0.0, 0.0), |(sum, n), value| (sum + value, n + 1.0));
    if n > 0.0 { sum / n } else { 0.0 }
}

/// Where the marker targets are in a posture; `None` without any.
fn places(tracker: &Tracker, stored: &[f64], pose: &mut Pose) -> Option<Vec<Vec3>> {
    tracker.program().evaluate(stored, Mode::Open, pose).ok()?;
    let model = tracker.model();
    let markers = tracker.targets().markers.iter().map(|t| &model.markers()[t.marker]);
    let places: Vec<Vec3> = markers.map(|m| pose.frame(m.segment) * m.point).collect();
    (!places.is_empty()).then_some(places)
}
