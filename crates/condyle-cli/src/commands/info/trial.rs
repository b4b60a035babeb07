//! A C3D trial: its markers as those of any recording, and all that stands beside them.

use super::recording;
use crate::output::{columns, wrapped};
use condyle::formats::c3d::{Kind, Other, Trial};
use serde_json::{Value, json};

fn others(trial: &Trial, kind: Kind) -> Vec<&Other> {
    trial.others.iter().filter(|other| other.kind == kind).collect()
}

fn storage(trial: &Trial) -> &'static str {
    if trial.storage.whole { "whole numbers" } else { "floats" }
}

pub(super) fn to_json(trial: &Trial) -> Value {
    let mut whole = recording::to_json(&trial.recording);
    let other = |other: &Other| json!({ "name": other.label, "kind": other.kind.name(), "unit": other.unit });
    let analog = &trial.analog;
    let channel = |c: &condyle::formats::c3d::Channel| json!({ "name": c.label, "unit": c.unit, "scale": c.scale * analog.scale, "offset": c.offset });
    let events = trial.events();
    let events = events.iter().map(|event| {
        json!({
            "label": event.label,
            "context": event.context,
            "subject": event.subject,
            "time": event.time,
        })
    });
    let platforms = trial.platforms();
    let platforms = platforms.iter().map(|platform| {
        json!({
            "type": platform.kind,
            "corners": platform.corners,
            "origin": platform.origin,
            "channels": platform.channels,
        })
    });
    whole["other_points"] = trial.others.iter().map(other).collect();
    whole["analog"] = json!({
        "rate": analog.rate,
        "samples": analog.samples(),
        "channels": analog.channels.iter().map(channel).collect::<Vec<_>>(),
    });
    whole["events"] = events.collect();
    whole["force_platforms"] = platforms.collect();
    whole["first_frame"] = trial.first_frame.into();
    whole["up"] = trial.up.name().into();
    whole["processor"] = trial.storage.processor.name().into();
    whole["storage"] = storage(trial).into();
    whole
}

pub(super) fn to_text(trial: &Trial) -> String {
    let mut text = recording::to_text(&trial.recording);
    for kind in Kind::ALL {
        let points = others(trial, kind);
        if let Some(first) = points.first() {
            let unit = if first.unit.is_empty() { "no unit" } else { &first.unit };
            let labels: Vec<&str> = points.iter().map(|other| other.label.as_str()).collect();
            text.push('\n');
            text.push_str(&wrapped(
                &format!("{}s ({}, {unit}):", kind.name(), labels.len()),
                &labels,
            ));
        }
    }
    let analog = &trial.analog;
    if !analog.channels.is_empty() {
        let (count, samples) = (analog.channels.len(), analog.samples());
        let names: Vec<String> = analog
            .channels
            .iter()
            .map(|c| match c.unit.as_str() {
                "" => c.label.clone(),
                unit => format!("{} ({unit})", c.label),
            })
            .collect();
        let names: Vec<&str> = names.iter().map(String::as_str).collect();
        let head = format!("analog channels ({count}, {samples} samples at {} Hz):", analog.rate);
        text.push('\n');
        text.push_str(&wrapped(&head, &names));
    }
    let events = trial.events();
    if !events.is_empty() {
        let row = |event: &condyle::formats::c3d::Event| {
            let time = format!("{:.3} s", event.time);
            vec![time, event.context.clone(), event.label.clone()]
        };
        text.push_str(&format!("\nevents ({}):\n", events.len()));
        text.push_str(&columns(&events.iter().map(row).collect::<Vec<_>>()));
    }
    let platforms = trial.platforms();
    if !platforms.is_empty() {
        let kinds: Vec<String> = platforms.iter().map(|p| format!("type {}", p.kind)).collect();
        let kinds: Vec<&str> = kinds.iter().map(String::as_str).collect();
        text.push('\n');
        text.push_str(&wrapped(&format!("force platforms ({}):", kinds.len()), &kinds));
    }
    text.push_str(&format!(
        "\nstored by {} as {}; {} points up in the file; first frame {}\n",
        trial.storage.processor.name(),
        storage(trial),
        trial.up.name(),
        trial.first_frame,
    ));
    text
}
