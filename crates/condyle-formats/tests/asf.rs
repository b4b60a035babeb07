//! ASF and AMC files: against an evaluator in Python, and damaged in every way.

use condyle_formats::skeleton::Assumed;
use condyle_formats::{Animation, Read, asf};
use condyle_math::Vec3;
use condyle_model::{Mode, Model, Pose, Program, SegmentId, UpAxis};
use serde_json::Value;
use std::path::{Path, PathBuf};

const PLAIN: Assumed =
    Assumed { metres_per_unit: Some(1.0), up: Some(UpAxis::Y), rate: Some(100.0) };

fn data() -> Option<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data");
    if !folder.is_dir() {
        println!("skipped: shared data absent");
    }
    folder.is_dir().then_some(folder)
}

fn places(model: &Model, stored: &[f64], points: &[(SegmentId, Vec3)]) -> Vec<Vec3> {
    let program = Program::compile(model);
    let mut pose = Pose::new(&program);
    program.evaluate(stored, Mode::Open, &mut pose).unwrap();
    points.iter().map(|(id, point)| pose.segment(*id) * *point).collect()
}

/// A marker of a model by its name: every bone has one at its beginning, and last bones have one at their end.
fn marker(model: &Model, name: &str) -> (SegmentId, Vec3) {
    let found = model.markers().iter().find(|marker| marker.name == name);
    let found = found.unwrap_or_else(|| panic!("no marker {name}"));
    (found.segment.unwrap(), found.point)
}

#[test]
fn joints_are_where_the_definition_puts_them() {
    let Some(folder) = data() else { return };
    let oracle = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../oracles/asf/positions.json");
    let answers: Value = serde_json::from_str(&std::fs::read_to_string(oracle).unwrap()).unwrap();
    let mut compared = 0;
    for (name, answer) in answers["files"].as_object().unwrap() {
        let path = folder.join(name);
        let subject = path.file_stem().unwrap().to_str().unwrap()[..2].to_owned();
        let skeleton = std::fs::read(path.with_file_name(format!("{subject}.asf"))).unwrap();
        let take = std::fs::read(&path).unwrap();
        let read = asf::with_skeleton(&take, &skeleton, &PLAIN).unwrap();
        assert_eq!(read.warnings, [], "{name}");
        let Animation { model, motion } = read.value;
        let joints = answer["joints"].as_object().unwrap();
        assert_eq!(joints.len(), model.markers().len(), "{name}");
        let points: Vec<(SegmentId, Vec3)> = joints.keys().map(|n| marker(&model, n)).collect();
        for (index, frame) in answer["frames"].as_array().unwrap().iter().enumerate() {
            let stored = &motion.frames[frame.as_u64().unwrap() as usize];
            let found = places(&model, stored, &points);
            for ((found, rows), joint) in found.iter().zip(joints.values()).zip(joints.keys()) {
                let expected: [f64; 3] =
                    std::array::from_fn(|axis| rows[index][axis].as_f64().unwrap());
                // Thirteen digits of some tens of units.
                let off = (*found - Vec3::from(expected)).norm();
                assert!(off < 1e-10, "{name}, {joint}, frame {frame}: {off}");
                compared += 1;
            }
        }
    }
    assert_eq!(compared, 7 * 4 * 38);
}

#[test]
fn the_unit_of_the_carnegie_mellon_recordings_is_known() {
    let Some(folder) = data() else { return };
    let bytes = std::fs::read(folder.join("shoulder/cmu01/01.asf")).unwrap();
    let read = asf::read(&bytes, &Assumed::default()).unwrap();
    assert_eq!(read.warnings, []);
    // lfemur is 7.1578 units long: 7.1578 / 0.45 inches are 0.404 m.
    let shank = read.value.segment(read.value.find_segment("ltibia").unwrap());
    let length = shank.joint_in_parent.translation.norm();
    assert!((length - 7.1578 / 0.45 * 0.0254).abs() < 1e-6, "{length}");
}

