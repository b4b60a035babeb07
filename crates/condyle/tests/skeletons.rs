//! Files of skeletons by path: all of the test data, takes and their skeletons, and motions of any model as BVH.

use condyle::formats::skeleton::Assumed;
use condyle::formats::{Content, bvh};
use condyle::math::Vec3;
use condyle::model::{Facing, UpAxis};
use condyle::open::{self, Cause};
use condyle::{Mode, Model, Motion, Pose, Program, shipped};
use std::path::{Path, PathBuf};

/// All files of the shared data with one of these endings.
fn files(endings: &[&str]) -> Vec<PathBuf> {
    let shared = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared");
    let mut open = vec![shared.join("data"), shared.join("cases")];
    let mut found = vec![];
    while let Some(folder) = open.pop() {
        let Ok(entries) = std::fs::read_dir(&folder) else { continue };
        for path in entries.map(|entry| entry.unwrap().path()) {
            if path.is_dir() {
                open.push(path);
            } else if endings.contains(&open::ending(&path).as_str()) {
                found.push(path);
            }
        }
    }
    if found.is_empty() {
        println!("skipped: shared data absent");
    }
    found
}

#[test]
fn every_file_is_read_or_refused_for_its_reason() {
    for path in files(&["bvh", "asf", "amc"]) {
        let read = open::content(&path, None).unwrap_or_else(|error| panic!("{error}"));
        let frames = match &read.value {
            Content::Animation(found) => found.motion.frames.len(),
            Content::Model(model) => model.segments().len(),
            other => panic!("{}: {other:?}", path.display()),
        };
        assert!(frames > 1, "{}", path.display());
    }
    // The table of the data says: "a CSE169 reader must refuse it with a clear message".
    for path in files(&["skel"]) {
        let error = open::content(&path, None).expect_err("the data has DART's files only");
        let Cause::Content { error, .. } = error.cause else { panic!("{error}") };
        assert_eq!(error.code(), "skel/dart", "{}", path.display());
    }
}

#[test]
fn a_take_without_its_skeleton_says_so() {
    let folder = std::env::temp_dir().join(format!("condyle-takes-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let take = folder.join("07_01.amc");
    std::fs::write(&take, "1\nroot 0 0 0 0 0 0\n").unwrap();
    let error = open::content(&take, None).unwrap_err().to_string();
    assert!(error.contains("07.asf") && error.contains("--skeleton"), "{error}");
    let skeleton = ":root\n order TX TY TZ RX RY RZ\n:bonedata\n:hierarchy\n";
    std::fs::write(folder.join("07.asf"), skeleton).unwrap();
    let read = open::content(&take, None).unwrap();
    assert!(read.warned("amc/skeleton"));
    assert!(matches!(read.value, Content::Animation(_)));
    std::fs::remove_dir_all(&folder).unwrap();
}

/// Where the joint of every segment is.
fn centres(model: &Model, stored: &[f64]) -> Vec<condyle::math::Vec3> {
    let program = Program::compile(model);
    let mut pose = Pose::new(&program);
    program.evaluate(stored, Mode::Open, &mut pose).unwrap();
    let segments = model.segment_ids();
    segments.map(|id| pose.segment(id) * model.segment(id).joint_in_segment.translation).collect()
}

#[test]
fn the_human_moves_as_bvh_does() {
    let model = shipped::read("human").unwrap().value.model;
    // Every coordinate of one number goes to and fro within its range, each at its own pace.
    let mut motion = Motion::default();
    for frame in 0..40 {
        let mut stored = model.defaults();
        for (number, id) in model.coordinate_ids().enumerate() {
            let coordinate = model.coordinate(id);
            let (low, high) = coordinate.range.bounds();
            if coordinate.kind.stored() == 1 && low.is_finite() && high.is_finite() {
                let share = 0.5 + 0.4 * (f64::from(frame) * 0.1 + number as f64).sin();
                *model.value_mut(&mut stored, id) = low + share * (high - low);
            }
        }
        motion.times.push(f64::from(frame) * 0.01);
        motion.frames.push(stored);
    }
    let text = bvh::write(&model, &motion, Mode::Open, 0.01).unwrap().value;
    let assumed = Assumed { metres_per_unit: Some(0.01), up: Some(UpAxis::Y), rate: None };
    let again = bvh::from_bytes_with(text.as_bytes(), &assumed).unwrap().value;
    let ids: Vec<usize> = model
        .segments()
        .iter()
        .map(|segment| again.model.find_segment(&segment.name).unwrap().index())
        .collect();
    for (frame, stored) in motion.frames.iter().enumerate() {
        let expected = centres(&model, stored);
        let found = centres(&again.model, &again.motion.frames[frame]);
        for (own, id) in expected.iter().zip(&ids) {
            let off = (*own - found[*id]).norm();
            // Six decimals of a centimetre and a degree in each of some twenty joints of a chain.
            assert!(off < 5e-7, "frame {frame}, {}: {off}", again.model.segments()[*id].name);
        }
    }
}

#[test]
fn shipped_models_look_along_z_turned_as_a_whole() {
    let mut turned_models = 0;
    for name in shipped::names() {
        let model = shipped::read(name).unwrap().value.model;
        let turned = model.looking(Facing::PlusZ);
        assert_eq!(turned, turned.looking(Facing::PlusZ), "{name}");
        // Back where it looked: the turn and its inverse, to rounding.
        let back = turned.looking(model.facing());
        let (to, from) = (turned.facing().direction(), model.facing().direction());
        // The turn about y that takes one direction to the other, by its definition.
        let angle = to.x.atan2(to.z) - from.x.atan2(from.z);
        let (sine, cosine) = angle.sin_cos();
        turned_models += usize::from(turned.facing() != model.facing());
        for frame in 0..5 {
            let mut stored = model.defaults();
            for (number, id) in model.coordinate_ids().enumerate() {
                let coordinate = model.coordinate(id);
                let (low, high) = coordinate.range.bounds();
                if coordinate.kind.stored() == 1 && low.is_finite() && high.is_finite() {
                    let share = 0.5 + 0.4 * (f64::from(frame) + number as f64).sin();
                    *model.value_mut(&mut stored, id) = low + share * (high - low);
                }
            }
            let [own, other, again] = [&model, &turned, &back].map(|model| centres(model, &stored));
            for ((p, q), r) in own.iter().zip(&other).zip(&again) {
                let expected = Vec3::new(cosine * p.x + sine * p.z, p.y, cosine * p.z - sine * p.x);
                assert!((*q - expected).norm() < 1e-9, "{name}, frame {frame}: {p:?} {q:?}");
                assert!((*p - *r).norm() < 1e-9, "{name}, frame {frame}, back");
            }
        }
    }
    assert!(turned_models >= 5, "{turned_models}");
}
