//! Rotations spread evenly over all that there are.

use condyle_math::Quat;
use std::f64::consts::{PI, SQRT_2};

/// The irrational number ψ with ψ⁴ = ψ + 4, with which the spirals are even (Alexa 2022).
const PSI: f64 = 1.533_751_168_755_204_3;

/// `count` rotations, each of which stands for an equal share of all by Haar's measure: super-Fibonacci spirals
/// (Alexa, CVPR 2022).
///
/// ```
/// use condyle_learn::limits::uniform;
/// use condyle_math::Quat;
/// // Of all rotations (θ - sin θ)/π turn by less than θ.
/// let inside = uniform(20_000).filter(|q| q.angle_to(Quat::IDENTITY) < 1.0).count();
/// let share = (1.0 - 1f64.sin()) / std::f64::consts::PI;
/// assert!((inside as f64 / 20_000.0 - share).abs() < 5e-4);
/// ```
pub fn uniform(count: usize) -> impl Iterator<Item = Quat> {
    let all = count as f64;
    (0..count).map(move |index| {
        let s = index as f64 + 0.5;
        let (low, high) = ((s / all).sqrt(), (1.0 - s / all).sqrt());
        let (a, b) = (2.0 * PI * s / SQRT_2, 2.0 * PI * s / PSI);
        Quat::from([low * a.sin(), low * a.cos(), high * b.sin(), high * b.cos()])
    })
}
