//! The tables of a model document, one after the other, into a [`Draft`].

use super::draft::{
    ClosureDraft, ComponentDraft, ConditionDraft, CoordinateDraft, Draft, Holder, Law, MarkerDraft,
    OutputDraft, SegmentDraft,
};
use super::fields::{Fields, Reader};
use super::function::rescaled;
use super::keys;
use super::mirror::Mirror;
use super::source::{Name, Spot};
use super::tree::{Entry, Node, Value};
use crate::diagnostic::nearest;
use condyle_math::function::SimmSpline;
use condyle_math::{Affine, Vec3};
use condyle_model::component::Centre;
use condyle_model::{CoordinateKind, Range, UpAxis};

const FRAME: [&str; 4] = ["at", "turn", "order", "matrix"];

impl Reader<'_> {
    /// Reads the whole tree.
    pub(super) fn draft(&mut self, entries: Vec<Entry>) -> Draft {
        let root = Node { value: Value::Table(entries), spot: Spot::default() };
        let top = self.table(&root, root.spot, String::new(), keys::TOP);
        let mut draft = Draft::default();
        if let Some(node) = top.get("constants") {
            for entry in self.entries(node, "constants") {
                if let Some(number) = self.number(&entry.node, &entry.key.text) {
                    self.constants.insert(entry.key.text.clone(), number);
                }
            }
        }
        draft.name = top.get("name").and_then(|n| self.text(n, "name")).map(|n| n.text);
        match top.get("up").and_then(|n| self.text(n, "up")) {
            Some(up) if up.text == "z" => draft.up = UpAxis::Z,
            Some(up) if up.text != "y" => {
                let message = format!("`up` is `{}`", up.text);
                self.sources.error(up.spot, "model/up", message, "give \"y\" or \"z\"");
            }
            _ => {}
        }
        for family in ["segment", "joint", "joint_set", "marker", "closure"] {
            let Some(node) = top.get(family) else { continue };
            for entry in self.entries(node, family) {
                match family {
                    "segment" => self.segment(&mut draft, entry),
                    "joint" => self.joint(&mut draft, entry),
                    "joint_set" => self.joint_set(&mut draft, entry),
                    "marker" => self.marker(&mut draft, entry),
                    _ => self.closure(&mut draft, entry),
                }
            }
        }
        draft.sort();
        if let Some(mirror) = top.get("mirror").and_then(|n| self.mirror(n)) {
            mirror.complete(&mut draft, self.sources);
        }
        draft
    }

    fn mirror(&mut self, node: &Node) -> Option<Mirror> {
        let fields = self.table(node, node.spot, "mirror".to_owned(), keys::MIRROR);
        let mut texts = ["plane", "from", "to"].map(|key| {
            let Some(node) = fields.get(key) else {
                let wanted = "a mirror such as { plane = \"z\", from = \"_r\", to = \"_l\" }";
                self.missing(&fields, key, wanted);
                return None;
            };
            self.text(node, key)
        });
        let [plane, from, to] = texts.each_mut().map(Option::take);
        let (plane, from, to) = (plane?, from?, to?);
        if from.text.is_empty() || from.text == to.text {
            let message = "the two ends of names are the same";
            let help = "give different ones, such as from = \"_r\", to = \"_l\"";
            self.sources.error(from.spot, "model/mirror", message, help);
            return None;
        }
        let Some(axis) = ["x", "y", "z"].iter().position(|a| *a == plane.text) else {
            let message = format!("`plane` is `{}`", plane.text);
            let help = "give the axis that is reversed: \"x\", \"y\" or \"z\"";
            self.sources.error(plane.spot, "model/mirror", message, help);
            return None;
        };
        Some(Mirror { axis, from: from.text, to: to.text })
    }

    fn segment(&mut self, draft: &mut Draft, entry: &Entry) {
        let name = entry.key.clone();
        let label = format!("segment.{}", name.text);
        let fields = self.table(&entry.node, name.spot, label, keys::SEGMENT);
        let parent = fields.get("parent").and_then(|n| self.text(n, "parent"));
        let in_parent = self.frame(&fields, FRAME);
        let in_itself =
            self.frame(&fields, ["joint_at", "joint_turn", "joint_order", "joint_matrix"]);
        draft.segments.push(SegmentDraft { name, parent, in_parent, in_itself });
    }

    fn joint_set(&mut self, draft: &mut Draft, entry: &Entry) {
        let set = entry.key.clone();
        let label = format!("joint_set.{}", set.text);
        let fields = self.table(&entry.node, set.spot, label.clone(), keys::JOINT_SET);
        draft.sets.push(set.clone());
        if let Some(node) = fields.get("coordinate") {
            for entry in self.entries(node, "coordinate") {
                let start = CoordinateDraft {
                    set: set.text.clone(),
                    name: entry.key.clone(),
                    kind: CoordinateKind::Rotation,
                    default: [0.0; 4],
                    range: Range::FREE,
                    locked: false,
                    source: None,
                    follows: None,
                };
                let coordinate = self.coordinate(&label, entry, start, true);
                draft.coordinates.push(coordinate);
            }
        }
        if let Some(node) = fields.get("component") {
            for entry in self.entries(node, "component") {
                self.component(draft, &set.text, entry);
            }
        }
        if let Some(node) = fields.get("output") {
            for entry in self.entries(node, "output") {
                let (ports, listed) = self.names(&entry.node, &entry.key.text);
                let segment = entry.key.clone();
                draft.outputs.push(OutputDraft { set: set.text.clone(), segment, ports, listed });
            }
        }
    }

    /// The properties of a coordinate, on top of what is known of it.
    pub(super) fn coordinate(
        &mut self,
        owner: &str,
        entry: &Entry,
        mut coordinate: CoordinateDraft,
        free_kind: bool,
    ) -> CoordinateDraft {
        let label = format!("{owner}.coordinate.{}", entry.key.text);
        let fields = self.table(&entry.node, entry.key.spot, label, keys::COORDINATE);
        if let Some(kind) = fields.get("kind").and_then(|n| self.text(n, "kind")) {
            use CoordinateKind::{Orientation, Other, Rotation, Translation};
            let kinds = [Rotation, Translation, Other, Orientation];
            match kinds.into_iter().find(|k| k.name() == kind.text) {
                Some(found) if free_kind || found == coordinate.kind => coordinate.kind = found,
                Some(_) => {
                    let message = format!("this coordinate is a {}", coordinate.kind.name());
                    let help = "leave `kind` away: the joint's type says it";
                    self.sources.error(kind.spot, "model/kind", message, help);
                }
                None => {
                    let names = kinds.map(CoordinateKind::name);
                    let help = match nearest(&kind.text, names) {
                        Some(near) => format!("did you mean `{near}`?"),
                        None => format!("kinds are: {}", names.join(", ")),
                    };
                    let message = format!("unknown kind of coordinate `{}`", kind.text);
                    self.sources.error(kind.spot, "model/kind", message, help);
                }
            }
        }
        let unit = self.unit(&fields, coordinate.kind);
        let orientation = coordinate.kind == CoordinateKind::Orientation;
        if orientation && coordinate.default == [0.0; 4] {
            coordinate.default[3] = 1.0;
        }
        if let Some(node) = fields.get("default") {
            if !orientation {
                coordinate.default[0] = unit * self.number(node, "default").unwrap_or(0.0);
            } else if let Some(q) = self.some::<4>(node, "default") {
                let length = q.iter().map(|x| x * x).sum::<f64>().sqrt();
                if (length - 1.0).abs() > 1e-6 {
                    let message = format!("this quaternion has length {length}");
                    let help = "give x, y, z, w of length 1; no turn is [0, 0, 0, 1]";
                    self.sources.error(node.spot, "model/orientation", message, help);
                }
                coordinate.default = q;
            }
        }
        if let Some(node) = fields.get("range") {
            if orientation {
                let message = "an orientation has no range";
                self.sources.error(node.spot, "model/range", message, "leave it away");
            } else {
                self.range(node, unit, &mut coordinate.range);
            }
        }
        let held = coordinate.range.lower.is_some() || coordinate.range.upper.is_some();
        coordinate.range.enforced = self.flag(fields.get("enforced"), "enforced", held);
        coordinate.locked = self.flag(fields.get("locked"), "locked", false);
        coordinate.source =
            fields.get("source").and_then(|n| self.text(n, "source")).map(|n| n.text);
        coordinate.follows = fields.get("follows").and_then(|n| self.text(n, "follows"));
        coordinate
    }

    /// What default and range of a coordinate are multiplied with.
    fn unit(&mut self, fields: &Fields<'_>, kind: CoordinateKind) -> f64 {
        const DEGREE: f64 = std::f64::consts::PI / 180.0;
        let usual = match kind {
            CoordinateKind::Rotation => self.angle_unit(fields.spot),
            _ => 1.0,
        };
        let Some(name) = fields.get("unit").and_then(|n| self.text(n, "unit")) else {
            return usual;
        };
        let known: &[(&str, f64)] = match kind {
            CoordinateKind::Rotation => &[("rad", 1.0), ("deg", DEGREE)],
            CoordinateKind::Translation => &[("m", 1.0), ("cm", 0.01), ("mm", 0.001)],
            CoordinateKind::Other => {
                &[("1", 1.0), ("rad", 1.0), ("deg", DEGREE), ("m", 1.0), ("mm", 0.001)]
            }
            CoordinateKind::Orientation => &[],
        };
        if let Some((_, factor)) = known.iter().find(|(unit, _)| *unit == name.text) {
            return *factor;
        }
        let units: Vec<&str> = known.iter().map(|(unit, _)| *unit).collect();
        let message = format!("a coordinate of kind {} has no unit `{}`", kind.name(), name.text);
        let help = match units[..] {
            [] => "leave it away".to_owned(),
            _ => format!("units are: {}", units.join(", ")),
        };
        self.sources.error(name.spot, "model/unit", message, help);
        usual
    }

    fn range(&mut self, node: &Node, unit: f64, range: &mut Range) {
        let sides = self.list(node, "range").unwrap_or_default();
        let [low, high] = sides else {
            if matches!(node.value, Value::List(_)) {
                let message = format!("`range` has {} sides", sides.len());
                let help = "give [lowest, highest]; a side may be \"none\"";
                self.sources.error(node.spot, "model/length", message, help);
            }
            return;
        };
        let mut side = |node: &Node| match &node.value {
            Value::Text(text) if text == "none" => None,
            _ => self.number(node, "range").map(|n| unit * n),
        };
        (range.lower, range.upper) = (side(low), side(high));
    }

    fn component(&mut self, draft: &mut Draft, set: &str, entry: &Entry) {
        let name = entry.key.clone();
        let label = format!("joint_set.{set}.component.{}", name.text);
        let kinds: Vec<&str> = keys::COMPONENTS.iter().map(|(kind, _)| *kind).collect();
        let [one] = self.entries(&entry.node, &label) else {
            if matches!(entry.node.value, Value::Table(_)) {
                let message = format!("[{label}] does not hold one component");
                let help = format!("name its kind: [{label}.KIND] with {}", kinds.join(", "));
                self.sources.error(name.spot, "model/component", message, help);
            }
            return;
        };
        let kind = one.key.text.as_str();
        let Some((_, known)) = keys::COMPONENTS.iter().find(|(k, _)| *k == kind) else {
            let help = match nearest(kind, kinds.iter().copied()) {
                Some(near) => format!("did you mean `{near}`?"),
                None => format!("kinds are: {}", kinds.join(", ")),
            };
            let message = format!("unknown kind of component `{kind}`");
            self.sources.error(one.key.spot, "model/component", message, help);
            return;
        };
        let fields = self.table(&one.node, name.spot, format!("{label}.{kind}"), known);
        if let Some((law, ports)) = self.law(&fields, kind) {
            draft.components.push(ComponentDraft { set: set.to_owned(), name, law, ports });
        }
    }

    /// The parameters of a component and the names at its ports.
    fn law(&mut self, fields: &Fields<'_>, kind: &str) -> Option<(Law, Vec<Name>)> {
        let ports: &[&str] = match kind {
            "map" => &["input"],
            "rotate" | "pivot" => &["angle"],
            "depend" => &["passive", "driver"],
            "translate" => &["distance"],
            "ball" => &["orientation"],
            "ellipsoid" => &["about_x", "about_y", "about_z"],
            "constant_curvature" => &["about_x", "about_z", "about_y"],
            _ => &[],
        };
        let mut names: Vec<Option<Name>> = vec![];
        for port in ports {
            match fields.get(port) {
                Some(node) => names.push(self.text(node, port)),
                None => {
                    self.missing(fields, port, "the name of a coordinate or a component");
                    names.push(None);
                }
            }
        }
        let several = match kind {
            "combine" => Some("inputs"),
            "product" => Some("factors"),
            _ => None,
        };
        if let Some(port) = several {
            match fields.get(port) {
                Some(node) => names.extend(self.names(node, port).0.into_iter().map(Some)),
                None => {
                    self.missing(fields, port, "a list of names");
                    names.push(None);
                }
            }
        }
        let law = match kind {
            "map" => Law::Map(self.map(fields)?),
            "combine" => match fields.get("function") {
                Some(node) => Law::Combine(self.several(node, "function")?),
                None => {
                    self.missing(fields, "function", "{ slopes = [...], intercept = 0 }");
                    return None;
                }
            },
            "rotate" => {
                Law::Rotate(self.needed(fields, "axis", "a direction such as [0, 0, 1]")?)
            }
            "translate" => {
                Law::Translate(self.needed(fields, "axis", "a direction such as [0, 1, 0]")?)
            }
            "depend" => self.depend(fields)?,
            "pivot" => {
                let axis = self.needed(fields, "axis", "a direction such as [0, 0, 1]");
                let centre = self.centre(fields)?;
                Law::Pivot(axis?, centre)
            }
            "compensate" => self.compensate(fields)?,
            "ball" => Law::Ball,
            "place" => Law::Place(self.frame(fields, FRAME)),
            "ellipsoid" => Law::Ellipsoid(self.needed(fields, "radii", "three half axes")?),
            "constant_curvature" => {
                let neutral = match fields.get("neutral") {
                    Some(node) => {
                        let unit = self.angle_unit(node.spot);
                        self.some::<3>(node, "neutral")?.map(|a| unit * a)
                    }
                    None => [0.0; 3],
                };
                let Some(length) = fields.get("length") else {
                    self.missing(fields, "length", "the length of the arc in metres");
                    return None;
                };
                Law::ConstantCurvature { neutral, length: self.number(length, "length")? }
            }
            _ => Law::Product,
        };
        let names: Option<Vec<Name>> = names.into_iter().collect();
        Some((law, names?))
    }

    fn depend(&mut self, fields: &Fields<'_>) -> Option<Law> {
        let mut bound = |key: &str| match fields.get(key) {
            Some(node) => self.function(node, key).map(Some),
            None => Some(None),
        };
        let (lower, upper) = (bound("lower"), bound("upper"));
        if matches!((&lower, &upper), (Some(None), Some(None))) {
            self.missing(fields, "lower", "`lower`, `upper` or both, as functions of the driver");
            return None;
        }
        Some(Law::Depend { lower: lower?, upper: upper? })
    }

    /// Where the centre of a pivot is: at one point for each interval, or on a smooth path.
    fn centre(&mut self, fields: &Fields<'_>) -> Option<Centre> {
        if let Some(node) = fields.get("path") {
            let unit = self.angle_unit(node.spot);
            let list = self.list(node, "path")?;
            let mut splines = vec![];
            for node in list {
                let (angles, places) = self.pairs(node, "path")?;
                let angles = angles.into_iter().map(|a| unit * a).collect();
                splines.push(self.through(node, SimmSpline::new(angles, places))?);
            }
            return match splines.try_into() {
                Ok(splines) => Some(Centre::Path(Box::new(splines))),
                Err(_) => {
                    let message = format!("`path` has {} curves", list.len());
                    let help = "give three lists of [angle, place]: for x, y and z";
                    self.sources.error(node.spot, "model/length", message, help);
                    None
                }
            };
        }
        let Some(node) = fields.get("centres") else {
            self.missing(fields, "centres", "centres such as [{ to = 1.5, at = [0, 0.01, 0] }]");
            return None;
        };
        let unit = self.angle_unit(node.spot);
        let mut centres = vec![];
        for node in self.list(node, "centres")? {
            let label = format!("{}.centres", fields.label);
            let fields = self.table(node, node.spot, label, keys::CENTRE);
            // The last interval need not end.
            let to = match fields.get("to") {
                Some(node) => unit * self.number(node, "to")?,
                None => f64::INFINITY,
            };
            centres
                .push((to, fields.get("at").map_or(Some(Vec3::ZERO), |n| self.vector(n, "at"))?));
        }
        Some(Centre::Intervals(centres))
    }

    fn compensate(&mut self, fields: &Fields<'_>) -> Option<Law> {
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
        Some(Law::Compensate { segment: segment?, ancestors, weight })
    }

    fn needed(&mut self, fields: &Fields<'_>, key: &str, wanted: &str) -> Option<Vec3> {
        match fields.get(key) {
            Some(node) => self.vector(node, key),
            None => {
                self.missing(fields, key, wanted);
                None
            }
        }
    }

    fn map(&mut self, fields: &Fields<'_>) -> Option<Vec<condyle_math::function::Function>> {
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
                self.sources.error(node.spot, "model/exclusive", message, "give one of them");
                return None;
            }
        };
        let mut unit = |key: &str| -> Option<f64> {
            let Some(node) = fields.get(key) else { return Some(1.0) };
            let name = self.text(node, key)?;
            match name.text.as_str() {
                "rad" | "m" => Some(1.0),
                "deg" => Some(std::f64::consts::PI / 180.0),
                "mm" => Some(0.001),
                other => {
                    let message = format!("unknown unit `{other}`");
                    let help = "units are: rad, deg, m, mm";
                    self.sources.error(name.spot, "model/unit", message, help);
                    None
                }
            }
        };
        let (argument, value) = (unit("in")?, unit("out")?);
        functions = functions.into_iter().map(|f| rescaled(f, argument, value)).collect();
        Some(functions)
    }

    fn marker(&mut self, draft: &mut Draft, entry: &Entry) {
        let label = format!("marker.{}", entry.key.text);
        let fields = self.table(&entry.node, entry.key.spot, label, keys::MARKER);
        let (segment, point) = self.point(&fields);
        draft.markers.push(MarkerDraft { name: entry.key.clone(), segment, point });
    }

    fn point(&mut self, fields: &Fields<'_>) -> (Holder, Vec3) {
        let segment = fields.get("segment").and_then(|n| self.text(n, "segment"));
        let point = fields.get("at").and_then(|n| self.vector(n, "at")).unwrap_or(Vec3::ZERO);
        (segment, point)
    }

    fn closure(&mut self, draft: &mut Draft, entry: &Entry) {
        let name = entry.key.clone();
        let label = format!("closure.{}", name.text);
        let fields = self.table(&entry.node, name.spot, label.clone(), keys::CLOSURE);
        let distance = fields.get("distance");
        let condition = match (fields.get("points"), fields.get("frames"), fields.get("coupling")) {
            (Some(node), None, None) => self.two(node, "points").map(|[a, b]| {
                let mut point = |node: &Node| {
                    let fields = self.table(node, node.spot, label.clone(), keys::MARKER);
                    self.point(&fields)
                };
                let at = [point(a), point(b)];
                match distance {
                    None => Some(ConditionDraft::Points(at)),
                    Some(n) => {
                        let distance = self.number(n, "distance")?;
                        Some(ConditionDraft::Distance(at, distance))
                    }
                }
            }),
            (None, Some(node), None) if distance.is_none() => {
                self.two(node, "frames").map(|[a, b]| {
                    let mut frame = |node: &Node| -> (Holder, Affine) {
                        let fields = self.table(node, node.spot, label.clone(), keys::FRAME);
                        let segment = fields.get("segment").and_then(|n| self.text(n, "segment"));
                        (segment, self.frame(&fields, FRAME))
                    };
                    Some(ConditionDraft::Frames([frame(a), frame(b)]))
                })
            }
            (None, None, Some(node)) if distance.is_none() => Some(self.coupling(node, &label)),
            _ => {
                let message = format!("[{label}] does not say one condition");
                let help = "give `points`, `points` with `distance`, `frames` or `coupling`";
                self.sources.error(name.spot, "model/closure", message, help);
                None
            }
        };
        if let Some(condition) = condition.flatten() {
            draft.closures.push(ClosureDraft { name, condition });
        }
    }

    fn two<'t>(&mut self, node: &'t Node, label: &str) -> Option<[&'t Node; 2]> {
        match self.list(node, label)? {
            [a, b] => Some([a, b]),
            list => {
                let message = format!("`{label}` has {} entries", list.len());
                self.sources.error(node.spot, "model/length", message, "give 2");
                None
            }
        }
    }

    fn coupling(&mut self, node: &Node, label: &str) -> Option<ConditionDraft> {
        let fields = self.table(node, node.spot, format!("{label}.coupling"), keys::COUPLING);
        let mut found = keys::COUPLING.iter().map(|key| {
            let node = fields.get(key);
            if node.is_none() {
                self.missing(&fields, key, "`follower`, `driver` and `function`");
            }
            node
        });
        let (follower, driver, function) = (found.next()?, found.next()?, found.next()?);
        drop(found);
        let follower = self.text(follower?, "follower");
        let driver = self.text(driver?, "driver");
        let function = self.function(function?, "function");
        Some(ConditionDraft::Coupling { follower: follower?, driver: driver?, function: function? })
    }
}
