//! What is said of a tracking: one JSON document, or a few lines.

use crate::failure::Failure;
use crate::output;
use condyle::formats::Recording;
use condyle::tracking::{BeyondRange, Determination, Faulty, Jump, MarkerErrors, Report, Unused};
use serde_json::{Value, json};
use std::path::Path;

pub(super) fn json(trial: &Path, report: &Report, seconds: f64) -> Value {
    let s = &report.summary;
    let errors = |m: &MarkerErrors| (m.name.clone(), json!({ "rms_m": m.rms, "max_m": m.max }));
    let markers: serde_json::Map<String, Value> = report.markers.iter().map(errors).collect();
    let failed = s
        .failed
        .iter()
        .map(|f| json!({ "frame": f.frame, "time": f.time, "status": f.status.name() }));
    let swaps = report.swaps.iter().map(
        |swap| json!({ "labels": swap.labels, "frames": [swap.frames.start, swap.frames.end] }),
    );
    let determined = |d: &Determination| {
        let shares = json!({
            "determined": d.determined, "weak": d.weak, "held": d.held, "at_limit": d.at_limit,
            "not_determined_s": d.spans,
        });
        (d.coordinate.clone(), shares)
    };
    let determination: serde_json::Map<String, Value> =
        report.determination.iter().map(determined).collect();
    let faulty = |left_out: bool| -> Vec<Value> {
        let wanted = report.faulty.iter().filter(|f| f.fault.is_left_out() == left_out);
        let one = |f: &Faulty| {
            let frames = [f.frames.start, f.frames.end];
            json!({ "label": f.label, "frames": frames, "fault": f.fault.name() })
        };
        wanted.map(one).collect()
    };
    let beyond = |b: &BeyondRange| {
        let [least, greatest] = b.values;
        let found =
            json!({ "range": b.range, "least": least, "greatest": greatest, "frames": b.frames });
        (b.coordinate.clone(), found)
    };
    let beyond: serde_json::Map<String, Value> = report.beyond_range.iter().map(beyond).collect();
    json!({
        "trial": trial.to_string_lossy(),
        "frames": s.frames,
        "seconds": seconds,
        "frames_per_second": s.frames as f64 / seconds.max(1e-9),
        "markers_used": s.markers_used,
        "rms_m": s.rms,
        "max_m": s.max,
        "objective": s.objective,
        "objective_markers": s.objective_markers,
        "failed_frames": failed.collect::<Vec<_>>(),
        "loop_error_m": report.loop_error,
        "iterations": report.iterations,
        "objective_posture": s.objective_posture,
        "mostly_at_limit": report.mostly_at_limit,
        "determination": determination,
        "unmoved": report.unmoved,
        "beyond_range": beyond,
        "jumps": report.jumps.iter().map(|jump| jump.frame).collect::<Vec<_>>(),
        "jump_details": report.jumps.iter().map(jump_json).collect::<Vec<_>>(),
        "swapped_labels": swaps.collect::<Vec<_>>(),
        "left_out": faulty(true),
        "not_resolved": faulty(false),
        "unused_markers": {
            "model": names(&report.unused.model),
            "recording": names(&report.unused.recording),
        },
        "never_seen": report.unused.never_seen,
        "without_weight": report.unused.without_weight,
        "verdict": {
            "plausible": report.verdict.plausible,
            "cause": report.verdict.cause.as_ref().map(|cause| &cause.message),
        },
        "markers": markers,
    })
}

fn jump_json(jump: &Jump) -> Value {
    let (coordinate, change) = jump.coordinate.as_ref().map(|(key, by)| (key, by)).unzip();
    json!({
        "frame": jump.frame,
        "segment": jump.segment,
        "turn_rad": jump.turn,
        "coordinate": coordinate,
        "change_rad": change,
        "cause": jump.cause.to_string(),
    })
}

