//! One scalar to several: yᵢ = fᵢ(x) (Shao & Ng-Thow-Hing 2003, section 4.2).

use super::{Contract, Geometry, Kind, Port, PortType};
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

    fn geometry(&mut self) -> Vec<Geometry<'_>> {
        vec![]
    }
}
