//! `condyle learn limits --given`, and what is asked of a limit that depends on another joint.

use super::{Folder, near, number};
use serde_json::Value;
use std::fmt::Write as _;

/// Quaternions of turns about z and an angle on which they depend: from 0 to 30 degrees and half of it.
fn table(degrees: bool) -> String {
    let name = if degrees { "elbow_deg" } else { "elbow" };
    let mut text = format!("qx,qy,qz,qw,{name}\n");
    for index in 0..3000u32 {
        // Fractional parts of multiples of the golden ratio and of the root of 2: even over a square.
        let [a, b] = [0.618_033_988_75, 0.414_213_562_37].map(|g| (f64::from(index) * g).fract());
        let elbow = 100.0 * a;
        let half = (0.5 * (30.0 + 0.4 * elbow) * b).to_radians();
        let elbow = if degrees { elbow } else { elbow.to_radians() };
        let _ = writeln!(text, "0,0,{},{},{elbow}", half.sin(), half.cos());
    }
    text
}

#[test]
fn a_limit_follows_what_it_depends_on() {
    let folder = Folder::new("limits-given");
    folder.write("cloud.csv", table(true));
    let learn = ["learn", "limits", "cloud.csv", "--given", "elbow", "-o", "L.toml", "--report"];
    folder.condyle(&[&learn[..], &["R.json"]].concat()).expect(0);
    let report: Value = serde_json::from_str(&folder.read("R.json")).unwrap();
    assert_eq!(report["given"]["hinge"], true);
    assert!(number(&report["given"]["bins"][0]["samples"]) > 100.0);

    let mut asked = "qx,qy,qz,qw,elbow\n".to_owned();
    // 50 degrees: too much at an angle of 0 by 20, within the limit at 100 degrees by 20, unknown at 300.
    let half = 25f64.to_radians();
    for elbow in ["0", "1.7453", "5.2", ""] {
        let _ = writeln!(asked, "0,0,{},{},{elbow}", half.sin(), half.cos());
    }
    folder.write("asked.csv", asked);
    let told = folder.condyle(&["limits", "query", "L.toml", "asked.csv", "--json"]).expect(0);
    let told: Value = serde_json::from_str(&told).unwrap();
    let rows = &told["rotations"];
    assert_eq!(rows[0]["state"], "invalid");
    near(number(&rows[0]["distance_deg"]), -20.0, 1.0);
    assert_eq!(rows[1]["state"], "valid");
    near(number(&rows[1]["distance_deg"]), 20.0, 1.0);
    assert_eq!(rows[2]["state"], "unknown");
    assert!(rows[3].is_null());
    // The nearest at an angle of 0 is turned by 30 degrees.
    near(number(&rows[0]["nearest"][2]), 15f64.to_radians().sin(), 0.01);

    // Without the driver's column nothing can be said.
    folder.write("bare.csv", "qx,qy,qz,qw\n0,0,0,1\n");
    let said = folder.condyle(&["limits", "query", "L.toml", "bare.csv"]).refused();
    assert!(said.contains("elbow_deg"), "{said}");
    let said = folder.condyle(&["limits", "report", "L.toml"]).expect(0);
    assert!(said.contains("given elbow:"), "{said}");
}

#[test]
fn a_table_in_radians_says_the_same() {
    let folder = Folder::new("limits-given-units");
    folder.write("radians.csv", table(false));
    folder.write("degrees.csv", table(true));
    let bins = |file: &str| {
        let limit = format!("{file}.toml");
        let report = format!("{file}.json");
        let learn =
            ["learn", "limits", file, "--given", "elbow", "-o", &limit, "--report", &report];
        folder.condyle(&learn).expect(0);
        let report: Value = serde_json::from_str(&folder.read(&report)).unwrap();
        number(&report["given"]["bins"][2]["share"])
    };
    near(bins("radians.csv"), bins("degrees.csv"), 1e-3);
    let learn = ["learn", "limits", "radians.csv", "--given", "knee", "-o", "x.toml"];
    let said = folder.condyle(&learn).refused();
    assert!(said.contains("`knee`"), "{said}");
}

