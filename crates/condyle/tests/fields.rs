//! Learned limits in models from text to answers. What is learned are balls of rotations, whose distances are
//! known: from 3000 samples and 40 nodes along an edge they are met within two degrees.

use condyle::check::motion;
use condyle::formats::document::{self, limit};
use condyle::formats::exchange;
use condyle::limits::{About, Cloud, Settings, learn};
use condyle::math::{Quat, Vec3};
use condyle::model::component::FieldLimit;
use condyle::model::limit::Limit;
use condyle::tracking::{Request, track};
use condyle::{AngleUnit, Law, Mode, Model, Motion, Pose, Program, Severity, Table, legal, posing};
use std::sync::OnceLock;

/// Rotations of a fixed sequence, uniform (Shoemake 1992).
struct Rotations(u64);

impl Rotations {
    fn unit(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }

    fn next(&mut self) -> Quat {
        let (u, v, w) = (self.unit(), self.unit(), self.unit());
        let (a, b) = ((1.0 - u).sqrt(), u.sqrt());
        let (s, t) = (std::f64::consts::TAU * v, std::f64::consts::TAU * w);
        Quat { x: a * s.sin(), y: a * s.cos(), z: b * t.sin(), w: b * t.cos() }
    }
}

/// The text of a limit: all turns of at most 50 degrees from a turn about x by 20, of which those within 25 of
/// a turn about z by 0 were not seen where there is a hole.
fn ball(hole: bool) -> &'static str {
    static TEXTS: [OnceLock<String>; 2] = [const { OnceLock::new() }; 2];
    TEXTS[usize::from(hole)].get_or_init(|| {
        let mut random = Rotations(11);
        let middle = middle();
        let samples: Vec<Quat> = std::iter::repeat_with(|| random.next())
            .filter(|q| q.angle_to(middle).to_degrees() < 50.0)
            .filter(|q| !hole || q.angle_to(middle).to_degrees() > 25.0)
            .take(3000)
            .collect();
        let cloud = Cloud::gather(&[&samples], 0.0).unwrap();
        let about = About {
            name: "ball".into(),
            child: "humerus".into(),
            reference: Some("thorax".into()),
            source: "a known shape".into(),
            ..About::default()
        };
        let settings = Settings { nodes: 40, ..Settings::default() };
        limit::write(&learn(&cloud, &settings, about).unwrap())
    })
}

fn middle() -> Quat {
    Quat::exp(Vec3::X * 20f64.to_radians())
}

/// A thorax in the world, a scapula and a humerus on it, each a ball joint; the humerus is limited in the thorax.
const SHOULDER: &str = r#"
condyle = 1
kind = "model"
angles = "deg"
mirror = { plane = "z", from = "_r", to = "_l" }
[segment.thorax]
[joint.trunk]
type = "ball"
segment = "thorax"
[segment.scapula_r]
parent = "thorax"
at = [0, 0, 0.2]
[segment.humerus_r]
parent = "scapula_r"
at = [0, 0, 0.05]
[joint.girdle_r]
type = "ball"
segment = "scapula_r"
[joint.arm_r]
type = "ball"
segment = "humerus_r"
[joint_set.limits_r.component.reach.field]
segment = "humerus_r"
reference = "thorax"
file = "limits/ball.toml"
[marker.t1]
segment = "thorax"
at = [0.1, 0, 0]
[marker.t2]
segment = "thorax"
at = [0, 0.1, 0]
[marker.t3]
segment = "thorax"
at = [0, 0, 0.1]
[marker.s1_r]
segment = "scapula_r"
at = [0.1, 0, 0]
[marker.s2_r]
segment = "scapula_r"
at = [0, 0.1, 0]
[marker.s3_r]
segment = "scapula_r"
at = [0, 0, 0.1]
[marker.h1_r]
segment = "humerus_r"
at = [0.1, -0.1, 0]
[marker.h2_r]
segment = "humerus_r"
at = [0, -0.3, 0]
[marker.h3_r]
segment = "humerus_r"
at = [0, -0.2, 0.1]
"#;

