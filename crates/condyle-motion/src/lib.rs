//! Values of a body over time, independent of file formats.
//!
//! | type | what |
//! | --- | --- |
//! | [`Recording`] | marker positions, frame by frame |
//! | [`Orientations`] | orientations of inertial sensors, frame by frame |
//! | [`Table`] | columns of numbers by name, as a file has them: a motion of no stated model |
//! | [`Motion`] | the coordinates of one model, frame by frame |
//! | [`Animation`] | a model and a motion of it, as files of skeletons hold both |
//! | [`Keys`] | poses at given times, and the motion between them |
//! | [`Posture`] | the coordinates of one model at one time, set and read by coordinate |
//!
//! In memory, lengths are in metres, angles in radians, times in seconds; other units of a file are
//! recorded as [`LengthUnit`] and [`AngleUnit`]. [`columns`] assigns columns to coordinates,
//! [`difference`] compares two motions, [`upkeep`] filters, fills, resamples and cuts.

mod angles;
mod animation;
pub mod columns;
pub mod difference;
pub mod keypoint;
mod keys;
mod length_unit;
mod marker_table;
mod motion;
mod orientations;
mod posture;
mod recording;
mod sample;
mod subjects;
mod table;
pub mod upkeep;
mod virtual_markers;
mod zeros;

pub use animation::Animation;
pub use keys::{Interpolation, Keys};
pub use length_unit::LengthUnit;
pub use motion::{BLANK, Motion};
pub use orientations::Orientations;
pub use posture::Posture;
pub use recording::{Gap, Observed, Recording};
pub use sample::{Between, between};
pub use table::{AngleUnit, Table};
pub use zeros::Zeros;
