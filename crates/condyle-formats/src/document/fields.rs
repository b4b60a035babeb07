//! Typed access to the tree: every wrong type, unknown key and unknown constant is reported once,
//! and reading goes on.

use super::number::Constant;
use super::template::Given;
use super::texts::{Angles, Name, Spot, Texts};
use super::tree::{Entry, Node, Value};
use super::words;
use condyle_diagnostics::{Severity, did_you_mean};
use condyle_math::{Affine, EulerOrder, Mat3, Quat, Vec3};
use std::collections::HashMap;

/// A matrix is a rotation if M'M is the identity but for this.
const EXACT: f64 = 1e-6;
/// It is a rotation with few digits if it is but for this.
const ROUNDED: f64 = 2e-3;

/// A number with at most four decimals.
fn shown(number: f64) -> String {
    let text = format!("{number:.4}");
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}

/// Reads values of a tree and reports what is wrong with them.
pub(super) struct Reader<'s> {
    pub(super) texts: &'s mut Texts,
    pub(super) constants: HashMap<String, Constant>,
    /// What instances of templates give for their parameters, by their context.
    pub(super) given: HashMap<u32, Given>,
    /// The text of another file by its path from the document.
    pub(super) include: &'s mut dyn FnMut(&str) -> Result<String, String>,
}

/// A table whose keys are known.
pub(super) struct Fields<'t> {
    entries: &'t [Entry],
    /// The place of its name.
    pub(super) spot: Spot,
    /// Its name in messages, such as `segment.tibia_r`.
    pub(super) label: String,
}

impl<'t> Fields<'t> {
    pub(super) fn get(&self, key: &str) -> Option<&'t Node> {
        self.entries.iter().find(|e| e.key.text == key).map(|e| &e.node)
    }

    pub(super) fn entries(&self) -> &'t [Entry] {
        self.entries
    }
}

