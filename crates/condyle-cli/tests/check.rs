//! The contract of `condyle check`: exit codes, its JSON, and what it finds in real models.

mod command;

use command::{Answer, Folder};
use serde_json::Value;
use std::path::{Path, PathBuf};

/// A shank on a hinge with this range and clamping; angles in radians.
fn hinge(range: &str, clamped: bool) -> String {
    format!(
        "<OpenSimDocument Version=\"40000\"><Model name=\"hinge\">\
         <BodySet><objects><Body name=\"shank\"/></objects></BodySet>\
         <JointSet><objects><PinJoint name=\"knee\">\
         <socket_parent_frame>/ground</socket_parent_frame>\
         <socket_child_frame>/bodyset/shank</socket_child_frame>\
         <coordinates><Coordinate name=\"flexion\"><range>{range}</range>\
         <clamped>{clamped}</clamped></Coordinate></coordinates>\
         </PinJoint></objects></JointSet></Model></OpenSimDocument>\n"
    )
}

/// A motion of the hinge in degrees at 100 Hz.
fn mot(degrees: &[f64]) -> String {
    let mut text = "m\nversion=1\ninDegrees=yes\nendheader\ntime\tflexion\n".to_owned();
    for (frame, value) in degrees.iter().enumerate() {
        text.push_str(&format!("{}\t{value}\n", frame as f64 / 100.0));
    }
    text
}

#[track_caller]
fn text(answer: &Answer, code: i32) -> String {
    let text = String::from_utf8(answer.out.clone()).expect("text");
    assert_eq!(answer.code, code, "{text}{}", answer.err);
    text
}

#[track_caller]
fn json(answer: &Answer, code: i32) -> Value {
    serde_json::from_str(&text(answer, code)).expect("one JSON document")
}

fn codes(answer: &Value) -> Vec<&str> {
    let findings = answer["findings"].as_array().expect("findings");
    findings.iter().map(|f| f["code"].as_str().expect("a code")).collect()
}

#[track_caller]
fn near(found: &Value, expected: f64) {
    let found = found.as_f64().expect("a number");
    assert!((found - expected).abs() < 1e-12, "found {found}, expected {expected}");
}

#[test]
fn nothing_wrong_is_0() {
    let folder = Folder::new("check-sound");
    folder.write("m.osim", hinge("0 2", true)).write("m.mot", mot(&[0.0, 50.0, 100.0]));
    let run = folder.condyle(&["check", "m.osim"]);
    assert_eq!(text(&run, 0), "m.osim: no findings\n");
    let run = folder.condyle(&["check", "m.osim", "m.mot", "--json"]);
    let answer = json(&run, 0);
    assert_eq!(answer["model"], "hinge");
    assert_eq!(answer["findings"], serde_json::json!([]));
    assert_eq!(answer["motion"]["frames"], 3);
    assert_eq!(answer["motion"]["violations"], serde_json::json!([]));
    assert!(json(&folder.condyle(&["check", "m.osim", "--json"]), 0)["motion"].is_null());
}

#[test]
fn notes_do_not_count() {
    let folder = Folder::new("check-note");
    folder.write("m.osim", hinge("-99999.9 99999.9", false));
    let answer = json(&folder.condyle(&["check", "m.osim", "--json"]), 0);
    assert_eq!(codes(&answer), ["lint/dummy-range"]);
    assert_eq!(answer["findings"][0]["severity"], "note");
    let said = text(&folder.condyle(&["check", "m.osim"]), 0);
    assert!(said.starts_with("m.osim: 0 errors, 0 warnings, 1 note\n"), "{said}");
}

#[test]
fn warnings_and_errors_are_1() {
    let folder = Folder::new("check-wrong");
    folder.write("degrees.osim", hinge("-10 140", true));
    let answer = json(&folder.condyle(&["check", "degrees.osim", "--json"]), 1);
    assert_eq!(codes(&answer), ["lint/degrees"]);
    assert_eq!(answer["findings"][0]["subjects"], serde_json::json!(["flexion"]));
    // Enforced limits that cross cannot be posed, but the file was understood.
    folder.write("crossing.osim", hinge("-0.1 -0.4", true));
    let answer = json(&folder.condyle(&["check", "crossing.osim", "--json"]), 1);
    assert_eq!(codes(&answer), ["model/crossing-range"]);
    assert_eq!(answer["findings"][0]["severity"], "error");
    let said = text(&folder.condyle(&["check", "crossing.osim"]), 1);
    assert!(said.contains("error model/crossing-range"), "{said}");
}

