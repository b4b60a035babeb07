//! The dual active-set method of Goldfarb and Idnani (1983), with bounds as unit rows.

use super::working_set::{WorkingSet, limit, mark, slack};
use super::{
    BoundState, Constraint, DEPENDENCE, FEASIBILITY, OPTIMALITY, QuadraticProgram, Solution, Status,
};
use crate::cholesky::dot;

/// An equality row shorter than this fraction of the longest is taken for zero.
const NULL_ROW: f64 = 1e-12;
/// Dependent rows may disagree by this fraction of the values that are compared.
const CONSISTENCY_RELATIVE: f64 = 1e-8;
/// A violation below this fraction of the unconstrained step is rounding.
const ROUNDING: f64 = 1e-20;

/// Whether the point satisfies all inequality rows.
pub(super) fn rows_satisfied(program: &QuadraticProgram<'_>, solution: &Solution) -> bool {
    let d = &solution.d;
    let size = dot(d, d).sqrt();
    (0..program.inequality_values.len()).all(|k| {
        let row = program.inequality_row(k);
        let value = program.inequality_values[k];
        let tolerance = FEASIBILITY * (value.abs() + dot(row, row).sqrt() * size);
        // False for what is not a number, or infinite in the wrong place: the dual method reports it.
        value == f64::NEG_INFINITY
            || (tolerance < f64::INFINITY
                && slack(program, Constraint::Inequality(k), d) >= -tolerance)
    })
}

/// Minimises over all constraints of `program` from the active set in `solution`.
pub(super) fn solve(
    program: &QuadraticProgram<'_>,
    set: &mut WorkingSet,
    solution: &mut Solution,
    iteration_limit: u32,
    consistency: f64,
) {
    let mut run = Run { program, set, solution, iteration_limit, consistency, floor: 0.0 };
    run.solution.status = Status::Solved;
    if let Err(stop) = run.solve() {
        run.solution.status = stop;
    }
    run.set.report(program, run.solution);
}

struct Run<'a> {
    program: &'a QuadraticProgram<'a>,
    set: &'a mut WorkingSet,
    solution: &'a mut Solution,
    iteration_limit: u32,
    consistency: f64,
    /// Violations up to this distance pass: rounding in `d`, from the size of the unconstrained step,
    /// and what dependent constraints were found to disagree by.
    floor: f64,
}