impl Reader<'_> {
    pub(super) fn wrong(&mut self, node: &Node, label: &str, wanted: &str) {
        let message = format!("`{label}` is {}", node.describe());
        self.texts.error(node.spot, "document/type", message, format!("give {wanted}"));
    }

    /// The entries of a table with any keys.
    pub(super) fn entries<'t>(&mut self, node: &'t Node, label: &str) -> &'t [Entry] {
        match &node.value {
            Value::Table(entries) => entries,
            _ => {
                self.wrong(node, label, "a table");
                &[]
            }
        }
    }

    /// A table with known keys; others are reported.
    pub(super) fn table<'t>(
        &mut self,
        node: &'t Node,
        spot: Spot,
        label: String,
        known: &[&str],
    ) -> Fields<'t> {
        let entries = self.entries(node, &label);
        for entry in entries {
            if !known.contains(&entry.key.text.as_str()) {
                self.unknown_key(&entry.key, &label, known);
            }
        }
        Fields { entries, spot, label }
    }

    pub(super) fn unknown_key(&mut self, key: &Name, label: &str, known: &[&str]) {
        let all = || format!("known keys are: {}", known.join(", "));
        let help = match words::key(label, &key.text) {
            Some(help) => help.to_owned(),
            None => did_you_mean(&key.text, known.iter().copied(), all),
        };
        let message = match label {
            "" => format!("unknown key `{}`", key.text),
            label => format!("unknown key `{}` in [{label}]", key.text),
        };
        self.texts.error(key.spot, "document/unknown-key", message, help);
    }

    pub(super) fn missing(&mut self, fields: &Fields<'_>, key: &str, wanted: &str) {
        let message = format!("[{}] has no `{key}`", fields.label);
        self.texts.error(fields.spot, "document/missing", message, format!("give {wanted}"));
    }

    /// The value of a key that must be there.
    pub(super) fn required<'t>(
        &mut self,
        fields: &Fields<'t>,
        key: &str,
        wanted: &str,
    ) -> Option<&'t Node> {
        let node = fields.get(key);
        if node.is_none() {
            self.missing(fields, key, wanted);
        }
        node
    }

    /// Two keys of which only one may be given.
    pub(super) fn exclusive(&mut self, node: &Node, one: &str, other: &str) {
        let message = format!("both `{one}` and `{other}` are given");
        self.texts.error(node.spot, "document/exclusive", message, "give one of them");
    }

    /// A list or string of the wrong length.
    pub(super) fn length(&mut self, spot: Spot, message: String, help: impl Into<String>) {
        self.texts.error(spot, "document/length", message, help);
    }

    /// The factor from the unit of angles at this spot to radians.
    pub(super) fn angle_unit(&self, spot: Spot) -> f64 {
        match self.texts.angles(spot) {
            Angles::Degrees => std::f64::consts::PI / 180.0,
            Angles::Radians => 1.0,
        }
    }

    pub(super) fn text(&mut self, node: &Node, label: &str) -> Option<Name> {
        match &node.value {
            Value::Text(text) => Some(Name { text: text.clone(), spot: node.spot }),
            Value::List(_) => {
                let message = format!("`{label}` is a list");
                let help = "give one name; a sum of several scalars is a component of kind combine, \
                            a product of transforms one of kind product";
                self.texts.error(node.spot, "document/type", message, help);
                None
            }
            _ => {
                self.wrong(node, label, "a string");
                None
            }
        }
    }

    pub(super) fn flag(&mut self, node: Option<&Node>, label: &str, default: bool) -> bool {
        match node {
            None => default,
            Some(Node { value: Value::Bool(b), .. }) => *b,
            Some(node) => {
                self.wrong(node, label, "true or false");
                default
            }
        }
    }

    /// A whole number from 0.
    pub(super) fn count(&mut self, node: &Node, label: &str) -> Option<usize> {
        let n = self.number(node, label)?;
        if (0.0..=1e6).contains(&n) && n.fract() == 0.0 {
            return Some(n as usize);
        }
        let message = format!("`{label}` is {n}");
        self.texts.error(node.spot, "document/type", message, "give a whole number from 0");
        None
    }

    pub(super) fn list<'t>(&mut self, node: &'t Node, label: &str) -> Option<&'t [Node]> {
        match &node.value {
            Value::List(list) => Some(list),
            _ => {
                self.wrong(node, label, "a list");
                None
            }
        }
    }

    pub(super) fn numbers(&mut self, node: &Node, label: &str) -> Option<Vec<f64>> {
        let list = self.list(node, label)?;
        // Read to the end, so that every error is reported.
        let numbers: Vec<Option<f64>> = list.iter().map(|n| self.number(n, label)).collect();
        numbers.into_iter().collect()
    }

    /// Exactly `N` numbers.
    pub(super) fn some<const N: usize>(&mut self, node: &Node, label: &str) -> Option<[f64; N]> {
        let numbers = self.numbers(node, label)?;
        let count = numbers.len();
        match numbers.try_into() {
            Ok(numbers) => Some(numbers),
            Err(_) => {
                let message = format!("`{label}` has {count} numbers");
                let point = if count > N { "; decimals have a point, as in 0.42" } else { "" };
                self.length(node.spot, message, format!("give {N}{point}"));
                None
            }
        }
    }

    pub(super) fn vector(&mut self, node: &Node, label: &str) -> Option<Vec3> {
        if let Value::Text(text) = &node.value
            && let Some(axis) = words::axis(text)
        {
            let message = format!("`{label}` is a string");
            self.texts.error(node.spot, "document/type", message, format!("write {axis:?}"));
            return None;
        }
        self.some::<3>(node, label).map(Vec3::from)
    }

    /// A vector that has a direction.
    pub(super) fn has_direction(&mut self, node: &Node, label: &str) -> Option<Vec3> {
        let vector = self.vector(node, label)?;
        if vector.norm() > 1e-9 {
            return Some(vector);
        }
        let message = format!("`{label}` has length 0");
        let help = "give a direction, such as [0, 0, 1]";
        self.texts.error(node.spot, "model/axis", message, help);
        None
    }

    /// A number with a default.
    pub(super) fn number_or(&mut self, fields: &Fields<'_>, key: &str, or: f64) -> Option<f64> {
        fields.get(key).map_or(Some(or), |node| self.number(node, key))
    }

    /// A list of vectors, each of which is `None` after an error.
    pub(super) fn vectors(&mut self, node: &Node, label: &str) -> Option<Vec<Option<Vec3>>> {
        let list = self.list(node, label)?;
        Some(list.iter().map(|node| self.vector(node, label)).collect())
    }

    /// A list of pairs: the knots of a curve.
    pub(super) fn pairs(&mut self, node: &Node, label: &str) -> Option<(Vec<f64>, Vec<f64>)> {
        let list = self.list(node, label)?;
        let pairs: Vec<Option<[f64; 2]>> = list.iter().map(|n| self.some(n, label)).collect();
        let pairs: Option<Vec<[f64; 2]>> = pairs.into_iter().collect();
        Some(pairs?.into_iter().map(|[x, y]| (x, y)).unzip())
    }

    /// A name, or a list of names, and whether it was a list.
    pub(super) fn names(&mut self, node: &Node, label: &str) -> (Vec<Name>, bool) {
        match &node.value {
            Value::List(list) => (list.iter().filter_map(|n| self.text(n, label)).collect(), true),
            _ => (self.text(node, label).into_iter().collect(), false),
        }
    }

    /// An affine frame from keys such as `at`, `turn`, `order`, `matrix`.
    pub(super) fn frame(&mut self, fields: &Fields<'_>, keys: [&str; 4]) -> Affine {
        let [at, turn, order, matrix] = keys;
        let point = fields.get(at).and_then(|n| self.vector(n, at)).unwrap_or(Vec3::ZERO);
        let mut linear = Mat3::IDENTITY;
        if let Some(node) = fields.get(turn) {
            let unit = self.angle_unit(node.spot);
            let named = fields.get(order).and_then(|n| self.order(n, order));
            let angles = self.some::<3>(node, turn).unwrap_or_default().map(|a| unit * a);
            linear = named.unwrap_or(EulerOrder::XYZ).to_mat3(angles);
        } else if let Some(node) = fields.get(order) {
            let message = format!("`{order}` is given without `{turn}`");
            let help = format!("give three angles as `{turn}`, or omit `{order}`");
            self.texts.error(node.spot, "document/missing", message, help);
        }
        if let Some(node) = fields.get(matrix) {
            if fields.get(turn).is_some() {
                self.exclusive(node, turn, matrix);
            }
            let rows: Vec<Vec3> =
                self.vectors(node, matrix).into_iter().flatten().flatten().collect();
            match rows[..] {
                [x, y, z] => {
                    linear = self.turn_of(node, matrix, Mat3::from_columns(x, y, z).transpose());
                }
                _ => {
                    let message = format!("`{matrix}` has {} rows", rows.len());
                    self.length(node.spot, message, "give 3 rows of 3");
                }
            }
        }
        Affine::new(linear, point)
    }

    /// A matrix that must be a rotation; a rounded one is made one. After an error the identity.
    fn turn_of(&mut self, node: &Node, label: &str, matrix: Mat3) -> Mat3 {
        let product = matrix.transpose() * matrix;
        let off = (0..9).map(|i| (product.at(i / 3, i % 3) - f64::from(i % 4 == 0)).abs());
        let off = off.fold(0.0, f64::max);
        if off < EXACT && matrix.determinant() > 0.0 {
            return matrix;
        }
        let help = "give rows of length 1 at right angles, or three angles as a turn";
        let why = match matrix.determinant() {
            det if det.is_nan() || det.abs() <= 1e-6 => {
                ("is flat: its determinant is 0".to_owned(), help)
            }
            det if det < 0.0 => (
                format!("is a reflection, not a rotation: its determinant is {}", shown(det)),
                "exchange two rows, or change the sign of one",
            ),
            _ if off < ROUNDED => {
                let message = format!("`{label}` is off a rotation by {off:.1e} and is made one");
                let said =
                    self.texts.said(node.spot, Severity::Warning, "document/rotation", message);
                self.texts.warn(node.spot, said.with_help("give more digits"));
                return Quat::from_mat3(matrix).normalized().to_mat3();
            }
            det => {
                let rows = matrix.transpose();
                let lengths = [rows.x, rows.y, rows.z].map(|row| shown(row.norm()));
                let why = format!(
                    "is not a rotation: its rows have the lengths {}, its determinant is {}",
                    lengths.join(", "),
                    shown(det)
                );
                (why, help)
            }
        };
        self.texts.error(node.spot, "model/rotation", format!("`{label}` {}", why.0), why.1);
        Mat3::IDENTITY
    }

    pub(super) fn order(&mut self, node: &Node, label: &str) -> Option<EulerOrder> {
        let name = self.text(node, label)?;
        match name.text.parse() {
            Ok(order) => Some(order),
            Err(_) => {
                let message = format!("unknown rotation order `{}`", name.text);
                let help = "give three of x, y, z, no two adjacent ones equal, such as `zxy`";
                self.texts.error(name.spot, "document/order", message, help);
                None
            }
        }
    }

    /// A vector that must be there.
    pub(super) fn required_vector(
        &mut self,
        fields: &Fields<'_>,
        key: &str,
        wanted: &str,
    ) -> Option<Vec3> {
        self.required(fields, key, wanted).and_then(|node| self.vector(node, key))
    }

    /// A direction that must be there.
    pub(super) fn required_direction(
        &mut self,
        fields: &Fields<'_>,
        key: &str,
        wanted: &str,
    ) -> Option<Vec3> {
        self.required(fields, key, wanted).and_then(|node| self.has_direction(node, key))
    }

    /// The factor from a named unit to radians or metres.
    pub(super) fn unit_of(&mut self, node: &Node, key: &str) -> Option<f64> {
        let name = self.text(node, key)?;
        match name.text.as_str() {
            "rad" | "m" => Some(1.0),
            "deg" => Some(std::f64::consts::PI / 180.0),
            "cm" => Some(0.01),
            "mm" => Some(0.001),
            other => {
                let message = format!("unknown unit `{other}`");
                let help = match words::unit(other) {
                    Some(unit) => format!("did you mean `{unit}`?"),
                    None => "units are: rad, deg, m, cm, mm".to_owned(),
                };
                self.texts.error(name.spot, "document/unit", message, help);
                None
            }
        }
    }

    /// A number of 0 or more.
    pub(super) fn not_negative(&mut self, node: &Node, label: &str) -> Option<f64> {
        let number = self.number(node, label)?;
        if number < 0.0 {
            let message = format!("`{label}` is {number}");
            self.texts.error(node.spot, "document/number", message, "give a number of 0 or more");
        }
        Some(number)
    }

    /// A number above 0.
    pub(super) fn positive(&mut self, node: &Node, label: &str) -> Option<f64> {
        let number = self.number(node, label)?;
        if number <= 0.0 {
            let message = format!("`{label}` is {number}");
            self.texts.error(node.spot, "document/number", message, "give a number above 0");
        }
        Some(number)
    }

    /// A value of a coordinate in radians or metres. What kind the coordinate is only the model knows,
    /// so in a document in degrees each value says its unit.
    pub(super) fn value(&mut self, fields: &Fields<'_>, key: &str) -> Option<f64> {
        let node = fields.get(key)?;
        let unit = match fields.get("unit") {
            Some(unit) => self.unit_of(unit, "unit")?,
            None if self.angle_unit(node.spot) != 1.0 => {
                let message = format!("`{key}` has no unit");
                let help = "in a document in degrees give `unit = \"deg\"` or `unit = \"m\"`";
                self.texts.error(node.spot, "document/unit", message, help);
                1.0
            }
            None => 1.0,
        };
        Some(unit * self.number(node, key)?)
    }

    /// One of a few words; the first of them is the default.
    pub(super) fn word<T: Copy>(
        &mut self,
        fields: &Fields<'_>,
        key: &str,
        words: &[(&str, T)],
    ) -> Option<T> {
        let Some(node) = fields.get(key) else { return words.first().map(|(_, value)| *value) };
        let name = self.text(node, key)?;
        if let Some((_, value)) = words.iter().find(|(word, _)| *word == name.text) {
            return Some(*value);
        }
        let known = words.iter().map(|(word, _)| *word);
        let all = || format!("give `{}`", known.clone().collect::<Vec<_>>().join("` or `"));
        let help = did_you_mean(&name.text, known.clone(), all);
        let message = format!("unknown value `{}` of `{key}`", name.text);
        self.texts.error(name.spot, "document/word", message, help);
        None
    }
}
