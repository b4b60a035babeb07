//! MJCF, the models of MuJoCo: written, not read.
//!
//! | in the model | in the file |
//! | --- | --- |
//! | a segment | a body; its chain of plain joints ([`crate::plain`]) are the body's joints, at most six, with bodies in between where there are more |
//! | turns, slides, orientations | `hinge`, `slide` and `ball` joints |
//! | a polynomial of one coordinate, up to the fourth power | `equality/joint` with its `polycoef` |
//! | a sum of multiples of coordinates | a fixed tendon that is held at a constant (`equality/tendon`) |
//! | any other function of one coordinate | the polynomial of order four next to it, where that is within 0.5 mm or 0.1° |
//! | functions of several, contacts | free joints, told |
//! | ranges that are enforced, markers, defaults | `range`, sites, the keyframe `default` |
//! | loops of points and frames | `connect` and `weld` |
//!
//! All joints have the reference 0, so that joint values are the model's. MuJoCo has z up: a model with y up hangs
//! from a body that is turned by a quarter turn about x. Masses are not known: 1 kg for each segment.

mod write;

pub use write::{write, written};
