//! A recording in, a motion out.
//!
//! A [`Request`] says what is tracked, by names. [`track`] does all at once; [`Job`] prepares it and
//! solves it in a second step. What comes out is a [`Tracking`], summed up in a [`Report`]. Frames
//! that come one by one are solved by a [`Stream`], over a [`Tracker`] that shares its model.

mod assignment;
mod cloud;
mod job;
mod report;
mod request;
#[cfg(any(feature = "document", feature = "opensim"))]
mod setup;
mod sides;
mod unused;
mod variant;
mod verdict;

pub use condyle_track::{
    CoordinateTarget, FrameAnswer, FrameStatus, MarkerTarget, OrientationTarget, PostureTarget,
    Rules, Scratch, Stream, Targets, Tracker, Wanted,
};
pub use job::Job;
pub use report::{FailedFrame, MarkerErrors, Report, Summary};
pub use request::{CoordinateRequest, CoordinateValue, PostureRequest, Request};
pub use unused::{Unused, UnusedMarkers};
pub use variant::Variant;
pub use verdict::Verdict;

use condyle_diagnostics::{Diagnostic, Error};
use condyle_model::Model;
use condyle_motion::{Motion, Recording};

/// A tracked recording.
#[derive(Clone, Debug)]
pub struct Tracking {
    /// The coordinates of every frame.
    pub motion: Motion,
    /// What came out of every frame, in order.
    pub answers: Vec<FrameAnswer>,
    /// Names of the markers used, in the order of each answer's errors.
    pub markers: Vec<String>,
    /// For each marker used, its position among the recording's labels.
    pub labels: Vec<usize>,
    /// The recording's frames that were tracked.
    pub frames: std::ops::Range<usize>,
    /// Warnings: guessed marker names, targets that are ignored.
    pub warnings: Vec<Diagnostic>,
    /// Labels that were found exchanged, by frame range (robust tracking only).
    pub swaps: Vec<Swap>,
    /// The markers and labels that were not used.
    pub unused: UnusedMarkers,
    /// Whether the fit can be believed.
    pub verdict: Verdict,
}

/// Two labels that are swapped over some frames.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Swap {
    /// The two labels.
    pub labels: [String; 2],
    /// Frames of the recording, from 0.
    pub frames: std::ops::Range<usize>,
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
