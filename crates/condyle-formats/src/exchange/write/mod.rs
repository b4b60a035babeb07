//! Writing: every part of a model, field by field.
//!
//! Parts are taken apart by all their fields, so that one that is not written does not compile.

mod form;
mod law;

use super::{HEAD, VERSION};
use condyle_math::function::{
    Curve, Function, FunctionOfSeveral, MultivariatePolynomial, PiecewiseLinear, SimmSpline,
};
use condyle_math::{Affine, Vec3};
use condyle_model::component::{Component, PortType};
use condyle_model::model::{Condition, SizeGroup};
use condyle_model::{
    Closure, Coordinate, CoordinateKind, Marker, Model, PostureTerm, Range, Segment, SegmentId,
    Signal, UpAxis,
};
use serde_json::{Map, Value, json};
use std::collections::{HashMap, HashSet};

/// Writes a resolved model, one part a line.
///
/// [`read`](super::read()) gives the same model again; a component whose name is taken in its joint set
/// gets a number appended.
///
/// ```
/// use condyle_formats::exchange;
/// use condyle_math::Vec3;
/// use condyle_model::ModelBuilder;
/// let mut b = ModelBuilder::new("arm");
/// let forearm = b.segment("forearm", None);
/// b.hinge("elbow", forearm, "flexion", Vec3::Z);
/// let model = b.build()?;
/// let text = exchange::write(&model);
/// assert!(text.starts_with("{\n\"condyle_model\": 1,\n\"name\": \"arm\","));
/// assert_eq!(exchange::read(text.as_bytes())?.value.segments(), model.segments());
/// # Ok::<(), condyle_formats::Error>(())
/// ```
#[must_use]
pub fn write(model: &Model) -> String {
    let writer = Writer { model, names: component_names(model) };
    let up = match model.up() {
        UpAxis::Y => "y",
        UpAxis::Z => "z",
    };
    let mut text = format!(
        "{{\n\"{HEAD}\": {VERSION},\n\"name\": {},\n\"up\": \"{up}\",\n\"facing\": \"{}\"",
        json!(model.name()),
        model.facing().name_in(model.up()),
    );
    let mut list = |key: &str, parts: Vec<Value>| {
        let lines: Vec<String> = parts.iter().map(|part| format!("\n{part}")).collect();
        text.push_str(&format!(",\n\"{key}\": [{}]", lines.join(",")));
    };
    list("segments", model.segments().iter().map(|s| writer.segment(s)).collect());
    list("joint_sets", model.joint_sets().iter().map(|set| json!(set.name)).collect());
    list("coordinates", model.coordinates().iter().map(|c| writer.coordinate(c)).collect());
    let components = model.components().iter().enumerate();
    list("components", components.map(|(index, c)| writer.component(index, c)).collect());
    list("markers", model.markers().iter().map(|m| writer.marker(m)).collect());
    list("closures", model.closures().iter().map(|c| writer.closure(c)).collect());
    list("postures", model.postures().iter().map(|p| writer.posture(p)).collect());
    list("sizes", model.size_groups().iter().map(|group| writer.size(group)).collect());
    list("shapes", model.shapes().iter().map(|shape| writer.shape(shape)).collect());
    let values = model.evaluation_order().into_iter().map(|signal| match signal {
        Signal::Output(id, _) => json!({ "component": writer.path(id.index()) }),
        other => writer.signal(other),
    });
    let values = Value::Array(values.collect());
    let segments: Vec<Value> =
        model.parents_first().into_iter().map(|id| writer.segment_name(Some(id))).collect();
    let order = format!("{{\n\"values\": {values},\n\"segments\": {}}}", Value::Array(segments));
    format!("{text},\n\"order\": {order}\n}}\n")
}

struct Writer<'m> {
    model: &'m Model,
    /// A name for each component, unique in its joint set beside the coordinates.
    names: Vec<String>,
}

