//! From bytes to lines, cells and numbers, for every text format.

#[cfg(any(feature = "document", feature = "glb", feature = "surfaces"))]
pub(crate) mod base64;
mod decode;
mod line;
mod names;
mod number;
mod row;

pub use decode::{MAX_TEXT_BYTES, decode, utf8};
pub(crate) use decode::{check_size, read_decoded};
#[cfg(any(feature = "opensim", feature = "urdf"))]
pub(crate) use line::column_at;
pub(crate) use line::{Line, Lines, last_line, lines};
pub(crate) use names::distinct;
pub use number::{cell, number};
pub(crate) use number::{decimal, plain, unquoted, with_comma};
pub(crate) use row::{Row, is_blank};
