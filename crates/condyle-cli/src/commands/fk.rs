//! `condyle fk`: world transforms.

use super::{Limits, Outcome};
use crate::failure::{Failure, warned};
use crate::output;
use crate::screen::say;
use clap::Args;
use condyle::formats::poses::Resolved;
use condyle::{Mode, Model, Motion, Pose, Program, legal, open};
use serde_json::{Map, Value, json};
use std::path::PathBuf;

#[derive(Debug, Args)]
pub(crate) struct Fk {
    /// The model: a file, or the name of a shipped one.
    model: PathBuf,
    /// A JSON file with `{"coordinate": number}` in radians and metres, or a list of such poses.
    #[arg(long, value_name = "P.json", conflicts_with = "motion")]
    pose: Option<PathBuf>,
    /// A motion whose columns are named after coordinates.
    #[arg(long, value_name = "M")]
    motion: Option<PathBuf>,
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
        let model = warned(&self.model, open::model(&self.model)?);
        let requests = self.requests(&model)?;
        let program = Program::compile(&model);
        let mut pose = Pose::new(&program);
        let mut solved = 0;
        let mut ignored = vec![0usize; model.coordinates().len()];
        let mut frames = Vec::with_capacity(requests.motion.frames.len());
        for (index, (time, stored)) in
            requests.motion.times.iter().zip(&requests.motion.frames).enumerate()
        {
            let evaluated = match self.limits {
                Limits::On => legal::evaluate(&model, &program, stored, &mut pose),
                Limits::Off => program.evaluate(stored, Mode::Open, &mut pose).map(|()| false),
            };
            solved += usize::from(evaluated.map_err(|error| Failure::new(error.to_string()))?);
            for id in model.coordinate_ids() {
                let named = requests.named.get(index).is_none_or(|n| n[id.index()]);
                if named && model.coordinate(id).follows.is_some() {
                    let asked = model.value(stored, id);
                    let got = pose.coordinate(&model, id)[0];
                    if (asked - got).abs() > COUPLING_TOLERANCE {
                        ignored[id.index()] += 1;
                    }
                }
            }
            let segments: Map<String, Value> = model
                .segment_ids()
                .map(|id| (model.segment(id).name.clone(), json!(pose.segment(id).to_rows())))
                .collect();
            frames.push(json!({ "time": time, "segments": segments }));
        }
        for (id, count) in model.coordinate_ids().zip(ignored) {
            if count > 0 {
                say(&format!(
                    "warning: `{}` follows other coordinates; the value given for it was ignored in \
                     {count} of {} frames",
                    model.coordinate_key(id),
                    frames.len()
                ));
            }
        }
        if solved > 0 {
            say(&format!(
                "note: {solved} of {} frames broke limits between segments: theirs is the nearest legal \
                 pose",
                frames.len()
            ));
        }
        output::write(&self.output, format!("{}\n", json!({ "frames": frames })).as_bytes())?;
        Ok(Outcome::Done)
    }

    fn requests(&self, model: &Model) -> Result<Resolved, Failure> {
        if let Some(path) = &self.motion {
            let motion = warned(path, open::motion(path, model)?);
            return Ok(Resolved { motion, named: vec![] });
        }
        let Some(path) = &self.pose else {
            let motion = Motion { times: vec![0.0], frames: vec![model.defaults()] };
            return Ok(Resolved { motion, named: vec![vec![false; model.coordinates().len()]] });
        };
        Ok(warned(path, open::poses(path, model)?))
    }
}
