//! The roots of a [`Quartic`], bracketed by its extrema.
//!
//! Slower than `lines.rs`, but it finds every change of sign. With θ counted so that |f| is large
//! at π, f·(1 + t²)² is a quartic polynomial in t = tan(θ/2) whose leading coefficient is not
//! small. The roots of each derivative bracket those of the next lower one.

use super::quartic::{Quartic, Turn, Turns};

impl Quartic {
    /// All roots, by bracketing.
    #[cold]
    pub(super) fn by_extrema(&self) -> Turns {
        // f has five coefficients, so its values at five equally spaced angles determine it: it
        // cannot be small at all eight angles.
        let mut far = (1.0, 0.0);
        for turn in EIGHTHS {
            if self.at(turn).abs() > self.at(far).abs() {
                far = turn;
            }
        }
        let back = (-far.0, -far.1);
        let g = self.turned(back);
        // g·(1 + t²)² from cos θ = (1 - t²)/(1 + t²) and sin θ = 2t/(1 + t²), constant term first.
        // The leading coefficient is g(π) = f(far); t is infinite there.
        let quartic = [
            g.constant + g.cos + g.cos2,
            2.0 * g.sin + 4.0 * g.sin2,
            2.0 * g.constant - 6.0 * g.cos2,
            2.0 * g.sin - 4.0 * g.sin2,
            g.constant - g.cos + g.cos2,
        ];
        let mut turns = Turns::NONE;
        // Back from t to cosine and sine, and from g to f.
        for &t in real_roots(quartic).iter().flatten() {
            let r = 1.0 / (1.0 + t * t);
            let (x, y) = ((1.0 - t * t) * r, 2.0 * t * r);
            turns.push((x * back.0 - y * back.1, x * back.1 + y * back.0));
        }
        turns
    }

    /// f at the angle θ + φ as a function of θ.
    #[inline(always)]
    fn turned(&self, (c, s): Turn) -> Self {
        let (cc, ss) = (c * c - s * s, 2.0 * c * s);
        Self {
            constant: self.constant,
            cos: self.cos * c + self.sin * s,
            sin: self.sin * c - self.cos * s,
            cos2: self.cos2 * cc + self.sin2 * ss,
            sin2: self.sin2 * cc - self.cos2 * ss,
        }
    }
}

const EIGHTHS: [Turn; 8] = {
    const R: f64 = std::f64::consts::FRAC_1_SQRT_2;
    [(1.0, 0.0), (R, R), (0.0, 1.0), (-R, R), (-1.0, 0.0), (-R, -R), (0.0, -1.0), (R, -R)]
};

/// The real roots of a polynomial of degree 4, constant term first, with a leading coefficient that
/// is not small.
fn real_roots(k: [f64; 5]) -> [Option<f64>; 4] {
    // Cauchy's bound on the absolute value of the roots of k.
    let largest = k[..4].iter().fold(0.0, |most: f64, c| most.max(c.abs()));
    let bound = 1.0 + largest / k[4].abs();
    // The derivatives of degree 3, 2 and 1, in the same storage.
    let third = [k[1], 2.0 * k[2], 3.0 * k[3], 4.0 * k[4], 0.0];
    let second = [2.0 * k[2], 6.0 * k[3], 12.0 * k[4], 0.0, 0.0];
    let first = [6.0 * k[3], 24.0 * k[4], 0.0, 0.0, 0.0];
    let mut stops = [None; 4];
    for polynomial in [first, second, third, k] {
        stops = between(&polynomial, &stops, bound);
    }
    stops
}

/// The roots of a polynomial between consecutive stops (the roots of its derivative) where it
/// changes sign; between them it is monotonic, so that there is one root at most.
fn between(k: &[f64; 5], stops: &[Option<f64>; 4], bound: f64) -> [Option<f64>; 4] {
    let value = |t: f64| (((k[4] * t + k[3]) * t + k[2]) * t + k[1]) * t + k[0];
    let mut found = [None; 4];
    let mut count = 0;
    let mut low = -bound;
    let mut at_low = value(low);
    for high in stops.iter().copied().flatten().chain([bound]) {
        let at_high = value(high);
        if (at_low < 0.0) != (at_high < 0.0) && count < 4 {
            found[count] = Some(enclosed(k, (low, at_low), high));
            count += 1;
        }
        (low, at_low) = (high, at_high);
    }
    found
}

/// The root between two arguments with different signs: Newton steps, with bisection where a step
/// leaves the bracket.
fn enclosed(k: &[f64; 5], (mut low, at_low): (f64, f64), mut high: f64) -> f64 {
    let rising = at_low < 0.0;
    let mut t = 0.5 * (low + high);
    for _ in 0..120 {
        let value = (((k[4] * t + k[3]) * t + k[2]) * t + k[1]) * t + k[0];
        let slope = ((4.0 * k[4] * t + 3.0 * k[3]) * t + 2.0 * k[2]) * t + k[1];
        if (value < 0.0) == rising {
            low = t;
        } else {
            high = t;
        }
        let newton = t - value / slope;
        let next = if newton > low && newton < high { newton } else { 0.5 * (low + high) };
        if (next - t).abs() <= 1e-16 * (1.0 + t.abs()) || next == low || next == high {
            return next;
        }
        t = next;
    }
    t
}
