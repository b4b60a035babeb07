//! Documents of kind `goals`: what a pose should do.
//!
//! ```text
//! document       = the head of every document, and
//! point.N        = point, at: a point at a place
//! distance.N     = points, distance: two points so far apart
//! orientation.N  = segment, in, and quaternion | turn, order | "rest" as turn: a segment turned so
//! axis.N         = segment, axis, in, along: an axis of a segment along a direction
//! look.N         = segment, axis, through, at: an axis of a segment, through a point of it, at a point
//! plane.N        = point, origin, normal, in, side: a point on a plane, or above it
//! coordinate.C   = value, unit: a coordinate at a value
//! hold           = coordinates that stay at rest: a name with `*` for any letters, or a list
//! stiffness.C    = how strongly coordinates are near rest, m² per rad² (or per m²)
//! limits         = true|false
//! point          = the name of a marker | { segment, at }
//! place          = point | [x, y, z] of the world | "rest": where the point is at rest
//! ```
//!
//! Each goal takes a `weight`; one without is met exactly. `in` is a segment, without it the world.

use super::fields::{Fields, Reader};
use super::texts::Name;
use super::tree::{Entry, Node, Value};
use super::{Form, Kind, read_kind};
use condyle_diagnostics::{Error, Place, Read, Severity};
use condyle_math::{EulerOrder, Quat, Vec3};

const FORM: Form = Form {
    kind: Kind::Goals,
    keys: &[
        "point",
        "distance",
        "orientation",
        "axis",
        "look",
        "plane",
        "coordinate",
        "hold",
        "stiffness",
        "limits",
    ],
    own: &[],
    repeated: &[],
};

/// What a pose should do; what is not said is empty or `None`.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct GoalList {
    /// The goals, in the order of the text.
    pub goals: Vec<NamedGoal>,
    /// Patterns of coordinates that stay at rest.
    pub hold: Vec<Named>,
    /// Patterns of coordinates with the stiffness at rest, in the order of the text.
    pub stiffness: Vec<(Named, f64)>,
    /// Whether ranges and limits are kept.
    pub limits: Option<bool>,
}

/// A name, and where it stands.
#[derive(Clone, Debug, PartialEq)]
pub struct Named {
    /// The name.
    pub text: String,
    /// Its place, or that of the line that includes its text.
    pub place: Option<Place>,
}

/// One goal.
#[derive(Clone, Debug, PartialEq)]
pub struct NamedGoal {
    /// Its name.
    pub name: Named,
    /// What should hold.
    pub aim: NamedAim,
    /// `None` for a goal that is met exactly.
    pub weight: Option<f64>,
}

/// A point by names.
#[derive(Clone, Debug, PartialEq)]
pub enum NamedPoint {
    /// A marker of the model.
    Marker(Named),
    /// A point of a segment, in metres.
    OfSegment(Named, Vec3),
    /// A point of the world, in metres.
    World(Vec3),
    /// Where the point of the goal is at rest.
    Rest,
}

/// What should hold, by names. A segment of `None` is the world.
#[derive(Clone, Debug, PartialEq)]
pub enum NamedAim {
    /// A point at a place.
    Point {
        /// The point.
        point: NamedPoint,
        /// The place.
        at: NamedPoint,
    },
    /// Two points at a distance.
    Distance {
        /// The points.
        points: [NamedPoint; 2],
        /// The distance in metres, above 0.
        distance: f64,
    },
    /// A segment turned as given.
    Orientation {
        /// The segment.
        segment: Named,
        /// The segment whose axes are meant.
        relative_to: Option<Named>,
        /// The orientation; `None` for that at rest.
        rotation: Option<Quat>,
    },
    /// An axis of a segment along a direction.
    Axis {
        /// The segment.
        segment: Named,
        /// The axis, not 0.
        axis: Vec3,
        /// The segment whose axes the direction refers to.
        relative_to: Option<Named>,
        /// The direction, not 0.
        along: Vec3,
    },
    /// An axis of a segment toward a point.
    Look {
        /// The segment.
        segment: Named,
        /// The axis, not 0.
        axis: Vec3,
        /// The point of the segment through which it goes.
        through: Vec3,
        /// The point looked at.
        at: NamedPoint,
    },
    /// A point on a plane.
    Plane {
        /// The point.
        point: NamedPoint,
        /// The segment in which the plane is fixed.
        relative_to: Option<Named>,
        /// A point of the plane.
        origin: Vec3,
        /// The normal of the plane, not 0.
        normal: Vec3,
        /// Whether the side to which the normal points does as well.
        above: bool,
    },
    /// A coordinate at a value, in radians or metres.
    Coordinate {
        /// The coordinate.
        coordinate: Named,
        /// The value.
        value: f64,
    },
}

