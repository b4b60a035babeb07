//! Many frames: cut, solve each chunk, stitch.
//!
//! The cut depends on the number of frames alone, so any number of threads gives the same bytes:
//!
//! 1. the first frame of each chunk is solved in order, each from the one before ([`keys`]);
//! 2. each chunk is solved on its own from its first frame, one frame beyond its end ([`solve_chunk`]);
//! 3. where a chunk's last frame disagrees with the next chunk's first, the better of the two
//!    postures wins and the other chunk is solved again from the seam ([`stitch`]).

use crate::answer::FrameAnswer;
use crate::answers::{Answers, Run};
use crate::frame::TURN;
use crate::recorded::Recorded;
use crate::tracker::{Scratch, Tracker};
use std::ops::Range;

/// Frames that are solved one after another.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Chunk {
    /// The chunk's own frames.
    pub frames: Range<usize>,
}

/// Frames in a chunk.
const LENGTH: usize = 64;

/// A limb is tried again where it is so many times as odd as when that was in vain.
const ODDER: f64 = 1.5;

/// How many first guesses the first frame gets.
pub(crate) const FIRST_GUESSES: usize = 4;

/// Cuts a recording into chunks.
pub fn cut(frames: usize) -> Vec<Chunk> {
    (0..frames)
        .step_by(LENGTH)
        .map(|start| Chunk { frames: start..(start + LENGTH).min(frames) })
        .collect()
}

/// Solves the first frame of every chunk, in order.
pub fn keys(
    tracker: &Tracker,
    scratch: &mut Scratch,
    recorded: &dyn Recorded,
    chunks: &[Chunk],
) -> Vec<FrameAnswer> {
    let mut seen = vec![];
    let mut keys: Vec<FrameAnswer> = vec![];
    // For each limb how odd it was when no other turn was better.
    let mut tried = vec![0.0; tracker.limbs.len()];
    for chunk in chunks {
        let frame = chunk.frames.start;
        recorded.positions(frame, &mut seen);
        let key = match keys.last() {
            None => tracker.solve_first(scratch, &seen, frame, FIRST_GUESSES),
            Some(before) => {
                let mut answer = before.clone();
                scratch.solver.forget();
                tracker.follow(scratch, &seen, frame, &mut answer, false);
                // It may have followed a wrong minimum for long without a jump.
                let odd = tracker.odd_limb(scratch, &seen, &answer.coordinates);
                if let Some((limb, ratio)) = odd.filter(|(limb, r)| *r > ODDER * tried[*limb]) {
                    let found = tracker.try_odd_limb(scratch, &seen, frame, limb, &mut answer);
                    tried[limb] = if found { 0.0 } else { ratio };
                }
                answer
            }
        };
        keys.push(key);
    }
    keys
}

/// Solves a run of frames forwards or backwards, each from the one before.
fn run(
    tracker: &Tracker,
    scratch: &mut Scratch,
    recorded: &dyn Recorded,
    frames: impl Iterator<Item = usize>,
    start: &FrameAnswer,
) -> Vec<FrameAnswer> {
    let mut seen = vec![];
    let mut answer = start.clone();
    scratch.solver.forget();
    let solved = frames.map(|frame| {
        recorded.positions(frame, &mut seen);
        tracker.follow(scratch, &seen, frame, &mut answer, false);
        answer.clone()
    });
    solved.collect()
}

/// Solves the frames of a chunk after its first, and the first frame of the next chunk.
///
/// The answers begin with the key and have one more frame than the chunk, except in the last.
pub fn solve_chunk(
    tracker: &Tracker,
    scratch: &mut Scratch,
    recorded: &dyn Recorded,
    chunk: &Chunk,
    key: &FrameAnswer,
    total: usize,
) -> Vec<FrameAnswer> {
    let end = (chunk.frames.end + 1).min(total);
    let mut answers = vec![key.clone()];
    let rest = chunk.frames.start + 1..end;
    answers.extend(run(tracker, scratch, recorded, rest, key));
    mend_jumps(tracker, scratch, recorded, chunk.frames.start, &mut answers);
    answers
}

/// Walks back from every jump, for as long as the posture beyond it also fits the frames before it
/// better.
///
/// Where two minima exist side by side, following frame by frame stays in the old one until it
/// vanishes; the new one may have been lower for some frames already.
fn mend_jumps(
    tracker: &Tracker,
    scratch: &mut Scratch,
    recorded: &dyn Recorded,
    first: usize,
    answers: &mut [FrameAnswer],
) {
    for position in 1..answers.len() {
        if tracker.largest_turn(&answers[position - 1], &answers[position]) > TURN {
            walk_back(tracker, scratch, recorded, first, &mut answers[..=position]);
        }
    }
}

/// Solves frames again from the one after them, the last being right, until that does not help.
fn walk_back(
    tracker: &Tracker,
    scratch: &mut Scratch,
    recorded: &dyn Recorded,
    first: usize,
    answers: &mut [FrameAnswer],
) {
    for position in (0..answers.len().saturating_sub(1)).rev() {
        let frame = first + position;
        let after = answers[position + 1].clone();
        let again = run(tracker, scratch, recorded, frame..frame + 1, &after);
        match again.into_iter().next() {
            Some(again) if tracker.replaces(&again, &answers[position]) => {
                answers[position] = again;
            }
            _ => break,
        }
    }
}

