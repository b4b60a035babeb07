//! Units of numbers in a document.

use super::Step;
use crate::document::tree::{Entry, Value};
use condyle_model::{CoordinateKind, Model};

/// The unit of a number, as far as its text tells.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Unit {
    /// The unit of its text's angles.
    Angle,
    /// A named one; empty where the text does not tell.
    Named(&'static str),
    /// That of a coordinate: of its kind, unless its table names one.
    Coordinate { set: String, name: String, stated: Option<&'static str> },
    /// Angles of a file or metres, whichever the coordinates of a posture are.
    Posture,
}

/// Keys of points and lengths.
const LENGTHS: &[&str] = &[
    "at",
    "joint_at",
    "radii",
    "size",
    "length",
    "pitch",
    "chord",
    "outline",
    "middle",
    "thickness",
    "distance",
    "most_gap",
    "point",
    "half_width",
];
/// Keys of angles.
const ANGLES: &[&str] =
    &["turn", "joint_turn", "tilt", "neutral", "twist", "to", "angle", "pump", "swing"];
/// Keys of directions and ratios.
const RATIOS: &[&str] = &[
    "axis",
    "axes",
    "direction",
    "normal",
    "weight",
    "factor",
    "stiffness",
    "matrix",
    "joint_matrix",
    "forward",
    "up",
    "along",
    "across",
    "rest_direction",
    "proximal",
    "distal",
    "peak",
    "plane",
    "outward",
    "first",
    "second",
];

/// The tables around a number.
pub(super) struct Scope<'t> {
    tables: Vec<&'t [Entry]>,
}

impl<'t> Scope<'t> {
    pub(super) fn top() -> Self {
        Self { tables: vec![] }
    }

    pub(super) fn within(&self, entries: &'t [Entry]) -> Scope<'t>
    where
        't: 't,
    {
        let mut tables = self.tables.clone();
        tables.push(entries);
        Scope { tables }
    }

    /// The unit that a key names in the nearest table that has it.
    fn stated(&self, key: &str) -> Option<&'static str> {
        let entry =
            self.tables.iter().rev().find_map(|table| table.iter().find(|e| e.key.text == key))?;
        match &entry.node.value {
            Value::Text(text) => {
                ["deg", "rad", "m", "cm", "mm", "1"].into_iter().find(|unit| unit == text)
            }
            _ => None,
        }
    }

    /// The unit of the number at a path.
    pub(super) fn unit(&self, path: &[Step]) -> Unit {
        let keys: Vec<&str> = path
            .iter()
            .filter_map(|step| match step {
                Step::Key(key) => Some(key.as_str()),
                Step::Index(_) => None,
            })
            .collect();
        let last = keys.last().copied().unwrap_or_default();
        let index = path.iter().rev().find_map(|step| match step {
            Step::Index(index) => Some(*index),
            Step::Key(_) => None,
        });
        match keys[..] {
            [
                "joint" | "joint_set",
                set,
                "coordinate",
                name,
                "range" | "default" | "typical" | "rest",
            ] => {
                let stated = self.stated("unit");
                return Unit::Coordinate { set: set.to_owned(), name: name.to_owned(), stated };
            }
            ["posture", _, "rest"] => return Unit::Posture,
            ["constants", ..] => return Unit::Named(""),
            _ => {}
        }
        let kind = match keys[..] {
            ["joint_set", _, "component", _, kind, ..] => kind,
            _ => "",
        };
        let (argument, value) =
            (self.stated("in").unwrap_or_default(), self.stated("out").unwrap_or_default());
        match (kind, last) {
            ("cone", "rest") | ("field", "holes") => Unit::Named("1"),
            ("field", key) if key.contains("in_") => Unit::Named(""),
            ("pivot", "path") => Unit::Named(""),
            ("ellipse", "centre" | "half_axes") | ("half_space", "bound") => Unit::Named(argument),
            (_, "spline" | "lines" | "lower" | "upper") => {
                Unit::Named(if index == Some(0) { argument } else { value })
            }
            (_, "ends" | "constant") => Unit::Named(value),
            (_, "linear" | "polynomial" | "slopes" | "intercept") => Unit::Named(""),
            ("", "rest") => Unit::Named(""),
            (_, key) if LENGTHS.contains(&key) => Unit::Named("m"),
            (_, key) if ANGLES.contains(&key) => Unit::Angle,
            (_, key) if RATIOS.contains(&key) => Unit::Named("1"),
            _ => Unit::Named(""),
        }
    }
}

impl Unit {
    /// Its name, and whether it is the unit of the text's angles.
    pub(super) fn name(&self, degrees: bool, model: &Model) -> (&'static str, bool) {
        let angle = if degrees { "deg" } else { "rad" };
        match self {
            Self::Angle | Self::Posture => (angle, true),
            Self::Named(name) => (name, false),
            Self::Coordinate { stated: Some(name), .. } => (name, false),
            Self::Coordinate { set, name, .. } => match kind(model, set, name) {
                Some(CoordinateKind::Rotation) => (angle, true),
                Some(CoordinateKind::Translation) => ("m", false),
                Some(CoordinateKind::Scale | CoordinateKind::Orientation) => ("1", false),
                _ => ("", false),
            },
        }
    }
}

fn kind(model: &Model, set: &str, name: &str) -> Option<CoordinateKind> {
    let sets = model.joint_sets();
    let of_set = |c: &&condyle_model::Coordinate| {
        c.name == name && sets.get(c.joint_set.index()).is_some_and(|found| found.name == set)
    };
    model.coordinates().iter().find(of_set).map(|c| c.kind)
}
