//! Joints compared on recordings: how near markers come with a hinge, a planar knee, three rotations about a fixed centre, about the
//! learned one, and with all six coordinates free (Pronost, Sandholm & Thalmann 2010, 4.1, with the arm that they left out).
//!
//! What the [arms](condyle_learn::arms) are is said there. Here they are tracked:
//!
//! - [`Residuals::of`] tracks a recording with an arm: per frame the root mean square over markers and the largest distance. A frame in which a
//!   segment shows fewer than three of its markers says nothing of a joint and is counted for no arm;
//! - [`compare`] learns for each trial from others, never from what it is asked about, and tracks that trial with every arm
//!   ([`Question`] tells which others);
//! - [`markdown`] and [`csv`] are the tables.
//!
//! | module | what |
//! | --- | --- |
//! | `residuals` | one trial with one arm |
//! | `person` | trials of one person, tracked with the free joint |
//! | `best` | the constant centre that leaves the least at markers |
//! | `compared` | what is learned from what, and asked about what |
//! | `sums` | trials of a kind together, and the gains of one arm over another |
//! | `table` | Markdown and CSV |

mod best;
mod compared;
mod person;
mod residuals;
mod sums;
mod table;

pub(super) use best::{Seen, best};
pub use compared::{Compared, How, Part, Question, compare};
pub use person::{Person, Trial};
pub use residuals::Residuals;
pub use sums::{Gain, Gains, Group, Sum, gains, groups};
pub use table::{csv, markdown};
