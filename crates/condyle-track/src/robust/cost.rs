//! What a frame costs with its labels given to markers, and which labels are nearest to which places.
//!
//! With the place of each marker beside its own offset, and the gate g from which on it strays,
//!
//! ```text
//! C = Σₗ wₗ min(|eₗ|², gₗ²) / Σₗ wₗ  +  P + other targets        in m²
//! ```
//!
//! over all labels seen: e is how far label l is from the marker that it is given to; a label that is given
//! to none costs g². As a label left out costs as much as one that strays, C falls only if the other markers
//! come nearer to their own places.

use super::Source;
use super::assignment::assign;
use super::trial::Trial;
use crate::answer::FrameAnswer;
use condyle_math::Vec3;

/// A label is another marker's if it is nearer to that by this factor.
const NEARER: f64 = 0.5;
/// C must fall by this share of what the markers used leave, and by this in m², before labels are changed.
const GAIN: f64 = 0.10;
const LEAST_GAIN: f64 = 1e-6;
/// More than any squared distance within a gate.
const FORBIDDEN: f64 = 1e12;

impl Trial<'_> {
    /// C of a frame whose markers are at these places, by an answer of which only the other targets count.
    pub(super) fn cost(
        &self,
        frame: usize,
        source: Option<&Source>,
        places: &[Vec3],
        answer: &FrameAnswer,
    ) -> f64 {
        let row = self.row(frame);
        let mut squares = 0.0;
        for (marker, &place) in places.iter().enumerate() {
            let label = source.map_or(Some(marker), |source| source[marker]);
            let Some(label) = label else { continue };
            let Some(off) = distance(row[label], place) else { continue };
            squares += self.weight(label) * off.min(self.gate(frame, label)).powi(2);
        }
        let errors = answer.marker_errors.iter().enumerate();
        let used: f64 = errors.filter(|(_, e)| e.is_finite()).map(|(m, _)| self.weight(m)).sum();
        let mean = if used > 0.0 { answer.weighted_squares / used } else { 0.0 };
        squares / self.total(frame) + self.left_out(frame, source) + answer.minimised() - mean
    }

    /// By how much C must fall before labels are changed to those that cost `found`, in m².
    pub(super) fn needed(&self, frame: usize, source: Option<&Source>, found: f64) -> f64 {
        LEAST_GAIN + GAIN * (found - self.left_out(frame, source))
    }

    /// What the labels given to none add to C, in m².
    fn left_out(&self, frame: usize, source: Option<&Source>) -> f64 {
        let Some(source) = source else { return 0.0 };
        let seen = self.row(frame).iter().enumerate().filter(|(_, seen)| seen.is_some());
        let out = seen.map(|(label, _)| label).filter(|label| !source.contains(&Some(*label)));
        let squares: f64 = out.map(|l| self.weight(l) * self.gate(frame, l).powi(2)).sum();
        squares / self.total(frame)
    }

    fn weight(&self, label: usize) -> f64 {
        self.tracker.markers.placed[label].weight
    }

    /// Sum of the weights of the labels seen in a frame.
    fn total(&self, frame: usize) -> f64 {
        let seen = self.row(frame).iter().enumerate().filter(|(_, seen)| seen.is_some());
        let sum: f64 = seen.map(|(label, _)| self.weight(label)).sum();
        if sum > 0.0 { sum } else { 1.0 }
    }

    /// The labels of markers at these places: its own within the gate, else one that strays and is nearer
    /// here, or none, so that the sum of squares is least. `None` if each has its own.
    pub(super) fn nearest(&self, frame: usize, places: &[Vec3]) -> Option<Source> {
        let row = self.row(frame);
        let off = |label: usize, marker: usize| {
            distance(row[label], places[marker]).unwrap_or(f64::INFINITY)
        };
        let gate = |label: usize| self.gate(frame, label);
        let strays = |label: &usize| row[*label].is_some() && off(*label, *label) > gate(*label);
        let suspects: Vec<usize> = (0..self.count).filter(strays).collect();
        if suspects.is_empty() {
            return None;
        }
        let free: Vec<usize> =
            (0..self.count).filter(|marker| row[*marker].is_none() || strays(marker)).collect();
        // After the free markers one column for each label that is given to none.
        let cost = |suspect: usize, column: usize| {
            let label = suspects[suspect];
            let Some(&marker) = free.get(column) else { return gate(label).powi(2) };
            let away = off(label, marker);
            let fits = away < gate(marker).min(gate(label)) && away < NEARER * off(label, label);
            if fits { away * away } else { FORBIDDEN }
        };
        let columns = assign(suspects.len(), free.len() + suspects.len(), cost)?;
        let mut source: Source = (0..self.count).map(Some).collect();
        suspects.iter().for_each(|&label| source[label] = None);
        for (suspect, column) in columns.into_iter().enumerate() {
            if let Some(&marker) = free.get(column) {
                source[marker] = Some(suspects[suspect]);
            }
        }
        Some(source)
    }

    /// How many labels of a frame are farther than this share of their gates from the markers that they
    /// are given to.
    pub(super) fn straying(&self, frame: usize, places: &[Vec3], share: f64) -> usize {
        let strays = |(marker, place): (usize, &Vec3)| -> Option<bool> {
            let label = self.label(frame, marker)?;
            let off = distance(self.row(frame)[label], *place)?;
            Some(off > share * self.gate(frame, label))
        };
        places.iter().enumerate().filter(|&at| strays(at) == Some(true)).count()
    }
}

fn distance(seen: Option<[f64; 3]>, place: Vec3) -> Option<f64> {
    Some((Vec3::from(seen?) - place).norm())
}
