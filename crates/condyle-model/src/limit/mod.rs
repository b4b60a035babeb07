//! What a joint cannot do.
//!
//! A limit answers two questions of coordinates: by how much are they inside (negative outside),
//! and which legal ones are nearest. In posed mode the nearest legal ones are used; in open mode
//! the coordinates pass unchanged and the answer to the first question becomes rows g(q) ≥ 0 for a
//! solver.
//!
//! A [`Range`] limits one coordinate; a [`Cone`] limits a ball joint's rotation, its direction and
//! its twist together.

mod cone;
mod range;

pub use cone::{Cone, ConeError, ConePoint, Legal, Projected, Projection};
pub use range::Range;
