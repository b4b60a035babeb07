//! Contacts: a bone that glides on an ellipsoid.

use super::FRAME;
use super::ModelReader;
use super::component::DIRECTION;
use crate::document::fields::Fields;
use crate::document::model::keys;
use crate::document::tree::{Node, Value};
use condyle_math::{Affine, Vec3};
use condyle_model::Law;
use condyle_model::component::{Contact, ContactPair, Gliding};

impl ModelReader<'_> {
    pub(super) fn contact(&mut self, fields: &Fields<'_>) -> Option<Law> {
        let pose = self.frame(fields, FRAME);
        let radii = self.required_vector(fields, "radii", "three half axes in metres");
        let axis = self.required_vector(fields, "axis", DIRECTION);
        let pairs = self.contact_pairs(fields);
        let most_gap = match fields.get("most_gap") {
            Some(node) => self.number(node, "most_gap").map(Some),
            None => Some(None),
        };
        // Each parameter is tried alone beside valid ones, to report errors at their places.
        let stand_in = ContactPair { first: Vec3::X, second: Vec3::Y, at: [0.0; 2] };
        let unit = Vec3::new(1.0, 1.0, 1.0);
        let try_one = |radii: Vec3, axis: Vec3, pairs: &[ContactPair]| {
            Gliding::new(Affine::IDENTITY, radii, axis, pairs.to_vec()).err()
        };
        let at = |key: &str| fields.get(key).map_or(fields.spot, |node| node.spot);
        let mut wrong = vec![];
        if let Some(radii) = radii {
            wrong.extend(try_one(radii, Vec3::Z, &[stand_in]).map(|why| (at("radii"), why)));
        }
        if let Some(axis) = axis {
            wrong.extend(try_one(unit, axis, &[stand_in]).map(|why| (at("axis"), why)));
        }
        if let Some((node, pairs)) = &pairs {
            let given = match &node.value {
                Value::List(list) => &list[..],
                _ => &[],
            };
            // The last pair of the shortest invalid list; if that is empty, the list itself.
            let first = (pairs.len().min(1)..=pairs.len())
                .find_map(|n| try_one(unit, Vec3::Z, &pairs[..n]).map(|why| (n, why)));
            if let Some((n, why)) = first {
                let spot = given.get(n.wrapping_sub(1)).map_or(node.spot, |node| node.spot);
                wrong.push((spot, why));
            }
        }
        for (spot, why) in &wrong {
            let said = why.to_string();
            let (message, help) = said.split_once(": ").unwrap_or((&said, "change these numbers"));
            self.texts.error(*spot, "model/contact", message, help);
        }
        let law = Gliding::new(pose, radii?, axis?, pairs?.1).ok()?;
        let before = fields.get("before").is_some();
        Some(Law::Contact(Contact { before, most_gap: most_gap?, law }))
    }

    fn contact_pairs<'t>(&mut self, fields: &Fields<'t>) -> Option<(&'t Node, Vec<ContactPair>)> {
        let wanted = "points that touch, such as [{ first = [0, 0.02, -0.1], second = ... }]";
        let node = self.required(fields, "pairs", wanted)?;
        let units = self.driver_units(fields);
        let list = self.list(node, "pairs")?;
        let pairs: Vec<Option<ContactPair>> = list
            .iter()
            .map(|node| {
                let label = format!("{}.pairs", fields.label);
                let fields = self.table(node, node.spot, label, keys::CONTACT_PAIR);
                let wanted = "a point of the segment in metres";
                let first = self.required_vector(&fields, "first", wanted);
                let second = self.required_vector(&fields, "second", wanted);
                let at = match fields.get("at") {
                    Some(node) => self.driver_values(node, units),
                    None if list.len() < 2 => Some([0.0; 2]),
                    None => {
                        self.missing(&fields, "at", "the values of the drivers for this pair");
                        None
                    }
                };
                Some(ContactPair { first: first?, second: second?, at: at? })
            })
            .collect();
        Some((node, pairs.into_iter().collect::<Option<Vec<_>>>()?))
    }

    /// The values of one or two drivers; the second is 0 if omitted.
    fn driver_values(&mut self, node: &Node, units: [f64; 2]) -> Option<[f64; 2]> {
        match self.numbers(node, "at")?[..] {
            [x] => Some([units[0] * x, 0.0]),
            [x, y] => Some([units[0] * x, units[1] * y]),
            ref list => {
                let message = format!("`at` has {} numbers", list.len());
                self.length(node.spot, message, "give one for each driver, at most two");
                None
            }
        }
    }

    /// The factors of the drivers' values: one unit for both, or a list of two.
    fn driver_units(&mut self, fields: &Fields<'_>) -> [f64; 2] {
        let Some(node) = fields.get("in") else { return [1.0; 2] };
        let Value::List(list) = &node.value else {
            return [self.unit_of(node, "in").unwrap_or(1.0); 2];
        };
        match &list[..] {
            [x, y] => [x, y].map(|node| self.unit_of(node, "in").unwrap_or(1.0)),
            _ => {
                let message = format!("`in` has {} units", list.len());
                self.length(node.spot, message, "give one for both drivers, or a list of two");
                [1.0; 2]
            }
        }
    }
}
