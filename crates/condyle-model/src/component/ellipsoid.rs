//! Gliding on an ellipsoid: R = Rx(α)·Ry(β)·Rz(γ), and with n = R·z and r the half axes
//!
//! ```text
//! opensim    p = r ∘ n                        (Simbody's ellipsoid mobilizer, and the surface part
//!                                              of the joint of Seth et al. 2016)
//! normal     p = (r ∘ r ∘ n) / |r ∘ n|        (n is the surface's normal at p)
//! ```
//!
//! Both put p on the surface; with equal half axes they are one. In the first the frame's z axis is
//! not the normal: with half axes of 7, 15 and 7 cm the two differ by up to 21.3 degrees, so a turn
//! about z is a glide with a tilt. No kinks. Generator: by dual numbers.

use super::{Law, Source};
use condyle_math::{Affine, Mat3, Scalar, Vec3};

/// A bone that glides on an ellipsoid while it turns, as the scapula does on the ribs.
#[derive(Clone, Debug, PartialEq)]
pub struct Ellipsoid {
    /// Body-fixed angles about x, y, z in radians.
    pub angles: [Source; 3],
    /// Half axes in metres.
    pub radii: Vec3,
    /// What the frame's z axis is.
    pub axis: SurfaceAxis,
}

/// What the z axis of a frame that glides on an ellipsoid is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum SurfaceAxis {
    /// The direction whose product with the half axes is the place: OpenSim's reading.
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
