//! Written models in the programs that read them: OpenSim, Pinocchio, MuJoCo, usd-core.
//!
//! Their answers are kept in `oracles/written/`: bodies at legal poses, read from our files by those programs.
//! The models must be where they are, and so must what is written today, read by simple readers. Where a program
//! is installed (`OPENSIM_PYTHON` and so on name a Python that has it) it is asked again.

#[path = "../../examples/written/answer.rs"]
mod answer;
mod kept;
mod mjcf;
mod usda;

use condyle::formats::plain::upright;
use condyle::formats::{opensim, urdf, usd};
use condyle::math::Affine;
use condyle::model::UpAxis;
use condyle::{Mode, Model, Motion, Pose, Program, shipped};
use kept::{Allowed, PEERS, Peer, Row, answers, compare, folder, names, numbers, rows};
use serde_json::Value;
use std::collections::HashMap;
use std::process::Command;

/// What is promised of a fitted part over legal poses: half a millimetre and a tenth of a degree.
const PROMISED: [f64; 2] = [0.5, 0.1];
/// Parts that are named as not to be said: a contact that jumps within its limits, and what hangs on it.
const NOT_SAID: [(&str, &str); 1] = [("osim", "shoulder-shao2003")];

fn model(name: &str) -> Model {
    shipped::read(name).unwrap().value.model
}

fn posed(model: &Model, stored: &[f64]) -> Pose {
    let program = Program::compile(model);
    let mut pose = Pose::new(&program);
    program.evaluate(stored, Mode::Open, &mut pose).unwrap();
    pose
}

#[test]
fn models_are_where_other_programs_have_their_files() {
    for peer in &PEERS {
        let answers = answers(peer);
        let all: Vec<&str> = shipped::names().collect();
        assert!(all.iter().all(|name| answers.contains_key(*name)), "{}: a model", peer.answers);
        for (name, answer) in &answers {
            let model = model(name);
            let beyond = names(&answer["beyond"]);
            for row in rows(answer) {
                let pose = posed(&model, &row.stored);
                let what = format!("{name} in {}", answer["peer"]);
                compare(&what, &row, &beyond, allowed(answer, &beyond), &|body| {
                    pose.segment(model.find_segment(body).unwrap())
                });
            }
        }
    }
}

/// As listed; with parts that are not said, the others have to be exact.
fn allowed(answer: &Value, beyond: &[String]) -> Allowed {
    match beyond {
        [] => Allowed::by(answer),
        _ => Allowed { length: 1e-6, angle: 2e-6 },
    }
}

#[test]
fn what_is_listed_is_within_what_is_promised_or_named() {
    for peer in &PEERS {
        for (name, answer) in &answers(peer) {
            let named = NOT_SAID.contains(&(peer.format, name.as_str()));
            assert_eq!(named, !names(&answer["beyond"]).is_empty(), "{name}.{}", peer.format);
            let follows = numbers(&answer["follows"]);
            assert_eq!(named, follows.iter().zip(PROMISED).any(|(a, b)| *a > b), "{name}");
            // With every joint set nothing is fitted but OpenSim's couplers, whose values are what is set.
            if peer.format != "osim" {
                let together = numbers(&answer["all_given"]);
                assert!(together[0] < 0.02 && together[1] < 1e-4, "{name}: {together:?}");
            }
            assert_eq!(answer["poses"], 100);
        }
    }
}

/// What is written today, read by simple readers, is where the program had it.
fn written_today(peer: &Peer) {
    for (name, answer) in &answers(peer) {
        let model = model(name);
        let beyond = names(&answer["beyond"]);
        let allowed = allowed(answer, &beyond);
        let what = format!("{name}.{}", peer.format);
        let rows = rows(answer);
        for (row, bodies) in rows.iter().zip(bodies_today(&model, peer.format, &rows)) {
            compare(&what, row, &beyond, allowed, &|body| bodies[body]);
        }
    }
}

