//! Poses of a model and what they are: random requests, effective coordinates and transforms.

use condyle::{CoordinateKind, Mode, Model, Pose, Program};
use serde_json::{Map, Value, json};
use std::f64::consts::PI;

/// Numbers in [-1, 1) from a linear congruential generator.
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (self.0 >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }
}

/// How far requests go beyond the ranges, in turn: the first stays well inside.
const SPREADS: [f64; 8] = [0.6, 0.9, 1.0, 1.1, 1.3, 1.6, 2.0, 3.0];

/// Requested numbers of a pose: the defaults for number 0, then ever farther from the middle of the
/// ranges.
pub(crate) fn request(model: &Model, number: usize) -> Vec<f64> {
    let mut stored = model.defaults();
    if number == 0 {
        return stored;
    }
    let mut random = Random(number as u64);
    random.next();
    let spread = SPREADS[number % SPREADS.len()];
    for id in model.coordinate_ids() {
        let coordinate = model.coordinate(id);
        let place = model.stored_range(id);
        if coordinate.kind == CoordinateKind::Orientation {
            // Of any length: an evaluator has to take it as it is.
            stored[place].iter_mut().for_each(|x| *x = random.next());
            continue;
        }
        let (middle, half) = match coordinate.kind {
            CoordinateKind::Rotation => (0.0, 0.5 * PI),
            CoordinateKind::Translation => (0.0, 0.3),
            CoordinateKind::Scale => (1.0, 0.4),
            CoordinateKind::Other | CoordinateKind::Orientation => (0.0, 1.0),
        };
        let (middle, half) = match (coordinate.range.lower, coordinate.range.upper) {
            (Some(low), Some(high)) => (0.5 * (low + high), 0.5 * (high - low)),
            (Some(low), None) => (low + half, half),
            (None, Some(high)) => (high - half, half),
            (None, None) => (middle, half),
        };
        stored[place.start] = middle + half * spread * random.next();
    }
    stored
}

/// A conformance file: `count` poses, each open and posed.
pub(crate) fn record(model: &Model, count: usize) -> String {
    let program = Program::compile(model);
    let mut pose = Pose::new(&program);
    let mut lines = vec![];
    for number in 0..count {
        let requested = request(model, number);
        for (mode, name) in [(Mode::Open, "open"), (Mode::Posed, "posed")] {
            if program.evaluate(&requested, mode, &mut pose).is_err() {
                continue;
            }
            let segments: Map<String, Value> = model
                .segment_ids()
                .map(|id| {
                    let rows = pose.segment(id).to_rows();
                    let rows = json!([rows[0..4], rows[4..8], rows[8..12]]);
                    (model.segment(id).name.clone(), rows)
                })
                .collect();
            let line = json!({
                "mode": name,
                "requested": by_path(model, &requested),
                "effective": by_path(model, pose.effective()),
                "segments": segments,
            });
            lines.push(line.to_string());
        }
    }
    format!(
        "{{\n\"condyle_conformance\": 1,\n\"model\": {},\n\"poses\": [\n{}\n]\n}}\n",
        json!(model.name()),
        lines.join(",\n")
    )
}

/// The numbers of all coordinates, by their paths.
fn by_path(model: &Model, stored: &[f64]) -> Map<String, Value> {
    let entry = |id| {
        let coordinate = model.coordinate(id);
        let set = &model.joint_sets()[coordinate.joint_set.index()].name;
        let value = match &stored[model.stored_range(id)] {
            [one] => json!(one),
            several => json!(several),
        };
        (format!("{set}/{}", coordinate.name), value)
    };
    model.coordinate_ids().map(entry).collect()
}
