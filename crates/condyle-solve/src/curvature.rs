//! The curvature of active inequalities, learned from step to step.
//!
//! The Hessian of a Gauss-Newton step has the curvature of F alone. Where F pulls against a curved limit with the
//! multipliers λ, the second derivative along the limit is that of F - Σ λᵢ gᵢ, and without -Σ λᵢ ∇²gᵢ steps are too
//! long by the ratio of both: at the rounded edge of a limit, where it curves within a degree, hundreds of times. The
//! rows Gᵢ = ∇gᵢ are at hand before and after each step s, so their change
//!
//! ```text
//! y = Σ λᵢ (Gᵢ(x) - Gᵢ(x ⊕ s))
//! ```
//!
//! updates a matrix B by the formula of Broyden, Fletcher, Goldfarb and Shanno, B ← B - B s sᵀB/(sᵀB s) + y yᵀ/(yᵀs),
//! from B = 0. A step along which the limit curves the other way, yᵀs ≤ 0, changes nothing, so that B has no negative
//! eigenvalue and the quadratic program stays convex. It is used once a step was rejected: where none is, the plain steps
//! are long enough and not too long.

use crate::cholesky::dot;

/// An update needs an angle between s and y of which the cosine is at least this: B would grow without bound.
const ALONG: f64 = 0.05;

/// The matrix B, and what is needed for its next update.
#[derive(Debug)]
pub(crate) struct RowCurvature {
    matrix: Vec<f64>,
    step: Vec<f64>,
    /// Σ λᵢ Gᵢ before the step, and λ.
    pull: Vec<f64>,
    multipliers: Vec<f64>,
    product: Vec<f64>,
    /// Whether a step was taken whose end is not known yet, and whether B is not 0.
    pending: bool,
    some: bool,
    /// Whether B is used: from the first step of a solve on that was rejected.
    used: bool,
}

impl RowCurvature {
    /// For `n` unknowns and so many inequalities.
    pub(crate) fn new(n: usize, inequalities: usize) -> Self {
        let some = if inequalities > 0 { n } else { 0 };
        Self {
            matrix: vec![0.0; some * some],
            step: vec![0.0; some],
            pull: vec![0.0; some],
            multipliers: vec![0.0; inequalities],
            product: vec![0.0; some],
            pending: false,
            some: false,
            used: false,
        }
    }

    /// Uses B from now on; whether that changes the Hessian.
    pub(crate) fn begin(&mut self) -> bool {
        !std::mem::replace(&mut self.used, true) && self.some
    }

    /// B = 0, at the start of a solve.
    pub(crate) fn forget(&mut self) {
        if self.some {
            self.matrix.fill(0.0);
        }
        (self.pending, self.some, self.used) = (false, false, false);
    }

    /// Keeps the step that is taken from a point with these rows and multipliers.
    pub(crate) fn leave(&mut self, step: &[f64], rows: &[f64], multipliers: &[f64]) {
        self.pending = multipliers.iter().any(|y| *y > 0.0);
        if self.pending {
            self.step.copy_from_slice(step);
            self.multipliers.copy_from_slice(multipliers);
            pull(&mut self.pull, rows, multipliers);
        }
    }

    /// Updates B where a step has led to a point with these rows.
    pub(crate) fn arrive(&mut self, rows: &[f64]) {
        if !std::mem::take(&mut self.pending) {
            return;
        }
        let n = self.step.len();
        // y, in the place of the pull before the step.
        pull(&mut self.product, rows, &self.multipliers);
        for (before, after) in self.pull.iter_mut().zip(&self.product) {
            *before -= after;
        }
        let (y, s) = (&self.pull, &self.step);
        let bend = dot(y, s);
        // Written so that it is false for NaN.
        let convex = bend > ALONG * (dot(y, y) * dot(s, s)).sqrt();
        if !convex {
            return;
        }
        for (i, product) in self.product.iter_mut().enumerate() {
            *product = dot(&self.matrix[i * n..(i + 1) * n], s);
        }
        let known = dot(&self.product, s);
        let forget = if known > 1e-12 * bend { 1.0 / known } else { 0.0 };
        for i in 0..n {
            for j in 0..n {
                self.matrix[i * n + j] +=
                    y[i] * y[j] / bend - self.product[i] * self.product[j] * forget;
            }
        }
        self.some = true;
    }

