//! `condyle convert`: a file in another format.

mod dropped;
mod includes;
mod onto;

use super::{Angles, Limits, Outcome};
use crate::failure::{Failure, warn_about, warned};
use crate::motion_format as format;
use crate::output;
use crate::screen::say;
use clap::{Args, ValueEnum};
use condyle::formats::bvh;
use condyle::formats::c3d::Trial;
use condyle::formats::document::{self, Document};
use condyle::formats::exchange;
use condyle::formats::poses::Poses;
use condyle::formats::{Content, ContentKind, Format, Id, LengthUnit, Recording};
use condyle::open::{Cause, OpenError};
use condyle::{
    AngleUnit, Animation, Error, Interpolation, Mode, Model, Motion, Program, Table, encode, legal,
    open, scene, shipped,
};
use std::path::{Path, PathBuf};

#[derive(Debug, Args)]
pub(crate) struct Convert {
    /// A motion (.mot, .sto, .csv), poses (.json, as `fk` takes them), a model (.osim, .toml, a
    /// resolved one in .json, or the name of a shipped one), a skeleton with its motion (.bvh, .amc, .glb, .gltf, .fbx, .npz) or a
    /// marker recording (.trc, .c3d).
    input: PathBuf,
    /// Where to write; `-` is standard output and needs --to.
    output: PathBuf,
    /// The model that a motion belongs to: a file, or the name of a shipped one.
    ///
    /// Of SMPL poses (.npz) it is the body: where their joints are.
    /// With it a motion can be baked to .glb and .bvh: plain bones, each with its translation, rotation and
    /// (in .glb) scale in its parent at every frame, for programs without joint sets.
    #[arg(long, value_name = "M")]
    model: Option<PathBuf>,
    /// The unit of angles in a motion that does not state it; without it, it is guessed by their size.
    #[arg(long, value_enum)]
    angles: Option<Angles>,
    /// Poses (.json) with a `time` each become a motion at so many frames a second.
    #[arg(long, value_name = "N", requires = "model")]
    rate: Option<f64>,
    /// How coordinates go from one such pose to the next; orientations always turn the shorter way.
    #[arg(long, value_enum, default_value_t = Curve::Spline, requires = "rate")]
    between: Curve,
    /// First move coordinates to the nearest posture that the model allows.
    #[arg(long, value_enum, default_value_t = Limits::Off)]
    limits: Limits,
    /// Of a C3D only the markers, not its angles, forces, moments and powers.
    #[arg(long)]
    markers_only: bool,
    /// Of a C3D the analog channels in their own units, as a table (.csv, .mot, .sto).
    #[arg(long, conflicts_with = "markers_only")]
    analog: bool,
    /// The format of the output; by default that of its ending.
    #[arg(long, value_parser = format::names(&WRITTEN))]
    to: Option<String>,
    #[command(flatten)]
    onto: onto::Onto,
}

/// How coordinates of one number go from key pose to key pose.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Curve {
    /// On straight lines.
    Linear,
    /// On a smooth curve that stays between the values of neighbouring poses.
    Spline,
}

/// Whether a format holds what moves.
fn moves(format: &Format) -> bool {
    !matches!(format.id, Id::Document | Id::Poses) && !of_models(format)
}

/// Whether a format of other programs holds models as trees of plain joints.
fn of_models(format: &Format) -> bool {
    matches!(format.id, Id::OpenSim | Id::Urdf | Id::Mjcf)
}

/// What can be written.
const WRITTEN: [ContentKind; 4] =
    [ContentKind::Motion, ContentKind::Scene, ContentKind::Recording, ContentKind::Model];

/// The supported conversions, for the message about any other.
const KNOWN: &str = "known are: a motion (.mot, .sto, .csv) to .mot, .sto or .csv; with --model also \
                     to .glb, .bvh or .usda (an animation), to .amc where the model is an .asf, .trc or .c3d (the model's markers), and poses (.json) to all \
                     of these, with --rate as key poses; a skeleton with its motion (.bvh, .amc, .glb, .gltf, .fbx, .npz) to all of these \
                     without --model, and as a model; all of these motions for another figure with --onto; a model (.osim, .urdf, .toml, .json, .asf, or a shipped one by name) to .toml, .json (resolved), .glb, .bvh, .osim, .urdf, .mjcf or .usda; \
                     a recording (.trc, .c3d) to .trc, .c3d or .csv, with --analog its channels to .csv, .mot or .sto";

