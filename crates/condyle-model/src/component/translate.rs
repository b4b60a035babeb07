//! Translation along a fixed axis: T = \[I | d·a\].
//!
//! Generator: (0, a).

use super::{Contract, Kind, Mirrored, Port, PortType, Reflection};
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
    fn outputs(&self) -> (PortType, usize) {
        (PortType::Transform, 1)
    }

    fn directions(&mut self) -> Vec<(&'static str, &mut Vec3)> {
        vec![("axis", &mut self.axis)]
    }

    fn grow(&mut self, _: f64, _: &[f64]) {}

    fn mirror(&mut self, at: Reflection) -> Result<Mirrored, String> {
        self.axis = at.point(self.axis);
        Ok(Mirrored::default())
    }
}
