//! A model as another program's file, and beside it what that program should answer: joint values and the
//! transforms of all bodies at random legal poses. The scripts in `oracles/written/` compare.
//!
//! `cargo run -p condyle-formats --example written -- MODEL FORMAT OUT [POSES]` writes OUT and OUT.json. MODEL is a
//! file that needs no other: shipped models by `condyle convert NAME NAME.json`.

use condyle_formats::plain::{Legal, Written};
use condyle_formats::{Content, Format, mjcf, opensim, urdf, usd};
use condyle_math::{Affine, Quat};
use condyle_model::{Mode, Model};
use condyle_motion::Motion;
use serde_json::{Map, Value, json};

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [model_path, format, out, rest @ ..] = &arguments[..] else {
        eprintln!("usage: written MODEL FORMAT OUT [POSES]");
        std::process::exit(2);
    };
    let poses = rest.first().and_then(|n| n.parse().ok()).unwrap_or(100);
    let model = match model_of(model_path) {
        Ok(model) => model,
        Err(message) => {
            eprintln!("{model_path}: {message}");
            std::process::exit(1);
        }
    };
    let written = match format.as_str() {
        "osim" => opensim::written(&model),
        "urdf" => urdf::written(&model),
        "mjcf" => mjcf::written(&model),
        "usda" => animated(&model, poses),
        // The model's own coordinates, for comparing how a file is read.
        "none" => Written { text: String::new(), ..opensim::written(&model) },
        other => {
            eprintln!("no such format: {other}");
            std::process::exit(2);
        }
    };
    let answer = answer(&model, &written, poses);
    let saved = std::fs::write(out, &written.text)
        .and_then(|()| std::fs::write(format!("{out}.json"), answer.to_string()));
    if let Err(error) = saved {
        eprintln!("{out}: {error}");
        std::process::exit(1);
    }
}

/// A motion through the poses that are answered.
fn animated(model: &Model, count: usize) -> Written {
    let mut legal = Legal::new(model, 2024);
    let frames: Vec<Vec<f64>> = (0..count).map(|_| legal.next_pose().0).collect();
    let motion = Motion { times: (0..count).map(|i| i as f64 / 30.0).collect(), frames };
    let text = match usd::write(model, &motion, Mode::Open) {
        Ok(read) => read,
        Err(error) => {
            eprintln!("{error}");
            std::process::exit(1);
        }
    };
    Written { text: text.value, remarks: text.warnings, ..opensim::written(model) }
}

fn model_of(path: &str) -> Result<Model, String> {
    let bytes = std::fs::read(path).map_err(|error| error.to_string())?;
    let format = Format::of_bytes(&bytes).ok_or("no format is recognised")?;
    let read = format
        .read(&bytes, &mut |path| std::fs::read_to_string(path).map_err(|error| error.to_string()));
    match read.map_err(|error| error.to_string())?.value {
        Content::Model(model) => Ok(model),
        Content::Document(document) => Ok(document.model),
        other => Err(format!("it holds {}", other.kind().name())),
    }
}

fn answer(model: &Model, written: &Written, count: usize) -> Value {
    let tree = &written.tree;
    let mut legal = Legal::new(model, 2024);
    let mut poses = vec![];
    for _ in 0..count {
        let (stored, pose) = legal.next_pose();
        let variables = tree.variables_at(model, &stored);
        let values = tree.values_at(model, pose, &variables);
        let joints = written.joints.iter().map(|(name, v)| (name.clone(), json!(values[*v])));
        let balls = written.balls.iter().map(|(name, at)| {
            let q = pose.coordinate(model, tree.orientations[*at]).first_chunk::<4>();
            let q = q.map_or(Quat::IDENTITY, |q| Quat::from(*q)).normalized();
            (name.clone(), json!(q.to_array()))
        });
        let mut said: Vec<Affine> = vec![];
        let (mut bodies, mut truth) = (Map::new(), Map::new());
        for (link, name) in tree.links.iter().zip(&written.bodies) {
            let own = tree.link_transform(link, &values, pose, model);
            let world = link.parent.map_or(own, |parent| said[parent] * own);
            said.push(world);
            bodies.insert(name.clone(), json!(world.to_rows()[..12]));
            truth.insert(name.clone(), json!(pose.segment(link.segment).to_rows()[..12]));
        }
        poses.push(json!({
            "joints": joints.collect::<Map<String, Value>>(),
            "balls": balls.collect::<Map<String, Value>>(),
            "said": bodies,
            "true": truth,
        }));
    }
    let remarks = written.remarks.iter().map(|r| format!("{}: {}", r.code, r.sentence()));
    json!({ "model": model.name(), "remarks": remarks.collect::<Vec<_>>(), "base": written.base.to_rows()[..12], "poses": poses })
}
