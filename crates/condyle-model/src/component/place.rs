//! A fixed transform: T = const.

use super::{Contract, Geometry, Kind};
use condyle_math::Affine;

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
    fn geometry(&mut self) -> Vec<Geometry<'_>> {
        vec![Geometry::Frame(&mut self.child_in_parent)]
    }
}
