//! Labels exchanged over the whole trial.

use super::assignment::assign;
use super::{Corrected, Repairs};
use crate::answer::FrameAnswer;
use crate::recorded::Recorded;
use crate::tracker::{Scratch, Tracker};
use condyle_math::Vec3;

/// So many frames, evenly spread, are looked at, and so many solved again.
const LOOKED_AT: usize = 64;
const SOLVED: usize = 8;
/// The squared distances of labels that go round must fall below this share.
const DISTANCES: f64 = 0.5;
/// What is minimised must fall below this share.
const FIT: f64 = 0.8;
/// The exchanged labels must then be this near to their markers, RMS, in metres: where a model is not
/// scaled to its person, markers of one segment may be nearer to each other's places by chance.
const LEFT: f64 = 0.040;
/// A label nearer to its marker than this, in metres, is in place.
const IN_PLACE: f64 = 0.020;

/// Exchanges labels that are nearer to each other's markers in all frames, where the frames then fit
/// clearly better; whether any were.
///
/// Offsets are not counted: they would be those of the wrong labels.
pub fn exchanged_throughout(
    tracker: &Tracker,
    scratch: &mut Scratch,
    recorded: &dyn Recorded,
    repairs: &mut Repairs,
    answers: &[FrameAnswer],
) -> bool {
    let count = tracker.markers.placed.len();
    let frames = answers.len();
    let every = frames.div_ceil(LOOKED_AT).max(1);
    let (mut squares, mut n) = (vec![0.0; count * count], vec![0.0; count]);
    let mut seen = vec![];
    for frame in (0..frames).step_by(every).filter(|&f| answers[f].status.is_solved()) {
        Corrected { recorded, repairs }.positions(frame, &mut seen);
        let Some(pose) = scratch.buffers.pose_at(tracker, &answers[frame].coordinates) else {
            continue;
        };
        for (label, seen) in seen.iter().enumerate().take(count) {
            let Some(seen) = *seen else { continue };
            n[label] += 1.0;
            for (marker, placed) in tracker.markers.placed.iter().enumerate() {
                squares[label * count + marker] +=
                    (placed.at(pose) - Vec3::from(seen)).norm_squared();
            }
        }
    }
    let mean =
        |label: usize, marker: usize| squares[label * count + marker] / f64::max(n[label], 1.0);
    let suspects: Vec<usize> =
        (0..count).filter(|&l| n[l] > 0.0 && mean(l, l) > IN_PLACE * IN_PLACE).collect();
    let Some(columns) =
        assign(suspects.len(), suspects.len(), |row, column| mean(suspects[row], suspects[column]))
    else {
        return false;
    };
    let mut labels: Vec<usize> = (0..count).collect();
    for (row, column) in columns.into_iter().enumerate() {
        labels[suspects[column]] = suspects[row];
    }
    keep_clear_cycles(&mut labels, mean);
    if labels.iter().enumerate().all(|(marker, &label)| marker == label) {
        return false;
    }
    let mut exchanged = repairs.clone();
    exchanged.exchange(&labels);
    let (mut before, mut after, mut squares, mut n) = (0.0, 0.0, 0.0, 0.0);
    for frame in (0..frames).step_by(frames.div_ceil(SOLVED).max(1)) {
        Corrected { recorded, repairs: &exchanged }.positions(frame, &mut seen);
        let again = tracker.solve_frame(scratch, &seen, frame, &answers[frame].coordinates);
        before += answers[frame].minimised();
        after += again.minimised();
        let errors = again.marker_errors.iter().enumerate();
        for (_, error) in errors.filter(|(m, e)| labels[*m] != *m && e.is_finite()) {
            squares += error * error;
            n += 1.0;
        }
    }
    let better = after < FIT * before && squares <= LEFT * LEFT * n;
    if better {
        *repairs = exchanged;
    }
    better
}

/// Takes back the cycles that do not clearly shorten the distances.
fn keep_clear_cycles(labels: &mut [usize], mean: impl Fn(usize, usize) -> f64) {
    let mut done = vec![false; labels.len()];
    for first in 0..labels.len() {
        let (mut cycle, mut at) = (vec![], first);
        while !done[at] {
            done[at] = true;
            cycle.push(at);
            at = labels[at];
        }
        let before: f64 = cycle.iter().map(|&m| mean(m, m)).sum();
        let after: f64 = cycle.iter().map(|&m| mean(labels[m], m)).sum();
        if after > DISTANCES * before {
            cycle.iter().for_each(|&m| labels[m] = m);
        }
    }
}
