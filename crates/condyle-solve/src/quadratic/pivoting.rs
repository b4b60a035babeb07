//! Block principal pivoting for programs without equalities.
//!
//! For a guess of the active bounds b and rows a the conditions are linear. With the factor
//! `H_ff = Uᵀ U` of the free variables f and the columns of `Y = U⁻ᵀ G_afᵀ`,
//!
//! ```text
//! d⁰_f = -H_ff⁻¹ (g_f + H_fb d_b),    Yᵀ Y w = h_a - G_a d⁰,    d_f = d⁰_f + U⁻¹ Y w
//! ```

use super::solution::add_symmetric_product;
use super::working_set::slack;
use super::{BoundState, Constraint, FEASIBILITY, OPTIMALITY, QuadraticProgram, Solution, Status};
use crate::cholesky::{self, axpy, dot};

/// How many rounds that do not reach a new minimum of the number of misplaced variables exchange
/// all of them; after that one variable is exchanged at a time.
const PATIENCE: u32 = 3;
/// Where less than this fraction of a squared row is not spanned by other rows, the dual method takes over.
const SPANNED: f64 = 1e-8;
/// Factorisations after which the dual method, whose steps are cheaper, is used instead.
const ROUNDS: u32 = 25;

#[derive(Debug, Clone)]
pub(super) struct Pivoting {
    /// The factor of the free block, `count × count`, at the front.
    factor: Vec<f64>,
    /// The free variables in ascending order, in the first `count` places.
    free: Vec<usize>,
    /// The right-hand side and solution of the free block.
    step: Vec<f64>,
    /// What a step of [`Pivoting::approach`] adds to it and to the multipliers, and the residual.
    change: Vec<f64>,
    raised: Vec<f64>,
    residual: Vec<f64>,
    /// `g + H d` with only the variables held at a bound in `d`, and the sum of the absolute terms.
    held_gradient: Vec<f64>,
    held_size: Vec<f64>,
    /// The state that each variable should have, and whether each row should be active.
    wanted: Vec<BoundState>,
    wanted_rows: Vec<bool>,
    /// The active rows, in the first `active` places, and their multipliers.
    rows: Vec<usize>,
    multipliers: Vec<f64>,
    /// `Yᵀ`, a row of `count` numbers for each active row, and the factor of `Yᵀ Y`.
    reached: Vec<f64>,
    schur: Vec<f64>,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Outcome {
    /// Optimal.
    Solved,
    /// No solution; the status gives the reason.
    Failed,
    /// Too many factorisations, or rows that depend on each other; the states are a warm start for the
    /// dual method.
    Stalled,
}

impl Pivoting {
    pub(super) fn new(n: usize, rows: usize) -> Self {
        // More active rows than free variables depend on each other.
        let most = n.min(rows);
        Self {
            factor: vec![0.0; n * n],
            free: vec![0; n],
            step: vec![0.0; n],
            change: vec![0.0; n],
            raised: vec![0.0; most],
            residual: vec![0.0; n],
            held_gradient: vec![0.0; n],
            held_size: vec![0.0; n],
            wanted: vec![BoundState::Free; n],
            wanted_rows: vec![false; rows],
            rows: vec![0; most],
            multipliers: vec![0.0; most],
            reached: vec![0.0; most * n],
            schur: vec![0.0; most * most],
        }
    }

    /// Solves `H_ff d_f = -(g_f + H_fb d_b)` for the free variables f, with those in b at their
    /// bounds.
    ///
    /// Returns the number of free variables, or the variable whose pivot failed.
    fn solve_free(
        &mut self,
        program: &QuadraticProgram<'_>,
        solution: &mut Solution,
    ) -> Result<usize, usize> {
        let n = program.n();
        let mut count = 0;
        self.held_gradient.copy_from_slice(program.gradient);
        for (size, g) in self.held_size.iter_mut().zip(program.gradient) {
            *size = g.abs();
        }
        for i in 0..n {
            let value = match solution.bounds[i] {
                BoundState::Free => {
                    self.free[count] = i;
                    count += 1;
                    continue;
                }
                BoundState::Upper => program.upper[i],
                BoundState::Lower | BoundState::Fixed => program.lower[i],
            };
            solution.d[i] = value;
            if value == 0.0 {
                continue;
            }
            // Only the lower triangle of H is given.
            for j in 0..n {
                let term = program.hessian[i.max(j) * n + i.min(j)] * value;
                self.held_gradient[j] += term;
                self.held_size[j] += term.abs();
            }
        }

        // Row j of the upper triangle is column j of the lower one: the transpose that
        // `factor_upper` reads. With all variables free the indices need no look-up.
        let factor = &mut self.factor[..count * count];
        if count == n {
            for i in 0..n {
                for (j, x) in program.hessian[i * n..i * n + i + 1].iter().enumerate() {
                    factor[j * n + i] = *x;
                }
            }
        } else {
            for (a, &i) in self.free[..count].iter().enumerate() {
                let row = &program.hessian[i * n..i * n + i + 1];
                for (b, &j) in self.free[..=a].iter().enumerate() {
                    factor[b * count + a] = row[j];
                }
            }
        }
        for (x, &i) in self.step.iter_mut().zip(&self.free[..count]) {
            *x = -self.held_gradient[i];
        }
        cholesky::factor_upper(factor, count).map_err(|failure| self.free[failure.index])?;
        cholesky::solve(factor, count, &mut self.step[..count]);
        for (x, &i) in self.step.iter().zip(&self.free[..count]) {
            solution.d[i] = *x;
        }
        Ok(count)
    }