fn component_names(model: &Model) -> Vec<String> {
    let mut taken: HashSet<(usize, String)> =
        model.coordinates().iter().map(|c| (c.joint_set.index(), c.name.clone())).collect();
    let mut last: HashMap<(usize, &str), usize> = HashMap::new();
    let mut names = vec![];
    for component in model.components() {
        let set = component.joint_set.index();
        let mut name = component.name.clone();
        let count = last.entry((set, &component.name)).or_insert(1);
        while !taken.insert((set, name.clone())) {
            *count += 1;
            name = format!("{}_{count}", component.name);
        }
        names.push(name);
    }
    names
}

impl Writer<'_> {
    fn set(&self, index: usize) -> &str {
        &self.model.joint_sets()[index].name
    }

    fn path(&self, component: usize) -> String {
        let set = self.model.components()[component].joint_set.index();
        format!("{}/{}", self.set(set), self.names[component])
    }

    fn coordinate_path(&self, coordinate: &Coordinate) -> String {
        format!("{}/{}", self.set(coordinate.joint_set.index()), coordinate.name)
    }

    fn signal(&self, signal: Signal) -> Value {
        match signal {
            Signal::Coordinate(id) => {
                json!({ "coordinate": self.coordinate_path(self.model.coordinate(id)) })
            }
            Signal::Output(id, output) => {
                json!({ "component": self.path(id.index()), "output": output })
            }
            Signal::Segment(id) => json!({ "segment": self.model.segment(id).name }),
        }
    }

    fn segment_name(&self, id: Option<SegmentId>) -> Value {
        id.map_or(Value::Null, |id| json!(self.model.segment(id).name))
    }

    fn segment(&self, segment: &Segment) -> Value {
        let Segment { name, parent, joint_in_parent, joint_in_segment, motion, joint_set } =
            segment;
        json!({
            "name": name,
            "parent": self.segment_name(*parent),
            "joint_in_parent": frame(*joint_in_parent),
            "joint_in_segment": frame(*joint_in_segment),
            "motion": motion.map(|motion| self.signal(motion)),
            "joint_set": joint_set.map(|set| self.set(set.index())),
        })
    }

    fn coordinate(&self, coordinate: &Coordinate) -> Value {
        let Coordinate {
            name,
            joint_set,
            kind,
            default,
            range: Range { lower, upper, enforced },
            typical,
            locked,
            follows,
            drives,
            source,
        } = coordinate;
        let unit = match kind {
            CoordinateKind::Rotation => json!("rad"),
            CoordinateKind::Translation => json!("m"),
            CoordinateKind::Scale => json!("1"),
            CoordinateKind::Orientation => json!("quaternion"),
            CoordinateKind::Other => Value::Null,
        };
        json!({
            "path": self.coordinate_path(coordinate),
            "name": name,
            "joint_set": self.set(joint_set.index()),
            "kind": kind.name(),
            "unit": unit,
            "default": if kind.stored() == 1 { json!(default[0]) } else { json!(default) },
            "range": [lower, upper],
            "clamped": enforced,
            "typical": typical,
            "locked": locked,
            "follows": follows.map(|leader| self.signal(leader)),
            "drives": drives,
            "source": source,
        })
    }

    fn component(&self, index: usize, component: &Component) -> Value {
        let Component { name: _, joint_set, law, inputs: _ } = component;
        let mut inputs = Map::new();
        for (port, signals) in component.by_port() {
            let mut list: Vec<Value> = signals.iter().map(|&signal| self.signal(signal)).collect();
            let value = if port.is_list() { Value::Array(list) } else { list.pop().into() };
            inputs.insert(port.name.to_owned(), value);
        }
        let (makes, count) = law.outputs();
        json!({
            "path": self.path(index),
            "name": self.names[index],
            "joint_set": self.set(joint_set.index()),
            "kind": law.kind().name,
            "inputs": inputs,
            "outputs": { "type": type_name(makes), "count": count },
            "parameters": law::parameters(law),
        })
    }

    fn marker(&self, marker: &Marker) -> Value {
        let Marker { name, segment, point, like } = marker;
        json!({
            "name": name,
            "segment": self.segment_name(*segment),
            "point": vector(*point),
            "like": like,
        })
    }

    fn closure(&self, Closure { name, condition }: &Closure) -> Value {
        let point = |(segment, point): &(Option<SegmentId>, Vec3)| json!({ "segment": self.segment_name(*segment), "point": vector(*point) });
        let at = |(segment, at): &(Option<SegmentId>, Affine)| json!({ "segment": self.segment_name(*segment), "frame": frame(*at) });
        match condition {
            Condition::Points { at } => {
                json!({ "name": name, "kind": "points", "at": at.each_ref().map(point) })
            }
            Condition::Frames { at: [one, other] } => {
                json!({ "name": name, "kind": "frames", "at": [at(one), at(other)] })
            }
            Condition::Distance { at, distance } => json!({
                "name": name,
                "kind": "distance",
                "at": at.each_ref().map(point),
                "distance": distance,
            }),
            Condition::Coupling { follower, driver, function: f } => json!({
                "name": name,
                "kind": "coupling",
                "follower": self.coordinate_path(self.model.coordinate(*follower)),
                "driver": self.coordinate_path(self.model.coordinate(*driver)),
                "function": function(f),
            }),
        }
    }

    fn posture(&self, posture: &PostureTerm) -> Value {
        let PostureTerm { name, sum, rest, stiffness, source } = posture;
        let terms: Vec<Value> = sum
            .iter()
            .map(|(id, factor)| {
                let path = self.coordinate_path(self.model.coordinate(*id));
                json!({ "coordinate": path, "factor": factor })
            })
            .collect();
        json!({
            "name": name,
            "sum": terms,
            "rest": rest,
            "stiffness": stiffness,
            "source": source,
        })
    }

    fn size(&self, SizeGroup { name, segments }: &SizeGroup) -> Value {
        let segments: Vec<Value> = segments.iter().map(|&id| self.segment_name(Some(id))).collect();
        json!({ "name": name, "segments": segments })
    }
}

