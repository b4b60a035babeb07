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
        let follows = model.coordinates().get(index).is_some_and(|c| c.follows.is_some());
        if follows || tracking.unmoved.iter().any(|id| id.index() == index) {
            continue;
        }
        let trust = |frame| match tracking.trust_in(frame).get(index) {
            Some(Trust::Held) => Some("undetermined"),
            Some(Trust::AtLimit) => Some("limited"),
            _ => None,
        };
        let found = stretches(&tracking.times, trust);
        spans.extend(found.into_iter().map(|(kind, ends)| (kind, ends, sentence(&key, kind))));
    }
    spans
}

/// Stretches of one kind, as one where less than this lies between two of them, in seconds: nobody tells them apart.
const APART: f64 = 0.1;

/// The stretches of time of each kind, from the kinds of all frames.
fn stretches(
    times: &[f64],
    kind: impl Fn(usize) -> Option<&'static str>,
) -> Vec<(&'static str, [f64; 2])> {
    let mut found: Vec<(&'static str, [f64; 2])> = vec![];
    let mut before = None;
    for (frame, &now) in times.iter().enumerate() {
        let kind = kind(frame);
        // A stretch ends where the next frame begins.
        if let (Some(_), Some((_, [_, end]))) = (before, found.last_mut()) {
            *end = now;
        }
        match (kind, found.last_mut()) {
            (Some(kind), Some((last, [_, end]))) if *last == kind && now - *end < APART => {
                *end = now;
            }
            (Some(kind), _) => found.push((kind, [now, now])),
            _ => {}
        }
        before = kind;
    }
    found
}

fn sentence(key: &str, kind: &str) -> String {
    match kind {
        "limited" => format!("markers push {key} against its limit"),
        _ => format!("markers do not determine {key}"),
    }
}

#[cfg(test)]
mod tests {
    use super::stretches;

    #[test]
    fn stretches_close_to_each_other_are_one() {
        let times: Vec<f64> = (0..60).map(|frame| f64::from(frame) / 20.0).collect();
        // Frames 2 and 3, 5 hundredths later 5, half a second later 16, then another kind to the end.
        let kind = |frame| match frame {
            2 | 3 | 5 | 16 => Some("limited"),
            17.. => Some("undetermined"),
            _ => None,
        };
        let found = stretches(&times, kind);
        let expected =
            [("limited", [0.1, 0.3]), ("limited", [0.8, 0.85]), ("undetermined", [0.85, 2.95])];
        assert_eq!(found.len(), expected.len(), "{found:?}");
        for ((kind, ends), (wanted, places)) in found.iter().zip(expected) {
            assert_eq!(*kind, wanted);
            assert!(ends.iter().zip(places).all(|(a, b)| (a - b).abs() < 1e-12), "{found:?}");
        }
        assert!(stretches(&times, |_| None).is_empty());
    }
}