#[test]
fn a_motion_outside_is_1_with_every_frame() {
    let folder = Folder::new("check-motion");
    folder.write("m.osim", hinge("0 2", true)).write("m.mot", mot(&[-3.0, 50.0, -5.0, -4.0]));
    let answer = json(&folder.condyle(&["check", "m.osim", "m.mot", "--json"]), 1);
    assert_eq!(codes(&answer), ["motion/outside-range"]);
    let violations = answer["motion"]["violations"].as_array().expect("violations");
    let frames: Vec<u64> = violations.iter().filter_map(|v| v["frame"].as_u64()).collect();
    assert_eq!(frames, [0, 2, 3]);
    let worst = &violations[1];
    assert_eq!(worst["coordinate"], "flexion");
    near(&worst["time"], 0.02);
    near(&worst["value"], -5f64.to_radians());
    near(&worst["by"], 5f64.to_radians());
    near(&worst["limit"], 0.0);
    near(&worst["nearest"], 0.0);
    assert_eq!(worst["source"], "the model's range (enforced)");
    let summary = &answer["motion"]["coordinates"][0];
    assert_eq!(summary["runs"], serde_json::json!([[0, 0], [2, 3]]));
    assert_eq!(summary["worst"], *worst);
    let said = text(&folder.condyle(&["check", "m.osim", "m.mot"]), 1);
    for part in ["m.mot: 4 frames", "f0, f2-3", "-5.00°", "beyond", "(enforced)"] {
        assert!(said.contains(part), "{part}: {said}");
    }
}

#[test]
fn unusable_input_is_2() {
    let folder = Folder::new("check-unusable");
    folder.write("m.osim", hinge("0 2", true)).write("broken.osim", "<Model");
    let nowhere = folder.path().join("nowhere").join("m.osim");
    let nowhere = nowhere.to_str().expect("a name in text");
    let runs: [&[&str]; 5] = [
        &["check"],
        &["check", nowhere],
        &["check", "absent.osim"],
        &["check", "broken.osim"],
        &["check", "m.osim", "absent.mot"],
    ];
    for arguments in runs {
        let run = folder.condyle(arguments);
        assert_eq!((run.code, run.out.len()), (2, 0), "{arguments:?}: {}", run.err);
    }
}

/// The folder of shared data beside the repository; `None` where it is absent.
fn data() -> Option<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data");
    if folder.is_dir() {
        return Some(folder);
    }
    println!("skipped: shared data absent");
    None
}

fn check(folder: &Folder, data: &Path, names: &[&str]) -> Answer {
    let paths: Vec<String> =
        names.iter().map(|name| data.join(name).to_string_lossy().into_owned()).collect();
    let mut arguments = vec!["check"];
    arguments.extend(paths.iter().map(String::as_str));
    arguments.push("--json");
    folder.condyle(&arguments)
}

/// The findings of one rule: subjects and message.
fn of<'a>(answer: &'a Value, code: &str) -> Vec<(Vec<&'a str>, &'a str)> {
    let findings = answer["findings"].as_array().expect("findings").iter();
    findings
        .filter(|f| f["code"] == code)
        .map(|f| {
            let subjects = f["subjects"].as_array().expect("subjects").iter();
            (subjects.filter_map(Value::as_str).collect(), f["message"].as_str().unwrap_or(""))
        })
        .collect()
}

#[test]
fn known_faults_of_real_models() {
    let Some(data) = data() else { return };
    let folder = Folder::new("check-real");
    // Knees to 140°, patellae whose splines end at 2.0944 rad = 120°.
    let answer = json(&check(&folder, &data, &["knee/opencap4/manually_scaled.osim"]), 1);
    let beyond = of(&answer, "lint/beyond-knots");
    assert_eq!(beyond.len(), 2, "{beyond:?}");
    assert_eq!((beyond[0].0[0], beyond[1].0[0]), ("knee_angle_r", "knee_angle_l"));
    for part in ["may reach 140°", "end at 120°", "the last 20° are extrapolated"] {
        assert!(beyond.iter().all(|(_, message)| message.contains(part)), "{part}: {beyond:?}");
    }
    let dummies: Vec<&str> = of(&answer, "lint/dummy-range").iter().map(|(s, _)| s[0]).collect();
    assert_eq!(dummies, ["knee_angle_r_beta", "knee_angle_l_beta"]);
    // The published model that it was scaled from stops at the knots.
    let answer = json(&check(&folder, &data, &["models/osim/Rajagopal2015.osim"]), 0);
    assert_eq!(of(&answer, "lint/beyond-knots"), []);
    assert_eq!(of(&answer, "lint/dummy-range").len(), 2);
    // An ankle of ±90° on the right and ±60° on the left.
    let answer = json(&check(&folder, &data, &["models/osim/gait2354_simbody_std_latest.osim"]), 1);
    let uneven = of(&answer, "lint/uneven-ranges");
    assert_eq!(uneven[0].0, ["ankle_angle_r", "ankle_angle_l"]);
    assert!(uneven[0].1.contains("-90° to 90°") && uneven[0].1.contains("-60° to 60°"));
}

