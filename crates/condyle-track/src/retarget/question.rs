//! What the target is asked for, frame by frame, and its solution.

use super::body::{Anchor, Part, Side};
use super::feet::Feet;
use super::sampled::{Sampled, middle, trunk};
use super::stance::{Stance, arc, unit};
use super::{Humanoid, Options, Posed, held};
use crate::answer::FrameAnswer;
use crate::target::rotation_of;
use crate::{
    DirectionTarget, FrameStatus, OrientationTarget, PlaceTarget, PostureTarget, Rules, Scratch,
    Targets, Tracker,
};
use condyle_math::{Mat3, Quat, Vec3};
use condyle_model::{CoordinateId, CoordinateKind, JointSetId, SegmentId};
use condyle_motion::Motion;
use std::collections::{BTreeMap, BTreeSet};

/// Weights, m² per rad² and per m²; lines have 1.
mod weight {
    /// A limb or trunk that points where it should.
    pub(super) const LINE: f64 = 1.0;
    /// A collar bone that turns as the source's does, from where it rests.
    pub(super) const GIRDLE: f64 = 0.3;
    /// A hand, finger or toe that does.
    pub(super) const SMALL: f64 = 0.1;
    /// Each rotation between chest and head: a hundredth of what the head weighs.
    pub(super) const NECK: f64 = 0.003;
    /// The middle between the hips: 10 cm off weigh as much as 0.1 rad of ten lines.
    pub(super) const MIDDLE: f64 = 10.0;
    /// Feet that stand; nearly exact.
    pub(super) const FOOT: f64 = 1000.0;
}

/// How much the orientation of a part weighs. That of limbs is weak: their lines are asked for, and how they
/// are turned about these follows from the joints beyond, where these are bent.
fn turn_weight(part: Part) -> f64 {
    match part {
        Part::Pelvis => 0.5,
        Part::Chest | Part::Head => 0.3,
        Part::Foot(_) => 0.2,
        Part::Hand(_) => 0.1,
        Part::Clavicle(_) => 0.01,
        Part::Neck | Part::UpperArm(_) | Part::Thigh(_) => 0.02,
        Part::Spine(_) => 0.02,
        Part::Shank(_) | Part::Toes(_) => 0.01,
        _ => 0.003,
    }
}

/// Frames on the way from rest to the first.
const LEAD: usize = 12;
/// A part that turns by more than this from one frame to the next (radians) is led there: recordings that begin with
/// a posture for calibration jump from it, and a neck that follows a head at once may wind up on the way.
const JUMP: f64 = 0.5;
/// On such a way no part turns by more in a step, radians.
const STRIDE: f64 = 0.2;

/// A frame jumps to another posture that the target could have if that is so much better.
const BETTER: f64 = 0.9;

/// What is solved one after the other: frames, and what leads to them.
enum Step {
    /// A frame of the motion.
    Frame(usize),
    /// Between a frame, or rest, and another one.
    Way { from: Option<usize>, to: usize, share: f64 },
}

/// A line that is asked for, and by which the result is measured.
pub(super) struct Line {
    pub name: String,
    pub from: Anchor,
    pub to: Anchor,
    pub weight: f64,
    pub wanted: Vec<Vec3>,
}

/// An orientation that is asked for.
pub(super) struct Turn {
    pub part: Part,
    pub segment: SegmentId,
    pub wanted: Vec<Quat>,
}

/// All that is asked for.
pub(super) struct Plan {
    pub lines: Vec<Line>,
    pub turns: Vec<Turn>,
    pub middle: Option<(Anchor, Vec<Vec3>)>,
    /// Rotations that share the way from chest to head.
    pub neck: Vec<CoordinateId>,
    /// Parts that only one of the two has.
    pub unmatched: [Vec<Part>; 2],
}

