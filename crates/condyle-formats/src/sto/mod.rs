//! STO and MOT, the tables of OpenSim and of SIMM before it.
//!
//! ```text
//! file   = { header line }  "endheader"  { blank line }  names  { row }
//! header = key "=" value  |  SIMM key  value  |  title  |  any other text
//! names  = "time" { name }
//! ```
//!
//! Cells are separated by tabs; where the line of names has none, by semicolons, commas or spaces. They may
//! be quoted.
//! How dialects are read:
//!
//! - `inDegrees=yes|no`, in any case, gives the unit of rotations. A header with the keys of SIMM
//!   (`datacolumns`, `datarows`, `otherdata`, `range`) and without `inDegrees` means degrees, as
//!   does the sentence `Angles are in degrees`. Otherwise the unit is
//!   [`Unstated`](crate::AngleUnit::Unstated). Where the two
//!   contradict each other the key decides, with a warning.
//! - Cells of several numbers (`DataType=Vec3`, `Quaternion`) become columns `name_1`, `name_2`,
//!   ... in the order of the file (OpenSim's quaternions are w, x, y, z), with a warning.
//! - Blank cells, words for a missing value ([`cell`](crate::text::cell)) and rows that end early are NaN; a
//!   row with too many cells is an error.
//! - Where all cells with a comma are one number each, and no vectors are stated, commas are decimal
//!   separators, with a warning.
//! - Numbers of a first column without a name are taken as the times, with a warning; numbers where the
//!   names should be are an error.
//! - Wrong counts in the header are a warning: the actual rows and names are used.
//! - Repeated times are a warning, decreasing times an error; of two columns with one name the
//!   second becomes `name#2`, with a warning.

mod header;
mod read;
mod write;

pub use read::{from_bytes, read};
pub use write::{head, rows, write};
