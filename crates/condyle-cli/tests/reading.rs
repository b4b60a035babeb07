//! Recordings, motions and poses as people have them, through the command.
//!
//! The public cases vary one trial of a two-pin arm, whose angles in frame i are sh = 0.3 sin(0.3 i) and
//! el = 0.5 + 0.04 i radians: where a variant is read rightly, these come out.

#[path = "command/mod.rs"]
mod command;

use command::{Answer, Folder};
use condyle::formats::sto;
use std::path::{Path, PathBuf};

/// The folder of cases, or a line that says that the test is skipped.
fn cases() -> Option<PathBuf> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/cases/reading");
    let found = path.is_dir();
    if !found {
        println!("skipped: there is no {}", path.display());
    }
    found.then(|| path.canonicalize().expect("a path of a folder"))
}

fn text(path: &Path) -> &str {
    path.to_str().expect("a path of letters")
}

/// The largest difference of a motion in degrees from the truth, in radians; frames are those of 100 Hz.
fn off(folder: &Folder, name: &str) -> f64 {
    let bytes = std::fs::read(folder.path().join(name)).expect("a motion");
    let table = sto::from_bytes(&bytes).expect("a motion that can be read").value;
    let mut most = 0.0f64;
    for (row, time) in table.times.iter().enumerate() {
        let i = (time * 100.0).round();
        for (name, truth) in [("sh_flex", 0.3 * (0.3 * i).sin()), ("el_flex", 0.5 + 0.04 * i)] {
            let column = table.column(name).expect("a coordinate of the arm");
            most = most.max((table.value(row, column).unwrap().to_radians() - truth).abs());
        }
    }
    most
}

fn track(folder: &Folder, model: &Path, trial: &Path, others: &[&str]) -> Answer {
    let arguments = ["track", text(model), text(trial), "-o", "o.mot"];
    folder.condyle(&[&arguments, others].concat())
}

