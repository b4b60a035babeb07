//! Sine and cosine together, without a library call or a branch.
//!
//! Cody-Waite range reduction: x = k·π/2 + r with |r| ≤ π/4, subtracting π/2 in three parts, the
//! first two of which have so few bits that k times them is exact. Then one polynomial in r for
//! each of the two, and the quadrant k mod 4. The absolute error stays below 2⁻⁵². Angles beyond
//! ±10⁹ are clamped. The result does not depend on the platform's mathematics library, so the sine
//! of an angle is the same on every machine.

use std::f64::consts::FRAC_2_PI;

/// The largest angle; k stays below 2³⁰.
const MOST: f64 = 1e9;

/// π/2 in three parts: its first 23 bits, the next 23, and the remainder. k has at most 30 bits, so
/// the products of k with the first two fit into the 53 bits of an f64.
const HALF_PI: [f64; 3] = [
    f64::from_bits(0x3ff9_21fb_4000_0000),
    f64::from_bits(0x3e74_442d_0000_0000),
    5.390302858158119e-15,
];

/// 1.5·2⁵²: adding it rounds a number to an integer, which then occupies the lowest mantissa bits.
const ROUND: f64 = 6_755_399_441_055_744.0;

/// Coefficients in ascending powers of z = r² of the polynomials that interpolate (sin r - r)/r³
/// and (cos r - 1 + r²/2)/r⁴ at the six Chebyshev nodes of [0, (π/4)²]; sine and cosine are then
/// exact to 10⁻¹⁷.
const SERIES: [[f64; 2]; 6] = [
    [-0.16666666666666666, 0.041666666666666664],
    [0.008333333333330946, -0.0013888888888887395],
    [-0.0001984126983675497, 2.4801587298763433e-05],
    [2.755731610068312e-06, -2.7557317270560385e-07],
    [-2.5051131455447428e-08, 2.087614602470193e-09],
    [1.591810123167728e-10, -1.1382614869434128e-11],
];

/// Σ c[n]·zⁿ for both polynomials: even and odd powers are summed separately (Estrin), so that the
/// two dependency chains run in parallel.
#[inline(always)]
fn series(z: f64) -> [f64; 2] {
    let z2 = z * z;
    let step = |n: usize, sum: [f64; 2]| [SERIES[n][0] + z2 * sum[0], SERIES[n][1] + z2 * sum[1]];
    let even = step(0, step(2, SERIES[4]));
    let odd = step(1, step(3, SERIES[5]));
    [even[0] + z * odd[0], even[1] + z * odd[1]]
}

/// Sine and cosine of an angle in radians.
#[inline(always)]
pub(crate) fn sin_cos(x: f64) -> (f64, f64) {
    let x = x.clamp(-MOST, MOST);
    let shifted = x * FRAC_2_PI + ROUND;
    let quadrant = shifted.to_bits();
    let k = shifted - ROUND;
    // k·HALF_PI[0] and k·HALF_PI[1] are exact; only the third product and the sum round.
    let (near, rest) = ((x - k * HALF_PI[0]) - k * HALF_PI[1], k * HALF_PI[2]);
    let r = near - rest;
    // The rounding error of r: r + tail is the reduced angle to about twice the precision.
    let tail = (near - r) - rest;
    let z = r * r;
    let [sine, cosine] = series(z);
    // To first order sin(r + tail) = sin r + tail and cos(r + tail) = cos r - r·tail.
    let sine = r + (r * z * sine + tail);
    let cosine = (1.0 - 0.5 * z) + (z * z * cosine - r * tail);
    // Odd quadrants exchange the two; the sine is negative for k mod 4 = 2, 3, the cosine for 1, 2.
    let (s, c) = if quadrant & 1 == 0 { (sine, cosine) } else { (cosine, sine) };
    let flip = |value: f64, by: u64| f64::from_bits(value.to_bits() ^ (by << 63));
    (flip(s, (quadrant >> 1) & 1), flip(c, ((quadrant + 1) >> 1) & 1))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_is_the_sine_and_the_cosine() {
        let mut worst = 0.0f64;
        let mut check = |x: f64| {
            let ((s, c), (sine, cosine)) = (sin_cos(x), x.sin_cos());
            worst = worst.max((s - sine).abs()).max((c - cosine).abs());
        };
        for i in -200_000..200_000 {
            check(f64::from(i) * 1.234_567_89e-5);
            check(f64::from(i) * 0.499_999_7);
            check(f64::from(i) * std::f64::consts::FRAC_PI_4);
            check(f64::from(i) * 4_999.987);
        }
        // One unit in the last place of numbers near 1.
        assert!(worst <= f64::EPSILON, "{worst:e}");
    }

    #[test]
    fn plain_angles_are_plain() {
        assert_eq!(sin_cos(0.0), (0.0, 1.0));
        for x in [0.1, 1.0, 2.0, 3.0, 40.0] {
            let ((s, c), (t, d)) = (sin_cos(x), sin_cos(-x));
            assert_eq!((s, c), (-t, d));
        }
        let (s, c) = sin_cos(1e300);
        assert!(((s * s + c * c) - 1.0).abs() < 1e-15);
        assert!(sin_cos(f64::NAN).0.is_nan());
    }
}
