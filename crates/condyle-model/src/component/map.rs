//! One scalar to several: yᵢ = fᵢ(x) (Shao & Ng-Thow-Hing 2003, section 4.2).

use super::{Contract, Kind, Mirrored, Port, PortType, Reflection};
use condyle_math::Vec3;
use condyle_math::function::Function;

/// One scalar that drives several: for example a flexion angle that moves the tibia by three
/// functions.
#[derive(Clone, Debug, PartialEq)]
pub struct Map {
    /// One function for each output.
    pub functions: Vec<Function>,
}

impl Map {
    pub(crate) const KIND: Kind =
        Kind { name: "map", ports: &[Port::one("input", PortType::Scalar)] };
}

impl Contract for Map {
    fn outputs(&self) -> (PortType, usize) {
        (PortType::Scalar, self.functions.len())
    }

    fn directions(&mut self) -> Vec<(&'static str, &mut Vec3)> {
        vec![]
    }

    fn grow(&mut self, _: f64, _: &[f64]) {}

    fn mirror(&mut self, _: Reflection) -> Result<Mirrored, String> {
        Ok(Mirrored::default())
    }
}
