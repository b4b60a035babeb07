//! The tables of a model document, one after the other, into a [`Draft`].

mod closure;
mod component;
mod cone;
mod contact;
mod coordinate;
mod custom;
mod shape;
mod size;

use crate::document::model::draft::{CoordinateDraft, Draft, OutputDraft, SegmentDraft};
use crate::document::fields::{Fields, Reader};
use crate::document::model::keys;
use crate::document::model::mirror::Mirror;
use crate::document::texts::Spot;
use crate::document::tree::{Entry, Node, Value};
use condyle_model::{CoordinateKind, Range, UpAxis};

const FRAME: [&str; 4] = ["at", "turn", "order", "matrix"];

impl ModelReader<'_> {
    /// Reads the whole tree.
    pub(super) fn draft(&mut self, entries: Vec<Entry>) -> Draft {
        let root = Node { value: Value::Table(entries), spot: Spot::default() };
        let top = self.table(&root, root.spot, String::new(), keys::TOP);
        let mut draft = Draft::default();
        if let Some(node) = top.get("constants") {
            self.constants(node);
        }
        draft.name = top.get("name").and_then(|n| self.text(n, "name")).map(|n| n.text);
        match top.get("up").and_then(|n| self.text(n, "up")) {
            Some(up) if up.text == "z" => draft.up = UpAxis::Z,
            Some(up) if up.text != "y" => {
                let message = format!("`up` is `{}`", up.text);
                self.texts.error(up.spot, "model/up", message, "give \"y\" or \"z\"");
            }
            _ => {}
        }
        for family in ["segment", "joint", "joint_set", "marker", "closure", "size"] {
            let Some(node) = top.get(family) else { continue };
            for entry in self.entries(node, family) {
                match family {
                    "segment" => self.segment(&mut draft, entry),
                    "joint" => self.joint(&mut draft, entry),
                    "joint_set" => self.joint_set(&mut draft, entry),
                    "marker" => self.marker(&mut draft, entry),
                    "closure" => self.closure(&mut draft, entry),
                    _ => self.size(&mut draft, entry),
                }
            }
        }
        draft.sort();
        if let Some(mirror) = top.get("mirror").and_then(|n| self.mirror(n)) {
            mirror.complete(&mut draft, self.texts);
            size::both_sides(&mirror, &mut draft);
        }
        draft
    }

    /// The constants in the order of the text: each may use those before it.
    fn constants(&mut self, node: &Node) {
        let entries = self.entries(node, "constants");
        let unknown = entries.iter().map(|e| (e.key.text.clone(), Constant::Below));
        self.constants = unknown.collect();
        for entry in entries {
            let constant = match self.number(&entry.node, &entry.key.text) {
                Some(number) => Constant::Is(number),
                None => Constant::Wrong,
            };
            self.constants.insert(entry.key.text.clone(), constant);
        }
    }

    fn mirror(&mut self, node: &Node) -> Option<Mirror> {
        let fields = self.table(node, node.spot, "mirror".to_owned(), keys::MIRROR);
        let mut texts = ["plane", "from", "to"].map(|key| {
            let Some(node) = fields.get(key) else {
                let wanted = "a mirror such as { plane = \"z\", from = \"_r\", to = \"_l\" }";
                self.missing(&fields, key, wanted);
                return None;
            };
            self.text(node, key)
        });
        let [plane, from, to] = texts.each_mut().map(Option::take);
        let (plane, from, to) = (plane?, from?, to?);
        if from.text.is_empty() || from.text == to.text {
            let message = "the two ends of names are the same";
            let help = "give different ones, such as from = \"_r\", to = \"_l\"";
            self.texts.error(from.spot, "model/mirror", message, help);
            return None;
        }
        let Some(axis) = ["x", "y", "z"].iter().position(|a| *a == plane.text) else {
            let message = format!("`plane` is `{}`", plane.text);
            let help = "give the axis that is reversed: \"x\", \"y\" or \"z\"";
            self.texts.error(plane.spot, "model/mirror", message, help);
            return None;
        };
        Some(Mirror { axis, from: from.text, to: to.text })
    }

    fn segment(&mut self, draft: &mut Draft, entry: &Entry) {
        let name = entry.key.clone();
        let label = format!("segment.{}", name.text);
        let fields = self.table(&entry.node, name.spot, label, keys::SEGMENT);
        let parent = fields.get("parent").and_then(|n| self.text(n, "parent"));
        let in_parent = self.frame(&fields, FRAME);
        let in_itself =
            self.frame(&fields, ["joint_at", "joint_turn", "joint_order", "joint_matrix"]);
        draft.segments.push(SegmentDraft { name, parent, in_parent, in_itself });
    }

    fn joint_set(&mut self, draft: &mut Draft, entry: &Entry) {
        let set = entry.key.clone();
        let label = format!("joint_set.{}", set.text);
        let fields = self.table(&entry.node, set.spot, label.clone(), keys::JOINT_SET);
        draft.sets.push(set.clone());
        if let Some(node) = fields.get("coordinate") {
            for entry in self.entries(node, "coordinate") {
                let start = CoordinateDraft {
                    set: set.text.clone(),
                    name: entry.key.clone(),
                    kind: CoordinateKind::Rotation,
                    default: CoordinateKind::Rotation.neutral(),
                    range: Range::FREE,
                    locked: false,
                    source: None,
                    follows: None,
                };
                let coordinate = self.coordinate(&label, entry, start, true);
                draft.coordinates.push(coordinate);
            }
        }
        if let Some(node) = fields.get("component") {
            for entry in self.entries(node, "component") {
                self.component(draft, &set.text, entry);
            }
        }
        if let Some(node) = fields.get("output") {
            for entry in self.entries(node, "output") {
                let (ports, listed) = self.names(&entry.node, &entry.key.text);
                let segment = entry.key.clone();
                draft.outputs.push(OutputDraft { set: set.text.clone(), segment, ports, listed });
            }
        }
    }
}
