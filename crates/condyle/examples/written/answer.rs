//! What another program should answer about a written model.

use condyle::formats::plain::{Legal, Written};
use condyle::formats::{mjcf, opensim, urdf, usd};
use condyle::math::Quat;
use condyle::{Mode, Model, Motion};
use serde_json::{Map, Value, json};

/// The text in a format, and legal poses: what the model's stored numbers are (`stored`), values of all joints of
/// the file (`joints`, `balls`), and transforms of all bodies in the model's world, evaluated by the model (`true`).
/// `None` for other formats.
pub(super) fn written(model: &Model, format: &str, poses: usize) -> Option<(String, Value)> {
    let written = match format {
        "osim" => opensim::written(model),
        "urdf" => urdf::written(model),
        "mjcf" => mjcf::written(model),
        "usda" => animated(model, poses)?,
        "none" => Written { text: String::new(), ..opensim::written(model) },
        _ => return None,
    };
    let answer = answer(model, &written, poses);
    Some((written.text, answer))
}

/// A motion through the poses that are answered, thirty a second.
fn animated(model: &Model, count: usize) -> Option<Written> {
    let mut legal = Legal::new(model, 2024);
    let frames = (0..count).map(|_| legal.next_pose().0).collect();
    let motion = Motion { times: (0..count).map(|i| i as f64 / 30.0).collect(), frames };
    let read = usd::write(model, &motion, Mode::Open).ok()?;
    Some(Written { text: read.value, remarks: read.warnings, ..opensim::written(model) })
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
        let truth =
            tree.links.iter().zip(&written.bodies).map(|(link, name)| {
                (name.clone(), json!(pose.segment(link.segment).to_rows()[..12]))
            });
        poses.push(json!({
            "stored": stored,
            "joints": joints.collect::<Map<String, Value>>(),
            "balls": balls.collect::<Map<String, Value>>(),
            "true": truth.collect::<Map<String, Value>>(),
        }));
    }
    let remarks = written.remarks.iter().map(|r| json!([r.code, r.message]));
    json!({
        "model": model.name(),
        "remarks": remarks.collect::<Vec<_>>(),
        "base": written.base.to_rows()[..12],
        "poses": poses,
    })
}
