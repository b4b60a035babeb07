//! `condyle track` with several recordings.

use super::{Folder, leg};
use serde_json::Value;

fn trial(frames: usize) -> String {
    leg::trc(frames, |_, _| true)
}

impl Folder {
    fn value(&self, name: &str) -> Value {
        serde_json::from_str(&self.read(name)).expect("JSON")
    }

    fn has(&self, name: &str) -> bool {
        self.path().join(name).exists()
    }
}

#[test]
fn a_bad_recording_does_not_end_the_others() {
    let folder = Folder::with_leg("batch-bad");
    folder.write("a.trc", trial(3)).write("bad.trc", "no recording").write("c.trc", trial(4));
    let run = folder.condyle(&[
        "track", "leg.osim", "a.trc", "bad.trc", "c.trc", "-o", "out/", "--report", "r.json",
    ]);
    assert_eq!(run.code, 2, "{}", run.err);
    assert!(
        run.err.ends_with("error: 1 of 3 recordings could not be tracked: bad.trc\n"),
        "{}",
        run.err
    );
    assert!(
        run.err.contains("bad.trc:1: the file does not start with `PathFileType`"),
        "{}",
        run.err
    );
    assert!(folder.has("out/a.mot") && folder.has("out/c.mot") && !folder.has("out/bad.mot"));
    assert_eq!(folder.value("out/c.report.json")["frames"], 4);
    let list = folder.value("r.json");
    assert_eq!(list[0], folder.value("out/a.report.json"));
    assert!(list[1]["error"].as_str().is_some_and(|said| said.contains("PathFileType")), "{list}");
    assert_eq!((&list[1]["trial"], &list[2]["frames"]), (&"bad.trc".into(), &4.into()));
}

#[test]
fn a_recording_that_does_not_fit_is_named_and_ends_with_1() {
    let folder = Folder::with_leg("batch-odd");
    folder.write("a.trc", trial(3)).write("gap.trc", leg::trc(9, |frame, _| frame != 4));
    let run = folder.condyle(&["track", "leg.osim", "gap.trc", "a.trc", "-o", "out"]);
    assert_eq!(run.code, 1, "{}", run.err);
    assert!(run.err.contains("1 of 2 recordings have frames that were not solved"), "{}", run.err);
    assert!(run.err.ends_with(": gap.trc\n"), "{}", run.err);
}

#[test]
fn equal_names_keep_the_folders_in_which_they_differ() {
    let folder = Folder::with_leg("batch-names");
    folder.write("data/s1/walk.trc", trial(2)).write("data/s2/deep/walk.trc", trial(3));
    let both = ["track", "leg.osim", "data/s1/walk.trc", "data/s2/deep/../deep/walk.trc"];
    folder.condyle(&[&both[..], &["-o", "out", "--errors", "e/"]].concat()).expect(0);
    assert_eq!(folder.value("out/s1/walk.report.json")["frames"], 2);
    assert_eq!(folder.value("out/s2/deep/walk.report.json")["frames"], 3);
    assert!(folder.has("out/s1/walk.mot") && folder.has("e/s2/deep/walk.csv"));
    // In one folder the tables of errors and the motions would have one name.
    folder.condyle(&[&both[..], &["-o", "o", "--to", "csv", "--errors", "o"]].concat()).expect(0);
    assert!(folder.read("o/s1/walk.errors.csv").starts_with("time,marker,error_m\n"));
    assert!(folder.read("o/s1/walk.csv").starts_with("time,hip_flexion"));
}

