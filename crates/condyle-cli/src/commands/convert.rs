//! `condyle convert`: a file in another format.

pub(super) mod poses;

use super::Outcome;
use crate::failure::{Failure, warn_about, warned};
use crate::motion_format::MotionFormat;
use crate::output;
use clap::{Args, ValueEnum};
use condyle::formats::{AngleUnit, Table, csv, document, glb, sto, trc};
use condyle::{Mode, Model, Motion, Program, open, scene, shipped};
use std::path::{Path, PathBuf};

#[derive(Debug, Args)]
pub(crate) struct Convert {
    /// A motion (.mot, .sto, .csv), poses (.json, as `fk` takes them), a model (.osim, .toml, or the
    /// name of a shipped one) or a marker recording (.trc).
    input: PathBuf,
    /// Where to write; `-` is standard output and needs --to.
    output: PathBuf,
    /// The model that a motion belongs to: a file, or the name of a shipped one.
    ///
    /// With it a motion can be baked to .glb: plain bones, each with its place, turn and size in its
    /// parent at every frame, for programs that know no joint sets.
    #[arg(long, value_name = "M")]
    model: Option<PathBuf>,
    /// First move coordinates to the nearest posture that the model allows.
    #[arg(long, value_enum, default_value_t = Limits::Off)]
    limits: Limits,
    /// The format of the output, if not by its ending.
    #[arg(long, value_enum)]
    to: Option<Target>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Limits {
    Off,
    On,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Target {
    /// OpenSim's motion file.
    Mot,
    /// OpenSim's storage file.
    Sto,
    /// Comma-separated, in radians and metres where a model says which is which.
    Csv,
    /// A scene.
    Glb,
    /// A marker recording.
    Trc,
    /// A model document.
    Toml,
}

/// The combinations that exist, for the message about one that does not.
const KNOWN: &str = "known are: a motion (.mot, .sto, .csv) to .mot, .sto or .csv; with --model also \
                     to .glb (an animation) or .trc (the model's markers), and poses (.json) to all \
                     of these; a model (.osim, .toml, or a shipped one by name) to .toml or .glb; \
                     a recording (.trc) to .trc or .csv";

impl Target {
    /// By `--to`, else by the ending of the output.
    fn of(path: &Path, to: Option<Self>) -> Result<Self, Failure> {
        if let Some(to) = to {
            return Ok(to);
        }
        if path == Path::new("-") {
            return Err(Failure::new("standard output has no ending: name the format with --to"));
        }
        match open::ending(path).as_str() {
            "mot" => Ok(Self::Mot),
            "sto" => Ok(Self::Sto),
            "csv" => Ok(Self::Csv),
            "glb" => Ok(Self::Glb),
            "trc" => Ok(Self::Trc),
            "toml" => Ok(Self::Toml),
            _ => Err(Failure::new(format!(
                "{}: the ending names no format that can be written ({KNOWN})",
                path.display()
            ))),
        }
    }

    /// The format of a motion, if it is one.
    fn motion(self) -> Option<MotionFormat> {
        match self {
            Self::Mot => Some(MotionFormat::Mot),
            Self::Sto => Some(MotionFormat::Sto),
            Self::Csv => Some(MotionFormat::Csv),
            Self::Glb => Some(MotionFormat::Glb),
            Self::Trc | Self::Toml => None,
        }
    }

    fn name(self) -> &'static str {
        match self {
            Self::Toml => "toml",
            _ => self.motion().map_or("trc", MotionFormat::ending),
        }
    }
}

impl Convert {
    pub(crate) fn run(self) -> Result<Outcome, Failure> {
        let target = Target::of(&self.output, self.to)?;
        let ending = open::ending(&self.input);
        // The name of a shipped model stands for its document.
        let named = shipped::asked_for(&self.input).is_some();
        let bytes = match if named { "toml" } else { ending.as_str() } {
            "mot" | "sto" | "csv" | "json" if target != Target::Toml => self.motion_as(target)?,
            "toml" if target == Target::Toml => self.document()?.into_bytes(),
            "osim" | "xml" if target == Target::Toml => {
                let model = warned(&self.input, open::model(&self.input)?);
                document::write(&model).into_bytes()
            }
            "osim" | "xml" | "toml" if target == Target::Glb => self.still()?,
            "trc" if matches!(target, Target::Trc | Target::Csv) => self.recording_as(target)?,
            "trc" => {
                return Err(self.unknown(
                    target,
                    "; `condyle track MODEL TRIAL -o OUT` makes motions of recordings",
                ));
            }
            _ => return Err(self.unknown(target, "")),
        };
        output::write(&self.output, &bytes)?;
        Ok(Outcome::Done)
    }

