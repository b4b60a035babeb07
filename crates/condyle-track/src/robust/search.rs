//! The search for faults: frame by frame, from a neighbour, forwards and backwards until nothing changes.

use super::Source;
use super::trial::Trial;
use crate::answer::{FrameAnswer, FrameStatus, better};
use crate::sequence::FIRST_GUESSES;
use crate::tracker::Scratch;
use condyle_math::Vec3;

/// A label this share of its gate from where its marker is expected is looked at.
const LOOK: f64 = 0.75;
/// Two postures whose F + P differ by this share, or in m², are alike; one that turns a joint less by
/// this, in radians, goes on from its neighbour.
const ALIKE: f64 = 1e-4;
const ALIKE_FLOOR: f64 = 1e-9;
const LEAST_TURN: f64 = 0.1;
/// How often a frame is solved with labels given anew.
const ROUNDS: usize = 4;
/// How often the trial is gone through in both directions.
const PASSES: usize = 3;
/// Of a run of frames that stray alike and were not changed, each so many-th is tried.
const STRIDE: usize = 8;

/// A trial in which faults are looked for.
pub(super) struct Search<'a> {
    pub trial: Trial<'a>,
    scratch: &'a mut Scratch,
    /// How often each frame was changed.
    changes: Vec<u32>,
    /// For both directions what was known of each frame when it was tried last.
    tried: [Vec<Option<Known>>; 2],
    /// How many labels strayed in the frame before, and how many frames in a row were rejected.
    straying: usize,
    rejected: usize,
    /// Where the markers of the frame at hand should be, and what they are given.
    places: Vec<Vec3>,
    seen: Vec<Option<[f64; 3]>>,
}

/// What decides whether a frame is worth another try.
#[derive(Clone, Copy, PartialEq)]
struct Known {
    changes_around: u32,
    straying: usize,
    /// The round, for a frame with changed labels.
    round: Option<usize>,
}

/// A frame with its neighbours on one side.
#[derive(Clone, Copy)]
struct Place {
    frame: usize,
    near: [Option<usize>; 2],
    backwards: bool,
    round: usize,
}

/// What a frame may become.
struct Found {
    cost: f64,
    source: Option<Source>,
    answer: FrameAnswer,
}

impl<'a> Search<'a> {
    pub(super) fn new(trial: Trial<'a>, scratch: &'a mut Scratch) -> Self {
        let frames = trial.frames;
        Self {
            trial,
            scratch,
            changes: vec![0; frames],
            tried: [vec![None; frames], vec![None; frames]],
            straying: 0,
            rejected: 0,
            places: vec![],
            seen: vec![],
        }
    }

    /// Takes offsets from these frames, and measures all by them.
    pub(super) fn take_offsets(&mut self, frames: &[usize]) {
        self.trial.take_offsets(frames);
        self.trial.measure(self.scratch);
    }

    /// Changes labels and answers where that clearly fits better; whether any was changed.
    pub(super) fn run(&mut self, round: usize) -> bool {
        let frames = self.trial.frames;
        let mut any = false;
        for pass in 0..2 * PASSES {
            let backwards = pass % 2 == 1;
            let mut changed = false;
            self.rejected = 0;
            for step in 0..frames {
                let frame = if backwards { frames - 1 - step } else { step };
                let before = |by: usize| {
                    let at = if backwards { Some(frame + by) } else { frame.checked_sub(by) };
                    at.filter(|&at| at < frames)
                };
                let near = [before(1), before(2)];
                if self.try_frame(Place { frame, near, backwards, round }) {
                    self.changes[frame] += 1;
                    changed = true;
                }
            }
            any |= changed;
            if pass > 0 && !changed {
                break;
            }
        }
        any
    }

    /// Tries a frame from its neighbours; whether it was changed.
    fn try_frame(&mut self, at: Place) -> bool {
        let (trial, frame) = (&self.trial, at.frame);
        if trial.row(frame).iter().all(Option::is_none) {
            return false;
        }
        let usable = |f: &usize| trial.answers[*f].status != FrameStatus::NoMarkers;
        let near = at.near.map(|f| f.filter(usable));
        self.places.clear();
        match near {
            [Some(a), Some(b)] => {
                let places = trial.places(a).iter().zip(trial.places(b));
                self.places.extend(places.map(|(&y, &z)| y + (y - z)));
            }
            [Some(a), None] => self.places.extend_from_slice(trial.places(a)),
            _ => self.places.extend_from_slice(trial.places(frame)),
        }
        let own = trial.sources[frame].is_none();
        let moved = near[0].is_some_and(|near| self.changes[near] > 0);
        let straying = trial.straying(frame, trial.places(frame), 1.0)
            + trial.straying(frame, &self.places, LOOK);
        let again = straying == std::mem::replace(&mut self.straying, straying);
        if own && straying == 0 && !moved {
            self.rejected = 0;
            return false;
        }
        let around = at.near.into_iter().flatten().chain([frame]).map(|f| self.changes[f]);
        let round = (!own).then_some(at.round);
        let known = Some(Known { changes_around: around.sum(), straying, round });
        let last = &mut self.tried[usize::from(at.backwards)][frame];
        // Where the same labels stray for long and nothing else fits, not every frame is tried.
        let skipped = own && again && !moved && !self.rejected.is_multiple_of(STRIDE);
        if skipped || *last == known {
            self.rejected += 1;
            return false;
        }
        *last = known;
        let accepted =
            self.solve(frame, near[0]).filter(|found| self.accepts(frame, near[0], found));
        let Some(found) = accepted else {
            self.rejected += 1;
            return false;
        };
        self.rejected = 0;
        let found = self.as_it_is(frame, near[0], &found).unwrap_or(found);
        self.put(frame, found);
        true
    }

