//! BVH files: against Blender, damaged in every way, and written.

use condyle_formats::bvh::{self, USUAL_UNIT};
use condyle_formats::skeleton::Assumed;
use condyle_formats::{Animation, Read};
use condyle_math::{Affine, Mat3, Vec3};
use condyle_model::{Mode, Model, ModelBuilder, Pose, Program, SegmentId, UpAxis};
use condyle_motion::Motion;
use serde_json::Value;
use std::path::{Path, PathBuf};

/// The units of the file, y up.
const PLAIN: Assumed = Assumed { metres_per_unit: Some(1.0), up: Some(UpAxis::Y), rate: None };

fn oracles() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../oracles/bvh")
}

/// A file of the shared data or of the oracles; `None` where the data is absent.
fn file(name: &str) -> Option<Vec<u8>> {
    let path = if name.contains('/') {
        Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data").join(name)
    } else {
        oracles().join(name)
    };
    let bytes = std::fs::read(path).ok();
    if bytes.is_none() {
        println!("skipped: {name} is absent");
    }
    bytes
}

fn answers() -> Value {
    let text = std::fs::read_to_string(oracles().join("positions.json")).unwrap();
    serde_json::from_str(&text).unwrap()
}

fn read(text: &str) -> Read<Animation> {
    bvh::from_bytes_with(text.as_bytes(), &PLAIN).unwrap_or_else(|e| panic!("{e}\n{text}"))
}

/// The places of points of segments in a frame.
fn places(model: &Model, stored: &[f64], points: &[(SegmentId, Vec3)]) -> Vec<Vec3> {
    let program = Program::compile(model);
    let mut pose = Pose::new(&program);
    program.evaluate(stored, Mode::Open, &mut pose).unwrap();
    points.iter().map(|(id, point)| pose.segment(*id) * *point).collect()
}

#[test]
fn joints_are_where_blender_has_them() {
    let answers = answers();
    let mut compared = 0;
    for (name, answer) in answers["files"].as_object().unwrap() {
        let Some(bytes) = file(name) else { continue };
        let Animation { model, motion } = bvh::from_bytes_with(&bytes, &PLAIN).unwrap().value;
        let joints = answer["joints"].as_object().unwrap();
        assert_eq!(joints.len(), model.segments().len(), "{name}");
        let points: Vec<(SegmentId, Vec3)> =
            joints.keys().map(|joint| (model.find_segment(joint).unwrap(), Vec3::ZERO)).collect();
        for (index, frame) in answer["frames"].as_array().unwrap().iter().enumerate() {
            let stored = &motion.frames[frame.as_u64().unwrap() as usize];
            let found = places(&model, stored, &points);
            let place = |rows: &Value| -> [f64; 3] {
                std::array::from_fn(|axis| rows[index][axis].as_f64().unwrap())
            };
            let expected: Vec<Vec3> = joints.values().map(|rows| place(rows).into()).collect();
            let size = expected.iter().map(|p| p.norm()).fold(0.0, f64::max);
            for ((found, expected), joint) in found.iter().zip(&expected).zip(joints.keys()) {
                let off = (*found - *expected).norm();
                assert!(off < 1e-5 * size, "{name}, {joint}, frame {frame}: {off} of {size}");
                compared += 1;
            }
        }
    }
    assert!(compared >= 7 * 4, "mixed.bvh is always there");
}

#[test]
fn read_written_and_read_again_is_the_same() {
    for name in answers()["files"].as_object().unwrap().keys() {
        let Some(bytes) = file(name) else { continue };
        let first = bvh::from_bytes_with(&bytes, &PLAIN).unwrap().value;
        let text = bvh::write(&first.model, &first.motion, Mode::Open, 1.0).unwrap();
        let again = read(&text.value).value;
        assert_eq!(again.motion.times, first.motion.times, "{name}");
        let keys = |model: &Model| -> Vec<String> {
            model.coordinate_ids().map(|id| model.coordinate_key(id)).collect()
        };
        assert_eq!(keys(&again.model), keys(&first.model), "{name}");
        for (frame, (a, b)) in again.motion.frames.iter().zip(&first.motion.frames).enumerate() {
            for (number, (a, b)) in a.iter().zip(b).enumerate() {
                // Six decimals, of a degree or of a unit.
                assert!((a - b).abs() <= 0.51e-6, "{name}: frame {frame}, number {number}");
            }
        }
        // A second time nothing is rounded.
        let third = bvh::write(&again.model, &again.motion, Mode::Open, 1.0).unwrap().value;
        assert_eq!(third, text.value, "{name}");
    }
}