    /// Adds B to a Hessian, if it is used.
    pub(crate) fn add_to(&self, hessian: &mut [f64]) {
        if self.some && self.used {
            hessian.iter_mut().zip(&self.matrix).for_each(|(h, b)| *h += b);
        }
    }
}

/// Σ λᵢ Gᵢ.
fn pull(sum: &mut [f64], rows: &[f64], multipliers: &[f64]) {
    sum.fill(0.0);
    for (row, y) in rows.chunks_exact(sum.len().max(1)).zip(multipliers) {
        sum.iter_mut().zip(row).for_each(|(sum, g)| *sum += y * g);
    }
}

#[cfg(test)]
mod tests {
    use crate::least_squares::{LocalModel, Problem, Solver, Stop, Stopping};

    /// The point nearest to `goal` with 1 - (x/a)ᵖ - yᵖ ≥ 0: a rectangle with corners that are rounded the less the
    /// larger p is.
    struct Corner {
        at: [f64; 2],
        trial: [f64; 2],
        goal: [f64; 2],
        power: i32,
    }

    const WIDE: f64 = 1.5;

    impl Problem for Corner {
        fn evaluate(&mut self, step: &[f64], _: &mut [f64], inequalities: &mut [f64]) -> f64 {
            self.trial = [self.at[0] + step[0], self.at[1] + step[1]];
            let [x, y] = self.trial;
            // The p-th root keeps the slope of order 1 far outside too.
            let size = (x / WIDE).powi(self.power) + y.powi(self.power);
            inequalities[0] = 1.0 - size.powf(1.0 / f64::from(self.power));
            (x - self.goal[0]).powi(2) + (y - self.goal[1]).powi(2)
        }

        fn accept(&mut self) {
            self.at = self.trial;
        }

        fn linearise(&mut self, local: &mut LocalModel) {
            let [x, y] = self.at;
            let p = self.power;
            let size = (x / WIDE).powi(p) + y.powi(p);
            let outer = size.powf(1.0 / f64::from(p) - 1.0);
            local.hessian.copy_from_slice(&[2.0, 0.0, 0.0, 2.0]);
            local.inequality_rows[0] = -outer * (x / WIDE).powi(p - 1) / WIDE;
            local.inequality_rows[1] = -outer * y.powi(p - 1);
            for i in 0..2 {
                local.gradient[i] = 2.0 * (self.at[i] - self.goal[i]);
                local.lower[i] = f64::NEG_INFINITY;
                local.upper[i] = f64::INFINITY;
            }
        }
    }

    /// The distance of the goal from the nearest of a million points of the boundary.
    fn nearest(goal: [f64; 2], power: i32) -> f64 {
        let distance = |k: u32| {
            let angle = f64::from(k) * std::f64::consts::FRAC_PI_2 / 1e6;
            let (s, c) = angle.sin_cos();
            let part = 2.0 / f64::from(power);
            (WIDE * c.powf(part) - goal[0]).hypot(s.powf(part) - goal[1])
        };
        (0..=1_000_000).map(distance).fold(f64::INFINITY, f64::min)
    }

    #[test]
    fn the_rounded_corner_of_a_limit_is_found_in_few_steps() {
        for (power, goal) in [
            (8, [3.0, 2.0]),
            (16, [3.0, 2.5]),
            (64, [2.5, 2.0]),
            (64, [4.0, 1.2]),
            (200, [2.5, 2.0]),
        ] {
            let mut corner = Corner { at: [0.3, 0.2], trial: [0.0; 2], goal, power };
            let summary = Solver::new(&[1.0; 2], 0, 1).minimise(&mut corner, &Stopping::default());
            assert_eq!(summary.stop, Stop::Converged, "{power}: {summary:?}");
            // Without the curvature of the limit they are up to 29.
            assert!(summary.iterations <= 20, "{power}: {summary:?}");
            let truth = nearest(goal, power).powi(2);
            assert!(
                (summary.objective - truth).abs() < 1e-4 * truth,
                "{power}: {summary:?}, {truth}"
            );
        }
    }
}
