//! `condyle constrain`.

use super::Folder;
use serde_json::Value;

/// An elbow that bends from 0 to 100 degrees, and a wrist without limits.
const ARM: &str = r#"
condyle = 1
kind = "model"
angles = "deg"
[segment.forearm]
[segment.hand]
parent = "forearm"
at = [0, -0.25, 0]
[joint.elbow]
type = "hinge"
segment = "forearm"
axis = [0, 0, 1]
coordinates = ["flexion"]
[joint.elbow.coordinate.flexion]
range = [0, 100]
[joint.wrist]
type = "hinge"
segment = "hand"
axis = [0, 0, 1]
coordinates = ["bend"]
"#;

/// Flexion rises from 80 to 119 degrees; `other` is no coordinate.
fn motion() -> String {
    let mut text = String::from(
        "arm\nversion=1\nnRows=40\nnColumns=4\ninDegrees=yes\nendheader\ntime\tflexion\tbend\tother\n",
    );
    for frame in 0..40 {
        text += &format!("{}\t{}\t12.3\t7.77\n", f64::from(frame) / 100.0, 80 + frame);
    }
    text
}

fn rows(text: &str) -> Vec<Vec<f64>> {
    let numbers = |line: &str| line.split('\t').map(|cell| cell.trim().parse().ok()).collect();
    text.lines().filter_map(numbers).filter(|row: &Vec<f64>| row.len() == 4).collect()
}

#[test]
fn a_table_comes_back_with_only_changed_cells_changed() {
    let folder = Folder::new("constrain-table");
    folder.write("arm.toml", ARM);
    folder.write("m.mot", motion());
    let asked = ["constrain", "arm.toml", "m.mot", "-o", "l.mot", "--report", "r.json"];
    let said = folder.condyle(&asked).expect(0);
    assert!(said.contains("m.mot: 19 of 40 frames changed"), "{said}");
    let rows = rows(&folder.read("l.mot"));
    assert_eq!(rows.len(), 40);
    for (frame, row) in rows.iter().enumerate() {
        let flexion = (80.0 + frame as f64).min(100.0);
        assert!((row[1] - flexion).abs() < 1e-9, "{frame}: {row:?}");
        assert_eq!(row[2..], [12.3, 7.77], "{frame}");
        assert!(row[1] == flexion || frame > 20, "{frame}: legal frames stay to the bit");
    }
    let report: Value = serde_json::from_str(&folder.read("r.json")).expect("JSON");
    let broken = &report["violations"][0];
    assert_eq!((&broken["limit"], &broken["frames"]), (&"flexion".into(), &19.into()));
    assert!((broken["by"].as_f64().unwrap() - 19f64.to_radians()).abs() < 1e-9);
    assert_eq!(broken["runs"], serde_json::json!([[21, 39]]));
    assert_eq!(report["remaining"], serde_json::json!([]));
    assert!((report["changes"][0]["mean"].as_f64().unwrap() - 10f64.to_radians()).abs() < 1e-9);
    // What is legal is left alone.
    let again = folder.condyle(&["constrain", "arm.toml", "l.mot", "--json"]).expect(0);
    let again: Value = serde_json::from_str(&again).expect("JSON");
    assert_eq!(again["changed"], 0);
}

#[test]
fn many_motions_go_on_after_a_bad_one_and_are_resumed() {
    let folder = Folder::new("constrain-batch");
    folder.write("arm.toml", ARM);
    folder.write("a.mot", motion());
    folder.write("b.mot", "no motion");
    folder.write("c.mot", motion());
    let alone = folder.condyle(&["constrain", "arm.toml", "a.mot", "c.mot", "-o", "x.mot"]);
    assert!(alone.refused().contains("need a folder"));
    let asked = [
        "constrain",
        "arm.toml",
        "a.mot",
        "b.mot",
        "c.mot",
        "-o",
        "legal/",
        "--resume",
        "--report",
        "r.csv",
    ];
    let run = folder.condyle(&asked);
    assert_eq!(run.code, 2);
    assert!(run.err.contains("1 of 3 motions could not be used: b.mot"), "{}", run.err);
    let table = folder.read("r.csv");
    let cells: Vec<Vec<&str>> = table.lines().map(|line| line.split(',').collect()).collect();
    assert_eq!(cells[1][..7], ["a.mot", "flexion", "range", "19", "21", "39", "39"], "{table}");
    assert_eq!((cells[2][0], cells[2][2], cells[3][0]), ("b.mot", "error", "c.mot"));
    assert_eq!(folder.read("legal/a.mot"), folder.read("legal/c.mot").replace("c\n", "a\n"));
    let again = folder.condyle(&asked);
    assert!(again.err.contains("a.mot: done before and unchanged, skipped"), "{}", again.err);
    assert_eq!(folder.read("r.csv"), table);
}

/// A figure of two joints, its numbers written oddly.
const FIGURE: &str = "HIERARCHY\nROOT Hips\n{\n  OFFSET 0 0 0\n  CHANNELS 6 Xposition Yposition Zposition \
                      Zrotation Xrotation Yrotation\n  JOINT Arm\n  {\n    OFFSET 0 50.0 0\n    CHANNELS 3 \
                      Zrotation Xrotation Yrotation\n    End Site\n    {\n      OFFSET 0 30 0\n    }\n  }\n}\n\
                      MOTION\nFrames: 2\nFrame Time: 0.04\n1.50 90 0 10 0 0 20 0 5\n1.25 90 0 10 0 0 80 0 5\n";

