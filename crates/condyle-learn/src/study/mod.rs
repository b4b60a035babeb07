//! Six virtual people for the study of Pronost, Sandholm & Thalmann 2010 ("S3"), whose knees are known.
//!
//! A generator that says what a learned law should have been. Nothing here uses what learns: markers come from products of
//! matrices along a leg whose knee is one of three [kinds](Knee), two of which no linear law can be; the truth of each frame is
//! taken from the bones, in frames that are computed here from the same landmarks.
//!
//! ```text
//! marker = thigh · (place + artefact(flexion, load, trial)) + noise              on the thigh
//! marker = thigh · joint · knee(angles) · (place + artefact) + noise             on the shank
//! ```
//!
//! What is random comes from the seed, the person and the trial alone: the same with and without artefact, on any number of
//! threads.
//!
//! | module | what |
//! | --- | --- |
//! | `knee` | true knees: a linear law in three angles, Walker's, a planar one of Yamaguchi & Zajac |
//! | `person` | bones, markers, knee and skin of six people |
//! | `motion` | gait and crouch: angles and thigh over time |
//! | `skin` | how far skin takes each marker from its bone |
//! | `trial` | recordings, and the truth of each frame |
//! | `best_linear` | the linear law nearest to a truth, by the method of Gram & Schmidt |
//! | `dice` | numbers from a seed |

mod best_linear;
mod dice;
mod knee;
mod motion;
mod person;
mod skin;
mod trial;

pub use best_linear::BestLinear;
pub use knee::{Knee, planar_slides};
pub use motion::{CROUCHES, Kind};
pub use person::Person;
pub use skin::Skin;
pub use trial::{TRUTH_COLUMNS, Take, Trials};
