//! `condyle track`: marker recordings in, motion out.

mod report;
mod request;

use super::Outcome;
use crate::failure::{Failure, warn_about, warned};
use crate::motion_format;
use crate::output;
use crate::progress::frames_bar;
use clap::Args;
use condyle::formats::{Recording, csv};
use condyle::tracking::{Job, Tracking};
use condyle::{Model, open};
use serde_json::Value;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Instant;

#[derive(Debug, Args)]
pub(crate) struct Track {
    /// The model: a file, or the name of a shipped one.
    model: PathBuf,
    /// One or several marker recordings.
    #[arg(required = true)]
    trials: Vec<PathBuf>,
    #[command(flatten)]
    asked: request::Asked,
    /// The motion: .mot, .sto, .csv or .glb, `-`, or a folder (required with several recordings).
    #[arg(short, long)]
    output: Option<PathBuf>,
    /// The format of the motion; by default that of the file's ending.
    #[arg(long, value_parser = motion_format::motions())]
    to: Option<String>,
    /// Marker errors as a table: time, marker, error in metres.
    #[arg(long, value_name = "E.csv")]
    errors: Option<PathBuf>,
    /// A summary of the tracking, as JSON.
    #[arg(long, value_name = "R.json")]
    report: Option<PathBuf>,
    /// Number of solver threads; all cores by default.
    #[arg(long, value_parser = clap::value_parser!(u16).range(1..=1024))]
    threads: Option<u16>,
    /// The report as one JSON document on standard output.
    #[arg(long)]
    json: bool,
}

impl Track {
    pub(crate) fn run(self) -> Result<Outcome, Failure> {
        let model = Arc::new(warned(&self.model, open::model(&self.model)?));
        let mut request = self.asked.request(&model)?;
        request.threads = self.threads.map(usize::from);
        let several = self.trials.len() > 1;
        if several && self.output.as_ref().is_some_and(|o| o != Path::new("-") && !is_folder(o)) {
            return Err(Failure::new("several recordings need a folder for -o"));
        }
        let mut failed = false;
        let mut reports = vec![];
        for trial in &self.trials {
            let recording = warned(trial, open::recording(trial)?);
            let bar = frames_bar(&trial.file_name().unwrap_or_default().to_string_lossy());
            let mut solved = Instant::now();
            let mut progress = |done: usize, total: usize| {
                bar.set_length(total as u64);
                bar.set_position(done as u64);
                solved = Instant::now();
            };
            let job = Job::new(Arc::clone(&model), &recording, &request)
                .map_err(|error| Failure::new(format!("{}: {error}", trial.display())))?;
            let start = Instant::now();
            let tracking = job.run(&mut progress);
            // Solving alone: what follows the last progress is judging.
            let seconds = solved.duration_since(start).as_secs_f64();
            bar.finish_and_clear();
            warn_about(trial, &tracking.warnings);
            let report = tracking.report(&model);
            failed |= !report.summary.failed.is_empty() || !report.verdict.plausible;
            self.write_motion(&model, trial, &recording, &tracking)?;
            if let Some(path) = &self.errors {
                let path = self.for_trial(path, trial, "csv");
                output::write(&path, error_table(&tracking).as_bytes())?;
            }
            if !self.json && self.output.as_deref() != Some(Path::new("-")) {
                report::print(trial, &recording, &report, seconds)?;
            }
            reports.push(report::json(trial, &report, seconds));
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
        let (motion, remarks) = (&tracking.motion, tracking.remarks(model));
        let bytes = motion_format::encoded(format, model, motion, &name, markers, &remarks)?;
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
