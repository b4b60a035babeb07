//! From bytes to a skeleton and its motion.

use super::hierarchy::{self, Channel, Joint, Words};
use super::rows::{self, Rows};
use crate::skeleton::{
    Assumed, Bone, Freedom, FreedomKind, Skeleton, facing_of, length_unit, up_of,
};
use crate::text::{decode, lines};
use condyle_diagnostics::{Diagnostic, Error, Read, Warnings};
use condyle_math::Vec3;
use condyle_model::{Mode, Model, Pose, Program, UpAxis};
use condyle_motion::{Animation, Motion};

/// Reads a BVH file; what it does not state is guessed.
///
/// # Errors
/// As [`from_bytes_with`].
///
/// ```
/// use condyle_formats::bvh;
/// let text = "HIERARCHY\nROOT hips\n{\nOFFSET 0 0 0\n\
///     CHANNELS 4 Xposition Yposition Zposition Yrotation\n}\n\
///     MOTION\nFrames: 1\nFrame Time: 0.01\n0 95.5 2 90\n";
/// let read = bvh::from_bytes(text.as_bytes())?.value;
/// // Too few joints for a person: centimetres are assumed.
/// assert!((read.motion.frames[0][1] - 0.955).abs() < 1e-12);
/// assert_eq!(read.motion.frames[0][3], std::f64::consts::FRAC_PI_2);
/// # Ok::<(), condyle_formats::Error>(())
/// ```
pub fn from_bytes(bytes: &[u8]) -> Result<Read<Animation>, Error> {
    from_bytes_with(bytes, &Assumed::default())
}

/// Reads a BVH file, with what is known of it.
///
/// # Errors
/// `bvh/no-joint`, `bvh/grammar` and `bvh/number` with their places, `bvh/size` and `bvh/short-rows` of what
/// no program writes; what [`decode`] refuses.
pub fn from_bytes_with(bytes: &[u8], assumed: &Assumed) -> Result<Read<Animation>, Error> {
    let decoded = decode(bytes)?;
    let mut warnings = Warnings::default();
    warnings.extend(decoded.warnings);
    let mut words = Words::new(lines(&decoded.value));
    let (joints, has_motion) = hierarchy::read(&mut words, &mut warnings)?;
    let resting: Vec<f64> = joints.iter().flat_map(resting).collect();
    let (first, rest) = words.into_lines();
    let rows = if has_motion {
        rows::read(first, rest, &resting, &mut warnings)?
    } else {
        warnings.push(Diagnostic::warning("bvh/no-motion", "there is no MOTION in the file"));
        Rows::default()
    };
    let mut skeleton = skeleton(&joints, &mut warnings);
    let unit = length_unit(&skeleton, assumed, &mut warnings);
    scale(&mut skeleton, unit);
    let motion = motion(&joints, rows, unit, &mut warnings);
    let read = skeleton.build()?;
    let (up, said) = up(&read.value, &motion, assumed);
    skeleton.up = up;
    let rest = skeleton.rest();
    let places: Vec<(&str, Vec3)> = rest.iter().map(|(name, at, _)| (*name, *at)).collect();
    skeleton.facing = facing_of(&places, up).unwrap_or(skeleton.facing);
    let read = skeleton.build()?;
    warnings.extend(read.warnings);
    warnings.extend(said.into_iter().collect());
    let value = Animation { model: read.value, motion };
    Ok(Read { value, warnings: warnings.finish() })
}

/// The numbers of a joint's channels at rest.
pub(super) fn resting(joint: &Joint) -> impl Iterator<Item = f64> + '_ {
    joint.channels.iter().map(|channel| match channel {
        Channel::Position(axis) => joint.offset[*axis],
        _ => 0.0,
    })
}

/// Which channel of a joint is its place along an axis: the last one, as later words rule.
fn position(joint: &Joint, axis: usize) -> Option<usize> {
    joint.channels.iter().rposition(|channel| *channel == Channel::Position(axis))
}

/// The bones in the units of the file.
pub(super) fn skeleton(joints: &[Joint], warnings: &mut Warnings) -> Skeleton {
    let bones = joints.iter().map(|joint| {
        let offset = Vec3::from(joint.offset);
        // The numbers of a root are its places, those of another joint steps from its OFFSET.
        let root = joint.parent.is_none();
        let mut fixed = joint.offset;
        let mut freedoms = vec![];
        for (axis, unit) in Vec3::UNITS.into_iter().enumerate() {
            if position(joint, axis).is_none() {
                continue;
            }
            let mut freedom = Freedom::new(FreedomKind::Move(unit));
            if root {
                freedom.default[0] = joint.offset[axis];
                fixed[axis] = 0.0;
            }
            freedoms.push(freedom);
        }
        let positions = joint.channels.iter().filter(|c| matches!(c, Channel::Position(_))).count();
        if positions > freedoms.len() {
            warnings.add("bvh/channel", || {
                let message = format!("`{}` has one position twice: the last rules", joint.name);
                Diagnostic::warning("bvh/channel", message)
            });
        }
        for channel in &joint.channels {
            if let Channel::Rotation(axis) = channel {
                freedoms.push(Freedom::new(FreedomKind::Turn(Vec3::UNITS[*axis])));
            }
        }
        let at = if root { Vec3::from(fixed) } else { offset };
        let ends = joint.ends.iter().map(|end| (format!("{}_end", joint.name), Vec3::from(*end)));
        let ends = ends.collect();
        Bone { freedoms, ends, ..Bone::at(&joint.name, joint.parent, at) }
    });
    // Figures in such files look along +z by custom.
    let facing = condyle_model::model::Facing::PlusZ;
    Skeleton {
        name: String::new(),
        up: UpAxis::Y,
        facing,
        bones: bones.collect(),
        ..Skeleton::default()
    }
}

