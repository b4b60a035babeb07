//! Plain joints in a few lines: each becomes a joint set of the same components as any other.

use super::draft::{ComponentDraft, CoordinateDraft, Draft, Law, OutputDraft};
use super::fields::{Fields, Reader};
use super::keys;
use super::source::Name;
use super::tree::{Entry, Value};
use crate::diagnostic::nearest;
use condyle_math::{EulerOrder, Vec3};
use condyle_model::{CoordinateKind, Range};

/// One factor of a joint's motion: what its coordinate is called, and what it does.
struct Motion {
    coordinate: String,
    kind: CoordinateKind,
    law: Law,
}

impl Motion {
    fn turn(coordinate: &str, axis: Vec3) -> Self {
        let kind = CoordinateKind::Rotation;
        Self { coordinate: coordinate.to_owned(), kind, law: Law::Rotate(axis) }
    }

    fn slide(coordinate: &str, axis: Vec3) -> Self {
        let kind = CoordinateKind::Translation;
        Self { coordinate: coordinate.to_owned(), kind, law: Law::Translate(axis) }
    }
}

impl Reader<'_> {
    pub(super) fn joint(&mut self, draft: &mut Draft, entry: &Entry) {
        let set = entry.key.clone();
        let label = format!("joint.{}", set.text);
        let fields = self.table(&entry.node, set.spot, label.clone(), keys::JOINT);
        draft.sets.push(set.clone());
        let Some(kind) = fields.get("type") else {
            let types = format!("one of: {}", keys::JOINT_TYPES.join(", "));
            return self.missing(&fields, "type", &types);
        };
        let Some(kind) = self.text(kind, "type") else { return };
        let segment = match fields.get("segment") {
            Some(node) => self.text(node, "segment"),
            None => {
                self.missing(&fields, "segment", "the name of the segment that moves");
                None
            }
        };
        let Some(mut motions) = self.motions(&fields, &kind) else { return };
        if let Some(node) = fields.get("coordinates") {
            let names = self.names(node, "coordinates").0;
            if names.len() == motions.len() {
                for (motion, name) in motions.iter_mut().zip(names) {
                    motion.coordinate = name.text;
                }
            } else {
                let message = format!(
                    "`coordinates` has {} names, but a {} joint has {} coordinates",
                    names.len(),
                    kind.text,
                    motions.len()
                );
                let help = format!("give {} names", motions.len());
                self.sources.error(node.spot, "model/length", message, help);
            }
        }
        let given = fields.get("coordinate").map(|n| self.entries(n, "coordinate"));
        let given = given.unwrap_or_default();
        for entry in given {
            if !motions.iter().any(|m| m.coordinate == entry.key.text) {
                let names: Vec<&str> = motions.iter().map(|m| m.coordinate.as_str()).collect();
                let help = match nearest(&entry.key.text, names.iter().copied()) {
                    Some(near) => format!("did you mean `{near}`?"),
                    None => format!("its coordinates are: {}", names.join(", ")),
                };
                let message = format!("[{label}] has no coordinate `{}`", entry.key.text);
                self.sources.error(entry.key.spot, "model/unknown-name", message, help);
            }
        }
        let names: Vec<String> = motions.iter().map(|m| m.coordinate.clone()).collect();
        let here = |text: String| Name { text, spot: set.spot };
        let mut factors = vec![];
        for motion in motions {
            let name = here(motion.coordinate.clone());
            let start = CoordinateDraft {
                set: set.text.clone(),
                name: name.clone(),
                kind: motion.kind,
                default: match motion.kind {
                    CoordinateKind::Orientation => [0.0, 0.0, 0.0, 1.0],
                    _ => [0.0; 4],
                },
                range: Range::FREE,
                locked: false,
                source: None,
                follows: None,
            };
            let coordinate = match given.iter().find(|e| e.key.text == motion.coordinate) {
                Some(entry) => self.coordinate(&label, entry, start, false),
                None => start,
            };
            draft.coordinates.push(coordinate);
            let mut component = match motion.law {
                Law::Translate(_) => format!("along_{}", motion.coordinate),
                _ => format!("about_{}", motion.coordinate),
            };
            while names.contains(&component) {
                component.push('_');
            }
            let component = here(component);
            factors.push(component.clone());
            draft.components.push(ComponentDraft {
                set: set.text.clone(),
                name: component,
                law: motion.law,
                ports: vec![name],
            });
        }
        if let Some(segment) = segment
            && !factors.is_empty()
        {
            let listed = factors.len() > 1;
            draft.outputs.push(OutputDraft { set: set.text, segment, ports: factors, listed });
        }
    }

    /// What a joint of that type is made of, the factor nearest to the parent first.
    fn motions(&mut self, fields: &Fields<'_>, kind: &Name) -> Option<Vec<Motion>> {
        let (x, y, z) = (Vec3::X, Vec3::Y, Vec3::Z);
        let used: &[&str] = match kind.text.as_str() {
            "hinge" => &["axis"],
            "universal" | "planar" => &["axes"],
            "prismatic" => &["axis", "axes"],
            "euler" => &["axes", "order"],
            "free" => &["order"],
            _ => &[],
        };
        for entry in fields.entries() {
            let key = entry.key.text.as_str();
            if ["axis", "axes", "order"].contains(&key) && !used.contains(&key) {
                let message = format!("a {} joint has no `{key}`", kind.text);
                self.sources.error(entry.key.spot, "model/unknown-key", message, "leave it away");
            }
        }
        let turns = |axes: &[Vec3], names: &[&str]| -> Vec<Motion> {
            names.iter().zip(axes).map(|(n, a)| Motion::turn(n, *a)).collect()
        };
        Some(match kind.text.as_str() {
            "weld" => vec![],
            "hinge" => vec![Motion::turn("angle", self.axes::<1>(fields)[0])],
            "universal" => turns(&self.axes::<2>(fields), &["first", "second"]),
            "ball" => vec![Motion {
                coordinate: "orientation".to_owned(),
                kind: CoordinateKind::Orientation,
                law: Law::Ball,
            }],
            "euler" if fields.get("axes").is_some() => {
                turns(&self.axes::<3>(fields), &["first", "second", "third"])
            }
            "euler" => {
                let Some(node) = fields.get("order") else {
                    self.missing(fields, "order", "an order such as \"zxy\", or three `axes`");
                    return None;
                };
                let order = self.order(node, "order")?;
                let axes = [0, 1, 2].map(|i| order.axis(i));
                turns(&axes, &["first", "second", "third"])
            }
            "prismatic" if fields.get("axis").is_some() => {
                vec![Motion::slide("distance", self.axes::<1>(fields)[0])]
            }
            "prismatic" => {
                let Some(node) = fields.get("axes") else {
                    self.missing(fields, "axis", "a direction such as [0, 1, 0], or `axes`");
                    return None;
                };
                let list = self.list(node, "axes")?;
                let axes: Vec<_> = list.iter().filter_map(|n| self.vector(n, "axes")).collect();
                if axes.is_empty() || axes.len() > 3 {
                    let message = format!("`axes` has {} directions", axes.len());
                    self.sources.error(node.spot, "model/length", message, "give one to three");
                    return None;
                }
                let names = ["first", "second", "third"];
                names.iter().zip(axes).map(|(name, a)| Motion::slide(name, a)).collect()
            }
            "planar" => {
                let axes = match fields.get("axes") {
                    Some(_) => self.axes::<3>(fields),
                    None => [x, y, z],
                };
                vec![
                    Motion::slide("x", axes[0]),
                    Motion::slide("y", axes[1]),
                    Motion::turn("turn", axes[2]),
                ]
            }
            "free" => {
                let order = fields.get("order").map(|n| self.order(n, "order"));
                let order = order.unwrap_or(Some(EulerOrder::XYZ))?;
                let mut motions =
                    vec![Motion::slide("x", x), Motion::slide("y", y), Motion::slide("z", z)];
                let axes = [0, 1, 2].map(|i| order.axis(i));
                motions.extend(turns(&axes, &["first", "second", "third"]));
                motions
            }
            other => {
                let help = match nearest(other, keys::JOINT_TYPES.iter().copied()) {
                    Some(near) => format!("did you mean `{near}`?"),
                    None => format!("types are: {}", keys::JOINT_TYPES.join(", ")),
                };
                let message = format!("unknown type of joint `{other}`");
                self.sources.error(kind.spot, "model/joint-type", message, help);
                return None;
            }
        })
    }

    /// `axis`, or exactly `N` `axes`; after an error z, so that the rest of the joint is read.
    fn axes<const N: usize>(&mut self, fields: &Fields<'_>) -> [Vec3; N] {
        let key = if N == 1 { "axis" } else { "axes" };
        let Some(node) = fields.get(key) else {
            let wanted = match N {
                1 => "a direction such as [0, 0, 1]".to_owned(),
                _ => format!("{N} directions"),
            };
            self.missing(fields, key, &wanted);
            return [Vec3::Z; N];
        };
        if N == 1 {
            return [self.vector(node, key).unwrap_or(Vec3::Z); N];
        }
        let list = self.list(node, key).unwrap_or_default();
        let axes: Vec<Option<Vec3>> = list.iter().map(|n| self.vector(n, key)).collect();
        if axes.len() != N && matches!(node.value, Value::List(_)) {
            let message = format!("`axes` has {} directions", axes.len());
            self.sources.error(node.spot, "model/length", message, format!("give {N}"));
        }
        std::array::from_fn(|i| axes.get(i).copied().flatten().unwrap_or(Vec3::Z))
    }
}
