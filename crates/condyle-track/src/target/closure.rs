//! Loops: rows that must vanish, or with a finite weight w a residual `w Σ c²` that is part of F.

use super::Target;
use crate::problem::Frame;
use condyle_solve::least_squares::LocalModel;

/// The loops of the model; their residuals c, in metres and radians, come with each pose.
pub(super) struct Closures;

impl Target for Closures {
    fn value(&self, frame: &mut Frame<'_>) -> f64 {
        let targets = &frame.tracker.targets;
        match targets.closure_weight {
            Some(weight) if !targets.close_exactly() => {
                let residuals = frame.buffers.closures.residuals.iter();
                weight * residuals.map(|c| c * c).sum::<f64>()
            }
            _ => 0.0,
        }
    }

    fn linearise(&self, frame: &mut Frame<'_>, local: &mut LocalModel) {
        let (tracker, closures) = (frame.tracker, &frame.buffers.closures);
        let n = tracker.unknown_len();
        for row in 0..closures.len() {
            let derivatives = closures.row(row);
            if tracker.targets.close_exactly() {
                let line = &mut local.equality_rows[row * n..(row + 1) * n];
                for (entry, &direction) in line.iter_mut().zip(&tracker.directions) {
                    *entry = derivatives[direction as usize];
                }
                continue;
            }
            let weight = 2.0 * tracker.targets.closure_weight.unwrap_or(0.0);
            let residual = closures.residuals[row];
            for (i, &direction) in tracker.directions.iter().enumerate() {
                let slope = derivatives[direction as usize];
                if slope == 0.0 {
                    continue;
                }
                local.gradient[i] += weight * residual * slope;
                for (j, &other) in tracker.directions[..=i].iter().enumerate() {
                    local.hessian[i * n + j] += weight * slope * derivatives[other as usize];
                }
            }
        }
    }
}
