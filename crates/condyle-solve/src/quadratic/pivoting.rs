//! Block principal pivoting for programs with bounds only.

use super::{BoundState, FEASIBILITY, OPTIMALITY, QuadraticProgram, Solution, Status};
use crate::cholesky;

/// How many rounds that do not reach a new minimum of the number of misplaced variables exchange
/// all of them; after that one variable is exchanged at a time.
const PATIENCE: u32 = 3;
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
    /// `g + H d` with only the variables held at a bound in `d`, and the sum of the absolute terms.
    held_gradient: Vec<f64>,
    held_size: Vec<f64>,
    /// The state that each variable should have.
    wanted: Vec<BoundState>,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Outcome {
    /// Optimal over the bounds.
    Solved,
    /// No solution; the status gives the reason.
    Failed,
    /// Too many factorisations; the states are a warm start for the dual method.
    Stalled,
}

impl Pivoting {
    pub(super) fn new(n: usize) -> Self {
        Self {
            factor: vec![0.0; n * n],
            free: vec![0; n],
            step: vec![0.0; n],
            held_gradient: vec![0.0; n],
            held_size: vec![0.0; n],
            wanted: vec![BoundState::Free; n],
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

    /// Counts the variables in the wrong state and sets `wanted`; fills the bound multipliers.
    ///
    /// A free variable is misplaced if it violates a bound, a held one if its multiplier has the
    /// wrong sign.
    fn misplaced(
        &mut self,
        program: &QuadraticProgram<'_>,
        solution: &mut Solution,
        free: usize,
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
                // z = g + H d in this row, with the free variables added; `scale` bounds its
                // rounding.
                let (mut z, mut scale) = (self.held_gradient[i], self.held_size[i]);
                for (x, &j) in self.step.iter().zip(&self.free[..free]) {
                    let term = program.hessian[i.max(j) * n + i.min(j)] * x;
                    z += term;
                    scale += term.abs();
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
        count
    }
}

/// Minimises over the bounds of `program` from the states in `solution`.
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
        let count = work.misplaced(program, solution, free);
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
            return Outcome::Solved;
        }
        if count < best {
            best = count;
            patience = PATIENCE;
        } else {
            patience = patience.saturating_sub(1);
        }
        // Block exchange, or Murty's rule: always the misplaced variable with the largest index.
        if patience > 0 {
            solution.bounds.copy_from_slice(&work.wanted);
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