    /// Moves the solution of [`Self::solve_free`] onto the active rows.
    ///
    /// Returns their number; `None` if they depend on each other, or nearly so.
    fn hold_rows(
        &mut self,
        program: &QuadraticProgram<'_>,
        solution: &mut Solution,
        count: usize,
    ) -> Option<usize> {
        let mut active = 0;
        for k in (0..solution.active_rows.len()).filter(|&k| solution.active_rows[k]) {
            *self.rows.get_mut(active)? = k;
            active += 1;
        }
        if active == 0 {
            return Some(0);
        }
        if active > count {
            return None;
        }
        let (factor, free) = (&self.factor[..count * count], &self.free[..count]);
        for (a, &k) in self.rows[..active].iter().enumerate() {
            let row = program.inequality_row(k);
            let (before, rest) = self.reached.split_at_mut(a * count);
            let column = &mut rest[..count];
            column.iter_mut().zip(free).for_each(|(x, &i)| *x = row[i]);
            cholesky::solve_forward(factor, count, column);
            for (b, other) in before.chunks_exact(count).enumerate() {
                self.schur[b * active + a] = dot(other, column);
            }
            self.schur[a * active + a] = dot(column, column);
        }
        let schur = &mut self.schur[..active * active];
        cholesky::factor_upper(schur, active).ok()?;
        // A pivot is the square of the part of a row that those before it do not span.
        let mut columns = self.reached.chunks_exact(count).take(active).enumerate();
        if columns.any(|(a, y)| schur[a * active + a].powi(2) < SPANNED * dot(y, y)) {
            return None;
        }
        self.multipliers[..active].fill(0.0);
        // The second step is iterative refinement.
        (0..2).for_each(|_| self.approach(program, solution, count, active));
        Some(active)
    }

    /// One Newton step on the conditions, with the active rows as equalities. They are linear: it leads
    /// from any `d` and multipliers to the solution.
    fn approach(
        &mut self,
        program: &QuadraticProgram<'_>,
        solution: &mut Solution,
        count: usize,
        active: usize,
    ) {
        let (factor, free) = (&self.factor[..count * count], &self.free[..count]);
        let schur = &self.schur[..active * active];
        let rows = &self.rows[..active];
        // ρ = g + H d - Gᵀ w, and δ⁰ = -H_ff⁻¹ ρ_f.
        let rho = &mut self.residual;
        rho.copy_from_slice(program.gradient);
        add_symmetric_product(program.hessian, &solution.d, rho);
        for (&w, &k) in self.multipliers.iter().zip(rows) {
            axpy(rho, -w, program.inequality_row(k));
        }
        let change = &mut self.change[..count];
        change.iter_mut().zip(free).for_each(|(x, &i)| *x = -rho[i]);
        cholesky::solve(factor, count, change);
        // Yᵀ Y δw = h_a - G_a (d + δ⁰)
        let raised = &mut self.raised[..active];
        for (x, &k) in raised.iter_mut().zip(rows) {
            let row = program.inequality_row(k);
            let moved: f64 = change.iter().zip(free).map(|(x, &i)| row[i] * x).sum();
            *x = -slack(program, Constraint::Inequality(k), &solution.d) - moved;
        }
        cholesky::solve(schur, active, raised);
        axpy(&mut self.multipliers[..active], 1.0, raised);
        // δd_f = δ⁰ + U⁻¹ Y δw
        let along = &mut self.residual[..count];
        along.fill(0.0);
        for (&w, column) in raised.iter().zip(self.reached.chunks_exact(count)) {
            axpy(along, w, column);
        }
        cholesky::solve_backward(factor, count, along);
        for (((x, first), along), &i) in self.step.iter_mut().zip(&*change).zip(&*along).zip(free) {
            solution.d[i] += first + along;
            *x = solution.d[i];
        }
    }

