//! The parameters of paths, ellipsoids, columns, scales and shears.

use super::ModelReader;
use crate::document::fields::Fields;
use crate::document::model::keys;
use crate::document::tree::Node;
use condyle_math::Vec3;
use condyle_math::function::SimmSpline;
use condyle_model::Law;
use condyle_model::component::{
    Along, Centre, ConstantCurvature, Curve, Ellipsoid, Heading, Scale, Shear, SurfaceAxis,
};

impl ModelReader<'_> {
    /// The centre of a pivot: one point for each interval, or a smooth path.
    pub(super) fn centre(&mut self, fields: &Fields<'_>) -> Option<Centre> {
        if let Some(node) = fields.get("path") {
            let unit = self.angle_unit(node.spot);
            return self.path(node, unit, "angle").map(Centre::Path);
        }
        let wanted = "centres such as [{ to = 1.5, at = [0, 0.01, 0] }]";
        let node = self.required(fields, "centres", wanted)?;
        let unit = self.angle_unit(node.spot);
        let mut centres = vec![];
        let list = self.list(node, "centres")?;
        for (number, node) in list.iter().enumerate() {
            let label = format!("{}.centres", fields.label);
            let fields = self.table(node, node.spot, label, keys::CENTRE);
            // The last interval may be unbounded.
            let to = match fields.get("to") {
                Some(node) => unit * self.number(node, "to")?,
                None if number + 1 == list.len() => f64::INFINITY,
                None => {
                    self.missing(
                        &fields,
                        "to",
                        "the upper end of its interval; only the last may have none",
                    );
                    return None;
                }
            };
            centres
                .push((to, fields.get("at").map_or(Some(Vec3::ZERO), |n| self.vector(n, "at"))?));
        }
        Some(Centre::Intervals(centres))
    }

    /// Three splines for x, y and z, their arguments multiplied by `unit`.
    fn path(&mut self, node: &Node, unit: f64, argument: &str) -> Option<Box<[SimmSpline; 3]>> {
        let list = self.list(node, "path")?;
        let mut splines = vec![];
        for node in list {
            let (arguments, places) = self.pairs(node, "path")?;
            let arguments = arguments.into_iter().map(|a| unit * a).collect();
            splines.push(self.through(node, SimmSpline::new(arguments, places))?);
        }
        match splines.try_into() {
            Ok(splines) => Some(Box::new(splines)),
            Err(_) => {
                let message = format!("`path` has {} curves", list.len());
                let help = format!("give three lists of [{argument}, place]: for x, y and z");
                self.length(node.spot, message, help);
                None
            }
        }
    }

    /// A path, and how a segment turns with it.
    pub(in super::super) fn curve(&mut self, fields: &Fields<'_>) -> Option<Law> {
        let unit = fields.get("in").map_or(Some(1.0), |n| self.unit_of(n, "in"));
        let wanted = "three lists of [parameter, place]: for x, y and z";
        let node = self.required(fields, "path", wanted);
        let path = node.zip(unit).and_then(|(node, unit)| self.path(node, unit, "parameter"));
        let heading = match (fields.get("forward"), fields.get("up")) {
            (None, None) => None,
            (Some(forward), Some(up)) => {
                let (forward, up) = (self.vector(forward, "forward"), self.vector(up, "up"));
                Some(Heading { forward: forward?, up: up? })
            }
            (one, other) => {
                let (has, lacks) =
                    if one.is_some() { ("forward", "up") } else { ("up", "forward") };
                let spot = one.or(other).map_or(fields.spot, |node| node.spot);
                let message = format!("`{has}` is given without `{lacks}`");
                let help = "give both: the axis along the curve and the axis that stays up; or \
                            neither, for no turn";
                self.texts.error(spot, "document/missing", message, help);
                return None;
            }
        };
        Some(Law::Curve(Curve { path: path?, heading }))
    }

    pub(in super::super) fn ellipsoid(&mut self, fields: &Fields<'_>) -> Option<Law> {
        let radii = self.required_vector(fields, "radii", "three half axes in metres");
        let words = [("opensim", SurfaceAxis::OpenSim), ("normal", SurfaceAxis::Normal)];
        let axis = self.word(fields, "surface_axis", &words);
        Some(Law::Ellipsoid(Ellipsoid { radii: radii?, axis: axis? }))
    }

    pub(super) fn column(&mut self, fields: &Fields<'_>) -> Option<Law> {
        let neutral = match fields.get("neutral") {
            Some(node) => {
                let unit = self.angle_unit(node.spot);
                self.some::<3>(node, "neutral")?.map(|a| unit * a)
            }
            None => [0.0; 3],
        };
        let length = self.required(fields, "length", "the length of the arc in metres")?;
        let length = self.number(length, "length")?;
        Some(Law::ConstantCurvature(ConstantCurvature { neutral, length }))
    }

    /// A uniform scale, or one along an axis, with or without constant volume.
    pub(in super::super) fn scale(&mut self, fields: &Fields<'_>) -> Option<Law> {
        let volume = self.flag(fields.get("volume"), "volume", false);
        let along = match fields.get("axis") {
            Some(node) => {
                let axis = self.vector(node, "axis")?;
                if volume { Along::Volume(axis) } else { Along::Axis(axis) }
            }
            None if volume => {
                self.missing(fields, "axis", "the axis of the stretch");
                return None;
            }
            None => Along::Everywhere,
        };
        Some(Law::Scale(Scale { along }))
    }

    pub(in super::super) fn shear(&mut self, fields: &Fields<'_>) -> Option<Law> {
        let along = self.required_vector(fields, "along", "the direction in which layers slide");
        let across =
            self.required_vector(fields, "across", "the direction in which layers are stacked");
        Some(Law::Shear(Shear { along: along?, across: across? }))
    }
}