pub(super) fn print(
    trial: &Path,
    recording: &Recording,
    report: &Report,
    seconds: f64,
) -> Result<(), Failure> {
    let s = &report.summary;
    let mut text = format!(
        "{}: {} frames, {} of {} markers, {:.0} frames/s\n  marker error {:.2} mm RMS, {:.1} mm at worst\n",
        trial.display(),
        s.frames,
        s.markers_used,
        recording.labels.len(),
        s.frames as f64 / seconds.max(1e-9),
        1e3 * s.rms,
        1e3 * s.max,
    );
    let mut worst: Vec<&MarkerErrors> = report.markers.iter().collect();
    worst.sort_by(|a, b| b.rms.total_cmp(&a.rms));
    let row = |m: &&MarkerErrors| {
        let [rms, max] = [1e3 * m.rms, 1e3 * m.max];
        vec![m.name.clone(), format!("{rms:.1} mm RMS,"), format!("{max:.1} mm at worst")]
    };
    let rows: Vec<Vec<String>> = worst.iter().take(3).map(row).collect();
    text.push_str(&output::columns(&rows));
    for swap in &report.swaps {
        text.push_str(&format!(
            "  {swap}
"
        ));
    }
    for faulty in &report.faulty {
        text.push_str(&format!(
            "  {faulty}
"
        ));
    }
    if let [first, ..] = s.failed[..] {
        text.push_str(&format!(
            "  {} frames not solved, the first is frame {} ({})\n",
            s.failed.len(),
            first.frame,
            first.status.name()
        ));
    }
    text.push_str(&left_out("never seen", &report.unused.never_seen));
    text.push_str(&left_out("of weight 0", &report.unused.without_weight));
    text.push_str(&unused("model", "recording", report, &report.unused.model));
    text.push_str(&unused("recording", "model", report, &report.unused.recording));
    if !report.mostly_at_limit.is_empty() {
        let keys = output::few(report.mostly_at_limit.iter().cloned());
        text.push_str(&format!("  mostly at a limit: {keys}\n"));
    }
    let unsure = report.determination.iter();
    let unsure = unsure.filter(|d| !d.is_sure() && !report.unmoved.contains(&d.coordinate));
    let unsure: Vec<String> = unsure.map(|d| d.coordinate.clone()).collect();
    if !unsure.is_empty() {
        text.push_str(&format!(
            "  hardly determined by the markers: {}\n",
            output::few(unsure.into_iter())
        ));
    }
    if !report.unmoved.is_empty() {
        let keys = output::few(report.unmoved.iter().cloned());
        text.push_str(&format!("  move no marker, held at rest: {keys}\n"));
    }
    for beyond in &report.beyond_range {
        let degrees = |values: [f64; 2]| values.map(|value| format!("{:.1}°", value.to_degrees()));
        let ([least, greatest], [lower, upper]) = (degrees(beyond.values), degrees(beyond.range));
        text.push_str(&format!(
            "  `{}` runs from {least} to {greatest}, beyond its range {lower} to {upper}: whole turns are the \
             same posture\n",
            beyond.coordinate
        ));
    }
    let most = report.jumps.iter().max_by(|a, b| a.turn.total_cmp(&b.turn));
    if let (Some(most), [first, ..]) = (most, &report.jumps[..]) {
        let n = report.jumps.len();
        let (noun, which) = match n {
            1 => ("jump", String::new()),
            _ => ("jumps", format!("the first at frame {}, the greatest at ", first.frame)),
        };
        text.push_str(&format!("  {n} {noun} of more than 60 degrees: {which}{most}\n"));
    }
    if let Some(cause) = &report.verdict.cause {
        text.push_str(&format!("  not plausible: {}\n", cause.sentence()));
    }
    output::print(text.as_bytes())
}

fn names(unused: &[Unused]) -> Vec<&str> {
    unused.iter().map(|one| one.name.as_str()).collect()
}

/// A line about markers that both sides have and that were not used all the same.
fn left_out(why: &str, names: &[String]) -> String {
    if names.is_empty() {
        return String::new();
    }
    let quoted = names.iter().map(|name| format!("`{name}`"));
    format!("  {} {why}, not used: {}\n", names.len(), output::few(quoted))
}

/// A line about the names of one side that the other does not have, those with a likely partner first.
fn unused(side: &str, other: &str, report: &Report, unused: &[Unused]) -> String {
    let said = [&report.unused.never_seen, &report.unused.without_weight];
    let known = |one: &&Unused| said.iter().any(|names| names.contains(&one.name));
    let mut sorted: Vec<&Unused> = unused.iter().filter(|one| !known(one)).collect();
    if sorted.is_empty() {
        return String::new();
    }
    sorted.sort_by_key(|one| one.partner.is_none());
    let said = sorted.iter().map(|one| match &one.partner {
        Some(partner) => format!("`{}` (is it the {other}'s `{partner}`?)", one.name),
        None => format!("`{}`", one.name),
    });
    let n = sorted.len();
    let noun = if n == 1 { "marker" } else { "markers" };
    format!("  {n} {noun} of the {side} not used: {}\n", output::few(said))
}
