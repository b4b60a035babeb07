//! Numbers about a whole tracking.

use super::{Faulty, Swap, Tracking, UnusedMarkers, Verdict};
use condyle_model::{CoordinateId, Model};
use condyle_track::{FrameAnswer, FrameStatus};

/// What can be said of a tracking without its model.
#[derive(Clone, Debug, PartialEq)]
pub struct Summary {
    /// Frames tracked.
    pub frames: usize,
    /// Markers with a positive weight.
    pub markers_used: usize,
    /// Mean over frames of the RMS over markers, in metres.
    pub rms: f64,
    /// Largest marker error of all frames, in metres.
    pub max: f64,
    /// Mean of F, in m².
    pub objective: f64,
    /// Mean of Σ w |e|², in m².
    pub objective_markers: f64,
    /// Mean of P, in m².
    pub objective_posture: f64,
    /// Frames that were not solved.
    pub failed: Vec<FailedFrame>,
}

/// A frame that was not solved.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FailedFrame {
    /// Its number in the recording, from 0.
    pub frame: usize,
    /// Its time, in seconds.
    pub time: f64,
    /// Why.
    pub status: FrameStatus,
}

/// The errors of one marker over the frames that saw it, in metres.
#[derive(Clone, Debug, PartialEq)]
pub struct MarkerErrors {
    /// Its name in the model.
    pub name: String,
    /// Root mean square.
    pub rms: f64,
    /// The largest.
    pub max: f64,
}

/// All numbers about a tracking.
#[derive(Clone, Debug, PartialEq)]
pub struct Report {
    /// What can be said without the model.
    pub summary: Summary,
    /// Largest loop error of all frames, in metres or radians.
    pub loop_error: f64,
    /// Iterations of the solver, all frames together.
    pub iterations: u64,
    /// Keys of the coordinates that touch a bound in more than half of the frames.
    pub mostly_at_limit: Vec<String>,
    /// Labels that were exchanged and put right.
    pub swaps: Vec<Swap>,
    /// Labels that were left out, or stray and could not be put right.
    pub faulty: Vec<Faulty>,
    /// The markers used.
    pub markers: Vec<MarkerErrors>,
    /// The markers and labels that were not used.
    pub unused: UnusedMarkers,
    /// Whether the fit can be believed.
    pub verdict: Verdict,
}

impl Tracking {
    /// Sums the tracking up.
    pub fn summary(&self) -> Summary {
        let n = self.answers.len();
        let mean = |f: &dyn Fn(&FrameAnswer) -> f64| {
            self.answers.iter().map(f).sum::<f64>() / n.max(1) as f64
        };
        let frames = self.frames.clone().zip(&self.motion.times).zip(&self.answers);
        let failed = frames.filter(|(_, answer)| !answer.status.is_solved());
        Summary {
            frames: n,
            markers_used: self.markers.len(),
            rms: mean(&FrameAnswer::rms),
            max: self.answers.iter().map(FrameAnswer::max).fold(0.0, f64::max),
            objective: mean(&|a| a.objective),
            objective_markers: mean(&|a| a.weighted_squares),
            objective_posture: mean(&|a| a.posture),
            failed: failed
                .map(|((frame, &time), a)| FailedFrame { frame, time, status: a.status })
                .collect(),
        }
    }

    /// All numbers about the tracking with its model.
    pub fn report(&self, model: &Model) -> Report {
        let mostly = |(_, frames): &(CoordinateId, usize)| 2 * frames > self.answers.len();
        let mostly = self.at_limits(model).into_iter().filter(mostly);
        Report {
            summary: self.summary(),
            loop_error: self.answers.iter().map(|a| a.closure_error).fold(0.0, f64::max),
            iterations: self.answers.iter().map(|a| u64::from(a.iterations)).sum(),
            mostly_at_limit: mostly.map(|(id, _)| model.coordinate_key(id)).collect(),
            swaps: self.swaps.clone(),
            faulty: self.faulty.clone(),
            markers: self.marker_errors(),
            unused: self.unused.clone(),
            verdict: self.verdict.clone(),
        }
    }

    /// Coordinates that touch a bound of their enforced range, with the number of frames in which
    /// they do.
    pub fn at_limits(&self, model: &Model) -> Vec<(CoordinateId, usize)> {
        let touches = |id: CoordinateId| {
            let (lower, upper) = model.coordinate(id).range.bounds();
            let values = self.motion.frames.iter().map(|frame| model.value(frame, id));
            values.filter(|&value| value <= lower || value >= upper).count()
        };
        let free = model.coordinate_ids().filter(|&id| model.coordinate(id).follows.is_none());
        free.map(|id| (id, touches(id))).filter(|(_, frames)| *frames > 0).collect()
    }

    /// The errors of each marker used, in the order of each answer's errors.
    pub fn marker_errors(&self) -> Vec<MarkerErrors> {
        let errors = |(m, name): (usize, &String)| {
            let seen = self.answers.iter().map(|a| a.marker_errors[m]).filter(|e| e.is_finite());
            let (sum, max, n) =
                seen.fold((0.0, 0.0, 0), |(s, m, n), e| (s + e * e, f64::max(m, e), n + 1));
            MarkerErrors { name: name.clone(), rms: (sum / f64::from(n.max(1))).sqrt(), max }
        };
        self.markers.iter().enumerate().map(errors).collect()
    }
}
