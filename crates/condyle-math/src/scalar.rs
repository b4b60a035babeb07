//! The number type that kernels are generic over.

use std::fmt::Debug;
use std::ops::{Add, AddAssign, Div, Mul, MulAssign, Neg, Sub, SubAssign};

/// A real number, several real numbers (SIMD lanes), or a number with its derivatives.
///
/// Implemented for [`f64`] and [`Dual`](crate::Dual). Smooth kernels use only operations that work
/// on all lanes at once, where a comparison has no single result. Kernels that branch read
/// [`Scalar::value`] and have to be run lane by lane.
pub trait Scalar:
    Copy
    + Debug
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
    + AddAssign
    + SubAssign
    + MulAssign
    + Send
    + Sync
    + 'static
{
    /// A constant.
    fn from_f64(value: f64) -> Self;

    /// The number without its derivatives, for kernels that branch.
    fn value(self) -> f64;

    /// The square root; its derivative at 0 is infinite.
    fn sqrt(self) -> Self;

    /// Sine and cosine of an angle in radians.
    fn sin_cos(self) -> (Self, Self);

    /// The angle in radians, in (-π, π], of the point (`x`, `self`).
    fn atan2(self, x: Self) -> Self;

    /// A function given by its value and its derivative, applied to every lane.
    ///
    /// `law` returns `(f(x), f'(x))`. Kernels evaluate splines and other tables through it.
    fn chain(self, law: impl Fn(f64) -> (f64, f64)) -> Self;

    /// `then` where `self < bound`, `otherwise` elsewhere, lane by lane.
    ///
    /// Both branches are evaluated before the selection: guard divisions in the branch that is not
    /// selected.
    fn select_less(self, bound: Self, then: Self, otherwise: Self) -> Self;

    /// Zero.
    #[inline(always)]
    fn zero() -> Self {
        Self::from_f64(0.0)
    }

    /// One.
    #[inline(always)]
    fn one() -> Self {
        Self::from_f64(1.0)
    }

    /// The absolute value.
    #[inline(always)]
    fn abs(self) -> Self {
        self.select_less(Self::zero(), -self, self)
    }

    /// The product with a plain number.
    #[inline(always)]
    fn scale(self, factor: f64) -> Self {
        self * Self::from_f64(factor)
    }
}

impl Scalar for f64 {
    #[inline(always)]
    fn from_f64(value: f64) -> Self {
        value
    }

    #[inline(always)]
    fn value(self) -> f64 {
        self
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        f64::sqrt(self)
    }

    #[inline(always)]
    fn sin_cos(self) -> (Self, Self) {
        crate::sine::sin_cos(self)
    }

    #[inline(always)]
    fn atan2(self, x: Self) -> Self {
        f64::atan2(self, x)
    }

    #[inline(always)]
    fn chain(self, law: impl Fn(f64) -> (f64, f64)) -> Self {
        law(self).0
    }

    #[inline(always)]
    fn select_less(self, bound: Self, then: Self, otherwise: Self) -> Self {
        if self < bound { then } else { otherwise }
    }

    #[inline(always)]
    fn scale(self, factor: f64) -> Self {
        self * factor
    }
}
