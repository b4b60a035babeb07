//! Left against right.
//!
//! Sides are recognised by names: `knee_r` and `knee_l`, `r_knee`, `RightKnee`, `knee.R`. A body is
//! mirrored in a plane of its segments' own frames, mostly the one across the third axis; the plane
//! that fits most pairs is taken, and where none fits most of them nothing is said about places and
//! axes. A mirrored axis of rotation is turned over as well, so that an equal angle is an equal
//! posture; a coordinate whose axis is not turned over counts backwards, and so should its range.

use super::{Inspected, finding, length, real_range};
use condyle_diagnostics::{Diagnostic, Severity, Subject};
use condyle_math::Vec3;
use condyle_model::{CoordinateId, CoordinateKind, Jacobian, Model, Pose, SegmentId, UpAxis};
use std::collections::HashMap;

/// The joints of a scaled subject may well differ by a few millimetres.
const PLACES_DIFFER: f64 = 5e-3;

/// Ranges that differ by less than this differ by rounding only.
const RANGES_DIFFER: f64 = 2e-3;

/// In degrees; small, as axes are copied from side to side, not measured.
const AXES_DIFFER: f64 = 1.0;

pub(super) fn check(subject: &Inspected<'_>, findings: &mut Vec<Diagnostic>) {
    let model = subject.model;
    let names: Vec<&str> = model.segments().iter().map(|s| s.name.as_str()).collect();
    let ids: Vec<SegmentId> = model.segment_ids().collect();
    let (pairs, alone) = paired(&names);
    // Where one side has a parent that the other lacks, their positions cannot be compared.
    let segments: Vec<[SegmentId; 2]> = pairs
        .iter()
        .map(|&[r, l]| [ids[r], ids[l]])
        .filter(|&pair| alike_parents(model, pair))
        .collect();
    let (coordinates, alone_too) = coordinate_pairs(model);
    missing(pairs.len(), &alone, ("segment", Subject::Segment), findings);
    let keys: Vec<&str> = alone_too.iter().map(|id| subject.keys[id.index()].as_str()).collect();
    missing(coordinates.len(), &keys, ("coordinate", Subject::Coordinate), findings);
    let motions = Motions::new(subject);
    let senses = match motions.plane(&segments) {
        Some(plane) => {
            motions.places(plane, &segments, findings);
            motions.axes(plane, &coordinates, findings)
        }
        None => {
            motions.one_side(&segments, findings);
            vec![None; coordinates.len()]
        }
    };
    backwards(subject, &coordinates, &senses, findings);
    for (&pair, sense) in coordinates.iter().zip(&senses) {
        findings.extend(ranges(subject, pair, *sense));
    }
    defaults(subject, &coordinates, &senses, findings);
}

/// The words for the sides, right ones first.
const SIDES: [[&str; 2]; 5] =
    [["r", "l"], ["R", "L"], ["right", "left"], ["Right", "Left"], ["RIGHT", "LEFT"]];

/// Whether a name belongs to the right side, and the name on the other; none without a side.
pub(super) fn mirrored(name: &str) -> Option<(bool, String)> {
    let mut right = None;
    let mut text = String::with_capacity(name.len());
    for piece in name.split_inclusive(['_', '.', '-', ' ', '/']) {
        let word = piece.trim_end_matches(['_', '.', '-', ' ', '/']);
        let found = SIDES.iter().find_map(|side| {
            let own = side.iter().position(|s| *s == word)?;
            Some((own == 0, side[1 - own]))
        });
        match found {
            Some((own, other)) if right.is_none_or(|known| known == own) => {
                right = Some(own);
                text.push_str(other);
                text.push_str(&piece[word.len()..]);
            }
            // A name with both sides belongs to neither.
            Some(_) => return None,
            None => text.push_str(piece),
        }
    }
    if let Some(right) = right {
        return Some((right, text));
    }
    for [own, other] in [["Right", "Left"], ["right", "left"]] {
        if name.contains(own) != name.contains(other) {
            let right = name.contains(own);
            let (from, to) = if right { (own, other) } else { (other, own) };
            return Some((right, name.replacen(from, to, 1)));
        }
    }
    None
}

