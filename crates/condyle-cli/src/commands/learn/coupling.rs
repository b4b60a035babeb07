//! `condyle learn coupling`: how coordinates follow others.

mod report;

use crate::commands::{Angles, Limits, Outcome, ZerosArgument, zeros};
use crate::failure::{Failure, warn_about, warned};
use crate::output;
use crate::progress::frames_bar;
use clap::Args;
use condyle::formats::document::{self, law, law::LawDocument};
use condyle::formats::{Format, Id};
use condyle::learn::coupling::{About, Basis, LawFunction, Settings, learn, split};
use condyle::learning::{Coupled, GroupTable, gather, group_table};
use condyle::tracking::Request;
use condyle::transferring::{coupled_text, onto_named};
use condyle::{Model, encode, open};
use std::path::{Path, PathBuf};
use std::time::Instant;

/// Learn from recordings how coordinates follow others: how the centre of a joint travels with its angles.
///
/// Trials with markers need --model and --joint: each is tracked with the model, whose joint must be free there. Motions
/// (.mot, .sto, .csv) whose columns are the coordinates need nothing.
#[derive(Debug, Args)]
pub(super) struct Coupling {
    /// Trials: markers, or motions whose columns are the coordinates. Who moves, and how, is read from the names of files:
    /// `s1_crouch_30_2.trc` is subject s1, motion crouch, variety crouch_30.
    #[arg(required = true, value_name = "TRIAL")]
    trials: Vec<PathBuf>,
    /// The model that markers are tracked with, or whose coordinates motions hold.
    #[arg(long, value_name = "M")]
    model: Option<PathBuf>,
    /// The joint whose coordinates are meant, or the segment that it moves.
    #[arg(long, value_name = "J", requires = "model")]
    joint: Option<String>,
    /// Coordinates in control, of any joint. Without --control and --follow a split is proposed.
    #[arg(long, value_name = "C1,C2", value_delimiter = ',')]
    control: Vec<String>,
    /// Coordinates that follow.
    #[arg(long, value_name = "D1,D2", value_delimiter = ',')]
    follow: Vec<String>,
    /// Terms of the laws: linear, polynomial:2 to polynomial:6, or spline:3 to spline:20.
    #[arg(long, value_name = "BASIS", default_value = "linear", value_parser = basis)]
    basis: Basis,
    /// Shrink coefficients: a term that is perpendicular to the others is multiplied by 1/(1 + R).
    #[arg(long, value_name = "R", default_value = "0", value_parser = ridge)]
    ridge: f64,
    /// Who moves in which trial, and how: a CSV with the columns file, subject, motion and, where there are
    /// varieties, sub_motion.
    #[arg(long, value_name = "GROUPS.csv")]
    groups: Option<PathBuf>,
    /// What the recordings' labels are called in the model: a document of `kind = "names"`, or a shipped table.
    #[arg(long, value_name = "TABLE")]
    names: Option<PathBuf>,
    /// Whose markers are meant, where the labels of several people begin with their names: `Anna:RFHD`.
    #[arg(long, value_name = "NAME")]
    subject: Option<String>,
    /// What a marker at exactly 0 0 0 is; without it, it is missing where it is elsewhere in other frames.
    #[arg(long, value_enum)]
    zeros: Option<ZerosArgument>,
    /// The unit of angles in motions that do not state it; without it, it is guessed by their size.
    #[arg(long, value_enum)]
    angles: Option<Angles>,
    /// Hold coordinates to their enforced ranges while markers are tracked; on without it.
    #[arg(long, value_enum)]
    limits: Option<Limits>,
    /// Number of solver threads; all cores by default.
    #[arg(long, value_parser = clap::value_parser!(u16).range(1..=1024))]
    threads: Option<u16>,
    /// The laws, a document of `kind = "law"`; `-` is standard output.
    #[arg(short, long, value_name = "C.toml")]
    output: PathBuf,
    /// All numbers about the laws, in JSON.
    #[arg(long, value_name = "R.json")]
    report: Option<PathBuf>,
    /// The model in which the coordinates that follow do so by the laws (.toml, .osim). An `.osim` comes back with muscles, shapes and
    /// masses; of laws of splines with segments, joints and markers alone.
    #[arg(long, value_name = "MODEL", requires = "model")]
    apply: Option<PathBuf>,
}

pub(super) fn basis(text: &str) -> Result<Basis, String> {
    let help = "give linear, polynomial:2 to polynomial:6, or spline:3 to spline:20";
    Basis::named(text).ok_or_else(|| help.to_owned())
}

pub(super) fn ridge(text: &str) -> Result<f64, String> {
    let ridge = text.parse().ok().filter(|r: &f64| r.is_finite() && *r >= 0.0);
    ridge.ok_or_else(|| "give a number of 0 or more".to_owned())
}

/// Whether a law is a sum of splines: such a one needs helper coordinates in an `.osim`, so that the file is written anew.
fn is_of_splines(law: &LawFunction) -> bool {
    matches!(law, LawFunction::Sum { .. })
}

