//! Posture terms: sums of coordinates with a value at rest and a stiffness.

use super::ModelReader;
use crate::document::fields::Fields;
use crate::document::model::draft::{Draft, PostureDraft};
use crate::document::model::keys;
use crate::document::tree::Entry;

impl ModelReader<'_> {
    pub(super) fn posture(&mut self, draft: &mut Draft, entry: &Entry) {
        let name = entry.key.clone();
        let label = format!("posture.{}", name.text);
        let fields = self.table(&entry.node, name.spot, label, keys::POSTURE);
        let wanted = "the coordinates with their factors, such as { neck = 1, trunk = -0.5 }";
        let sum = self.required(&fields, "sum", wanted);
        let wanted = "a number in m² per rad² (or per m²), such as 1e-5";
        let stiffness = self.required(&fields, "stiffness", wanted);
        let stiffness = stiffness.and_then(|node| self.number(node, "stiffness"));
        let rest = self.number_or(&fields, "rest", 0.0);
        let source = fields.get("source").and_then(|n| self.text(n, "source")).map(|n| n.text);
        let angle_unit = self.angle_unit(fields.get("rest").map_or(name.spot, |node| node.spot));
        let Some(entries) = sum.map(|node| self.entries(node, "sum")) else { return };
        let factor = |e: &Entry| Some((e.key.clone(), self.number(&e.node, &e.key.text)?));
        let sum: Vec<_> = entries.iter().map(factor).collect();
        if let (Some(sum), Some(rest), Some(stiffness)) =
            (sum.into_iter().collect(), rest, stiffness)
        {
            draft.postures.push(PostureDraft { name, sum, rest, angle_unit, stiffness, source });
        }
    }

    /// The value at rest and the stiffness of a single coordinate, in the unit that it states; it rests at its default
    /// unless a value is given.
    pub(super) fn rest(
        &mut self,
        fields: &Fields<'_>,
        stated: Option<f64>,
        rotation: bool,
        default: f64,
    ) -> Option<[f64; 2]> {
        let rest = fields.get("rest");
        let Some(stiffness) = fields.get("stiffness") else {
            if let Some(node) = rest {
                let message = "`rest` is given without `stiffness`";
                let help = "give how stiff it is, such as stiffness = 1e-5, or omit `rest`";
                self.texts.error(node.spot, "document/missing", message, help);
            }
            return None;
        };
        let stiffness = self.number(stiffness, "stiffness");
        let rest = match rest {
            Some(node) => {
                let unit = self.factor(stated, rotation, node);
                self.number(node, "rest").map(|value| unit * value)
            }
            None => Some(default),
        };
        Some([rest?, stiffness?])
    }
}
