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
//! Cells are separated by tabs; in a line without any tab by spaces; by commas or semicolons where the line
//! of keys is. They may be quoted. How dialects are read:
//!
//! - Labels are taken **by order**, never by tab position: OpenSim once wrote one tab too many
//!   (`Time\t\tSternum`). Axis names are not looked at, so they may start at X5. Named columns before
//!   the first axis, such as `Timestamp`, are no markers and are not read, with a warning.
//! - Rows that stand a cell or two beside their names, behind blank cells or a time stamp, are found by
//!   their length and their times, with a warning.
//! - Header keys are found by name, their values by column or, with blank cells between them, by order;
//!   `OrigDataRate` and its friends may be missing. `NumFrames`
//!   and `NumMarkers` are often wrong: the rows and the labels rule, with a warning.
//! - A marker with a coordinate that is blank, NaN, infinite or one of the words for a missing value
//!   ([`cell`](crate::text::cell)) was not seen. `0 0 0` is a place like any other:
//!   [`Recording::settle_zeros`](crate::Recording::settle_zeros) tells what it means.
//! - A row that ends early leaves its last markers unseen, with a warning. Whole markers beyond
//!   the last name are skipped, with a warning; any other cell too many is an error.
//! - Of two markers with one name the second becomes `name#2`, with a warning.
//! - An unknown or blank unit is guessed from the size of the data, with a warning; a size that may be
//!   that of a body in centimetres or of a hand in millimetres is an error.
//! - Repeated times are a warning, decreasing times an error. Where times and DataRate disagree the times
//!   are used, with a warning; 25 times apart and more, or the numbers of frames as times, is an error
//!   unless frames were left out.

mod header;
mod layout;
mod read;
mod write;

pub use read::{from_bytes, read};
pub use write::{write, write_with_remarks};
