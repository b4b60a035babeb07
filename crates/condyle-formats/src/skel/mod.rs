//! SKEL, the skeletons of the animation course CSE 169 of UC San Diego (Rotenberg).
//!
//! ```text
//! joint = "balljoint" name "{" { item } "}"
//! item  = joint | "offset" x y z | "boxmin" x y z | "boxmax" x y z | "pose" x y z
//!       | ("rotxlimit" | "rotylimit" | "rotzlimit") low high
//! ```
//!
//! A joint is at its offset in its parent and turns about x, then y, then z, which is Rz·Ry·Rx for column
//! vectors, by angles in radians. A pose outside of the limits is brought to the nearest legal one, so limits
//! become ranges that are enforced, and the pose the coordinates' defaults. Where nothing is said, the offset
//! and the pose are 0, there are no limits, and the box reaches from -0.1 to 0.1 along each axis. Boxes are
//! shapes of the model. The unit of lengths is not stated ([`Assumed`]); metres are
//! usual.
//!
//! DART's skeletons have the same ending and nothing else in common, neither those in XML nor those in its old
//! text: both are refused with that reason.

use crate::skeleton::{
    Assumed, Bone, Freedom, FreedomKind, Skeleton, facing_of, length_unit_or, up_of,
};
use crate::text::{Line, decode, lines, number};
use condyle_diagnostics::{Diagnostic, Error, Place, Read, Warnings};
use condyle_math::{Mat3, Vec3};
use condyle_mesh::{Block, Form};
use condyle_model::model::Facing;
use condyle_model::{Model, Range, UpAxis};

/// More joints are refused.
const MOST_JOINTS: usize = 5000;
/// A limit as far out as this is none: the course's own default.
const NO_LIMIT: f64 = 100_000.0;

/// A joint as it is written.
#[derive(Clone, Debug)]
struct Joint {
    name: String,
    parent: Option<usize>,
    offset: [f64; 3],
    low: [f64; 3],
    high: [f64; 3],
    limits: [Option<[f64; 2]>; 3],
    pose: [f64; 3],
}

/// A word and its place; a brace is a word.
type Word<'a> = (&'a str, Place);

/// The words of a line.
fn words<'a>(line: Line<'a>) -> impl Iterator<Item = Word<'a>> {
    let mut rest = line.text;
    std::iter::from_fn(move || {
        rest =
            rest.trim_start_matches(|c: char| c.is_whitespace() || matches!(c, ',' | ';' | '\0'));
        let first = rest.chars().next()?;
        let ends = |c: char| c.is_whitespace() || matches!(c, '{' | '}' | ',' | ';');
        let length = match first {
            '{' | '}' => 1,
            _ => rest.find(ends).unwrap_or(rest.len()),
        };
        let (word, after) = rest.split_at_checked(length)?;
        rest = after;
        Some((word, line.place_of(word)))
    })
}

/// Reads a skeleton of the course.
///
/// # Errors
/// `skel/dart` for DART's files, `skel/empty`, `skel/grammar` and `skel/number` with their places, `skel/size`
/// of what no program writes; what [`decode`] refuses.
///
/// ```
/// use condyle_formats::{skel, skeleton::Assumed};
/// let text = "balljoint root {\n offset 0 1 0\n balljoint knee {\n offset 0 -0.4 0\n \
///     rotxlimit -2 0\n rotylimit 0 0\n rotzlimit 0 0\n pose 0.5 0 0\n }\n}\n";
/// let model = skel::read(text.as_bytes(), &Assumed::default())?.value;
/// let knee = model.coordinate_ids().find(|id| model.coordinate_key(*id) == "knee/rx").unwrap();
/// // The pose is outside of the limits, and brought to the nearest.
/// assert_eq!(model.coordinate(knee).default[0], 0.0);
/// assert_eq!(model.coordinate(knee).range.lower, Some(-2.0));
/// # Ok::<(), condyle_formats::Error>(())
/// ```
pub fn read(bytes: &[u8], assumed: &Assumed) -> Result<Read<Model>, Error> {
    let decoded = decode(bytes)?;
    let mut warnings = Warnings::default();
    warnings.extend(decoded.warnings);
    let joints = joints(&decoded.value, &mut warnings)?;
    let mut skeleton = bones(&joints, 1.0, &mut warnings);
    let unit = length_unit_or(&skeleton, assumed, (1.0, "m"), &mut warnings);
    skeleton = bones(&joints, unit, &mut Warnings::default());
    let rest = skeleton.rest();
    let places: Vec<(&str, Vec3)> = rest.iter().map(|(name, at, _)| (*name, *at)).collect();
    let up = assumed.up.or_else(|| up_of(&places)).unwrap_or(UpAxis::Y);
    let facing = facing_of(&places, up).unwrap_or(Facing::PlusZ);
    (skeleton.up, skeleton.facing) = (up, facing);
    let read = skeleton.build()?;
    warnings.extend(read.warnings);
    Ok(Read { value: read.value, warnings: warnings.finish() })
}

