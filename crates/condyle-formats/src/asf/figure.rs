//! From a written skeleton to a model.

use super::read::{self, Order, Token, Written};
use crate::skeleton::{
    Assumed, Bone, Freedom, FreedomKind, Skeleton, facing_of, length_unit, up_of,
};
use crate::text::decode;
use condyle_diagnostics::{Diagnostic, Error, Read, Warnings, listed};
use condyle_math::{Affine, Mat3, Vec3};
use condyle_model::model::Facing;
use condyle_model::{Model, Range, UpAxis};
use std::collections::HashMap;

/// The `length` of the Carnegie Mellon recordings: their unit is 1/0.45 inch.
const CMU_LENGTH: f64 = 0.45;

/// A model, and where a take's numbers go.
#[derive(Debug)]
pub(super) struct Figure {
    pub(super) model: Model,
    /// Of each bone by its name in lower case: for each of its tokens the place among the stored numbers,
    /// and whether it is an angle.
    pub(super) places: HashMap<String, Vec<Option<(usize, bool)>>>,
    /// The names of the bones as they are written, the root first, each after its parent.
    pub(super) order: Vec<String>,
    /// Metres in a unit of length.
    pub(super) unit: f64,
    pub(super) degrees: bool,
    /// The root's position, which is added to what the take says.
    pub(super) position: Vec3,
    /// Where the root's steps are stored, along x, y and z.
    pub(super) steps: Vec<(usize, usize)>,
}

/// Reads an ASF file: a model at rest, with the limits of its joints.
///
/// # Errors
/// `asf/empty`, `asf/grammar` and `asf/number` with their places, `asf/size` of what no program writes; what
/// [`decode`] refuses.
///
/// ```
/// use condyle_formats::{asf, skeleton::Assumed};
/// let text = ":units\n length 0.45\n angle deg\n:root\n order TX TY TZ RX RY RZ\n position 0 17 0\n\
///     :bonedata\n begin\n name femur\n direction 0 -1 0\n length 7\n axis 0 0 20 XYZ\n dof rx\n\
///     limits (-20 160)\n end\n:hierarchy\n begin\n root femur\n end\n";
/// let model = asf::read(text.as_bytes(), &Assumed::default())?.value;
/// let femur = model.coordinate_ids().last().unwrap();
/// assert_eq!(model.coordinate_key(femur), "femur/rx");
/// assert_eq!(model.coordinate(femur).range.upper, Some(160f64.to_radians()));
/// # Ok::<(), condyle_formats::Error>(())
/// ```
pub fn read(bytes: &[u8], assumed: &Assumed) -> Result<Read<Model>, Error> {
    Ok(figure(bytes, assumed)?.map(|figure| figure.model))
}

/// The rotation of three angles, the first axis of the order first, about fixed axes.
fn turn(angles: [f64; 3], order: Order, factor: f64) -> Mat3 {
    order.iter().fold(Mat3::IDENTITY, |before, axis| {
        let angle = angles[*axis] * factor;
        let own = match axis {
            0 => Mat3::rotation_x(angle),
            1 => Mat3::rotation_y(angle),
            _ => Mat3::rotation_z(angle),
        };
        own * before
    })
}

pub(super) fn figure(bytes: &[u8], assumed: &Assumed) -> Result<Read<Figure>, Error> {
    let decoded = decode(bytes)?;
    let mut warnings = Warnings::default();
    warnings.extend(decoded.warnings);
    let written = read::read(&decoded.value, &mut warnings)?;
    let factor = if written.degrees { 1f64.to_radians() } else { 1.0 };
    let tree = tree(&written, &mut warnings)?;
    let mut skeleton = bones(&written, &tree, factor, &mut warnings);
    let known = written.length.filter(|length| (length - CMU_LENGTH).abs() < 1e-9);
    let unit = match (assumed.metres_per_unit, known) {
        (None, Some(length)) => 0.0254 / length,
        _ => length_unit(&skeleton, assumed, &mut warnings),
    };
    scale(&mut skeleton, unit);
    let rest = skeleton.rest();
    let points: Vec<(&str, Vec3)> = rest.iter().map(|(name, at, _)| (*name, *at)).collect();
    let up = assumed.up.or_else(|| up_of(&points)).unwrap_or(UpAxis::Y);
    let facing = facing_of(&points, up).unwrap_or(Facing::PlusZ);
    (skeleton.up, skeleton.facing) = (up, facing);
    skeleton.name.clone_from(&written.name);
    let read = skeleton.build()?;
    warnings.extend(read.warnings);
    let (places, steps) = places(&written, &tree);
    let figure = Figure {
        model: read.value,
        places,
        order: tree.iter().map(|(bone, _)| written_of(&written, *bone).name.clone()).collect(),
        unit,
        degrees: written.degrees,
        position: Vec3::from(written.root.direction) * unit,
        steps,
    };
    Ok(Read { value: figure, warnings: warnings.finish() })
}

/// The bones that hang together, each after its parent: bone (none for the root) and position of the parent
/// in this list.
type Tree = Vec<(Option<usize>, Option<usize>)>;

