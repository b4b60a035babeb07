//! Where joints are, from markers: rigid clusters, functional axes and centres, a free joint from a standing trial.
//!
//! | module | what |
//! | --- | --- |
//! | [`Cluster`] | markers that are rigid to a segment: where it is in a frame, and markers that are missing rebuilt from the others |
//! | [`Screw`] | a fixed axis between two segments about which one turns and along which it slides, whatever their frames |
//! | [`Centre`] | a fixed point between two segments, and the centre of a sphere |
//! | [`Functional`] | the axis or the centre of a joint, from a trial in which it moves, where the standing person has it |
//! | [`FreeJoint`] | a model of two segments with six degrees of freedom between them, from a standing trial |

mod centre;
mod cluster;
mod free;
mod functional;
mod screw;

pub use centre::{Centre, Sphere, sphere};
pub use cluster::{Cluster, placed};
pub use free::{FreeJoint, Standing};
pub use functional::{Functional, FunctionalAxis, FunctionalCentre};
pub use screw::Screw;
