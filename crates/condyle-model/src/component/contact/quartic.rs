//! Where a point that turns about an axis meets an ellipsoid.
//!
//! A point on a circle, c + u·cos θ + w·sin θ, divided by the half axes component by component,
//! gives C + U·cos θ + W·sin θ, and it lies on the ellipsoid where
//!
//! ```text
//! f(θ) = |C + U·cos θ + W·sin θ|² - 1 = A + B·cos θ + C·sin θ + D·cos 2θ + E·sin 2θ = 0
//! ```
//!
//! With x = cos θ and y = sin θ that is a circle that meets a conic, in 0, 2 or 4 points. Turn the
//! circle until E = 0, divide by the amplitude of the second harmonic, and add μ·(x² + y² - 1):
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
//! The answer is used where it is beyond doubt: the lines multiply to f, no line comes near to
//! touching the circle, and f is steep at every root. Everywhere else the quartic is taken about an
//! angle where |f| is large, and its roots are enclosed between its extrema, those between the
//! inflections, so that every change of sign is found. A pair of roots can be missed only where f
//! passes 0 by no more than its rounding error.

use condyle_math::{Scalar, Vec3};

/// The second-degree trigonometric polynomial A + B·cos θ + C·sin θ + D·cos 2θ + E·sin 2θ.
#[derive(Clone, Copy, Debug)]
pub(super) struct Quartic<S = f64> {
    pub(super) constant: S,
    pub(super) cos: S,
    pub(super) sin: S,
    pub(super) cos2: S,
    pub(super) sin2: S,
}

/// An angle as its cosine and sine.
pub(super) type Turn = (f64, f64);

/// Up to four angles.
#[derive(Clone, Copy, Debug)]
pub(super) struct Turns {
    list: [Turn; 4],
    count: usize,
}

impl Turns {
    const NONE: Self = Self { list: [(1.0, 0.0); 4], count: 0 };

    #[inline(always)]
    fn push(&mut self, turn: Turn) {
        if self.count < 4 {
            self.list[self.count] = turn;
            self.count += 1;
        }
    }

    #[inline(always)]
    pub(super) fn as_slice(&self) -> &[Turn] {
        &self.list[..self.count]
    }
}

/// How near to touching the circle a line, or how flat f at a root, puts the fast way in doubt.
const TOUCH: f64 = 1e-5;
const FLAT: f64 = 1e-4;

/// Below this, what divides a coefficient of the lines is too inexact, and a root is taken instead.
const SHALLOW: f64 = 0.1;

/// Below this part of the first harmonic the second is a small disturbance of it.
const NEARLY_FIRST: f64 = 1e-3;

impl<S: Scalar> Quartic<S> {
    /// f for the circle with this centre and these half axes, all divided by the ellipsoid's radii.
    #[inline(always)]
    pub(super) fn of_circle(centre: Vec3<S>, u: Vec3<S>, w: Vec3<S>) -> Self {
        let (uu, ww) = (u.norm_squared(), w.norm_squared());
        Self {
            constant: centre.norm_squared() - S::one() + (uu + ww).scale(0.5),
            cos: centre.dot(u).scale(2.0),
            sin: centre.dot(w).scale(2.0),
            cos2: (uu - ww).scale(0.5),
            sin2: u.dot(w),
        }
    }

    /// The coefficients without their derivatives.
    #[inline(always)]
    pub(super) fn value(&self) -> Quartic {
        Quartic {
            constant: self.constant.value(),
            cos: self.cos.value(),
            sin: self.sin.value(),
            cos2: self.cos2.value(),
            sin2: self.sin2.value(),
        }
    }

    /// f′, which is of the same form.
    #[inline(always)]
    pub(super) fn slope(&self) -> Self {
        Self {
            constant: S::zero(),
            cos: self.sin,
            sin: -self.cos,
            cos2: self.sin2.scale(2.0),
            sin2: self.cos2.scale(-2.0),
        }
    }

    /// f at an angle.
    #[inline(always)]
    pub(super) fn at(&self, (c, s): Turn) -> S {
        let first = self.cos.scale(c) + self.sin.scale(s);
        self.constant + first + self.cos2.scale(c * c - s * s) + self.sin2.scale(2.0 * c * s)
    }
}

impl Quartic {
    /// The largest coefficient of a harmonic: the measure of what is small.
    #[inline(always)]
    pub(super) fn scale(&self) -> f64 {
        self.cos.abs().max(self.sin.abs()).max(self.cos2.abs().max(self.sin2.abs()))
    }