impl NamedAim {
    /// The word for its kind.
    #[must_use]
    pub fn kind(&self) -> &'static str {
        match self {
            Self::Point { .. } => "point",
            Self::Distance { .. } => "distance",
            Self::Orientation { .. } => "orientation",
            Self::Axis { .. } => "axis",
            Self::Look { .. } => "look",
            Self::Plane { .. } => "plane",
            Self::Coordinate { .. } => "coordinate",
        }
    }
}

/// Reads a document of goals. `include` gives the text of another one by its path.
///
/// # Errors
/// Everything that is wrong, in the order of the text.
///
/// ```
/// use condyle_formats::document::goals::{self, NamedAim, NamedPoint};
/// let text = r#"
/// condyle = 1
/// kind = "goals"
/// hold = ["pelvis_*"]
/// [point.hand]
/// point = "RFIN"
/// at = [0.3, 1.2, 0.1]
/// [look.face]
/// segment = "skull"
/// axis = [1, 0, 0]
/// at = "RFIN"
/// weight = 0.5
/// "#;
/// let list = goals::read(text, &mut |_| Err("it stands alone".into()))?.value;
/// assert_eq!(list.goals.len(), 2);
/// assert_eq!(list.goals[1].weight, Some(0.5));
/// assert!(matches!(&list.goals[0].aim, NamedAim::Point { at: NamedPoint::World(_), .. }));
/// # Ok::<(), condyle_formats::Error>(())
/// ```
pub fn read(
    text: &str,
    include: &mut dyn FnMut(&str) -> Result<String, String>,
) -> Result<Read<GoalList>, Error> {
    read_kind(&FORM, text, include, |mut reader, top| Some(reader.goals(top)))
}

/// What a point may be, for messages.
const POINT: &str = "the name of a marker, or { segment = \"…\", at = [x, y, z] }";
const PLACE: &str =
    "the name of a marker, [x, y, z], { segment = \"…\", at = [x, y, z] }, or \"rest\"";

