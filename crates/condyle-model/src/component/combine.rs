//! Several scalars to one: y = f(x₁, …, xₙ).

use super::{Contract, Geometry, Kind, Port, PortType};
use condyle_math::function::FunctionOfSeveral;

/// One scalar as a function of several: for example the flexion of a vertebra from the three angles
/// of the trunk.
#[derive(Clone, Debug, PartialEq)]
pub struct Combine {
    /// The function, of as many arguments as there are inputs.
    pub function: FunctionOfSeveral,
}

impl Combine {
    pub(crate) const KIND: Kind =
        Kind { name: "combine", ports: &[Port::list("inputs", PortType::Scalar)] };
}

impl Contract for Combine {
    fn takes(&self) -> Option<usize> {
        Some(self.function.arity())
    }

    fn outputs(&self) -> (PortType, usize) {
        (PortType::Scalar, 1)
    }

    fn geometry(&mut self) -> Vec<Geometry<'_>> {
        vec![]
    }
}
