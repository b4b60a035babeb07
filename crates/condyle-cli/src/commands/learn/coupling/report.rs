//! What is told of laws: all numbers in JSON, and a page of text.

use crate::output;
use condyle::CoordinateKind;
use condyle::learn::coupling::{Law, Laws, LeftOut, Scoped, Split, Validity};
use condyle::learning::Gathered;
use serde_json::{Map, Value, json};
use std::fmt::Write;

/// What is said of the criterion of 2010 wherever it is.
const NOTE: &str = "max|M·C - E| < min(E) of Pronost et al. 2010 compares an error with where the origin happens to lie: \
    read with |E| it accepts noise, read with signs it refuses every law of a negative coordinate; `accepted` does not use it";

/// A number, or null where it is not finite.
fn finite(number: f64) -> Value {
    if number.is_finite() { json!(number) } else { Value::Null }
}

fn left_out(left: &Option<LeftOut>) -> Value {
    left.as_ref().map_or(Value::Null, |left| {
        json!({
            "parts": left.parts,
            "rmse": left.rmse,
            "rmse_of_mean": left.rmse_of_mean,
            "rmse_of_own_mean": left.rmse_of_own_mean,
            "r2": finite(left.r2),
            "chance": left.chance,
        })
    })
}

fn validity(validity: &Option<Validity>) -> Value {
    validity.map_or(Value::Null, |v| {
        json!({
            "largest_deviation": v.largest,
            "min": v.least,
            "min_absolute": v.least_absolute,
            "holds_signed": v.signed(),
            "holds_absolute": v.absolute(),
            "note": NOTE,
        })
    })
}

fn unit(kind: Option<CoordinateKind>) -> Value {
    match kind {
        Some(CoordinateKind::Translation) => "m".into(),
        Some(CoordinateKind::Rotation) => "rad".into(),
        _ => Value::Null,
    }
}

pub(super) fn json(laws: &Laws, split: &Split, gathered: &Gathered, seconds: [f64; 2]) -> Value {
    let one = |law: &Law| {
        let named = |values: &[f64]| -> Map<String, Value> {
            laws.terms.iter().cloned().zip(values.iter().map(|v| finite(*v))).collect()
        };
        let ends = |[low, high]: &[f64; 2]| json!([finite(*low), finite(*high)]);
        let names = std::iter::once("intercept".to_owned()).chain(laws.terms.iter().cloned());
        let ci95: Map<String, Value> = names.clone().zip(law.ci95.iter().map(ends)).collect();
        let freedom: Map<String, Value> =
            names.zip(law.freedom.iter().map(|f| finite(*f))).collect();
        let partial: Map<String, Value> =
            laws.controls.iter().cloned().zip(law.partial_r2.iter().map(|v| json!(v))).collect();
        let scoped = |scoped: &Scoped| {
            let [intercept, slopes @ ..] = &scoped.coefficients[..] else { return Value::Null };
            json!({
                "scope": scoped.scope.name(),
                "name": scoped.name,
                "trials": scoped.trials,
                "frames": scoped.frames,
                "intercept": intercept,
                "slopes": named(slopes),
                "mean_deviation": scoped.mean_deviation,
                "rmse": scoped.rmse,
                "left_out_rmse": scoped.left_out_rmse,
                "global_left_out_rmse": scoped.global_left_out_rmse,
            })
        };
        json!({
            "dependent": law.dependent,
            "unit": unit(law.kind),
            "intercept": law.intercept,
            "slopes": named(&law.coefficients),
            "ci95": ci95,
            "freedom": freedom,
            "r2": law.r2,
            "adjusted_r2": law.adjusted_r2,
            "partial_r2": partial,
            "rmse": law.rmse,
            "mean_deviation": law.mean_deviation,
            "left_out_rmse": law.left_out.as_ref().map(|left| left.rmse),
            "accepted": law.accepted(),
            "left_out": left_out(&law.left_out),
            "left_out_subjects": left_out(&law.left_out_subjects),
            "left_out_motions": left_out(&law.left_out_motions),
            "criterion_2010": validity(&law.validity),
            "by_motion": law.scoped.iter().map(scoped).collect::<Vec<_>>(),
        })
    };
    let trials: Vec<Value> = laws
        .trials
        .iter()
        .zip(&gathered.marker_rms)
        .map(|(trial, rms)| {
            json!({
                "name": trial.name,
                "subject": trial.groups.subject,
                "motion": trial.groups.motion,
                "sub_motion": trial.groups.sub_motion,
                "frames": trial.frames,
                "missing": trial.missing,
                "badly_tracked": trial.badly_tracked,
                "marker_rms_m": rms,
            })
        })
        .collect();
    let dropped: Vec<Value> = laws
        .dropped
        .iter()
        .map(|(term, parts)| {
            let parts: Map<String, Value> =
                parts.iter().map(|(name, share)| (name.clone(), json!(share))).collect();
            json!({ "term": term, "is_the_sum_of": parts })
        })
        .collect();
    let constant: Vec<&str> =
        split.constant.iter().map(|c| gathered.samples.columns[*c].as_str()).collect();
    json!({
        "laws": laws.laws.iter().map(one).collect::<Vec<_>>(),
        "control": laws.controls,
        "follow": laws.laws.iter().map(|law| &law.dependent).collect::<Vec<_>>(),
        "constant": constant,
        "split": split.reason,
        "basis": laws.basis.name(),
        "ridge": laws.ridge,
        "terms": laws.terms,
        "rank": laws.rank(),
        "dropped": dropped,
        "condition": finite(laws.condition),
        "intervals_of": if laws.blocks { "blocks of the only trial" } else { "trials" },
        "region": {
            "low": laws.region.low,
            "high": laws.region.high,
            "centre": laws.region.centre,
            "inverse": laws.region.inverse,
            "distance": laws.region.distance,
        },
        "frames": laws.frames(),
        "trials": trials,
        "seconds": { "reading_and_tracking": seconds[0], "learning": seconds[1] },
    })
}

