//! Bounded nonlinear least squares with equalities and inequalities: sequential quadratic
//! programming with Gauss-Newton steps in a trust region.
//!
//! Minimises F(x) over x within bounds, subject to c(x) = 0 and g(x) ≥ 0. x may be on a manifold:
//! the caller applies the steps, x ⊕ d (the retraction). Each iteration solves the quadratic
//! program
//!
//! ```text
//! min ∇Fᵀd + ½ dᵀHd   with   bounds on x ⊕ d,  |dᵢ| ≤ Δ·scaleᵢ,  c + C d = 0,  g + G d ≥ 0
//! ```
//!
//! and accepts the step if the merit function F + μ(Σ|c| + Σ max(0, -g)) decreases. Bounds are
//! satisfied exactly. The active set is the warm start of the next quadratic program, so a
//! coordinate that stays at its bound costs no extra iterations. When the model predicts a decrease
//! below `tolerance · F`, the last step is still tried, so that directions in which F is nearly
//! flat converge to the minimum of the caller's prior.

use crate::cholesky::dot;
use crate::curvature::RowCurvature;
use crate::elimination::Elimination;
use crate::quadratic::{QuadraticProgram, Status, Workspace};

/// A smooth problem with a current point, which the problem stores and moves by steps.
pub trait Problem {
    /// Evaluates at the current point moved by `step`, which becomes the trial point.
    ///
    /// Returns F there and fills the values c of the equalities and g of the inequalities.
    fn evaluate(&mut self, step: &[f64], equalities: &mut [f64], inequalities: &mut [f64]) -> f64;

    /// Makes the trial point the current one.
    fn accept(&mut self);

    /// Fills the quadratic model at the current point, the last accepted trial point.
    fn linearise(&mut self, local: &mut LocalModel);
}

/// The quadratic model of a problem at a point, row-major.
#[derive(Clone, Debug)]
pub struct LocalModel {
    /// An approximation of the second derivative of F, n × n; only the lower triangle is read.
    pub hessian: Vec<f64>,
    /// Whether the Hessian should have second derivatives of the residuals, which Gauss and Newton leave
    /// out: asked for near the minimum. A problem that has none ignores it.
    pub curved: bool,
    /// The gradient of F, n.
    pub gradient: Vec<f64>,
    /// Lower bound of each component of a step, n.
    pub lower: Vec<f64>,
    /// Upper bound of each component of a step, n.
    pub upper: Vec<f64>,
    /// Derivatives of the equalities, one row of n for each.
    pub equality_rows: Vec<f64>,
    /// Derivatives of the inequalities, one row of n for each.
    pub inequality_rows: Vec<f64>,
}

/// Stopping criteria and the initial trust region.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stopping {
    /// Stop when the model predicts a decrease of F by less than this fraction of F.
    pub tolerance: f64,
    /// Decreases of F below this count as zero, whatever F is.
    pub floor: f64,
    /// The largest violation of an equality or inequality that counts as feasible.
    pub feasibility: f64,
    /// The largest number of iterations.
    pub iterations: u32,
    /// The initial half-width of the trust region, in units of `scale`.
    pub trust: f64,
}

impl Default for Stopping {
    fn default() -> Self {
        Self { tolerance: 1e-6, floor: 1e-18, feasibility: 1e-7, iterations: 60, trust: 0.5 }
    }
}

/// How a solve ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stop {
    /// The model predicts no further decrease.
    Converged,
    /// No step decreases the merit function, although the model predicts a decrease.
    Stalled,
    /// The limit on iterations was reached.
    IterationLimit,
    /// A value was not finite, or the quadratic program could not be solved.
    NotFinite,
    /// Equalities or inequalities are violated at the end.
    Infeasible,
}

/// The result of a solve.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Summary {
    /// F at the end.
    pub objective: f64,
    /// Largest |c| and largest -g at the end.
    pub violation: f64,
    /// Iterations used.
    pub iterations: u32,
    /// Why it ended.
    pub stop: Stop,
}

