//! FBX, the files of Autodesk's and most animation programs: skeletons and animations, read.
//!
//! The container, its properties, pivots and curves are read by `ufbx`, a library in C with a safe interface in Rust; for that
//! reason this part is a feature that is off by default, and absent where there is no C compiler, as for WebAssembly.
//!
//! - The file's unit and axes are stated in it: lengths become metres, y points up, and axes are right-handed.
//! - Pre- and post-rotation, pivots, offsets and orders of rotation become one translation, rotation and scale of each node at each
//!   frame. Nodes that do not inherit the scale of their parent are compensated for it, by a helper node where that has to be.
//! - Bones are the file's limbs, the nodes above them, and what moves below them; in a file without limbs, what moves. What else
//!   they become is said in [glTF's reader](crate::glb::read), which has the same model.
//! - Frames are at the rate of the file, from the beginning of the animation to its end: the curves of FBX are sampled as animation
//!   programs do.

mod read;

pub use read::{from_bytes, read};