impl<'s> Reader<'s> {
    fn goals(&mut self, top: &Fields<'_>) -> GoalList {
        let mut list = GoalList {
            limits: top.get("limits").map(|n| self.flag(Some(n), "limits", true)),
            ..GoalList::default()
        };
        let kinds: [(&str, &[&str], Parse<'s>); 7] = [
            ("point", &["point", "at"], Self::point_goal),
            ("distance", &["points", "distance"], Self::distance_goal),
            (
                "orientation",
                &["segment", "in", "quaternion", "turn", "order"],
                Self::orientation_goal,
            ),
            ("axis", &["segment", "axis", "in", "along"], Self::axis_goal),
            ("look", &["segment", "axis", "through", "at"], Self::look_goal),
            ("plane", &["point", "origin", "normal", "in", "side"], Self::plane_goal),
            ("coordinate", &["value", "unit"], Self::coordinate_goal),
        ];
        let mut placed = vec![];
        for (kind, keys, parse) in kinds {
            for entry in top.get(kind).map_or(&[][..], |node| self.entries(node, kind)) {
                let known = [keys, &["weight"]].concat();
                let label = format!("{kind}.{}", entry.key.text);
                let fields = self.table(&entry.node, entry.key.spot, label, &known);
                let weight = fields.get("weight").map(|node| self.positive(node, "weight"));
                let aim = parse(self, entry, &fields);
                // A weight that is wrong was reported.
                let (Some(aim), None | Some(Some(_))) = (aim, weight) else { continue };
                let goal =
                    NamedGoal { name: self.named(&entry.key), aim, weight: weight.flatten() };
                placed.push((entry.key.spot, goal));
            }
        }
        placed.sort_by_key(|(spot, _)| *spot);
        list.goals = placed.into_iter().map(|(_, goal)| goal).collect();
        if let Some(node) = top.get("hold") {
            let (names, _) = self.names(node, "hold");
            list.hold = names.iter().map(|name| self.named(name)).collect();
        }
        for entry in top.get("stiffness").map_or(&[][..], |node| self.entries(node, "stiffness")) {
            if let Some(stiffness) = self.positive(&entry.node, &entry.key.text) {
                list.stiffness.push((self.named(&entry.key), stiffness));
            }
        }
        list
    }

    fn named(&self, name: &Name) -> Named {
        let said = self.texts.said(name.spot, Severity::Note, "goals/name", String::new());
        Named { text: name.text.clone(), place: said.place }
    }

    fn point_goal(&mut self, _: &Entry, fields: &Fields<'_>) -> Option<NamedAim> {
        let point = self.required(fields, "point", POINT).and_then(|n| self.point(n, "point"));
        let at = self.required(fields, "at", PLACE).and_then(|n| self.place(n, "at", true));
        Some(NamedAim::Point { point: point?, at: at? })
    }

    fn distance_goal(&mut self, _: &Entry, fields: &Fields<'_>) -> Option<NamedAim> {
        let distance = self
            .required(fields, "distance", "a number of metres above 0")
            .and_then(|node| self.positive(node, "distance"));
        let node = self.required(fields, "points", "a list of two points")?;
        let points = match self.list(node, "points")? {
            [first, second] => [first, second].map(|node| self.place(node, "points", false)),
            list => {
                let message = format!("`points` has {} points", list.len());
                self.length(node.spot, message, "give two");
                return None;
            }
        };
        let [first, second] = points;
        Some(NamedAim::Distance { points: [first?, second?], distance: distance? })
    }

    fn orientation_goal(&mut self, _: &Entry, fields: &Fields<'_>) -> Option<NamedAim> {
        let segment = self.segment(fields);
        let relative_to = self.relative_to(fields)?;
        let rotation = match (fields.get("quaternion"), fields.get("turn")) {
            (Some(_), Some(turn)) => {
                self.exclusive(turn, "quaternion", "turn");
                None
            }
            (Some(node), None) => self.quaternion(node).map(Some),
            (None, Some(node)) => match &node.value {
                Value::Text(word) if word == "rest" => Some(None),
                _ => self.angles_of(node, fields).map(Some),
            },
            (None, None) => {
                self.missing(
                    fields,
                    "turn",
                    "three angles, `quaternion = [x, y, z, w]`, or \"rest\"",
                );
                None
            }
        };
        if let (Some(order), None) = (fields.get("order"), fields.get("turn")) {
            let message = "`order` is given without `turn`".to_owned();
            let help = "give three angles as `turn`, or omit `order`";
            self.texts.error(order.spot, "document/missing", message, help);
        }
        Some(NamedAim::Orientation { segment: segment?, relative_to, rotation: rotation? })
    }

    fn quaternion(&mut self, node: &Node) -> Option<Quat> {
        let numbers = self.some::<4>(node, "quaternion")?;
        let length = numbers.iter().map(|v| v * v).sum::<f64>().sqrt();
        if !(length.is_finite() && length > 1e-150) {
            let help = "give [x, y, z, w] of length 1";
            self.texts.error(node.spot, "goals/quaternion", "`quaternion` has no length", help);
            return None;
        }
        Some(Quat::from(numbers.map(|v| v / length)))
    }

    fn angles_of(&mut self, node: &Node, fields: &Fields<'_>) -> Option<Quat> {
        let unit = self.angle_unit(node.spot);
        let order = match fields.get("order") {
            Some(node) => self.order(node, "order"),
            None => Some(EulerOrder::XYZ),
        };
        let angles = self.some::<3>(node, "turn")?;
        Some(Quat::from_mat3(order?.to_mat3(angles.map(|angle| unit * angle))))
    }

    fn axis_goal(&mut self, _: &Entry, fields: &Fields<'_>) -> Option<NamedAim> {
        let segment = self.segment(fields);
        let axis = self.direction(fields, "axis", "an axis of the segment");
        let along = self.direction(fields, "along", "a direction");
        let relative_to = self.relative_to(fields)?;
        Some(NamedAim::Axis { segment: segment?, axis: axis?, relative_to, along: along? })
    }

    fn look_goal(&mut self, _: &Entry, fields: &Fields<'_>) -> Option<NamedAim> {
        let segment = self.segment(fields);
        let axis = self.direction(fields, "axis", "an axis of the segment");
        let through = match fields.get("through") {
            Some(node) => self.vector(node, "through"),
            None => Some(Vec3::ZERO),
        };
        let at = self.required(fields, "at", PLACE).and_then(|n| self.place(n, "at", false));
        Some(NamedAim::Look { segment: segment?, axis: axis?, through: through?, at: at? })
    }

    fn plane_goal(&mut self, _: &Entry, fields: &Fields<'_>) -> Option<NamedAim> {
        let point = self.required(fields, "point", POINT).and_then(|n| self.point(n, "point"));
        let origin = match fields.get("origin") {
            Some(node) => self.vector(node, "origin"),
            None => Some(Vec3::ZERO),
        };
        let normal = self.direction(fields, "normal", "the normal of the plane");
        let above = self.word(fields, "side", &[("on", false), ("above", true)]);
        let relative_to = self.relative_to(fields)?;
        let (point, origin, normal) = (point?, origin?, normal?);
        Some(NamedAim::Plane { point, relative_to, origin, normal, above: above? })
    }

    fn coordinate_goal(&mut self, entry: &Entry, fields: &Fields<'_>) -> Option<NamedAim> {
        self.required(fields, "value", "a number")?;
        let value = self.value(fields, "value")?;
        Some(NamedAim::Coordinate { coordinate: self.named(&entry.key), value })
    }

    fn segment(&mut self, fields: &Fields<'_>) -> Option<Named> {
        let node = self.required(fields, "segment", "the name of a segment")?;
        self.text(node, "segment").map(|name| self.named(&name))
    }

    /// The segment of `in`, if there is one; `None` after an error.
    fn relative_to(&mut self, fields: &Fields<'_>) -> Option<Option<Named>> {
        match fields.get("in") {
            Some(node) => self.text(node, "in").map(|name| Some(self.named(&name))),
            None => Some(None),
        }
    }

    /// A vector that has a direction.
    fn direction(&mut self, fields: &Fields<'_>, key: &str, wanted: &str) -> Option<Vec3> {
        let node = self.required(fields, key, &format!("{wanted}, [x, y, z]"))?;
        let vector = self.vector(node, key)?;
        let length = vector.norm();
        if !(length.is_finite() && length > 1e-150) {
            let message = format!("`{key}` has no direction");
            self.texts.error(node.spot, "goals/direction", message, "give [x, y, z] that is not 0");
            return None;
        }
        Some(vector * (1.0 / length))
    }

    /// A point of the model.
    fn point(&mut self, node: &Node, label: &str) -> Option<NamedPoint> {
        match &node.value {
            Value::Text(_) => self.text(node, label).map(|n| NamedPoint::Marker(self.named(&n))),
            Value::Table(_) => {
                let known = ["segment", "at"];
                let fields = self.table(node, node.spot, label.to_owned(), &known);
                let segment = self.segment(&fields);
                let at = self.required_vector(&fields, "at", "[x, y, z] in metres");
                Some(NamedPoint::OfSegment(segment?, at?))
            }
            _ => {
                self.wrong(node, label, POINT);
                None
            }
        }
    }

    /// A point of the model or of the world, or where a point is at rest.
    fn place(&mut self, node: &Node, label: &str, rest: bool) -> Option<NamedPoint> {
        match &node.value {
            Value::List(_) => self.vector(node, label).map(NamedPoint::World),
            Value::Text(word) if word == "rest" && rest => Some(NamedPoint::Rest),
            _ => self.point(node, label),
        }
    }
}

/// Reads one kind of goal; `None` after an error.
type Parse<'s> = fn(&mut Reader<'s>, &Entry, &Fields<'_>) -> Option<NamedAim>;

#[cfg(test)]
mod tests {
    use super::*;