impl Run<'_> {
    fn solve(&mut self) -> Result<(), Status> {
        self.set
            .begin(self.program)
            .map_err(|failure| Status::NotPositiveDefinite { variable: failure.index })?;
        self.check_rows()?;
        self.solution.d.fill(0.0);
        self.set.refine(self.program, &mut self.solution.d);
        self.floor = ROUNDING * dot(&self.solution.d, &self.solution.d).sqrt();
        self.add_equalities()?;
        self.add_last_active();
        self.settle()?;

        // Whether `d` is as exact as the factorisation allows; steps leave rounding behind.
        let mut polished = true;
        // Whether the claim of infeasibility would be made on exact numbers.
        let mut confirmed = false;
        loop {
            match self.most_violated() {
                None if polished => return Ok(()),
                None => {
                    self.settle()?;
                    polished = true;
                }
                Some(constraint) => match self.enforce(constraint, polished)? {
                    true => (polished, confirmed) = (false, false),
                    false if confirmed => self.forgive(constraint)?,
                    false => {
                        self.settle()?;
                        (polished, confirmed) = (true, true);
                    }
                },
            }
        }
    }

    /// Numbers that must be finite are; a row `G_k d ≥ ∞` cannot hold.
    fn check_rows(&mut self) -> Result<(), Status> {
        let finite = |x: &[f64]| x.iter().all(|x| x.is_finite());
        let values = self.program.inequality_values;
        if !finite(&self.set.equality_norms)
            || !finite(&self.set.inequality_norms)
            || !finite(self.program.equality_values)
            || values.iter().any(|h| h.is_nan())
        {
            return Err(Status::NotFinite);
        }
        if let Some(k) = values.iter().position(|&h| h == f64::INFINITY) {
            self.solution.conflict.push(Constraint::Inequality(k));
            return Err(Status::Infeasible);
        }
        Ok(())
    }

    fn count(&mut self) -> Result<(), Status> {
        if self.solution.iterations >= self.iteration_limit {
            return Err(Status::IterationLimit);
        }
        self.solution.iterations += 1;
        Ok(())
    }

    /// Makes fixed variables and equality rows members; drops dependent ones that agree.
    fn add_equalities(&mut self) -> Result<(), Status> {
        for i in 0..self.program.n() {
            if self.solution.bounds[i] == BoundState::Fixed {
                // Unit rows are independent of each other.
                self.set.transform(self.program, Constraint::Lower(i));
                self.set.add(Constraint::Lower(i), 0.0);
            }
        }
        let longest = self.set.equality_norms.iter().fold(0.0, |m: f64, x| m.max(*x));
        for k in 0..self.program.equality_values.len() {
            let row = Constraint::Equality(k);
            let independent = self.set.transform(self.program, row);
            let null = self.set.equality_norms[k] <= NULL_ROW * longest;
            if independent && !null {
                self.set.add(row, 0.0);
                continue;
            }
            let (rest, size) = if null {
                let value = self.program.equality_values[k].abs();
                (value, value)
            } else {
                self.disagreement(row)
            };
            if rest.abs() > CONSISTENCY_RELATIVE * size + self.consistency * longest {
                if null {
                    self.solution.conflict.push(row);
                } else {
                    self.blame(row);
                }
                return Err(Status::Infeasible);
            }
        }
        self.set.equalities = self.set.members().len();
        Ok(())
    }

    /// Makes the active set of the last call members, as far as it is independent.
    fn add_last_active(&mut self) {
        for i in 0..self.program.n() {
            match self.solution.bounds[i] {
                BoundState::Lower => self.add_if_independent(Constraint::Lower(i)),
                BoundState::Upper => self.add_if_independent(Constraint::Upper(i)),
                BoundState::Free | BoundState::Fixed => {}
            }
        }
        for k in 0..self.program.inequality_values.len() {
            if self.solution.active_rows[k] {
                let row = Constraint::Inequality(k);
                if self.program.inequality_values[k] == f64::NEG_INFINITY {
                    mark(self.solution, row, false);
                } else {
                    self.add_if_independent(row);
                }
            }
        }
    }

    fn add_if_independent(&mut self, constraint: Constraint) {
        let independent = self.set.transform(self.program, constraint);
        if independent {
            self.set.add(constraint, 0.0);
        }
        mark(self.solution, constraint, independent);
    }

    /// Solves with the members as equalities, dropping inequalities whose multiplier is negative: `d`
    /// is then the minimiser over the members.
    fn settle(&mut self) -> Result<(), Status> {
        self.count()?;
        loop {
            self.set.refine(self.program, &mut self.solution.d);
            let size = self.set.refine(self.program, &mut self.solution.d);
            let mut worst = None;
            let mut least = -OPTIMALITY * size;
            for k in self.set.equalities..self.set.members().len() {
                let push = self.set.u[k] * self.set.norm(self.set.members()[k]);
                if push < least {
                    (worst, least) = (Some(k), push);
                }
            }
            let Some(k) = worst else { break };
            self.count()?;
            let dropped = self.set.drop_member(k);
            mark(self.solution, dropped, false);
        }
        let inequalities = self.set.equalities..self.set.members().len();
        for u in &mut self.set.u[inequalities] {
            *u = u.max(0.0);
        }
        Ok(())
    }

    /// The inactive constraint that `d` violates by the largest distance.
    fn most_violated(&self) -> Option<Constraint> {
        let d = &self.solution.d;
        let size = FEASIBILITY * dot(d, d).sqrt() + self.floor;
        let mut worst = (0.0, None);
        // `slack` and `value` in units of d.
        let mut consider = |constraint, slack: f64, value: f64| {
            if slack < -(FEASIBILITY * value.abs() + size) && slack < worst.0 {
                worst = (slack, Some(constraint));
            }
        };
        for i in 0..d.len() {
            if self.solution.bounds[i] == BoundState::Free {
                let (lower, upper) = (self.program.lower[i], self.program.upper[i]);
                if d[i] < lower {
                    consider(Constraint::Lower(i), d[i] - lower, lower);
                } else if d[i] > upper {
                    consider(Constraint::Upper(i), upper - d[i], upper);
                }
            }
        }
        for (k, &value) in self.program.inequality_values.iter().enumerate() {
            if !self.solution.active_rows[k] && value > f64::NEG_INFINITY {
                let row = Constraint::Inequality(k);
                let norm = self.set.inequality_norms[k];
                let scale = if norm > 0.0 { 1.0 / norm } else { 1.0 };
                consider(row, slack(self.program, row, d) * scale, value * scale);
            }
        }
        worst.1
    }

    /// Raises the multiplier of a violated constraint until it is satisfied, dropping members whose
    /// multipliers reach zero on the way. `false` if that never ends, since the dual is unbounded, or
    /// if the constraint depends on the members and `d` is not exact enough to say that it is violated.
    fn enforce(&mut self, constraint: Constraint, exact: bool) -> Result<bool, Status> {
        let mut multiplier = 0.0;
        loop {
            self.count()?;
            let independent = self.set.transform(self.program, constraint);
            if !independent && !exact {
                return Ok(false);
            }
            let (q, equalities) = (self.set.members().len(), self.set.equalities);

            // Coefficients below the threshold are rounding; it is wider where dividing by them would
            // be the only way to go on.
            let threshold = if independent { 1e-2 * DEPENDENCE } else { DEPENDENCE }
                * self.set.norm(constraint);
            let mut partial = (f64::INFINITY, 0);
            for k in equalities..q {
                let r = self.set.coefficients[k];
                if r * self.set.norm(self.set.members()[k]) > threshold {
                    let t = self.set.u[k] / r;
                    if t < partial.0 {
                        partial = (t, k);
                    }
                }
            }
            let tail = &self.set.transformed[q..];
            let full = if independent {
                (-slack(self.program, constraint, &self.solution.d) / dot(tail, tail)).max(0.0)
            } else {
                f64::INFINITY
            };
            let t = partial.0.min(full);
            if t == f64::INFINITY {
                return Ok(false);
            }

            if independent {
                self.set.step(t, &mut self.solution.d);
            }
            multiplier += t;
            for k in 0..q {
                let u = self.set.u[k] - t * self.set.coefficients[k];
                self.set.u[k] = if k < equalities { u } else { u.max(0.0) };
            }
            if full <= partial.0 {
                self.set.add(constraint, multiplier);
                mark(self.solution, constraint, true);
                return Ok(true);
            }
            let dropped = self.set.drop_member(partial.1);
            mark(self.solution, dropped, false);
        }
    }

    /// By how much the limit of a dependent constraint, last transformed, exceeds what the limits of
    /// the members imply for it, and the sum of the absolute values compared.
    fn disagreement(&self, constraint: Constraint) -> (f64, f64) {
        let value = limit(self.program, constraint);
        let (mut rest, mut size) = (value, value.abs());
        for (r, &member) in self.set.coefficients.iter().zip(self.set.members()) {
            let term = r * limit(self.program, member);
            rest -= term;
            size += term.abs();
        }
        (rest, size)
    }

    /// Accepts that a dependent constraint is violated if that is within what dependent rows may
    /// disagree by; otherwise no point satisfies all constraints.
    fn forgive(&mut self, constraint: Constraint) -> Result<(), Status> {
        let norm = self.set.norm(constraint);
        let (rest, size) = self.disagreement(constraint);
        let violation = -slack(self.program, constraint, &self.solution.d);
        if rest.max(violation) > CONSISTENCY_RELATIVE * size + self.consistency * norm {
            self.blame(constraint);
            return Err(Status::Infeasible);
        }
        self.floor += 2.0 * violation.max(0.0) / norm;
        Ok(())
    }

    /// Notes a dependent constraint and the members it contradicts.
    fn blame(&mut self, constraint: Constraint) {
        let threshold = DEPENDENCE * self.set.norm(constraint);
        let conflict = &mut self.solution.conflict;
        conflict.push(constraint);
        for (&member, r) in self.set.members().iter().zip(&self.set.coefficients) {
            if r.abs() * self.set.norm(member) > threshold {
                conflict.push(member);
            }
        }
    }
}
