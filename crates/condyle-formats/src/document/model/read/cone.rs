//! Joint cones: the directions that a bone may point in, and how far it may twist.

use super::ModelReader;
use crate::document::fields::Fields;
use crate::document::model::keys;
use crate::document::texts::Spot;
use crate::document::tree::{Node, Value};
use condyle_math::{EulerOrder, Vec3};
use condyle_model::Law;
use condyle_model::component::{JointCone, Swinging};
use condyle_model::limit::{Cone, ConeError, ConePoint, Projection};

/// How often the number of points is doubled by default.
const SUBDIVISIONS: u32 = 2;

impl ModelReader<'_> {
    pub(super) fn cone(&mut self, fields: &Fields<'_>) -> Option<Law> {
        let of = self.swinging(fields);
        let rest = self.required_vector(
            fields,
            "rest",
            "the bone's long axis at rest, such as [0, -1, 0]",
        );
        let twist = self.twist(fields);
        let points = self.cone_points(fields);
        let subdivisions = match fields.get("subdivisions") {
            Some(node) => self.count(node, "subdivisions").map(|n| n as u32),
            None => Some(SUBDIVISIONS),
        };
        let words = [("nearest", Projection::Nearest), ("toward_rest", Projection::TowardRest)];
        let projection = self.word(fields, "projection", &words);
        let (rest, twist, subdivisions) = (rest?, twist?, subdivisions?);
        match Cone::new(rest, twist, points?, subdivisions, projection?) {
            Ok(cone) => Some(Law::Cone(JointCone { of: of?, cone })),
            Err(error) => {
                let (spot, message, help) = refused(fields, error);
                self.texts.error(spot, "model/cone", message, help);
                None
            }
        }
    }

    /// What the cone holds: an orientation, or angles about axes.
    fn swinging(&mut self, fields: &Fields<'_>) -> Option<Swinging> {
        if fields.get("orientation").is_some() {
            for key in ["angles", "axes", "order"] {
                let Some(node) = fields.get(key) else { continue };
                self.exclusive(node, "orientation", key);
                return None;
            }
            return Some(Swinging::Orientation);
        }
        let wanted = "the names of three angles (or two), or an `orientation`";
        let count = match &self.required(fields, "angles", wanted)?.value {
            Value::List(list) => list.len(),
            _ => 1,
        };
        if !(2..=3).contains(&count) {
            let spot = fields.get("angles").map_or(fields.spot, |node| node.spot);
            let message = format!("`angles` has {count} names");
            self.length(spot, message, "give three angles, or two if the bone does not twist");
            return None;
        }
        let axes = match (fields.get("axes"), fields.get("order")) {
            (Some(node), None) => {
                let axes = self.vectors(node, "axes")?;
                (node.spot, axes.into_iter().collect::<Option<Vec<Vec3>>>()?)
            }
            (None, Some(node)) => (node.spot, self.letters(node, count)?),
            (Some(_), Some(node)) => {
                self.exclusive(node, "axes", "order");
                return None;
            }
            (None, None) => {
                let wanted = "the axes of the angles, or an `order` such as \"zxy\"";
                self.missing(fields, "axes", wanted);
                return None;
            }
        };
        match (count, &axes.1[..]) {
            (3, &[a, b, c]) => Some(Swinging::Angles([a, b, c])),
            (2, &[a, b]) => Some(Swinging::Directions([a, b])),
            (_, list) => {
                let message = format!("`axes` has {} directions for {count} angles", list.len());
                self.length(axes.0, message, format!("give {count}"));
                None
            }
        }
    }

    /// The axes named by an order: one letter for each of three or two angles.
    fn letters(&mut self, node: &Node, count: usize) -> Option<Vec<Vec3>> {
        let axis = |letter: char| "xyz".find(letter).map(|i| [Vec3::X, Vec3::Y, Vec3::Z][i]);
        if count == 3 {
            let order: EulerOrder = self.order(node, "order")?;
            return Some([0, 1, 2].map(|i| order.axis(i)).to_vec());
        }
        let name = self.text(node, "order")?;
        let axes: Option<Vec<Vec3>> = name.text.chars().map(axis).collect();
        if let Some([a, b]) = axes.as_deref()
            && a != b
        {
            return axes;
        }
        let message = format!("unknown rotation order `{}` for two angles", name.text);
        let help = "give two different letters of x, y, z, such as \"zx\"";
        self.texts.error(name.spot, "document/order", message, help);
        None
    }

    fn cone_points(&mut self, fields: &Fields<'_>) -> Option<Vec<ConePoint>> {
        let wanted = "directions around `rest`, such as [{ direction = [1, -1, 0] }, ...]";
        let node = self.required(fields, "points", wanted)?;
        let list = self.list(node, "points")?;
        // Read to the end, so that every error is reported.
        let points: Vec<Option<ConePoint>> = list
            .iter()
            .map(|node| {
                let label = format!("{}.points", fields.label);
                let fields = self.table(node, node.spot, label, keys::CONE_POINT);
                let wanted = "a direction at the limit, such as [1, -1, 0]";
                let direction = self.required_vector(&fields, "direction", wanted);
                let twist = self.twist(&fields);
                Some(ConePoint { direction: direction?, twist: twist? })
            })
            .collect();
        points.into_iter().collect()
    }

    /// The lower and upper limit of twist, if there are any; `None` after an error.
    fn twist(&mut self, fields: &Fields<'_>) -> Option<Option<[f64; 2]>> {
        let Some(node) = fields.get("twist") else { return Some(None) };
        let unit = self.angle_unit(node.spot);
        let [low, high] = self.some::<2>(node, "twist")?;
        if low > high {
            let message = format!("the lower twist limit {low} is above the upper limit {high}");
            self.texts.error(node.spot, "model/crossing-range", message, "exchange the two");
            return None;
        }
        Some(Some([unit * low, unit * high]))
    }
}

