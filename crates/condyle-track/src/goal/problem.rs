//! One descent as a least-squares problem: goals as rows or as squares, rest, loops and limits.

use super::Rest;
use super::question::Question;
use super::rows::{Evaluated, Rows};
use crate::tracker::FIXED;
use condyle_math::{Quat, Vec3};
use condyle_model::evaluate::ClosureRows;
use condyle_model::{CoordinateId, CoordinateKind, Jacobian, Pose};
use condyle_solve::least_squares::{LocalModel, Problem, Solver};

/// A row that must not be negative is active below this, and a coordinate at its bound within it.
pub(super) const ACTIVE: f64 = 1e-9;
/// Rows that must vanish are scaled to this length where a descent begins: the solver makes them
/// orthonormal, and the multipliers that its merit function goes by are those of rows of length 1.
const LENGTH: f64 = 10.0;
/// A row shorter than this, in metres or radians per radian, is scaled as one of this length.
const SHORT: f64 = 1e-4;

/// How goals and rest enter a descent.
#[derive(Clone)]
pub(super) struct Stage {
    /// The weight of squares of goals without a weight; `None` where they are rows.
    pub exact: Option<f64>,
    /// Factor of goals with a weight.
    pub weighted: f64,
    /// Factor of R.
    pub rest: f64,
    /// The pose to be near.
    pub near: Rest,
    /// Whether the Hessian near the minimum is that of the Lagrangian.
    pub curved: bool,
}

/// How one goal enters.
#[derive(Clone, Copy, PartialEq)]
enum Entry {
    Square(f64),
    Vanish,
    NotNegative,
}

/// A descent with its buffers.
pub(super) struct Descent<'a> {
    pub question: &'a Question<'a>,
    pub stage: Stage,
    pub current: Vec<f64>,
    pub pose: Pose,
    jacobian: Jacobian,
    pub closures: ClosureRows,
    /// Residuals of all goals, and a row of derivatives for each.
    pub residuals: Vec<f64>,
    slopes: Vec<f64>,
    trial: Vec<f64>,
    tangent: Vec<f64>,
    /// Factors of the rows that must vanish.
    factors: Vec<f64>,
}

impl<'a> Descent<'a> {
    pub(super) fn new(question: &'a Question<'a>, stage: Stage, start: &[f64]) -> Self {
        let (model, program) = (question.model, &question.program);
        let mut current = start.to_vec();
        question.clamp(&mut current);
        let mut descent = Self {
            question,
            stage,
            pose: Pose::new(program),
            jacobian: Jacobian::new(program),
            closures: ClosureRows::new(model),
            residuals: vec![0.0; question.rows()],
            slopes: vec![0.0; question.rows() * model.tangent_len()],
            trial: current.clone(),
            current,
            tangent: vec![0.0; model.tangent_len()],
            factors: vec![],
        };
        let n = question.unknown_len();
        let (equalities, inequalities) = descent.shape();
        descent.factors = vec![1.0; equalities];
        descent.evaluate_at(&descent.current.clone());
        let mut rows = vec![0.0; equalities * n];
        descent.derivatives(&mut rows, &mut vec![0.0; inequalities * n]);
        for (factor, row) in descent.factors.iter_mut().zip(rows.chunks_exact(n.max(1))) {
            let length = row.iter().map(|v| v * v).sum::<f64>().sqrt();
            *factor = LENGTH / length.max(SHORT);
        }
        descent
    }

    /// A solver of the shape of this descent.
    pub(super) fn solver(&self) -> Solver {
        // A natural step: half a radian; lengths are linear, so a metre or two at a time.
        let natural = |id: &CoordinateId| match self.question.model.coordinate(*id).kind {
            CoordinateKind::Translation => 4.0,
            _ => 1.0,
        };
        let scale: Vec<f64> = self.question.coordinates.iter().map(natural).collect();
        let (equalities, inequalities) = self.shape();
        Solver::new(&scale, equalities, inequalities)
    }

    /// How many rows must vanish, and how many must not be negative.
    pub(super) fn shape(&self) -> (usize, usize) {
        let of = |entry| {
            let entries = (0..self.question.goals.goals.len()).filter(|&i| self.entry(i) == entry);
            entries.map(|i| self.question.rows_of(i).len()).sum::<usize>()
        };
        let equalities = self.closures.len() + of(Entry::Vanish);
        (equalities, self.question.limit_rows + of(Entry::NotNegative))
    }

