//! Many frames: cut, solve each chunk, stitch.
//!
//! The cut depends on the number of frames alone, so any number of threads gives the same bytes:
//!
//! 1. the first frame of each chunk is solved in order, each from the one before ([`keys`]);
//! 2. each chunk is solved on its own from its first frame, one frame beyond its end ([`solve_chunk`]);
//! 3. where a chunk's last frame disagrees with the next chunk's first, the better of the two
//!    postures wins and the other chunk is solved again from the seam ([`stitch`]).

use crate::answer::{FrameAnswer, better};
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

/// A rotation that changes by more than this from one frame to the next, in radians, is looked at.
const JUMP: f64 = 0.3;

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
    for chunk in chunks {
        let frame = chunk.frames.start;
        recorded.positions(frame, &mut seen);
        let key = match keys.last() {
            None => tracker.solve_first(scratch, &seen, frame, FIRST_GUESSES),
            Some(before) => tracker.solve_frame(scratch, &seen, frame, &before.coordinates),
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
        if tracker.largest_turn(&answers[position - 1], &answers[position]) > JUMP {
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
            Some(again) if better(&again, &answers[position]) => answers[position] = again,
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
    mut answers: Vec<Vec<FrameAnswer>>,
) -> Vec<FrameAnswer> {
    // Forwards: a chunk that began worse than the one before it ended starts again from there.
    for i in 1..chunks.len() {
        let Some(seam) = answers[i - 1].get(chunks[i - 1].frames.len()).cloned() else { continue };
        if better(&seam, &answers[i][0]) {
            let total = chunks.last().map_or(0, |c| c.frames.end);
            answers[i] = solve_chunk(tracker, scratch, recorded, &chunks[i], &seam, total);
        }
    }
    // Backwards: a chunk that ended worse than the next one began is walked back from the seam for
    // as long as that helps.
    for i in (1..chunks.len()).rev() {
        let length = chunks[i - 1].frames.len();
        let Some(seam) = answers[i - 1].get(length) else { continue };
        let from = answers[i][0].clone();
        if !better(&from, seam) {
            continue;
        }
        answers[i - 1][length] = from;
        walk_back(tracker, scratch, recorded, chunks[i - 1].frames.start, &mut answers[i - 1]);
    }
    let lengths: Vec<usize> = chunks.iter().map(|c| c.frames.len()).collect();
    answers
        .into_iter()
        .zip(lengths)
        .flat_map(|(answers, length)| answers.into_iter().take(length))
        .collect()
}
