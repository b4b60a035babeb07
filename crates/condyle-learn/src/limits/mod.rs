//! Limits of joints learned from orientations that people took.
//!
//! | module | what |
//! | --- | --- |
//! | [`Cloud`] | rotations of one segment in another, gathered from recordings and thinned |
//! | [`field`] | the default method: signed geodesic distance to the closing of a cloud by empty balls |
//! | [`herda2003`] | spheres in the vector part of quaternions, after Herda, Urtasun, Fua & Hanson 2003: the baseline |

mod cloud;
pub mod field;
pub mod herda2003;
mod principal;
mod spread;

pub use cloud::{Cloud, Gathered, SPACING};
pub use field::{About, Answer, Field, LearnedLimit, Settings, State, learn};
