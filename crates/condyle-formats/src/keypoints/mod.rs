//! 3D keypoints of pose estimators: people found in pictures, joint by joint, with how sure each point is.
//!
//! There is no one format; what tools write is told by its content.
//!
//! ```text
//! JSON   { "people": [ { "pose_keypoints_3d": [x, y, z, c, …] } ] }         OpenPose, one frame
//!        { "instance_info": [ { "instances": [ { "keypoints": [[x, y, z], …],
//!                                                "keypoint_scores": [c, …] } ] } ] }   MMPose
//!        [ { "keypoints": { "left_hip": [x, y, z, c], … } }, … ]             by name, or a list of
//!                                                                           {"name", "x", "y", "z", "score"}
//!        { "fps": 60, "names": [ … ], "frames": [ … ] }                      frames of any of these
//! JSONL  one frame a line
//! CSV    time or frame, left_hip_x, left_hip_y, left_hip_z, left_hip_score, …   wide
//!        frame, person, keypoint, x, y, z, confidence                           long
//! ```
//!
//! Points without names are those of the [set](KeypointSet) of that many points. Confidences become
//! [`Recording::confidences`](crate::Recording::confidences); a point of confidence 0 was not seen. Several
//! people are told apart by what they are called in the file, else by nearness from frame to frame, and their
//! labels begin with `person1:`.
//!
//! Such files state neither unit nor axes. The heads are above the feet, so the axis from the ankles to the
//! shoulders is up (`keypoints/up`); a leg from hip over knee to ankle is 0.4 to 1.3 m long, which tells metres
//! from centimetres and millimetres, and what is none of them is brought to a leg of 0.84 m
//! (`keypoints/unit`). [`Assumed`] overrules both.

#[cfg(feature = "poses")]
mod json;
#[cfg(feature = "poses")]
mod raw;
mod sets;
#[cfg(feature = "poses")]
mod settle;
#[cfg(feature = "poses")]
mod table;

pub use condyle_motion::keypoint::{LIMBS, canonical};
pub use sets::{KeypointSet, SETS};

#[cfg(feature = "poses")]
use crate::{Error, Read, Recording, skeleton::Assumed, text::read_decoded};

/// Whether JSON holds keypoints, rather than poses by the names of coordinates: by the words that only
/// keypoints have, in its first 64 KiB.
#[cfg(feature = "poses")]
#[must_use]
pub fn is_json(bytes: &[u8]) -> bool {
    let start = String::from_utf8_lossy(&bytes[..bytes.len().min(1 << 16)]);
    json::KEYS.iter().any(|key| {
        start.match_indices(key).any(|(at, _)| {
            let quoted = at > 0 && start.as_bytes().get(at - 1) == Some(&b'"');
            quoted && start[at + key.len()..].starts_with('"')
        })
    })
}

/// Whether a table holds keypoints: a column each for point, x, y and z, or three columns for each shoulder,
/// elbow, wrist, hip, knee and ankle.
#[cfg(feature = "poses")]
#[must_use]
pub fn is_table(bytes: &[u8]) -> bool {
    table::is_keypoints(bytes)
}

/// Reads keypoints from JSON, JSON lines or CSV; what they do not state is guessed.
///
/// # Errors
/// As [`from_bytes_with`].
///
/// ```
/// use condyle_formats::keypoints;
/// let text = r#"{"fps": 50, "frames": [
///     {"keypoints": {"left_hip": [0, 900, 0, 0.9], "left_knee": [0, 480, 0, 0.5], "left_ankle": [0, 60, 0, 0]}},
///     {"keypoints": {"left_hip": [0, 900, 0, 0.8], "left_knee": [0, 480, 0, 0.5], "left_ankle": [0, 60, 0, 1]}}
/// ]}"#;
/// let read = keypoints::from_bytes(text.as_bytes())?;
/// // A leg of 840 is one in millimetres.
/// let [hip, ankle] = ["left_hip", "left_ankle"].map(|name| read.value.marker(name).unwrap());
/// assert_eq!(read.value.position(0, hip), Some([0.0, 0.9, 0.0]));
/// assert_eq!(read.value.confidence(1, hip), 0.8);
/// assert_eq!(read.value.position(0, ankle), None);
/// # Ok::<(), condyle_formats::Error>(())
/// ```
#[cfg(feature = "poses")]
pub fn from_bytes(bytes: &[u8]) -> Result<Read<Recording>, Error> {
    from_bytes_with(bytes, &Assumed::default())
}

/// Reads keypoints, with what is known of them.
///
/// # Errors
/// `keypoints/syntax` if it is no JSON, `keypoints/shape` where it is laid out in no known way,
/// `keypoints/two-dimensional` for points without depth, `keypoints/set` where points without names are as many as
/// those of no known set, `keypoints/number`, `keypoints/time`, `keypoints/size`; those of [`csv`](crate::csv::read).
#[cfg(feature = "poses")]
pub fn from_bytes_with(bytes: &[u8], assumed: &Assumed) -> Result<Read<Recording>, Error> {
    read_decoded(bytes, |text| {
        let start = text.trim_start();
        let read =
            if start.starts_with(['{', '[']) { json::read(text)? } else { table::read(text)? };
        let mut warnings = read.warnings;
        let value = settle::settled(read.value, text.len(), assumed, &mut warnings)?;
        Ok(Read { value, warnings })
    })
}