impl Convert {
    pub(crate) fn run(self) -> Result<Outcome, Failure> {
        let target = self.target()?;
        let inputs: Vec<&Path> = [&self.input]
            .into_iter()
            .chain(&self.model)
            .chain(self.onto.inputs())
            .map(PathBuf::as_path)
            .collect();
        output::check_distinct(&inputs, &[&self.output])?;
        if let Some(model) = &self.model {
            open::skeleton_is(model);
            if self.is_of_smpl() {
                open::body_is(model);
            }
        }
        let read = match open::content(&self.input, None) {
            Err(error) if matches!(error.cause, Cause::Format { .. }) => {
                return Err(self.unknown(target, ""));
            }
            read => read?,
        };
        let content = warned(&self.input, read);
        if self.rate.is_some() && !matches!(content, Content::Poses(_)) {
            let what = self.input.display();
            return Err(Failure::new(format!("{what}: --rate is for poses (.json) with times")));
        }
        let bytes = match content {
            Content::Model(model) | Content::Document(Document { model, .. })
                if target.id == Id::Poses =>
            {
                exchange::write(&model).into_bytes()
            }
            Content::Animation(animation) => self.animation(*animation, target)?,
            Content::Poses(poses) if moves(target) => {
                self.motion_as(Moving::Poses(poses), target)?
            }
            Content::Table(table) if moves(target) => {
                self.motion_as(Moving::Table(table), target)?
            }
            Content::Document(document) if target.id == Id::Document => {
                self.document(document)?.into_bytes()
            }
            Content::Limit(limit) if target.id == Id::Document => encode::limit(target, &limit)?,
            Content::Model(model) if target.id == Id::Document => {
                document::write(&model).into_bytes()
            }
            Content::Model(model) | Content::Document(Document { model, .. })
                if target.id == Id::Glb =>
            {
                self.scene(&model, &Motion::default())?
            }
            Content::Model(model) | Content::Document(Document { model, .. })
                if of_models(target) =>
            {
                warned(&self.output, encode::model(target, &model)?)
            }
            Content::Model(model) | Content::Document(Document { model, .. })
                if matches!(target.id, Id::Bvh | Id::Usda) =>
            {
                self.skeleton(target, &model, &Motion::default())?
            }
            Content::Recording(recording) if target.writes.contains(&ContentKind::Recording) => {
                let name = self.output.file_name().unwrap_or_default().to_string_lossy();
                encode::recording(target, &recording, &name)?
            }
            Content::Trial(trial)
                if self.analog && target.writes.contains(&ContentKind::Motion) =>
            {
                self.channels(&trial, target)?
            }
            Content::Trial(trial)
                if !self.analog && target.writes.contains(&ContentKind::Recording) =>
            {
                self.trial(*trial, target)?
            }
            Content::Recording(_) | Content::Trial(_) => {
                return Err(self.unknown(
                    target,
                    "; `condyle track MODEL TRIAL -o OUT` computes motions from recordings",
                ));
            }
            _ => return Err(self.unknown(target, "")),
        };
        output::write(&self.output, &bytes)?;
        Ok(Outcome::Done)
    }

