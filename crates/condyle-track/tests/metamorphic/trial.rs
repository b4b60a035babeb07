//! Generated recordings of random bodies, what tracking makes of them, and how two trackings differ.

use crate::body::{Body, Dice};
use condyle_math::{Quat, Vec3};
use condyle_model::{CoordinateKind, Mode, Pose, Program};
use condyle_track::{Chunk, FrameAnswer, Scratch, Tracker, Trust, sequence};
use std::f64::consts::PI;

/// Frames of a trial: three chunks, the last not full.
pub(crate) const FRAMES: usize = 150;

/// For each frame the recorded place of each marker.
pub(crate) type Rows = Vec<Vec<Option<[f64; 3]>>>;

/// The markers of a random motion, each off by a constant of 4 mm and noise of 2 mm along each axis, with
/// gaps. Some angles go beyond their range.
pub(crate) fn recorded(body: &Body, seed: u64) -> (Vec<Vec<f64>>, Rows) {
    let model = body.build();
    let program = Program::compile(&model);
    let mut pose = Pose::new(&program);
    let dice = &mut Dice(!seed);
    let waves = |dice: &mut Dice| {
        let (a, b) = (5.0 * dice.unit(), 11.0 * dice.unit());
        let (p, q) = (PI * dice.unit(), PI * dice.unit());
        move |t: f64| 0.65 * (a * t + p).sin() + 0.35 * (b * t + q).sin()
    };
    let mut motions: Vec<Box<dyn Fn(f64) -> Vec<f64>>> = vec![];
    for id in model.coordinate_ids() {
        let coordinate = model.coordinate(id);
        let (wave, other, third) = (waves(dice), waves(dice), waves(dice));
        let speed = 9.0 * dice.unit();
        let most = coordinate.range.bounds().1;
        motions.push(match coordinate.kind {
            CoordinateKind::Orientation => Box::new(move |t| {
                let turn = Vec3::new(wave(t), other(t), third(t)) * 2.0;
                Quat::exp(turn).to_array().to_vec()
            }),
            CoordinateKind::Translation => Box::new(move |t| vec![wave(t)]),
            _ if most > 3.0 => Box::new(move |t| vec![speed * t + 0.3 * wave(t)]),
            _ => Box::new(move |t| vec![1.03 * most * wave(t)]),
        });
    }
    let offsets: Vec<Vec3> = (0..body.points_len()).map(|_| dice.vector(0.004)).collect();
    let (mut truth, mut rows): (Vec<Vec<f64>>, Rows) = (vec![], vec![]);
    for frame in 0..FRAMES {
        let t = frame as f64 / FRAMES as f64;
        let stored: Vec<f64> = motions.iter().flat_map(|motion| motion(t)).collect();
        program.evaluate(&stored, Mode::Open, &mut pose).unwrap();
        let markers = model.markers().iter().zip(&offsets);
        let places = markers.map(|(marker, off)| {
            let off = *off + dice.vector(0.002);
            Some((pose.frame(marker.segment) * marker.point + off).to_array())
        });
        rows.push(places.collect());
        truth.push(pose.effective().to_vec());
    }
    // One marker in five is gone for a while; in half of the trials all are, for three frames.
    for marker in 0..body.points_len() {
        if dice.below(5) == 0 {
            let (first, length) = (dice.below(FRAMES), 5 + dice.below(35));
            rows.iter_mut().skip(first).take(length).for_each(|row| row[marker] = None);
        }
    }
    if dice.below(2) == 0 {
        let first = dice.below(FRAMES);
        rows.iter_mut().skip(first).take(3).for_each(|row| row.fill(None));
    }
    (truth, rows)
}

/// A tracked trial.
pub(crate) struct Tracked<'a> {
    pub(crate) body: &'a Body,
    pub(crate) tracker: Tracker,
    pub(crate) answers: Vec<FrameAnswer>,
    pub(crate) trust: Vec<Vec<Trust>>,
}

impl<'a> Tracked<'a> {
    /// All markers in their order, in chunks of the usual length.
    pub(crate) fn plain(body: &'a Body, rows: &Rows) -> Self {
        let all: Vec<usize> = (0..body.points_len()).collect();
        Self::of(body, body.tracker(&all, &[]), rows, None)
    }

    pub(crate) fn of(body: &'a Body, tracker: Tracker, rows: &Rows, chunk: Option<usize>) -> Self {
        let recorded = |frame: usize, row: &mut Vec<Option<[f64; 3]>>| row.clone_from(&rows[frame]);
        let mut scratch = Scratch::new(&tracker);
        let total = rows.len();
        let chunks = match chunk {
            None => sequence::cut(total),
            Some(length) => {
                let starts = (0..total).step_by(length);
                starts.map(|start| Chunk { frames: start..(start + length).min(total) }).collect()
            }
        };
        let keys = sequence::keys(&tracker, &mut scratch, &recorded, &chunks);
        let solved = chunks.iter().zip(&keys).map(|(chunk, key)| {
            sequence::solve_chunk(&tracker, &mut scratch, &recorded, chunk, key, total)
        });
        let solved = solved.collect();
        let answers = sequence::stitch(&tracker, &mut scratch, &recorded, &chunks, solved);
        let trust = answers.iter().zip(rows).enumerate();
        let trust = trust.map(|(i, (answer, row))| tracker.trust(&mut scratch, row, i, answer));
        let trust = trust.collect();
        Self { body, tracker, answers, trust }
    }

