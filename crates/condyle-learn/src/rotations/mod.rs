//! Rotations of a segment in another from recordings that hold orientations already.
//!
//! | module | from |
//! | --- | --- |
//! | `quaternions` | tables with columns qx, qy, qz, qw |
//! | `sensors` | orientations of inertial sensors in the world |
//! | `posed` | a motion of a model: any segment in any other |
//!
//! Markers give them by a recipe ([`frames`](crate::frames)). All are [`Orientated`](crate::frames::Orientated).

mod posed;
mod quaternions;
mod sensors;

pub use posed::{Pair, segments};
pub use quaternions::{COMPONENTS, in_table, of_table};
pub use sensors::of_sensors;