fn tree(written: &read::Skeleton, warnings: &mut Warnings) -> Result<Tree, Error> {
    let mut ids: HashMap<String, Option<usize>> = HashMap::new();
    ids.insert("root".to_owned(), None);
    for (index, bone) in written.bones.iter().enumerate() {
        if bone.name.is_empty() {
            let message = "a bone has no name";
            return Err(Error::new("asf/grammar", message).at(bone.place));
        }
        if ids.insert(bone.name.to_ascii_lowercase(), Some(index)).is_some() {
            let message = format!("two bones are called `{}`", bone.name);
            return Err(Error::new("asf/name", message).at(bone.place));
        }
    }
    let mut children: HashMap<Option<usize>, Vec<usize>> = HashMap::new();
    let mut has_parent = vec![false; written.bones.len()];
    for (parent, child, place) in &written.hierarchy {
        let find = |name: &String| ids.get(&name.to_ascii_lowercase()).copied();
        let (Some(parent), Some(Some(child))) = (find(parent), find(child)) else {
            warnings.add("asf/hierarchy", || {
                let message = format!("`{parent:.40}` or `{child:.40}` is no bone");
                let help = "this line of the hierarchy is left out";
                Diagnostic::warning("asf/hierarchy", message).at(*place).with_help(help)
            });
            continue;
        };
        if std::mem::replace(&mut has_parent[child], true) {
            let message = format!("`{}` hangs on two bones", written.bones[child].name);
            return Err(Error::new("asf/hierarchy", message).at(*place));
        }
        children.entry(parent).or_default().push(child);
    }
    let mut tree: Tree = vec![];
    let mut open: Vec<(Option<usize>, Option<usize>)> = vec![(None, None)];
    while let Some((bone, parent)) = open.pop() {
        tree.push((bone, parent));
        let own = tree.len() - 1;
        let hanging = children.get(&bone).into_iter().flatten().rev();
        open.extend(hanging.map(|child| (Some(*child), Some(own))));
    }
    if tree.len() <= written.bones.len() {
        let mut hangs = vec![false; written.bones.len()];
        tree.iter().filter_map(|(bone, _)| *bone).for_each(|bone| hangs[bone] = true);
        let alone = written.bones.iter().zip(hangs).filter(|(_, hangs)| !hangs);
        let names: Vec<&str> = alone.map(|(bone, _)| bone.name.as_str()).collect();
        let message = format!("nothing joins {} to the root", listed(&names));
        let said = Diagnostic::warning("asf/alone", message);
        warnings.push(said.with_help("these bones are left out"));
    }
    Ok(tree)
}

/// The tokens of a bone, root or not.
fn written_of(written: &read::Skeleton, bone: Option<usize>) -> &Written {
    bone.and_then(|bone| written.bones.get(bone)).unwrap_or(&written.root)
}

/// A token and its position among those of its bone.
type Numbered = (usize, Token);

/// The tokens of a bone in the order of its coordinates: steps first, then turns from the last to the first;
/// a length by itself.
fn coordinates(bone: &Written) -> (Vec<Numbered>, Option<usize>) {
    let all = bone.tokens.iter().copied().enumerate();
    let steps = all.clone().filter(|(_, token)| matches!(token, Token::Move(_)));
    let turns = all.clone().rev().filter(|(_, token)| matches!(token, Token::Turn(_)));
    let length = all.clone().find(|(_, token)| *token == Token::Length);
    (steps.chain(turns).collect(), length.map(|(index, _)| index))
}

