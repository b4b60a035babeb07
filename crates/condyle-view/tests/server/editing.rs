//! The page edits, an editor edits, and the page hears of it.

use super::{LEG, Running};
use serde_json::{Value, json};
use std::time::Duration;

fn soon(events: &std::sync::mpsc::Receiver<Value>) -> Value {
    events.recv_timeout(Duration::from_secs(30)).expect("an event")
}

#[test]
fn an_edit_changes_one_number_and_tells_all_pages() {
    let server = Running::start("edit");
    let events = server.events();
    let at = json!(["segment", "shank_r", "at", 1]);
    let (status, said) = server.post("edit", &json!({ "path": at, "value": -0.43 }));
    assert_eq!(status, 200, "{said}");
    assert_eq!(
        (&said["line"], &said["old"], &said["new"]),
        (&json!(8), &json!("-0.420"), &json!("-0.43"))
    );
    assert_eq!(said["mirrored"], json!([["segment", "shank_l", "at", 1]]));
    assert_eq!(server.text(), LEG.replace("-0.420", "-0.43"));
    assert_eq!(soon(&events), json!({ "kind": "model" }));
    let session = String::from_utf8(server.get("session.json").body).unwrap();
    assert_eq!(session.matches("-0.43").count(), 2, "both sides");
    let (status, _) = server.post("undo", &json!(null));
    assert_eq!((status, server.text().as_str()), (200, LEG));
    let (status, _) = server.post("redo", &json!(null));
    assert_eq!((status, server.text()), (200, LEG.replace("-0.420", "-0.43")));
    assert_eq!(server.post("redo", &json!(null)).0, 422);
}

#[test]
fn a_value_that_is_not_plain_is_asked_about_first() {
    let server = Running::start("confirm");
    let at = json!(["segment", "foot_r", "at", 1]);
    let (status, said) = server.post("edit", &json!({ "path": at, "value": -0.41 }));
    assert_eq!((status, &said["needs"]), (409, &json!("confirm")));
    assert_eq!(said["sentence"], json!("writes constant `shank` (leg.toml:5)"));
    assert_eq!(server.text(), LEG);
    let (status, _) = server.post("edit", &json!({ "path": at, "value": -0.41, "confirm": true }));
    assert_eq!((status, server.text()), (200, LEG.replace("0.400", "0.41")));
    // The mirrored side is asked about, too, and written where it comes from.
    let left = json!(["segment", "shank_l", "at", 2]);
    let (status, said) = server.post("edit", &json!({ "path": left, "value": 0.09 }));
    assert_eq!(status, 409);
    assert!(
        said["sentence"]
            .as_str()
            .unwrap()
            .starts_with("`segment.shank_l.at[2]` is the mirror image of `segment.shank_r.at[2]`")
    );
    let (status, _) = server.post("edit", &json!({ "path": left, "value": 0.09, "confirm": true }));
    assert_eq!(
        (status, server.text()),
        (200, LEG.replace("0.400", "0.41").replace("0.083", "0.09"))
    );
    // A point moves in one step, and is undone in one.
    let at = json!(["segment", "shank_r", "at"]);
    let before = server.text();
    let (status, _) = server.post("edit", &json!({ "path": at, "value": [0.01, -0.420, 0.1] }));
    assert_eq!(
        (status, server.text()),
        (200, before.replace("[0, -0.420, 0.09]", "[0.01, -0.420, 0.1]"))
    );
    assert_eq!(server.post("undo", &json!(null)).0, 200);
    assert_eq!(server.text(), before);
}