    fn unknown(&self, target: Target, hint: &str) -> Failure {
        let model = if self.model.is_some() { " with --model" } else { "" };
        Failure::new(format!(
            "{}: cannot be converted to .{}{model}{hint} ({KNOWN})",
            self.input.display(),
            target.name(),
        ))
    }

    /// The input's name without its ending: the title of what is written.
    fn name(&self) -> String {
        self.input.file_stem().unwrap_or_default().to_string_lossy().into_owned()
    }

    fn mode(&self) -> Mode {
        if self.limits == Limits::On { Mode::Posed } else { Mode::Open }
    }

    /// A document as it was written; a shipped one such that it can be read anywhere.
    fn document(&self) -> Result<String, Failure> {
        if let Some(name) = shipped::asked_for(&self.input) {
            return Ok(shipped::standalone(name)?);
        }
        Ok(warned(&self.input, open::document(&self.input)?).source)
    }

    /// A model at rest as a scene.
    fn still(&self) -> Result<Vec<u8>, Failure> {
        let model = warned(&self.input, open::model(&self.input)?);
        self.scene(&model, &Motion::default())
    }

    /// A motion as a scene of plain bones. Limits are applied here, since not all of them can be said
    /// by coordinates.
    fn scene(&self, model: &Model, motion: &Motion) -> Result<Vec<u8>, Failure> {
        let scene = warned(&self.output, scene::baked(model, motion, self.mode(), None));
        glb::write(&scene).map_err(|error| Failure::new(error.to_string()))
    }

    fn motion_as(&self, target: Target) -> Result<Vec<u8>, Failure> {
        let poses = open::ending(&self.input) == "json";
        let Some(model_path) = &self.model else {
            let what = format!("{}: without --model", self.input.display());
            if poses || matches!(target, Target::Glb | Target::Trc) {
                let from = if poses { "poses" } else { "a motion" };
                let to = target.name();
                return Err(Failure::new(format!("{what} {from} cannot become .{to} ({KNOWN})")));
            }
            if self.limits == Limits::On {
                return Err(Failure::new(format!("{what} there are no limits to apply")));
            }
            let table = warned(&self.input, open::table(&self.input)?);
            return rewritten(&self.input, table, target);
        };
        let model = warned(model_path, open::model(model_path)?);
        let mut motion = if poses {
            poses::read(&self.input, &model)?.motion
        } else {
            let table = warned(&self.input, open::table(&self.input)?);
            let (motion, warnings) = Motion::from_table(&model, &table);
            warn_about(&self.input, &warnings);
            motion
        };
        if target == Target::Glb {
            return self.scene(&model, &motion);
        }
        if target == Target::Trc {
            return self.virtual_markers(&model, &motion);
        }
        motion.make_effective(&Program::compile(&model), self.mode());
        match target.motion() {
            Some(format) => format.encode(&model, &motion, &self.name(), None),
            None => Err(self.unknown(target, "")),
        }
    }

    fn recording_as(&self, target: Target) -> Result<Vec<u8>, Failure> {
        let recording = warned(&self.input, open::recording(&self.input)?);
        if target == Target::Csv {
            return encoded(csv::write(&recording.to_table()));
        }
        let name = self.output.file_name().unwrap_or_default().to_string_lossy();
        encoded(trc::write(&recording, &name))
    }

    /// The model's markers along a motion, as a recording in millimetres.
    fn virtual_markers(&self, model: &Model, motion: &Motion) -> Result<Vec<u8>, Failure> {
        if model.markers().is_empty() {
            return Err(Failure::new(format!(
                "model `{}` has no markers to record: add a marker set",
                model.name()
            )));
        }
        if motion.frames.is_empty() {
            return Err(Failure::new(format!(
                "{}: the motion has no frames to record",
                self.input.display()
            )));
        }
        let recording = motion.virtual_markers(model, self.mode());
        let recording = recording.map_err(|error| Failure::new(error.to_string()))?;
        let name = self.output.file_name().unwrap_or_default().to_string_lossy();
        encoded(trc::write(&recording, &name))
    }
}

fn encoded(text: Result<String, condyle::formats::Error>) -> Result<Vec<u8>, Failure> {
    text.map(String::into_bytes).map_err(|error| Failure::new(error.to_string()))
}

/// A table in another format, number by number, with the unit of its angles said.
fn rewritten(path: &Path, mut table: Table, target: Target) -> Result<Vec<u8>, Failure> {
    if table.angle_unit == AngleUnit::Unstated {
        // A CSV without a word about it is in radians: that is how this program writes them.
        if open::ending(path) != "csv" {
            eprintln!(
                "warning: {}: the header does not say whether angles are in degrees; taken as \
                 radians (add the line inDegrees=yes if they are not)",
                path.display()
            );
        }
        table.angle_unit = AngleUnit::Radians;
    }
    encoded(if target == Target::Csv { csv::write(&table) } else { sto::write(&table) })
}
