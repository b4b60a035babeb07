//! Numbers of model documents changed in their texts.

mod every;
mod files;
mod places;

use condyle::formats::document::edit::{Editing, Step};
use condyle::{CoordinateKind, Mode, Model, Pose, Program, shipped};

/// A path of keys and positions: `segment.shank.at.1`.
fn path(text: &str) -> Vec<Step> {
    let step = |part: &str| match part.parse() {
        Ok(index) => Step::Index(index),
        Err(_) => Step::Key(part.to_owned()),
    };
    text.split('.').map(step).collect()
}

/// The text of what a shipped model includes.
fn part(name: &str) -> Result<String, String> {
    let text = shipped::part(name).or_else(|| shipped::text(name));
    text.map(str::to_owned).ok_or_else(|| "there is none".to_owned())
}

/// A shipped model as if all its texts were the user's.
fn shipped_as_own(name: &str) -> Editing {
    Editing::read(name, shipped::text(name).unwrap(), &mut part, &|_| true).unwrap()
}

/// The transforms of all segments by name in a pose with every coordinate away from its default, the same for models
/// with the same coordinates; numbers row by row.
fn posed(model: &Model, mode: Mode) -> Vec<(String, [f64; 16])> {
    let program = Program::compile(model);
    let mut pose = Pose::new(&program);
    let mut stored = model.defaults();
    for id in model.coordinate_ids() {
        let coordinate = model.coordinate(id);
        // A number from 0.2 to 0.8 by the name.
        let hash =
            coordinate.name.bytes().fold(7u32, |h, b| h.wrapping_mul(31).wrapping_add(b.into()));
        let share = 0.2 + 0.6 * f64::from(hash % 1000) / 1000.0;
        let value = match (coordinate.kind, coordinate.range.lower, coordinate.range.upper) {
            (CoordinateKind::Orientation, ..) => continue,
            (CoordinateKind::Scale, ..) => 1.0 + 0.1 * share,
            (_, Some(low), Some(high)) => low + share * (high - low),
            (CoordinateKind::Translation, ..) => 0.01 * share,
            _ => 0.3 * share,
        };
        stored[model.stored_range(id).start] = value;
    }
    program.evaluate(&stored, mode, &mut pose).unwrap();
    let rows = |id| pose.segment(id).to_rows();
    model.segment_ids().map(|id| (model.segment(id).name.clone(), rows(id))).collect()
}

/// The largest difference between two poses.
fn apart(a: &[(String, [f64; 16])], b: &[(String, [f64; 16])]) -> f64 {
    assert_eq!(a.len(), b.len());
    a.iter().fold(0.0, |most: f64, (name, rows)| {
        let other = b.iter().find(|(n, _)| n == name).expect("the same segments");
        rows.iter().zip(other.1).fold(most, |most, (x, y)| {
            if x.is_finite() || y.is_finite() { most.max((x - y).abs()) } else { most }
        })
    })
}