impl Plan {
    pub(super) fn new(
        source: Humanoid<'_>,
        target: Humanoid<'_>,
        from: &Stance,
        to: &Stance,
        sampled: &Sampled,
    ) -> Self {
        let mut plan = Self {
            lines: vec![],
            turns: vec![],
            middle: None,
            neck: vec![],
            unmatched: [vec![], vec![]],
        };
        let spine = interpolated(from, to, sampled);
        let mut wanted: BTreeMap<Part, Vec<Mat3>> = spine;
        for (part, anchor) in target.body.parts() {
            if let Some(turned) = sampled.turned.get(&part) {
                wanted.entry(part).or_insert_with(|| turned.clone());
            }
            let (Some(frames), Some(own)) = (wanted.get(&part), to.frames.get(&part)) else {
                continue;
            };
            let back = own.transpose();
            let turns: Vec<Quat> =
                frames.iter().map(|frame| Quat::from_mat3(*frame * back)).collect();
            if let Some(end) = target.body.end(part) {
                let start = target.body.start(part).unwrap_or(anchor);
                plan.line(target, part, [start, end], sampled, &turns, [from, to]);
            }
            plan.turns.push(Turn { part, segment: anchor.segment, wanted: turns });
        }
        plan.neck = neck_of_bones(target);
        if !plan.neck.is_empty() {
            plan.turns.retain(|turn| turn.part != Part::Neck);
        }
        let necks = [source, target].map(|figure| figure.body.get(Part::Neck).is_some());
        if let (Some((low, high)), Some(wanted)) =
            (trunk(target, necks[0] && necks[1]), sampled.trunk.clone())
        {
            let line =
                Line { name: "trunk".into(), from: low, to: high, weight: weight::LINE, wanted };
            if low.segment != high.segment {
                plan.lines.push(line);
            }
        }
        if let Some(anchor) = middle(target) {
            let (up, size) = (sampled.up, sampled.size);
            let place = |p: &Vec3| (*p - up * sampled.ankle) * size + up * to.ankle;
            plan.middle = Some((anchor, sampled.middle.iter().map(place).collect()));
        }
        let only = |a: Humanoid<'_>, b: Humanoid<'_>| {
            let own = a.body.parts().map(|(part, _)| part);
            let spine = |part: &Part| matches!(part, Part::Spine(_));
            own.filter(|part| b.body.get(*part).is_none() && !part.is_tip() && !spine(part))
                .collect()
        };
        plan.unmatched = [only(source, target), only(target, source)];
        plan
    }

    /// The line of a limb: where the source's points; a foot's where that of rest is turned to.
    fn line(
        &mut self,
        target: Humanoid<'_>,
        part: Part,
        [from, to]: [Anchor; 2],
        sampled: &Sampled,
        turns: &[Quat],
        stances: [&Stance; 2],
    ) {
        let weight = match part {
            Part::UpperArm(_)
            | Part::Forearm(_)
            | Part::Thigh(_)
            | Part::Shank(_)
            | Part::Foot(_) => weight::LINE,
            Part::Clavicle(_) => weight::GIRDLE,
            _ => weight::SMALL,
        };
        let at_rest = || {
            let mut posed = Posed::new(target.model);
            let pose = posed.at(&target.model.defaults()).ok()?;
            let along = to.placed(pose) - from.placed(pose);
            let axes = rotation_of(pose.segment(target.body.get(part)?.segment).linear);
            Some(axes.transpose() * along * (1.0 / along.norm().max(1e-12)))
        };
        let girdle = match part {
            Part::Clavicle(side) => girdle(side, sampled, stances),
            _ => None,
        };
        let wanted = match (part, sampled.lines.get(&part)) {
            _ if girdle.is_some() => girdle.unwrap_or_default(),
            (Part::Foot(_) | Part::Toes(_) | Part::Clavicle(_), _) => match at_rest() {
                Some(own) => turns.iter().map(|turn| turn.to_mat3() * own).collect(),
                None => return,
            },
            (_, Some(lines)) => lines.clone(),
            (_, None) => return,
        };
        self.lines.push(Line { name: part.name(), from, to, weight, wanted });
    }

