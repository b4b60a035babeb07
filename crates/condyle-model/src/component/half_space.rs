//! Scalars inside a [`HalfSpace`]: in posed mode the nearest ones inside, in open mode the scalars as they
//! are and one limit row. The outputs are those that are legal, in the order of the inputs.

use super::{Contract, Kind, Mirrored, Port, PortType, Reflection};
use crate::limit::{HalfSpace, Limit};
use condyle_math::Vec3;

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

    fn directions(&mut self) -> Vec<(&'static str, &mut Vec3)> {
        vec![]
    }

    fn grow(&mut self, _: f64, _: &[f64]) {}

    fn mirror(&mut self, _: Reflection) -> Result<Mirrored, String> {
        Ok(Mirrored::default())
    }
}
