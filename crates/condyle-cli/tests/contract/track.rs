//! `condyle track`.

use super::{Folder, leg, near, number};
use serde_json::{Value, json};

/// A recording in which every marker is seen.
fn whole(frames: usize) -> String {
    leg::trc(frames, |_, _| true)
}

/// Rows of a table of text, split at a separator, after the line that starts with `time`.
fn table(text: &str, separator: char) -> (Vec<String>, Vec<Vec<f64>>) {
    let mut lines = text.lines().skip_while(|line| !line.starts_with("time"));
    let names = lines.next().expect("a line of names").split(separator).map(str::to_owned);
    let rows =
        lines.map(|line| line.split(separator).map(|c| c.parse().expect("a number")).collect());
    (names.collect(), rows.collect())
}

#[test]
fn a_motion_comes_back_from_its_markers() {
    let folder = Folder::with_leg("track-motion");
    folder.write("walk.trc", whole(25));
    let run = folder.condyle(&["track", "leg.osim", "walk.trc", "-o", "-", "--threads", "1"]);
    let text = run.expect(0);
    assert!(text.contains("inDegrees=yes\n") && text.starts_with("walk\n"), "{text}");
    // The toe moves no marker, and the header says so.
    let header = text.split_once("endheader\n").expect("a header").0;
    assert!(header.ends_with("\nno_marker_moves=toe/flexion\n"), "{header}");
    let (names, rows) = table(&text, '\t');
    let expected =
        ["time", "hip_flexion", "knee_angle", "knee_slide", "ankle/flexion", "toe/flexion"];
    assert_eq!(names, expected);
    assert_eq!(rows.len(), 25);
    for (frame, row) in rows.iter().enumerate() {
        let t = frame as f64 / 100.0;
        near(row[0], t, 1e-12);
        near(row[1], leg::hip(t).to_degrees(), 1e-3);
        near(row[2], leg::knee(t).to_degrees(), 1e-3);
        near(row[3], 0.02 * leg::knee(t), 1e-6);
        // Locked at its default; the toe, which nothing shows, stays at its own.
        near(row[4], 0.1f64.to_degrees(), 1e-12);
        near(row[5], 0.0, 1e-9);
    }
}

#[test]
fn the_report_is_one_document_with_what_the_contract_names() {
    let folder = Folder::with_leg("track-report");
    folder.write("walk.trc", whole(10));
    let arguments =
        ["track", "leg.osim", "walk.trc", "-o", "w.csv", "--json", "--report", "r.json"];
    let report = folder.condyle(&[&arguments[..], &["--errors", "e.csv"]].concat()).json();
    assert_eq!((&report["frames"], &report["markers_used"]), (&json!(10), &json!(6)));
    assert_eq!(report["failed_frames"], json!([]));
    for key in ["seconds", "frames_per_second", "rms_m", "max_m", "objective", "objective_markers"]
    {
        assert!(number(&report[key]) >= 0.0, "{key}");
    }
    assert!(number(&report["max_m"]) < 1e-5, "{report}");
    let written: Value = serde_json::from_str(&folder.read("r.json")).expect("JSON");
    assert_eq!(written, report);
    let (names, rows) = table(&folder.read("w.csv"), ',');
    assert_eq!(names[1], "hip_flexion");
    // CSV is in radians.
    near(rows[9][2], leg::knee(0.09), 2e-5);
    let errors = folder.read("e.csv");
    let mut lines = errors.lines();
    assert_eq!(lines.next(), Some("time,marker,error_m"));
    assert_eq!(lines.clone().count(), 60);
    let first: Vec<&str> = lines.next().expect("a row").split(',').collect();
    assert_eq!(first[..2], ["0", "HIP"]);
    assert!(first[2].parse::<f64>().expect("metres") < 1e-5);
}

#[test]
fn a_frame_without_markers_fails_and_the_others_do_not() {
    let folder = Folder::with_leg("track-failed");
    folder.write("walk.trc", leg::trc(9, |frame, _| frame != 4));
    let run =
        folder.condyle(&["track", "leg.osim", "walk.trc", "-o", "w.csv", "--report", "r.json"]);
    let text = run.expect(1);
    assert!(text.contains("1 frames not solved, the first is frame 4 (no markers)"), "{text}");
    let report: Value = serde_json::from_str(&folder.read("r.json")).expect("JSON");
    let failed = json!([{"frame": 4, "time": 0.04, "status": "no markers"}]);
    assert_eq!(report["failed_frames"], failed);
    let (_, rows) = table(&folder.read("w.csv"), ',');
    assert_eq!(rows.len(), 9);
    near(rows[8][1], leg::hip(0.08), 2e-5);
}

