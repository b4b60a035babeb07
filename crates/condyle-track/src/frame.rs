//! One frame: where to start, what came out.

use crate::answer::{FrameAnswer, FrameStatus, better};
use crate::problem::Frame;
use crate::tracker::{Scratch, Tracker};
use condyle_math::Vec3;
use condyle_model::{CoordinateId, CoordinateKind, Mode};
use condyle_solve::least_squares::{self, Stop};
use std::f64::consts::{FRAC_PI_2, TAU};

/// A frame that fits this many times worse than the one before is looked at again.
const JUMP: f64 = 3.0;
/// A rise of F + P below this (3 mm RMS) is no jump.
const JUMP_FLOOR: f64 = 1e-5;
/// Two values of F + P closer than this (0.03 mm RMS) are alike.
const ALIKE: f64 = 1e-9;
/// How many first guesses such a frame gets.
const RESCUE_GUESSES: usize = 2;

impl Tracker {
    /// The posture nearest to the recorded markers of one frame, from one start: the stored numbers
    /// of all coordinates. Arguments are those of [`Tracker::solve_into`].
    ///
    /// # Panics
    /// If `start` has not as many numbers as the model stores.
    pub fn solve_frame(
        &self,
        scratch: &mut Scratch,
        seen: &[Option<[f64; 3]>],
        frame: usize,
        start: &[f64],
    ) -> FrameAnswer {
        let mut answer = FrameAnswer::start(start);
        self.solve_into(scratch, seen, frame, &mut answer);
        answer
    }

    /// Solves one frame from the posture in `answer`, which becomes that of the frame.
    ///
    /// `seen` has the recorded position of each marker target in metres, `None` where it is not seen;
    /// `frame` chooses the values of coordinate targets. Nothing is allocated once the answer has been
    /// written to.
    ///
    /// # Panics
    /// If the answer has not as many coordinates as the model stores.
    pub fn solve_into(
        &self,
        scratch: &mut Scratch,
        seen: &[Option<[f64; 3]>],
        frame: usize,
        answer: &mut FrameAnswer,
    ) {
        scratch.solver.forget();
        self.descend(scratch, seen, frame, answer);
    }

    /// The posture of a frame about which nothing is known, from at most so many first guesses.
    ///
    /// A descent from afar may wind a joint through a whole turn, and a joint that glides while it
    /// turns may even fit a little better there. Such an answer is wound back by whole turns towards
    /// the defaults and solved again from there, and that is what competes.
    pub fn solve_first(
        &self,
        scratch: &mut Scratch,
        seen: &[Option<[f64; 3]>],
        frame: usize,
        guesses: usize,
    ) -> FrameAnswer {
        let mut best: Option<FrameAnswer> = None;
        for guess in self.first_guesses(scratch, seen, guesses) {
            let mut answer = self.solve_frame(scratch, seen, frame, &guess);
            if self.unwind(&mut answer.coordinates) {
                self.solve_into(scratch, seen, frame, &mut answer);
            }
            if best.as_ref().is_none_or(|best| self.preferred(&answer, best)) {
                best = Some(answer);
            }
        }
        best.unwrap_or_else(|| self.solve_frame(scratch, seen, frame, &self.defaults))
    }

    /// Whether an answer beats another where nothing came before: clearly lower F + P, or as good and
    /// nearer to the defaults. Three angles can name one rotation in two ways, and both fit alike.
    fn preferred(&self, a: &FrameAnswer, b: &FrameAnswer) -> bool {
        let alike = (a.minimised() - b.minimised()).abs() <= 1e-4 * b.minimised() + ALIKE;
        if !alike || a.status != b.status {
            return better(a, b);
        }
        let away = |answer: &FrameAnswer| -> f64 {
            let turns = self.turns(&answer.coordinates, &self.defaults);
            turns.map(|(_, turn)| turn.powi(2)).sum()
        };
        away(a) < away(b) - 1e-6
    }

    /// The largest change of a rotation between two answers, in radians.
    pub(crate) fn largest_turn(&self, a: &FrameAnswer, b: &FrameAnswer) -> f64 {
        let turns = self.turns(&a.coordinates, &b.coordinates);
        turns.map(|(_, turn)| turn.abs()).fold(0.0, f64::max)
    }

