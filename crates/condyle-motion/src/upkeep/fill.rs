//! Short gaps.

use super::{Series, argument, plural, runs, spline};
use condyle_diagnostics::Error;

/// Fills gaps between two values that are at most so many seconds apart, on the spline through all values.
pub(super) fn fill(series: &mut Series, seconds: f64) -> Result<String, Error> {
    if !(seconds > 0.0 && seconds.is_finite()) {
        return Err(argument(format!("gaps of {seconds} s cannot be filled: give a time above 0")));
    }
    let Series { times, columns, together } = series;
    let (mut gaps, mut filled, mut left) = (0, 0, 0);
    for (index, column) in columns.iter_mut().enumerate() {
        // Gaps of what is measured together are counted once.
        let counted = usize::from(index % (*together).max(1) == 0);
        let found = runs(column);
        if found.len() < 2 {
            continue;
        }
        // Rows at the same time cannot both be on a curve: the later one is left out.
        let mut seen: Vec<usize> = Vec::new();
        for row in found.iter().cloned().flatten() {
            if seen.last().is_none_or(|&last| times[row] > times[last]) {
                seen.push(row);
            }
        }
        let at: Vec<f64> = seen.iter().map(|&row| times[row]).collect();
        let values: Vec<f64> = seen.iter().map(|&row| column[row]).collect();
        let slopes = spline::slopes(&at, &values);
        for pair in found.windows(2) {
            let (before, after) = (pair[0].end - 1, pair[1].start);
            if times[after] - times[before] > seconds * (1.0 + 1e-9) {
                left += counted;
                continue;
            }
            let k = at.partition_point(|&t| t <= times[before]).saturating_sub(1);
            let Some(next) = at.get(k + 1) else { continue };
            for row in before + 1..after {
                column[row] = spline::at(
                    times[row],
                    [at[k], *next],
                    [values[k], values[k + 1]],
                    [slopes[k], slopes[k + 1]],
                );
                filled += counted;
            }
            gaps += counted;
        }
    }
    let mut said = format!(
        "filled {gaps} {} of up to {seconds} s, {filled} {}",
        plural(gaps, "gap", "gaps"),
        plural(filled, "value", "values")
    );
    if left > 0 {
        said += &format!("; {left} longer {} left", plural(left, "one was", "ones were"));
    }
    Ok(said)
}
