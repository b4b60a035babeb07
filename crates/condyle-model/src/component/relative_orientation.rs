//! The orientation of a segment in another: R = R_referenceᵀ·R_segment.
//!
//! For example of the humerus in the thorax, through clavicle and scapula that move between them. It can
//! go to a [`Cone`](crate::limit::Cone) or to [`Angles`](super::Angles), which then bound or read what no
//! single coordinate holds. Limits on it give their rows in both modes and move nothing.
//!
//! Along a direction with the angular velocity ω of the segment in the reference, the three tangents of
//! q ⊕ δ = q·exp(δ) change by Rᵀ·ω. No kinks; q and -q are one orientation.

use super::{Contract, Geometry, Kind, Port, PortType};

/// The orientation of a `segment` in a `reference` segment, or in the world.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RelativeOrientation {
    /// Whether there is a reference segment; else it is in the world.
    pub reference: bool,
}

impl RelativeOrientation {
    pub(crate) const KIND: Kind = Kind {
        name: "relative_orientation",
        ports: &[
            Port::one("segment", PortType::Segment),
            Port::perhaps("reference", PortType::Segment),
        ],
    };
}

impl Contract for RelativeOrientation {
    fn has(&self, port: &Port) -> bool {
        self.reference || port.name != "reference"
    }

    fn outputs(&self) -> (PortType, usize) {
        (PortType::Orientation, 1)
    }

    fn geometry(&mut self) -> Vec<Geometry<'_>> {
        vec![]
    }
}
