//! Limits of joints learned from orientations that people took.
//!
//! | module | what |
//! | --- | --- |
//! | [`herda2003`] | spheres in the vector part of quaternions, after Herda, Urtasun, Fua & Hanson 2003: the baseline |

pub mod herda2003;
