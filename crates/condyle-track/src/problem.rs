//! One frame as a least-squares problem: the family of targets within bounds and rows.

use crate::answer::FrameAnswer;
use crate::target::{self, Moments};
use crate::tracker::Tracker;
use condyle_math::Vec3;
use condyle_model::evaluate::ClosureRows;
use condyle_model::{CoordinateId, Jacobian, Mode, Pose};
use condyle_solve::least_squares::{LocalModel, Problem};

/// A frame at the pose that was evaluated last.
pub(crate) struct Frame<'a> {
    pub tracker: &'a Tracker,
    /// The recorded positions, one for each marker target.
    pub seen: &'a [Option<[f64; 3]>],
    /// Its number, for targets that have a value for each frame.
    pub index: usize,
    pub buffers: &'a mut Buffers,
}

/// The numbers of a frame.
#[derive(Debug)]
pub(crate) struct Buffers {
    pub pose: Pose,
    pub jacobian: Jacobian,
    /// The numbers at which the pose was evaluated with all derivatives, and whether it still is there.
    pub at: Vec<f64>,
    pub differentiated: bool,
    pub closures: ClosureRows,
    /// Stored numbers where the solver is, and where it tries to go.
    pub current: Vec<f64>,
    pub trial: Vec<f64>,
    pub tangent: Vec<f64>,
    /// For each marker target its weight in this frame, its place in the pose, and its error.
    pub weights: Vec<f64>,
    pub points: Vec<Vec3>,
    pub errors: Vec<Vec3>,
    pub total_weight: f64,
    /// For each group of markers, and for each set of groups.
    pub moments: Vec<Moments>,
    pub summed: Vec<Moments>,
    /// For each unknown how a line turns with it, and which unknowns do that; empty between targets.
    pub velocities: Vec<Option<Vec3>>,
    pub touched: Vec<u32>,
}

impl Buffers {
    /// Poses the model plainly; `None` if there are not as many numbers as it stores.
    pub(crate) fn pose_at(&mut self, tracker: &Tracker, stored: &[f64]) -> Option<&Pose> {
        self.differentiated = false;
        tracker.part.evaluate(stored, Mode::Open, &mut self.pose).ok()?;
        Some(&self.pose)
    }

    /// Poses the model at `trial` with all derivatives, if it is not there; whether it was not. A frame
    /// begins where the last one ended.
    fn differentiate(&mut self, tracker: &Tracker) -> bool {
        let Self { pose, jacobian, closures, trial, at, .. } = self;
        if self.differentiated && (same(at, trial) || same(pose.effective(), trial)) {
            return false;
        }
        let evaluated = tracker.part.evaluate_with_jacobian(trial, pose, jacobian);
        debug_assert!(evaluated.is_ok(), "buffers are made for this program");
        closures.update(&tracker.model, &tracker.part, pose, Some(jacobian));
        at.copy_from_slice(trial);
        self.differentiated = true;
        true
    }
}

/// Whether two lists of numbers are the same, bit by bit.
fn same(a: &[f64], b: &[f64]) -> bool {
    a.iter().zip(b).all(|(a, b)| a.to_bits() == b.to_bits())
}

impl Frame<'_> {
    /// Weighs the markers of the frame: zero where one is not seen.
    pub(crate) fn weigh(&mut self) {
        let Buffers { weights, total_weight, .. } = &mut *self.buffers;
        *total_weight = 0.0;
        for (i, marker) in self.tracker.markers.placed.iter().enumerate() {
            let seen = self.seen.get(i).copied().flatten().is_some();
            let factor = self.tracker.targets.marker_factor(self.index, i);
            weights[i] = if seen { marker.weight * factor } else { 0.0 };
            *total_weight += weights[i];
        }
    }

    /// One over the sum of the weights seen; 0 where none is.
    pub(crate) fn marker_scale(&self) -> f64 {
        let total = self.buffers.total_weight;
        if total > 0.0 { 1.0 / total } else { 0.0 }
    }

    /// The value of a coordinate of one number, in radians or metres.
    pub(crate) fn coordinate(&self, id: CoordinateId) -> f64 {
        self.buffers.pose.coordinate(&self.tracker.model, id)[0]
    }

    /// Writes down the final posture and how it fits.
    pub(crate) fn measure(&mut self, answer: &mut FrameAnswer) {
        let tracker = self.tracker;
        let Buffers { current, trial, .. } = &mut *self.buffers;
        trial.copy_from_slice(current);
        self.buffers.differentiate(tracker);
        self.weigh();
        let sums = target::measure(self);
        let Buffers { pose, closures, weights, errors, .. } = &*self.buffers;
        answer.coordinates.clear();
        answer.coordinates.extend_from_slice(pose.effective());
        answer.objective = sums.objective;
        answer.posture = sums.posture;
        answer.weighted_squares = sums.squares;
        answer.marker_errors.clear();
        let errors = weights.iter().zip(errors);
        answer
            .marker_errors
            .extend(errors.map(|(&w, e)| if w > 0.0 { e.norm() } else { f64::NAN }));
        answer.closure_error = closures.residuals.iter().fold(0.0, |m: f64, c| m.max(c.abs()));
    }
}

impl Problem for Frame<'_> {
    fn evaluate(&mut self, step: &[f64], equalities: &mut [f64], inequalities: &mut [f64]) -> f64 {
        let tracker = self.tracker;
        let Buffers { current, trial, tangent, .. } = &mut *self.buffers;
        for (unknown, &direction) in tracker.directions.iter().enumerate() {
            tangent[direction as usize] = step[unknown];
        }
        tracker.model.retract(current, tangent, trial);
        // Rounding must not carry a coordinate over its bound.
        for &(place, lower, upper) in tracker.stored.iter().flatten() {
            trial[place] = trial[place].max(lower).min(upper);
        }
        self.buffers.differentiate(tracker);
        let Buffers { pose, closures, .. } = &*self.buffers;
        // As many as there are rows of loops, or none where these have a weight.
        equalities.copy_from_slice(&closures.residuals[..equalities.len()]);
        for (row, value) in inequalities.iter_mut().enumerate() {
            *value = pose.limit_row(row);
        }
        target::measure(self).minimised
    }

    fn accept(&mut self) {
        std::mem::swap(&mut self.buffers.current, &mut self.buffers.trial);
    }

    fn linearise(&mut self, local: &mut LocalModel) {
        let Buffers { current, trial, .. } = &mut *self.buffers;
        trial.copy_from_slice(current);
        // After a step that was rejected, pose and errors are those of where it led.
        if self.buffers.differentiate(self.tracker) {
            target::measure(self);
        }
        local.hessian.fill(0.0);
        local.gradient.fill(0.0);
        target::linearise(self, local);
        let (tracker, buffers) = (self.tracker, &*self.buffers);
        for (unknown, stored) in tracker.stored.iter().enumerate() {
            (local.lower[unknown], local.upper[unknown]) = match *stored {
                Some((place, lower, upper)) => {
                    let q = buffers.current[place];
                    (lower - q, upper - q)
                }
                None => (f64::NEG_INFINITY, f64::INFINITY),
            };
        }
        let n = tracker.unknown_len();
        for row in 0..tracker.limit_rows {
            let line = &mut local.inequality_rows[row * n..(row + 1) * n];
            line.fill(0.0);
            for &(direction, slot) in tracker.part.limit_row_directions(row) {
                if let Some(entry) = line.get_mut(tracker.unknowns[direction as usize] as usize) {
                    *entry += buffers.jacobian.derivative(slot);
                }
            }
        }
    }
}
