//! Dual numbers: values with their partial derivatives.

use crate::{Lane, Scalar};
use std::ops::{Add, AddAssign, Div, Mul, MulAssign, Neg, Sub, SubAssign};

/// A value with its partial derivatives with respect to `N` variables (forward mode).
///
/// Arithmetic follows from (a + a'ε)(b + b'ε) = ab + (a'b + ab')ε with ε² = 0, so a smooth kernel
/// evaluated on duals returns its exact derivatives (to rounding).
///
/// ```
/// use condyle_math::{Dual, Scalar};
///
/// // d/dx (x² sin x) at x = 1 is 2 sin 1 + cos 1.
/// let x = Dual::<1>::variable(1.0, 0);
/// let y = x * x * x.sin_cos().0;
/// assert!((y.partials[0] - (2.0 * 1f64.sin() + 1f64.cos())).abs() < 1e-15);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dual<const N: usize> {
    /// The value.
    pub value: f64,
    /// The partial derivatives, one for each variable.
    pub partials: [f64; N],
}

impl<const N: usize> Dual<N> {
    /// A constant: all derivatives zero.
    #[inline(always)]
    pub fn constant(value: f64) -> Self {
        Self { value, partials: [0.0; N] }
    }

    /// The variable `index` (below `N`) at `value`: its own partial derivative is 1, the others 0.
    #[inline(always)]
    pub fn variable(value: f64, index: usize) -> Self {
        let mut partials = [0.0; N];
        partials[index] = 1.0;
        Self { value, partials }
    }

    #[inline(always)]
    fn map(self, value: f64, slope: f64) -> Self {
        Self { value, partials: self.partials.map(|p| p * slope) }
    }
}

impl<const N: usize> Add for Dual<N> {
    type Output = Self;
    #[inline(always)]
    fn add(mut self, other: Self) -> Self {
        self += other;
        self
    }
}

impl<const N: usize> Sub for Dual<N> {
    type Output = Self;
    #[inline(always)]
    fn sub(mut self, other: Self) -> Self {
        self -= other;
        self
    }
}

impl<const N: usize> Mul for Dual<N> {
    type Output = Self;
    #[inline(always)]
    fn mul(mut self, other: Self) -> Self {
        self *= other;
        self
    }
}

impl<const N: usize> Div for Dual<N> {
    type Output = Self;
    #[inline(always)]
    fn div(self, other: Self) -> Self {
        let value = self.value / other.value;
        // (a/b)' = (a' - (a/b)·b') / b
        let mut partials = self.partials;
        for (p, q) in partials.iter_mut().zip(other.partials) {
            *p = (*p - value * q) / other.value;
        }
        Self { value, partials }
    }
}

impl<const N: usize> Neg for Dual<N> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self { value: -self.value, partials: self.partials.map(|p| -p) }
    }
}

impl<const N: usize> AddAssign for Dual<N> {
    #[inline(always)]
    fn add_assign(&mut self, other: Self) {
        self.value += other.value;
        for (p, q) in self.partials.iter_mut().zip(other.partials) {
            *p += q;
        }
    }
}

impl<const N: usize> SubAssign for Dual<N> {
    #[inline(always)]
    fn sub_assign(&mut self, other: Self) {
        self.value -= other.value;
        for (p, q) in self.partials.iter_mut().zip(other.partials) {
            *p -= q;
        }
    }
}

impl<const N: usize> MulAssign for Dual<N> {
    #[inline(always)]
    fn mul_assign(&mut self, other: Self) {
        // The partials first: they need the old value.
        for (p, q) in self.partials.iter_mut().zip(other.partials) {
            *p = *p * other.value + self.value * q;
        }
        self.value *= other.value;
    }
}

impl<const N: usize> Lane for Dual<N> {
    #[inline(always)]
    fn value(self) -> f64 {
        self.value
    }
}

impl<const N: usize> Scalar for Dual<N> {
    type Lane = Self;

    #[inline(always)]
    fn from_f64(value: f64) -> Self {
        Self::constant(value)
    }

    #[inline(always)]
    fn lane_by_lane<const I: usize, const O: usize>(
        inputs: [Self; I],
        kernel: impl Fn([Self; I]) -> [Self; O],
    ) -> [Self; O] {
        kernel(inputs)
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        let root = self.value.sqrt();
        self.map(root, 0.5 / root)
    }

    #[inline(always)]
    fn sin_cos(self) -> (Self, Self) {
        let (s, c) = Scalar::sin_cos(self.value);
        (self.map(s, c), self.map(c, -s))
    }

    #[inline(always)]
    fn atan2(self, x: Self) -> Self {
        // d atan2(y, x) = (x·dy - y·dx) / (x² + y²); undefined at the origin.
        let square = self.value * self.value + x.value * x.value;
        let (by_y, by_x) = (x.value / square, -self.value / square);
        let mut partials = self.partials;
        for (p, q) in partials.iter_mut().zip(x.partials) {
            *p = *p * by_y + q * by_x;
        }
        Self { value: self.value.atan2(x.value), partials }
    }

    #[inline(always)]
    fn chain(self, law: impl Fn(f64) -> (f64, f64)) -> Self {
        let (value, slope) = law(self.value);
        self.map(value, slope)
    }

    #[inline(always)]
    fn select_less(self, bound: Self, then: Self, otherwise: Self) -> Self {
        if self.value < bound.value { then } else { otherwise }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// Every operation of the trait in one expression, so that one derivative tests them all.
    fn everything<S: Scalar>(x: S, y: S) -> S {
        let (s, c) = (x * y).sin_cos();
        let r = (x * x + y * y + S::one()).sqrt();
        let turned = (s + r).atan2(c - r.scale(0.3));
        let table = (x - y).chain(|t| (t * t * t, 3.0 * t * t));
        turned / r - table.abs() + x.select_less(y, x * y, -y)
    }

    proptest! {
        #[test]
        fn partials_equal_central_differences(x in -2.0..2.0f64, y in -2.0..2.0f64) {
            prop_assume!((x - y).abs() > 1e-2); // the kinks of `everything`
            let dual = everything(Dual::<2>::variable(x, 0), Dual::<2>::variable(y, 1));
            let h = 1e-6;
            let by_x = (everything(x + h, y) - everything(x - h, y)) / (2.0 * h);
            let by_y = (everything(x, y + h) - everything(x, y - h)) / (2.0 * h);
            prop_assume!(by_x.abs() + by_y.abs() < 1e3); // excludes the branch cut of atan2
            prop_assert_eq!(dual.value, everything(x, y));
            prop_assert!((dual.partials[0] - by_x).abs() < 1e-7 * (1.0 + by_x.abs()));
            prop_assert!((dual.partials[1] - by_y).abs() < 1e-7 * (1.0 + by_y.abs()));
        }
    }
}
