//! `condyle upkeep`: a recording or a motion, filtered, filled, resampled, cut or turned.

use super::{Outcome, ZerosArgument, zeros};
use crate::failure::{Failure, warn_about, warned};
use crate::motion_format::names;
use crate::output;
use crate::screen::say;
use clap::Args;
use condyle::formats::{Content, ContentKind, Format, Id};
use condyle::upkeep::{Axes, Done, Plan};
use condyle::{LengthUnit, Recording, Table, encode, open};
use std::path::{Path, PathBuf};

/// What can be written.
const WRITTEN: [ContentKind; 2] = [ContentKind::Motion, ContentKind::Recording];

/// Filter, fill, resample, cut or turn a recording or a motion.
///
/// Whatever is asked for is done in the order of these flags, and written into the header of OUT.
#[derive(Debug, Args)]
pub(crate) struct Upkeep {
    /// A marker recording, or a motion or another table over time.
    input: PathBuf,
    /// Where to write; `-` is standard output and needs --to.
    output: PathBuf,
    /// What the new axes of a marker recording are in the old ones: `x,z,-y` makes y of a former z.
    #[arg(long, value_name = "X,Y,Z", allow_hyphen_values = true)]
    axes: Option<Axes>,
    /// Fill gaps between two measured values at most so many seconds apart, on a cubic spline.
    #[arg(long, value_name = "SECONDS")]
    fill: Option<f64>,
    /// Low-pass at this frequency: Butterworth of order 2, forth and back, half power at HZ after both.
    #[arg(long, value_name = "HZ")]
    lowpass: Option<f64>,
    /// So many rows a second, on a cubic spline.
    #[arg(long, value_name = "HZ")]
    resample: Option<f64>,
    /// Only the times from A to B in seconds; either may be left out.
    #[arg(long, value_name = "A:B", value_parser = interval, allow_hyphen_values = true)]
    crop: Option<(f64, f64)>,
    /// Rates of change per second instead of values; writes a table.
    #[arg(long)]
    differentiate: bool,
    /// What markers at exactly 0 0 0 are; without it the rest of the recording tells.
    #[arg(long, value_enum)]
    zeros: Option<ZerosArgument>,
    /// The format of the output; by default that of its ending.
    #[arg(long, value_parser = names(&WRITTEN))]
    to: Option<String>,
}

/// `A:B`, `A:` or `:B`.
fn interval(text: &str) -> Result<(f64, f64), String> {
    let (from, to) = text.split_once(':').ok_or("two times with a colon between: 0.5:2")?;
    let time = |text: &str, open: f64| match text.trim() {
        "" => Ok(open),
        text => text.parse().map_err(|_| format!("`{text}` is no time in seconds")),
    };
    Ok((time(from, f64::NEG_INFINITY)?, time(to, f64::INFINITY)?))
}

impl Upkeep {
    pub(crate) fn run(self) -> Result<Outcome, Failure> {
        let plan = Plan {
            axes: self.axes,
            fill: self.fill,
            low_pass: self.lowpass,
            resample: self.resample,
            crop: self.crop,
            differentiate: self.differentiate,
        };
        if plan == Plan::default() {
            return Err(Failure::new(
                "nothing is asked for: --axes, --fill, --lowpass, --resample, --crop or --differentiate",
            ));
        }
        let target = self.target()?;
        output::check_distinct(&[&self.input], &[&self.output])?;
        let content =
            warned(&self.input, open::content_with(&self.input, None, zeros(self.zeros))?);
        let bytes = match content {
            Content::Table(table) => self.table(table, plan, target)?,
            Content::Recording(recording) if plan.differentiate => {
                self.speeds(recording, plan, target)?
            }
            Content::Trial(trial) if plan.differentiate => {
                self.speeds(trial.recording, plan, target)?
            }
            Content::Trial(mut trial) if target.id == Id::C3d => {
                self.done(trial.keep_up(&plan))?;
                encode::trial(target, &trial, "")?
            }
            Content::Trial(trial) => {
                if trial.others.len() + trial.analog.channels.len() > 0 {
                    say("note: only the markers are written, not what else the C3D file holds");
                }
                let units = LengthUnit::Millimetre;
                self.recording(Recording { units, ..trial.recording }, plan, target)?
            }
            Content::Recording(recording) => self.recording(recording, plan, target)?,
            other => {
                return Err(Failure::new(format!(
                    "{}: the file holds {}; upkeep takes marker recordings, motions and tables (`condyle convert` \
                     makes a .mot of the others)",
                    self.input.display(),
                    other.kind().name()
                )));
            }
        };
        output::write(&self.output, &bytes)?;
        Ok(Outcome::Done)
    }

    fn table(&self, mut table: Table, plan: Plan, target: &Format) -> Result<Vec<u8>, Failure> {
        let done = self.done(plan.table(&mut table))?;
        table.header.extend(remarks(&done));
        Ok(encode::table(target, &table)?)
    }

    /// Speeds of markers are a table; all else is done to the markers first.
    fn speeds(
        &self,
        mut recording: Recording,
        plan: Plan,
        target: &Format,
    ) -> Result<Vec<u8>, Failure> {
        let positions = Plan { differentiate: false, ..plan };
        let done = self.done(positions.recording(&mut recording))?;
        let mut table = recording.to_table();
        table.header = vec![("Units".into(), "m/s".into())];
        table.header.extend(remarks(&done));
        let speeds = Plan { differentiate: true, ..Plan::default() };
        self.table(table, speeds, target)
    }

    fn recording(
        &self,
        mut recording: Recording,
        plan: Plan,
        target: &Format,
    ) -> Result<Vec<u8>, Failure> {
        let done = self.done(plan.recording(&mut recording))?;
        let name = self.output.file_name().unwrap_or_default().to_string_lossy();
        Ok(encode::recording_with_remarks(target, &recording, &name, &done.steps)?)
    }

    /// Says what was done.
    fn done(&self, done: Result<Done, condyle::Error>) -> Result<Done, Failure> {
        let done =
            done.map_err(|error| Failure::new(format!("{}: {error}", self.input.display())))?;
        warn_about(&self.input, &done.warnings);
        for step in &done.steps {
            say(&format!("note: {step}"));
        }
        Ok(done)
    }

    fn target(&self) -> Result<&'static Format, Failure> {
        if self.to.is_none() && self.output == Path::new("-") {
            return Err(Failure::new("standard output has no ending: name the format with --to"));
        }
        let ending = self.to.clone().unwrap_or_else(|| open::ending(&self.output));
        let found = Format::of_ending(&ending);
        found.filter(|f| f.writes.iter().any(|kind| WRITTEN.contains(kind))).ok_or_else(|| {
            let known = WRITTEN.map(Format::endings_that_write).join(", ");
            Failure::new(format!(
                "{}: the ending names no format for a recording or a motion (known are {known})",
                self.output.display()
            ))
        })
    }
}

/// Lines of a header.
fn remarks(done: &Done) -> Vec<(String, String)> {
    done.steps.iter().map(|step| ("upkeep".to_owned(), step.clone())).collect()
}