/// An arm in the plane: the forearm bends by an angle, the hand turns by another that depends on it.
const ARM: &str = r#"
condyle = 1
kind = "model"
angles = "deg"
[segment.upper]
[segment.forearm]
parent = "upper"
at = [0, -0.3, 0]
[segment.hand]
parent = "forearm"
at = [0, -0.25, 0]
[joint_set.elbow.coordinate.elbow]
[joint_set.elbow.component.bend.rotate]
angle = "elbow"
axis = [0, 0, 1]
[joint_set.elbow.output]
forearm = ["bend"]
[joint_set.wrist.coordinate.turn]
[joint_set.wrist.component.turning.rotate]
angle = "turn"
axis = [0, 0, 1]
[joint_set.wrist.output]
hand = ["turning"]
[joint_set.wrist.component.held.field]
segment = "hand"
reference = "forearm"
driver = "elbow.elbow"
file = "L.toml"
[marker.F1]
segment = "forearm"
at = [0.03, -0.1, 0]
[marker.F2]
segment = "forearm"
at = [-0.02, -0.2, 0.02]
[marker.H1]
segment = "hand"
at = [0.02, -0.08, 0]
[marker.H2]
segment = "hand"
at = [-0.02, -0.05, 0.03]
"#;

/// Degrees that the hand may turn by at an angle of the elbow in degrees, as `table` draws it.
fn most(elbow: f64) -> f64 {
    30.0 + 0.4 * elbow
}

fn arm(name: &str) -> Folder {
    let folder = Folder::new(name);
    folder.write("cloud.csv", table(true)).write("arm.toml", ARM);
    folder.condyle(&["learn", "limits", "cloud.csv", "--given", "elbow", "-o", "L.toml"]).expect(0);
    folder
}

/// Columns of a table by the ends of their names, after the line that starts with `time`.
fn columns(text: &str, names: [&str; 2]) -> Vec<[f64; 2]> {
    let mut lines = text.lines().skip_while(|line| !line.starts_with("time"));
    let separator = |line: &str| if line.contains('\t') { '\t' } else { ',' };
    let head = lines.next().expect("a line of names");
    let at = names.map(|name| {
        let found = head.split(separator(head)).position(|own| own.trim().ends_with(name));
        found.expect("a column")
    });
    let cells = |line: &str| -> Vec<f64> {
        line.split(separator(line)).map(|cell| cell.trim().parse().expect("a number")).collect()
    };
    lines.map(cells).map(|row| at.map(|at| row[at])).collect()
}

#[test]
fn a_motion_is_constrained_by_what_its_driver_allows() {
    let folder = arm("given-constrain");
    let mut motion = String::from(
        "arm\nversion=1\nnRows=21\nnColumns=3\ninDegrees=yes\nendheader\ntime\telbow\tturn\n",
    );
    for frame in 0..21u32 {
        let _ = writeln!(motion, "{}\t{}\t60", f64::from(frame) / 20.0, 5 * frame);
    }
    folder.write("m.mot", motion);
    let said = folder.condyle(&["check", "arm.toml", "m.mot"]).expect(1);
    assert!(said.contains("`held`"), "{said}");
    folder.condyle(&["constrain", "arm.toml", "m.mot", "-o", "l.mot"]).expect(0);
    let rows = columns(&folder.read("l.mot"), ["elbow", "turn"]);
    assert_eq!(rows.len(), 21);
    for (frame, [elbow, turn]) in rows.into_iter().enumerate() {
        // 60 degrees are allowed from an angle of 75 on; the limit is learned to within a degree.
        assert!(turn < most(elbow) + 1.0, "{frame}: {elbow} {turn}");
        let given = [5.0 * frame as f64, 60.0];
        match frame {
            0..12 => {
                // As little as it takes: what is too much, over the root of 1 + 0.4², along both.
                let by = (given[1] - most(given[0])) / 1.16f64.sqrt();
                near((elbow - given[0]).hypot(turn - given[1]), by, 2.0);
            }
            17.. => assert_eq!([elbow, turn], given, "what is legal stays to the bit"),
            _ => {}
        }
    }
    folder.condyle(&["check", "arm.toml", "l.mot"]).expect(0);
}

