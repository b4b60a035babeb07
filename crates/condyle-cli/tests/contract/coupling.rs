//! `condyle learn coupling`.

use super::{Folder, near, number};
use serde_json::Value;
use std::fmt::Write as _;

/// A fixed sequence of numbers between -1 and 1.
struct Numbers(u64);

impl Numbers {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (self.0 >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }
}

/// Ten trials in degrees and metres: `knee_tx` is -0.42 + 0.035·flexion - 0.02·rotation, but for 0.1 mm; `knee_tz` is noise.
fn trials(folder: &Folder, ending: &str) -> Vec<String> {
    let mut numbers = Numbers(3);
    let mut names = vec![];
    for trial in 0..10 {
        let start = 3.0 * numbers.next();
        let degrees = if ending == "mot" { 1f64.to_degrees() } else { 1.0 };
        let mut text = String::new();
        let columns = ["time", "flexion", "rotation", "knee_tx", "knee_tz"];
        if ending == "mot" {
            text.push_str("trial\nversion=1\nnRows=60\nnColumns=5\ninDegrees=yes\nendheader\n");
            let _ = writeln!(text, "{}", columns.join("\t"));
        } else {
            let _ = writeln!(text, "{}", columns.join(","));
        }
        for frame in 0..60 {
            let t = 0.1 * f64::from(frame) + start;
            let (a, b) = (0.6 + 0.5 * t.sin(), 0.1 * (1.7 * t).cos() + 0.02 * numbers.next());
            let tx = -0.42 + 0.035 * a - 0.02 * b + 1e-4 * numbers.next();
            let cells =
                [0.01 * f64::from(frame), degrees * a, degrees * b, tx, 0.01 * numbers.next()];
            let cells: Vec<String> = cells.iter().map(f64::to_string).collect();
            let _ = writeln!(text, "{}", cells.join(if ending == "mot" { "\t" } else { "," }));
        }
        let name = format!("{}_{trial}.{ending}", if trial < 5 { "gait" } else { "crouch" });
        folder.write(&name, text);
        names.push(name);
    }
    names
}

fn law<'r>(report: &'r Value, dependent: &str) -> &'r Value {
    let laws = report["laws"].as_array().expect("laws");
    laws.iter().find(|law| law["dependent"] == dependent).expect("a law of it")
}

fn learned(folder: &Folder, names: &[String], more: &[&str]) -> Value {
    let names: Vec<&str> = names.iter().map(String::as_str).collect();
    let all = [&["learn", "coupling"], &names[..], more, &["-o", "C.toml", "--report", "R.json"]];
    folder.condyle(&all.concat()).expect(0);
    serde_json::from_str(&folder.read("R.json")).expect("JSON")
}

#[test]
fn a_known_law_is_learned_from_motions_and_noise_is_not_accepted() {
    for ending in ["mot", "csv"] {
        let folder = Folder::new(&format!("coupling-{ending}"));
        let names = trials(&folder, ending);
        let sides = ["--control", "flexion,rotation", "--follow", "knee_tx,knee_tz"];
        let report = learned(&folder, &names, &sides);
        let tx = law(&report, "knee_tx");
        // The noise is even in ±0.1 mm; of 600 frames the slopes are known to a hundredth of that and better.
        near(number(&tx["intercept"]), -0.42, 1e-4);
        near(number(&tx["slopes"]["flexion"]), 0.035, 1e-4);
        near(number(&tx["slopes"]["rotation"]), -0.02, 5e-4);
        for (name, truth) in [("intercept", -0.42), ("flexion", 0.035), ("rotation", -0.02)] {
            let [low, high] = [0, 1].map(|end| number(&tx["ci95"][name][end]));
            assert!(low < high && high - low < 1e-3, "{name}: {low} to {high}");
            assert!(low - 1e-4 < truth && truth < high + 1e-4, "{name}: {low} to {high}");
        }
        assert!(number(&tx["r2"]) > 0.99);
        // An even noise of half width w has the RMS w/√3.
        near(number(&tx["rmse"]), 1e-4 / 3f64.sqrt(), 5e-6);
        near(number(&tx["left_out_rmse"]), 1e-4 / 3f64.sqrt(), 8e-6);
        assert_eq!(
            (&tx["accepted"], &tx["criterion_2010"]["holds_absolute"]),
            (&true.into(), &true.into())
        );
        let tz = law(&report, "knee_tz");
        assert_eq!(tz["accepted"], false);
        assert_eq!((&report["rank"], &report["frames"]), (&2.into(), &600.into()));
        // Two motions of five trials each.
        assert_eq!(tx["by_motion"].as_array().map(Vec::len), Some(4));
        let info = folder.condyle(&["info", "C.toml", "--json"]).json();
        assert_eq!(info["kind"], "law");
        near(number(&info["laws"][0]["slopes_at_0"]["flexion"]), 0.035, 1e-4);
    }
}

#[test]
fn a_split_is_proposed_and_sides_are_checked() {
    let folder = Folder::new("coupling-split");
    let names = trials(&folder, "mot");
    let report = learned(&folder, &names, &[]);
    assert_eq!(report["control"], serde_json::json!(["flexion", "rotation"]));
    assert!(report["split"].as_str().is_some_and(|why| why.contains("rotations control")));
    let report = learned(&folder, &names, &["--follow", "knee_tx"]);
    assert_eq!(report["control"], serde_json::json!(["flexion", "rotation", "knee_tz"]));
    let first = [names[0].as_str()];
    let wrong = |more: &[&str]| {
        let all = [&["learn", "coupling"], &first[..], more, &["-o", "C2.toml"]].concat();
        folder.condyle(&all).refused()
    };
    let said = wrong(&["--control", "flexon", "--follow", "knee_tx"]);
    assert!(said.contains("there is no column `flexon`") && said.contains("flexion"), "{said}");
    let said = wrong(&["--control", "flexion", "--follow", "flexion"]);
    assert!(said.contains("is to control and to follow"), "{said}");
    let said = wrong(&["--basis", "cubic"]);
    assert!(said.contains("polynomial:2"), "{said}");
}

