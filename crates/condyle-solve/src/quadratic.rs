//! Strictly convex quadratic programs with bounds, equalities and inequalities.
//!
//! Two algorithms share one [`Workspace`] and one warm start:
//!
//! - **Without equalities**: block principal pivoting. For a guess of the active bounds and rows, the
//!   free variables are solved for by one Cholesky factorisation, and every constraint that is
//!   violated or whose multiplier has the wrong sign changes its state at once. When that stops
//!   making progress, one variable at a time is changed by Murty's rule, which cannot cycle for a
//!   positive definite matrix and bounds alone (Júdice and Pires 1994). A correct guess costs one
//!   factorisation of the free block.
//! - **With equalities**, and where pivoting stalls: the dual active-set method of Goldfarb and
//!   Idnani (1983), with bounds as unit rows. It starts from the last active set, drops constraints
//!   whose multiplier has the wrong sign, and adds violated constraints one by one; it also detects
//!   infeasibility.
//!
//! Both count their iterations and stop at a limit with [`Status::IterationLimit`].

mod dual;
mod pivoting;
mod program;
mod solution;
mod working_set;

pub use program::QuadraticProgram;
pub use solution::{BoundState, Constraint, Solution, Status};

use pivoting::Pivoting;
use working_set::WorkingSet;

/// A bound counts as violated beyond this fraction of the size of the step and of the bound.
const FEASIBILITY: f64 = 1e-12;
/// A multiplier has the wrong sign beyond this fraction of the size of the gradient.
const OPTIMALITY: f64 = 1e-12;
/// A row is linearly dependent on the active rows if the part orthogonal to them, in the norm
/// √(nᵀ H⁻¹ n), is below this fraction of it.
const DEPENDENCE: f64 = 1e-10;

/// The default of [`Workspace::set_consistency`].
pub const DEFAULT_CONSISTENCY: f64 = 1e-10;

/// All memory of the solver, with the last solution, which is the warm start of the next call.
///
/// ```
/// use condyle_solve::quadratic::{QuadraticProgram, Status, Workspace};
///
/// let mut workspace = Workspace::new(2, 1, 0);
/// // Nearest point to the origin on d₀ + d₁ = 2.
/// let program = QuadraticProgram::bounded(
///     &[1.0, 0.0, 0.0, 1.0],
///     &[0.0, 0.0],
///     &[f64::NEG_INFINITY; 2],
///     &[f64::INFINITY; 2],
/// );
/// let solution = workspace.solve(&program.with_equalities(&[1.0, 1.0], &[2.0]));
/// assert_eq!(solution.status(), Status::Solved);
/// assert!((solution.d()[0] - 1.0).abs() < 1e-15);
/// assert!((solution.equality_multipliers()[0] - 1.0).abs() < 1e-15); // H d + g = 1 · (1, 1)
/// ```
#[derive(Debug, Clone)]
pub struct Workspace {
    solution: Solution,
    pivoting: Pivoting,
    set: WorkingSet,
    consistency: f64,
    iteration_limit: Option<u32>,
}

impl Workspace {
    /// Allocates all memory for `n` unknowns, `equalities` rows of `C` and `inequalities` rows of
    /// `G`.
    ///
    /// ```
    /// let workspace = condyle_solve::quadratic::Workspace::new(29, 3, 0);
    /// assert_eq!(workspace.solution().d().len(), 29);
    /// ```
    pub fn new(n: usize, equalities: usize, inequalities: usize) -> Self {
        Self {
            solution: Solution::new(n, equalities, inequalities),
            pivoting: Pivoting::new(n, inequalities),
            set: WorkingSet::new(n, equalities, inequalities),
            consistency: DEFAULT_CONSISTENCY,
            iteration_limit: None,
        }
    }

    /// Changes the shape, as [`Workspace::new`]; settings are kept. The warm start is kept if the
    /// shape does not change.
    ///
    /// ```
    /// let mut workspace = condyle_solve::quadratic::Workspace::new(2, 0, 0);
    /// workspace.resize(3, 1, 0);
    /// assert_eq!(workspace.shape(), (3, 1, 0));
    /// ```
    pub fn resize(&mut self, n: usize, equalities: usize, inequalities: usize) {
        if self.shape() != (n, equalities, inequalities) {
            let (consistency, iteration_limit) = (self.consistency, self.iteration_limit);
            *self = Self::new(n, equalities, inequalities);
            self.consistency = consistency;
            self.iteration_limit = iteration_limit;
        }
    }

    /// The numbers of unknowns, equality rows and inequality rows that the next program must have.
    ///
    /// ```
    /// assert_eq!(condyle_solve::quadratic::Workspace::new(4, 2, 1).shape(), (4, 2, 1));
    /// ```
    pub fn shape(&self) -> (usize, usize, usize) {
        let s = &self.solution;
        (s.d.len(), s.equality_multipliers.len(), s.inequality_multipliers.len())
    }

