//! The cubic spline through values at any times.
//!
//! Between neighbouring values it is a cubic; value, slope and curvature are continuous, and at the second and the
//! last but one value the third derivative is too, so that no condition is invented at the ends ("not a knot"; C. de
//! Boor, A Practical Guide to Splines, 1978, chapter IV). Two values are joined by a line, three by a parabola.

/// Slopes of the spline at its values.
///
/// With steps `h[i]` and secants `d[i]` the curvature is continuous at value i if
///
/// h\[i\] s\[i-1\] + 2 (h\[i-1\] + h\[i\]) s\[i\] + h\[i-1\] s\[i+1\] = 3 (h\[i\] d\[i-1\] + h\[i-1\] d\[i\]).
///
/// `times` must increase; both lists have the same length.
#[must_use]
pub fn slopes(times: &[f64], values: &[f64]) -> Vec<f64> {
    let n = times.len().min(values.len());
    if n < 2 {
        return vec![0.0; n];
    }
    let step = |i: usize| times[i + 1] - times[i];
    let secant = |i: usize| (values[i + 1] - values[i]) / step(i);
    if n == 2 {
        return vec![secant(0); 2];
    }
    if n == 3 {
        // The parabola.
        let (h0, h1) = (step(0), step(1));
        let bend = (secant(1) - secant(0)) / (h0 + h1);
        return vec![secant(0) - h0 * bend, secant(0) + h0 * bend, secant(1) + h1 * bend];
    }
    // Three diagonals; the conditions at the ends have been reduced to two unknowns with the next row.
    let mut below = vec![0.0; n];
    let mut main = vec![0.0; n];
    let mut above = vec![0.0; n];
    let mut right = vec![0.0; n];
    let (h0, h1) = (step(0), step(1));
    main[0] = h1;
    above[0] = h0 + h1;
    right[0] = ((h0 + 2.0 * (h0 + h1)) * h1 * secant(0) + h0 * h0 * secant(1)) / (h0 + h1);
    for i in 1..n - 1 {
        below[i] = step(i);
        main[i] = 2.0 * (step(i - 1) + step(i));
        above[i] = step(i - 1);
        right[i] = 3.0 * (step(i) * secant(i - 1) + step(i - 1) * secant(i));
    }
    let (hl, hk) = (step(n - 2), step(n - 3));
    below[n - 1] = hl + hk;
    main[n - 1] = hk;
    right[n - 1] =
        (hl * hl * secant(n - 3) + (2.0 * (hl + hk) + hl) * hk * secant(n - 2)) / (hl + hk);
    for i in 1..n {
        let factor = below[i] / main[i - 1];
        main[i] -= factor * above[i - 1];
        right[i] -= factor * right[i - 1];
    }
    right[n - 1] /= main[n - 1];
    for i in (0..n - 1).rev() {
        right[i] = (right[i] - above[i] * right[i + 1]) / main[i];
    }
    right
}

/// The cubic of one interval at `time`, given times, values and slopes of its ends.
#[must_use]
pub fn at(time: f64, times: [f64; 2], values: [f64; 2], slopes: [f64; 2]) -> f64 {
    let h = times[1] - times[0];
    let (u, v) = ((time - times[0]) / h, (times[1] - time) / h);
    // Hermite's form, in the distances from both ends so that each end is met exactly.
    v * v * ((1.0 + 2.0 * u) * values[0] + u * h * slopes[0])
        + u * u * ((1.0 + 2.0 * v) * values[1] - v * h * slopes[1])
}
