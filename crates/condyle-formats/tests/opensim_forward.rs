//! Forward kinematics of real models against transforms that OpenSim 4.6 computed.
//!
//! The references live beside the project in development; without them the test says so.

use condyle_formats::opensim::model::read;
use condyle_model::{Mode, Pose, Program};
use serde_json::Value;
use std::path::PathBuf;

fn shared_data() -> Option<PathBuf> {
    let data = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data");
    if data.is_dir() {
        return Some(data);
    }
    println!("skipped: the shared data folder is absent");
    None
}

#[test]
fn every_body_agrees_with_opensim_to_a_micrometre() {
    let Some(data) = shared_data() else { return };
    let mut references = 0;
    let mut worst = (0.0, String::new());
    for entry in std::fs::read_dir(data.join("fk_reference")).unwrap() {
        let text = std::fs::read_to_string(entry.unwrap().path()).unwrap();
        let reference: Value = serde_json::from_str(&text).unwrap();
        let name = reference["model"].as_str().unwrap();
        let model = read(&std::fs::read(data.join(name)).unwrap());
        let model = model.unwrap_or_else(|e| panic!("{name}: {e}")).value;
        let program = Program::compile(&model);
        let mut pose = Pose::new(&program);
        for sample in reference["poses"].as_array().unwrap() {
            let mut stored = model.defaults();
            for (key, value) in sample["pose"].as_object().unwrap() {
                let id = model.find_coordinate(key).unwrap_or_else(|e| panic!("{name}: {e}"));
                *model.value_mut(&mut stored, id) = value.as_f64().unwrap();
            }
            program.evaluate(&stored, Mode::Open, &mut pose).unwrap();
            for (segment, rows) in sample["segments"].as_object().unwrap() {
                let id = model.find_segment(segment).unwrap_or_else(|e| panic!("{name}: {e}"));
                for (a, b) in pose.segment(id).to_rows().iter().zip(rows.as_array().unwrap()) {
                    let off = (a - b.as_f64().unwrap()).abs();
                    if off > worst.0 {
                        worst = (off, format!("{name}: {segment}"));
                    }
                }
            }
            // Coupled coordinates are evaluated, and must agree with the pose that met them.
            for id in model.coordinate_ids() {
                let key = model.coordinate_key(id);
                let expected = sample["pose"].get(&key).and_then(Value::as_f64);
                if let Some(expected) = expected {
                    let found = pose.coordinate(&model, id)[0];
                    assert!((found - expected).abs() < 1e-9, "{name}: {key} {found} {expected}");
                }
            }
        }
        references += 1;
    }
    println!("{references} models, worst entry off by {:.1e} in {}", worst.0, worst.1);
    assert!(references >= 30, "only {references} references found");
    assert!(worst.0 < 1e-9, "{worst:?}");
}
