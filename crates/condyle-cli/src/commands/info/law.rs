//! What `info` says of laws of coordinates.

use condyle::formats::document::law::{LawDocument, WrittenLaw};
use serde_json::{Map, Value, json};
use std::fmt::Write;

fn finite(number: f64) -> Value {
    if number.is_finite() { json!(number) } else { Value::Null }
}

/// The values where all controls are 0 and the slopes there.
fn at_zero(document: &LawDocument, law: &WrittenLaw) -> (f64, Map<String, Value>) {
    let zero = vec![0.0; document.controls.len()];
    let slopes = document.controls.iter().enumerate();
    let slopes = slopes.map(|(k, name)| (name.clone(), finite(law.function.slope(&zero, k))));
    (law.function.value(&zero), slopes.collect())
}

pub(super) fn to_json(document: &LawDocument) -> Value {
    let one = |law: &WrittenLaw| {
        let (intercept, slopes) = at_zero(document, law);
        json!({
            "dependent": law.dependent,
            "value_at_0": intercept,
            "slopes_at_0": slopes,
            "r2": finite(law.r2),
            "rmse": finite(law.rmse),
            "left_out_rmse": finite(law.left_out_rmse),
            "accepted": law.accepted,
        })
    };
    let bounds = document.region.as_ref().map(|region| {
        let ends = document.controls.iter().zip(region.low.iter().zip(&region.high));
        ends.map(|(name, (low, high))| (name.clone(), json!([low, high])))
            .collect::<Map<String, Value>>()
    });
    json!({
        "kind": "law",
        "name": document.name,
        "source": document.source,
        "frames_of": document.frames,
        "control": document.controls,
        "laws": document.laws.iter().map(one).collect::<Vec<_>>(),
        "region": bounds,
        "basis": document.basis.name(),
        "ridge": document.ridge,
        "condition": finite(document.condition),
        "trials": document.trials.len(),
        "frames": document.trials.iter().map(|(_, frames)| frames).sum::<usize>(),
    })
}

pub(super) fn to_text(document: &LawDocument) -> String {
    let count = document.laws.len();
    let mut out = format!(
        "{count} law{} of {}{}\n",
        if count == 1 { "" } else { "s" },
        document.controls.join(", "),
        if document.source.is_empty() { String::new() } else { format!("; {}", document.source) },
    );
    for law in &document.laws {
        let (value, slopes) = at_zero(document, law);
        let slopes: Vec<String> =
            slopes.iter().map(|(name, slope)| format!("{slope} per {name}")).collect();
        let _ = writeln!(out, "  {}: {value} at 0, {}", law.dependent, slopes.join(", "));
        let accepted = match law.accepted {
            Some(true) => ", accepted",
            Some(false) => ", not accepted",
            None => "",
        };
        if law.r2.is_finite() {
            let _ = writeln!(out, "    R² {:.4}{accepted}", law.r2);
        }
    }
    if let Some(region) = &document.region {
        for (name, (low, high)) in document.controls.iter().zip(region.low.iter().zip(&region.high))
        {
            let _ = writeln!(out, "  learned for {name} from {low:.4} to {high:.4}");
        }
    }
    out
}
