//! `condyle scale`: a model and a person who stands still in, a model of that person out.

mod subject;

use super::{Outcome, ZerosArgument, zeros};
use crate::failure::{Failure, warn_about, warned};
use crate::output;
use clap::Args;
use condyle::formats::document;
use condyle::open;
use condyle::scaling::{Assumptions, Factor, MarkerFit, Scaled, fit};
use serde_json::{Value, json};
use std::path::{Path, PathBuf};

/// How many of the markers that were moved farthest are shown.
const SHOWN: usize = 5;

#[derive(Debug, Args)]
pub(crate) struct Scale {
    /// The model; each of its size groups has one scale factor.
    model: PathBuf,
    /// A marker recording of the person standing still; with a setup instead of those that it names.
    #[arg(long = "static", value_name = "TRIAL", required_unless_present = "setup")]
    trial: Option<PathBuf>,
    /// The scaled model, or `-`: a document (.toml); an `.osim` with a setup comes back as its own file.
    #[arg(short, long, value_name = "SUBJECT")]
    output: PathBuf,
    /// Whose markers are meant, where the labels of several people begin with their names: `Anna:RFHD`.
    #[arg(long, value_name = "NAME")]
    subject: Option<String>,
    /// What a marker at exactly 0 0 0 is; without it, it is missing where it is elsewhere in other frames.
    #[arg(long, value_enum)]
    zeros: Option<ZerosArgument>,
    /// Keep the markers of the scaled model instead of moving them to where they were recorded.
    #[arg(long)]
    keep_markers: bool,
    /// A setup of OpenSim's scaling: factors along the axes of each body, by measurements or by hand. Bodies and markers are those of the
    /// model.
    #[arg(long, value_name = "SCALE.xml")]
    setup: Option<PathBuf>,
    /// The mass of the person, instead of the setup's.
    #[arg(long, value_name = "KG", requires = "setup")]
    mass: Option<f64>,
    /// Keep the shares of the bodies in the mass.
    #[arg(long, requires = "setup")]
    preserve_mass: bool,
    /// Leave what OpenSim leaves, and do the rest exactly as it does.
    #[arg(long, requires = "setup")]
    as_opensim: bool,
    /// What was scaled and what was not, as Markdown (.md) or JSON (.json).
    #[arg(long, value_name = "R.json", requires = "setup")]
    report: Option<PathBuf>,
    /// The results as one JSON document on standard output.
    #[arg(long)]
    json: bool,
}

impl Scale {
    pub(crate) fn run(self) -> Result<Outcome, Failure> {
        if let Some(setup) = &self.setup {
            return subject::run(&self, setup);
        }
        let Some(trial) = &self.trial else {
            return Err(Failure::new("give --static TRIAL, or --setup SCALE.xml"));
        };
        let to_screen = self.output == Path::new("-");
        if !to_screen && open::ending(&self.output) != "toml" {
            let path = self.output.display();
            let message =
                format!("{path}: a scaled model is written as a document: end it in .toml");
            return Err(Failure::new(message));
        }
        if to_screen && self.json {
            return Err(Failure::new(
                "--json and -o - both want standard output: give one of them",
            ));
        }
        output::check_distinct(&[&self.model, trial], &[&self.output])?;
        let model = warned(&self.model, open::model(&self.model)?);
        let recording = warned(trial, open::recording_with(trial, zeros(self.zeros))?);
        let assumed = Assumptions {
            subject: self.subject.clone(),
            keep_markers: self.keep_markers,
            ..Assumptions::default()
        };
        let scaled = fit(&model, &recording, &assumed)
            .map_err(|error| Failure::new(format!("{}: {error}", trial.display())))?;
        warn_about(trial, &scaled.warnings);
        let subject = match self.output.file_stem() {
            Some(stem) if !to_screen => scaled.model.named(&stem.to_string_lossy()),
            _ => scaled.model.clone(),
        };
        output::write(&self.output, document::write(&subject).as_bytes())?;
        if self.json {
            output::print_json(&self.report_of(trial, &scaled))?;
        } else if !to_screen {
            output::print(table(&scaled, assumed.keep_markers).as_bytes())?;
        }
        Ok(if scaled.status.is_solved() { Outcome::Done } else { Outcome::DoesNotHold })
    }

    fn report_of(&self, trial: &Path, scaled: &Scaled) -> Value {
        let factor = |f: &Factor| {
            json!({
                "name": f.name,
                "factor": f.factor,
                "spread": f.spread,
                "length_m": f.length,
                "change_m": change(f),
            })
        };
        let marker =
            |m: &MarkerFit| json!({ "name": m.name, "error_m": m.error, "moved_m": m.moved });
        json!({
            "model": self.model.to_string_lossy(),
            "trial": trial.to_string_lossy(),
            "body": factor(&scaled.body),
            "groups": scaled.groups.iter().map(factor).collect::<Vec<_>>(),
            "rms_before_m": scaled.rms_before,
            "rms_after_m": scaled.rms_after,
            "markers_used": scaled.markers.len(),
            "markers": scaled.markers.iter().map(marker).collect::<Vec<_>>(),
            "markers_unused": scaled.unused,
            "markers_moved": !self.keep_markers,
            "status": scaled.status.name(),
        })
    }
}

/// By how much the longest stretch has grown, in metres.
fn change(factor: &Factor) -> f64 {
    factor.length * (factor.factor - 1.0)
}

fn table(scaled: &Scaled, kept: bool) -> String {
    let row = |f: &Factor| {
        let length = match f.length > 0.0 {
            true => format!("{:+.1} mm of {:.1}", 1e3 * change(f), 1e3 * f.length),
            false => String::new(),
        };
        vec![
            f.name.clone(),
            format!("{:.4}", f.factor),
            format!("± {:.1} %,", 1e2 * f.spread),
            length,
        ]
    };
    let rows: Vec<Vec<String>> =
        std::iter::once(&scaled.body).chain(&scaled.groups).map(row).collect();
    let mut text = output::columns(&rows);
    text.push_str(&format!(
        "{} markers: {:.1} mm RMS before, {:.1} mm after\n",
        scaled.markers.len(),
        1e3 * scaled.rms_before,
        1e3 * scaled.rms_after,
    ));
    if !scaled.unused.is_empty() {
        let (n, names) = (scaled.unused.len(), scaled.unused.iter());
        let few = output::few(names.map(|name| format!("`{name}`")));
        let noun = if n == 1 { "marker" } else { "markers" };
        text.push_str(&format!("  {n} {noun} of the model not used: {few}\n"));
    }
    let by = |m: &MarkerFit| if kept { m.error } else { m.moved };
    let mut far: Vec<&MarkerFit> = scaled.markers.iter().collect();
    far.sort_by(|a, b| by(b).total_cmp(&by(a)));
    text.push_str(if kept { "farthest off:\n" } else { "moved to where they were seen:\n" });
    let rows: Vec<Vec<String>> = far
        .iter()
        .take(SHOWN)
        .map(|m| vec![m.name.clone(), format!("{:.1} mm", 1e3 * by(m))])
        .collect();
    text.push_str(&output::columns(&rows));
    text
}
