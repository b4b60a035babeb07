//! Poses of all shipped models as the library computes them, for the check that the committed WebAssembly gives the same:
//! `golden FOLDER` writes there a resolved model `NAME.json` and its poses `NAME.golden.json` for each; and the same for
//! files of formats that the second module reads, an `.osim` and a `.glb`.

use condyle::formats::{Format, exchange};
use condyle::{CoordinateKind, Mode, Model, Motion, encode, shipped};
use condyle_wasm::{Stage, converted};
use serde_json::{Value, json};
use std::path::Path;

/// Poses of each model, open and within limits.
const POSES: u64 = 25;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let folder = std::env::args().nth(1).ok_or("give a folder")?;
    let folder = Path::new(&folder);
    std::fs::create_dir_all(folder)?;
    for name in shipped::names() {
        let model = shipped::read(name)?.value.model;
        std::fs::write(folder.join(format!("{name}.json")), exchange::write(&model))?;
        std::fs::write(folder.join(format!("{name}.json.golden.json")), poses(model)?)?;
    }
    for (name, bytes) in foreign()? {
        let answer = converted(name, &bytes, None).map_err(|fault| fault.to_string())?;
        let answer: Value = serde_json::from_str(&answer.text)?;
        let text = answer["model"].as_str().ok_or("no model")?;
        let model = exchange::read(text.as_bytes())?.value;
        std::fs::write(folder.join(name), &bytes)?;
        std::fs::write(folder.join(format!("{name}.golden.json")), poses(model)?)?;
    }
    Ok(())
}

/// The name of a file, and its bytes.
type Foreign = (&'static str, Vec<u8>);

/// A leg of OpenSim, and a scene with a motion.
fn foreign() -> Result<[Foreign; 2], Box<dyn std::error::Error>> {
    let leg = shipped::read("legs")?.value.model;
    let osim = Format::of_ending("osim").ok_or("no format")?;
    let arm = shipped::read("knee")?.value.model;
    let mut frames = vec![arm.defaults(); 2];
    frames[1][0] -= 0.5;
    let motion = Motion { times: vec![0.0, 1.0], frames };
    let scene = encode::scene(&arm, &motion, Mode::Open, None)?;
    Ok([("legs.osim", encode::model(osim, &leg)?.value), ("knee.glb", scene.value)])
}

/// Poses of a model, open and within limits.
fn poses(model: Model) -> Result<String, String> {
    let name = model.name().to_owned();
    let mut stage = Stage::new(model);
    let mut poses = vec![];
    for number in 0..POSES {
        for within_limits in [false, true] {
            let asked = asked(&stage, number);
            stage.actors[0].asked.copy_from_slice(&asked);
            if !stage.pose(0, within_limits) {
                return Err(format!("{name}: pose {number} cannot be evaluated"));
            }
            let actor = &stage.actors[0];
            poses.push(json!({ "asked": asked, "within_limits": within_limits,
                "effective": actor.effective, "places": actor.places }));
        }
    }
    Ok(json!(poses).to_string())
}

/// Numbers within the ranges and a little beyond, the same in every run.
fn asked(stage: &Stage, number: u64) -> Vec<f64> {
    let model = &stage.model;
    let mut stored = model.defaults();
    for id in model.coordinate_ids() {
        let coordinate = model.coordinate(id);
        for (part, place) in model.stored_range(id).enumerate() {
            let share = drawn(number << 32 | (id.index() * 4 + part) as u64);
            let (low, high) = coordinate.range.bounds();
            let (low, high) = (low.max(-1.0), high.min(1.0).max(low.max(-1.0)));
            stored[place] = match coordinate.kind {
                CoordinateKind::Orientation => 2.0 * share - 1.0,
                CoordinateKind::Scale => 0.9 + 0.2 * share,
                _ => low + (1.1 * share - 0.05) * (high - low),
            };
        }
    }
    stored
}

/// A number from 0 to 1 for each index: SplitMix64 (Steele, Lea & Flood 2014).
fn drawn(index: u64) -> f64 {
    let mut z = index.wrapping_add(1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64
}