    fn goals(inside: &str) -> Result<GoalList, Error> {
        let text = format!("condyle = 1\nkind = \"goals\"\n{inside}");
        read(&text, &mut |_| Err("it stands alone".into())).map(|read| read.value)
    }

    #[test]
    fn all_that_can_be_said_is_read() {
        let list = goals(
            "angles = \"deg\"\nhold = \"pelvis_*\"\nlimits = false\n\
             [point.hand]\npoint = { segment = \"hand\", at = [0, -0.1, 0] }\nat = \"rest\"\n\
             [coordinate.knee]\nvalue = 90\nunit = \"deg\"\n\
             [distance.feet]\npoints = [\"r_toe\", [1, 2, 3]]\ndistance = 0.3\n\
             [orientation.head]\nsegment = \"skull\"\nin = \"pelvis\"\nturn = [90, 0, 0]\nweight = 2\n\
             [orientation.trunk]\nsegment = \"trunk\"\nturn = \"rest\"\n\
             [orientation.foot]\nsegment = \"foot\"\nquaternion = [0, 0, 0, 2]\n\
             [axis.arm]\nsegment = \"arm\"\naxis = [0, -2, 0]\nalong = [1, 0, 0]\n\
             [look.face]\nsegment = \"skull\"\naxis = [1, 0, 0]\nat = \"hand\"\n\
             [plane.sole]\npoint = \"r_toe\"\nnormal = [0, 1, 0]\nside = \"above\"\n\
             [stiffness]\n\"lumbar_*\" = 1e-4\n",
        )
        .unwrap();
        let names: Vec<&str> = list.goals.iter().map(|goal| goal.name.text.as_str()).collect();
        assert_eq!(names, ["hand", "knee", "feet", "head", "trunk", "foot", "arm", "face", "sole"]);
        assert_eq!((list.limits, list.hold[0].text.as_str()), (Some(false), "pelvis_*"));
        assert_eq!((list.stiffness[0].0.text.as_str(), list.stiffness[0].1), ("lumbar_*", 1e-4));
        let aim = |i: usize| &list.goals[i].aim;
        assert!(matches!(aim(0), NamedAim::Point { at: NamedPoint::Rest, .. }));
        let quarter = std::f64::consts::FRAC_PI_2;
        assert!(matches!(aim(1), NamedAim::Coordinate { value, .. } if *value == quarter));
        match aim(3) {
            NamedAim::Orientation { relative_to: Some(name), rotation: Some(rotation), .. } => {
                assert_eq!(name.text, "pelvis");
                assert!(rotation.angle_to(Quat::from_axis_angle(Vec3::X, quarter)) < 1e-15);
            }
            other => panic!("{other:?}"),
        }
        assert_eq!(list.goals[3].weight, Some(2.0));
        assert!(matches!(aim(4), NamedAim::Orientation { rotation: None, .. }));
        assert!(matches!(aim(6), NamedAim::Axis { axis, .. } if *axis == -Vec3::Y));
        assert!(matches!(aim(8), NamedAim::Plane { above: true, .. }));
        assert_eq!(goals("").unwrap(), GoalList::default());
    }

