//! `condyle bench`: how fast a model is posed on this machine, and frames of a recording are solved one by one.

use super::Outcome;
use crate::failure::{Failure, warned};
use crate::output;
use clap::Args;
use condyle::tracking::{Live, Request};
use condyle::{Jacobian, Mode, Model, Pose, Program, open};
use serde_json::json;
use std::hint::black_box;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Instant;

#[derive(Debug, Args)]
pub(crate) struct Bench {
    /// The model: a file, or the name of a shipped one.
    model: PathBuf,
    /// A marker recording, whose frames are solved one by one as from a camera system.
    trial: Option<PathBuf>,
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

/// How often a recording is solved; of each frame the least time counts.
const PASSES: usize = 5;

/// Times of frames that are solved one by one, in milliseconds.
struct Streamed {
    frames: usize,
    /// The first, which starts from first guesses.
    first: f64,
    mean: f64,
    /// The slowest after it, and its number.
    worst: f64,
    worst_frame: usize,
}

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
        let streamed = self.trial.as_deref().map(|trial| streamed(&model, trial)).transpose()?;
        if self.json {
            output::print_json(&json!({
                "model": model.name(),
                "segments": segments,
                "coordinates": model.coordinates().len(),
                "pose_ns": one,
                "batched_pose_ns": batched,
                "pose_with_jacobian_ns": differentiated,
                "bytes_per_pose": bytes,
                "stream": streamed.map(|s| json!({
                    "frames": s.frames,
                    "first_ms": s.first,
                    "mean_ms": s.mean,
                    "worst_ms": s.worst,
                    "worst_frame": s.worst_frame,
                })),
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
            let mut text = format!(
                "{}: {segments} segments, {} coordinates, {bytes} bytes a pose, one thread\n{table}",
                self.model.display(),
                model.coordinates().len(),
            );
            if let Some(s) = streamed {
                text.push_str(&format!(
                    "  {} frames one by one: {:.2} ms on average, {:.2} ms at worst (frame {}); the first \
                     takes {:.1} ms\n",
                    s.frames, s.mean, s.worst, s.worst_frame, s.first,
                ));
            }
            output::print(text.as_bytes())?;
        }
        Ok(Outcome::Done)
    }
}

/// Solves the frames of a recording one by one, several times over.
fn streamed(model: &Model, trial: &Path) -> Result<Streamed, Failure> {
    let recording = warned(trial, open::recording(trial)?);
    let fail =
        |error: &dyn std::fmt::Display| Failure::new(format!("{}: {error}", trial.display()));
    let mut times = vec![f64::INFINITY; recording.frames()];
    let mut coordinates = vec![0.0; model.stored_len()];
    let shared = Arc::new(model.clone());
    for _ in 0..PASSES {
        let live = Live::new(Arc::clone(&shared), &recording.labels, &Request::default());
        let mut live = live.map_err(|error| fail(&error))?;
        for (frame, least) in times.iter_mut().enumerate() {
            let seen: Vec<_> = recording.frame(frame).iter().map(|seen| seen.position()).collect();
            let start = Instant::now();
            let _ = black_box(live.next(&seen, &mut coordinates));
            *least = least.min(1e3 * start.elapsed().as_secs_f64());
        }
    }
    let [first, rest @ ..] = &times[..] else { return Err(fail(&"there are no frames")) };
    let most = rest.iter().enumerate().max_by(|a, b| a.1.total_cmp(b.1));
    let (worst_frame, worst) = most.map_or((0, *first), |(frame, time)| (frame + 1, *time));
    let mean = rest.iter().sum::<f64>() / rest.len().max(1) as f64;
    Ok(Streamed { frames: times.len(), first: *first, mean, worst, worst_frame })
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
