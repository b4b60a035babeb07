//! Three-by-three matrices, stored by columns.

use crate::{Quat, Scalar, Vec3};
use std::ops::Mul;

/// A three-by-three matrix: a rotation, or any linear map.
///
/// Its columns are the images of the axes: the columns of `scapula_in_thorax` are the axes of the
/// scapula expressed in the thorax.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mat3<S = f64> {
    /// Image of the first axis.
    pub x: Vec3<S>,
    /// Image of the second axis.
    pub y: Vec3<S>,
    /// Image of the third axis.
    pub z: Vec3<S>,
}

impl Mat3<f64> {
    /// The identity.
    pub const IDENTITY: Self = Self::from_columns(Vec3::X, Vec3::Y, Vec3::Z);

    /// The same matrix as constants of another scalar.
    #[inline(always)]
    pub fn cast<S: Scalar>(self) -> Mat3<S> {
        Mat3::from_columns(self.x.cast(), self.y.cast(), self.z.cast())
    }
}

impl<S> Mat3<S> {
    /// The matrix with these columns.
    #[inline(always)]
    pub const fn from_columns(x: Vec3<S>, y: Vec3<S>, z: Vec3<S>) -> Self {
        Self { x, y, z }
    }
}

impl<S: Scalar> Mat3<S> {
    /// The identity of any scalar.
    #[inline(always)]
    pub fn identity() -> Self {
        Mat3::IDENTITY.cast()
    }

    /// The rotation by `angle` (radians) about the first axis.
    #[inline(always)]
    pub fn rotation_x(angle: S) -> Self {
        Self::identity().rotated_x(angle.sin_cos())
    }

    /// The rotation by `angle` (radians) about the second axis.
    #[inline(always)]
    pub fn rotation_y(angle: S) -> Self {
        Self::identity().rotated_y(angle.sin_cos())
    }

    /// The rotation by `angle` (radians) about the third axis.
    #[inline(always)]
    pub fn rotation_z(angle: S) -> Self {
        Self::identity().rotated_z(angle.sin_cos())
    }

    /// `self · Rx` for an angle given by its sine and cosine: four multiplications per row instead
    /// of nine.
    #[inline(always)]
    pub fn rotated_x(self, (s, c): (S, S)) -> Self {
        Self::from_columns(self.x, self.y * c + self.z * s, self.z * c - self.y * s)
    }

    /// `self · Ry` for an angle given by its sine and cosine.
    #[inline(always)]
    pub fn rotated_y(self, (s, c): (S, S)) -> Self {
        Self::from_columns(self.x * c - self.z * s, self.y, self.z * c + self.x * s)
    }

    /// `self · Rz` for an angle given by its sine and cosine.
    #[inline(always)]
    pub fn rotated_z(self, (s, c): (S, S)) -> Self {
        Self::from_columns(self.x * c + self.y * s, self.y * c - self.x * s, self.z)
    }

    /// The rotation about any axis of length 1, from the angle's sine and cosine.
    ///
    /// Rodrigues: R = c·I + s·\[a\]× + (1 - c)·a·aᵀ.
    #[inline(always)]
    pub fn rotation_about(axis: Vec3<S>, (s, c): (S, S)) -> Self {
        let t = S::one() - c;
        let (ax, ay, az) = (axis.x * t, axis.y * t, axis.z * t);
        let (sx, sy, sz) = (axis.x * s, axis.y * s, axis.z * s);
        let (xy, xz, yz) = (ax * axis.y, ax * axis.z, ay * axis.z);
        Self::from_columns(
            Vec3::new(ax * axis.x + c, xy + sz, xz - sy),
            Vec3::new(xy - sz, ay * axis.y + c, yz + sx),
            Vec3::new(xz + sy, yz - sx, az * axis.z + c),
        )
    }

    /// The transpose; for a rotation, its inverse.
    #[inline(always)]
    pub fn transpose(self) -> Self {
        Self::from_columns(
            Vec3::new(self.x.x, self.y.x, self.z.x),
            Vec3::new(self.x.y, self.y.y, self.z.y),
            Vec3::new(self.x.z, self.y.z, self.z.z),
        )
    }

    /// The rotation vector of a rotation: its axis times its angle in radians, in [0, π].
    ///
    /// Computed from the quaternion of [`Quat::from_mat3`].
    pub fn log(self) -> Vec3<S> {
        Quat::from_mat3(self).log()
    }

    /// The determinant.
    #[inline(always)]
    pub fn determinant(self) -> S {
        self.x.dot(self.y.cross(self.z))
    }

    /// The inverse of any regular matrix; not finite for a singular one.
    pub fn inverse(self) -> Self {
        // The rows of the inverse are the cross products of the columns over the determinant.
        let r = S::one() / self.determinant();
        Self::from_columns(
            self.y.cross(self.z) * r,
            self.z.cross(self.x) * r,
            self.x.cross(self.y) * r,
        )
        .transpose()
    }

    /// The entry in a row and a column, each 0, 1 or 2.
    ///
    /// # Panics
    /// If an index is above 2.
    #[inline]
    pub fn at(&self, row: usize, column: usize) -> S {
        [self.x, self.y, self.z][column].to_array()[row]
    }
}

impl<S: Scalar> Mul<Vec3<S>> for Mat3<S> {
    type Output = Vec3<S>;
    #[inline(always)]
    fn mul(self, v: Vec3<S>) -> Vec3<S> {
        self.x * v.x + self.y * v.y + self.z * v.z
    }
}

impl<S: Scalar> Mul for Mat3<S> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        Self::from_columns(self * other.x, self * other.y, self * other.z)
    }
}
