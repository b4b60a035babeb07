//! From a model and its motion to text.

use super::angles::{following, order};
use crate::skeleton::PlainBones;
use condyle_diagnostics::{Diagnostic, Error, Read};
use condyle_math::{Affine, EulerOrder, Mat3, Vec3};
use condyle_model::component::Law;
use condyle_model::{CoordinateId, Mode, Model, SegmentId, Signal};
use condyle_motion::Motion;
use std::collections::HashMap;
use std::fmt::Write;

/// Metres in the unit of most programs, the centimetre.
pub const USUAL_UNIT: f64 = 0.01;

/// A joint whose centre moves less than this, in metres, has no positions.
const STILL: f64 = 1e-6;
/// Times of whole milliseconds differ from even ones by that much, in seconds.
const MILLISECONDS: f64 = 0.000_51;
/// The frame time of a single frame, in seconds.
const USUAL_FRAME_TIME: f64 = 1.0 / 30.0;
/// The deepest indentation.
const DEEPEST: usize = 64;

const AXES: [char; 3] = ['X', 'Y', 'Z'];

/// Writes a model and its motion, with so many metres in a unit; without frames the model stands at rest.
/// In posed mode limits hold.
///
/// # Warnings
/// `skeleton/strain` where bones are stretched or sheared, `bvh/uneven` where frames are not evenly in time
/// and are resampled, `bvh/up` where z is up, `bvh/renamed` where names hold spaces or braces.
///
/// # Errors
/// `bvh/empty` without segments; frames that have not the model's number of values.
///
/// ```
/// use condyle_formats::bvh;
/// use condyle_math::Vec3;
/// use condyle_model::{Mode, ModelBuilder};
/// use condyle_motion::Motion;
/// let mut b = ModelBuilder::new("arm");
/// let forearm = b.segment("forearm", None);
/// b.place_joint(forearm, Vec3::Y);
/// b.hinge("elbow", forearm, "flexion", Vec3::Z);
/// let model = b.build()?;
/// let motion = Motion { times: vec![0.0, 0.5], frames: vec![vec![0.0], vec![90f64.to_radians()]] };
/// let text = bvh::write(&model, &motion, Mode::Open, bvh::USUAL_UNIT)?.value;
/// assert!(text.contains("OFFSET 0 100 0"));
/// assert!(text.ends_with("Frames: 2\nFrame Time: 0.5\n0 100 0 0 0 0\n0 100 0 90 0 0\n"));
/// # Ok::<(), condyle_formats::Error>(())
/// ```
pub fn write(
    model: &Model,
    motion: &Motion,
    mode: Mode,
    metres_per_unit: f64,
) -> Result<Read<String>, Error> {
    if model.segments().is_empty() {
        return Err(Error::new("bvh/empty", "the model has no segments"));
    }
    let mut warnings = vec![];
    let even = even(model, motion, &mut warnings);
    let motion = even.as_ref().unwrap_or(motion);
    let mut bones = PlainBones::new(model, mode)?;
    let still = Motion { times: vec![0.0], frames: vec![model.defaults()] };
    let motion = if motion.frames.is_empty() { &still } else { motion };
    let frames = Frames::of(&mut bones, motion)?;
    let joints = joints(model, &bones, &frames);
    let mut text = String::with_capacity(1 << 16);
    text.push_str("HIERARCHY\n");
    let names = names(model, &mut warnings);
    hierarchy(&mut text, model, &bones, &joints, &names, metres_per_unit);
    rows(&mut text, &bones, &joints, &frames, motion, metres_per_unit);
    if model.up() == condyle_model::UpAxis::Z {
        let message = "z is up in the model, and in what is written: most programs take y to be up";
        warnings.push(Diagnostic::warning("bvh/up", message));
    }
    warnings.extend(bones.lost());
    Ok(Read { value: text, warnings })
}

/// The motion at even times, if its own are not.
fn even(model: &Model, motion: &Motion, warnings: &mut Vec<Diagnostic>) -> Option<Motion> {
    let step = frame_time(motion);
    let first = motion.times.first()?;
    // Half a millisecond at most, but no tenth of a frame.
    let most = MILLISECONDS.min(0.1 * step).max(0.01 * step);
    let uneven = |(frame, time): (usize, &f64)| (time - first - frame as f64 * step).abs() > most;
    if !motion.times.iter().enumerate().any(uneven) {
        return None;
    }
    let message = format!("the frames are not evenly in time: written are frames each {step:.6} s");
    warnings.push(Diagnostic::warning("bvh/uneven", message));
    Some(motion.resampled(model, 1.0 / step))
}

