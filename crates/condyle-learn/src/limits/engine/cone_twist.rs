//! Two half-angles of swing, a range of twist and the frames they are in.

use super::Law;
use condyle_math::{Mat3, Quat, Vec3};

/// A cone of swing with a range of twist, in the numbers that engines take.
///
/// The range of twist is symmetric, ± [`ConeTwist::twist`]: where its middle lies is said by the frames.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ConeTwist {
    /// How the half-angles are meant.
    pub law: Law,
    /// The rotation of the child in its reference that has no swing and no twist.
    pub middle: Quat,
    /// The constraint's frame in the child, F_c: x along the bone, half-angles about y and z.
    pub in_child: Quat,
    /// The half-angles about y and z, in radians.
    pub swing: [f64; 2],
    /// Half of the range of twist, in radians; π where the twist is free.
    pub twist: f64,
}

impl ConeTwist {
    /// The constraint's frame in the reference, F_r = middle·F_c.
    #[must_use]
    pub fn in_reference(&self) -> Quat {
        (self.middle * self.in_child).normalized()
    }

    /// A rotation of the child in its reference in the frames of the constraint, c = F_r⁻¹·R·F_c.
    #[inline]
    #[must_use]
    pub fn relative(&self, rotation: Quat) -> Quat {
        self.in_reference().conjugate() * rotation * self.in_child
    }

    /// Whether a rotation of the child in its reference is allowed.
    ///
    /// ```
    /// use condyle_learn::limits::engine::{ConeTwist, Law};
    /// use condyle_math::{Quat, Vec3};
    /// // A bone along -y that swings by 40 degrees about the child's x and 20 about z, and twists by 30.
    /// let in_child = Quat::from_mat3(condyle_math::Mat3::from_columns(-Vec3::Y, Vec3::X, Vec3::Z));
    /// let [a, b, twist] = [40f64, 20.0, 30.0].map(f64::to_radians);
    /// let middle = Quat::IDENTITY;
    /// let cone = ConeTwist { law: Law::Angle, middle, in_child, swing: [a, b], twist };
    /// let turned = |axis, degrees: f64| Quat::from_axis_angle(axis, degrees.to_radians());
    /// assert!(cone.allows(turned(Vec3::X, 39.0)) && !cone.allows(turned(Vec3::X, 41.0)));
    /// assert!(cone.allows(turned(Vec3::Z, 19.0)) && !cone.allows(turned(Vec3::Z, 21.0)));
    /// assert!(cone.allows(turned(Vec3::Y, 29.0)) && !cone.allows(turned(Vec3::Y, 31.0)));
    /// ```
    #[inline]
    #[must_use]
    pub fn allows(&self, rotation: Quat) -> bool {
        self.law.allows(self.relative(rotation), self.swing, self.twist)
    }

    /// A quicker [`ConeTwist::allows`] for many rotations.
    pub(super) fn asked(&self) -> impl Fn(Quat) -> bool + '_ {
        let back = self.in_reference().conjugate();
        move |rotation| self.law.allows(back * rotation * self.in_child, self.swing, self.twist)
    }

    /// The axis of twist (x) and the second swing axis (z) of both frames, as vectors: in the reference, then in the child.
    #[must_use]
    pub fn axes(&self) -> [[Vec3; 2]; 2] {
        let of = |q: Quat| {
            let m = q.to_mat3();
            [m.x, m.z]
        };
        [of(self.in_reference()), of(self.in_child)]
    }
}

/// A frame with x along a bone; y and z as near as can be to axes of the child.
pub(super) fn along(bone: Vec3) -> Quat {
    let x = bone.normalized();
    let sizes = x.to_array().map(f64::abs);
    // The axis of the child that is farthest from the bone; of equal ones the last, z before x.
    let mut other = Vec3::Z;
    if sizes[0] < sizes[2] - 1e-9 {
        other = Vec3::X;
    }
    if sizes[1] < sizes[0].min(sizes[2]) - 1e-9 {
        other = Vec3::Y;
    }
    let z = (other - x * other.dot(x)).normalized();
    Quat::from_mat3(Mat3::from_columns(x, z.cross(x), z))
}
