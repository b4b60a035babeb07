//! Random models against the transforms that OpenSim 4.6 computed for them.
//!
//! `oracles/joints/random_models.json` holds generated models with every joint type, nested frames,
//! couplers, loops and joints stated backwards; `oracles/joints/random_models.py` makes it.

use condyle_formats::opensim::model::read;
use condyle_model::{CoordinateKind, Mode, Model, Pose, Program};
use serde_json::Value;
use std::path::PathBuf;

/// The largest difference that is left to rounding: models reach some metres, and a coordinate that
/// follows a cubic of another far outside its knots is some hundreds.
const TOLERANCE: f64 = 1e-9;

fn models() -> Vec<Value> {
    let file = "../../oracles/joints/random_models.json";
    let path = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join(file);
    let text = std::fs::read_to_string(path).unwrap();
    serde_json::from_str(&text).unwrap()
}

fn load(answer: &Value) -> Model {
    let xml = answer["xml"].as_str().unwrap();
    read(xml.as_bytes()).unwrap_or_else(|e| panic!("{}: {e}", answer["model"])).value
}

fn largest(ours: &[f64], theirs: &Value) -> f64 {
    let theirs = theirs.as_array().unwrap();
    assert!(ours.len() >= theirs.len());
    let off = ours.iter().zip(theirs).map(|(a, b)| (a - b.as_f64().unwrap()).abs());
    // NaN counts as the worst.
    off.fold(0.0, |worst, d| if d <= worst { worst } else { d })
}

#[test]
fn bodies_and_markers_stand_where_opensim_puts_them() {
    let mut compared = 0;
    for answer in models() {
        let model = load(&answer);
        let program = Program::compile(&model);
        let mut pose = Pose::new(&program);
        for sample in answer["poses"].as_array().unwrap() {
            let mut stored = model.defaults();
            for (key, value) in sample["pose"].as_object().unwrap() {
                let id = model.find_coordinate(key).unwrap();
                *model.value_mut(&mut stored, id) = value.as_f64().unwrap();
            }
            program.evaluate(&stored, Mode::Open, &mut pose).unwrap();
            for (name, rows) in sample["segments"].as_object().unwrap() {
                let id = model.find_segment(name).unwrap();
                let off = largest(&pose.segment(id).to_rows(), rows);
                assert!(off < TOLERANCE, "{}: {name} is off by {off:e}", answer["model"]);
                compared += 1;
            }
            for (name, place) in sample["markers"].as_object().unwrap() {
                let marker = model.markers().iter().find(|m| m.name == *name).unwrap();
                let found = pose.frame(marker.segment) * marker.point;
                let off = largest(&found.to_array(), place);
                assert!(off < TOLERANCE, "{}: marker {name} is off by {off:e}", answer["model"]);
            }
            for id in model.coordinate_ids() {
                let key = model.coordinate_key(id);
                let expected = sample["pose"][&key].as_f64().unwrap();
                let found = pose.coordinate(&model, id)[0];
                let off = (found - expected).abs() / expected.abs().max(1.0);
                assert!(off < TOLERANCE, "{}: {key} is {found}, not {expected}", answer["model"]);
            }
        }
    }
    assert!(compared > 300, "only {compared} transforms compared");
}

#[test]
fn coordinates_are_of_the_kind_that_opensim_calls_them() {
    let mut seen = [0; 4];
    for answer in models() {
        let model = load(&answer);
        let kinds = answer["kinds"].as_object().unwrap();
        let coupled = answer["coupled"].as_array().unwrap();
        assert_eq!(model.coordinates().len(), kinds.len(), "{}", answer["model"]);
        for id in model.coordinate_ids() {
            let key = model.coordinate_key(id);
            let coordinate = model.coordinate(id);
            let number = match coordinate.kind {
                CoordinateKind::Rotation => 1,
                CoordinateKind::Translation => 2,
                _ => 3,
            };
            // OpenSim calls it undefined (0) where nothing uses it.
            let expected = kinds[&key].as_u64().unwrap().clamp(1, 3);
            assert_eq!(number, expected, "{}: {key}", answer["model"]);
            seen[number as usize] += 1;
            let follows = coupled.iter().any(|c| c.as_str() == Some(&key));
            assert_eq!(coordinate.follows.is_some(), follows, "{}: {key}", answer["model"]);
        }
    }
    assert!(seen[1..].iter().all(|&n| n > 20), "{seen:?}");
}

#[test]
fn the_models_hold_every_kind_of_joint_and_function() {
    let text: String = models().iter().map(|m| m["xml"].as_str().unwrap().to_owned()).collect();
    for kind in [
        "WeldJoint",
        "PinJoint",
        "SliderJoint",
        "UniversalJoint",
        "BallJoint",
        "GimbalJoint",
        "PlanarJoint",
        "FreeJoint",
        "CustomJoint",
        "EllipsoidJoint",
        "ScapulothoracicJoint",
        "ConstantCurvatureJoint",
        "Constant",
        "LinearFunction",
        "PolynomialFunction",
        "SimmSpline",
        "PiecewiseLinearFunction",
        "MultiplierFunction",
        "MultivariatePolynomialFunction",
        "CoordinateCouplerConstraint",
        "PointConstraint",
        "ConstantDistanceConstraint",
        "WeldConstraint",
        "PhysicalOffsetFrame",
    ] {
        let tags = [format!("<{kind}>"), format!("<{kind} ")];
        assert!(tags.iter().any(|tag| text.contains(tag)), "no model has a {kind}");
    }
}
