//! Poses of the shipped human by goals: what is asked holds, measured on the pose by itself, and ranges
//! are kept. The documents of `docs/posing.md` and the example.

use condyle::formats::document::goals::{self, GoalList};
use condyle::math::{Quat, Vec3};
use condyle::posing::{By, Posed, pose};
use condyle::{Mode, Model, Pose, Program, open};
use std::path::Path;

fn human() -> Model {
    open::model(Path::new("human")).unwrap().value
}

fn read(text: &str) -> GoalList {
    goals::read(text, &mut |_| Err("it stands alone".into())).unwrap().value
}

fn asked(inside: &str) -> GoalList {
    read(&format!("condyle = 1\nkind = \"goals\"\n{inside}"))
}

/// The evaluated pose, after a look at all ranges.
fn evaluated(model: &Model, posed: &Posed) -> Pose {
    let program = Program::compile(model);
    let mut pose = Pose::new(&program);
    program.evaluate(&posed.answer.coordinates, Mode::Open, &mut pose).unwrap();
    for id in model.coordinate_ids() {
        let (value, range) =
            (model.value(&posed.answer.coordinates, id), model.coordinate(id).range);
        assert!(range.distance(value) >= 0.0, "{} at {value}", model.coordinate_key(id));
    }
    for row in 0..program.limit_row_len() {
        // What counts as met, in metres or radians, and as much again.
        assert!(pose.limit_row(row) > -3e-6, "limit {row}: {}", pose.limit_row(row));
    }
    pose
}

fn marker(model: &Model, pose: &Pose, name: &str) -> Vec3 {
    let marker = model.markers().iter().find(|m| m.name == name).unwrap();
    pose.frame(marker.segment) * marker.point
}

fn degrees(model: &Model, posed: &Posed, name: &str) -> f64 {
    model.value(&posed.answer.coordinates, model.find_coordinate(name).unwrap()).to_degrees()
}

#[test]
fn the_example_puts_a_hand_on_the_other_shoulder() {
    let human = human();
    let path = Path::new(env!("CARGO_MANIFEST_DIR"));
    let path = path.join("../../examples/goals/hand-on-shoulder.toml");
    let posed = pose(&human, &open::goals(&path).unwrap().value, None).unwrap();
    assert!(posed.answer.is_met(), "{:?}", posed.answer.misses);
    let now = evaluated(&human, &posed);
    let scapula = human.find_segment("scapula_l").unwrap();
    let place = now.segment(scapula) * Vec3::new(0.0, 0.03, 0.0);
    assert!((marker(&human, &now, "RFIN") - place).norm() < 2e-6);
    let program = Program::compile(&human);
    let mut rest = Pose::new(&program);
    program.evaluate(&posed.goals.rest.pose, Mode::Open, &mut rest).unwrap();
    for name in ["r_calc", "r_toe", "L_calc", "L_toe"] {
        let off = marker(&human, &now, name) - marker(&human, &rest, name);
        assert!(off.norm() < 2e-6, "{name}: {off:?}");
    }
    // An arm that crosses the chest is bent and raised a little; nothing else folds up.
    let elbow = degrees(&human, &posed, "elbow_flex_r");
    assert!((80.0..143.0).contains(&elbow), "{elbow}");
    let bent =
        0.75 * degrees(&human, &posed, "trunk_flexion") + degrees(&human, &posed, "lumbar_flexion");
    assert!(bent.abs() < 25.0, "{bent}");
    // The left hand has nothing to do.
    let wrist = human.find_coordinate("wrist_flex_l").unwrap();
    assert_eq!(posed.answer.by[wrist.index()], By::Rest);
    // At rest it is extended by 12 degrees.
    assert!((degrees(&human, &posed, "wrist_flex_l") + 12.0).abs() < 1e-9);
}

#[test]
fn eyes_look_at_a_point_and_hands_reach_behind_the_back() {
    let human = human();
    let text = "hold = \"pelvis_*\"\n[look.eyes]\nsegment = \"skull\"\naxis = [1, 0, 0]\n\
                through = [0.08, 0.06, 0]\nat = [1.0, 1.2, 0.7]";
    let posed = pose(&human, &asked(text), None).unwrap();
    assert!(posed.answer.is_met(), "{:?}", posed.answer.misses);
    let now = evaluated(&human, &posed);
    let skull = now.segment(human.find_segment("skull").unwrap());
    let line = Vec3::new(1.0, 1.2, 0.7) - skull * Vec3::new(0.08, 0.06, 0.0);
    let sight = skull.linear * Vec3::X;
    assert!(sight.cross(line.normalized()).norm() < 1e-8 && sight.dot(line) > 0.0);
    let elbow = human.find_coordinate("elbow_flex_r").unwrap();
    let rest = human.value(&posed.goals.rest.pose, elbow);
    assert_eq!(human.value(&posed.answer.coordinates, elbow), rest, "arms are at rest");
    assert!((rest - 12f64.to_radians()).abs() < 1e-15);
    // 12 cm behind the sacrum, where a hand gets with the shoulder turned inward.
    let text = "hold = \"pelvis_*\"\n[point.hand]\npoint = \"RFIN\"\nat = [-0.25, 1.1, 0.05]";
    let posed = pose(&human, &asked(text), None).unwrap();
    let now = evaluated(&human, &posed);
    assert!(posed.answer.is_met(), "{:?}", posed.answer.misses);
    let hand = marker(&human, &now, "RFIN");
    assert!((hand - Vec3::new(-0.25, 1.1, 0.05)).norm() < 1e-8);
}