    /// Clears the active set, so that the next call starts cold, with no active constraint.
    ///
    /// ```
    /// use condyle_solve::quadratic::{QuadraticProgram, Workspace};
    ///
    /// let mut workspace = Workspace::new(1, 0, 0);
    /// // ½ d² - 2 d on d ≤ 1: the cold start needs the free solution d = 2 first.
    /// let program = QuadraticProgram::bounded(&[1.0], &[-2.0], &[0.0], &[1.0]);
    /// assert_eq!(workspace.solve(&program).iterations(), 2);
    /// assert_eq!(workspace.solve(&program).iterations(), 1); // warm
    /// workspace.forget();
    /// assert_eq!(workspace.solve(&program).iterations(), 2);
    /// ```
    pub fn forget(&mut self) {
        self.solution.forget();
    }

    /// Sets the residual below which linearly dependent constraints count as consistent.
    ///
    /// An equality row that is a linear combination of others, `C_k = Σ_j r_j C_j`, is dropped if
    /// `|c_k - Σ_j r_j c_j| ≤ 1e-8 (|c_k| + Σ_j |r_j c_j|) + tolerance · max_j |C_j|`, and makes
    /// the program infeasible otherwise. A bound or inequality that depends linearly on the active
    /// constraints may be violated by as much, with its own norm in place of the maximum.
    /// `tolerance` is in the unit of the unknowns; the default is [`DEFAULT_CONSISTENCY`].
    ///
    /// ```
    /// use condyle_solve::quadratic::{QuadraticProgram, Status, Workspace};
    ///
    /// // d = 1 and d = 1.001.
    /// let free = ([f64::NEG_INFINITY], [f64::INFINITY]);
    /// let program = QuadraticProgram::bounded(&[1.0], &[0.0], &free.0, &free.1)
    ///     .with_equalities(&[1.0, 1.0], &[1.0, 1.001]);
    /// let mut workspace = Workspace::new(1, 2, 0);
    /// assert_eq!(workspace.solve(&program).status(), Status::Infeasible);
    /// workspace.set_consistency(0.01);
    /// assert!((workspace.solve(&program).d()[0] - 1.0).abs() < 1e-12);
    /// ```
    pub fn set_consistency(&mut self, tolerance: f64) {
        self.consistency = tolerance;
    }

    /// Limits the iterations of one call; `None` means `100 + 10 (n + m_e + m_i)`.
    ///
    /// ```
    /// use condyle_solve::quadratic::{QuadraticProgram, Status, Workspace};
    ///
    /// let mut workspace = Workspace::new(1, 0, 0);
    /// workspace.set_iteration_limit(Some(1)); // this program needs 2 from a cold start
    /// let program = QuadraticProgram::bounded(&[1.0], &[-2.0], &[0.0], &[1.0]);
    /// assert_eq!(workspace.solve(&program).status(), Status::IterationLimit);
    /// ```
    pub fn set_iteration_limit(&mut self, limit: Option<u32>) {
        self.iteration_limit = limit;
    }

    /// The solution of the last call.
    ///
    /// ```
    /// let workspace = condyle_solve::quadratic::Workspace::new(2, 0, 0);
    /// assert_eq!(workspace.solution().iterations(), 0); // before any call
    /// ```
    pub fn solution(&self) -> &Solution {
        &self.solution
    }