const SKELETON: &str = "# comment\n:version 1.10\n:name Anna B\n:units\n  mass 1.0\n  length 1.0\n  angle rad\n\
    :documentation\n  anything: begin end\n:root\n  order TX ty TZ RZ RY RX\n  axis XYZ\n  position 1 2 3\n\
      orientation 0 0 0\n:bonedata\nbegin\n id 1\n name Thigh\n direction 0, -1, 0\n length 2\n\
     axis 0.1 0.2 0.3 ZXY # first z\n dof rx ry tz l\n limits (-1.5 inf)\n (-0.5 0.5)\n (-inf inf) (0 1)\nend\n\
    begin\n name shank\n direction 0 -1 0\n length 3\n axis 0 0 0 XYZ\n dof rz\nend\n\
    :hierarchy\nbegin\n root Thigh\n thigh shank\nend\n:skin x.obj\n";

fn with(take: &str) -> Read<Animation> {
    asf::with_skeleton(take.as_bytes(), SKELETON.as_bytes(), &PLAIN)
        .unwrap_or_else(|error| panic!("{error}\n{take}"))
}

#[test]
fn a_skeleton_with_everything() {
    let model = asf::read(SKELETON.as_bytes(), &PLAIN).unwrap();
    assert_eq!(model.warnings, []);
    let model = model.value;
    assert_eq!(model.name(), "Anna B");
    let names: Vec<&str> = model.segments().iter().map(|s| s.name.as_str()).collect();
    assert_eq!(names, ["root", "Thigh", "Thigh_tip", "shank"]);
    let keys: Vec<String> = model.coordinate_ids().map(|id| model.coordinate_key(id)).collect();
    assert_eq!(
        keys,
        [
            "root/tx", "ty", "root/tz", "root/rx", "root/ry", "root/rz", "Thigh/tz", "Thigh/ry",
            "Thigh/rx", "l", "shank/rz"
        ]
        .map(|key| match key {
            "root/tx" => "tx",
            other => other,
        })
    );
    let range = |key: &str| {
        let id = model.coordinate_ids().find(|id| model.coordinate_key(*id) == key).unwrap();
        let range = model.coordinate(id).range;
        (range.lower, range.upper, range.enforced)
    };
    assert_eq!(range("Thigh/rx"), (Some(-1.5), None, false));
    assert_eq!(range("Thigh/ry"), (Some(-0.5), Some(0.5), false));
    assert_eq!(range("Thigh/tz"), (None, None, false));
    assert_eq!(range("l"), (Some(0.0), Some(1.0), false));
    assert_eq!(model.defaults()[..3], [1.0, 2.0, 3.0]);
}

#[test]
fn a_take_is_turned_moved_and_lengthened() {
    let read = with(":RADIANS\n1\nroot 10 20 30 0.3 0.2 0.1\nThigh 0.4 0.5 0.6 0.7\nshank 0.8\n");
    assert_eq!(read.warnings, []);
    let Animation { model, motion } = read.value;
    let x = condyle_math::Mat3::rotation_x;
    let y = condyle_math::Mat3::rotation_y;
    let z = condyle_math::Mat3::rotation_z;
    // By hand: the first token first, about fixed axes; the thigh in the axes C of `ZXY`.
    let root = x(0.1) * y(0.2) * z(0.3);
    let c = y(0.2) * x(0.1) * z(0.3);
    let hip = Vec3::new(11.0, 22.0, 33.0) + root * (c * Vec3::new(0.0, 0.0, 0.6));
    let thigh = root * c * y(0.5) * x(0.4) * c.transpose();
    let knee = hip + thigh * Vec3::new(0.0, -2.7, 0.0);
    let ankle = knee + thigh * z(0.8) * Vec3::new(0.0, -3.0, 0.0);
    let points = ["Thigh", "shank", "shank_end"].map(|name| marker(&model, name));
    let found = places(&model, &motion.frames[0], &points);
    for (found, expected) in found.iter().zip([hip, knee, ankle]) {
        assert!((*found - expected).norm() < 1e-13, "{found:?} {expected:?}");
    }
}

