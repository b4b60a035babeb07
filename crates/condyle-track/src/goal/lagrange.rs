//! Multipliers of the rows that hold a pose, and the Hessian of the Lagrangian.
//!
//! Near the minimum the Hessian is that of the Lagrangian, ∇²(F - Σ y c): with goals as rows the
//! curvature of F alone says little of how far to go along them. It is differenced from exact gradients,
//! with multipliers y from least squares, and ρ cᵀc is added, which changes no step that satisfies the
//! rows.

use super::problem::{ACTIVE, Descent};
use condyle_solve::cholesky;

/// Half the step of difference quotients, in radians or metres.
const STEP: f64 = 1e-5;

impl Descent<'_> {
    /// The rows of derivatives that hold the current pose: those that must vanish, and those that must
    /// not be negative, are active and pushed against; and the multiplier of each, by least squares over
    /// the unknowns that are not at a bound.
    ///
    /// Evaluated at the current pose. `(rows, multipliers, which of the inequalities)`.
    pub(super) fn multipliers(&self) -> (Vec<f64>, Vec<f64>, Vec<usize>) {
        let n = self.question.unknown_len();
        let (equal, least) = self.shape();
        let (mut rows, mut others) = (vec![0.0; equal * n], vec![0.0; least * n]);
        let (mut values, mut bounds) = (vec![0.0; equal], vec![0.0; least]);
        self.derivatives(&mut rows, &mut others);
        self.values(&mut values, &mut bounds);
        let mut gradient = vec![0.0; n];
        self.gradient(&mut gradient);
        let free: Vec<bool> = (0..n).map(|i| self.at_bounds(i) == [false; 2]).collect();
        let mut active: Vec<usize> = (0..least).filter(|&i| bounds[i] <= ACTIVE).collect();
        loop {
            let mut all = rows.clone();
            active.iter().for_each(|&i| all.extend_from_slice(&others[i * n..(i + 1) * n]));
            let multipliers = least_squares(&all, &gradient, &free);
            // One that would have to pull is not active.
            let pulls = |i: usize| multipliers[equal + i] < 0.0;
            let before = active.len();
            let kept: Vec<usize> = (0..before).filter(|&i| !pulls(i)).map(|i| active[i]).collect();
            if kept.len() == before {
                return (all, multipliers, active);
            }
            active = kept;
        }
    }

    /// The Hessian of the Lagrangian at the current pose, by central differences of exact gradients; with
    /// what makes it positive definite across the rows. Leaves another pose evaluated.
    pub(super) fn curved_hessian(&mut self, hessian: &mut [f64]) {
        let n = self.question.unknown_len();
        let (rows, multipliers, active) = self.multipliers();
        let (equal, least) = self.shape();
        let (mut c, mut g) = (vec![0.0; equal * n], vec![0.0; least * n]);
        let mut gradients = [vec![0.0; n], vec![0.0; n]];
        let mut square = vec![0.0; n * n];
        let center = self.current.clone();
        let mut along = vec![0.0; self.question.model.tangent_len()];
        // What moves no goal and no row has nothing but rest, of which the curvature is known.
        let mut plain = vec![0.0; n * n];
        self.hessian(&mut plain);
        let still: Vec<bool> = (0..n).map(|unknown| !self.moves(unknown, &rows)).collect();
        for unknown in 0..n {
            if still[unknown] {
                for row in 0..n {
                    let (low, high) = (row.min(unknown), row.max(unknown));
                    square[row * n + unknown] = plain[high * n + low];
                }
                continue;
            }
            for (gradient, step) in gradients.iter_mut().zip([STEP, -STEP]) {
                along.fill(0.0);
                along[self.question.directions[unknown]] = step;
                let mut moved = center.clone();
                self.question.model.retract(&center, &along, &mut moved);
                self.evaluate_at(&moved);
                self.gradient(gradient);
                self.derivatives(&mut c, &mut g);
                let lines = c.chunks_exact(n).chain(active.iter().map(|&i| &g[i * n..(i + 1) * n]));
                for (line, y) in lines.zip(&multipliers) {
                    gradient.iter_mut().zip(line).for_each(|(entry, slope)| *entry -= y * slope);
                }
            }
            for row in 0..n {
                square[row * n + unknown] = (gradients[0][row] - gradients[1][row]) / (2.0 * STEP);
            }
        }
        let largest = (0..n).map(|i| square[i * n + i].abs()).fold(0.0, f64::max);
        let longest = rows.chunks_exact(n).map(|r| r.iter().map(|v| v * v).sum::<f64>());
        let across = 10.0 * largest / longest.fold(1e-300, f64::max);
        for i in 0..n {
            for j in 0..=i {
                let crossing: f64 = rows.chunks_exact(n).map(|r| r[i] * r[j]).sum();
                hessian[i * n + j] =
                    0.5 * (square[i * n + j] + square[j * n + i]) + across * crossing;
            }
        }
    }
}

/// The y that minimise |g - Aᵀy| over the free components; small where rows depend on each other.
fn least_squares(rows: &[f64], gradient: &[f64], free: &[bool]) -> Vec<f64> {
    let n = gradient.len();
    let m = rows.len() / n.max(1);
    let dot =
        |a: &[f64], b: &[f64]| -> f64 { (0..n).filter(|&i| free[i]).map(|i| a[i] * b[i]).sum() };
    let row = |i: usize| &rows[i * n..(i + 1) * n];
    let mut matrix = vec![0.0; m * m];
    for i in 0..m {
        (0..=i).for_each(|j| matrix[i * m + j] = dot(row(i), row(j)));
    }
    let largest = (0..m).map(|i| matrix[i * m + i]).fold(0.0, f64::max);
    (0..m).for_each(|i| matrix[i * m + i] += 1e-13 * largest + 1e-300);
    let mut multipliers: Vec<f64> = (0..m).map(|i| dot(row(i), gradient)).collect();
    match cholesky::factor(&mut matrix, m) {
        Ok(()) => cholesky::solve(&matrix, m, &mut multipliers),
        Err(_) => multipliers.fill(0.0),
    }
    multipliers
}
