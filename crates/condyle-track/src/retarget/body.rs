//! Which segment of a model is which part of a human.

use condyle_math::Vec3;
use condyle_model::{Model, Pose, SegmentId};
use std::collections::BTreeMap;

/// A side of the body.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Side {
    /// The figure's own left.
    Left,
    /// The figure's own right.
    Right,
}

impl Side {
    /// Both.
    pub const BOTH: [Self; 2] = [Self::Left, Self::Right];

    /// The letter for it in names: `l` or `r`.
    pub fn letter(self) -> char {
        match self {
            Self::Left => 'l',
            Self::Right => 'r',
        }
    }

    /// 1 for the right, -1 for the left.
    pub(crate) fn sign(self) -> f64 {
        match self {
            Self::Left => -1.0,
            Self::Right => 1.0,
        }
    }
}

/// A finger.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[expect(missing_docs, reason = "they are what they are called")]
pub enum Finger {
    Thumb,
    Index,
    Middle,
    Ring,
    Little,
}

impl Finger {
    /// All five.
    pub const ALL: [Self; 5] = [Self::Thumb, Self::Index, Self::Middle, Self::Ring, Self::Little];

    fn name(self) -> &'static str {
        match self {
            Self::Thumb => "thumb",
            Self::Index => "index",
            Self::Middle => "middle",
            Self::Ring => "ring",
            Self::Little => "little",
        }
    }
}

/// A part of the body, or the tip of one.
///
/// A part is a segment, and its place is its joint: that of the forearm the elbow. Tips are points only.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Part {
    /// The pelvis, or the bone that all others hang on.
    Pelvis,
    /// A part of the spine below the chest, counted from the pelvis.
    Spine(u8),
    /// What carries the arms: the uppermost part of the spine below the neck.
    Chest,
    /// The first part of the neck.
    Neck,
    /// The head.
    Head,
    /// The collar bone.
    Clavicle(Side),
    /// The upper arm, from the shoulder.
    UpperArm(Side),
    /// The forearm, from the elbow.
    Forearm(Side),
    /// The hand, from the wrist.
    Hand(Side),
    /// A phalanx, from 0 at the knuckle outwards; of the thumb 0 is the metacarpal. 3 is the tip.
    Finger(Side, Finger, u8),
    /// The tip of a hand without fingers.
    HandTip(Side),
    /// The thigh, from the hip.
    Thigh(Side),
    /// The shank, from the knee.
    Shank(Side),
    /// The foot, from the ankle.
    Foot(Side),
    /// The knee, where it is not the joint of the segment that is the shank.
    Knee(Side),
    /// The ankle, where it is not the joint of the segment that is the foot.
    Ankle(Side),
    /// The ball of the foot: the point above the sole that tells where the foot points.
    Ball(Side),
    /// The toes, from their joints with the foot.
    Toes(Side),
    /// The tip of the toes.
    ToeTip(Side),
}

impl Part {
    /// Its name in tables: `pelvis`, `forearm_r`, `index_1_l`. All of the spine, the chest included, are
    /// `spine`.
    pub fn name(self) -> String {
        let sided = |name: &str, side: Side| format!("{name}_{}", side.letter());
        match self {
            Self::Pelvis => "pelvis".into(),
            Self::Spine(_) => "spine".into(),
            Self::Chest => "chest".into(),
            Self::Neck => "neck".into(),
            Self::Head => "head".into(),
            Self::Clavicle(side) => sided("clavicle", side),
            Self::UpperArm(side) => sided("upper_arm", side),
            Self::Forearm(side) => sided("forearm", side),
            Self::Hand(side) => sided("hand", side),
            Self::Finger(side, finger, 3) => sided(&format!("{}_tip", finger.name()), side),
            Self::Finger(side, finger, joint) => {
                sided(&format!("{}_{}", finger.name(), joint + 1), side)
            }
            Self::HandTip(side) => sided("hand_tip", side),
            Self::Thigh(side) => sided("thigh", side),
            Self::Shank(side) => sided("shank", side),
            Self::Foot(side) => sided("foot", side),
            Self::Knee(side) => sided("knee", side),
            Self::Ankle(side) => sided("ankle", side),
            Self::Ball(side) => sided("ball", side),
            Self::Toes(side) => sided("toes", side),
            Self::ToeTip(side) => sided("toe_tip", side),
        }
    }

