//! The knees that Pronost, Sandholm & Thalmann 2010 (4.1) compare, and the one that they left out: the *arms* of a comparison.
//!
//! A [`Leg`] is a model whose joint has six coordinates of its own, as [`FreeJoint`](super::calibration::FreeJoint) makes it from a
//! standing trial: three places of its centre along the parent's axes, three angles. Each [`Arm`] is the same model (segments,
//! markers, frames and names of coordinates) with fewer of them free, so that arms differ in the joint and in nothing else:
//!
//! | arm | free | places of the centre | angles |
//! | --- | --- | --- | --- |
//! | `hinge` | 1 | where it is while the person stands | flexion; the others as while the person stands |
//! | `planar` | 1 | forward and upward by the splines of Yamaguchi & Zajac 1989 of flexion, which begin where the hinge is | flexion |
//! | `fixed` | 3 | the constant nearest to the centre: the mean over the frames that the law is learned from, its least squares without slopes | all |
//! | `fixed-c4` | 3 | the constant of the law, c₄ of the paper: where its angles are 0 | all |
//! | `fixed-best` | 3 | the constant that leaves the least at the markers of those frames | all |
//! | `learned` | 3 | the law | all |
//! | `free` | 6 | free | all |
//!
//! The paper compares `hinge` (its 1DOF), `planar` (3DOF) and `learned` (3⁺DOF). From `planar` to `learned` two angles become free
//! *and* the centre is learned. `fixed` tells both gains apart: hinge to fixed is that of freer rotation, fixed to learned that of the
//! centre. `fixed-best` is asked for more: laws and means are fitted to where tracking puts the centre, it to the markers themselves.
//!
//! Contract: an arm is a function of the leg and of what was [learned](Centre) alone; every arm has the coordinates of the leg, in
//! its order; coordinates that are not free are locked or follow. `free` is the leg itself.
//!
//! | module | what |
//! | --- | --- |
//! | `arm` | which arms there are |
//! | `leg` | the coordinates of a joint with six, and its model for each arm |
//! | `centre` | what arms take from recordings: the law and the mean; scaled to another person |
//! | `planar` | the splines of Yamaguchi & Zajac |

mod arm;
mod centre;
mod leg;
mod planar;

pub use arm::Arm;
pub use centre::{Centre, Sizes};
pub use leg::Leg;
pub use planar::{PLANAR_LENGTH, planar};
