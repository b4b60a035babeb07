//! Figures of our own to carry motions between: rest postures, sizes, axes of bones, facing and names differ.

use condyle::math::{Affine, Mat3, Quat, Vec3};
use condyle::model::model::Facing;
use condyle::model::{CoordinateKind, UpAxis};
use condyle::{Model, ModelBuilder, Motion};
use std::f64::consts::{FRAC_PI_2, FRAC_PI_4};

/// The bones by the names of H-Anim, each with its parent; the names of others are in the same order.
pub(crate) const BONES: [(&str, Option<usize>); 20] = [
    ("sacroiliac", None),
    ("vl3", Some(0)),
    ("vt10", Some(1)),
    ("vc7", Some(2)),
    ("skullbase", Some(3)),
    ("l_sternoclavicular", Some(2)),
    ("l_shoulder", Some(5)),
    ("l_elbow", Some(6)),
    ("l_wrist", Some(7)),
    ("r_sternoclavicular", Some(2)),
    ("r_shoulder", Some(9)),
    ("r_elbow", Some(10)),
    ("r_wrist", Some(11)),
    ("l_hip", Some(0)),
    ("l_knee", Some(13)),
    ("l_ankle", Some(14)),
    ("l_metatarsal", Some(15)),
    ("r_hip", Some(0)),
    ("r_knee", Some(17)),
    ("r_ankle", Some(18)),
];

/// The joint of the right toes, which is last in the lists.
pub(crate) const RIGHT_TOES: (&str, usize) = ("r_metatarsal", 19);

pub(crate) const MIXAMO: [&str; 21] = [
    "mixamorig:Hips",
    "mixamorig:Spine",
    "mixamorig:Spine1",
    "mixamorig:Neck",
    "mixamorig:Head",
    "mixamorig:LeftShoulder",
    "mixamorig:LeftArm",
    "mixamorig:LeftForeArm",
    "mixamorig:LeftHand",
    "mixamorig:RightShoulder",
    "mixamorig:RightArm",
    "mixamorig:RightForeArm",
    "mixamorig:RightHand",
    "mixamorig:LeftUpLeg",
    "mixamorig:LeftLeg",
    "mixamorig:LeftFoot",
    "mixamorig:LeftToeBase",
    "mixamorig:RightUpLeg",
    "mixamorig:RightLeg",
    "mixamorig:RightFoot",
    "mixamorig:RightToeBase",
];

/// The limbs whose directions are compared: from which bone to which.
pub(crate) const LIMBS: [(usize, usize); 8] =
    [(6, 7), (7, 8), (10, 11), (11, 12), (13, 14), (14, 15), (17, 18), (18, 19)];

/// How the arms are held at rest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Arms {
    T,
    A,
    Hanging,
}

#[derive(Clone, Copy, Debug)]
pub(crate) struct Figure {
    pub(crate) arms: Arms,
    /// Lengths of the legs and of the arms, 1 for those of an adult.
    pub(crate) legs: f64,
    pub(crate) reach: f64,
    /// How much longer the thigh is than usual, the shank being that much shorter.
    pub(crate) thigh: f64,
    pub(crate) facing: Facing,
    pub(crate) up: UpAxis,
    /// Whether each bone has axes of its own, all different.
    pub(crate) odd_axes: bool,
    /// The lengths of a figure in centimetres are a hundred times those here.
    pub(crate) mixamo: bool,
    pub(crate) unnamed: bool,
    /// Whether it lies on its back where all coordinates rest, as figures of some programs do.
    pub(crate) lying: bool,
    /// How far the toes are in front of the ankle, in metres.
    pub(crate) foot: f64,
}

impl Default for Figure {
    fn default() -> Self {
        Self {
            arms: Arms::T,
            legs: 1.0,
            reach: 1.0,
            thigh: 0.0,
            facing: Facing::PlusZ,
            up: UpAxis::Y,
            odd_axes: false,
            mixamo: false,
            unnamed: false,
            lying: false,
            foot: 0.14,
        }
    }
}

