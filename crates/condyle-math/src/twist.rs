//! Generators of rigid motion.

use crate::{Affine, Scalar, Vec3};
use std::ops::{Add, AddAssign, Mul};

/// An infinitesimal rigid motion: how a frame moves per unit of one coordinate.
///
/// `linear` is the velocity of the material point that passes the origin, so twists of one frame of
/// reference add, and a point at `p` moves with `angular × p + linear`.
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

    /// The same motion seen from the parent of `frame` (the adjoint of a rigid transform).
    #[inline(always)]
    pub fn transformed(self, frame: Affine<S>) -> Self {
        let angular = frame.linear * self.angular;
        Self { angular, linear: frame.linear * self.linear + frame.translation.cross(angular) }
    }

    /// The generator of a rigid motion from its value and its derivative: Ṫ·T⁻¹.
    #[inline(always)]
    pub fn from_derivative(value: Affine<S>, derivative: Affine<S>) -> Self {
        // Ṙ·Rᵀ = [ω]×, read off by ω = ½ Σ aᵢ × ȧᵢ over the columns.
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
