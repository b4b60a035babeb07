//! Twists: generators of rigid motions.

use crate::{Affine, Scalar, Vec3};
use std::ops::{Add, AddAssign, Mul};

/// An infinitesimal rigid motion: how a frame moves per unit of one coordinate.
///
/// `linear` is the velocity of the material point that coincides with the origin. Twists in the
/// same frame of reference add, and a point at `p` has the velocity `angular × p + linear`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Twist<S = f64> {
    /// Angular velocity per unit of the coordinate, rad.
    pub angular: Vec3<S>,
    /// Velocity at the origin per unit of the coordinate, m.
    pub linear: Vec3<S>,
}

impl<S: Scalar> Twist<S> {
    /// No motion.
    #[inline(always)]
    pub fn zero() -> Self {
        Self { angular: Vec3::zero(), linear: Vec3::zero() }
    }

    /// A rotation about an axis (unit direction) through a centre.
    #[inline(always)]
    pub fn rotation(axis: Vec3<S>, centre: Vec3<S>) -> Self {
        Self { angular: axis, linear: centre.cross(axis) }
    }

    /// A translation along a direction.
    #[inline(always)]
    pub fn translation(direction: Vec3<S>) -> Self {
        Self { angular: Vec3::zero(), linear: direction }
    }

    /// The velocity of the material point at `point`.
    #[inline(always)]
    pub fn velocity_at(self, point: Vec3<S>) -> Vec3<S> {
        self.angular.cross(point) + self.linear
    }

    /// The same motion expressed in the parent of `frame`: the adjoint of a rigid transform,
    /// (ω, v) ↦ (R·ω, R·v + t × R·ω).
    #[inline(always)]
    pub fn transformed(self, frame: Affine<S>) -> Self {
        let angular = frame.linear * self.angular;
        Self { angular, linear: frame.linear * self.linear + frame.translation.cross(angular) }
    }

    /// The twist Ṫ·T⁻¹ of a rigid transform, from its value T and its derivative Ṫ.
    #[inline(always)]
    pub fn from_derivative(value: Affine<S>, derivative: Affine<S>) -> Self {
        // Ṙ·Rᵀ = [ω]×, so ȧ = ω × a for each column a of R, and Σ a × ȧ = 3ω - Σ (a·ω)·a = 2ω.
        let (r, d) = (value.linear, derivative.linear);
        let angular = (r.x.cross(d.x) + r.y.cross(d.y) + r.z.cross(d.z)) * S::from_f64(0.5);
        Self { angular, linear: derivative.translation - angular.cross(value.translation) }
    }
}

impl<S: Scalar> Add for Twist<S> {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Self { angular: self.angular + other.angular, linear: self.linear + other.linear }
    }
}

impl<S: Scalar> AddAssign for Twist<S> {
    #[inline(always)]
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl<S: Scalar> Mul<S> for Twist<S> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, factor: S) -> Self {
        Self { angular: self.angular * factor, linear: self.linear * factor }
    }
}
