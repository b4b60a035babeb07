//! Where a point of a segment is in another: sᵢ = nᵢ·(T·p), with T the segment in the reference, p the
//! point, and nᵢ directions of the reference.
//!
//! One number for each direction, such as the distance of the medial border of a scapula from the plane
//! through the middle of the thorax: one direction, normal to the plane. Limits on it give their rows in
//! both modes and move nothing. No kinks.

use super::{Contract, Fault, Geometry, Kind, Port, PortType};
use condyle_diagnostics::Severity;
use condyle_math::Vec3;

/// The coordinates of a point of a `segment` along directions of a `reference` segment, or of the world.
#[derive(Clone, Debug, PartialEq)]
pub struct RelativePosition {
    /// Whether there is a reference segment; else it is in the world.
    pub reference: bool,
    /// The point, in the frame of its segment, in metres.
    pub point: Vec3,
    /// The directions, in the frame of the reference; they are normalised when the model is built.
    pub along: Vec<Vec3>,
}

impl RelativePosition {
    pub(crate) const KIND: Kind = Kind {
        name: "relative_position",
        ports: &[
            Port::one("segment", PortType::Segment),
            Port::perhaps("reference", PortType::Segment),
        ],
    };
}

impl Contract for RelativePosition {
    fn has(&self, port: &Port) -> bool {
        self.reference || port.name != "reference"
    }

    fn faults(&self) -> Vec<Fault> {
        if !self.along.is_empty() && self.point.is_finite() {
            return vec![];
        }
        vec![Fault {
            severity: Severity::Error,
            code: "model/measure",
            said: "measures nothing".to_owned(),
            help: "give a finite point and one direction or more",
        }]
    }

    fn outputs(&self) -> (PortType, usize) {
        (PortType::Scalar, self.along.len())
    }

    fn geometry(&mut self) -> Vec<Geometry<'_>> {
        let along = self.along.iter_mut().map(|along| Geometry::Direction("along", along));
        [Geometry::Point(&mut self.point)].into_iter().chain(along).collect()
    }
}
