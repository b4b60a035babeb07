//! What a limit depends on, in its document.

use super::super::model::{number, text};
use super::super::tree::Value;
use super::write::{letters, packed_samples};
use super::{Fields, Reader};
use crate::text::base64;
use condyle_learn::limits::dependent::{Dependence, DependenceKnown, DependenceSettings, Drivers};
use condyle_model::CoordinateKind;
use condyle_model::limit::field::snapped;
use std::fmt::Write;

const KEYS: &[&str] = &[
    "name",
    "reference",
    "unit",
    "values",
    "packed",
    "rotations",
    "slope",
    "step",
    "nodes",
    "few",
    "layer",
    "radius",
    "gap",
];

/// Units of coordinates, by what they measure.
pub(crate) const UNITS: [(CoordinateKind, &str); 3] = [
    (CoordinateKind::Rotation, "rad"),
    (CoordinateKind::Translation, "m"),
    (CoordinateKind::Other, "1"),
];

impl Reader<'_> {
    /// The table `given` of a limit with so many samples.
    pub(super) fn given(&mut self, top: &Fields<'_>, samples: usize) -> Option<Dependence> {
        let fields = self.table_of(top, "given", KEYS)?;
        let name = self.required(&fields, "name", "the coordinate or segment that it depends on");
        let name = name.and_then(|node| self.text(node, "name"))?.text;
        let reference = match fields.get("reference") {
            Some(node) => Some(self.text(node, "reference")?.text),
            None => None,
        };
        let drivers = self.drivers(&fields)?;
        let kind = self.kind(&fields, &drivers)?;
        if drivers.len() != samples {
            let message = format!("{} values for {samples} samples", drivers.len());
            self.length(fields.spot, message, "give the driver at each sample");
            return None;
        }
        let mut settings = DependenceSettings::of(&drivers);
        let mut numbers = [None; 5];
        for (number, key) in numbers.iter_mut().zip(["slope", "step", "layer", "radius", "gap"]) {
            if let Some(node) = fields.get(key) {
                *number = Some(self.not_negative(node, key)?);
            }
        }
        let [slope, step, layer, radius, gap] = numbers;
        settings.slope = slope.unwrap_or(settings.slope);
        settings.step = step.unwrap_or(settings.step);
        settings.gap = layer;
        if let Some(node) = fields.get("nodes") {
            settings.nodes = self.count(node, "nodes")?;
        }
        if let Some(node) = fields.get("few") {
            settings.few = self.count(node, "few")?.min(1 << 20) as u32;
        }
        let turn = std::f64::consts::PI;
        let angles = [layer, radius, gap].into_iter().flatten().all(|angle| angle < turn);
        if !(settings.step > 0.0 && (24..=128).contains(&settings.nodes) && angles) {
            let message =
                "`step` is 0, `nodes` are not 24 to 128, or an angle is half a turn or more";
            let help = "correct them, or leave them out";
            self.texts.error(fields.spot, "limit/settings", message.to_owned(), help);
            return None;
        }
        let known = match (radius, gap) {
            (Some(radius), Some(gap)) if radius > 0.0 => Some(DependenceKnown { radius, gap }),
            (None, None) => None,
            _ => {
                let message = "[given] has not both of `radius` above 0 and `gap`".to_owned();
                self.texts.error(fields.spot, "limit/learned", message, "give both, or none");
                return None;
            }
        };
        Some(Dependence { name, reference, kind, drivers, settings, known })
    }

    /// What a coordinate measures, by its unit.
    fn kind(&mut self, fields: &Fields<'_>, drivers: &Drivers) -> Option<CoordinateKind> {
        let Some(node) = fields.get("unit") else { return Some(drivers.usual_kind()) };
        let unit = self.text(node, "unit")?;
        let kind = UNITS.iter().find(|(_, name)| *name == unit.text).map(|(kind, _)| *kind);
        if kind.is_none() || matches!(drivers, Drivers::Rotations(_)) {
            let message = format!("`{}` is no unit of what the limit depends on", unit.text);
            let help = "\"rad\", \"m\" or \"1\" of a coordinate, none of a rotation";
            self.texts.error(unit.spot, "limit/unit", message, help);
            return None;
        }
        kind
    }

    fn drivers(&mut self, fields: &Fields<'_>) -> Option<Drivers> {
        let given: Vec<_> = ["values", "packed", "rotations"]
            .into_iter()
            .filter(|key| fields.get(key).is_some())
            .collect();
        match (given[..].first().copied(), given.len()) {
            (Some("values"), 1) => {
                let node = fields.get("values")?;
                if matches!(node.value, Value::List(_)) {
                    let list = self.list(node, "values")?;
                    let all: Vec<Option<f64>> =
                        list.iter().map(|node| self.number(node, "values")).collect();
                    return all.into_iter().collect::<Option<Vec<_>>>().map(Drivers::Scalars);
                }
                let text = self.text(node, "values")?;
                let bytes = base64::decode(&text.text).filter(|bytes| bytes.len() % 4 == 0);
                let values: Vec<f64> = bytes
                    .iter()
                    .flat_map(|bytes| bytes.chunks_exact(4))
                    .filter_map(|four| <[u8; 4]>::try_from(four).ok())
                    .map(|four| f64::from(f32::from_le_bytes(four)))
                    .collect();
                if bytes.is_none() || values.iter().any(|value| !value.is_finite()) {
                    let message = "`values` is no base64 of finite numbers".to_owned();
                    let help = "four bytes a value, as condyle writes them, or a list of numbers";
                    self.texts.error(text.spot, "limit/packed", message, help);
                    return None;
                }
                Some(Drivers::Scalars(values))
            }
            (Some("packed"), 1) => {
                let text = self.text(fields.get("packed")?, "packed")?;
                self.unpacked(&text.text, text.spot).map(Drivers::Rotations)
            }
            (Some("rotations"), 1) => {
                let list = self.list(fields.get("rotations")?, "rotations")?;
                let all: Vec<Option<condyle_math::Quat>> =
                    list.iter().map(|node| self.rotation_of(node, "rotations")).collect();
                let all = all.into_iter().map(|q| q.map(snapped)).collect::<Option<Vec<_>>>()?;
                Some(Drivers::Rotations(all))
            }
            _ => {
                self.missing(
                    fields,
                    "values",
                    "the driver at each sample: one of `values`, `packed`, `rotations`",
                );
                None
            }
        }
    }
}

