//! The shipped human on recordings of whole bodies: `cargo run --release --example track_human -- FOLDER`.
//!
//! FOLDER holds recordings at the places listed here. Lengths and markers are taken from a static trial
//! where there is one, else from the first frame of the recording; beside the answer stands that of the
//! model that came with the recording. One table is printed, in Markdown.

use condyle::formats::Recording;
use condyle::scaling::{self, Assumptions as Sizing};
use condyle::tracking::{Request, track};
use condyle::{Model, open};
use std::error::Error;
use std::path::{Path, PathBuf};

/// Recording, static trial, and the model that came with them.
const TRIALS: [(&str, Option<&str>, Option<&str>); 5] = [
    (
        "knee/opencap4/squats1.trc",
        Some("knee/opencap4/static1.trc"),
        Some("knee/opencap4/manually_scaled.osim"),
    ),
    (
        "knee/opencap4/walking1.trc",
        Some("knee/opencap4/static1.trc"),
        Some("knee/opencap4/manually_scaled.osim"),
    ),
    ("knee/gait_walk.trc", None, None),
    ("knee/gait_walk2.trc", None, None),
    (
        "ik/lai_subject6/walking1.trc",
        None,
        Some("ik/lai_subject6/LaiArnoldModified2017_scaled.osim"),
    ),
];

fn main() -> Result<(), Box<dyn Error>> {
    let Some(folder) = std::env::args().nth(1).map(PathBuf::from) else {
        return Err("give the folder of the recordings".into());
    };
    let human = open::model(Path::new("human"))?.value;
    println!(
        "| recording | lengths from | human as shipped | lengths fitted | markers placed, too | its own .osim |"
    );
    println!("| --- | --- | ---: | ---: | ---: | ---: |");
    for (name, static_trial, own) in TRIALS {
        let path = folder.join(name);
        if !path.exists() {
            println!("| {name} | is not there | | | | |");
            continue;
        }
        let recording = open::recording(&path)?.value;
        let standing = match static_trial {
            Some(trial) => open::recording(&folder.join(trial))?.value,
            None => first_frame(&recording),
        };
        let fitted = |keep_markers| {
            let sizing = Sizing { keep_markers, ..Sizing::default() };
            scaling::fit(&human, &standing, &sizing).map(|scaled| scaled.model)
        };
        let own = match own {
            Some(own) => error(&open::model(&folder.join(own))?.value, &recording)?,
            None => "-".to_owned(),
        };
        println!(
            "| {name} | {} | {} | {} | {} | {own} |",
            static_trial.unwrap_or("its first frame"),
            error(&human, &recording)?,
            error(&fitted(true)?, &recording)?,
            error(&fitted(false)?, &recording)?,
        );
    }
    Ok(())
}

/// Mean over the frames of the RMS over all markers that model and recording share.
fn error(model: &Model, recording: &Recording) -> Result<String, Box<dyn Error>> {
    let tracking = track(model, recording, &Request::default(), &mut |_, _| {})?;
    let summary = tracking.summary();
    Ok(format!("{:.1} mm ({})", 1e3 * summary.rms, summary.markers_used))
}

fn first_frame(recording: &Recording) -> Recording {
    Recording {
        times: recording.times[..1].to_vec(),
        positions: recording.positions[..recording.labels.len()].to_vec(),
        ..recording.clone()
    }
}
