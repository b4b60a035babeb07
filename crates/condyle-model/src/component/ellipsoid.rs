//! Gliding on an ellipsoid: R = Rx(α)·Ry(β)·Rz(γ), and with n = R·z and r the half axes
//!
//! ```text
//! opensim    p = r ∘ n                        (Simbody's ellipsoid mobilizer, and the surface part
//!                                              of the joint of Seth et al. 2016)
//! normal     p = (r ∘ r ∘ n) / |r ∘ n|        (n is the surface's normal at p)
//! ```
//!
//! Both put p on the surface; with equal half axes they are the same. In the first the z axis of
//! the frame is not the surface normal: with half axes of 7, 15 and 7 cm the two differ by up to
//! 21.3 degrees. No kinks. Generator: by dual numbers.

use super::{Law, Signal};
use condyle_math::{Affine, Mat3, Scalar, Vec3};

/// Gliding on an ellipsoid with rotation, like the scapula on the ribs.
#[derive(Clone, Debug, PartialEq)]
pub struct Ellipsoid {
    /// Body-fixed angles about x, y, z in radians.
    pub angles: [Signal; 3],
    /// Half axes in metres.
    pub radii: Vec3,
    /// The meaning of the frame's z axis.
    pub axis: SurfaceAxis,
}

/// The meaning of the z axis of a frame that glides on an ellipsoid.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum SurfaceAxis {
    /// The direction n whose component-wise product with the half axes is the position, as in
    /// OpenSim.
    #[default]
    OpenSim,
    /// The normal of the surface.
    Normal,
}

impl Law for Ellipsoid {
    #[inline]
    fn transform<S: Scalar>(&self, inputs: &[S]) -> Affine<S> {
        let [a, b, c] = [inputs[0], inputs[1], inputs[2]].map(S::sin_cos);
        let rotation = Mat3::identity().rotated_x(a).rotated_y(b).rotated_z(c);
        let stretched = rotation.z.times(self.radii.cast());
        let place = match self.axis {
            SurfaceAxis::OpenSim => stretched,
            SurfaceAxis::Normal => {
                stretched.times(self.radii.cast()) * (S::one() / stretched.norm())
            }
        };
        Affine::new(rotation, place)
    }
}
