//! TRC, the marker recordings of Motion Analysis.
//!
//! The grammar, as found in existing files:
//!
//! ```text
//! file      = [ "PathFileType" ... ] line
//!             keys line                     DataRate  CameraRate  NumFrames  NumMarkers  Units  ...
//!             values line                   100.00    100.00      184        28          mm     ...
//!             "Frame#" "Time" labels line   one name per marker, two blank cells after each
//!             [ axes line ]                 X1 Y1 Z1 X2 ...
//!             { [ row ] line }
//! row       = frame time { x y z }          blank or NaN: the marker was not seen
//! ```
//!
//! Cells are separated by tabs; in a line without any tab by spaces. How dialects are read:
//!
//! - Labels are taken **by order**, never by tab position: OpenSim once wrote one tab too many
//!   (`Time\t\tSternum`). Axis names are not looked at, so they may start at X5.
//! - Header keys are found by name; `OrigDataRate` and its friends may be missing. `NumFrames`
//!   and `NumMarkers` are often wrong: the rows and the labels rule, with a warning.
//! - A marker with a blank, NaN or infinite coordinate was not seen. `0 0 0` is a place like any
//!   other unless [`Dialect::zero_is_missing`] says otherwise.
//! - A row that ends early leaves its last markers unseen, with a warning. Whole markers beyond
//!   the last name are skipped, with a warning, if the first row has them too; any other cell too
//!   many is an error.
//! - Of two markers with one name the second becomes `name#2`, with a warning.
//! - An unknown or blank unit is guessed from the size of the data, with a warning.
//! - Repeated times are a warning, decreasing times an error.

mod header;
mod read;
mod write;

pub use read::{Dialect, from_bytes, read, read_with};
pub use write::write;
