//! `condyle fk`: world transforms.

use super::{Angles, Limits, Outcome};
use crate::failure::{Failure, warned};
use crate::output::{self, Output};
use crate::screen::say;
use clap::Args;
use condyle::formats::poses::Resolved;
use condyle::{Animation, Mode, Model, Motion, Pose, Program, SegmentId, legal, open};
use serde_json::json;
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

#[derive(Debug, Args)]
pub(crate) struct Fk {
    /// The model: a file, or the name of a shipped one.
    model: PathBuf,
    /// A JSON file with `{"coordinate": number}` in radians and metres, or a list of such poses.
    #[arg(long, value_name = "P.json", conflicts_with = "motion")]
    pose: Option<PathBuf>,
    /// A motion whose columns are named after coordinates; by default the one that the model's file holds.
    #[arg(long, value_name = "M")]
    motion: Option<PathBuf>,
    /// The unit of angles in a motion that does not state it; without it, it is guessed by their size.
    #[arg(long, value_enum)]
    angles: Option<Angles>,
    /// First move coordinates into their ranges.
    #[arg(long, value_enum, default_value_t = Limits::Off)]
    limits: Limits,
    /// One JSON document on standard output (the default, and the only form).
    #[arg(long)]
    json: bool,
    /// Where to write the result; `-` is standard output.
    #[arg(short, long, default_value = "-")]
    output: PathBuf,
}

/// A value for a coupled coordinate that differs from what its leaders make by more than this is
/// worth a warning.
const COUPLING_TOLERANCE: f64 = 1e-9;

impl Fk {
    pub(crate) fn run(self) -> Result<Outcome, Failure> {
        let inputs = [Some(&self.model), self.pose.as_ref(), self.motion.as_ref()];
        let inputs: Vec<&Path> = inputs.into_iter().flatten().map(PathBuf::as_path).collect();
        output::check_distinct(&inputs, &[&self.output])?;
        let Animation { model, motion } = warned(&self.model, open::animation(&self.model)?);
        let long = match &self.motion {
            // Never the whole of it in memory.
            Some(path) if self.angles.is_none() => {
                open::motion_parts(path, &model)?.map(|parts| warned(path, parts))
            }
            _ => None,
        };
        let frames = match long {
            Some(parts) => {
                let mut frames = Frames::create(&model, &self)?;
                for part in parts {
                    let motion = part?;
                    frames.add(&Resolved { motion, named: vec![] })?;
                    if frames.output.get_ref().is_closed() {
                        break;
                    }
                }
                frames
            }
            None => {
                let requests = self.requests(&model, motion)?;
                let mut frames = Frames::create(&model, &self)?;
                frames.add(&requests)?;
                frames
            }
        };
        frames.end()?;
        Ok(Outcome::Done)
    }

    fn requests(&self, model: &Model, own: Motion) -> Result<Resolved, Failure> {
        if let Some(path) = &self.motion {
            let motion = warned(path, open::motion_with(path, model, self.angles.map(Into::into))?);
            return Ok(Resolved { motion, named: vec![] });
        }
        let Some(path) = &self.pose else {
            if !own.frames.is_empty() {
                return Ok(Resolved { motion: own, named: vec![] });
            }
            let motion = Motion { times: vec![0.0], frames: vec![model.defaults()] };
            return Ok(Resolved { motion, named: vec![vec![false; model.coordinates().len()]] });
        };
        Ok(warned(path, open::poses(path, model)?))
    }
}

/// The answer, written frame by frame.
struct Frames<'a> {
    model: &'a Model,
    path: &'a Path,
    limits: Limits,
    program: Program,
    pose: Pose,
    /// The segments and their names in JSON, in the order of their names.
    segments: Vec<(SegmentId, String)>,
    output: BufWriter<Output>,
    count: usize,
    /// How many frames were moved to the nearest legal pose.
    solved: usize,
    /// For each coordinate in how many frames its value was ignored.
    ignored: Vec<usize>,
}

