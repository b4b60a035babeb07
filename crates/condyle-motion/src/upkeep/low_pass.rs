//! The low-pass that laboratories use: Butterworth, forth and back, without delay.
//!
//! One pass of order 2 with cut-off f has the gain 1/√(1 + (tan(πν/F)/tan(πf/F))⁴) at frequency ν, F being the rate. Two
//! passes have its square, which at f is 1/2 in amplitude. So that both together leave half of the *power* at the
//! stated frequency, each is made with tan(πf/F) larger by 1/(√2 - 1)^¼ = 1.2465 (D. A. Winter, Biomechanics and Motor
//! Control of Human Movement, 4th ed. 2009, 2.2.4.4: a correction of 0.802).
//!
//! Each run of values is continued at both ends by its point reflection over three periods of the cut-off, and the
//! filter starts in the state that the first value, held for ever, would leave it in (F. Gustafsson, IEEE Trans.
//! Signal Processing 44, 1996, compares such starts).

use super::{Series, argument, plural, rate, runs};
use condyle_diagnostics::Error;

/// A run of fewer values is left as it is: it is shorter than what the filter responds to.
const LEAST: usize = 4;

/// A run is continued over so many periods of the cut-off: what the start of the filter leaves decays by a factor of
/// exp(2π 1.2465/√2) = 254 in each.
const PERIODS: f64 = 3.0;

pub(super) fn low_pass(series: &mut Series, hertz: f64) -> Result<String, Error> {
    let Some(rate) = rate::even_rate(&series.times) else {
        return Err(Error::new(
            "upkeep/uneven",
            "times are not evenly spaced, which a filter needs",
        )
        .with_help("resample first: it may be asked for in a run before"));
    };
    if !(hertz > 0.0 && hertz < rate / 2.0) {
        return Err(argument(format!(
            "a low-pass at {hertz} Hz: of {} rows a second it must be above 0 and below {} Hz",
            rate::short(rate),
            rate::short(rate / 2.0)
        )));
    }
    let filter = Filter::new(hertz / rate);
    let reach = ((PERIODS * rate / hertz).ceil() as usize).max(9);
    let mut left = 0;
    for (index, column) in series.columns.iter_mut().enumerate() {
        for run in runs(column) {
            if run.len() < LEAST {
                left += usize::from(index % series.together.max(1) == 0);
            } else {
                filter.forth_and_back(&mut column[run], reach);
            }
        }
    }
    let mut said = format!(
        "low-passed at {hertz} Hz (Butterworth, order 2, forth and back, half power at {hertz} Hz after both)"
    );
    if left > 0 {
        said += &format!(
            "; {left} {} of fewer than {LEAST} values left as {}",
            plural(left, "run", "runs"),
            plural(left, "it was", "they were")
        );
    }
    Ok(said)
}

/// One pass: y = b0 x + b1 x' + b2 x'' - a1 y' - a2 y''.
struct Filter {
    b: [f64; 3],
    a: [f64; 2],
}

impl Filter {
    /// `share` is the cut-off as a share of the rate, below a half.
    fn new(share: f64) -> Self {
        let correction = (2.0_f64.sqrt() - 1.0).powf(-0.25);
        // The bilinear transform keeps the gain at each frequency if it is made with tangents.
        let k = (std::f64::consts::PI * share).tan() * correction;
        let (k2, root) = (k * k, 2.0_f64.sqrt() * k);
        let whole = 1.0 + root + k2;
        let b = k2 / whole;
        Self { b: [b, 2.0 * b, b], a: [2.0 * (k2 - 1.0) / whole, (1.0 - root + k2) / whole] }
    }

    fn forth_and_back(&self, values: &mut [f64], reach: usize) {
        let n = values.len();
        let reach = reach.min(n - 1);
        let (first, last) = (values[0], values[n - 1]);
        let mut long = Vec::with_capacity(n + 2 * reach);
        long.extend((1..=reach).rev().map(|i| 2.0 * first - values[i]));
        long.extend_from_slice(values);
        long.extend((1..=reach).map(|i| 2.0 * last - values[n - 1 - i]));
        self.pass(long.iter_mut());
        self.pass(long.iter_mut().rev());
        values.copy_from_slice(&long[reach..reach + n]);
    }

    fn pass<'v>(&self, mut values: impl Iterator<Item = &'v mut f64>) {
        let ([b0, b1, b2], [a1, a2]) = (self.b, self.a);
        let Some(first) = values.next() else { return };
        // The state for a constant input, whose output is the same constant.
        let (mut one, mut two) = ((1.0 - b0) * *first, (b2 - a2) * *first);
        for value in std::iter::once(first).chain(values) {
            let x = *value;
            let y = b0 * x + one;
            one = b1 * x - a1 * y + two;
            two = b2 * x - a2 * y;
            *value = y;
        }
    }
}
