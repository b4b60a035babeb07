//! What tells a later run that a recording is done: digests of what a result was made from, and of the
//! result.

use super::places::Places;
use crate::digest::{Digest, of_file};
use condyle::formats::{Format, document};
use condyle::tracking::Request;
use condyle::{Model, Zeros};
use serde_json::{Value, json};
use std::collections::BTreeMap;
use std::path::Path;

/// The part of the digest that all recordings of a run share: the program, the model with all that it
/// includes, and everything asked that changes a result.
pub(super) fn of_run(
    path: &Path,
    model: &Model,
    request: &Request,
    zeros: Zeros,
    format: &Format,
) -> Digest {
    let mut digest = Digest::default();
    digest.add("program", env!("CARGO_PKG_VERSION").as_bytes());
    digest.add("model file", of_file(path).unwrap_or_default().as_bytes());
    digest.add("model", document::write(model).as_bytes());
    // A map has no order of its own; threads change no result.
    let weights: Option<BTreeMap<_, _>> =
        request.marker_weights.as_ref().map(|w| w.iter().collect());
    let others = Request { marker_weights: None, threads: None, ..request.clone() };
    digest.add("weights", format!("{weights:?}").as_bytes());
    digest.add("asked", format!("{others:?}").as_bytes());
    digest.add("zeros", format!("{zeros:?}").as_bytes());
    digest.add("format", format.name.as_bytes());
    digest
}

/// The digest of all that one result is made from; `None` of a recording that can be read only once.
pub(super) fn of_trial(run: &Digest, trial: &Path, places: &Places) -> Option<String> {
    if !trial.is_file() {
        return None;
    }
    let mut digest = run.clone();
    digest.add("recording", of_file(trial).ok()?.as_bytes());
    // The name of a recording is the title of its motion.
    digest.add("name", super::places::stem(trial).as_bytes());
    digest.add("errors", &[u8::from(places.errors.is_some())]);
    Some(digest.finish())
}

/// What a report says about how it came about.
pub(in crate::commands) fn mark(made_from: Option<&str>, results: &[(&str, String)]) -> Value {
    let results: serde_json::Map<String, Value> =
        results.iter().map(|(what, digest)| ((*what).to_owned(), json!(digest))).collect();
    json!({ "made_from_sha256": made_from, "results_sha256": results })
}

/// The report of an input that is done: made from the same, with results that are still as written.
pub(in crate::commands) fn found(
    made_from: &str,
    report: Option<&Path>,
    results: &[(&str, &Path)],
) -> Option<Value> {
    let report = std::fs::read(report?).ok()?;
    let report: Value = serde_json::from_slice(&report).ok()?;
    let mark = report.get("resume")?;
    let as_written = |(what, place): &(&str, &Path)| {
        of_file(place).is_ok_and(|digest| mark["results_sha256"][*what].as_str() == Some(&*digest))
    };
    let done =
        mark["made_from_sha256"].as_str() == Some(made_from) && results.iter().all(as_written);
    done.then_some(report)
}