/// The buffers of a solver; the active set is kept from one solve to the next.
#[derive(Debug)]
pub struct Solver {
    local: LocalModel,
    program: Workspace,
    step: Vec<f64>,
    lower: Vec<f64>,
    upper: Vec<f64>,
    scale: Vec<f64>,
    equalities: Vec<f64>,
    inequalities: Vec<f64>,
    trial_equalities: Vec<f64>,
    trial_inequalities: Vec<f64>,
    elimination: Elimination,
    /// The step along each orthonormal equality row that satisfies the linearised equalities.
    equality_steps: Vec<f64>,
    equality_values: Vec<f64>,
    inequality_values: Vec<f64>,
    curvature: RowCurvature,
}

/// The largest half-width of the trust region, in units of `scale`.
const WIDEST: f64 = 2.0;
/// A decrease of less than this share of F means that the minimum is near.
const NEAR: f64 = 0.1;
/// The half-width of the trust region below which the iteration stops.
const NARROWEST: f64 = 1e-9;

impl Solver {
    /// Buffers for problems of this shape; `scale` is the typical size of a step in each direction.
    pub fn new(scale: &[f64], equalities: usize, inequalities: usize) -> Self {
        let n = scale.len();
        Self {
            local: LocalModel {
                hessian: vec![0.0; n * n],
                curved: false,
                gradient: vec![0.0; n],
                lower: vec![0.0; n],
                upper: vec![0.0; n],
                equality_rows: vec![0.0; n * equalities],
                inequality_rows: vec![0.0; n * inequalities],
            },
            program: Workspace::new(n, equalities, inequalities),
            step: vec![0.0; n],
            lower: vec![0.0; n],
            upper: vec![0.0; n],
            scale: scale.to_vec(),
            equalities: vec![0.0; equalities],
            inequalities: vec![0.0; inequalities],
            trial_equalities: vec![0.0; equalities],
            trial_inequalities: vec![0.0; inequalities],
            elimination: Elimination::new(equalities),
            equality_steps: vec![0.0; equalities],
            equality_values: vec![0.0; equalities],
            inequality_values: vec![0.0; inequalities],
            curvature: RowCurvature::new(n, inequalities),
        }
    }

    /// Clears the active set, so that the next solve depends on its own problem only.
    pub fn forget(&mut self) {
        self.program.forget();
    }

    /// The model at the last point that was linearised, its equality rows orthonormalised.
    pub fn local(&self) -> &LocalModel {
        &self.local
    }

