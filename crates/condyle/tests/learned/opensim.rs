//! Arms on real recordings beside OpenSim: marker errors of its own inverse kinematics on the frames that were left out, and where it
//! has the shank (`oracles/arms/`).

use condyle::learn::arms::{Arm, Leg, Sizes};
use condyle::learn::calibration::FreeJoint;
use condyle::learn::coupling::Groups;
use condyle::learning::arms::{Compared, How, Person, Question, Trial, compare};
use condyle::math::{Affine, Mat3, Vec3};
use condyle::{Mode, Model, Pose, Program, open};
use serde_json::Value;
use std::path::{Path, PathBuf};

fn data() -> Option<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data/knee");
    if folder.is_dir() {
        return Some(folder);
    }
    println!("skipped: shared data absent");
    None
}

fn answers() -> Value {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../oracles/arms/answers.json");
    let text = std::fs::read_to_string(path).expect("the answers of OpenSim");
    serde_json::from_str(&text).expect("JSON")
}

fn list(text: &str) -> (String, Vec<String>) {
    let (name, markers) = text.split_once('=').expect("a segment and its markers");
    (name.to_owned(), markers.split(',').map(str::to_owned).collect())
}

/// The person of an answer, by the options that the command was given.
fn person(folder: &Path, name: &str, answer: &Value) -> Person {
    let options: Vec<&str> =
        answer["options"].as_array().unwrap().iter().filter_map(Value::as_str).collect();
    let option =
        |key: &str| options[options.iter().position(|o| *o == key).unwrap() + 1].to_owned();
    let [(above, upper), (below, lower)] = ["--parent", "--child"].map(|key| list(&option(key)));
    let joint = FreeJoint {
        segments: [above, below],
        markers: [upper, lower],
        origin: option("--origin"),
        ends: [option("--medial"), option("--lateral")],
        ..FreeJoint::knee_pronost2010()
    };
    let path = |name: &Value| folder.join(name.as_str().unwrap());
    let standing = open::recording(&path(&answer["static"])).unwrap().value;
    let trials = answer["trials"].as_array().unwrap().iter().map(|file| {
        let path = path(file);
        let name = path.file_stem().unwrap().to_string_lossy().into_owned();
        let recording = open::recording(&path).unwrap().value;
        Trial { groups: Groups::of_name(&name), name, recording }
    });
    let trials = trials.collect();
    Person {
        name: name.to_owned(),
        leg: Leg::of(&joint.model(&standing).unwrap(), &joint.name).unwrap(),
        sizes: Sizes::of(&joint, &standing),
        trials,
    }
}

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("{value} is no number"))
}

#[test]
fn marker_errors_on_trials_left_out_are_those_of_opensim() {
    let Some(folder) = data() else { return };
    for (name, answer) in answers().as_object().unwrap() {
        let person = person(&folder, name, answer);
        let question =
            Question::ALL.into_iter().find(|q| answer["question"] == q.name()).expect("a question");
        let persons = [person];
        let all = compare(&persons, &How::default(), &mut |_| {}).unwrap().value;
        let all: Vec<&Compared> = all.iter().filter(|one| one.question == question).collect();
        assert!(!all.is_empty());
        for one in &all {
            let trial = &persons[0].trials[one.trial].name;
            for arm in Arm::COMPARED {
                let theirs = &answer["errors"][trial][arm.name()];
                let ours = one.of(arm).unwrap();
                // Of some trials the first seconds are kept.
                let counted: Vec<f64> =
                    ours.rms.iter().copied().filter(|rms| rms.is_finite()).collect();
                let frames = theirs["frames"].as_u64().unwrap() as usize;
                let all = answer["seconds"].is_null();
                assert!(frames == counted.len() || !all && frames > 100, "{trial} {arm:?}");
                let mean = 1e3 * counted[..frames].iter().sum::<f64>() / frames as f64;
                let theirs_mean = number(&theirs["rms_mm"]);
                println!(
                    "{name} {trial} {}: {mean:.4} mm, OpenSim {theirs_mean:.4} mm",
                    arm.name()
                );
                if TURNED_OVER.contains(&arm) {
                    assert!(theirs_mean > 4.0 * mean, "{trial} {arm:?}: {mean} {theirs_mean}");
                    continue;
                }
                // Both minimise the sum of squares; the mean of its root differs by where they stop.
                let within = TOLERANCE * theirs_mean + 1e-3;
                assert!(
                    (mean - theirs_mean).abs() < within,
                    "{trial} {arm:?}: {mean} {theirs_mean}"
                );
            }
        }
        shanks(&persons[0].leg, all[0], answer);
    }
}

/// OpenSim starts from the standing posture, which is turned by half a turn from this trial, and stays in other minima with these.
const TURNED_OVER: [Arm; 3] = [Arm::Hinge, Arm::Planar, Arm::Learned];

/// How far the mean errors may be apart, relatively.
const TOLERANCE: f64 = 5e-3;

/// Where OpenSim has the shank in the poses that are kept.
fn shanks(leg: &Leg, one: &Compared, answer: &Value) {
    let centre = &one.parts[0].centre;
    for arm in Arm::COMPARED {
        let model = leg.arm(arm, Some(centre)).unwrap();
        let answer_of = &answer["poses"][arm.name()];
        // What the script found over its 100 poses.
        assert!(number(&answer_of["pose_difference_m"]) < 1e-6, "{arm:?}");
        let kept = answer_of["kept"].as_array().unwrap();
        let asked = answer["asked"].as_array().unwrap();
        for (pose, rows) in asked.iter().zip(kept) {
            let found = shank(&model, pose);
            let r: Vec<f64> = rows.as_array().unwrap().iter().map(number).collect();
            let linear = Mat3::from_columns(
                Vec3::new(r[0], r[4], r[8]),
                Vec3::new(r[1], r[5], r[9]),
                Vec3::new(r[2], r[6], r[10]),
            );
            let theirs = Affine { linear, translation: Vec3::new(r[3], r[7], r[11]) };
            for point in [Vec3::ZERO, Vec3::new(0.0, -0.4, 0.0)] {
                let apart = (found * point - theirs * point).norm();
                assert!(apart < 1e-6, "{arm:?}: {apart}");
            }
        }
    }
}

fn shank(model: &Model, pose: &Value) -> Affine {
    let mut stored = model.defaults();
    for (name, value) in pose.as_object().unwrap() {
        let id = model.find_coordinate(name).unwrap();
        let coordinate = model.coordinate(id);
        if coordinate.locked || coordinate.follows.is_some() {
            continue;
        }
        // Places of the knee are told as distances from their defaults.
        let from = if name.starts_with("knee_r_t") { coordinate.default[0] } else { 0.0 };
        *model.value_mut(&mut stored, id) = from + number(value);
    }
    let program = Program::compile(model);
    let mut posed = Pose::new(&program);
    program.evaluate(&stored, Mode::Open, &mut posed).unwrap();
    posed.segment(model.find_segment("shank_r").unwrap())
}
