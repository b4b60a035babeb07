//! `condyle demo`: the whole story on a recording made from a known motion.

mod figure;

use super::Outcome;
use crate::failure::Failure;
use crate::motion_format;
use crate::output;
use crate::progress::frames_bar;
use clap::Args;
use condyle::formats::{Recording, trc};
use condyle::tracking::{Job, Request, Tracking};
use condyle::{CoordinateKind, Mode, Model, Motion, Pose, Program};
use condyle_view::{Session, Shown, exported};
use figure::{Flaws, record, walk, walker};
use serde_json::json;
use std::path::PathBuf;
use std::sync::Arc;
use std::time::Instant;

#[derive(Debug, Args)]
pub(crate) struct Demo {
    /// A folder for the recording, the motions, an animated scene, and a page that plays them in a browser.
    #[arg(short, long, value_name = "DIR")]
    output: Option<PathBuf>,
    /// One JSON document on standard output.
    #[arg(long)]
    json: bool,
}

const FRAMES: usize = 600;
const RATE: f64 = 100.0;
const NOISE: f64 = 0.002;
const MISSING: f64 = 0.05;
const SWAPPED: [&str; 2] = ["R.Knee", "L.Knee"];
const SWAPPED_FROM: usize = 240;
const SWAPPED_TO: usize = 330;

impl Demo {
    pub(crate) fn run(self) -> Result<Outcome, Failure> {
        let model = Arc::new(walker());
        let truth = walk(&model, FRAMES, RATE);
        let flaws = Flaws {
            noise: NOISE,
            missing: MISSING,
            swap: Some((SWAPPED.map(str::to_owned), SWAPPED_FROM..SWAPPED_TO)),
            seed: 2026,
        };
        let recording = record(&model, &truth, &flaws);
        let followers = model.coordinates().iter().filter(|c| c.follows.is_some()).count();
        if !self.json {
            output::print(
                format!(
                    "A walk whose every angle is known, and what a laboratory might have recorded of it.\n\n  \
                     figure     {} segments, {} coordinates of which {followers} follow others, {} markers\n  \
                     recording  {FRAMES} frames at {RATE} Hz; {} mm of noise; {:.1} % of all marker places missing;\n             \
                     labels {} and {} exchanged in frames {SWAPPED_FROM} to {}\n\n",
                    model.segments().len(),
                    model.coordinates().len(),
                    model.markers().len(),
                    1e3 * NOISE,
                    100.0 * recording.missing() as f64 / recording.positions.len() as f64,
                    SWAPPED[0],
                    SWAPPED[1],
                    SWAPPED_TO - 1,
                )
                .as_bytes(),
            )?;
        }
        let (plain, rate_plain) = tracked(&model, &recording, false)?;
        let (robust, rate_robust) = tracked(&model, &recording, true)?;
        let [off_plain, off_robust] =
            [&plain, &robust].map(|t| Closeness::of(&model, &t.motion(), &truth));
        if self.json {
            output::print_json(&json!({
                "frames": FRAMES,
                "plain": off_plain.json(&plain, rate_plain),
                "robust": off_robust.json(&robust, rate_robust),
                "swapped_labels": robust.swaps.iter().map(|s| json!({
                    "labels": s.labels, "frames": [s.frames.start, s.frames.end],
                })).collect::<Vec<_>>(),
            }))?;
        } else {
            output::print(
                table([(&plain, &off_plain, rate_plain), (&robust, &off_robust, rate_robust)])
                    .as_bytes(),
            )?;
            output::print(findings(&model, &robust, &off_robust).as_bytes())?;
        }
        if let Some(folder) = &self.output {
            let fail = |error: condyle::formats::Error| Failure::new(error.to_string());
            let text = trc::write(&recording, "recording.trc").map_err(fail)?;
            output::write(&folder.join("recording.trc"), text.as_bytes())?;
            let labels: Vec<usize> = (0..recording.labels.len()).collect();
            let recovered = robust.motion();
            let motions = [
                ("truth.mot", &truth),
                ("recovered.mot", &recovered),
                ("recovered.glb", &recovered),
            ];
            for (name, motion) in motions {
                let path = folder.join(name);
                let format = motion_format::of_motion(&path, None)?;
                let markers = Some((&recording, labels.as_slice()));
                let bytes = motion_format::encoded(format, &model, motion, "demo", markers, &[])?;
                output::write(&path, &bytes)?;
            }
            let mut session = Session::of(Model::clone(&model));
            "demo".clone_into(&mut session.title);
            let markers = Shown::tracked("recovered".to_owned(), &model, &recording, &robust);
            session.motions = vec![markers, Shown::of("truth".to_owned(), truth)];
            output::write(&folder.join("demo.html"), exported(&session, false).as_bytes())?;
            if !self.json {
                let folder = folder.display();
                output::print(
                    format!(
                        "\nIn {folder}: recording.trc, truth.mot, recovered.mot, recovered.glb, which any \
                         glTF viewer plays, and demo.html, which a browser opens: the motion with its markers, beside the truth.\n"
                    )
                    .as_bytes(),
                )?;
            }
        }
        Ok(Outcome::Done)
    }
}

