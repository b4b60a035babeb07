//! Sets of keypoints: which point is which in a list without names.

/// The points of an annotation or a model, in the order in which tools write them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct KeypointSet {
    /// What it is called.
    pub name: &'static str,
    /// The names of its points, as its authors spell them.
    pub points: &'static [&'static str],
}

/// The known sets; of two with as many points the first is meant where nothing else is said.
///
/// ```
/// use condyle_formats::keypoints::{KeypointSet, SETS};
/// assert_eq!(KeypointSet::of_size(25).map(|set| set.points[8]), Some("MidHip"));
/// let sizes: Vec<usize> = SETS.iter().map(|set| set.points.len()).collect();
/// assert_eq!(sizes, [17, 18, 25, 26, 33, 17]);
/// ```
pub const SETS: &[KeypointSet] = &[
    // Lin et al. 2014 and the annotation of people of 2016; cocodataset.org.
    KeypointSet {
        name: "COCO-17",
        points: &[
            "nose",
            "left_eye",
            "right_eye",
            "left_ear",
            "right_ear",
            "left_shoulder",
            "right_shoulder",
            "left_elbow",
            "right_elbow",
            "left_wrist",
            "right_wrist",
            "left_hip",
            "right_hip",
            "left_knee",
            "right_knee",
            "left_ankle",
            "right_ankle",
        ],
    },
    // OpenPose, its older set: the neck is the middle of the shoulders.
    KeypointSet {
        name: "COCO-18",
        points: &[
            "Nose",
            "Neck",
            "RShoulder",
            "RElbow",
            "RWrist",
            "LShoulder",
            "LElbow",
            "LWrist",
            "RHip",
            "RKnee",
            "RAnkle",
            "LHip",
            "LKnee",
            "LAnkle",
            "REye",
            "LEye",
            "REar",
            "LEar",
        ],
    },
    // OpenPose, doc/02_output.md: Pose Output Format (BODY_25).
    KeypointSet {
        name: "BODY_25",
        points: &[
            "Nose",
            "Neck",
            "RShoulder",
            "RElbow",
            "RWrist",
            "LShoulder",
            "LElbow",
            "LWrist",
            "MidHip",
            "RHip",
            "RKnee",
            "RAnkle",
            "LHip",
            "LKnee",
            "LAnkle",
            "REye",
            "LEye",
            "REar",
            "LEar",
            "LBigToe",
            "LSmallToe",
            "LHeel",
            "RBigToe",
            "RSmallToe",
            "RHeel",
        ],
    },
    // Fang et al. 2022, AlphaPose; Halpe-FullBody, its first 26 points.
    KeypointSet {
        name: "Halpe-26",
        points: &[
            "Nose",
            "LEye",
            "REye",
            "LEar",
            "REar",
            "LShoulder",
            "RShoulder",
            "LElbow",
            "RElbow",
            "LWrist",
            "RWrist",
            "LHip",
            "RHip",
            "LKnee",
            "RKnee",
            "LAnkle",
            "RAnkle",
            "Head",
            "Neck",
            "Hip",
            "LBigToe",
            "RBigToe",
            "LSmallToe",
            "RSmallToe",
            "LHeel",
            "RHeel",
        ],
    },
    // Bazarevsky et al. 2020; the landmarks of MediaPipe Pose.
    KeypointSet {
        name: "MediaPipe",
        points: &[
            "nose",
            "left_eye_inner",
            "left_eye",
            "left_eye_outer",
            "right_eye_inner",
            "right_eye",
            "right_eye_outer",
            "left_ear",
            "right_ear",
            "mouth_left",
            "mouth_right",
            "left_shoulder",
            "right_shoulder",
            "left_elbow",
            "right_elbow",
            "left_wrist",
            "right_wrist",
            "left_pinky",
            "right_pinky",
            "left_index",
            "right_index",
            "left_thumb",
            "right_thumb",
            "left_hip",
            "right_hip",
            "left_knee",
            "right_knee",
            "left_ankle",
            "right_ankle",
            "left_heel",
            "right_heel",
            "left_foot_index",
            "right_foot_index",
        ],
    },
    // Ionescu et al. 2014, with the 17 points that lifting networks use; as many as COCO's, so it is meant
    // only where a file names it or its points.
    KeypointSet {
        name: "H36M-17",
        points: &[
            "root",
            "right_hip",
            "right_knee",
            "right_foot",
            "left_hip",
            "left_knee",
            "left_foot",
            "spine",
            "thorax",
            "neck_base",
            "head",
            "left_shoulder",
            "left_elbow",
            "left_wrist",
            "right_shoulder",
            "right_elbow",
            "right_wrist",
        ],
    },
];

impl KeypointSet {
    /// The first set of so many points.
    #[must_use]
    pub fn of_size(points: usize) -> Option<&'static Self> {
        SETS.iter().find(|set| set.points.len() == points)
    }

    /// The set whose name is in a text such as `body26` or `H3.6M`, if it has so many points.
    #[must_use]
    pub fn named(text: &str, points: usize) -> Option<&'static Self> {
        let text: String =
            text.chars().filter(char::is_ascii_alphanumeric).collect::<String>().to_lowercase();
        let is_h36m = text.contains("h36m") || text.contains("human36m");
        SETS.iter()
            .filter(|set| set.points.len() == points)
            .find(|set| (set.name == "H36M-17") == is_h36m)
    }
}

#[cfg(test)]
mod tests {
    use super::super::{LIMBS, canonical};
    use super::*;

    #[test]
    fn every_set_has_the_limbs_and_no_point_twice() {
        for set in SETS {
            let mut known: Vec<&str> = set.points.iter().filter_map(|p| canonical(p)).collect();
            let count = known.len();
            assert!(LIMBS.iter().all(|limb| known.contains(limb)), "{}", set.name);
            known.sort_unstable();
            known.dedup();
            assert_eq!(known.len(), count, "{}", set.name);
            // Of Human3.6M the spine and the base of the neck are no points of others.
            let unknown = if set.name == "H36M-17" { 2 } else { 0 };
            assert_eq!(set.points.len() - count, unknown, "{}", set.name);
        }
    }

    #[test]
    fn of_two_sets_with_17_points_a_name_tells() {
        assert_eq!(KeypointSet::of_size(17).unwrap().name, "COCO-17");
        assert_eq!(KeypointSet::named("h3.6m", 17).unwrap().name, "H36M-17");
        assert_eq!(KeypointSet::named("human36m_3d", 17).unwrap().name, "H36M-17");
        assert_eq!(KeypointSet::named("coco", 17).unwrap().name, "COCO-17");
        assert!(KeypointSet::of_size(12).is_none());
    }
}
