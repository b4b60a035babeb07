//! Transforms from one frame to another.

use crate::{Mat3, Scalar, Vec3};
use std::ops::Mul;

/// An affine transform `p ↦ linear · p + translation`; rigid if `linear` is a rotation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Affine<S = f64> {
    /// The linear part: the axes of the child frame in the parent frame, as columns.
    pub linear: Mat3<S>,
    /// The origin of the child frame in the parent frame, in metres.
    pub translation: Vec3<S>,
}

impl Affine<f64> {
    /// The identity.
    pub const IDENTITY: Self = Self::new(Mat3::IDENTITY, Vec3::ZERO);

    /// The same transform as constants of another scalar.
    #[inline(always)]
    pub fn cast<S: Scalar>(self) -> Affine<S> {
        Affine::new(self.linear.cast(), self.translation.cast())
    }

    /// The sixteen numbers of the homogeneous matrix, row by row.
    ///
    /// ```
    /// use condyle_math::{Affine, Vec3};
    /// let m = Affine::from_translation(Vec3::new(1.0, 2.0, 3.0)).to_rows();
    /// assert_eq!([m[3], m[7], m[11], m[15]], [1.0, 2.0, 3.0, 1.0]);
    /// ```
    pub fn to_rows(self) -> [f64; 16] {
        let (l, t) = (self.linear, self.translation);
        [
            l.x.x, l.y.x, l.z.x, t.x, //
            l.x.y, l.y.y, l.z.y, t.y, //
            l.x.z, l.y.z, l.z.z, t.z, //
            0.0, 0.0, 0.0, 1.0,
        ]
    }
}

impl<S> Affine<S> {
    /// The transform with this linear part and this translation.
    #[inline(always)]
    pub const fn new(linear: Mat3<S>, translation: Vec3<S>) -> Self {
        Self { linear, translation }
    }

    /// The twelve numbers: the columns of the linear part, then the translation.
    #[inline(always)]
    pub fn to_columns(self) -> [S; 12] {
        let Mat3 { x, y, z } = self.linear;
        let t = self.translation;
        [x.x, x.y, x.z, y.x, y.y, y.z, z.x, z.y, z.z, t.x, t.y, t.z]
    }

    /// The transform with these columns; the inverse of [`Affine::to_columns`].
    #[inline(always)]
    pub fn from_columns([a, b, c, d, e, f, g, h, i, j, k, l]: [S; 12]) -> Self {
        let (x, y, z) = (Vec3::new(a, b, c), Vec3::new(d, e, f), Vec3::new(g, h, i));
        Self::new(Mat3::from_columns(x, y, z), Vec3::new(j, k, l))
    }
}

impl<S: Scalar> Affine<S> {
    /// The identity of any scalar.
    #[inline(always)]
    pub fn identity() -> Self {
        Affine::IDENTITY.cast()
    }

    /// A pure rotation about the origin.
    #[inline(always)]
    pub fn from_rotation(rotation: Mat3<S>) -> Self {
        Self::new(rotation, Vec3::zero())
    }

    /// A pure translation.
    #[inline(always)]
    pub fn from_translation(translation: Vec3<S>) -> Self {
        Self::new(Mat3::identity(), translation)
    }

    /// The inverse of a rigid transform (`linear` must be a rotation).
    #[inline(always)]
    pub fn rigid_inverse(self) -> Self {
        let back = self.linear.transpose();
        Self::new(back, -(back * self.translation))
    }

    /// The transform with its origin moved by `step`, in metres along the axes of the child frame:
    /// `self · from_translation(step)`.
    #[inline(always)]
    pub fn shifted(self, step: Vec3<S>) -> Self {
        Self::new(self.linear, self.translation + self.linear * step)
    }
}

impl<S: Scalar> Mul<Vec3<S>> for Affine<S> {
    type Output = Vec3<S>;
    #[inline(always)]
    fn mul(self, point: Vec3<S>) -> Vec3<S> {
        self.linear * point + self.translation
    }
}

impl<S: Scalar> Mul for Affine<S> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        Self::new(self.linear * other.linear, self * other.translation)
    }
}
