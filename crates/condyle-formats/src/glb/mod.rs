//! GLB, binary glTF 2.0: an animated figure in one file. Skins, their skeletons and animations are read ([`read`]), a user's
//! own file is given back with another motion ([`reanimate`]), and scenes are written:
//!
//! A [`Scene`] is a tree of named nodes, surfaces that hang on them, a list of times, and for each moving
//! node its transform in its parent at every time. The surfaces are written as one skinned mesh whose
//! joints are all nodes, so that programs show an armature whose bones can be posed. Lengths are metres; glTF is Y up, so a figure
//! that is Z up is below a rotated root node. A node is translated, rotated, and scaled along its
//! own axes, together with its children; glTF nodes represent no other transforms. Channels that
//! never change are omitted. Times start at 0, as glTF has no negative times; times that are not
//! later than the one before are dropped.

mod accessor;
mod bind;
mod clip;
mod container;
mod cover;
mod figure;
mod json;
mod pack;
mod place;
mod read;
mod reanimate;
mod scene;
mod skin;
mod splice;
mod stretch;
mod tree;
mod write;

pub use accessor::Beside;
#[cfg(feature = "fbx")]
pub(crate) use clip::{Channel, Clip, Path};
pub(crate) use container::looks_like_json;
#[cfg(feature = "fbx")]
pub(crate) use figure::{Figure, Still};
#[cfg(feature = "fbx")]
pub(crate) use tree::{Tree, TreeNode};

pub use condyle_mesh::{Finish, Mesh};
pub use cover::{Carrier, Cover, covers};
pub use read::{Options, from_bytes, node_motion, read};
pub use reanimate::{NodeMotion, NodeTrack, Old, reanimate};
pub use scene::{Driven, LocalPose, MarkerTrack, Scene, SceneNode, Surface, Track, UpAxis};
pub use stretch::in_two;
pub use write::write;
