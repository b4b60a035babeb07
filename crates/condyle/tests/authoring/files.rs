//! Files: undo, other programs that write at the same time, shipped models, links and modes.

use super::path;
use condyle::authoring::{Authoring, AuthoringError};
use condyle::formats::document::edit::WayKind;
use condyle::{open, shipped};
use std::path::PathBuf;

const TEXT: &str = "condyle = 1\nkind = \"model\"\n# A leg.\n[segment.shank]\nat = [0, -0.420, 0]\n[segment.foot]\nparent = \"shank\"\n";

/// A folder of its own, which is removed at the end.
struct Folder(PathBuf);

impl Folder {
    fn new(name: &str) -> Self {
        let path =
            std::env::temp_dir().join(format!("condyle-authoring-{}-{name}", std::process::id()));
        let _ = std::fs::remove_dir_all(&path);
        std::fs::create_dir_all(&path).unwrap();
        Self(path)
    }

    fn file(&self, name: &str, text: &str) -> PathBuf {
        let path = self.0.join(name);
        std::fs::write(&path, text).unwrap();
        path
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir_all(&self.0);
    }
}

fn text(path: &std::path::Path) -> String {
    std::fs::read_to_string(path).unwrap()
}

#[test]
fn edits_are_undone_and_done_again_byte_for_byte() {
    let folder = Folder::new("undo");
    let file = folder.file("leg.toml", TEXT);
    let mut leg = Authoring::open(&file).unwrap();
    let at = path("segment.shank.at.1");
    let texts: Vec<String> = [-0.43, -0.44, -0.45]
        .map(|value| {
            let written = leg.set(&at, value, None).unwrap();
            assert_eq!((written.line, written.file.as_path()), (5, file.as_path()));
            text(&file)
        })
        .to_vec();
    assert_eq!(texts[2], TEXT.replace("-0.420", "-0.45"));
    leg.undo().unwrap();
    assert_eq!(text(&file), texts[1]);
    assert_eq!(leg.editing().find(&at).unwrap().value, -0.44);
    leg.undo().unwrap();
    leg.undo().unwrap();
    assert_eq!(text(&file), TEXT);
    assert!(matches!(leg.undo(), Err(AuthoringError::Impossible(_))));
    for expected in &texts {
        leg.redo().unwrap();
        assert_eq!(text(&file), *expected);
    }
    assert!(matches!(leg.redo(), Err(AuthoringError::Impossible(_))));
    let left: Vec<_> = std::fs::read_dir(&folder.0).unwrap().collect();
    assert_eq!(left.len(), 1, "nothing is left beside the file");
}

#[test]
fn what_another_program_wrote_is_never_overwritten() {
    let folder = Folder::new("editor");
    let file = folder.file("leg.toml", TEXT);
    let mut leg = Authoring::open(&file).unwrap();
    let at = path("segment.shank.at.1");
    leg.set(&at, -0.43, None).unwrap();
    let theirs = TEXT.replace("-0.420", "-0.5") + "# edited\n";
    std::fs::write(&file, &theirs).unwrap();
    assert!(matches!(leg.set(&at, -0.44, None), Err(AuthoringError::Changed(_))));
    assert!(matches!(leg.undo(), Err(AuthoringError::Changed(_))));
    assert!(matches!(
        leg.put(&["segment".into(), "toe".into(), "parent".into()], "\"foot\""),
        Err(AuthoringError::Changed(_))
    ));
    assert_eq!(text(&file), theirs);
    assert_eq!(leg.reload(), Ok(true));
    assert_eq!(leg.reload(), Ok(false));
    leg.set(&at, -0.44, None).unwrap();
    assert_eq!(text(&file), theirs.replace("-0.5", "-0.44"));
    std::fs::remove_file(&file).unwrap();
    assert!(matches!(leg.set(&at, -0.45, None), Err(AuthoringError::Io(..))));
    assert!(!file.exists());
}

#[test]
fn a_broken_file_keeps_the_last_good_model_and_says_where_it_is_wrong() {
    let folder = Folder::new("broken");
    let file = folder.file("leg.toml", TEXT);
    let mut leg = Authoring::open(&file).unwrap();
    std::fs::write(&file, TEXT.replace("parent", "parnet")).unwrap();
    let fault = leg.reload().unwrap_err();
    assert_eq!((fault.line, fault.column), (7, 1));
    assert!(
        fault.excerpt.contains("7 | parnet = \"shank\"\n  | ^^^^^^ did you mean `parent`?"),
        "{}",
        fault.excerpt
    );
    assert_eq!(leg.editing().values().len(), 3);
    std::fs::write(&file, TEXT).unwrap();
    assert_eq!(leg.reload(), Ok(false), "the file is as it was read");
    // An edit that would break it leaves it as it is.
    let wrong = leg.put(&["segment".into(), "foot".into(), "parent".into()], "\"shin\"");
    let Err(AuthoringError::Fault(fault)) = wrong else { panic!("an unknown parent") };
    assert_eq!((fault.line, fault.column), (7, 10));
    assert_eq!(text(&file), TEXT);
}

#[test]
fn the_first_edit_of_a_shipped_model_makes_a_file_that_includes_it() {
    let folder = Folder::new("shipped");
    folder.file("knee-edited.toml", "another file");
    let mut knee = Authoring::open_in("knee".as_ref(), &folder.0).unwrap();
    let file = folder.0.join("knee-edited-2.toml");
    assert!(!knee.is_file() && !file.exists() && knee.path() == file);
    // Before the first edit the model is the shipped one.
    assert_eq!(knee.editing().document().model, shipped::read("knee").unwrap().value.model);
    let value = knee
        .editing()
        .values()
        .iter()
        .find(|v| v.path.first() == path("segment").first() && v.value != 0.0);
    let value = value.unwrap().clone();
    let question = knee.question(&value.path, Some(WayKind::Override)).unwrap();
    assert!(
        question.contains("includes the shipped `knee`") && question.contains("in place of"),
        "{question}"
    );
    knee.set(&value.path, value.value + 0.01, Some(WayKind::Override)).unwrap();
    assert!(knee.is_file() && text(&file).contains("include = [\"knee\"]"));
    let model = open::model(&file).unwrap().value;
    assert_ne!(model, shipped::read("knee").unwrap().value.model);
    assert_eq!(model, knee.editing().document().model);
    knee.undo().unwrap();
    assert_eq!(open::model(&file).unwrap().value, shipped::read("knee").unwrap().value.model);
    knee.redo().unwrap();
    assert_eq!(open::model(&file).unwrap().value, model);
    assert_eq!(text(&folder.0.join("knee-edited.toml")), "another file");
}

#[cfg(unix)]
#[test]
fn links_are_followed_and_modes_stay() {
    use std::os::unix::fs::PermissionsExt;
    let folder = Folder::new("links");
    let file = folder.file("leg.toml", TEXT);
    std::fs::set_permissions(&file, std::fs::Permissions::from_mode(0o640)).unwrap();
    let link = folder.0.join("link.toml");
    std::os::unix::fs::symlink(&file, &link).unwrap();
    Authoring::open(&link).unwrap().set(&path("segment.shank.at.1"), -0.43, None).unwrap();
    assert!(std::fs::symlink_metadata(&link).unwrap().is_symlink());
    assert_eq!(text(&file), TEXT.replace("-0.420", "-0.43"));
    assert_eq!(std::fs::metadata(&file).unwrap().permissions().mode() & 0o777, 0o640);
}
