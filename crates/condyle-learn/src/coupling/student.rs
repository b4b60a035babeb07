//! Student's t distribution, for any positive number of degrees of freedom.

/// The logarithm of the gamma function (Lanczos, g = 7, nine terms; relative error below 1e-14 for x > 0).
fn ln_gamma(x: f64) -> f64 {
    const C: [f64; 9] = [
        0.999_999_999_999_809_9,
        676.520_368_121_885_1,
        -1_259.139_216_722_402_8,
        771.323_428_777_653_1,
        -176.615_029_162_140_6,
        12.507_343_278_686_905,
        -0.138_571_095_265_720_12,
        9.984_369_578_019_572e-6,
        1.505_632_735_149_311_6e-7,
    ];
    if x < 0.5 {
        let sine = (std::f64::consts::PI * x).sin();
        return (std::f64::consts::PI / sine).ln() - ln_gamma(1.0 - x);
    }
    let x = x - 1.0;
    let t = x + 7.5;
    let sum = (1..9).fold(C[0], |sum, i| sum + C[i] / (x + i as f64));
    0.5 * std::f64::consts::TAU.ln() + (x + 0.5) * t.ln() - t + sum.ln()
}

/// The regularised incomplete beta function, by Lentz's continued fraction.
fn beta(x: f64, a: f64, b: f64) -> f64 {
    if x <= 0.0 || x >= 1.0 {
        return if x <= 0.0 { 0.0 } else { 1.0 };
    }
    if x > (a + 1.0) / (a + b + 2.0) {
        return 1.0 - beta(1.0 - x, b, a);
    }
    let front = (ln_gamma(a + b) - ln_gamma(a) - ln_gamma(b) + a * x.ln() + b * (-x).ln_1p()).exp();
    let away = |v: f64| if v.abs() < 1e-300 { 1e-300 } else { v };
    let (mut c, mut d) = (1.0, 1.0 / away(1.0 - (a + b) * x / (a + 1.0)));
    let mut h = d;
    for m in 1..500 {
        let m = f64::from(m);
        for term in [
            m * (b - m) * x / ((a + 2.0 * m - 1.0) * (a + 2.0 * m)),
            -(a + m) * (a + b + m) * x / ((a + 2.0 * m) * (a + 2.0 * m + 1.0)),
        ] {
            d = 1.0 / away(1.0 + term * d);
            c = away(1.0 + term / c);
            h *= c * d;
        }
        if (c * d - 1.0).abs() < 1e-16 {
            break;
        }
    }
    front * h / a
}

/// The share of Student's distribution with `freedom` degrees of freedom that lies below `t`.
///
/// ```
/// // With one degree of freedom it is Cauchy's: ½ + atan(t)/π.
/// let share = condyle_learn::coupling::t_share(1.0, 1.0);
/// assert!((share - 0.75).abs() < 1e-14);
/// ```
#[must_use]
pub fn share(t: f64, freedom: f64) -> f64 {
    if !t.is_finite() {
        return if t > 0.0 { 1.0 } else { 0.0 };
    }
    let tail = 0.5 * beta(freedom / (freedom + t * t), 0.5 * freedom, 0.5);
    if t > 0.0 { 1.0 - tail } else { tail }
}

/// The number below which a share of Student's distribution lies; 0.975 gives 95 % two-sided intervals.
///
/// ```
/// // Printed in every table: 12.706 for one degree of freedom, 2.262 for nine.
/// let t = |freedom| condyle_learn::coupling::t_quantile(0.975, freedom);
/// assert!((t(1.0) - 12.7062).abs() < 1e-4 && (t(9.0) - 2.2622).abs() < 1e-4);
/// ```
#[must_use]
pub fn quantile(below: f64, freedom: f64) -> f64 {
    if below < 0.5 {
        return -quantile(1.0 - below, freedom);
    }
    if !(freedom > 0.0 && below < 1.0) {
        return f64::INFINITY;
    }
    let (mut low, mut high) = (0.0, 1.0);
    while share(high, freedom) < below && high < 1e150 {
        high *= 4.0;
    }
    for _ in 0..200 {
        let middle = 0.5 * (low + high);
        if share(middle, freedom) < below {
            low = middle
        } else {
            high = middle
        }
        if high - low <= 1e-14 * high {
            break;
        }
    }
    0.5 * (low + high)
}
