//! A motion on the page, perhaps with what was measured.

use condyle::tracking::{Tracking, Trust};
use condyle::{Model, Motion, Recording};
use serde_json::{Value, json};

/// A motion with what it was tracked from.
#[derive(Clone, Debug, PartialEq)]
pub struct Shown {
    /// The name of its file.
    pub name: String,
    /// The coordinates over time.
    pub motion: Motion,
    /// The markers that it was tracked from, at the times of the motion.
    pub markers: Option<Recording>,
    /// Spans that deserve a look: their kind (`jump`, `undetermined`, `limited`), from when to when in
    /// seconds, and a sentence.
    pub spans: Vec<(&'static str, [f64; 2], String)>,
}

impl Shown {
    /// A motion alone.
    #[must_use]
    pub fn of(name: String, motion: Motion) -> Self {
        Self { name, motion, markers: None, spans: vec![] }
    }

    /// What was tracked from a recording.
    #[must_use]
    pub fn tracked(
        name: String,
        model: &Model,
        recording: &Recording,
        tracking: &Tracking,
    ) -> Self {
        let frames = tracking.frames.clone();
        let row = recording.labels.len();
        let places = frames.start * row..frames.end * row;
        let markers = Recording {
            labels: recording.labels.clone(),
            rate: recording.rate,
            times: tracking.times.clone(),
            positions: recording.positions.get(places).unwrap_or_default().to_vec(),
            ..Recording::default()
        };
        let spans = spans(model, tracking);
        Self { name, motion: tracking.motion(), markers: Some(markers), spans }
    }

    /// What the page reads of it; `pack` says where numbers go, and how the page finds them there.
    pub fn to_json(&self, mut pack: impl FnMut(&mut dyn Iterator<Item = f64>) -> Value) -> Value {
        let Motion { times, frames } = &self.motion;
        let values = pack(&mut frames.iter().flatten().copied());
        let markers = self.markers.as_ref().map(|recording| {
            let missing = [f64::NAN; 3];
            let places = recording.positions.iter().map(|p| p.position().unwrap_or(missing));
            json!({ "names": recording.labels, "positions": pack(&mut places.flatten()) })
        });
        let spans: Vec<Value> = self
            .spans
            .iter()
            .map(|(kind, [from, to], what)| {
                json!({ "kind": kind, "from": from, "to": to, "what": what })
            })
            .collect();
        json!({
            "name": self.name,
            "times": times,
            "width": frames.first().map_or(0, Vec::len),
            "values": values,
            "markers": markers,
            "spans": spans,
        })
    }
}

/// Where a tracking jumps, and where markers say nothing of a coordinate or push it against a bound.
fn spans(model: &Model, tracking: &Tracking) -> Vec<(&'static str, [f64; 2], String)> {
    let mut spans = vec![];
    let time = |frame: usize| {
        let frame = frame.saturating_sub(tracking.frames.start);
        tracking.times.get(frame).copied().unwrap_or(0.0)
    };
    for jump in &tracking.jumps {
        let ends = [time(jump.frame.saturating_sub(1)), time(jump.frame)];
        spans.push(("jump", ends, jump.to_string()));
    }
    for (index, key) in model.coordinate_keys().into_iter().enumerate() {
        if tracking.unmoved.iter().any(|id| id.index() == index) {
            continue;
        }
        let mut open: Option<(&'static str, f64)> = None;
        for (frame, &now) in tracking.times.iter().enumerate() {
            let kind = match tracking.trust_in(frame).get(index) {
                Some(Trust::Held) => Some("undetermined"),
                Some(Trust::AtLimit) => Some("limited"),
                _ => None,
            };
            if open.map(|(kind, _)| kind) != kind {
                if let Some((kind, from)) = open {
                    spans.push((kind, [from, now], sentence(&key, kind)));
                }
                open = kind.map(|kind| (kind, now));
            }
        }
        if let (Some((kind, from)), Some(&last)) = (open, tracking.times.last()) {
            spans.push((kind, [from, last], sentence(&key, kind)));
        }
    }
    spans
}

fn sentence(key: &str, kind: &str) -> String {
    match kind {
        "limited" => format!("markers push {key} against its limit"),
        _ => format!("markers do not determine {key}"),
    }
}
