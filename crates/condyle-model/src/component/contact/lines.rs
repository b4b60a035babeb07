//! The roots of a [`Quartic`] by a pair of lines, where they are beyond doubt.
//!
//! With x = cos θ and y = sin θ the roots are where the unit circle meets a conic. Turn the circle
//! until E = 0, divide by the amplitude of the second harmonic, and add μ·(x² + y² - 1):
//!
//! ```text
//! (1 + μ)·x² - (1 - μ)·y² + 2β·x + 2γ·y + α - μ
//! ```
//!
//! is a pair of lines where h(μ) = (α - μ)(μ² - 1) - β²(μ - 1) - γ²(μ + 1) = 0. As h(-1) = 2β² and
//! h(1) = -2γ², a root lies in [-1, 1], where both lines are real; from one of the two ends h falls
//! and bends so that Newton's steps cannot pass it. Each line then meets the circle in 2 points or
//! none. This is the factorisation of the quartic in tan θ/2 without the half angle, so no θ is
//! special.
//!
//! Beyond doubt means: the lines multiply to f, neither comes near to touching the circle, and f is
//! steep at every root.

use super::quartic::{Quartic, Turn, Turns};

/// How near to touching the circle a line, or how flat f at a root, puts the fast way in doubt.
const TOUCH: f64 = 1e-5;
const FLAT: f64 = 1e-4;

/// Below this, what divides a coefficient of the lines is too inexact, and a root is taken instead.
const SHALLOW: f64 = 0.1;

/// Below this part of the first harmonic the second is a small disturbance of it.
const NEARLY_FIRST: f64 = 1e-3;

impl Quartic {
    /// The roots by the pair of lines where they are beyond doubt, and `None` elsewhere.
    #[inline]
    pub(super) fn by_lines(&self) -> Option<Turns> {
        let first = self.cos * self.cos + self.sin * self.sin;
        let second = self.cos2 * self.cos2 + self.sin2 * self.sin2;
        if second <= NEARLY_FIRST * NEARLY_FIRST * first {
            return self.by_one_line(first.sqrt(), second.sqrt());
        }
        let second = second.sqrt();
        // Half the angle of (cos2, sin2): the turn that leaves no sin 2θ.
        let scale = 1.0 / second;
        let double = self.cos2 * scale;
        let large = (0.5 + 0.5 * double.abs()).sqrt();
        let small = 0.5 * self.sin2 * scale / large;
        let turn = if double >= 0.0 {
            (large, small)
        } else {
            (small.abs(), if self.sin2 < 0.0 { -large } else { large })
        };
        let alpha = self.constant * scale;
        let beta = 0.5 * scale * (self.cos * turn.0 + self.sin * turn.1);
        let gamma = 0.5 * scale * (self.sin * turn.0 - self.cos * turn.1);
        let mu = degenerate(alpha, beta, gamma)?;

        // (p·x - q·y - m1)(p·x + q·y - m2), m = middle ∓ half.
        let (p, q) = ((1.0 + mu).max(0.0).sqrt(), (1.0 - mu).max(0.0).sqrt());
        let rest = alpha - mu;
        let (middle, half) = if p > SHALLOW && q > SHALLOW {
            (-beta / p, gamma / q)
        } else if p < q {
            let half = gamma / q;
            ((half * half + rest).max(0.0).sqrt().copysign(-beta), half)
        } else {
            let middle = -beta / p;
            (middle, (middle * middle - rest).max(0.0).sqrt().copysign(gamma))
        };
        let off = (p * middle + beta).abs()
            + (q * half - gamma).abs()
            + (middle * middle - half * half - rest).abs();
        let size = 1.0 + alpha.abs() + beta.abs() + gamma.abs();
        if off.is_nan() || off > 1e-12 * size {
            return None;
        }
        let steep = FLAT * self.scale();
        let root_half = std::f64::consts::FRAC_1_SQRT_2;
        let mut turns = Turns::NONE;
        for (nx, ny, m) in [(p, -q, middle - half), (p, q, middle + half)] {
            let (nx, ny, k) = (nx * root_half, ny * root_half, m * root_half);
            let square = 1.0 - k * k;
            if square.abs() < TOUCH {
                return None;
            }
            if square > 0.0 {
                let reach = square.sqrt();
                for reach in [reach, -reach] {
                    let (x, y) = (nx * k - ny * reach, ny * k + nx * reach);
                    let root = (x * turn.0 - y * turn.1, x * turn.1 + y * turn.0);
                    if self.slope().at(root).abs() < steep {
                        return None;
                    }
                    turns.push(root);
                }
            }
        }
        Some(turns)
    }

    /// The roots where the second harmonic hardly counts, as on a sphere, and the line is one.
    fn by_one_line(&self, first: f64, second: f64) -> Option<Turns> {
        let k = -self.constant / first;
        let slack = second / first;
        if k.abs() > 1.0 + slack + 1e-9 {
            return Some(Turns::NONE);
        }
        // Where the first harmonic is flat enough for the second to matter, f is still above it.
        if k.abs() > 1.0 - 8.0 * slack - TOUCH {
            return None;
        }
        let (nx, ny) = (self.cos / first, self.sin / first);
        let reach = (1.0 - k * k).sqrt();
        let mut turns = Turns::NONE;
        for reach in [reach, -reach] {
            let mut turn = (nx * k - ny * reach, ny * k + nx * reach);
            for _ in 0..4 {
                turn = stepped(turn, -self.at(turn) / self.slope().at(turn));
            }
            turns.push(turn);
        }
        Some(turns)
    }
}

/// The turn by a small angle more.
#[inline(always)]
pub(super) fn stepped((c, s): Turn, step: f64) -> Turn {
    let (x, y) = (c - s * step, s + c * step);
    let r = 1.0 / (x * x + y * y).sqrt();
    (x * r, y * r)
}

/// A root in [-1, 1] of h(μ) = (α - μ)(μ² - 1) - β²(μ - 1) - γ²(μ + 1).
///
/// At 1, h is not above 0; where it falls and bends down there, Newton's steps approach the largest
/// root from above. At -1 it is the other way round. One of the two always holds: the first for
/// α ≤ 1, the second for α ≥ -1. Where both do, the choice is the root that stands alone.
#[inline(always)]
fn degenerate(alpha: f64, beta: f64, gamma: f64) -> Option<f64> {
    let (bb, cc) = (beta * beta, gamma * gamma);
    // h = -μ³ + α·μ² + k1·μ + k0
    let (k1, k0) = (1.0 - bb - cc, bb - cc - alpha);
    let inflection = alpha * (1.0 / 3.0);
    let there = ((alpha - inflection) * inflection + k1) * inflection + k0;
    let from_above = if alpha > 1.0 {
        false
    } else if alpha < -1.0 {
        true
    } else {
        there > 0.0
    };
    let mut mu = if from_above { 1.0 } else { -1.0 };
    for _ in 0..40 {
        let h = ((alpha - mu) * mu + k1) * mu + k0;
        let slope = (2.0 * alpha - 3.0 * mu) * mu + k1;
        let step = h / slope;
        mu -= step;
        if step.abs() <= 1e-9 {
            return Some(mu.clamp(-1.0, 1.0));
        }
    }
    None
}
