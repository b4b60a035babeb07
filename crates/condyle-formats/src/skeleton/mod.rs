//! Skeletons as files of animation hold them, and what all such files have in common.
//!
//! A file of this kind holds bones in a tree, where each is in its parent at rest, and how each moves frame
//! by frame. Its reader fills a [`Skeleton`] and calls [`Skeleton::build`]; a writer asks [`PlainBones`] for
//! rotations and places of the bones of a posed model, whatever its joints are, or [`Place::nearest`] for the
//! translation, rotation and scale nearest to a transform.
//!
//! # The contract
//!
//! - A bone is a segment, with the name of the bone; of equal names the second becomes `name#2`, with the
//!   warning `skeleton/name`.
//! - What moves a bone are its [`Freedom`]s, applied in their order from the parent to the bone:
//!   `bone_in_parent = joint_in_parent · F1 · F2 · … · joint_in_segment⁻¹`. A file of angles gives angles
//!   (`rx`, `ry`, `rz`), so that its numbers are kept; a file of rotations gives a ball (`orientation`).
//!   Places are `tx`, `ty`, `tz`, sizes `sx`, `sy`, `sz`. The joint set has the name of the bone, so the key
//!   of a coordinate is `Hips/rx`.
//! - The model's coordinates are in the order of the bones and of their freedoms. A frame of a motion is
//!   these numbers one after the other, an orientation as x, y, z, w.
//! - Each bone has a marker with its name at its joint, and one for each of its [`Bone::ends`].
//! - Lengths are metres and angles radians before they are put in. Files that do not state the unit of
//!   lengths or the axis that points up are read by [`Assumed`], which holds what the user knows; what is
//!   not told is guessed by the size and the names of the bones, with the warnings `skeleton/unit` and
//!   `skeleton/up`.

mod assumed;
mod bake;
mod bone;
mod place;

pub use assumed::{Assumed, UnitGuess, facing_of, length_unit, length_unit_or, named_unit, up_of};
pub use bake::{PlainBone, PlainBones};
pub use bone::{Bone, Freedom, FreedomKind, Skeleton};
pub use place::Place;
