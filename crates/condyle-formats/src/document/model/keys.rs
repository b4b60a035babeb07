//! The words of a model document: every key that each table takes.

/// Keys at the top of a document.
pub(super) const TOP: &[&str] = &[
    "condyle",
    "kind",
    "name",
    "up",
    "angles",
    "include",
    "constants",
    "mirror",
    "segment",
    "joint",
    "joint_set",
    "marker",
    "closure",
    "size",
];
/// What a document of this format may be.
pub(super) const KINDS: &[&str] = &["model", "limit", "law", "recipe", "setup", "names"];
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
/// The types of plain joints, with the keys that each takes beside those that all take.
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
/// What every plain joint takes.
pub(super) const JOINT_BASE: &[&str] = &["segment", "type", "coordinates", "coordinate"];
pub(super) const JOINT_SET: &[&str] = &["coordinate", "component", "output"];
pub(super) const COORDINATE: &[&str] =
    &["kind", "default", "range", "enforced", "locked", "unit", "source", "follows"];
pub(super) const MARKER: &[&str] = &["segment", "at"];
pub(super) const CLOSURE: &[&str] = &["points", "frames", "distance", "coupling"];
pub(super) const SIZE: &[&str] = &["segments"];
pub(super) const FRAME: &[&str] = &["segment", "at", "turn", "order", "matrix"];
pub(super) const CENTRE: &[&str] = &["to", "at"];
pub(super) const CONE_POINT: &[&str] = &["direction", "twist"];
pub(super) const CONTACT_PAIR: &[&str] = &["first", "second", "at"];
pub(super) const COUPLING: &[&str] = &["follower", "driver", "function"];
pub(super) const FUNCTION: &[&str] =
    &["constant", "linear", "ends", "polynomial", "spline", "lines", "factor"];
pub(super) const SEVERAL: &[&str] = &["slopes", "intercept", "dimension", "order", "coefficients"];

/// The component kinds with their keys.
pub(super) const COMPONENTS: &[(&str, &[&str])] = &[
    ("map", &["input", "function", "functions", "in", "out"]),
    ("combine", &["inputs", "function"]),
    ("depend", &["passive", "driver", "lower", "upper"]),
    (
        "cone",
        &[
            "angles",
            "axes",
            "order",
            "orientation",
            "rest",
            "points",
            "twist",
            "subdivisions",
            "projection",
        ],
    ),
    (
        "contact",
        &[
            "segment", "surface", "at", "turn", "order", "matrix", "radii", "axis", "before",
            "drivers", "in", "pairs",
        ],
    ),
    ("rotate", &["angle", "axis"]),
    ("pivot", &["angle", "axis", "centres", "path"]),
    ("translate", &["distance", "axis"]),
    ("ball", &["orientation"]),
    ("place", &["at", "turn", "order", "matrix"]),
    ("ellipsoid", &["about_x", "about_y", "about_z", "radii", "surface_axis"]),
    ("constant_curvature", &["about_x", "about_z", "about_y", "neutral", "length"]),
    ("compensate", &["segment", "ancestors", "weight"]),
    ("scale", &["factor", "axis", "volume"]),
    ("shear", &["amount", "along", "across"]),
    ("curve", &["parameter", "in", "path", "forward", "up"]),
    ("custom", &["law", "inputs", "parameters"]),
    ("product", &["factors"]),
];

/// Every table of a model document with the keys that it takes, for manuals and schemas.
///
/// The components stand under their kinds, such as `component.rotate`.
#[must_use]
pub fn keys() -> Vec<(String, Vec<&'static str>)> {
    let plain: [(&str, &[&'static str]); 17] = [
        ("model", TOP),
        ("mirror", MIRROR),
        ("segment", SEGMENT),
        ("joint", JOINT),
        ("joint_set", JOINT_SET),
        ("coordinate", COORDINATE),
        ("marker", MARKER),
        ("closure", CLOSURE),
        ("size", SIZE),
        ("point", MARKER),
        ("frame", FRAME),
        ("centre", CENTRE),
        ("cone_point", CONE_POINT),
        ("contact_pair", CONTACT_PAIR),
        ("coupling", COUPLING),
        ("function", FUNCTION),
        ("function_of_several", SEVERAL),
    ];
    let components = COMPONENTS.iter().map(|(kind, keys)| (format!("component.{kind}"), *keys));
    plain
        .into_iter()
        .map(|(table, keys)| (table.to_owned(), keys))
        .chain(components)
        .map(|(table, keys)| (table, keys.to_vec()))
        .collect()
}
