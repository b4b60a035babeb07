//! A recording with its answers, frame by frame, as the search for faults changes them.

use super::Source;
use super::offsets::Offsets;
use crate::answer::{FrameAnswer, FrameStatus};
use crate::recorded::Recorded;
use crate::tracker::{Scratch, Tracker};
use condyle_math::Vec3;

/// The gate of a label that did not move at all is this share of what it is else: noise alone moves a
/// marker, so it is hardly one.
const HELD: f64 = 0.25;

/// What is known of a trial.
pub(super) struct Trial<'a> {
    pub tracker: &'a Tracker,
    pub frames: usize,
    pub count: usize,
    pub answers: Vec<FrameAnswer>,
    /// Those of frames that were changed, as they were first.
    pub plain: Vec<Option<FrameAnswer>>,
    /// Frame by frame the labels of the markers; `None` where each has its own.
    pub sources: Vec<Option<Source>>,
    /// Frame by frame and label by label, as recorded.
    seen: Vec<Option<[f64; 3]>>,
    /// Frame by frame and label by label: whether it is to the last digit where it was one frame before.
    held: Vec<bool>,
    offsets: Offsets,
    /// Frame by frame and marker by marker: the offset of what is recorded for it, in its segment's
    /// axes, and where in the world the marker with its own offset is.
    residuals: Vec<Vec3>,
    places: Vec<Vec3>,
}

impl<'a> Trial<'a> {
    /// A trial whose offsets are not known yet.
    pub(super) fn new(
        tracker: &'a Tracker,
        scratch: &mut Scratch,
        recorded: &dyn Recorded,
        answers: Vec<FrameAnswer>,
    ) -> Self {
        let (frames, count) = (answers.len(), tracker.markers.placed.len());
        let (mut seen, mut row) = (Vec::with_capacity(frames * count), vec![]);
        for frame in 0..frames {
            recorded.positions(frame, &mut row);
            row.resize(count, None);
            seen.append(&mut row);
        }
        let still = |at: usize| at >= count && seen[at].is_some() && seen[at] == seen[at - count];
        let held = (0..frames * count).map(still).collect();
        let mut trial = Self {
            tracker,
            frames,
            count,
            answers,
            plain: vec![None; frames],
            sources: vec![None; frames],
            seen,
            held,
            offsets: Offsets::unknown(count),
            residuals: vec![Vec3::ZERO; frames * count],
            places: vec![Vec3::ZERO; frames * count],
        };
        trial.measure(scratch);
        trial
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
    pub(super) fn gate(&self, frame: usize, label: usize) -> f64 {
        let held = self.held[frame * self.count + label];
        self.offsets.gates[label] * if held { HELD } else { 1.0 }
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

    /// Frame and label of all that are more than so many gates from where they are used.
    pub(super) fn far(&self, gates: f64) -> Vec<(usize, usize)> {
        let mut far = vec![];
        for frame in 0..self.frames {
            for (marker, &place) in self.places(frame).iter().enumerate() {
                let Some(label) = self.label(frame, marker) else { continue };
                let Some(seen) = self.row(frame)[label] else { continue };
                if (Vec3::from(seen) - place).norm() > gates * self.offsets.gates[label] {
                    far.push((frame, label));
                }
            }
        }
        far
    }

    /// Takes offsets and gates from these frames; places are not measured.
    pub(super) fn take_offsets(&mut self, frames: &[usize]) {
        self.offsets = Offsets::of(self, frames);
    }

    /// Measures residuals and places of all frames again.
    pub(super) fn measure(&mut self, scratch: &mut Scratch) {
        (0..self.frames).for_each(|frame| self.measure_frame(scratch, frame));
    }

    /// Measures those of one frame.
    pub(super) fn measure_frame(&mut self, scratch: &mut Scratch, frame: usize) {
        let coordinates = &self.answers[frame].coordinates;
        let Some(pose) = scratch.buffers.pose_at(self.tracker, coordinates) else { return };
        for (marker, placed) in self.tracker.markers.placed.iter().enumerate() {
            let at = frame * self.count + marker;
            let label = self.label(frame, marker);
            if let Some(seen) = label.and_then(|label| self.row(frame)[label]) {
                self.residuals[at] = placed.offset_to(pose, Vec3::from(seen));
            }
            self.places[at] = placed.beside(pose, self.offsets.offsets[marker]);
        }
    }

    /// Where the markers with their offsets are in the pose that was evaluated last.
    pub(super) fn place_beside(&self, scratch: &Scratch, places: &mut Vec<Vec3>) {
        let placed = self.tracker.markers.placed.iter().zip(&self.offsets.offsets);
        places.clear();
        places.extend(placed.map(|(placed, &off)| placed.beside(&scratch.buffers.pose, off)));
    }
}