/// Positions of right and left, and names whose other side is missing.
fn paired<'n>(names: &[&'n str]) -> (Vec<[usize; 2]>, Vec<&'n str>) {
    let at: HashMap<&str, usize> = names.iter().enumerate().map(|(i, n)| (*n, i)).collect();
    let (mut pairs, mut alone) = (vec![], vec![]);
    for (index, name) in names.iter().enumerate() {
        let Some((right, other)) = mirrored(name) else { continue };
        match at.get(other.as_str()) {
            Some(&left) if right => pairs.push([index, left]),
            Some(_) => {}
            None => alone.push(*name),
        }
    }
    (pairs, alone)
}

/// As [`paired`], by joint set and name, or by name alone where the joint set has no side.
fn coordinate_pairs(model: &Model) -> (Vec<[CoordinateId; 2]>, Vec<CoordinateId>) {
    let set = |id: CoordinateId| &model.joint_sets()[model.coordinate(id).joint_set.index()].name;
    let full: HashMap<String, CoordinateId> = model
        .coordinate_ids()
        .map(|id| (format!("{}/{}", set(id), model.coordinate(id).name), id))
        .collect();
    let bare: HashMap<&str, CoordinateId> =
        model.coordinate_ids().map(|id| (model.coordinate(id).name.as_str(), id)).collect();
    let (mut pairs, mut alone) = (vec![], vec![]);
    for id in model.coordinate_ids() {
        let name = &model.coordinate(id).name;
        let by_name = mirrored(name);
        let whole = mirrored(&format!("{}/{name}", set(id)));
        let Some(right) = by_name.as_ref().or(whole.as_ref()).map(|(right, _)| *right) else {
            continue;
        };
        let other = whole.and_then(|(_, name)| full.get(&name));
        let other = other.or_else(|| by_name.and_then(|(_, name)| bare.get(name.as_str())));
        match other {
            Some(&left) if right => pairs.push([id, left]),
            Some(_) => {}
            None => alone.push(id),
        }
    }
    (pairs, alone)
}

/// Whether two segments have the same parent, or parents that form a pair.
fn alike_parents(model: &Model, pair: [SegmentId; 2]) -> bool {
    let [r, l] = pair.map(|id| model.segment(id).parent);
    let name = |id: Option<SegmentId>| id.map(|id| model.segment(id).name.as_str());
    r == l || name(r).and_then(mirrored).map(|(_, other)| other).as_deref() == name(l)
}

/// Names without their other side, in a model that otherwise has both.
fn missing(
    pairs: usize,
    alone: &[&str],
    (what, subject): (&str, fn(String) -> Subject),
    findings: &mut Vec<Diagnostic>,
) {
    if alone.is_empty() || pairs < 3 * alone.len() {
        return;
    }
    let names: Vec<String> = alone.iter().map(|&name| name.to_owned()).collect();
    let (s, has) = if names.len() == 1 { ("", "has") } else { ("s", "have") };
    findings.push(finding(
        Severity::Note,
        "lint/side-missing",
        names.iter().cloned().map(subject),
        format!(
            "{what}{s} {} {has} no counterpart on the other side, unlike {pairs} pairs",
            super::listed(&names)
        ),
        "is a name misspelt, or is this side modelled in more detail?",
    ));
}

/// Position and motion of segments in their parents when every coordinate is 0.
struct Motions<'s> {
    subject: &'s Inspected<'s>,
    pose: Pose,
    jacobian: Jacobian,
}

/// A vector mirrored along one axis.
fn reflected(v: Vec3, plane: usize) -> Vec3 {
    let mut v = v.to_array();
    v[plane] = -v[plane];
    Vec3::from(v)
}

impl<'s> Motions<'s> {
    fn new(subject: &'s Inspected<'s>) -> Self {
        let mut pose = Pose::new(&subject.program);
        let mut jacobian = Jacobian::new(&subject.program);
        let mut zero = subject.model.defaults();
        for id in subject.model.coordinate_ids() {
            if subject.kind(id) != CoordinateKind::Orientation {
                zero[subject.model.stored_range(id)].fill(0.0);
            }
        }
        // The buffers are made for this program.
        let _ = subject.program.evaluate_with_jacobian(&zero, &mut pose, &mut jacobian);
        Self { subject, pose, jacobian }
    }

    /// A segment's origin in its parent.
    fn place(&self, id: SegmentId) -> Vec3 {
        let parent = self.pose.frame(self.subject.model.segment(id).parent);
        let gap = self.pose.segment(id).translation - parent.translation;
        parent.linear.transpose() * gap
    }

