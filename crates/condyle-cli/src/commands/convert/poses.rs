//! Poses as JSON: one, or a list of them.

use crate::failure::Failure;
use condyle::{CoordinateKind, Model, Motion};
use serde_json::Value;
use std::path::Path;

/// The coordinates of each pose, and which of them it names.
pub(in crate::commands) struct Poses {
    /// One frame for each pose; its time is its number.
    pub(in crate::commands) motion: Motion,
    /// For each pose and coordinate, whether the pose names it; empty where every pose names all.
    pub(in crate::commands) named: Vec<Vec<bool>>,
}

/// Reads `{"coordinate": number}` in radians and metres (an orientation: `[x, y, z, w]`), or a list
/// of such poses. Coordinates not named keep their defaults.
pub(in crate::commands) fn read(path: &Path, model: &Model) -> Result<Poses, Failure> {
    let fail = |why: String| Failure::new(format!("{}: {why}", path.display()));
    let text = std::fs::read_to_string(path).map_err(|error| fail(error.to_string()))?;
    let value = serde_json::from_str(&text).map_err(|error| fail(error.to_string()))?;
    let poses = match value {
        Value::Array(poses) => poses,
        one => vec![one],
    };
    let mut read = Poses { motion: Motion::default(), named: vec![] };
    for (index, pose) in poses.iter().enumerate() {
        let (stored, named) = one(model, pose).map_err(|message| {
            let place = if poses.len() > 1 { format!("pose {index}: ") } else { String::new() };
            fail(format!("{place}{message}"))
        })?;
        read.motion.times.push(index as f64);
        read.motion.frames.push(stored);
        read.named.push(named);
    }
    Ok(read)
}

/// The stored numbers of a pose, and which coordinates it names.
fn one(model: &Model, pose: &Value) -> Result<(Vec<f64>, Vec<bool>), String> {
    let Value::Object(entries) = pose else {
        return Err(r#"a pose is an object such as {"knee_angle_r": 0.5}"#.to_owned());
    };
    let mut stored = model.defaults();
    let mut named = vec![false; model.coordinates().len()];
    for (key, value) in entries {
        let id = model.find_coordinate(key).map_err(|error| error.to_string())?;
        let place = model.stored_range(id);
        named[id.index()] = true;
        if model.coordinate(id).kind == CoordinateKind::Orientation {
            let numbers: Option<Vec<f64>> =
                value.as_array().map(|list| list.iter().filter_map(Value::as_f64).collect());
            match numbers {
                Some(q) if q.len() == 4 && q.iter().any(|v| *v != 0.0) => {
                    stored[place].copy_from_slice(&q);
                }
                _ => return Err(format!("`{key}` is an orientation: give [x, y, z, w]")),
            }
            continue;
        }
        match value.as_f64() {
            Some(number) => stored[place.start] = number,
            None => return Err(format!("`{key}` is {value}, not a number (radians or metres)")),
        }
    }
    Ok((stored, named))
}