    /// How each part is turned in its parent in a frame; the first in the world.
    pub(crate) fn turns(&self, frame: usize) -> Vec<Quat> {
        let (model, program) = (self.tracker.model(), self.tracker.program());
        let mut pose = Pose::new(program);
        program.evaluate(&self.answers[frame].coordinates, Mode::Open, &mut pose).unwrap();
        let of =
            |part: usize| Quat::from_mat3(pose.segment(self.body.joint_of(model, part).0).linear);
        let turn = |part: usize| match self.body.parent(part) {
            Some(parent) => of(parent).conjugate() * of(part),
            None => of(part),
        };
        (0..self.body.parts_len()).map(turn).collect()
    }

    /// Whether the markers, or bounds, determine all coordinates of a part's joint in a frame.
    pub(crate) fn determines(&self, frame: usize, part: usize) -> bool {
        let (_, ids) = self.body.joint_of(self.tracker.model(), part);
        let sure = |t: Trust| matches!(t, Trust::Determined | Trust::AtLimit);
        ids.iter().all(|id| sure(self.trust[frame][id.index()]))
    }

    /// The numbers of a part's joint.
    pub(crate) fn numbers(&self, frame: usize, part: usize) -> Vec<f64> {
        let model = self.tracker.model();
        let (_, ids) = self.body.joint_of(model, part);
        let stored = &self.answers[frame].coordinates;
        ids.iter().flat_map(|&id| stored[model.stored_range(id)].to_vec()).collect()
    }
}

/// The largest differences of two trackings.
#[derive(Clone, Debug, Default)]
pub(crate) struct Off {
    /// Of F + P, as a share of it; below 1 (µm)² nothing counts.
    pub(crate) fit: f64,
    /// Of how a determined part is turned in its parent, in radians.
    pub(crate) turn: f64,
    /// Of an angle of a determined joint without a quaternion, in radians.
    pub(crate) number: f64,
    /// Where these are.
    pub(crate) at: [String; 3],
    /// Frames of which one is solved and the other not.
    pub(crate) statuses: usize,
    /// Frames, and those whose F + P differs by more than a millionth.
    pub(crate) frames: usize,
    pub(crate) differing: usize,
    /// Joints of frames that were compared, and those that are not determined.
    pub(crate) compared: usize,
    pub(crate) undetermined: usize,
}

impl Off {
    pub(crate) fn add(&mut self, other: Off) {
        let [fit, turn, number] = other.at;
        if other.fit > self.fit {
            (self.fit, self.at[0]) = (other.fit, fit);
        }
        if other.turn > self.turn {
            (self.turn, self.at[1]) = (other.turn, turn);
        }
        if other.number > self.number {
            (self.number, self.at[2]) = (other.number, number);
        }
        self.statuses += other.statuses;
        self.frames += other.frames;
        self.differing += other.differing;
        self.compared += other.compared;
        self.undetermined += other.undetermined;
    }
}

/// How to hold one tracking against another.
pub(crate) struct Against<'a> {
    /// The frame of the second for one of the first; none if it has none.
    pub(crate) frame: &'a dyn Fn(usize) -> Option<usize>,
    /// What becomes of a part's turn.
    pub(crate) image: &'a dyn Fn(usize, Quat) -> Quat,
    /// By how much F + P grows.
    pub(crate) growth: f64,
    /// Where to begin.
    pub(crate) case: String,
}

pub(crate) fn compare(a: &Tracked<'_>, b: &Tracked<'_>, how: &Against<'_>) -> Off {
    let mut off = Off::default();
    for frame in 0..a.answers.len() {
        let Some(other) = (how.frame)(frame) else { continue };
        let (x, y) = (&a.answers[frame], &b.answers[other]);
        if x.status != y.status {
            off.statuses += 1;
        }
        if !(x.status.is_solved() && y.status.is_solved()) {
            continue;
        }
        let place = |part: usize| format!("{} frame {frame} part {part}", how.case);
        let (f, g) = (x.minimised() * how.growth, y.minimised());
        let fit = (f - g).abs() / (f + 1e-12 * how.growth);
        let [turns, others] = [a.turns(frame), b.turns(other)];
        let at = [place(0), String::new(), String::new()];
        let differing = usize::from(fit > 1e-6);
        let mut frame_off = Off { fit, at, frames: 1, differing, ..Off::default() };
        for part in 0..a.body.parts_len() {
            if !(a.determines(frame, part) && b.determines(other, part)) {
                frame_off.undetermined += 1;
                continue;
            }
            let turn = (how.image)(part, turns[part]).angle_to(others[part]);
            let (p, q) = (a.numbers(frame, part), b.numbers(other, part));
            let ball = matches!(p.len(), 4 | 7);
            let places = if part == 0 { 3 } else { 0 };
            let numbers = p.iter().zip(&q).skip(places).map(|(p, q)| (p - q).abs());
            let number = if ball { 0.0 } else { numbers.fold(0.0, f64::max) };
            let at = [String::new(), place(part), place(part)];
            frame_off.add(Off { turn, number, at, compared: 1, ..Off::default() });
        }
        off.add(frame_off);
    }
    off
}
