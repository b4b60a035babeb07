//! Feet that stand: where the target's ankles and balls of the feet should be.

use super::body::Anchor;
use super::question::foot_points;
use super::sampled::Sampled;
use super::{Humanoid, Options, Posed};
use condyle_math::Vec3;
use condyle_motion::Motion;
use std::ops::Range;

/// Points of the feet and their places.
pub(super) struct Feet {
    /// For each point where it should be in each frame.
    pub places: Vec<(Anchor, Vec<Option<Vec3>>)>,
}

/// What a foot is moved for fades in and out over so many seconds.
const FADE: f64 = 0.3;
/// Two stands are one where no more than so many seconds are between them, and so many metres.
const GAP: f64 = 0.1;
const NEAR: f64 = 0.03;

/// Where the points of the feet should be; `None` where none stands.
pub(super) fn feet(
    target: Humanoid<'_>,
    sampled: &Sampled,
    free: &Motion,
    options: Options,
) -> Option<Feet> {
    let points = foot_points(target, sampled);
    let mut posed = Posed::new(target.model);
    let mut free_places: Vec<Vec<Vec3>> = vec![vec![]; points.len()];
    for frame in &free.frames {
        let pose = posed.at(frame).ok()?;
        for ((_, _, anchor), places) in points.iter().zip(&mut free_places) {
            places.push(anchor.placed(pose));
        }
    }
    // For each point what it should be moved by where it stands, and in between.
    let mut moved: Vec<(Vec<Range<usize>>, Vec<Vec3>)> = vec![];
    for ((_, part, _), places) in points.iter().zip(&free_places) {
        let source = sampled.placed.get(part)?;
        let runs = joined(sampled.stands.get(part)?, source, &sampled.times);
        let mut offsets = vec![Vec3::ZERO; places.len()];
        for run in &runs {
            let mean = |of: &[Vec3]| {
                let sum = run.clone().fold(Vec3::ZERO, |sum, frame| sum + of[frame]);
                sum * (1.0 / run.len() as f64)
            };
            let (own, theirs) = (mean(places), mean(source));
            for frame in run.clone() {
                let slid = (source[frame] - theirs) * sampled.size;
                let slid = if options.pin_feet { Vec3::ZERO } else { slid };
                offsets[frame] = own + slid - places[frame];
            }
        }
        moved.push((runs, offsets));
    }
    if moved.iter().all(|(runs, _)| runs.is_empty()) {
        return None;
    }
    let none = vec![Vec3::ZERO; free.frames.len()];
    let alone: Vec<Vec<Vec3>> =
        moved.iter().map(|(runs, offsets)| faded(runs, offsets, &none, &sampled.times)).collect();
    let mut places = vec![];
    for (number, (foot, _, anchor)) in points.iter().enumerate() {
        // Where one point of a foot stands the other goes with it.
        let other = (0..points.len()).find(|&other| other != number && points[other].0 == *foot);
        let base = other.map_or(&none, |other| &alone[other]);
        let (runs, offsets) = &moved[number];
        let all = faded(runs, offsets, base, &sampled.times);
        let wanted =
            all.iter().zip(&free_places[number]).map(|(by, place)| Some(*place + *by)).collect();
        places.push((*anchor, wanted));
    }
    Some(Feet { places })
}

/// Runs that are nearly one, joined.
fn joined(runs: &[Range<usize>], places: &[Vec3], times: &[f64]) -> Vec<Range<usize>> {
    let mut all: Vec<Range<usize>> = vec![];
    for run in runs {
        if let Some(last) = all.last_mut()
            && times[run.start] - times[last.end - 1] < GAP
            && (places[run.start] - places[last.end - 1]).norm() < NEAR
        {
            last.end = run.end;
            continue;
        }
        all.push(run.clone());
    }
    all
}

/// Offsets where a point stands; before and after they fade to those of the base.
fn faded(runs: &[Range<usize>], offsets: &[Vec3], base: &[Vec3], times: &[f64]) -> Vec<Vec3> {
    let mut all = base.to_vec();
    let mut fade = |from: usize, to: usize, edge: usize, length: f64| {
        let by = offsets[edge] - base[edge];
        for frame in from..to {
            let share = ((times[frame] - times[edge]).abs() / length).min(1.0);
            // 1 - smoothstep.
            all[frame] += by * (1.0 - share * share * (3.0 - 2.0 * share));
        }
    };
    for (number, run) in runs.iter().enumerate() {
        let before = number.checked_sub(1).map_or(0, |before| runs[before].end);
        let after = runs.get(number + 1).map_or(offsets.len(), |after| after.start);
        // The whole gap at most, so that nothing is left where the next one begins.
        let gap = |from: usize, to: usize, open: bool| {
            let span = (times[to] - times[from]).abs();
            if open { FADE } else { span.clamp(1e-9, FADE) }
        };
        if before < run.start {
            let length = gap(before.saturating_sub(1), run.start, number == 0);
            fade(before, run.start, run.start, length);
        }
        if run.end < after {
            let length = gap(run.end - 1, after.min(times.len() - 1), number + 1 == runs.len());
            fade(run.end, after, run.end - 1, length);
        }
    }
    for frame in runs.iter().flat_map(Clone::clone) {
        all[frame] = offsets[frame];
    }
    all
}