/// The skeleton in the units of the file; bones of variable length have their end as a bone of its own.
fn bones(written: &read::Skeleton, tree: &Tree, factor: f64, warnings: &mut Warnings) -> Skeleton {
    // Where the children of each bone hang: the bone of the skeleton, and the place there.
    let mut ends: Vec<(usize, Vec3)> = Vec::with_capacity(tree.len());
    let mut has_child = vec![false; tree.len()];
    tree.iter().filter_map(|(_, parent)| *parent).for_each(|parent| has_child[parent] = true);
    let mut bones: Vec<Bone> = Vec::with_capacity(tree.len());
    for (index, (bone, parent)) in tree.iter().enumerate() {
        let source = written_of(written, *bone);
        let (parent, at) = match parent.and_then(|parent| ends.get(parent)) {
            Some((parent, at)) => (Some(*parent), *at),
            None => (None, Vec3::ZERO),
        };
        let axes = Affine::from_rotation(turn(source.axis, source.order, factor));
        if parent.is_none() && source.axis != [0.0; 3] {
            let message = "the root is oriented at rest, which programs read differently";
            let help = "it turns about the axes that its orientation gives, as bones do";
            warnings.push(Diagnostic::warning("asf/root", message).with_help(help));
        }
        let mut own = Bone::at(&source.name, parent, at);
        own.joint_in_parent = Affine::new(axes.linear, at);
        own.joint_in_segment = axes;
        let (tokens, length) = coordinates(source);
        check_limits(source, warnings);
        for (number, token) in tokens {
            let (kind, scale) = match token {
                Token::Move(axis) => (FreedomKind::Move(Vec3::UNITS[axis]), 1.0),
                Token::Turn(axis) => (FreedomKind::Turn(Vec3::UNITS[axis]), factor),
                Token::Length => continue,
            };
            let mut freedom = Freedom::new(kind);
            freedom.range = range(source, number, scale);
            if parent.is_none()
                && let Token::Move(axis) = token
            {
                freedom.default[0] = source.direction[axis];
            }
            own.freedoms.push(freedom);
        }
        if parent.is_none() {
            // The root's position is in the steps; along others it is fixed.
            let fixed: [f64; 3] = std::array::from_fn(|axis| {
                let moves = source.tokens.contains(&Token::Move(axis));
                if moves { 0.0 } else { source.direction[axis] }
            });
            own.joint_in_parent.translation = fixed.into();
        }
        bones.push(own);
        let mut end = (bones.len() - 1, Vec3::ZERO);
        if bone.is_some() {
            let direction = direction(source, warnings);
            end.1 = direction * source.length;
            if let Some(number) = length {
                let mut tip = Bone::at(&format!("{}_tip", source.name), Some(end.0), end.1);
                let kind = FreedomKind::Move(direction);
                let range = range(source, number, 1.0);
                tip.freedoms = vec![Freedom { name: "l".into(), range, ..Freedom::new(kind) }];
                bones.push(tip);
                end = (bones.len() - 1, Vec3::ZERO);
            }
            if !has_child[index]
                && let Some(last) = bones.last_mut()
            {
                last.ends.push((format!("{}_end", source.name), end.1));
            }
        }
        ends.push(end);
    }
    Skeleton { bones, ..Skeleton::default() }
}

fn direction(source: &Written, warnings: &mut Warnings) -> Vec3 {
    let written = Vec3::from(source.direction);
    let norm = written.norm();
    // Directions have six digits.
    if (norm - 1.0).abs() < 1e-3 || source.length == 0.0 {
        return written;
    }
    warnings.add("asf/direction", || {
        let message = format!("the direction of `{}` has the length {norm}", source.name);
        let said = Diagnostic::warning("asf/direction", message).at(source.place);
        said.with_help("it is made 1")
    });
    if norm > 1e-9 { written * (1.0 / norm) } else { Vec3::Y }
}

fn range(source: &Written, number: usize, factor: f64) -> Range {
    let end = |place: usize| {
        let limit = source.limits.get(place).copied().filter(|limit| limit.is_finite());
        limit.map(|limit| limit * factor)
    };
    let (lower, upper) = (end(2 * number), end(2 * number + 1));
    match (lower, upper) {
        (Some(low), Some(high)) if low > high => {
            Range { lower: upper, upper: lower, enforced: false }
        }
        _ => Range { lower, upper, enforced: false },
    }
}

fn check_limits(source: &Written, warnings: &mut Warnings) {
    let (pairs, tokens) = (source.limits.len(), source.tokens.len());
    if pairs > 0 && pairs != 2 * tokens {
        warnings.add("asf/limits", || {
            let message = format!(
                "`{}` has {pairs} limits of {tokens} degrees of freedom: two are needed for each",
                source.name
            );
            Diagnostic::warning("asf/limits", message).at(source.place)
        });
    }
}

/// Brings lengths to metres.
fn scale(skeleton: &mut Skeleton, unit: f64) {
    for bone in &mut skeleton.bones {
        bone.joint_in_parent.translation = bone.joint_in_parent.translation * unit;
        bone.ends.iter_mut().for_each(|(_, end)| *end = *end * unit);
        let steps = bone.freedoms.iter_mut();
        for freedom in steps.filter(|f| matches!(f.kind, FreedomKind::Move(_))) {
            freedom.default[0] *= unit;
            for end in [&mut freedom.range.lower, &mut freedom.range.upper].into_iter().flatten() {
                *end *= unit;
            }
        }
    }
}

/// For each bone by name where the numbers of its tokens are stored, and the root's steps by axis.
#[allow(clippy::type_complexity, reason = "two tables of one walk")]
fn places(
    written: &read::Skeleton,
    tree: &Tree,
) -> (HashMap<String, Vec<Option<(usize, bool)>>>, Vec<(usize, usize)>) {
    let mut places = HashMap::new();
    let mut steps = vec![];
    let mut next = 0;
    for (bone, _) in tree {
        let source = written_of(written, *bone);
        let mut own = vec![None; source.tokens.len()];
        let (tokens, length) = coordinates(source);
        for (number, token) in tokens {
            own[number] = Some((next, matches!(token, Token::Turn(_))));
            if let (None, Token::Move(axis)) = (bone, token) {
                steps.push((next, axis));
            }
            next += 1;
        }
        if let (Some(number), Some(_)) = (length, bone) {
            own[number] = Some((next, false));
            next += 1;
        }
        // A second `l` of a bone is none.
        places.insert(source.name.to_ascii_lowercase(), own);
    }
    (places, steps)
}