#[test]
fn takes_as_people_have_them() {
    let full = "root 0 0 0 0 0 0\nThigh 1 0 0 0\n";
    let codes =
        |read: &Read<Animation>| read.warnings.iter().map(|said| said.code).collect::<Vec<_>>();
    let knee = |read: &Read<Animation>| -> Vec<f64> {
        read.value.motion.frames.iter().map(|frame| frame[10]).collect()
    };
    for (take, angles, times, said) in [
        (format!("1\n{full}shank 1\n2\n{full}shank 2\n"), vec![1.0, 2.0], vec![0.0, 0.01], vec![]),
        (
            format!("1\n{full}shank 1\n2\n{full}4\n{full}SHANK 3\n"),
            vec![1.0, 1.0, 3.0],
            vec![0.0, 0.01, 0.03],
            vec!["amc/missing-frames", "amc/missing"],
        ),
        (
            format!("5\n{full}shank 1\n5\n{full}shank 2\n6\n{full}shank 3\n"),
            vec![1.0, 3.0],
            vec![0.0, 0.01],
            vec!["amc/repeated"],
        ),
        (
            format!("5\n{full}shank 1\n1\n{full}shank 2\n2\n{full}shank 3\n"),
            vec![1.0, 2.0, 3.0],
            vec![0.0, 0.01, 0.02],
            vec!["amc/back"],
        ),
        (format!("1\n{full}shank 1 9\n"), vec![1.0], vec![0.0], vec!["amc/row-length"]),
        (format!("1\n{full}shank 1\nwing 9\n"), vec![1.0], vec![0.0], vec!["amc/unknown"]),
        (format!("1\n{full}shank nan\n"), vec![0.0], vec![0.0], vec!["amc/missing"]),
    ] {
        let read = with(&take);
        assert_eq!(knee(&read), angles, "{take}");
        assert_eq!(codes(&read), said, "{take}");
        for (found, expected) in read.value.motion.times.iter().zip(times) {
            assert!((found - expected).abs() < 1e-12, "{take}");
        }
    }
    let degrees = with(&format!(":FULLY-SPECIFIED\r\n:DEGREES\r\n1\r\n{full}shank 90\r\n"));
    assert_eq!(knee(&degrees), [90f64.to_radians()]);
    let mut told = PLAIN;
    told.rate = None;
    let read = asf::with_skeleton(b"1\nshank 0\n", SKELETON.as_bytes(), &told).unwrap();
    assert!(read.warned("amc/rate"));
    for (take, code) in
        [("", "amc/no-frame"), ("root 1 2 3\n", "amc/grammar"), ("1\nshank word\n", "amc/number")]
    {
        let error = asf::with_skeleton(take.as_bytes(), SKELETON.as_bytes(), &PLAIN).unwrap_err();
        assert_eq!(error.code(), code, "{take}");
    }
}

#[test]
fn skeletons_that_contradict_themselves() {
    for (old, new, code) in [
        ("root Thigh", "root Thigh shank", "asf/hierarchy"),
        ("name shank", "name thigh", "asf/name"),
        ("dof rz", "dof rw", "asf/grammar"),
        ("length 3", "length three", "asf/grammar"),
        ("direction 0 -1 0", "direction 0 -1", "asf/number"),
    ] {
        let text = SKELETON.replace(old, new);
        assert_ne!(text, SKELETON);
        assert_eq!(asf::read(text.as_bytes(), &PLAIN).unwrap_err().code(), code, "{new}");
    }
    assert_eq!(asf::read(b"", &PLAIN).unwrap_err().code(), "asf/empty");
    for (old, new, code) in [
        ("thigh shank", "thigh shank toe", "asf/hierarchy"),
        ("thigh shank", "", "asf/alone"),
        ("direction 0 -1 0", "direction 0 -2 0", "asf/direction"),
        (" (-inf inf) (0 1)", "", "asf/limits"),
        ("orientation 0 0 0", "orientation 0 1 0", "asf/root"),
        (" id 1", " mood good", "asf/unknown"),
    ] {
        let text = SKELETON.replace(old, new);
        assert_ne!(text, SKELETON);
        let read = asf::read(text.as_bytes(), &PLAIN).unwrap();
        assert_eq!(read.warnings.iter().map(|s| s.code).collect::<Vec<_>>(), [code], "{new}");
    }
}