#[test]
fn a_place_out_of_reach_is_pointed_at() {
    let human = human();
    let text = "hold = [\"pelvis_*\", \"trunk_*\", \"lumbar_*\", \"thoracic_*\"]\n[point.hand]\npoint = \"RFIN\"\n\
                at = [2.0, 1.3, 0.2]";
    let posed = pose(&human, &asked(text), None).unwrap();
    assert!(!posed.answer.is_met());
    let now = evaluated(&human, &posed);
    let hand = marker(&human, &now, "RFIN");
    let missed = (hand - Vec3::new(2.0, 1.3, 0.2)).norm();
    assert!((missed - posed.answer.misses[0].off).abs() < 1e-12);
    // An arm of 0.6 to 0.8 m from a shoulder that is 0.05 m before to behind the hips.
    assert!((1.1..1.5).contains(&missed), "{missed}");
    assert!(degrees(&human, &posed, "elbow_flex_r") < 5.0, "the elbow is straight");
    assert!(posed.answer.by.contains(&By::Limit));
}

#[test]
fn places_that_legal_poses_reach_are_reached() {
    let human = human();
    let program = Program::compile(&human);
    let mut at = Pose::new(&program);
    let mut seed = 1_u64;
    // Knuth's linear congruential numbers, from 0 to 1.
    let mut drawn = || {
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (seed >> 11) as f64 / (1_u64 << 53) as f64
    };
    let mut missed = vec![];
    for trial in 0..4 {
        // Anywhere within the ranges; both hands, a foot and the head turned as it is are asked for.
        let mut stored = human.defaults();
        for id in human.coordinate_ids() {
            let (lower, upper) = human.coordinate(id).range.bounds();
            if lower.is_finite() && upper.is_finite() {
                *human.value_mut(&mut stored, id) = lower + (upper - lower) * drawn();
            }
        }
        program.evaluate(&stored, Mode::Posed, &mut at).unwrap();
        let goals: String = ["RFIN", "LFIN", "r_toe"]
            .map(|name| {
                let p = marker(&human, &at, name);
                let p = format!("[{}, {}, {}]", p.x, p.y, p.z);
                format!("[point.{name}]\npoint = \"{name}\"\nat = {p}\n")
            })
            .concat();
        let skull = at.segment(human.find_segment("skull").unwrap()).linear;
        let [x, y, z, w] = Quat::from_mat3(skull).to_array();
        let turn = format!("segment = \"skull\"\nquaternion = [{x}, {y}, {z}, {w}]\n");
        let list = asked(&format!("hold = \"pelvis_*\"\n{goals}[orientation.skull]\n{turn}"));
        let posed = pose(&human, &list, None).unwrap();
        evaluated(&human, &posed);
        if !posed.answer.is_met() {
            missed.push((trial, posed.answer.misses));
        }
    }
    assert!(missed.is_empty(), "{missed:?}");
}

#[test]
fn a_pose_is_at_rest_without_goals_and_where_it_is_already() {
    let human = human();
    let posed = pose(&human, &asked(""), None).unwrap();
    assert_eq!(posed.answer.coordinates, posed.goals.rest.pose);
    assert!(posed.answer.is_met() && posed.answer.rest == 0.0);
    // The answer of goals is the rest of the same goals.
    let list = asked("hold = \"pelvis_*\"\n[point.hand]\npoint = \"RFIN\"\nat = [0.3, 1.2, 0.1]");
    let first = pose(&human, &list, None).unwrap();
    let again = pose(&human, &list, Some(&first.answer.coordinates)).unwrap();
    for (a, b) in first.answer.coordinates.iter().zip(&again.answer.coordinates) {
        assert!((a - b).abs() < 1e-9, "{a} {b}");
    }
}

#[test]
fn unknown_names_are_placed_and_said_at_once() {
    let list = asked(
        "hold = [\"pelvsi_tx\", \"wing_*\"]\n[point.hand]\npoint = \"RFNI\"\n\
         at = { segment = \"scapla_l\", at = [0, 0, 0] }\n[coordinate.elbow_flx_r]\nvalue = 1",
    );
    let error = pose(&human(), &list, None).unwrap_err();
    let said: Vec<String> = error.iter().map(ToString::to_string).collect();
    let expected = [
        "line 3, column 9: unknown coordinate `pelvsi_tx` (did you mean `pelvis_tx`?)",
        "line 3, column 22: no coordinate fits `wing_*` (`condyle info MODEL` lists them)",
        "line 5, column 9: unknown marker `RFNI` (did you mean `RFIN`?)",
        "line 6, column 18: unknown segment `scapla_l` (did you mean `scapula_l`?)",
        "line 7, column 13: unknown coordinate `elbow_flx_r` (did you mean `elbow_flex_r`?)",
    ];
    assert_eq!(said, expected);
}

#[test]
fn the_documents_of_the_manual_are_read() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/posing.md");
    let page = std::fs::read_to_string(path).unwrap();
    let texts: Vec<&str> =
        page.split("```toml\n").skip(1).map(|t| t.split("```").next().unwrap()).collect();
    let list = read(texts[0]);
    assert_eq!((texts.len(), list.goals.len()), (1, 7));
    let human = human();
    let posed = pose(&human, &list, None).unwrap();
    assert!(posed.answer.is_met(), "{:?}", posed.answer.misses);
    evaluated(&human, &posed);
    // The keys of the page are poses of the human.
    let json = page.split("```json\n").nth(1).unwrap().split("```").next().unwrap();
    let keys = condyle::formats::poses::read(json.as_bytes()).unwrap().value.keys(&human).unwrap();
    assert_eq!(keys.times, [0.0, 0.5, 2.0]);
}
