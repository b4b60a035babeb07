//! Components: their parameters, and the names at their ports.

use super::FRAME;
use super::ModelReader;
use crate::document::fields::Fields;
use crate::document::function::rescaled;
use crate::document::model::draft::{ComponentDraft, Draft};
use crate::document::texts::Name;
use crate::document::tree::{Entry, Node, Value};
use crate::document::words;
use condyle_diagnostics::did_you_mean;
use condyle_math::function::Function;
use condyle_model::Law;
use condyle_model::component::{
    Arity, Ball, Combine, Compensate, Correlate, Depend, Kind, Map, Pivot, PivotError, Place,
    PortType, Product, RelativeOrientation, Rotate, Translate,
};

/// The help where a direction is missing.
pub(super) const DIRECTION: &str = "a direction such as [0, 0, 1]";

/// How the parameters of one kind of law are read.
struct LawReader {
    name: &'static str,
    /// The keys of its parameters, beside its ports.
    keys: &'static [&'static str],
    read: fn(&mut ModelReader<'_>, &Fields<'_>) -> Option<Law>,
}

/// The keys of a learned limit; `segment` and `reference` stand for a component that measures them.
const FIELD: &[&str] = &[
    "segment",
    "reference",
    "driver_segment",
    "driver_reference",
    "file",
    "limit",
    "in_reference",
    "in_segment",
    "driver_in_reference",
    "driver_in_segment",
    "mirrored",
    "holes",
];

const READERS: &[LawReader] = &[
    reader("map", &["function", "functions", "in", "out"], |r, f| r.map(f)),
    reader("combine", &["function"], |r, f| {
        let node = r.required(f, "function", "{ slopes = [...], intercept = 0 }")?;
        Some(Law::Combine(Combine { function: r.several(node, "function")? }))
    }),
    reader("correlate", &["function", "region"], |r, f| {
        let node = r.required(f, "function", "{ slopes = [...], intercept = 0 }")?;
        let function = r.several(node, "function")?;
        let region = match f.get("region") {
            Some(node) => Some(r.region(node, "region", function.arity())?),
            None => None,
        };
        Some(Law::Correlate(Correlate { function, region }))
    }),
    reader("depend", &["lower", "upper", "in", "out"], |r, f| r.depend(f)),
    reader(
        "cone",
        &["axes", "order", "rest", "points", "twist", "subdivisions", "projection"],
        |r, f| r.cone(f),
    ),
    reader(
        "contact",
        &["at", "turn", "order", "matrix", "radii", "axis", "in", "pairs", "most_gap"],
        |r, f| r.contact(f),
    ),
    reader("ellipse", &["centre", "half_axes", "tilt", "in"], |r, f| r.ellipse(f)),
    reader("half_space", &["normal", "bound", "in"], |r, f| r.half_space(f)),
    reader("field", FIELD, |r, f| r.field(f)),
    reader("relative_orientation", &[], |_, f| {
        let reference = f.get("reference").is_some();
        Some(Law::RelativeOrientation(RelativeOrientation { reference }))
    }),
    reader("relative_position", &["point", "along"], |r, f| r.relative_position(f)),
    reader("angles", &["order", "twist", "mirrored"], |r, f| r.angles(f)),
    reader("rotate", &["axis"], |r, f| {
        Some(Law::Rotate(Rotate { axis: r.required_direction(f, "axis", DIRECTION)? }))
    }),
    reader("pivot", &["axis", "centres", "path"], |r, f| r.pivot(f)),
    reader("translate", &["axis"], |r, f| {
        let axis = r.required_direction(f, "axis", "a direction such as [0, 1, 0]")?;
        Some(Law::Translate(Translate { axis }))
    }),
    reader("ball", &[], |_, _| Some(Law::Ball(Ball))),
    reader("place", &FRAME, |r, f| Some(Law::Place(Place { child_in_parent: r.frame(f, FRAME) }))),
    reader("ellipsoid", &["radii", "surface_axis"], |r, f| r.ellipsoid(f)),
    reader("constant_curvature", &["neutral", "length"], |r, f| r.column(f)),
    reader("compensate", &["weight"], |r, f| {
        Some(Law::Compensate(Compensate { weight: r.number_or(f, "weight", 1.0)? }))
    }),
    reader("scale", &["axis", "volume"], |r, f| r.scale(f)),
    reader("shear", &["along", "across"], |r, f| r.shear(f)),
    reader("curve", &["in", "path", "forward", "up"], |r, f| r.curve(f)),
    reader("custom", &["law", "parameters"], |r, f| r.custom(f)),
    reader("product", &[], |_, _| Some(Law::Product(Product))),
];