/// One trial: blocks of it stand in for trials, which is said.
#[test]
fn one_trial_is_told() {
    let folder = Folder::new("coupling-one");
    let names = trials(&folder, "csv");
    let run = folder.condyle(&["learn", "coupling", &names[0], "--control", "flexion", "-o", "-"]);
    assert!(run.err.contains("there is one trial"), "{}", run.err);
    assert!(run.expect(0).contains("kind = \"law\""));
}

/// Seven markers of a leg in millimetres, as a person stands.
pub(crate) fn standing() -> String {
    let markers = [
        ("RGT", "20\t900\t170"),
        ("RLFE", "10\t480\t140"),
        ("RMFE", "0\t470\t50"),
        ("RTT", "60\t410\t100"),
        ("RFH", "-30\t420\t150"),
        ("RMEDMAL", "-10\t80\t60"),
        ("RLATMAL", "-30\t70\t130"),
    ];
    let names: Vec<&str> = markers.iter().map(|(name, _)| *name).collect();
    let places: Vec<&str> = markers.iter().map(|(_, place)| *place).collect();
    let columns: Vec<String> = (1..=7).map(|k| format!("X{k}\tY{k}\tZ{k}")).collect();
    let (names, places, columns) = (names.join("\t\t\t"), places.join("\t"), columns.join("\t"));
    format!(
        "PathFileType\t4\t(X/Y/Z)\tstanding.trc\n\
         DataRate\tCameraRate\tNumFrames\tNumMarkers\tUnits\tOrigDataRate\tOrigDataStartFrame\tOrigNumFrames\n\
         100\t100\t2\t7\tmm\t100\t1\t2\nFrame#\tTime\t{names}\n\t\t{columns}\n\n\
         1\t0.00\t{places}\n2\t0.01\t{places}\n"
    )
}

/// From a standing trial a model with a free knee, from gaits tracked with it the law, from the law a model that follows it.
#[test]
fn a_knee_is_calibrated_tracked_and_learned() {
    let folder = Folder::new("coupling-knee");
    folder.write("standing.trc", standing());
    folder.condyle(&["learn", "joint", "standing.trc", "-o", "leg.toml"]).expect(0);
    // All angles are 0 while the person stands, so the tracked standing trial has the defaults.
    let mut names = vec![];
    for trial in 0..5 {
        let columns = [
            "time",
            "thigh_r_rz",
            "knee_r_flexion",
            "knee_r_adduction",
            "knee_r_rotation",
            "knee_r_tx",
            "knee_r_ty",
            "knee_r_tz",
        ];
        let mut text = format!(
            "g\nversion=1\nnRows=50\nnColumns=8\ninDegrees=no\nendheader\n{}\n",
            columns.join("\t")
        );
        for frame in 0..50 {
            let t = 0.12 * f64::from(frame) + f64::from(trial);
            let (a, b, c) = (-0.5 - 0.4 * t.sin(), 0.05 * (1.9 * t).sin(), 0.1 * (2.3 * t).cos());
            let cells = [
                0.01 * f64::from(frame),
                0.3 * (0.9 * t).sin(),
                a,
                b,
                c,
                0.01 + 0.035 * a - 0.01 * b,
                -0.42 + 0.008 * a,
                0.015 * c,
            ];
            let _ = writeln!(text, "{}", cells.map(|x| x.to_string()).join("\t"));
        }
        let (motion, markers) = (format!("gait_{trial}.mot"), format!("gait_{trial}.trc"));
        folder.write(&motion, text);
        folder.condyle(&["convert", &motion, &markers, "--model", "leg.toml"]).expect(0);
        names.push(markers);
    }
    let more = ["--model", "leg.toml", "--joint", "knee_r", "--apply", "law.toml"];
    let report = learned(&folder, &names, &more);
    let expected = ["knee_r_flexion", "knee_r_adduction", "knee_r_rotation"];
    assert_eq!(report["control"], serde_json::json!(expected));
    // What is left is the rounding of the files and the stop of the solver: far below the 10 % of the issue.
    for (dependent, truth) in [
        ("knee_r_tx", [0.01, 0.035, -0.01, 0.0]),
        ("knee_r_ty", [-0.42, 0.008, 0.0, 0.0]),
        ("knee_r_tz", [0.0, 0.0, 0.0, 0.015]),
    ] {
        let law = law(&report, dependent);
        near(number(&law["intercept"]), truth[0], 1e-5);
        for (name, slope) in expected.iter().zip(&truth[1..]) {
            near(number(&law["slopes"][name]), *slope, 1e-4);
        }
        assert_eq!(law["accepted"], true);
    }
    // The learned knee tracks as the free one does, with three coordinates fewer.
    let run = folder.condyle(&["track", "law.toml", "gait_0.trc", "-o", "again.mot", "--json"]);
    let tracked = run.json();
    assert!(number(&tracked["rms_m"]) < 1e-5, "{}", tracked["rms_m"]);
    // The same gait is where the law was learned; a knee bent farther is not.
    folder.condyle(&["check", "law.toml", "again.mot"]).expect(0);
    folder.write("far.json", "[{ \"knee_r_flexion\": -1.6 }]");
    let run = folder.condyle(&["check", "law.toml", "far.json", "--json"]);
    let said: Value = serde_json::from_str(&run.expect(1)).expect("JSON");
    assert_eq!(said["motion"]["extrapolated"].as_array().map(Vec::len), Some(3));
}
