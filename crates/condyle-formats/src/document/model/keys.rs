//! The keys of each table of a model document.

use super::read::component_keys;
use crate::document::function::{FUNCTION, SEVERAL};
use crate::document::head::HEAD;
use crate::document::template::TEMPLATE;
use condyle_model::Law;

/// The keys at the top of a document, beside those of its head.
pub(super) const TOP: &[&str] = &[
    "up",
    "facing",
    "mirror",
    "segment",
    "joint",
    "joint_set",
    "marker",
    "shape",
    "closure",
    "posture",
    "size",
    "template",
];
/// Those of them that a template may hold.
pub(super) const REPEATED: &[&str] =
    &["segment", "joint", "joint_set", "marker", "shape", "closure", "posture", "size"];
pub(super) const MIRROR: &[&str] = &["plane", "from", "to"];
pub(super) const SEGMENT: &[&str] = &[
    "parent",
    "at",
    "turn",
    "order",
    "matrix",
    "joint_at",
    "joint_turn",
    "joint_order",
    "joint_matrix",
];
pub(super) const JOINT: &[&str] = &[
    "segment",
    "type",
    "axis",
    "axes",
    "order",
    "ball",
    "pitch",
    "path",
    "in",
    "forward",
    "up",
    "volume",
    "along",
    "across",
    "radii",
    "surface_axis",
    "coordinates",
    "coordinate",
];
/// The types of plain joints, with the keys of each beside [`JOINT_BASE`].
pub(super) const JOINT_TYPES: &[(&str, &[&str])] = &[
    ("hinge", &["axis"]),
    ("universal", &["axes"]),
    ("ball", &[]),
    ("euler", &["axes", "order"]),
    ("prismatic", &["axis", "axes"]),
    ("planar", &["axes"]),
    ("free", &["order", "ball"]),
    ("screw", &["axis", "pitch"]),
    ("curve", &["path", "in", "forward", "up"]),
    ("scale", &["axis", "axes", "volume"]),
    ("shear", &["along", "across"]),
    ("ellipsoid", &["radii", "surface_axis"]),
    ("weld", &[]),
];
/// The keys of every plain joint.
pub(super) const JOINT_BASE: &[&str] = &["segment", "type", "coordinates", "coordinate"];
pub(super) const JOINT_SET: &[&str] = &["coordinate", "component", "output"];
pub(super) const COORDINATE: &[&str] = &[
    "kind",
    "default",
    "range",
    "typical",
    "enforced",
    "locked",
    "drives",
    "unit",
    "source",
    "follows",
    "rest",
    "stiffness",
];
pub(super) const MARKER: &[&str] = &["segment", "at", "like"];
pub(super) const POINT: &[&str] = &["segment", "at"];
/// The forms of a shape.
pub(super) const FORMS: &[&str] = &["ball", "box", "tube", "plate", "rib"];
pub(super) const SHAPE: &[&str] =
    &["segment", "finish", "ball", "box", "tube", "across", "plate", "rib"];
pub(super) const BALL: &[&str] = &["at", "radii", "turn", "order", "matrix"];
pub(super) const BOX: &[&str] = &["at", "size", "turn", "order", "matrix"];
pub(super) const PLATE: &[&str] = &["outline", "middle", "thickness"];
pub(super) const RIB: &[&str] = &[
    "at", "chord", "peak", "angle", "proximal", "distal", "pump", "swing", "plane", "along",
    "outward", "radii",
];
pub(super) const CLOSURE: &[&str] = &["points", "frames", "distance", "coupling"];
pub(super) const POSTURE: &[&str] = &["sum", "rest", "stiffness", "source"];
pub(super) const SIZE: &[&str] = &["segments"];
pub(super) const FRAME: &[&str] = &["segment", "at", "turn", "order", "matrix"];
pub(super) const CENTRE: &[&str] = &["to", "at"];
pub(super) const CONE_POINT: &[&str] = &["direction", "twist"];
pub(super) const CONTACT_PAIR: &[&str] = &["first", "second", "at"];
pub(super) const COUPLING: &[&str] = &["follower", "driver", "function"];

/// Every table of a model document with its keys, for manuals and schemas.
///
/// Components are listed by kind, such as `component.rotate`.
#[must_use]
pub fn keys() -> Vec<(String, Vec<&'static str>)> {
    let top = [HEAD, TOP].concat();
    let template = [TEMPLATE, REPEATED].concat();
    let plain: [(&str, &[&'static str]); 24] = [
        ("model", &top),
        ("mirror", MIRROR),
        ("template", &template),
        ("segment", SEGMENT),
        ("joint", JOINT),
        ("joint_set", JOINT_SET),
        ("coordinate", COORDINATE),
        ("marker", MARKER),
        ("closure", CLOSURE),
        ("posture", POSTURE),
        ("size", SIZE),
        ("shape", SHAPE),
        ("ball", BALL),
        ("box", BOX),
        ("plate", PLATE),
        ("rib", RIB),
        ("point", POINT),
        ("frame", FRAME),
        ("centre", CENTRE),
        ("cone_point", CONE_POINT),
        ("contact_pair", CONTACT_PAIR),
        ("coupling", COUPLING),
        ("function", FUNCTION),
        ("function_of_several", SEVERAL),
    ];
    let components = Law::KINDS.iter().map(|kind| {
        let keys: Vec<&'static str> = component_keys(kind).collect();
        (format!("component.{}", kind.name), keys)
    });
    plain
        .into_iter()
        .map(|(table, keys)| (table.to_owned(), keys.to_vec()))
        .chain(components)
        .collect()
}
