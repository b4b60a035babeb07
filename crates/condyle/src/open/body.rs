//! The body of poses of SMPL, which such files do not hold: where its joints are at rest.

use super::{Cause, OpenError, failed, source};
use crate::retargeting::recognise;
use crate::shipped;
use condyle_diagnostics::{Diagnostic, Error, Read};
use condyle_formats::document::names;
use condyle_formats::skeleton::Assumed;
use condyle_formats::smpl::{self, Rest, Tree};
use condyle_formats::{Content, ContentKind};
use condyle_math::{Mat3, Vec3};
use condyle_model::{Model, Pose, Program, UpAxis};
use condyle_track::retarget::{Body, Finger, Part};
use std::path::{Path, PathBuf};
use std::sync::Mutex;

/// Whose proportions are taken where no body is told.
const USUAL: &str = "human";
/// Limbs that point this near to where SMPL has them at rest are left as they are.
const NEAR: f64 = std::f64::consts::FRAC_PI_6;

/// The file of the body, once one is told.
static BODY: Mutex<Option<PathBuf>> = Mutex::new(None);

/// Says which body poses of SMPL belong to that are opened from here on: one of SMPL (`.npz`), or any model whose
/// bones have names that are known, from which only places are taken. The first call counts; without one the
/// proportions are those of the shipped `human`.
pub fn body_is(path: &Path) {
    if let Ok(mut told) = BODY.lock() {
        told.get_or_insert_with(|| path.to_owned());
    }
}

/// A file of NumPy: poses with their body, or a body.
pub(super) fn opened(
    path: &Path,
    bytes: &[u8],
    assumed: &Assumed,
) -> Result<Read<Content>, OpenError> {
    let wrong = |error| failed(path, Cause::Content { error, text: None });
    if smpl::is_body(bytes) {
        let Read { value, warnings } = smpl::rest(bytes).map_err(wrong)?;
        let mut read = value.model().map_err(wrong)?;
        read.warnings.splice(0..0, warnings);
        return Ok(read.map(Content::Model));
    }
    let told = BODY.lock().ok().and_then(|told| told.clone());
    let Read { value: rest, warnings } = match &told {
        Some(body) => rest_of(body)?,
        None => {
            let model = shipped::read(USUAL)?.value.model;
            rest_of_model(&model).map_err(wrong)?
        }
    };
    let read = smpl::from_bytes_with(bytes, &rest, assumed).map_err(wrong)?;
    let mut read = read.map(|found| Content::Animation(Box::new(found)));
    let body = told.unwrap_or_else(|| PathBuf::from(USUAL));
    let said = warnings.iter().map(|said| {
        let text = format!("{}: {}", body.display(), said.message);
        let copy = Diagnostic::new(said.severity, said.code, text);
        match said.help.is_empty() {
            true => copy,
            false => copy.with_help(said.help.clone()),
        }
    });
    read.warnings.extend(said);
    Ok(read)
}

/// The places of joints that a file tells.
fn rest_of(path: &Path) -> Result<Read<Rest>, OpenError> {
    let wrong = |error| failed(path, Cause::Content { error, text: None });
    if super::ending(path) == "npz" {
        return smpl::rest(&source::bytes(path)?).map_err(wrong);
    }
    let Read { value, mut warnings } = super::content(path, Some(ContentKind::Model))?;
    let model = match value {
        Content::Model(model) => model,
        Content::Document(document) => document.model,
        Content::Animation(animation) => animation.model,
        _ => return Err(failed(path, Cause::Format { wanted: Some(ContentKind::Model) })),
    };
    let read = rest_of_model(&model).map_err(wrong)?;
    warnings.extend(read.warnings);
    Ok(Read { value: read.value, warnings })
}