/// An invalid cone: place, message and help. Points are counted from 1.
fn refused(fields: &Fields<'_>, error: ConeError) -> (Spot, String, &'static str) {
    let at = |key: &str| fields.get(key).or(fields.get("points")).map_or(fields.spot, |n| n.spot);
    let given = match fields.get("points").map(|node| &node.value) {
        Some(Value::List(list)) => &list[..],
        _ => &[],
    };
    let point = |index: usize| given.get(index).map_or(at("points"), |node| node.spot);
    let twist = |index: Option<usize>| index.map_or(at("twist"), point);
    let edge = |from: usize, to: usize| format!("the edge from point {} to {}", from + 1, to + 1);
    match error {
        ConeError::NoRest => (
            at("rest"),
            "the rest direction has length 0".to_owned(),
            "give the bone's long axis, such as [0, -1, 0]",
        ),
        ConeError::NoDirection { point: one } => (
            point(one),
            format!("the direction of point {} has length 0", one + 1),
            "give a direction at the limit, such as [1, -1, 0]",
        ),
        ConeError::TooFewPoints { count } => (
            at("points"),
            format!("{count} points do not enclose an area"),
            "give at least 3, in order around `rest`",
        ),
        ConeError::TooManyPoints { count, subdivisions } => (
            at("subdivisions"),
            format!(
                "{count} points doubled {subdivisions} times are more than {}",
                Cone::MOST_POINTS
            ),
            "subdivide less often",
        ),
        ConeError::TwistCrossing { point: one } => (
            twist(one),
            "the lower twist limit is above the upper limit".to_owned(),
            "exchange the two",
        ),
        ConeError::TwistRange { point: one } => (
            twist(one),
            "a twist limit is beyond a full turn".to_owned(),
            "give limits between -1 and 1 turn",
        ),
        ConeError::NoTwistAtRest { point: one } => (
            point(one),
            format!("point {} has twist limits, but there are none at rest", one + 1),
            "give `twist` beside `rest`, or omit it at the points",
        ),
        ConeError::Coincident { from, to } => (
            point(to),
            format!("points {} and {} have the same direction", from + 1, to + 1),
            "remove one of them",
        ),
        ConeError::HalfTurn { from, to } => (
            point(to),
            format!("points {} and {} have opposite directions", from + 1, to + 1),
            "add a point between them, so that the edge is determined",
        ),
        ConeError::OppositeRest { point: one } => (
            point(one),
            format!("point {} is opposite to the rest direction", one + 1),
            "move it toward the rest direction: the opposite direction is always outside",
        ),
        ConeError::RestOutside => (
            at("rest"),
            "the rest direction is not inside the points".to_owned(),
            "choose one inside, or give the points in order around it",
        ),
        ConeError::Hidden { from, to, refined: false } => (
            point(from),
            format!("not all of {} is visible from the rest direction", edge(from, to)),
            "give the points in order around `rest`, or move one of the two",
        ),
        ConeError::Hidden { from, to, refined: true } => (
            point(from),
            format!(
                "after subdivision, not all of {} is visible from the rest direction",
                edge(from, to)
            ),
            "give fewer `subdivisions`, or a point between the two",
        ),
        ConeError::WoundTwice => (
            at("points"),
            "the points run around the rest direction more than once".to_owned(),
            "give them in order around it",
        ),
    }
}
