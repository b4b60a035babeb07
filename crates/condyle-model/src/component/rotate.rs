//! Rotation about a fixed axis through the origin: T = \[R(a, θ) | 0\].
//!
//! Generator: (a, 0). For an axis through another point, put a [`Place`](super::Place) before it
//! and its inverse after it.

use super::{Contract, Geometry, Kind, Port, PortType};
use condyle_math::Vec3;

/// A hinge: rotation by one angle about one axis.
#[derive(Clone, Debug, PartialEq)]
pub struct Rotate {
    /// The axis; it is normalised when the model is built.
    pub axis: Vec3,
}

impl Rotate {
    pub(crate) const KIND: Kind =
        Kind { name: "rotate", ports: &[Port::one("angle", PortType::Scalar)] };
}

impl Contract for Rotate {
    fn geometry(&mut self) -> Vec<Geometry<'_>> {
        vec![Geometry::Turning("axis", &mut self.axis)]
    }
}