// Every kind of law is read.
const _: () = assert!(READERS.len() == Law::KINDS.len());

const fn reader(
    name: &'static str,
    keys: &'static [&'static str],
    read: fn(&mut ModelReader<'_>, &Fields<'_>) -> Option<Law>,
) -> LawReader {
    LawReader { name, keys, read }
}

/// The keys of a component: its ports and its parameters.
pub(in crate::document::model) fn component_keys(
    kind: &Kind,
) -> impl Iterator<Item = &'static str> {
    let parameters = READERS.iter().find(|reader| reader.name == kind.name);
    let parameters = parameters.map_or(&[][..], |reader| reader.keys);
    kind.ports.iter().map(|port| port.name).chain(parameters.iter().copied())
}

impl ModelReader<'_> {
    pub(super) fn component(&mut self, draft: &mut Draft, set: &str, entry: &Entry) {
        let name = entry.key.clone();
        let label = format!("joint_set.{set}.component.{}", name.text);
        let read = self.kind_of(&label, entry).and_then(|(one, kind, reader)| {
            let known: Vec<&str> = component_keys(kind).collect();
            let label = format!("{label}.{}", kind.name);
            let fields = self.table(&one.node, name.spot, label, &known);
            // Both to the end, so that every error is reported.
            let ports = match kind.name {
                "field" => self.measured_for(draft, set, &name, &fields),
                _ => self.ports(&fields, kind),
            };
            let law = (reader.read)(self, &fields);
            Some((law?, ports?))
        });
        match read {
            Some((law, ports)) => {
                draft.components.push(ComponentDraft { set: set.to_owned(), name, law, ports });
            }
            // Do not report errors again for components that reference this one.
            None => _ = draft.broken.insert((set.to_owned(), name.text)),
        }
    }

    /// The one table of a component, named by its kind.
    fn kind_of<'t>(
        &mut self,
        label: &str,
        entry: &'t Entry,
    ) -> Option<(&'t Entry, &'static Kind, &'static LawReader)> {
        let kinds: Vec<&str> = Law::KINDS.iter().map(|kind| kind.name).collect();
        let [one] = self.entries(&entry.node, label) else {
            if matches!(entry.node.value, Value::Table(_)) {
                let message = format!("[{label}] must hold exactly one component");
                let help = format!("give its kind as [{label}.KIND], one of: {}", kinds.join(", "));
                self.texts.error(entry.key.spot, "model/component", message, help);
            }
            return None;
        };
        let name = one.key.text.as_str();
        let kind = Law::KINDS.iter().find(|kind| kind.name == name);
        if let Some(found) = kind.zip(READERS.iter().find(|reader| reader.name == name)) {
            return Some((one, found.0, found.1));
        }
        let all = || format!("kinds are: {}", kinds.join(", "));
        let help = match words::kind(name) {
            Some(help) => help.to_owned(),
            None => did_you_mean(name, kinds.iter().copied(), all),
        };
        let message = format!("unknown kind of component `{name}`");
        self.texts.error(one.key.spot, "model/component", message, help);
        None
    }

    /// The names at the ports of a component, in their order.
    fn ports(&mut self, fields: &Fields<'_>, kind: &Kind) -> Option<Vec<Name>> {
        let mut names: Vec<Option<Name>> = vec![];
        for port in kind.ports {
            let perhaps = matches!(port.arity, Arity::Perhaps | Arity::PerhapsList);
            if perhaps && fields.get(port.name).is_none() {
                continue;
            }
            let wanted = match (port.takes, port.is_list()) {
                (PortType::Segment | PortType::Joint, false) => "the name of a segment",
                (_, false) => "the name of a coordinate or a component",
                (_, true) => "a list of names",
            };
            let node = self.required(fields, port.name, wanted);
            match node {
                Some(node) if port.is_list() => {
                    names.extend(self.names(node, port.name).0.into_iter().map(Some));
                }
                node => names.push(node.and_then(|node| self.text(node, port.name))),
            }
        }
        names.into_iter().collect()
    }

    fn pivot(&mut self, fields: &Fields<'_>) -> Option<Law> {
        let axis = self.required_direction(fields, "axis", DIRECTION);
        let (centre, axis) = (self.centre(fields)?, axis?);
        match Pivot::new(axis, centre) {
            Ok(pivot) => Some(Law::Pivot(pivot)),
            Err(why) => {
                let node = match why {
                    PivotError::Axis => fields.get("axis"),
                    _ => fields.get("centres").or(fields.get("path")),
                };
                let interval = match (&why, node.map(|node| &node.value)) {
                    (
                        PivotError::NotIncreasing(i) | PivotError::NotFinite(i),
                        Some(Value::List(list)),
                    ) => list.get(*i),
                    _ => None,
                };
                let spot = interval.or(node).map_or(fields.spot, |node| node.spot);
                let why = why.to_string();
                let rising = "give each interval its upper end `to`, in rising order; only the last may \
                              have none";
                let (message, help) = why.split_once(": ").unwrap_or((&why, rising));
                self.texts.error(spot, "model/component", message, help);
                None
            }
        }
    }

    fn depend(&mut self, fields: &Fields<'_>) -> Option<Law> {
        let mut bound = |key: &str| match fields.get(key) {
            Some(node) => self.function(node, key).map(Some),
            None => Some(None),
        };
        let (lower, upper) = (bound("lower"), bound("upper"));
        let units = self.units(fields);
        if matches!((&lower, &upper), (Some(None), Some(None))) {
            self.missing(fields, "lower", "`lower`, `upper` or both, as functions of the driver");
            return None;
        }
        let (argument, value) = units?;
        let scaled = |bound: Option<Function>| bound.map(|f| rescaled(f, argument, value));
        Some(Law::Depend(Depend { lower: scaled(lower?), upper: scaled(upper?) }))
    }

    fn map(&mut self, fields: &Fields<'_>) -> Option<Law> {
        let units = self.units(fields);
        let functions = match (fields.get("function"), fields.get("functions")) {
            (Some(node), None) => self.function(node, "function").map(|function| vec![function]),
            (None, Some(Node { value: Value::Table(_), spot })) => {
                let help = "give one function as `function`, several as a list of them";
                self.texts.error(*spot, "document/type", "`functions` is a table", help);
                None
            }
            (None, Some(node)) => {
                let list = self.list(node, "functions")?;
                let read: Vec<_> = list.iter().map(|n| self.function(n, "functions")).collect();
                read.into_iter().collect::<Option<Vec<_>>>()
            }
            (None, None) => {
                self.missing(fields, "function", "a function such as { linear = [0.5, 0] }");
                None
            }
            (Some(_), Some(node)) => {
                self.exclusive(node, "function", "functions");
                None
            }
        };
        let (argument, value) = units?;
        let functions = functions?.into_iter().map(|f| rescaled(f, argument, value)).collect();
        Some(Law::Map(Map { functions }))
    }

    /// The factors from the units `in` of arguments and `out` of values to radians and metres.
    fn units(&mut self, fields: &Fields<'_>) -> Option<(f64, f64)> {
        let mut unit = |key: &str| fields.get(key).map_or(Some(1.0), |n| self.unit_of(n, key));
        let (argument, value) = (unit("in"), unit("out"));
        Some((argument?, value?))
    }
}
