//! How engines make a boundary of two half-angles and a range of twist.

use condyle_math::Quat;
use std::f64::consts::PI;

/// A rotation parted into a turn about x and the shortest swing after it, q = swing·twist.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Parted {
    /// y and z of the swing's quaternion, whose x is 0.
    pub swing: [f64; 2],
    /// Its real part, not negative.
    pub real: f64,
    /// The twist in radians, in (-π, π]; 0 where a swing of half a turn leaves it open.
    pub twist: f64,
}

impl Parted {
    /// Of a unit quaternion; q and -q are parted alike.
    ///
    /// ```
    /// use condyle_learn::limits::engine::Parted;
    /// use condyle_math::{Quat, Vec3};
    /// let q = Quat::from_axis_angle(Vec3::Y, 0.6) * Quat::from_axis_angle(Vec3::X, -0.4);
    /// let parted = Parted::of(-q);
    /// assert!((parted.twist + 0.4).abs() < 1e-15);
    /// let [y, z] = parted.vector();
    /// assert!((y - 0.6).abs() < 1e-15 && z.abs() < 1e-15);
    /// ```
    #[inline]
    #[must_use]
    pub fn of(q: Quat) -> Self {
        let real = q.x.hypot(q.w);
        if real < 1e-12 {
            return Self { swing: [q.y, q.z], real: 0.0, twist: 0.0 };
        }
        let (s, c) = (q.x / real, q.w / real);
        let (s, c) = if c < 0.0 { (-s, -c) } else { (s, c) };
        let sign = if q.w < 0.0 { -1.0 } else { 1.0 };
        let [y, z] = [sign * q.y, sign * q.z];
        Self { swing: [c * y - s * z, c * z + s * y], real, twist: 2.0 * s.atan2(c) }
    }

    /// The rotation vector of the swing about y and z, in radians.
    #[inline]
    #[must_use]
    pub fn vector(&self) -> [f64; 2] {
        let sine = self.swing[0].hypot(self.swing[1]);
        // θ / sin(θ/2), 2 in the limit.
        let factor = if sine > 1e-12 { 2.0 * sine.atan2(self.real) / sine } else { 2.0 };
        self.swing.map(|s| factor * s)
    }

    /// The rotation that swings by a rotation vector (0, y, z) after a twist.
    #[inline]
    #[must_use]
    pub fn joined([y, z]: [f64; 2], twist: f64) -> Quat {
        let swing = Quat::exp(condyle_math::Vec3::new(0.0, y, z));
        swing * Quat::from_axis_angle(condyle_math::Vec3::X, twist)
    }
}

/// The law by which two half-angles a (about y) and b (about z) bound a swing, and by which a twist is bounded.
///
/// With s = (0, s_y, s_z, s_w) the swing's quaternion and θ its rotation vector:
///
/// | law | allowed |
/// | --- | --- |
/// | `Angle` | (θ_y/a)² + (θ_z/b)² ≤ 1 |
/// | `JoltCone` | (s_y/sin ½a)² + (s_z/sin ½b)² ≤ 1 |
/// | `JoltPyramid` | 2·atan2(s_y, s_w) within ±a, 2·atan2(s_z, s_w) within ±b |
/// | `PhysxCone` | (u_y/a)² + (u_z/b)² ≤ 1 with u = 4·atan2(s, 1 + s_w) |
/// | `PhysxPyramid` | u_y within ±a, u_z within ±b |
/// | `MujocoBall` | the angle of the whole rotation at most a; no twist of its own |
/// | `MujocoHinges` | c = Ry(α)·Rz(β)·Rx(γ), α within ±a, β within ±b, γ within ±twist |
///
/// On the axes y and z all but the ball mean the same, between them they differ: at 60 and 30 degrees Jolt's cone by up to 0.6
/// degrees from the ellipse of angles, the pyramids by more.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Law {
    /// An ellipse of rotation vectors, of no engine: what a table says that is for none in particular.
    Angle,
    /// Jolt's `SwingTwistConstraint` and `SixDOFConstraint` with `ESwingType::Cone`.
    JoltCone,
    /// The same with `ESwingType::Pyramid`.
    JoltPyramid,
    /// `PxD6Joint::setSwingLimit` with a `PxJointLimitCone`, PhysX 4.1 and later.
    PhysxCone,
    /// `PxD6Joint::setPyramidSwingLimit` with a `PxJointLimitPyramid`.
    PhysxPyramid,
    /// MuJoCo's ball joint with a range.
    MujocoBall,
    /// Three hinges of MuJoCo in one body, about y, z and x of the child's frame in this order.
    MujocoHinges,
}

impl Law {
    /// All laws.
    pub const ALL: [Self; 7] = [
        Self::Angle,
        Self::JoltCone,
        Self::JoltPyramid,
        Self::PhysxCone,
        Self::PhysxPyramid,
        Self::MujocoBall,
        Self::MujocoHinges,
    ];

