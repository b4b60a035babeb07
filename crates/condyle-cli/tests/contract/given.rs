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
