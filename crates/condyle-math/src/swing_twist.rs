//! Swing-twist decomposition: the direction of the bone, and the rotation about it.

use crate::{Quat, Scalar, Vec3};

/// A rotation decomposed as `swing · twist`: the bone rotates about its own axis, then swings to
/// its direction.
///
/// The twist is the rotation about `axis` that is nearest to the whole rotation; the axis of the
/// swing is perpendicular to `axis`. The decomposition is smooth except where the swing is a half
/// turn: there the twist is undetermined, and the identity is returned for it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SwingTwist<S = f64> {
    /// The rotation that moves the axis to its new direction along the shortest arc.
    pub swing: Quat<S>,
    /// The rotation about the axis, applied first.
    pub twist: Quat<S>,
}

/// Below this length of the projected quaternion (v·axis, w) the twist is undetermined.
const HALF_TURN: f64 = 1e-12;

impl<S: Scalar> SwingTwist<S> {
    /// Decomposes a unit quaternion about an axis of length 1 fixed in the bone.
    ///
    /// ```
    /// use condyle_math::{Quat, SwingTwist, Vec3};
    /// let swing = Quat::from_axis_angle(Vec3::X, 0.7);
    /// let twist = Quat::from_axis_angle(Vec3::Y, -0.4);
    /// let split = SwingTwist::of(swing * twist, Vec3::Y);
    /// assert!((split.twist_angle(Vec3::Y) + 0.4).abs() < 1e-15);
    /// assert!(split.swing.angle_to(swing) < 1e-15);
    /// ```
    pub fn of(rotation: Quat<S>, axis: Vec3<S>) -> Self {
        // The twist is the projection (a·(v·a), w) of the quaternion, normalised.
        let along = rotation.vector().dot(axis);
        let length = (along * along + rotation.w * rotation.w).sqrt();
        // `select_less` evaluates both branches: `safe` keeps the one that is not selected finite.
        let bound = S::from_f64(HALF_TURN);
        let safe = length.select_less(bound, S::one(), length);
        let sine = length.select_less(bound, S::zero(), along / safe);
        let w = length.select_less(bound, S::one(), rotation.w / safe);
        let twist = Quat { x: axis.x * sine, y: axis.y * sine, z: axis.z * sine, w };
        Self { swing: rotation * twist.conjugate(), twist }
    }

    /// The composed rotation, `swing · twist`.
    pub fn rotation(self) -> Quat<S> {
        self.swing * self.twist
    }

    /// The signed twist about `axis` in radians, in (-π, π].
    pub fn twist_angle(self, axis: Vec3<S>) -> S {
        // Of q and -q the one with w ≥ 0, so that twice the half angle is in (-π, π].
        let near = self.twist.w.select_less(S::zero(), -S::one(), S::one());
        (self.twist.vector().dot(axis) * near).atan2(self.twist.w * near).scale(2.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn recomposes_and_keeps_the_swing_perpendicular(
            q in [-1.0..1.0, -1.0..1.0, -1.0..1.0, -1.0..1.0f64], a in [-1.0..1.0, -1.0..1.0, 0.1..1.0f64],
        ) {
            prop_assume!(q.iter().map(|c| c * c).sum::<f64>() > 1e-3);
            let (q, axis) = (Quat::from(q).normalized(), Vec3::from(a).normalized());
            let split = SwingTwist::of(q, axis);
            prop_assert!(split.rotation().angle_to(q) < 1e-14);
            prop_assert!(split.swing.vector().dot(axis).abs() < 1e-14);
            // The swing alone determines the direction of the bone.
            let turned = split.swing.to_mat3() * axis;
            prop_assert!((turned - q.to_mat3() * axis).norm() < 1e-14);
        }
    }

    #[test]
    fn a_half_turn_swing_has_no_twist() {
        let q = Quat::from_axis_angle(Vec3::X, std::f64::consts::PI);
        let split = SwingTwist::of(q, Vec3::Y);
        assert!(split.rotation().angle_to(q) < 1e-14);
        assert!(split.twist.vector().norm() < 1e-12);
    }
}
