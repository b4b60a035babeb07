//! BVH, the skeletons with motion of Biovision, which most programs of animation write.
//!
//! ```text
//! file      = "HIERARCHY" { root } "MOTION" "Frames:" count "Frame Time:" seconds { row line }
//! root      = ("ROOT" | "JOINT") name "{" { item } "}"
//! item      = "OFFSET" x y z | "CHANNELS" count { channel } | root | "End Site" "{" "OFFSET" x y z "}"
//! channel   = ("X" | "Y" | "Z") ("position" | "rotation")
//! row       = one number for each channel of all joints, in their order
//! ```
//!
//! What the numbers mean:
//!
//! - A joint is at its OFFSET in its parent, turned by the product of its rotations in the order in which
//!   they are listed: `Zrotation Xrotation Yrotation` is Rz·Rx·Ry for column vectors. Every joint has an order
//!   of its own, and may have one rotation or two. Angles are degrees.
//! - Positions of a joint stand for its OFFSET and go before its rotations, wherever they are listed. A root's
//!   coordinates `tx`, `ty`, `tz` are these numbers; those of another joint are the step from its OFFSET.
//!   Where positions of such a joint are nearer to zero than to its OFFSET on average they are taken to be
//!   that step, with the warning `bvh/relative-positions`.
//! - The unit of lengths is not stated in such files, and y is up by custom: see
//!   [`Assumed`](crate::skeleton::Assumed).
//!
//! How files that differ from the grammar are read: words in any case, cells separated by spaces, tabs,
//! commas or semicolons, numbers with decimal commas, names with spaces, several roots, joints without End
//! Site, OFFSET or CHANNELS, braces that are not closed. `Frames:` is often wrong: the rows rule. A row that
//! is too short keeps the numbers of the row before, what is too long is left out, as is a cell that holds
//! no finite number; rows that are broken into several lines are put together. A frame time that is missing
//! or no positive number is taken to be 1/30 s, one of ten and more to be frames per second. Each of these
//! comes with a warning.
//!
//! What is written: bones are turned and placed in their parents as [`PlainBones`](crate::skeleton::PlainBones)
//! has them. A joint of turns about its own axes in the file's manner, such as one that was read from such a
//! file, keeps its channels and their values. Any other joint has three angles in the order, of the six, that
//! stays farthest from where two of its axes meet, and each angle goes on from that of the frame before
//! without a jump by a whole turn. Roots and joints whose centres move have positions. Sizes and shears
//! are left out, with the warning `skeleton/strain`. Lengths are centimetres unless another unit is asked for.

mod angles;
mod hierarchy;
mod read;
mod replace;
mod rows;
mod write;

pub use read::{from_bytes, from_bytes_with};
pub use replace::with_motion;
pub use write::{USUAL_UNIT, write};