    /// Minimises a problem from its current point, and moves that point to the minimum.
    ///
    /// Does not allocate.
    pub fn minimise<P: Problem>(&mut self, problem: &mut P, options: &Stopping) -> Summary {
        self.step.fill(0.0);
        let mut objective =
            problem.evaluate(&self.step, &mut self.equalities, &mut self.inequalities);
        problem.accept();
        let mut violation = violation(&self.equalities, &self.inequalities);
        let mut summary =
            Summary { objective, violation, iterations: 0, stop: Stop::IterationLimit };
        if !(objective.is_finite() && violation.is_finite()) {
            summary.stop = Stop::NotFinite;
            return summary;
        }
        let mut trust = options.trust;
        let mut penalty = 0.0_f64;
        // Whether the current point is new and has to be linearised; a rejected step keeps the
        // model.
        let mut fresh = true;
        let mut near = false;
        let mut polished = false;
        self.curvature.forget();
        while summary.iterations < options.iterations {
            summary.iterations += 1;
            if fresh {
                self.linearise(problem, near);
            }
            let mut proposed = self.propose(trust);
            if self.local.curved && matches!(proposed, Err(Status::NotPositiveDefinite { .. })) {
                self.linearise(problem, false);
                proposed = self.propose(trust);
            }
            let Ok(share) = proposed else {
                summary.stop = Stop::NotFinite;
                break;
            };
            // The l1 merit function is exact if μ exceeds every multiplier.
            penalty = penalty.max(2.0 * self.largest_multiplier());
            let promised = self.promise();
            let infeasible = sum_violation(&self.equalities, &self.inequalities);
            let small = promised <= options.tolerance * objective + options.floor;
            let last = small && share == 1.0 && violation <= options.feasibility;
            near = promised <= NEAR * objective;
            let mut trial = problem.evaluate(
                &self.step,
                &mut self.trial_equalities,
                &mut self.trial_inequalities,
            );
            if self.bend(options.feasibility) {
                trial = problem.evaluate(
                    &self.step,
                    &mut self.trial_equalities,
                    &mut self.trial_inequalities,
                );
            }
            let trial_infeasible = sum_violation(&self.trial_equalities, &self.trial_inequalities);
            let gained = objective - trial + penalty * (infeasible - trial_infeasible);
            // Relaxed rows are satisfied by a share of the way only.
            let expected = promised + penalty * infeasible * share;
            // Near convergence rounding dominates the gain: a step that loses no more is accepted.
            let noise = 1e-14 * objective + options.floor;
            if gained.is_finite() && gained >= 1e-4 * expected - noise {
                // Armijo condition with c₁ = 1e-4; the ratio of gain to prediction sets the region.
                problem.accept();
                fresh = true;
                let multipliers = self.program.solution().inequality_multipliers();
                self.curvature.leave(&self.step, &self.local.inequality_rows, multipliers);
                objective = trial;
                std::mem::swap(&mut self.equalities, &mut self.trial_equalities);
                std::mem::swap(&mut self.inequalities, &mut self.trial_inequalities);
                violation = self::violation(&self.equalities, &self.inequalities);
                if gained > 0.75 * expected {
                    trust = (2.0 * trust).min(WIDEST);
                } else if gained < 0.25 * expected {
                    trust *= 0.5;
                }
                if last && violation <= options.feasibility {
                    // F is off by as much as a multiplier times the violation: one more step where that
                    // is not small.
                    if polished || violation <= 0.01 * options.feasibility {
                        summary.stop = Stop::Converged;
                        break;
                    }
                    polished = true;
                }
            } else if last {
                summary.stop = Stop::Converged;
                break;
            } else {
                // A quarter of the rejected step, which may be shorter than the region is wide.
                fresh = self.local.curved | self.curvature.begin();
                near = false;
                trust = 0.25 * trust.min(self.step_size());
                if trust < NARROWEST {
                    summary.stop = if violation > options.feasibility {
                        Stop::Infeasible
                    } else {
                        Stop::Stalled
                    };
                    break;
                }
            }
        }
        summary.objective = objective;
        summary.violation = violation;
        if violation > options.feasibility && summary.stop == Stop::IterationLimit {
            summary.stop = Stop::Infeasible;
        }
        summary
    }

    fn linearise<P: Problem>(&mut self, problem: &mut P, curved: bool) {
        self.local.curved = curved;
        problem.linearise(&mut self.local);
        self.curvature.arrive(&self.local.inequality_rows);
        self.curvature.add_to(&mut self.local.hessian);
        self.orthonormalise_equalities();
    }

    /// Orthonormalises the equality rows and transforms the right-hand sides -c likewise.
    fn orthonormalise_equalities(&mut self) {
        self.elimination.orthonormalise(&mut self.local.equality_rows, self.step.len());
        for (step, c) in self.equality_steps.iter_mut().zip(&self.equalities) {
            *step = -c;
        }
        self.elimination.apply(&mut self.equality_steps);
    }

