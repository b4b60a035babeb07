//! How mobile a joint is: the reachable set of rotations in numbers, and two of them compared.
//!
//! | module | what |
//! | --- | --- |
//! | `extent` | share of all rotations, how far it goes about an axis, the largest angle |
//! | `system` | the same in angles of a joint coordinate system, with the measure and without |
//! | `resampled` | between what bounds the share lies, from takes left out in turn |
//! | `thin` | where samples are sparse or absent: what to record next |
//! | `words` | a rotation as plane, elevation and twist of a bone |
//! | `compared` | what two limits have in common, and how far one goes beyond the other |
//!
//! Shares are of all rotations, by Haar's measure, so they depend on no axes and no order of angles; volumes of boxes of Euler
//! angles do (Manafzadeh & Gatesy 2022).

mod compared;
mod extent;
mod resampled;
mod system;
mod thin;
mod words;

pub use compared::{Beyond, Compared, compared};
pub use extent::{Extent, about, largest_angle, middle, share, twists};
pub use resampled::{Interval, interval};
pub use system::{InSystem, in_system};
pub use thin::{Thin, thin};
pub use words::{Placed, placed};