    #[test]
    fn faults_are_placed() {
        for (text, said) in [
            ("[pont.a]", "line 3, column 2: unknown key `pont` (did you mean `point`?)"),
            ("[point.a]\npoint = \"m\"", "line 3, column 8: [point.a] has no `at`"),
            ("[point.a]\npoint = 3\nat = [0, 0, 0]", "line 4, column 9: `point` is a number"),
            ("[point.a]\npoint = \"m\"\nat = [0, 0]", "line 5, column 6: `at` has 2 numbers"),
            (
                "[distance.a]\npoints = [\"m\"]\ndistance = 1",
                "line 4, column 10: `points` has 1 points",
            ),
            (
                "[distance.a]\npoints = [\"m\", \"n\"]\ndistance = 0",
                "line 5, column 12: `distance` is 0 (give a number above 0)",
            ),
            (
                "[orientation.a]\nsegment = \"s\"",
                "line 3, column 14: [orientation.a] has no `turn`",
            ),
            (
                "[orientation.a]\nsegment = \"s\"\nquaternion = [0, 0, 0, 0]",
                "line 5, column 14: `quaternion` has no length",
            ),
            (
                "[axis.a]\nsegment = \"s\"\naxis = [0, 0, 0]\nalong = [1, 0, 0]",
                "line 5, column 8: `axis` has no direction",
            ),
            (
                "[plane.a]\npoint = \"m\"\nnormal = [0, 1, 0]\nside = \"abov\"",
                "line 6, column 8: unknown value `abov` of `side` (did you mean `above`?)",
            ),
            ("[coordinate.a]\nvalue = 1\nweight = -1", "line 5, column 10: `weight` is -1"),
            ("[stiffness]\na = 0", "line 4, column 5: `a` is 0 (give a number above 0)"),
        ] {
            let error = goals(text).unwrap_err().to_string();
            assert!(error.starts_with(said), "{error}");
        }
        let many = goals("[point.a]\n[look.b]\n[plane.c]").unwrap_err();
        assert_eq!(many.len(), 7, "{many}");
    }
}
