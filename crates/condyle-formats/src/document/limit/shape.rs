//! A limit that is given by formulas: three turns whose ends depend on those before.
//!
//! ```text
//! [shape]
//! axes   = [a1, a2, a3]     # R = turn(a1) · turn(a2) · turn(a3), perpendicular to each other
//! first  = [lower, upper]
//! second = [lower, upper], or { first = [...], lower = [...], upper = [...] }: at angles of the first turn
//! third  = the same, or with second = [...] too: then lower and upper have a row for each of first
//! beyond = how far beyond these ends a rotation may be
//! nodes  = along an edge of the map, 24 to 256
//! ```
//!
//! Ends are linear between what is given, and go on so beyond it.

use super::super::fields::Reader;
use super::super::model::{number, numbers};
use super::super::tree::{Node, Value};
use condyle_learn::limits::field::shaped;
use condyle_model::limit::field::{Ends, Ground, Shape, ShapeError};
use std::fmt::Write;

/// The keys of a shape.
const KEYS: [&str; 6] = ["axes", "first", "second", "third", "beyond", "nodes"];

impl Reader<'_> {
    /// What a limit by formulas is made of.
    pub(super) fn shape(&mut self, node: &Node, label: String) -> Option<Ground> {
        let fields = self.table(node, node.spot, label, &KEYS);
        let unit = self.angle_unit(node.spot);
        let axes = self.required(&fields, "axes", "three directions, the axes of the turns");
        let axes = axes.and_then(|node| self.vectors(node, "axes"));
        let first = self.required(&fields, "first", "the lower and the upper end, [-9, 160]");
        let first = first.and_then(|node| self.some::<2>(node, "first"));
        let wanted = "both ends, [lower, upper], or a table of `first`, `lower`, `upper`";
        let second = self.required(&fields, "second", wanted);
        let second = second.and_then(|node| self.ends(node, "second", unit));
        let third = self.required(&fields, "third", wanted);
        let third = third.and_then(|node| self.ends(node, "third", unit));
        let beyond = self.number_or(&fields, "beyond", 0.0);
        let nodes = match fields.get("nodes") {
            None => None,
            Some(node) => Some(self.nodes(node)?),
        };
        let axes: Vec<_> = axes?.into_iter().collect::<Option<_>>()?;
        let Ok(axes) = <[_; 3]>::try_from(axes) else {
            let message = "`axes` are not three directions".to_owned();
            self.length(
                fields.spot,
                message,
                "give three, such as [[1, 0, 0], [0, 0, 1], [0, 1, 0]]",
            );
            return None;
        };
        let first = first?.map(|end| end * unit);
        let shape = Shape::new(axes, first, second?, third?, beyond? * unit);
        Some(shaped(self.right(node, shape)?, nodes))
    }

    /// A number of nodes along an edge of the map.
    pub(super) fn nodes(&mut self, node: &Node) -> Option<usize> {
        let nodes = self.count(node, "nodes")?;
        if (24..=256).contains(&nodes) {
            return Some(nodes);
        }
        let message = format!("`nodes` is {nodes}");
        self.texts.error(node.spot, "limit/settings", message, "give 24 to 256");
        None
    }

    fn right<T>(&mut self, node: &Node, shape: Result<T, ShapeError>) -> Option<T> {
        shape
            .map_err(|ShapeError { message, help }| {
                self.texts.error(node.spot, "limit/shape", message, help);
            })
            .ok()
    }

    fn ends(&mut self, node: &Node, label: &str, unit: f64) -> Option<Ends> {
        if let Value::List(_) = node.value {
            let [lower, upper] = self.some::<2>(node, label)?.map(|end| end * unit);
            let ends = Ends::new(vec![0.0], vec![], vec![lower], vec![upper]);
            return self.right(node, ends);
        }
        let keys = ["first", "second", "lower", "upper"];
        let fields = self.table(node, node.spot, label.to_owned(), &keys);
        let known = match fields.get("second") {
            None => Some(vec![]),
            Some(node) => self.numbers(node, "second"),
        };
        let wanted = "the angles of the first turn at which ends are given";
        let first = self.required(&fields, "first", wanted);
        let first = first.and_then(|node| self.numbers(node, "first"));
        let [lower, upper] = ["lower", "upper"].map(|key| {
            let node = self.required(&fields, key, "an end at each of these angles")?;
            self.rows(node, key)
        });
        let [first, known, lower, upper] = [first?, known?, lower?, upper?]
            .map(|angles| angles.into_iter().map(|angle| angle * unit).collect());
        self.right(node, Ends::new(first, known, lower, upper))
    }

    /// Numbers, or rows of numbers.
    fn rows(&mut self, node: &Node, label: &str) -> Option<Vec<f64>> {
        let list = self.list(node, label)?;
        if !list.iter().any(|node| matches!(node.value, Value::List(_))) {
            return self.numbers(node, label);
        }
        let rows: Vec<_> = list.iter().map(|row| self.numbers(row, label)).collect();
        let rows = rows.into_iter().collect::<Option<Vec<_>>>()?;
        if rows.windows(2).any(|pair| pair[0].len() != pair[1].len()) {
            self.length(
                node.spot,
                format!("the rows of `{label}` are not equally long"),
                "give as many numbers in each",
            );
            return None;
        }
        Some(rows.concat())
    }
}

/// Writes a shape below `within`, in radians.
pub(super) fn write_shape(out: &mut String, shape: &Shape, nodes: usize, within: &str) {
    let _ = writeln!(out, "\n[{within}shape]");
    let axes = shape.axes().map(|axis| numbers(&axis.to_array()));
    let _ = writeln!(out, "axes = [{}]", axes.join(", "));
    let _ = writeln!(out, "first = {} # radians", numbers(&shape.first()));
    for (key, ends) in [("second", shape.second()), ("third", shape.third())] {
        let columns = ends.second().len();
        let rows = |ends: &[f64]| match columns {
            1 => numbers(ends),
            _ => {
                let rows: Vec<String> = ends.chunks(columns).map(numbers).collect();
                format!("[{}]", rows.join(", "))
            }
        };
        let of_second = match columns {
            1 => String::new(),
            _ => format!("second = {}, ", numbers(ends.second())),
        };
        let (first, lower, upper) = (numbers(ends.first()), rows(ends.lower()), rows(ends.upper()));
        let _ = writeln!(
            out,
            "{key} = {{ first = {first}, {of_second}lower = {lower}, upper = {upper} }}"
        );
    }
    if shape.beyond() > 0.0 {
        let _ = writeln!(out, "beyond = {}", number(shape.beyond()));
    }
    let _ = writeln!(out, "nodes = {nodes}");
}
