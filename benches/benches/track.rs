//! Frames a second on one thread: `cargo bench -p condyle-benches --bench track
//! [-- --model F --trial F [--setup IK.xml]]`.
//!
//! Without files a noisy walk of the full body is tracked. The bound is the linearisation: one pose
//! with its Jacobian for each iteration, which every Gauss-Newton solver needs.
#![allow(missing_docs, reason = "a benchmark has no interface")]

mod files;

use condyle::formats::{LengthUnit, Recording};
use condyle::tracking::{Job, Request};
use condyle_benches::{arguments, clock, full_body, table, walk};
use condyle_model::{Jacobian, Model, Pose, Program};
use std::hint::black_box;
use std::time::Instant;

fn main() {
    let (name, model, recording) = match (arguments::path("--model"), arguments::path("--trial")) {
        (Some(model), Some(trial)) => {
            let recording = files::recording(&trial);
            (trial.display().to_string(), files::model(&model), recording)
        }
        (None, None) => {
            let model = full_body::model();
            let recording = synthetic(&model, 600);
            ("full body, 2 mm noise".to_owned(), model, recording)
        }
        _ => files::quit("--model and --trial go together"),
    };
    let row = measure(name, &model, &recording);
    let head = [
        "recording",
        "frames",
        "markers",
        "frames/s",
        "us/frame",
        "iterations",
        "bound us",
        "ratio",
        "rms mm",
        "failed",
        "bytes/pose",
    ];
    table::print("tracking, one thread", &head, &[row]);
}

fn synthetic(model: &Model, frames: usize) -> Recording {
    let motion = walk::motion(model, frames);
    Recording {
        labels: model.markers().iter().map(|marker| marker.name.clone()).collect(),
        rate: walk::RATE,
        times: (0..frames).map(|frame| frame as f64 / walk::RATE).collect(),
        positions: walk::recorded(model, &motion, 0.002)
            .concat()
            .into_iter()
            .map(Into::into)
            .collect(),
        units: LengthUnit::Metre,
        confidences: None,
    }
}

fn measure(name: String, model: &Model, recording: &Recording) -> Vec<String> {
    let asked = arguments::path("--setup").map(|path| files::setup(&path));
    let request = asked.map_or_else(Request::default, |setup| Request::from_setup(&setup));
    let request = Request { threads: Some(1), ..request };
    let job = Job::new(model.clone(), recording, &request)
        .unwrap_or_else(|error| files::quit(&error.to_string()));
    let solve = |_| {
        let start = Instant::now();
        let tracking = job.run(&mut |_, _| {});
        (start.elapsed().as_secs_f64(), tracking)
    };
    let least = (0..5).map(solve).min_by(|a, b| a.0.total_cmp(&b.0));
    let Some((seconds, tracking)) = least else { return vec![] };
    let summary = tracking.summary();
    let iterations = tracking.answers.iter().map(|a| f64::from(a.iterations)).sum::<f64>()
        / summary.frames as f64;
    let program = Program::compile(model);
    let (mut pose, mut jacobian) = (Pose::new(&program), Jacobian::new(&program));
    let frames = &tracking.motion().frames;
    let once = clock::nanoseconds(|i| {
        let stored = black_box(&frames[i % frames.len()]);
        let evaluated = program.evaluate_with_jacobian(stored, &mut pose, &mut jacobian);
        assert!(black_box(evaluated).is_ok());
    });
    let microseconds = 1e6 * seconds / summary.frames as f64;
    let bound = 1e-3 * once * (iterations + 1.0);
    vec![
        name,
        summary.frames.to_string(),
        summary.markers_used.to_string(),
        format!("{:.0}", summary.frames as f64 / seconds),
        format!("{microseconds:.1}"),
        format!("{iterations:.2}"),
        format!("{bound:.1}"),
        format!("{:.1}", microseconds / bound),
        format!("{:.3}", 1e3 * summary.rms),
        summary.failed.len().to_string(),
        pose.bytes().to_string(),
    ]
}
