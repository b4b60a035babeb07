//! One frame: where to start, what came out.

use crate::answer::{FrameAnswer, FrameStatus, better};
use crate::problem::Frame;
use crate::tracker::{Scratch, Tracker};
use condyle_model::{CoordinateId, CoordinateKind};
use condyle_solve::least_squares::{self, Stop};
use std::f64::consts::TAU;

/// A frame that fits this many times worse than the one before is looked at again.
const JUMP: f64 = 3.0;
/// A rise of F + P below this (3 mm RMS) is no jump.
const JUMP_FLOOR: f64 = 1e-5;
/// Two values of F + P closer than this (0.03 mm RMS) are alike.
const ALIKE: f64 = 1e-9;
/// Rotations that differ by more than this, in radians, are another branch, to which an answer changes
/// only where that lowers F + P by this share.
pub(crate) const TURN: f64 = 0.3;
const SWITCH: f64 = 1e-3;
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
        let mut best = self.solve_guesses(scratch, seen, frame, guesses);
        if let Some(start) = self.outward(scratch, seen, frame, &best) {
            let answer = self.solve_wound(scratch, seen, frame, &start.coordinates);
            if self.preferred(&answer, &best) {
                best = answer;
            }
        }
        self.try_limbs(scratch, seen, frame, &mut best);
        best
    }

    /// The best descent from at most so many first guesses of the whole model.
    fn solve_guesses(
        &self,
        scratch: &mut Scratch,
        seen: &[Option<[f64; 3]>],
        frame: usize,
        guesses: usize,
    ) -> FrameAnswer {
        let mut best: Option<FrameAnswer> = None;
        for guess in self.first_guesses(scratch, seen, guesses) {
            let answer = self.solve_wound(scratch, seen, frame, &guess);
            if best.as_ref().is_none_or(|best| self.preferred(&answer, best)) {
                best = Some(answer);
            }
        }
        best.unwrap_or_else(|| self.solve_frame(scratch, seen, frame, &self.defaults))
    }

    /// A descent from afar, wound back by whole turns towards the defaults and solved again from there.
    fn solve_wound(
        &self,
        scratch: &mut Scratch,
        seen: &[Option<[f64; 3]>],
        frame: usize,
        start: &[f64],
    ) -> FrameAnswer {
        let mut answer = self.solve_frame(scratch, seen, frame, start);
        if self.unwind(&mut answer.coordinates) {
            self.solve_into(scratch, seen, frame, &mut answer);
        }
        answer
    }

    /// A frame among others from at most so many first guesses: as [`Tracker::solve_first`], but not built
    /// anew from the root, as its neighbours say as much.
    pub(crate) fn solve_anew(
        &self,
        scratch: &mut Scratch,
        seen: &[Option<[f64; 3]>],
        frame: usize,
        guesses: usize,
    ) -> FrameAnswer {
        let mut answer = self.solve_guesses(scratch, seen, frame, guesses);
        self.try_limbs(scratch, seen, frame, &mut answer);
        answer
    }

    /// Tries each limb at other quarter turns, then what lies beyond bounds.
    fn try_limbs(
        &self,
        scratch: &mut Scratch,
        seen: &[Option<[f64; 3]>],
        frame: usize,
        best: &mut FrameAnswer,
    ) {
        for limb in 0..self.limbs.len() {
            self.try_limb(scratch, seen, frame, limb, best);
        }
        self.cross_bounds(scratch, seen, frame, best);
    }

    /// Tries a limb at other quarter turns, where its markers are farther off than all on average.
    fn try_limb(
        &self,
        scratch: &mut Scratch,
        seen: &[Option<[f64; 3]>],
        frame: usize,
        limb: usize,
        best: &mut FrameAnswer,
    ) {
        for guess in self.limb_guesses(scratch, seen, limb, best) {
            let mut answer = self.solve_wound(scratch, seen, frame, &guess);
            answer.iterations += best.iterations;
            if self.replaces(&answer, best) {
                *best = answer;
            } else {
                best.iterations = answer.iterations;
            }
        }
    }

    /// Whether an answer takes the place of another: it is better, and where a joint turns much, by
    /// a thousandth at least. Of answers that fit alike the one at hand stays.
    pub(crate) fn replaces(&self, a: &FrameAnswer, b: &FrameAnswer) -> bool {
        let alike = a.status == b.status && a.minimised() >= b.minimised() * (1.0 - SWITCH);
        better(a, b) && !(alike && self.largest_turn(a, b) > TURN)
    }

    /// Whether an answer beats another where nothing came before: clearly lower F + P, or as good and
    /// nearer to the defaults. Three angles can name one rotation in two ways, and both fit alike.
    fn preferred(&self, a: &FrameAnswer, b: &FrameAnswer) -> bool {
        let alike = (a.minimised() - b.minimised()).abs() <= 1e-4 * b.minimised() + ALIKE;
        if !alike || a.status != b.status {
            return better(a, b);
        }
        self.away(&a.coordinates) < self.away(&b.coordinates) - 1e-6
    }

    /// The sum of the squared rotations away from the defaults.
    pub(crate) fn away(&self, stored: &[f64]) -> f64 {
        self.turns(stored, &self.defaults).map(|(_, turn)| turn.powi(2)).sum()
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
    pub(crate) fn unwind(&self, stored: &mut [f64]) -> bool {
        let before = stored.to_vec();
        for (place, turn) in self.turns(&before, &self.defaults) {
            stored[place] -= (turn / TAU).round() * TAU;
        }
        before != stored
    }

    /// Brings every angle within half a turn of its default, and where three angles name a posture outside of their ranges
    /// takes the other three that do; whether anything was changed.
    pub(crate) fn rename(&self, stored: &mut [f64]) -> bool {
        let unwound = self.unwind(stored);
        self.branches.bring_inside(stored, &self.model) || unwound
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
        self.cross_bounds(scratch, seen, frame, answer);
        let jumped = answer.minimised() > JUMP * before + JUMP_FLOOR;
        let lost = matches!(answer.status, FrameStatus::Uncertain | FrameStatus::Infeasible);
        if jumped || lost || gap {
            let mut again = self.solve_anew(scratch, seen, frame, RESCUE_GUESSES);
            self.branches.bring_near(&mut again.coordinates, &answer.coordinates, &self.stored);
            let all = answer.iterations + again.iterations;
            if self.replaces(&again, answer) {
                *answer = again;
            }
            answer.iterations = all;
        }
    }

    /// Where a joint is at a bound, tries where else it could be.
    pub(crate) fn cross_bounds(
        &self,
        scratch: &mut Scratch,
        seen: &[Option<[f64; 3]>],
        frame: usize,
        answer: &mut FrameAnswer,
    ) {
        let across = self.branches.across_bounds(&answer.coordinates, &self.stored).map(Vec::from);
        let poles = self.branches.off_poles(&answer.coordinates, &self.stored).map(Vec::from);
        let mut others = across.chain(poles).peekable();
        if others.peek().is_none() {
            return;
        }
        for other in others.collect::<Vec<_>>() {
            let mut start = answer.coordinates.clone();
            other.iter().for_each(|&(place, q)| start[place] = q);
            let again = self.solve_frame(scratch, seen, frame, &start);
            if again.minimised() < answer.minimised() * (1.0 - SWITCH) && better(&again, answer) {
                *answer = again;
            }
        }
    }

    /// A descent from the posture in `answer`, keeping the solver's active set of the last one.
    pub(crate) fn descend(
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
    pub(crate) fn hold(&self, stored: &mut [f64]) {
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
}
