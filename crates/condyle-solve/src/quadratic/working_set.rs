//! The active constraints of the dual method and their factorisation.
//!
//! With `H = L Lᵀ`, an orthogonal `Q` and the matrix `N` whose columns are the normals of the active
//! constraints, the method maintains `J = L⁻ᵀ Q` such that
//!
//! ```text
//! Jᵀ H J = 1        Jᵀ N = [R; 0],  R upper triangular
//! ```
//!
//! The first `q` columns of `J`, one for each member, are `J₁`; the others, `J₂`, span the
//! directions that keep all members active. `Jᵀ` is stored by rows and `R` by columns, so that
//! reflections, rotations and triangular solves run over contiguous memory.

use super::solution::add_symmetric_product;
use super::{BoundState, Constraint, DEPENDENCE, QuadraticProgram, Solution};
use crate::cholesky::{self, PivotFailure, axpy, dot, subtract_rows};

#[derive(Debug, Clone)]
pub(super) struct WorkingSet {
    n: usize,
    /// `Jᵀ`, `n × n` row-major.
    jt: Vec<f64>,
    /// `R`, column `k` at `k * n .. k * n + k + 1`.
    r: Vec<f64>,
    /// The active constraints in the order of the columns of `R`; equalities come first.
    members: Vec<Constraint>,
    /// The number of members at the front that are equalities and are never dropped.
    pub(super) equalities: usize,
    /// The multipliers of the members.
    pub(super) u: Vec<f64>,
    /// `Jᵀ` times the normal last given to [`WorkingSet::transform`].
    pub(super) transformed: Vec<f64>,
    /// `R⁻¹` times its first `q` entries: the coefficients of the normal in those of the members.
    pub(super) coefficients: Vec<f64>,
    scratch: Vec<f64>,
    residual: Vec<f64>,
    pub(super) equality_norms: Vec<f64>,
    pub(super) inequality_norms: Vec<f64>,
}

impl WorkingSet {
    pub(super) fn new(n: usize, equalities: usize, inequalities: usize) -> Self {
        Self {
            n,
            jt: vec![0.0; n * n],
            r: vec![0.0; n * n],
            members: Vec::with_capacity(n),
            equalities: 0,
            u: vec![0.0; n],
            transformed: vec![0.0; n],
            coefficients: vec![0.0; n],
            scratch: vec![0.0; n],
            residual: vec![0.0; n],
            equality_norms: vec![0.0; equalities],
            inequality_norms: vec![0.0; inequalities],
        }
    }

    /// Factors `H` and clears the set: `Q = 1`, so `Jᵀ = L⁻¹`.
    pub(super) fn begin(&mut self, program: &QuadraticProgram<'_>) -> Result<(), PivotFailure> {
        let n = self.n;
        self.members.clear();
        self.equalities = 0;
        // `r` is unused until the first member is added: it holds the Cholesky factor meanwhile.
        for i in 0..n {
            for (j, x) in program.hessian[i * n..i * n + i + 1].iter().enumerate() {
                self.r[j * n + i] = *x;
            }
        }
        cholesky::factor_upper(&mut self.r, n)?;
        cholesky::invert_lower(&self.r, n, &mut self.jt);
        for k in 0..self.equality_norms.len() {
            let row = program.equality_row(k);
            self.equality_norms[k] = dot(row, row).sqrt();
        }
        for k in 0..self.inequality_norms.len() {
            let row = program.inequality_row(k);
            self.inequality_norms[k] = dot(row, row).sqrt();
        }
        Ok(())
    }

    pub(super) fn members(&self) -> &[Constraint] {
        &self.members
    }

    /// The Euclidean norm of a constraint's normal.
    pub(super) fn norm(&self, constraint: Constraint) -> f64 {
        match constraint {
            Constraint::Lower(_) | Constraint::Upper(_) => 1.0,
            Constraint::Equality(k) => self.equality_norms[k],
            Constraint::Inequality(k) => self.inequality_norms[k],
        }
    }

