//! What is said of a motion that was brought within limits.

use super::count;
use crate::output::columns;
use condyle::check::motion::MotionCheck;
use condyle::constraining::{Fate, Repair, Step};
use condyle::{CoordinateKind, Model, Motion};
use serde_json::{Value, json};
use std::fmt::Write;
use std::path::Path;

/// So many changes and limits are shown on the screen.
const MOST_SHOWN: usize = 12;

/// One limit that a motion breaks.
struct Violation {
    limit: String,
    kind: String,
    frames: usize,
    runs: Vec<[usize; 2]>,
    frame: usize,
    time: f64,
    by: f64,
    unit: &'static str,
    nearest: Value,
    source: String,
}

fn unit(kind: CoordinateKind) -> &'static str {
    match kind {
        CoordinateKind::Rotation | CoordinateKind::Orientation => "rad",
        CoordinateKind::Translation => "m",
        _ => "1",
    }
}

/// The limits that are enforced and broken.
fn violations(model: &Model, check: &MotionCheck) -> Vec<Violation> {
    let ranges = check.outside.iter().filter(|outside| outside.enforced).map(|outside| {
        let worst = &outside.worst;
        Violation {
            limit: model.coordinate_key(outside.coordinate),
            kind: "range".to_owned(),
            frames: outside.frames,
            runs: outside.runs.clone(),
            frame: worst.frame,
            time: worst.time,
            by: worst.by,
            unit: unit(model.coordinate(outside.coordinate).kind),
            nearest: json!(worst.nearest),
            source: outside.source.clone(),
        }
    });
    let limits = check.broken.iter().map(|broken| {
        let component = &model.components()[broken.component.index()];
        let set = &model.joint_sets()[component.joint_set.index()].name;
        let nearest = broken.nearest.iter().map(|near| (near.name.clone(), json!(near.valid)));
        Violation {
            limit: format!("{set}.{}", component.name),
            kind: component.law.kind().name.to_owned(),
            frames: broken.frames,
            runs: broken.runs.clone(),
            frame: broken.frame,
            time: broken.time,
            by: broken.by,
            unit: unit(broken.kind),
            nearest: Value::Object(nearest.collect()),
            source: format!("the model's {}", component.law.kind().name),
        }
    });
    let loops = check.open_loops.iter().map(|open| Violation {
        limit: open.name.clone(),
        kind: "loop".to_owned(),
        frames: open.frames,
        runs: vec![],
        frame: open.frame,
        time: open.time,
        by: open.metres.max(open.radians),
        unit: if open.metres >= open.radians { "m" } else { "rad" },
        nearest: Value::Null,
        source: "the model".to_owned(),
    });
    ranges.chain(limits).chain(loops).collect()
}

/// The report of one motion, in radians and metres.
pub(super) fn json(path: &Path, model: &Model, motion: &Motion, repair: &Repair) -> Value {
    let shown = |check: &MotionCheck| -> Vec<Value> {
        let all = violations(model, check).into_iter().map(|v| {
            json!({
                "limit": v.limit, "kind": v.kind, "frames": v.frames, "runs": v.runs,
                "frame": v.frame, "time": v.time, "by": v.by, "unit": v.unit,
                "nearest": v.nearest, "source": v.source,
            })
        });
        all.collect()
    };
    let legal = &repair.legal;
    let step = |step: Step| json!({ "rad": step.turn, "m": step.slide });
    let left: Vec<usize> = legal.left().collect();
    let changes = repair.changes.iter().map(|change| {
        json!({
            "coordinate": model.coordinate_key(change.coordinate),
            "frames": change.frames,
            "mean": change.mean,
            "most": change.most,
            "frame": change.frame,
            "unit": unit(model.coordinate(change.coordinate).kind),
        })
    });
    json!({
        "motion": path.to_string_lossy(),
        "frames": motion.frames.len(),
        "changed": legal.changed(),
        "led_over": legal.seams,
        "blended": count(repair, Fate::Blended),
        "left": left,
        "violations": shown(&repair.before),
        "remaining": shown(&repair.after),
        "changes": changes.collect::<Vec<_>>(),
        "largest_step_of_change": {
            "each_frame_alone": step(legal.alone),
            "written": step(legal.step),
            "beyond_bound": step(legal.beyond),
        },
    })
}

/// The first line of the table.
const TITLES: &str = "motion,limit,kind,frames,first_frame,last_frame,worst_frame,time_s,beyond,unit,\
                      remaining_frames,source\n";

