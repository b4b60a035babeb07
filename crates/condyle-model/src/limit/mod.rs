//! Joint limits.
//!
//! For given coordinates a limit computes their distance from the boundary (negative outside) and
//! the nearest legal coordinates. In posed mode the nearest legal coordinates are used. In open
//! mode the coordinates pass unchanged, and the distances are inequality rows g(q) ≥ 0 for a
//! solver.
//!
//! A [`Range`] limits one coordinate; a [`Cone`] limits swing and twist of a ball joint together.

mod cone;
mod range;

pub use cone::{Cone, ConeError, ConePoint, Legal, Projected, Projection};
pub use range::Range;
