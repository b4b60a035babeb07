//! Shipped models by their names.

use condyle::formats::document;
use condyle::{Mode, Model, Pose, Program, open, shipped};
use std::path::Path;

#[test]
fn every_text_of_the_folder_has_its_name() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("models");
    let mut files: Vec<String> = std::fs::read_dir(folder)
        .expect("the folder of models")
        .map(|entry| entry.expect("a file").file_name().into_string().expect("a name in Unicode"))
        .filter_map(|file| file.strip_suffix(".toml").map(str::to_owned))
        .collect();
    files.sort();
    let names: Vec<&str> = shipped::names().collect();
    assert_eq!(names, files, "give each file a line in the table of shipped.rs, by name");
}

/// Asserts that two models are the same to rounding: a turn that is written as three angles is not
/// read back to the last bit.
#[track_caller]
fn same(name: &str, copy: &Model, model: &Model) {
    let named = |model: &Model| -> Vec<String> {
        let segments = model.segments().iter().map(|s| s.name.clone());
        segments.chain(model.joint_sets().iter().map(|s| s.name.clone())).collect()
    };
    assert_eq!(named(copy), named(model), "{name}");
    assert!(copy.coordinates() == model.coordinates(), "{name}");
    assert!(copy.closures().len() == model.closures().len(), "{name}");
    let posed = |model: &Model, share: f64| {
        let program = Program::compile(model);
        let mut pose = Pose::new(&program);
        let mut stored = model.defaults();
        for (id, c) in model.coordinate_ids().zip(model.coordinates()) {
            if let (Some(low), Some(high)) = (c.range.lower, c.range.upper) {
                *model.value_mut(&mut stored, id) = low + (high - low) * share;
            }
        }
        program.evaluate(&stored, Mode::Open, &mut pose).expect("buffers of this program");
        let markers = model.markers().iter().map(|m| pose.frame(m.segment) * m.point);
        let markers: Vec<f64> = markers.flat_map(|p| p.to_array()).collect();
        pose.segments().iter().flat_map(|t| t.to_rows()).chain(markers).collect::<Vec<f64>>()
    };
    for share in [0.2, 0.7] {
        let (copy, model) = (posed(copy, share), posed(model, share));
        assert_eq!(copy.len(), model.len(), "{name}");
        let off = copy.iter().zip(&model).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(off < 1e-13, "{name}: {off}");
    }
}

#[test]
fn every_model_opens_by_name_and_its_copy_stands_alone() {
    for name in shipped::names() {
        let read = open::model(Path::new(name)).expect(name);
        assert_eq!(read.warnings, [], "{name}");
        let text = shipped::text(name).expect(name);
        let own = shipped::read(name).expect(name).value;
        assert!(own.text == text && own.model == read.value, "{name}");
        let copy = shipped::standalone(name).expect(name);
        let mut alone = |file: &str| Err(format!("`{file}` is not here"));
        let again = document::read(&copy, &mut alone).unwrap_or_else(|e| panic!("{name}: {e:?}"));
        same(name, &again.value.model, &read.value);
        // A text that includes nothing is given as it is; of others at least the head stays.
        if copy != text {
            assert!(text.contains("\ninclude = "), "{name}");
            let head: Vec<&str> = text.lines().take_while(|line| line.starts_with('#')).collect();
            assert!(!head.is_empty() && copy.starts_with(&head.join("\n")), "{name}");
        }
    }
}

#[test]
fn a_word_that_is_nothing_is_told_what_there_is() {
    let error = open::model(Path::new("spnie")).expect_err("no model");
    let said = error.to_string();
    assert!(matches!(error.cause, open::Cause::Unknown));
    let start =
        "`spnie` is neither a file nor a shipped model (did you mean `spine`? shipped are arms, ";
    assert!(said.starts_with(start), "{said}");
    assert!(shipped::names().all(|name| said.contains(name)), "{said}");
    let far = open::model(Path::new("xylophone")).expect_err("no model").to_string();
    assert!(!far.contains("did you mean"), "{far}");
    // What has an ending or a folder is a path.
    for path in ["spine.toml", "models/spine", ""] {
        let error = open::model(Path::new(path)).expect_err("no file");
        assert!(!matches!(error.cause, open::Cause::Unknown), "{path}");
    }
}

#[test]
fn the_page_says_how_large_each_model_is() {
    let page = include_str!("../../../../docs/shipped-models.md");
    let mut rows = page.lines().filter(|line| line.starts_with("| `"));
    for name in shipped::names() {
        let model = open::model(Path::new(name)).expect(name).value;
        let row = rows.next().unwrap_or_else(|| panic!("{name} has no row"));
        let cells: Vec<&str> = row.split('|').map(str::trim).collect();
        let (segments, coordinates) = (model.segments().len(), model.coordinates().len());
        let expected = [format!("`{name}`"), segments.to_string(), coordinates.to_string()];
        assert_eq!([cells[1], cells[3], cells[4]], expected.each_ref().map(String::as_str));
    }
    assert_eq!(rows.next(), None);
}
