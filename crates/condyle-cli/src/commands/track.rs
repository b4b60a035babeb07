//! `condyle track`: marker recordings in, motion out.

use super::Outcome;
use crate::failure::{Failure, warn_about, warned};
use crate::motion_format;
use crate::output;
use crate::progress::frames_bar;
use clap::{Args, ValueEnum};
use condyle::formats::{Recording, csv};
use condyle::tracking::{Plan, Tracking, track};
use condyle::{CoordinateId, Model, open};
use serde_json::{Value, json};
use std::path::{Path, PathBuf};

#[derive(Debug, Args)]
pub(crate) struct Track {
    /// The model: a file, or the name of a shipped one.
    model: PathBuf,
    /// One or several marker recordings.
    #[arg(required = true)]
    trials: Vec<PathBuf>,
    /// Weights, coordinate tasks and time range: a setup of OpenSim's inverse kinematics.
    #[arg(long, value_name = "IK.xml")]
    setup: Option<PathBuf>,
    /// The motion: .mot, .sto, .csv or .glb, `-`, or a folder (a must for several recordings).
    #[arg(short, long)]
    output: Option<PathBuf>,
    /// The format of the motion, if not by the ending.
    #[arg(long, value_parser = motion_format::motions())]
    to: Option<String>,
    /// Marker errors as a table: time, marker, error in metres.
    #[arg(long, value_name = "E.csv")]
    errors: Option<PathBuf>,
    /// Numbers about the whole tracking, as JSON.
    #[arg(long, value_name = "R.json")]
    report: Option<PathBuf>,
    /// How many threads solve; as many as there are cores if not given.
    #[arg(long, value_parser = clap::value_parser!(u16).range(1..=1024))]
    threads: Option<u16>,
    /// Hold coordinates to their enforced ranges.
    #[arg(long, value_enum, default_value_t = Limits::On)]
    limits: Limits,
    /// Find swapped labels, and weigh markers down that are far off where others agree.
    #[arg(long)]
    robust: bool,
    /// The report as one JSON document on standard output.
    #[arg(long)]
    json: bool,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Limits {
    Off,
    On,
}

impl Track {
    pub(crate) fn run(self) -> Result<Outcome, Failure> {
        let model = warned(&self.model, open::model(&self.model)?);
        let plan = self.plan()?;
        let several = self.trials.len() > 1;
        if several && self.output.as_ref().is_some_and(|o| o != Path::new("-") && !is_folder(o)) {
            return Err(Failure::new("several recordings need a folder for -o"));
        }
        let mut failed = false;
        let mut reports = vec![];
        for trial in &self.trials {
            let recording = warned(trial, open::recording(trial)?);
            let bar = frames_bar(&trial.file_name().unwrap_or_default().to_string_lossy());
            let mut progress = |done: usize, total: usize| {
                bar.set_length(total as u64);
                bar.set_position(done as u64);
            };
            let tracking = track(&model, &recording, &plan, &mut progress)
                .map_err(|error| Failure::new(format!("{}: {error}", trial.display())))?;
            bar.finish_and_clear();
            warn_about(trial, &tracking.warnings);
            let summary = tracking.summary();
            failed |= !summary.failed.is_empty();
            self.write_motion(&model, trial, &recording, &tracking)?;
            if let Some(path) = &self.errors {
                let path = self.for_trial(path, trial, "csv");
                output::write(&path, error_table(&tracking).as_bytes())?;
            }
            let report = report(&model, trial, &recording, &tracking);
            if !self.json && self.output.as_deref() != Some(Path::new("-")) {
                print_summary(trial, &recording, &tracking)?;
            }
            reports.push(report);
        }
        let whole = if several { Value::Array(reports) } else { reports.remove(0) };
        if let Some(path) = &self.report {
            let text = serde_json::to_string_pretty(&whole).unwrap_or_default();
            output::write(path, format!("{text}\n").as_bytes())?;
        }
        if self.json {
            output::print_json(&whole)?;
        }
        Ok(if failed { Outcome::DoesNotHold } else { Outcome::Done })
    }

    fn plan(&self) -> Result<Plan, Failure> {
        let mut plan = Plan::default();
        if let Some(path) = &self.setup {
            let setup = warned(path, open::setup(path)?);
            plan = Plan::from_setup(&setup);
            if let Some(name) = &setup.coordinate_file
                && plan.coordinates.iter().any(|(_, _, t)| {
                    *t == condyle::formats::opensim::setup::CoordinateTarget::FromFile
                })
            {
                let path = open::beside(path, name);
                plan.coordinate_file = Some(warned(&path, open::table(&path)?));
            }
        }
        plan.limits = self.limits == Limits::On;
        plan.robust = self.robust;
        plan.threads = self.threads.map(usize::from);
        Ok(plan)
    }

