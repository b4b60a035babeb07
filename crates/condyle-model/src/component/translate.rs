//! Translation along a fixed axis: T = \[I | d·a\].
//!
//! Generator: (0, a).

use super::{Contract, Geometry, Kind, Port, PortType};
use condyle_math::Vec3;

/// A slider: translation by one distance along one axis.
#[derive(Clone, Debug, PartialEq)]
pub struct Translate {
    /// The axis; it is normalised when the model is built.
    pub axis: Vec3,
}

impl Translate {
    pub(crate) const KIND: Kind =
        Kind { name: "translate", ports: &[Port::one("distance", PortType::Scalar)] };
}

impl Contract for Translate {
    fn geometry(&mut self) -> Vec<Geometry<'_>> {
        vec![Geometry::Direction("axis", &mut self.axis)]
    }
}