    /// The axis normal to the mirror plane, if one plane fits most pairs.
    fn plane(&self, pairs: &[[SegmentId; 2]]) -> Option<usize> {
        let misfit = |plane: usize| -> f64 {
            let gap = |&[r, l]: &[SegmentId; 2]| {
                (reflected(self.place(r), plane) - self.place(l)).norm().min(0.1)
            };
            pairs.iter().map(gap).sum()
        };
        // The third axis first: OpenSim's right.
        let best = [2, 0, 1].into_iter().min_by(|&a, &b| misfit(a).total_cmp(&misfit(b)))?;
        let fits = pairs.iter().filter(|pair| self.misplaced(best, **pair).is_none()).count();
        (2 * fits > pairs.len()).then_some(best)
    }

    /// The distance of the left joint from the mirror image of the right one, if it matters.
    fn misplaced(&self, plane: usize, [right, left]: [SegmentId; 2]) -> Option<f64> {
        let (r, l) = (self.place(right), self.place(left));
        let gap = (reflected(r, plane) - l).norm();
        (gap > PLACES_DIFFER.max(0.05 * r.norm())).then_some(gap)
    }

    /// Pairs on the same parent at the same place, away from the middle, where no plane is known.
    fn one_side(&self, pairs: &[[SegmentId; 2]], findings: &mut Vec<Diagnostic>) {
        let model = self.subject.model;
        // The lateral axis of a body that stands: z where y is up, y where z is.
        let lateral = match model.up() {
            UpAxis::Y => 2,
            UpAxis::Z => 1,
        };
        for &[right, left] in pairs {
            let (r, l) = (self.place(right), self.place(left));
            let same_parent = model.segment(right).parent == model.segment(left).parent;
            if !same_parent || (r - l).norm() > 1e-3 || r.to_array()[lateral].abs() < 0.01 {
                continue;
            }
            let names = [right, left].map(|id| model.segment(id).name.clone());
            findings.push(finding(
                Severity::Warning,
                "lint/same-side",
                names.clone().map(Subject::Segment),
                format!(
                    "the joints of `{}` and `{}` are at the same place in their parent, both on one side",
                    names[0], names[1]
                ),
                "reverse the sign of the lateral coordinate of the left one",
            ));
        }
    }

    fn places(&self, plane: usize, pairs: &[[SegmentId; 2]], findings: &mut Vec<Diagnostic>) {
        let name = |id: SegmentId| self.subject.model.segment(id).name.clone();
        let mut differ: Vec<(f64, String)> = vec![];
        for &[right, left] in pairs {
            let Some(gap) = self.misplaced(plane, [right, left]) else { continue };
            let same = (self.place(right) - self.place(left)).norm() < 1e-3;
            if !same || gap < 0.01 {
                differ.push((gap, name(left)));
                continue;
            }
            findings.push(finding(
                Severity::Warning,
                "lint/same-side",
                [name(right), name(left)].map(Subject::Segment),
                format!(
                    "the joints of `{}` and `{}` are at the same place in their parents: the left \
                     one is {} from the mirror of the right one",
                    name(right),
                    name(left),
                    length(gap)
                ),
                "reverse the sign of the lateral coordinate",
            ));
        }
        differ.sort_by(|a, b| b.0.total_cmp(&a.0));
        let Some((most, worst)) = differ.first() else { return };
        findings.push(finding(
            Severity::Note,
            "lint/uneven-places",
            differ.iter().map(|(_, name)| Subject::Segment(name.clone())),
            format!(
                "{} of {} joints are not the mirror image of the other side's; the largest difference is that \
                 of `{worst}`, by {}",
                differ.len(),
                pairs.len(),
                length(*most)
            ),
            "a subject may be asymmetric; a generic model should not be",
        ));
    }

