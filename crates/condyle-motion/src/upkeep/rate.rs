//! Other rows: another rate, a part.

use super::{Series, argument, plural, runs, spline};
use condyle_diagnostics::Error;

/// Steps of time may differ from their mean by this share of it, as times in files are rounded.
const EVEN: f64 = 0.2;

/// Rows per second on average; none for fewer than two rows.
pub(super) fn rate(times: &[f64]) -> Option<f64> {
    let (first, last) = (times.first()?, times.last()?);
    (last > first).then(|| (times.len() - 1) as f64 / (last - first))
}

/// The rate if every time is where even steps have it, within a fifth of a step.
pub(super) fn even_rate(times: &[f64]) -> Option<f64> {
    let rate = rate(times)?;
    let even = times
        .iter()
        .enumerate()
        .all(|(row, time)| ((time - times[0]) * rate - row as f64).abs() <= EVEN);
    even.then_some(rate)
}

/// The most rows that are made of one: what a slip of the pen would ask for is refused.
const MOST: f64 = 1000.0;

pub(super) fn resample(series: &mut Series, hertz: f64) -> Result<String, Error> {
    if !(hertz > 0.0 && hertz.is_finite()) {
        return Err(argument(format!("{hertz} rows a second: give a number above 0")));
    }
    let Some(old) = rate(&series.times) else {
        return Err(Error::new("upkeep/empty", "another rate needs at least two rows"));
    };
    let (first, last) = (series.times[0], series.times[series.times.len() - 1]);
    let count = ((last - first) * hertz * (1.0 + 1e-12) + 1e-6).floor();
    if count > MOST * series.times.len() as f64 {
        return Err(argument(format!(
            "{hertz} rows a second would be {:.0} times the rows there are",
            hertz / old
        )));
    }
    let times: Vec<f64> = (0..=count as usize).map(|row| first + row as f64 / hertz).collect();
    let columns = series.columns.iter().map(|column| sampled(&series.times, column, &times));
    series.columns = columns.collect();
    let rows = times.len();
    series.times = times;
    Ok(format!("resampled from {} to {hertz} rows a second, {rows} rows", short(old)))
}

/// A column at other times: on the spline of each run, missing in between.
fn sampled(times: &[f64], column: &[f64], wanted: &[f64]) -> Vec<f64> {
    let mut values = vec![f64::NAN; wanted.len()];
    for run in runs(column) {
        let mut rows: Vec<usize> = Vec::with_capacity(run.len());
        for row in run {
            if rows.last().is_none_or(|&last| times[row] > times[last]) {
                rows.push(row);
            }
        }
        let at: Vec<f64> = rows.iter().map(|&row| times[row]).collect();
        let known: Vec<f64> = rows.iter().map(|&row| column[row]).collect();
        let (start, end) = (at[0], at[at.len() - 1]);
        // Rounded times at the ends of a run still belong to it.
        let slack = 1e-6 * (end - start).max(1e-3);
        let from = wanted.partition_point(|&t| t < start - slack);
        let to = wanted.partition_point(|&t| t <= end + slack);
        if at.len() == 1 {
            values[from..to].fill(known[0]);
            continue;
        }
        let slopes = spline::slopes(&at, &known);
        let mut k = 0;
        for row in from..to {
            let time = wanted[row].clamp(start, end);
            while k + 2 < at.len() && at[k + 1] <= time {
                k += 1;
            }
            values[row] = spline::at(
                time,
                [at[k], at[k + 1]],
                [known[k], known[k + 1]],
                [slopes[k], slopes[k + 1]],
            );
        }
    }
    values
}

pub(super) fn crop(series: &mut Series, from: f64, to: f64) -> Result<String, Error> {
    if from.is_nan() || to.is_nan() || from > to {
        return Err(argument(format!(
            "a part from {from} to {to} s: it must not end before it starts"
        )));
    }
    let slack = rate(&series.times).map_or(0.0, |rate| 1e-6 / rate);
    let first = series.times.partition_point(|&t| t < from - slack);
    let last = series.times.partition_point(|&t| t <= to + slack);
    if first >= last {
        let there = match series.times[..] {
            [] => "there are no rows".to_owned(),
            [start, .., end] => format!("rows are from {start} to {end} s"),
            [only] => format!("the only row is at {only} s"),
        };
        return Err(Error::new(
            "upkeep/empty",
            format!("no row is between {from} and {to} s: {there}"),
        ));
    }
    let rows = last - first;
    let all = series.times.len();
    for column in &mut series.columns {
        *column = column[first..last].to_vec();
    }
    series.times = series.times[first..last].to_vec();
    let (start, end) = (series.times[0], series.times[rows - 1]);
    let word = plural(rows, "row", "rows");
    Ok(format!("cut to {rows} {word} of {all}, from {start} to {end} s"))
}

/// A rate that was computed from rounded times, as people write it.
pub(super) fn short(rate: f64) -> f64 {
    let digits = 10_f64.powi(4 - rate.abs().log10().ceil() as i32);
    (rate * digits).round() / digits
}