    /// A path for one of several recordings: a file of the trial's name in the folder.
    fn for_trial(&self, path: &Path, trial: &Path, ending: &str) -> PathBuf {
        if self.trials.len() == 1 && !is_folder(path) {
            return path.to_owned();
        }
        let stem = trial.file_stem().unwrap_or_default().to_string_lossy();
        path.join(format!("{stem}.{ending}"))
    }

    fn write_motion(
        &self,
        model: &Model,
        trial: &Path,
        recording: &Recording,
        tracking: &Tracking,
    ) -> Result<(), Failure> {
        let Some(path) = &self.output else { return Ok(()) };
        let folder = is_folder(path);
        // A folder's ending is no format's.
        let place = if folder { Path::new("-") } else { path };
        let format = motion_format::of_motion(place, self.to.as_deref())?;
        let name = trial.file_stem().unwrap_or_default().to_string_lossy();
        let markers = Some((recording, tracking.labels.as_slice()));
        let bytes = motion_format::encoded(format, model, &tracking.motion, &name, markers)?;
        output::write(&self.for_trial(path, trial, format.name), &bytes)
    }
}

/// Whether a path means a folder: it is one, or has no ending.
fn is_folder(path: &Path) -> bool {
    path != Path::new("-") && (path.is_dir() || path.extension().is_none())
}

fn error_table(tracking: &Tracking) -> String {
    let rows = tracking.motion.times.iter().zip(&tracking.answers).flat_map(|(&time, answer)| {
        let seen = tracking.markers.iter().zip(&answer.marker_errors);
        seen.filter(|(_, e)| e.is_finite()).map(move |(name, &e)| (time, name.as_str(), e))
    });
    csv::write_marker_errors(rows)
}

fn report(model: &Model, trial: &Path, recording: &Recording, tracking: &Tracking) -> Value {
    let s = tracking.summary();
    let markers: serde_json::Map<String, Value> = tracking
        .markers
        .iter()
        .zip(tracking.marker_errors())
        .map(|(name, (rms, max))| (name.clone(), json!({ "rms_m": rms, "max_m": max })))
        .collect();
    let failed: Vec<Value> = s
        .failed
        .iter()
        .map(|&(frame, status)| {
            json!({ "frame": frame, "time": recording.times.get(frame), "status": status.name() })
        })
        .collect();
    let swaps: Vec<Value> = tracking
        .swaps
        .iter()
        .map(
            |swap| json!({ "labels": swap.labels, "frames": [swap.frames.start, swap.frames.end] }),
        )
        .collect();
    let closure = tracking.answers.iter().map(|a| a.closure_error).fold(0.0, f64::max);
    let mostly = |(_, frames): &(CoordinateId, usize)| 2 * frames > s.frames;
    let at_limit: Vec<String> = tracking
        .at_limits(model)
        .into_iter()
        .filter(mostly)
        .map(|(id, _)| model.coordinate_key(id))
        .collect();
    json!({
        "trial": trial.to_string_lossy(),
        "frames": s.frames,
        "seconds": s.seconds,
        "frames_per_second": s.frames_per_second,
        "markers_used": s.markers_used,
        "rms_m": s.rms,
        "max_m": s.max,
        "objective": s.objective,
        "objective_markers": s.objective_markers,
        "failed_frames": failed,
        "loop_error_m": closure,
        "iterations": tracking.answers.iter().map(|a| u64::from(a.iterations)).sum::<u64>(),
        "mostly_at_limit": at_limit,
        "swapped_labels": swaps,
        "markers": markers,
    })
}

fn print_summary(trial: &Path, recording: &Recording, tracking: &Tracking) -> Result<(), Failure> {
    let s = tracking.summary();
    let mut text = format!(
        "{}: {} frames, {} of {} markers, {:.0} frames/s\n  marker error {:.2} mm RMS, {:.1} mm at worst\n",
        trial.display(),
        s.frames,
        s.markers_used,
        recording.labels.len(),
        s.frames_per_second,
        1e3 * s.rms,
        1e3 * s.max,
    );
    let mut worst: Vec<(&String, (f64, f64))> =
        tracking.markers.iter().zip(tracking.marker_errors()).collect();
    worst.sort_by(|a, b| b.1.0.total_cmp(&a.1.0));
    let rows: Vec<Vec<String>> = worst
        .iter()
        .take(3)
        .map(|(name, (rms, max))| {
            vec![
                (*name).clone(),
                format!("{:.1} mm RMS,", 1e3 * rms),
                format!("{:.1} mm at worst", 1e3 * max),
            ]
        })
        .collect();
    text.push_str(&output::columns(&rows));
    for swap in &tracking.swaps {
        text.push_str(&format!(
            "  labels `{}` and `{}` are swapped in frames {} to {}\n",
            swap.labels[0],
            swap.labels[1],
            swap.frames.start,
            swap.frames.end - 1
        ));
    }
    if let [(frame, status), ..] = s.failed[..] {
        text.push_str(&format!(
            "  {} frames not solved, the first is frame {frame} ({})\n",
            s.failed.len(),
            status.name()
        ));
    }
    output::print(text.as_bytes())
}