#[test]
fn every_trial_is_read_rightly_or_refused_with_the_reason() {
    let Some(cases) = cases() else { return };
    let folder = Folder::new("reading-trials");
    let arm = cases.join("00-base/arm.osim");
    // The trial, arguments, exit code, words of the messages.
    let told: &[(&str, &[&str], i32, &str)] = &[
        ("08-shifted-rows/leading_tab_last_unseen.trc", &[], 0, "rows stand beside their names"),
        ("08-shifted-rows/timestamp.trc", &[], 0, "`Timestamp` in column 3 is no marker"),
        ("09-nameless-later/trial.trc", &[], 0, "markers without a name"),
        ("10-header-tabs/trial.trc", &[], 0, ""),
        ("13-names-tight/trial.trc", &[], 0, ""),
        ("15-zeros/trial.trc", &[], 0, "at exactly 0 0 0 and elsewhere in other frames: `D"),
        ("15-zeros/trial.trc", &["--zeros", "missing"], 0, "at exactly 0 0 0: `D"),
        ("15-zeros/trial.trc", &["--zeros", "keep"], 1, ""),
        ("24-units/meters.trc", &[], 0, ""),
        ("24-units/upper.trc", &[], 0, ""),
        ("24-units/m_called_mm.trc", &[], 1, "is the unit `mm` right?"),
        ("24-units/mm_called_m.trc", &[], 1, "is the unit `m` right?"),
        ("30-two-subjects/case.trc", &[], 0, "ignoring case"),
        (
            "30-two-subjects/trial.trc",
            &[],
            2,
            "several subjects fit the model: `S1 (4 markers)`, `S2 (4 markers)`",
        ),
        ("30-two-subjects/trial.trc", &["--subject", "S2"], 0, "without their prefix `S2:`"),
        ("30-two-subjects/trial.trc", &["--subject", "S3"], 2, "subjects are: S1, S2"),
        (
            "30-two-subjects/mixed.trc",
            &[],
            2,
            "several subjects fit the model: `S1 (2 markers)`, `S2 (4 markers)`",
        ),
        ("30-two-subjects/mixed.trc", &["--subject", "s2"], 0, "without their prefix `S2:`"),
        ("26-encodings/backwards.trc", &[], 2, "time goes back"),
        ("26-encodings/bom.trc", &[], 0, ""),
        ("26-encodings/comma.trc", &[], 0, "the decimal separator is a comma"),
        ("26-encodings/cr.trc", &[], 0, ""),
        ("26-encodings/crlf.trc", &[], 0, ""),
        ("26-encodings/csvlike.trc", &[], 0, ""),
        ("26-encodings/ctrlz.trc", &[], 0, ""),
        ("26-encodings/notime.trc", &[], 2, "the row has no time"),
        ("26-encodings/nul.trc", &[], 0, ""),
        ("26-encodings/plus.trc", &[], 0, ""),
        ("26-encodings/quoted.trc", &[], 0, ""),
        ("26-encodings/rate_comma.trc", &[], 0, ""),
        ("26-encodings/sci.trc", &[], 0, ""),
        ("26-encodings/sci_fortran.trc", &[], 0, ""),
        ("26-encodings/utf16.trc", &[], 0, ""),
        ("26-encodings/utf16be_nobom.trc", &[], 0, "without a byte order mark"),
    ];
    for (name, arguments, code, said) in told {
        let run = track(&folder, &arm, &cases.join(name), arguments);
        assert_eq!(run.code, *code, "{name} {arguments:?}: {}", run.err);
        assert!(run.err.contains(said), "{name} {arguments:?}: {}", run.err);
        if *code == 0 {
            let off = off(&folder, "o.mot");
            // The numbers have five decimals of a millimetre, or of a metre.
            let most = if name.contains("meters") { 1e-3 } else { 1e-6 };
            assert!(off < most, "{name} {arguments:?}: off by {off} rad");
        }
        // What is read without a guess says nothing.
        let clean = *code == 0 && said.is_empty();
        assert!(!clean || !run.err.contains("warning"), "{name}: {}", run.err);
    }
    // Negative times change only which frame is which.
    let run = track(&folder, &arm, &cases.join("26-encodings/negtime.trc"), &[]);
    assert_eq!(run.code, 0, "{}", run.err);
    // A hand, of which a guess by size would be wrong: the unit is in the header.
    let hand = cases.join("10-header-tabs/hand.trc");
    let info = folder.condyle(&["info", text(&hand)]);
    assert_eq!((info.code, info.err.as_str()), (0, ""));
    assert!(String::from_utf8_lossy(&info.out).contains("lengths in mm"));
}

#[test]
fn every_word_for_a_missing_value_is_one() {
    let Some(cases) = cases() else { return };
    let folder = Folder::new("reading-words");
    let arm = cases.join("00-base/arm.osim");
    let mut count = 0;
    for entry in std::fs::read_dir(cases.join("11-nan-tokens")).unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_none_or(|ending| ending != "trc") {
            continue;
        }
        let run = track(&folder, &arm, &path, &[]);
        assert_eq!((run.code, off(&folder, "o.mot") < 1e-6), (0, true), "{path:?}: {}", run.err);
        let info = folder.condyle(&["info", text(&path), "--json"]);
        let info = String::from_utf8(info.out).unwrap();
        assert_eq!(info.matches("\"missing_frames\":1,").count(), 1, "{path:?}: {info}");
        count += 1;
    }
    assert!(count > 0);
}

