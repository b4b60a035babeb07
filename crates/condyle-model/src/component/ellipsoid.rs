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

use super::{Contract, Geometry, Kind, Mirrored, MotionLaw, Port, PortType, Reflection};
use condyle_math::{Affine, Mat3, Scalar, Vec3};
use std::f64::consts::PI;

/// Gliding on an ellipsoid with rotation, like the scapula on the ribs.
#[derive(Clone, Debug, PartialEq)]
pub struct Ellipsoid {
    /// Half axes in metres.
    pub radii: Vec3,
    /// The meaning of the frame's z axis.
    pub axis: SurfaceAxis,
}

impl Ellipsoid {
    pub(crate) const KIND: Kind = Kind {
        name: "ellipsoid",
        ports: &[
            Port::one("about_x", PortType::Scalar),
            Port::one("about_y", PortType::Scalar),
            Port::one("about_z", PortType::Scalar),
        ],
    };
}

impl Contract for Ellipsoid {
    fn geometry(&mut self) -> Vec<Geometry<'_>> {
        let Vec3 { x, y, z } = &mut self.radii;
        let axes = [Vec3::X, Vec3::Y, Vec3::Z];
        [x, y, z].into_iter().zip(axes).map(|(r, axis)| Geometry::Length(r, axis)).collect()
    }

    fn mirror(&mut self, at: Reflection) -> Result<Mirrored, String> {
        // At z the pole is reversed: D·Rx(a)·Ry(b)·Rz(c)·D = Rx(π-a)·Ry(b)·Rz(-c)·Rx(π).
        let half_turn = Affine::from_rotation(Mat3::from_columns(Vec3::X, -Vec3::Y, -Vec3::Z));
        let (signs, lead, after) = match at.axis() {
            0 => ([1.0, -1.0, -1.0], 0.0, None),
            1 => ([-1.0, 1.0, -1.0], 0.0, None),
            _ => ([-1.0, 1.0, -1.0], PI, Some(half_turn)),
        };
        let [x, y, z] = signs;
        Ok(Mirrored { inputs: vec![[x, lead], [y, 0.0], [z, 0.0]], after })
    }
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

impl MotionLaw for Ellipsoid {
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