#[test]
fn clamped_coordinates_are_held_and_others_are_not() {
    let folder = Folder::with_leg("track-limits");
    // The hip may not go below 0.2 now, but was there.
    let tight = leg::osim().replace("<range>-1.5 2</range>", "<range>0.2 2</range>");
    folder.write("tight.osim", tight).write("walk.trc", whole(3));
    let hip = |limits: &str| {
        let arguments = ["track", "tight.osim", "walk.trc", "-o", "w.csv", "--limits", limits];
        folder.condyle(&arguments).expect(0);
        table(&folder.read("w.csv"), ',').1[0][1]
    };
    near(hip("off"), leg::hip(0.0), 2e-5);
    near(hip("on"), 0.2, 1e-9);
}

#[test]
fn a_setup_brings_weights_tasks_and_times() {
    let folder = Folder::with_leg("track-setup");
    folder.write("walk.trc", whole(21)).write(
        "ik.xml",
        "<OpenSimDocument><InverseKinematicsTool><time_range>0.05 0.1</time_range>\
         <IKTaskSet file=\"tasks.xml\"/></InverseKinematicsTool></OpenSimDocument>",
    );
    let marker =
        |name: &str| format!("<IKMarkerTask name=\"{name}\"><weight>2</weight></IKMarkerTask>");
    let tasks =
        format!("<IKTaskSet><objects>{}{}</objects></IKTaskSet>", marker("MID"), marker("ANKLE"));
    folder.write("tasks.xml", tasks);
    let arguments = ["track", "leg.osim", "walk.trc", "--setup", "ik.xml", "--json", "-o", "w.csv"];
    let report = folder.condyle(&arguments).json();
    assert_eq!((&report["frames"], &report["markers_used"]), (&json!(6), &json!(2)));
    let (_, rows) = table(&folder.read("w.csv"), ',');
    near(rows[0][0], 0.05, 1e-12);
    near(rows[5][0], 0.1, 1e-12);
    near(rows[5][2], leg::knee(0.1), 1e-4);
    folder.write(
        "ik.xml",
        "<InverseKinematicsTool><time_range>7 8</time_range></InverseKinematicsTool>",
    );
    let said = folder.condyle(&arguments).refused();
    // Without tasks all markers count; the times are what is wrong.
    assert!(said.contains("no frame lies between 7 and 8 s"), "{said}");
}

#[test]
fn guessed_names_are_warnings_and_strangers_an_error() {
    let folder = Folder::with_leg("track-names");
    let guessed = whole(2).replace("HIP", "Anna:HIP").replace("SHIN", "shin");
    folder.write("guessed.trc", guessed);
    let run = folder.condyle(&["track", "leg.osim", "guessed.trc", "--json"]);
    assert!(run.err.contains("markers are taken without their prefix `Anna:`: `HIP`"));
    assert!(run.err.contains("markers are taken ignoring case: `shin for SHIN`"));
    assert_eq!(run.json()["markers_used"], 6);
    let mut strangers = whole(2);
    for (name, ..) in leg::MARKERS {
        strangers = strangers.replace(name, &name.chars().rev().collect::<String>());
    }
    folder.write("strangers.trc", strangers);
    let said = folder.condyle(&["track", "leg.osim", "strangers.trc"]).refused();
    assert!(
        said.contains("share no marker") && said.contains("HIP") && said.contains("PIH"),
        "{said}"
    );
}

#[test]
fn several_recordings_go_to_a_folder() {
    let folder = Folder::with_leg("track-several");
    folder.write("a.trc", whole(3)).write("b.trc", whole(2));
    let both = ["track", "leg.osim", "a.trc", "b.trc"];
    let said = folder.condyle(&[&both[..], &["-o", "one.mot"]].concat()).refused();
    assert_eq!(said, "error: several recordings need a folder for -o\n");
    let reports = folder.condyle(&[&both[..], &["-o", "out", "--json"]].concat()).json();
    assert_eq!((&reports[0]["frames"], &reports[1]["frames"]), (&json!(3), &json!(2)));
    assert_eq!(table(&folder.read("out/a.mot"), '\t').1.len(), 3);
    assert_eq!(table(&folder.read("out/b.mot"), '\t').1.len(), 2);
    let said = folder.condyle(&["track", "leg.osim", "a.trc", "-o", "a.xyz"]).refused();
    assert!(said.contains("a.xyz: the ending names no format for a motion"), "{said}");
}

