//! Frames of markers as they come, by labels.

use super::{FrameAnswer, Job, Request, Stream, Tracker};
use condyle_diagnostics::{Diagnostic, Error};
use condyle_model::{Model, SizeMismatch};
use condyle_motion::{Observed, Recording};
use std::sync::Arc;

/// Solves the frames of a camera system one by one, each from the one before, into the caller's buffer.
///
/// It is a [`Stream`] whose markers are matched to labels by a [`Request`], like those of a recording.
/// After the first frame nothing is allocated, but in a frame that is tried again from first guesses: where
/// the fit is suddenly far worse, a joint stands at a bound that it could pass otherwise, or the frame before
/// was not solved.
#[derive(Debug)]
pub struct Live {
    stream: Stream,
    /// For each marker target its label.
    labels: Vec<usize>,
    markers: Vec<String>,
    width: usize,
    seen: Vec<Option<[f64; 3]>>,
    warnings: Vec<Diagnostic>,
}

impl Live {
    /// Matches labels to a model's markers, and prepares what is asked. The time range and values of
    /// coordinates from a file have no meaning here, and faults of markers are not looked for; both are
    /// warnings where they are asked for.
    ///
    /// # Errors
    /// Those of [`Job::new`].
    pub fn new(
        model: impl Into<Arc<Model>>,
        labels: &[String],
        request: &Request,
    ) -> Result<Self, Error> {
        let request = Request { time_range: None, coordinate_values: None, ..request.clone() };
        let recording = Recording {
            labels: labels.to_vec(),
            times: vec![0.0],
            positions: vec![Observed::from([0.0; 3]); labels.len()],
            ..Recording::default()
        };
        let job = Job::new(model, &recording, &request)?;
        let mut warnings = job.warnings.clone();
        if request.robust {
            let message = "faults of markers are not looked for in frames that come one by one";
            warnings.push(Diagnostic::warning("track/not-robust", message));
        }
        Ok(Self {
            stream: Stream::new(Arc::clone(job.tracker())),
            seen: vec![None; job.labels.len()],
            labels: job.labels,
            markers: job.markers,
            width: labels.len(),
            warnings,
        })
    }

    /// Solves the next frame: the position of each label in metres, `None` where it is not seen. The
    /// coordinates of the posture, radians and metres in the order in which the model stores them, are
    /// written to the caller's buffer.
    ///
    /// # Errors
    /// If there are not as many positions as labels, or as many coordinates as the model stores.
    pub fn next(
        &mut self,
        positions: &[Option<[f64; 3]>],
        coordinates: &mut [f64],
    ) -> Result<&FrameAnswer, SizeMismatch> {
        let of = |buffer, expected, found| SizeMismatch { buffer, expected, found };
        let stored = self.stream.answer().coordinates.len();
        if positions.len() != self.width {
            return Err(of("the list of positions", self.width, positions.len()));
        }
        if coordinates.len() != stored {
            return Err(of("the list of coordinates", stored, coordinates.len()));
        }
        for (seen, &label) in self.seen.iter_mut().zip(&self.labels) {
            *seen = positions[label].filter(|place| place.iter().all(|x| x.is_finite()));
        }
        let answer = self.stream.next(&self.seen);
        coordinates.copy_from_slice(&answer.coordinates);
        Ok(answer)
    }

    /// The answer of the last frame; the defaults before the first.
    pub fn answer(&self) -> &FrameAnswer {
        self.stream.answer()
    }

    /// Names of the markers used, in the order of each answer's errors.
    pub fn markers(&self) -> &[String] {
        &self.markers
    }

    /// Guessed names of markers, and what of the request is ignored.
    pub fn warnings(&self) -> &[Diagnostic] {
        &self.warnings
    }

    /// The model and what is tracked.
    pub fn tracker(&self) -> &Arc<Tracker> {
        self.stream.tracker()
    }
}