/// Writes what a limit depends on.
pub(super) fn given(out: &mut String, dependence: &Dependence, within: &str) {
    let Dependence { name, reference, kind, drivers, settings, known } = dependence;
    let DependenceSettings { slope, step, nodes, few, gap } = settings;
    let _ = writeln!(out, "\n[{within}given]");
    let _ = writeln!(out, "name = {}", text(name));
    if let Some(reference) = reference {
        let _ = writeln!(out, "reference = {}", text(reference));
    }
    if *kind != drivers.usual_kind()
        && let Some((_, unit)) = UNITS.iter().find(|(own, _)| own == kind)
    {
        let _ = writeln!(out, "unit = {}", text(unit));
    }
    let _ = writeln!(out, "slope = {}", number(*slope));
    let _ = writeln!(out, "step = {}", number(*step));
    let _ = writeln!(out, "nodes = {nodes}");
    let _ = writeln!(out, "few = {few}");
    if let Some(layer) = gap {
        let _ = writeln!(out, "layer = {}", number(*layer));
    }
    if let Some(DependenceKnown { radius, gap }) = known {
        for (key, angle) in [("radius", radius), ("gap", gap)] {
            let _ = writeln!(out, "{key} = {} # {:.2} degrees", number(*angle), angle.to_degrees());
        }
    }
    match drivers {
        Drivers::Scalars(values) => {
            let bytes: Vec<u8> =
                values.iter().flat_map(|value| (*value as f32).to_le_bytes()).collect();
            let _ = writeln!(out, "# {} values: an f32 each", values.len());
            letters(out, "values", &bytes);
        }
        Drivers::Rotations(values) => packed_samples(out, values),
    }
}
