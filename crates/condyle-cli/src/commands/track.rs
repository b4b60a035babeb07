//! `condyle track`: marker recordings in, motion out.

pub(super) mod done;
pub(super) mod places;
mod report;
mod request;

use super::{Outcome, zeros};
use crate::digest::{Digest, Hashed};
use crate::failure::{Failure, warn_about, warned};
use crate::motion_format;
use crate::output::{self, Output};
use crate::progress::frames_bar;
use crate::screen::say;
use clap::Args;
use condyle::formats::Format;
use condyle::tracking::{Job, Request};
use condyle::{Model, open};
use places::Places;
use serde_json::{Value, json};
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
    /// The motion: .mot, .sto, .csv or .glb, `-`, or a folder (required with several recordings), in which
    /// each result has a report beside it and recordings of several folders keep theirs.
    #[arg(short, long)]
    output: Option<PathBuf>,
    /// The format of the motion; by default that of the file's ending.
    #[arg(long, value_parser = motion_format::motions())]
    to: Option<String>,
    /// Marker errors as a table: time, marker, error in metres; or a folder for those of several recordings.
    #[arg(long, value_name = "E.csv")]
    errors: Option<PathBuf>,
    /// Skip recordings whose results were made before from the same files by the same request.
    #[arg(long)]
    resume: bool,
    /// A summary of the tracking, as JSON; of several recordings the list of theirs.
    #[arg(long, value_name = "R.json")]
    report: Option<PathBuf>,
    /// Number of solver threads; all cores by default.
    #[arg(long, value_parser = clap::value_parser!(u16).range(1..=1024))]
    threads: Option<u16>,
    /// The report as one JSON document on standard output.
    #[arg(long)]
    json: bool,
}

/// How one recording ended.
struct Done {
    report: Value,
    /// Whether all frames were solved and the fit can be believed.
    holds: bool,
}

/// What is the same for all recordings.
struct Run<'a> {
    model: Arc<Model>,
    request: Request,
    format: &'static Format,
    made_from: Digest,
    asked: &'a Track,
}

impl Track {
    pub(crate) fn run(self) -> Result<Outcome, Failure> {
        let (places, format) = places::plan(&self)?;
        let model = Arc::new(warned(&self.model, open::model(&self.model)?));
        let mut request = self.asked.request(&model)?;
        request.threads = self.threads.map(usize::from);
        // Model and setup may have named further files.
        output::check_unread(places.iter().flat_map(Places::all).chain(self.report.as_deref()))?;
        let made_from = match places.iter().any(|places| places.report.is_some()) {
            true => done::of_run(&self.model, &model, &request, zeros(self.asked.zeros), format),
            false => Digest::default(),
        };
        let run = Run { model, request, format, made_from, asked: &self };
        let several = self.trials.len() > 1;
        let (mut reports, mut failed, mut odd) = (vec![], vec![], vec![]);
        for (trial, places) in self.trials.iter().zip(&places) {
            match run.one(trial, places) {
                Ok(done) => {
                    if !done.holds {
                        odd.push(trial.display().to_string());
                    }
                    reports.push(done.report);
                }
                Err(failure) if several => {
                    say(&format!("error: {failure}"));
                    let (name, why) = (trial.to_string_lossy(), failure.to_string());
                    reports.push(json!({ "trial": name, "error": why }));
                    failed.push(trial.display().to_string());
                }
                Err(failure) => return Err(failure),
            }
        }
        let whole = if several { Value::Array(reports) } else { reports.remove(0) };
        if let Some(path) = &self.report {
            output::write(path, pretty(&whole).as_bytes())?;
        }
        if self.json {
            output::print_json(&whole)?;
        }
        let count = self.trials.len();
        if several && !odd.is_empty() {
            say(&format!(
                "{} of {count} recordings have frames that were not solved, or a fit that is not plausible: {}",
                odd.len(),
                odd.join(", ")
            ));
        }
        if !failed.is_empty() {
            return Err(Failure::new(format!(
                "{} of {count} recordings could not be tracked: {}",
                failed.len(),
                failed.join(", ")
            )));
        }
        Ok(if odd.is_empty() { Outcome::Done } else { Outcome::DoesNotHold })
    }

    /// Whether nothing but results goes to standard output.
    fn is_quiet(&self) -> bool {
        let results = [&self.output, &self.errors, &self.report].into_iter().flatten();
        self.json || results.into_iter().any(|path| output::is_standard(path))
    }
}

impl Run<'_> {
    /// Tracks one recording. Its results are in place before its report is, so that a report speaks of
    /// whole results only.
    fn one(&self, trial: &Path, places: &Places) -> Result<Done, Failure> {
        let made_from =
            places.report.as_ref().and_then(|_| done::of_trial(&self.made_from, trial, places));
        if self.asked.resume
            && let Some(report) = made_from
                .as_deref()
                .and_then(|from| done::found(from, places.report.as_deref(), &places.results()))
        {
            say(&format!("note: {}: done before and unchanged, skipped", trial.display()));
            let failed =
                report["failed_frames"].as_array().is_some_and(|frames| !frames.is_empty());
            let holds = !failed && report["verdict"]["plausible"] == true;
            return Ok(Done { report, holds });
        }
        let recording = warned(trial, open::recording_with(trial, zeros(self.asked.asked.zeros))?);
        let bar = frames_bar(&trial.file_name().unwrap_or_default().to_string_lossy());
        let mut solved = Instant::now();
        let mut progress = |done: usize, total: usize| {
            bar.set_length(total as u64);
            bar.set_position(done as u64);
            solved = Instant::now();
        };
        let job = Job::new(Arc::clone(&self.model), &recording, &self.request)
            .map_err(|error| Failure::new(format!("{}: {error}", trial.display())))?;
        let start = Instant::now();
        let tracking = job.run(&mut progress);
        // Solving alone: what follows the last progress is judging.
        let seconds = solved.duration_since(start).as_secs_f64();
        bar.finish_and_clear();
        warn_about(trial, &tracking.warnings);
        let report = tracking.report(&self.model);
        let holds = report.summary.failed.is_empty() && report.verdict.plausible;
        let mut results = vec![];
        if let Some(place) = &places.motion {
            let (format, model, name) = (self.format, &self.model, places::stem(trial));
            let write = |output: &mut Hashed<Output>| {
                motion_format::write_tracked(
                    output, place, format, model, &tracking, &name, &recording,
                )
            };
            results.push(("motion", hashed(place, write)?));
        }
        if let Some(place) = &places.errors {
            let write = |output: &mut Hashed<Output>| {
                let written = motion_format::write_errors(output, &tracking);
                written.map_err(|error| output::not_written(place, error))
            };
            results.push(("errors", hashed(place, write)?));
        }
        if !self.asked.is_quiet() {
            report::print(trial, &recording, &report, seconds)?;
        }
        let mut report = report::json(trial, &report, seconds);
        if let Some(place) = &places.report {
            report["resume"] = done::mark(made_from.as_deref(), &results);
            output::write(place, pretty(&report).as_bytes())?;
        }
        Ok(Done { report, holds })
    }
}

/// Writes a result, and answers with its digest.
pub(super) fn hashed(
    place: &Path,
    write: impl FnOnce(&mut Hashed<Output>) -> Result<(), Failure>,
) -> Result<String, Failure> {
    let mut output = Hashed::new(Output::create(place)?);
    write(&mut output)?;
    let (output, digest) = output.finish();
    output.finish().map(|()| digest)
}

pub(super) fn pretty(value: &Value) -> String {
    format!("{}\n", serde_json::to_string_pretty(value).unwrap_or_default())
}
