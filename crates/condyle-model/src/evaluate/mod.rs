//! Forward kinematics: from coordinates to transforms, with exact derivatives.
//!
//! [`Program::compile`] flattens a model once: components are sorted, constants folded, identities
//! dropped, and products of components with a single reader are concatenated. The result is a list
//! of scalar instructions (`y = f(x)`, bounds, cones), followed by *chains*, products of elementary
//! steps
//!
//! ```text
//! T_out = T_base · S₁ · S₂ · … · Sₙ,     Sᵢ ∈ {fixed, turn about an axis, slide along it, ball, scale, shear, law}
//! ```
//!
//! and contacts, which compute two rotations from the result of a chain. Between the scalar
//! instructions and the chains the sines and cosines of all angles are computed in one loop.
//!
//! The world transform of a segment is a chain whose base is the transform of its parent.
//! [`Program::evaluate`] runs the instructions in order, for any scalar type.
//! [`Program::evaluate_with_jacobian`] also records, at each step, the twist of its motion in the
//! world. If step i rotates about the axis a by θ(q), coordinate q contributes ∂θ/∂q · (a, c × a)
//! to every segment beyond it, with c the origin of the frame. Twists about the origin of the world
//! add, so the derivative of a segment is a sum over the path to it, and most segments share the
//! twists of their ancestors without a copy.
//!
//! Below a scale or a shear a motion is not rigid: it has a strain in addition to its twist.
//!
//! In [`Mode::Posed`] coordinates are first clamped to their ranges, and passive ones to the bounds
//! that their drivers set. In [`Mode::Open`] they are used as given, and the limits are available
//! to a solver as inequality rows. The range of a coordinate that follows others is always a row:
//! clamping the follower would violate its dependency.

mod behind;
mod chain;
mod closure;
mod compile;
mod deformation;
mod derivative_plan;
mod forward;
mod instruction;
mod jacobian;
mod pose;
mod program;
mod rotation_rate;
mod stage;
mod tape;

pub use closure::ClosureRows;
pub use jacobian::Jacobian;
pub use pose::{ContactReport, Pose};
pub use program::{Bound, Mode, Program, SizeMismatch};
pub use rotation_rate::log_rate;