    /// By `--to`, else by the ending of the output.
    fn target(&self) -> Result<&'static Format, Failure> {
        if self.to.is_none() && self.output == Path::new("-") {
            return Err(Failure::new("standard output has no ending: name the format with --to"));
        }
        let ending = self.to.clone().unwrap_or_else(|| open::ending(&self.output));
        Format::of_ending(&ending).filter(|format| !format.writes.is_empty()).ok_or_else(|| {
            Failure::new(format!(
                "{}: the ending names no format that can be written ({KNOWN})",
                self.output.display()
            ))
        })
    }

    fn unknown(&self, target: &Format, hint: &str) -> Failure {
        let model = if self.model.is_some() { " with --model" } else { "" };
        Failure::new(format!(
            "{}: cannot be converted to .{}{model}{hint} ({KNOWN})",
            self.input.display(),
            target.name,
        ))
    }

    /// The input's name without its ending: the title of what is written.
    fn name(&self) -> String {
        self.input.file_stem().unwrap_or_default().to_string_lossy().into_owned()
    }

    /// Whether the input is a file of poses whose model is their body.
    fn is_of_smpl(&self) -> bool {
        Format::of_ending(&open::ending(&self.input)).is_some_and(|f| f.id == Id::Smpl)
    }

    fn mode(&self) -> Mode {
        if self.limits == Limits::On { Mode::Posed } else { Mode::Open }
    }

    /// A document as it was written; a shipped one so that it can be read without other files.
    fn document(&self, document: Document) -> Result<String, Failure> {
        match shipped::asked_for(&self.input) {
            Some(name) => Ok(shipped::standalone(name)?),
            None => Ok(includes::moved(&document.text, &self.input, &self.output)),
        }
    }

    /// A trial, with what the target cannot hold named.
    fn trial(&self, trial: Trial, target: &Format) -> Result<Vec<u8>, Failure> {
        let name = self.output.file_name().unwrap_or_default().to_string_lossy();
        if self.markers_only {
            let units = LengthUnit::Millimetre;
            let recording = Recording { units, ..trial.recording };
            return Ok(encode::recording(target, &recording, &name)?);
        }
        if target.id != Id::C3d {
            dropped::tell(&trial, target);
        }
        Ok(encode::trial(target, &trial, &name)?)
    }

    /// The analog channels of a trial over time.
    fn channels(&self, trial: &Trial, target: &Format) -> Result<Vec<u8>, Failure> {
        if trial.analog.channels.is_empty() {
            let what = self.input.display();
            return Err(Failure::new(format!("{what}: there are no analog channels")));
        }
        let start = trial.recording.times.first().copied().unwrap_or(0.0);
        let mut table = trial.analog.to_table(start);
        table.name = self.name();
        Ok(encode::table(target, &table)?)
    }

    fn scene(&self, model: &Model, motion: &Motion) -> Result<Vec<u8>, Failure> {
        Ok(warned(&self.output, encode::scene(model, motion, self.mode(), None)?))
    }

    /// A skeleton in the unit that is told, else in centimetres.
    fn skeleton(
        &self,
        target: &Format,
        model: &Model,
        motion: &Motion,
    ) -> Result<Vec<u8>, Failure> {
        let unit = open::assumed().metres_per_unit;
        if unit.is_none() && target.id == Id::Bvh {
            say(&format!("note: {}: lengths are in cm (--length-unit)", self.output.display()));
        }
        let unit = unit.unwrap_or(bvh::USUAL_UNIT);
        Ok(warned(&self.output, encode::skeleton(target, model, motion, self.mode(), unit)?))
    }

    fn motion_as(&self, moving: Moving, target: &Format) -> Result<Vec<u8>, Failure> {
        let Some(model_path) = &self.model else {
            let what = format!("{}: without --model", self.input.display());
            let from = match moving {
                Moving::Poses(_) => "poses",
                Moving::Table(_) => "a motion",
            };
            let writes = target.writes.contains(&ContentKind::Motion);
            let (Moving::Table(table), true) = (moving, writes) else {
                let to = target.name;
                return Err(Failure::new(format!(
                    "{what} {from} cannot be converted to .{to} ({KNOWN})"
                )));
            };
            if self.limits == Limits::On {
                return Err(Failure::new(format!("{what} there are no limits to apply")));
            }
            return rewritten(&self.input, table, self.angles, target);
        };
        let model = warned(model_path, open::model(model_path)?);
        let motion = match moving {
            Moving::Poses(poses) => self.poses(&poses, &model)?,
            Moving::Table(mut table) => {
                let settled = open::settled(&model, &mut table, self.angles.map(Into::into));
                warn_about(&self.input, &settled.map_err(|error| self.wrong(error))?);
                let (motion, warnings) = Motion::from_table(&model, &table);
                warn_about(&self.input, &warnings);
                motion
            }
        };
        self.moved(&model, motion, target)
    }

    /// A skeleton with its motion: that of another model where one is told, else its own, or the skeleton
    /// alone.
    fn animation(&self, animation: Animation, target: &Format) -> Result<Vec<u8>, Failure> {
        let Animation { model, motion } = animation;
        match target.id {
            Id::Document => Ok(document::write(&model).into_bytes()),
            Id::Poses => Ok(exchange::write(&model).into_bytes()),
            _ if of_models(target) => Ok(warned(&self.output, encode::model(target, &model)?)),
            _ if !moves(target) => Err(self.unknown(target, "")),
            // Their model tells where joints are; the motion is that of their own tree.
            _ if self.model.is_some() && !self.is_of_smpl() => {
                self.motion_as(Moving::Table(motion.to_table(&model, &self.name())), target)
            }
            _ => self.moved(&model, motion, target),
        }
    }

    /// A motion of a model, or what it is for another figure, in another format, legal if asked for.
    fn moved(
        &self,
        model: &Model,
        mut motion: Motion,
        target: &Format,
    ) -> Result<Vec<u8>, Failure> {
        if let Some((onto, carried)) =
            self.onto.carried(&self.input, model, &motion, self.limits)?
        {
            if let Some(path) = self.onto.onto.as_ref().filter(|path| open::is_gltf(path))
                && target.id == Id::Glb
            {
                let driven = scene::driven(model, &motion, self.mode());
                let file = open::reanimated(path, &carried, driven, &self.name())?;
                return Ok(warned(path, file));
            }
            let path = self.onto.onto.as_ref().unwrap_or(&self.input);
            return self.written(path, &onto, carried, target);
        }
        if self.limits == Limits::On {
            let legal::Kept { solved, lost } = legal::keep(model, &mut motion);
            let all = motion.frames.len();
            if solved > 0 {
                say(&format!(
                    "note: {solved} of {all} frames broke limits between segments: theirs is the nearest \
                     legal pose"
                ));
            }
            if lost > 0 {
                say(&format!(
                    "warning: {lost} of {all} frames are not given by their coordinates alone: a limit acts on \
                     what several of them make together, or something reads what is asked beside it"
                ));
            }
        }
        self.written(self.model.as_ref().unwrap_or(&self.input), model, motion, target)
    }

    /// A motion of a model, which is that of a file, in another format.
    fn written(
        &self,
        of: &Path,
        model: &Model,
        mut motion: Motion,
        target: &Format,
    ) -> Result<Vec<u8>, Failure> {
        match target.id {
            Id::Glb => return self.scene(model, &motion),
            Id::Bvh | Id::Usda => return self.skeleton(target, model, &motion),
            Id::Trc | Id::C3d => return self.virtual_markers(model, &motion, target),
            Id::Amc => {
                motion.make_effective(&Program::compile(model), self.mode());
                return Ok(warned(of, open::take_written(of, &motion)?));
            }
            _ => motion.make_effective(&Program::compile(model), self.mode()),
        }
        format::encoded(target, model, &motion, &self.name(), None, &[])
    }

    fn wrong(&self, error: Error) -> Failure {
        let cause = Cause::Content { error, text: None };
        Failure::from(OpenError { path: self.input.clone(), cause })
    }

    /// Poses as frames, or as keys between which a motion goes.
    fn poses(&self, poses: &Poses, model: &Model) -> Result<Motion, Failure> {
        let fail = |error: Error| self.wrong(error);
        warn_about(&self.input, &poses.remarks(model));
        let Some(rate) = self.rate else {
            return Ok(poses.resolve(model).map_err(fail)?.motion);
        };
        let keys = poses.keys(model).map_err(fail)?;
        let between = match self.between {
            Curve::Linear => Interpolation::Linear,
            Curve::Spline => Interpolation::Spline,
        };
        let sampled = keys.sample(model, rate, between);
        sampled.map_err(|error| Failure::new(format!("{}: {error}", self.input.display())))
    }

    /// The model's markers along a motion, as a recording in millimetres.
    fn virtual_markers(
        &self,
        model: &Model,
        motion: &Motion,
        target: &Format,
    ) -> Result<Vec<u8>, Failure> {
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
        Ok(encode::recording(target, &recording, &name)?)
    }
}

/// What a motion is made from.
enum Moving {
    Poses(Poses),
    Table(Table),
}

/// A table in another format, number by number, with the unit of its angles stated as far as it is known.
fn rewritten(
    path: &Path,
    mut table: Table,
    angles: Option<Angles>,
    target: &Format,
) -> Result<Vec<u8>, Failure> {
    match angles {
        Some(angles) => table.angle_unit = angles.into(),
        None if !matches!(table.angle_unit, AngleUnit::Degrees | AngleUnit::Radians) => {
            say(&format!(
                "warning: {}: it is not stated whether angles are in degrees, and is not in what is written \
             (state it with --angles)",
                path.display()
            ))
        }
        None => {}
    }
    Ok(encode::table(target, &table)?)
}