#[test]
fn two_columns_of_one_name_matter_only_for_a_coordinate() {
    let Some(cases) = cases() else { return };
    let folder = Folder::new("reading-columns");
    let [arm, motion] =
        ["arm.osim", "ik.mot"].map(|name| cases.join("07-duplicate-columns").join(name));
    let (arm, motion) = (text(&arm), text(&motion));
    for arguments in
        [&["info", motion][..], &["fk", arm, "--motion", motion], &["diff", motion, motion]]
    {
        let run = folder.condyle(arguments);
        assert_eq!(run.code, 0, "{arguments:?}: {}", run.err);
        assert!(run.err.contains("`ground_force_vx#2`"), "{arguments:?}: {}", run.err);
    }
    let twice = "ik\ninDegrees=yes\nendheader\ntime\tsh_flex\tsh_flex\n0\t10\t20\n";
    folder.write("twice.mot", twice);
    let run = folder.condyle(&["fk", arm, "--motion", "twice.mot"]);
    assert_eq!(run.code, 2, "{}", run.err);
    assert!(run.err.contains("two columns are called `sh_flex`"), "{}", run.err);
}

#[test]
fn a_marker_at_zero_is_missing_where_it_is_elsewhere_in_other_frames() {
    let Some(cases) = cases() else { return };
    let trial = cases.join("../tracking/zero_is_missing.trc");
    let model = cases.join("../../data/knee/opencap4/manually_scaled.osim");
    if !trial.is_file() || !model.is_file() {
        println!("skipped: there is no {} or {}", trial.display(), model.display());
        return;
    }
    let folder = Folder::new("reading-zeros");
    let run = folder.condyle(&["info", text(&trial)]);
    assert_eq!(run.code, 0, "{}", run.err);
    assert!(run.err.contains("at exactly 0 0 0 and elsewhere"), "{}", run.err);
    assert!(!String::from_utf8_lossy(&run.out).contains("no gaps"));
    let run = track(&folder, &model, &trial, &["--report", "r.json"]);
    let report = std::fs::read_to_string(folder.path().join("r.json")).expect("a report");
    // The last: before it are those of single markers.
    let rms = report.rsplit("\"rms_m\": ").next().and_then(|rest| rest.split([',', '\n']).next());
    let rms: f64 = rms.expect("an RMS").parse().unwrap();
    // The trial without faults has 12 mm; with the zeros as places it is above 200 mm.
    assert!(run.code == 0 && rms < 0.02, "{rms} {}", run.err);
}

#[test]
fn angles_of_an_unstated_unit_are_guessed_aloud_or_refused() {
    let Some(cases) = cases() else { return };
    let folder = Folder::new("reading-angles");
    let arm = cases.join("00-base/arm.osim");
    let arm = text(&arm);
    let motion = |el: &str, stated: &str| {
        format!("m\n{stated}endheader\ntime\tsh_flex\tel_flex\n0\t0.5\t{el}\n0.01\t0.5\t{el}\n")
    };
    for (el, unit) in [("60", "degrees"), ("1.5", "radians")] {
        folder
            .write("m.mot", motion(el, ""))
            .write("m.csv", format!("time,sh_flex,el_flex\n0,0.5,{el}\n"));
        for arguments in [
            &["fk", arm, "--motion", "m.mot"][..],
            &["fk", arm, "--motion", "m.csv"],
            &["convert", "m.mot", "o.trc", "--model", arm],
            &["check", arm, "m.mot"],
            &["diff", "m.mot", "m.mot"],
            &["diff", "m.mot", "m.csv", "--model", arm],
        ] {
            let run = folder.condyle(arguments);
            let said = [run.err, String::from_utf8_lossy(&run.out).into_owned()].concat();
            assert!(run.code < 2, "{arguments:?}: {said}");
            assert!(said.contains(&format!("taken as {unit}")), "{arguments:?}: {said}");
        }
        let stated = if unit == "degrees" { "inDegrees=yes\n" } else { "inDegrees=no\n" };
        folder.write("stated.mot", motion(el, stated));
        let [guessed, stated] =
            ["m.mot", "stated.mot"].map(|name| folder.condyle(&["fk", arm, "--motion", name]));
        assert!(stated.err.is_empty(), "{}", stated.err);
        assert_eq!(guessed.out, stated.out, "{unit}");
        let told = &unit[..3];
        let told = folder.condyle(&["fk", arm, "--motion", "m.mot", "--angles", told]);
        assert_eq!((told.err.as_str(), told.out), ("", stated.out), "{unit}");
    }
    // 300 degrees in radians, or 5 degrees.
    folder.write("m.mot", motion("5.3", ""));
    let run = folder.condyle(&["diff", "m.mot", "m.mot"]);
    assert_eq!(run.code, 2, "{}", run.err);
    assert!(
        run.err.contains("may be degrees or radians") && run.err.contains("--angles"),
        "{}",
        run.err
    );
    assert_eq!(folder.condyle(&["diff", "m.mot", "m.mot", "--angles", "deg"]).code, 0);
    // What the program writes states its unit, or is a CSV.
    let trial = cases.join("00-base/trial.trc");
    for name in ["own.mot", "own.sto"] {
        let run = folder.condyle(&["track", arm, text(&trial), "-o", name]);
        assert_eq!(run.code, 0, "{}", run.err);
        let run = folder.condyle(&["fk", arm, "--motion", name]);
        assert_eq!((run.code, run.err.as_str()), (0, ""), "{name}");
    }
}

