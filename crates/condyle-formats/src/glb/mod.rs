//! GLB, binary glTF 2.0: an animated figure in one file that every viewer opens.
//!
//! A [`Scene`] is a tree of named nodes with simple shapes, a time line, and for each moving node
//! its place in its parent at every time. Lengths are metres; glTF is Y up, so a figure that is Z
//! up hangs under one turned root. A node is moved, turned and sized along its own axes, and what
//! it carries with it; no more can be said of it. Channels that never change are left out. Times start at 0, as
//! glTF has none before; times that are no later than the one before are dropped.

mod pack;
mod place;
mod scene;
mod shape;
mod write;

pub use scene::{LocalPose, MarkerTrack, Scene, SceneNode, Track, UpAxis};
pub use shape::{Finish, Shape};
pub use write::write;