/// Seconds of a frame on average, with the twelve digits that a sum of times keeps.
fn frame_time(motion: &Motion) -> f64 {
    let (Some(first), Some(last)) = (motion.times.first(), motion.times.last()) else {
        return USUAL_FRAME_TIME;
    };
    let step = (last - first) / motion.times.len().saturating_sub(1).max(1) as f64;
    let rounded = format!("{step:.11e}").parse().unwrap_or(step);
    if rounded > 0.0 { rounded } else { USUAL_FRAME_TIME }
}

/// All bones in all frames.
struct Frames {
    /// For each frame the transforms of the bones in their parents.
    locals: Vec<Vec<Affine>>,
    /// For each frame the effective values of the coordinates.
    effective: Vec<Vec<f64>>,
}

impl Frames {
    fn of(bones: &mut PlainBones<'_>, motion: &Motion) -> Result<Self, Error> {
        let mut frames = Self { locals: vec![], effective: vec![] };
        for stored in &motion.frames {
            let mut locals = Vec::with_capacity(bones.bones().len());
            bones.pose(stored, &mut locals)?;
            frames.locals.push(locals);
            frames.effective.push(bones.effective().to_vec());
        }
        Ok(frames)
    }

    /// A bone in every frame.
    fn of_bone(&self, bone: usize) -> impl Iterator<Item = Affine> + Clone + '_ {
        self.locals.iter().filter_map(move |locals| locals.get(bone).copied())
    }
}

/// How the numbers of a joint are written.
struct Joint {
    /// Whether it has positions.
    moves: bool,
    turns: Turns,
}

/// How the rotation of a joint is written.
enum Turns {
    /// By the coordinates of its own: three axes, each with a place among the stored numbers if it turns.
    Kept([(usize, Option<usize>); 3]),
    /// By three angles.
    Angles(EulerOrder),
}

impl Joint {
    /// The axes of its rotations.
    fn axes(&self) -> Vec<usize> {
        match &self.turns {
            Turns::Kept(turns) => turns.iter().map(|(axis, _)| *axis).collect(),
            Turns::Angles(order) => order.axes().to_vec(),
        }
    }
}

fn joints(model: &Model, bones: &PlainBones<'_>, frames: &Frames) -> Vec<Joint> {
    let straight = |turn: Mat3| is_identity(turn);
    let all = bones.bones();
    let of_bone = |(index, bone): (usize, &crate::skeleton::PlainBone)| {
        let straight = straight(bone.rest) && bone.parent.is_none_or(|p| straight(all[p].rest));
        let kept = straight.then(|| kept(model, bone.segment)).flatten();
        let far = |local: Affine| (local.translation - bone.offset).norm() > STILL;
        let moves = bone.parent.is_none() || frames.of_bone(index).any(far);
        let turns = kept.map_or_else(
            || Turns::Angles(order(frames.of_bone(index).map(|local| local.linear))),
            Turns::Kept,
        );
        Joint { moves, turns }
    };
    all.iter().enumerate().map(of_bone).collect()
}

fn is_identity(turn: Mat3) -> bool {
    let off = [turn.x - Vec3::X, turn.y - Vec3::Y, turn.z - Vec3::Z];
    off.iter().all(|column| column.norm() < 1e-9)
}

