//! STO and MOT, the tables of OpenSim and of SIMM before it.
//!
//! ```text
//! file   = { header line }  "endheader"  { blank line }  names  { row }
//! header = key "=" value  |  SIMM key  value  |  title  |  any other text
//! names  = "time" { name }
//! ```
//!
//! Cells are separated by tabs; where the line of names has none, by commas or by spaces.
//! How dialects are read:
//!
//! - `inDegrees=yes|no`, in any case, gives the unit of rotations. A header with the keys of SIMM
//!   (`datacolumns`, `datarows`, `otherdata`, `range`) and without `inDegrees` means degrees, as
//!   does the sentence `Angles are in degrees`. Otherwise the unit is
//!   [`Unstated`](crate::AngleUnit::Unstated). Where the two
//!   contradict each other the key decides, with a warning.
//! - Cells of several numbers (`DataType=Vec3`, `Quaternion`) become columns `name_1`, `name_2`,
//!   ... in the order of the file (OpenSim's quaternions are w, x, y, z), with a warning.
//! - Blank cells and rows that end early are NaN; a row with too many cells is an error.
//! - Wrong counts in the header are a warning: the actual rows and names are used.
//! - Repeated times are a warning, decreasing times an error; two columns with the same name are an
//!   error.

mod header;
mod read;
mod write;

pub use read::{from_bytes, read};
pub use write::{head, rows, write};