    fn entry(&self, goal: usize) -> Entry {
        let goal = &self.question.goals.goals[goal];
        match (goal.weight, self.stage.exact) {
            (Some(weight), _) => Entry::Square(weight * self.stage.weighted),
            (None, Some(weight)) => Entry::Square(weight),
            (None, None) if goal.aim.is_one_sided() => Entry::NotNegative,
            (None, None) => Entry::Vanish,
        }
    }

    /// Poses the model with all derivatives and measures the goals.
    pub(super) fn evaluate_at(&mut self, stored: &[f64]) {
        let Self { question, pose, jacobian, closures, .. } = self;
        let (model, program) = (question.model, &question.program);
        let evaluated = program.evaluate_with_jacobian(stored, pose, jacobian);
        debug_assert!(evaluated.is_ok(), "buffers are made for this program");
        closures.update(model, program, pose, Some(jacobian));
        self.slopes.fill(0.0);
        let at = Evaluated { model, program, pose: &self.pose, jacobian: &self.jacobian };
        let tangents = model.tangent_len();
        for (i, goal) in question.goals.goals.iter().enumerate() {
            let rows = question.rows_of(i);
            let slopes = &mut self.slopes[rows.start * tangents..rows.end * tangents];
            let residuals = &mut self.residuals[rows];
            goal.aim.measure(at, &mut Rows { residuals, slopes, tangents });
        }
    }

    /// Whether a goal holds on one side of a plane, and the point is there.
    pub(super) fn is_met_aside(&self, goal: usize) -> bool {
        let one_sided = self.question.goals.goals[goal].aim.is_one_sided();
        one_sided && self.question.rows_of(goal).all(|row| self.residuals[row] > 0.0)
    }

