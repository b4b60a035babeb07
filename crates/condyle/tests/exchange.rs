//! Resolved models in JSON: all of a model is kept, and what other authors compare with is current.

#[path = "../examples/conformance/record.rs"]
mod record;

use condyle::formats::{Content, Format, document, exchange};
use condyle::model::Law;
use condyle::{Model, shipped};
use serde_json::Value;
use std::path::PathBuf;

fn docs(name: &str) -> String {
    let path = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../docs").join(name);
    std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

fn conformance() -> Model {
    let text = docs("exchange/conformance.toml");
    document::read(&text, &mut |_| Err("it stands alone".into())).unwrap().value.model
}

/// How the files beside it are made anew.
const AGAIN: &str =
    "cargo run --example conformance -- docs/exchange/conformance.toml 10 docs/exchange";

#[test]
fn every_model_is_read_as_it_was_written() {
    let shipped = shipped::names().map(|name| shipped::read(name).unwrap().value.model);
    for model in shipped.chain([conformance()]) {
        let text = exchange::write(&model);
        let format = Format::of_bytes(text.as_bytes()).expect("JSON is known");
        let read = format.read(text.as_bytes(), &mut |_| Err("it stands alone".into())).unwrap();
        let Content::Model(again) = read.value else { panic!("{} is no model", model.name()) };
        assert!(exchange::write(&again) == text, "{}", model.name());
        // Equal to the last bit, but that names of components are unique now.
        assert!(again.segments() == model.segments(), "{}", model.name());
        assert!(again.coordinates() == model.coordinates(), "{}", model.name());
        assert!(again.shapes() == model.shapes(), "{}", model.name());
        assert!(again.postures() == model.postures(), "{}", model.name());
        assert!(again.markers() == model.markers(), "{}", model.name());
        assert!(again.closures() == model.closures(), "{}", model.name());
        assert!(again.joint_sets() == model.joint_sets(), "{}", model.name());
        assert!(again.size_groups() == model.size_groups(), "{}", model.name());
        let world = |m: &Model| (m.name().to_owned(), m.up(), m.facing());
        assert_eq!(world(&again), world(&model));
        let parts = |m: &Model| -> Vec<_> {
            m.components().iter().map(|c| (c.law.clone(), c.inputs.clone())).collect()
        };
        assert!(parts(&again) == parts(&model), "{}", model.name());
    }
}

#[test]
fn the_conformance_model_has_every_kind_of_component() {
    let model = conformance();
    let has = |kind: &str| model.components().iter().any(|c| c.law.kind().name == kind);
    let missing: Vec<&str> = Law::KINDS.iter().map(|k| k.name).filter(|k| !has(k)).collect();
    assert_eq!(missing, ["custom"], "a law that only its program knows cannot be exchanged");
}

#[test]
fn the_specification_has_a_section_for_every_kind_of_component() {
    let text = docs("exchange.md") + &docs("exchange/components.md");
    for kind in Law::KINDS {
        let heading = format!("\n### `{}`\n", kind.name);
        assert!(text.contains(&heading), "no section for `{}`", kind.name);
    }
}

#[test]
fn the_conformance_files_are_current() {
    let model = conformance();
    let written = docs("exchange/conformance.json");
    assert!(written == exchange::write(&model), "conformance.json is old: {AGAIN}");
    let parse = |text: &str| serde_json::from_str::<Value>(text).unwrap();
    let written = parse(&docs("exchange/conformance.poses.json"));
    let now = parse(&record::record(&model, 10));
    // Libraries of arcus functions differ by rounding from machine to machine.
    let off = apart(&written, &now);
    assert!(off <= 1e-12, "conformance.poses.json is off by {off}: {AGAIN}");
    assert!(now["poses"].as_array().unwrap().len() == 20);
}

/// The largest difference of two values' numbers; infinite where they are built differently.
fn apart(a: &Value, b: &Value) -> f64 {
    match (a, b) {
        (Value::Number(a), Value::Number(b)) => {
            let (a, b) = (a.as_f64().unwrap(), b.as_f64().unwrap());
            (a - b).abs() / b.abs().max(1.0)
        }
        (Value::Array(a), Value::Array(b)) if a.len() == b.len() => {
            a.iter().zip(b).map(|(a, b)| apart(a, b)).fold(0.0, f64::max)
        }
        (Value::Object(a), Value::Object(b)) if a.len() == b.len() => a
            .iter()
            .map(|(key, a)| b.get(key).map_or(f64::INFINITY, |b| apart(a, b)))
            .fold(0.0, f64::max),
        (a, b) if a == b => 0.0,
        _ => f64::INFINITY,
    }
}