#[test]
fn poses_and_tracked_motions_keep_what_a_driver_allows() {
    let folder = arm("given-pose");
    // Rotations are about z: their first column is cos, sin.
    let angles = |answer: &Value| {
        let angle = |segment: &str| {
            let rows = &answer["frames"][0]["segments"][segment];
            number(&rows[4]).atan2(number(&rows[0])).to_degrees()
        };
        [angle("forearm"), angle("hand") - angle("forearm")]
    };
    folder.write("p.json", r#"{"elbow": 0.5, "turn": 1.3}"#);
    let off = folder.condyle(&["fk", "arm.toml", "--pose", "p.json"]).json();
    let [elbow, turn] = angles(&off);
    near(elbow, 0.5f64.to_degrees(), 1e-9);
    near(turn, 1.3f64.to_degrees(), 1e-9);
    let on = folder.condyle(&["fk", "arm.toml", "--pose", "p.json", "--limits", "on"]).json();
    let [elbow, turn] = angles(&on);
    // 41.5 degrees are allowed there: the legal pose is on the limit, which is learned to within a degree.
    near(turn, most(elbow), 1.0);

    // Markers of a hand that turns by 60 degrees at an elbow of 10, where 34 are allowed.
    let (elbow, turn) = (10f64.to_radians(), 60f64.to_radians());
    let turned = |angle: f64, [x, y, z]: [f64; 3]| {
        let (s, c) = angle.sin_cos();
        [c * x - s * y, s * x + c * y, z]
    };
    let add = |a: [f64; 3], b: [f64; 3]| [a[0] + b[0], a[1] + b[1], a[2] + b[2]];
    let joint = [0.0, -0.3, 0.0];
    let wrist = add(joint, turned(elbow, [0.0, -0.25, 0.0]));
    let places = [
        add(joint, turned(elbow, [0.03, -0.1, 0.0])),
        add(joint, turned(elbow, [-0.02, -0.2, 0.02])),
        add(wrist, turned(elbow + turn, [0.02, -0.08, 0.0])),
        add(wrist, turned(elbow + turn, [-0.02, -0.05, 0.03])),
    ];
    let mut text = "PathFileType\t4\t(X/Y/Z)\tm.trc\n\
         DataRate\tCameraRate\tNumFrames\tNumMarkers\tUnits\tOrigDataRate\tOrigDataStartFrame\tOrigNumFrames\n\
         100\t100\t3\t4\tm\t100\t1\t3\n\
         Frame#\tTime\tF1\t\t\tF2\t\t\tH1\t\t\tH2\t\t\n\
         \t\tX1\tY1\tZ1\tX2\tY2\tZ2\tX3\tY3\tZ3\tX4\tY4\tZ4\n\n"
        .to_owned();
    for frame in 0..3u32 {
        let _ = write!(text, "{}\t{}", frame + 1, f64::from(frame) / 100.0);
        for number in places.as_flattened() {
            let _ = write!(text, "\t{number}");
        }
        text.push('\n');
    }
    folder.write("m.trc", text);
    let tracked = |limits: &str| {
        let asked = ["track", "arm.toml", "m.trc", "-o", "w.mot", "--limits", limits];
        folder.condyle(&asked).expect(0);
        columns(&folder.read("w.mot"), ["elbow", "turn"])
    };
    for [elbow, turn] in tracked("off") {
        near(elbow, 10.0, 0.01);
        near(turn, 60.0, 0.01);
    }
    for [elbow, turn] in tracked("on") {
        assert!(turn < most(elbow) + 1.0 && turn > 30.0, "{elbow} {turn}");
    }
}

#[test]
fn a_driver_in_metres_is_told_in_millimetres() {
    let folder = Folder::new("limits-given-metres");
    let metres = table(false).replace(",elbow\n", ",slide_m\n");
    folder.write("cloud.csv", metres);
    let learn = ["learn", "limits", "cloud.csv", "--given", "slide", "-o", "L.toml"];
    let said = folder.condyle(&learn).expect(0);
    // Eight values from 0 to 1.745 m: the second is at a seventh.
    assert!(said.contains("249.3 mm") && !said.contains("14.3°"), "{said}");
    assert!(folder.read("L.toml").contains("unit = \"m\""));
    let told = folder.condyle(&["limits", "report", "L.toml"]).expect(0);
    assert!(told.contains("249.3 mm"), "{told}");
    let told = folder.condyle(&["limits", "report", "L.toml", "--json"]).json();
    assert_eq!(told["given"]["unit"], "m");
}
