//! Writes any model, with everything expanded.

mod component;
mod surface;

use super::mirror::escaped;
use condyle_math::function::{Curve, Function, FunctionOfSeveral};
use condyle_math::{Affine, EulerOrder, Mat3, Vec3};
use condyle_model::model::{Condition, Facing};
use condyle_model::{
    Coordinate, CoordinateId, CoordinateKind, Model, PostureTerm, Range, Segment, SegmentId,
    Signal, UpAxis,
};
use std::collections::{HashMap, HashSet};
use std::fmt::Write;

/// Adds lines to a text in memory, which cannot fail.
macro_rules! line {
    ($writer:expr, $($arg:tt)*) => {{ let _ = writeln!($writer.out, $($arg)*); }};
}
use line;

/// Writes a model as a document that reads back to the same model: same order, same numbers.
///
/// A component whose name is taken in its joint set gets a number appended.
#[must_use]
pub fn write(model: &Model) -> String {
    let mut writer = Writer { model, out: String::new(), components: component_names(model) };
    writer.all();
    writer.out
}

struct Writer<'m> {
    model: &'m Model,
    out: String,
    /// A name for each component, unique in its joint set beside the coordinates.
    components: Vec<String>,
}

fn component_names(model: &Model) -> Vec<String> {
    let mut taken: HashSet<(usize, String)> =
        model.coordinates().iter().map(|c| (c.joint_set.index(), c.name.clone())).collect();
    let mut last: HashMap<(usize, String), usize> = HashMap::new();
    let mut names = vec![];
    for component in model.components() {
        let set = component.joint_set.index();
        let mut name = component.name.clone();
        let count = last.entry((set, name.clone())).or_insert(1);
        while !taken.insert((set, name.clone())) {
            *count += 1;
            name = format!("{}_{count}", component.name);
        }
        names.push(name);
    }
    names
}

