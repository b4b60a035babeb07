//! Which coordinates control, where nobody says.

use super::Samples;
use condyle_model::CoordinateKind;
use condyle_solve::regression::Regression;

/// Which columns control and which follow, and why.
#[derive(Clone, Debug, PartialEq)]
pub struct Split {
    /// The columns in control.
    pub control: Vec<usize>,
    /// Those that follow.
    pub follow: Vec<usize>,
    /// Columns that do not move, and are neither.
    pub constant: Vec<usize>,
    /// Why, in a sentence; empty where both were given.
    pub reason: String,
}

/// A column whose spread is less in its unit does not move (1e-9 m, 1e-9 rad), nor one that moves less than rounding.
const STILL: f64 = 1e-9;
/// A column follows if less than this share of its variance is left beside those in control.
const FOLLOWS: f64 = 0.1;

/// Splits columns into those in control and those that follow.
///
/// What is given stays. Where only one side is given, the others that move are the other side. Where none is: with both
/// rotations and translations the rotations control, as in Pronost et al. 2010, since joints are driven by angles;
/// otherwise columns are taken into control in the order of a pivoted QR of the standardised columns, the one that says most
/// about all others first, until what is left of each is less than a tenth of its variance, or the half of them control.
///
/// `kinds` are those of the columns, where they are known.
#[must_use]
pub fn split(
    samples: &Samples,
    kinds: &[Option<CoordinateKind>],
    control: &[usize],
    follow: &[usize],
) -> Split {
    let moves: Vec<bool> = (0..samples.columns.len())
        .map(|column| {
            let values = samples.column(column);
            let (low, high) = values
                .iter()
                .fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), v| (l.min(*v), h.max(*v)));
            high - low > STILL.max(1e-12 * low.abs().max(high.abs()))
        })
        .collect();
    let free = |column: &usize| !control.contains(column) && !follow.contains(column);
    let others: Vec<usize> =
        (0..samples.columns.len()).filter(free).filter(|c| moves[*c]).collect();
    let constant = (0..samples.columns.len()).filter(free).filter(|c| !moves[*c]).collect();
    let (control, follow, reason) = match (control.is_empty(), follow.is_empty()) {
        (false, false) => (control.to_vec(), follow.to_vec(), String::new()),
        (false, true) => {
            let reason = "all others that move follow the coordinates that are given";
            (control.to_vec(), others, reason.to_owned())
        }
        (true, false) => {
            let reason = "all others that move control those that are given";
            (others, follow.to_vec(), reason.to_owned())
        }
        (true, true) => proposed(samples, kinds, others),
    };
    Split { control, follow, constant, reason }
}

fn proposed(
    samples: &Samples,
    kinds: &[Option<CoordinateKind>],
    columns: Vec<usize>,
) -> (Vec<usize>, Vec<usize>, String) {
    let is = |column: &usize, kind| kinds.get(*column) == Some(&Some(kind));
    let (turns, moves): (Vec<usize>, Vec<usize>) =
        columns.iter().copied().partition(|c| is(c, CoordinateKind::Rotation));
    let all_known = columns
        .iter()
        .all(|c| is(c, CoordinateKind::Rotation) || is(c, CoordinateKind::Translation));
    if all_known && !turns.is_empty() && !moves.is_empty() {
        let reason = "rotations control and translations follow: joints are driven by angles";
        return (turns, moves, reason.to_owned());
    }
    // Standardised, row by row.
    let values: Vec<Vec<f64>> = columns
        .iter()
        .map(|column| {
            let values = samples.column(*column);
            let n = values.len() as f64;
            let mean = values.iter().sum::<f64>() / n;
            let scale = (values.iter().map(|v| (v - mean).powi(2)).sum::<f64>()).sqrt();
            values.iter().map(|v| (v - mean) / scale).collect()
        })
        .collect();
    // The first column is the one that leaves least of all others.
    let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    let mut chosen: Vec<usize> = vec![];
    let most = columns.len().div_ceil(2).min(columns.len().saturating_sub(1));
    while chosen.len() < most {
        let left_with = |candidate: usize| -> f64 {
            let set: Vec<usize> = chosen.iter().copied().chain([candidate]).collect();
            left(&values, &set).into_iter().sum()
        };
        let best = (0..columns.len())
            .filter(|c| !chosen.contains(c))
            .map(|c| (c, left_with(c)))
            .fold(None, |best: Option<(usize, f64)>, one| match best {
                // Of equal ones the first.
                Some(best) if best.1 <= one.1 * (1.0 + 1e-9) + 1e-12 => Some(best),
                _ => Some(one),
            });
        let Some((column, _)) = best else { break };
        chosen.push(column);
        if left(&values, &chosen).into_iter().all(|share| share < FOLLOWS) {
            break;
        }
    }
    debug_assert!(values.iter().all(|v| (dot(v, v) - 1.0).abs() < 1e-6));
    let control: Vec<usize> = chosen.iter().map(|c| columns[*c]).collect();
    let follow: Vec<usize> =
        columns.iter().enumerate().filter(|(c, _)| !chosen.contains(c)).map(|(_, c)| *c).collect();
    let shares = left(&values, &chosen);
    let worst = shares.iter().copied().fold(0.0, f64::max);
    let reason = format!(
        "with {} in control at most {:.1} % of the variance of any other is left, the least with so many",
        condyle_diagnostics::listed(control.iter().map(|c| samples.columns[*c].as_str())),
        100.0 * worst
    );
    (control, follow, reason)
}

/// The share of the variance of each standardised column that a linear sum of some does not explain.
fn left(values: &[Vec<f64>], control: &[usize]) -> Vec<f64> {
    let rows = values.first().map_or(0, Vec::len);
    let design: Vec<f64> =
        (0..rows).flat_map(|row| control.iter().map(move |c| values[*c][row])).collect();
    let fit = Regression::new(&design, control.len(), &[]);
    let share = |column: &Vec<f64>| {
        let gamma = fit.project(column);
        (1.0 - gamma.iter().map(|g| g * g).sum::<f64>()).max(0.0)
    };
    let others = (0..values.len()).filter(|c| !control.contains(c));
    others.map(|c| share(&values[c])).collect()
}