    /// Unit direction of a coordinate in its parent: of its rotation axis or of its translation.
    fn direction(&self, id: CoordinateId) -> Option<Vec3> {
        let model = self.subject.model;
        let coordinate = model.coordinate(id);
        let along = model.tangent_range(id).start as u32;
        let moved = model.segment_ids().find(|&s| {
            model.segment(s).joint_set == Some(coordinate.joint_set)
                && self.subject.program.segment_directions(s).iter().any(|(d, _)| *d == along)
        })?;
        let parent = model.segment(moved).parent;
        let velocity = |segment: SegmentId| {
            let directions = self.subject.program.segment_directions(segment);
            let twist = directions.iter().find(|(d, _)| *d == along)?.1;
            let twist = self.jacobian.twist(twist);
            let here = self.pose.segment(moved).translation;
            Some((twist.angular, twist.velocity_at(here)))
        };
        let (mut angular, mut linear) = velocity(moved)?;
        if let Some((a, l)) = parent.and_then(velocity) {
            (angular, linear) = (angular - a, linear - l);
        }
        let v = if coordinate.kind == CoordinateKind::Translation { linear } else { angular };
        let v = self.pose.frame(parent).linear.transpose() * v;
        (v.norm() > 1e-6).then(|| v.normalized())
    }

    /// For each pair whether the left coordinate counts the same way; `None` where it is unknown.
    fn axes(
        &self,
        plane: usize,
        pairs: &[[CoordinateId; 2]],
        findings: &mut Vec<Diagnostic>,
    ) -> Vec<Option<bool>> {
        let mut odd = vec![];
        let senses: Vec<Option<bool>> = pairs
            .iter()
            .map(|&[right, left]| {
                let kind = self.subject.kind(right);
                if kind != self.subject.kind(left) || kind == CoordinateKind::Orientation {
                    return None;
                }
                let mirror = reflected(self.direction(right)?, plane);
                let expected = if kind == CoordinateKind::Translation { mirror } else { -mirror };
                let found = self.direction(left)?;
                let (along, across) = (expected.dot(found), expected.cross(found).norm());
                let angle = across.atan2(along.abs()).to_degrees();
                if angle > AXES_DIFFER {
                    odd.push((right, left, angle));
                    return None;
                }
                Some(along > 0.0)
            })
            .collect();
        // Where most axes are not mirror images, the frames are not either: nothing is known.
        let known = senses.iter().filter(|sense| sense.is_some()).count();
        if known < 2 * odd.len() {
            return vec![None; pairs.len()];
        }
        for (right, left, angle) in odd {
            let (right, left) = (self.subject.key(right), self.subject.key(left));
            findings.push(finding(
                Severity::Warning,
                "lint/uneven-axes",
                [right.clone(), left.clone()].map(Subject::Coordinate),
                format!(
                    "the axes of `{right}` and `{left}` are not mirror images: {}° apart",
                    super::rounded(angle, 2)
                ),
                "mirror the axis: often a sign is missing",
            ));
        }
        senses
    }
}

fn ranges(
    subject: &Inspected<'_>,
    [right, left]: [CoordinateId; 2],
    sense: Option<bool>,
) -> Option<Diagnostic> {
    let (r, l) = (real_range(subject.model, right)?, real_range(subject.model, left)?);
    if subject.kind(right) != subject.kind(left) {
        return None;
    }
    let near = |a: (f64, f64), b: (f64, f64)| {
        (a.0 - b.0).abs() <= RANGES_DIFFER && (a.1 - b.1).abs() <= RANGES_DIFFER
    };
    let same = near(r, l);
    let negated = near((-r.1, -r.0), l);
    let good = match sense {
        Some(true) => same,
        Some(false) => negated,
        None => same || negated,
    };
    if good {
        return None;
    }
    let range = |id: CoordinateId, (lower, upper): (f64, f64)| {
        format!(
            "`{}` {} to {}",
            subject.key(id),
            subject.shown(id, lower),
            subject.shown(id, upper)
        )
    };
    let both = format!("{}, {}", range(right, r), range(left, l));
    let message = match sense {
        Some(true) if negated => {
            format!("{both}: negated, although their axes are mirrored already")
        }
        Some(false) if same => format!("{both}: equal, although their signs are opposite"),
        _ => format!("{both}: the sides have different ranges"),
    };
    let enforced = [right, left].iter().any(|&id| subject.model.coordinate(id).range.enforced);
    Some(finding(
        if enforced { Severity::Warning } else { Severity::Note },
        "lint/uneven-ranges",
        [subject.key(right), subject.key(left)].map(Subject::Coordinate),
        message,
        "give both sides the same range, unless they were measured on a subject",
    ))
}