    /// All parts but those of the spine below the chest, in their order.
    pub fn all() -> Vec<Self> {
        let mut all = vec![Self::Pelvis, Self::Chest, Self::Neck, Self::Head];
        for side in Side::BOTH {
            all.extend([
                Self::Clavicle(side),
                Self::UpperArm(side),
                Self::Forearm(side),
                Self::Hand(side),
                Self::HandTip(side),
                Self::Thigh(side),
                Self::Shank(side),
                Self::Foot(side),
                Self::Knee(side),
                Self::Ankle(side),
                Self::Ball(side),
                Self::Toes(side),
                Self::ToeTip(side),
            ]);
            for finger in Finger::ALL {
                all.extend((0..4).map(|joint| Self::Finger(side, finger, joint)));
            }
        }
        all.sort();
        all
    }

    /// The part of that name: as [`Part::name`], `chest` included.
    ///
    /// ```
    /// use condyle_track::retarget::{Part, Side};
    /// assert_eq!(Part::named("forearm_r"), Some(Part::Forearm(Side::Right)));
    /// assert_eq!(Part::named("wing"), None);
    /// ```
    pub fn named(name: &str) -> Option<Self> {
        Self::all().into_iter().find(|part| part.name() == name)
    }

    /// Whether it is a point only.
    pub fn is_tip(self) -> bool {
        matches!(
            self,
            Self::HandTip(_)
                | Self::Knee(_)
                | Self::Ankle(_)
                | Self::Ball(_)
                | Self::ToeTip(_)
                | Self::Finger(_, _, 3)
        )
    }
}

/// A point of a segment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Anchor {
    /// The segment.
    pub segment: SegmentId,
    /// The point in it, in metres.
    pub point: Vec3,
}

impl Anchor {
    /// Where it is in the world.
    pub(crate) fn placed(self, pose: &Pose) -> Vec3 {
        pose.segment(self.segment) * self.point
    }
}

/// Which segments of a model are which parts of a human.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct Body {
    parts: BTreeMap<Part, Anchor>,
}

impl Body {
    /// Makes a segment a part: its place is the segment's joint.
    pub fn set(&mut self, model: &Model, part: Part, segment: SegmentId) {
        let point = model.segment(segment).joint_in_segment.translation;
        self.parts.insert(part, Anchor { segment, point });
    }

    /// Makes a point of a segment the place of a part.
    pub fn set_point(&mut self, part: Part, anchor: Anchor) {
        self.parts.insert(part, anchor);
    }

    /// Where a part is, if the figure has it.
    pub fn get(&self, part: Part) -> Option<Anchor> {
        self.parts.get(&part).copied()
    }

    /// All parts that the figure has.
    pub fn parts(&self) -> impl Iterator<Item = (Part, Anchor)> + '_ {
        self.parts.iter().map(|(part, anchor)| (*part, *anchor))
    }

    /// Where a part begins: its joint, that of a shank the knee and that of a foot the ankle.
    pub(crate) fn start(&self, part: Part) -> Option<Anchor> {
        let told = match part {
            Part::Shank(side) => self.get(Part::Knee(side)),
            Part::Foot(side) => self.get(Part::Ankle(side)),
            _ => None,
        };
        told.or_else(|| self.get(part))
    }

    /// Where a part of a limb ends: the joint of the next, or a tip.
    pub(crate) fn end(&self, part: Part) -> Option<Anchor> {
        let first = |parts: &[Part]| parts.iter().find_map(|part| self.get(*part));
        match part {
            Part::Clavicle(side) => first(&[Part::UpperArm(side)]),
            Part::UpperArm(side) => first(&[Part::Forearm(side)]),
            Part::Forearm(side) => first(&[Part::Hand(side)]),
            Part::Hand(side) => first(&[
                Part::Finger(side, Finger::Middle, 0),
                Part::HandTip(side),
                Part::Finger(side, Finger::Index, 0),
            ]),
            Part::Thigh(side) => first(&[Part::Knee(side), Part::Shank(side)]),
            Part::Shank(side) => first(&[Part::Ankle(side), Part::Foot(side)]),
            Part::Foot(side) => first(&[Part::Ball(side), Part::Toes(side), Part::ToeTip(side)]),
            Part::Toes(side) => first(&[Part::ToeTip(side)]),
            Part::Finger(side, finger, joint) if joint < 3 => {
                (joint + 1..4).find_map(|next| self.get(Part::Finger(side, finger, next)))
            }
            _ => None,
        }
    }
}