    /// Computes `Jᵀ n` for the normal `n` of a constraint; `true` if it is linearly independent of
    /// the members.
    pub(super) fn transform(
        &mut self,
        program: &QuadraticProgram<'_>,
        constraint: Constraint,
    ) -> bool {
        let (n, q) = (self.n, self.members.len());
        let (row, sign, column) = match constraint {
            Constraint::Lower(i) => (None, 1.0, i),
            Constraint::Upper(i) => (None, -1.0, i),
            Constraint::Equality(k) => (Some(program.equality_row(k)), 1.0, 0),
            Constraint::Inequality(k) => (Some(program.inequality_row(k)), 1.0, 0),
        };
        for k in 0..n {
            let basis = &self.jt[k * n..(k + 1) * n];
            self.transformed[k] = row.map_or_else(|| sign * basis[column], |row| dot(row, basis));
        }
        self.coefficients[..q].copy_from_slice(&self.transformed[..q]);
        solve_upper(&self.r, n, &mut self.coefficients[..q]);
        // |Jᵀ n|² = nᵀ H⁻¹ n; the tail is the part that the members do not span.
        let tail = &self.transformed[q..];
        let all = dot(&self.transformed, &self.transformed);
        dot(tail, tail) > DEPENDENCE * DEPENDENCE * all
    }

    /// `d += t z` with `z = J₂ J₂ᵀ n`, the direction that keeps all members active.
    pub(super) fn step(&self, t: f64, d: &mut [f64]) {
        let q = self.members.len();
        subtract_rows(d, &self.jt, self.n, 0, |k| -t * self.transformed[k], q..self.n);
    }

    /// Adds the constraint last transformed, which must be independent.
    pub(super) fn add(&mut self, constraint: Constraint, u: f64) {
        let (n, q) = (self.n, self.members.len());
        let tail = &mut self.transformed[q..];
        let mut corner = tail[0];
        if tail.len() > 1 {
            // Householder reflection of the tail onto its first axis: v = tail - corner e₁,
            // P = 1 - β v vᵀ, β = 2 / vᵀv. With corner opposite in sign to tail[0] nothing cancels.
            let norm = dot(tail, tail).sqrt();
            corner = -norm.copysign(tail[0]);
            let beta = 1.0 / (norm * (norm + tail[0].abs()));
            tail[0] -= corner;
            let rows = &mut self.jt[q * n..];
            let sum = &mut self.scratch;
            sum.fill(0.0);
            subtract_rows(sum, rows, n, 0, |k| -tail[k], 0..n - q);
            for (row, v) in rows.chunks_exact_mut(n).zip(&*tail) {
                axpy(row, -beta * v, sum);
            }
        }
        self.r[q * n..q * n + q].copy_from_slice(&self.transformed[..q]);
        self.r[q * n + q] = corner;
        self.u[q] = u;
        self.members.push(constraint);
    }

    /// Removes member `k` and restores the triangular form by Givens rotations.
    pub(super) fn drop_member(&mut self, k: usize) -> Constraint {
        let n = self.n;
        let dropped = self.members.remove(k);
        let q = self.members.len();
        for j in k..q {
            self.u[j] = self.u[j + 1];
            // Column j + 1 has j + 2 entries; as column j its last one is below the diagonal.
            self.r.copy_within((j + 1) * n..(j + 1) * n + j + 2, j * n);
        }
        for i in k..q {
            let (a, b) = (self.r[i * n + i], self.r[i * n + i + 1]);
            // Not 0: b was a diagonal entry of R.
            let length = a.hypot(b);
            let (cos, sin) = (a / length, b / length);
            for j in i..q {
                let pair = &mut self.r[j * n + i..j * n + i + 2];
                (pair[0], pair[1]) = (cos * pair[0] + sin * pair[1], cos * pair[1] - sin * pair[0]);
            }
            let (first, second) = self.jt[i * n..(i + 2) * n].split_at_mut(n);
            for (x, y) in first.iter_mut().zip(second) {
                (*x, *y) = (cos * *x + sin * *y, cos * *y - sin * *x);
            }
        }
        dropped
    }

