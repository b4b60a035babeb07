//! Two scalars inside an [`Ellipse`]: in posed mode the nearest ones inside, in open mode the scalars as
//! they are and one limit row. The ports are the two scalars, the outputs those that are legal.

use super::{Contract, Geometry, Kind, Port, PortType};
use crate::limit::{Ellipse, Limit};

impl Ellipse {
    pub(crate) const KIND: Kind = Kind {
        name: "ellipse",
        ports: &[Port::one("first", PortType::Scalar), Port::one("second", PortType::Scalar)],
    };
}

impl Contract for Ellipse {
    fn outputs(&self) -> (PortType, usize) {
        (PortType::Scalar, 2)
    }

    fn limit(&self) -> Option<&dyn Limit> {
        Some(self)
    }

    fn geometry(&mut self) -> Vec<Geometry<'_>> {
        vec![]
    }
}
