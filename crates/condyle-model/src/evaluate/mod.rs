//! From coordinates to transforms.
//!
//! [`Program::compile`] flattens a model once: components are sorted, constants folded, identities
//! dropped, products of single-use components laid end to end. What remains are, first, scalar
//! instructions (`y = f(x)`, bounds, cones), then *chains*, products of elementary steps
//!
//! ```text
//! T_out = T_base · S₁ · S₂ · … · Sₙ,     Sᵢ ∈ {fixed, turn about an axis, slide along it, ball, scale, shear, law}
//! ```
//!
//! and contacts, which make two turns of a chain's result. Between the two the sines of all angles
//! are taken together.
//!
//! A segment's world transform is a chain whose base is its parent's. [`Program::evaluate`] runs
//! them in order over any scalar; [`Program::evaluate_with_jacobian`] also records, at each step,
//! the world generator of what moves there. If step i turns about a by θ(q), coordinate q
//! contributes ∂θ/∂q · (a, c × a) to every segment beyond it, with c the frame's origin; twists at
//! the world's origin add, so a segment's derivative is a sum over its path, and most segments
//! share their ancestors' numbers without a copy.
//!
//! Below a scale or a shear a generator has a strain beside its twist.
//!
//! In [`Mode::Posed`] coordinates are first moved into their ranges, and passive ones between the
//! bounds of their drivers. In [`Mode::Open`] they are taken as given, and a solver gets the limits
//! as rows. The range of a coordinate that follows others is a row only: moving it would break what
//! it follows.

mod chain;
mod closure;
mod compile;
mod deformation;
mod derivative_plan;
mod forward;
mod instruction;
mod jacobian;
mod normals;
mod pose;
mod program;
mod rotation_rate;
mod tape;

pub use closure::ClosureRows;
pub use jacobian::Jacobian;
pub use pose::{ContactReport, Pose};
pub use program::{Mode, Program, SizeMismatch};
