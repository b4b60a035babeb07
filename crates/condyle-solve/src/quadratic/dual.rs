//! The dual active-set method of Goldfarb and Idnani (1983), with bounds as unit rows.

use super::working_set::{WorkingSet, limit, mark, slack};
use super::{
    BoundState, Constraint, DEPENDENCE, FEASIBILITY, OPTIMALITY, QuadraticProgram, Solution, Status,
};
use crate::cholesky::dot;

/// An equality row with a norm below this fraction of the largest counts as zero.
const NULL_ROW: f64 = 1e-12;
/// The right-hand sides of dependent rows may differ by this fraction of the terms compared.
const CONSISTENCY_RELATIVE: f64 = 1e-8;
/// A violation below this fraction of the norm of the unconstrained minimiser is not enforced.
const ROUNDING: f64 = 1e-20;

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
    /// Violations up to this distance are not enforced: a part for rounding, relative to the
    /// unconstrained minimiser, plus the accepted inconsistency of dependent constraints.
    floor: f64,
}

impl Run<'_> {
    fn solve(&mut self) -> Result<(), Status> {
        self.set
            .begin(self.program)
            .map_err(|failure| Status::NotPositiveDefinite { variable: failure.index })?;
        self.check_rows()?;
        // With no members one Newton step from 0 is the unconstrained minimiser -H⁻¹ g.
        self.solution.d.fill(0.0);
        self.set.refine(self.program, &mut self.solution.d);
        self.floor = ROUNDING * dot(&self.solution.d, &self.solution.d).sqrt();
        self.add_equalities()?;
        self.add_last_active();
        self.settle()?;

        // Whether `d` was refined since the last step; steps accumulate rounding errors.
        let mut polished = true;
        // Whether the failure to enforce a constraint was repeated after a refinement.
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

    /// Checks that rows and values are finite; a row `G_k d ≥ ∞` cannot hold.
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

    /// Adds fixed variables and equality rows as members; skips dependent rows that are consistent.
    fn add_equalities(&mut self) -> Result<(), Status> {
        for i in 0..self.program.n() {
            if self.solution.bounds[i] == BoundState::Fixed {
                // Unit rows are linearly independent: no check is needed.
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

    /// Adds the active set of the last call, as far as it is linearly independent.
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
                // The row may have been switched off since the last call.
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

    /// Solves with the members as equalities, dropping inequalities with a negative multiplier
    /// until none is left: `d` is then the minimiser subject to the members, and dual feasible.
    fn settle(&mut self) -> Result<(), Status> {
        self.count()?;
        loop {
            // The second Newton step is iterative refinement.
            self.set.refine(self.program, &mut self.solution.d);
            let size = self.set.refine(self.program, &mut self.solution.d);
            let mut worst = None;
            let mut least = -OPTIMALITY * size;
            for k in self.set.equalities..self.set.members().len() {
                // Multiplier times norm: independent of the scale of the row.
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

    /// The inactive constraint that `d` violates by the largest Euclidean distance.
    fn most_violated(&self) -> Option<Constraint> {
        let d = &self.solution.d;
        let size = FEASIBILITY * dot(d, d).sqrt() + self.floor;
        let mut worst = (0.0, None);
        // `slack` and `value` are divided by the norm of the row: distances in the unit of d.
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

    /// Increases the multiplier of a violated constraint until it is satisfied, dropping members
    /// whose multipliers reach zero on the way (Goldfarb and Idnani, step 2). Returns `false` if
    /// the dual is unbounded, or if the constraint depends linearly on the members and `d` was not
    /// refined, so that its violation may be rounding.
    fn enforce(&mut self, constraint: Constraint, exact: bool) -> Result<bool, Status> {
        let mut multiplier = 0.0;
        loop {
            self.count()?;
            let independent = self.set.transform(self.program, constraint);
            if !independent && !exact {
                return Ok(false);
            }
            let (q, equalities) = (self.set.members().len(), self.set.equalities);

            // Dual ratio test: the multiplier of member k falls by r_k per unit of t, and the first
            // to reach zero limits the step. Coefficients below the threshold count as zero; it is
            // larger for a dependent constraint, where such a coefficient alone would determine the
            // step.
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
            // The step z = J₂ J₂ᵀ n changes the slack by nᵀ z = |J₂ᵀ n|² per unit of t; it is not 0
            // for an independent constraint. A dependent one cannot be reached by moving d.
            let tail = &self.set.transformed[q..];
            let full = if independent {
                (-slack(self.program, constraint, &self.solution.d) / dot(tail, tail)).max(0.0)
            } else {
                f64::INFINITY
            };
            let t = partial.0.min(full);
            // No limit on the multiplier: the dual is unbounded and the primal infeasible.
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

    /// For a dependent constraint n = Σ r_k n_k, last transformed: its right-hand side less the one
    /// that the members imply, b - Σ r_k b_k, and the sum of the absolute terms.
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

    /// Accepts the violation of a dependent constraint within the consistency tolerance; beyond it
    /// the program is infeasible.
    fn forgive(&mut self, constraint: Constraint) -> Result<(), Status> {
        let norm = self.set.norm(constraint);
        let (rest, size) = self.disagreement(constraint);
        let violation = -slack(self.program, constraint, &self.solution.d);
        if rest.max(violation) > CONSISTENCY_RELATIVE * size + self.consistency * norm {
            self.blame(constraint);
            return Err(Status::Infeasible);
        }
        // Twice the violation, so that the same constraint is not selected again.
        self.floor += 2.0 * violation.max(0.0) / norm;
        Ok(())
    }

    /// Reports a dependent constraint and the members that it contradicts: those with a nonzero
    /// coefficient in its linear combination.
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