/// One joint, and a second at its end, with what stands behind MOTION.
fn small(motion: &str) -> String {
    format!(
        "HIERARCHY\nROOT a\n{{\nOFFSET 0 1 0\nCHANNELS 2 Xrotation Zrotation\nJOINT b\n{{\nOFFSET 0 2 0\n\
         CHANNELS 1 Yrotation\nEnd Site\n{{\nOFFSET 0 3 0\n}}\n}}\n}}\nMOTION\n{motion}"
    )
}

fn codes(read: &Read<Animation>) -> Vec<&'static str> {
    read.warnings.iter().map(|said| said.code).collect()
}

/// The numbers of all frames, in degrees.
fn degrees(read: &Read<Animation>) -> Vec<Vec<f64>> {
    let rounded = |v: &f64| (v.to_degrees() * 1e9).round() / 1e9;
    read.value.motion.frames.iter().map(|frame| frame.iter().map(rounded).collect()).collect()
}

#[test]
fn motions_as_people_have_them() {
    let two = vec![vec![1.0, 2.0, 3.0], vec![4.0, 5.0, 6.0]];
    let head = "Frames: 2\nFrame Time: 0.01\n";
    for (motion, frames, said) in [
        (format!("{head}1 2 3\n4 5 6\n"), two.clone(), vec![]),
        (format!("{head}1\t2\t3\r\n\r\n4\t5\t6"), two.clone(), vec![]),
        (format!("{head}1, 2, 3\n4,5,6\n"), two.clone(), vec![]),
        (format!("{head}1;2;3;\n4e0 5.0E+00 .6e1\n"), two.clone(), vec![]),
        ("frames : 2\nFRAME TIME:\t0,01\n1,0 2,0 3,0\n4,0 5,0 6,0\n".into(), two.clone(), vec![]),
        ("Frames: 2 Frame Time: 0.01\n1 2 3\n4 5 6\n".into(), two.clone(), vec![]),
        (
            "Frames: 9\nFrame Time: 0.01\n1 2 3\n4 5 6\n".into(),
            two.clone(),
            vec!["bvh/frame-count"],
        ),
        (format!("{head}1 2\n3\n4 5 6\n"), two.clone(), vec!["bvh/broken-rows"]),
        ("Frames: 2\n1 2 3\n4 5 6\n".into(), two.clone(), vec!["bvh/frame-time"]),
        ("Frames: 2\nFrame Time: 0\n1 2 3\n4 5 6".into(), two.clone(), vec!["bvh/frame-time"]),
        ("Frames: 2\nFrame Time: 100\n1 2 3\n4 5 6".into(), two.clone(), vec!["bvh/frame-time"]),
        (
            format!("{head}1 2 3\n4 5\n"),
            vec![vec![1.0, 2.0, 3.0], vec![4.0, 5.0, 3.0]],
            vec!["bvh/row-length"],
        ),
        (format!("{head}1 2 3 7\n4 5 6\n"), two.clone(), vec!["bvh/row-length"]),
        (
            format!("{head}1 nan 3\n4 -1.#IND 6\n"),
            vec![vec![1.0, 0.0, 3.0], vec![4.0, 0.0, 6.0]],
            vec!["bvh/missing"],
        ),
        ("Frames: 0\nFrame Time: 0.01\n".into(), vec![], vec![]),
    ] {
        let found = read(&small(&motion));
        assert_eq!(degrees(&found), frames, "{motion}");
        assert_eq!(codes(&found), said, "{motion}");
        // Without a sensible frame time it is 1/30 s, and 100 is a number of frames per second.
        if frames.len() == 2 {
            let third = motion.contains("Time: 0\n") || !motion.to_lowercase().contains("time");
            let step = if third { 1.0 / 30.0 } else { 0.01 };
            assert!((found.value.motion.times[1] - step).abs() < 1e-12, "{motion}");
        }
    }
    let wrong = bvh::from_bytes(small(&format!("{head}1 2 3\n4 word 6\n")).as_bytes()).unwrap_err();
    assert_eq!(wrong.code(), "bvh/number");
    assert_eq!(wrong.place().map(|p| (p.line, p.column)), Some((20, 3)));
}