/// A number with its unit, in mm or degrees where that is known.
fn sized(value: f64, kind: Option<CoordinateKind>) -> String {
    match kind {
        Some(CoordinateKind::Translation) => format!("{:.3} mm", 1e3 * value),
        Some(CoordinateKind::Rotation) => format!("{:.3}°", value.to_degrees()),
        _ => format!("{value:.5}"),
    }
}

pub(super) fn text(laws: &Laws, split: &Split, gathered: &Gathered) -> String {
    let mut out = String::new();
    let frames = laws.frames();
    let missing: usize = laws.trials.iter().map(|trial| trial.missing).sum();
    let bad: usize = laws.trials.iter().map(|trial| trial.badly_tracked).sum();
    let _ = writeln!(
        out,
        "{} trials, {frames} frames; left out: {missing} with gaps, {bad} tracked badly",
        laws.trials.len()
    );
    let tracked: Vec<f64> = gathered.marker_rms.iter().flatten().copied().collect();
    if !tracked.is_empty() {
        let mean = tracked.iter().sum::<f64>() / tracked.len() as f64;
        let _ = writeln!(out, "tracking left {:.2} mm RMS at the markers", 1e3 * mean);
    }
    let _ = writeln!(out, "control: {}", laws.controls.join(", "));
    if !split.reason.is_empty() {
        let _ = writeln!(out, "  ({})", split.reason);
    }
    let _ = writeln!(
        out,
        "rank {} of {} terms, condition {:.1}{}",
        laws.rank(),
        laws.terms.len(),
        laws.condition,
        if laws.condition > 30.0 {
            ": controls move nearly together; a ridge may help"
        } else {
            ""
        }
    );
    for law in &laws.laws {
        let _ = writeln!(out, "\n{}", law.dependent);
        let mut rows =
            vec![["", "value", "95 % interval", "", "freedom"].map(str::to_owned).to_vec()];
        let names = std::iter::once("intercept").chain(laws.terms.iter().map(String::as_str));
        let values = std::iter::once(&law.intercept).chain(&law.coefficients);
        for (((name, value), [low, high]), freedom) in
            names.zip(values).zip(&law.ci95).zip(&law.freedom)
        {
            let shown = |x: f64| if x.is_finite() { format!("{x:.6}") } else { "-".to_owned() };
            let freedom = format!("{freedom:.1}");
            rows.push(vec![name.to_owned(), shown(*value), shown(*low), shown(*high), freedom]);
        }
        out.push_str(&output::columns(&rows));
        let _ = write!(out, "R² {:.4}, RMS error {}", law.r2, sized(law.rmse, law.kind));
        match &law.left_out {
            Some(left) => {
                let what = if laws.blocks { "blocks of time" } else { "trials" };
                let _ = writeln!(
                    out,
                    "; of {} {what} left out {} (their mean {})",
                    left.parts,
                    sized(left.rmse, law.kind),
                    sized(left.rmse_of_mean, law.kind)
                );
            }
            None => out.push('\n'),
        }
        for (what, left) in
            [("subjects", &law.left_out_subjects), ("motions", &law.left_out_motions)]
        {
            if let Some(left) = left {
                let _ = writeln!(
                    out,
                    "of {} {what} left out {} (their mean {})",
                    left.parts,
                    sized(left.rmse, law.kind),
                    sized(left.rmse_of_mean, law.kind)
                );
            }
        }
        if !law.scoped.is_empty() {
            let mut rows = vec![
                ["law of", "trials", "RMS", "left out", "global law there"]
                    .map(str::to_owned)
                    .to_vec(),
            ];
            for scoped in &law.scoped {
                let shown = |x: Option<f64>| x.map_or("-".to_owned(), |x| sized(x, law.kind));
                rows.push(vec![
                    format!("{} {}", scoped.scope.name().replace('_', "-"), scoped.name),
                    scoped.trials.to_string(),
                    sized(scoped.rmse, law.kind),
                    shown(scoped.left_out_rmse),
                    shown(scoped.global_left_out_rmse),
                ]);
            }
            out.push_str(&output::columns(&rows));
        }
        let _ = writeln!(
            out,
            "{}",
            match law.accepted() {
                true =>
                    "accepted: it predicts what was left out better than the mean does, beyond chance",
                false =>
                    "not accepted: it does not predict what was left out better than the mean does, beyond chance",
            }
        );
        if let Some(v) = law.validity {
            let holds = |holds: bool| if holds { "holds" } else { "does not hold" };
            let _ = writeln!(
                out,
                "criterion of Pronost et al. 2010: with |E| {}, with signs {} (it accepts noise and says nothing)",
                holds(v.absolute()),
                holds(v.signed())
            );
        }
    }
    out
}
