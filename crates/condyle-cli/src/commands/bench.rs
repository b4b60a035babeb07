//! `condyle bench`: how fast a model is posed on this machine.

use super::Outcome;
use crate::failure::{Failure, warned};
use crate::output;
use clap::Args;
use condyle::{Jacobian, Mode, Model, Pose, Program, open};
use serde_json::json;
use std::hint::black_box;
use std::path::PathBuf;
use std::time::Instant;

#[derive(Debug, Args)]
pub(crate) struct Bench {
    /// The model: a file, or the name of a shipped one.
    model: PathBuf,
    /// One JSON document on standard output.
    #[arg(long)]
    json: bool,
}

/// The number of different postures evaluated in turn, so that branch prediction cannot adapt to
/// one.
const POSTURES: usize = 64;
/// The number of postures in one batch.
const BATCH: usize = 1024;
/// How often each figure is measured; the minimum is reported.
const ROUNDS: usize = 15;

impl Bench {
    pub(crate) fn run(self) -> Result<Outcome, Failure> {
        let model = warned(&self.model, open::model(&self.model)?);
        let program = Program::compile(&model);
        let postures = postures(&model);
        let fail = |error: condyle::model::SizeMismatch| Failure::new(error.to_string());
        let mut pose = Pose::new(&program);
        let mut jacobian = Jacobian::new(&program);
        program.evaluate_with_jacobian(&postures[0], &mut pose, &mut jacobian).map_err(fail)?;
        let one = nanoseconds(POSTURES, || {
            for posture in &postures {
                let _ = black_box(program.evaluate(posture, Mode::Open, &mut pose));
            }
        });
        let differentiated = nanoseconds(POSTURES, || {
            for posture in &postures {
                let _ =
                    black_box(program.evaluate_with_jacobian(posture, &mut pose, &mut jacobian));
            }
        });
        // A batch keeps every pose, as for an export or a data set.
        let mut poses = vec![Pose::new(&program); BATCH];
        let batched = nanoseconds(BATCH, || {
            for (pose, posture) in poses.iter_mut().zip(postures.iter().cycle()) {
                let _ = black_box(program.evaluate(posture, Mode::Open, pose));
            }
        });
        let (segments, bytes) = (model.segments().len(), pose.bytes());
        if self.json {
            output::print_json(&json!({
                "model": model.name(),
                "segments": segments,
                "coordinates": model.coordinates().len(),
                "pose_ns": one,
                "batched_pose_ns": batched,
                "pose_with_jacobian_ns": differentiated,
                "bytes_per_pose": bytes,
            }))?;
        } else {
            let row = |name: &str, value: f64| {
                vec![
                    name.to_owned(),
                    format!("{value:.0} ns"),
                    format!("{:.1} ns a segment", value / segments.max(1) as f64),
                ]
            };
            let table = output::columns(&[
                row("one pose", one),
                row("one of a batch of 1024", batched),
                row("with its Jacobian", differentiated),
            ]);
            let text = format!(
                "{}: {segments} segments, {} coordinates, {bytes} bytes a pose, one thread\n{table}",
                self.model.display(),
                model.coordinates().len(),
            );
            output::print(text.as_bytes())?;
        }
        Ok(Outcome::Done)
    }
}

/// Postures spread over the ranges, or half a unit around the defaults where there is none.
fn postures(model: &Model) -> Vec<Vec<f64>> {
    (0..POSTURES)
        .map(|posture| {
            let mut stored = model.defaults();
            for id in model.coordinate_ids() {
                let place = model.stored_range(id);
                if place.len() > 1 {
                    continue;
                }
                let range = model.coordinate(id).range;
                let default = stored[place.start];
                let near =
                    |v: Option<f64>, other: f64| v.filter(|v| v.abs() < 10.0).unwrap_or(other);
                let (lower, upper) =
                    (near(range.lower, default - 0.5), near(range.upper, default + 0.5));
                // The golden ratio spreads evenly however many coordinates there are.
                let share =
                    ((posture * 31 + id.index() * 17 + 1) as f64 * 0.618_033_988_749_895).fract();
                stored[place.start] = lower + (upper - lower) * share;
            }
            stored
        })
        .collect()
}

/// The least time of several rounds, for each of `count` things done in one.
fn nanoseconds(count: usize, mut work: impl FnMut()) -> f64 {
    let mut least = f64::INFINITY;
    for _ in 0..ROUNDS {
        // Long enough for the clock: a thousand things or more.
        let repeats = (2048 / count).max(1);
        let start = Instant::now();
        (0..repeats).for_each(|_| work());
        least = least.min(start.elapsed().as_secs_f64() * 1e9 / (repeats * count) as f64);
    }
    least
}