fn files(hole: bool) -> impl FnMut(&str) -> Result<String, String> {
    move |path| match path {
        "limits/ball.toml" => Ok(ball(hole).to_owned()),
        other => Err(format!("{other} is not there")),
    }
}

fn read(text: &str, hole: bool) -> Model {
    document::read(text, &mut files(hole)).unwrap_or_else(|error| panic!("{error}")).value.model
}

fn fields(model: &Model) -> Vec<&FieldLimit> {
    let law = |c: &'_ condyle::Component| matches!(c.law, Law::Field(_));
    let components = model.components().iter().filter(|c| law(c));
    components
        .filter_map(|c| match &c.law {
            Law::Field(law) => Some(law),
            _ => None,
        })
        .collect()
}

/// The rotation of the humerus of a side in the thorax.
fn reach(model: &Model, pose: &Pose, side: &str) -> Quat {
    let frame = |name: &str| pose.segment(model.find_segment(name).unwrap()).linear;
    Quat::from_mat3(frame("thorax").transpose() * frame(&format!("humerus_{side}")))
}

/// A posture whose joints are turned at random, by up to so much.
fn posture(model: &Model, random: &mut Rotations, most: f64) -> Vec<f64> {
    let mut stored = model.defaults();
    for q in stored.chunks_mut(4) {
        let turn = random.next().log();
        let turn = turn * (most * random.unit() / turn.norm().max(1e-9));
        q.copy_from_slice(&Quat::exp(turn).to_array());
    }
    stored
}

/// How far outside of the ball a rotation is, in degrees; on the left the mirror image counts.
fn outside(q: Quat, side: &str) -> f64 {
    let q = if side == "l" { Quat { x: -q.x, y: -q.y, ..q } } else { q };
    q.angle_to(middle()).to_degrees() - 50.0
}

#[test]
fn the_nearest_legal_pose_is_within_the_field_of_either_side() {
    let model = read(SHOULDER, false);
    let program = Program::compile(&model);
    assert_eq!(program.measured_limit_rows().len(), 2);
    let (mut pose, mut open) = (Pose::new(&program), Pose::new(&program));
    let mut random = Rotations(5);
    let mut solved = 0;
    for _ in 0..60 {
        let asked = posture(&model, &mut random, 1.2);
        program.evaluate(&asked, Mode::Open, &mut open).unwrap();
        let moved = legal::evaluate(&model, &program, &asked, &mut pose).unwrap();
        solved += usize::from(moved);
        for side in ["r", "l"] {
            let (before, after) = (reach(&model, &open, side), reach(&model, &pose, side));
            let beyond = outside(before, side);
            assert!(outside(after, side) < 2.0, "{}", outside(after, side));
            assert!((0..2).all(|row| pose.limit_row(row) > -1e-6));
            if !moved {
                assert!(beyond < 2.0, "{beyond}");
                assert!(after.angle_to(before) < 1e-9);
            } else if beyond > 2.0 {
                // It ends at the boundary, not deeper.
                assert!(outside(after, side) > -3.0, "{}", outside(after, side));
            }
        }
    }
    assert!(solved > 20, "{solved}");
}

