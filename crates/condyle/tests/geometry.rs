//! Skins against NumPy (`oracles/glb/skin.py`).

use condyle::{Figure, Mode, Pose, Program, geometry, open};
use std::path::Path;

#[test]
fn skins_are_where_numpy_has_them() {
    let here = Path::new(env!("CARGO_MANIFEST_DIR"));
    let answers = std::fs::read_to_string(here.join("../../oracles/glb/skin.json")).expect("kept");
    let answers: serde_json::Value = serde_json::from_str(&answers).expect("JSON");
    for (name, expected) in answers.as_object().expect("files") {
        let path = here.join("../../../shared/data/models/gltf").join(name);
        if !path.is_file() {
            eprintln!("skipped: {name} is not there");
            continue;
        }
        let animation = open::animation(&path).expect("a figure").value;
        let geometry = geometry::open(&path, &animation.model, &[]).expect("skins").value;
        let figure = Figure::new(&animation.model).with(geometry);
        let program = Program::compile(&animation.model);
        let mut pose = Pose::new(&program);
        program.evaluate(&animation.motion.frames[0], Mode::Open, &mut pose).expect("its length");
        let corners = figure.skins.iter().flat_map(|skin| skin.posed(&pose).positions);
        let corners: Vec<[f64; 3]> = corners.step_by(97).map(|p| p.to_array()).collect();
        let expected = expected.as_array().expect("corners");
        assert_eq!(corners.len(), expected.len(), "{name}");
        for (corner, expected) in corners.iter().zip(expected) {
            for (axis, found) in corner.iter().enumerate() {
                let expected = expected[axis].as_f64().expect("a number");
                assert!((found - expected).abs() < 2e-6, "{name}: {corner:?} for {expected}");
            }
        }
    }
}
