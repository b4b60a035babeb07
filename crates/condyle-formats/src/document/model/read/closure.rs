//! Markers and loop closures.

use super::FRAME;
use super::ModelReader;
use crate::document::fields::Fields;
use crate::document::model::draft::{
    ClosureDraft, ConditionDraft, Draft, Holder, MarkerDraft, PlaceDraft,
};
use crate::document::model::keys;
use crate::document::tree::{Entry, Node, Value};
use condyle_math::{Affine, Vec3};

impl ModelReader<'_> {
    pub(super) fn marker(&mut self, draft: &mut Draft, entry: &Entry) {
        let name = entry.key.clone();
        let label = format!("marker.{}", name.text);
        if matches!(entry.node.value, Value::Text(_)) {
            // Another name for the place of a marker.
            let Some(like) = self.text(&entry.node, &label) else { return };
            draft.markers.push(MarkerDraft { name, place: PlaceDraft::Marker(like, Vec3::ZERO) });
            return;
        }
        let fields = self.table(&entry.node, name.spot, label, keys::MARKER);
        let (segment, point) = self.point(&fields);
        if let Some(node) = fields.get("like") {
            if fields.get("segment").is_some() {
                self.exclusive(node, "like", "segment");
            }
            let Some(like) = self.text(node, "like") else { return };
            draft.markers.push(MarkerDraft { name, place: PlaceDraft::Marker(like, point) });
            return;
        }
        draft.markers.push(MarkerDraft { name, place: PlaceDraft::Point(segment, point) });
    }

    pub(super) fn point(&mut self, fields: &Fields<'_>) -> (Holder, Vec3) {
        let segment = fields.get("segment").and_then(|n| self.text(n, "segment"));
        let point = fields.get("at").and_then(|n| self.vector(n, "at")).unwrap_or(Vec3::ZERO);
        (segment, point)
    }

    pub(super) fn closure(&mut self, draft: &mut Draft, entry: &Entry) {
        let name = entry.key.clone();
        let label = format!("closure.{}", name.text);
        let fields = self.table(&entry.node, name.spot, label.clone(), keys::CLOSURE);
        let distance = fields.get("distance");
        let condition = match (fields.get("points"), fields.get("frames"), fields.get("coupling")) {
            (Some(node), None, None) => self.two(node, "points").map(|[a, b]| {
                let mut point = |node: &Node| {
                    let fields = self.table(node, node.spot, label.clone(), keys::POINT);
                    self.point(&fields)
                };
                let at = [point(a), point(b)];
                match distance {
                    None => Some(ConditionDraft::Points(at)),
                    Some(n) => {
                        let distance = self.number(n, "distance")?;
                        Some(ConditionDraft::Distance(at, distance))
                    }
                }
            }),
            (None, Some(node), None) if distance.is_none() => {
                self.two(node, "frames").map(|[a, b]| {
                    let mut frame = |node: &Node| -> (Holder, Affine) {
                        let fields = self.table(node, node.spot, label.clone(), keys::FRAME);
                        let segment = fields.get("segment").and_then(|n| self.text(n, "segment"));
                        (segment, self.frame(&fields, FRAME))
                    };
                    Some(ConditionDraft::Frames([frame(a), frame(b)]))
                })
            }
            (None, None, Some(node)) if distance.is_none() => Some(self.coupling(node, &label)),
            _ => {
                let message = format!("[{label}] must have exactly one condition");
                let help = "give `points`, `points` with `distance`, `frames` or `coupling`";
                self.texts.error(name.spot, "model/closure", message, help);
                None
            }
        };
        if let Some(condition) = condition.flatten() {
            draft.closures.push(ClosureDraft { name, condition });
        }
    }

    fn two<'t>(&mut self, node: &'t Node, label: &str) -> Option<[&'t Node; 2]> {
        match self.list(node, label)? {
            [a, b] => Some([a, b]),
            list => {
                let message = format!("`{label}` has {} entries", list.len());
                self.length(node.spot, message, "give 2");
                None
            }
        }
    }

    fn coupling(&mut self, node: &Node, label: &str) -> Option<ConditionDraft> {
        let fields = self.table(node, node.spot, format!("{label}.coupling"), keys::COUPLING);
        let mut found = keys::COUPLING
            .iter()
            .map(|key| self.required(&fields, key, "`follower`, `driver` and `function`"));
        let (follower, driver, function) = (found.next()?, found.next()?, found.next()?);
        drop(found);
        let follower = self.text(follower?, "follower");
        let driver = self.text(driver?, "driver");
        let function = self.function(function?, "function");
        Some(ConditionDraft::Coupling { follower: follower?, driver: driver?, function: function? })
    }
}
