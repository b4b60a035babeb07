//! Learned limits of orientations: in files of their own, or in the model.

use super::ModelReader;
use crate::document::fields::Fields;
use crate::document::include::beside;
use crate::document::limit;
use crate::document::model::draft::{ComponentDraft, Draft};
use crate::document::texts::{Name, Spot};
use condyle_diagnostics::Severity;
use condyle_learn::limits::LearnedLimit;
use condyle_math::{EulerOrder, Quat};
use condyle_model::Law;
use condyle_model::component::{FieldLimit, Reflection, RelativeOrientation};
use std::sync::Arc;

impl ModelReader<'_> {
    pub(super) fn field(&mut self, fields: &Fields<'_>) -> Option<Law> {
        let limit = match (fields.get("file"), fields.get("limit")) {
            (Some(node), Some(_)) => {
                self.exclusive(node, "file", "limit");
                return None;
            }
            (Some(node), None) => {
                let path = self.text(node, "file")?;
                self.field_of(&path)
            }
            (None, Some(node)) => {
                let label = format!("{}.limit", fields.label);
                let known = [&["name"], limit::KEYS].concat();
                let own = self.table(node, node.spot, label, &known);
                let name = own.get("name").and_then(|node| self.text(node, "name"));
                let name = name.map(|name| name.text).unwrap_or_default();
                self.limit(&own, name).map(Arc::new)
            }
            (None, None) => {
                self.missing(fields, "file", "the path of a learned limit, or a table `limit`");
                return None;
            }
        };
        let in_reference = self.axes_in(fields, "in_reference");
        let in_segment = self.axes_in(fields, "in_segment");
        let driver_in_reference = self.axes_in(fields, "driver_in_reference");
        let driver_in_segment = self.axes_in(fields, "driver_in_segment");
        let planes = [("x", 0), ("y", 1), ("z", 2)];
        let mirrored = match fields.get("mirrored") {
            None => None,
            Some(_) => Some(Reflection::new(self.word(fields, "mirrored", &planes)?)?),
        };
        let words = [("open", false), ("closed", true)];
        let strict = self.word(fields, "holes", &words)?;
        let (limit, in_reference, in_segment) = (limit?, in_reference?, in_segment?);
        let (driver_in_reference, driver_in_segment) = (driver_in_reference?, driver_in_segment?);
        Some(Law::Field(FieldLimit {
            limit,
            in_reference,
            in_segment,
            driver_in_reference,
            driver_in_segment,
            mirrored,
            strict,
        }))
    }

    /// The limit in a file, whose path is seen from the text that names it.
    fn field_of(&mut self, named: &Name) -> Option<Arc<LearnedLimit>> {
        let path = beside(self.texts.path(named.spot), &named.text);
        if let Some(known) = self.fields.get(&path) {
            return known.clone();
        }
        let help = "give the path of a document of kind `limit`, from this one's folder";
        let read = match (self.reader.include)(&path) {
            Ok(text) => limit::read(&text, &mut |_| Err("limits stand alone".to_owned())),
            Err(why) => {
                let message = format!("`{path}` cannot be read: {why}");
                self.texts.error(named.spot, "document/include", message, help);
                self.fields.insert(path, None);
                return None;
            }
        };
        let read = match read {
            Ok(read) => {
                for warning in read.warnings {
                    let message = format!("{path}: {warning}");
                    let said =
                        self.texts.said(named.spot, Severity::Warning, warning.code, message);
                    self.texts.warn(named.spot, said);
                }
                Some(Arc::new(read.value))
            }
            Err(errors) => {
                for error in errors.iter() {
                    let message = format!("{path}: {error}");
                    self.texts.error(named.spot, error.code, message, help);
                }
                None
            }
        };
        self.fields.insert(path, read.clone());
        read
    }

    /// Axes in others: a unit quaternion x, y, z, w, or three angles about x, y and z in their order.
    fn axes_in(&mut self, fields: &Fields<'_>, key: &str) -> Option<Quat> {
        let Some(node) = fields.get(key) else { return Some(Quat::IDENTITY) };
        if self.list(node, key)?.len() == 3 {
            let unit = self.angle_unit(node.spot);
            let angles = self.some::<3>(node, key)?.map(|angle| unit * angle);
            return Some(Quat::from_mat3(EulerOrder::XYZ.to_mat3(angles)));
        }
        let given = Quat::from(self.some::<4>(node, key)?);
        let exact = (given.dot(given) - 1.0).abs() < 1e-12;
        if exact { Some(given) } else { self.rotation_of(node, key) }
    }

    /// What a field reads: the rotation that it limits, and where it depends on another joint its driver. Of two segments it
    /// is the component that measures the one in the other.
    pub(super) fn measured_for(
        &mut self,
        draft: &mut Draft,
        set: &str,
        name: &Name,
        fields: &Fields<'_>,
    ) -> Option<Vec<Name>> {
        let wanted =
            "an `orientation`, or the `segment` whose rotation is limited and its `reference`";
        let own = ["orientation", "segment", "reference"];
        let mut ports =
            vec![self.turned(draft, set, ("measured_for", name), fields, own, wanted)?];
        let driver = ["driver_orientation", "driver_segment", "driver_reference"];
        if let Some(node) = fields.get("driver") {
            for key in driver {
                if fields.get(key).is_some() {
                    self.exclusive(node, "driver", key);
                    return None;
                }
            }
            ports.push(self.text(node, "driver")?);
        } else if driver.iter().any(|key| fields.get(key).is_some()) {
            let wanted =
                "a `driver_orientation`, or the `driver_segment` that the limit depends on";
            let driven = ("driver_of", name);
            ports.push(self.turned(draft, set, driven, fields, driver, wanted)?);
        }
        Some(ports)
    }

    /// A rotation at a port, or of a segment in another by a component that measures it.
    fn turned(
        &mut self,
        draft: &mut Draft,
        set: &str,
        (prefix, name): (&str, &Name),
        fields: &Fields<'_>,
        [port, segment, reference]: [&'static str; 3],
        wanted: &str,
    ) -> Option<Name> {
        if let Some(node) = fields.get(port) {
            for key in [segment, reference] {
                if fields.get(key).is_some() {
                    self.exclusive(node, port, key);
                    return None;
                }
            }
            return self.text(node, port);
        }
        let node = self.required(fields, segment, wanted)?;
        let mut ports = vec![self.text(node, segment)?];
        if let Some(node) = fields.get(reference) {
            ports.push(self.text(node, reference)?);
        }
        let law = Law::RelativeOrientation(RelativeOrientation { reference: ports.len() > 1 });
        // The end of a name tells its side.
        let spot = Spot { ..name.spot };
        let measured = Name { text: format!("{prefix}_{}", name.text), spot };
        let port = Name { text: measured.text.clone(), spot };
        draft.components.push(ComponentDraft { set: set.to_owned(), name: measured, law, ports });
        Some(port)
    }
}
