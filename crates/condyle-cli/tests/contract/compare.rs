//! `condyle learn compare`.

use super::coupling::standing;
use super::{Folder, near, number};
use serde_json::Value;
use std::fmt::Write as _;

/// Trials of a knee whose centre follows its flexion, as marker files: two gaits and two crouches.
fn trials(folder: &Folder) -> Vec<String> {
    folder.write("standing.trc", standing());
    folder.condyle(&["learn", "joint", "standing.trc", "-o", "leg.toml"]).expect(0);
    let kinds = [("gait_1", 0.4), ("gait_2", 0.5), ("crouch_1", 0.8), ("crouch_2", 0.9)];
    let mut names = vec![];
    for (trial, (name, swing)) in kinds.into_iter().enumerate() {
        let columns = "time\tthigh_r_rz\tknee_r_flexion\tknee_r_adduction\tknee_r_rotation\tknee_r_tx\tknee_r_ty\tknee_r_tz";
        let mut text =
            format!("g\nversion=1\nnRows=40\nnColumns=8\ninDegrees=no\nendheader\n{columns}\n");
        for frame in 0..40 {
            let t = 0.15 * f64::from(frame) + trial as f64;
            let (a, b, c) =
                (-swing * (1.1 + t.sin()), 0.05 * (1.9 * t).sin(), 0.1 * (2.3 * t).cos());
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
        let (motion, markers) = (format!("{name}.mot"), format!("{name}.trc"));
        folder.write(&motion, text);
        folder.condyle(&["convert", &motion, &markers, "--model", "leg.toml"]).expect(0);
        names.push(markers);
    }
    names
}

fn asked<'a>(report: &'a Value, question: &str) -> Vec<&'a Value> {
    let trials = report["trials"].as_array().expect("trials");
    trials.iter().filter(|trial| trial["question"] == question).collect()
}

/// One command calibrates, learns and tracks what was left out; the learned centre, which is the truth, leaves the rounding of the
/// files, and a fixed one, a hinge and a planar knee leave what they cannot follow.
#[test]
fn the_true_knee_comes_out_ahead_on_trials_that_it_did_not_see() {
    let folder = Folder::new("compare");
    let names = trials(&folder);
    let names: Vec<&str> = names.iter().map(String::as_str).collect();
    let options = ["-o", "out", "--models", "out/models", "--threads", "1"];
    let arguments = [&["learn", "compare", "standing.trc", "--trials"], &names[..], &options];
    folder.condyle(&arguments.concat()).expect(0);
    let report: Value = serde_json::from_str(&folder.read("out/compare.json")).expect("JSON");
    for question in ["other trials", "same motion", "other motions"] {
        let all = asked(&report, question);
        assert_eq!(all.len(), 4, "{question}");
        for trial in all {
            let rms = |arm: &str| number(&trial["arms"][arm]["rms_mm"]);
            assert!(rms("learned") < 0.01 && rms("free") < 0.01, "{question}: {trial}");
            for arm in ["hinge", "planar", "fixed", "fixed-c4", "fixed-best"] {
                assert!(rms(arm) > 0.5, "{question} {arm}: {trial}");
            }
            // The sum of the paper is in metres: 40 frames.
            near(number(&trial["arms"]["fixed"]["sum_m"]), 0.04 * rms("fixed"), 1e-9);
            let learned_from = trial["learned_from"].as_array().expect("names");
            assert!(!learned_from.contains(&trial["trial"]), "{question}");
            for arm in ["hinge", "planar", "fixed", "fixed-c4", "fixed-best", "learned", "free"] {
                let file = trial["parts"][0]["models"][arm].as_str().expect("a file");
                assert!(folder.read(&format!("out/models/{file}")).contains("<OpenSimDocument"));
            }
        }
    }
    // Nobody else is there to learn from.
    assert!(asked(&report, "other persons, per axis").is_empty());
    let table = folder.read("out/compare.md");
    assert!(table.contains("| crouch | 2 | learned | 3 |"), "{table}");
    assert_eq!(folder.read("out/compare.csv").lines().count(), 1 + 3 * 4 * 7);
}

#[test]
fn two_persons_learn_from_each_other() {
    let folder = Folder::new("compare-two");
    let names = trials(&folder);
    // The same files as two persons: scaled by 1 the law of one is that of the other.
    folder.write("s.csv", "subject,static\nAnna,standing.trc\nBo,standing.trc\n");
    folder.write(
        "g.csv",
        "file,subject,motion\ngait_1.trc,Anna,gait\ncrouch_1.trc,Anna,crouch\ngait_2.trc,Bo,gait\n",
    );
    let trials = [&*names[0], &*names[1], &*names[2]];
    let more = ["--subjects", "s.csv", "--groups", "g.csv", "-o", "-", "--report", "r.json"];
    let arguments = [&["learn", "compare", "--trials"], &trials[..], &more].concat();
    let table = folder.condyle(&arguments).expect(0);
    assert!(table.contains("| Bo | gait | 1 | learned | 3 |"), "{table}");
    let report: Value = serde_json::from_str(&folder.read("r.json")).expect("JSON");
    for trial in asked(&report, "other persons, per axis") {
        assert!(number(&trial["arms"]["learned"]["rms_mm"]) < 0.01, "{trial}");
    }
    assert_eq!(asked(&report, "other persons, equation 3").len(), 3);
    near(number(&report["scaling"][0]["equation_3"][0]), 1.0, 1e-12);
    // A trial of someone else is refused.
    folder.write("g.csv", "file,subject,motion\ngait_1.trc,Cy,gait\n");
    let wrong =
        ["learn", "compare", "--trials", trials[0], "--subjects", "s.csv", "--groups", "g.csv"];
    let said = folder.condyle(&wrong).refused();
    assert!(said.contains("`Cy`, who is none of Anna, Bo"), "{said}");
}

#[test]
fn what_cannot_be_written_or_calibrated_is_refused() {
    let folder = Folder::new("compare-wrong");
    let names = trials(&folder);
    let wrong = |more: &[&str]| {
        let all = [&["learn", "compare"], more, &["--trials", names[0].as_str()]].concat();
        folder.condyle(&all).refused()
    };
    let said = wrong(&["standing.trc", "-o", "table.xlsx"]);
    assert!(said.contains("end it in .md or .csv"), "{said}");
    let said = wrong(&["standing.trc", "--medial", "NOBODY"]);
    assert!(said.contains("shows no `NOBODY`"), "{said}");
    let said = wrong(&[]);
    assert!(said.contains("STATIC"), "{said}");
}