    /// Second-order correction: adds the shortest step that satisfies the equalities, and the inequalities that the trial
    /// point violates, linearised with their values there. Returns whether the step changed.
    ///
    /// Without it the merit function rejects good steps along a curved constraint again and again
    /// (the Maratos effect).
    fn bend(&mut self, feasibility: f64) -> bool {
        let off = violation(&self.trial_equalities, &self.trial_inequalities);
        if !off.is_finite() || off <= 0.003 * feasibility {
            return false;
        }
        for (value, c) in self.equality_values.iter_mut().zip(&self.trial_equalities) {
            *value = -c;
        }
        self.elimination.apply(&mut self.equality_values);
        // The rows are orthonormal, so the shortest step is Cᵀ·values.
        let n = self.step.len();
        for (row, along) in
            self.local.equality_rows.chunks_exact(n.max(1)).zip(&self.equality_values)
        {
            for (d, r) in self.step.iter_mut().zip(row) {
                *d += along * r;
            }
        }
        // Rows of inequalities are few and seldom violated together: each for itself, and only where the way back is short
        // beside the step, which then went along the limit.
        let short = 0.1 * dot(&self.step, &self.step);
        for (row, g) in
            self.local.inequality_rows.chunks_exact(n.max(1)).zip(&self.trial_inequalities)
        {
            let square: f64 = row.iter().map(|r| r * r).sum();
            if *g < 0.0 && g * g < short * square {
                for (d, r) in self.step.iter_mut().zip(row) {
                    *d -= g / square * r;
                }
            }
        }
        for i in 0..n {
            self.step[i] = self.step[i].max(self.local.lower[i]).min(self.local.upper[i]);
        }
        true
    }

    /// Solves the quadratic program within the trust region; returns the share of the violation that
    /// the step is to end.
    fn propose(&mut self, trust: f64) -> Result<f64, Status> {
        for i in 0..self.step.len() {
            // The step 0 must stay possible, also where the point violates a bound by rounding.
            let reach = trust * self.scale[i];
            self.lower[i] = self.local.lower[i].max(-reach).min(0.0);
            self.upper[i] = self.local.upper[i].min(reach).max(0.0);
        }
        let mut ridge = 1e-12;
        loop {
            match self.solve_program() {
                Ok(share) => return Ok(share),
                // A direction of small curvature was lost to rounding: add a multiple of the
                // identity (Levenberg-Marquardt), from 1e-12 of the largest diagonal entry upwards,
                // and retry.
                Err(Status::NotPositiveDefinite { .. }) if ridge < 1e-3 && !self.local.curved => {
                    let n = self.step.len();
                    let hessian = &mut self.local.hessian;
                    let largest = (0..n).map(|i| hessian[i * n + i]).fold(0.0, f64::max);
                    (0..n).for_each(|i| hessian[i * n + i] += ridge * largest + 1e-30);
                    ridge *= 100.0;
                }
                Err(failed) => return Err(failed),
            }
        }
    }

    /// Solves the program with the present Hessian; returns the share of the violation that the step is to end.
    ///
    /// Where the trust region is too small to satisfy the linearised constraints, their violation
    /// need only be reduced by a tenth, failing that by half of what each alone could be within the region, and
    /// failing that, not at all.
    fn solve_program(&mut self) -> Result<f64, Status> {
        for share in [1.0, 0.1, f64::NAN, 0.0] {
            let share = if share.is_nan() { 0.5 * self.reducible().min(0.2) } else { share };
            for (value, full) in self.equality_values.iter_mut().zip(&self.equality_steps) {
                *value = share * full;
            }
            for (value, g) in self.inequality_values.iter_mut().zip(&self.inequalities) {
                // A satisfied inequality keeps its full slack.
                *value = if *g < 0.0 { -share * g } else { -g };
            }
            let program = QuadraticProgram::bounded(
                &self.local.hessian,
                &self.local.gradient,
                &self.lower,
                &self.upper,
            )
            .with_equalities(&self.local.equality_rows, &self.equality_values)
            .with_inequalities(&self.local.inequality_rows, &self.inequality_values);
            let solution = self.program.solve(&program);
            match solution.status() {
                Status::Solved => {
                    self.step.copy_from_slice(solution.d());
                    return Ok(share);
                }
                Status::Infeasible | Status::IterationLimit => {}
                failed => return Err(failed),
            }
        }
        self.step.fill(0.0);
        Ok(0.0)
    }