/// Joins the chunks' answers into one for each frame.
pub fn stitch(
    tracker: &Tracker,
    scratch: &mut Scratch,
    recorded: &dyn Recorded,
    chunks: &[Chunk],
    answers: Vec<Vec<FrameAnswer>>,
) -> Vec<FrameAnswer> {
    let runs = answers.iter().map(|answers| Run::of(answers)).collect();
    stitch_runs(tracker, scratch, recorded, chunks, runs).iter().collect()
}

/// Joins the chunks' answers, each packed, into one for each frame.
pub fn stitch_runs(
    tracker: &Tracker,
    scratch: &mut Scratch,
    recorded: &dyn Recorded,
    chunks: &[Chunk],
    mut runs: Vec<Run>,
) -> Answers {
    let total = chunks.last().map_or(0, |c| c.frames.end);
    // Forwards: a chunk that began worse than the one before it ended starts again from there.
    for i in 1..chunks.len() {
        let Some(seam) = runs[i - 1].get(chunks[i - 1].frames.len()) else { continue };
        let Some(mut begun) = runs[i].get(0) else { continue };
        tracker.branches.bring_near(&mut begun.coordinates, &seam.coordinates, &tracker.stored);
        if tracker.replaces(&seam, &begun) {
            let again = solve_chunk(tracker, scratch, recorded, &chunks[i], &seam, total);
            runs[i] = Run::of(&again);
        }
    }
    // Backwards: a chunk that ended worse than the next one began is walked back from the seam for
    // as long as that helps.
    for i in (1..chunks.len()).rev() {
        let length = chunks[i - 1].frames.len();
        let Some(seam) = runs[i - 1].get(length) else { continue };
        let Some(mut from) = runs[i].get(0) else { continue };
        tracker.branches.bring_near(&mut from.coordinates, &seam.coordinates, &tracker.stored);
        if !tracker.replaces(&from, &seam) {
            continue;
        }
        let mut answers = runs[i - 1].unpacked();
        answers[length] = from;
        walk_back(tracker, scratch, recorded, chunks[i - 1].frames.start, &mut answers);
        runs[i - 1] = Run::of(&answers);
    }
    for (run, chunk) in runs.iter_mut().zip(chunks) {
        run.truncate(chunk.frames.len());
    }
    let mut answers = Answers::of_runs(runs);
    review(tracker, scratch, recorded, &mut answers);
    // Of all numbers for a posture those that go on from the frame before.
    let mut before = answers.get(0).map(|first| first.coordinates).unwrap_or_default();
    for frame in 1..answers.len() {
        let own = answers.coordinates_mut(frame);
        tracker.branches.bring_near(own, &before, &tracker.stored);
        before.copy_from_slice(own);
    }
    answers
}

/// A frame is looked at again where F + P exceeds this many medians of the trial, and 1 mm².
const HIGH: f64 = 1.5;
/// At most one frame in so many, and so far apart.
const REVIEWED: usize = 256;
const APART: usize = 32;
/// After so many frames in a row for which nothing better was found, the others are left.
const IN_VAIN: usize = 2;

/// Tries first guesses where the fit is worst. A posture that becomes worse little by little, at a bound or
/// in a minimum of its own, is no jump that following would notice. What is better goes on to the
/// frames before and after for as long as it is better there.
fn review(
    tracker: &Tracker,
    scratch: &mut Scratch,
    recorded: &dyn Recorded,
    answers: &mut Answers,
) {
    let mut sorted: Vec<f64> = (0..answers.len()).map(|frame| answers.minimised(frame)).collect();
    sorted.sort_by(f64::total_cmp);
    let Some(&median) = sorted.get(sorted.len() / 2) else { return };
    drop(sorted);
    let high = |frame: &usize| answers.minimised(*frame) > HIGH * median + 1e-6;
    let mut order: Vec<usize> = (0..answers.len()).filter(high).collect();
    order.sort_by(|&a, &b| answers.minimised(b).total_cmp(&answers.minimised(a)));
    let (mut looked, mut in_vain): (Vec<usize>, usize) = (vec![], 0);
    let mut seen = vec![];
    for frame in order {
        if looked.len() > answers.len() / REVIEWED || in_vain >= IN_VAIN {
            break;
        }
        // It may have become better since.
        let high = answers.minimised(frame) > HIGH * median + 1e-6;
        if !high || looked.iter().any(|other| other.abs_diff(frame) < APART) {
            continue;
        }
        looked.push(frame);
        recorded.positions(frame, &mut seen);
        let mut again = tracker.solve_anew(scratch, &seen, frame, FIRST_GUESSES);
        let numbers = &mut again.coordinates;
        tracker.branches.bring_near(numbers, answers.coordinates(frame), &tracker.stored);
        if !tracker.replaces(&again, &answers.at(frame)) {
            in_vain += 1;
            continue;
        }
        in_vain = 0;
        answers.set(frame, &again);
        // What is better goes on to the frames before and after.
        let mut follow = |from: usize, to: usize, answers: &mut Answers| {
            let start = answers.at(from);
            let again = run(tracker, scratch, recorded, to..to + 1, &start);
            let again = again.into_iter().next();
            let taken = again.filter(|again| tracker.replaces(again, &answers.at(to)));
            taken.inspect(|again| answers.set(to, again)).is_some()
        };
        for before in (0..frame).rev() {
            if !follow(before + 1, before, answers) {
                break;
            }
        }
        for after in frame + 1..answers.len() {
            if !follow(after - 1, after, answers) {
                break;
            }
        }
    }
}
