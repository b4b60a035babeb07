//! Frame by frame: what fits where, judged from a neighbouring frame.
//!
//! With the place y of each marker with its offset, and the gate g from which on it strays, the cost of
//! a frame is
//!
//! ```text
//! C = Σₗ wₗ min(|eₗ|², gₗ²) / Σₗ wₗ  +  P + other targets
//! ```
//!
//! over all labels seen: e is how far label l is from the marker that it is given to, and a label that is
//! given to none costs g². A frame is changed only where C falls clearly. Because a label left out costs
//! as much as one that strays, it falls only if the other markers come nearer to their own places.

use super::Source;
use super::assignment::assign;
use super::offsets::Offsets;
use super::trial::Trial;
use crate::answer::{FrameAnswer, FrameStatus, better};
use crate::sequence::FIRST_GUESSES;
use crate::tracker::Scratch;
use condyle_math::Vec3;
use condyle_model::Mode;

/// A label this share of its gate from where its marker is expected is looked at.
const LOOK: f64 = 0.75;
/// A label is another marker's if it is nearer to that by this factor.
const NEARER: f64 = 0.5;
/// C must fall by this share of what the kept markers leave, and by this, in m².
const GAIN: f64 = 0.10;
const LEAST_GAIN: f64 = 1e-6;
/// Two postures whose F + P differ by this share are alike; one that turns a joint less by this, in
/// radians, goes on from its neighbour.
const ALIKE: f64 = 1e-4;
const LEAST_TURN: f64 = 0.1;
/// How often a frame is solved with labels given anew.
const ROUNDS: usize = 4;
/// How often the trial is gone through in both directions.
const PASSES: usize = 3;
/// Of a run of frames that stray alike and were not changed, each so many-th is tried.
const STRIDE: usize = 8;