    /// The target's motion, from the start's frames or from rest.
    ///
    /// A limb that is led against a limit may stay there when the way back is on the other side. So with limits the
    /// motion is solved without them first, and each frame is also tried from the nearest of that.
    pub(super) fn solve(
        &self,
        target: Humanoid<'_>,
        options: Options,
        feet: Option<&Feet>,
        start: Option<&Motion>,
        times: &[f64],
        progress: &mut dyn FnMut(),
    ) -> Motion {
        let open = Options { limits: false, ..options };
        let free = (options.limits && start.is_none())
            .then(|| self.solve(target, open, None, None, times, &mut || {}));
        let first = (!options.limits && start.is_none()).then(|| self.first(target)).flatten();
        let steps = self.steps(times.len(), start.is_some());
        let targets = self.targets(target, &steps, feet);
        let rules = Rules { limits: options.limits, tolerance: 1e-6 };
        let tracker = Tracker::new(target.model.with_locked(held::held(target)), targets, rules);
        let mut scratch = Scratch::new(&tracker);
        let mut answer = FrameAnswer::start(&tracker.defaults);
        let mut frames = Vec::with_capacity(times.len());
        for (frame, step) in steps.iter().enumerate() {
            if let Some(own) = start.and_then(|start| start.frames.get(frame)) {
                answer.coordinates.clone_from(own);
            }
            match (step, &first) {
                (Step::Way { from: None, .. }, Some(_)) => continue,
                (Step::Frame(0), Some(first)) => answer.coordinates.clone_from(first),
                _ => {}
            }
            let before = answer.minimised();
            tracker.descend(&mut scratch, &[], frame, &mut answer);
            // Without limits nothing is at a bound.
            tracker.cross_bounds(&mut scratch, &[], frame, &mut answer);
            if matches!(step, Step::Way { .. }) {
                let last = matches!(steps.get(frame + 1), Some(Step::Frame(_)));
                // Frames keep the names that the first one gives its postures.
                if last && tracker.rename(&mut answer.coordinates) {
                    tracker.descend(&mut scratch, &[], frame, &mut answer);
                }
                continue;
            }
            if let (Some(free), Step::Frame(of)) = (&free, step) {
                let mut other = FrameAnswer::start(&free.frames[*of]);
                tracker.rename(&mut other.coordinates);
                tracker.descend(&mut scratch, &[], frame, &mut other);
                // Three angles may name the free one's posture in a way that limits forbid.
                tracker.cross_bounds(&mut scratch, &[], frame, &mut other);
                if other.minimised() < BETTER * answer.minimised() {
                    answer = other;
                }
            }
            let lost = matches!(answer.status, FrameStatus::Uncertain | FrameStatus::Infeasible);
            if lost && answer.minimised() > 4.0 * before + 0.01 {
                let again = tracker.solve_anew(&mut scratch, &[], frame, 2);
                if tracker.replaces(&again, &answer) {
                    answer = again;
                }
            }
            frames.push(answer.coordinates.clone());
            progress();
        }
        Motion { times: times.to_vec(), frames }
    }

    /// The posture of the first frame within limits, by way from rest: where a motion without limits begins.
    ///
    /// From a posture in which an arm hangs it can be raised in either direction of its plane of elevation; an elevation
    /// below 0 fits as well, but not what a rhythm makes of it.
    fn first(&self, target: Humanoid<'_>) -> Option<Vec<f64>> {
        let steps = self.steps(1, false);
        let targets = self.targets(target, &steps, None);
        let rules = Rules { limits: true, tolerance: 1e-6 };
        let tracker = Tracker::new(target.model.with_locked(held::held(target)), targets, rules);
        let mut scratch = Scratch::new(&tracker);
        let mut answer = FrameAnswer::start(&tracker.defaults);
        for step in 0..steps.len() {
            tracker.descend(&mut scratch, &[], step, &mut answer);
            tracker.cross_bounds(&mut scratch, &[], step, &mut answer);
        }
        answer.coordinates.iter().all(|value| value.is_finite()).then_some(answer.coordinates)
    }

    /// All frames, with ways from rest and across jumps unless each has a start of its own.
    fn steps(&self, frames: usize, started: bool) -> Vec<Step> {
        if started {
            return (0..frames).map(Step::Frame).collect();
        }
        let mut steps = vec![];
        for to in 0..frames {
            let (from, count) = match to.checked_sub(1) {
                None => (None, LEAD),
                Some(from) => {
                    let turned = |turn: &Turn| match (turn.wanted.get(from), turn.wanted.get(to)) {
                        (Some(a), Some(b)) => a.angle_to(*b),
                        _ => 0.0,
                    };
                    let jump = self.turns.iter().map(turned).fold(0.0, f64::max);
                    let count = if jump > JUMP { (jump / STRIDE).ceil() as usize } else { 0 };
                    (Some(from), count)
                }
            };
            let share = |step: usize| (step + 1) as f64 / (count + 1) as f64;
            steps.extend((0..count).map(|step| Step::Way { from, to, share: share(step) }));
            steps.push(Step::Frame(to));
        }
        steps
    }

