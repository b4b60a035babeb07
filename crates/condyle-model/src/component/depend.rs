//! One angle bounded by another (Shao & Ng-Thow-Hing 2003, section 4.5).
//!
//! ```text
//! y = x            where  lower(d) ≤ x ≤ upper(d)
//! y = lower(d)     below, y = upper(d) above
//! ```
//!
//! for a passive angle x and a driver d; a missing bound does not bound. (The source's one-to-one
//! dependency, where both bounds are one function, is a [`Map`](super::Map).)
//!
//! In posed mode the passive angle is held, and where the bounds cross the upper one rules. In open
//! mode it passes unchanged, and the two sides are rows x - lower(d) ≥ 0 and upper(d) - x ≥ 0 for a
//! solver. Kinks: in posed mode, where a bound begins to hold.

use super::Source;
use condyle_math::function::Function;

/// A passive angle that may move only as far as a driver lets it: a clavicle under a lifted arm.
#[derive(Clone, Debug, PartialEq)]
pub struct Depend {
    /// The angle that is held.
    pub passive: Source,
    /// The angle that decides.
    pub driver: Source,
    /// Least value of the passive angle, as a function of the driver.
    pub lower: Option<Function>,
    /// Largest value of the passive angle, as a function of the driver.
    pub upper: Option<Function>,
}
