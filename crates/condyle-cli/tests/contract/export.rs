//! `condyle export page`.

use super::Folder;
use serde_json::Value;

/// What a page was given: the JSON of its element `session`.
fn session(html: &str) -> Value {
    let (_, rest) = html.split_once("id=\"session\">").expect("a session");
    let (json, _) = rest.split_once("</script>").expect("its end");
    serde_json::from_str(json).expect("JSON")
}

#[test]
fn a_page_holds_the_model_and_its_motion_and_names_nothing_outside() {
    let folder = Folder::with_leg("export");
    folder.write("m.csv", "time,knee_angle\n0,-0.5\n0.25,-1\n");
    let answer = folder.condyle(&["export", "page", "leg.osim", "m.csv", "-o", "x.html"]);
    assert_eq!((answer.code, answer.out.len()), (0, 0), "{}", answer.err);
    let html = std::fs::read_to_string(folder.path().join("x.html")).expect("a page");
    assert!(html.starts_with("<!doctype html>"));
    assert!(!html.contains("src=\"assets/"), "everything is inside");
    let session = session(&html);
    assert_eq!((&session["mode"], &session["title"]), (&"exported".into(), &"leg".into()));
    assert!(session["model"]["text"].as_str().is_some_and(|text| text.contains("knee_angle")));
    assert_eq!(session["motions"][0]["name"], "m.csv");
    assert_eq!(session["motions"][0]["times"], serde_json::json!([0.0, 0.25]));
}

#[test]
fn a_title_is_text_and_no_markup() {
    let folder = Folder::with_leg("export-title");
    let title = "</script><b>";
    let arguments = ["export", "page", "leg.osim", "--title", title, "-o", "-"];
    let html = folder.condyle(&arguments).expect(0);
    assert_eq!(session(&html)["title"], title);
}

#[test]
fn what_cannot_be_opened_is_refused_and_nothing_is_written() {
    let folder = Folder::with_leg("export-refused");
    folder.condyle(&["export", "page", "humann", "-o", "x.html"]).refused();
    folder.condyle(&["export", "page", "leg.osim", "none.mot", "-o", "x.html"]).refused();
    assert!(!folder.path().join("x.html").exists());
}
