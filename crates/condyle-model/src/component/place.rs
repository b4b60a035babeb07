//! A fixed transform: T = const.

use super::{Contract, Kind, Mirrored, PortType, Reflection};
use condyle_math::{Affine, Vec3};

/// A fixed transform, such as an oblique joint axis or a shifted centre.
#[derive(Clone, Debug, PartialEq)]
pub struct Place {
    /// The child frame in its parent.
    pub child_in_parent: Affine,
}

impl Place {
    pub(crate) const KIND: Kind = Kind { name: "place", ports: &[] };
}

impl Contract for Place {
    fn outputs(&self) -> (PortType, usize) {
        (PortType::Transform, 1)
    }

    fn directions(&mut self) -> Vec<(&'static str, &mut Vec3)> {
        vec![]
    }

    fn grow(&mut self, joint: f64, _: &[f64]) {
        let place = &mut self.child_in_parent.translation;
        *place = *place * joint;
    }

    fn mirror(&mut self, at: Reflection) -> Result<Mirrored, String> {
        self.child_in_parent = at.frame(self.child_in_parent);
        Ok(Mirrored::default())
    }
}
