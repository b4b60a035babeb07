//! Recordings to models: what people do, learned from what was measured of them.
//!
//! | module | what |
//! | --- | --- |
//! | [`frames`] | orientations of segments from markers, by a recipe |

pub mod frames;