#[test]
fn a_tracked_motion_satisfies_the_field() {
    let model = read(SHOULDER, false);
    let mut random = Rotations(8);
    // A slow motion through and out of the limit, as its markers show it.
    let far = posture(&model, &mut random, 1.5);
    let frames: Vec<Vec<f64>> = (0..40)
        .map(|frame| {
            let part = f64::from(frame) / 39.0;
            far.chunks(4)
                .flat_map(|q| {
                    let q = Quat::from(<[f64; 4]>::try_from(q).unwrap());
                    Quat::exp(q.log() * (1.6 * part)).to_array()
                })
                .collect()
        })
        .collect();
    let times = (0..40).map(|frame| f64::from(frame) / 100.0).collect();
    let given = Motion { times, frames };
    let recording = given.virtual_markers(&model, Mode::Open).unwrap();
    let program = Program::compile(&model);
    let mut pose = Pose::new(&program);
    let mut least = |motion: &Motion| {
        let mut least = f64::INFINITY;
        for frame in &motion.frames {
            program.evaluate(frame, Mode::Open, &mut pose).unwrap();
            least = (0..2).map(|row| pose.limit_row(row)).fold(least, f64::min);
        }
        least
    };
    assert!(least(&given) < -0.2);
    let free = Request { limits: false, ..Request::default() };
    let free = track(&model, &recording, &free, &mut |_, _| {}).unwrap();
    assert!(least(&free.motion()) < -0.2);
    let held = track(&model, &recording, &Request::default(), &mut |_, _| {}).unwrap();
    assert!(least(&held.motion()) > -1e-5, "{}", least(&held.motion()));
    // Frames that are legal as they were recorded are found as they were.
    let first = &held.motion().frames[2];
    let off = first.iter().zip(&given.frames[2]).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    assert!(off < 1e-4, "{off}");
}

#[test]
fn goals_are_met_within_the_field() {
    let text = SHOULDER.replace("mirror = { plane = \"z\", from = \"_r\", to = \"_l\" }\n", "");
    let model = read(&text, false);
    let goals = "condyle = 1\nkind = \"goals\"\nhold = [\"trunk/orientation\", \"girdle_r/orientation\"]\n[orientation.up]\n\
                 segment = \"humerus_r\"\nquaternion = [0, 0, 0.8660254, 0.5]\nweight = 1\n";
    let list = document::goals::read(goals, &mut |_| Err("alone".into())).unwrap().value;
    let posed = posing::pose(&model, &list, None).unwrap();
    let program = Program::compile(&model);
    let mut pose = Pose::new(&program);
    program.evaluate(&posed.answer.coordinates, Mode::Open, &mut pose).unwrap();
    assert!(pose.limit_row(0) > -1e-6);
    let beyond = outside(reach(&model, &pose, "r"), "r");
    assert!(beyond.abs() < 2.5, "{beyond}");
}

#[test]
fn a_motion_is_checked_with_degrees_source_and_nearest() {
    let text = SHOULDER.replace("mirror = { plane = \"z\", from = \"_r\", to = \"_l\" }\n", "");
    let turned = |model: &Model, q: Quat| -> Table {
        let mut frame = model.defaults();
        let arm = model.find_coordinate("arm_r/orientation").unwrap();
        frame[model.stored_range(arm)].copy_from_slice(&q.to_array());
        let motion = Motion { times: vec![0.0, 0.01], frames: vec![model.defaults(), frame] };
        let mut table = motion.to_table(model, "m");
        table.angle_unit = AngleUnit::Radians;
        table.values = motion.frames.concat();
        table
    };
    let model = read(&text, false);
    // 90 degrees from the middle, of 50.
    let check =
        motion::check(&model, &turned(&model, middle() * Quat::exp(Vec3::Y * 90f64.to_radians())));
    let broken = &check.broken[0];
    assert_eq!((broken.frames, broken.frame), (1, 1));
    assert!((broken.by.to_degrees() - 40.0).abs() < 3.0, "{}", broken.by.to_degrees());
    let nearest: [f64; 4] = broken.nearest[0].valid[..].try_into().unwrap();
    assert!(outside(Quat::from(nearest), "r").abs() < 2.0);
    let said = &check.findings[0];
    assert_eq!((said.severity, said.code), (Severity::Error, "motion/outside-limit"));
    assert!(said.message.starts_with("field `reach` (a known shape) is broken in 1 frame"));

    // In the hole nothing is broken, but noted; where holes are closed it is.
    let model = read(&text, true);
    let unseen = turned(&model, middle());
    let check = motion::check(&model, &unseen);
    assert!(check.broken.is_empty());
    let note = check.findings.iter().find(|said| said.code == "motion/unknown").unwrap();
    assert_eq!(note.severity, Severity::Note);
    assert!((check.unseen[0].by.to_degrees() - 25.0).abs() < 6.0, "{}", check.unseen[0].by);
    let closed = text.replace("[marker.t1]", "holes = \"closed\"\n[marker.t1]");
    let model = read(&closed, true);
    assert_eq!(motion::check(&model, &unseen).broken.len(), 1);
}

