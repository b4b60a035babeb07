//! Words that authors bring from elsewhere: from the papers, from other formats, from habit.
//!
//! They are not accepted, so that there is one way to write each thing; the error says what is meant.

/// What is meant by a key that its table does not have. The table is the last part of its label that
/// says its kind, such as `depend` of `joint_set.s.component.bound.depend`.
pub(super) fn key(label: &str, key: &str) -> Option<&'static str> {
    let mut parts = label.split('.');
    let family = parts.next().unwrap_or_default();
    let kind = label.rsplit('.').next().unwrap_or_default();
    let table = match family {
        "joint_set" | "template" if label.contains(".component.") => kind,
        _ if label.contains(".coordinate.") => "coordinate",
        family => family,
    };
    let meant = KEYS.iter().find(|(of, keys, _)| *of == table && keys.contains(&key));
    meant.map(|(_, _, help)| *help)
}

/// A table or kind of component, keys that it does not have, and what is meant by them.
const KEYS: &[(&str, &[&str], &str)] = &[
    ("depend", &["on", "by", "leader", "active", "independent"], "did you mean `driver`?"),
    ("depend", &["angle", "input", "follower", "dependent"], "did you mean `passive`?"),
    ("depend", &["min", "minimum", "low"], "did you mean `lower`?"),
    ("depend", &["max", "maximum", "high"], "did you mean `upper`?"),
    (
        "rotate",
        &["centre", "center", "centres", "centers", "point", "at", "origin"],
        "a rotation about another centre is of kind pivot, with `centres = [{ at = [0, 0.01, 0] }]`",
    ),
    (
        "pivot",
        &["centre", "center", "centers", "point", "at"],
        "give `centres`, a list such as [{ at = [0, 0.01, 0] }]",
    ),
    ("translate", &["angle", "amount", "input"], "did you mean `distance`?"),
    ("map", &["angle", "on", "driver"], "did you mean `input`?"),
    (
        "combine",
        &["input", "angles", "slopes"],
        "give `inputs` and `function = { slopes = [...] }`",
    ),
    ("cone", &["directions", "polygon", "boundary", "corners"], "did you mean `points`?"),
    ("cone", &["axis", "long_axis", "neutral"], "the bone's direction at rest is `rest`"),
    ("compensate", &["parents", "parent", "of"], "did you mean `ancestors`?"),
    ("contact", &["ellipsoid", "semi_axes", "half_axes"], "did you mean `radii`?"),
    (
        "segment",
        &["position", "pos", "offset", "translation", "location", "origin"],
        "did you mean `at`?",
    ),
    ("segment", &["rotation", "orientation", "rotate", "euler"], "did you mean `turn`?"),
    ("joint", &["parent", "child"], "the parent is given in the table of the segment"),
    ("joint", &["body", "bone"], "did you mean `segment`?"),
    ("joint", &["kind"], "did you mean `type`?"),
    (
        "joint",
        &["range", "limits", "default"],
        "give it in a table of the coordinate: `coordinate.NAME = { range = [0, 90] }`",
    ),
    (
        "coordinate",
        &["min", "max", "lower", "upper", "limits", "limit"],
        "give `range = [lower, upper]`",
    ),
    ("coordinate", &["value", "initial", "init", "neutral"], "did you mean `default`?"),
    ("marker", &["parent", "body", "bone"], "did you mean `segment`?"),
    ("marker", &["position", "pos", "offset", "location", "point"], "did you mean `at`?"),
];

/// The kind of component that is meant by a word of the papers.
pub(super) fn kind(word: &str) -> Option<&'static str> {
    meant(KINDS, word)
}

/// The type of plain joint that is meant by a word of other formats.
pub(super) fn joint(word: &str) -> Option<&'static str> {
    meant(JOINTS, word)
}