    /// Whether f does not depend on the angle: the point lies on its axis.
    #[inline(always)]
    pub(super) fn is_constant(&self) -> bool {
        self.scale() <= 1e-15 * self.constant.abs() + f64::MIN_POSITIVE
    }

    /// Whether every coefficient is a number that can still be squared.
    #[inline(always)]
    pub(super) fn is_sound(&self) -> bool {
        let first = self.cos.abs() + self.sin.abs();
        self.constant.abs() + first + self.cos2.abs() + self.sin2.abs() < 1e100
    }

    /// All roots: none, two or four, in no order; none for a constant.
    #[inline]
    pub(super) fn roots(&self) -> Turns {
        if self.is_constant() {
            return Turns::NONE;
        }
        self.by_lines().unwrap_or_else(|| self.by_extrema())
    }

    /// The angle where |f| is least among its extrema.
    pub(super) fn nearest_extremum(&self) -> Turn {
        let slope = self.slope();
        let mut best = (1.0, 0.0);
        let mut least = f64::INFINITY;
        for &turn in slope.roots().as_slice() {
            let value = self.at(turn).abs();
            // Of two that are equal, the one nearer to rest.
            let margin = 1e-13 * self.scale();
            if value < least - margin || (value < least + margin && turn.0 > best.0) {
                (best, least) = (turn, value);
            }
        }
        best
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

    /// The roots by the pair of lines, where they are beyond doubt.
    #[inline]
    fn by_lines(&self) -> Option<Turns> {
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
        // Also where something was not finite.
        if !(off <= 1e-12 * size) {
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

    /// The roots by enclosing: sure, and slower.
    #[cold]
    fn by_extrema(&self) -> Turns {
        // Five equal angles determine f, so that it cannot be small at all of these.
        let mut far = (1.0, 0.0);
        for turn in EIGHTHS {
            if self.at(turn).abs() > self.at(far).abs() {
                far = turn;
            }
        }
        let back = (-far.0, -far.1);
        let g = self.turned(back);
        // g·(1 + t²)² with t = tan θ/2; t is infinite at the far angle.
        let quartic = [
            g.constant + g.cos + g.cos2,
            2.0 * g.sin + 4.0 * g.sin2,
            2.0 * g.constant - 6.0 * g.cos2,
            2.0 * g.sin - 4.0 * g.sin2,
            g.constant - g.cos + g.cos2,
        ];
        let mut turns = Turns::NONE;
        for &t in real_roots(quartic).iter().flatten() {
            let r = 1.0 / (1.0 + t * t);
            let (x, y) = ((1.0 - t * t) * r, 2.0 * t * r);
            turns.push((x * back.0 - y * back.1, x * back.1 + y * back.0));
        }
        turns
    }
}

const EIGHTHS: [Turn; 8] = {
    const R: f64 = std::f64::consts::FRAC_1_SQRT_2;
    [(1.0, 0.0), (R, R), (0.0, 1.0), (-R, R), (-1.0, 0.0), (-R, -R), (0.0, -1.0), (R, -R)]
};

/// The turn by a small angle more.
#[inline(always)]
fn stepped((c, s): Turn, step: f64) -> Turn {
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
        if !(step.abs() > 1e-9) {
            return (step.abs() <= 1e-9).then_some((mu - step).clamp(-1.0, 1.0));
        }
        mu -= step;
    }
    None
}

/// The real roots of a polynomial of degree 4, lowest coefficient first, whose last is not small.
fn real_roots(k: [f64; 5]) -> [Option<f64>; 4] {
    let largest = k[..4].iter().fold(0.0, |most: f64, c| most.max(c.abs()));
    let bound = 1.0 + largest / k[4].abs();
    let third = [k[1], 2.0 * k[2], 3.0 * k[3], 4.0 * k[4], 0.0];
    let second = [2.0 * k[2], 6.0 * k[3], 12.0 * k[4], 0.0, 0.0];
    let first = [6.0 * k[3], 24.0 * k[4], 0.0, 0.0, 0.0];
    let mut stops = [None; 4];
    for polynomial in [first, second, third, k] {
        stops = between(&polynomial, &stops, bound);
    }
    stops
}

/// One root between each two neighbouring stops where the polynomial changes sign.
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

/// The root between two places with different signs: Newton's steps, halving where they lead out.
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

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    /// Numbers in [-1, 1) from a linear congruence.
    struct Random(u64);

    impl Random {
        fn next(&mut self) -> f64 {
            self.0 = self.0.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            (self.0 >> 11) as f64 / (1u64 << 52) as f64 - 1.0
        }

        fn vector(&mut self, size: f64) -> Vec3 {
            Vec3::new(self.next(), self.next(), self.next()) * size
        }
    }

    /// The circle of a point of a scapula, and the radii, in metres.
    struct Circle {
        centre: Vec3,
        u: Vec3,
        w: Vec3,
        radii: Vec3,
    }

    impl Circle {
        /// Four kinds by turns: anywhere; the joint near the surface; near the centre, where four
        /// roots are likely; and one whose f misses 0, or passes it, by as little as 10⁻¹¹.
        fn random(random: &mut Random, kind: usize) -> Self {
            let mut radii = Vec3::from([0; 3].map(|_| 0.125 + 0.075 * random.next()));
            let joint = match kind {
                0 => random.vector(0.2),
                2 => random.vector(0.03),
                _ => random.vector(1.0).normalized().times(radii) * (1.0 + 0.2 * random.next()),
            };
            let axis = random.vector(1.0).normalized();
            let point = random.vector(0.15 / 3f64.sqrt());
            let along = axis * axis.dot(point);
            let (centre, u, w) = (joint + along, point - along, axis.cross(point));
            let circle = Self { centre, u, w, radii };
            let level = match kind {
                2 => circle.quartic().constant,
                3 => {
                    let at = circle.at(circle.quartic().nearest_extremum());
                    at + 10f64.powf(-7.0 + 4.0 * random.next()) * random.next().signum()
                }
                _ => 0.0,
            };
            // |p/r|² - 1 is lowered by about the level if r grows by the root of 1 + level.
            radii = radii * (1.0 + level).sqrt();
            Self { radii, ..circle }
        }

        fn quartic(&self) -> Quartic {
            let per = self.radii.to_array().map(|r| 1.0 / r).into();
            Quartic::of_circle(self.centre.times(per), self.u.times(per), self.w.times(per))
        }

        /// f as the source states it, without the polynomial.
        fn at(&self, (c, s): Turn) -> f64 {
            let p = self.centre + self.u * c + self.w * s;
            let squares = [p.x / self.radii.x, p.y / self.radii.y, p.z / self.radii.z];
            squares.iter().map(|x| x * x).sum::<f64>() - 1.0
        }
    }

    /// All changes of sign of `f` over a dense scan, halved to the end, and its extremum nearest 0.
    ///
    /// Where the scan has a least |f| between equal signs, a golden search looks for more.
    fn scan(f: impl Fn(f64) -> f64, values: &[f64]) -> (Vec<f64>, f64, f64) {
        let n = values.len();
        let step = TAU / n as f64;
        let halve = |mut a: f64, mut b: f64| {
            let below = f(a) < 0.0;
            for _ in 0..60 {
                let m = 0.5 * (a + b);
                if (f(m) < 0.0) == below { a = m } else { b = m }
            }
            a
        };
        let (mut roots, mut least) = (vec![], (f64::INFINITY, 0.0));
        for i in 0..n {
            let (before, here, after) = (values[(i + n - 1) % n], values[i], values[(i + 1) % n]);
            let x = i as f64 * step;
            if (here < 0.0) != (after < 0.0) {
                roots.push(halve(x, x + step));
            }
            let same = (before < 0.0) == (here < 0.0) && (after < 0.0) == (here < 0.0);
            if same && here.abs() <= before.abs() && here.abs() <= after.abs() {
                let sign = here.signum();
                let (mut a, mut b) = (x - step, x + step);
                for _ in 0..60 {
                    let (c, d) = (b - (b - a) * 0.618033988749895, a + (b - a) * 0.618033988749895);
                    if sign * f(c) < sign * f(d) { b = d } else { a = c }
                }
                let m = 0.5 * (a + b);
                if sign * f(m) < 0.0 {
                    roots.extend([halve(x - step, m), halve(m, x + step)]);
                } else if f(m).abs() < least.0 {
                    least = (f(m).abs(), m);
                }
            }
        }
        (roots, least.0, least.1)
    }

    fn apart(a: Turn, angle: f64) -> f64 {
        (a.1 * angle.cos() - a.0 * angle.sin()).atan2(a.0 * angle.cos() + a.1 * angle.sin()).abs()
    }

    #[test]
    fn every_root_and_every_nearest_extremum_of_twenty_thousand_circles_is_found() {
        // Every angle of 20 000 where the compiler helps, of 2 000 where it does not.
        let n = if cfg!(debug_assertions) { 2_000 } else { 20_000 };
        let table: Vec<Turn> =
            (0..n).map(|i| (i as f64 * TAU / n as f64).sin_cos()).map(|(s, c)| (c, s)).collect();
        let mut random = Random(1);
        let (mut counts, mut slow) = ([0; 5], 0);
        let (mut worst, mut nearest): (f64, f64) = (0.0, 1.0);
        let mut values = vec![0.0; n];
        for case in 0..20_000 {
            let circle = Circle::random(&mut random, case % 4);
            let quartic = circle.quartic();
            for (value, &turn) in values.iter_mut().zip(&table) {
                *value = circle.at(turn);
            }
            let f = |x: f64| circle.at((x.cos(), x.sin()));
            let (expected, least, at_least) = scan(f, &values);
            let roots = quartic.roots();
            slow += usize::from(quartic.by_lines().is_none());
            // With the Newton step that the kernel takes at the root it chooses.
            let polish = |turn: Turn| stepped(turn, -quartic.at(turn) / quartic.slope().at(turn));
            let found: Vec<Turn> = roots.as_slice().iter().copied().map(polish).collect();
            counts[found.len()] += 1;
            assert_eq!(found.len(), expected.len(), "{case} {found:?} {expected:?} {least}");
            nearest = nearest.min(least);
            for &root in &found {
                // The distance from the surface to first order.
                let p = circle.centre + circle.u * root.0 + circle.w * root.1;
                let per: Vec3 = circle.radii.to_array().map(|r| 1.0 / (r * r)).into();
                worst = worst.max(circle.at(root).abs() / (2.0 * p.times(per).norm()));
            }
            for &x in &expected {
                let off = found.iter().map(|&root| apart(root, x)).fold(9.0, f64::min);
                // Halving stops where f drowns in the rounding of its terms.
                let slope = quartic.slope().at((x.cos(), x.sin())).abs();
                let rounding = 1e-15 * (10.0 + quartic.constant.abs() + quartic.scale());
                assert!(off < 1e-15 + rounding / slope.max(1e-7), "{case} {off} {slope}");
            }
            if found.is_empty() {
                let turn = quartic.nearest_extremum();
                let value = circle.at(turn).abs();
                assert!((value - least).abs() < 1e-13 * (1.0 + quartic.constant.abs()), "{case}");
                // Golden search sees a minimum to the root of rounding only, and flat ones less.
                let bend = quartic.slope().slope().at(turn).abs();
                assert!(bend < 1e-3 || apart(turn, at_least) < 1e-5, "{case} {value} {least}");
            }
        }
        println!("0, 2, 4 roots: {} {} {}", counts[0], counts[2], counts[4]);
        println!("left to enclosing: {slow}; worst distance from the surface: {worst:.1e} m");
        println!("least miss: {nearest:.1e}");
        assert!(counts[0] > 1000 && counts[2] > 1000 && counts[4] > 100, "{counts:?}");
        assert!(counts[1] + counts[3] == 0, "{counts:?}");
        assert!(slow > 1000 && slow < 5000, "the near misses are enclosed, others not: {slow}");
        assert!(worst < 1e-9, "{worst}");
    }

    #[test]
    fn both_ways_agree_also_where_roots_nearly_touch() {
        // f = (cos(θ - a) - k)·(cos(θ - b) - m), four roots a ± acos k, b ± acos m, moved by `by`.
        let product = |a: f64, k: f64, b: f64, m: f64, by: f64| Quartic {
            constant: 0.5 * (a - b).cos() + k * m + by,
            cos: -m * a.cos() - k * b.cos(),
            sin: -m * a.sin() - k * b.sin(),
            cos2: 0.5 * (a + b).cos(),
            sin2: 0.5 * (a + b).sin(),
        };
        let mut random = Random(2);
        let mut missed = 0;
        for case in 0..40_000 {
            let near = 10f64.powf(-8.0 + 7.0 * random.next());
            let (a, k) = (3.0 * random.next(), 1.2 * random.next());
            let (b, m) = match case % 4 {
                // A touching line, two lines that meet near the circle, nearly one line, any.
                0 => (3.0 * random.next(), 1.0 + near * random.next().signum()),
                1 => {
                    let b = 3.0 * random.next();
                    let root = a + k.clamp(-1.0, 1.0).acos();
                    (b, (root - b).cos() + near)
                }
                2 => (a + near, k + near * random.next()),
                _ => (3.0 * random.next(), 1.2 * random.next()),
            };
            let by = if case % 8 < 4 { 0.0 } else { near * near * random.next() };
            let quartic = product(a, k, b, m, by);
            let [count, sure] = [quartic.roots(), quartic.by_extrema()].map(|r| r.count);
            if count != sure {
                missed += 1;
            }
            // Independently: the signs of f at its extrema, refined from a scan of its slope.
            let slope = quartic.slope();
            let of = |q: &Quartic, x: f64| q.at((x.cos(), x.sin()));
            let slopes: Vec<f64> =
                (0..400).map(|i| of(&slope, f64::from(i) * TAU / 400.0)).collect();
            let (extrema, ..) = scan(|x| of(&slope, x), &slopes);
            let mut values: Vec<(f64, f64)> =
                extrema.iter().map(|&x| (x.rem_euclid(TAU), of(&quartic, x))).collect();
            values.sort_by(|a, b| a.0.total_cmp(&b.0));
            if values.iter().all(|(_, f)| f.abs() > 1e-12) {
                let n = values.len();
                let changes = (0..n)
                    .filter(|&i| (values[i].1 < 0.0) != (values[(i + 1) % n].1 < 0.0))
                    .count();
                assert_eq!(count, changes, "{case} {near} {values:?} {quartic:?}");
            }
            for &root in quartic.roots().as_slice() {
                assert!(quartic.at(root).abs() < 1e-9 * quartic.scale(), "{case} {quartic:?}");
            }
        }
        assert_eq!(missed, 0);
    }

    #[test]
    fn degenerate_polynomials_have_the_roots_of_their_formula() {
        let quartic = |constant, cos, sin, cos2, sin2| Quartic { constant, cos, sin, cos2, sin2 };
        let angles = |q: Quartic| {
            let mut list: Vec<f64> =
                q.roots().as_slice().iter().map(|t| t.1.atan2(t.0).to_degrees()).collect();
            list.sort_by(f64::total_cmp);
            list
        };
        let close = |q: Quartic, expected: &[f64]| {
            let found = angles(q);
            assert_eq!(found.len(), expected.len(), "{q:?} {found:?}");
            for (a, b) in found.iter().zip(expected) {
                assert!((a - b).abs() < 1e-9, "{q:?} {found:?}");
            }
        };
        // One harmonic alone: cos θ = 1/2, sin θ = -1/2, cos 2θ = 0, sin 2θ = 1/2.
        close(quartic(-1.0, 2.0, 0.0, 0.0, 0.0), &[-60.0, 60.0]);
        close(quartic(1.0, 0.0, 2.0, 0.0, 0.0), &[-150.0, -30.0]);
        close(quartic(0.0, 0.0, 0.0, 1.0, 0.0), &[-135.0, -45.0, 45.0, 135.0]);
        close(quartic(-1.0, 0.0, 0.0, 0.0, 2.0), &[-165.0, -105.0, 15.0, 75.0]);
        // (cos θ - 1/2)·(cos θ + 1/2) and (cos θ - 1/2)·sin θ: lines that are parallel, and across.
        close(quartic(0.25, 0.0, 0.0, 0.5, 0.0), &[-120.0, -60.0, 60.0, 120.0]);
        close(quartic(0.0, 0.0, -0.5, 0.0, 0.5), &[-60.0, 0.0, 60.0, 180.0]);
        // The same in huge and tiny units.
        close(quartic(0.0, 0.0, -0.5e90, 0.0, 0.5e90), &[-60.0, 0.0, 60.0, 180.0]);
        close(quartic(0.0, 0.0, -0.5e-90, 0.0, 0.5e-90), &[-60.0, 0.0, 60.0, 180.0]);
        // None, and no angle at all.
        close(quartic(2.0, 0.0, 0.0, 1.0, 0.0), &[]);
        close(quartic(3.0, 0.0, 0.0, 0.0, 0.0), &[]);
        close(quartic(0.0, 0.0, 0.0, 0.0, 0.0), &[]);
        assert_eq!(quartic(2.0, -1.0, 0.0, 0.0, 0.0).nearest_extremum(), (1.0, 0.0));
    }
}
