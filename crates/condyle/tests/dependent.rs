//! Limits that depend on another joint, in models from text to answers. What is learned are hinges about z whose bounds follow a law:
//! 120° less 0.4 of how far the upper arm is turned, and 20° and 0.4 of the elbow's flexion.

use condyle::check::motion;
use condyle::formats::document::{self, limit};
use condyle::formats::exchange;
use condyle::learn::limits::dependent::{Asked, Driver, Drivers, Pairs, limit as learned};
use condyle::learn::limits::{About, Settings};
use condyle::math::{Quat, Vec3};
use condyle::{AngleUnit, Jacobian, Law, Mode, Model, Motion, Pose, Program};
use std::sync::OnceLock;

fn unit(state: &mut u64) -> f64 {
    *state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
    (*state >> 11) as f64 / (1u64 << 53) as f64
}

fn swung(state: &mut u64) -> Quat {
    let [x, y, z] = [0; 3].map(|_| 2.0 * unit(state) - 1.0);
    Quat::exp(Vec3::new(x, y, z) * 0.6)
}

/// How far an elbow opens.
fn most(shoulder: Quat) -> f64 {
    120f64.to_radians() - 0.4 * shoulder.angle_to(Quat::IDENTITY)
}

/// How far a wrist turns.
fn turned(flexion: f64) -> f64 {
    20f64.to_radians() + 0.4 * flexion
}

fn text(name: &str, reference: Option<&str>, rotations: &[Quat], drivers: Drivers) -> String {
    let pairs = Pairs::gather(&[(rotations, drivers)], 0.0, 0.5).unwrap();
    let about = About {
        name: "of a law".into(),
        child: "child".into(),
        source: "a law".into(),
        ..About::default()
    };
    let asked = Asked {
        about,
        name: name.into(),
        reference: reference.map(str::to_owned),
        kind: None,
        settings: None,
        whole: Settings { nodes: 24, ..Settings::default() },
        curves: None,
    };
    limit::write(&learned(&pairs, &asked).unwrap().0)
}

fn elbow() -> &'static str {
    static TEXT: OnceLock<String> = OnceLock::new();
    TEXT.get_or_init(|| {
        let mut state = 3;
        let shoulders: Vec<Quat> = (0..4000).map(|_| swung(&mut state)).collect();
        let turn = |q: &Quat| Quat::from_axis_angle(Vec3::Z, most(*q) * unit(&mut state));
        let rotations: Vec<Quat> = shoulders.iter().map(turn).collect();
        text("humerus", Some("thorax"), &rotations, Drivers::Rotations(shoulders))
    })
}

fn wrist() -> &'static str {
    static TEXT: OnceLock<String> = OnceLock::new();
    TEXT.get_or_init(|| {
        let mut state = 4;
        let flexions: Vec<f64> = (0..4000).map(|_| 2.0 * unit(&mut state)).collect();
        let turn = |f: &f64| Quat::from_axis_angle(Vec3::Z, turned(*f) * unit(&mut state));
        let rotations: Vec<Quat> = flexions.iter().map(turn).collect();
        text("flexion", None, &rotations, Drivers::Scalars(flexions))
    })
}

const ARM: &str = r#"
condyle = 1
kind = "model"
[segment.thorax]
[segment.humerus]
parent = "thorax"
[joint.shoulder]
type = "ball"
segment = "humerus"
[segment.forearm]
parent = "humerus"
at = [0, -0.3, 0]
[joint_set.elbow.coordinate.flexion]
[joint_set.elbow.component.bend.rotate]
angle = "flexion"
axis = [0, 0, 1]
[joint_set.elbow.output]
forearm = ["bend"]
[joint_set.elbow.component.open.field]
segment = "forearm"
reference = "humerus"
driver_segment = "humerus"
driver_reference = "thorax"
file = "elbow.toml"
[segment.hand]
parent = "forearm"
at = [0, -0.25, 0]
[joint_set.wrist.coordinate.wrist]
kind = "orientation"
[joint_set.wrist.component.held.field]
orientation = "wrist"
driver = "elbow.flexion"
file = "wrist.toml"
[joint_set.wrist.component.turn.ball]
orientation = "held"
[joint_set.wrist.output]
hand = ["turn"]
"#;

fn files(path: &str) -> Result<String, String> {
    match path {
        "elbow.toml" => Ok(elbow().to_owned()),
        "wrist.toml" => Ok(wrist().to_owned()),
        other => Err(format!("{other} is not there")),
    }
}

fn arm() -> Model {
    document::read(ARM, &mut files).unwrap_or_else(|error| panic!("{error}")).value.model
}

/// Shoulder, flexion, wrist.
fn posture(shoulder: Quat, flexion: f64, wrist: Quat) -> Vec<f64> {
    let mut stored = shoulder.to_array().to_vec();
    stored.push(flexion);
    stored.extend(wrist.to_array());
    stored
}