/// Left coordinates that count the other way than their mirror image, beside others that do not.
fn backwards(
    subject: &Inspected<'_>,
    pairs: &[[CoordinateId; 2]],
    senses: &[Option<bool>],
    findings: &mut Vec<Diagnostic>,
) {
    let rotations = || {
        let known = pairs.iter().zip(senses).filter_map(|(pair, sense)| Some((pair, (*sense)?)));
        known.filter(|(pair, _)| subject.kind(pair[0]) == CoordinateKind::Rotation)
    };
    // Where every axis counts alike on both sides of the world, that is how the model was made.
    if !rotations().any(|(_, sense)| sense) {
        return;
    }
    // Ranges say what is meant, unless they reach equally far to both sides; they have a rule of their own.
    let meant = |&[right, left]: &[CoordinateId; 2]| {
        let ranges = [right, left].map(|id| real_range(subject.model, id));
        ranges
            .iter()
            .all(|range| range.is_some_and(|(low, high)| (low + high).abs() > RANGES_DIFFER))
    };
    let odd: Vec<String> = rotations()
        .filter(|(pair, sense)| !sense && !meant(pair))
        .map(|(pair, _)| subject.key(pair[1]))
        .collect();
    if odd.is_empty() {
        return;
    }
    findings.push(finding(
        Severity::Warning,
        "lint/not-mirrored",
        odd.iter().cloned().map(Subject::Coordinate),
        format!(
            "the left side is no mirror image of the right: {} turn{} to the same side of the body as on the \
             right, not inward or outward alike",
            super::listed(&odd),
            if odd.len() == 1 { "s" } else { "" }
        ),
        "turn the axis over on the left (a mirrored axis of rotation is -D times the right one), or let \
         `mirror` write that side",
    ));
}

/// One note about all defaults that differ: the default pose may be in mid-stride.
fn defaults(
    subject: &Inspected<'_>,
    pairs: &[[CoordinateId; 2]],
    senses: &[Option<bool>],
    findings: &mut Vec<Diagnostic>,
) {
    let mut differ: Vec<(f64, String)> = vec![];
    for (&[right, left], sense) in pairs.iter().zip(senses) {
        let [r, l] = [right, left].map(|id| subject.model.coordinate(id));
        let kind = r.kind;
        if r.follows.is_some() || kind != l.kind || kind == CoordinateKind::Orientation {
            continue;
        }
        let (same, negated) =
            ((r.default[0] - l.default[0]).abs(), (r.default[0] + l.default[0]).abs());
        let gap = match sense {
            Some(true) => same,
            Some(false) => negated,
            None => same.min(negated),
        };
        let visible = if kind == CoordinateKind::Translation { 1e-3 } else { 1f64.to_radians() };
        if gap > visible {
            let text = format!(
                "`{}` {}, `{}` {}",
                subject.key(right),
                subject.shown(right, r.default[0]),
                subject.key(left),
                subject.shown(left, l.default[0])
            );
            differ.push((gap / visible, text));
        }
    }
    differ.sort_by(|a, b| b.0.total_cmp(&a.0));
    let Some((_, worst)) = differ.first() else { return };
    findings.push(finding(
        Severity::Note,
        "lint/uneven-defaults",
        [],
        format!(
            "{} of {} defaults differ from side to side; the largest difference is {worst}",
            differ.len(),
            pairs.len()
        ),
        "correct for a model whose default posture is a stride; otherwise make them equal",
    ));
}

#[cfg(test)]
mod tests {
    use super::mirrored;

    #[test]
    fn sides_are_words_of_a_name() {
        let cases = [
            ("knee_angle_r", Some((true, "knee_angle_l"))),
            ("knee_angle_r_beta", Some((true, "knee_angle_l_beta"))),
            ("thigh.L", Some((false, "thigh.R"))),
            ("l_knee", Some((false, "r_knee"))),
            ("RightUpLeg", Some((true, "LeftUpLeg"))),
            ("left_hip/flexion", Some((false, "right_hip/flexion"))),
            ("hip_r/flexion_r", Some((true, "hip_l/flexion_l"))),
            ("humerus", None),
            ("lumbar", None),
            ("r_to_l", None),
        ];
        for (name, expected) in cases {
            let found = mirrored(name);
            let found = found.as_ref().map(|(right, other)| (*right, other.as_str()));
            assert_eq!(found, expected, "{name}");
        }
    }
}