/// The joints of a model at its defaults by the names of SMPL, in SMPL's posture at rest.
///
/// Segments that bear the names of SMPL's joints are those; else the parts of the body are recognised
/// ([`recognise`]), and the pelvis is put above the middle of the hips. Where arms or legs point more than 30° away from where they do in SMPL's posture, or elbows are bent, they
/// are stretched, each bone as long as it is.
///
/// # Errors
/// `retarget/names` where the bones are not recognised.
fn rest_of_model(model: &Model) -> Result<Read<Rest>, Error> {
    let program = Program::compile(model);
    let mut pose = Pose::new(&program);
    let evaluated = program.evaluate(&model.defaults(), condyle_model::Mode::Open, &mut pose);
    evaluated.map_err(|error| Error::new("smpl/rest", error.to_string()))?;
    let turned = turn_of(model);
    let mut warnings = vec![];
    let recognised = recognise(model, None);
    let at = |body: &Body, part: Part| {
        body.get(part).map(|anchor| turned * (pose.segment(anchor.segment) * anchor.point))
    };
    let mut joints: Vec<(String, Vec3)> = vec![];
    let named = |joint: &str| {
        let found = model.segment_ids().find(|id| is_named(&model.segment(*id).name, joint));
        let place = |id| {
            let segment = model.segment(id);
            turned * (pose.segment(id) * segment.joint_in_segment.translation)
        };
        found.map(place)
    };
    let body = match recognised {
        Ok(found) => {
            warnings.extend(found.warnings);
            found.body
        }
        Err(error) if named("left_hip").is_none() => return Err(error),
        Err(_) => Body::default(),
    };
    let parts = parts_of_joints();
    let spine = trunk(&body, &at);
    for (joint, _) in Tree::SmplX.joints().into_iter().chain(Tree::Smpl.joints()) {
        if joints.iter().any(|(known, _)| *known == joint) {
            continue;
        }
        let by_part = || {
            let part = parts.iter().find(|(name, _)| is_named(name, &joint))?.1;
            let exact = match part {
                Part::Shank(side) => at(&body, Part::Knee(side)),
                Part::Foot(side) => at(&body, Part::Ankle(side)),
                _ => None,
            };
            let near = || match part {
                Part::Toes(side) => at(&body, Part::Ball(side)),
                Part::HandTip(side) => at(&body, Part::Finger(side, Finger::Middle, 0)),
                _ => None,
            };
            exact.or_else(|| at(&body, part)).or_else(near)
        };
        let place = named(&joint).or_else(|| spine_joint(&spine, &joint)).or_else(by_part);
        joints.extend(place.map(|place| (joint, place)));
    }
    if named("pelvis").is_none() || named("left_hip").is_none() {
        between_hips(&mut joints);
    }
    if let Some(said) = stretched(&mut joints) {
        warnings.push(Diagnostic::note("smpl/posture", said));
    }
    let name = if model.name().is_empty() { "the model" } else { model.name() };
    Ok(Read { value: Rest::new(&format!("`{name}`"), joints), warnings })
}

/// Puts the joint of the pelvis above the middle of the hips, where SMPL has it: that of a model of bones may be at
/// the front of the pelvis.
fn between_hips(joints: &mut [(String, Vec3)]) {
    let find = |name: &str| joints.iter().find(|(joint, _)| joint == name).map(|(_, at)| *at);
    let (Some(left), Some(right)) = (find("left_hip"), find("right_hip")) else { return };
    let middle = (left + right) * 0.5;
    if let Some((_, pelvis)) = joints.iter_mut().find(|(joint, _)| joint == "pelvis") {
        *pelvis = Vec3::new(middle.x, pelvis.y, middle.z);
    }
}

/// From the axes of a model to those of SMPL: y up, looking along +z.
fn turn_of(model: &Model) -> Mat3 {
    let up = match model.up() {
        UpAxis::Y => Vec3::Y,
        UpAxis::Z => Vec3::Z,
    };
    let ahead = model.facing().ahead(model.up());
    let left = up.cross(ahead);
    // Its rows are the axes of SMPL in the model.
    Mat3::from_columns(left, up, ahead).transpose()
}

/// Whether a bone bears the name of a joint: in any case, `L_Hip` or `left_hip`, behind any prefix such as
/// `m_avg_`.
fn is_named(bone: &str, joint: &str) -> bool {
    let plain = |name: &str| -> String {
        let lower = name.to_ascii_lowercase();
        lower.chars().filter(|c| c.is_alphanumeric()).collect()
    };
    let bone = bone.to_ascii_lowercase();
    let bone = bone.rsplit(':').next().unwrap_or(&bone);
    let bone = ["m_avg_", "f_avg_"].iter().find_map(|p| bone.strip_prefix(p)).unwrap_or(bone);
    let long = match bone.split_once('_') {
        Some(("l", rest)) => format!("left_{rest}"),
        Some(("r", rest)) => format!("right_{rest}"),
        _ => bone.to_owned(),
    };
    plain(&long) == plain(joint)
}

