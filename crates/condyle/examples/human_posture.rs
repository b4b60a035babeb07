//! How the shipped human holds itself where markers say little: `cargo run --release --example
//! human_posture -- FOLDER`.
//!
//! FOLDER holds recordings at the places listed here. The human is scaled to a static trial where there
//! is one, else to the first frame of the recording. One row of a table in Markdown is printed for each:
//!
//! - the RMS over the markers, and √P of the postures beside it;
//! - how far the skull leans from upright, at most and in how many frames by over 15°;
//! - the largest change from one frame to the next, of a coordinate of spine and neck and of the
//!   orientation of one of its segments;
//! - of the frames in which lumbar or thoracic rotation exceeds 2°, those in which both turn to one side.

use condyle::formats::Recording;
use condyle::math::Vec3;
use condyle::scaling::{self, Assumptions as Sizing};
use condyle::tracking::{Request, Tracking, track};
use condyle::{CoordinateId, Mode, Model, Pose, Program, open};
use std::error::Error;
use std::path::{Path, PathBuf};
use std::time::Instant;

/// Recording and static trial; the postures were set with the first two in view.
const TRIALS: [(&str, Option<&str>); 6] = [
    ("knee/opencap4/walking1.trc", Some("knee/opencap4/static1.trc")),
    ("knee/opencap4/squats1.trc", Some("knee/opencap4/static1.trc")),
    ("knee/gait_walk.trc", None),
    ("knee/gait_walk2.trc", None),
    ("knee/SprintMotion.trc", Some("knee/SprintCalib.trc")),
    ("ik/lai_subject6/walking1.trc", None),
];

fn main() -> Result<(), Box<dyn Error>> {
    let Some(folder) = std::env::args().nth(1).map(PathBuf::from) else {
        return Err("give the folder of the recordings".into());
    };
    let human = open::model(Path::new("human"))?.value;
    println!(
        "| recording | frames | markers | RMS, √P (mm) | skull leans (°) | over 15° | step of a \
         coordinate (°) | of a segment (°) | one side | frames/s |"
    );
    println!("| --- | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: |");
    for (name, static_trial) in TRIALS {
        let path = folder.join(name);
        if !path.exists() {
            println!("| {name} | is not there | | | | | | | | |");
            continue;
        }
        let recording = open::recording(&path)?.value;
        let standing = match static_trial {
            Some(trial) => open::recording(&folder.join(trial))?.value,
            None => first_frame(&recording),
        };
        let model = scaling::fit(&human, &standing, &Sizing::default())?.model;
        let start = Instant::now();
        let request = Request { threads: Some(1), ..Request::default() };
        let tracking = track(&model, &recording, &request, &mut |_, _| {})?;
        let seconds = start.elapsed().as_secs_f64();
        let summary = tracking.summary();
        let posture = tracking.answers.iter().map(|a| a.posture).sum::<f64>();
        let mean = posture / tracking.answers.len().max(1) as f64;
        let held = Held::of(&model, &tracking)?;
        println!(
            "| {name} | {} | {} | {:.2}, {:.2} | {:.1} | {:.0} % | {:.1} ({}) | {:.1} ({}) | {} | {:.0} |",
            summary.frames,
            summary.markers_used,
            1e3 * summary.rms,
            1e3 * mean.sqrt(),
            held.lean,
            100.0 * held.leaning,
            held.step.0,
            held.step.1,
            held.turn.0,
            held.turn.1,
            held.one_side.map_or("-".to_owned(), |(share, of)| format!("{:.0} % of {of}", 100.0 * share)),
            summary.frames as f64 / seconds,
        );
    }
    Ok(())
}

/// What became of the spine of a recording; angles in degrees.
struct Held {
    /// The largest angle between the skull's y axis and the world's.
    lean: f64,
    /// Share of the frames in which it exceeds 15°.
    leaning: f64,
    /// The largest change of a coordinate between frames, and which.
    step: (f64, String),
    /// The largest change of a segment's orientation between frames, and which.
    turn: (f64, String),
    /// Share of the frames in which lumbar and thoracic rotation have one sign, and of how many.
    one_side: Option<(f64, usize)>,
}

impl Held {
    fn of(model: &Model, tracking: &Tracking) -> Result<Self, Box<dyn Error>> {
        let frames = &tracking.motion.frames;
        let regions = ["lumbar", "thoracic", "cervical", "atlanto_occipital", "head"];
        let spine: Vec<CoordinateId> = model
            .coordinate_ids()
            .filter(|&id| {
                let set = &model.joint_sets()[model.coordinate(id).joint_set.index()].name;
                regions.contains(&set.as_str())
            })
            .collect();
        let mut held = Self {
            lean: 0.0,
            leaning: 0.0,
            step: (0.0, String::new()),
            turn: (0.0, String::new()),
            one_side: None,
        };
        for pair in frames.windows(2) {
            for &id in &spine {
                let step = (model.value(&pair[1], id) - model.value(&pair[0], id)).abs();
                if step.to_degrees() > held.step.0 {
                    held.step = (step.to_degrees(), model.coordinate(id).name.clone());
                }
            }
        }
        let [lumbar, thoracic] = [
            model.find_coordinate("lumbar_rotation")?,
            model.find_coordinate("thoracic_rotation")?,
        ];
        let turns = frames.iter().map(|q| [model.value(q, lumbar), model.value(q, thoracic)]);
        let large = turns.filter(|[l, t]| l.abs().max(t.abs()) > 2f64.to_radians());
        let (mut count, mut alike) = (0, 0);
        for [l, t] in large {
            count += 1;
            alike += usize::from(l * t > 0.0);
        }
        held.one_side = (count > 0).then(|| (alike as f64 / count as f64, count));

        let vertebra = |name: &str| {
            name == "skull" || ["vl", "vt", "vc"].iter().any(|start| name.starts_with(start))
        };
        let segments: Vec<_> = model
            .segment_ids()
            .filter(|&id| vertebra(&model.segment(id).name))
            .collect();
        let skull = model.find_segment("skull")?;
        let program = Program::compile(model);
        let mut pose = Pose::new(&program);
        let mut before = vec![];
        for q in frames {
            program.evaluate(q, Mode::Open, &mut pose)?;
            let up = pose.segment(skull).linear * Vec3::Y;
            let lean = up.y.clamp(-1.0, 1.0).acos().to_degrees();
            held.lean = held.lean.max(lean);
            held.leaning += f64::from(u8::from(lean > 15.0)) / frames.len() as f64;
            let now: Vec<_> = segments.iter().map(|&id| pose.segment(id).linear).collect();
            for ((a, b), &id) in now.iter().zip(&before).zip(&segments) {
                let turn = (*a * condyle::math::Mat3::transpose(*b)).log().norm().to_degrees();
                if turn > held.turn.0 {
                    held.turn = (turn, model.segment(id).name.clone());
                }
            }
            before = now;
        }
        Ok(held)
    }
}

fn first_frame(recording: &Recording) -> Recording {
    Recording {
        times: recording.times[..1].to_vec(),
        positions: recording.positions[..recording.labels.len()].to_vec(),
        ..recording.clone()
    }
}