    /// For each rotation the place where it is stored and a - b, in radians.
    fn turns<'a>(
        &'a self,
        a: &'a [f64],
        b: &'a [f64],
    ) -> impl Iterator<Item = (usize, f64)> + use<'a> {
        let model = &self.model;
        let rotates = |id: &CoordinateId| model.coordinate(*id).kind == CoordinateKind::Rotation;
        let places = model.coordinate_ids().filter(rotates).map(|id| model.stored_range(id).start);
        places.map(|place| (place, a[place] - b[place]))
    }

    /// Brings every angle within half a turn of its default; whether any was not.
    fn unwind(&self, stored: &mut [f64]) -> bool {
        let before = stored.to_vec();
        for (place, turn) in self.turns(&before, &self.defaults) {
            stored[place] -= (turn / TAU).round() * TAU;
        }
        before != stored
    }

    /// Solves a frame that follows another from the posture of that, which `answer` has before and
    /// that of the frame afterwards.
    ///
    /// A frame that fits far worse than the one before, or not at all, is tried again from first
    /// guesses, as is one after a `gap`: it may be a flip, or the end of a long gap. Only that
    /// allocates.
    pub(crate) fn follow(
        &self,
        scratch: &mut Scratch,
        seen: &[Option<[f64; 3]>],
        frame: usize,
        answer: &mut FrameAnswer,
        gap: bool,
    ) {
        let before = if answer.status.is_solved() { answer.minimised() } else { f64::INFINITY };
        self.descend(scratch, seen, frame, answer);
        let jumped = answer.minimised() > JUMP * before + JUMP_FLOOR;
        let lost = matches!(answer.status, FrameStatus::Uncertain | FrameStatus::Infeasible);
        if jumped || lost || gap {
            let again = self.solve_first(scratch, seen, frame, RESCUE_GUESSES);
            let all = answer.iterations + again.iterations;
            if better(&again, answer) {
                *answer = again;
            }
            answer.iterations = all;
        }
    }

    /// A descent from the posture in `answer`, keeping the solver's active set of the last one.
    fn descend(
        &self,
        scratch: &mut Scratch,
        seen: &[Option<[f64; 3]>],
        index: usize,
        answer: &mut FrameAnswer,
    ) {
        let Scratch { solver, buffers } = scratch;
        buffers.current.copy_from_slice(&answer.coordinates);
        self.hold(&mut buffers.current);
        buffers.tangent.fill(0.0);
        let mut frame = Frame { tracker: self, seen, index, buffers };
        frame.weigh();
        let some_seen = frame.buffers.total_weight > 0.0;
        (answer.status, answer.iterations) = (FrameStatus::NoMarkers, 0);
        if some_seen || self.targets.stand_without_markers() {
            let tolerance = self.rules.tolerance;
            let stopping = least_squares::Stopping { tolerance, ..Default::default() };
            let summary = solver.minimise(&mut frame, &stopping);
            answer.iterations = summary.iterations;
            answer.status = match summary.stop {
                _ if !some_seen && !self.targets.orient(index) => FrameStatus::NoMarkers,
                Stop::Converged => FrameStatus::Solved,
                Stop::Infeasible => FrameStatus::Infeasible,
                Stop::Stalled | Stop::IterationLimit | Stop::NotFinite => FrameStatus::Uncertain,
            };
        }
        frame.measure(answer);
    }

    /// Puts locked coordinates at their defaults and the others within their bounds.
    fn hold(&self, stored: &mut [f64]) {
        for id in self.model.coordinate_ids() {
            let coordinate = self.model.coordinate(id);
            if coordinate.locked {
                let place = self.model.stored_range(id);
                stored[place.clone()].copy_from_slice(&self.defaults[place]);
            }
        }
        for &(place, lower, upper) in self.stored.iter().flatten() {
            stored[place] = stored[place].max(lower).min(upper);
        }
    }

    /// Rough first guesses for a frame about which nothing is known, the most promising first.
    ///
    /// The coordinates that turn the whole model are tried at every combination of quarter turns
    /// that their ranges allow; each is judged by the markers' distances after both clouds are
    /// moved to their centroids. The defaults are always among the guesses.
    fn first_guesses(
        &self,
        scratch: &mut Scratch,
        seen: &[Option<[f64; 3]>],
        most: usize,
    ) -> Vec<Vec<f64>> {
        let mut guesses = vec![(f64::INFINITY, self.defaults.clone())];
        let turns = 4usize.pow(self.root_rotations.len() as u32);
        for combination in 0..turns {
            let mut stored = self.defaults.clone();
            let mut digits = combination;
            let mut legal = true;
            for &id in &self.root_rotations {
                let quarter = (digits % 4) as f64;
                digits /= 4;
                let place = self.model.stored_range(id);
                if self.model.coordinate(id).kind == CoordinateKind::Orientation {
                    // One orientation has all turns: about each axis by the three digits.
                    let up = [Vec3::X, Vec3::Y, Vec3::Z][combination / 4 % 3];
                    let turn = condyle_math::Quat::from_axis_angle(up, quarter * FRAC_PI_2);
                    stored[place].copy_from_slice(&turn.to_array());
                    continue;
                }
                let value = (quarter - if quarter == 3.0 { 4.0 } else { 0.0 }) * FRAC_PI_2;
                stored[place.start] += value;
                let range = self.model.coordinate(id).range;
                legal &= !self.rules.limits
                    || value == 0.0
                    || range.distance(stored[place.start]) >= 0.0;
            }
            if legal && let Some(spread) = self.spread(scratch, seen, &mut stored) {
                guesses.push((spread, stored));
            }
        }
        guesses.sort_by(|a, b| a.0.total_cmp(&b.0));
        guesses.dedup_by(|a, b| a.1 == b.1);
        guesses.truncate(most.max(1));
        guesses.into_iter().map(|(_, stored)| stored).collect()
    }

    /// Squared distance between the model's and the recorded markers, each about their centroid.
    fn spread(
        &self,
        scratch: &mut Scratch,
        seen: &[Option<[f64; 3]>],
        stored: &mut [f64],
    ) -> Option<f64> {
        self.hold(stored);
        let pose = &mut scratch.buffers.pose;
        self.program.evaluate(stored, Mode::Open, pose).ok()?;
        let seen = || {
            let markers = self.markers.placed.iter().zip(seen);
            markers.filter_map(|(marker, seen)| {
                Some((marker.weight, marker.at(pose) - Vec3::from((*seen)?)))
            })
        };
        let (mut total, mut between) = (0.0, Vec3::ZERO);
        for (weight, off) in seen() {
            between += off * weight;
            total += weight;
        }
        if total <= 0.0 {
            return None;
        }
        let between = between * (1.0 / total);
        let mut sum = 0.0;
        for (weight, off) in seen() {
            sum += weight * (off - between).norm_squared();
        }
        Some(sum)
    }
}