#[test]
fn a_foreign_skeleton_comes_back_with_only_its_bad_joint_changed() {
    let folder = Folder::new("constrain-binding");
    folder.write("figure.bvh", FIGURE);
    let head = "condyle = 1\nkind = \"model\"\nangles = \"deg\"\ninclude = [\"skeleton\"]\n";
    folder.write("range.toml", format!("{head}joint_set.Arm.coordinate.rz.range = [-30, 45]\n"));
    let asked = ["constrain", "range.toml", "figure.bvh", "-o", "legal.bvh", "--length-unit", "cm"];
    let said = folder.condyle(&asked).expect(0);
    assert!(said.contains("1 of 2 frames changed"), "{said}");
    let text = folder.read("legal.bvh");
    let (before, after) = text.split_at(text.find("MOTION").expect("MOTION"));
    assert_eq!(before, &FIGURE[..FIGURE.find("MOTION").unwrap()]);
    let last: Vec<&str> = after.lines().rev().take(2).collect();
    assert_eq!(last[1], "1.5 90 0 10 0 0 20 0 5");
    let numbers: Vec<f64> = last[0].split(' ').map(|cell| cell.parse().unwrap()).collect();
    assert!((numbers[6] - 45.0).abs() < 1e-9, "{numbers:?}");
    assert_eq!(
        (&numbers[..6], &numbers[7..]),
        (&[1.25, 90.0, 0.0, 10.0, 0.0, 0.0][..], &[0.0, 5.0][..])
    );
    // The same with the skeleton of a certain file.
    let named = head.replace("\"skeleton\"", "\"figure.bvh\"");
    folder.write("named.toml", format!("{named}joint_set.Arm.coordinate.rz.range = [-30, 45]\n"));
    let asked = ["constrain", "named.toml", "figure.bvh", "-o", "again.bvh", "--length-unit", "cm"];
    folder.condyle(&asked).expect(0);
    assert_eq!(folder.read("again.bvh"), text);
    // A joint that the skeleton does not have is said with its place.
    folder.write("wrong.toml", format!("{head}joint_set.Arn.coordinate.rz.range = [-30, 45]\n"));
    let refused = folder.condyle(&["constrain", "wrong.toml", "figure.bvh"]).refused();
    assert!(refused.contains("no coordinate `Arn.rz`"), "{refused}");
    assert!(refused.contains("did you mean `Arm.rz`?"), "{refused}");
}

/// Rotations spread evenly over the ball of 60 degrees, but for one of 25 about a turn of 25 degrees about x.
fn rotations() -> String {
    let mut text = "qx,qy,qz,qw\n".to_owned();
    // Drawn in the vector part of quaternions.
    let mut state = 14u64;
    let mut part = || {
        state =
            state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1u64 << 53) as f64 - 0.5
    };
    for _ in 0..12_000 {
        let at = [part(), part(), part()];
        let size = at.iter().map(|v| v * v).sum::<f64>().sqrt();
        let w = (1.0 - size * size).max(0.0).sqrt();
        let half = 12.5f64.to_radians();
        let off = 2.0 * (at[0] * half.sin() + w * half.cos()).abs().min(1.0).acos();
        if size <= 30f64.to_radians().sin() && off > 25f64.to_radians() {
            text += &format!("{},{},{},{w}\n", at[0], at[1], at[2]);
        }
    }
    text
}

#[test]
fn what_nobody_was_recorded_in_is_left_with_strict_only() {
    let folder = Folder::new("constrain-strict");
    folder.write("q.csv", rotations());
    let learn = ["learn", "limits", "q.csv", "-o", "limit.toml", "--mesh", "limit.glb"];
    folder.condyle(&learn).expect(0);
    // A surface is no skeleton, but glTF that can be read.
    let surface = std::fs::read(folder.path().join("limit.glb")).expect("a surface");
    assert!(surface.starts_with(b"glTF") && surface.len() > 100_000);
    folder.write(
        "arm.toml",
        "condyle = 1\nkind = \"model\"\n[segment.arm]\n[joint_set.shoulder.coordinate.swing]\n\
         kind = \"orientation\"\n[joint_set.shoulder.component.seen.field]\norientation = \"swing\"\n\
         file = \"limit.toml\"\n[joint_set.shoulder.component.turn.ball]\norientation = \"seen\"\n\
         [joint_set.shoulder.output]\narm = \"turn\"\n",
    );
    // From rest to 80 degrees about x: through the middle of the hole, and out of the ball.
    let mut text = "time,swing.qx,swing.qy,swing.qz,swing.qw\n".to_owned();
    for frame in 0..=40 {
        let half = f64::from(frame).to_radians();
        text += &format!("{},{},0,0,{}\n", f64::from(frame) * 0.1, half.sin(), half.cos());
    }
    folder.write("m.csv", text);
    let run = |more: &[&str]| -> Value {
        let asked = [&["constrain", "arm.toml", "m.csv", "--json"], more].concat();
        serde_json::from_slice(&folder.condyle(&asked).out).expect("JSON")
    };
    let changed = |report: &Value| report["changed"].as_u64().unwrap();
    let (open, strict) = (run(&[]), run(&["--strict"]));
    // Frames beyond 60 degrees are 31 to 40; those within 25 of the middle 0 to 25.
    assert!((9..=12).contains(&changed(&open)), "{open}");
    assert!(open["violations"].as_array().unwrap().iter().any(|v| v["kind"] == "unseen"), "{open}");
    assert!(changed(&strict) > changed(&open) + 10, "{strict}");
}
