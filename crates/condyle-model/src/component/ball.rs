//! Rotation by an orientation: T = \[R(q) | 0\].
//!
//! The coordinate stores four numbers and has three tangents: with the retraction q ⊕ δ = q·exp(δ)
//! the generators are rotations about the axes of the child, R·x, R·y and R·z.

use super::{Contract, Geometry, Kind, Port, PortType};

/// A ball joint, without singularities.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Ball;

impl Ball {
    pub(crate) const KIND: Kind =
        Kind { name: "ball", ports: &[Port::one("orientation", PortType::Orientation)] };
}

impl Contract for Ball {
    fn geometry(&mut self) -> Vec<Geometry<'_>> {
        vec![]
    }
}