#[test]
fn the_default_posture_outside_is_said() {
    // Axes of the humerus that are turned by 90 degrees: the default is 72 from the middle at the least.
    let turned = SHOULDER.replace("[marker.t1]", "in_segment = [90, 0, 0]\n[marker.t1]");
    let said = |text: &str| -> Vec<String> {
        let findings = condyle::check::check(&read(text, false), &[]);
        let own = findings.iter().filter(|said| said.code == "lint/outside-at-rest");
        own.map(|said| said.message.clone()).collect()
    };
    let found = said(&turned);
    assert_eq!(found.len(), 2, "{found:?}");
    assert!(found[0].starts_with("field `reach` does not allow the default posture, by"));
    assert!(said(SHOULDER).is_empty());
}

#[test]
fn nothing_is_lost_in_text_and_json() {
    let text = SHOULDER.replace(
        "[marker.t1]",
        "in_segment = [10, 20, 30]\nin_reference = [0, 0.6, 0, 0.8]\n[marker.t1]",
    );
    let model = read(&text, true);
    let [right, left] = fields(&model)[..] else { panic!("two sides") };
    assert!(right.mirrored.is_none() && left.mirrored.is_some());
    assert!(std::sync::Arc::ptr_eq(&right.limit, &left.limit));
    let same = |again: &Model| {
        assert_eq!(fields(again), fields(&model));
        let q = Rotations(3).next().to_array();
        for (a, b) in fields(again).iter().zip(fields(&model)) {
            assert_eq!(a.rows_at(&q)[0], b.rows_at(&q)[0]);
        }
    };
    let written = document::write(&model);
    let again = document::read(&written, &mut |_| Err("alone".into())).unwrap().value.model;
    same(&again);
    assert_eq!(document::write(&again), written);
    let json = exchange::write(&model);
    same(&exchange::read(json.as_bytes()).unwrap().value);
    assert_eq!(document::includes(&text)[0].1, "limits/ball.toml");
}

#[test]
fn what_is_wrong_with_a_field_is_said() {
    let errors = |text: &str| -> String {
        let errors = document::read(text, &mut files(false)).unwrap_err();
        errors.iter().map(|said| format!("{said}\n")).collect()
    };
    for (old, new, said) in [
        (
            "segment = \"humerus_r\"\nreference",
            "segment = \"humrus_r\"\nreference",
            "(did you mean `humerus_r`?)",
        ),
        ("reference = \"thorax\"\n", "reference = \"torax\"\n", "(did you mean `thorax`?)"),
        (
            "file = \"limits/ball.toml\"",
            "file = \"bal.toml\"",
            "`bal.toml` cannot be read: bal.toml is not there",
        ),
        ("file = \"limits/ball.toml\"", "", "has no `file`"),
        ("segment = \"humerus_r\"\nreference = \"thorax\"\n", "", "has no `segment`"),
        (
            "file = \"limits/ball.toml\"",
            "file = \"limits/ball.toml\"\nin_segment = [0, 0, 0, 2]",
            "has length 2, not 1",
        ),
        (
            "file = \"limits/ball.toml\"",
            "file = \"limits/ball.toml\"\nholes = \"shut\"",
            "unknown value `shut` of `holes`",
        ),
    ] {
        assert!(SHOULDER.contains(old), "{old}");
        let found = errors(&SHOULDER.replacen(old, new, 1));
        assert!(found.contains(said), "{new}: {found}");
    }
    // A file of another kind.
    let found = document::read(SHOULDER, &mut |_| Ok("condyle = 1\nkind = \"names\"\n".into()));
    assert!(
        found.unwrap_err().to_string().contains("this is a document of kind `names`, not a limit")
    );
}
