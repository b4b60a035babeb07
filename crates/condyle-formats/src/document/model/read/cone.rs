//! Joint cones: where a bone may point and how far it may turn about itself.

use crate::document::fields::Fields;
use crate::document::model::keys;
use crate::document::model::blueprint::{Held, Blueprint};
use crate::document::texts::Spot;
use crate::document::tree::{Node, Value};
use condyle_math::{EulerOrder, Vec3};
use condyle_model::limit::{Cone, ConeError, ConePoint, Projection};

/// How often the number of points is doubled unless said.
const SUBDIVISIONS: u32 = 2;

impl ModelReader<'_> {
    pub(super) fn cone(&mut self, fields: &Fields<'_>) -> Option<Blueprint> {
        let held = self.held(fields);
        let rest = self.needed(fields, "rest", "the bone's long axis at rest, such as [0, -1, 0]");
        let twist = match fields.get("twist") {
            Some(node) => self.twist(node).map(Some),
            None => Some(None),
        };
        let points = self.cone_points(fields);
        let subdivisions = match fields.get("subdivisions") {
            Some(node) => self.count(node, "subdivisions").map(|n| n as u32),
            None => Some(SUBDIVISIONS),
        };
        let words = [("nearest", Projection::Nearest), ("toward_rest", Projection::TowardRest)];
        let projection = self.word(fields, "projection", &words);
        let (rest, twist, subdivisions) = (rest?, twist?, subdivisions?);
        match Cone::new(rest, twist, points?, subdivisions, projection?) {
            Ok(cone) => Some(Blueprint::Cone(held?, cone)),
            Err(error) => {
                let (spot, message, help) = refused(fields, error);
                self.texts.error(spot, "model/cone", message, help);
                None
            }
        }
    }

    /// What the cone holds: an orientation, or angles about axes.
    fn held(&mut self, fields: &Fields<'_>) -> Option<Held> {
        let axes = ["axes", "order"].map(|key| fields.get(key).map(|node| (key, node)));
        if fields.get("orientation").is_some() {
            for key in ["angles", "axes", "order"] {
                let Some(node) = fields.get(key) else { continue };
                let message = format!("both `orientation` and `{key}` are given");
                let help = "an orientation needs no axes: give it alone, or angles with theirs";
                self.texts.error(node.spot, "model/exclusive", message, help);
                return None;
            }
            return Some(Held::Orientation);
        }
        let count = match &fields.get("angles")?.value {
            Value::List(list) => list.len(),
            _ => 1,
        };
        if !(2..=3).contains(&count) {
            let spot = fields.get("angles").map_or(fields.spot, |node| node.spot);
            let message = format!("`angles` has {count} names");
            let help = "give three angles, or two where the bone does not turn about itself";
            self.texts.error(spot, "model/length", message, help);
            return None;
        }
        let axes = match axes {
            [Some((_, node)), None] => {
                let list = self.list(node, "axes")?;
                let axes: Vec<Option<Vec3>> = list.iter().map(|n| self.vector(n, "axes")).collect();
                (node.spot, axes.into_iter().collect::<Option<Vec<Vec3>>>()?)
            }
            [None, Some((_, node))] => (node.spot, self.letters(node, count)?),
            [Some(_), Some((_, node))] => {
                let message = "both `axes` and `order` are given";
                self.texts.error(node.spot, "model/exclusive", message, "give one of them");
                return None;
            }
            [None, None] => {
                let wanted = "the axes of the angles, or an `order` such as \"zxy\"";
                self.missing(fields, "axes", wanted);
                return None;
            }
        };
        match (count, &axes.1[..]) {
            (3, &[a, b, c]) => Some(Held::Three([a, b, c])),
            (2, &[a, b]) => Some(Held::Two([a, b])),
            (_, list) => {
                let message = format!("`axes` has {} directions for {count} angles", list.len());
                let help = format!("give {count}");
                self.texts.error(axes.0, "model/length", message, help);
                None
            }
        }
    }

    /// The axes that an order names: three letters, or two of two angles.
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
        let message = format!("unknown rotation order `{}` of two angles", name.text);
        let help = "give two different ones of x, y, z, such as \"zx\"";
        self.texts.error(name.spot, "model/order", message, help);
        None
    }

    fn cone_points(&mut self, fields: &Fields<'_>) -> Option<Vec<ConePoint>> {
        let Some(node) = fields.get("points") else {
            let wanted = "directions around `rest`, such as [{ direction = [1, -1, 0] }, ...]";
            self.missing(fields, "points", wanted);
            return None;
        };
        let list = self.list(node, "points")?;
        // All of them are read, so that all that are wrong are named.
        let points: Vec<Option<ConePoint>> = list
            .iter()
            .map(|node| {
                let label = format!("{}.points", fields.label);
                let fields = self.table(node, node.spot, label, keys::CONE_POINT);
                let wanted = "where the bone can just point, such as [1, -1, 0]";
                let direction = self.needed(&fields, "direction", wanted);
                let twist = match fields.get("twist") {
                    Some(node) => self.twist(node).map(Some),
                    None => Some(None),
                };
                Some(ConePoint { direction: direction?, twist: twist? })
            })
            .collect();
        points.into_iter().collect()
    }

    /// Lowest and highest turn of the bone about itself.
    fn twist(&mut self, node: &Node) -> Option<[f64; 2]> {
        let unit = self.angle_unit(node.spot);
        let [low, high] = self.some::<2>(node, "twist")?;
        if low > high {
            let message = format!("the lowest twist {low} lies above the highest {high}");
            self.texts.error(node.spot, "model/crossing-range", message, "exchange the two");
            return None;
        }
        Some([unit * low, unit * high])
    }
}

