//! Coordinates: what they measure, and their limits.

use super::ModelReader;
use crate::document::fields::Fields;
use crate::document::model::draft::CoordinateDraft;
use crate::document::model::keys;
use crate::document::tree::{Entry, Node, Value};
use condyle_diagnostics::did_you_mean;
use condyle_model::{CoordinateKind, Range};

impl ModelReader<'_> {
    /// The properties of a coordinate; `free_kind` if its kind may be given.
    pub(in super::super) fn coordinate(
        &mut self,
        owner: &str,
        entry: &Entry,
        mut coordinate: CoordinateDraft,
        free_kind: bool,
    ) -> CoordinateDraft {
        let label = format!("{owner}.coordinate.{}", entry.key.text);
        coordinate.table = entry.key.spot;
        let fields = self.table(&entry.node, entry.key.spot, label, keys::COORDINATE);
        if let Some(kind) = fields.get("kind").and_then(|n| self.text(n, "kind")) {
            use CoordinateKind::{Orientation, Other, Rotation, Scale, Translation};
            let kinds = [Rotation, Translation, Scale, Other, Orientation];
            match kinds.into_iter().find(|k| k.name() == kind.text) {
                Some(found) if free_kind || found == coordinate.kind => coordinate.kind = found,
                Some(_) => {
                    let message = format!("this coordinate is a {}", coordinate.kind.name());
                    let help = "omit `kind`: the type of the joint determines it";
                    self.texts.error(kind.spot, "model/kind", message, help);
                }
                None => {
                    let names = kinds.map(CoordinateKind::name);
                    let all = || format!("kinds are: {}", names.join(", "));
                    let help = did_you_mean(&kind.text, names, all);
                    let message = format!("unknown kind of coordinate `{}`", kind.text);
                    self.texts.error(kind.spot, "model/kind", message, help);
                }
            }
        }
        let stated = self.unit(&fields, coordinate.kind);
        let rotation = coordinate.kind == CoordinateKind::Rotation;
        let orientation = coordinate.kind == CoordinateKind::Orientation;
        coordinate.default = coordinate.kind.neutral();
        if let Some(node) = fields.get("default") {
            if !orientation {
                let unit = self.factor(stated, rotation, node);
                coordinate.default[0] = unit * self.number(node, "default").unwrap_or(0.0);
            } else if let Some(q) = self.some::<4>(node, "default") {
                let length = q.iter().map(|x| x * x).sum::<f64>().sqrt();
                if (length - 1.0).abs() > 1e-6 {
                    let message = format!("this quaternion has length {length}");
                    let help = "give x, y, z, w of length 1; the identity is [0, 0, 0, 1]";
                    self.texts.error(node.spot, "model/orientation", message, help);
                }
                coordinate.default = q;
            }
        }
        if let Some(node) = fields.get("range") {
            if orientation {
                let message = "an orientation has no range";
                self.texts.error(node.spot, "model/range", message, "omit it");
            } else {
                let unit = self.factor(stated, rotation, node);
                self.range(node, unit, &mut coordinate.range);
            }
        }
        if let Some(node) = fields.get("typical")
            && let Some(ends) = self.some::<2>(node, "typical")
        {
            if orientation || ends[0] > ends[1] {
                let message = "`typical` is not [lowest, highest]";
                let help =
                    "give what people reach on average, as in a range; omit it for an orientation";
                self.texts.error(node.spot, "model/range", message, help);
            }
            let unit = self.factor(stated, rotation, node);
            coordinate.typical = Some(ends.map(|end| unit * end));
        }
        let held = coordinate.range.lower.is_some() || coordinate.range.upper.is_some();
        // What an included text says of its own range does not hold for the range of the text that includes it: those
        // are numbered before what they include.
        let ours = |flag: &&Node| {
            fields.get("range").is_none_or(|range| flag.spot.file <= range.spot.file)
        };
        let enforced = fields.get("enforced").filter(ours);
        coordinate.range.enforced = self.flag(enforced, "enforced", held);
        coordinate.locked = self.flag(fields.get("locked"), "locked", false);
        coordinate.drives =
            fields.get("drives").and_then(|n| self.text(n, "drives")).map(|n| n.text);
        coordinate.source =
            fields.get("source").and_then(|n| self.text(n, "source")).map(|n| n.text);
        coordinate.held = self.rest(&fields, stated, rotation, coordinate.default[0]);
        coordinate.follows = fields.get("follows").and_then(|n| self.text(n, "follows"));
        coordinate
    }

    /// The factor to radians or metres of a value of a coordinate: that which its table states, else that of the text in
    /// which the value itself stands, which may be another one than that of the table.
    pub(super) fn factor(&self, stated: Option<f64>, rotation: bool, value: &Node) -> f64 {
        let usual = || if rotation { self.angle_unit(value.spot) } else { 1.0 };
        stated.unwrap_or_else(usual)
    }

    /// The factor that a coordinate's table states by name.
    fn unit(&mut self, fields: &Fields<'_>, kind: CoordinateKind) -> Option<f64> {
        const DEGREE: f64 = std::f64::consts::PI / 180.0;
        let name = fields.get("unit").and_then(|n| self.text(n, "unit"))?;
        let known: &[(&str, f64)] = match kind {
            CoordinateKind::Rotation => &[("rad", 1.0), ("deg", DEGREE)],
            CoordinateKind::Translation => &[("m", 1.0), ("cm", 0.01), ("mm", 0.001)],
            CoordinateKind::Other => &[
                ("1", 1.0),
                ("rad", 1.0),
                ("deg", DEGREE),
                ("m", 1.0),
                ("cm", 0.01),
                ("mm", 0.001),
            ],
            CoordinateKind::Scale | CoordinateKind::Orientation => &[],
        };
        if let Some((_, factor)) = known.iter().find(|(unit, _)| *unit == name.text) {
            return Some(*factor);
        }
        let units: Vec<&str> = known.iter().map(|(unit, _)| *unit).collect();
        let message = format!("a coordinate of kind {} has no unit `{}`", kind.name(), name.text);
        let help = match units[..] {
            [] => "omit it".to_owned(),
            _ => format!("units are: {}", units.join(", ")),
        };
        self.texts.error(name.spot, "document/unit", message, help);
        None
    }

    fn range(&mut self, node: &Node, unit: f64, range: &mut Range) {
        let sides = self.list(node, "range").unwrap_or_default();
        let [low, high] = sides else {
            if matches!(node.value, Value::List(_)) {
                let message = format!("`range` has {} entries", sides.len());
                let help = "give [lower, upper]; either may be \"none\"";
                self.length(node.spot, message, help);
            }
            return;
        };
        let mut side = |node: &Node| match &node.value {
            Value::Text(text) if text == "none" => None,
            _ => self.number(node, "range").map(|n| unit * n),
        };
        (range.lower, range.upper) = (side(low), side(high));
    }
}
