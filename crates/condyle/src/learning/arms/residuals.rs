//! One trial with one arm.

use crate::tracking::{Request, Tracking, track};
use condyle_diagnostics::Error;
use condyle_learn::arms::Leg;
use condyle_model::Model;
use condyle_motion::{Observed, Recording};
use std::ops::Range;

/// How far a joint leaves the markers of a trial from where they were recorded.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct Residuals {
    /// The root mean square over the markers seen in each frame, in metres; not a number in frames that are not counted.
    pub rms: Vec<f64>,
    /// The largest distance of a marker in each frame, in metres.
    pub max: Vec<f64>,
    /// Whether both segments show three of their markers in each frame.
    pub seen: Vec<bool>,
}

impl Residuals {
    /// Tracks a recording with a model of the leg: the leg's own, or an arm.
    ///
    /// # Errors
    /// As [`track`].
    pub fn of(
        leg: &Leg,
        arm: &Model,
        recording: &Recording,
        request: &Request,
    ) -> Result<Self, Error> {
        Ok(Self::of_tracking(leg, &track(arm, recording, request, &mut |_, _| {})?))
    }

    /// The same of what was tracked already.
    #[must_use]
    pub fn of_tracking(leg: &Leg, tracking: &Tracking) -> Self {
        let [parent, child] = leg.markers();
        let side =
            |name: &String| (parent.contains(&name.as_str()), child.contains(&name.as_str()));
        let sides: Vec<(bool, bool)> = tracking.markers.iter().map(side).collect();
        let mut residuals = Self::default();
        for frame in 0..tracking.answers.len() {
            let answer = tracking.answers.at(frame);
            let (mut above, mut below, mut count) = (0usize, 0usize, 0usize);
            let (mut squares, mut most) = (0.0, 0.0f64);
            for (error, (is_above, is_below)) in answer.marker_errors.iter().zip(&sides) {
                if !error.is_finite() || !(is_above | is_below) {
                    continue;
                }
                above += usize::from(*is_above);
                below += usize::from(*is_below);
                count += 1;
                squares += error * error;
                most = most.max(*error);
            }
            let counted = above >= FEWEST && below >= FEWEST;
            let solved = answer.status.is_solved();
            residuals.seen.push(counted);
            let told = counted && solved;
            residuals.rms.push(if told { (squares / count as f64).sqrt() } else { f64::NAN });
            residuals.max.push(if told { most } else { f64::NAN });
        }
        residuals
    }

    /// The sum over markers and frames of squared distances, in m², and how many distances there are.
    pub(super) fn squares(leg: &Leg, tracking: &Tracking) -> (f64, usize) {
        let used = Self::of_tracking(leg, tracking);
        let told = |frame: &usize| used.rms.get(*frame).is_some_and(|rms| rms.is_finite());
        let (mut sum, mut count) = (0.0, 0);
        for frame in (0..tracking.answers.len()).filter(told) {
            let answer = tracking.answers.at(frame);
            for error in answer.marker_errors.iter().filter(|error| error.is_finite()) {
                sum += error * error;
                count += 1;
            }
        }
        (sum, count)
    }

    /// How many frames are counted.
    #[must_use]
    pub fn frames(&self) -> usize {
        self.rms.iter().filter(|rms| rms.is_finite()).count()
    }

    /// The sum over frames of the root mean square, in metres: what Pronost et al. 2010 print.
    #[must_use]
    pub fn sum(&self) -> f64 {
        self.rms.iter().filter(|rms| rms.is_finite()).sum()
    }

    /// The mean over frames of the root mean square, in metres; 0 where no frame is counted.
    #[must_use]
    pub fn mean(&self) -> f64 {
        self.sum() / self.frames().max(1) as f64
    }

    /// The largest distance of a marker, in metres.
    #[must_use]
    pub fn most(&self) -> f64 {
        self.max.iter().copied().filter(|max| max.is_finite()).fold(0.0, f64::max)
    }

    /// In how many frames a segment shows fewer than three of its markers.
    #[must_use]
    pub fn unseen(&self) -> usize {
        self.seen.iter().filter(|seen| !**seen).count()
    }

    /// How many frames with enough markers could not be solved.
    #[must_use]
    pub fn unsolved(&self) -> usize {
        self.seen.len() - self.unseen() - self.frames()
    }

    /// Those of some of the frames.
    #[must_use]
    pub fn part(&self, frames: Range<usize>) -> Self {
        Self {
            rms: self.rms.get(frames.clone()).unwrap_or_default().to_vec(),
            max: self.max.get(frames.clone()).unwrap_or_default().to_vec(),
            seen: self.seen.get(frames).unwrap_or_default().to_vec(),
        }
    }

    /// Adds those of frames that follow.
    pub fn extend(&mut self, more: &Self) {
        self.rms.extend_from_slice(&more.rms);
        self.max.extend_from_slice(&more.max);
        self.seen.extend_from_slice(&more.seen);
    }
}

/// A segment is seen with so many markers.
const FEWEST: usize = 3;

/// Some frames of a recording, one after another.
pub(super) fn frames_of(recording: &Recording, frames: &[usize]) -> Recording {
    let width = recording.labels.len();
    let frames = frames.iter().copied().filter(|frame| *frame < recording.frames());
    let frames: Vec<usize> = frames.collect();
    let cells = || frames.iter().flat_map(|frame| frame * width..(frame + 1) * width);
    let place = |cell| recording.positions.get(cell).copied().unwrap_or(Observed::MISSING);
    let sure = |all: &Vec<f64>| cells().filter_map(|cell| all.get(cell).copied()).collect();
    Recording {
        labels: recording.labels.clone(),
        times: frames.iter().filter_map(|frame| recording.times.get(*frame).copied()).collect(),
        positions: cells().map(place).collect(),
        confidences: recording.confidences.as_ref().map(sure),
        ..*recording
    }
}
