//! One angle bounded by another (Shao & Ng-Thow-Hing 2003, section 4.5).
//!
//! ```text
//! y = x            where  lower(d) ≤ x ≤ upper(d)
//! y = lower(d)     below, y = upper(d) above
//! ```
//!
//! for a passive angle x and a driver d; each bound is optional. (The one-to-one dependency of the
//! paper, where both bounds are the same function, is a [`Map`](super::Map).)
//!
//! In posed mode the passive angle is clamped; where the bounds cross, the upper one takes
//! precedence. In open mode it passes unchanged, and the bounds are limit rows x - lower(d) ≥ 0 and
//! upper(d) - x ≥ 0 for a solver. Kinks: in posed mode, where a bound becomes active.

use super::{Contract, Geometry, Kind, Port, PortType};
use condyle_math::function::Function;

/// A passive angle whose bounds are functions of a driver: for example the elevation of the
/// clavicle, bounded by that of the arm.
#[derive(Clone, Debug, PartialEq)]
pub struct Depend {
    /// Smallest value of the passive angle, as a function of the driver.
    pub lower: Option<Function>,
    /// Largest value of the passive angle, as a function of the driver.
    pub upper: Option<Function>,
}

impl Depend {
    pub(crate) const KIND: Kind = Kind {
        name: "depend",
        ports: &[Port::one("passive", PortType::Scalar), Port::one("driver", PortType::Scalar)],
    };
}

impl Contract for Depend {
    fn outputs(&self) -> (PortType, usize) {
        (PortType::Scalar, 1)
    }

    fn geometry(&mut self) -> Vec<Geometry<'_>> {
        vec![]
    }
}
