//! `condyle convert`.

use super::{Folder, leg, near, number};
use serde_json::Value;

/// Name of each column, and the numbers of each row, of a text with a line `time,...`.
fn csv(text: &str) -> (Vec<&str>, Vec<Vec<f64>>) {
    let mut lines = text.lines().skip_while(|line| line.starts_with('#'));
    let names = lines.next().expect("a line of names").split(',').collect();
    let number =
        |cell: &str| if cell.is_empty() { f64::NAN } else { cell.parse().expect("a number") };
    (names, lines.map(|line| line.split(',').map(number).collect()).collect())
}

/// The JSON chunk of a binary glTF file.
fn gltf(bytes: &[u8]) -> Value {
    assert_eq!(&bytes[..4], b"glTF");
    let length = u32::from_le_bytes(bytes[12..16].try_into().expect("four bytes")) as usize;
    assert_eq!(&bytes[16..20], b"JSON");
    serde_json::from_slice(&bytes[20..20 + length]).expect("JSON")
}

#[test]
fn a_resolved_model_is_a_model() {
    let folder = Folder::with_leg("convert-resolved");
    folder.condyle(&["convert", "leg.osim", "leg.json"]).expect(0);
    assert!(folder.read("leg.json").starts_with("{\n\"condyle_model\": 1,\n"));
    // Written again it is the same to the byte, and it poses as what it was made from.
    folder.condyle(&["convert", "leg.json", "again.json"]).expect(0);
    assert_eq!(folder.read("leg.json"), folder.read("again.json"));
    folder.write("p.json", r#"{"knee_angle": 0.7, "hip_flexion": -0.3}"#);
    let frames = ["leg.osim", "leg.json"]
        .map(|model| folder.condyle(&["fk", model, "--pose", "p.json"]).expect(0));
    assert_eq!(frames[0], frames[1]);
    let info: Value =
        serde_json::from_str(&folder.condyle(&["info", "leg.json", "--json"]).expect(0))
            .expect("JSON");
    assert_eq!((&info["kind"], &info["facing"]), (&"model".into(), &"+x".into()));
    // Poses are JSON, too, and no model; a model is no motion.
    let run = folder.condyle(&["fk", "p.json"]);
    assert!(run.err.contains("the file holds poses, not a model"), "{}", run.err);
    let run = folder.condyle(&["convert", "p.json", "q.json", "--model", "leg.osim"]);
    assert!(run.err.contains("cannot be converted to .json"), "{}", run.err);
}

#[test]
fn with_a_model_a_motion_is_completed() {
    let folder = Folder::with_leg("convert-model");
    folder.write("m.mot", leg::mot(5));
    let run = folder.condyle(&["convert", "m.mot", "m.csv", "--model", "leg.osim"]);
    assert!(run.err.contains("these coordinates keep their defaults"), "{}", run.err);
    assert_eq!(run.expect(0), "");
    let text = folder.read("m.csv");
    let (names, rows) = csv(&text);
    let expected =
        ["time", "hip_flexion", "knee_angle", "knee_slide", "ankle/flexion", "toe/flexion"];
    assert_eq!(names, expected);
    for (frame, row) in rows.iter().enumerate() {
        let t = frame as f64 / 100.0;
        near(row[1], leg::hip(t), 1e-15);
        near(row[2], leg::knee(t), 1e-15);
        near(row[3], 0.02 * leg::knee(t), 1e-15);
        near(row[4], 0.1, 0.0);
    }
    // And back: degrees again, nothing lost.
    let run = folder.condyle(&["convert", "m.csv", "-", "--to", "mot", "--model", "leg.osim"]);
    assert!(run.err.contains("taken as radians, as in all CSV"), "{}", run.err);
    let text = run.expect(0);
    assert!(text.starts_with("m\nversion=1\nnRows=5\nnColumns=6\ninDegrees=yes\n"), "{text}");
    let last: Vec<f64> = text
        .lines()
        .last()
        .map(|line| line.split('\t').map(|c| c.parse().expect("a number")).collect())
        .expect("a row");
    near(last[1], leg::hip(0.04).to_degrees(), 1e-12);
    near(last[3], 0.02 * leg::knee(0.04), 1e-15);
}

#[test]
fn without_a_model_numbers_stay_and_the_unit_is_said() {
    let folder = Folder::new("convert-table");
    folder.write("d.mot", "d\ninDegrees=yes\nendheader\ntime\tknee\n0\t30.5\n");
    folder.condyle(&["convert", "d.mot", "d.csv"]).expect(0);
    assert_eq!(folder.read("d.csv"), "# inDegrees=yes\ntime,knee\n0,30.5\n");
    let text = folder.condyle(&["convert", "d.csv", "-", "--to", "sto"]).expect(0);
    assert!(text.contains("inDegrees=yes\n") && text.ends_with("time\tknee\n0\t30.5\n"), "{text}");
    folder.write("u.mot", "u\nendheader\ntime\tknee\n0\t0.5\n");
    let run = folder.condyle(&["convert", "u.mot", "-", "--to", "mot"]);
    assert!(run.err.starts_with("warning: u.mot: it is not stated whether"), "{}", run.err);
    // What nobody states is not stated in what is written.
    assert!(!run.expect(0).contains("inDegrees"));
    folder.write("r.csv", "time,knee\n0,0.5\n");
    let run = folder.condyle(&["convert", "r.csv", "-", "--to", "mot", "--angles", "rad"]);
    assert_eq!(run.err, "");
    assert!(run.expect(0).contains("inDegrees=no\n"));
}

#[test]
fn scenes_still_and_moving() {
    let folder = Folder::with_leg("convert-scenes");
    folder.write("m.mot", leg::mot(5));
    folder.condyle(&["convert", "leg.osim", "leg.glb"]).expect(0);
    let bytes = std::fs::read(folder.path().join("leg.glb")).expect("a scene");
    assert_eq!(
        u32::from_le_bytes(bytes[8..12].try_into().expect("four bytes")) as usize,
        bytes.len()
    );
    let still = gltf(&bytes);
    assert_eq!(still["animations"].as_array().map_or(0, Vec::len), 0);
    let nodes = still["nodes"].as_array().expect("nodes");
    let node = |name: &str| nodes.iter().find(|n| n["name"] == name).expect(name);
    let translation: Vec<f64> = node("shank")["translation"]
        .as_array()
        .expect("three numbers")
        .iter()
        .map(number)
        .collect();
    near(translation[1], -0.4, 1e-7);
    // The foot stands at its default of 0.1.
    near(number(&node("foot")["rotation"][2]), 0.05f64.sin(), 1e-7);
    let run = folder.condyle(&["convert", "m.mot", "-", "--to", "glb", "--model", "leg.osim"]);
    assert_eq!(run.code, 0, "{}", run.err);
    let moving = gltf(&run.out);
    assert_eq!(moving["animations"].as_array().map(Vec::len), Some(1));
}

#[test]
fn recordings_keep_their_unit_and_tables_are_in_metres() {
    let folder = Folder::new("convert-trc");
    let trc = "PathFileType\t4\t(X/Y/Z)\ta.trc\nDataRate\tNumFrames\tNumMarkers\tUnits\n50\t2\t2\tcm\n\
               Frame#\tTime\tA\t\t\tB\n\n\n1\t0\t1.5\t2\t-3\t\t\t\n2\t0.02\t0\t0\t0.25\t4\t5\t6\n";
    folder.write("a.trc", trc);
    folder.condyle(&["convert", "a.trc", "b.trc"]).expect(0);
    let b = folder.read("b.trc");
    assert!(b.starts_with("PathFileType\t4\t(X/Y/Z)\tb.trc\n"), "{b}");
    assert!(b.contains("\tcm\t"), "{b}");
    assert!(b.ends_with("\n1\t0\t1.5\t2\t-3\t\t\t\n2\t0.02\t0\t0\t0.25\t4\t5\t6\n"), "{b}");
    let table = folder.condyle(&["convert", "a.trc", "-", "--to", "csv"]).expect(0);
    assert_eq!(
        table,
        "time,A.x,A.y,A.z,B.x,B.y,B.z\n0,0.015,0.02,-0.03,,,\n0.02,0,0,0.0025,0.04,0.05,0.06\n"
    );
}

#[test]
fn a_motion_becomes_the_markers_that_would_be_seen() {
    let folder = Folder::with_leg("convert-markers");
    folder.write("m.mot", leg::mot(5));
    folder.condyle(&["convert", "m.mot", "m.trc", "--model", "leg.osim"]).expect(0);
    let text = folder.read("m.trc");
    assert!(text.contains("\n100\t100\t5\t6\tmm\t"), "{text}");
    folder.condyle(&["convert", "m.trc", "m.csv"]).expect(0);
    let text = folder.read("m.csv");
    let (names, rows) = csv(&text);
    assert_eq!(names[..4], ["time", "HIP.x", "HIP.y", "HIP.z"]);
    for (frame, row) in rows.iter().enumerate() {
        let t = frame as f64 / 100.0;
        for index in 0..leg::MARKERS.len() {
            let [x, y] = leg::marker(index, leg::hip(t), leg::knee(t));
            near(row[1 + 3 * index], x, 1e-14);
            near(row[2 + 3 * index], y, 1e-14);
            near(row[3 + 3 * index], 0.0, 0.0);
        }
    }
}

#[test]
fn what_cannot_be_converted_is_told_what_can() {
    let folder = Folder::with_leg("convert-refused");
    folder.write("m.mot", leg::mot(2)).write("a.trc", leg::trc(2, |_, _| true));
    let refused = |arguments: &[&str], sentence: &str| {
        let said = folder.condyle(&[&["convert"], arguments].concat()).refused();
        assert!(said.contains(sentence), "{said}");
        said
    };
    let known = "known are: a motion (.mot, .sto, .csv) to .mot";
    refused(&["leg.osim", "leg.mot"], known);
    refused(&["m.mot", "m.glb"], "without --model a motion cannot be converted to .glb");
    refused(&["m.mot", "m.xyz"], "the ending names no format that can be written");
    let said = refused(&["a.trc", "a.mot", "--model", "leg.osim"], known);
    assert!(said.contains("`condyle track MODEL TRIAL -o OUT` computes motions from recordings"));
    refused(&["m.mot", "-"], "name the format with --to");
    refused(&["readme.txt", "a.mot"], known);
    let bare = leg::osim().replace("<Marker ", "<Remark ").replace("</Marker>", "</Remark>");
    folder.write("bare.osim", bare);
    refused(&["m.mot", "m.trc", "--model", "bare.osim"], "has no markers to record");
}

#[test]
fn key_poses_become_a_motion() {
    let folder = Folder::with_leg("convert-keys");
    folder.write(
        "keys.json",
        r#"[{"time": 1, "hip_flexion": 0, "knee_angle": -1}, {"time": 1.25, "hip_flexion": 1},
            {"time": 2, "hip_flexion": 4, "knee_angle": 0}]"#,
    );
    let keys = ["convert", "keys.json", "-", "--to", "csv", "--model", "leg.osim", "--rate", "20"];
    let run = |more: &[&str]| folder.condyle(&[&keys[..], more].concat()).expect(0);
    let text = run(&["--between", "linear"]);
    let (names, rows) = csv(&text);
    assert_eq!(names[..3], ["time", "hip_flexion", "knee_angle"]);
    assert_eq!(rows.len(), 21);
    for row in &rows {
        let t = row[0] - 1.0;
        near(row[1], 4.0 * t, 1e-14);
        // The second pose does not name the knee; what follows it does so in every frame.
        near(row[2], t - 1.0, 1e-14);
        near(row[3], 0.02 * (t - 1.0), 1e-15);
    }
    // With limits on the hip stops at 2, the end of its range.
    let text = run(&["--between", "linear", "--limits", "on"]);
    csv(&text).1.iter().for_each(|row| near(row[1], (4.0 * (row[0] - 1.0)).min(2.0), 1e-14));
    // A smooth step between the two poses that name the knee: 3 t² - 2 t³.
    let text = run(&[]);
    for row in &csv(&text).1 {
        let t = row[0] - 1.0;
        near(row[2], 3.0 * t * t - 2.0 * t * t * t - 1.0, 1e-14);
    }
}