#[test]
fn what_cannot_be_written_is_found_before_anything_is_read() {
    let folder = Folder::with_leg("batch-refused");
    folder.write("a.trc", trial(2)).write("b.trc", trial(2)).write("dir/x", "");
    let both = ["track", "nowhere.osim", "a.trc", "b.trc"];
    let one = ["track", "nowhere.osim", "a.trc"];
    for (recordings, arguments, said) in [
        (&both[..], &["-o", "-"][..], "several recordings cannot go to one stream: give a folder"),
        (&both, &["-o", "one.mot"], "several recordings need a folder for -o"),
        (
            &both,
            &["-o", "out", "--errors", "e.csv"],
            "e.csv: the errors of several recordings need a folder",
        ),
        (&both, &["--resume"], "--resume needs -o"),
        (&one, &["-o", "a.xyz"], "a.xyz: the ending names no format for a motion"),
        (&one, &["--errors", "e.txt"], "e.txt: a table of marker errors is written as .csv"),
        (&one, &["--report", "r.txt"], "r.txt: a report is written as .json"),
        (&one, &["-o", "-", "--json"], "two results want standard output"),
        (&one, &["-o", "a.trc", "--to", "mot"], "a.trc: this file is also an input (a.trc)"),
        (&one, &["-o", "dir/../a.trc", "--to", "mot"], "dir/../a.trc: this file is also an input"),
        (
            &one,
            &["--errors", "x.csv", "-o", "x.csv"],
            "x.csv: two results would be written to this file",
        ),
        (&["track", "nowhere.osim", "a.trc", "./a.trc"], &["-o", "out"], "two results would be"),
    ] {
        let found = folder.condyle(&[recordings, arguments].concat()).refused();
        assert!(found.contains(said), "{arguments:?}: {found}");
    }
    assert!(!folder.has("out") && !folder.has("-") && !folder.has("e.csv"));
}

#[test]
fn what_is_done_with_the_same_inputs_is_skipped_and_nothing_else() {
    let folder = Folder::with_leg("batch-resume");
    folder.write("a.trc", trial(3)).write("b.trc", trial(4));
    folder.write("names.toml", "condyle = 1\nkind = \"names\"\n[names]\nX = \"HIP\"\n");
    let skipped = |more: &[&str]| -> Vec<bool> {
        let arguments =
            ["track", "leg.osim", "a.trc", "b.trc", "-o", "out", "--resume", "--report", "r.json"];
        let run = folder.condyle(&[&arguments[..], more].concat());
        let err = run.err.clone();
        run.expect(0);
        let frames: Vec<Value> = folder.value("r.json").as_array().cloned().unwrap_or_default();
        assert_eq!(frames.iter().map(|r| &r["frames"]).collect::<Vec<_>>(), [3, 4]);
        ["a.trc", "b.trc"]
            .map(|name| err.contains(&format!("note: {name}: done before and unchanged, skipped")))
            .to_vec()
    };
    let (both, none, only_b) = (vec![true; 2], vec![false; 2], vec![false, true]);
    assert_eq!(skipped(&[]), none);
    assert_eq!(skipped(&[]), both);
    assert_eq!(skipped(&["--threads", "1"]), both, "threads change no result");
    folder.write("a.trc", trial(3).replace("0.02\t", "0.025\t"));
    assert_eq!(skipped(&[]), only_b, "another recording");
    std::fs::remove_file(folder.path().join("out/a.mot")).expect("a result");
    assert_eq!(skipped(&[]), only_b, "a result that is gone");
    let torn = folder.read("out/a.mot");
    folder.write("out/a.mot", &torn[..torn.len() / 2]);
    assert_eq!(skipped(&[]), only_b, "a result that was changed");
    assert_eq!(folder.read("out/a.mot"), torn);
    folder.write("out/a.report.json", "{");
    assert_eq!(skipped(&[]), only_b, "a report that was changed");
    for options in [
        &["--weight", "HIP=2"][..],
        &["--limits", "off"],
        &["--max-rms", "50"],
        &["--names", "names.toml"],
        &["--hold", "hip_flexion=1e-9"],
        &["--errors", "e/"],
    ] {
        assert_eq!(skipped(options), none, "{options:?}");
        assert_eq!(skipped(options), both, "{options:?}");
    }
    assert_eq!(skipped(&[]), none, "the options of the first run again");
    folder.write("leg.osim", leg::osim().replace("<range>-1.5 2</range>", "<range>-1.4 2</range>"));
    assert_eq!(skipped(&[]), none, "another model");
}
