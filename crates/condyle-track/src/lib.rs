//! Markers to coordinates: the nearest posture of a model for every frame of a recording.
//!
//! Per frame, over the independent coordinates q within their limits,
//!
//! ```text
//! minimise  F(q) = (Σₘ wₘ |eₘ|²) / (Σₘ wₘ)  +  Σ_c w_c (q_c - t_c)²
//! ```
//!
//! where eₘ is the distance of a model marker from its recorded place, the sums over m run over the
//! markers seen in that frame with positive weight, and the second sum over coordinate tasks. This
//! is OpenSim's objective: the marker part is divided by the sum of weights, the coordinate part is
//! not. Coupled coordinates are evaluated, so a coupling is exact and costs nothing; loops are
//! closed by equality rows.
//!
//! Directions that neither markers nor tasks determine are drawn to their defaults by a prior of
//! [`PRIOR`] per rad² or m², too weak to move anything that the data see.
//!
//! | file | what |
//! | --- | --- |
//! | [`tasks`] | what is asked: markers, coordinate targets, weights, options |
//! | [`Tracker`] | one model and its tasks, ready to solve frames |
//! | [`FrameAnswer`] | one frame: posture, fit, status |
//! | [`sequence`] | many frames: cut, solve a chunk, stitch |
//! | [`robust`] | faulty markers: weighed down, swapped labels found |
//!
//! Nothing here reads a file, starts a thread, or depends on how many there are.

mod answer;
mod frame;
mod moments;
mod problem;
mod recorded;
pub mod robust;
pub mod sequence;
pub mod tasks;
mod tracker;

pub use answer::{FrameAnswer, FrameStatus};
pub use problem::PRIOR;
pub use recorded::Recorded;
pub use sequence::{Chunk, cut, stitch};
pub use tasks::{CoordinateTask, MarkerTask, Options, Tasks};
pub use tracker::{Scratch, Tracker};
