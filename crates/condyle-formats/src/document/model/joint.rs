//! Plain joints: each is expanded to a joint set of coordinates and components.

use super::draft::{ComponentDraft, CoordinateDraft, Draft, OutputDraft};
use super::keys;
use super::mirror::escaped;
use super::read::ModelReader;
use crate::document::fields::Fields;
use crate::document::texts::Name;
use crate::document::tree::{Entry, Value};
use crate::document::words;
use condyle_diagnostics::did_you_mean;
use condyle_math::function::Function;
use condyle_math::{EulerOrder, Vec3};
use condyle_model::component::{Along, Ball, Map, Rotate, Scale, Translate};
use condyle_model::{CoordinateKind, Law};
use std::collections::HashSet;

/// The coordinates and components of a plain joint.
#[derive(Default)]
struct Expansion {
    /// Names and kinds of its coordinates.
    coordinates: Vec<(String, CoordinateKind)>,
    /// Its components, nearest to the parent first.
    parts: Vec<Part>,
}

/// One component of a joint, named for its first coordinate.
struct Part {
    prefix: &'static str,
    law: Law,
    inputs: Vec<Input>,
    /// Whether it is a factor of the motion, or only an input of another part.
    moves: bool,
}

enum Input {
    Coordinate(usize),
    Part(usize),
}

impl Expansion {
    /// Adds a coordinate and the factor that it drives.
    fn with(mut self, name: &str, kind: CoordinateKind, prefix: &'static str, law: Law) -> Self {
        let inputs = vec![Input::Coordinate(self.coordinates.len())];
        self.coordinates.push((name.to_owned(), kind));
        self.parts.push(Part { prefix, law, inputs, moves: true });
        self
    }

    fn turn(self, name: &str, axis: Vec3) -> Self {
        self.with(name, CoordinateKind::Rotation, "about", Law::Rotate(Rotate { axis }))
    }

    fn slide(self, name: &str, axis: Vec3) -> Self {
        self.with(name, CoordinateKind::Translation, "along", Law::Translate(Translate { axis }))
    }

    fn ball(self) -> Self {
        self.with("orientation", CoordinateKind::Orientation, "about", Law::Ball(Ball))
    }

    fn turns(self, axes: [Vec3; 3]) -> Self {
        ["first", "second", "third"]
            .iter()
            .zip(axes)
            .fold(self, |expansion, (n, a)| expansion.turn(n, a))
    }

    /// A turn, and a slide along the same axis by `pitch` for each whole turn.
    fn screw(axis: Vec3, pitch: f64) -> Self {
        let mut expansion = Self::default().turn("angle", axis);
        let functions = vec![Function::linear(pitch / std::f64::consts::TAU, 0.0)];
        let law = Law::Map(Map { functions });
        let inputs = vec![Input::Coordinate(0)];
        expansion.parts.push(Part { prefix: "pitch_of", law, inputs, moves: false });
        let (law, inputs) = (Law::Translate(Translate { axis }), vec![Input::Part(1)]);
        expansion.parts.push(Part { prefix: "along", law, inputs, moves: true });
        expansion
    }

    /// One component with three angles.
    fn glide(law: Law) -> Self {
        let kind = CoordinateKind::Rotation;
        let coordinates = ["about_x", "about_y", "about_z"].map(|name| (name.to_owned(), kind));
        let inputs = (0..3).map(Input::Coordinate).collect();
        let parts = vec![Part { prefix: "on_surface", law, inputs, moves: true }];
        Self { coordinates: coordinates.to_vec(), parts }
    }
}