impl Writer<'_> {
    fn all(&mut self) {
        let model = self.model;
        line!(self, "condyle = 1");
        line!(self, "kind = \"model\"");
        line!(self, "name = {}", text(model.name()));
        if model.up() == UpAxis::Z {
            line!(self, "up = \"z\"");
        }
        if model.facing() != Facing::default() {
            line!(self, "facing = \"{}\"", model.facing().name_in(model.up()));
        }
        for segment in model.segments() {
            self.segment(segment);
        }
        for set in model.joint_sets() {
            line!(self, "\n[joint_set.{}]", key(&set.name));
        }
        let short = self.short_postures();
        for coordinate in model.coordinates() {
            self.coordinate(coordinate);
            let own = |p: &&PostureTerm| model.coordinate(p.sum[0].0) == coordinate;
            if let Some(posture) = model.postures()[..short].iter().find(own) {
                if posture.rest != coordinate.default[0] {
                    line!(self, "rest = {}", number(posture.rest));
                }
                line!(self, "stiffness = {}", number(posture.stiffness));
            }
        }
        for (index, component) in model.components().iter().enumerate() {
            let set = key(&self.set(component.joint_set.index()));
            let name = key(&self.components[index]);
            let kind = component.law.kind().name;
            line!(self, "\n[joint_set.{set}.component.{name}.{kind}]");
            self.component(component);
        }
        for (id, set) in model.joint_set_ids().zip(model.joint_sets()) {
            for (number, (segment, motion)) in model.outputs_of(id).enumerate() {
                if number == 0 {
                    line!(self, "\n[joint_set.{}.output]", key(&set.name));
                }
                let port = self.port(Some(id.index()), motion);
                line!(self, "{} = {port}", key(&model.segment(segment).name));
            }
        }
        for marker in model.markers() {
            line!(self, "\n[marker.{}]", key(&marker.name));
            if let Some(like) = &marker.like
                && model.markers().iter().any(|m| {
                    m.name == *like && (m.segment, m.point) == (marker.segment, marker.point)
                })
            {
                line!(self, "like = {}", text(like));
                continue;
            }
            if let Some(segment) = marker.segment {
                line!(self, "segment = {}", text(&model.segment(segment).name));
            }
            line!(self, "at = {}", vector(marker.point));
        }
        for shape in model.shapes() {
            self.shape(shape);
        }
        self.closures();
        for posture in &model.postures()[short..] {
            line!(self, "\n[posture.{}]", key(&posture.name));
            let term = |(id, factor): &(CoordinateId, f64)| {
                format!("{} = {}", self.port(None, Signal::Coordinate(*id)), number(*factor))
            };
            let sum: Vec<String> = posture.sum.iter().map(term).collect();
            line!(self, "sum = {{ {} }}", sum.join(", "));
            if posture.rest != 0.0 {
                line!(self, "rest = {}", number(posture.rest));
            }
            line!(self, "stiffness = {}", number(posture.stiffness));
            if let Some(source) = &posture.source {
                line!(self, "source = {}", text(source));
            }
        }
        for group in model.size_groups() {
            line!(self, "\n[size.{}]", key(&group.name));
            let names = group.segments.iter().map(|&id| text(&model.segment(id).name));
            line!(self, "segments = [{}]", names.collect::<Vec<_>>().join(", "));
        }
    }

    /// How many posture terms, from the first, can be written with their coordinate: reading makes
    /// those before all others, in the order of the coordinates.
    fn short_postures(&self) -> usize {
        let model = self.model;
        let mut last = None;
        let short = model.postures().iter().take_while(|posture| {
            let [(id, 1.0)] = posture.sum[..] else { return false };
            let coordinate = model.coordinate(id);
            let set = self.set(coordinate.joint_set.index());
            let in_order = last.is_none_or(|last| last < id.index());
            last = Some(id.index());
            in_order
                && posture.source == coordinate.source
                && posture.name == format!("{}.{}", escaped(&set), escaped(&coordinate.name))
        });
        short.count()
    }

    fn set(&self, index: usize) -> String {
        self.model.joint_sets()[index].name.clone()
    }

    fn segment(&mut self, segment: &Segment) {
        line!(self, "\n[segment.{}]", key(&segment.name));
        if let Some(parent) = segment.parent {
            line!(self, "parent = {}", text(&self.model.segment(parent).name));
        }
        for part in frame(segment.joint_in_parent) {
            line!(self, "{part}");
        }
        for part in frame(segment.joint_in_segment) {
            line!(self, "joint_{part}");
        }
    }

    fn coordinate(&mut self, c: &Coordinate) {
        let set = self.set(c.joint_set.index());
        line!(self, "\n[joint_set.{}.coordinate.{}]", key(&set), key(&c.name));
        if c.kind != CoordinateKind::Rotation {
            line!(self, "kind = \"{}\"", c.kind.name());
        }
        if c.kind == CoordinateKind::Orientation {
            if c.default != [0.0, 0.0, 0.0, 1.0] {
                line!(self, "default = {}", numbers(&c.default));
            }
        } else if c.default[0] != c.kind.neutral()[0] {
            line!(self, "default = {}", number(c.default[0]));
        }
        let Range { lower, upper, enforced } = c.range;
        let held = lower.is_some() || upper.is_some();
        if held {
            let side = |v: Option<f64>| v.map_or("\"none\"".to_owned(), number);
            line!(self, "range = [{}, {}]", side(lower), side(upper));
        }
        if let Some([low, high]) = c.typical {
            line!(self, "typical = [{}, {}]", number(low), number(high));
        }
        if enforced != held {
            line!(self, "enforced = {enforced}");
        }
        if c.locked {
            line!(self, "locked = true");
        }
        if let Some(drives) = &c.drives {
            line!(self, "drives = {}", text(drives));
        }
        if let Some(source) = &c.source {
            line!(self, "source = {}", text(source));
        }
        if let Some(leader) = c.follows {
            let port = self.port(Some(c.joint_set.index()), leader);
            line!(self, "follows = {port}");
        }
    }

    /// A port as a string: the bare name within its own set.
    fn port(&self, own: Option<usize>, source: Signal) -> String {
        let (set, name, output) = match source {
            Signal::Coordinate(id) => {
                let c = self.model.coordinate(id);
                (c.joint_set.index(), c.name.as_str(), 0)
            }
            Signal::Output(id, output) => {
                let set = self.model.components()[id.index()].joint_set.index();
                (set, self.components[id.index()].as_str(), output)
            }
            Signal::Segment(id) => return text(&self.model.segment(id).name),
        };
        let name = escaped(name);
        let set_name = escaped(&self.set(set));
        text(&match (own == Some(set), output) {
            (true, 0) => name,
            (false, 0) => format!("{set_name}.{name}"),
            (_, output) => format!("{set_name}.{name}.{}", output + 1),
        })
    }

    fn closures(&mut self) {
        let model = self.model;
        let mut taken: HashSet<String> = HashSet::new();
        for closure in model.closures() {
            let mut name = closure.name.clone();
            let mut count = 1;
            while !taken.insert(name.clone()) {
                count += 1;
                name = format!("{}_{count}", closure.name);
            }
            line!(self, "\n[closure.{}]", key(&name));
            let holder = |id: &Option<SegmentId>| {
                id.map_or(String::new(), |id| {
                    format!("segment = {}, ", text(&model.segment(id).name))
                })
            };
            let point = |(id, p): &(Option<SegmentId>, Vec3)| {
                format!("{{ {}at = {} }}", holder(id), vector(*p))
            };
            match &closure.condition {
                Condition::Points { at: [a, b] } => {
                    line!(self, "points = [{}, {}]", point(a), point(b));
                }
                Condition::Distance { at: [a, b], distance } => {
                    line!(self, "points = [{}, {}]", point(a), point(b));
                    line!(self, "distance = {}", number(*distance));
                }
                Condition::Frames { at } => {
                    let one = |(id, f): &(Option<SegmentId>, Affine)| {
                        let mut parts = frame(*f);
                        if let Some(id) = id {
                            parts
                                .insert(0, format!("segment = {}", text(&model.segment(*id).name)));
                        }
                        format!("{{ {} }}", parts.join(", "))
                    };
                    line!(self, "frames = [{}, {}]", one(&at[0]), one(&at[1]));
                }
                Condition::Coupling { follower, driver, function: f } => {
                    let follower = self.port(None, Signal::Coordinate(*follower));
                    let driver = self.port(None, Signal::Coordinate(*driver));
                    let f = function(f);
                    line!(
                        self,
                        "coupling = {{ follower = {follower}, driver = {driver}, function = {f} }}"
                    );
                }
            }
        }
    }
}

