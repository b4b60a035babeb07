//! Frames as they come, each from the one before.

use crate::answer::{FrameAnswer, FrameStatus};
use crate::sequence::FIRST_GUESSES;
use crate::tracker::{Scratch, Tracker};
use std::sync::Arc;

/// Solves frame after frame into buffers that it keeps.
///
/// The first frame that has markers starts from first guesses. Every other starts from the posture before
/// it; where that was not solved, or the fit is suddenly far worse, first guesses are tried as well.
/// Only these allocate: a frame that follows another without such a jump does not.
#[derive(Debug)]
pub struct Stream {
    tracker: Arc<Tracker>,
    scratch: Scratch,
    answer: FrameAnswer,
    frames: usize,
    begun: bool,
}

impl Stream {
    /// A stream before its first frame.
    pub fn new(tracker: impl Into<Arc<Tracker>>) -> Self {
        let tracker = tracker.into();
        let (scratch, answer) = (Scratch::new(&tracker), FrameAnswer::start(&tracker.defaults));
        Self { tracker, scratch, answer, frames: 0, begun: false }
    }

    /// Solves the next frame: the recorded position of each marker target in metres, `None` where it is
    /// not seen. Frames are counted from 0 for targets that have a value for each.
    pub fn next(&mut self, seen: &[Option<[f64; 3]>]) -> &FrameAnswer {
        let Self { tracker, scratch, answer, frames, begun } = self;
        if *begun {
            let gap = !answer.status.is_solved() && seen.iter().any(Option::is_some);
            tracker.follow(scratch, seen, *frames, answer, gap);
        } else {
            *answer = tracker.solve_first(scratch, seen, *frames, FIRST_GUESSES);
            *begun = answer.status != FrameStatus::NoMarkers;
            scratch.solver.forget();
        }
        *frames += 1;
        answer
    }

    /// The answer of the last frame; the defaults before the first.
    pub fn answer(&self) -> &FrameAnswer {
        &self.answer
    }

    /// The model and what is tracked.
    pub fn tracker(&self) -> &Arc<Tracker> {
        &self.tracker
    }
}
