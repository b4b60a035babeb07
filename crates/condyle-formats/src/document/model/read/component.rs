//! Components: their parameters, and the names at their ports.

use super::FRAME;
use super::ModelReader;
use crate::document::fields::Fields;
use crate::document::function::rescaled;
use crate::document::model::blueprint::Blueprint;
use crate::document::model::draft::{ComponentDraft, Draft};
use crate::document::model::keys;
use crate::document::texts::Name;
use crate::document::tree::{Entry, Value};
use condyle_diagnostics::did_you_mean;
use condyle_math::function::Function;

/// The help where a direction is missing.
pub(super) const DIRECTION: &str = "a direction such as [0, 0, 1]";

impl ModelReader<'_> {
    pub(super) fn component(&mut self, draft: &mut Draft, set: &str, entry: &Entry) {
        let name = entry.key.clone();
        let label = format!("joint_set.{set}.component.{}", name.text);
        let read = self.kind_of(&label, entry).and_then(|(one, known)| {
            let kind = one.key.text.as_str();
            let fields = self.table(&one.node, name.spot, format!("{label}.{kind}"), known);
            self.blueprint(&fields, kind)
        });
        match read {
            Some((blueprint, ports)) => {
                draft.components.push(ComponentDraft {
                    set: set.to_owned(),
                    name,
                    blueprint,
                    ports,
                });
            }
            // Do not report errors again for components that reference this one.
            None => _ = draft.broken.insert((set.to_owned(), name.text)),
        }
    }

    /// The one table of a component, named by its kind, and the keys of that kind.
    fn kind_of<'t>(
        &mut self,
        label: &str,
        entry: &'t Entry,
    ) -> Option<(&'t Entry, &'static [&'static str])> {
        let kinds: Vec<&str> = keys::COMPONENTS.iter().map(|(kind, _)| *kind).collect();
        let [one] = self.entries(&entry.node, label) else {
            if matches!(entry.node.value, Value::Table(_)) {
                let message = format!("[{label}] must hold exactly one component");
                let help = format!("give its kind as [{label}.KIND], one of: {}", kinds.join(", "));
                self.texts.error(entry.key.spot, "model/component", message, help);
            }
            return None;
        };
        let kind = one.key.text.as_str();
        if let Some((_, known)) = keys::COMPONENTS.iter().find(|(k, _)| *k == kind) {
            return Some((one, known));
        }
        let all = || format!("kinds are: {}", kinds.join(", "));
        let help = did_you_mean(kind, kinds.iter().copied(), all);
        let message = format!("unknown kind of component `{kind}`");
        self.texts.error(one.key.spot, "model/component", message, help);
        None
    }

    /// The parameters of a component and the names at its ports.
    fn blueprint(&mut self, fields: &Fields<'_>, kind: &str) -> Option<(Blueprint, Vec<Name>)> {
        let names = self.ports(fields, kind);
        let blueprint = match kind {
            "map" => Blueprint::Map(self.map(fields)?),
            "combine" => {
                let wanted = "{ slopes = [...], intercept = 0 }";
                let node = self.required(fields, "function", wanted)?;
                Blueprint::Combine(self.several(node, "function")?)
            }
            "rotate" => Blueprint::Rotate(self.required_vector(fields, "axis", DIRECTION)?),
            "translate" => Blueprint::Translate(self.required_vector(
                fields,
                "axis",
                "a direction such as [0, 1, 0]",
            )?),
            "depend" => self.depend(fields)?,
            "cone" => self.cone(fields)?,
            "contact" => self.contact(fields)?,
            "pivot" => {
                let axis = self.required_vector(fields, "axis", DIRECTION);
                let centre = self.centre(fields)?;
                Blueprint::Pivot(axis?, centre)
            }
            "compensate" => self.compensate(fields)?,
            "ball" => Blueprint::Ball,
            "place" => Blueprint::Place(self.frame(fields, FRAME)),
            "ellipsoid" => self.ellipsoid(fields)?,
            "constant_curvature" => self.column(fields)?,
            "scale" => self.scale(fields)?,
            "shear" => self.shear(fields)?,
            "curve" => self.curve(fields)?,
            "custom" => self.custom(fields)?,
            _ => Blueprint::Product,
        };
        Some((blueprint, names?))
    }

    /// The names at the ports of a component, in their order.
    fn ports(&mut self, fields: &Fields<'_>, kind: &str) -> Option<Vec<Name>> {
        let single: &[&str] = match kind {
            "map" => &["input"],
            "rotate" | "pivot" => &["angle"],
            "depend" => &["passive", "driver"],
            "translate" => &["distance"],
            "ball" => &["orientation"],
            "ellipsoid" => &["about_x", "about_y", "about_z"],
            "constant_curvature" => &["about_x", "about_z", "about_y"],
            "scale" => &["factor"],
            "shear" => &["amount"],
            "curve" => &["parameter"],
            "contact" if fields.get("before").is_some() => &["before"],
            "cone" if fields.get("orientation").is_some() => &["orientation"],
            _ => &[],
        };
        let mut names: Vec<Option<Name>> = vec![];
        for port in single {
            let wanted = "the name of a coordinate or a component";
            names.push(self.required(fields, port, wanted).and_then(|n| self.text(n, port)));
        }
        let several = match kind {
            "combine" | "custom" => Some("inputs"),
            "product" => Some("factors"),
            "contact" if fields.get("drivers").is_some() => Some("drivers"),
            "cone" if fields.get("orientation").is_none() => Some("angles"),
            _ => None,
        };
        if let Some(port) = several {
            let wanted = match kind {
                "cone" => "the names of three angles (or two), or an `orientation`",
                _ => "a list of names",
            };
            match self.required(fields, port, wanted) {
                Some(node) => names.extend(self.names(node, port).0.into_iter().map(Some)),
                None => names.push(None),
            }
        }
        names.into_iter().collect()
    }

    fn depend(&mut self, fields: &Fields<'_>) -> Option<Blueprint> {
        let mut bound = |key: &str| match fields.get(key) {
            Some(node) => self.function(node, key).map(Some),
            None => Some(None),
        };
        let (lower, upper) = (bound("lower"), bound("upper"));
        if matches!((&lower, &upper), (Some(None), Some(None))) {
            self.missing(fields, "lower", "`lower`, `upper` or both, as functions of the driver");
            return None;
        }
        Some(Blueprint::Depend { lower: lower?, upper: upper? })
    }

    fn compensate(&mut self, fields: &Fields<'_>) -> Option<Blueprint> {
        let (Some(segment), Some(ancestors)) = (fields.get("segment"), fields.get("ancestors"))
        else {
            self.missing(
                fields,
                "ancestors",
                "`segment`, and the `ancestors` whose turns it compensates",
            );
            return None;
        };
        let segment = self.text(segment, "segment");
        let ancestors = self.names(ancestors, "ancestors").0;
        let weight = self.number_or(fields, "weight", 1.0)?;
        Some(Blueprint::Compensate { segment: segment?, ancestors, weight })
    }

    fn map(&mut self, fields: &Fields<'_>) -> Option<Vec<Function>> {
        let mut functions = match (fields.get("function"), fields.get("functions")) {
            (Some(node), None) => vec![self.function(node, "function")?],
            (None, Some(node)) => {
                let list = self.list(node, "functions")?;
                let read: Vec<_> = list.iter().map(|n| self.function(n, "functions")).collect();
                read.into_iter().collect::<Option<Vec<_>>>()?
            }
            (None, None) => {
                self.missing(fields, "function", "a function such as { linear = [0.5, 0] }");
                return None;
            }
            (Some(_), Some(node)) => {
                self.exclusive(node, "function", "functions");
                return None;
            }
        };
        let mut unit = |key: &str| fields.get(key).map_or(Some(1.0), |n| self.unit_of(n, key));
        let (argument, value) = (unit("in")?, unit("out")?);
        functions = functions.into_iter().map(|f| rescaled(f, argument, value)).collect();
        Some(functions)
    }
}
