//! What a page asks for, read from JSON.

use condyle::formats::document::edit::{Step, WayKind};
use serde_json::Value;

/// How many steps a path may have, and how many values may be set at once.
const MOST: usize = 64;

/// A number or several to be set.
#[derive(Debug, PartialEq)]
pub(super) struct Edit {
    pub(super) values: Vec<(Vec<Step>, f64)>,
    pub(super) way: Option<WayKind>,
    /// Whether the page asked its user.
    pub(super) confirm: bool,
}

/// Something to be added: keys of a table of the document with their values as TOML.
#[derive(Debug, PartialEq)]
pub(super) struct Add {
    pub(super) table: Vec<String>,
    pub(super) keys: Vec<(String, String)>,
}

fn parsed(body: &[u8]) -> Result<Value, String> {
    serde_json::from_slice(body).map_err(|error| format!("this is no JSON: {error}"))
}

/// `["segment", "shank", "at", 1]`.
pub(super) fn path(value: &Value) -> Option<Vec<Step>> {
    let list = value.as_array().filter(|list| (1..=MOST).contains(&list.len()))?;
    let step = |step: &Value| match step {
        Value::String(key) => Some(Step::Key(key.clone())),
        Value::Number(index) => Some(Step::Index(usize::try_from(index.as_u64()?).ok()?)),
        _ => None,
    };
    list.iter().map(step).collect()
}

/// A path as JSON.
pub(super) fn path_json(path: &[Step]) -> Value {
    let step = |step: &Step| match step {
        Step::Key(key) => Value::from(key.as_str()),
        Step::Index(index) => Value::from(*index),
    };
    path.iter().map(step).collect()
}

impl Edit {
    /// `{"path": [...], "value": 0.1 or [0.1, null, 0.3], "way": "factor", "confirm": true}`.
    pub(super) fn read(body: &[u8]) -> Result<Self, String> {
        let message = parsed(body)?;
        let path = path(&message["path"]).ok_or("`path` must be a list of keys and positions")?;
        let mut values = vec![];
        match &message["value"] {
            Value::Number(value) => values.push((path, value.as_f64().unwrap_or(f64::NAN))),
            Value::Array(list) if list.len() <= MOST => {
                for (index, value) in list.iter().enumerate() {
                    let value = match value {
                        Value::Null => continue,
                        value => value.as_f64().ok_or("`value` must hold numbers")?,
                    };
                    let mut path = path.clone();
                    path.push(Step::Index(index));
                    values.push((path, value));
                }
            }
            _ => return Err("`value` must be a number or a list of some".to_owned()),
        }
        let way = match &message["way"] {
            Value::Null => None,
            Value::String(name) => {
                Some(WayKind::named(name).ok_or(format!("there is no way `{name}`"))?)
            }
            _ => return Err("`way` must be a name".to_owned()),
        };
        let confirm = matches!(message["confirm"], Value::Bool(true));
        Ok(Self { values, way, confirm })
    }
}

impl Add {
    /// One of `{"kind": "segment", "name", "parent", "at"}`, `{"kind": "component", "set", "name", "component",
    /// "values": {...}}`, `{"kind": "wire", "path": [...], "value": name or names}`.
    pub(super) fn read(body: &[u8]) -> Result<Self, String> {
        let message = parsed(body)?;
        let name = |key: &str| {
            let text = message[key].as_str().filter(|text| !text.is_empty() && text.len() < 256);
            text.map(str::to_owned).ok_or(format!("`{key}` must be a name"))
        };
        match message["kind"].as_str() {
            Some("segment") => {
                let mut keys = vec![];
                for key in ["parent", "at", "turn"] {
                    if !message[key].is_null() {
                        keys.push((key.to_owned(), toml(&message[key])?));
                    }
                }
                Ok(Self { table: vec!["segment".to_owned(), name("name")?], keys })
            }
            Some("component") => {
                let table =
                    ["joint_set".to_owned(), name("set")?, "component".to_owned(), name("name")?];
                let values = match &message["values"] {
                    Value::Null => "{}".to_owned(),
                    values @ Value::Object(_) => toml(values)?,
                    _ => return Err("`values` must be keys with their values".to_owned()),
                };
                Ok(Self { table: table.to_vec(), keys: vec![(name("component")?, values)] })
            }
            Some("wire") => {
                let keys = path(&message["path"]).unwrap_or_default();
                let keys = keys.into_iter().map(|step| match step {
                    Step::Key(key) => Ok(key),
                    Step::Index(_) => Err("`path` must be a list of keys".to_owned()),
                });
                let mut table = keys.collect::<Result<Vec<_>, _>>()?;
                let key = table.pop().ok_or("`path` must be a list of keys")?;
                let of_set = table.first().is_some_and(|family| family == "joint_set");
                if !of_set || table.len() < 3 {
                    return Err("a wire ends at a port or an output of a joint set".to_owned());
                }
                let names = match &message["value"] {
                    Value::String(_) => true,
                    Value::Array(names) => names.iter().all(Value::is_string),
                    _ => false,
                };
                if !names {
                    return Err("`value` must be a name, or a list of names".to_owned());
                }
                Ok(Self { table, keys: vec![(key, toml(&message["value"])?)] })
            }
            _ => Err("`kind` must be segment, component or wire".to_owned()),
        }
    }
}

