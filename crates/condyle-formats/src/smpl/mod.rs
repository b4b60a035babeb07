//! Poses of SMPL, SMPL-H and SMPL-X, as AMASS and pose estimators store them: `.npz`.
//!
//! ```text
//! file   = a zip archive of arrays, `NAME.npy` each, stored or deflated
//! poses  = (frames, 3·joints): a rotation vector for each joint, in its parent
//! trans  = (frames, 3): what is added to the place of the pelvis in the body
//! ```
//!
//! What is read:
//!
//! | arrays | meaning |
//! | --- | --- |
//! | `poses`, `pose`, `fullpose`, `full_pose`, `thetas` | all joints: 22 (the body alone), 24 (SMPL), 52 (SMPL-H) or 55 (SMPL-X) |
//! | `root_orient`, `global_orient`; `pose_body`, `body_pose`; `pose_hand`, `left_hand_pose`, `right_hand_pose`; `pose_jaw`, `jaw_pose`; `pose_eye`, `leye_pose`, `reye_pose` | the same in parts |
//! | `trans`, `transl`, `translation` | places of the pelvis |
//! | `mocap_framerate`, `mocap_frame_rate`, `mocap_fps`, `framerate`, `frame_rate`, `fps` | frames per second |
//! | `betas` | the shape, used with a body that has `shapedirs` |
//! | `gender`, `surface_model_type` | told; the second says which tree parts belong to |
//!
//! Names may have a prefix `smpl_`, `smplh_` or `smplx_`. Poses may be (frames, joints, 3), or matrices as (frames, joints, 3, 3).
//! Numbers are integers or floats of any size and byte order, in C or Fortran order. Arrays of Python objects are
//! refused: reading them means to run a program that is in the file.
//!
//! Joint *j* of the tree is at rest at J(j) in the body, all axes of joints are those of the body: y up, the figure
//! looks along +z with its arms stretched out to the sides (left along +x). Then
//!
//! `joint_in_parent = (J(j) - J(parent)) · exp(pose(j))`, and the pelvis is at `J(0) + trans`.
//!
//! Such files do not hold J: see [`Rest`]. With a body of SMPL it is `J_regressor · (v_template + shapedirs · betas)`.
//! Of a model that is no such body J(0) is not known either, and the pelvis is put at `trans`.
//!
//! AMASS turns the root so that z is up; SMPL's own space has y up; estimators have y down, as in pictures. The mean
//! of where the pelvis' own y points tells which, and motions are turned so that y is up.

mod archive;
mod array;
mod body;
mod layout;
mod read;
mod rest;
mod tree;

pub use body::{is_body, rest};
pub use read::{from_bytes, from_bytes_with};
pub use rest::Rest;
pub use tree::Tree;

/// Whether bytes are an archive of arrays.
#[must_use]
pub fn is_npz(bytes: &[u8]) -> bool {
    // The length of the first name, and the name.
    let name = bytes.get(26..28).map_or(0, |b| usize::from(b[0]) + 256 * usize::from(b[1]));
    let name = bytes.get(30..30 + name).unwrap_or_default();
    bytes.starts_with(b"PK\x03\x04") && name.ends_with(b".npy")
}
