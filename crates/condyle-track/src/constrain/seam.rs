//! Where the nearest legal pose jumps, and how the answer gets from one side to the other.

use super::figure::{Figure, Seat};
use super::{Pace, Step};
use condyle_model::CoordinateKind;
use condyle_motion::Motion;
use std::collections::BTreeMap;

/// The greatest slope of s(w) = w²(3 - 2w).
const STEEPEST: f64 = 1.5;
/// Of the steps of a motion, what its change may take part in: a projection to a convex set moves by at most one of
/// them, its difference from the motion by at most two.
const LIPSCHITZ: f64 = 2.0;
/// A part in which the answer goes over is at most this long, in seconds to each side.
const LONGEST: f64 = 1.0;
/// The time between frames that are not in time.
const USUAL: f64 = 1.0 / 30.0;
/// Less is rounding, in radians and metres.
const ROUNDING: f64 = 1e-7;

/// How far the change goes from frame to frame.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Steps {
    pub largest: Step,
    pub beyond: Step,
}

/// Where the change jumps: the frames behind, with the size of each jump in seconds at the allowed pace.
#[derive(Debug, Default)]
pub(super) struct Jumps {
    pub steps: Steps,
    at: Vec<(usize, f64)>,
}

/// Seconds from the frame before.
fn time_to(motion: &Motion, frame: usize) -> f64 {
    let time = |frame: usize| motion.times.get(frame).copied().unwrap_or(f64::NAN);
    let passed = time(frame) - time(frame.wrapping_sub(1));
    if passed > 1e-6 && passed < 1.0 { passed } else { USUAL }
}

/// Compares the steps of the change with what is allowed.
pub(super) fn jumps<'a>(
    figure: &mut Figure<'_>,
    motion: &Motion,
    answer: &dyn Fn(usize) -> &'a [f64],
    pace: Pace,
) -> Jumps {
    let mut found = Jumps::default();
    let [mut m0, mut x0, mut m1, mut x1]: [Vec<Seat>; 4] = Default::default();
    let mut known = None;
    for frame in 1..motion.frames.len() {
        let (before, now) = (&motion.frames[frame - 1], &motion.frames[frame]);
        let is_changed = |frame: usize, asked: &Vec<f64>| answer(frame) != &asked[..];
        if !is_changed(frame - 1, before) && !is_changed(frame, now) {
            continue;
        }
        if known == Some(frame - 1) {
            std::mem::swap(&mut m0, &mut m1);
            std::mem::swap(&mut x0, &mut x1);
        } else {
            figure.seats(before, &mut m0);
            figure.seats(answer(frame - 1), &mut x0);
        }
        figure.seats(now, &mut m1);
        figure.seats(answer(frame), &mut x1);
        known = Some(frame);
        let (mut change, mut asked) = (Step::default(), Step::default());
        for ((m0, x0), (m1, x1)) in m0.iter().zip(&x0).zip(m1.iter().zip(&x1)) {
            let turned = |m: &Seat, x: &Seat| m.turn.conjugate() * x.turn;
            let moved = |m: &Seat, x: &Seat| x.place - m.place;
            let own = Step {
                turn: turned(m0, x0).angle_to(turned(m1, x1)),
                slide: (moved(m1, x1) - moved(m0, x0)).norm(),
            };
            let still = [(m0, x0), (m1, x1)]
                .iter()
                .all(|(m, x)| m.turn.angle_to(x.turn) < ROUNDING && moved(m, x).norm() < ROUNDING);
            if still {
                continue;
            }
            change = change.most(own);
            let turn = m0.turn.angle_to(m1.turn);
            asked = asked.most(Step { turn, slide: (m1.place - m0.place).norm() });
        }
        let dt = time_to(motion, frame);
        let over = Step {
            turn: change.turn - (LIPSCHITZ * asked.turn + pace.turn * dt),
            slide: change.slide - (LIPSCHITZ * asked.slide + pace.slide * dt),
        };
        found.steps.largest = found.steps.largest.most(change);
        if over.turn > ROUNDING || over.slide > ROUNDING {
            found.steps.beyond = found.steps.beyond.most(over);
            found.at.push((frame, (change.turn / pace.turn).max(change.slide / pace.slide)));
        }
    }
    found
}

