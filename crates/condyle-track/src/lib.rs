//! Markers to coordinates: the nearest posture of a model for every frame of a recording.
//!
//! Per frame, over the independent coordinates q within their limits,
//!
//! ```text
//! minimise  F(q) + P(q),   F = (Σₘ wₘ |eₘ|²) / (Σₘ wₘ)  +  Σ_c w_c (q_c - t_c)²
//!                          P = Σ_p k_p (Σᵢ a_pᵢ qᵢ - r_p)²
//! ```
//!
//! where eₘ is the distance of a model marker from its recorded place, the sums over m run over the
//! markers seen in that frame with positive weight, and the second sum over coordinate targets. F is
//! OpenSim's objective: the marker part is divided by the sum of weights, the coordinate part is
//! not. P, reported apart from F, holds postures that markers do not determine near their rest.
//! Coupled coordinates are evaluated, so a coupling is exact and costs nothing; loops are closed by
//! equality rows.
//!
//! Directions that nothing determines are drawn to their defaults by a prior of [`PRIOR`] per rad² or
//! m², too weak to move anything that the data see.
//!
//! | | what |
//! | --- | --- |
//! | [`Targets`] | what is tracked: markers, coordinates, postures, loops |
//! | [`Tracker`] | one model and its targets, ready to solve frames by its [`Rules`] |
//! | [`FrameAnswer`] | one frame: posture, fit, status |
//! | [`Answers`] | many frames, packed |
//! | [`Trust`] | how far each coordinate of a frame follows from the markers |
//! | [`Stream`] | frames as they come |
//! | [`sequence`] | many frames: cut, solve a chunk, stitch |
//! | [`goal`] | poses by goals: what should be where, nearest to rest |
//! | [`constrain`] | the nearest legal motion: limits kept in every frame, without sudden changes |
//! | [`robust`] | faulty markers: left out, exchanged labels put right |
//! | [`retarget`] | a motion of one figure for another: directions of limbs, feet that stand |
//!
//! ```
//! use condyle_math::Vec3;
//! use condyle_model::ModelBuilder;
//! use condyle_track::{MarkerTarget, Rules, Stream, Targets, Tracker};
//!
//! let mut b = ModelBuilder::new("leg");
//! let shank = b.segment("shank", None);
//! b.hinge("knee", shank, "flexion", -Vec3::Z);
//! b.marker("ankle", Some(shank), Vec3::new(0.0, -0.40, 0.0));
//! let markers = vec![MarkerTarget { marker: 0, weight: 1.0 }];
//! let targets = Targets { markers, ..Targets::default() };
//! let mut stream = Stream::new(Tracker::new(b.build().unwrap(), targets, Rules::default()));
//! for flexion in [0.0_f64, 0.1, 0.2] {
//!     let seen = [-0.40 * flexion.sin(), -0.40 * flexion.cos(), 0.0];
//!     assert!((stream.next(&[Some(seen)]).coordinates[0] - flexion).abs() < 1e-6);
//! }
//! ```
//!
//! Nothing here reads a file, starts a thread, or depends on how many there are.

mod answer;
mod answers;
mod branch;
pub mod constrain;
mod frame;
pub mod goal;
mod guess;
mod problem;
mod recorded;
pub mod retarget;
pub mod robust;
pub mod sequence;
mod stream;
mod target;
mod tracker;
mod trust;

pub use answer::{FrameAnswer, FrameStatus};
pub use answers::{Answers, Run};
pub use recorded::Recorded;
pub use sequence::{Chunk, cut, stitch};
pub use stream::Stream;
pub use target::{
    CoordinateTarget, DirectionTarget, MarkerTarget, OrientationTarget, PRIOR, PlaceTarget,
    PostureTarget, Targets, Wanted,
};
pub use tracker::{Rules, Scratch, Tracker};
pub use trust::Trust;
