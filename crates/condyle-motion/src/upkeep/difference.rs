//! Rates of change.
//!
//! Inside a run, of steps h before and k after a value, (h² y₊ + (k² - h²) y - k² y₋)/(h k (h + k)): exact for parabolas.
//! At its ends the slope of the parabola through the three values there.

use super::{Series, runs};
use condyle_diagnostics::Error;

pub(super) fn differentiate(series: &mut Series) -> Result<String, Error> {
    let Series { times, columns, .. } = series;
    if times.windows(2).any(|pair| pair[1] <= pair[0]) {
        return Err(Error::new(
            "upkeep/uneven",
            "two rows are at the same time, between which there is no rate",
        )
        .with_help("resample first"));
    }
    for column in columns {
        let mut rates = vec![f64::NAN; column.len()];
        for run in runs(column) {
            slopes(&times[run.clone()], &column[run.clone()], &mut rates[run]);
        }
        *column = rates;
    }
    Ok("differentiated: values are per second (differences of second order)".into())
}

/// A single value has no rate.
fn slopes(t: &[f64], y: &[f64], rates: &mut [f64]) {
    let n = t.len();
    let secant = |i: usize| (y[i + 1] - y[i]) / (t[i + 1] - t[i]);
    match n {
        0 | 1 => return,
        2 => return rates.fill(secant(0)),
        _ => {}
    }
    for i in 1..n - 1 {
        let (h, k) = (t[i] - t[i - 1], t[i + 1] - t[i]);
        rates[i] = (k * secant(i - 1) + h * secant(i)) / (h + k);
    }
    rates[0] = 2.0 * secant(0) - rates[1];
    rates[n - 1] = 2.0 * secant(n - 2) - rates[n - 2];
}
