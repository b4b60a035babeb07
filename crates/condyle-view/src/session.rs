//! What a page is given to show.

use crate::base64::base64;
use condyle::formats::{Content, exchange};
use condyle::open::{self, Cause, OpenError};
use condyle::tracking::{Request, Tracking, Trust, track};
use condyle::{Animation, Model, Motion, Read, Recording};
use serde_json::{Value, json};
use std::path::{Path, PathBuf};

/// Where a page with a session is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mode {
    /// It comes from the server of `condyle view`, which edits files and tells changes.
    Served,
    /// It is a file of its own.
    Exported,
}

/// A model with motions and recordings of it: all that a page shows.
#[derive(Clone, Debug, PartialEq)]
pub struct Session {
    /// What stands above the page.
    pub title: String,
    /// The model.
    pub model: Model,
    /// The motions, in the order in which they were named.
    pub motions: Vec<Shown>,
    /// Files of meshes that the model names: each with the address at which the page finds it.
    pub geometry: Vec<(String, String)>,
    /// The text file of the model where the page may edit it.
    pub source: Option<String>,
}

/// A motion, perhaps with what was measured.
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

impl Session {
    /// A session of a model alone.
    #[must_use]
    pub fn of(model: Model) -> Self {
        let title = model.name().to_owned();
        Self { title, model, motions: vec![], geometry: vec![], source: None }
    }

    /// Opens a model, and motions or recordings of it; a recording is tracked. A motion that the model's own
    /// file holds comes first.
    ///
    /// # Errors
    /// As [`open::content`]; a recording that cannot be tracked.
    pub fn open(model: &Path, motions: &[PathBuf]) -> Result<Read<Self>, OpenError> {
        let Read { value: Animation { model: found, motion }, mut warnings } =
            open::animation(model)?;
        let mut session = Self::of(found);
        let stem = model.file_stem().unwrap_or_default().to_string_lossy();
        session.title = stem.into_owned();
        if motion.frames.len() > 1 {
            session.motions.push(Shown::of(name(model), motion));
        }
        for path in motions {
            let read = Shown::open(path, &session.model)?;
            warnings.extend(read.warnings);
            session.motions.push(read.value);
        }
        Ok(Read { value: session, warnings })
    }

    /// The session as the page reads it. Its motions are in single precision, its model is exact.
    #[must_use]
    pub fn to_json(&self, mode: Mode) -> String {
        let text = exchange::write(&self.model);
        let geometry: serde_json::Map<String, Value> =
            self.geometry.iter().map(|(name, at)| (name.clone(), json!(at))).collect();
        let mode = match mode {
            Mode::Served => "served",
            Mode::Exported => "exported",
        };
        json!({
            "condyle": 1,
            "mode": mode,
            "title": self.title,
            "model": {
                "name": self.model.name(),
                "format": "json",
                "text": text,
                "geometry": geometry,
            },
            "motions": self.motions.iter().map(Shown::to_json).collect::<Vec<_>>(),
            "editable": self.source.is_some(),
            "source": self.source,
        })
        .to_string()
    }
}

impl Shown {
    /// A motion alone.
    #[must_use]
    pub fn of(name: String, motion: Motion) -> Self {
        Self { name, motion, markers: None, spans: vec![] }
    }

    /// Opens a motion, or a recording, which is tracked.
    ///
    /// # Errors
    /// As [`open::content`]; a recording that cannot be tracked.
    pub fn open(path: &Path, model: &Model) -> Result<Read<Self>, OpenError> {
        let recording = match open::content(path, None)? {
            Read { value: Content::Recording(recording), warnings } => (recording, warnings),
            Read { value: Content::Trial(trial), warnings } => (trial.recording, warnings),
            _ => return Ok(open::motion(path, model)?.map(|motion| Self::of(name(path), motion))),
        };
        let (recording, mut warnings) = recording;
        let tracking = track(model, &recording, &Request::default(), &mut |_, _| {});
        let tracking = tracking.map_err(|error| OpenError {
            path: path.to_owned(),
            cause: Cause::Content { error, text: None },
        })?;
        warnings.extend(tracking.warnings.iter().cloned());
        Ok(Read { value: Self::tracked(name(path), model, &recording, &tracking), warnings })
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

    fn to_json(&self) -> Value {
        let Motion { times, frames } = &self.motion;
        let numbers = frames.iter().flatten().map(|value| *value as f32);
        let markers = self.markers.as_ref().map(|recording| {
            let missing = [f64::NAN; 3];
            let places = recording.positions.iter().map(|p| p.position().unwrap_or(missing));
            let numbers = places.flatten().map(|value| value as f32);
            json!({ "names": recording.labels, "positions_base64": packed(numbers) })
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
            "values_base64": packed(numbers),
            "markers": markers,
            "spans": spans,
        })
    }
}

/// Single precision, the least byte first.
fn packed(numbers: impl Iterator<Item = f32>) -> String {
    base64(&numbers.flat_map(f32::to_le_bytes).collect::<Vec<u8>>())
}

/// The last part of a path.
fn name(path: &Path) -> String {
    path.file_name().unwrap_or_default().to_string_lossy().into_owned()
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
        let kind = |frame: usize| match tracking.trust_in(frame).get(index) {
            Some(Trust::Held) => Some("undetermined"),
            Some(Trust::AtLimit) => Some("limited"),
            _ => None,
        };
        if tracking.unmoved.iter().any(|id| id.index() == index) {
            continue;
        }
        let mut open: Option<(&'static str, f64)> = None;
        for (frame, &now) in tracking.times.iter().enumerate() {
            let kind = kind(frame);
            if open.map(|(kind, _)| kind) != kind {
                if let Some((kind, from)) = open {
                    spans.push((kind, [from, now], said(&key, kind)));
                }
                open = kind.map(|kind| (kind, now));
            }
        }
        if let (Some((kind, from)), Some(&last)) = (open, tracking.times.last()) {
            spans.push((kind, [from, last], said(&key, kind)));
        }
    }
    spans
}

fn said(key: &str, kind: &str) -> String {
    match kind {
        "limited" => format!("markers push {key} against its limit"),
        _ => format!("markers do not determine {key}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_session_says_what_it_holds() -> Result<(), OpenError> {
        let mut session = Session::open("knee".as_ref(), &[])?.value;
        let motion = Motion { times: vec![0.0, 0.5], frames: vec![vec![0.25], vec![-1.0]] };
        session.motions.push(Shown::of("bend.mot".to_owned(), motion));
        let json: Value = serde_json::from_str(&session.to_json(Mode::Served)).expect("it is JSON");
        assert_eq!((&json["mode"], &json["title"]), (&json!("served"), &json!("knee")));
        // 0.25 and -1 in single precision are 0x3e800000 and 0xbf800000.
        assert_eq!(json["motions"][0]["values_base64"], json!("AACAPgAAgL8="));
        let text = json["model"]["text"].as_str().expect("a text");
        let read = exchange::read(text.as_bytes()).expect("a model");
        assert!(read.value.find_coordinate("knee_angle_r").is_ok());
        assert_eq!(json["editable"], json!(false));
        Ok(())
    }
}