#[test]
fn key_poses_need_times_that_rise() {
    let folder = Folder::with_leg("convert-no-keys");
    folder.write("m.mot", leg::mot(3));
    let run = |text: &str, rate: &str| {
        folder.write("k.json", text);
        let rate = format!("--rate={rate}");
        folder.condyle(&["convert", "k.json", "o.mot", "--model", "leg.osim", &rate]).refused()
    };
    let said = run(r#"[{"time": 1}, {"time": 1}]"#, "10");
    assert!(said.contains("k.json: pose 1: the time 1 is also that of pose 0"), "{said}");
    let said = run(r#"[{"time": 1}, {"time": 0.5}]"#, "10");
    assert!(said.contains("pose 1: the time 0.5 is before that of pose 0, 1"), "{said}");
    let said = run(r#"[{"time": 1}, {}]"#, "10");
    assert!(said.contains("pose 1: it has no `time` (give seconds)"), "{said}");
    let said = run("[]", "10");
    assert!(said.contains("there are no key poses"), "{said}");
    let said = run(r#"[{"time": 0}, {"time": 1}]"#, "-1");
    assert!(said.contains("-1 frames a second"), "{said}");
    // Without --rate a time is no coordinate.
    let plain = folder.condyle(&["convert", "k.json", "o.mot", "--model", "leg.osim"]).refused();
    assert!(plain.contains("unknown coordinate `time` (times are read with --rate"), "{plain}");
    let motion = ["convert", "m.mot", "o.csv", "--model", "leg.osim", "--rate", "10"];
    let said = folder.condyle(&motion).refused();
    assert!(said.contains("m.mot: --rate is for poses (.json) with times"), "{said}");
}
