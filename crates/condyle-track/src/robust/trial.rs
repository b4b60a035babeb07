//! A recording with its answers, frame by frame, as the search for faults changes them.

use super::Source;
use super::offsets::Offsets;
use crate::answer::{FrameAnswer, FrameStatus};
use crate::recorded::Recorded;
use crate::tracker::{Scratch, Tracker};
use condyle_math::Vec3;
use condyle_model::Mode;

/// What is known of a trial.
pub(super) struct Trial<'a> {
    pub tracker: &'a Tracker,
    pub frames: usize,
    pub count: usize,
    /// Frame by frame and label by label, as recorded.
    pub seen: Vec<Option<[f64; 3]>>,
    pub answers: Vec<FrameAnswer>,
    /// Those of frames that were changed, as they were first.
    pub plain: Vec<Option<FrameAnswer>>,
    /// Frame by frame the labels of the markers; `None` where each has its own.
    pub sources: Vec<Option<Source>>,
    /// Frame by frame and marker by marker: the offset of what is recorded for it, in its segment's
    /// axes, and where in the world the marker with its own offset is.
    residuals: Vec<Vec3>,
    places: Vec<Vec3>,
    /// Frame by frame and label by label: whether it is to the last digit where it was one frame before.
    held: Vec<bool>,
}

/// The gate of a label that did not move at all is this share of what it is else: noise alone moves a
/// marker, so it is hardly one.
const HELD: f64 = 0.25;

impl<'a> Trial<'a> {
    pub(super) fn new(
        tracker: &'a Tracker,
        recorded: &dyn Recorded,
        answers: &[FrameAnswer],
    ) -> Self {
        let (frames, count) = (answers.len(), tracker.markers.placed.len());
        let (mut seen, mut row) = (Vec::with_capacity(frames * count), vec![]);
        for frame in 0..frames {
            recorded.positions(frame, &mut row);
            row.resize(count, None);
            seen.append(&mut row);
        }
        let sources = vec![None; frames];
        let still = |at: usize| at >= count && seen[at].is_some() && seen[at] == seen[at - count];
        let held = (0..frames * count).map(still).collect();
        let nothing = vec![Vec3::ZERO; frames * count];
        let (residuals, places) = (nothing.clone(), nothing);
        let answers = answers.to_vec();
        let plain = vec![None; frames];
        Self { tracker, frames, count, seen, answers, plain, sources, residuals, places, held }
    }

    /// The recorded positions of a frame, label by label.
    pub(super) fn row(&self, frame: usize) -> &[Option<[f64; 3]>] {
        &self.seen[frame * self.count..(frame + 1) * self.count]
    }

    /// Where the markers of a frame are with their offsets.
    pub(super) fn places(&self, frame: usize) -> &[Vec3] {
        &self.places[frame * self.count..(frame + 1) * self.count]
    }

    /// The distance in metres from which on a label strays in a frame.
    pub(super) fn gate(&self, offsets: &Offsets, frame: usize, label: usize) -> f64 {
        let held = self.held[frame * self.count + label];
        offsets.gates[label] * if held { HELD } else { 1.0 }
    }

    /// The label of a marker in a frame.
    pub(super) fn label(&self, frame: usize, marker: usize) -> Option<usize> {
        self.sources[frame].as_ref().map_or(Some(marker), |source| source[marker])
    }

    /// How far what is recorded for a marker is off it, if anything is and the frame was solved.
    pub(super) fn residual(&self, frame: usize, marker: usize) -> Option<Vec3> {
        if self.answers[frame].status != FrameStatus::Solved {
            return None;
        }
        self.row(frame)[self.label(frame, marker)?]?;
        let residual = self.residuals[frame * self.count + marker];
        residual.is_finite().then_some(residual)
    }

    /// Frame and label of all that are more than so many gates from where they are used; `throughout`
    /// gives the labels of what is seen here.
    pub(super) fn far(
        &self,
        offsets: &Offsets,
        gates: f64,
        throughout: &[usize],
    ) -> Vec<(usize, usize)> {
        let mut far = vec![];
        for frame in 0..self.frames {
            for (marker, &place) in self.places(frame).iter().enumerate() {
                let Some(label) = self.label(frame, marker) else { continue };
                let Some(seen) = self.row(frame)[label] else { continue };
                let off = (Vec3::from(seen) - place).norm();
                if off > gates * self.gate(offsets, frame, label) {
                    far.push((frame, throughout.get(label).map_or(label, |&label| label)));
                }
            }
        }
        far
    }

    /// Measures residuals and places of all frames again.
    pub(super) fn measure(&mut self, scratch: &mut Scratch, offsets: Option<&Offsets>) {
        for frame in 0..self.frames {
            let pose = &mut scratch.buffers.pose;
            let coordinates = &self.answers[frame].coordinates;
            if self.tracker.program.evaluate(coordinates, Mode::Open, pose).is_ok() {
                self.measure_at(scratch, offsets, frame);
            }
        }
    }

    /// Those of one frame, at the pose that was evaluated last.
    pub(super) fn measure_at(
        &mut self,
        scratch: &Scratch,
        offsets: Option<&Offsets>,
        frame: usize,
    ) {
        let pose = &scratch.buffers.pose;
        for (marker, placed) in self.tracker.markers.placed.iter().enumerate() {
            let at = frame * self.count + marker;
            let label = self.label(frame, marker);
            if let Some(seen) = label.and_then(|label| self.row(frame)[label]) {
                self.residuals[at] = placed.offset_to(pose, Vec3::from(seen));
            }
            let offset = offsets.map_or(Vec3::ZERO, |o| o.offsets[marker]);
            self.places[at] = placed.beside(pose, offset);
        }
    }
}