/// Changes labels and answers of a trial where that clearly fits better; whether any was changed.
pub(super) fn search(trial: &mut Trial<'_>, scratch: &mut Scratch, offsets: &Offsets) -> bool {
    let mut any = false;
    // How often each frame was changed, and what was the count around it when it was tried last.
    let mut changes = vec![0_u32; trial.frames];
    let mut tried = [vec![u32::MAX; trial.frames], vec![u32::MAX; trial.frames]];
    let mut candidate = Candidate::default();
    for pass in 0..2 * PASSES {
        let backwards = pass % 2 == 1;
        let mut changed = false;
        candidate.rejected = 0;
        for step in 0..trial.frames {
            let frame = if backwards { trial.frames - 1 - step } else { step };
            let before = |by: usize| {
                let at = if backwards { Some(frame + by) } else { frame.checked_sub(by) };
                at.filter(|&at| at < trial.frames)
            };
            let near = [before(1), before(2)];
            let around = near.iter().flatten().chain(&[frame]).map(|&f| changes[f]).sum();
            if tried[usize::from(backwards)][frame] == around {
                continue;
            }
            tried[usize::from(backwards)][frame] = around;
            let moved = near[0].is_some_and(|near| changes[near] > 0);
            if candidate.try_frame(trial, scratch, offsets, frame, near, moved) {
                changes[frame] += 1;
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

/// The buffers of one frame that is tried.
#[derive(Default)]
struct Candidate {
    /// How many labels strayed in the frame before, and how many frames in a row were rejected.
    straying: usize,
    rejected: usize,
    expected: Vec<Vec3>,
    seen: Vec<Option<[f64; 3]>>,
}

impl Candidate {
    /// Tries a frame from its neighbours on one side, of which the nearer was `moved` by now or not;
    /// whether it was changed.
    fn try_frame(
        &mut self,
        trial: &mut Trial<'_>,
        scratch: &mut Scratch,
        offsets: &Offsets,
        frame: usize,
        near: [Option<usize>; 2],
        moved: bool,
    ) -> bool {
        if trial.row(frame).iter().all(Option::is_none) {
            return false;
        }
        let usable = |f: &usize| trial.answers[*f].status != FrameStatus::NoMarkers;
        let near = near.map(|f| f.filter(usable));
        self.expected.clear();
        match near {
            [Some(a), Some(b)] => {
                let places = trial.places(a).iter().zip(trial.places(b));
                self.expected.extend(places.map(|(&y, &z)| y + (y - z)));
            }
            [Some(a), None] => self.expected.extend_from_slice(trial.places(a)),
            _ => self.expected.extend_from_slice(trial.places(frame)),
        }
        let strays = |places: &[Vec3], share: f64| {
            let away = |marker: &usize| {
                let label = trial.label(frame, *marker);
                let off =
                    label.and_then(|label| distance(trial.row(frame)[label], places[*marker]));
                off.zip(label)
                    .is_some_and(|(off, label)| off > share * trial.gate(offsets, frame, label))
            };
            (0..trial.count).filter(away).count()
        };
        let own = trial.sources[frame].is_none();
        let straying = strays(trial.places(frame), 1.0) + strays(&self.expected, LOOK);
        // Where the same labels stray for long and nothing else fits, not every frame is tried.
        let again = straying == std::mem::replace(&mut self.straying, straying);
        if own && straying == 0 && !moved {
            self.rejected = 0;
            return false;
        }
        if own && again && !moved && self.rejected > 0 && self.rejected % STRIDE != 0 {
            self.rejected += 1;
            return false;
        }
        let now = cost(trial, offsets, frame, &trial.sources[frame], trial.places(frame))
            + beside(trial, &trial.answers[frame]);
        let mut best: Option<(f64, Option<Source>, FrameAnswer)> = None;
        let mut answer = trial.answers[near[0].unwrap_or(frame)].clone();
        let mut source = labels(trial, offsets, frame, &self.expected);
        for _ in 0..ROUNDS {
            self.seen.clear();
            give(trial.row(frame), source.as_ref(), &mut self.seen);
            trial.tracker.solve_into(scratch, &self.seen, frame, &mut answer);
            self.expected.clear();
            let placed = trial.tracker.markers.placed.iter().zip(&offsets.offsets);
            let pose = &scratch.buffers.pose;
            self.expected.extend(placed.map(|(placed, &offset)| placed.beside(pose, offset)));
            let next = labels(trial, offsets, frame, &self.expected);
            let found =
                cost(trial, offsets, frame, &source, &self.expected) + beside(trial, &answer);
            if best.as_ref().is_none_or(|(least, ..)| found < *least) {
                best = Some((found, source.clone(), answer.clone()));
            }
            if next == source {
                break;
            }
            source = next;
        }
        let Some((found, source, answer)) = best else { return false };
        let before = &trial.answers[frame];
        let broken = |answer: &FrameAnswer| answer.status == FrameStatus::Infeasible;
        let accepted = if source == trial.sources[frame] {
            // The same labels: a better posture, or one as good that goes on from the neighbour.
            let neighbour = near[0].map(|near| &trial.answers[near]);
            let turn =
                |answer| neighbour.map_or(0.0, |near| trial.tracker.largest_turn(near, answer));
            let alike = answer.minimised() <= before.minimised() * (1.0 + ALIKE) + 1e-9;
            better(&answer, before)
                || moved
                    && alike
                    && broken(&answer) == broken(before)
                    && turn(&answer) < turn(before) - LEAST_TURN
        } else {
            // What changes less of the recording need not fit better.
            let fewer =
                own_labels(&source, trial.count) > own_labels(&trial.sources[frame], trial.count);
            let needed = if fewer { 0.0 } else { needed(trial, offsets, frame, &source, found) };
            (broken(before) || !broken(&answer)) && found <= now - needed
        };
        if !accepted {
            self.rejected += 1;
            return false;
        }
        let (source, answer) =
            match self.as_it_is(trial, scratch, offsets, frame, near[0], &source, found) {
                Some(again) => (None, again),
                None => (source, answer),
            };
        self.rejected = 0;
        let before = std::mem::replace(&mut trial.answers[frame], answer);
        trial.plain[frame].get_or_insert(before);
        trial.sources[frame] = source;
        let pose = &mut scratch.buffers.pose;
        let coordinates = &trial.answers[frame].coordinates;
        if trial.tracker.program.evaluate(coordinates, Mode::Open, pose).is_ok() {
            trial.measure_at(scratch, Some(offsets), frame);
        }
        true
    }

    /// Where faults begin: the answer of the frame as it is from first guesses, if that fits nearly as
    /// well. The frames so far may have been in a wrong minimum, which no label is to blame for.
    #[expect(clippy::too_many_arguments)]
    fn as_it_is(
        &mut self,
        trial: &Trial<'_>,
        scratch: &mut Scratch,
        offsets: &Offsets,
        frame: usize,
        near: Option<usize>,
        source: &Option<Source>,
        found: f64,
    ) -> Option<FrameAnswer> {
        if source.is_none() || near.is_some_and(|near| trial.sources[near].is_some()) {
            return None;
        }
        let row = trial.row(frame);
        let again = trial.tracker.solve_first(scratch, row, frame, FIRST_GUESSES);
        let pose = &mut scratch.buffers.pose;
        trial.tracker.program.evaluate(&again.coordinates, Mode::Open, pose).ok()?;
        self.expected.clear();
        let placed = trial.tracker.markers.placed.iter().zip(&offsets.offsets);
        self.expected.extend(placed.map(|(placed, &offset)| placed.beside(pose, offset)));
        let as_it_is = cost(trial, offsets, frame, &None, &self.expected) + beside(trial, &again);
        let enough = found + needed(trial, offsets, frame, source, found);
        (as_it_is < enough && better(&again, &trial.answers[frame])).then_some(again)
    }
}

fn distance(seen: Option<[f64; 3]>, place: Vec3) -> Option<f64> {
    Some((Vec3::from(seen?) - place).norm())
}

/// By how much C must fall before labels are changed, in m².
fn needed(
    trial: &Trial<'_>,
    offsets: &Offsets,
    frame: usize,
    source: &Option<Source>,
    found: f64,
) -> f64 {
    LEAST_GAIN + GAIN * (found - out(trial, offsets, frame, source))
}

/// Takes back the changes of frames that, by the last offsets, fit no better than as they were.
pub(super) fn take_back(trial: &mut Trial<'_>, scratch: &mut Scratch, offsets: &Offsets) {
    let mut places = vec![];
    for frame in 0..trial.frames {
        let Some(plain) = trial.plain[frame].take() else { continue };
        let pose = &mut scratch.buffers.pose;
        if trial.sources[frame].is_none()
            || trial.tracker.program.evaluate(&plain.coordinates, Mode::Open, pose).is_err()
        {
            continue;
        }
        places.clear();
        let placed = trial.tracker.markers.placed.iter().zip(&offsets.offsets);
        places.extend(placed.map(|(placed, &offset)| placed.beside(pose, offset)));
        let before = cost(trial, offsets, frame, &None, &places) + beside(trial, &plain);
        let source = &trial.sources[frame];
        let now = cost(trial, offsets, frame, source, trial.places(frame))
            + beside(trial, &trial.answers[frame]);
        if now > before - needed(trial, offsets, frame, source, now) {
            trial.sources[frame] = None;
            trial.answers[frame] = plain;
        }
    }
}

/// What is minimised besides the markers, in m².
fn beside(trial: &Trial<'_>, answer: &FrameAnswer) -> f64 {
    let markers = trial.tracker.markers.placed.iter().zip(&answer.marker_errors);
    let used: f64 = markers.filter(|(_, e)| e.is_finite()).map(|(m, _)| m.weight).sum();
    let mean = if used > 0.0 { answer.weighted_squares / used } else { 0.0 };
    answer.minimised() - mean
}

/// How many markers have their own label.
fn own_labels(source: &Option<Source>, count: usize) -> usize {
    let own = |source: &Source| (0..count).filter(|&m| source[m] == Some(m)).count();
    source.as_ref().map_or(count, own)
}

/// The labels of the markers that are nearest to these places: its own within the gate, else another's
/// that strays, or none. `None` if each has its own.
fn labels(trial: &Trial<'_>, offsets: &Offsets, frame: usize, places: &[Vec3]) -> Option<Source> {
    let row = trial.row(frame);
    let gates: Vec<f64> = (0..trial.count).map(|l| trial.gate(offsets, frame, l)).collect();
    let off =
        |label: usize, marker: usize| distance(row[label], places[marker]).unwrap_or(f64::INFINITY);
    let own = |m: usize| off(m, m) <= gates[m];
    let suspects: Vec<usize> = (0..trial.count).filter(|&m| row[m].is_some() && !own(m)).collect();
    if suspects.is_empty() {
        return None;
    }
    let free: Vec<usize> = (0..trial.count).filter(|&m| row[m].is_none() || !own(m)).collect();
    // After the free markers one column for each label that is given to none.
    let cost = |s: usize, column: usize| {
        let label = suspects[s];
        let Some(&marker) = free.get(column) else { return gates[label].powi(2) };
        let away = off(label, marker);
        let fits = away < gates[marker].min(gates[label])
            && (label == marker || away < NEARER * off(label, label));
        if fits { away * away } else { 1e6 }
    };
    let columns = assign(suspects.len(), free.len() + suspects.len(), cost)?;
    let mut source: Source = (0..trial.count).map(Some).collect();
    suspects.iter().for_each(|&label| source[label] = None);
    for (s, column) in columns.into_iter().enumerate() {
        if let Some(&marker) = free.get(column) {
            source[marker] = Some(suspects[s]);
        }
    }
    Some(source)
}

/// The recorded positions of the markers of a frame.
pub(super) fn give(
    row: &[Option<[f64; 3]>],
    source: Option<&Source>,
    seen: &mut Vec<Option<[f64; 3]>>,
) {
    match source {
        None => seen.extend_from_slice(row),
        Some(source) => seen.extend(source.iter().map(|label| row[(*label)?])),
    }
}

/// The markers' part of C, in m².
fn cost(
    trial: &Trial<'_>,
    offsets: &Offsets,
    frame: usize,
    source: &Option<Source>,
    places: &[Vec3],
) -> f64 {
    let row = trial.row(frame);
    let mut squares = 0.0;
    for marker in 0..trial.count {
        let label = source.as_ref().map_or(Some(marker), |source| source[marker]);
        let Some(label) = label else { continue };
        let Some(off) = distance(row[label], places[marker]) else { continue };
        squares += trial.tracker.markers.placed[label].weight
            * off.min(trial.gate(offsets, frame, label)).powi(2);
    }
    squares / total(trial, frame) + out(trial, offsets, frame, source)
}

/// What the labels given to none add to C, in m².
fn out(trial: &Trial<'_>, offsets: &Offsets, frame: usize, source: &Option<Source>) -> f64 {
    let Some(source) = source else { return 0.0 };
    let mut given = vec![false; trial.count];
    source.iter().flatten().for_each(|&label| given[label] = true);
    let labels = (0..trial.count).filter(|&l| !given[l] && trial.row(frame)[l].is_some());
    let squares = labels
        .map(|l| trial.tracker.markers.placed[l].weight * trial.gate(offsets, frame, l).powi(2));
    squares.sum::<f64>() / total(trial, frame)
}

/// Sum of the weights of the labels seen in a frame.
fn total(trial: &Trial<'_>, frame: usize) -> f64 {
    let seen = trial.row(frame).iter().zip(&trial.tracker.markers.placed);
    let sum: f64 = seen.filter(|(seen, _)| seen.is_some()).map(|(_, m)| m.weight).sum();
    if sum > 0.0 { sum } else { 1.0 }
}
