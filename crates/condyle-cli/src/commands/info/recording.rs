//! A marker recording: frames, rate, markers and gaps.

use crate::output::{columns, wrapped};
use condyle::formats::Recording;
use serde_json::{Value, json};

/// How often a marker was not seen.
#[derive(Clone, Copy, Default)]
struct Missing {
    frames: usize,
    gaps: usize,
    longest: usize,
}

fn missing(recording: &Recording) -> Vec<Missing> {
    let mut missing = vec![Missing::default(); recording.labels.len()];
    for gap in recording.gaps() {
        let of_marker = &mut missing[gap.marker];
        of_marker.frames += gap.frames;
        of_marker.gaps += 1;
        of_marker.longest = of_marker.longest.max(gap.frames);
    }
    missing
}

/// From the first frame to the last, in seconds.
fn duration(recording: &Recording) -> f64 {
    match recording.times[..] {
        [first, .., last] => last - first,
        _ => 0.0,
    }
}

/// How sure each marker is on average, over the frames in which it was seen; `None` where the file does not say it.
fn confidences(recording: &Recording) -> Option<Vec<f64>> {
    recording.confidences.as_ref()?;
    let mean = |marker: usize| {
        let seen = (0..recording.frames()).filter(|&f| recording.position(f, marker).is_some());
        let (sum, count) = seen.fold((0.0, 0.0), |(sum, count), frame| {
            (sum + recording.confidence(frame, marker), count + 1.0)
        });
        if count > 0.0 { sum / count } else { 0.0 }
    };
    Some((0..recording.labels.len()).map(mean).collect())
}

pub(super) fn to_json(recording: &Recording) -> Value {
    let markers: Vec<Value> = recording
        .labels
        .iter()
        .zip(missing(recording))
        .map(|(name, missing)| {
            json!({
                "name": name,
                "missing_frames": missing.frames,
                "gaps": missing.gaps,
                "longest_gap": missing.longest,
            })
        })
        .collect();
    let mut whole = json!({
        "kind": "recording",
        "frames": recording.frames(),
        "rate": recording.rate,
        "duration": duration(recording),
        "time": [recording.times.first(), recording.times.last()],
        "unit": recording.units.name(),
        "markers": markers,
    });
    if let (Some(means), Some(markers)) = (confidences(recording), whole["markers"].as_array_mut())
    {
        for (marker, mean) in markers.iter_mut().zip(means) {
            marker["mean_confidence"] = json!(mean);
        }
    }
    let subjects = recording.subjects();
    if !subjects.is_empty() {
        let names = subjects.iter().map(|(name, count)| json!({ "name": name, "markers": count }));
        whole["subjects"] = names.collect();
    }
    whole
}

pub(super) fn to_text(recording: &Recording) -> String {
    let mut text = format!(
        "marker recording\n{} frames at {} Hz, {:.3} s from {} s on; lengths in {}\n\n",
        recording.frames(),
        recording.rate,
        duration(recording),
        recording.times.first().copied().unwrap_or_default(),
        recording.units.name(),
    );
    let names: Vec<&str> = recording.labels.iter().map(String::as_str).collect();
    text.push_str(&wrapped(&format!("markers ({}):", names.len()), &names));
    let subjects: Vec<String> = recording
        .subjects()
        .iter()
        .map(|(name, count)| format!("{name} ({count} markers)"))
        .collect();
    if !subjects.is_empty() {
        let subjects: Vec<&str> = subjects.iter().map(String::as_str).collect();
        text.push_str(&wrapped("subjects:", &subjects));
    }
    if let Some(means) = confidences(recording) {
        let told: Vec<String> =
            names.iter().zip(&means).map(|(name, mean)| format!("{name} {mean:.2}")).collect();
        let told: Vec<&str> = told.iter().map(String::as_str).collect();
        text.push_str(&wrapped("mean confidence, where seen:", &told));
    }
    let frames = recording.frames().max(1) as f64;
    let mut rows = vec![];
    for (name, missing) in names.iter().zip(missing(recording)) {
        if missing.frames > 0 {
            rows.push(vec![
                (*name).to_owned(),
                format!("{}", missing.frames),
                format!("{:.1} %", 100.0 * missing.frames as f64 / frames),
                format!("{}", missing.gaps),
                format!("{}", missing.longest),
            ]);
        }
    }
    if rows.is_empty() {
        text.push_str("\nno gaps: every marker is seen in every frame\n");
        return text;
    }
    text.push_str("\ngaps: frames missing, their share, number of gaps, frames of the longest\n");
    text.push_str(&columns(&rows));
    text
}
