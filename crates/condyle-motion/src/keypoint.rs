//! Points that estimators of poses find: what each is, however its name is spelt.

/// The points that every set has: both shoulders, elbows, wrists, hips, knees and ankles.
pub const LIMBS: [&str; 12] = [
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
];

/// Parts with sides: what they are called, and their names on the left and on the right.
const SIDED: [(&[&str], &str, &str); 19] = [
    (&["shoulder"], "left_shoulder", "right_shoulder"),
    (&["elbow"], "left_elbow", "right_elbow"),
    (&["wrist"], "left_wrist", "right_wrist"),
    (&["hip"], "left_hip", "right_hip"),
    (&["knee"], "left_knee", "right_knee"),
    // The foot of Human3.6M is its ankle.
    (&["ankle", "foot"], "left_ankle", "right_ankle"),
    (&["eye"], "left_eye", "right_eye"),
    (&["ear"], "left_ear", "right_ear"),
    (&["bigtoe"], "left_big_toe", "right_big_toe"),
    (&["smalltoe", "littletoe"], "left_small_toe", "right_small_toe"),
    (&["heel"], "left_heel", "right_heel"),
    (&["eyeinner"], "left_eye_inner", "right_eye_inner"),
    (&["eyeouter"], "left_eye_outer", "right_eye_outer"),
    (&["mouth"], "left_mouth", "right_mouth"),
    (&["pinky", "pinkyknuckle"], "left_pinky", "right_pinky"),
    (&["index", "indexknuckle"], "left_index", "right_index"),
    (&["thumb", "thumbknuckle"], "left_thumb", "right_thumb"),
    (&["footindex"], "left_foot_index", "right_foot_index"),
    (&["toe", "toebase"], "left_big_toe", "right_big_toe"),
];

/// Parts in the middle.
const MIDDLE: [(&[&str], &str); 4] = [
    (&["nose"], "nose"),
    (&["neck", "thorax"], "neck"),
    (&["midhip", "hip", "hips", "pelvis", "root", "hipcenter"], "mid_hip"),
    (&["head", "headtop", "tophead", "topofhead"], "head_top"),
];

/// What a point is by its name in a set or a file, in one spelling: `RHip`, `hip.R` and `right hip` are
/// `right_hip`; `None` where it is none of those that the sets have.
///
/// ```
/// use condyle_motion::keypoint::canonical;
/// for name in ["RHip", "right_hip", "RIGHT_HIP", "hip.R", "rightHip", "rhip"] {
///     assert_eq!(canonical(name), Some("right_hip"), "{name}");
/// }
/// assert_eq!(canonical("Hip"), Some("mid_hip"));
/// assert_eq!(canonical("LASI"), None);
/// ```
#[must_use]
pub fn canonical(name: &str) -> Option<&'static str> {
    if name.len() > 64 {
        return None;
    }
    let (mut side, mut part) = (None, String::new());
    for word in words(name) {
        let left = match word.as_str() {
            "l" | "left" => Some(true),
            "r" | "right" => Some(false),
            _ => None,
        };
        match (left, side) {
            (Some(_), Some(_)) => return None,
            (Some(left), None) => side = Some(left),
            (None, _) => part.push_str(&word),
        }
    }
    let of_side = |part: &str, left: bool| {
        let found = SIDED.iter().find(|(names, ..)| names.contains(&part));
        found.map(|&(_, l, r)| if left { l } else { r })
    };
    match side {
        Some(left) => of_side(&part, left),
        None => {
            let middle = MIDDLE.iter().find(|(names, _)| names.contains(&part.as_str()));
            middle.map(|(_, name)| *name).or_else(|| {
                // All letters of one size: `rhip`, `LEFTKNEE`.
                let starts = [("left", true), ("right", false), ("l", true), ("r", false)];
                let rest = |(start, left): (&str, bool)| Some((part.strip_prefix(start)?, left));
                starts.into_iter().filter_map(rest).find_map(|(part, left)| of_side(part, left))
            })
        }
    }
}

/// The words of a name in lower case, parted by signs and by capitals: `LBigToe` is `l big toe`.
fn words(name: &str) -> Vec<String> {
    let letters: Vec<char> = name.chars().collect();
    let mut words = vec![];
    let mut word = String::new();
    for (index, &letter) in letters.iter().enumerate() {
        let before = index.checked_sub(1).and_then(|i| letters.get(i));
        let after = letters.get(index + 1);
        let starts = letter.is_uppercase()
            && before.is_some_and(|b| {
                b.is_lowercase() || b.is_uppercase() && after.is_some_and(|a| a.is_lowercase())
            });
        if (starts || !letter.is_alphanumeric()) && !word.is_empty() {
            words.push(std::mem::take(&mut word));
        }
        if letter.is_alphanumeric() {
            word.extend(letter.to_lowercase());
        }
    }
    if !word.is_empty() {
        words.push(word);
    }
    words
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_of_laboratories_are_no_limbs() {
        // Labels of Plug-in Gait, OpenCap, ISB, CAST and gait2392 that stand on the skin beside a joint.
        let labels = [
            "RASI",
            "RKNE",
            "RANK",
            "RSHO",
            "RELB",
            "RWRA",
            "r_knee_lat",
            "L_elbow_lat",
            "R_HJC",
            "LFE_r",
            "R_wrist_radius",
            "RGT",
            "R.Iliac.Crest",
            "R.Knee.Lat",
        ];
        assert!(labels.iter().all(|label| canonical(label).is_none()));
        // These two are also names of keypoints: only all twelve limbs together tell.
        assert_eq!(canonical("R.Knee"), Some("right_knee"));
        assert_eq!(canonical("R_Shoulder"), Some("right_shoulder"));
    }

    #[test]
    fn capitals_part_words() {
        assert_eq!(words("LBigToe"), ["l", "big", "toe"]);
        assert_eq!(words("LEFT_FOOT_INDEX"), ["left", "foot", "index"]);
        assert_eq!(canonical("LSmallToe"), Some("left_small_toe"));
        assert_eq!(canonical("mouth_left"), Some("left_mouth"));
        assert_eq!(canonical("left_right_hip"), None);
    }
}
