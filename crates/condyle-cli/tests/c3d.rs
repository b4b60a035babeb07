//! C3D through the command: a trial tracked from TRC and from C3D gives the same, and what is said of a C3D file.

#[allow(dead_code, reason = "each test takes what it needs")]
#[path = "command/mod.rs"]
mod command;

use command::{Answer, Folder};
use condyle::formats::{LengthUnit, c3d, sto, trc};
use std::path::{Path, PathBuf};

fn shared(name: &str) -> Option<PathBuf> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared").join(name);
    match path.exists() {
        true => path.canonicalize().ok(),
        false => {
            println!("skipped: there is no {}", path.display());
            None
        }
    }
}

fn text(path: &Path) -> &str {
    path.to_str().expect("a path of letters")
}

/// What the command printed.
fn text_of(answer: &Answer) -> String {
    String::from_utf8_lossy(&answer.out).into_owned()
}

/// Floats of 24 bits are off by up to 0.00006 mm in a metre, which turns bones of 0.3 m by less than 1e-4 degrees.
#[test]
fn a_trial_is_tracked_from_c3d_as_from_trc() {
    let Some(base) = shared("cases/reading/00-base") else { return };
    let folder = Folder::new("c3d-track");
    let trial = std::fs::read_dir(&base).unwrap().filter_map(|entry| {
        let path = entry.ok()?.path();
        path.extension().is_some_and(|ending| ending == "trc").then_some(path)
    });
    let trial = trial.min().expect("a trial of the arm");
    let made = folder.condyle(&["convert", text(&trial), "t.c3d"]);
    assert_eq!(made.code, 0, "{}", made.err);
    let arm = base.join("arm.osim");
    let mut tables = vec![];
    for (trial, motion) in [(text(&trial), "a.mot"), ("t.c3d", "b.mot")] {
        let answer = folder.condyle(&["track", text(&arm), trial, "-o", motion]);
        assert_eq!(answer.code, 0, "{}", answer.err);
        let bytes = std::fs::read(folder.path().join(motion)).unwrap();
        tables.push(sto::from_bytes(&bytes).unwrap().value);
    }
    assert_eq!(tables[0].columns, tables[1].columns);
    assert_eq!(tables[0].values.len(), tables[1].values.len());
    for (a, b) in tables[0].values.iter().zip(&tables[1].values) {
        assert!((a - b).abs() < 1e-4, "{a} {b}");
    }
}

#[test]
fn a_c3d_is_converted_with_all_its_points_and_its_channels() {
    let Some(file) = shared("data/spine/biomechzoo_HC030A_straight.c3d") else { return };
    let folder = Folder::new("c3d-convert");
    let all = folder.condyle(&["convert", text(&file), "all.trc"]);
    assert_eq!(all.code, 0, "{}", all.err);
    assert!(all.err.contains("55 angles (deg), 20 forces (N), 18 moments (Nmm)"), "{}", all.err);
    let few = folder.condyle(&["convert", text(&file), "few.trc", "--markers-only"]);
    assert_eq!(few.code, 0, "{}", few.err);
    // 291 points by the header, 111 of them in the lists of other kinds.
    for (name, count) in [("all.trc", 291), ("few.trc", 180)] {
        let bytes = std::fs::read(folder.path().join(name)).unwrap();
        let read = trc::from_bytes(&bytes).unwrap().value;
        assert_eq!((read.labels.len(), read.units), (count, LengthUnit::Millimetre), "{name}");
    }
    let channels = folder.condyle(&["convert", text(&file), "analog.sto", "--analog"]);
    assert_eq!(channels.code, 0, "{}", channels.err);
    let bytes = std::fs::read(folder.path().join("analog.sto")).unwrap();
    assert_eq!(sto::from_bytes(&bytes).unwrap().value.times.len(), 1970);
    let again = folder.condyle(&["convert", text(&file), "again.c3d"]);
    assert_eq!(again.code, 0, "{}", again.err);
    let [first, second] = [file, folder.path().join("again.c3d")]
        .map(|path| c3d::from_bytes(&std::fs::read(path).unwrap()).unwrap().value);
    assert!(first.recording == second.recording && first.others == second.others);
    assert!(first.analog == second.analog && first.events() == second.events());
    let info = folder.condyle(&["info", "again.c3d"]);
    for told in [
        "angles (55, deg):",
        "analog channels (24, 1970 samples at 1000 Hz)",
        "events (8):",
        "type 2",
    ] {
        assert!(text_of(&info).contains(told), "{told}: {}", text_of(&info));
    }
}
