//! Product of transforms: T = T₁·T₂·…·Tₙ (Shao & Ng-Thow-Hing 2003, section 4.1).
//!
//! The first factor is nearest to the parent. Generators: those of each factor, transformed by the
//! product of the factors before it.

use super::{Contract, Geometry, Kind, Port, PortType};

/// A product of motions, the factor nearest to the parent first.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Product;

impl Product {
    pub(crate) const KIND: Kind =
        Kind { name: "product", ports: &[Port::list("factors", PortType::Transform)] };
}

impl Contract for Product {
    fn geometry(&mut self) -> Vec<Geometry<'_>> {
        vec![]
    }
}
