//! Generators of motions that are not rigid: those of segments below a scale or a shear.
//!
//! With T the transform of a segment, Ṫ·T⁻¹ = \[A | v\] gives the point p of the world the velocity
//! A·p + v. The skew part of A is the angular velocity of a [`Twist`]; its symmetric part, the
//! *strain*, is stored separately and is zero for rigid motions. A generator \[A | v\] in a frame
//! with linear part B and origin t becomes \[A′ | B·v - A′·t\] in its base, with A′ = B·A·B⁻¹.

use condyle_math::{Affine, Mat3, Twist, Vec3};

/// A generator \[A | v\].
#[derive(Clone, Copy, Debug)]
pub(super) struct Rate {
    pub linear: Mat3,
    pub translation: Vec3,
}

impl Rate {
    /// The generator of a twist with its strain: A = \[ω\]× + strain.
    pub(super) fn new(twist: Twist, strain: Mat3) -> Self {
        let w = twist.angular;
        let skew = Mat3::from_columns(
            Vec3::new(0.0, w.z, -w.y),
            Vec3::new(-w.z, 0.0, w.x),
            Vec3::new(w.y, -w.x, 0.0),
        );
        Self { linear: sum(skew, strain), translation: twist.linear }
    }

    /// A generator without translation.
    pub(super) fn of_linear(linear: Mat3) -> Self {
        Self { linear, translation: Vec3::ZERO }
    }

    /// Ṫ·T⁻¹ from a transform and its derivative.
    pub(super) fn from_derivative(value: Affine, derivative: Affine) -> Self {
        let linear = derivative.linear * value.linear.inverse();
        Self { linear, translation: derivative.translation - linear * value.translation }
    }

    /// The same motion expressed in the base of `frame`.
    pub(super) fn transformed(self, frame: Affine) -> Self {
        let linear = frame.linear * self.linear * frame.linear.inverse();
        let translation = frame.linear * self.translation - linear * frame.translation;
        Self { linear, translation }
    }

    /// The twist and the strain: skew and symmetric part of A.
    pub(super) fn split(self) -> (Twist, Mat3) {
        let m = self.linear;
        let angular = Vec3::new(m.y.z - m.z.y, m.z.x - m.x.z, m.x.y - m.y.x) * 0.5;
        let mirrored = m.transpose();
        let half = |a: Vec3, b: Vec3| (a + b) * 0.5;
        let strain =
            Mat3::from_columns(half(m.x, mirrored.x), half(m.y, mirrored.y), half(m.z, mirrored.z));
        (Twist { angular, linear: self.translation }, strain)
    }
}

/// No strain.
pub(super) const NO_STRAIN: Mat3 = Mat3::from_columns(Vec3::ZERO, Vec3::ZERO, Vec3::ZERO);

/// The sum of two matrices.
pub(super) fn sum(a: Mat3, b: Mat3) -> Mat3 {
    Mat3::from_columns(a.x + b.x, a.y + b.y, a.z + b.z)
}

/// A matrix times a number.
pub(super) fn times(m: Mat3, factor: f64) -> Mat3 {
    Mat3::from_columns(m.x * factor, m.y * factor, m.z * factor)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_rigid_motion_in_a_rigid_frame_is_its_twist() {
        let twist = Twist::rotation(Vec3::new(0.6, 0.0, 0.8), Vec3::new(0.1, -0.3, 0.2));
        let turn = Mat3::rotation_about(Vec3::new(0.0, 0.6, -0.8), 0.7f64.sin_cos());
        let frame = Affine::new(turn, Vec3::new(0.4, 0.1, -0.2));
        let (found, strain) = Rate::new(twist, NO_STRAIN).transformed(frame).split();
        let expected = twist.transformed(frame);
        assert!((found.angular - expected.angular).norm() < 1e-15);
        assert!((found.linear - expected.linear).norm() < 1e-15);
        assert!(strain.x.norm() + strain.y.norm() + strain.z.norm() < 1e-15);
    }
}