/// The turns of a joint that can be written as they are: about different unit axes, after all steps, each by
/// a coordinate of its own that is zero at rest. Axes without a turn stand behind them.
fn kept(model: &Model, id: SegmentId) -> Option<[(usize, Option<usize>); 3]> {
    let segment = model.segment(id);
    if !is_identity(segment.joint_in_parent.linear) || !is_identity(segment.joint_in_segment.linear)
    {
        return None;
    }
    let component = |signal: Signal| match signal {
        Signal::Output(id, 0) => model.components().get(id.index()),
        _ => None,
    };
    let whole = component(segment.motion?)?;
    let factors: Vec<Signal> = match whole.law {
        Law::Product(_) => whole.inputs.clone(),
        _ => vec![segment.motion?],
    };
    let mut turns = vec![];
    for factor in factors {
        let own = component(factor)?;
        match (&own.law, &own.inputs[..]) {
            (Law::Translate(_), _) if turns.is_empty() => {}
            (Law::Rotate(rotate), [Signal::Coordinate(angle)]) => {
                let axis = Vec3::UNITS.iter().position(|unit| *unit == rotate.axis)?;
                if turns.iter().any(|(other, _)| *other == axis) {
                    return None;
                }
                turns.push((axis, Some(own_angle(model, *angle)?)));
            }
            _ => return None,
        }
    }
    if turns.is_empty() {
        return None;
    }
    // Some programs, such as Blender, refuse joints of fewer than three rotations.
    for axis in [2, 0, 1] {
        if turns.iter().all(|(other, _)| *other != axis) {
            turns.push((axis, None));
        }
    }
    turns.try_into().ok()
}

/// Where the value of a coordinate is that is zero at rest and follows no other.
fn own_angle(model: &Model, id: CoordinateId) -> Option<usize> {
    let coordinate = model.coordinate(id);
    let free = coordinate.follows.is_none() && coordinate.default[0] == 0.0;
    free.then(|| model.stored_range(id).start)
}

/// Names without what ends a name in such files.
fn names(model: &Model, warnings: &mut Vec<Diagnostic>) -> Vec<String> {
    let plain = |name: &str| -> String {
        let bad = |c: char| c.is_whitespace() || matches!(c, '{' | '}' | ',' | ';');
        name.chars().map(|c| if bad(c) { '_' } else { c }).collect()
    };
    let names: Vec<String> = model.segments().iter().map(|segment| plain(&segment.name)).collect();
    let changed = names.iter().zip(model.segments()).filter(|(name, s)| **name != s.name).count();
    if changed > 0 {
        let message = format!("{changed} names hold spaces or braces: written with `_` instead");
        warnings.push(Diagnostic::warning("bvh/renamed", message));
    }
    names
}

/// A number with at most six decimals.
fn push(text: &mut String, value: f64) {
    let start = text.len();
    let _ = write!(text, "{value:.6}");
    let kept = text.trim_end_matches('0').trim_end_matches('.').len();
    text.truncate(kept.max(start));
    if text.get(start..).is_none_or(|number| matches!(number, "-0" | "-" | "")) {
        text.truncate(start);
        text.push('0');
    }
}

fn offset(text: &mut String, depth: usize, at: Vec3) {
    indent(text, depth);
    text.push_str("OFFSET");
    for value in at.to_array() {
        text.push(' ');
        push(text, value);
    }
    text.push('\n');
}

fn indent(text: &mut String, depth: usize) {
    text.extend(std::iter::repeat_n('\t', depth.min(DEEPEST)));
}

/// What is still to be written of the tree.
enum Step {
    Open(usize, usize),
    Close(usize),
}

fn hierarchy(
    text: &mut String,
    model: &Model,
    bones: &PlainBones<'_>,
    joints: &[Joint],
    names: &[String],
    unit: f64,
) {
    let all = bones.bones();
    let mut children: Vec<Vec<usize>> = vec![vec![]; all.len()];
    let mut roots = vec![];
    for (index, bone) in all.iter().enumerate() {
        match bone.parent {
            Some(parent) => children[parent].push(index),
            None => roots.push(index),
        }
    }
    let mut marks: HashMap<SegmentId, Vec<usize>> = HashMap::new();
    for (index, marker) in model.markers().iter().enumerate() {
        if let Some(segment) = marker.segment {
            marks.entry(segment).or_default().push(index);
        }
    }
    let mut open: Vec<Step> = roots.into_iter().rev().map(|root| Step::Open(root, 0)).collect();
    while let Some(step) = open.pop() {
        let (index, depth) = match step {
            Step::Open(index, depth) => (index, depth),
            Step::Close(depth) => {
                indent(text, depth);
                text.push_str("}\n");
                continue;
            }
        };
        let bone = &all[index];
        indent(text, depth);
        text.push_str(if bone.parent.is_none() { "ROOT " } else { "JOINT " });
        text.push_str(&names[bone.segment.index()]);
        text.push('\n');
        indent(text, depth);
        text.push_str("{\n");
        offset(text, depth + 1, bone.offset * (1.0 / unit));
        let joint = &joints[index];
        let axes = joint.axes();
        indent(text, depth + 1);
        let _ = write!(text, "CHANNELS {}", axes.len() + if joint.moves { 3 } else { 0 });
        if joint.moves {
            text.push_str(" Xposition Yposition Zposition");
        }
        for axis in axes {
            let _ = write!(text, " {}rotation", AXES[axis]);
        }
        text.push('\n');
        let own: Vec<usize> = marks.remove(&bone.segment).unwrap_or_default();
        for end in ends(model, bones, index, &own, children[index].is_empty()) {
            indent(text, depth + 1);
            text.push_str("End Site\n");
            indent(text, depth + 1);
            text.push_str("{\n");
            offset(text, depth + 2, end * (1.0 / unit));
            indent(text, depth + 1);
            text.push_str("}\n");
        }
        open.push(Step::Close(depth));
        open.extend(children[index].iter().rev().map(|child| Step::Open(*child, depth + 1)));
    }
}