/// A row for each limit that a motion broke.
pub(super) fn csv(reports: &[Value]) -> String {
    let mut text = TITLES.to_owned();
    let none = vec![];
    for report in reports {
        let motion = cell(&report["motion"]);
        if !report["error"].is_null() {
            let _ = writeln!(text, "{motion},,error,,,,,,,,,{}", cell(&report["error"]));
        }
        let remaining = report["remaining"].as_array().unwrap_or(&none);
        for row in report["violations"].as_array().unwrap_or(&none) {
            let still = remaining.iter().find(|other| other["limit"] == row["limit"]);
            let still = still.map_or(json!(0), |other| other["frames"].clone());
            let runs = row["runs"].as_array().unwrap_or(&none);
            let [first, last] = [runs.first(), runs.last()];
            let first = first.map_or(Value::Null, |run| run[0].clone());
            let last = last.map_or(Value::Null, |run| run[1].clone());
            let keys = ["frame", "time", "by", "unit"].map(|key| cell(&row[key]));
            let _ = writeln!(
                text,
                "{motion},{},{},{},{},{},{},{still},{}",
                cell(&row["limit"]),
                cell(&row["kind"]),
                row["frames"],
                cell(&first),
                cell(&last),
                keys.join(","),
                cell(&row["source"]),
            );
        }
    }
    text
}

/// A value as a cell; quoted where it has to be.
fn cell(value: &Value) -> String {
    let text = match value {
        Value::Null => String::new(),
        Value::String(text) => text.clone(),
        other => other.to_string(),
    };
    match text.contains([',', '"', '\n', '\r']) {
        true => format!("\"{}\"", text.replace('"', "\"\"")),
        false => text,
    }
}

fn amount(unit: &str, value: f64) -> String {
    match unit {
        "rad" => format!("{:.2}°", value.to_degrees()),
        "m" => format!("{:.2} mm", value * 1e3),
        _ => format!("{value:.4}"),
    }
}

/// What is said on the screen.
pub(super) fn text(path: &Path, model: &Model, repair: &Repair) -> String {
    let legal = &repair.legal;
    let (changed, frames) = (legal.changed(), legal.motion.frames.len());
    let mut text = format!("{}: {changed} of {frames} frames changed\n", path.display());
    let broken = violations(model, &repair.before);
    let limits = broken.iter().map(|v| {
        let (frames, frame) = (v.frames.to_string(), v.frame.to_string());
        let by = amount(v.unit, v.by);
        vec![v.limit.clone(), v.kind.clone(), frames, frame, by, v.source.clone()]
    });
    table(&mut text, &["limit", "kind", "frames", "worst at", "beyond", "source"], limits);
    let changes = repair.changes.iter().map(|change| {
        let unit = unit(model.coordinate(change.coordinate).kind);
        let (mean, most) = (amount(unit, change.mean), amount(unit, change.most));
        let (frames, frame) = (change.frames.to_string(), change.frame.to_string());
        vec![model.coordinate_key(change.coordinate), frames, mean, most, frame]
    });
    table(&mut text, &["changed", "frames", "mean", "most", "at"], changes);
    if !legal.seams.is_empty() {
        let spans = legal.seams.iter().map(|[first, last]| format!("f{first}-{last}"));
        let _ = writeln!(
            text,
            "  led over from one side of a limit to another in {} (legal frames changed for it: {})",
            spans.collect::<Vec<_>>().join(", "),
            count(repair, Fate::Blended)
        );
    }
    if legal.beyond.turn > 0.0 || legal.beyond.slide > 0.0 {
        let _ = writeln!(
            text,
            "  warning: from frame to frame the change jumps by {} and {} more than it may",
            amount("rad", legal.beyond.turn),
            amount("m", legal.beyond.slide)
        );
    }
    let left = legal.left().count();
    if left > 0 {
        let _ = writeln!(text, "  warning: no legal pose was found for {left} frames");
    }
    text
}

/// Some rows under their titles; none where there are no rows.
fn table(text: &mut String, titles: &[&str], all: impl ExactSizeIterator<Item = Vec<String>>) {
    let more = all.len().saturating_sub(MOST_SHOWN);
    let mut rows = vec![titles.iter().map(|title| (*title).to_owned()).collect()];
    rows.extend(all.take(MOST_SHOWN));
    if rows.len() > 1 {
        text.push_str(&columns(&rows));
    }
    if more > 0 {
        let _ = writeln!(text, "  and {more} more (--json has all)");
    }
}
