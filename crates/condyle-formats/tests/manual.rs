//! The manual of the text format: every document in it is read, every message is what is said.
//!
//! A block of `toml` must load, or be followed by a block `error:` with what is wrong with it. A
//! block with a file's name behind `toml` is what others include.

use condyle_formats::document::{self, render};
use condyle_math::{Affine, Mat3, Scalar, Vec3};
use condyle_model::component::{MotionLaw, Registry};
use serde_json::Value;
use std::collections::{BTreeMap, BTreeSet, HashMap};
use std::path::{Path, PathBuf};

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/model-format")
}

/// The law that the manual speaks of.
#[derive(Debug)]
struct Cam {
    lift: f64,
}

impl MotionLaw for Cam {
    fn transform<S: Scalar>(&self, inputs: &[S]) -> Affine<S> {
        let (s, c) = inputs[0].sin_cos();
        let lift = (S::one() - c).scale(self.lift);
        let turn = Mat3::rotation_about(Vec3::Z.cast(), (s, c));
        Affine::new(turn, Vec3::new(S::zero(), lift, S::zero()))
    }
}

fn laws() -> Registry {
    let mut laws = Registry::default();
    laws.register("cam", &["angle"], |parameters| {
        let lift = parameters.get("lift").and_then(|list| list.first());
        Ok(Cam { lift: *lift.ok_or("it needs a `lift` in metres")? })
    });
    laws
}

/// The fenced blocks of a page: what stands behind the fence, the text, the line.
fn blocks(page: &str) -> Vec<(String, String, usize)> {
    let mut blocks = vec![];
    let mut open: Option<(String, String, usize)> = None;
    for (number, line) in page.lines().enumerate() {
        match (&mut open, line.strip_prefix("```")) {
            (None, Some(info)) => open = Some((info.to_owned(), String::new(), number + 1)),
            (Some(_), Some(_)) => blocks.extend(open.take()),
            (Some((_, text, _)), None) => {
                text.push_str(line);
                text.push('\n');
            }
            (None, None) => {}
        }
    }
    blocks
}

#[test]
fn every_document_of_the_manual_is_read() {
    let (mut good, mut bad) = (0, 0);
    let laws = laws();
    for entry in std::fs::read_dir(folder()).unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_none_or(|e| e != "md") {
            continue;
        }
        let page = path.file_name().unwrap().to_string_lossy().into_owned();
        let blocks = blocks(&std::fs::read_to_string(&path).unwrap());
        let files: HashMap<&str, &str> = blocks
            .iter()
            .filter_map(|(info, text, _)| Some((info.strip_prefix("toml ")?, text.as_str())))
            .collect();
        for (index, (info, text, line)) in blocks.iter().enumerate() {
            if info != "toml" {
                continue;
            }
            let mut include = |name: &str| {
                let text = files.get(name).ok_or("it is not there")?;
                Ok((*text).to_owned())
            };
            let read = document::read_with(text, &mut include, &laws);
            let expected = blocks.get(index + 1).filter(|(info, ..)| info == "error:");
            match (read, expected) {
                (Ok(read), None) => {
                    assert_eq!(read.warnings, [], "{page}:{line}");
                    good += 1;
                }
                (Err(errors), Some((_, expected, line))) => {
                    let said = render("model.toml", text, &errors);
                    assert!(said == *expected, "{page}:{line} should be\n{said}");
                    bad += 1;
                }
                (Ok(_), Some(_)) => panic!("{page}:{line}: nothing is wrong with it"),
                (Err(errors), None) => {
                    panic!("{page}:{line}:\n{}", render("model.toml", text, &errors))
                }
            }
        }
    }
    assert!(good > 5 && bad > 4, "{good} documents and {bad} errors");
}

/// Each component has a section that gives its formula, units and kinks and uses it in a document.
#[test]
fn every_component_has_a_section() {
    let mut sections: HashMap<String, String> = HashMap::new();
    for entry in std::fs::read_dir(folder()).unwrap() {
        let path = entry.unwrap().path();
        let name = path.file_name().unwrap().to_string_lossy().into_owned();
        if !name.starts_with("component-") {
            continue;
        }
        let page = std::fs::read_to_string(&path).unwrap();
        for section in page.split("\n## ").skip(1) {
            let (title, text) = section.split_once('\n').unwrap();
            sections.insert(title.trim_matches('`').to_owned(), text.to_owned());
        }
    }
    let index = std::fs::read_to_string(folder().join("components.md")).unwrap();
    for (table, keys) in document::keys() {
        let Some(kind) = table.strip_prefix("component.") else { continue };
        let text = sections.remove(kind).unwrap_or_else(|| panic!("no section on {kind}"));
        assert!(index.contains(&format!("#{kind})")), "components.md does not link {kind}");
        for part in ["```text\n", "- **Units:**", "- **Kinks:**", "- **Keys:**"] {
            assert!(text.contains(part), "{kind} lacks {part}");
        }
        for key in keys {
            assert!(text.contains(&format!("`{key}`")), "{kind} does not speak of `{key}`");
        }
        let documents = blocks(&text).into_iter().filter(|(info, ..)| info == "toml");
        let uses = documents.filter(|(_, text, _)| text.contains(&format!(".{kind}]")));
        assert!(uses.count() > 0, "{kind} is not shown");
    }
    assert!(sections.is_empty(), "sections on nothing: {:?}", sections.keys());
}

#[test]
fn the_manual_speaks_of_every_key() {
    let mut text = String::new();
    for entry in std::fs::read_dir(folder()).unwrap() {
        text += &std::fs::read_to_string(entry.unwrap().path()).unwrap();
    }
    for (table, keys) in document::keys() {
        for key in keys {
            assert!(text.contains(key), "{key} of {table}");
        }
    }
}

/// The schema's tables by name, with their keys: the top, and what stands under `$defs`.
fn schema_keys(schema: &Value) -> BTreeMap<String, BTreeSet<String>> {
    let names = |table: &Value| -> BTreeSet<String> {
        table["properties"].as_object().unwrap().keys().cloned().collect()
    };
    let mut tables = BTreeMap::from([("model".to_owned(), names(schema))]);
    for (name, table) in schema["$defs"].as_object().unwrap() {
        if table.get("properties").is_some() {
            assert_eq!(table["additionalProperties"], false, "{name}");
            tables.insert(name.clone(), names(table));
        }
    }
    tables
}

#[test]
fn the_schema_has_the_keys_of_the_reader() {
    let text = std::fs::read_to_string(folder().join("model.schema.json")).unwrap();
    let schema: Value = serde_json::from_str(&text).unwrap();
    let known: BTreeMap<String, BTreeSet<String>> = document::keys()
        .into_iter()
        .map(|(table, keys)| (table, keys.into_iter().map(str::to_owned).collect()))
        .collect();
    let mut tables = schema_keys(&schema);
    // One table per component, of which a component has one.
    let kinds = tables.remove("component").unwrap();
    let named = known.keys().filter_map(|k| k.strip_prefix("component."));
    assert_eq!(kinds, named.map(str::to_owned).collect());
    assert_eq!(tables, known);
}