/// Brings lengths to metres.
fn scale(skeleton: &mut Skeleton, unit: f64) {
    for bone in &mut skeleton.bones {
        bone.joint_in_parent.translation = bone.joint_in_parent.translation * unit;
        for (_, end) in &mut bone.ends {
            *end = *end * unit;
        }
        for freedom in &mut bone.freedoms {
            if matches!(freedom.kind, FreedomKind::Move(_)) {
                freedom.default[0] *= unit;
            }
        }
    }
}

/// Whether the positions of a joint that is no root are steps from its OFFSET.
fn is_relative(joint: &Joint, first: usize, frames: &[Vec<f64>]) -> bool {
    let (mut near_zero, mut near_offset) = (0.0, 0.0);
    for axis in 0..3 {
        let Some(channel) = position(joint, axis) else { continue };
        let values = frames.iter().filter_map(|frame| frame.get(first + channel));
        let mean = values.sum::<f64>() / frames.len().max(1) as f64;
        near_zero += mean * mean;
        near_offset += (mean - joint.offset[axis]).powi(2);
    }
    joint.parent.is_some() && near_zero < near_offset
}

/// One stored number: the column that it is read from, what that is multiplied by, and what is added.
pub(super) struct Stored {
    pub(super) column: usize,
    factor: f64,
    add: f64,
}

impl Stored {
    /// In metres or radians.
    pub(super) fn value(&self, number: f64) -> f64 {
        (number + self.add) * self.factor
    }

    /// In the unit of the file.
    pub(super) fn number(&self, value: f64) -> f64 {
        value / self.factor - self.add
    }
}

/// Where the numbers of the model's coordinates stand, in its order.
pub(super) fn stored(
    joints: &[Joint],
    rows: &Rows,
    unit: f64,
    warnings: &mut Warnings,
) -> Vec<Stored> {
    let mut stored: Vec<Stored> = vec![];
    let mut first = 0;
    for joint in joints {
        let relative = is_relative(joint, first, &rows.frames);
        if relative && !rows.frames.is_empty() {
            warnings.add("bvh/relative-positions", || {
                let message = format!(
                    "positions of `{}` are nearer to zero than to its OFFSET, and taken as steps from there",
                    joint.name
                );
                Diagnostic::warning("bvh/relative-positions", message)
            });
        }
        for axis in 0..3 {
            if let Some(channel) = position(joint, axis) {
                let absolute = joint.parent.is_some() && !relative;
                let add = if absolute { -joint.offset[axis] } else { 0.0 };
                stored.push(Stored { column: first + channel, factor: unit, add });
            }
        }
        for (index, channel) in joint.channels.iter().enumerate() {
            if let Channel::Rotation(_) = channel {
                let factor = 1f64.to_radians();
                stored.push(Stored { column: first + index, factor, add: 0.0 });
            }
        }
        first += joint.channels.len();
    }
    stored
}

/// The frames in metres and radians, in the order of the model's coordinates.
fn motion(joints: &[Joint], rows: Rows, unit: f64, warnings: &mut Warnings) -> Motion {
    let stored = stored(joints, &rows, unit, warnings);
    let times = (0..rows.frames.len()).map(|frame| frame as f64 * rows.frame_time).collect();
    let frames = rows.frames.into_iter().map(|row| {
        let value = |stored: &Stored| stored.value(row.get(stored.column).copied().unwrap_or(0.0));
        stored.iter().map(value).collect()
    });
    Motion { times, frames: frames.collect() }
}

/// The axis that points up: the one told, else the one from feet to head in some frames.
fn up(model: &Model, motion: &Motion, assumed: &Assumed) -> (UpAxis, Option<Diagnostic>) {
    if let Some(up) = assumed.up {
        return (up, None);
    }
    let program = Program::compile(model);
    let mut pose = Pose::new(&program);
    let mut places: Vec<(&str, Vec3)> = vec![];
    let last = motion.frames.len().saturating_sub(1);
    let rest = model.defaults();
    for step in 0..=4 {
        let stored = motion.frames.get(last * step / 4).unwrap_or(&rest);
        if program.evaluate(stored, Mode::Open, &mut pose).is_ok() {
            let joints = model.segment_ids();
            places.extend(
                joints.map(|id| (model.segment(id).name.as_str(), pose.segment(id).translation)),
            );
        }
    }
    match up_of(&places) {
        Some(UpAxis::Z) => {
            let message =
                "the head is above the feet along z: z is up, not y as in most such files";
            let said = Diagnostic::warning("skeleton/up", message);
            (UpAxis::Z, Some(said.with_help("give the axis with --up-axis (y or z)")))
        }
        _ => (UpAxis::Y, None),
    }
}
