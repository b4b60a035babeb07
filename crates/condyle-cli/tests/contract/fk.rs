//! `condyle fk`.

use super::{Folder, leg, near, number};
use serde_json::Value;

/// The world transform of a segment in a frame: 16 numbers, row by row.
fn rows(answer: &Value, frame: usize, segment: &str) -> Vec<f64> {
    let list = answer["frames"][frame]["segments"][segment].as_array();
    let rows: Vec<f64> = list.expect("16 numbers").iter().map(number).collect();
    assert_eq!(rows.len(), 16);
    assert_eq!(rows[12..], [0.0, 0.0, 0.0, 1.0]);
    rows
}

/// Asserts that a shank is where its formula says.
#[track_caller]
fn shank_is_at(answer: &Value, frame: usize, h: f64, k: f64) {
    let rows = rows(answer, frame, "shank");
    let [x, y] = leg::shank(h, k, [0.0, 0.0]);
    near(rows[3], x, 1e-14);
    near(rows[7], y, 1e-14);
    near(rows[11], 0.0, 0.0);
    near(rows[0], (h + k).cos(), 1e-14);
    near(rows[1], -(h + k).sin(), 1e-14);
    near(rows[4], (h + k).sin(), 1e-14);
    near(rows[10], 1.0, 0.0);
}

#[test]
fn defaults_without_a_pose() {
    let folder = Folder::with_leg("fk-defaults");
    let answer = folder.condyle(&["fk", "leg.osim"]).json();
    assert_eq!(answer["frames"].as_array().map(Vec::len), Some(1));
    assert_eq!(answer["frames"][0]["time"], 0.0);
    let names: Vec<&String> =
        answer["frames"][0]["segments"].as_object().expect("segments by name").keys().collect();
    assert_eq!(names, ["foot", "shank", "thigh", "toes"]);
    shank_is_at(&answer, 0, 0.0, 0.0);
    // The ankle is locked at 0.1.
    near(rows(&answer, 0, "foot")[4], 0.1f64.sin(), 1e-15);
}

#[test]
fn poses_are_in_radians_and_partial() {
    let folder = Folder::with_leg("fk-poses");
    folder.write("p.json", r#"[{"hip_flexion": 0.7, "knee_angle": -1.1}, {"knee_angle": 0.25}]"#);
    let run = folder.condyle(&["fk", "leg.osim", "--pose", "p.json", "--json"]);
    assert_eq!(run.err, "");
    let answer = run.json();
    assert_eq!(answer["frames"][1]["time"], 1.0);
    shank_is_at(&answer, 0, 0.7, -1.1);
    shank_is_at(&answer, 1, 0.0, 0.25);
}

#[test]
fn values_are_taken_as_given_unless_limits_are_on() {
    let folder = Folder::with_leg("fk-limits");
    folder.write("p.json", r#"{"hip_flexion": 3, "knee_angle": 1, "ankle/flexion": 0.7}"#);
    let off = folder.condyle(&["fk", "leg.osim", "--pose", "p.json"]).json();
    shank_is_at(&off, 0, 3.0, 1.0);
    near(rows(&off, 0, "foot")[4], 4.7f64.sin(), 1e-14);
    let on = folder.condyle(&["fk", "leg.osim", "--pose", "p.json", "--limits", "on"]).json();
    // The hip is clamped at 2, the knee's range is no limit.
    shank_is_at(&on, 0, 2.0, 1.0);
}

#[test]
fn a_coupled_coordinate_follows_whatever_is_asked_for_it() {
    let folder = Folder::with_leg("fk-coupled");
    folder.write("p.json", r#"{"knee_angle": -1, "knee_slide": 0.5}"#);
    let run = folder.condyle(&["fk", "leg.osim", "--pose", "p.json"]);
    assert!(run.err.starts_with("warning: `knee_slide` follows other coordinates"), "{}", run.err);
    assert!(run.err.contains("in 1 of 1 frames"), "{}", run.err);
    shank_is_at(&run.json(), 0, 0.0, -1.0);
    folder.write("p.json", r#"{"knee_angle": -1, "knee_slide": -0.02}"#);
    let run = folder.condyle(&["fk", "leg.osim", "--pose", "p.json"]);
    assert_eq!((run.err.as_str(), run.code), ("", 0));
}

#[test]
fn names_that_lead_nowhere_or_everywhere() {
    let folder = Folder::with_leg("fk-names");
    folder.write("unknown.json", r#"{"knee_angel": 1}"#);
    let said = folder.condyle(&["fk", "leg.osim", "--pose", "unknown.json"]).refused();
    assert_eq!(
        said,
        "error: unknown.json: unknown coordinate `knee_angel` (did you mean `knee_angle`?)\n"
    );
    folder.write("twice.json", r#"[{}, {"flexion": 1}]"#);
    let said = folder.condyle(&["fk", "leg.osim", "--pose", "twice.json"]).refused();
    assert_eq!(
        said,
        "error: twice.json: pose 1: the coordinate name `flexion` is ambiguous: it could be \
         `ankle/flexion`, `toe/flexion`\n"
    );
    folder.write("toe.json", r#"{"toe/flexion": 0.5}"#);
    let answer = folder.condyle(&["fk", "leg.osim", "--pose", "toe.json"]).json();
    near(rows(&answer, 0, "toes")[4], 0.6f64.sin(), 1e-15);
}

#[test]
fn poses_that_are_no_poses() {
    let folder = Folder::with_leg("fk-bad");
    let said = |content: &str| {
        folder.write("p.json", content);
        folder.condyle(&["fk", "leg.osim", "--pose", "p.json"]).refused()
    };
    assert!(said("{\"knee_angle\": \"bent\"}").contains("`knee_angle` is `bent`"));
    assert!(said("7").contains("a pose is an object"));
    assert!(said("{\n\"knee_angle\": }").contains("line 2 column 15"));
    let said = folder.condyle(&["fk", "leg.osim", "--pose", "none.json"]).refused();
    assert!(said.starts_with("error: none.json: No such file"), "{said}");
    let said = folder.condyle(&["fk", "leg.osim", "--pose", "p.json", "--motion", "m.mot"]);
    assert_eq!(said.code, 2);
}

#[test]
fn a_motion_in_degrees_is_the_pose_in_radians() {
    let folder = Folder::with_leg("fk-motion");
    folder.write("m.mot", leg::mot(3)).write("p.json", "{}");
    let run = folder.condyle(&["fk", "leg.osim", "--motion", "m.mot"]);
    let absent = "no column for `knee_slide`, `ankle/flexion`, `toe/flexion`";
    assert!(run.err.contains(absent), "{}", run.err);
    let answer = run.json();
    for frame in 0..3 {
        let t = frame as f64 / 100.0;
        near(number(&answer["frames"][frame]["time"]), t, 0.0);
        shank_is_at(&answer, frame, leg::hip(t), leg::knee(t));
    }
}

#[test]
fn the_answer_goes_where_it_is_sent() {
    let folder = Folder::with_leg("fk-output");
    let printed = folder.condyle(&["fk", "leg.osim", "-o", "-"]).expect(0);
    assert_eq!(folder.condyle(&["fk", "leg.osim", "-o", "new/a.json"]).expect(0), "");
    assert_eq!(folder.read("new/a.json"), printed);
    let left: Vec<_> = std::fs::read_dir(folder.path().join("new")).expect("a folder").collect();
    assert_eq!(left.len(), 1, "no temporary file is left");
}
