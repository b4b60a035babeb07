//! The left Jacobian of SO(3) and its inverse: rates of rotation vectors and angular velocities.

use condyle_math::Vec3;

/// The rate ρ̇ of the rotation vector ρ (`turn`) of R for the angular velocity ω (`spin`), Ṙ =
/// \[ω\]× R.
///
/// The inverse left Jacobian of SO(3), with θ = |ρ|:
/// ρ̇ = ω - ½ ρ × ω + (1/θ² - (1 + cos θ)/(2 θ sin θ)) ρ × (ρ × ω).
pub fn log_rate(turn: Vec3, spin: Vec3) -> Vec3 {
    let square = turn.norm_squared();
    // Near 0 the Taylor series; the omitted term is θ⁴/30240 of the factor.
    let factor = if square < 1e-6 {
        1.0 / 12.0 + square / 720.0
    } else {
        let angle = square.sqrt();
        let (s, c) = angle.sin_cos();
        // At θ = π, 1 + cos θ vanishes faster than sin θ: the bound avoids 0/0.
        1.0 / square - (1.0 + c) / (2.0 * angle * s.max(1e-12))
    };
    let cross = turn.cross(spin);
    spin - cross * 0.5 + turn.cross(cross) * factor
}

/// The angular velocity ω of R = exp(ρ), Ṙ = \[ω\]× R, when ρ (`turn`) changes at `rate` ρ̇.
///
/// The left Jacobian of SO(3), with θ = |ρ|:
/// ω = ρ̇ + (1 - cos θ)/θ² ρ × ρ̇ + (θ - sin θ)/θ³ ρ × (ρ × ρ̇).
pub(super) fn exp_rate(turn: Vec3, rate: Vec3) -> Vec3 {
    let square = turn.norm_squared();
    // Near 0 the Taylor series; the omitted terms are θ⁴/720 and θ⁴/5040.
    let (first, second) = if square < 1e-6 {
        (0.5 - square / 24.0, 1.0 / 6.0 - square / 120.0)
    } else {
        let angle = square.sqrt();
        let (s, c) = angle.sin_cos();
        ((1.0 - c) / square, (angle - s) / (square * angle))
    };
    let cross = turn.cross(rate);
    rate + cross * first + turn.cross(cross) * second
}

#[cfg(test)]
mod tests {
    use super::*;
    use condyle_math::Quat;

    #[test]
    fn rates_are_inverse_and_equal_differences() {
        for turn in
            [Vec3::new(0.3, -0.7, 1.1), Vec3::new(1e-5, 2e-5, 0.0), Vec3::new(2.0, 1.0, -1.5)]
        {
            let rate = Vec3::new(0.4, 0.2, -0.9);
            let spin = exp_rate(turn, rate);
            assert!((log_rate(turn, spin) - rate).norm() < 1e-10);
            let h = 1e-6;
            let (a, b) = (Quat::exp(turn + rate * h), Quat::exp(turn - rate * h));
            let by_difference = (a * b.conjugate()).log() * (0.5 / h);
            assert!((spin - by_difference).norm() < 1e-8);
        }
    }
}
