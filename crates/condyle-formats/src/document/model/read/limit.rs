//! Limits of several scalars together: ellipses and half-spaces.

use super::ModelReader;
use crate::document::fields::Fields;
use condyle_model::Law;
use condyle_model::component::{Ellipse, HalfSpace};

impl ModelReader<'_> {
    /// An ellipse; its lengths are in the unit `in`, radians without it.
    pub(super) fn ellipse(&mut self, fields: &Fields<'_>) -> Option<Law> {
        let unit = fields.get("in").map_or(Some(1.0), |node| self.unit_of(node, "in"));
        let centre = match fields.get("centre") {
            Some(node) => self.some::<2>(node, "centre"),
            None => Some([0.0; 2]),
        };
        let wanted = "the two half axes, such as [1.2, 0.4]";
        let half_axes = self.required(fields, "half_axes", wanted);
        let half_axes = half_axes.and_then(|node| self.some::<2>(node, "half_axes"));
        let tilt = match fields.get("tilt") {
            Some(node) => {
                let unit = self.angle_unit(node.spot);
                self.number(node, "tilt").map(|tilt| unit * tilt)
            }
            None => Some(0.0),
        };
        let (unit, centre, half_axes, tilt) = (unit?, centre?, half_axes?, tilt?);
        match Ellipse::new(centre.map(|c| unit * c), half_axes.map(|a| unit * a), tilt) {
            Ok(ellipse) => Some(Law::Ellipse(ellipse)),
            Err(why) => {
                let message = format!("[{}] is no ellipse", fields.label);
                self.texts.error(fields.spot, "model/limit", message, why.to_string());
                None
            }
        }
    }

    /// A half-space; its bound is in the unit `in`, radians or metres without it.
    pub(super) fn half_space(&mut self, fields: &Fields<'_>) -> Option<Law> {
        let unit = fields.get("in").map_or(Some(1.0), |node| self.unit_of(node, "in"));
        let normal = self.required(fields, "normal", "one factor for each input, such as [1, 1]");
        let normal = normal.and_then(|node| self.numbers(node, "normal"));
        let bound = self.required(fields, "bound", "the largest sum of factors times inputs");
        let bound = bound.and_then(|node| self.number(node, "bound"));
        let (unit, normal, bound) = (unit?, normal?, bound?);
        match HalfSpace::new(normal, unit * bound) {
            Ok(half_space) => Some(Law::HalfSpace(half_space)),
            Err(why) => {
                let message = format!("[{}] bounds nothing", fields.label);
                self.texts.error(fields.spot, "model/limit", message, why.to_string());
                None
            }
        }
    }
}