/// The word for a type of ports and outputs.
fn type_name(of: PortType) -> &'static str {
    match of {
        PortType::Scalar => "scalar",
        PortType::Orientation => "orientation",
        PortType::Transform => "transform",
        PortType::Segment => "segment",
        PortType::Joint => "joint",
    }
}

fn vector(v: Vec3) -> Value {
    json!(v.to_array())
}

/// Three rows of four numbers: the linear part and the translation.
fn frame(frame: Affine) -> Value {
    let rows = frame.to_rows();
    json!([rows[0..4], rows[4..8], rows[8..12]])
}

fn knots(knots: impl Iterator<Item = (f64, f64)>) -> Value {
    knots.map(|(x, y)| json!([x, y])).collect()
}

fn lines(curve: &PiecewiseLinear) -> Value {
    json!({ "kind": "piecewise_linear", "knots": knots(curve.knots()) })
}

fn spline(curve: &SimmSpline) -> Value {
    json!({ "kind": "simm_spline", "knots": knots(curve.knots()) })
}

fn function(Function { factor, curve }: &Function) -> Value {
    let mut value = match curve {
        Curve::Constant(value) => json!({ "kind": "constant", "value": value }),
        Curve::Linear { slope, intercept } => {
            json!({ "kind": "linear", "slope": slope, "intercept": intercept })
        }
        Curve::Polynomial(p) => json!({ "kind": "polynomial", "coefficients": p.ascending() }),
        Curve::PiecewiseLinear(curve) => lines(curve),
        Curve::SimmSpline(curve) => spline(curve),
    };
    value["factor"] = json!(factor);
    value
}

fn function_of_several(function: &FunctionOfSeveral) -> Value {
    match function {
        FunctionOfSeveral::Linear { slopes, intercept } => {
            json!({ "kind": "linear", "slopes": slopes, "intercept": intercept })
        }
        FunctionOfSeveral::Polynomial(p) => polynomial(p),
    }
}

fn polynomial(p: &MultivariatePolynomial) -> Value {
    json!({
        "kind": "polynomial",
        "dimension": p.dimension(),
        "order": p.order(),
        "coefficients": p.coefficients(),
    })
}
