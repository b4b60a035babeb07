//! Every number of every shipped model: the bytes that change are that number alone, and the model is that of a
//! document in which another program changed the number.

use super::{apart, part, posed, shipped_as_own};
use condyle::formats::document;
use condyle::formats::document::edit::{Editable, Editing, Origin, Refused, Step, WayKind};
use condyle::{Mode, shipped};
use std::collections::HashSet;

/// A value near another one.
fn near(value: f64) -> f64 {
    // As many digits as a person would write.
    let near = if value == 0.0 { 0.001 } else { value * 1.001 };
    format!("{near:.12}").parse().unwrap()
}

/// The only place at which two trees of TOML differ; `None` if they differ in more than one value or in their keys.
fn difference(a: &toml::Value, b: &toml::Value, path: &mut Vec<Step>, found: &mut Vec<Vec<Step>>) {
    match (a, b) {
        (toml::Value::Table(a), toml::Value::Table(b)) => {
            assert!(a.keys().eq(b.keys()), "keys differ at {path:?}");
            for ((key, a), b) in a.iter().zip(b.values()) {
                path.push(Step::Key(key.clone()));
                difference(a, b, path, found);
                path.pop();
            }
        }
        (toml::Value::Array(a), toml::Value::Array(b)) => {
            assert_eq!(a.len(), b.len(), "lists differ at {path:?}");
            for (index, (a, b)) in a.iter().zip(b).enumerate() {
                path.push(Step::Index(index));
                difference(a, b, path, found);
                path.pop();
            }
        }
        _ if a == b => {}
        _ => found.push(path.clone()),
    }
}

/// A value of a tree of TOML.
fn value_at<'v>(root: &'v mut toml::Value, path: &[Step]) -> &'v mut toml::Value {
    path.iter().fold(root, |here, step| match step {
        Step::Key(key) => here.get_mut(key).unwrap(),
        Step::Index(index) => here.get_mut(*index).unwrap(),
    })
}

/// Changes one number and compares with what `toml` makes of it; whether the model still loads with it.
fn check(
    name: &str,
    editing: &Editing,
    editable: &Editable,
    way: WayKind,
    given: &dyn Fn(&str) -> Result<String, String>,
) -> bool {
    let value = near(editable.value);
    let told = || format!("{name}: {:?} by {way:?} to {value}", editable.path);
    let edited = match editing.set(&editable.path, value, Some(way)) {
        Ok(edited) => edited,
        Err(Refused::Fault { .. } | Refused::Impossible(_)) => return false,
        Err(other) => panic!("{}: {other}", told()),
    };
    let before = editing.source(&edited.change.file).unwrap();
    let after = edited.next.source(&edited.change.file).unwrap();
    // That number alone: what stands before and after it is the same, byte for byte.
    let (at, old, new) = (edited.change.at, &edited.change.old, &edited.change.new);
    assert_eq!(before.text[..at], after.text[..at], "{}", told());
    assert_eq!(before.text[at + old.len()..], after.text[at + new.len()..], "{}", told());
    if way != WayKind::Number {
        assert!(old.parse::<f64>().is_ok(), "{}: {old} is no number", told());
    }
    assert!(new.parse::<f64>().is_ok(), "{}: {new} is no number", told());
    for source in editing.sources() {
        if source.name != edited.change.file {
            assert_eq!(Some(source), edited.next.source(&source.name), "{}", told());
        }
    }
    // Another program finds one value that differs, and changes it itself.
    let tree = |text: &str| toml::Value::Table(text.parse::<toml::Table>().unwrap());
    let (mut own, theirs) = (tree(&before.text), tree(&after.text));
    let mut places = vec![];
    difference(&own, &theirs, &mut vec![], &mut places);
    assert_eq!(places.len(), 1, "{}: {places:?}", told());
    if editable.origin == Origin::Plain {
        assert_eq!(places[0], editable.path, "{}", told());
        *value_at(&mut own, &editable.path) = toml::Value::Float(value);
    } else {
        let mut theirs = theirs;
        *value_at(&mut own, &places[0]) = value_at(&mut theirs, &places[0]).clone();
    }
    let text = toml::to_string(&own).unwrap();
    let changed = edited.change.file.as_str();
    let mut include =
        |wanted: &str| if wanted == changed { Ok(text.clone()) } else { given(wanted) };
    let root = if changed.is_empty() { &text } else { editing.text() };
    let oracle = document::read(root, &mut include).unwrap_or_else(|e| panic!("{}: {e}", told()));
    for mode in [Mode::Posed, Mode::Open] {
        let (ours, theirs) =
            (posed(&edited.next.document().model, mode), posed(&oracle.value.model, mode));
        let apart = apart(&ours, &theirs);
        assert!(apart < 1e-12, "{}: {apart} apart", told());
    }
    // And the number that the document now has there is the one asked for.
    let there = edited.next.find(&editable.path).unwrap().value;
    assert!((there - value).abs() <= 1e-9 * value.abs(), "{}: {there}", told());
    true
}