#[test]
fn what_would_not_load_is_refused_with_its_line() {
    let server = Running::start("fault");
    let range = json!(["joint", "ankle_r", "coordinate", "ankle_r", "range", 1]);
    let (status, said) = server.post("edit", &json!({ "path": range, "value": -60 }));
    assert_eq!((status, &said["fault"]["line"]), (422, &json!(17)), "{said}");
    assert!(said["fault"]["excerpt"].as_str().unwrap().contains("range = [-50, -60]"), "{said}");
    assert_eq!(server.text(), LEG);
    let wire =
        json!({ "kind": "wire", "path": ["joint_set", "none", "output", "foot_r"], "value": "x" });
    assert_eq!(server.post("add", &wire).0, 422);
    assert_eq!(server.text(), LEG);
    let toe = json!({ "kind": "segment", "name": "toe_r", "parent": "foot_r", "at": [0.1, 0, 0] });
    let (status, said) = server.post("add", &toe);
    assert_eq!(status, 200, "{said}");
    assert_eq!(
        server.text(),
        format!("{LEG}\n[segment.toe_r]\nparent = \"foot_r\"\nat = [0.1, 0, 0]\n")
    );
    assert!(String::from_utf8(server.get("session.json").body).unwrap().contains("toe_l"));
}

#[test]
fn a_file_that_an_editor_changes_breaks_and_mends_is_told() {
    let server = Running::start("editor");
    let events = server.events();
    std::fs::write(&server.file, LEG.replace("-0.420", "-0.5")).unwrap();
    assert_eq!(soon(&events), json!({ "kind": "model" }));
    std::fs::write(&server.file, LEG.replace("parent", "parnet")).unwrap();
    let fault = soon(&events);
    assert_eq!(
        (&fault["kind"], &fault["line"], &fault["column"]),
        (&json!("fault"), &json!(10), &json!(1)),
        "{fault}"
    );
    assert!(fault["excerpt"].as_str().unwrap().contains("did you mean `parent`?"));
    // The last good model is still there, and who comes now hears what is wrong.
    assert!(String::from_utf8(server.get("session.json").body).unwrap().contains("-0.5"));
    let late = server.events();
    assert_eq!(soon(&late)["kind"], json!("fault"));
    // What the editor wrote is not overwritten.
    let at = json!(["segment", "shank_r", "at", 1]);
    let (status, said) = server.post("edit", &json!({ "path": at, "value": -0.43 }));
    assert_eq!((status, &said["needs"]), (409, &json!("reload")));
    assert_eq!(server.text(), LEG.replace("parent", "parnet"));
    std::fs::write(&server.file, LEG).unwrap();
    assert_eq!(soon(&events), json!({ "kind": "mended" }));
    assert_eq!(soon(&events), json!({ "kind": "model" }));
    assert_eq!(server.post("edit", &json!({ "path": at, "value": -0.43 })).0, 200);
}

#[test]
fn a_shipped_model_gets_a_file_of_the_users() {
    let folder = std::env::temp_dir().join(format!("condyle-view-{}-shipped", std::process::id()));
    let _ = std::fs::remove_dir_all(&folder);
    std::fs::create_dir_all(&folder).unwrap();
    let file = folder.join("knee-edited.toml");
    let server = Running::of(folder, "knee".into(), file.clone());
    let list: Value = serde_json::from_slice(&server.get("editable.json").body).unwrap();
    assert_eq!((&list["file"], &list["there"]), (&json!("knee-edited.toml"), &json!(false)));
    let values = list["values"].as_array().unwrap();
    assert!(values.iter().all(|value| value["origin"]["kind"] == "shipped"));
    let marker = values.iter().find(|v| v["path"][0] == "marker" && v["value"] != 0).unwrap();
    let edit = json!({ "path": marker["path"], "value": marker["value"].as_f64().unwrap() + 0.01 });
    let (status, said) = server.post("edit", &edit);
    assert_eq!(status, 409);
    assert!(
        said["sentence"].as_str().unwrap().contains("which includes the shipped `knee`"),
        "{said}"
    );
    assert!(!file.exists());
    let mut edit = edit;
    edit["confirm"] = json!(true);
    assert_eq!(server.post("edit", &edit).0, 200);
    let text = server.text();
    assert!(text.contains("include = [\"knee\"]") && text.contains("[marker."), "{text}");
}
