//! The roots of a [`Quartic`] by a degenerate conic (a pair of lines), where they are well
//! conditioned.
//!
//! With x = cos θ and y = sin θ the roots are the intersections of the unit circle with a conic.
//! Rotate until E = 0, divide by the amplitude of the second harmonic, and add μ·(x² + y² - 1):
//!
//! ```text
//! (1 + μ)·x² - (1 - μ)·y² + 2β·x + 2γ·y + α - μ
//! ```
//!
//! is a member of the pencil of conics through the same intersections. It is a pair of lines where
//! its determinant h(μ) = (α - μ)(μ² - 1) - β²(μ - 1) - γ²(μ + 1) is 0. As h(-1) = 2β² and h(1) =
//! -2γ², there is a root in [-1, 1], where both lines are real; from one of the two ends Newton
//! steps converge to it monotonically. Each line then meets the circle in 2 points or none. This is
//! the factorisation of the quartic in tan(θ/2) without the half angle, so no θ is singular.
//!
//! The result is used only if the product of the lines reproduces f, neither line is nearly tangent
//! to the circle, and |f′| is not small at any root; otherwise the roots are computed by bracketing
//! (`extrema.rs`).

use super::quartic::{Quartic, Turn, Turns};

/// A line with |1 - distance²| from the centre below this is too close to tangency.
const TOUCH: f64 = 1e-5;
/// A root with |f′| below this fraction of the largest harmonic is ill-conditioned.
const FLAT: f64 = 1e-4;

/// Below this value of p or q the quotient by it is inaccurate, and a square root is used instead.
const SHALLOW: f64 = 0.1;

/// Below this fraction of the first harmonic the second is treated as a perturbation.
const NEARLY_FIRST: f64 = 1e-3;

impl Quartic {
    /// The roots by the pair of lines; `None` where they are ill-conditioned.
    #[inline]
    pub(super) fn by_lines(&self) -> Option<Turns> {
        let first = self.cos * self.cos + self.sin * self.sin;
        let second = self.cos2 * self.cos2 + self.sin2 * self.sin2;
        if second <= NEARLY_FIRST * NEARLY_FIRST * first {
            return self.by_one_line(first.sqrt(), second.sqrt());
        }
        let second = second.sqrt();
        // The half angle δ of (cos2, sin2) as (cos δ, sin δ), which removes the sin 2θ term.
        // Half-angle formula for the larger of the two, the double-angle formula for the other: no
        // cancellation.
        let scale = 1.0 / second;
        let double = self.cos2 * scale;
        let large = (0.5 + 0.5 * double.abs()).sqrt();
        let small = 0.5 * self.sin2 * scale / large;
        let turn = if double >= 0.0 {
            (large, small)
        } else {
            (small.abs(), if self.sin2 < 0.0 { -large } else { large })
        };
        // f/second = α + 2β·x + 2γ·y + x² - y² in the rotated coordinates.
        let alpha = self.constant * scale;
        let beta = 0.5 * scale * (self.cos * turn.0 + self.sin * turn.1);
        let gamma = 0.5 * scale * (self.sin * turn.0 - self.cos * turn.1);
        let mu = degenerate(alpha, beta, gamma)?;

        // (p·x - q·y - m1)(p·x + q·y - m2) with p² = 1 + μ, q² = 1 - μ and m = middle ∓ half.
        // Comparing coefficients: p·middle = -β, q·half = γ, middle² - half² = α - μ. Two of the
        // three equations are used, without a division by a small p or q; p² + q² = 2, so one of
        // them is at least 1.
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
        // The residual of all three equations: large if μ is not accurate enough.
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
            // The normal has length √2. The line at distance k from the centre cuts the circle at
            // n·k ± n⊥·√(1 - k²).
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

    /// The roots if the second harmonic is negligible or small, as for a sphere: one line suffices.
    ///
    /// `first` and `second` are the amplitudes of the harmonics.
    fn by_one_line(&self, first: f64, second: f64) -> Option<Turns> {
        // Without the second harmonic cos(θ - θ₀) = k; it changes k by at most `slack`.
        let k = -self.constant / first;
        let slack = second / first;
        if k.abs() > 1.0 + slack + 1e-9 {
            return Some(Turns::NONE);
        }
        // Near the extremum of the first harmonic the second decides the number of roots.
        if k.abs() > 1.0 - 8.0 * slack - TOUCH {
            return None;
        }
        let (nx, ny) = (self.cos / first, self.sin / first);
        let reach = (1.0 - k * k).sqrt();
        let mut turns = Turns::NONE;
        for reach in [reach, -reach] {
            let mut turn = (nx * k - ny * reach, ny * k + nx * reach);
            // Newton steps on f itself correct for the second harmonic.
            for _ in 0..4 {
                turn = stepped(turn, -self.at(turn) / self.slope().at(turn));
            }
            turns.push(turn);
        }
        Some(turns)
    }
}

/// The angle increased by a small step: to first order, then normalised.
#[inline(always)]
pub(super) fn stepped((c, s): Turn, step: f64) -> Turn {
    let (x, y) = (c - s * step, s + c * step);
    let r = 1.0 / (x * x + y * y).sqrt();
    (x * r, y * r)
}

/// A root in [-1, 1] of h(μ) = (α - μ)(μ² - 1) - β²(μ - 1) - γ²(μ + 1).
///
/// h(1) ≤ 0 and h(-1) ≥ 0, and h is concave right of its inflection at α/3 and convex left of it.
/// For α ≤ 1, h′(1) = 2(α - 1) - β² - γ² ≤ 0 and h is concave at 1: Newton steps from there
/// approach the largest root monotonically from above. For α ≥ -1, h′(-1) = -2(α + 1) - β² - γ² ≤ 0
/// and h is convex at -1: steps from there approach the smallest root from below. For -1 ≤ α ≤ 1
/// the sign of h at the inflection decides: the selected root is the only one on its side of the
/// inflection.
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
