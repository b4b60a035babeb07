//! The source's motion in the world of the target: how every part is turned and where it is, frame by frame.

use super::body::{Anchor, Part, Side};
use super::stance::{Stance, unit};
use super::{Humanoid, Posed, standing};
use crate::target::rotation_of;
use condyle_diagnostics::Error;
use condyle_math::{Mat3, Vec3};
use condyle_motion::Motion;
use std::collections::BTreeMap;
use std::ops::Range;

/// The source's motion in the world of the target, in the source's size.
pub(super) struct Sampled {
    /// Seconds.
    pub times: Vec<f64>,
    /// For each part its anatomical axes, frame by frame.
    pub turned: BTreeMap<Part, Vec<Mat3>>,
    /// For each part, or tip, where it is.
    pub placed: BTreeMap<Part, Vec<Vec3>>,
    /// Where each part of a limb points, from its joint to its end.
    pub lines: BTreeMap<Part, Vec<Vec3>>,
    /// The middle between the hips (or the pelvis), and the line from there to the neck.
    pub middle: Vec<Vec3>,
    pub trunk: Option<Vec<Vec3>>,
    /// The axis that points up, in the target.
    pub up: Vec3,
    /// The target's size by the source's, by their legs.
    pub size: f64,
    /// The height of the source's ankles where it stands.
    pub ankle: f64,
    /// When ankles and balls of the feet stand.
    pub stands: BTreeMap<Part, Vec<Range<usize>>>,
}