#[test]
fn every_real_model_ends_in_an_answer() {
    let Some(data) = data() else { return };
    let folder = Folder::new("check-all");
    let mut open = vec![data.clone()];
    let (mut read, mut loud) = (0, vec![]);
    while let Some(next) = open.pop() {
        for entry in std::fs::read_dir(next).expect("a folder of the data") {
            let path = entry.expect("an entry").path();
            if path.is_dir() {
                open.push(path);
            } else if path.extension().is_some_and(|e| e == "osim") {
                let name = path.to_string_lossy().into_owned();
                let run = check(&folder, &data, &[&name]);
                // One file of a bug report has a coupler without its function.
                if name.ends_with("opensim-creator_515_repro.osim") {
                    assert_eq!(run.code, 2, "{name}: {}", run.err);
                    continue;
                }
                let answer = json(&run, run.code);
                let counts = |f: &&Value| f["severity"] != "note";
                let wrong = answer["findings"].as_array().expect("findings").iter().filter(counts);
                let wrong = wrong.count();
                assert_eq!(run.code, i32::from(wrong > 0), "{name}");
                read += 1;
                // Of one of them the left hip turns about the axes of the right one, which is said, too.
                if wrong > 3 {
                    loud.push((name, wrong));
                }
            }
        }
    }
    // Official and published models: what counts against them fits on one hand.
    assert!(read >= 40, "{read} models");
    assert!(loud.is_empty(), "{loud:?}");
}

#[test]
fn real_motions_hold_or_say_where_they_do_not() {
    let Some(data) = data() else { return };
    let folder = Folder::new("check-walks");
    // OpenSim's own answer keeps to the clamped ranges of the model that it was computed with.
    let files = [
        "ik/core_subject01/subject01_simbody.osim",
        "ik/core_subject01/std_subject01_walk1_ik.mot",
    ];
    let answer = json(&check(&folder, &data, &files), 0);
    assert_eq!(answer["motion"]["frames"], 73);
    assert_eq!(answer["motion"]["violations"], serde_json::json!([]));
    // A motion of a model that counts flexion of the knee the other way: below 0 in every frame.
    let files = ["models/osim/Rajagopal2015.osim", "sto/gait10dof18musc_ik_CRLF_line_ending.mot"];
    let answer = json(&check(&folder, &data, &files), 1);
    let knee = &answer["motion"]["coordinates"][0];
    assert_eq!((&knee["coordinate"], &knee["frames"]), (&"knee_angle_r".into(), &15.into()));
    assert_eq!(knee["runs"], serde_json::json!([[0, 14]]));
    assert_eq!(knee["worst"]["frame"], 14);
    assert_eq!(knee["worst"]["nearest"], 0.0);
}

#[test]
fn a_text_includes_a_shipped_model_by_name_and_changes_one_limit() {
    let folder = Folder::new("check-include");
    let text = "condyle = 1\nkind = \"model\"\nangles = \"deg\"\ninclude = [\"knee\"]\n\
                [joint_set.knee_r.coordinate]\nknee_angle_r = { range = [-5, 135] }\n";
    folder.write("mine.toml", text);
    let answer = json(&folder.condyle(&["info", "mine.toml", "--json"]), 0);
    near(&answer["coordinates"][0]["range"][1], 135f64.to_radians());
    near(&answer["coordinates"][0]["range"][0], -5f64.to_radians());
    // What it reads and limits is shown: the shin's slide along the thigh follows the angle.
    let shoulder = json(&folder.condyle(&["info", "shoulder", "--json"]), 0);
    let sets = shoulder["networks"].as_array().expect("networks");
    let components: Vec<&Value> =
        sets.iter().flat_map(|set| set["components"].as_array().expect("components")).collect();
    let contact = components.iter().find(|c| c["kind"] == "contact").expect("the scapula's");
    assert_eq!(contact["inputs"]["surface"], "thorax");
    assert!(contact["limit"]["radii"][1].as_f64().expect("metres") > 0.1);
    assert!(components.iter().any(|c| c["kind"] == "cone" && c["limit"]["points"].is_array()));
    let said = text_of(&folder, &["info", "shoulder"]);
    assert!(
        said.contains("limits of several together") && said.contains("bounded from below"),
        "{said}"
    );
}

fn text_of(folder: &Folder, arguments: &[&str]) -> String {
    text(&folder.condyle(arguments), 0)
}

#[test]
fn a_document_that_moves_takes_its_includes_along() {
    let folder = Folder::new("convert-include");
    let part = "condyle = 1\nkind = \"model\"\n[segment.shank]\nparent = \"thigh\"\n";
    let whole = "condyle = 1\nkind = \"model\"\n# the shank is elsewhere\ninclude = [\"parts/shank.toml\"]\n\
                 [segment.thigh]\n";
    folder.write("rig/parts/shank.toml", part).write("rig/leg.toml", whole);
    std::fs::create_dir_all(folder.path().join("other/deep")).expect("a folder");
    assert_eq!(folder.condyle(&["convert", "rig/leg.toml", "other/deep/leg.toml"]).code, 0);
    let moved = std::fs::read_to_string(folder.path().join("other/deep/leg.toml")).expect("a file");
    assert!(moved.contains("include = [\"../../rig/parts/shank.toml\"]"), "{moved}");
    assert!(moved.contains("# the shank is elsewhere"));
    let answer = json(&folder.condyle(&["info", "other/deep/leg.toml", "--json"]), 0);
    assert_eq!(answer["segments"].as_array().expect("segments").len(), 2);
}