/// How many values of a kind of path are looked at in each model; all of them take minutes with `human`.
const MOST_ALIKE: usize = 2;

fn alike(path: &[Step]) -> String {
    let part = |(at, step): (usize, &Step)| match (at, step) {
        (_, Step::Index(_)) => "#".to_owned(),
        // The names of a table, a coordinate and a component.
        (1 | 3, Step::Key(_)) => "*".to_owned(),
        (_, Step::Key(key)) => key.clone(),
    };
    path.iter().enumerate().map(part).collect::<Vec<_>>().join(".")
}

fn every_kind(names: &[&str], most: usize) -> (usize, usize, HashSet<WayKind>) {
    let (mut changed, mut refused, mut ways) = (0, 0, HashSet::new());
    for name in names {
        let editing = shipped_as_own(name);
        let mut seen: std::collections::HashMap<(String, WayKind), usize> = Default::default();
        for editable in editing.values() {
            assert!(!editable.ways.is_empty(), "{name}: {:?}", editable.path);
            for way in &editable.ways {
                if way.kind == WayKind::Override {
                    continue; // In `places.rs`: there the change is a line that is added.
                }
                let count = seen.entry((alike(&editable.path), way.kind)).or_default();
                *count += 1;
                if *count > most {
                    continue;
                }
                ways.insert(way.kind);
                match check(name, &editing, editable, way.kind, &part) {
                    true => changed += 1,
                    false => refused += 1,
                }
            }
        }
    }
    (changed, refused, ways)
}

#[test]
fn each_kind_of_number_of_shipped_models_changes_alone() {
    let names: Vec<&str> = shipped::names().filter(|name| *name != "human").collect();
    let (changed, refused, ways) = every_kind(&names, MOST_ALIKE);
    println!("{changed} numbers changed, {refused} refused");
    // Refused are such as whole numbers, and directions whose length is 1 within few digits.
    assert!(changed > 500 && refused * 10 < changed, "{changed} changed, {refused} refused");
    for way in [
        WayKind::Here,
        WayKind::File,
        WayKind::Row,
        WayKind::Template,
        WayKind::Factor,
        WayKind::Constant,
    ] {
        assert!(ways.contains(&way), "{way:?}");
    }
}

#[test]
#[ignore = "minutes: every number of every shipped model"]
fn every_number_of_shipped_models_changes_alone() {
    let names: Vec<&str> = shipped::names().collect();
    let (changed, refused, _) = every_kind(&names, usize::MAX);
    println!("{changed} numbers changed, {refused} refused");
    assert!(changed > 5000 && refused * 10 < changed, "{changed} changed, {refused} refused");
}

/// The documents of the manual: kinds of components that no shipped model has are there.
#[test]
fn every_number_of_the_manual_changes_alone() {
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/model-format");
    let (mut changed, mut refused, mut documents) = (0, 0, 0);
    for page in std::fs::read_dir(folder).unwrap() {
        let page = page.unwrap().path();
        let text = std::fs::read_to_string(&page).unwrap_or_default();
        let blocks: Vec<(&str, &str)> = text
            .split("```toml")
            .skip(1)
            .filter_map(|rest| rest.split_once("```")?.0.split_once('\n'))
            .map(|(name, block)| (name.trim(), block))
            .collect();
        let named = |wanted: &str| {
            let found = blocks.iter().find(|(name, _)| *name == wanted);
            found.map(|(_, block)| (*block).to_owned()).map_or_else(|| part(wanted), Ok)
        };
        for (_, block) in &blocks {
            // Those that show errors are not read.
            let Ok(editing) = Editing::read("doc.toml", block, &mut |name| named(name), &|_| true)
            else {
                continue;
            };
            documents += 1;
            let name = format!("{}: {block}", page.display());
            for editable in editing.values() {
                for way in &editable.ways {
                    if way.kind == WayKind::Override {
                        continue;
                    }
                    match check(&name, &editing, editable, way.kind, &named) {
                        true => changed += 1,
                        false => refused += 1,
                    }
                }
            }
        }
    }
    println!("{changed} numbers of {documents} documents changed, {refused} refused");
    assert!(
        documents > 40 && changed > 300 && refused * 5 < changed,
        "{documents}, {changed}, {refused}"
    );
}