impl Figure {
    /// The axes of the body in the world: forward, up, right.
    pub(crate) fn world(&self) -> Mat3 {
        let up = match self.up {
            UpAxis::Y => Vec3::Y,
            UpAxis::Z => Vec3::Z,
        };
        // With z up `PlusZ` looks against y, `MinusZ` along it.
        let forward = match (self.up, self.facing) {
            (_, Facing::PlusX) => Vec3::X,
            (_, Facing::MinusX) => -Vec3::X,
            (UpAxis::Y, Facing::PlusZ) => Vec3::Z,
            (UpAxis::Y, Facing::MinusZ) => -Vec3::Z,
            (UpAxis::Z, Facing::PlusZ) => -Vec3::Y,
            (UpAxis::Z, Facing::MinusZ) => Vec3::Y,
        };
        Mat3::from_columns(forward, up, forward.cross(up))
    }

    /// The name of a bone.
    pub(crate) fn name(&self, bone: usize) -> String {
        match (self.unnamed, self.mixamo) {
            (true, _) => format!("node {bone}"),
            (_, true) => MIXAMO[bone].to_owned(),
            _ => BONES.get(bone).map_or(RIGHT_TOES.0, |bone| bone.0).to_owned(),
        }
    }

    /// The joints at rest on axes forward, up, right; metres.
    fn joints(&self) -> Vec<Vec3> {
        let at = Vec3::new;
        let (thigh, shank) = (0.42 + self.thigh, 0.42 - self.thigh);
        let (hip, ankle) = ((thigh + shank) * self.legs + 0.08, 0.08);
        let knee = ankle + shank * self.legs;
        let mut joints = vec![
            at(0.0, hip + 0.03, 0.0),
            at(0.0, hip + 0.13, 0.0),
            at(0.0, hip + 0.30, 0.0),
            at(0.0, hip + 0.50, 0.0),
            at(0.01, hip + 0.60, 0.0),
        ];
        for side in [-1.0, 1.0] {
            let fall = match self.arms {
                Arms::T => 0.0,
                Arms::A => FRAC_PI_4,
                Arms::Hanging => FRAC_PI_2 * 0.97,
            };
            let along = at(0.0, -f64::sin(fall), side * f64::cos(fall));
            let shoulder = at(0.0, hip + 0.45, side * 0.18);
            joints.push(at(0.0, hip + 0.46, side * 0.03));
            joints.push(shoulder);
            joints.push(shoulder + along * (0.30 * self.reach));
            joints.push(shoulder + along * (0.56 * self.reach));
        }
        for side in [-1.0, 1.0] {
            joints.push(at(0.0, hip, side * 0.09));
            joints.push(at(0.0, knee, side * 0.09));
            joints.push(at(0.0, ankle, side * 0.09));
            joints.push(at(self.foot, 0.03, side * 0.10));
        }
        joints
    }

    /// Where the palm faces at rest, beside the bones' own axes: down in a T.
    pub(crate) fn palm(&self, side: f64) -> Vec3 {
        match self.arms {
            Arms::T => Vec3::new(0.0, -1.0, 0.0),
            Arms::A => Vec3::new(0.0, -FRAC_PI_4.cos(), -side * FRAC_PI_4.sin()),
            Arms::Hanging => {
                let fall = FRAC_PI_2 * 0.97;
                Vec3::new(0.0, -fall.cos(), -side * fall.sin())
            }
        }
    }