/// The bodies of a written text at each of some poses, in the model's world.
fn bodies_today(model: &Model, format: &str, rows: &[Row]) -> Vec<HashMap<String, Affine>> {
    let upright = match model.up() {
        UpAxis::Y => upright().rigid_inverse(),
        UpAxis::Z => Affine::IDENTITY,
    };
    match format {
        "osim" => {
            let text = opensim::write(model).value;
            let read = opensim::model::read(text.as_bytes()).unwrap().value;
            rows.iter().map(|row| set(&read, row, Affine::IDENTITY)).collect()
        }
        "urdf" => {
            let read = urdf::from_bytes(urdf::write(model).value.as_bytes()).unwrap().value;
            rows.iter().map(|row| set(&read, row, upright)).collect()
        }
        "mjcf" => {
            let text = condyle::formats::mjcf::write(model).value;
            let turned = |(name, body)| (name, upright * body);
            let at = |row: &Row| mjcf::bodies(&text, &row.joints).into_iter().map(turned).collect();
            rows.iter().map(at).collect()
        }
        _ => {
            let frames: Vec<Vec<f64>> = rows.iter().map(|row| row.stored.clone()).collect();
            let times = (0..frames.len()).map(|i| i as f64 / 30.0).collect();
            let motion = Motion { times, frames };
            usda::joints(&usd::write(model, &motion, Mode::Open).unwrap().value)
        }
    }
}

/// The segments of a model that was read, where its coordinates are what the program was given.
fn set(read: &Model, row: &Row, base: Affine) -> HashMap<String, Affine> {
    let mut stored = read.defaults();
    for (joint, value) in &row.joints {
        let id = read.find_coordinate(joint).unwrap();
        stored[read.stored_range(id).start] = *value;
    }
    let pose = posed(read, &stored);
    let named = |id| (read.segment(id).name.clone(), base * pose.segment(id));
    read.segment_ids().map(named).collect()
}

#[test]
fn opensim_had_it_where_it_is_written_today() {
    written_today(&PEERS[0]);
}

#[test]
fn pinocchio_had_it_where_it_is_written_today() {
    written_today(&PEERS[1]);
}

#[test]
fn mujoco_had_it_where_it_is_written_today() {
    written_today(&PEERS[2]);
}

#[test]
fn usd_had_it_where_it_is_written_today() {
    written_today(&PEERS[3]);
}

#[test]
fn programs_that_are_installed_have_it_today() {
    let out = std::env::temp_dir().join(format!("condyle-written-{}", std::process::id()));
    std::fs::create_dir_all(&out).unwrap();
    for peer in &PEERS {
        let Some(python) = std::env::var_os(peer.variable) else {
            println!("skipped: {} names no Python for .{}", peer.variable, peer.format);
            continue;
        };
        for (name, answer) in &answers(peer) {
            let (text, asked) = answer::written(&model(name), peer.format, 20).unwrap();
            let path = out.join(format!("{name}.{}", peer.format));
            std::fs::write(&path, text).unwrap();
            std::fs::write(path.with_extension(format!("{}.json", peer.format)), asked.to_string())
                .unwrap();
            let script = folder().join(peer.script);
            let run = Command::new(&python).arg(script).arg(&path).output().unwrap();
            let said = String::from_utf8_lossy(&run.stdout);
            let problem = String::from_utf8_lossy(&run.stderr);
            assert!(run.status.success(), "{name}.{}: {problem}", peer.format);
            let found: Value = serde_json::from_str(said.trim().lines().last().unwrap()).unwrap();
            for key in ["follows", "all_given"] {
                let [found, listed] = [&found[key], &answer[key]].map(numbers);
                let rounding = [1e-3, 1e-4, 0.1];
                let more = found.iter().zip(&listed).zip(rounding).any(|((f, l), r)| f - l > r);
                assert!(!more, "{name}.{}: {key} {found:?}, not {listed:?}", peer.format);
            }
        }
    }
    std::fs::remove_dir_all(&out).unwrap();
}