#[test]
fn poses_have_units_and_their_numbers_are_judged() {
    let Some(cases) = cases() else { return };
    let folder = Folder::new("reading-poses");
    let arm = cases.join("00-base/arm.osim");
    let arm = text(&arm);
    let fk = |pose: &str| {
        folder.write("p.json", pose);
        folder.condyle(&["fk", arm, "--pose", "p.json"])
    };
    let right = fk(r#"{"el_flex": 1.5707963267948966}"#);
    assert_eq!((right.code, right.err.as_str()), (0, ""));
    for pose in [
        r#"{"el_flex": "90 deg"}"#,
        r#"{"el_flex": "90°"}"#,
        r#"{"el_flex": "1.5707963267948966 rad"}"#,
    ] {
        let run = fk(pose);
        assert_eq!((run.code, run.err.as_str(), &run.out), (0, "", &right.out), "{pose}");
    }
    let run = fk(r#"{"el_flex": 90}"#);
    assert_eq!(run.code, 0);
    assert!(run.err.contains("`el_flex` is 90 rad") && run.err.contains("90 deg"), "{}", run.err);
    for pose in [r#"{"el_flex": "90"}"#, r#"{"el_flex": "90 mm"}"#, r#"{"el_flex": "deg"}"#] {
        let run = fk(pose);
        assert_eq!(run.code, 2, "{pose}: {}", run.err);
        assert!(run.err.contains("90 deg"), "{pose}: {}", run.err);
    }
}

#[test]
fn markers_may_be_a_table() {
    let Some(cases) = cases() else { return };
    let folder = Folder::new("reading-markers");
    let arm = cases.join("00-base/arm.osim");
    let trial = cases.join("00-base/trial.trc");
    let run = folder.condyle(&["convert", text(&trial), "m.csv"]);
    assert_eq!(run.code, 0, "{}", run.err);
    let csv = std::fs::read_to_string(folder.path().join("m.csv")).unwrap();
    let rows = csv.replace(',', "\t");
    let head = "markers\nUnits=m\nendheader\n";
    for (ending, to) in [("_t", ""), (".", ""), ("_", ""), (":", "")] {
        let mut names = rows.lines().next().unwrap().replace('.', ending);
        names.push_str(to);
        let rest: Vec<&str> = rows.lines().skip(1).collect();
        folder.write("m.sto", format!("{head}{names}\n{}\n", rest.join("\n")));
        let run = track(&folder, &arm, &folder.path().join("m.sto"), &[]);
        assert_eq!(run.code, 0, "{ending}: {}", run.err);
        assert!(off(&folder, "o.mot") < 1e-6, "{ending}");
    }
    folder.write("none.sto", "x\nendheader\ntime\ta\n0\t1\n");
    let run = track(&folder, &arm, &folder.path().join("none.sto"), &[]);
    assert_eq!(run.code, 2);
    assert!(run.err.contains("no marker has three columns"), "{}", run.err);
}