#[test]
fn rows_follow_the_law_and_have_slopes_by_both() {
    let model = arm();
    let program = Program::compile(&model);
    let (mut pose, mut jacobian) = (Pose::new(&program), Jacobian::new(&program));
    let mut state = 9;
    let step = 1e-5;
    for _ in 0..40 {
        let (shoulder, flexion) = (swung(&mut state), 0.2 + 2.0 * unit(&mut state));
        let wrist = Quat::from_axis_angle(Vec3::Z, 1.2 * unit(&mut state));
        let stored = posture(shoulder, flexion, wrist);
        program.evaluate_with_jacobian(&stored, &mut pose, &mut jacobian).unwrap();
        let rows: Vec<f64> = (0..2).map(|row| pose.limit_row(row)).collect();
        // Each within a few degrees of the law: the nearer bound, 0 or what it says.
        let laws = [
            (flexion.min(most(shoulder) - flexion), 5f64),
            (wrist.log().z.min(turned(flexion) - wrist.log().z), 1.5),
        ];
        for (law, within) in laws {
            let near = rows.iter().map(|row| (row - law).abs()).fold(f64::INFINITY, f64::min);
            assert!(near < within.to_radians(), "{law} {rows:?}");
        }
        for direction in 0..program.tangent_len() {
            let at = |sign: f64| {
                let mut moved = stored.clone();
                let turn = |numbers: &mut [f64], axis: usize| {
                    let q = Quat { x: numbers[0], y: numbers[1], z: numbers[2], w: numbers[3] };
                    let q = q * Quat::exp(Vec3::UNITS[axis] * (sign * step));
                    numbers.copy_from_slice(&q.to_array());
                };
                match direction {
                    0..3 => turn(&mut moved[..4], direction),
                    3 => moved[4] += sign * step,
                    other => turn(&mut moved[5..], other - 4),
                }
                let mut pose = Pose::new(&program);
                program.evaluate(&moved, Mode::Open, &mut pose).unwrap();
                [0, 1].map(|row| pose.limit_row(row))
            };
            let (plus, minus) = (at(1.0), at(-1.0));
            for row in 0..2 {
                let exact: f64 = program
                    .limit_row_directions(row)
                    .iter()
                    .filter(|(d, _)| *d as usize == direction)
                    .map(|(_, slot)| jacobian.derivative(*slot))
                    .sum();
                let difference = (plus[row] - minus[row]) / (2.0 * step);
                assert!(
                    (exact - difference).abs() < 1e-6,
                    "{row} {direction}: {exact} {difference}"
                );
            }
        }
    }
}

#[test]
fn posing_moves_the_child_and_not_its_driver() {
    let model = arm();
    let program = Program::compile(&model);
    let mut pose = Pose::new(&program);
    for flexion in [0.2, 1.0, 1.8] {
        let asked = Quat::from_axis_angle(Vec3::Z, 1.6);
        let stored = posture(Quat::IDENTITY, flexion, asked);
        program.evaluate(&stored, Mode::Posed, &mut pose).unwrap();
        let effective = pose.effective().to_vec();
        assert_eq!(effective[..5], stored[..5]);
        let held = Quat { x: effective[5], y: effective[6], z: effective[7], w: effective[8] };
        assert!((held.log().z - turned(flexion)).abs() < 1.5f64.to_radians());
        // Posed again it stays.
        let again = posture(Quat::IDENTITY, flexion, held);
        program.evaluate(&again, Mode::Posed, &mut pose).unwrap();
        let stays = pose.effective();
        assert!((0..4).all(|k| (stays[5 + k] - effective[5 + k]).abs() < 1e-9));
    }
}

#[test]
fn a_motion_is_checked_at_its_drivers() {
    let model = arm();
    let bent = 115f64.to_radians();
    // Amid what the wrist may: 0 to 66 degrees.
    let wrist = Quat::from_axis_angle(Vec3::Z, 30f64.to_radians());
    // The same flexion is legal with the arm at rest, and 7 degrees too much with it turned by 30.
    let far = Quat::from_axis_angle(Vec3::X, 30f64.to_radians());
    let moved = Motion {
        times: vec![0.0, 0.1],
        frames: vec![posture(Quat::IDENTITY, bent, wrist), posture(far, bent, wrist)],
    };
    let mut table = moved.to_table(&model, "m");
    table.angle_unit = AngleUnit::Radians;
    table.values = moved.frames.concat();
    let checked = motion::check(&model, &table);
    let broken = &checked.broken;
    assert_eq!(broken.len(), 1, "{broken:?}");
    assert_eq!((broken[0].frames, broken[0].frame), (1, 1));
    assert!((broken[0].by.to_degrees() - 7.0).abs() < 3.5, "{}", broken[0].by.to_degrees());
}

#[test]
fn documents_and_exchanged_models_keep_the_driver() {
    for text in [elbow(), wrist()] {
        let read = limit::read(text, &mut |_| Err("it stands alone".into())).unwrap().value;
        assert_eq!(limit::write(&read), text);
        let given = read.given().unwrap();
        let q = Quat::from_axis_angle(Vec3::Z, 0.5);
        let driver = match &given.dependence().drivers {
            Drivers::Scalars(_) => Driver::Scalar(0.7),
            Drivers::Rotations(_) => Driver::Rotation(Quat::from_axis_angle(Vec3::X, 0.3)),
        };
        let again = limit::read(&limit::write(&read), &mut |_| Err(String::new())).unwrap().value;
        // To the bit.
        assert_eq!(again.given().unwrap().distance(q, driver), given.distance(q, driver));
        assert!(text.len() < 1_000_000 / 5);
    }
    let model = arm();
    let written = document::write(&model);
    let read = document::read(&written, &mut |_| Err("it stands alone".into())).unwrap();
    let fields = |model: &Model| -> Vec<Law> {
        let laws = model.components().iter().map(|component| component.law.clone());
        laws.filter(|law| matches!(law, Law::Field(_))).collect()
    };
    assert_eq!(fields(&read.value.model), fields(&model));
    assert_eq!(fields(&model).len(), 2);
    let (back, _) = exchange_round(&model);
    assert_eq!(fields(&back).len(), 2);
}

fn exchange_round(model: &Model) -> (Model, usize) {
    let text = exchange::write(model);
    let read = exchange::read(text.as_bytes()).unwrap();
    (read.value, text.len())
}
