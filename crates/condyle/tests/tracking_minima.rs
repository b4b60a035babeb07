//! Tracking against a slow independent minimiser, on real recordings.
//!
//! `oracles/track/minima.json` holds, for sampled frames of each pair, the lowest F that a trust
//! region method over OpenSim's own kinematics found from its starts. The recordings live beside
//! the project in development; without them the tests say so.

use condyle::formats::opensim::setup::{self, IkTasks};
use condyle::model::Mode;
use condyle::tracking::{Request, Tracking, track};
use condyle::{Model, Pose, Program, open};
use serde_json::Value;
use std::path::{Path, PathBuf};

fn shared_data() -> Option<PathBuf> {
    let data = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data");
    if data.is_dir() {
        return Some(data);
    }
    println!("skipped: the shared data folder is absent");
    None
}

fn pairs() -> Vec<Value> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../oracles/track/minima.json");
    let text = std::fs::read_to_string(path).unwrap();
    let document: Value = serde_json::from_str(&text).unwrap();
    document["pairs"].as_array().unwrap().clone()
}

/// A setup, or a task set alone with the weight that the pair states.
fn request(data: &Path, pair: &Value) -> Request {
    let Some(name) = pair["setup"].as_str() else { return Request::default() };
    let path = data.join(name);
    let bytes = std::fs::read(&path).unwrap();
    let mut request = match open::setup(&path) {
        Ok(read) => Request::from_setup(&read.value),
        Err(_) => {
            let tasks = setup::tasks_from_bytes(&bytes).unwrap().value;
            let mut setup =
                setup::read("<OpenSimDocument><InverseKinematicsTool/></OpenSimDocument>")
                    .unwrap()
                    .value;
            setup.tasks = IkTasks::Inline(tasks);
            Request::from_setup(&setup)
        }
    };
    request.time_range = None;
    request
}

fn run(data: &Path, pair: &Value, threads: usize) -> Option<(Model, Tracking)> {
    let model_path = data.join(pair["model"].as_str().unwrap());
    let model = open::model(&model_path).ok()?.value;
    let recording = open::recording(&data.join(pair["trial"].as_str().unwrap())).unwrap().value;
    let request = Request { threads: Some(threads), ..request(data, pair) };
    let tracking = track(&model, &recording, &request, &mut |_, _| {}).unwrap();
    Some((model, tracking))
}

#[test]
fn sampled_frames_reach_the_independent_minimum() {
    let Some(data) = shared_data() else { return };
    for pair in pairs() {
        let name = format!("{} + {}", pair["model"], pair["trial"]);
        let (_, tracking) = run(&data, &pair, 1).unwrap_or_else(|| panic!("{name} cannot be read"));
        let mut compared = 0;
        for frame in pair["at"].as_array().unwrap() {
            let time = frame["time"].as_f64().unwrap();
            // The minimum near OpenSim's own answer. (A start may find a slightly lower one with a
            // knee wound through a whole turn, off the ends of its splines: no knee does that.)
            let least = frame["near_F"].as_f64().unwrap();
            let nearest = tracking
                .times
                .iter()
                .enumerate()
                .min_by(|a, b| (a.1 - time).abs().total_cmp(&(b.1 - time).abs()))
                .unwrap();
            if (nearest.1 - time).abs() > 1e-4 {
                continue;
            }
            compared += 1;
            let answer = tracking.answers.at(nearest.0);
            assert!(
                answer.objective <= (1.001 * least).max(least + 1e-9),
                "{name} at {time} s: F {} where {least} is possible",
                answer.objective
            );
            assert!(answer.status.is_solved(), "{name} at {time} s: {:?}", answer.status);
            assert!(answer.closure_error < 1e-6, "{name} at {time} s: {}", answer.closure_error);
        }
        // The script sampled six frames of every pair; none may slip by.
        assert_eq!(compared, 6, "{name}");
        let mean = tracking.answers.iter().map(|a| a.objective).sum::<f64>()
            / tracking.answers.len() as f64;
        println!("{name}: {} frames, mean F {mean:.6e}", tracking.answers.len());
    }
}

#[test]
fn couplings_are_exact_and_threads_change_nothing() {
    let Some(data) = shared_data() else { return };
    let pairs = pairs();
    let pair = pairs.iter().find(|p| p["trial"].as_str().unwrap().contains("squats1")).unwrap();
    let (model, one) = run(&data, pair, 1).unwrap();
    for threads in [2, 8] {
        let (_, other) = run(&data, pair, threads).unwrap();
        assert_eq!(one.motion(), other.motion(), "{threads} threads");
    }
    let program = Program::compile(&model);
    let mut pose = Pose::new(&program);
    let mut coupled = 0;
    for frame in &one.motion().frames {
        program.evaluate(frame, Mode::Open, &mut pose).unwrap();
        for id in model.coordinate_ids().filter(|&id| model.coordinate(id).follows.is_some()) {
            assert!((pose.coordinate(&model, id)[0] - model.value(frame, id)).abs() < 1e-12);
            coupled += 1;
        }
    }
    assert_eq!(coupled, 2 * one.motion().frames.len(), "two patellae in every frame");
}
