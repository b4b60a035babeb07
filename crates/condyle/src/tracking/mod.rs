//! A recording in, a motion out.
//!
//! A [`Request`] says what is tracked, by names. [`track`] does all at once; [`Job`] prepares it and
//! solves it in a second step. What comes out is a [`Tracking`], summed up in a [`Report`]. Frames
//! that come one by one are solved by a [`Live`], which knows labels, or by the [`Stream`] below it, which
//! knows marker targets; both own their share of the model.

mod cloud;
mod job;
mod jump;
mod live;
pub(crate) mod posture;
mod remarks;
mod report;
mod request;
#[cfg(any(feature = "document", feature = "opensim"))]
mod setup;
mod sides;
mod unused;
mod variant;
mod verdict;

pub use condyle_track::robust::Fault;
pub use condyle_track::{
    Answers, CoordinateTarget, FrameAnswer, FrameStatus, MarkerTarget, OrientationTarget,
    PostureTarget, Rules, Scratch, Stream, Targets, Tracker, Trust, Wanted,
};
pub use job::Job;
pub(crate) use job::LEAST_CONFIDENCE;
pub use jump::{Jump, JumpCause};
pub use live::Live;
pub use remarks::BeyondRange;
pub use report::{Determination, FailedFrame, MarkerErrors, Report, Summary};
#[cfg(feature = "document")]
pub(crate) use request::fits_pattern;
pub use request::{CoordinateRequest, CoordinateValue, PostureRequest, Request};
pub use unused::{Unused, UnusedMarkers};
pub use variant::Variant;
pub use verdict::Verdict;

use condyle_diagnostics::{Diagnostic, Error};
use condyle_model::{CoordinateId, Model};
use condyle_motion::{Motion, Recording};
use std::fmt;
use std::ops::Range;

/// A tracked recording.
#[derive(Clone, Debug)]
pub struct Tracking {
    /// Seconds, one for each frame.
    pub times: Vec<f64>,
    /// What came out of every frame, in order.
    pub answers: Answers,
    /// Names of the markers used, in the order of each answer's errors.
    pub markers: Vec<String>,
    /// For each marker used, its position among the recording's labels.
    pub labels: Vec<usize>,
    /// The recording's frames that were tracked.
    pub frames: Range<usize>,
    /// Warnings: guessed marker names, targets that are ignored.
    pub warnings: Vec<Diagnostic>,
    /// Labels that were exchanged and put right, by frame range (robust tracking only).
    pub swaps: Vec<Swap>,
    /// Labels that were left out, or stray and could not be put right, by frame range (robust tracking
    /// only).
    pub faulty: Vec<Faulty>,
    /// The markers and labels that were not used.
    pub unused: UnusedMarkers,
    /// How far each coordinate can be trusted, frame by frame in the order of the model's coordinates.
    pub trust: Vec<Trust>,
    /// Coordinates that move no marker that was used.
    pub unmoved: Vec<CoordinateId>,
    /// Where a segment with markers turns by more than 60° from one frame to the next, and why.
    pub jumps: Vec<Jump>,
    /// Whether the fit can be believed.
    pub verdict: Verdict,
}

impl Tracking {
    /// The coordinates of every frame.
    pub fn motion(&self) -> Motion {
        self.motion_of(0..self.answers.len())
    }

    /// The coordinates of some of the frames, counted from the first that was tracked.
    pub fn motion_of(&self, frames: Range<usize>) -> Motion {
        let frames = frames.start..frames.end.min(self.answers.len());
        Motion {
            times: self.times.get(frames.clone()).unwrap_or_default().to_vec(),
            frames: frames.map(|frame| self.answers.coordinates(frame).to_vec()).collect(),
        }
    }

    /// How far each coordinate can be trusted in a frame; empty if there is no such frame.
    pub fn trust_in(&self, frame: usize) -> &[Trust] {
        trust_in(&self.trust, self.answers.len(), frame)
    }
}

/// The part of one frame.
fn trust_in(trust: &[Trust], frames: usize, frame: usize) -> &[Trust] {
    let width = trust.len() / frames.max(1);
    trust.get(frame * width..(frame + 1) * width).unwrap_or_default()
}

/// Labels that are exchanged over some frames.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Swap {
    /// The labels, two or more: each is at the place of the next, the last at that of the first.
    pub labels: Vec<String>,
    /// Frames of the recording, from 0.
    pub frames: Range<usize>,
}

impl fmt::Display for Swap {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let labels: Vec<String> = self.labels.iter().map(|label| format!("`{label}`")).collect();
        match &labels[..] {
            [a, b] => write!(f, "labels {a} and {b} stand for each other's marker")?,
            _ => write!(f, "labels {} each stand for the next one's marker", labels.join(", "))?,
        }
        write!(f, " in {}", span(&self.frames))
    }
}

/// A label at which something is the matter over some frames.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Faulty {
    /// The label.
    pub label: String,
    /// Frames of the recording, from 0.
    pub frames: Range<usize>,
    /// What is the matter with it.
    pub fault: Fault,
}

impl fmt::Display for Faulty {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { label, frames, fault } = self;
        let (fault, span) = (fault.name(), span(frames));
        match self.fault.is_left_out() {
            true => write!(f, "label `{label}` is {fault} in {span}: left out"),
            false => write!(f, "label `{label}` strays in {span}: {fault}, used as it is"),
        }
    }
}

fn span(frames: &Range<usize>) -> String {
    match frames.len() {
        1 => format!("frame {}", frames.start),
        _ => format!("frames {} to {}", frames.start, frames.end.saturating_sub(1)),
    }
}

/// Tracks a recording; `progress` is called with the number of frames that are done and
/// their total.
///
/// # Errors
/// Those of [`Job::new`], if there is nothing to track. Frames that cannot be solved are marked in
/// their answer, never an error.
pub fn track(
    model: &Model,
    recording: &Recording,
    request: &Request,
    progress: &mut (dyn FnMut(usize, usize) + Send),
) -> Result<Tracking, Error> {
    Ok(Job::new(model.clone(), recording, request)?.run(progress))
}