/// The tips of a bone: markers that are called so; of a last bone else its farthest marker, or a third of its
/// own offset.
fn ends(
    model: &Model,
    bones: &PlainBones<'_>,
    index: usize,
    markers: &[usize],
    last: bool,
) -> Vec<Vec3> {
    let Some(bone) = bones.bones().get(index) else { return vec![] };
    let called = format!("{}_end", model.segment(bone.segment).name);
    let markers = markers.iter().filter_map(|&marker| model.markers().get(marker));
    let place = |point: Vec3| bones.point(index, point);
    let named = markers.clone().filter(|marker| marker.name.starts_with(&called));
    let named: Vec<Vec3> = named.map(|marker| place(marker.point)).collect();
    if !named.is_empty() || !last {
        return named;
    }
    let farthest =
        markers.map(|marker| place(marker.point)).max_by(|a, b| a.norm().total_cmp(&b.norm()));
    let third = if bone.parent.is_some() { bone.offset * (1.0 / 3.0) } else { Vec3::ZERO };
    vec![farthest.filter(|point| point.norm() > 0.005).unwrap_or(third)]
}

fn rows(
    text: &mut String,
    bones: &PlainBones<'_>,
    joints: &[Joint],
    frames: &Frames,
    motion: &Motion,
    unit: f64,
) {
    let _ = write!(text, "MOTION\nFrames: {}\n", frames.locals.len());
    let _ = writeln!(text, "Frame Time: {}", frame_time(motion));
    let written = written(bones);
    let mut before = vec![[0.0; 3]; joints.len()];
    for (locals, effective) in frames.locals.iter().zip(&frames.effective) {
        let start = text.len();
        for &index in &written {
            let (Some(local), Some(joint)) = (locals.get(index), joints.get(index)) else {
                continue;
            };
            let mut number = |value: f64| {
                if text.len() > start {
                    text.push(' ');
                }
                push(text, value);
            };
            if joint.moves {
                local.translation.to_array().into_iter().for_each(|value| number(value / unit));
            }
            match &joint.turns {
                Turns::Kept(turns) => {
                    for (_, place) in turns {
                        let angle = place.and_then(|place| effective.get(place));
                        number(angle.copied().unwrap_or(0.0).to_degrees());
                    }
                }
                Turns::Angles(order) => {
                    before[index] = following(*order, local.linear, before[index]);
                    before[index].into_iter().for_each(|angle| number(angle.to_degrees()));
                }
            }
        }
        text.push('\n');
    }
}

/// The bones in the order in which they are written: each before its children, those in their order.
fn written(bones: &PlainBones<'_>) -> Vec<usize> {
    let all = bones.bones();
    let mut children: Vec<Vec<usize>> = vec![vec![]; all.len()];
    let mut open = vec![];
    for (index, bone) in all.iter().enumerate() {
        match bone.parent {
            Some(parent) => children[parent].push(index),
            None => open.push(index),
        }
    }
    open.reverse();
    let mut order = Vec::with_capacity(all.len());
    while let Some(index) = open.pop() {
        order.push(index);
        open.extend(children[index].iter().rev());
    }
    order
}
