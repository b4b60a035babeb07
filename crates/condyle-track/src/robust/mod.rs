//! Markers that cannot be where the recording says: found, left out or put right, the rest left alone.
//!
//! A marker may lie beside its place on the model all the time; that is no fault. Its *offset* is the
//! median over the trial of what it is off, in the axes of its segment; it *strays* where it is farther
//! from there than its gate, the greater of 40 mm and four scales of its deviations. Faults are changes:
//! a frame is tried with straying labels left out or given to the markers that they fit, starting from a
//! neighbouring frame, and changed only where all markers together fit clearly better (`search`). Labels
//! that are exchanged from the first frame to the last have no frame in which they are right; these are
//! judged by distances alone, offsets not counted (`exchange`).
//!
//! What comes out are [`Repairs`] of the recording. Tracking a [`Corrected`] recording is plain tracking
//! of what is left: no marker is weighed down.

mod assignment;
mod exchange;
mod faults;
mod offsets;
mod search;
mod trial;

pub use exchange::exchanged_throughout;
pub use faults::{Exchanged, Fault, LeftOut, describe};

use crate::answer::FrameAnswer;
use crate::recorded::Recorded;
use crate::tracker::{Scratch, Tracker};
use std::collections::BTreeMap;
use offsets::Offsets;
use trial::Trial;

/// For each marker target the one whose recorded position it gets; `None` if it gets none.
pub type Source = Vec<Option<usize>>;

/// How often offsets are taken again after faults were put right.
const ROUNDS: usize = 3;

/// What is changed in a recording.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct Repairs {
    frames: BTreeMap<usize, Source>,
}

impl Repairs {
    /// Where the markers of a frame come from; `None` if each has its own label.
    pub fn source(&self, frame: usize) -> Option<&Source> {
        self.frames.get(&frame)
    }

    /// The frames in which something is changed.
    pub fn frames(&self) -> impl Iterator<Item = usize> + '_ {
        self.frames.keys().copied()
    }

    /// Whether nothing is changed.
    pub fn is_empty(&self) -> bool {
        self.frames.is_empty()
    }

    /// Markers recorded at exactly 0 0 0, which is how some programs write a marker that they lost.
    pub fn of_origin(tracker: &Tracker, recorded: &dyn Recorded, frames: usize) -> Self {
        let (mut repairs, mut seen) = (Self::default(), vec![]);
        let count = tracker.markers.placed.len();
        for frame in 0..frames {
            recorded.positions(frame, &mut seen);
            let lost = |m: usize| seen.get(m) == Some(&Some([0.0; 3])) && !tracker.markers.placed[m].of_world();
            if (0..count).any(lost) {
                let source = (0..count).map(|m| (!lost(m)).then_some(m)).collect();
                repairs.frames.insert(frame, source);
            }
        }
        repairs
    }

    /// Gives the markers other labels in all frames: marker m that of `labels[m]`, before what is changed
    /// already.
    fn exchange(&mut self, labels: &[usize], frames: usize) {
        for frame in 0..frames {
            let source = match self.frames.get(&frame) {
                Some(source) => labels.iter().map(|&label| source[label]).collect(),
                None => labels.iter().copied().map(Some).collect(),
            };
            self.frames.insert(frame, source);
        }
    }
}

/// A recording with its repairs.
pub struct Corrected<'a> {
    /// The recording as it is.
    pub recorded: &'a dyn Recorded,
    /// What is changed in it.
    pub repairs: &'a Repairs,
}

impl Recorded for Corrected<'_> {
    fn positions(&self, frame: usize, seen: &mut Vec<Option<[f64; 3]>>) {
        self.recorded.positions(frame, seen);
        if let Some(source) = self.repairs.source(frame) {
            let row = std::mem::take(seen);
            seen.extend(source.iter().map(|label| row.get((*label)?).copied().flatten()));
        }
    }
}

/// Finds faults, from the answers of a tracking of the recording with `repairs`, which get them added.
/// The answers become those of the repaired frames.
pub fn find(
    tracker: &Tracker,
    scratch: &mut Scratch,
    recorded: &dyn Recorded,
    repairs: &mut Repairs,
    answers: &mut Vec<FrameAnswer>,
) {
    let mut trial = Trial::new(tracker, recorded, repairs, answers);
    trial.measure(scratch, None);
    // Faults make a frame fit worse, so offsets are first taken where it fits well.
    let mut frames: Vec<usize> = (0..trial.frames).collect();
    frames.sort_by(|&a, &b| trial.answers[a].minimised().total_cmp(&trial.answers[b].minimised()));
    frames.truncate(trial.frames.div_ceil(2).max(FEW.min(trial.frames)));
    for round in 0..ROUNDS {
        let offsets = Offsets::of(&trial, &frames);
        trial.measure(scratch, Some(&offsets));
        if !search::search(&mut trial, scratch, &offsets) && round > 0 {
            break;
        }
        frames = (0..trial.frames).collect();
    }
    repairs.frames.clear();
    for (frame, source) in trial.sources.into_iter().enumerate() {
        if let Some(source) = source {
            repairs.frames.insert(frame, source);
        }
    }
    *answers = trial.answers;
}

/// Of a shorter trial all frames count.
const FEW: usize = 24;
