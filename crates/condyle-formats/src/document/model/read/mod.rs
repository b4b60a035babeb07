//! The tables of a model document, read into a [`Draft`].

mod closure;
mod component;
mod cone;
mod contact;
mod coordinate;
mod custom;
mod field;
mod limit;
mod measured;
mod posture;
mod shape;
mod size;
mod surface;

pub(super) use component::component_keys;

use crate::document::fields::{Fields, Reader};
use crate::document::model::draft::{CoordinateDraft, Draft, OutputDraft, SegmentDraft};
use crate::document::model::keys;
use crate::document::model::mirror::Mirror;
use crate::document::tree::{Entry, Node};
use condyle_learn::limits::LearnedLimit;
use condyle_model::component::{Reflection, Registry};
use condyle_model::model::Facing;
use condyle_model::{CoordinateKind, UpAxis};
use std::collections::HashMap;
use std::ops::{Deref, DerefMut};
use std::sync::Arc;

const FRAME: [&str; 4] = ["at", "turn", "order", "matrix"];

/// The generic reader, and what only a model needs.
pub(super) struct ModelReader<'s> {
    pub(super) reader: Reader<'s>,
    /// The laws that components of kind `custom` may name.
    pub(super) laws: Registry,
    /// The learned limits that were read, by their paths.
    pub(super) fields: HashMap<String, Option<Arc<LearnedLimit>>>,
}

impl<'s> Deref for ModelReader<'s> {
    type Target = Reader<'s>;

    fn deref(&self) -> &Self::Target {
        &self.reader
    }
}

impl DerefMut for ModelReader<'_> {
    fn deref_mut(&mut self) -> &mut Self::Target {
        &mut self.reader
    }
}

impl ModelReader<'_> {
    /// Reads all tables of a model.
    pub(super) fn draft(&mut self, top: &Fields<'_>) -> Draft {
        let name = top.get("name").and_then(|n| self.text(n, "name")).map(|n| n.text);
        let mut draft = Draft { name, ..Draft::default() };
        match top.get("up").and_then(|n| self.text(n, "up")) {
            Some(up) if up.text == "z" => draft.up = UpAxis::Z,
            Some(up) if up.text != "y" => {
                let message = format!("unknown up axis `{}`", up.text);
                self.texts.error(up.spot, "model/up", message, "give \"y\" or \"z\"");
            }
            _ => {}
        }
        if let Some(facing) = top.get("facing").and_then(|n| self.text(n, "facing")) {
            match Facing::named_in(&facing.text, draft.up) {
                Some(found) => draft.facing = found,
                None => {
                    let message = format!("unknown direction `{}`", facing.text);
                    let help = "give the axis along which the character looks: \"+x\", \"-x\", \
                                \"+z\" or \"-z\"; where z is up \"+y\" or \"-y\"";
                    self.texts.error(facing.spot, "model/facing", message, help);
                }
            }
        }
        for &family in keys::REPEATED {
            let Some(node) = top.get(family) else { continue };
            for entry in self.entries(node, family) {
                match family {
                    "segment" => self.segment(&mut draft, entry),
                    "joint" => self.joint(&mut draft, entry),
                    "joint_set" => self.joint_set(&mut draft, entry),
                    "marker" => self.marker(&mut draft, entry),
                    "shape" => self.shape(&mut draft, entry),
                    "closure" => self.closure(&mut draft, entry),
                    "posture" => self.posture(&mut draft, entry),
                    _ => self.size(&mut draft, entry),
                }
            }
        }
        draft.sort();
        if let Some(mirror) = top.get("mirror").and_then(|n| self.mirror(n)) {
            mirror.complete(&mut draft, self.reader.texts);
            size::both_sides(&mirror, &mut draft);
        }
        draft
    }

    fn mirror(&mut self, node: &Node) -> Option<Mirror> {
        let fields = self.table(node, node.spot, "mirror".to_owned(), keys::MIRROR);
        let mut texts = ["plane", "from", "to"].map(|key| {
            let wanted = "a mirror such as { plane = \"z\", from = \"_r\", to = \"_l\" }";
            self.required(&fields, key, wanted).and_then(|node| self.text(node, key))
        });
        let [plane, from, to] = texts.each_mut().map(Option::take);
        let (plane, from, to) = (plane?, from?, to?);
        if from.text.is_empty() || from.text == to.text {
            let message = "`from` and `to` are the same";
            let help = "give different endings of names, such as from = \"_r\", to = \"_l\"";
            self.texts.error(from.spot, "model/mirror", message, help);
            return None;
        }
        let axis = ["x", "y", "z"].iter().position(|a| *a == plane.text);
        let Some(axis) = axis.and_then(Reflection::new) else {
            let message = format!("unknown mirror plane `{}`", plane.text);
            let help = "give the axis normal to it: \"x\", \"y\" or \"z\"";
            self.texts.error(plane.spot, "model/mirror", message, help);
            return None;
        };
        Some(Mirror { reflection: axis, from: from.text, to: to.text, spot: from.spot })
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
                let kind = CoordinateKind::Rotation;
                let start = CoordinateDraft::new(&set.text, entry.key.clone(), kind);
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