    /// One Newton step on the KKT conditions with the members as equalities. The conditions are
    /// linear: the step leads from any `d` and `u` to the solution, and repeated, it reduces
    /// rounding errors. Returns the largest absolute entry of `g` and `u`, the scale of the
    /// multipliers.
    ///
    /// With δd = J y the conditions H δd - N δu = -ρ and Nᵀ δd = b - Nᵀ d become y - [R; 0] δu =
    /// -Jᵀ ρ and Rᵀ y₁ = b - Nᵀ d.
    pub(super) fn refine(&mut self, program: &QuadraticProgram<'_>, d: &mut [f64]) -> f64 {
        let (n, q) = (self.n, self.members.len());
        // ρ = H d + g - N u
        let rho = &mut self.residual;
        rho.copy_from_slice(program.gradient);
        let mut size = rho.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
        add_symmetric_product(program.hessian, d, rho);
        for (&member, &u) in self.members.iter().zip(&self.u) {
            match member {
                Constraint::Lower(i) => rho[i] -= u,
                Constraint::Upper(i) => rho[i] += u,
                Constraint::Equality(k) => axpy(rho, -u, program.equality_row(k)),
                Constraint::Inequality(k) => axpy(rho, -u, program.inequality_row(k)),
            }
            size = size.max(u.abs());
        }
        // y₁ = R⁻ᵀ (b - Nᵀ d)
        let y = &mut self.scratch;
        for k in 0..q {
            let column = &self.r[k * n..k * n + k + 1];
            let beta = -slack(program, self.members[k], d);
            y[k] = (beta - dot(&column[..k], &y[..k])) / column[k];
        }
        // y₂ = -J₂ᵀ ρ and R δu = y₁ + J₁ᵀ ρ
        let change = &mut self.coefficients;
        for k in 0..n {
            let t = dot(&self.jt[k * n..(k + 1) * n], rho);
            if k < q {
                change[k] = y[k] + t;
            } else {
                y[k] = -t;
            }
        }
        solve_upper(&self.r, n, &mut change[..q]);
        axpy(&mut self.u[..q], 1.0, &change[..q]);
        // d += J y
        subtract_rows(d, &self.jt, n, 0, |k| -y[k], 0..n);
        size
    }

    /// Writes the multipliers to the solution and sets `d` exactly to its active bounds.
    pub(super) fn report(&self, program: &QuadraticProgram<'_>, solution: &mut Solution) {
        solution.clear_multipliers();
        for (k, (&member, &u)) in self.members.iter().zip(&self.u).enumerate() {
            // Only the multipliers of equalities may be negative.
            let positive = if k < self.equalities { u } else { u.max(0.0) };
            match member {
                Constraint::Lower(i) => {
                    solution.bound_multipliers[i] = positive;
                    solution.d[i] = program.lower[i];
                }
                Constraint::Upper(i) => {
                    solution.bound_multipliers[i] = -positive;
                    solution.d[i] = program.upper[i];
                }
                Constraint::Equality(k) => solution.equality_multipliers[k] = u,
                Constraint::Inequality(k) => solution.inequality_multipliers[k] = positive,
            }
        }
        for (i, d) in solution.d.iter_mut().enumerate() {
            *d = d.clamp(program.lower[i], program.upper[i]);
        }
    }
}

/// `nᵀ d - b` of a constraint `nᵀ d ≥ b`.
pub(super) fn slack(program: &QuadraticProgram<'_>, constraint: Constraint, d: &[f64]) -> f64 {
    match constraint {
        Constraint::Lower(i) => d[i] - program.lower[i],
        Constraint::Upper(i) => program.upper[i] - d[i],
        Constraint::Equality(k) => dot(program.equality_row(k), d) - program.equality_values[k],
        Constraint::Inequality(k) => {
            dot(program.inequality_row(k), d) - program.inequality_values[k]
        }
    }
}

/// `b` of a constraint `nᵀ d ≥ b`.
pub(super) fn limit(program: &QuadraticProgram<'_>, constraint: Constraint) -> f64 {
    match constraint {
        Constraint::Lower(i) => program.lower[i],
        Constraint::Upper(i) => -program.upper[i],
        Constraint::Equality(k) => program.equality_values[k],
        Constraint::Inequality(k) => program.inequality_values[k],
    }
}

/// Records in the active set of the solution that a constraint became active or inactive.
pub(super) fn mark(solution: &mut Solution, constraint: Constraint, active: bool) {
    match constraint {
        Constraint::Lower(i) if active => solution.bounds[i] = BoundState::Lower,
        Constraint::Upper(i) if active => solution.bounds[i] = BoundState::Upper,
        Constraint::Lower(i) | Constraint::Upper(i) => solution.bounds[i] = BoundState::Free,
        Constraint::Equality(_) => {}
        Constraint::Inequality(k) => solution.active_rows[k] = active,
    }
}

/// `x := R⁻¹ x` by back substitution; `R` is stored by columns with stride `n`.
fn solve_upper(r: &[f64], n: usize, x: &mut [f64]) {
    for k in (0..x.len()).rev() {
        let column = &r[k * n..k * n + k + 1];
        x[k] /= column[k];
        let value = x[k];
        axpy(&mut x[..k], -value, &column[..k]);
    }
}