    /// The smallest share of its violation by which a linearised constraint can be reduced within the bounds of a step.
    fn reducible(&self) -> f64 {
        let n = self.step.len();
        let share = |row: &[f64], needed: f64| {
            // The most that the row times the step can be, in the direction that is needed.
            let ends = self.lower.iter().zip(&self.upper);
            let most = row.iter().zip(ends).map(|(r, (lower, upper))| {
                if r * needed > 0.0 { r.abs() * upper } else { -r.abs() * lower }
            });
            if needed == 0.0 { f64::INFINITY } else { most.sum::<f64>() / needed.abs() }
        };
        let LocalModel { equality_rows, inequality_rows, .. } = &self.local;
        let equalities = equality_rows.chunks_exact(n.max(1)).zip(&self.equality_steps);
        let inequalities = inequality_rows.chunks_exact(n.max(1)).zip(&self.inequalities);
        let equalities = equalities.map(|(row, c)| share(row, *c));
        let inequalities = inequalities.map(|(row, g)| share(row, (-g).max(0.0)));
        equalities.chain(inequalities).fold(f64::INFINITY, f64::min)
    }

    /// The decrease of F that the model predicts for the step: -(gᵀd + ½ dᵀHd).
    fn promise(&self) -> f64 {
        let n = self.step.len();
        let mut sum = 0.0;
        for i in 0..n {
            let row = &self.local.hessian[i * n..i * n + i];
            let mut product = 0.5 * self.local.hessian[i * n + i] * self.step[i];
            for (h, d) in row.iter().zip(&self.step) {
                product += h * d;
            }
            sum -= self.step[i] * (self.local.gradient[i] + product);
        }
        sum
    }

    fn largest_multiplier(&self) -> f64 {
        let solution = self.program.solution();
        let multipliers =
            solution.equality_multipliers().iter().chain(solution.inequality_multipliers());
        multipliers.fold(0.0, |m: f64, y| m.max(y.abs()))
    }

    fn step_size(&self) -> f64 {
        self.step.iter().zip(&self.scale).map(|(d, s)| d.abs() / s).fold(0.0, f64::max)
    }
}

fn violation(equalities: &[f64], inequalities: &[f64]) -> f64 {
    let worst =
        equalities.iter().fold(0.0, |m: f64, c| if c.is_nan() { f64::NAN } else { m.max(c.abs()) });
    inequalities.iter().fold(worst, |m, g| m.max(-g))
}