    fn targets(&self, target: Humanoid<'_>, steps: &[Step], feet: Option<&Feet>) -> Targets {
        let mut posed = Posed::new(target.model);
        let rest = posed.at(&target.model.defaults()).ok();
        let mut targets = Targets::default();
        for turn in &self.turns {
            let own =
                rest.map(|pose| Quat::from_mat3(rotation_of(pose.segment(turn.segment).linear)));
            let at = |frame: usize| turn.wanted.get(frame).copied();
            let wanted = steps.iter().map(|step| match step {
                Step::Frame(frame) => at(*frame),
                Step::Way { from, to, share } => {
                    let from = from.map_or(own, at)?;
                    Some(between(from, at(*to)?, *share))
                }
            });
            let wanted = wanted.collect();
            let weight = turn_weight(turn.part);
            targets.orientations.push(OrientationTarget { segment: turn.segment, weight, wanted });
        }
        for line in &self.lines {
            let wanted = steps.iter().map(|step| match step {
                Step::Frame(frame) => line.wanted.get(*frame).copied().filter(|d| d.is_finite()),
                Step::Way { .. } => None,
            });
            let end = |anchor: Anchor| (anchor.segment, anchor.point);
            targets.directions.push(DirectionTarget {
                from: end(line.from),
                to: end(line.to),
                weight: line.weight,
                wanted: wanted.collect(),
            });
        }
        if let Some((anchor, places)) = &self.middle {
            let own = rest.map(|pose| anchor.placed(pose));
            let at = |frame: usize| places.get(frame).copied();
            let wanted = steps.iter().map(|step| match step {
                Step::Frame(frame) => at(*frame),
                Step::Way { from, to, share } => {
                    let from = from.map_or(own, at)?;
                    Some(from + (at(*to)? - from) * *share)
                }
            });
            targets.places.push(PlaceTarget {
                segment: anchor.segment,
                point: anchor.point,
                weight: weight::MIDDLE,
                wanted: wanted.collect(),
            });
        }
        for (anchor, places) in feet.iter().flat_map(|feet| &feet.places) {
            targets.places.push(PlaceTarget {
                segment: anchor.segment,
                point: anchor.point,
                weight: weight::FOOT,
                wanted: places.clone(),
            });
        }
        targets.postures = target
            .model
            .postures()
            .iter()
            .map(|term| PostureTarget {
                terms: term.sum.clone(),
                rest: term.rest,
                stiffness: term.stiffness,
            })
            .collect();
        let defaults = target.model.defaults();
        targets.postures.extend(self.neck.iter().map(|id| PostureTarget {
            terms: vec![(*id, 1.0)],
            rest: target.model.stored_range(*id).next().map_or(0.0, |at| defaults[at]),
            stiffness: weight::NECK,
        }));
        targets
    }
}

/// Where a collar bone points: as far from where it rests in the chest as the source's, along the shortest arc.
///
/// How it turns about its own length is left out. Collar bones lie in different directions in different skeletons,
/// so that the axial turn of one would move the end of another.
fn girdle(side: Side, sampled: &Sampled, stances: [&Stance; 2]) -> Option<Vec<Vec3>> {
    let rest = |stance: &Stance| {
        let [a, b] =
            [Part::Clavicle(side), Part::UpperArm(side)].map(|part| stance.points.get(&part));
        let along = *b? - *a?;
        (along.norm() > 1e-9).then(|| stance.axes.transpose() * unit(along))
    };
    let [theirs, own] = stances.map(rest);
    let (theirs, own) = (theirs?, own?);
    let chests = sampled.turned.get(&Part::Chest)?;
    let lines = sampled.lines.get(&Part::Clavicle(side))?;
    let wanted = chests.iter().zip(lines).map(|(chest, line)| {
        let now = chest.transpose() * *line;
        *chest * (arc(theirs, now) * own)
    });
    Some(wanted.collect())
}

