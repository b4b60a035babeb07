//! A segment that keeps its orientation while ancestors rotate (Shao & Ng-Thow-Hing 2003, section
//! 4.3).
//!
//! Let the segments on the path from the topmost named ancestor down to the segment's parent have
//! the rotations Bᵢ·Rᵢ·Bᵢ′, with fixed frames before and after each motion Rᵢ. With A their
//! product, and A′ the same product with Rᵢ^(1-w) in place of Rᵢ for every named ancestor, the
//! rotation
//!
//! ```text
//! C = A⁻¹·A′
//! ```
//!
//! in the parent's frame cancels the fraction w of the named motions. It is a rotation about the
//! segment's own joint, so the segment stays attached. Motions of ancestors that are not named, and
//! the motion of the segment's own joint, are not changed. The output is F⁻¹·C·F with F the joint
//! frame in the parent: it is the first factor, before the segment's own motion.
//!
//! Discontinuous for a weight between 0 and 1, where a named motion reaches a half turn.

use super::{Contract, Fault, Geometry, Kind, Port, PortType};

use condyle_diagnostics::Severity;

/// The rotation that cancels those of named ancestors: for example an arm that keeps hanging while
/// the shoulder shrugs.
///
/// Its ports are the segment to whose joint the output applies, and the ancestors whose rotations are
/// cancelled, of any joint sets.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Compensate {
    /// The fraction of their rotations that is cancelled, from 0 to 1.
    pub weight: f64,
}

impl Compensate {
    pub(crate) const KIND: Kind = Kind {
        name: "compensate",
        ports: &[Port::one("segment", PortType::Joint), Port::list("ancestors", PortType::Joint)],
    };
}

impl Contract for Compensate {
    fn faults(&self) -> Vec<Fault> {
        if (0.0..=1.0).contains(&self.weight) {
            return vec![];
        }
        vec![Fault {
            severity: Severity::Error,
            code: "model/weight",
            said: format!("has the weight {}", self.weight),
            help: "give a weight from 0 (nothing is undone) to 1 (all is)",
        }]
    }

    fn geometry(&mut self) -> Vec<Geometry<'_>> {
        vec![]
    }
}
