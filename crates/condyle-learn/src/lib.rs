//! Recordings to models: what people do, learned from what was measured of them.
//!
//! | module | what |
//! | --- | --- |
//! | [`arms`] | joints with fewer and fewer free coordinates, to be compared with a learned one |
//! | [`calibration`] | where joints are: rigid clusters, functional axes and centres, a free joint from a standing trial |
//! | [`coupling`] | laws that couple coordinates, from frames of trials |
//! | [`frames`] | orientations of segments from markers, by a recipe |
//! | [`rotations`] | orientations of segments from tables, inertial sensors and motions |
//! | [`limits`] | limits of joints from orientations |
//! | [`study`] | virtual people whose knees are known, for the study of Pronost et al. 2010 |
//! | [`transfer`] | laws on the joints of other figures, by three landmarks |

pub mod arms;
pub mod calibration;
pub mod coupling;
pub mod frames;
pub mod limits;
pub mod rotations;
pub mod study;
pub mod transfer;