/// The rotations that a neck of several bones and its head have together; none of a neck of one bone.
///
/// Such bones share a motion, each by a part of it. Were one of them to turn as the source's neck does, the neck
/// might bend several times as far, and the head back. So only the head is turned as the source's, and all that moves
/// it in the chest moves as little as it can.
fn neck_of_bones(target: Humanoid<'_>) -> Vec<CoordinateId> {
    let model = target.model;
    let of = |part: Part| target.body.get(part).map(|anchor| anchor.segment);
    let (Some(neck), Some(chest), Some(head)) = (of(Part::Neck), of(Part::Chest), of(Part::Head))
    else {
        return vec![];
    };
    let bones: Vec<SegmentId> =
        model.path_to_root(head).take_while(|segment| *segment != chest).collect();
    if !bones.iter().skip(1).any(|bone| *bone != neck) {
        return vec![];
    }
    let sets: BTreeSet<JointSetId> =
        bones.iter().filter_map(|bone| model.segment(*bone).joint_set).collect();
    let turns = |id: &CoordinateId| model.coordinate(*id).kind == CoordinateKind::Rotation;
    sets.into_iter().flat_map(|set| model.coordinates_of(set)).filter(turns).collect()
}

/// A rotation on the shortest way from one to another.
fn between(from: Quat, to: Quat, share: f64) -> Quat {
    (from * Quat::exp((from.conjugate() * to).log() * share)).normalized()
}

/// How the parts of the target's spine below the chest should be turned: as the source's is at the same share
/// of the way from pelvis to chest.
fn interpolated(from: &Stance, to: &Stance, sampled: &Sampled) -> BTreeMap<Part, Vec<Mat3>> {
    let (Some(own), Some(wanted)) = (shares(from), shares(to)) else { return BTreeMap::new() };
    let mut all = BTreeMap::new();
    for (part, share) in wanted {
        if !matches!(part, Part::Spine(_)) {
            continue;
        }
        let above = own.iter().position(|(_, at)| *at >= share).unwrap_or(own.len() - 1);
        let below = above.saturating_sub(1);
        let ((lower, a), (upper, b)) = (own[below], own[above]);
        let part_way = if b > a { ((share - a) / (b - a)).clamp(0.0, 1.0) } else { 1.0 };
        let (Some(low), Some(high)) = (sampled.turned.get(&lower), sampled.turned.get(&upper))
        else {
            continue;
        };
        let frames = low.iter().zip(high).map(|(low, high)| {
            let [low, high] = [low, high].map(|m| Quat::from_mat3(*m));
            between(low, high, part_way).to_mat3()
        });
        all.insert(part, frames.collect());
    }
    all
}

/// For pelvis, spine and chest the share of the way from the pelvis to the chest.
fn shares(stance: &Stance) -> Option<Vec<(Part, f64)>> {
    let spine = |part: &Part| matches!(part, Part::Pelvis | Part::Spine(_) | Part::Chest);
    let mut along = 0.0;
    let mut before: Option<Vec3> = None;
    let mut shares = vec![];
    for (part, point) in stance.points.iter().filter(|(part, _)| spine(part)) {
        along += before.map_or(0.0, |before| (*point - before).norm());
        before = Some(*point);
        shares.push((*part, along));
    }
    let whole = (along > 1e-9).then_some(along)?;
    let ends = [Part::Pelvis, Part::Chest].iter().all(|end| stance.points.contains_key(end));
    shares.iter_mut().for_each(|(_, share)| *share /= whole);
    ends.then_some(shares)
}

/// The sides whose feet are asked for.
pub(super) fn foot_points(target: Humanoid<'_>, sampled: &Sampled) -> Vec<(Part, Part, Anchor)> {
    let mut points = vec![];
    for side in Side::BOTH {
        let foot = Part::Foot(side);
        if let Some(anchor) = target.body.start(foot) {
            points.push((foot, foot, anchor));
            if let (Some(ball), Some(end)) = (sampled.ball(side), target.body.end(foot)) {
                points.push((foot, ball, end));
            }
        }
    }
    points
}
