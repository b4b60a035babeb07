//! The number type that kernels are generic over.

use std::fmt::Debug;
use std::ops::{Add, AddAssign, Div, Mul, MulAssign, Neg, Sub, SubAssign};

/// A real number, several real numbers (SIMD lanes), or a number with its derivatives.
///
/// Implemented for [`f64`] and [`Dual`](crate::Dual). A kernel works on all lanes at once, and they
/// differ: no method returns a `bool` or a plain number. What depends on the value of a number is
/// written in one of three ways:
///
/// - [`Scalar::select_less`] chooses between two results, both of which are computed;
/// - [`Scalar::chain`] applies a function of one number that is known by its value and its slope,
///   such as a spline;
/// - [`Scalar::lane_by_lane`] runs a kernel that branches in each lane by itself. Only there
///   [`Lane::value`] can be read.
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
    /// The number in one lane; a scalar of one lane is its own.
    type Lane: Lane;

    /// A constant, the same in all lanes.
    fn from_f64(value: f64) -> Self;

    /// A kernel that branches, run in each lane by itself: `kernel(inputs)` for a scalar of one
    /// lane.
    ///
    /// ```
    /// use condyle_math::{Lane, Scalar, Vec3};
    ///
    /// /// The coordinate axis that is farthest from the direction of `v`.
    /// fn farthest<S: Scalar>(v: Vec3<S>) -> Vec3<S> {
    ///     let axis = S::lane_by_lane(v.to_array(), |v| {
    ///         let size = v.map(|part| part.value().abs());
    ///         let least = size.into_iter().fold(f64::INFINITY, f64::min);
    ///         let place = size.iter().position(|&part| part == least);
    ///         Vec3::UNITS[place.unwrap_or(0)].cast().to_array()
    ///     });
    ///     axis.into()
    /// }
    /// assert_eq!(farthest(Vec3::new(0.5, -0.1, 0.2)), Vec3::Y);
    /// ```
    fn lane_by_lane<const N: usize, const M: usize>(
        inputs: [Self; N],
        kernel: impl Fn([Self::Lane; N]) -> [Self::Lane; M],
    ) -> [Self; M];

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

/// A [`Scalar`] of one lane, on whose value a kernel can branch.
pub trait Lane: Scalar<Lane = Self> {
    /// The number without its derivatives.
    fn value(self) -> f64;
}

impl Lane for f64 {
    #[inline(always)]
    fn value(self) -> f64 {
        self
    }
}

impl Scalar for f64 {
    type Lane = Self;

    #[inline(always)]
    fn from_f64(value: f64) -> Self {
        value
    }

    #[inline(always)]
    fn lane_by_lane<const N: usize, const M: usize>(
        inputs: [Self; N],
        kernel: impl Fn([Self; N]) -> [Self; M],
    ) -> [Self; M] {
        kernel(inputs)
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