impl ModelReader<'_> {
    pub(super) fn joint(&mut self, draft: &mut Draft, entry: &Entry) {
        let set = entry.key.clone();
        let label = format!("joint.{}", set.text);
        let fields = self.table(&entry.node, set.spot, label.clone(), keys::JOINT);
        draft.sets.push(set.clone());
        draft.plain.insert(set.text.clone());
        let wanted = format!("one of: {}", types().join(", "));
        let Some(kind) = self.required(&fields, "type", &wanted) else {
            draft.broken.insert((set.text, String::new()));
            return;
        };
        let Some(kind) = self.text(kind, "type") else { return };
        let segment = self.required(&fields, "segment", "the name of the segment that moves");
        let segment = segment.and_then(|node| self.text(node, "segment"));
        let Some(mut expansion) = self.expansion(&fields, &kind) else {
            draft.broken.insert((set.text, String::new()));
            return;
        };
        if let Some(node) = fields.get("coordinates") {
            let names = self.names(node, "coordinates").0;
            if names.len() == expansion.coordinates.len() {
                for (coordinate, name) in expansion.coordinates.iter_mut().zip(names) {
                    coordinate.0 = name.text;
                }
            } else {
                let message = format!(
                    "`coordinates` has {} names, but a {} joint has {} coordinates",
                    names.len(),
                    kind.text,
                    expansion.coordinates.len()
                );
                let help = format!("give {} names", expansion.coordinates.len());
                self.length(node.spot, message, help);
            }
        }
        let given = fields.get("coordinate").map(|n| self.entries(n, "coordinate"));
        let given = given.unwrap_or_default();
        for entry in given {
            if !expansion.coordinates.iter().any(|(name, _)| *name == entry.key.text) {
                let names: Vec<&str> =
                    expansion.coordinates.iter().map(|(n, _)| n.as_str()).collect();
                let all = || format!("its coordinates are: {}", names.join(", "));
                let help = did_you_mean(&entry.key.text, names.iter().copied(), all);
                let message = format!("[{label}] has no coordinate `{}`", entry.key.text);
                self.texts.error(entry.key.spot, "model/unknown-name", message, help);
            }
        }
        let here = |text: String| Name { text, spot: set.spot };
        for (name, kind) in &expansion.coordinates {
            let start = CoordinateDraft::new(&set.text, here(name.clone()), *kind);
            let coordinate = match given.iter().find(|e| e.key.text == *name) {
                Some(entry) => self.coordinate(&label, entry, start, false),
                None => start,
            };
            draft.coordinates.push(coordinate);
        }
        let names = part_names(&expansion);
        let mut factors = vec![];
        for (part, name) in expansion.parts.into_iter().zip(&names) {
            let input = |input: &Input| match input {
                Input::Coordinate(i) => escaped(&expansion.coordinates[*i].0),
                Input::Part(i) => escaped(&names[*i]),
            };
            if part.moves {
                factors.push(here(escaped(name)));
            }
            draft.components.push(ComponentDraft {
                set: set.text.clone(),
                name: here(name.clone()),
                law: part.law,
                ports: part.inputs.iter().map(|i| here(input(i))).collect(),
            });
        }
        if let Some(segment) = segment
            && !factors.is_empty()
        {
            let listed = factors.len() > 1;
            draft.outputs.push(OutputDraft { set: set.text, segment, ports: factors, listed });
        }
    }

    /// What a joint of that type expands to.
    fn expansion(&mut self, fields: &Fields<'_>, kind: &Name) -> Option<Expansion> {
        let (x, y, z) = (Vec3::X, Vec3::Y, Vec3::Z);
        let Some((_, used)) = keys::JOINT_TYPES.iter().find(|(name, _)| *name == kind.text) else {
            let all = || format!("types are: {}", types().join(", "));
            let help = match words::joint(&kind.text) {
                Some(help) => help.to_owned(),
                None => did_you_mean(&kind.text, types(), all),
            };
            let message = format!("unknown type of joint `{}`", kind.text);
            self.texts.error(kind.spot, "model/joint-type", message, help);
            return None;
        };
        for entry in fields.entries() {
            let key = entry.key.text.as_str();
            let known = keys::JOINT.contains(&key);
            if known && !used.contains(&key) && !keys::JOINT_BASE.contains(&key) {
                let message = format!("a {} joint has no `{key}`", kind.text);
                let help = match (key, used.contains(&"axes"), used.contains(&"axis")) {
                    ("axis", true, _) => "give its `axes`",
                    ("axes", _, true) => "give its `axis`",
                    _ => "omit it",
                };
                self.texts.error(entry.key.spot, "document/unknown-key", message, help);
            }
        }
        let expansion = Expansion::default();
        let other = CoordinateKind::Other;
        Some(match kind.text.as_str() {
            "hinge" => expansion.turn("angle", self.axes::<1>(fields)[0]),
            "universal" => {
                let [first, second] = self.axes::<2>(fields);
                expansion.turn("first", first).turn("second", second)
            }
            "ball" => expansion.ball(),
            "euler" if fields.get("axes").is_some() => expansion.turns(self.axes::<3>(fields)),
            "euler" => {
                let wanted = "an order such as \"zxy\", or three `axes`";
                let node = self.required(fields, "order", wanted)?;
                let order = self.order(node, "order")?;
                expansion.turns([0, 1, 2].map(|i| order.axis(i)))
            }
            "prismatic" if fields.get("axis").is_some() => {
                expansion.slide("distance", self.axes::<1>(fields)[0])
            }
            "prismatic" => {
                if fields.get("axes").is_none() {
                    self.missing(fields, "axis", "a direction such as [0, 1, 0], or `axes`");
                }
                let axes = self.up_to_three(fields)?;
                let names = ["first", "second", "third"];
                names
                    .iter()
                    .zip(axes)
                    .fold(expansion, |expansion, (name, a)| expansion.slide(name, a))
            }
            "planar" => {
                let axes = match fields.get("axes") {
                    Some(_) => self.axes::<3>(fields),
                    None => [x, y, z],
                };
                expansion.slide("x", axes[0]).slide("y", axes[1]).turn("turn", axes[2])
            }
            "free" => {
                let order = fields.get("order").map(|n| self.order(n, "order"));
                let order = order.unwrap_or(Some(EulerOrder::XYZ))?;
                let expansion = expansion.slide("x", x).slide("y", y).slide("z", z);
                let ball = self.flag(fields.get("ball"), "ball", false);
                if let Some(node) = fields.get("order").filter(|_| ball) {
                    self.exclusive(node, "ball", "order");
                }
                match ball {
                    true => expansion.ball(),
                    false => expansion.turns([0, 1, 2].map(|i| order.axis(i))),
                }
            }
            "screw" => {
                let axis = self.axes::<1>(fields)[0];
                let wanted = "how far it slides in one full turn, in metres";
                let node = self.required(fields, "pitch", wanted)?;
                Expansion::screw(axis, self.number(node, "pitch")?)
            }
            "curve" => expansion.with("parameter", other, "along", self.curve(fields)?),
            "scale" if fields.get("axes").is_some() => {
                if let Some(node) = fields.get("axis").or(fields.get("volume")) {
                    let message = "`axes` excludes `axis` and `volume`";
                    let help = "give `axes`; or one `axis`, with or without `volume`";
                    self.texts.error(node.spot, "document/exclusive", message, help);
                }
                let axes = self.up_to_three(fields)?;
                let names = ["first", "second", "third"];
                names.iter().zip(axes).fold(expansion, |expansion, (name, axis)| {
                    expansion.with(
                        name,
                        CoordinateKind::Scale,
                        "by",
                        Law::Scale(Scale { along: Along::Axis(axis) }),
                    )
                })
            }
            "scale" => expansion.with("factor", CoordinateKind::Scale, "by", self.scale(fields)?),
            "shear" => expansion.with("amount", other, "by", self.shear(fields)?),
            "ellipsoid" => Expansion::glide(self.ellipsoid(fields)?),
            // A weld.
            _ => expansion,
        })
    }

    fn up_to_three(&mut self, fields: &Fields<'_>) -> Option<Vec<Vec3>> {
        let node = fields.get("axes")?;
        let axes: Vec<Vec3> = self.vectors(node, "axes")?.into_iter().flatten().collect();
        if axes.is_empty() || axes.len() > 3 {
            let message = format!("`axes` has {} directions", axes.len());
            self.length(node.spot, message, "give one to three");
            return None;
        }
        Some(axes)
    }

    /// `axis`, or exactly `N` `axes`; after an error z, so that the rest of the joint is read.
    fn axes<const N: usize>(&mut self, fields: &Fields<'_>) -> [Vec3; N] {
        let key = if N == 1 { "axis" } else { "axes" };
        let wanted = match N {
            1 => "a direction such as [0, 0, 1]".to_owned(),
            _ => format!("{N} directions"),
        };
        let Some(node) = self.required(fields, key, &wanted) else { return [Vec3::Z; N] };
        if N == 1 {
            return [self.has_direction(node, key).unwrap_or(Vec3::Z); N];
        }
        let axes = self.vectors(node, key).unwrap_or_default();
        if axes.len() != N && matches!(node.value, Value::List(_)) {
            let message = format!("`axes` has {} directions", axes.len());
            self.length(node.spot, message, format!("give {N}"));
        }
        std::array::from_fn(|i| axes.get(i).copied().flatten().unwrap_or(Vec3::Z))
    }
}

fn types() -> Vec<&'static str> {
    keys::JOINT_TYPES.iter().map(|(name, _)| *name).collect()
}

/// A name for each part, unique among coordinates and parts.
fn part_names(expansion: &Expansion) -> Vec<String> {
    let mut taken: HashSet<String> =
        expansion.coordinates.iter().map(|(name, _)| name.clone()).collect();
    let name = |part: &Part| {
        let first = part.inputs.iter().find_map(|input| match input {
            Input::Coordinate(i) => Some(*i),
            Input::Part(_) => None,
        });
        let mut name = format!("{}_{}", part.prefix, expansion.coordinates[first.unwrap_or(0)].0);
        while !taken.insert(name.clone()) {
            name.push('_');
        }
        name
    };
    expansion.parts.iter().map(name).collect()
}