fn sum_violation(equalities: &[f64], inequalities: &[f64]) -> f64 {
    equalities.iter().map(|c| c.abs()).sum::<f64>()
        + inequalities.iter().map(|g| (-g).max(0.0)).sum::<f64>()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A planar arm of three unit links that reaches for a point, with bounded angles; an equality
    /// may constrain the end of the second link to a line.
    struct Arm {
        angles: [f64; 3],
        trial: [f64; 3],
        goal: [f64; 2],
        bounds: [(f64, f64); 3],
        tie: Option<f64>,
    }

    impl Arm {
        fn points(angles: &[f64; 3]) -> [[f64; 2]; 3] {
            let (mut heading, mut at) = (0.0, [0.0; 2]);
            angles.map(|a| {
                heading += a;
                at = [at[0] + f64::cos(heading), at[1] + f64::sin(heading)];
                at
            })
        }
    }

    impl Problem for Arm {
        fn evaluate(&mut self, step: &[f64], equalities: &mut [f64], _: &mut [f64]) -> f64 {
            for i in 0..3 {
                self.trial[i] = self.angles[i] + step[i];
            }
            let points = Self::points(&self.trial);
            if let Some(height) = self.tie {
                equalities[0] = points[1][1] - height;
            }
            let e = [points[2][0] - self.goal[0], points[2][1] - self.goal[1]];
            e[0] * e[0] + e[1] * e[1] + 1e-9 * self.trial.iter().map(|a| a * a).sum::<f64>()
        }

        fn accept(&mut self) {
            self.angles = self.trial;
        }

        fn linearise(&mut self, local: &mut LocalModel) {
            let points = Self::points(&self.angles);
            let origin = |j: usize| if j == 0 { [0.0; 2] } else { points[j - 1] };
            let e = [points[2][0] - self.goal[0], points[2][1] - self.goal[1]];
            let column = |j: usize, tip: [f64; 2]| [origin(j)[1] - tip[1], tip[0] - origin(j)[0]];
            for i in 0..3 {
                let a = column(i, points[2]);
                local.gradient[i] = 2.0 * (a[0] * e[0] + a[1] * e[1]) + 2e-9 * self.angles[i];
                for j in 0..3 {
                    let b = column(j, points[2]);
                    local.hessian[3 * i + j] =
                        2.0 * (a[0] * b[0] + a[1] * b[1]) + if i == j { 2e-9 } else { 0.0 };
                }
                local.lower[i] = self.bounds[i].0 - self.angles[i];
                local.upper[i] = self.bounds[i].1 - self.angles[i];
                if self.tie.is_some() {
                    local.equality_rows[i] = if i < 2 { column(i, points[1])[1] } else { 0.0 };
                }
            }
        }
    }

    const WIDE: (f64, f64) = (-3.0, 3.0);

    #[test]
    fn a_reachable_goal_is_reached() {
        let mut arm = Arm {
            angles: [0.1; 3],
            trial: [0.0; 3],
            goal: [0.5, 1.2],
            bounds: [WIDE; 3],
            tie: None,
        };
        let summary = Solver::new(&[1.0; 3], 0, 0).minimise(&mut arm, &Stopping::default());
        assert_eq!(summary.stop, Stop::Converged);
        // Only the prior of 1e-9 · Σ angle² is left.
        assert!(summary.objective < 1e-8, "{summary:?}");
    }

    #[test]
    fn a_goal_out_of_reach_leaves_the_gap() {
        let mut arm = Arm {
            angles: [0.3, -0.2, 0.4],
            trial: [0.0; 3],
            goal: [3.0, 4.0],
            bounds: [WIDE; 3],
            tie: None,
        };
        let summary = Solver::new(&[1.0; 3], 0, 0).minimise(&mut arm, &Stopping::default());
        // The straight arm of length 3 points at the goal at distance 5.
        assert!((summary.objective - 4.0).abs() < 1e-5, "{summary:?}");
    }

    #[test]
    fn bounds_hold_exactly_and_equalities_closely() {
        let bounds = [(0.0, 0.4), (-0.1, 0.1), (0.0, 3.0)];
        let mut arm =
            Arm { angles: [0.2, 0.0, 1.0], trial: [0.0; 3], goal: [-1.0, 2.0], bounds, tie: None };
        let mut solver = Solver::new(&[1.0; 3], 0, 0);
        solver.minimise(&mut arm, &Stopping::default());
        assert_eq!(arm.angles[0], 0.4);
        assert_eq!(arm.angles[1], 0.1);

        let mut tied = Arm {
            angles: [0.2, 0.0, 1.0],
            trial: [0.0; 3],
            goal: [1.0, 2.0],
            bounds: [WIDE; 3],
            tie: Some(1.1),
        };
        let summary = Solver::new(&[1.0; 3], 1, 0).minimise(&mut tied, &Stopping::default());
        assert_eq!(summary.stop, Stop::Converged);
        assert!((Arm::points(&tied.angles)[1][1] - 1.1).abs() < 1e-8);
        assert!(summary.objective < 1e-8, "the goal is within one link of the tied joint");
    }
}
