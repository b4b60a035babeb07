//! What a motion breaks, with times.

use crate::answer::{Answer, Fault, said, sentence};
use crate::stage::Stage;
use condyle::check::motion::check;
use condyle::{CoordinateKind, Motion};
use serde_json::{Value, json};

impl Stage {
    /// `{"times": […], "frames": [[…], …]}`, stored numbers, to a list of spans with what is wrong in each.
    pub(crate) fn checked(&self, question: &Value) -> Result<Answer, Fault> {
        let motion = motion(&self.model, question)?;
        let table = motion.to_table(&self.model, "shown");
        let found = check(&self.model, &table);
        let time = |frame: usize| motion.times.get(frame).copied().unwrap_or(0.0);
        let span = |[first, last]: [usize; 2]| (time(first), time(last));
        let mut spans = vec![];
        for outside in &found.outside {
            let key = self.model.coordinate_key(outside.coordinate);
            let kind = self.model.coordinate(outside.coordinate).kind;
            for &run in &outside.runs {
                let (from, to) = span(run);
                let inside = (run[0]..=run[1]).contains(&outside.worst.frame);
                let at = if inside { outside.worst.time } else { from };
                let text = format!(
                    "{key} is outside its range, at most by {} ({})",
                    amount(kind, outside.worst.by),
                    outside.source
                );
                spans.push(json!({ "kind": "violation", "from": from, "to": to, "at": at,
                    "coordinate": outside.coordinate.index(), "what": text }));
            }
        }
        for broken in &found.broken {
            let component = &self.model.components()[broken.component.index()];
            for &run in &broken.runs {
                let (from, to) = span(run);
                let text = format!(
                    "limit {} of {} is broken, at most by {}",
                    component.name,
                    self.model.joint_sets()[component.joint_set.index()].name,
                    amount(broken.kind, broken.by)
                );
                spans.push(json!({ "kind": "violation", "from": from, "to": to, "at": broken.time,
                    "what": text }));
            }
        }
        for open in &found.open_loops {
            let text = format!("loop {} is open by {}", open.name, open.shown());
            spans.push(json!({ "kind": "violation", "from": open.time, "to": open.time,
                "at": open.time, "what": text }));
        }
        for jump in &found.jumps {
            let key = self.model.coordinate_key(jump.coordinate);
            let degrees = jump.by.to_degrees();
            let before = time(jump.frame.saturating_sub(1));
            let text = match jump.wrap {
                true => format!("{key} wraps by {degrees:.0}° in one frame"),
                false => format!("{key} jumps by {degrees:.0}° in one frame"),
            };
            spans.push(json!({ "kind": "jump", "from": before, "to": jump.time, "at": jump.time,
                "coordinate": jump.coordinate.index(), "what": text }));
        }
        let findings: Vec<Value> = found.findings.iter().map(said).collect();
        Ok(Answer::of(&json!({ "spans": spans, "findings": findings, "holds": found.holds() })))
    }
}

/// An angle or a length in words.
fn amount(kind: CoordinateKind, value: f64) -> String {
    match kind {
        CoordinateKind::Translation => format!("{:.1} mm", value * 1e3),
        CoordinateKind::Rotation | CoordinateKind::Orientation => {
            format!("{:.1}°", value.to_degrees())
        }
        _ => format!("{value:.3}"),
    }
}

/// A motion that the page has.
pub(crate) fn motion(model: &condyle::Model, question: &Value) -> Result<Motion, Fault> {
    let numbers = |value: &Value| -> Option<Vec<f64>> {
        value.as_array()?.iter().map(Value::as_f64).collect()
    };
    let times = numbers(&question["times"]).ok_or_else(|| sentence("a motion has times"))?;
    let frames = question["frames"].as_array().ok_or_else(|| sentence("a motion has frames"))?;
    let frames: Option<Vec<Vec<f64>>> = frames.iter().map(numbers).collect();
    let frames = frames.ok_or_else(|| sentence("a frame is a list of numbers"))?;
    if frames.len() != times.len() || frames.iter().any(|f| f.len() != model.stored_len()) {
        return Err(sentence("a frame has all stored numbers of the model, and a time"));
    }
    Ok(Motion { times, frames })
}