/// Whether the trunks of two figures have to end at their necks: where one has no chest with two shoulders. Skeletons have
/// their lowest joint of the neck anywhere from the middle of the chest to its top; shoulders are at one height in all.
pub(super) fn by_necks(figures: [Humanoid<'_>; 2]) -> bool {
    let all = |part: fn(Side) -> Part| {
        let has = |figure: &Humanoid<'_>, side: Side| figure.body.get(part(side)).is_some();
        figures.iter().all(|figure| Side::BOTH.iter().all(|side| has(figure, *side)))
    };
    let both = |part: Part| figures.iter().all(|figure| figure.body.get(part).is_some());
    both(Part::Neck) && !(both(Part::Chest) && all(Part::UpperArm))
}

/// Where a trunk begins and ends: between the hips, fixed in the pelvis, and between the shoulders as they are at rest,
/// fixed in the chest, or at the neck.
pub(super) fn trunk(figure: Humanoid<'_>, neck: bool) -> Option<(Anchor, Anchor)> {
    let mut posed = Posed::new(figure.model);
    let pose = posed.at(&figure.model.defaults()).ok()?;
    let middle = |part: fn(Side) -> Part, of: Part| {
        let [a, b] = Side::BOTH.map(|side| figure.body.get(part(side)));
        let at = (a?.placed(pose) + b?.placed(pose)) * 0.5;
        let segment = figure.body.get(of)?.segment;
        let frame = pose.segment(segment);
        let point = frame.linear.inverse() * (at - frame.translation);
        Some(Anchor { segment, point })
    };
    let low = middle(Part::Thigh, Part::Pelvis).or_else(|| figure.body.get(Part::Pelvis))?;
    let high = match figure.body.get(Part::Neck).filter(|_| neck) {
        Some(neck) => neck,
        None => middle(Part::UpperArm, Part::Chest)?,
    };
    Some((low, high))
}

/// The middle between the hips, fixed in the pelvis; of a figure without legs the pelvis or the chest.
pub(super) fn middle(figure: Humanoid<'_>) -> Option<Anchor> {
    let whole = trunk(figure, true).or_else(|| trunk(figure, false)).map(|(low, _)| low);
    whole.or_else(|| figure.body.get(Part::Pelvis)).or_else(|| figure.body.get(Part::Chest))
}

impl Sampled {
    pub(super) fn new(
        source: Humanoid<'_>,
        motion: &Motion,
        from: &Stance,
        to: &Stance,
        necks: bool,
    ) -> Result<Self, Error> {
        let world = to.heading * from.heading.transpose();
        let ends = trunk(source, necks);
        let centre = middle(source)
            .ok_or_else(|| Error::new("retarget/parts", "the source has no pelvis"))?;
        let mut posed = Posed::new(source.model);
        let mut turned: BTreeMap<Part, Vec<Mat3>> = BTreeMap::new();
        let mut placed: BTreeMap<Part, Vec<Vec3>> = BTreeMap::new();
        let mut lines: BTreeMap<Part, Vec<Vec3>> = BTreeMap::new();
        let (mut between, mut trunk) = (vec![], vec![]);
        for frame in &motion.frames {
            let pose = posed.at(frame)?;
            for (part, anchor) in source.body.parts() {
                let start = source.body.start(part).unwrap_or(anchor).placed(pose);
                placed.entry(part).or_default().push(world * start);
                if let Some(own) = from.frames.get(&part) {
                    let axes = rotation_of(pose.segment(anchor.segment).linear);
                    turned.entry(part).or_default().push(world * (axes * *own));
                }
                if let Some(end) = source.body.end(part) {
                    let along = unit(end.placed(pose) - start);
                    lines.entry(part).or_default().push(world * along);
                }
            }
            between.push(world * centre.placed(pose));
            if let Some((low, high)) = ends {
                trunk.push(world * unit(high.placed(pose) - low.placed(pose)));
            }
        }
        let up = to.heading.y;
        let times = motion.times.clone();
        let mut stands = BTreeMap::new();
        for side in Side::BOTH {
            let toes = [Part::Ball(side), Part::Toes(side), Part::ToeTip(side)];
            let ball = toes.into_iter().find(|part| placed.contains_key(part));
            for part in [Some(Part::Foot(side)), ball].into_iter().flatten() {
                if let Some(points) = placed.get(&part) {
                    stands.insert(part, standing(points, &times, up));
                }
            }
        }
        let ankle = ankle_height(&placed, up, from);
        Ok(Self {
            times,
            turned,
            placed,
            lines,
            middle: between,
            trunk: ends.map(|_| trunk),
            up,
            size: to.leg / from.leg,
            ankle,
            stands,
        })
    }

    /// The frames in which both ankle and ball of a foot stand; none where they are too few to tell anything.
    fn standing_frames(&self, side: Side) -> Vec<usize> {
        let runs = |part: Part| self.stands.get(&part).map_or(&[][..], Vec::as_slice);
        let ball = self.ball(side).map_or(&[][..], runs);
        let both = runs(Part::Foot(side))
            .iter()
            .flat_map(Clone::clone)
            .filter(|frame| ball.iter().any(|run| run.contains(frame)));
        let frames: Vec<usize> = both.collect();
        if frames.len() < FEWEST { vec![] } else { frames }
    }

    /// The point that tells how the front of a foot moves.
    pub(super) fn ball(&self, side: Side) -> Option<Part> {
        let toes = [Part::Ball(side), Part::Toes(side), Part::ToeTip(side)];
        toes.into_iter().find(|part| self.placed.contains_key(part))
    }

    /// Turns the frames of feet and toes so that they are level where the feet stand: rest postures of
    /// skeletons hold feet at other angles than people who stand. A foot whose line from
    /// ankle to ball has nearly the slope of the target's keeps that line instead.
    pub(super) fn settle_soles(&mut self, from: &Stance, to: &Stance) {
        for side in Side::BOTH {
            let frames = self.standing_frames(side);
            for part in [Part::Foot(side), Part::Toes(side)] {
                let Some(axes) = self.turned.get(&part) else { continue };
                let pitches = frames.iter().filter_map(|&frame| Some(axes.get(frame)?.x));
                // Without standing the posture of rest tells.
                let mut pitch = match median(pitches.map(|x| x.dot(self.up).asin())) {
                    Some(pitch) if pitch.abs() > MOST_PITCH => 0.0,
                    pitch => pitch.unwrap_or(0.0),
                };
                if let (Part::Foot(_), Some(own), Some(rest)) =
                    (part, to.slopes.get(&side), from.slopes.get(&side))
                {
                    let lines = self.lines.get(&part);
                    let slopes = frames.iter().filter_map(|&frame| lines?.get(frame));
                    let stands = median(slopes.map(|line| line.dot(self.up).asin()));
                    let alike = |slope: f64| (slope - own).abs() < ALIKE;
                    if alike(*rest) || stands.is_some_and(alike) {
                        // The frame is level at rest: so the line of the target is that of the source.
                        pitch = own - rest;
                    }
                }
                // The third axis of a foot's frame points across it: x turns towards y about z.
                let level = Mat3::rotation_z(-pitch);
                if let Some(axes) = self.turned.get_mut(&part) {
                    axes.iter_mut().for_each(|axes| *axes = *axes * level);
                }
            }
        }
    }
}

/// The middle of some numbers.
fn median(numbers: impl Iterator<Item = f64>) -> Option<f64> {
    let mut sorted: Vec<f64> = numbers.collect();
    sorted.sort_by(f64::total_cmp);
    sorted.get(sorted.len() / 2).copied()
}

/// Slopes of feet from ankle to ball that differ by less than this, in radians, are those of feet that are built
/// alike: their lines are matched. Of others the soles are.
const ALIKE: f64 = 0.1;
/// So many frames of standing say how a sole is.
const FEWEST: usize = 10;
/// A foot that stands steeper than this stands on its toes, in radians.
const MOST_PITCH: f64 = 0.5;

/// The height of the ankles where the source stands: of its rest if it stands as high in the motion, else the
/// lowest of the motion.
fn ankle_height(placed: &BTreeMap<Part, Vec<Vec3>>, up: Vec3, from: &Stance) -> f64 {
    let mut heights: Vec<f64> = Side::BOTH
        .iter()
        .filter_map(|side| placed.get(&Part::Foot(*side)))
        .flatten()
        .map(|point| point.dot(up))
        .filter(|height| height.is_finite())
        .collect();
    heights.sort_by(f64::total_cmp);
    let Some(&low) = heights.get(heights.len() / 50) else { return 0.0 };
    // Someone who never stands on the ground (who climbs, or sits) keeps his height above it.
    if low > from.ankle + 0.25 * from.leg { from.ankle } else { low }
}
