//! Numbers about a whole tracking.

use super::{BeyondRange, Faulty, Jump, Swap, Tracking, UnusedMarkers, Verdict};
use crate::check::circles;
use condyle_model::{CoordinateId, Model};
use condyle_track::{FrameAnswer, FrameStatus, Trust};

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

/// In how many of the frames a coordinate follows from the markers.
#[derive(Clone, Debug, PartialEq)]
pub struct Determination {
    /// Its key in the model.
    pub coordinate: String,
    /// Share of the frames in which it is determined.
    pub determined: f64,
    /// Share of the frames in which it is weak: its standard deviation exceeds 5° or 1 cm at 2 mm of noise.
    pub weak: f64,
    /// Share of the frames in which it is held at a bound, or by the posture of the model.
    pub held: f64,
    /// Share of the frames, among those, in which the markers push it against a bound.
    pub at_limit: f64,
    /// From when to when it is weak or held, in seconds.
    pub spans: Vec<[f64; 2]>,
}

/// From this share of the frames on a coordinate counts as determined.
const SURE: f64 = 0.9;

impl Determination {
    /// Whether it is determined in nine of ten frames.
    pub fn is_sure(&self) -> bool {
        self.determined >= SURE
    }
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
    /// Keys of the coordinates that the markers push against a bound in more than half of the frames.
    pub mostly_at_limit: Vec<String>,
    /// How far each coordinate that is not locked is determined, in the order of the model.
    pub determination: Vec<Determination>,
    /// Keys of the coordinates that move no marker that was used.
    pub unmoved: Vec<String>,
    /// Where a segment turns by more than 60° from one frame to the next, and why.
    pub jumps: Vec<Jump>,
    /// Rotations without ends whose angles leave the range of their file.
    pub beyond_range: Vec<BeyondRange>,
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
            self.answers.iter().map(|a| f(&a)).sum::<f64>() / n.max(1) as f64
        };
        let frames = self.frames.clone().zip(&self.times).zip(self.answers.iter());
        let failed = frames.filter(|(_, answer)| !answer.status.is_solved());
        Summary {
            frames: n,
            markers_used: self.markers.len(),
            rms: mean(&FrameAnswer::rms),
            max: self.answers.iter().map(|a| a.max()).fold(0.0, f64::max),
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
        let mostly = |id: &CoordinateId| {
            let pushed = self.trust_of(*id).filter(|trust| *trust == Trust::AtLimit);
            2 * pushed.count() > self.answers.len()
        };
        let mostly = model.coordinate_ids().filter(mostly);
        let key = |id: CoordinateId| model.coordinate_key(id);
        Report {
            summary: self.summary(),
            loop_error: self.answers.iter().map(|a| a.closure_error).fold(0.0, f64::max),
            iterations: self.answers.iter().map(|a| u64::from(a.iterations)).sum(),
            mostly_at_limit: mostly.map(key).collect(),
            determination: self.determination(model),
            unmoved: self.unmoved.iter().copied().map(key).collect(),
            jumps: self.jumps.clone(),
            beyond_range: self.beyond_range(model),
            swaps: self.swaps.clone(),
            faulty: self.faulty.clone(),
            markers: self.marker_errors(),
            unused: self.unused.clone(),
            verdict: self.verdict.clone(),
        }
    }

    /// How far a coordinate can be trusted, frame by frame.
    fn trust_of(&self, id: CoordinateId) -> impl Iterator<Item = Trust> + '_ {
        let frames = 0..self.answers.len();
        frames.filter_map(move |frame| self.trust_in(frame).get(id.index()).copied())
    }

    /// In how many of the frames each coordinate that is not locked follows from the markers.
    pub(super) fn determination(&self, model: &Model) -> Vec<Determination> {
        let solved = model.coordinate_ids().filter(|&id| !model.coordinate(id).locked);
        solved.map(|id| self.determination_of(model, id)).collect()
    }

    fn determination_of(&self, model: &Model, id: CoordinateId) -> Determination {
        let trust = || self.trust_of(id);
        let n = self.answers.len().max(1) as f64;
        let share = |kinds: &[Trust]| trust().filter(|t| kinds.contains(t)).count() as f64 / n;
        let (mut spans, mut open): (Vec<[f64; 2]>, bool) = (vec![], false);
        for (trust, &time) in trust().zip(&self.times) {
            let unsure = trust != Trust::Determined;
            match spans.last_mut() {
                Some(span) if unsure && open => span[1] = time,
                _ if unsure => spans.push([time; 2]),
                _ => {}
            }
            open = unsure;
        }
        Determination {
            coordinate: model.coordinate_key(id),
            determined: share(&[Trust::Determined]),
            weak: share(&[Trust::Weak]),
            held: share(&[Trust::Held, Trust::AtLimit]),
            at_limit: share(&[Trust::AtLimit]),
            spans,
        }
    }

    /// Coordinates that touch a bound of their enforced range, with the number of frames in which
    /// they do. A rotation whose range is a circle has no bounds.
    pub fn at_limits(&self, model: &Model) -> Vec<(CoordinateId, usize)> {
        let touches = |id: CoordinateId| {
            let (lower, upper) = model.coordinate(id).range.bounds();
            let frames = 0..self.answers.len();
            let values = frames.map(|frame| model.value(self.answers.coordinates(frame), id));
            values.filter(|&value| value <= lower || value >= upper).count()
        };
        let circles = circles(model);
        let bounded =
            |id: &CoordinateId| model.coordinate(*id).follows.is_none() && !circles.contains(id);
        let free = model.coordinate_ids().filter(bounded);
        free.map(|id| (id, touches(id))).filter(|(_, frames)| *frames > 0).collect()
    }

    /// The errors of each marker used, in the order of each answer's errors.
    pub fn marker_errors(&self) -> Vec<MarkerErrors> {
        let errors = |(m, name): (usize, &String)| {
            let frames = 0..self.answers.len();
            let errors = frames.map(|frame| self.answers.marker_errors(frame)[m]);
            let seen = errors.filter(|e| e.is_finite());
            let (sum, max, n) =
                seen.fold((0.0, 0.0, 0), |(s, m, n), e| (s + e * e, f64::max(m, e), n + 1));
            MarkerErrors { name: name.clone(), rms: (sum / f64::from(n.max(1))).sqrt(), max }
        };
        self.markers.iter().enumerate().map(errors).collect()
    }
}
