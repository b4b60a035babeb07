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
mod cost;
mod exchange;
mod faults;
mod offsets;
mod search;
mod trial;

pub use assignment::assign;
pub use exchange::exchanged_throughout;
pub use faults::{Exchanged, Fault, Faulty, describe};
pub use offsets::FEWEST_FRAMES;

use crate::answer::FrameAnswer;
use crate::recorded::Recorded;
use crate::tracker::{Scratch, Tracker};
use search::Search;
use std::collections::BTreeMap;
use trial::Trial;

/// For each marker target the one whose recorded position it gets; `None` if it gets none.
type Source = Vec<Option<usize>>;

/// How often offsets are taken again after faults were put right.
const ROUNDS: usize = 3;
/// Where even in the better quarter of frames half of the markers are farther off than this, in metres,
/// recording and model do not belong together, and no label alone is to blame.
const WORST: f64 = 0.150;
/// A label this many gates from its offset that is used all the same is told.
const UNRESOLVED: f64 = 2.0;

/// What is changed in a recording.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct Repairs {
    /// The labels that each frame has at 0 0 0.
    lost: BTreeMap<usize, Vec<usize>>,
    /// For each marker the label that it has throughout; empty where each has its own.
    throughout: Vec<usize>,
    /// The frames in which that is not so.
    frames: BTreeMap<usize, Source>,
    /// Frame and label of what strays far and is used all the same.
    unresolved: Vec<(usize, usize)>,
}

impl Repairs {
    /// Leaves out markers recorded at exactly 0 0 0, which is how some programs write one that they
    /// lost.
    pub fn of_origin(tracker: &Tracker, recorded: &dyn Recorded, frames: usize) -> Self {
        let (mut repairs, mut seen) = (Self::default(), vec![]);
        for frame in 0..frames {
            recorded.positions(frame, &mut seen);
            let labels = seen.iter().zip(&tracker.markers.placed).enumerate();
            let lost =
                labels.filter(|(_, (seen, placed))| **seen == Some([0.0; 3]) && !placed.of_world());
            let lost: Vec<usize> = lost.map(|(label, _)| label).collect();
            if !lost.is_empty() {
                repairs.lost.insert(frame, lost);
            }
        }
        repairs
    }

    /// The labels of `count` markers in a frame; `None` if each has its own.
    fn source(&self, frame: usize, count: usize) -> Option<Source> {
        let lost = self.lost.get(&frame);
        if lost.is_none() && self.throughout.is_empty() && !self.frames.contains_key(&frame) {
            return None;
        }
        let throughout = |label: usize| self.throughout.get(label).map_or(label, |&label| label);
        let mut source: Source = match self.frames.get(&frame) {
            Some(source) => source.iter().map(|label| label.map(throughout)).collect(),
            None => (0..count).map(|marker| Some(throughout(marker))).collect(),
        };
        for label in source
            .iter_mut()
            .filter(|l| l.is_some_and(|l| lost.is_some_and(|lost| lost.contains(&l))))
        {
            *label = None;
        }
        Some(source)
    }

    /// Gives the markers other labels in all frames: marker m that of `labels[m]`, before what is changed
    /// already.
    fn exchange(&mut self, labels: &[usize]) {
        let before = |label: usize| self.throughout.get(label).map_or(label, |&label| label);
        self.throughout = labels.iter().map(|&label| before(label)).collect();
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
        if let Some(source) = self.repairs.source(frame, seen.len()) {
            let row = std::mem::take(seen);
            seen.extend(source.iter().map(|label| row.get((*label)?).copied().flatten()));
        }
    }
}

/// Finds faults, from the answers of a tracking of the recording with `repairs`, which get them added.
/// The answers become those of the repaired frames; all others stay as they are.
pub fn find(
    tracker: &Tracker,
    scratch: &mut Scratch,
    recorded: &dyn Recorded,
    repairs: &mut Repairs,
    answers: &mut Vec<FrameAnswer>,
) {
    // Faults make a frame fit worse, so offsets are first taken where it fits well.
    let all: Vec<usize> = (0..answers.len()).collect();
    let mut good = all.clone();
    good.sort_by(|&a, &b| answers[a].minimised().total_cmp(&answers[b].minimised()));
    let middle = |frame: &usize| {
        let errors = answers[*frame].marker_errors.iter().filter(|e| e.is_finite());
        offsets::median(&mut errors.copied().collect::<Vec<_>>())
    };
    if good.get(good.len() / 4).is_some_and(|frame| middle(frame) > WORST) {
        return;
    }
    good.truncate(good.len().div_ceil(2).max(2 * FEWEST_FRAMES));
    let corrected = Corrected { recorded, repairs };
    let trial = Trial::new(tracker, scratch, &corrected, std::mem::take(answers));
    let mut search = Search::new(trial, scratch);
    search.take_offsets(&good);
    for round in 0..ROUNDS {
        if !search.run(round) {
            break;
        }
        search.take_offsets(&all);
    }
    search.take_back();
    let trial = search.trial;
    let throughout = |label: usize| repairs.throughout.get(label).map_or(label, |&label| label);
    let far = trial.far(UNRESOLVED).into_iter();
    repairs.unresolved = far.map(|(frame, label)| (frame, throughout(label))).collect();
    let sources = trial.sources.into_iter().enumerate();
    repairs.frames = sources.filter_map(|(frame, source)| Some((frame, source?))).collect();
    *answers = trial.answers;
}
