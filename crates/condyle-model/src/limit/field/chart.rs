//! The map in which a field is stored: rotations about the reference, in a ball.
//!
//! A rotation p is first brought into the cloud's own axes, q = A⁻¹ m⁻¹ p A with m the reference rotation and A the
//! principal axes of the cloud about it. So the stored values do not depend on which axes the two segments
//! have been given. Then, with the sign for which w ≥ 0,
//!
//! x = √2 v/√(1 + w),   |x| = 2 sin(θ/4),
//!
//! which takes all rotations to a ball of radius √2. Along the radius a unit of x is 2/cos(θ/4) rad of rotation, across
//! it 2 cos(θ/4): 2 in the middle, 2.8 and 1.4 at the half turns. Of modified Rodrigues parameters,
//! x = v/(1 + w), a unit is 4 in the middle and 2 at the half turns: the same number of nodes resolves people's joints,
//! which are about the middle, worse by 30 %.

use condyle_math::{Quat, Vec3};

/// Beyond the half turns the map goes on to w = -`OVERLAP`, so that values under both signs can be blended.
pub(super) const OVERLAP: f64 = 0.05;

/// The radius of the map with its overlap.
pub(super) fn reach() -> f64 {
    (2.0 * (1.0 + OVERLAP)).sqrt()
}

/// The axes in which a field is stored.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Chart {
    left: Quat,
    right: Quat,
}

impl Chart {
    /// The axes of a cloud about its reference rotation: unit quaternions `reference` and `axes`, which takes the
    /// cloud's axes to the child's.
    #[must_use]
    pub fn new(reference: Quat, axes: Quat) -> Self {
        Self { left: (axes.conjugate() * reference.conjugate()).normalized(), right: axes }
    }

    /// The same from what [`Chart::sides`] gave, without rounding.
    #[must_use]
    pub fn of_sides([left, right]: [Quat; 2]) -> Self {
        Self { left, right }
    }

    /// A⁻¹ m⁻¹ and A: a rotation in the cloud's axes is left · p · right.
    #[must_use]
    pub fn sides(&self) -> [Quat; 2] {
        [self.left, self.right]
    }

    /// A rotation in the cloud's axes, of length 1, of the two signs the one with w > 0, or with w = 0 and the
    /// first other component above 0.
    ///
    /// All operations are odd, so that `q` and `-q` give the same bits.
    #[inline]
    #[must_use]
    pub fn inward(&self, q: Quat) -> Quat {
        signed((self.left * q * self.right).normalized())
    }

    /// Back from the cloud's axes.
    #[inline]
    #[must_use]
    pub fn outward(&self, q: Quat) -> Quat {
        self.left.conjugate() * q * self.right.conjugate()
    }

    /// A tangent vector in the child's own axes, from one in the cloud's.
    #[inline]
    pub(super) fn tangent_outward(&self, g: Vec3) -> Vec3 {
        self.right.to_mat3() * g
    }
}

/// Of both signs the one with w > 0, or with w = 0 and the first other component above 0.
#[inline]
pub(super) fn signed(q: Quat) -> Quat {
    let first = [q.w, q.x, q.y, q.z].into_iter().find(|c| *c != 0.0);
    if first.is_some_and(|c| c < 0.0) { -q } else { q }
}

/// Where a quaternion is in the map.
#[inline]
pub(super) fn mapped(q: Quat) -> [f64; 3] {
    let scale = (2.0 / (1.0 + q.w)).sqrt();
    [q.x * scale, q.y * scale, q.z * scale]
}

/// The slope of a function on quaternions from its slope in the map.
#[inline]
pub(super) fn slope(q: Quat, g: [f64; 3]) -> [f64; 4] {
    let scale = (2.0 / (1.0 + q.w)).sqrt();
    let along = q.x * g[0] + q.y * g[1] + q.z * g[2];
    [g[0] * scale, g[1] * scale, g[2] * scale, -0.5 * scale * along / (1.0 + q.w)]
}

/// The quaternion at a place of the map; w = 1 - |x|²/2.
pub(super) fn unmapped(x: [f64; 3]) -> Option<Quat> {
    let square = x[0] * x[0] + x[1] * x[1] + x[2] * x[2];
    let scale = (1.0 - square / 4.0).sqrt();
    (square < 4.0).then(|| Quat {
        x: x[0] * scale,
        y: x[1] * scale,
        z: x[2] * scale,
        w: 1.0 - square / 2.0,
    })
}
