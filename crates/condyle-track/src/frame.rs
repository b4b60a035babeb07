//! One frame: where to start, what came out.

use crate::answer::{FrameAnswer, FrameStatus, better};
use crate::problem::FrameProblem;
use crate::robust;
use crate::tracker::{Scratch, Tracker};
use condyle_math::Vec3;
use condyle_model::{CoordinateKind, Mode};
use condyle_solve::least_squares::{self, Stop};
use std::f64::consts::{FRAC_PI_2, TAU};

/// A frame that fits this many times worse than the one before is looked at again.
const JUMP: f64 = 3.0;
/// A rise of F below this (3 mm RMS) is no jump.
const JUMP_FLOOR: f64 = 1e-5;
/// Two values of F closer than this (0.03 mm RMS) are alike.
const ALIKE: f64 = 1e-9;
/// How many first guesses such a frame gets.
const RESCUE_GUESSES: usize = 2;

impl Tracker<'_> {
    /// The posture nearest to the markers of one frame, from one or several starts.
    ///
    /// `targets` has one place for each marker task, `None` where it is not seen; `frame` chooses
    /// the values of coordinate tasks. Each start has the stored numbers of all coordinates; the
    /// best minimum wins, an earlier start on a tie. Without starts the defaults are one.
    pub fn solve_frame(
        &self,
        scratch: &mut Scratch,
        targets: &[Option<[f64; 3]>],
        frame: usize,
        starts: &[&[f64]],
    ) -> FrameAnswer {
        let defaults: &[f64] = &self.defaults;
        let alone = [defaults];
        let starts = if starts.is_empty() { &alone[..] } else { starts };
        let mut best: Option<FrameAnswer> = None;
        let mut iterations = 0;
        for start in starts {
            scratch.solver.forget();
            let answer = self.descend_robustly(scratch, targets, frame, start);
            iterations += answer.iterations;
            let wins = best.as_ref().is_none_or(|best| better(&answer, best));
            if wins {
                best = Some(answer);
            }
        }
        let mut best =
            best.unwrap_or_else(|| self.descend(scratch, targets, frame, defaults, None));
        best.iterations = iterations;
        best
    }

    /// The posture of a frame about which nothing is known, from [`Tracker::first_guesses`].
    ///
    /// A descent from afar may wind a joint through a whole turn, and a joint that glides while it
    /// turns may even fit a little better there. Such an answer is wound back by whole turns towards
    /// the defaults and solved again from there, and that is what competes.
    pub fn solve_first(
        &self,
        scratch: &mut Scratch,
        targets: &[Option<[f64; 3]>],
        frame: usize,
        guesses: usize,
    ) -> FrameAnswer {
        let guesses = self.first_guesses(scratch, targets, guesses);
        let mut best: Option<FrameAnswer> = None;
        for guess in &guesses {
            let mut answer = self.solve_frame(scratch, targets, frame, &[guess]);
            if let Some(unwound) = self.unwound(&answer.coordinates) {
                answer = self.solve_frame(scratch, targets, frame, &[&unwound]);
            }
            if best.as_ref().is_none_or(|best| self.preferred(&answer, best)) {
                best = Some(answer);
            }
        }
        best.unwrap_or_else(|| self.solve_frame(scratch, targets, frame, &[]))
    }

    /// Whether an answer beats another where nothing came before: clearly lower F, or as good and
    /// nearer to the defaults. Three angles can name one rotation in two ways, and both fit alike.
    fn preferred(&self, a: &FrameAnswer, b: &FrameAnswer) -> bool {
        let alike = (a.objective - b.objective).abs() <= 1e-4 * b.objective + ALIKE;
        if !alike || a.status != b.status {
            return better(a, b);
        }
        let away = |answer: &FrameAnswer| -> f64 {
            let angles = self
                .model
                .coordinate_ids()
                .filter(|&id| self.model.coordinate(id).kind == CoordinateKind::Rotation);
            angles
                .map(|id| self.model.stored_range(id).start)
                .map(|place| (answer.coordinates[place] - self.defaults[place]).powi(2))
                .sum()
        };
        away(a) < away(b) - 1e-6
    }

    /// The largest change of a rotation between two answers, in radians.
    pub(crate) fn largest_turn(&self, a: &FrameAnswer, b: &FrameAnswer) -> f64 {
        let rotations = self
            .model
            .coordinate_ids()
            .filter(|&id| self.model.coordinate(id).kind == CoordinateKind::Rotation);
        rotations
            .map(|id| self.model.stored_range(id).start)
            .map(|place| (a.coordinates[place] - b.coordinates[place]).abs())
            .fold(0.0, f64::max)
    }

    /// The same posture with every angle within half a turn of its default; none if all are.
    fn unwound(&self, stored: &[f64]) -> Option<Vec<f64>> {
        let mut unwound = stored.to_vec();
        for id in self.model.coordinate_ids() {
            if self.model.coordinate(id).kind == CoordinateKind::Rotation {
                let place = self.model.stored_range(id).start;
                let turns = ((stored[place] - self.defaults[place]) / TAU).round();
                unwound[place] -= turns * TAU;
            }
        }
        (unwound != stored).then_some(unwound)
    }

    /// One descent from one start, keeping the solver's active set of the last descent.
    pub(crate) fn descend(
        &self,
        scratch: &mut Scratch,
        targets: &[Option<[f64; 3]>],
        frame: usize,
        start: &[f64],
        factors: Option<&[f64]>,
    ) -> FrameAnswer {
        let Scratch { pose, jacobian, closures, solver, buffers } = scratch;
        buffers.current.copy_from_slice(start);
        self.hold(&mut buffers.current);
        buffers.tangent.fill(0.0);
        let mut problem = FrameProblem {
            tracker: self,
            targets,
            frame,
            pose,
            jacobian,
            closures,
            buffers,
            total_weight: 0.0,
        };
        problem.weigh(factors);
        let seen = problem.total_weight > 0.0;
        let mut iterations = 0;
        let mut status = FrameStatus::NoMarkers;
        if seen || !self.tasks.coordinates.is_empty() {
            let options = least_squares::Options {
                tolerance: self.options.tolerance,
                ..least_squares::Options::default()
            };
            let summary = solver.minimise(&mut problem, &options);
            iterations = summary.iterations;
            status = match summary.stop {
                Stop::Converged => FrameStatus::Solved,
                Stop::Infeasible => FrameStatus::Infeasible,
                Stop::Stalled | Stop::IterationLimit | Stop::NotFinite => FrameStatus::Uncertain,
            };
            if !seen {
                status = FrameStatus::NoMarkers;
            }
        }
        self.measure(problem, iterations, status)
    }

    /// The posture of a frame that follows another, whose posture is the start.
    ///
    /// A frame that fits far worse than the one before, or not at all, is tried again from first
    /// guesses: it may be a flip, or the end of a long gap.
    pub(crate) fn follow(
        &self,
        scratch: &mut Scratch,
        targets: &[Option<[f64; 3]>],
        frame: usize,
        start: &[f64],
        objective_before: Option<f64>,
    ) -> FrameAnswer {
        let mut answer = self.descend_robustly(scratch, targets, frame, start);
        let before = objective_before.unwrap_or(f64::INFINITY);
        let jumped = answer.objective > JUMP * before + JUMP_FLOOR;
        let lost = matches!(answer.status, FrameStatus::Uncertain | FrameStatus::Infeasible);
        if jumped || lost {
            let spent = answer.iterations;
            let again = self.solve_first(scratch, targets, frame, RESCUE_GUESSES);
            let all = spent + again.iterations;
            if better(&again, &answer) {
                answer = again;
            }
            answer.iterations = all;
        }
        answer
    }

    /// A descent that, where asked, weighs markers down that the others contradict.
    fn descend_robustly(
        &self,
        scratch: &mut Scratch,
        targets: &[Option<[f64; 3]>],
        frame: usize,
        start: &[f64],
    ) -> FrameAnswer {
        let mut answer = self.descend(scratch, targets, frame, start, None);
        if !self.options.robust {
            return answer;
        }
        let mut factors = vec![];
        for _ in 0..robust::ROUNDS {
            robust::factors(&answer.marker_errors, &mut factors);
            let from = std::mem::take(&mut answer.coordinates);
            let iterations = answer.iterations;
            answer = self.descend(scratch, targets, frame, &from, Some(&factors));
            answer.iterations += iterations;
        }
        answer
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

    /// Evaluates the final posture plainly and measures it.
    fn measure(
        &self,
        mut problem: FrameProblem<'_, '_>,
        iterations: u32,
        status: FrameStatus,
    ) -> FrameAnswer {
        let evaluated = self.program.evaluate(&problem.buffers.current, Mode::Open, problem.pose);
        debug_assert!(evaluated.is_ok(), "buffers are made for this program");
        problem.weigh(None);
        let weighted_squares = problem.measure();
        let mut objective = problem.task_cost();
        if problem.total_weight > 0.0 {
            objective += weighted_squares / problem.total_weight;
        }
        let mut closure_error = 0.0;
        if !problem.closures.is_empty() {
            problem.closures.update(self.model, &self.program, problem.pose, None);
            closure_error = problem.closures.residuals.iter().fold(0.0, |m: f64, c| m.max(c.abs()));
            if !self.closures_exact {
                let weight = self.tasks.closure_weight.unwrap_or(0.0);
                objective += weight * problem.closures.residuals.iter().map(|c| c * c).sum::<f64>();
            }
        }
        let buffers = &problem.buffers;
        let errors = buffers.weights.iter().zip(&buffers.errors);
        FrameAnswer {
            coordinates: problem.pose.effective().to_vec(),
            objective,
            weighted_squares,
            marker_errors: errors
                .map(|(&w, e)| if w > 0.0 { e.norm() } else { f64::NAN })
                .collect(),
            closure_error,
            status,
            iterations,
        }
    }

    /// Rough first guesses for a frame about which nothing is known, the most promising first.
    ///
    /// The coordinates that turn the whole model are tried at every combination of quarter turns
    /// that their ranges allow; each is judged by the markers' distances after both clouds are
    /// moved to their centroids. The defaults are always among the guesses.
    pub fn first_guesses(
        &self,
        scratch: &mut Scratch,
        targets: &[Option<[f64; 3]>],
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
                legal &= !self.options.limits
                    || value == 0.0
                    || range.distance(stored[place.start]) >= 0.0;
            }
            if legal && let Some(spread) = self.spread(scratch, targets, &mut stored) {
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
        targets: &[Option<[f64; 3]>],
        stored: &mut [f64],
    ) -> Option<f64> {
        self.hold(stored);
        self.program.evaluate(stored, Mode::Open, &mut scratch.pose).ok()?;
        let (mut total, mut between) = (0.0, Vec3::ZERO);
        for (marker, target) in self.markers.iter().zip(targets) {
            if let Some(target) = target {
                let point = scratch.pose.frame(marker.segment) * marker.point;
                between += (point - Vec3::from(*target)) * marker.weight;
                total += marker.weight;
            }
        }
        if total <= 0.0 {
            return None;
        }
        let between = between * (1.0 / total);
        let mut sum = 0.0;
        for (marker, target) in self.markers.iter().zip(targets) {
            if let Some(target) = target {
                let point = scratch.pose.frame(marker.segment) * marker.point;
                sum += marker.weight * (point - Vec3::from(*target) - between).norm_squared();
            }
        }
        Some(sum)
    }
}
