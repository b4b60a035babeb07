//! Model documents: everything that takes a model takes them.

use super::{Folder, leg, number};
use serde_json::Value;

#[test]
fn a_converted_model_poses_tracks_and_describes_itself_as_before() {
    let folder = Folder::with_leg("document-convert");
    assert_eq!(folder.condyle(&["convert", "leg.osim", "leg.toml"]).expect(0), "");
    folder.write("m.mot", leg::mot(5));
    let poses = ["leg.osim", "leg.toml"].map(|model| {
        let frames = folder.condyle(&["fk", model, "--motion", "m.mot"]).json()["frames"].clone();
        frames.as_array().expect("frames").clone()
    });
    assert_eq!(poses[0].len(), poses[1].len());
    for (a, b) in poses[0].iter().zip(&poses[1]) {
        for (name, rows) in a["segments"].as_object().expect("segments") {
            let other = b["segments"][name].as_array().expect("rows");
            for (a, b) in rows.as_array().expect("rows").iter().zip(other) {
                assert!((number(a) - number(b)).abs() < 1e-12, "{name}: {a} and {b}");
            }
        }
    }
    let info = |model| folder.condyle(&["info", model, "--json"]).json();
    let (osim, toml) = (info("leg.osim"), info("leg.toml"));
    for key in ["name", "up", "segments", "coordinates", "markers", "closures", "postures"] {
        assert_eq!(osim[key], toml[key], "{key}");
    }
    // A document is saved as it was, and a scene is made of it.
    folder.condyle(&["convert", "leg.toml", "again.toml"]).expect(0);
    assert_eq!(folder.read("leg.toml"), folder.read("again.toml"));
    folder.condyle(&["convert", "leg.toml", "leg.glb"]).expect(0);
    assert!(folder.condyle(&["convert", "m.mot", "m.toml"]).refused().contains("known are"));
    folder.condyle(&["convert", "m.mot", "markers.trc", "--model", "leg.osim"]).expect(0);
    let tracked = ["leg.osim", "leg.toml"].map(|model| {
        folder
            .condyle(&["track", model, "markers.trc", "-o", "out.csv", "--report", "r.json"])
            .expect(0);
        let report: Value = serde_json::from_str(&folder.read("r.json")).expect("a report");
        number(&report["rms_m"])
    });
    assert!((tracked[0] - tracked[1]).abs() < 1e-9, "{tracked:?}");
}

#[test]
fn several_errors_are_shown_with_their_lines() {
    let folder = Folder::new("document-wrong");
    let head = "condyle = 1\nkind = \"model\"\n";
    let body = "[segment.thigh]\nparnet = \"x\"\n[segment.\"é\"]\nat = 1\n";
    folder.write("leg.toml", format!("{head}{body}"));
    assert_eq!(
        folder.condyle(&["info", "leg.toml"]).refused(),
        "error: leg.toml:4:1: unknown key `parnet` in [segment.thigh]
  |
4 | parnet = \"x\"
  | ^^^^^^ did you mean `parent`?
error: leg.toml:6:6: `at` is a number
  |
6 | at = 1
  |      ^ give a list
"
    );
}

#[test]
fn what_is_included_stands_beside() {
    let folder = Folder::new("document-include");
    let head = "condyle = 1\nkind = \"model\"\n";
    std::fs::create_dir_all(folder.path().join("parts")).expect("a folder");
    folder.write(
        "leg.toml",
        format!("\u{feff}{head}include = [\"parts/foot.toml\"]\n[segment.shank]\n"),
    );
    folder.write(
        "parts/foot.toml",
        format!("{head}[segment.foot]\nparent = \"shank\"\nat = [1, 2, 3]\n"),
    );
    let info = folder.condyle(&["info", "leg.toml", "--json"]).json();
    assert_eq!(info["segments"].as_array().map(Vec::len), Some(2));
    folder.write("leg.toml", format!("{head}include = [\"gone.toml\"]\n"));
    let said = folder.condyle(&["fk", "leg.toml"]).refused();
    assert!(said.contains("leg.toml:3:12: `gone.toml` cannot be included"), "{said}");
    folder.write("leg.toml", [0x63, 0x0a, 0xff]);
    assert!(
        folder.condyle(&["fk", "leg.toml"]).refused().contains("leg.toml:2: the text is not UTF-8")
    );
}