#[test]
fn arguments_win_over_a_written_setup_and_both_over_the_usual() {
    let folder = Folder::with_leg("track-written-setup");
    folder.write("walk.trc", whole(21).replace("HIP", "Pelvis1")).write(
        "sets/names.toml",
        "condyle = 1\nkind = \"names\"\n[names]\nPelvis1 = [\"hip centre\", \"HIP\"]\n",
    );
    folder.write(
        "sets/setup.toml",
        "condyle = 1\nkind = \"setup\"\nangles = \"deg\"\ntime = [0.05, \"none\"]\n\
         names = \"names.toml\"\nmax_rms = 0.05\n\
         [weight]\n\"*\" = 2\nTIBIA = 0\n\
         [hold.hip_flexion]\nstiffness = 1e4\nrest = 30\nunit = \"deg\"\n",
    );
    let run = |more: &[&str]| {
        let arguments = [
            "track",
            "leg.osim",
            "walk.trc",
            "--setup",
            "sets/setup.toml",
            "--json",
            "-o",
            "w.csv",
        ];
        folder.condyle(&[&arguments[..], more].concat())
    };
    let answer = run(&["--hold", "hip_flexion=0"]).json();
    // From 0.05 to 0.2 s at 100 Hz; all markers but one, the renamed among them.
    assert_eq!((&answer["frames"], &answer["markers_used"]), (&json!(16), &json!(5)));
    assert_eq!(answer["unused_markers"], json!({ "model": ["TIBIA"], "recording": ["TIBIA"] }));
    assert_eq!(answer["verdict"], json!({ "plausible": true, "cause": null }));
    near(table(&folder.read("w.csv"), ',').1[0][1], leg::hip(0.05), 2e-5);
    let arguments =
        ["--time", "0.1:0.12", "--weight", "T*=1", "--weight", "SHIN=0", "--max-rms", "900"];
    let held = run(&arguments).json();
    assert_eq!((&held["frames"], &held["markers_used"]), (&json!(3), &json!(5)));
    // So stiff that markers a few centimetres off have no say.
    near(table(&folder.read("w.csv"), ',').1[0][1], 30f64.to_radians(), 1e-4);
    assert!(number(&held["objective_posture"]) > 0.0);
    // The bound of the setup holds where no argument raises it.
    let arguments = ["--time", "0.1:0.12"];
    assert_eq!(run(&arguments).code, 1);
}

#[test]
fn tasks_alone_are_a_setup() {
    let folder = Folder::with_leg("track-tasks-alone");
    folder.write("walk.trc", whole(5)).write(
        "tasks.xml",
        "<IKTaskSet><objects><IKMarkerTask name=\"MID\"><weight>2</weight></IKMarkerTask>\
         <IKMarkerTask name=\"SHIN\"><weight>1</weight></IKMarkerTask></objects></IKTaskSet>",
    );
    let arguments = ["track", "leg.osim", "walk.trc", "--setup", "tasks.xml", "--json"];
    let report = folder.condyle(&arguments).json();
    assert_eq!(report["markers_used"], 2);
    assert_eq!(report["unused_markers"]["model"].as_array().map(Vec::len), Some(4));
}

#[test]
fn a_fit_that_cannot_be_is_refused_with_its_cause() {
    let folder = Folder::with_leg("track-implausible");
    // The hip may not go below 0.2 now, but was at 0.
    let tight = leg::osim().replace("<range>-1.5 2</range>", "<range>0.2 2</range>");
    folder.write("tight.osim", tight).write("walk.trc", whole(3));
    let arguments = ["track", "tight.osim", "walk.trc", "--max-rms", "1"];
    let run = folder.condyle(&[&arguments[..], &["--json"]].concat());
    assert_eq!(run.code, 1, "{}", run.err);
    let report: Value = serde_json::from_slice(&run.out).expect("JSON");
    assert_eq!(report["verdict"]["plausible"], false);
    let cause = report["verdict"]["cause"].as_str().expect("a cause");
    assert!(cause.contains("farthest off are"), "{cause}");
    let text = folder.condyle(&arguments).expect(1);
    assert!(text.contains("  not plausible: the marker error is"), "{text}");
}

#[test]
fn wrong_arguments_are_refused_with_suggestions() {
    let folder = Folder::with_leg("track-arguments");
    folder.write("walk.trc", whole(3));
    for (arguments, said) in [
        (["--weight", "TIBLA=1"], "did you mean `TIBIA`?"),
        (["--weight", "TIBIA"], "give NAME=NUMBER"),
        (["--weight", "TIBIA=-1"], "0 or more"),
        (["--weight", "TIBIA=1e308"], "out of bounds"),
        (["--hold", "hip_flexoin=1"], "did you mean `hip_flexion`?"),
        (["--time", "2:1"], "no time lies between"),
        (["--time", "7:"], "no frame lies between"),
        (["--names", "opencab"], "did you mean `opencap`?"),
        (["--max-rms", "0"], "millimetres above 0"),
    ] {
        let run = folder.condyle(&[&["track", "leg.osim", "walk.trc"][..], &arguments].concat());
        let found = run.refused();
        assert!(found.contains(said), "{arguments:?}: {found}");
    }
}
