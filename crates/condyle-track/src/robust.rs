//! Markers that cannot be where the recording says.
//!
//! Two kinds of fault are distinguished from noise. A marker far off where the others agree is weighted down
//! by Geman and McClure's factor 1/(1 + (e/s)²)², with s from the median error of its frame. Two
//! labels that stand for each other's marker are found because each fits the other's place: they
//! are reported, put right, and the frames solved again.

use crate::answer::FrameAnswer;
use crate::recorded::Recorded;
use crate::tracker::{Scratch, Tracker};
use condyle_math::Vec3;
use condyle_model::Mode;

/// No scale is taken below this: errors of a few millimetres are skin and noise, not faults.
const LEAST_SCALE: f64 = 0.005;

/// A marker is suspect from this many scales on.
const SUSPECT: f64 = 4.0;

/// A swap must leave less than this share of the two squared errors.
const SWAP_GAIN: f64 = 0.2;

/// Shortest run of frames, and longest hole in it, that counts as a swap.
const SHORTEST_RUN: usize = 2;
const LONGEST_HOLE: usize = 5;

/// How often the weights of a frame are refined.
pub(crate) const ROUNDS: usize = 3;

/// The robust scale of a frame's marker errors: 1.5 medians, at least 5 mm. `sorted` is a buffer.
fn scale(errors: &[f64], sorted: &mut Vec<f64>) -> f64 {
    sorted.clear();
    sorted.extend(errors.iter().filter(|e| e.is_finite()));
    if sorted.is_empty() {
        return LEAST_SCALE;
    }
    let middle = sorted.len() / 2;
    let (_, median, _) = sorted.select_nth_unstable_by(middle, f64::total_cmp);
    (1.5 * *median).max(LEAST_SCALE)
}

/// A factor for the weight of each marker, from the errors of a first fit.
pub(crate) fn factors(errors: &[f64], factors: &mut Vec<f64>) {
    let scale = 2.0 * scale(errors, factors);
    factors.clear();
    factors.extend(errors.iter().map(|e| {
        let ratio = if e.is_finite() { e / scale } else { 0.0 };
        1.0 / (1.0 + ratio * ratio).powi(2)
    }));
}

/// Two marker targets whose labels are exchanged over a run of frames.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Exchanged {
    /// Positions among the marker targets, the lower first.
    pub markers: [usize; 2],
    /// The frames.
    pub frames: std::ops::Range<usize>,
}

/// Finds labels that stand for each other's marker, from the answers of a robust tracking.
pub fn find_exchanged(
    tracker: &Tracker,
    scratch: &mut Scratch,
    recorded: &dyn Recorded,
    answers: &[FrameAnswer],
) -> Vec<Exchanged> {
    let mut found: Vec<([usize; 2], usize)> = vec![];
    let (mut seen, mut sorted) = (vec![], vec![]);
    for (frame, answer) in answers.iter().enumerate() {
        let suspect_from = SUSPECT * scale(&answer.marker_errors, &mut sorted);
        let errors = answer.marker_errors.iter().enumerate();
        let suspects: Vec<usize> =
            errors.filter(|(_, e)| **e > suspect_from).map(|(i, _)| i).collect();
        if suspects.len() < 2 {
            continue;
        }
        recorded.positions(frame, &mut seen);
        let pose = &mut scratch.buffers.pose;
        if tracker.program.evaluate(&answer.coordinates, Mode::Open, pose).is_err() {
            continue;
        }
        let off = |marker: usize, label: usize| -> Option<f64> {
            let point = tracker.markers.placed.get(marker)?.at(pose);
            let seen = seen.get(label).copied().flatten()?;
            Some((point - Vec3::from(seen)).norm_squared())
        };
        for (position, &a) in suspects.iter().enumerate() {
            for &b in &suspects[position + 1..] {
                let before = off(a, a).zip(off(b, b)).map(|(x, y)| x + y);
                let after = off(a, b).zip(off(b, a)).map(|(x, y)| x + y);
                if let (Some(before), Some(after)) = (before, after)
                    && after < SWAP_GAIN * before
                {
                    found.push(([a, b], frame));
                }
            }
        }
    }
    runs(found)
}

/// Joins frames of one pair into runs over small holes, and drops runs that are too short.
fn runs(mut found: Vec<([usize; 2], usize)>) -> Vec<Exchanged> {
    found.sort_unstable();
    let mut runs: Vec<Exchanged> = vec![];
    for (markers, frame) in found {
        match runs.last_mut() {
            Some(run) if run.markers == markers && frame <= run.frames.end + LONGEST_HOLE => {
                run.frames.end = frame + 1;
            }
            _ => runs.push(Exchanged { markers, frames: frame..frame + 1 }),
        }
    }
    runs.retain(|run| run.frames.len() >= SHORTEST_RUN);
    runs
}

/// A recording with exchanged labels put right.
pub struct Corrected<'a> {
    /// The recording as it is.
    pub recorded: &'a dyn Recorded,
    /// What is exchanged in it.
    pub exchanged: &'a [Exchanged],
}

impl Recorded for Corrected<'_> {
    fn positions(&self, frame: usize, seen: &mut Vec<Option<[f64; 3]>>) {
        self.recorded.positions(frame, seen);
        for exchange in self.exchanged.iter().filter(|e| e.frames.contains(&frame)) {
            let [a, b] = exchange.markers;
            if a < seen.len() && b < seen.len() {
                seen.swap(a, b);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn runs_bridge_holes_and_drop_single_frames() {
        let pair = [3, 7];
        let mut found: Vec<_> = [10, 11, 12, 15, 16, 40].map(|frame| (pair, frame)).to_vec();
        found.push(([1, 2], 12));
        assert_eq!(runs(found), [Exchanged { markers: pair, frames: 10..17 }]);
    }

    #[test]
    fn one_outlier_loses_its_weight_and_the_others_keep_theirs() {
        let mut weights = vec![];
        factors(&[0.002, 0.003, 0.001, 0.200, f64::NAN], &mut weights);
        // Scale: 5 mm, taken twice. (2 mm)² / (10 mm)² = 0.04; 1/1.04² = 0.925.
        assert!((weights[0] - 1.0 / 1.04f64.powi(2)).abs() < 1e-12);
        assert!(weights[3] < 1e-5);
        assert_eq!(weights[4], 1.0);
    }
}
