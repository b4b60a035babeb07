//! Two scalars inside an [`Ellipse`]: in posed mode the nearest ones inside, in open mode the scalars as
//! they are and one limit row. The ports are the two scalars, the outputs those that are legal.

use super::{Contract, Kind, Mirrored, Port, PortType, Reflection};
use crate::limit::{Ellipse, Limit};
use condyle_math::Vec3;

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

    fn directions(&mut self) -> Vec<(&'static str, &mut Vec3)> {
        vec![]
    }

    fn grow(&mut self, _: f64, _: &[f64]) {}

    fn mirror(&mut self, _: Reflection) -> Result<Mirrored, String> {
        Ok(Mirrored::default())
    }
}
