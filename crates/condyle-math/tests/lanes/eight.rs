//! Eight numbers at once: the scalar that shows that kernels are right in every lane.

use condyle_math::{Lane, Scalar};
use std::array::from_fn;
use std::ops::{Add, AddAssign, Div, Mul, MulAssign, Neg, Sub, SubAssign};

/// Eight numbers, or eight numbers with their derivatives.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Eight<L = f64>(pub(crate) [L; 8]);

macro_rules! operator {
    ($name:ident $method:ident, $assign_name:ident $assign:ident) => {
        impl<L: Lane> $name for Eight<L> {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                Self(from_fn(|i| self.0[i].$method(other.0[i])))
            }
        }
        impl<L: Lane> $assign_name for Eight<L> {
            #[inline(always)]
            fn $assign(&mut self, other: Self) {
                *self = self.$method(other);
            }
        }
    };
}

operator!(Add add, AddAssign add_assign);
operator!(Sub sub, SubAssign sub_assign);
operator!(Mul mul, MulAssign mul_assign);

impl<L: Lane> Div for Eight<L> {
    type Output = Self;
    #[inline(always)]
    fn div(self, other: Self) -> Self {
        Self(from_fn(|i| self.0[i] / other.0[i]))
    }
}

impl<L: Lane> Neg for Eight<L> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self(self.0.map(Neg::neg))
    }
}

impl<L: Lane> Scalar for Eight<L> {
    type Lane = L;

    fn from_f64(value: f64) -> Self {
        Self([L::from_f64(value); 8])
    }

    fn lane_by_lane<const N: usize, const M: usize>(
        inputs: [Self; N],
        kernel: impl Fn([L; N]) -> [L; M],
    ) -> [Self; M] {
        let lanes: [[L; M]; 8] = from_fn(|i| kernel(inputs.map(|input| input.0[i])));
        from_fn(|output| Self(lanes.map(|lane| lane[output])))
    }

    fn sqrt(self) -> Self {
        Self(self.0.map(L::sqrt))
    }

    fn sin_cos(self) -> (Self, Self) {
        let both = self.0.map(L::sin_cos);
        (Self(both.map(|(sine, _)| sine)), Self(both.map(|(_, cosine)| cosine)))
    }

    fn atan2(self, x: Self) -> Self {
        Self(from_fn(|i| self.0[i].atan2(x.0[i])))
    }

    fn chain(self, law: impl Fn(f64) -> (f64, f64)) -> Self {
        Self(self.0.map(|x| x.chain(&law)))
    }

    fn select_less(self, bound: Self, then: Self, otherwise: Self) -> Self {
        Self(from_fn(|i| self.0[i].select_less(bound.0[i], then.0[i], otherwise.0[i])))
    }
}