impl Coupling {
    pub(super) fn run(self) -> Result<Outcome, Failure> {
        let to_screen = self.output == Path::new("-");
        if !to_screen && open::ending(&self.output) != "toml" {
            let path = self.output.display();
            let message = format!("{path}: laws are written as a document: end it in .toml");
            return Err(Failure::new(message));
        }
        let report_to_screen = self.report.as_deref() == Some(Path::new("-"));
        if to_screen && report_to_screen {
            let message = "-o - and --report - both want standard output: give one of them";
            return Err(Failure::new(message));
        }
        let target = self.target()?;
        let files = self.model.iter().chain(&self.groups).chain(&self.names);
        let inputs: Vec<&Path> = self.trials.iter().chain(files).map(PathBuf::as_path).collect();
        let outputs: Vec<&Path> = std::iter::once(&self.output)
            .chain(&self.report)
            .chain(&self.apply)
            .map(PathBuf::as_path)
            .collect();
        output::check_distinct(&inputs, &outputs)?;
        let wanted = self.wanted()?;
        output::check_unread(outputs.iter().copied())?;
        let paths: Vec<&Path> = self.trials.iter().map(PathBuf::as_path).collect();
        let started = Instant::now();
        let bar = frames_bar("learn");
        let read = gather(&paths, &wanted, &mut |trial, done, all| {
            bar.set_length((all * paths.len()) as u64);
            bar.set_position((all * trial + done) as u64);
        });
        bar.finish_and_clear();
        let gathered = warned(&self.trials[0], read?);
        let gathering = started.elapsed().as_secs_f64();
        let samples = &gathered.samples;
        let place = |name: &String| match &wanted.model {
            Some(model) => {
                let key = model.coordinate_key(model.find_coordinate(name)?);
                Ok::<_, Failure>(samples.find(&key).unwrap_or(0))
            }
            None => Ok(samples.find(name).unwrap_or(0)),
        };
        let control: Vec<usize> = self.control.iter().map(place).collect::<Result<_, _>>()?;
        let follow: Vec<usize> = self.follow.iter().map(place).collect::<Result<_, _>>()?;
        let divided = split(samples, &gathered.kinds, &control, &follow);
        let settings = Settings { basis: self.basis, ridge: self.ridge };
        let learned = learn(samples, &gathered.kinds, &divided.control, &divided.follow, &settings);
        let mut laws = learned?;
        laws.about = self.about(&wanted, to_screen);
        warn_about(&self.trials[0], &laws.warnings());
        if let (Some(path), Some(model)) = (&self.apply, &wanted.model) {
            let document: LawDocument = (&laws).into();
            let bytes = match (self.text_of(path)?, target) {
                // An `.osim` comes back as its own text, muscles and masses included.
                (Some(text), _) if laws.laws.iter().all(|law| !is_of_splines(&law.function)) => {
                    coupled_text(&text, &document)?.into_bytes()
                }
                (_, Some(format)) if format.id != Id::Document => {
                    let coupled = onto_named(model, &document)?;
                    warned(path, encode::model(format, &coupled)?)
                }
                _ => document::write(&onto_named(model, &document)?).into_bytes(),
            };
            output::write(path, &bytes)?;
        }
        output::write(&self.output, law::write(&(&laws).into()).as_bytes())?;
        if let Some(path) = &self.report {
            let seconds = [gathering, started.elapsed().as_secs_f64() - gathering];
            let report = report::json(&laws, &divided, &gathered, seconds);
            output::write(path, format!("{report:#}\n").as_bytes())?;
        }
        if !to_screen && !report_to_screen {
            output::print(report::text(&laws, &divided, &gathered).as_bytes())?;
        }
        Ok(Outcome::Done)
    }

    /// The text of the model, where it is an `.osim` and is written as one.
    fn text_of(&self, path: &Path) -> Result<Option<String>, Failure> {
        let Some(model) = &self.model else { return Ok(None) };
        if open::ending(path) != "osim" || open::ending(model) != "osim" {
            return Ok(None);
        }
        Ok(Some(warned(model, open::osim_text(model)?)))
    }

    /// The format of the model that is written, where one is.
    fn target(&self) -> Result<Option<&'static Format>, Failure> {
        let Some(path) = &self.apply else { return Ok(None) };
        let ending = open::ending(path);
        let format = Format::of_ending(&ending)
            .filter(|f| f.writes.contains(&condyle::formats::ContentKind::Model));
        match format {
            Some(format) => Ok(Some(format)),
            None => {
                let path = path.display();
                Err(Failure::new(format!("{path}: models are not written as .{ending}")))
            }
        }
    }

    fn wanted(&self) -> Result<Coupled, Failure> {
        let model: Option<Model> = match &self.model {
            Some(path) => Some(warned(path, open::model(path)?)),
            None => None,
        };
        let groups = match &self.groups {
            Some(path) => {
                let text = std::fs::read_to_string(path)
                    .map_err(|error| Failure::new(format!("{}: {error}", path.display())))?;
                group_table(&text)
                    .map_err(|error| Failure::new(format!("{}: {error}", path.display())))?
            }
            None => GroupTable::default(),
        };
        let mut request = Request {
            subject: self.subject.clone(),
            threads: self.threads.map(usize::from),
            ..Request::default()
        };
        if let Some(path) = &self.names {
            request.names = warned(path, open::names(path)?);
        }
        if let Some(limits) = self.limits {
            request.limits = limits == Limits::On;
        }
        Ok(Coupled {
            model,
            joint: self.joint.clone(),
            control: self.control.clone(),
            follow: self.follow.clone(),
            groups,
            request,
            zeros: zeros(self.zeros),
            angles: self.angles.map(Into::into),
        })
    }

    fn about(&self, wanted: &Coupled, to_screen: bool) -> About {
        let name = self.output.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        let frames = match (&wanted.model, &wanted.joint) {
            (Some(model), Some(joint)) => format!("model {}, joint {joint}", model.name()),
            (Some(model), None) => format!("model {}", model.name()),
            _ => String::new(),
        };
        let trials = self.trials.len();
        About {
            name: if to_screen { String::new() } else { name },
            source: format!("learned from {trials} trial{}", if trials == 1 { "" } else { "s" }),
            frames,
        }
    }
}