/// The names of SMPL's joints with the parts of the body that they are.
fn parts_of_joints() -> Vec<(String, Part)> {
    let text = shipped::skeletons().find(|(name, _)| *name == "smpl").map_or("", |(_, text)| text);
    let table = names::read(text, &mut |_| Err("it stands alone".to_owned()));
    let table = table.map_or_else(|_| Default::default(), |read| read.value);
    let all = table.iter().filter(|(part, _)| part != "spine").flat_map(|(part, names)| {
        let part = Part::named(part);
        names.iter().filter_map(move |name| Some((name.clone(), part?)))
    });
    all.collect()
}

/// Three joints of the spine: those of a model that has three, else at each quarter of the way from the pelvis to the
/// neck.
fn trunk(body: &Body, at: &dyn Fn(&Body, Part) -> Option<Vec3>) -> Vec<Vec3> {
    let lower = (0..24).filter_map(|number| at(body, Part::Spine(number)));
    let line: Vec<Vec3> = lower.chain(at(body, Part::Chest)).collect();
    if line.len() == 3 {
        return line;
    }
    let (Some(pelvis), Some(neck)) = (at(body, Part::Pelvis), at(body, Part::Neck)) else {
        return vec![];
    };
    // Bones whose joints are not above each other are left out.
    let mut way = vec![pelvis];
    for point in line {
        if way.last().is_none_or(|last| point.y > last.y) && point.y < neck.y {
            way.push(point);
        }
    }
    way.push(neck);
    let lengths: Vec<f64> = way.windows(2).map(|pair| (pair[1] - pair[0]).norm()).collect();
    let total: f64 = lengths.iter().sum();
    let place = |share: f64| {
        let mut left = share * total;
        for (pair, length) in way.windows(2).zip(&lengths) {
            if left <= *length && *length > 0.0 {
                return pair[0] + (pair[1] - pair[0]) * (left / length);
            }
            left -= length;
        }
        neck
    };
    [0.25, 0.5, 0.75].map(place).to_vec()
}

fn spine_joint(spine: &[Vec3], joint: &str) -> Option<Vec3> {
    let number: usize = joint.strip_prefix("spine")?.parse().ok()?;
    spine.get(number.checked_sub(1)?).copied()
}

/// The joints of a limb: from the trunk outwards, and what hangs on the last one.
struct Limb {
    side: &'static str,
    bones: [&'static str; 3],
    hangs: &'static [&'static str],
}

const FINGERS: [&str; 6] = ["index", "middle", "pinky", "ring", "thumb", "hand"];

impl Limb {
    fn hangs(&self, joint: &str) -> bool {
        let rest = joint.strip_prefix(self.side).and_then(|rest| rest.strip_prefix('_'));
        rest.is_some_and(|rest| self.hangs.iter().any(|name| rest.starts_with(name)))
    }
}

/// Brings limbs to where SMPL has them at rest, and says so where one was elsewhere.
fn stretched(joints: &mut [(String, Vec3)]) -> Option<String> {
    let mut said = None;
    for (side, sign) in [("left", 1.0), ("right", -1.0)] {
        let arm = Limb { side, bones: ["shoulder", "elbow", "wrist"], hangs: &FINGERS };
        let leg = Limb { side, bones: ["hip", "knee", "ankle"], hangs: &["foot"] };
        for (limb, direction, name) in [(arm, Vec3::X * sign, "arms"), (leg, -Vec3::Y, "legs")] {
            let find = |joints: &[(String, Vec3)], what: &str| {
                let name = format!("{side}_{what}");
                joints.iter().find(|(joint, _)| *joint == name).map(|(_, place)| *place)
            };
            let places = limb.bones.map(|bone| find(joints, bone));
            let [Some(first), Some(second), Some(third)] = places else { continue };
            let (upper, lower) = (second - first, third - second);
            let near = |bone: Vec3| bone.dot(direction) >= NEAR.cos() * bone.norm();
            if near(upper) && near(lower) {
                continue;
            }
            let middle = first + direction * upper.norm();
            let end = middle + direction * lower.norm();
            let turn = match name {
                "arms" => hand_turn(joints, side, third, direction),
                _ => Mat3::IDENTITY,
            };
            let names = limb.bones.map(|bone| format!("{side}_{bone}"));
            for (joint, place) in joints.iter_mut() {
                if *joint == names[1] {
                    *place = middle;
                } else if *joint == names[2] {
                    *place = end;
                } else if limb.hangs(joint) {
                    *place = end + turn * (*place - third);
                }
            }
            let text = "at rest its limbs are elsewhere than in SMPL's posture: they are stretched";
            said = Some(format!("{text} ({name})"));
        }
    }
    said
}