    /// Squares that count, as (weight, residual, row) at the pose that was evaluated last.
    fn squares(&self) -> impl Iterator<Item = (f64, f64, usize)> + '_ {
        (0..self.question.goals.goals.len()).flat_map(move |goal| {
            let rows = self.question.rows_of(goal);
            let weight = match self.entry(goal) {
                Entry::Square(weight) if !self.is_met_aside(goal) => weight,
                _ => 0.0,
            };
            let counted = rows.map(move |row| (weight, self.residuals[row], row));
            counted.filter(|&(weight, ..)| weight > 0.0)
        })
    }

    /// How far coordinates are from rest: for each unknown the component of q - rest, or of the rotation
    /// vector from rest.
    fn off_rest(&self, unknown: usize) -> f64 {
        let stored = self.pose.effective();
        let id = self.question.coordinates[unknown];
        let place = self.question.model.stored_range(id);
        if let Some((place, ..)) = self.question.stored[unknown] {
            return stored[place] - self.stage.near.pose[place];
        }
        let of =
            |list: &[f64]| Quat::from(std::array::from_fn::<f64, 4, _>(|i| list[place.start + i]));
        let turn: Vec3 = (of(&self.stage.near.pose).conjugate() * of(stored)).normalized().log();
        let first = self.question.model.tangent_range(id).start;
        turn.to_array()[self.question.directions[unknown] - first]
    }

    fn stiffness(&self, unknown: usize) -> f64 {
        let stiffness = self.stage.near.stiffness[self.question.coordinates[unknown].index()];
        self.stage.rest * stiffness
    }

    /// For each sum of coordinates its weight, how far it is from rest, and its slopes by the unknowns.
    fn sums(&self) -> impl Iterator<Item = (f64, f64, Vec<(usize, f64)>)> + '_ {
        let (model, program) = (self.question.model, &self.question.program);
        self.stage.near.sums.iter().map(move |sum| {
            let value =
                |&(id, factor): &(CoordinateId, f64)| factor * self.pose.coordinate(model, id)[0];
            let off = sum.terms.iter().map(value).sum::<f64>() - sum.rest;
            let entries = sum.terms.iter().flat_map(|&(id, factor)| {
                let entries = program.coordinate_directions(model, id).iter();
                entries.map(move |&(direction, slot)| {
                    (direction, factor * self.jacobian.derivative(slot))
                })
            });
            let known = entries.filter_map(|(direction, slope)| {
                let unknown = self.question.unknowns[direction as usize];
                (unknown != FIXED).then_some((unknown as usize, slope))
            });
            (self.stage.rest * sum.stiffness, off, known.collect())
        })
    }

    /// R, with its factor in this stage, at the pose that was evaluated last.
    pub(super) fn rest_value(&self) -> f64 {
        let own = (0..self.question.unknown_len())
            .map(|unknown| self.stiffness(unknown) * self.off_rest(unknown).powi(2));
        own.sum::<f64>() + self.sums().map(|(weight, off, _)| weight * off * off).sum::<f64>()
    }

    /// What is minimised, at the pose that was evaluated last.
    pub(super) fn objective(&self) -> f64 {
        self.squares().map(|(weight, off, _)| weight * off * off).sum::<f64>() + self.rest_value()
    }

    fn slope(&self, row: usize, unknown: usize) -> f64 {
        let tangents = self.question.model.tangent_len();
        self.slopes[row * tangents + self.question.directions[unknown]]
    }

    /// The derivatives of all residuals by the unknowns.
    #[cfg(test)]
    pub(super) fn goal_rows(&self) -> Vec<f64> {
        let n = self.question.unknown_len();
        let rows = 0..self.question.rows();
        rows.flat_map(|row| (0..n).map(move |unknown| self.slope(row, unknown))).collect()
    }

    /// Whether an unknown moves a goal, or one of some rows.
    pub(super) fn moves(&self, unknown: usize, rows: &[f64]) -> bool {
        let n = self.question.unknown_len();
        let mut held = rows.iter().skip(unknown).step_by(n);
        held.any(|v| *v != 0.0)
            || (0..self.question.rows()).any(|row| self.slope(row, unknown) != 0.0)
    }

    /// The gradient of what is minimised.
    pub(super) fn gradient(&self, gradient: &mut [f64]) {
        for (unknown, entry) in gradient.iter_mut().enumerate() {
            *entry = 2.0 * self.stiffness(unknown) * self.off_rest(unknown);
        }
        for (weight, off, slopes) in self.sums() {
            slopes.iter().for_each(|&(i, slope)| gradient[i] += 2.0 * weight * off * slope);
        }
        for (weight, off, row) in self.squares() {
            for (unknown, entry) in gradient.iter_mut().enumerate() {
                *entry += 2.0 * weight * off * self.slope(row, unknown);
            }
        }
    }

    /// The lower triangle of the Hessian of Gauss and Newton.
    pub(super) fn hessian(&self, hessian: &mut [f64]) {
        let n = self.question.unknown_len();
        hessian.fill(0.0);
        for unknown in 0..n {
            hessian[unknown * n + unknown] = 2.0 * self.stiffness(unknown);
        }
        for (weight, _, slopes) in self.sums() {
            for &(i, slope) in &slopes {
                for &(j, other) in slopes.iter().filter(|(j, _)| *j <= i) {
                    hessian[i * n + j] += 2.0 * weight * slope * other;
                }
            }
        }
        for (weight, _, row) in self.squares() {
            let slopes: Vec<f64> = (0..n).map(|unknown| self.slope(row, unknown)).collect();
            for i in (0..n).filter(|&i| slopes[i] != 0.0) {
                for j in 0..=i {
                    hessian[i * n + j] += 2.0 * weight * slopes[i] * slopes[j];
                }
            }
        }
    }

    /// Writes the values of rows that must vanish, and of those that must not be negative.
    pub(super) fn values(&self, equalities: &mut [f64], inequalities: &mut [f64]) {
        let loops = self.closures.len();
        equalities[..loops].copy_from_slice(&self.closures.residuals);
        for (row, value) in inequalities[..self.question.limit_rows].iter_mut().enumerate() {
            *value = self.pose.limit_row(row);
        }
        let (mut equal, mut least) = (loops, self.question.limit_rows);
        for goal in 0..self.question.goals.goals.len() {
            for row in self.question.rows_of(goal) {
                match self.entry(goal) {
                    Entry::Square(_) => {}
                    Entry::Vanish => {
                        equalities[equal] = self.residuals[row];
                        equal += 1;
                    }
                    Entry::NotNegative => {
                        inequalities[least] = self.residuals[row];
                        least += 1;
                    }
                }
            }
        }
        equalities.iter_mut().zip(&self.factors).for_each(|(value, factor)| *value *= factor);
    }

    /// Writes the derivatives of the same rows by the unknowns.
    pub(super) fn derivatives(&self, equalities: &mut [f64], inequalities: &mut [f64]) {
        let n = self.question.unknown_len();
        let loops = self.closures.len();
        for (row, line) in equalities.chunks_exact_mut(n.max(1)).take(loops).enumerate() {
            let derivatives = self.closures.row(row);
            for (entry, &direction) in line.iter_mut().zip(&self.question.directions) {
                *entry = derivatives[direction];
            }
        }
        let limits = self.question.limit_rows;
        for (row, line) in inequalities.chunks_exact_mut(n.max(1)).take(limits).enumerate() {
            line.fill(0.0);
            for &(direction, slot) in self.question.program.limit_row_directions(row) {
                let unknown = self.question.unknowns[direction as usize] as usize;
                if let Some(entry) = line.get_mut(unknown) {
                    *entry += self.jacobian.derivative(slot);
                }
            }
        }
        let (mut equal, mut least) = (loops, limits);
        for goal in 0..self.question.goals.goals.len() {
            for row in self.question.rows_of(goal) {
                let (list, place) = match self.entry(goal) {
                    Entry::Square(_) => continue,
                    Entry::Vanish => (&mut *equalities, &mut equal),
                    Entry::NotNegative => (&mut *inequalities, &mut least),
                };
                for unknown in 0..n {
                    list[*place * n + unknown] = self.slope(row, unknown);
                }
                *place += 1;
            }
        }
        for (row, factor) in equalities.chunks_exact_mut(n.max(1)).zip(&self.factors) {
            row.iter_mut().for_each(|v| *v *= factor);
        }
    }

    /// Appends the rows of goals that enter as squares and are not met on their side.
    pub(super) fn squared_rows(&self, rows: &mut Vec<f64>) {
        for goal in 0..self.question.goals.goals.len() {
            if matches!(self.entry(goal), Entry::Square(_)) && !self.is_met_aside(goal) {
                for row in self.question.rows_of(goal) {
                    rows.extend((0..self.question.unknown_len()).map(|i| self.slope(row, i)));
                }
            }
        }
    }

    /// Whether the coordinate of an unknown is at its lower, and at its upper bound.
    pub(super) fn at_bounds(&self, unknown: usize) -> [bool; 2] {
        match self.question.stored[unknown] {
            Some((place, lower, upper)) => {
                let q = self.current[place];
                [q <= lower + ACTIVE, q >= upper - ACTIVE]
            }
            None => [false; 2],
        }
    }
}

