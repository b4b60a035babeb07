//! The result of a call of the solver.

use super::QuadraticProgram;
use crate::cholesky::{axpy, dot};

/// How a call ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Status {
    /// The point satisfies the KKT conditions.
    Solved,
    /// No point satisfies all constraints; [`Solution::conflict`] lists some that contradict.
    Infeasible,
    /// The limit on iterations was reached; the point may violate constraints.
    IterationLimit,
    /// `H` is not positive definite on the variables that were not held at a bound.
    NotPositiveDefinite {
        /// The variable whose pivot failed.
        variable: usize,
    },
    /// The data contain NaN, or an infinity other than in bounds or `h`, or the solution
    /// overflowed.
    NotFinite,
}

/// The state of a variable with respect to its bounds; the warm start of the next call.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum BoundState {
    /// Not held at a bound; multiplier 0.
    Free,
    /// Held at its lower bound, multiplier ≥ 0.
    Lower,
    /// Held at its upper bound, multiplier ≤ 0.
    Upper,
    /// Its bounds are equal; the multiplier has any sign.
    Fixed,
}

/// One constraint of a [`QuadraticProgram`].
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Constraint {
    /// `d_i ≥ lower_i`.
    Lower(usize),
    /// `d_i ≤ upper_i`.
    Upper(usize),
    /// Row `k` of `C d = c`.
    Equality(usize),
    /// Row `k` of `G d ≥ h`.
    Inequality(usize),
}

/// The minimiser, its multipliers and its active set.
///
/// The multipliers satisfy `H d + g = z + Cᵀ y + Gᵀ w`.
///
/// ```
/// use condyle_solve::quadratic::{BoundState, Constraint, QuadraticProgram, Status, Workspace};
///
/// // Nearest point to (0, 0, 5) on d₀ + d₁ = 2 with d₀ ≥ 1.5 and -d₂ ≥ -1: (1.5, 0.5, 1).
/// let hessian = [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0];
/// let (lower, upper) = ([1.5, f64::NEG_INFINITY, f64::NEG_INFINITY], [f64::INFINITY; 3]);
/// let program = QuadraticProgram::bounded(&hessian, &[0.0, 0.0, -5.0], &lower, &upper)
///     .with_equalities(&[1.0, 1.0, 0.0], &[2.0])
///     .with_inequalities(&[0.0, 0.0, -1.0], &[-1.0]);
/// let mut workspace = Workspace::new(3, 1, 1);
/// let solution = workspace.solve(&program);
/// let near = |a: f64, b: f64| (a - b).abs() < 1e-14;
/// assert_eq!(solution.status(), Status::Solved);
/// assert!(near(solution.d()[1], 0.5));
/// assert_eq!(solution.bounds(), [BoundState::Lower, BoundState::Free, BoundState::Free]);
/// assert_eq!(solution.active_rows(), [true]);
/// // H d + g = (1.5, 0.5, -4) = z + Cᵀ y + Gᵀ w.
/// assert!(near(solution.equality_multipliers()[0], 0.5));
/// assert!(near(solution.bound_multipliers()[0], 1.0));
/// assert!(near(solution.inequality_multipliers()[0], 4.0));
/// assert!(near(solution.objective(&program), 0.5 * 3.5 - 5.0)); // ½ |d|² - 5 d₂
/// // The start, and one step for each of the two active inequalities, and the check.
/// assert!(solution.iterations() <= 4);
///
/// // -d₂ ≥ -1 against d₂ ≥ 2.
/// let contradiction = [1.5, f64::NEG_INFINITY, 2.0];
/// let solution = workspace.solve(&QuadraticProgram { lower: &contradiction, ..program });
/// assert_eq!(solution.conflict(), [Constraint::Lower(2), Constraint::Inequality(0)]);
/// ```
#[derive(Debug, Clone)]
pub struct Solution {
    pub(super) d: Vec<f64>,
    pub(super) bound_multipliers: Vec<f64>,
    pub(super) equality_multipliers: Vec<f64>,
    pub(super) inequality_multipliers: Vec<f64>,
    pub(super) bounds: Vec<BoundState>,
    pub(super) active_rows: Vec<bool>,
    pub(super) conflict: Vec<Constraint>,
    pub(super) iterations: u32,
    pub(super) status: Status,
}