    /// Its name in tables.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Angle => "cone",
            Self::JoltCone => "jolt cone",
            Self::JoltPyramid => "jolt pyramid",
            Self::PhysxCone => "physx cone",
            Self::PhysxPyramid => "physx pyramid",
            Self::MujocoBall => "mujoco ball",
            Self::MujocoHinges => "mujoco hinges",
        }
    }

    /// Whether the twist has bounds of its own.
    #[must_use]
    pub fn twists(self) -> bool {
        self != Self::MujocoBall
    }

    /// The largest half-angles about y and z and the largest half of the twist's range, in radians.
    #[must_use]
    pub fn most(self) -> [f64; 3] {
        let near = 179f64.to_radians();
        match self {
            Self::MujocoHinges => [PI, 89f64.to_radians(), PI],
            Self::MujocoBall => [PI, PI, PI],
            _ => [near, near, PI],
        }
    }

    /// Whether a rotation in the constraint's frames is allowed.
    #[inline]
    #[must_use]
    pub fn allows(self, q: Quat, [a, b]: [f64; 2], twist: f64) -> bool {
        match self {
            Self::MujocoBall => {
                return 2.0 * q.vector().norm().atan2(q.w.abs()) <= a;
            }
            Self::MujocoHinges => {
                let [y, z, x] = hinges(q);
                return y.abs() <= a && z.abs() <= b && x.abs() <= twist;
            }
            _ => {}
        }
        let parted = Parted::of(q);
        if parted.twist.abs() > twist {
            return false;
        }
        let [y, z] = parted.swing;
        let ellipse = |y: f64, z: f64| y * y + z * z <= 1.0;
        match self {
            Self::JoltCone => ellipse(y / (0.5 * a).sin(), z / (0.5 * b).sin()),
            Self::JoltPyramid => {
                let angle = |s: f64| 2.0 * s.abs().atan2(parted.real);
                angle(y) <= a && angle(z) <= b
            }
            Self::PhysxCone | Self::PhysxPyramid => {
                let [y, z] = [y, z].map(|s| 4.0 * s.abs().atan2(1.0 + parted.real));
                if self == Self::PhysxCone { ellipse(y / a, z / b) } else { y <= a && z <= b }
            }
            _ => {
                let [y, z] = parted.vector();
                ellipse(y / a, z / b)
            }
        }
    }
}

/// The angles about y, z and x of q = Ry·Rz·Rx, that about z within a right angle.
#[inline]
pub(super) fn hinges(q: Quat) -> [f64; 3] {
    let m = q.to_mat3();
    // Ry(α)·Rz(β) e_x = (cos α cos β, sin β, -sin α cos β); the second row is (sin β, cos β cos γ, -cos β sin γ).
    [(-m.x.z).atan2(m.x.x), m.x.y.clamp(-1.0, 1.0).asin(), (-m.z.y).atan2(m.y.y)]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::limits::uniform;
    use condyle_math::Vec3;

    #[test]
    fn what_is_parted_is_the_product_of_its_parts() {
        for q in uniform(2000) {
            let parted = Parted::of(q);
            let again = Parted::joined(parted.vector(), parted.twist);
            assert!(again.angle_to(q) < 1e-12, "{q:?}");
            assert_eq!(Parted::of(-q), parted);
        }
    }

    /// On the axes every law has the half-angle that was given, by its formula.
    #[test]
    fn half_angles_are_what_they_say() {
        let (a, b, t) = (1.1, 0.5, 0.8);
        for law in Law::ALL {
            if law == Law::MujocoBall {
                continue;
            }
            let asked = |axis, angle| law.allows(Quat::from_axis_angle(axis, angle), [a, b], t);
            for (axis, most) in [(Vec3::Y, a), (Vec3::Z, b), (Vec3::X, t)] {
                for sign in [1.0, -1.0] {
                    assert!(asked(axis, sign * (most - 1e-9)), "{law:?} {axis:?}");
                    assert!(!asked(axis, sign * (most + 1e-9)), "{law:?} {axis:?}");
                }
            }
        }
        let ball =
            |axis, angle| Law::MujocoBall.allows(Quat::from_axis_angle(axis, angle), [a, b], t);
        assert!(ball(Vec3::X, -1.09) && !ball(Vec3::Z, 1.11));
    }

    /// A corner of each pyramid, by the formulas of the engines' own sources: Jolt's of Rz(z)·Ry(y), whose y/2 is
    /// atan2(q.y, q.w); PhysX's 4·atan2(s, 1 + w).
    #[test]
    fn pyramids_have_their_corners() {
        let [a, b] = [0.9, 0.4];
        let jolt = {
            let q = Quat::from_axis_angle(Vec3::Z, b) * Quat::from_axis_angle(Vec3::Y, a);
            Quat { x: 0.0, ..q }.normalized()
        };
        let physx = {
            let [y, z] = [a, b].map(|u: f64| (0.25 * u).tan());
            // s = u(1 + w) with s² + w² = 1.
            let k = y * y + z * z;
            let w = (1.0 - k) / (1.0 + k);
            Quat { x: 0.0, y: y * (1.0 + w), z: z * (1.0 + w), w }
        };
        for (law, corner) in [(Law::JoltPyramid, jolt), (Law::PhysxPyramid, physx)] {
            assert!((corner.dot(corner) - 1.0).abs() < 1e-12);
            assert!(law.allows(corner, [a + 1e-9, b + 1e-9], 0.1), "{law:?}");
            assert!(!law.allows(corner, [a - 1e-9, b + 1e-9], 0.1), "{law:?}");
            assert!(!law.allows(corner, [a + 1e-9, b - 1e-9], 0.1), "{law:?}");
        }
    }

    #[test]
    fn hinges_are_three_turns_in_their_order() {
        for [y, z, x] in [[0.3, -0.4, 1.2], [-2.5, 1.2, -3.0], [0.0, 0.0, 0.5]] {
            let q = Quat::from_axis_angle(Vec3::Y, y)
                * Quat::from_axis_angle(Vec3::Z, z)
                * Quat::from_axis_angle(Vec3::X, x);
            for (found, given) in hinges(-q).into_iter().zip([y, z, x]) {
                assert!((found - given).abs() < 1e-12, "{found} {given}");
            }
        }
    }
}