impl<'a> Frames<'a> {
    fn create(model: &'a Model, asked: &'a Fk) -> Result<Self, Failure> {
        // Where limits are off, none that only gives a row has to be made.
        let program = match asked.limits {
            Limits::On => Program::compile(model),
            Limits::Off => Program::compile_unmeasured(model),
        };
        let pose = Pose::new(&program);
        let mut segments: Vec<(SegmentId, String)> =
            model.segment_ids().map(|id| (id, model.segment(id).name.clone())).collect();
        segments.sort_by(|a, b| a.1.cmp(&b.1));
        segments.iter_mut().for_each(|(_, name)| *name = json!(name).to_string());
        let mut frames = Self {
            model,
            path: &asked.output,
            limits: asked.limits,
            program,
            pose,
            segments,
            output: BufWriter::with_capacity(1 << 16, Output::create(&asked.output)?),
            count: 0,
            solved: 0,
            ignored: vec![0; model.coordinates().len()],
        };
        frames.write(|output| write!(output, "{{\"frames\":["))?;
        Ok(frames)
    }

    fn write(
        &mut self,
        write: impl FnOnce(&mut BufWriter<Output>) -> io::Result<()>,
    ) -> Result<(), Failure> {
        write(&mut self.output).map_err(|error| output::not_written(self.path, error))
    }

    fn add(&mut self, requests: &Resolved) -> Result<(), Failure> {
        let motion = &requests.motion;
        for (index, (&time, stored)) in motion.times.iter().zip(&motion.frames).enumerate() {
            let evaluated = match self.limits {
                Limits::On => legal::evaluate(self.model, &self.program, stored, &mut self.pose),
                Limits::Off => {
                    self.program.evaluate(stored, Mode::Open, &mut self.pose).map(|()| false)
                }
            };
            self.solved += usize::from(evaluated.map_err(|e| Failure::new(e.to_string()))?);
            self.compare(stored, requests.named.get(index));
            self.frame(time)?;
        }
        Ok(())
    }

    /// Counts the values that differ from what a coordinate that follows others has.
    fn compare(&mut self, stored: &[f64], named: Option<&Vec<bool>>) {
        for id in self.model.coordinate_ids() {
            if named.is_none_or(|n| n[id.index()]) && self.model.coordinate(id).follows.is_some() {
                let asked = self.model.value(stored, id);
                let got = self.pose.coordinate(self.model, id)[0];
                if (asked - got).abs() > COUPLING_TOLERANCE {
                    self.ignored[id.index()] += 1;
                }
            }
        }
    }

    fn frame(&mut self, time: f64) -> Result<(), Failure> {
        let Self { output, pose, segments, .. } = self;
        let written = (|| {
            output.write_all(if self.count > 0 {
                b",{\"segments\":{"
            } else {
                b"{\"segments\":{"
            })?;
            for (index, (id, name)) in segments.iter().enumerate() {
                output.write_all(if index > 0 { b"," } else { b"" })?;
                output.write_all(name.as_bytes())?;
                output.write_all(b":")?;
                serde_json::to_writer(&mut *output, &pose.segment(*id).to_rows())?;
            }
            output.write_all(b"},\"time\":")?;
            serde_json::to_writer(&mut *output, &time)?;
            output.write_all(b"}")
        })();
        self.count += 1;
        written.map_err(|error| output::not_written(self.path, error))
    }

    /// Says what was changed, and puts the answer in its place.
    fn end(mut self) -> Result<(), Failure> {
        let count = self.count;
        for (id, &ignored) in self.model.coordinate_ids().zip(&self.ignored) {
            if ignored > 0 {
                say(&format!(
                    "warning: `{}` follows other coordinates; the value given for it was ignored in \
                     {ignored} of {count} frames",
                    self.model.coordinate_key(id),
                ));
            }
        }
        if self.solved > 0 {
            say(&format!(
                "note: {} of {count} frames broke limits between segments: theirs is the nearest legal \
                 pose",
                self.solved
            ));
        }
        self.write(|output| output.write_all(b"]}\n"))?;
        match self.output.into_inner() {
            Ok(output) => output.finish(),
            Err(error) => Err(output::not_written(self.path, error.into_error())),
        }
    }
}