    /// Minimises `½ dᵀ H d + gᵀ d` within the bounds and rows of `program`, from the last active set.
    ///
    /// Never allocates. The result depends on the program and, in its last digits and in
    /// [`Solution::iterations`], on the initial active set.
    ///
    /// # Errors
    ///
    /// Reported by [`Solution::status`]: the vectors are the solution only if it is
    /// [`Status::Solved`].
    ///
    /// # Panics
    ///
    /// If the length of a slice of `program` does not match [`Workspace::shape`].
    ///
    /// ```
    /// use condyle_solve::quadratic::{QuadraticProgram, Workspace};
    ///
    /// // Nearest point to the origin with d₀ + d₁ ≥ 2 and d₁ ≥ 1.5: (0.5, 1.5).
    /// let hessian = [1.0, 0.0, 0.0, 1.0];
    /// let (lower, upper) = ([f64::NEG_INFINITY, 1.5], [f64::INFINITY; 2]);
    /// let program = QuadraticProgram::bounded(&hessian, &[0.0, 0.0], &lower, &upper)
    ///     .with_inequalities(&[1.0, 1.0], &[2.0]);
    /// let mut workspace = Workspace::new(2, 0, 1);
    /// let solution = workspace.solve(&program);
    /// assert!((solution.d()[0] - 0.5).abs() < 1e-15);
    /// assert_eq!(solution.d()[1], 1.5);
    /// assert!((solution.inequality_multipliers()[0] - 0.5).abs() < 1e-15);
    /// ```
    pub fn solve(&mut self, program: &QuadraticProgram<'_>) -> &Solution {
        let (n, equalities, inequalities) = self.shape();
        program.check_shape(n, equalities, inequalities);
        let solution = &mut self.solution;
        solution.begin();
        let limit = self
            .iteration_limit
            .unwrap_or_else(|| 100 + 10 * (n + equalities + inequalities) as u32);

        solution.status = Status::Solved;
        for i in 0..n {
            let (lower, upper) = (program.lower[i], program.upper[i]);
            // Written so that it is false for NaN.
            let possible = lower <= upper && lower < f64::INFINITY && upper > f64::NEG_INFINITY;
            if !possible {
                solution.status = Status::Infeasible;
                solution.conflict.push(Constraint::Lower(i));
                solution.conflict.push(Constraint::Upper(i));
                return &self.solution;
            }
            // A state of the last call is kept where its bound still exists.
            solution.bounds[i] = match solution.bounds[i] {
                _ if lower == upper => BoundState::Fixed,
                BoundState::Lower if lower > f64::NEG_INFINITY => BoundState::Lower,
                BoundState::Upper if upper < f64::INFINITY => BoundState::Upper,
                _ => BoundState::Free,
            };
        }

        let done = equalities == 0
            && pivoting::solve(program, &mut self.pivoting, solution, limit)
                != pivoting::Outcome::Stalled;
        if !done {
            if inequalities > 0 && equalities == 0 {
                // Where pivoting stalled with rows its states lead nowhere.
                self.solution.forget();
            }
            let solution = &mut self.solution;
            dual::solve(program, &mut self.set, solution, limit, self.consistency);
        }
        if self.solution.status == Status::Solved && !self.solution.is_finite() {
            self.solution.status = Status::NotFinite;
        }
        &self.solution
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Strictly diagonally dominant with entries of both signs, and a gradient that pushes many
    /// variables out of the box; from a linear congruential generator (Knuth's MMIX constants).
    fn boxed(n: usize, seed: u64) -> (Vec<f64>, Vec<f64>) {
        let mut state = seed;
        let mut real = || {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            (state >> 33) as f64 / f64::from(1_u32 << 30) - 1.0
        };
        let mut hessian: Vec<f64> = (0..n * n).map(|_| real()).collect();
        for i in 0..n {
            hessian[i * n + i] = n as f64;
        }
        (hessian, (0..n).map(|_| 2.0 * n as f64 * real()).collect())
    }

    #[test]
    fn the_two_algorithms_agree_and_hand_over() {
        for seed in 0..50 {
            let n = 25;
            let (hessian, gradient) = boxed(n, seed);
            let (lower, upper) = (vec![-1.0; n], vec![0.5; n]);
            let program = QuadraticProgram::bounded(&hessian, &gradient, &lower, &upper);

            let mut workspace = Workspace::new(n, 0, 0);
            let pivoted = workspace.solve(&program).clone();
            assert_eq!(pivoted.status, Status::Solved);
            assert!(pivoted.bounds.iter().any(|&b| b != BoundState::Free));

            // The dual method from no active bound, and from states in which pivoting could stall.
            let starts = [BoundState::Free, BoundState::Lower, BoundState::Upper];
            for start in starts {
                let mut solution = Solution::new(n, 0, 0);
                solution.bounds.fill(start);
                dual::solve(&program, &mut workspace.set, &mut solution, 1000, 1e-10);
                assert_eq!(solution.status, Status::Solved);
                assert_eq!(
                    solution.bounds, pivoted.bounds,
                    "one active set: nothing is degenerate"
                );
                // H has condition below 10: both are within 1e-13 of the minimiser.
                for i in 0..n {
                    assert!((solution.d[i] - pivoted.d[i]).abs() < 1e-13);
                    let gap = solution.bound_multipliers[i] - pivoted.bound_multipliers[i];
                    assert!(gap.abs() < 1e-13 * 2.0 * n as f64, "of a gradient of up to 2 n");
                }
            }
        }
    }

    #[test]
    fn a_limit_reached_is_said_by_both_algorithms() {
        let n = 25;
        let (hessian, gradient) = boxed(n, 7);
        let (lower, upper) = (vec![-0.1; n], vec![0.05; n]);
        let program = QuadraticProgram::bounded(&hessian, &gradient, &lower, &upper);
        let mut workspace = Workspace::new(n, 0, 0);
        // From all free, pivoting needs a second round; the dual method one step per active bound.
        workspace.set_iteration_limit(Some(1));
        assert_eq!(workspace.solve(&program).status, Status::IterationLimit);
        workspace.set_iteration_limit(None);
        let active = workspace.solve(&program).bounds.iter().filter(|b| **b != BoundState::Free);
        let active = active.count() as u32;
        for (limit, status) in [(active - 1, Status::IterationLimit), (1000, Status::Solved)] {
            let mut solution = Solution::new(n, 0, 0);
            dual::solve(&program, &mut workspace.set, &mut solution, limit, 1e-10);
            assert_eq!(solution.status, status);
            assert!(solution.iterations <= limit);
        }
    }
}
