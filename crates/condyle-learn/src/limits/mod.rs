//! Limits of joints learned from orientations that people took.
//!
//! | module | what |
//! | --- | --- |
//! | [`Cloud`] | rotations of one segment in another, gathered from recordings and thinned |
//! | [`engine`] | the nearest cone with twist and the nearest reach cone, for game and robot engines |
//! | [`field`] | the default method: signed geodesic distance to the closing of a cloud by empty balls |
//! | [`dependent`] | limits that depend on another joint: the same at values of a driver |
//! | [`herda2003`] | spheres in the vector part of quaternions, after Herda, Urtasun, Fua & Hanson 2003: the baseline |
//! | [`left_out()`] | how far a limit goes beyond recordings, from takes that are left out |
//! | [`mobility`] | volume, extent, thin regions, and what two limits have in common |

mod cloud;
pub mod engine;
pub mod field;
pub mod herda2003;
mod left_out;
pub mod mobility;
mod principal;
mod spread;
mod uniform;

pub use cloud::{Cloud, Gathered, SPACING};
pub use field::dependent;
pub use field::{About, Answer, Field, LearnedLimit, Settings, State, learn};
pub use left_out::{COVER, LeftOut, independent, left_out, percentile};
pub use uniform::uniform;
