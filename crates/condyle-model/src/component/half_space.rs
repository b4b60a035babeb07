//! Scalars inside a [`HalfSpace`]: in posed mode the nearest ones inside, in open mode the scalars as they
//! are and one limit row. The outputs are those that are legal, in the order of the inputs.

use super::{Contract, Geometry, Kind, Port, PortType};
use crate::limit::{HalfSpace, Limit};

impl HalfSpace {
    pub(crate) const KIND: Kind =
        Kind { name: "half_space", ports: &[Port::list("inputs", PortType::Scalar)] };
}

impl Contract for HalfSpace {
    fn outputs(&self) -> (PortType, usize) {
        (PortType::Scalar, self.normal().len())
    }

    fn limit(&self) -> Option<&dyn Limit> {
        Some(self)
    }

    fn geometry(&mut self) -> Vec<Geometry<'_>> {
        vec![]
    }
}