/// What is wrong with a cone: where, what, and what would be right. Points are counted from 1.
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
            "give where the bone can just point, such as [1, -1, 0]",
        ),
        ConeError::TooFewPoints { count } => (
            at("points"),
            format!("{count} points enclose nothing"),
            "give at least 3, in their order around `rest`",
        ),
        ConeError::TooManyPoints { count, subdivisions } => (
            at("subdivisions"),
            format!(
                "{count} points doubled {subdivisions} times are more than {}",
                Cone::MOST_POINTS
            ),
            "subdivide less often",
        ),
        ConeError::TwistCrossing { point: one } => {
            (twist(one), "the lowest twist lies above the highest".to_owned(), "exchange the two")
        }
        ConeError::TwistRange { point: one } => (
            twist(one),
            "a bound of twist lies beyond a full turn".to_owned(),
            "give bounds within one turn either way",
        ),
        ConeError::NoTwistAtRest { point: one } => (
            point(one),
            format!("point {} has bounds of twist, but there are none at rest", one + 1),
            "give `twist` beside `rest` too, or leave it away at the points",
        ),
        ConeError::Coincident { from, to } => (
            point(to),
            format!("points {} and {} have the same direction", from + 1, to + 1),
            "leave one of them away",
        ),
        ConeError::HalfTurn { from, to } => (
            point(to),
            format!("points {} and {} point opposite ways", from + 1, to + 1),
            "put a point between them, so that the edge is determined",
        ),
        ConeError::OppositeRest { point: one } => (
            point(one),
            format!("point {} lies opposite to the rest direction", one + 1),
            "move it toward the rest direction: what is opposite is always outside",
        ),
        ConeError::RestOutside => (
            at("rest"),
            "the rest direction is not inside the points".to_owned(),
            "choose one inside, or give the points in their order around it",
        ),
        ConeError::Hidden { from, to, refined: false } => (
            point(from),
            format!("the rest direction does not see all of {}", edge(from, to)),
            "put the points in their order around `rest`, or move one of the two",
        ),
        ConeError::Hidden { from, to, refined: true } => (
            point(from),
            format!("subdivided, the rest direction does not see all of {}", edge(from, to)),
            "give fewer `subdivisions`, or a point between the two",
        ),
        ConeError::WoundTwice => (
            at("points"),
            "the points run around the rest direction more than once".to_owned(),
            "put them in their order around it",
        ),
    }
}
