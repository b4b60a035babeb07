//! The angles at which a point that rotates about an axis meets an ellipsoid.
//!
//! A point on a circle, c + u·cos θ + w·sin θ, divided by the half axes component by component,
//! gives M + U·cos θ + W·sin θ, and it lies on the ellipsoid where
//!
//! ```text
//! f(θ) = |M + U·cos θ + W·sin θ|² - 1 = A + B·cos θ + C·sin θ + D·cos 2θ + E·sin 2θ = 0
//! ```
//!
//! at 0, 2 or 4 angles. Where they are well conditioned they are computed from a pair of lines
//! (`lines.rs`); elsewhere they are bracketed by the extrema of f (`extrema.rs`), so that every
//! change of sign is found. A pair of roots can be missed only where f exceeds 0 between them by no
//! more than its rounding error.

use condyle_math::{Lane, Scalar, Vec3};

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
    pub(super) const NONE: Self = Self { list: [(1.0, 0.0); 4], count: 0 };

    #[inline(always)]
    pub(super) fn push(&mut self, turn: Turn) {
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

impl<S: Scalar> Quartic<S> {
    /// f for the circle with this centre and these half axes, all divided by the half axes of the
    /// ellipsoid.
    #[inline(always)]
    pub(super) fn of_circle(centre: Vec3<S>, u: Vec3<S>, w: Vec3<S>) -> Self {
        // |M + U·cos θ + W·sin θ|² with cos² = (1 + cos 2θ)/2, sin² = (1 - cos 2θ)/2 and
        // sin·cos = (sin 2θ)/2.
        let (uu, ww) = (u.norm_squared(), w.norm_squared());
        Self {
            constant: centre.norm_squared() - S::one() + (uu + ww).scale(0.5),
            cos: centre.dot(u).scale(2.0),
            sin: centre.dot(w).scale(2.0),
            cos2: (uu - ww).scale(0.5),
            sin2: u.dot(w),
        }
    }

    /// f′, which has the same form.
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

impl<S: Lane> Quartic<S> {
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
}

impl Quartic {
    /// The largest absolute coefficient of a harmonic: the scale for tolerances.
    #[inline(always)]
    pub(super) fn scale(&self) -> f64 {
        self.cos.abs().max(self.sin.abs()).max(self.cos2.abs().max(self.sin2.abs()))
    }

    /// Whether f does not depend on the angle, to rounding: the point is on the axis.
    #[inline(always)]
    pub(super) fn is_constant(&self) -> bool {
        self.scale() <= 1e-15 * self.constant.abs() + f64::MIN_POSITIVE
    }

    /// Whether every coefficient is finite and small enough to be squared without overflow.
    #[inline(always)]
    pub(super) fn is_sound(&self) -> bool {
        let first = self.cos.abs() + self.sin.abs();
        self.constant.abs() + first + self.cos2.abs() + self.sin2.abs() < 1e100
    }

    /// All roots: none, two or four, unordered; `None` if f is constant.
    #[inline]
    pub(super) fn roots(&self) -> Turns {
        if self.is_constant() {
            return Turns::NONE;
        }
        self.by_lines().unwrap_or_else(|| self.by_extrema())
    }

    /// The extremum of f with the smallest |f|.
    pub(super) fn nearest_extremum(&self) -> Turn {
        let slope = self.slope();
        let mut best = (1.0, 0.0);
        let mut least = f64::INFINITY;
        for &turn in slope.roots().as_slice() {
            let value = self.at(turn).abs();
            // If two are equal to rounding, the one nearer to rest.
            let margin = 1e-13 * self.scale();
            if value < least - margin || (value < least + margin && turn.0 > best.0) {
                (best, least) = (turn, value);
            }
        }
        best
    }
}

#[cfg(test)]
mod tests {
    use super::super::lines::stepped;
    use super::*;
    use std::f64::consts::TAU;

    /// Numbers in [-1, 1) from a linear congruential generator.
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
        /// Four kinds in turn: anywhere; the joint near the surface; near the centre, where four
        /// roots are likely; and an extremum of f with a value as small as ±10⁻¹¹.
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

        /// f by its definition, without the polynomial.
        fn at(&self, (c, s): Turn) -> f64 {
            let p = self.centre + self.u * c + self.w * s;
            let squares = [p.x / self.radii.x, p.y / self.radii.y, p.z / self.radii.z];
            squares.iter().map(|x| x * x).sum::<f64>() - 1.0
        }
    }

    /// All changes of sign of `f` over a dense scan, refined by bisection, and its extremum nearest
    /// 0.
    ///
    /// Where the scan has a minimum of |f| between equal signs, a golden-section search looks for
    /// more roots.
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
                // Bisection stops where f is below the rounding error of its terms.
                let slope = quartic.slope().at((x.cos(), x.sin())).abs();
                let rounding = 1e-15 * (10.0 + quartic.constant.abs() + quartic.scale());
                assert!(off < 1e-15 + rounding / slope.max(1e-7), "{case} {off} {slope}");
            }
            if found.is_empty() {
                let turn = quartic.nearest_extremum();
                let value = circle.at(turn).abs();
                assert!((value - least).abs() < 1e-13 * (1.0 + quartic.constant.abs()), "{case}");
                // Golden-section search locates a minimum to the square root of rounding, flat ones
                // less accurately.
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