/// A value of JSON as TOML writes it. Recursive as deep as the JSON is, of which the reader bounds the depth.
fn toml(value: &Value) -> Result<String, String> {
    Ok(match value {
        Value::Null => return Err("`null` is no value of a document".to_owned()),
        Value::Bool(flag) => flag.to_string(),
        Value::Number(number) => number.to_string(),
        // All that JSON escapes is an escape of TOML, too, but for the slash, which it leaves as it is.
        Value::String(_) => value.to_string().replace('\u{7f}', "\\u007F"),
        Value::Array(list) => {
            let list = list.iter().map(toml).collect::<Result<Vec<_>, _>>()?;
            format!("[{}]", list.join(", "))
        }
        Value::Object(entries) => {
            let entry = |(key, value): (&String, &Value)| {
                let bare = |c: char| c.is_ascii_alphanumeric() || c == '_' || c == '-';
                let quoted = Value::from(key.as_str()).to_string();
                let key = if !key.is_empty() && key.chars().all(bare) { key } else { &quoted };
                Ok::<_, String>(format!("{key} = {}", toml(value)?))
            };
            let entries = entries.iter().map(entry).collect::<Result<Vec<_>, _>>()?;
            if entries.is_empty() {
                "{}".to_owned()
            } else {
                format!("{{ {} }}", entries.join(", "))
            }
        }
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn edits_are_read_and_broken_ones_are_refused() {
        let edit = Edit::read(br#"{"path":["segment","a.b","at"],"value":[null,-0.43],"way":"factor","confirm":true}"#);
        let at = |index| {
            vec![
                Step::Key("segment".into()),
                Step::Key("a.b".into()),
                Step::Key("at".into()),
                Step::Index(index),
            ]
        };
        let expected =
            Edit { values: vec![(at(1), -0.43)], way: Some(WayKind::Factor), confirm: true };
        assert_eq!(edit, Ok(expected));
        for broken in [
            "",
            "{",
            "[]",
            "null",
            "{}",
            r#"{"path":[],"value":1}"#,
            r#"{"path":["a",-1],"value":1}"#,
            r#"{"path":["a",{}],"value":1}"#,
            r#"{"path":["a"],"value":"1"}"#,
            r#"{"path":["a"],"value":[true]}"#,
            r#"{"path":["a"],"value":1,"way":"none"}"#,
            "\u{0}\u{1}",
        ] {
            assert!(Edit::read(broken.as_bytes()).is_err(), "{broken}");
        }
        let deep = format!("{{\"path\":{}", "[".repeat(100_000));
        assert!(Edit::read(deep.as_bytes()).is_err());
    }

    #[test]
    fn what_is_added_becomes_toml() {
        let add =
            |text: &str| Add::read(text.as_bytes()).map(|add| (add.table.join("/"), add.keys));
        let keys = |key: &str, value: &str| vec![(key.to_owned(), value.to_owned())];
        assert_eq!(
            add(
                r#"{"kind":"component","set":"knee","name":"half","component":"map","values":{"input":"bend","function":{"linear":[0.5,0]}}}"#
            ),
            Ok((
                "joint_set/knee/component/half".into(),
                keys("map", "{ function = { linear = [0.5, 0] }, input = \"bend\" }")
            ))
        );
        assert_eq!(
            add(
                r#"{"kind":"wire","path":["joint_set","knee","output","shank"],"value":["a","b\n\""]}"#
            ),
            Ok(("joint_set/knee/output".into(), keys("shank", "[\"a\", \"b\\n\\\"\"]")))
        );
        assert!(add(r#"{"kind":"wire","path":["segment","shank","parent"],"value":"a"}"#).is_err());
        assert!(add(r#"{"kind":"segment","name":"","parent":"a"}"#).is_err());
        assert!(add(r#"{"kind":"include"}"#).is_err());
    }
}
