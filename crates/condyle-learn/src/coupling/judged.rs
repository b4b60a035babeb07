//! How far a law can be believed: parts left out, acceptance, the criterion of 2010.

use super::design::{Design, Fitted};
use super::student;

/// A law is accepted if chance alone gave such an advantage in fewer than so many of all cases.
const CHANCE: f64 = 0.025;
/// Errors below this share of the spread of a dependent are rounding.
const ROUNDING: f64 = 1e-12;

/// What parts say that were left out in turn, each predicted by the law of all others.
#[derive(Clone, Debug, PartialEq)]
pub struct LeftOut {
    /// How many parts were left out, one after another.
    pub parts: usize,
    /// The root mean square error of the predictions, in the unit of the dependent.
    pub rmse: f64,
    /// The same of predicting the mean of all other parts: the best centre that stays where it is.
    pub rmse_of_mean: f64,
    /// The same of the mean of the part itself, which no prediction knows.
    pub rmse_of_own_mean: f64,
    /// 1 - (`rmse`/`rmse_of_mean`)²; below 0 where the mean predicts better.
    pub r2: f64,
    /// How likely such an advantage over the mean of the others, or a greater one, is where there is none: one-sided t test
    /// of log(mean square error of the mean / of the law) over the parts.
    pub chance: f64,
}

impl LeftOut {
    /// Whether the law predicts what was left out better than the mean, beyond chance.
    #[must_use]
    pub fn is_better(&self) -> bool {
        self.rmse < self.rmse_of_mean && self.chance < CHANCE
    }
}

/// Leaves groups of a design's parts out in turn; `None` where there are not two of them.
pub(super) fn left_out(
    design: &Design,
    y: &[f64],
    fitted: &Fitted,
    groups: &[Vec<usize>],
) -> Option<LeftOut> {
    if groups.len() < 2 {
        return None;
    }
    let total: f64 = y.iter().sum();
    let mean = total / y.len() as f64;
    let spread = y.iter().map(|y| (y - mean).powi(2)).sum::<f64>() / y.len() as f64;
    let (mut law, mut others, mut own, mut count) = (0.0, 0.0, 0.0, 0usize);
    let mut advantages = vec![];
    for group in groups {
        let predicted = design.left_out(y, fitted, group)?;
        let values: Vec<f64> =
            group.iter().flat_map(|part| y[design.parts[*part].clone()].iter().copied()).collect();
        let size = values.len();
        if size == 0 {
            continue;
        }
        let sum: f64 = values.iter().sum();
        let mean_of_others = (total - sum) / (y.len() - size) as f64;
        let mean_of_own = sum / size as f64;
        let square = |a: f64| a * a;
        let of_law: f64 = values.iter().zip(&predicted).map(|(y, p)| square(y - p)).sum();
        let of_others: f64 = values.iter().map(|y| square(y - mean_of_others)).sum();
        own += values.iter().map(|y| square(y - mean_of_own)).sum::<f64>();
        law += of_law;
        others += of_others;
        count += size;
        let least = ROUNDING * ROUNDING * spread * size as f64 + f64::MIN_POSITIVE;
        advantages.push(((of_others + least) / (of_law + least)).ln());
    }
    let rmse = |sum: f64| (sum / count as f64).sqrt();
    Some(LeftOut {
        parts: advantages.len(),
        rmse: rmse(law),
        rmse_of_mean: rmse(others),
        rmse_of_own_mean: rmse(own),
        r2: 1.0 - law / others,
        chance: chance(&advantages),
    })
}

/// The one-sided p value of a mean above 0.
fn chance(values: &[f64]) -> f64 {
    let n = values.len() as f64;
    let mean = values.iter().sum::<f64>() / n;
    let variance = values.iter().map(|v| (v - mean).powi(2)).sum::<f64>() / (n - 1.0);
    if n < 2.0 || !mean.is_finite() {
        return 1.0;
    }
    let error = (variance / n).sqrt();
    if error == 0.0 {
        return if mean > 0.0 { 0.0 } else { 1.0 };
    }
    1.0 - student::share(mean / error, n - 1.0)
}

/// The criterion of Pronost et al. 2010, max|M·C - E| < min(E), in both readings. It compares an error with where the
/// origin happens to lie: with E a position of half a metre and its absolute value any law holds, of noise too; with its
/// sign no law of a negative coordinate does.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Validity {
    /// The greatest error of the law on the data that it was learned from.
    pub largest: f64,
    /// min(E).
    pub least: f64,
    /// min|E|.
    pub least_absolute: f64,
}

impl Validity {
    /// Whether max|M·C - E| < min(E).
    #[must_use]
    pub fn signed(&self) -> bool {
        self.largest < self.least
    }

    /// Whether max|M·C - E| < min|E|.
    #[must_use]
    pub fn absolute(&self) -> bool {
        self.largest < self.least_absolute
    }
}

pub(super) fn validity(y: &[f64], residuals: &[f64]) -> Validity {
    let largest = residuals.iter().fold(0.0f64, |most, e| most.max(e.abs()));
    let least = y.iter().copied().fold(f64::INFINITY, f64::min);
    let least_absolute = y.iter().fold(f64::INFINITY, |least, y| least.min(y.abs()));
    Validity { largest, least, least_absolute }
}
