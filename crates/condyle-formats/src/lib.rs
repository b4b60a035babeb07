//! Bytes to values and back: marker recordings, motions, models, animated scenes.
//!
//! Every reader takes text or bytes, never a path, and answers with a [`Read`]: the value and the
//! warnings about it, or with an [`Error`] that says what is wrong, where, and what would be
//! right. Inside, lengths are metres; a recording in millimetres is converted at the border. No
//! input makes a reader panic, recurse, or allocate more than a small multiple of its size.
//!
//! Tables (TRC, STO, MOT, CSV) and C3D are always there; `document`, `glb`, `opensim` and `poses` are features, as is `smpl`, and
//! `fbx`, which is off by default: it needs a C compiler.
//!
//! | format | read | write |
//! | --- | --- | --- |
//! | model documents (TOML) | [`document::read`] | [`document::write`] |
//! | TRC marker recordings | [`trc::read`] | [`trc::write`] |
//! | STO and MOT motions | [`sto::read`] | [`sto::write`] |
//! | 3D keypoints of pose estimators (JSON, JSON lines, CSV) | [`keypoints::from_bytes`] | |
//! | poses (JSON) | [`poses::read`] | |
//! | resolved models (JSON) | [`exchange::read`] | [`exchange::write`] |
//! | C3D trials: markers, analog channels, events | [`c3d::from_bytes`] | [`c3d::write`] |
//! | CSV tables | [`csv::read`] | [`csv::write`] |
//! | OpenSim models | [`opensim::model::read`] | [`opensim::write`] |
//! | OpenSim inverse kinematics setups | [`opensim::setup`] | |
//! | OpenSim scale setups, and models scaled in their own text | [`opensim::scale_setup`], [`opensim::scale`] | |
//! | SKEL skeletons of CSE 169 | [`skel::read`] | |
//! | ASF skeletons, and AMC takes of them | [`asf::read`], [`asf::with_skeleton`] | takes: [`asf::write`] |
//! | BVH skeletons with motion | [`bvh::from_bytes`] | [`bvh::write`] |
//! | SMPL, SMPL-H and SMPL-X poses, and their bodies (NPZ) | `smpl::from_bytes`, `smpl::rest` | |
//! | FBX skeletons with motion | `fbx::read` | |
//! | GLB and glTF skeletons with motion; animated scenes | [`glb::read`] | [`glb::write`] |
//! | GLB characters of a user, given back with a new animation | | [`glb::reanimate`] |
//! | URDF robot descriptions | [`urdf::from_bytes`] | [`urdf::write`] |
//! | MJCF models of MuJoCo | | [`mjcf::write`] |
//! | UsdSkel scenes (USDA) | | [`usd::write`] |
//! | surfaces of bones: VTK polygons (`.vtp`), STL, OBJ | `surface::from_bytes` | |
//! | XML, for readers of models | [`XmlDocument`] | |

pub mod asf;
pub mod bvh;
pub mod c3d;
pub mod csv;

#[cfg(feature = "document")]
pub mod document;
#[cfg(feature = "poses")]
pub mod exchange;
#[cfg(feature = "fbx")]
pub mod fbx;
mod format;
#[cfg(feature = "glb")]
pub mod glb;
pub mod keypoints;
#[cfg(feature = "mjcf")]
pub mod mjcf;
#[cfg(feature = "opensim")]
pub mod opensim;
#[cfg(feature = "plain")]
pub mod plain;
#[cfg(feature = "poses")]
pub mod poses;
pub mod skel;
pub mod skeleton;
#[cfg(feature = "smpl")]
pub mod smpl;
pub mod sto;
#[cfg(feature = "surfaces")]
pub mod surface;
pub mod text;
pub mod trc;
#[cfg(feature = "urdf")]
pub mod urdf;
#[cfg(feature = "usd")]
pub mod usd;
#[cfg(any(feature = "opensim", feature = "urdf"))]
pub mod xml;

pub use condyle_diagnostics::{Diagnostic, Error, Place, Read, Severity, Subject, nearest};
pub use condyle_motion::{AngleUnit, Animation, Gap, LengthUnit, Observed, Recording, Table};
pub use format::{Content, ContentKind, FORMATS, Format, Id, Include};
#[cfg(any(feature = "opensim", feature = "urdf"))]
pub use xml::{Element, XmlDocument};