/// A jump, or several near each other: the frame behind the first, that behind the last, and the part in which the
/// answer goes over.
struct Seam {
    jumps: [usize; 2],
    part: [usize; 2],
}

fn seams(motion: &Motion, jumps: &Jumps) -> Vec<Seam> {
    let mut seams: Vec<Seam> = vec![];
    let last = motion.frames.len() - 1;
    for &(frame, seconds) in &jumps.at {
        let half = (0.5 * STEEPEST * seconds).min(LONGEST);
        let count = (half / time_to(motion, frame)).ceil() as usize;
        let part = [frame.saturating_sub(count.max(1)), (frame + count.max(1) - 1).min(last)];
        match seams.last_mut() {
            Some(known) if part[0] <= known.part[1] + 1 => {
                known.jumps[1] = frame;
                known.part = [known.part[0].min(part[0]), known.part[1].max(part[1])];
            }
            _ => seams.push(Seam { jumps: [frame; 2], part }),
        }
    }
    seams
}

/// Frames that get another pose, and the parts in which they are.
type Mended = (BTreeMap<usize, Vec<f64>>, Vec<[usize; 2]>);

/// Leads the answer over each jump.
pub(super) fn mend<'a>(
    figure: &mut Figure<'_>,
    motion: &Motion,
    nearest: &dyn Fn(usize) -> &'a [f64],
    jumps: &Jumps,
    pace: Pace,
) -> Mended {
    let mut mended = BTreeMap::new();
    let mut parts = vec![];
    if motion.frames.is_empty() {
        return (mended, parts);
    }
    let last = motion.frames.len() - 1;
    for seam in seams(motion, jumps) {
        let ([first_jump, last_jump], [start, end]) = (seam.jumps, seam.part);
        // The branch from before the jumps, and the one from behind them.
        let mut forward: BTreeMap<usize, Vec<f64>> = BTreeMap::new();
        let mut here = nearest(first_jump - 1).to_vec();
        for frame in first_jump..=end {
            let most = allowed(figure, motion, frame, pace);
            here = figure.toward(&here, &motion.frames[frame], &most);
            forward.insert(frame, here.clone());
        }
        let mut backward: BTreeMap<usize, Vec<f64>> = BTreeMap::new();
        let mut here = nearest(last_jump).to_vec();
        for frame in (start..last_jump).rev() {
            let most = allowed(figure, motion, frame + 1, pace);
            here = figure.toward(&here, &motion.frames[frame], &most);
            backward.insert(frame, here.clone());
        }
        let frames = (end - start + 2) as f64;
        let mut here = match start {
            0 => None,
            _ => Some(mended.get(&(start - 1)).map_or(nearest(start - 1), Vec::as_slice).to_vec()),
        };
        let mut goes = start;
        let longest = end + 4 * (end - start + 1);
        while goes <= last && goes <= longest {
            let target = if goes <= end {
                let w = (goes - start + 1) as f64 / frames;
                let a = forward.get(&goes).map_or(nearest(goes), Vec::as_slice);
                let b = backward.get(&goes).map_or(nearest(goes), Vec::as_slice);
                figure.between(a, b, w * w * (3.0 - 2.0 * w))
            } else {
                nearest(goes).to_vec()
            };
            let next = match here {
                Some(from) => {
                    let most = allowed(figure, motion, goes, pace);
                    figure.toward(&from, &target, &most)
                }
                None => figure.legal(target.clone()),
            };
            // Beyond the part the answer has only to arrive.
            if goes > end && next == target {
                break;
            }
            mended.insert(goes, next.clone());
            here = Some(next);
            goes += 1;
        }
        parts.push([start, goes - 1]);
    }
    (mended, parts)
}

/// For each coordinate how far it may go to a frame from the one before.
fn allowed(figure: &Figure<'_>, motion: &Motion, frame: usize, pace: Pace) -> Vec<f64> {
    let dt = time_to(motion, frame);
    let gaps = figure.gaps(&motion.frames[frame - 1], &motion.frames[frame]);
    let own = |kind: CoordinateKind| match kind {
        CoordinateKind::Translation => pace.slide * dt,
        _ => pace.turn * dt,
    };
    gaps.map(|(kind, gap)| gap + own(kind)).collect()
}
