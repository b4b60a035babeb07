//! C3D, the binary recordings of most laboratories: markers, analog channels, events, force platforms.
//!
//! ```text
//! file       = header, parameters, frames       in blocks of 512 bytes
//! header     = the block of the parameters, 0x50, counts, scale, the block of the frames, rate, events
//! parameters = 4 bytes (the last says which processor), { group | parameter }, 0
//! frame      = { x y z word } { samples of all channels }
//! ```
//!
//! What is read, and how it is repaired:
//!
//! - Files of three processors, with floats or whole numbers. Counts, scale and place of the data are stated
//!   in several places, which often disagree: those are used that fill the file, with a warning. A file that
//!   is cut off gives the frames that are there.
//! - A marker is missing where its fourth word is negative or one of its numbers is none. `0 0 0` is a place
//!   like any other: [`Recording::settle_zeros`](crate::Recording::settle_zeros) tells what it means.
//! - Points that `POINT:ANGLES`, `FORCES`, `MOMENTS`, `POWERS` and `SCALARS` list are no markers: they
//!   are kept in their own unit ([`Other`]).
//! - The unit of length is `POINT:UNITS`; without a known one it is told by the size of the data, as for TRC.
//! - Up is the direction in which force platforms are flat, else `POINT:Y_SCREEN`, else that in which alone
//!   the markers never leave a floor at zero; markers are turned so that y is up ([`Up`]).
//! - Of two points with one name the second becomes `name#2`; one without a name is `unnamed`.
//! - A chain of parameters that is broken goes on at the next place that looks like one.
//! - The first frame is at its number minus one over the rate, on the clock of the events.
//!
//! What is written: floats in Intel's order, all parameters as they were read, those that describe the data as they
//! are. Reading a written file gives the same [`Trial`] but for how it was stored.

mod analog;
mod bytes;
mod event;
mod header;
mod layout;
mod parameters;
mod platform;
mod read;
mod section;
mod trial;
mod upkeep;
mod vertical;
mod write;

pub use analog::{Analog, Channel};
pub use bytes::Processor;
pub use event::{Event, Origin};
pub use parameters::{Group, Parameter, Parameters, Values};
pub use platform::Platform;
pub use read::from_bytes;
pub(crate) use read::is_c3d;
pub use trial::{Column, Kind, Other, Storage, Trial};
pub use vertical::Up;
pub use write::write;
