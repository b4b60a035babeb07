//! What files of skeletons leave unsaid: the unit of lengths, the axis that points up, where the figure looks.

use super::Skeleton;
use condyle_diagnostics::{Diagnostic, Warnings};
use condyle_math::Vec3;
use condyle_model::UpAxis;
use condyle_model::model::Facing;
use condyle_motion::LengthUnit;
use std::collections::HashMap;

/// What the user knows of a file that does not state it; `None` is guessed, with a warning.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct Assumed {
    /// Metres in one unit of length.
    pub metres_per_unit: Option<f64>,
    /// The axis that points up.
    pub up: Option<UpAxis>,
    /// Frames per second.
    pub rate: Option<f64>,
}

/// Metres in the unit of the Carnegie Mellon recordings: 1/0.45 inch.
const CMU_UNIT: f64 = 0.0254 / 0.45;

/// Metres in a unit by its name (`m`, `cm`, `mm`, `in`, `ft`, and `cmu` for the 1/0.45 inch of the Carnegie
/// Mellon recordings), or by a positive number of metres.
///
/// ```
/// use condyle_formats::skeleton::named_unit;
/// assert_eq!(named_unit("cm"), Some(0.01));
/// assert_eq!(named_unit("0.3"), Some(0.3));
/// assert!((named_unit("cmu").unwrap() - 0.056444).abs() < 1e-6);
/// assert_eq!(named_unit("-1"), None);
/// ```
#[must_use]
pub fn named_unit(name: &str) -> Option<f64> {
    if name.trim().eq_ignore_ascii_case("cmu") {
        return Some(CMU_UNIT);
    }
    let named = LengthUnit::from_name(name).map(|unit| unit.to_metres(1.0));
    let number = || name.trim().parse().ok().filter(|n: &f64| n.is_finite() && *n > 0.0);
    named.or_else(number)
}

/// What the size of a figure says about its unit of length.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct UnitGuess {
    /// Metres in one unit.
    pub metres: f64,
    /// Its name.
    pub name: &'static str,
    /// Whether the size is that of a person in this unit; else it is only what most programs write.
    pub fits: bool,
}

