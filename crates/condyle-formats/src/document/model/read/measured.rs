//! What is measured between segments, and angles of orientations.

use super::ModelReader;
use crate::document::fields::Fields;
use condyle_math::Vec3;
use condyle_model::Law;
use condyle_model::component::{AngleNames, Angles, Reflection, RelativePosition};

/// The names of the three axes and of the planes normal to them.
pub(in crate::document::model) const AXES: [(&str, usize); 3] = [("x", 0), ("y", 1), ("z", 2)];

impl ModelReader<'_> {
    /// A point, and the directions along which it is measured: the axes where none are given.
    pub(super) fn relative_position(&mut self, fields: &Fields<'_>) -> Option<Law> {
        let point = match fields.get("point") {
            Some(node) => self.vector(node, "point"),
            None => Some(Vec3::ZERO),
        };
        let along = match fields.get("along") {
            Some(node) => self.vectors(node, "along")?.into_iter().collect(),
            None => Some(Vec3::UNITS.to_vec()),
        };
        let (point, along): (Vec3, Vec<Vec3>) = (point?, along?);
        let reference = fields.get("reference").is_some();
        Some(Law::RelativePosition(RelativePosition { reference, point, along }))
    }

    /// Euler angles in an `order`, or the `twist` about an axis and the swing.
    pub(super) fn angles(&mut self, fields: &Fields<'_>) -> Option<Law> {
        let names = match (fields.get("order"), fields.get("twist")) {
            (Some(node), None) => AngleNames::Euler(self.order(node, "order")?),
            (None, Some(_)) => AngleNames::SwingTwist(self.word(fields, "twist", &AXES)?),
            (Some(_), Some(node)) => {
                self.exclusive(node, "order", "twist");
                return None;
            }
            (None, None) => {
                let wanted = "an order of axes such as \"zxy\", or the axis of a `twist`";
                self.missing(fields, "order", wanted);
                return None;
            }
        };
        let mirrored = match fields.get("mirrored") {
            Some(_) => Reflection::new(self.word(fields, "mirrored", &AXES)?),
            None => None,
        };
        Some(Law::Angles(Angles { names, mirrored }))
    }
}
