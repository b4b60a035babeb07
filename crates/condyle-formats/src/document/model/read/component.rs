//! Components: their parameters, and the names at their ports.

use crate::document::model::draft::{ComponentDraft, Draft};
use crate::document::fields::Fields;
use crate::document::function::rescaled;
use crate::document::model::keys;
use crate::document::model::blueprint::Blueprint;
use crate::document::texts::Name;
use crate::document::tree::{Entry, Node, Value};
use super::FRAME;
use condyle_diagnostics::nearest;
use condyle_math::Vec3;
use condyle_math::function::Function;

/// What is asked for where a direction is missing.
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
                draft.components.push(ComponentDraft { set: set.to_owned(), name, blueprint, ports });
            }
            // What reads it is not to blame.
            None => _ = draft.broken.insert((set.to_owned(), name.text)),
        }
    }

    /// The one table of a component, which is named by its kind, and the keys of that kind.
    fn kind_of<'t>(
        &mut self,
        label: &str,
        entry: &'t Entry,
    ) -> Option<(&'t Entry, &'static [&'static str])> {
        let kinds: Vec<&str> = keys::COMPONENTS.iter().map(|(kind, _)| *kind).collect();
        let [one] = self.entries(&entry.node, label) else {
            if matches!(entry.node.value, Value::Table(_)) {
                let message = format!("[{label}] does not hold one component");
                let help = format!("name its kind: [{label}.KIND] with {}", kinds.join(", "));
                self.texts.error(entry.key.spot, "model/component", message, help);
            }
            return None;
        };
        let kind = one.key.text.as_str();
        if let Some((_, known)) = keys::COMPONENTS.iter().find(|(k, _)| *k == kind) {
            return Some((one, known));
        }
        let help = match nearest(kind, kinds.iter().copied()) {
            Some(near) => format!("did you mean `{near}`?"),
            None => format!("kinds are: {}", kinds.join(", ")),
        };
        let message = format!("unknown kind of component `{kind}`");
        self.texts.error(one.key.spot, "model/component", message, help);
        None
    }

    /// The parameters of a component and the names at its ports.
    fn blueprint(&mut self, fields: &Fields<'_>, kind: &str) -> Option<(Blueprint, Vec<Name>)> {
        let names = self.ports(fields, kind);
        let blueprint = match kind {
            "map" => Blueprint::Map(self.map(fields)?),
            "combine" => match fields.get("function") {
                Some(node) => Blueprint::Combine(self.several(node, "function")?),
                None => {
                    self.missing(fields, "function", "{ slopes = [...], intercept = 0 }");
                    return None;
                }
            },
            "rotate" => Blueprint::Rotate(self.needed(fields, "axis", DIRECTION)?),
            "translate" => {
                Blueprint::Translate(self.needed(fields, "axis", "a direction such as [0, 1, 0]")?)
            }
            "depend" => self.depend(fields)?,
            "cone" => self.cone(fields)?,
            "contact" => self.contact(fields)?,
            "pivot" => {
                let axis = self.needed(fields, "axis", DIRECTION);
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
            match fields.get(port) {
                Some(node) => names.push(self.text(node, port)),
                None => {
                    self.missing(fields, port, "the name of a coordinate or a component");
                    names.push(None);
                }
            }
        }
        let several = match kind {
            "combine" | "custom" => Some("inputs"),
            "product" => Some("factors"),
            "contact" if fields.get("drivers").is_some() => Some("drivers"),
            "cone" if fields.get("orientation").is_none() => Some("angles"),
            _ => None,
        };
        if let Some(port) = several {
            match fields.get(port) {
                Some(node) => names.extend(self.names(node, port).0.into_iter().map(Some)),
                None if kind == "cone" => {
                    let wanted = "the names of three angles (or two), or an `orientation`";
                    self.missing(fields, port, wanted);
                    names.push(None);
                }
                None => {
                    self.missing(fields, port, "a list of names");
                    names.push(None);
                }
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
            self.missing(fields, "ancestors", "`segment` and the `ancestors` to be compensated");
            return None;
        };
        let segment = self.text(segment, "segment");
        let ancestors = self.names(ancestors, "ancestors").0;
        let weight = match fields.get("weight") {
            Some(node) => self.number(node, "weight")?,
            None => 1.0,
        };
        Some(Blueprint::Compensate { segment: segment?, ancestors, weight })
    }

    pub(super) fn needed(&mut self, fields: &Fields<'_>, key: &str, wanted: &str) -> Option<Vec3> {
        match fields.get(key) {
            Some(node) => self.vector(node, key),
            None => {
                self.missing(fields, key, wanted);
                None
            }
        }
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
                let message = "both `function` and `functions` are given";
                self.texts.error(node.spot, "model/exclusive", message, "give one of them");
                return None;
            }
        };
        let mut unit = |key: &str| fields.get(key).map_or(Some(1.0), |n| self.unit_of(n, key));
        let (argument, value) = (unit("in")?, unit("out")?);
        functions = functions.into_iter().map(|f| rescaled(f, argument, value)).collect();
        Some(functions)
    }

    /// What numbers in a unit have to be multiplied with.
    pub(super) fn unit_of(&mut self, node: &Node, key: &str) -> Option<f64> {
        let name = self.text(node, key)?;
        match name.text.as_str() {
            "rad" | "m" => Some(1.0),
            "deg" => Some(std::f64::consts::PI / 180.0),
            "mm" => Some(0.001),
            other => {
                let message = format!("unknown unit `{other}`");
                let help = "units are: rad, deg, m, mm";
                self.texts.error(name.spot, "model/unit", message, help);
                None
            }
        }
    }

    /// What stands at a key that takes one of a few words; the first of them unless said.
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
        let help = match nearest(&name.text, known.clone()) {
            Some(near) => format!("did you mean \"{near}\"?"),
            None => {
                let known: Vec<String> = known.map(|word| format!("\"{word}\"")).collect();
                format!("give {}", known.join(" or "))
            }
        };
        let message = format!("`{key}` is `{}`", name.text);
        self.texts.error(name.spot, "model/word", message, help);
        None
    }
}
