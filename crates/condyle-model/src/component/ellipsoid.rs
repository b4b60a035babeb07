//! Gliding on an ellipsoid: R = Rx(α)·Ry(β)·Rz(γ), p = radii ∘ (R·z).
//!
//! The frame's z axis is the surface normal only where the radii are equal: this is the
//! parametrisation named `opensim` (Simbody's ellipsoid mobilizer, and the surface part of the
//! scapulothoracic joint of Seth et al. 2016). With radii of 7, 15 and 7 cm the axis and the normal
//! differ by up to 21.3 degrees.

use super::{Law, Source};
use condyle_math::{Affine, Mat3, Scalar, Vec3};

/// A bone that glides on an ellipsoid while it turns, as the scapula does on the ribs.
#[derive(Clone, Debug, PartialEq)]
pub struct Ellipsoid {
    /// Body-fixed angles about x, y, z in radians.
    pub angles: [Source; 3],
    /// Half axes in metres.
    pub radii: Vec3,
}

impl Law for Ellipsoid {
    #[inline]
    fn transform<S: Scalar>(&self, inputs: &[S]) -> Affine<S> {
        let [a, b, c] = [inputs[0], inputs[1], inputs[2]].map(S::sin_cos);
        let rotation = Mat3::identity().rotated_x(a).rotated_y(b).rotated_z(c);
        Affine::new(rotation, rotation.z.times(self.radii.cast()))
    }
}
