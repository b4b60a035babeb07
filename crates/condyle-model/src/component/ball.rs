//! Rotation by an orientation: T = \[R(q) | 0\].
//!
//! The coordinate stores four numbers and has three tangents: with the retraction q ⊕ δ = q·exp(δ)
//! the generators are rotations about the axes of the child, R·x, R·y and R·z.

use super::{Contract, Kind, Mirrored, Port, PortType, Reflection};
use condyle_math::Vec3;

/// A ball joint, without singularities.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Ball;

impl Ball {
    pub(crate) const KIND: Kind =
        Kind { name: "ball", ports: &[Port::one("orientation", PortType::Orientation)] };
}

impl Contract for Ball {
    fn outputs(&self) -> (PortType, usize) {
        (PortType::Transform, 1)
    }

    fn directions(&mut self) -> Vec<(&'static str, &mut Vec3)> {
        vec![]
    }

    fn grow(&mut self, _: f64, _: &[f64]) {}

    fn mirror(&mut self, _: Reflection) -> Result<Mirrored, String> {
        Ok(Mirrored::default())
    }
}