#[test]
fn hierarchies_as_people_have_them() {
    let text = "hierarchy\nroot Left Hip: 1{Offset 0,0,0 channels 3 zROTATION Xrotation\nYrotation\n\
        JOINT Left Hip: 1\n{\nOFFSET 0 0\nCHANNELS 4 Xrotation\n}\n\
        joint mid { OFFSET 0 1 0 JOINT tip { OFFSET 0 1 0 } }\n}\n\
        ROOT other\n{\nOFFSET 5 0 0\nCHANNELS 3 Xposition Yposition Zposition\n\
        MOTION\nFrames: 1\nFrame Time: 0.1\n10 20 30 40 7 8 9\n";
    let found = read(text);
    let model = &found.value.model;
    let names: Vec<&str> = model.segments().iter().map(|s| s.name.as_str()).collect();
    assert_eq!(names, ["Left Hip: 1", "Left Hip: 1#2", "mid", "tip", "other"]);
    let parents: Vec<Option<usize>> =
        model.segments().iter().map(|s| s.parent.map(|p| p.index())).collect();
    assert_eq!(parents, [None, Some(0), Some(0), Some(2), None]);
    let keys: Vec<String> = model.coordinate_ids().map(|id| model.coordinate_key(id)).collect();
    let of = |joint: &str, names: [&str; 3]| names.map(|name| format!("{joint}/{name}"));
    assert_eq!(
        keys[..3],
        of("Left Hip: 1", ["rz", "rx", "ry"]).map(|k| match &k[..] {
            // The key of a name that only one joint has is the name.
            "Left Hip: 1/rz" => "rz".to_owned(),
            "Left Hip: 1/ry" => "ry".to_owned(),
            _ => k,
        })
    );
    // The root's place is its positions; the file's unit is a metre here.
    assert_eq!(found.value.motion.frames[0][4..], [7.0, 8.0, 9.0]);
    assert_eq!(codes(&found), ["bvh/offset", "bvh/channel-count", "bvh/brace", "skeleton/name"]);
    for (text, code) in [
        ("HIERARCHY\nMOTION\n", "bvh/no-joint"),
        ("HIERARCHY\nROOT a\n{\nOFSET 0 0 0\n}\n", "bvh/grammar"),
        ("OFFSET 0 0 0\n", "bvh/grammar"),
        ("", "bvh/no-joint"),
    ] {
        assert_eq!(bvh::from_bytes(text.as_bytes()).unwrap_err().code(), code, "{text}");
    }
}

#[test]
fn positions_of_a_joint_are_told_from_steps() {
    let with = |row: &str| {
        let text = format!(
            "HIERARCHY\nROOT a\n{{\nOFFSET 0 0 0\nCHANNELS 1 Xrotation\nJOINT b\n{{\nOFFSET 0 10 0\n\
             CHANNELS 4 Yrotation Zposition Yposition Xposition\n}}\n}}\nMOTION\nFrames: 1\n\
             Frame Time: 0.1\n{row}\n"
        );
        read(&text)
    };
    // In the order tx, ty, tz, ry: steps from the OFFSET in both cases.
    let absolute = with("0 90 1 10.5 2");
    assert_eq!(absolute.value.motion.frames[0][1..4], [2.0, 0.5, 1.0]);
    assert_eq!(codes(&absolute), Vec::<&str>::new());
    let steps = with("0 90 1 0.5 2");
    assert_eq!(steps.value.motion.frames[0][1..4], [2.0, 0.5, 1.0]);
    assert_eq!(codes(&steps), ["bvh/relative-positions"]);
}

#[test]
fn rows_that_are_far_too_short_take_no_memory() {
    let mut text = String::from("HIERARCHY\n");
    for joint in 0..4000 {
        text.push_str(&format!("ROOT j{joint} {{ CHANNELS 3 Xrotation Yrotation Zrotation }}\n"));
    }
    text.push_str("MOTION\nFrames: 100000\nFrame Time: 0.01\n");
    text.push_str(&"0\n".repeat(100_000));
    assert_eq!(bvh::from_bytes(text.as_bytes()).unwrap_err().code(), "bvh/short-rows");
    let deep = format!("HIERARCHY\n{}", "JOINT a {\n".repeat(6000));
    assert_eq!(bvh::from_bytes(deep.as_bytes()).unwrap_err().code(), "bvh/size");
}