impl Solution {
    pub(super) fn new(n: usize, equalities: usize, inequalities: usize) -> Self {
        Self {
            d: vec![0.0; n],
            bound_multipliers: vec![0.0; n],
            equality_multipliers: vec![0.0; equalities],
            inequality_multipliers: vec![0.0; inequalities],
            bounds: vec![BoundState::Free; n],
            active_rows: vec![false; inequalities],
            // The incoming constraint and at most n independent ones; two bounds that cross.
            conflict: Vec::with_capacity(n + 2),
            iterations: 0,
            status: Status::Solved,
        }
    }

    /// Clears everything except the active set and the status.
    pub(super) fn begin(&mut self) {
        self.d.fill(0.0);
        self.clear_multipliers();
        self.conflict.clear();
        self.iterations = 0;
    }

    /// Clears the active set; fixed variables stay fixed.
    pub(super) fn forget(&mut self) {
        for bound in &mut self.bounds {
            if *bound != BoundState::Fixed {
                *bound = BoundState::Free;
            }
        }
        self.active_rows.fill(false);
    }

    pub(super) fn clear_multipliers(&mut self) {
        self.bound_multipliers.fill(0.0);
        self.equality_multipliers.fill(0.0);
        self.inequality_multipliers.fill(0.0);
    }

    pub(super) fn is_finite(&self) -> bool {
        let finite = |x: &[f64]| x.iter().all(|x| x.is_finite());
        finite(&self.d)
            && finite(&self.bound_multipliers)
            && finite(&self.equality_multipliers)
            && finite(&self.inequality_multipliers)
    }

    /// The minimiser, `n`. If solved, it satisfies the bounds exactly.
    pub fn d(&self) -> &[f64] {
        &self.d
    }

    /// `z`, `n`: positive for an active lower bound, negative for an active upper bound.
    pub fn bound_multipliers(&self) -> &[f64] {
        &self.bound_multipliers
    }

    /// `y`, `m_e`; zero for a row that was dropped because it depends on others.
    pub fn equality_multipliers(&self) -> &[f64] {
        &self.equality_multipliers
    }

    /// `w ≥ 0`, `m_i`; zero for a row that is not active.
    pub fn inequality_multipliers(&self) -> &[f64] {
        &self.inequality_multipliers
    }

    /// The state of every variable, `n`.
    pub fn bounds(&self) -> &[BoundState] {
        &self.bounds
    }

    /// Which inequality rows are active, `m_i`.
    pub fn active_rows(&self) -> &[bool] {
        &self.active_rows
    }

    /// If infeasible, constraints that contradict each other; otherwise empty.
    pub fn conflict(&self) -> &[Constraint] {
        &self.conflict
    }

    /// Factorisations of the free block, or constraints added and dropped, in the last call.
    pub fn iterations(&self) -> u32 {
        self.iterations
    }

    /// How the last call ended.
    pub fn status(&self) -> Status {
        self.status
    }

    /// The objective `½ dᵀ H d + gᵀ d` of `program` at this solution.
    ///
    /// # Panics
    ///
    /// If `program` has another number of unknowns.
    ///
    /// ```
    /// use condyle_solve::quadratic::{QuadraticProgram, Workspace};
    ///
    /// let program = QuadraticProgram::bounded(&[2.0], &[-1.0], &[0.0], &[1.0]);
    /// assert_eq!(Workspace::new(1, 0, 0).solve(&program).objective(&program), -0.25); // d = ½
    /// ```
    pub fn objective(&self, program: &QuadraticProgram<'_>) -> f64 {
        let n = self.d.len();
        assert_eq!(program.n(), n, "the program has another number of unknowns");
        let mut value = dot(program.gradient, &self.d);
        for i in 0..n {
            let row = &program.hessian[i * n..i * n + i + 1];
            value += self.d[i] * (dot(&row[..i], &self.d[..i]) + 0.5 * row[i] * self.d[i]);
        }
        value
    }
}

/// `y += H x` from the lower triangle of `hessian`.
pub(super) fn add_symmetric_product(hessian: &[f64], x: &[f64], y: &mut [f64]) {
    let n = x.len();
    for i in 0..n {
        let row = &hessian[i * n..i * n + i];
        let sum = dot(row, &x[..i]) + hessian[i * n + i] * x[i];
        axpy(&mut y[..i], x[i], row);
        y[i] += sum;
    }
}
