//! Skeletons of FBX beside another reader's places of joints.
#![cfg(feature = "fbx")]

use condyle_formats::fbx;
use condyle_model::{Mode, Pose, Program};
use serde_json::Value;
use std::path::{Path, PathBuf};

/// The folder of shared data beside the repository; `None` where it is absent.
fn data() -> Option<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data/models/fbx");
    if folder.is_dir() {
        return Some(folder);
    }
    println!("skipped: shared data absent");
    None
}

#[test]
fn joints_are_where_blender_has_them() {
    let Some(folder) = data() else { return };
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../oracles/fbx/blender.json");
    let oracle: Value = serde_json::from_slice(&std::fs::read(path).unwrap()).unwrap();
    for (name, answer) in oracle.as_object().unwrap() {
        let found = fbx::from_bytes(&std::fs::read(folder.join(name)).unwrap()).unwrap().value;
        let program = Program::compile(&found.model);
        let mut pose = Pose::new(&program);
        let (mut far, mut size, mut places): (f64, f64, _) = (0.0, 0.0, 0);
        for frame in answer["frames"].as_array().unwrap() {
            let time = frame["time"].as_f64().unwrap();
            let stored = found.motion.at(&found.model, time).unwrap_or_else(|| panic!("{time}"));
            program.evaluate(&stored, Mode::Open, &mut pose).unwrap();
            for (joint, place) in frame["joints"].as_object().unwrap() {
                let id =
                    found.model.find_segment(joint).unwrap_or_else(|e| panic!("{joint}: {e:?}"));
                let at = pose.segment(id).translation.to_array();
                for (x, expected) in at.iter().zip(place.as_array().unwrap()) {
                    let expected = expected.as_f64().unwrap();
                    far = far.max((x - expected).abs());
                    size = size.max(expected.abs());
                }
                places += 1;
            }
        }
        println!("{name}: {places} places, largest difference {far:.1e} m of {size:.2}");
        assert!(places > 50 && far < 1e-5 * size, "{name}: {far} of {size}");
    }
}

#[test]
fn damaged_files_are_refused() {
    assert_eq!(fbx::from_bytes(b"").unwrap_err().code(), "fbx/damaged");
    let Some(folder) = data() else { return };
    let bytes = std::fs::read(folder.join("huesitos.fbx")).unwrap();
    for length in (0..bytes.len()).step_by(1013) {
        // Never a panic; what is read of the part is a skeleton.
        let _ = fbx::from_bytes(&bytes[..length]);
    }
    assert_eq!(fbx::from_bytes(&bytes[..bytes.len() / 2]).unwrap_err().code(), "fbx/damaged");
}

/// The seeds of the fuzz target say one skeleton as text and in both binary forms.
#[test]
fn text_and_both_binary_forms_say_the_same() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fuzz/seeds/fbx");
    let read = |name: &str| {
        let bytes = std::fs::read(folder.join(name)).unwrap();
        fbx::from_bytes(&bytes).unwrap_or_else(|error| panic!("{name}: {error:?}")).value
    };
    let text = read("limb.fbx");
    for limb in ["upper", "lower"] {
        assert!(text.model.find_segment(limb).is_ok(), "{limb}");
    }
    assert_eq!(read("limb_7400.fbx"), text);
    assert_eq!(read("limb_7500.fbx"), text);
    // One second at 30 a second.
    assert_eq!(text.motion.times.len(), 31);
    let first = text.motion.frames.first().unwrap();
    let half = text.motion.at(&text.model, 0.5).unwrap();
    assert!(first != &half, "the lower limb bends");
}
