//! URDF, the robot descriptions of ROS: a tree of links and joints.
//!
//! ```text
//! child_in_parent = origin · motion(q),   origin = T(xyz)·Rz(yaw)·Ry(pitch)·Rx(roll)
//! ```
//!
//! | joint | motion | coordinates |
//! | --- | --- | --- |
//! | `fixed` | none | |
//! | `revolute`, `continuous` | R(axis, q) | the joint's name |
//! | `prismatic` | T(q·axis) | the joint's name |
//! | `planar` | slides along two axes of the plane, then R(axis, q) | name with `_x`, `_y`, `_turn` |
//! | `floating` | T(x, y, z)·R(orientation) | name with `_x`, `_y`, `_z`, `_rotation` |
//!
//! `mimic` lets a joint follow another: q = multiplier·other + offset. Masses, surfaces, colours, transmissions and
//! what simulators add are skipped; that meshes are not read is said.
//!
//! Repaired with a warning: links that are only named by joints, second links and joints of one name, a second
//! joint that moves a link, several roots, limits in the wrong order or absent, axes without a direction, mimics of
//! unknown joints or in a circle. Links in a circle are an error.

mod read;
mod write;

pub use read::from_bytes;
pub use write::{write, written};
