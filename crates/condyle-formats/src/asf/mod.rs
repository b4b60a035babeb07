//! ASF and AMC, the skeletons of Acclaim and the motions of them.
//!
//! An `.asf` file is a skeleton with the limits of its joints ([`read`]), an `.amc` file the angles of one
//! take, frame by frame, which mean nothing without their skeleton ([`with_skeleton`]). Takes are written of
//! motions of a skeleton that is there ([`write()`]).
//!
//! ```text
//! asf       = { ":" keyword content }          "#" starts a comment; commas and parentheses are spaces
//! :units    = "mass" m "length" l "angle" ("deg" | "rad")
//! :root     = "order" { token } "axis" order "position" x y z "orientation" a b c
//! :bonedata = { "begin" "id" n "name" name "direction" x y z "length" l "axis" a b c order
//!               [ "dof" { token } "limits" { low high } ] "end" }
//! :hierarchy= "begin" { parent { child } line } "end"
//! amc       = { ":" keyword } { frame-number line { bone { number } line } }
//! token     = ("r" | "t") ("x" | "y" | "z") | "l"
//! ```
//!
//! What the numbers mean:
//!
//! - A bone begins where its parent ends, at `length · direction` from its beginning, and directions are those
//!   at rest in the world's axes. Every bone's own frame has the world's axes at rest.
//! - The joint of a bone turns about axes that `axis` gives: with C the rotation of its three angles and R that
//!   of the take, the bone turns by `C·R·C⁻¹`. In both the first token comes first: `rx ry rz` is a turn
//!   about x, then about the fixed y, then about the fixed z, so R = Rz·Ry·Rx for column vectors. The root
//!   turns likewise, about `orientation`, and is moved by its `position` and the take's `tx ty tz`.
//! - `tx ty tz` of a bone move it along the same axes before it turns. `l` moves the bone's end, and all that
//!   hangs there, along the bone.
//! - Coordinates are named after their tokens; what is written about limits is a range that is not enforced,
//!   since recordings exceed it.
//! - `length 0.45` is the unit of the Carnegie Mellon recordings, 1/0.45 inch. Of any other number it is not
//!   agreed what it multiplies: the unit is guessed by the figure's size ([`Assumed`](crate::skeleton::Assumed)),
//!   as is the rate of a take, 120 frames a second, which no such file states.
//!
//! How damaged files are read, each with a warning: directions that are not of length 1 are made so; limits
//! without a dof and dofs without limits; bones that nothing hangs on anything are left out. In a take, a bone
//! that a frame leaves out keeps its numbers of the frame before; bones that the skeleton has not, and numbers
//! beyond a bone's dofs, are left out; times go by the frames' numbers, so that missing frames are gaps;
//! a number that comes twice counts once.

mod figure;
mod read;
mod take;
mod words;
mod write;

pub use figure::read;
pub use take::with_skeleton;
pub use write::write;