/// A thigh with a bent rest pose, a shank whose centre moves with its angle in an oblique frame, and a
/// patella that is stretched.
fn leg() -> Model {
    let mut b = ModelBuilder::new("leg");
    let thigh = b.segment("thigh", None);
    let turned =
        Affine::new(Mat3::rotation_x(0.3) * Mat3::rotation_y(0.2), Vec3::new(0.1, 0.9, 0.0));
    b.place_joint_frames(thigh, turned, Affine::from_translation(Vec3::new(0.0, 0.1, 0.02)));
    let (_, hip) = b.ball_joint("hip", thigh);
    b.coordinate_mut(hip).default = [0.1, 0.0, 0.0, 0.99f64.sqrt()];
    let shank = b.segment("shank", Some(thigh));
    let knee_frame = Affine::new(Mat3::rotation_z(0.1), Vec3::new(0.0, -0.4, 0.01));
    b.place_joint_frames(shank, knee_frame, Affine::new(Mat3::rotation_z(-0.2), Vec3::Y * 0.03));
    let set = b.joint_set("knee");
    let angle = b.coordinate(set, "flexion", condyle_model::CoordinateKind::Rotation);
    let turn = b.rotate(set, "turn", angle, Vec3::new(0.6, 0.0, 0.8));
    let glide = condyle_math::function::Function::linear(0.01, 0.0);
    let glide = b.map(set, "glide", angle, glide);
    let glide = b.translate(set, "slide", glide, Vec3::X);
    let motion = b.product(set, "motion", vec![glide, turn]);
    b.output(set, shank, motion);
    let foot = b.segment("foot", Some(shank));
    b.place_joint(foot, Vec3::Y * -0.4);
    b.hinge("ankle", foot, "dorsiflexion", Vec3::Z);
    b.marker("toe", Some(foot), Vec3::new(0.2, -0.05, 0.0));
    b.build().unwrap()
}

#[test]
fn joint_centres_of_any_model_are_kept() {
    let model = leg();
    let frames: Vec<Vec<f64>> = (0..=60)
        .map(|step| {
            let angle = f64::from(step) * 0.05;
            let [s, c] = [(angle / 2.0).sin(), (angle / 2.0).cos()];
            vec![0.48 * s, 0.6 * s, 0.64 * s, c, angle, 0.3 - angle]
        })
        .collect();
    let times = (0..frames.len()).map(|frame| frame as f64 * 0.01).collect();
    let motion = Motion { times, frames };
    let text = bvh::write(&model, &motion, Mode::Open, USUAL_UNIT).unwrap();
    assert_eq!(text.warnings, []);
    let assumed = Assumed { metres_per_unit: Some(USUAL_UNIT), ..PLAIN };
    let again = bvh::from_bytes_with(text.value.as_bytes(), &assumed).unwrap().value;
    let ids = |model: &Model| ["thigh", "shank", "foot"].map(|n| model.find_segment(n).unwrap());
    let own = ids(&model).map(|id| (id, model.segment(id).joint_in_segment.translation));
    let other = ids(&again.model).map(|id| (id, Vec3::ZERO));
    let toe = again.model.markers().iter().find(|m| m.name == "foot_end").unwrap().clone();
    let own = [own.as_slice(), &[(own[2].0, Vec3::new(0.2, -0.05, 0.0))]].concat();
    let other = [other.as_slice(), &[(other[2].0, toe.point)]].concat();
    for (frame, stored) in motion.frames.iter().enumerate() {
        let expected = places(&model, stored, &own);
        let found = places(&again.model, &again.motion.frames[frame], &other);
        for (found, expected) in found.iter().zip(&expected) {
            // Six decimals of a centimetre and of a degree, over half a metre.
            assert!((*found - *expected).norm() < 3e-8, "frame {frame}: {found:?} {expected:?}");
        }
    }
    // The knee's centre moves by 1 cm a radian, so it has positions; the ankle has none.
    assert!(text.value.contains("JOINT shank\n\t{\n\t\tOFFSET"));
    let channels: Vec<&str> =
        text.value.lines().filter_map(|l| l.trim().strip_prefix("CHANNELS ")).collect();
    assert_eq!(channels.iter().map(|c| &c[..1]).collect::<Vec<_>>(), ["6", "6", "3"]);
    // No angle jumps.
    for pair in again.motion.frames.windows(2) {
        for (a, b) in pair[0].iter().zip(&pair[1]) {
            assert!((a - b).abs() < 0.5, "{a} {b}");
        }
    }
}

#[test]
fn the_axis_that_points_up_is_told_by_the_pose() {
    let figure = |up: [f64; 3]| {
        let [x, y, z] = up;
        format!(
            "HIERARCHY\nROOT hips {{ OFFSET 0 0 0 CHANNELS 1 Xrotation\nJOINT head {{ OFFSET {x} {y} {z} }}\n\
             JOINT foot {{ OFFSET {} {} {} }} }}\nMOTION\nFrames: 1\nFrame Time: 1\n0\n",
            -x, -y, -z
        )
    };
    for (up, axis) in [([0.0, 9.0, 1.0], UpAxis::Y), ([0.0, 1.0, 9.0], UpAxis::Z)] {
        let read = bvh::from_bytes(figure(up).as_bytes()).unwrap();
        assert_eq!(read.value.model.up(), axis);
        assert_eq!(read.warned("skeleton/up"), axis == UpAxis::Z);
        assert!(read.warned("skeleton/unit"));
    }
}