/// A name as a key: bare where TOML allows it.
fn key(name: &str) -> String {
    let bare = |c: char| c.is_ascii_alphanumeric() || c == '_' || c == '-';
    if !name.is_empty() && name.chars().all(bare) { name.to_owned() } else { text(name) }
}

pub(in crate::document) fn text(value: &str) -> String {
    let mut out = String::from("\"");
    for c in value.chars() {
        match c {
            '"' => out.push_str("\\\""),
            '\\' => out.push_str("\\\\"),
            c if (c < ' ') || c == '\u{7f}' => {
                let _ = write!(out, "\\u{:04X}", c as u32);
            }
            c => out.push(c),
        }
    }
    out.push('"');
    out
}

/// The shortest text that reads back to the same number.
pub(in crate::document) fn number(value: f64) -> String {
    if value == value.trunc() && value.abs() < 1e9 && (value != 0.0 || value.is_sign_positive()) {
        return format!("{value}");
    }
    format!("{value:?}")
}

pub(in crate::document) fn numbers(values: &[f64]) -> String {
    let list: Vec<String> = values.iter().map(|v| number(*v)).collect();
    format!("[{}]", list.join(", "))
}

fn vector(v: Vec3) -> String {
    numbers(&v.to_array())
}

/// The lines of a frame: `at`, and `turn` where three angles give the rotation to rounding, else
/// `matrix`.
fn frame(frame: Affine) -> Vec<String> {
    let mut lines = vec![];
    if frame.translation != Vec3::ZERO {
        lines.push(format!("at = {}", vector(frame.translation)));
    }
    if frame.linear == Mat3::IDENTITY {
        return lines;
    }
    let angles = EulerOrder::XYZ.from_mat3(frame.linear);
    let again = EulerOrder::XYZ.to_mat3(angles);
    let m = frame.linear;
    let worst = [(m.x, again.x), (m.y, again.y), (m.z, again.z)].map(|(a, b)| (a - b).norm());
    if worst.iter().all(|d| *d < 1e-15) {
        lines.push(format!("turn = {}", numbers(&angles)));
    } else {
        let rows = m.transpose();
        let rows = [rows.x, rows.y, rows.z].map(vector);
        lines.push(format!("matrix = [{}]", rows.join(", ")));
    }
    lines
}

fn knots(list: &mut dyn Iterator<Item = (f64, f64)>) -> String {
    let list: Vec<String> = list.map(|(x, y)| numbers(&[x, y])).collect();
    format!("[{}]", list.join(", "))
}

pub(in crate::document) fn function(f: &Function) -> String {
    let curve = match &f.curve {
        Curve::Constant(c) if f.factor == 1.0 => return number(*c),
        Curve::Constant(c) => format!("constant = {}", number(*c)),
        Curve::Linear { slope, intercept } => {
            format!("linear = {}", numbers(&[*slope, *intercept]))
        }
        Curve::Polynomial(p) => format!("polynomial = {}", numbers(p.ascending())),
        Curve::PiecewiseLinear(p) => format!("lines = {}", knots(&mut p.knots())),
        Curve::SimmSpline(s) => format!("spline = {}", knots(&mut s.knots())),
    };
    if f.factor == 1.0 {
        format!("{{ {curve} }}")
    } else {
        format!("{{ {curve}, factor = {} }}", number(f.factor))
    }
}

pub(in crate::document) fn several_of(f: &FunctionOfSeveral) -> String {
    match f {
        FunctionOfSeveral::Linear { slopes, intercept } => {
            format!("{{ slopes = {}, intercept = {} }}", numbers(slopes), number(*intercept))
        }
        FunctionOfSeveral::Polynomial(p) => format!(
            "{{ dimension = {}, order = {}, coefficients = {} }}",
            p.dimension(),
            p.order(),
            numbers(p.coefficients())
        ),
    }
}