fn joints(text: &str, warnings: &mut Warnings) -> Result<Vec<Joint>, Error> {
    let mut words = lines(text).flat_map(words).peekable();
    if let Some((first, place)) = words.peek() {
        let dart = match *first {
            word if word.starts_with('<') => Some("in XML"),
            word if word.eq_ignore_ascii_case("dofs") => Some("in its old text"),
            _ => None,
        };
        if let Some(form) = dart {
            let message =
                format!("this is a skeleton of DART {form}, not one of the course CSE 169");
            let help = "files of this ending are read where they begin with `balljoint`";
            return Err(Error::new("skel/dart", message).at(*place).with_help(help));
        }
    }
    let mut joints: Vec<Joint> = vec![];
    let mut open: Vec<usize> = vec![];
    let mut last = Place::at_line(1);
    while let Some((word, place)) = words.next() {
        last = place;
        let key = word.to_ascii_lowercase();
        if key == "balljoint" {
            if joints.len() >= MOST_JOINTS {
                let message = format!("there are more than {MOST_JOINTS} joints");
                return Err(Error::new("skel/size", message).at(place));
            }
            let mut name = format!("joint{}", joints.len() + 1);
            if let Some((own, _)) = words.next_if(|(word, _)| *word != "{") {
                own.trim_matches('"').clone_into(&mut name);
            }
            if words.next_if(|(word, _)| *word == "{").is_none() {
                let message = format!("a `{{` is missing behind `balljoint {name:.40}`");
                return Err(Error::new("skel/grammar", message).at(place));
            }
            joints.push(Joint {
                name,
                parent: open.last().copied(),
                offset: [0.0; 3],
                low: [-0.1; 3],
                high: [0.1; 3],
                limits: [None; 3],
                pose: [0.0; 3],
            });
            open.push(joints.len() - 1);
            continue;
        }
        if key == "}" {
            if open.pop().is_none() {
                warnings.add("skel/brace", || {
                    Diagnostic::warning("skel/brace", "a `}` closes nothing").at(place)
                });
            }
            continue;
        }
        let Some(joint) = open.last().and_then(|index| joints.get_mut(*index)) else {
            let message = format!("`{word:.40}` stands outside of a joint");
            let help = "the file begins with `balljoint`";
            return Err(Error::new("skel/grammar", message).at(place).with_help(help));
        };
        let count = match key.as_str() {
            "offset" | "boxmin" | "boxmax" | "pose" => 3,
            "rotxlimit" | "rotylimit" | "rotzlimit" => 2,
            _ => {
                warnings.add("skel/unknown", || {
                    let message = format!("`{word:.40}` is not known, and left out");
                    Diagnostic::warning("skel/unknown", message).at(place)
                });
                while words.next_if(|(word, _)| number(word).is_some()).is_some() {}
                continue;
            }
        };
        let mut numbers = [0.0; 3];
        for value in numbers.iter_mut().take(count) {
            let (text, at) = words.next().unwrap_or(("", place));
            *value = number(text).filter(|value| !value.is_nan()).ok_or_else(|| {
                let message = format!("`{word}` needs {count} numbers, `{text:.40}` is none");
                Error::new("skel/number", message).at(at)
            })?;
        }
        let limit = Some([numbers[0], numbers[1]]);
        match key.as_str() {
            "offset" => joint.offset = numbers.map(finite),
            "boxmin" => joint.low = numbers.map(finite),
            "boxmax" => joint.high = numbers.map(finite),
            "pose" => joint.pose = numbers.map(finite),
            "rotxlimit" => joint.limits[0] = limit,
            "rotylimit" => joint.limits[1] = limit,
            _ => joint.limits[2] = limit,
        }
    }
    if !open.is_empty() {
        let message = format!("{} braces are not closed", open.len());
        warnings.push(Diagnostic::warning("skel/brace", message).at(last));
    }
    if joints.is_empty() {
        let message = "there is no joint";
        let help = "the file begins with `balljoint`";
        return Err(Error::new("skel/empty", message).at(Place::at_line(1)).with_help(help));
    }
    Ok(joints)
}

fn finite(value: f64) -> f64 {
    if value.is_finite() { value } else { 0.0 }
}

/// The bones, with so many metres in a unit.
fn bones(joints: &[Joint], unit: f64, warnings: &mut Warnings) -> Skeleton {
    let mut skeleton = Skeleton::default();
    for (index, joint) in joints.iter().enumerate() {
        let mut bone = Bone::at(&joint.name, joint.parent, Vec3::from(joint.offset) * unit);
        // The turn about x comes first, and is next to the bone.
        for axis in [2, 1, 0] {
            let mut freedom = Freedom::new(FreedomKind::Turn(Vec3::UNITS[axis]));
            freedom.range = range(joint, axis, warnings);
            freedom.default[0] = freedom.range.nearest(joint.pose[axis]);
            if freedom.default[0] != joint.pose[axis] {
                warnings.add("skel/pose", || {
                    let message = format!(
                        "the pose of `{}` is outside of its limits about {}: it is brought to {}",
                        joint.name,
                        ["x", "y", "z"][axis],
                        freedom.default[0]
                    );
                    Diagnostic::note("skel/pose", message)
                });
            }
            bone.freedoms.push(freedom);
        }
        skeleton.bones.push(bone);
        let (low, high) = (Vec3::from(joint.low) * unit, Vec3::from(joint.high) * unit);
        let size = Vec3::from((high - low).to_array().map(f64::abs));
        let thin = size.to_array().into_iter().any(|side| side < 1e-9);
        if !thin {
            let block = Block { at: (low + high) * 0.5, size, turn: Mat3::IDENTITY };
            skeleton.shapes.push((index, Form::Block(block)));
        }
    }
    skeleton
}

fn range(joint: &Joint, axis: usize, warnings: &mut Warnings) -> Range {
    let Some([mut low, mut high]) = joint.limits[axis] else { return Range::FREE };
    if low > high {
        warnings.add("skel/limit", || {
            let message = format!("a limit of `{}` is from {low} to {high}", joint.name);
            let said = Diagnostic::warning("skel/limit", message);
            said.with_help("it is taken the other way round")
        });
        (low, high) = (high, low);
    }
    let lower = Some(low).filter(|low| *low > -NO_LIMIT);
    let upper = Some(high).filter(|high| *high < NO_LIMIT);
    Range { lower, upper, enforced: lower.is_some() || upper.is_some() }
}
