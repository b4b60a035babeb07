//! The joints of SMPL's family: their names, their parents, and where hands begin.

/// The joints of the trunk and the limbs, which all trees have, each with its parent.
const TRUNK: [(&str, usize); 22] = [
    ("pelvis", 0),
    ("left_hip", 0),
    ("right_hip", 0),
    ("spine1", 0),
    ("left_knee", 1),
    ("right_knee", 2),
    ("spine2", 3),
    ("left_ankle", 4),
    ("right_ankle", 5),
    ("spine3", 6),
    ("left_foot", 7),
    ("right_foot", 8),
    ("neck", 9),
    ("left_collar", 9),
    ("right_collar", 9),
    ("head", 12),
    ("left_shoulder", 13),
    ("right_shoulder", 14),
    ("left_elbow", 16),
    ("right_elbow", 17),
    ("left_wrist", 18),
    ("right_wrist", 19),
];

/// The fingers of a hand in their order.
const FINGERS: [&str; 5] = ["index", "middle", "pinky", "ring", "thumb"];

/// The wrists, left and right.
const WRISTS: [usize; 2] = [20, 21];

/// Which joints a file has.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Tree {
    /// The trunk and the limbs without hands: 22 joints.
    Body,
    /// SMPL: 24 joints, the last two a hand each.
    Smpl,
    /// SMPL-H: 52 joints, fifteen for each hand.
    SmplH,
    /// SMPL-X: 55 joints, with a jaw and eyes before the hands.
    SmplX,
}

impl Tree {
    /// All of them.
    pub const ALL: [Self; 4] = [Self::Body, Self::Smpl, Self::SmplH, Self::SmplX];

    /// Its name for people.
    #[must_use]
    pub fn title(self) -> &'static str {
        match self {
            Self::Body => "the body of SMPL without hands",
            Self::Smpl => "SMPL",
            Self::SmplH => "SMPL-H",
            Self::SmplX => "SMPL-X",
        }
    }

    /// How many joints it has.
    ///
    /// ```
    /// use condyle_formats::smpl::Tree;
    /// assert_eq!(Tree::ALL.map(Tree::len), [22, 24, 52, 55]);
    /// ```
    #[must_use]
    pub fn len(self) -> usize {
        match self {
            Self::Body => 22,
            Self::Smpl => 24,
            Self::SmplH => 52,
            Self::SmplX => 55,
        }
    }

    /// Never: every tree has joints.
    #[must_use]
    pub fn is_empty(self) -> bool {
        false
    }

    /// The tree of so many joints.
    #[must_use]
    pub fn of_len(joints: usize) -> Option<Self> {
        Self::ALL.into_iter().find(|tree| tree.len() == joints)
    }

    /// The first joint of the left hand's fingers; those of the right follow after fifteen.
    pub(super) fn fingers(self) -> Option<usize> {
        match self {
            Self::SmplH => Some(22),
            Self::SmplX => Some(25),
            Self::Body | Self::Smpl => None,
        }
    }

    /// Its joints in the order of the poses: name and parent, which stands before; the pelvis has none.
    ///
    /// ```
    /// use condyle_formats::smpl::Tree;
    /// let joints = Tree::SmplX.joints();
    /// assert_eq!(joints[22], ("jaw".to_owned(), Some(15)));
    /// assert_eq!(joints[54], ("right_thumb3".to_owned(), Some(53)));
    /// assert_eq!(Tree::SmplH.joints()[37], ("right_index1".to_owned(), Some(21)));
    /// ```
    #[must_use]
    pub fn joints(self) -> Vec<(String, Option<usize>)> {
        let trunk = TRUNK.iter().enumerate();
        let mut joints: Vec<(String, Option<usize>)> = trunk
            .map(|(index, (name, parent))| ((*name).to_owned(), (index > 0).then_some(*parent)))
            .collect();
        let sides = || ["left", "right"].into_iter().zip(WRISTS);
        match self {
            Self::Body => {}
            Self::Smpl => {
                joints.extend(sides().map(|(side, wrist)| (format!("{side}_hand"), Some(wrist))));
            }
            Self::SmplH | Self::SmplX => {
                if self == Self::SmplX {
                    let head = ["jaw", "left_eye_smplhf", "right_eye_smplhf"];
                    joints.extend(head.map(|name| (name.to_owned(), Some(15))));
                }
                for (side, wrist) in sides() {
                    for finger in FINGERS {
                        for number in 1..=3 {
                            let parent = if number == 1 { wrist } else { joints.len() - 1 };
                            joints.push((format!("{side}_{finger}{number}"), Some(parent)));
                        }
                    }
                }
            }
        }
        joints
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Parents as the bodies' `kintree_table` has them, printed from the published models.
    #[test]
    fn parents_are_those_of_the_published_trees() {
        let parents = |tree: Tree| -> Vec<i64> {
            tree.joints().iter().map(|(_, parent)| parent.map_or(-1, |p| p as i64)).collect()
        };
        let smpl =
            [-1, 0, 0, 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 9, 9, 12, 13, 14, 16, 17, 18, 19, 20, 21];
        assert_eq!(parents(Tree::Smpl), smpl);
        let hands =
            [20, 22, 23, 20, 25, 26, 20, 28, 29, 20, 31, 32, 20, 34, 35, 21, 37, 38, 21, 40, 41];
        assert_eq!(parents(Tree::SmplH)[22..43], hands);
        let face = [15, 15, 15, 20, 25, 26];
        assert_eq!(parents(Tree::SmplX)[22..28], face);
        for tree in Tree::ALL {
            assert_eq!(tree.joints().len(), tree.len());
            assert!(tree.joints().iter().enumerate().all(|(i, (_, p))| p.is_none_or(|p| p < i)));
        }
    }
}