/// What turns a hand so that its fingers point along a direction, and its palm down with the index ahead.
fn hand_turn(joints: &[(String, Vec3)], side: &str, wrist: Vec3, direction: Vec3) -> Mat3 {
    let find = |what: &str| {
        let name = format!("{side}_{what}");
        joints.iter().find(|(joint, _)| *joint == name).map(|(_, place)| *place)
    };
    let frame = |along: Vec3, ahead: Vec3| {
        let along = along * (1.0 / along.norm());
        let ahead = ahead - along * along.dot(ahead);
        let ahead = ahead * (1.0 / ahead.norm());
        Mat3::from_columns(along, ahead, along.cross(ahead))
    };
    let knuckles = (find("middle1"), find("index1"), find("pinky1"));
    let (Some(middle), Some(index), Some(little)) = knuckles else { return Mat3::IDENTITY };
    let turn = frame(direction, Vec3::Z) * frame(middle - wrist, index - little).transpose();
    let finite = [turn.x, turn.y, turn.z].iter().all(|column| column.norm().is_finite());
    if finite { turn } else { Mat3::IDENTITY }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Lengths of its bones are those of `human`; its arms are stretched out with the palms down.
    #[test]
    fn human_stands_as_smpl_does() {
        let human = shipped::read("human").unwrap().value.model;
        let read = rest_of_model(&human).unwrap();
        let rest = read.value;
        let at = |name: &str| rest.joint(name).unwrap_or_else(|| panic!("no {name}"));
        let program = Program::compile(&human);
        let mut pose = Pose::new(&program);
        program.evaluate(&human.defaults(), condyle_model::Mode::Open, &mut pose).unwrap();
        let place = |name: &str| {
            let id = human.find_segment(name).unwrap();
            pose.segment(id) * human.segment(id).joint_in_segment.translation
        };
        let upper = (place("ulna_r") - place("humerus_r")).norm();
        assert!(((at("right_elbow") - at("right_shoulder")).norm() - upper).abs() < 1e-12);
        for (side, sign) in [("left", 1.0), ("right", -1.0)] {
            let of = |name: &str| at(&format!("{side}_{name}"));
            let arm = (of("wrist") - of("shoulder")) * sign;
            assert!(arm.y.abs() < 1e-12 && arm.z.abs() < 1e-12 && arm.x > 0.4, "{arm:?}");
            assert!((of("hip") - at("pelvis")).x * sign > 0.05);
            assert!(of("foot").z - of("ankle").z > 0.08, "toes are ahead");
            assert!(of("index1").z - of("pinky1").z > 0.03, "palms are down, thumbs ahead");
            assert!((of("middle3") - of("middle1")).x * sign > 0.04);
            assert!((of("thumb1") - of("wrist")).z > 0.0);
        }
        let hips = (at("left_hip") + at("right_hip")) * 0.5;
        assert!((at("pelvis") - hips).x.abs() < 1e-12 && (at("pelvis") - hips).z.abs() < 1e-12);
        let heights = ["pelvis", "spine1", "spine2", "spine3", "neck", "head"].map(|j| at(j).y);
        assert!(heights.windows(2).all(|pair| pair[1] > pair[0] + 0.03), "{heights:?}");
        assert!((at("left_hip").y - at("left_ankle").y) > 0.7);
    }

    #[test]
    fn names_of_bones() {
        for bone in ["L_Hip", "left_hip", "m_avg_L_Hip", "smpl:LeftHip", "leftHip"] {
            assert!(is_named(bone, "left_hip"), "{bone}");
        }
        assert!(!is_named("hip", "left_hip") && !is_named("R_Hip", "left_hip"));
        assert!(is_named("Spine1", "spine1") && !is_named("Spine", "spine1"));
    }
}