fn meant(known: &[(&[&str], &'static str)], word: &str) -> Option<&'static str> {
    let plain: String = word.chars().filter(|c| c.is_alphanumeric()).collect();
    let plain = plain.to_lowercase();
    known.iter().find(|(words, _)| words.contains(&plain.as_str())).map(|(_, help)| *help)
}

/// Words without their capitals and underscores, and what is meant by them.
const KINDS: &[(&[&str], &str)] = &[
    (&["dependency", "dependent", "depends", "onewaydependency"], "did you mean `depend`?"),
    (
        &["rotation", "revolute", "pin", "hinge"],
        "a rotation about the joint is `rotate`, one about a moving centre `pivot`",
    ),
    (&["mapping", "onetoone", "function", "spline", "coupling"], "did you mean `map`?"),
    (&["sum", "blend", "add", "linear"], "did you mean `combine`?"),
    (&["jointsinuscone", "sinuscone", "jointcone", "reachcone", "limit"], "did you mean `cone`?"),
    (&["compensation", "counterrotate"], "did you mean `compensate`?"),
    (
        &["scapula", "scapulaconstraint", "scapulothoracic", "gliding", "glide"],
        "did you mean `contact`?",
    ),
    (&["translation", "slide", "prismatic"], "did you mean `translate`?"),
    (&["ballandsocket", "quaternion", "orientation"], "did you mean `ball`?"),
    (&["chain", "sequence", "multiply"], "did you mean `product`?"),
    (&["transform", "offset", "fixed", "frame"], "did you mean `place`?"),
];

const JOINTS: &[(&[&str], &str)] = &[
    (&["revolute", "pin", "pinjoint", "rotation", "continuous"], "did you mean `hinge`?"),
    (&["ballandsocket", "spherical", "balljoint", "quaternion"], "did you mean `ball`?"),
    (&["gimbal", "gimbaljoint", "threeaxis"], "did you mean `euler`?"),
    (&["slider", "sliderjoint", "slide", "translation"], "did you mean `prismatic`?"),
    (&["freejoint", "root", "floating", "sixdof"], "did you mean `free`?"),
    (&["fixed", "weldjoint", "rigid"], "did you mean `weld`?"),
    (&["hooke", "condyloid", "saddle", "ellipsoidal"], "did you mean `universal`?"),
];

/// The unit that is meant by another word for it.
pub(super) fn unit(word: &str) -> Option<&'static str> {
    let plain = word.trim().to_lowercase();
    let meant = UNITS.iter().find(|(words, _)| words.contains(&plain.as_str()));
    meant.map(|(_, unit)| *unit)
}

const UNITS: &[(&[&str], &str)] = &[
    (&["deg", "degree", "degrees", "°", "grad"], "deg"),
    (&["rad", "radian", "radians"], "rad"),
    (&["m", "metre", "metres", "meter", "meters"], "m"),
    (&["cm", "centimetre", "centimetres", "centimeter", "centimeters"], "cm"),
    (&["mm", "millimetre", "millimetres", "millimeter", "millimeters"], "mm"),
];

/// The direction that is meant by the name of an axis, such as "z" or "-x".
pub(super) fn axis(word: &str) -> Option<[i8; 3]> {
    let plain = word.trim().to_lowercase();
    let (sign, name) = match plain.strip_prefix('-') {
        Some(name) => (-1, name),
        None => (1, plain.strip_prefix('+').unwrap_or(&plain)),
    };
    let at = ["x", "y", "z"].iter().position(|axis| *axis == name)?;
    Some(std::array::from_fn(|i| if i == at { sign } else { 0 }))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_of_others_are_understood() {
        let depend = "joint_set.s.component.bound.depend";
        assert_eq!(key(depend, "on"), Some("did you mean `driver`?"));
        assert_eq!(key("joint_set.s.coordinate.abd", "max"), Some("give `range = [lower, upper]`"));
        assert_eq!(
            key("joint.knee.coordinate.abd", "max"),
            key("joint_set.s.coordinate.abd", "max")
        );
        assert_eq!(key("segment.thigh", "parnt"), None);
        assert_eq!(kind("Joint_Sinus_Cone"), Some("did you mean `cone`?"));
        assert_eq!((unit("Degrees"), unit("furlong")), (Some("deg"), None));
        assert_eq!((axis("-Y"), axis("w")), (Some([0, -1, 0]), None));
    }
}