impl UnitGuess {
    /// Sizes of people in each unit, from an infant of 0.8 m to 3 m of a figure with raised arms. Between
    /// inches and centimetres they overlap, and 85 is the limit.
    const SIZES: [(f64, f64, f64, &'static str); 5] = [
        (0.7, 3.5, 1.0, "m"),
        (12.0, 45.0, CMU_UNIT, "1/0.45 in"),
        (45.0, 85.0, 0.0254, "in"),
        (85.0, 350.0, 0.01, "cm"),
        (700.0, 3500.0, 0.001, "mm"),
    ];

    /// The guess for a figure that is so many units large.
    ///
    /// ```
    /// use condyle_formats::skeleton::UnitGuess;
    /// assert_eq!(UnitGuess::of(172.0).name, "cm");
    /// assert_eq!(UnitGuess::of(31.0).name, "1/0.45 in");
    /// assert_eq!(UnitGuess::of(1.7).name, "m");
    /// assert!(!UnitGuess::of(6.0).fits);
    /// ```
    #[must_use]
    pub fn of(size: f64) -> Self {
        let found = Self::SIZES.iter().find(|(low, high, ..)| (*low..*high).contains(&size));
        match found {
            Some((_, _, metres, name)) => Self { metres: *metres, name, fits: true },
            None => Self { metres: 0.01, name: "cm", fits: false },
        }
    }
}

/// Fewer joints are not taken to be those of a person.
const LEAST_JOINTS: usize = 10;

/// Metres in a unit of a skeleton that is in the units of its file: what is told, else what its largest
/// extent at rest says, with the warning `skeleton/unit`.
pub fn length_unit(skeleton: &Skeleton, assumed: &Assumed, warnings: &mut Warnings) -> f64 {
    length_unit_or(
        skeleton,
        assumed,
        (UnitGuess::of(0.0).metres, UnitGuess::of(0.0).name),
        warnings,
    )
}

/// As [`length_unit`], with the unit and its name that are taken where the size does not tell: that which most
/// programs write.
pub fn length_unit_or(
    skeleton: &Skeleton,
    assumed: &Assumed,
    usual: (f64, &'static str),
    warnings: &mut Warnings,
) -> f64 {
    if let Some(metres) = assumed.metres_per_unit {
        return metres;
    }
    let mut low = [f64::INFINITY; 3];
    let mut high = [f64::NEG_INFINITY; 3];
    for (_, joint, ends) in skeleton.rest() {
        for point in ends.into_iter().chain([joint]) {
            for (axis, value) in point.to_array().into_iter().enumerate() {
                low[axis] = low[axis].min(value);
                high[axis] = high[axis].max(value);
            }
        }
    }
    let size = (0..3).map(|axis| high[axis] - low[axis]).fold(0.0, f64::max);
    let mut guess = UnitGuess::of(size);
    if skeleton.bones.len() < LEAST_JOINTS || !guess.fits {
        guess = UnitGuess { metres: usual.0, name: usual.1, fits: false };
    }
    let message = match guess.fits {
        true => format!(
            "the unit of length is not stated: {size:.4} units are the size of a person in {}",
            guess.name
        ),
        false => format!(
            "the unit of length is not stated, and a size of {size:.4} units does not tell it: read as {}",
            guess.name
        ),
    };
    let help = "give it with --length-unit (m, cm, mm, in, ft, cmu, or metres in a unit)";
    warnings.push(Diagnostic::warning("skeleton/unit", message).with_help(help));
    guess.metres
}

/// The axis that points from the feet to the head, by the names of joints at their places in one pose or in
/// several; `None` where names or places do not tell.
#[must_use]
pub fn up_of(joints: &[(&str, Vec3)]) -> Option<UpAxis> {
    let mean = |words: &[&str]| {
        let of_words = joints.iter().filter(|(name, _)| {
            let name = name.to_ascii_lowercase();
            words.iter().any(|word| name.contains(word))
        });
        let (sum, count) =
            of_words.fold((Vec3::ZERO, 0u32), |(sum, n), (_, at)| (sum + *at, n + 1));
        (count > 0).then(|| sum * (1.0 / f64::from(count)))
    };
    let step = mean(&["head", "neck"])? - mean(&["foot", "feet", "ankle", "toe"])?;
    let [x, y, z] = step.to_array().map(f64::abs);
    if y > 1.5 * x.max(z) {
        return Some(UpAxis::Y);
    }
    (z > 1.5 * x.max(y)).then_some(UpAxis::Z)
}

/// How left is written in names, and how right.
const SIDES: [(&str, &str); 6] =
    [("left", "right"), ("_l", "_r"), (".l", ".r"), ("l_", "r_"), ("-l", "-r"), ("l", "r")];

/// Where a figure looks at rest, by joints that are named after their sides: to the front of one whose left
/// joints are on its left. `None` where names or places do not tell.
///
/// ```
/// use condyle_formats::skeleton::facing_of;
/// use condyle_math::Vec3;
/// use condyle_model::{Facing, UpAxis};
/// let joints = [("LeftUpLeg", Vec3::X * 0.1), ("RightUpLeg", Vec3::X * -0.1)];
/// assert_eq!(facing_of(&joints, UpAxis::Y), Some(Facing::PlusZ));
/// ```
#[must_use]
pub fn facing_of(joints: &[(&str, Vec3)], up: UpAxis) -> Option<Facing> {
    let names: HashMap<String, Vec3> =
        joints.iter().map(|(name, at)| (name.to_ascii_lowercase(), *at)).collect();
    let mut left = Vec3::ZERO;
    for (name, at) in &names {
        let other = |(l, r): &(&str, &str)| {
            let whole = l.len() > 1 && name.contains(l);
            let first = name.strip_prefix(l).map(|rest| format!("{r}{rest}"));
            let other = if whole { Some(name.replacen(l, r, 1)) } else { first };
            other.and_then(|other| names.get(&other))
        };
        if let Some(right) = SIDES.iter().find_map(other) {
            left += *at - *right;
        }
    }
    let above = match up {
        UpAxis::Y => Vec3::Y,
        UpAxis::Z => Vec3::Z,
    };
    let ahead = left.cross(above);
    let along = |facing: &Facing| ahead.dot(facing.ahead(up));
    let best = Facing::ALL.into_iter().max_by(|a, b| along(a).total_cmp(&along(b)))?;
    (along(&best) > 0.8 * ahead.norm()).then_some(best)
}