    /// Counts the variables and rows in the wrong state, and sets what is wanted; fills the multipliers.
    ///
    /// A free variable or an inactive row is misplaced if it is violated, a held or active one if its
    /// multiplier has the wrong sign.
    fn misplaced(
        &mut self,
        program: &QuadraticProgram<'_>,
        solution: &mut Solution,
        free: usize,
        active: usize,
    ) -> usize {
        let n = program.n();
        let size = self.step[..free].iter().fold(0.0, |m: f64, x| m.max(x.abs()));
        let mut count = 0;
        for i in 0..n {
            let state = solution.bounds[i];
            self.wanted[i] = state;
            if state == BoundState::Free {
                solution.bound_multipliers[i] = 0.0;
                let (x, lower, upper) = (solution.d[i], program.lower[i], program.upper[i]);
                if x < lower - FEASIBILITY * (lower.abs() + size) {
                    self.wanted[i] = BoundState::Lower;
                } else if x > upper + FEASIBILITY * (upper.abs() + size) {
                    self.wanted[i] = BoundState::Upper;
                }
            } else {
                // z = g + H d - Gᵀ w in this row, with the free variables added; `scale` bounds its
                // rounding.
                let (mut z, mut scale) = (self.held_gradient[i], self.held_size[i]);
                let mut add = |term: f64| {
                    z += term;
                    scale += term.abs();
                };
                for (x, &j) in self.step.iter().zip(&self.free[..free]) {
                    add(program.hessian[i.max(j) * n + i.min(j)] * x);
                }
                for (w, &k) in self.multipliers.iter().zip(&self.rows[..active]) {
                    add(-w * program.inequality_row(k)[i]);
                }
                solution.bound_multipliers[i] = z;
                let wrong = match state {
                    BoundState::Lower => -z,
                    BoundState::Upper => z,
                    BoundState::Free | BoundState::Fixed => f64::NEG_INFINITY,
                };
                if wrong > OPTIMALITY * scale {
                    self.wanted[i] = BoundState::Free;
                }
            }
            count += usize::from(self.wanted[i] != state);
        }
        let (mut steep, mut length) = (0.0_f64, 0.0);
        if !self.wanted_rows.is_empty() {
            steep = program.gradient.iter().fold(0.0, |m, x| m.max(x.abs()));
            length = dot(&solution.d, &solution.d).sqrt();
        }
        let mut multipliers = self.multipliers[..active].iter();
        for (k, wanted) in self.wanted_rows.iter_mut().enumerate() {
            let row = program.inequality_row(k);
            let norm = dot(row, row).sqrt();
            let state = solution.active_rows[k];
            *wanted = if state {
                let w = multipliers.next().copied().unwrap_or(0.0);
                solution.inequality_multipliers[k] = w;
                w * norm >= -OPTIMALITY * steep.max(w.abs())
            } else {
                solution.inequality_multipliers[k] = 0.0;
                let value = program.inequality_values[k];
                let tolerance = FEASIBILITY * (value.abs() + norm * length);
                // Written so that it is true for NaN, which the dual method reports.
                let kept = value == f64::NEG_INFINITY
                    || (tolerance < f64::INFINITY
                        && slack(program, Constraint::Inequality(k), &solution.d) >= -tolerance);
                !kept
            };
            count += usize::from(*wanted != state);
        }
        count
    }
}

/// Minimises `program`, which has no equalities, from the states in `solution`.
pub(super) fn solve(
    program: &QuadraticProgram<'_>,
    work: &mut Pivoting,
    solution: &mut Solution,
    limit: u32,
) -> Outcome {
    let n = program.n();
    let mut best = usize::MAX;
    let mut patience = PATIENCE;
    while solution.iterations < limit.min(ROUNDS) {
        solution.iterations += 1;
        let free = match work.solve_free(program, solution) {
            Ok(free) => free,
            Err(variable) => {
                solution.status = Status::NotPositiveDefinite { variable };
                return Outcome::Failed;
            }
        };
        let Some(active) = work.hold_rows(program, solution, free) else {
            return Outcome::Stalled;
        };
        let count = work.misplaced(program, solution, free, active);
        if count == 0 {
            for i in 0..n {
                // Within the tolerances a free variable may violate its bound and a multiplier may
                // have the wrong sign: both are clamped.
                solution.d[i] = solution.d[i].clamp(program.lower[i], program.upper[i]);
                let z = &mut solution.bound_multipliers[i];
                match solution.bounds[i] {
                    BoundState::Lower => *z = z.max(0.0),
                    BoundState::Upper => *z = z.min(0.0),
                    BoundState::Free | BoundState::Fixed => {}
                }
            }
            solution.inequality_multipliers.iter_mut().for_each(|w| *w = w.max(0.0));
            return Outcome::Solved;
        }
        if count < best {
            best = count;
            patience = PATIENCE;
        } else {
            patience = patience.saturating_sub(1);
        }
        // Block exchange, or Murty's rule, which rows have no part in: always the misplaced variable with
        // the largest index.
        let rows = work.wanted_rows.contains(&true) || active > 0;
        if patience > 0 {
            solution.bounds.copy_from_slice(&work.wanted);
            solution.active_rows.copy_from_slice(&work.wanted_rows);
        } else if rows {
            return Outcome::Stalled;
        } else if let Some(last) = (0..n).rev().find(|&i| work.wanted[i] != solution.bounds[i]) {
            solution.bounds[last] = work.wanted[last];
        }
    }
    if solution.iterations >= limit {
        solution.status = Status::IterationLimit;
        return Outcome::Failed;
    }
    Outcome::Stalled
}
