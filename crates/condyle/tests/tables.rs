//! The documents of `docs/tracking.md`, and the shipped tables of names against the shipped human.

use condyle::formats::document::{self, Kind, names, setup};
use condyle::{open, shipped};
use std::collections::HashSet;
use std::path::Path;

#[test]
fn the_documents_of_the_manual_are_read() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/tracking.md");
    let page = std::fs::read_to_string(path).unwrap();
    let texts: Vec<&str> =
        page.split("```toml\n").skip(1).map(|t| t.split("```").next().unwrap()).collect();
    let mut alone = |_: &str| Err("it stands alone".to_owned());
    let read = setup::read(texts[0], &mut alone).unwrap().value;
    assert_eq!((read.weights.len(), read.postures.len(), read.coordinates.len()), (3, 3, 1));
    // Every coordinate that it names is one of the human.
    let human = open::model(Path::new("human")).unwrap().value;
    for (name, _) in read.postures.iter().flat_map(|posture| &posture.coordinates) {
        assert!(human.find_coordinate(name).is_ok(), "{name}");
    }
    assert_eq!(names::read(texts[1], &mut alone).unwrap().value.len(), 2);
    assert_eq!(texts.len(), 2);
}

#[test]
fn shipped_tables_name_one_place_of_the_human_each() {
    let human = open::model(Path::new("human")).unwrap().value;
    let marker = |name: &str| human.markers().iter().find(|marker| marker.name == name);
    for table in shipped::name_tables() {
        let text = shipped::name_table(table).unwrap();
        assert_eq!(document::kind(text), Some(Kind::Names), "{table}");
        let entries = open::names(Path::new(table)).unwrap().value;
        let labels: HashSet<&str> = entries.iter().map(|(label, _)| label.as_str()).collect();
        assert_eq!(labels.len(), entries.len(), "{table} has a label twice");
        for (label, names) in &entries {
            assert!(names.len() > 1 && names[0] == *label, "{table}: {label}");
            // Names that the human has are one landmark: one segment, one place.
            let known: Vec<_> = names.iter().filter_map(|name| marker(name)).collect();
            assert!(!known.is_empty(), "{table}: the human has no {label}");
            for other in &known {
                assert_eq!(other.segment, known[0].segment, "{table}: {label}");
                let off = (other.point - known[0].point).norm();
                assert!(off < 1e-9, "{table}: {label} is {off} m off");
            }
        }
    }
}