    /// The model: a ball for each bone, and places for the first. Palms are markers `palm_l` and `palm_r`.
    pub(crate) fn model(&self) -> Model {
        let world = self.world();
        let joints = self.joints();
        let axes = |bone: usize| {
            let turn = Vec3::new(0.9 * bone as f64, 0.4 - 0.7 * bone as f64, 0.3 * bone as f64);
            let own = if self.odd_axes { Quat::exp(turn).to_mat3() } else { Mat3::IDENTITY };
            (own, world * joints[bone])
        };
        let mut b = ModelBuilder::new("figure");
        b.facing(self.facing);
        b.up(self.up);
        let mut ids = vec![];
        for bone in 0..joints.len() {
            let parent = BONES.get(bone).map_or(Some(RIGHT_TOES.1), |bone| bone.1);
            let id = b.segment(&self.name(bone), parent.map(|parent| ids[parent]));
            let (own, place) = axes(bone);
            let joint = match parent {
                Some(parent) => {
                    let (theirs, origin) = axes(parent);
                    let back = theirs.transpose();
                    Affine::new(back * own, back * (place - origin))
                }
                None => Affine::from_rotation(own),
            };
            b.place_joint_frames(id, joint, Affine::IDENTITY);
            if parent.is_none() {
                let set = b.joint_set("root");
                let mut factors = vec![];
                for (axis, name) in Vec3::UNITS.into_iter().zip(["tx", "ty", "tz"]) {
                    let along = b.coordinate(set, name, CoordinateKind::Translation);
                    b.coordinate_mut(along).default[0] = axis.dot(own.transpose() * place);
                    factors.push(b.translate(set, name, along, axis));
                }
                let turn = b.coordinate(set, "turn", CoordinateKind::Orientation);
                if self.lying {
                    let back = Vec3::new(0.0, 0.0, FRAC_PI_2);
                    let back = Quat::exp(own.transpose() * (world * back));
                    b.coordinate_mut(turn).default = back.to_array();
                }
                factors.push(b.ball(set, "turn", turn));
                let motion = b.product(set, "motion", factors);
                b.output(set, id, motion);
            } else {
                b.ball_joint(&format!("joint of {}", self.name(bone)), id);
            }
            ids.push(id);
        }
        for (bone, side, name) in [(8, -1.0, "palm_l"), (12, 1.0, "palm_r")] {
            let (own, _) = axes(bone);
            b.marker(name, Some(ids[bone]), own.transpose() * (world * self.palm(side)) * 0.05);
        }
        b.build().unwrap()
    }

    /// A motion of its model: arms wave, elbows and knees bend, the figure walks forward and turns.
    ///
    /// Each bone turns about axes of the body at rest, by angles that the bone's number gives.
    pub(crate) fn motion(&self, model: &Model, frames: usize) -> Motion {
        let world = self.world();
        let mut motion = Motion::default();
        for frame in 0..frames {
            let t = frame as f64 * 0.01;
            let mut stored = model.defaults();
            for (number, id) in model.coordinate_ids().enumerate() {
                let place = model.stored_range(id);
                if place.len() == 1 {
                    continue;
                }
                let bone = number - 3;
                let wave = |speed: f64, phase: f64| (speed * t + phase + bone as f64).sin();
                // Forward, up, right: about the last limbs swing.
                let turn = match bone {
                    6 | 10 => {
                        Vec3::new(0.5 * wave(2.0, 0.0), 0.6 * wave(3.0, 1.0), 0.7 * wave(2.0, 2.0))
                    }
                    7 | 11 => {
                        Vec3::new(0.0, 0.7 + 0.5 * wave(3.0, 0.0), 0.0)
                            * if bone == 7 { -1.0 } else { 1.0 }
                    }
                    13 | 17 => Vec3::new(0.15 * wave(2.0, 0.0), 0.1, 0.5 * wave(3.0, 0.0)),
                    14 | 18 => Vec3::new(0.0, 0.0, -0.5 - 0.4 * wave(3.0, 1.0)),
                    0 => Vec3::new(0.05 * wave(1.0, 0.0), 0.5 * t, 0.1 * wave(2.0, 0.0)),
                    _ => Vec3::new(0.1, 0.1, 0.15) * wave(2.0, 0.0),
                };
                // In the bone's own axes at rest.
                let rest = self.rest(bone);
                let own = Quat::exp(rest.transpose() * (world * turn));
                stored[place].copy_from_slice(&own.to_array());
            }
            motion.times.push(t);
            motion.frames.push(stored);
        }
        motion
    }

    fn rest(&self, bone: usize) -> Mat3 {
        let turn = Vec3::new(0.9 * bone as f64, 0.4 - 0.7 * bone as f64, 0.3 * bone as f64);
        if self.odd_axes { Quat::exp(turn).to_mat3() } else { Mat3::IDENTITY }
    }
}