/// The tracking and its frames per second.
fn tracked(
    model: &Arc<Model>,
    recording: &Recording,
    robust: bool,
) -> Result<(Tracking, f64), Failure> {
    let bar = frames_bar(if robust { "tracking, robust" } else { "tracking" });
    let request = Request { robust, threads: Some(1), ..Request::default() };
    let job = Job::new(Arc::clone(model), recording, &request)?;
    let start = Instant::now();
    let tracking = job.run(&mut |done, total| {
        bar.set_length(total as u64);
        bar.set_position(done as u64);
    });
    let seconds = start.elapsed().as_secs_f64();
    bar.finish_and_clear();
    let rate = tracking.answers.len() as f64 / seconds.max(1e-9);
    Ok((tracking, rate))
}

/// How close a motion comes to the true one.
struct Closeness {
    /// Root mean square over all rotations and frames, in degrees.
    angles: f64,
    /// The rotation that is farthest off in the mean, and by how much in degrees.
    worst: (String, f64),
    /// Root mean square distance of all segments' origins, in metres.
    origins: f64,
}

impl Closeness {
    fn of(model: &Model, motion: &Motion, truth: &Motion) -> Self {
        let rotations = model
            .coordinate_ids()
            .filter(|&id| model.coordinate(id).kind == CoordinateKind::Rotation);
        let frames = || motion.frames.iter().zip(&truth.frames);
        let count = motion.frames.len().max(1) as f64;
        let mut worst = (String::new(), 0.0);
        let (mut sum, mut n) = (0.0, 0.0_f64);
        for id in rotations {
            let off = |a: &[f64], b: &[f64]| model.value(a, id) - model.value(b, id);
            let squares: f64 = frames().map(|(a, b)| off(a, b).powi(2)).sum();
            let rms = (squares / count).sqrt().to_degrees();
            if rms > worst.1 {
                worst = (model.coordinate_key(id), rms);
            }
            sum += rms * rms;
            n += 1.0;
        }
        let program = Program::compile(model);
        let (mut found, mut meant) = (Pose::new(&program), Pose::new(&program));
        let mut squares = 0.0;
        for (a, b) in frames() {
            let evaluated = program.evaluate(a, Mode::Open, &mut found).is_ok()
                && program.evaluate(b, Mode::Open, &mut meant).is_ok();
            if evaluated {
                let both = found.segments().iter().zip(meant.segments());
                squares +=
                    both.map(|(a, b)| (a.translation - b.translation).norm_squared()).sum::<f64>();
            }
        }
        let origins = (squares / count / model.segments().len().max(1) as f64).sqrt();
        Self { angles: (sum / n.max(1.0)).sqrt(), worst, origins }
    }

    fn json(&self, tracking: &Tracking, rate: f64) -> serde_json::Value {
        let summary = tracking.summary();
        json!({
            "frames_per_second": rate,
            "marker_rms_m": summary.rms,
            "angle_rms_deg": self.angles,
            "worst_coordinate": self.worst.0,
            "worst_coordinate_rms_deg": self.worst.1,
            "segment_origin_rms_m": self.origins,
            "failed_frames": summary.failed.len(),
        })
    }
}

fn table(runs: [(&Tracking, &Closeness, f64); 2]) -> String {
    let row = |name: &str, values: [String; 2]| {
        let [a, b] = values;
        vec![name.to_owned(), a, b]
    };
    output::columns(&[
        row("", ["track".to_owned(), "track --robust".to_owned()]),
        row("frames per second, one thread", runs.map(|(_, _, rate)| format!("{rate:.0}"))),
        row(
            "markers off the recording, RMS",
            runs.map(|(t, ..)| format!("{:.2} mm", 1e3 * t.summary().rms)),
        ),
        row("angles off the truth, RMS", runs.map(|(_, c, _)| format!("{:.2}°", c.angles))),
        row(
            "joints off the truth, RMS",
            runs.map(|(_, c, _)| format!("{:.2} mm", 1e3 * c.origins)),
        ),
    ])
}

fn findings(model: &Model, robust: &Tracking, off: &Closeness) -> String {
    let mut text = String::from("\n");
    for swap in &robust.swaps {
        text.push_str(&format!("  Found: {swap}.\n"));
    }
    let failed = robust.summary().failed.len();
    text.push_str(&format!(
        "  The recovered motion is {:.2} degrees and {:.2} mm from the truth; {} is the worst at {:.2} degrees.\n  \
         {failed} of {} frames failed; {} of {} coordinates were at a limit.\n",
        off.angles,
        1e3 * off.origins,
        off.worst.0,
        off.worst.1,
        robust.answers.len(),
        robust.at_limits(model).len(),
        model.coordinates().len(),
    ));
    text
}