impl Problem for Descent<'_> {
    fn evaluate(&mut self, step: &[f64], equalities: &mut [f64], inequalities: &mut [f64]) -> f64 {
        for (&direction, step) in self.question.directions.iter().zip(step) {
            self.tangent[direction] = *step;
        }
        let mut trial = std::mem::take(&mut self.trial);
        self.question.model.retract(&self.current, &self.tangent, &mut trial);
        self.question.clamp(&mut trial);
        self.evaluate_at(&trial);
        self.trial = trial;
        self.values(equalities, inequalities);
        self.objective()
    }

    fn accept(&mut self) {
        std::mem::swap(&mut self.current, &mut self.trial);
    }

    fn linearise(&mut self, local: &mut LocalModel) {
        let current = std::mem::take(&mut self.current);
        self.evaluate_at(&current);
        self.current = current;
        self.gradient(&mut local.gradient);
        self.derivatives(&mut local.equality_rows, &mut local.inequality_rows);
        for (unknown, stored) in self.question.stored.iter().enumerate() {
            (local.lower[unknown], local.upper[unknown]) = match *stored {
                Some((place, lower, upper)) => {
                    let q = self.current[place];
                    (lower - q, upper - q)
                }
                None => (f64::NEG_INFINITY, f64::INFINITY),
            };
        }
        // Where goals are squares and the last digits do not matter, the curvature is not worth its cost.
        if local.curved && self.stage.curved {
            self.curved_hessian(&mut local.hessian);
        } else {
            self.hessian(&mut local.hessian);
        }
    }
}