    /// Solves a frame from a neighbour with the labels that fit what is expected, then with those that fit
    /// what was solved, until they agree; the one that costs least.
    fn solve(&mut self, frame: usize, near: Option<usize>) -> Option<Found> {
        let trial = &self.trial;
        let mut best: Option<Found> = None;
        let mut answer = trial.answers[near.unwrap_or(frame)].clone();
        let mut source = trial.nearest(frame, &self.places);
        for _ in 0..ROUNDS {
            self.seen.clear();
            let row = trial.row(frame);
            match &source {
                None => self.seen.extend_from_slice(row),
                Some(source) => self.seen.extend(source.iter().map(|label| row[(*label)?])),
            }
            trial.tracker.solve_into(self.scratch, &self.seen, frame, &mut answer);
            trial.place_beside(self.scratch, &mut self.places);
            let next = trial.nearest(frame, &self.places);
            let cost = trial.cost(frame, source.as_ref(), &self.places, &answer);
            let agree = next == source;
            if best.as_ref().is_none_or(|best| cost < best.cost) {
                best = Some(Found { cost, source, answer: answer.clone() });
            }
            if agree {
                break;
            }
            source = next;
        }
        best
    }

    /// Whether a frame should become what was found.
    fn accepts(&self, frame: usize, near: Option<usize>, found: &Found) -> bool {
        let trial = &self.trial;
        let (before, after) = (&trial.answers[frame], &found.answer);
        let broken = |answer: &FrameAnswer| answer.status == FrameStatus::Infeasible;
        if found.source == trial.sources[frame] {
            // The same labels: a better posture, or one as good that goes on from the neighbour.
            let turn = |answer| {
                near.map_or(0.0, |near| trial.tracker.largest_turn(&trial.answers[near], answer))
            };
            let alike = after.minimised() <= before.minimised() * (1.0 + ALIKE) + ALIKE_FLOOR;
            let goes_on = near.is_some_and(|near| self.changes[near] > 0)
                && turn(after) < turn(before) - LEAST_TURN;
            return better(after, before) || alike && goes_on && broken(after) == broken(before);
        }
        let own = |source: Option<&Source>| {
            let own = |source: &Source| (0..trial.count).filter(|&m| source[m] == Some(m)).count();
            source.map_or(trial.count, own)
        };
        let (old, new) = (trial.sources[frame].as_ref(), found.source.as_ref());
        // What changes less of the recording need not fit better.
        let fewer = own(new) > own(old);
        let needed = if fewer { 0.0 } else { trial.needed(frame, new, found.cost) };
        let now = trial.cost(frame, old, trial.places(frame), before);
        (broken(before) || !broken(after)) && found.cost <= now - needed
    }

    /// Where faults begin: the frame as it is from first guesses, if that fits nearly as well. The frames
    /// so far may have been in a wrong minimum, which no label is to blame for.
    fn as_it_is(&mut self, frame: usize, near: Option<usize>, found: &Found) -> Option<Found> {
        let trial = &self.trial;
        if found.source.is_none() || near.is_some_and(|near| trial.sources[near].is_some()) {
            return None;
        }
        let row = trial.row(frame);
        let answer = trial.tracker.solve_first(self.scratch, row, frame, FIRST_GUESSES);
        self.scratch.buffers.pose_at(trial.tracker, &answer.coordinates)?;
        trial.place_beside(self.scratch, &mut self.places);
        let cost = trial.cost(frame, None, &self.places, &answer);
        let enough = found.cost + trial.needed(frame, found.source.as_ref(), found.cost);
        let taken = cost < enough && better(&answer, &trial.answers[frame]);
        taken.then_some(Found { cost, source: None, answer })
    }

    fn put(&mut self, frame: usize, found: Found) {
        let trial = &mut self.trial;
        let before = std::mem::replace(&mut trial.answers[frame], found.answer);
        trial.plain[frame].get_or_insert(before);
        trial.sources[frame] = found.source;
        trial.measure_frame(self.scratch, frame);
    }

    /// Takes back the changes of frames that, by the last offsets, fit no better than as they were.
    pub(super) fn take_back(&mut self) {
        let trial = &mut self.trial;
        for frame in 0..trial.frames {
            let Some(plain) = trial.plain[frame].take() else { continue };
            let Some(source) = &trial.sources[frame] else { continue };
            if self.scratch.buffers.pose_at(trial.tracker, &plain.coordinates).is_none() {
                continue;
            }
            trial.place_beside(self.scratch, &mut self.places);
            let before = trial.cost(frame, None, &self.places, &plain);
            let now = trial.cost(frame, Some(source), trial.places(frame), &trial.answers[frame]);
            if now > before - trial.needed(frame, Some(source), now) {
                trial.sources[frame] = None;
                trial.answers[frame] = plain;
                trial.measure_frame(self.scratch, frame);
            }
        }
    }
}
