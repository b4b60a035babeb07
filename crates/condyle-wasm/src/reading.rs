//! Files that are dropped on the page.
//!
//! Formats are named one by one: the table of all of them would bring every reader along, and the page has to
//! stay small. What is not here, a server reads.

use crate::answer::{Answer, Fault, fault, said, sentence};
use crate::goals;
use crate::shown::Shown;
use condyle::formats::{bvh, c3d, csv, document, exchange, poses, sto, trc};
use condyle::tracking::{Request, track};
use condyle::{Diagnostic, Error, Model, Motion, Read, Recording, Table, Zeros, open, shipped};
use serde_json::{Value, json};

/// What a file gives the page.
#[derive(Debug)]
pub enum Given {
    /// A model, and the motion that its file holds.
    Model(Box<Model>, Answer),
    /// A motion of the model that stands there.
    Motion(Answer),
}

/// Reads the bytes of a file by its ending; a motion or a recording needs the `model` that it is of, and a
/// recording is tracked. The name of a shipped model without bytes is that model, and documents may include the texts of
/// shipped ones.
///
/// # Errors
/// Everything that is wrong, as JSON.
pub fn read(model: Option<&Model>, name: &str, bytes: &[u8]) -> Result<Given, Fault> {
    if let Some(text) = shipped::text(name).filter(|_| bytes.is_empty()) {
        return documented(text);
    }
    let ending = name.rsplit_once('.').map_or("", |(_, ending)| ending).to_lowercase();
    let needed = || model.ok_or_else(|| sentence("give a model first"));
    let wrong = |error: Error| fault(&error);
    match &ending[..] {
        "toml" => {
            let text = std::str::from_utf8(bytes).map_err(|e| sentence(e.to_string()))?;
            if document::kind(bytes) != Some(document::Kind::Goals) {
                return documented(text);
            }
            needed()?;
            let goals = goals::described(text, model)?;
            let text = json!({ "motion": null, "goals": goals, "warnings": [] });
            Ok(Given::Motion(Answer::of(&text)))
        }
        "json" if is_model(bytes) => {
            let read = exchange::read(bytes).map_err(wrong)?;
            Ok(alone(read.value, &read.warnings))
        }
        "json" => {
            let read = poses::read(bytes).map_err(wrong)?;
            if read.value.are_keys() {
                // The page has their file, and asks for what is between them.
                let keys: Value = serde_json::from_slice(bytes).unwrap_or(Value::Null);
                let warnings = warned(&read.warnings);
                let text = json!({ "motion": null, "keys": keys, "warnings": warnings });
                return Ok(Given::Motion(Answer::of(&text)));
            }
            let resolved = read.value.resolve(needed()?).map_err(wrong)?;
            let shown = Shown::of(name.to_owned(), resolved.motion);
            Ok(Given::Motion(answered(&shown, &read.warnings)))
        }
        "bvh" => {
            let Read { value, warnings } = bvh::from_bytes(bytes).map_err(wrong)?;
            if value.motion.frames.len() < 2 {
                return Ok(alone(value.model, &warnings));
            }
            let shown = Shown::of(name.to_owned(), value.motion);
            Ok(Given::Model(Box::new(value.model), answered(&shown, &warnings)))
        }
        #[cfg(feature = "opensim")]
        "osim" => {
            let read = condyle::formats::opensim::model::read(bytes).map_err(wrong)?;
            Ok(alone(read.value, &read.warnings))
        }
        "trc" => tracked(needed()?, name, trc::from_bytes(bytes).map_err(wrong)?),
        "c3d" => {
            let read = c3d::from_bytes(bytes).map_err(wrong)?;
            tracked(needed()?, name, read.map(|trial| trial.recording))
        }
        "mot" | "sto" => table(needed()?, name, sto::from_bytes(bytes).map_err(wrong)?),
        "csv" => table(needed()?, name, csv::from_bytes(bytes).map_err(wrong)?),
        _ => Err(sentence(format!(
            "{name}: the page reads .toml, .json, .bvh, .trc, .c3d, .mot, .sto and .csv; \
             `condyle view {name}` reads all that condyle does"
        ))),
    }
}

/// A model document; it may include the texts of shipped ones.
fn documented(text: &str) -> Result<Given, Fault> {
    let mut include = |name: &str| {
        let own = shipped::included(name).map(str::to_owned);
        own.map_err(|_| format!("`{name}` is another file, which a page cannot open"))
    };
    let read = document::read(text, &mut include).map_err(|error| fault(&error))?;
    Ok(alone(read.value.model, &read.warnings))
}

/// Whether JSON is a resolved model, not poses.
fn is_model(bytes: &[u8]) -> bool {
    let head = String::from_utf8_lossy(bytes.get(..256).unwrap_or(bytes));
    head.contains("\"condyle_model\"")
}

fn alone(model: Model, warnings: &[Diagnostic]) -> Given {
    let answer = Answer::of(&json!({ "motion": null, "warnings": warned(warnings) }));
    Given::Model(Box::new(model), answer)
}

/// A motion, or markers that are tracked.
fn table(model: &Model, name: &str, read: Read<Table>) -> Result<Given, Fault> {
    let Read { value: mut table, warnings } = read;
    let settled = open::settled(model, &mut table, None).map_err(|error| fault(&error))?;
    let (motion, more) = Motion::from_table(model, &table);
    let warnings = [warnings, settled, more].concat();
    Ok(Given::Motion(answered(&Shown::of(name.to_owned(), motion), &warnings)))
}

fn tracked(model: &Model, name: &str, read: Read<Recording>) -> Result<Given, Fault> {
    let Read { value: mut recording, mut warnings } = read;
    warnings.extend(recording.settle_zeros(Zeros::Told));
    let tracking = track(model, &recording, &Request::default(), &mut |_, _| {});
    let tracking = tracking.map_err(|error: Error| fault(&error))?;
    warnings.extend(tracking.warnings.iter().cloned());
    let shown = Shown::tracked(name.to_owned(), model, &recording, &tracking);
    Ok(Given::Motion(answered(&shown, &warnings)))
}

fn answered(shown: &Shown, warnings: &[Diagnostic]) -> Answer {
    let mut answer = Answer::default();
    let motion = shown.to_json(|numbers| answer.floats(numbers));
    answer.text = json!({ "motion": motion, "warnings": warned(warnings) }).to_string();
    answer
}

fn warned(warnings: &[Diagnostic]) -> Vec<Value> {
    warnings.iter().map(said).collect()
}
