//! Repairs frame by frame, told as faults over ranges of frames.

use super::{Repairs, Source};
use crate::recorded::Recorded;
use std::collections::BTreeMap;
use std::ops::Range;

/// Labels that go round over a run of frames: each is recorded at the place of the next marker, the last
/// at that of the first.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Exchanged {
    /// Positions among the marker targets, the lowest first.
    pub cycle: Vec<usize>,
    /// The frames.
    pub frames: Range<usize>,
}

/// A label at which something is the matter over a run of frames.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Faulty {
    /// Position among the marker targets.
    pub marker: usize,
    /// The frames.
    pub frames: Range<usize>,
    /// What is the matter with it.
    pub fault: Fault,
}

/// What is the matter with a label.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Fault {
    /// It is at exactly 0 0 0, and left out.
    AtOrigin,
    /// It stands still where the body moves on, and is left out.
    Frozen,
    /// It is where no marker can be that the others leave a place for, and is left out.
    Elsewhere,
    /// It is far from its own offset, and nothing was found that fits clearly better: it is used as it is.
    Unresolved,
}

impl Fault {
    /// The word for it in reports.
    pub fn name(self) -> &'static str {
        match self {
            Self::AtOrigin => "at 0 0 0",
            Self::Frozen => "frozen",
            Self::Elsewhere => "elsewhere",
            Self::Unresolved => "not resolved",
        }
    }

    /// Whether such a label is left out.
    pub fn is_left_out(self) -> bool {
        self != Self::Unresolved
    }
}

/// A marker that moves by less than this over its frames stands still, in metres.
const STILL: f64 = 0.001;
/// Fewer frames than this do not say whether a marker stands still.
const FEWEST_STILL: usize = 4;

/// The faults that repairs of a recording put right or leave out.
pub fn describe(
    recorded: &dyn Recorded,
    repairs: &Repairs,
    frames: usize,
) -> (Vec<Exchanged>, Vec<Faulty>) {
    let mut seen = vec![];
    let mut cycles: BTreeMap<Vec<usize>, Vec<usize>> = BTreeMap::new();
    let mut out: BTreeMap<usize, Vec<(usize, [f64; 3])>> = BTreeMap::new();
    for frame in 0..frames {
        recorded.positions(frame, &mut seen);
        let Some(source) = repairs.source(frame, seen.len()) else { continue };
        for cycle in cycles_of(&source) {
            cycles.entry(cycle).or_default().push(frame);
        }
        for (label, seen) in seen.iter().enumerate() {
            if let Some(seen) = *seen
                && !source.contains(&Some(label))
            {
                out.entry(label).or_default().push((frame, seen));
            }
        }
    }
    let mut unseen = |label: usize, frame: usize| {
        recorded.positions(frame, &mut seen);
        seen.get(label).copied().flatten().is_none()
    };
    let mut exchanged = vec![];
    for (cycle, frames) in cycles {
        let hole = |frame: usize, unseen: &mut dyn FnMut(usize, usize) -> bool| {
            cycle.iter().any(|&label| unseen(label, frame))
        };
        for frames in runs(&frames, |frame| hole(frame, &mut unseen)) {
            exchanged.push(Exchanged { cycle: cycle.clone(), frames });
        }
    }
    let mut faulty = vec![];
    for (marker, places) in out {
        let frames: Vec<usize> = places.iter().map(|&(frame, _)| frame).collect();
        for frames in runs(&frames, |frame| unseen(marker, frame)) {
            let places = places.iter().filter(|(frame, _)| frames.contains(frame));
            let fault = fault_of(&places.map(|&(_, place)| place).collect::<Vec<_>>());
            faulty.push(Faulty { marker, frames, fault });
        }
    }
    let mut unresolved: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
    for &(frame, label) in &repairs.unresolved {
        unresolved.entry(label).or_default().push(frame);
    }
    for (marker, frames) in unresolved {
        let runs = runs(&frames, |frame| unseen(marker, frame)).into_iter();
        faulty.extend(runs.map(|frames| Faulty { marker, frames, fault: Fault::Unresolved }));
    }
    exchanged.sort_by_key(|e| e.frames.start);
    faulty.sort_by_key(|f| (f.fault, f.frames.start));
    (exchanged, faulty)
}

fn fault_of(places: &[[f64; 3]]) -> Fault {
    if places.iter().all(|place| *place == [0.0; 3]) {
        return Fault::AtOrigin;
    }
    let still = (0..3).all(|axis| {
        let values = places.iter().map(|place| place[axis]);
        let (low, high) =
            values.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), x| (l.min(x), h.max(x)));
        high - low < STILL
    });
    if still && places.len() >= FEWEST_STILL { Fault::Frozen } else { Fault::Elsewhere }
}

/// Joins frames into runs over holes in which nothing could be said.
fn runs(frames: &[usize], mut hole: impl FnMut(usize) -> bool) -> Vec<Range<usize>> {
    let mut runs: Vec<Range<usize>> = vec![];
    for &frame in frames {
        match runs.last_mut() {
            Some(run) if (run.end..frame).all(&mut hole) => run.end = frame + 1,
            _ => runs.push(frame..frame + 1),
        }
    }
    runs
}

/// The cycles of labels in a frame. A chain whose last label is given to no marker closes with it.
fn cycles_of(source: &Source) -> Vec<Vec<usize>> {
    let mut marker_of = vec![None; source.len()];
    for (marker, label) in source.iter().enumerate() {
        if let Some(label) = *label {
            marker_of[label] = Some(marker);
        }
    }
    let mut done = vec![false; source.len()];
    let mut cycles = vec![];
    // Chains begin at a marker without a label.
    let begins = |label: &usize| source[*label].is_none();
    let heads = (0..source.len()).filter(begins).chain(0..source.len());
    for head in heads {
        let (mut cycle, mut at) = (vec![], Some(head));
        while let Some(label) = at
            && !done[label]
        {
            done[label] = true;
            cycle.push(label);
            at = marker_of[label];
        }
        if cycle.len() > 1 {
            let lowest = (0..cycle.len()).min_by_key(|&i| cycle[i]).unwrap_or(0);
            cycle.rotate_left(lowest);
            cycles.push(cycle);
        }
    }
    cycles
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cycles_and_chains_are_told_apart_from_labels_left_out() {
        // Labels 0 and 3 exchanged; 1 -> 2 -> 4 -> 1; 5 in place; 6 left out.
        let source = vec![Some(3), Some(4), Some(1), Some(0), Some(2), Some(5), None];
        assert_eq!(cycles_of(&source), [vec![0, 3], vec![1, 2, 4]]);
        // Label 2 belongs to marker 0, label 0 to none: they are exchanged, and 0 is left out.
        assert_eq!(cycles_of(&vec![Some(2), Some(1), None]), [vec![0, 2]]);
    }

    #[test]
    fn runs_bridge_frames_that_say_nothing() {
        assert_eq!(runs(&[3, 4, 7, 9], |frame| frame < 7), [3..8, 9..10]);
    }
}
