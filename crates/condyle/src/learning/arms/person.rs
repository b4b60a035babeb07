//! Trials of one person, tracked with the free joint.

use super::residuals::Residuals;
use crate::tracking::{Request, track};
use condyle_diagnostics::Error;
use condyle_learn::arms::{Leg, Sizes};
use condyle_learn::coupling::Groups;
use condyle_motion::Recording;

/// One recording of a person.
#[derive(Clone, Debug)]
pub struct Trial {
    /// Its name, such as that of its file.
    pub name: String,
    /// Who moves, and how.
    pub groups: Groups,
    /// Its markers.
    pub recording: Recording,
}

/// One person: a leg from a standing trial, and trials.
#[derive(Clone, Debug)]
pub struct Person {
    /// A name.
    pub name: String,
    /// The leg, whose joint has six coordinates.
    pub leg: Leg,
    /// Lengths by which laws are scaled; `None` where the standing trial does not show them.
    pub sizes: Option<Sizes>,
    /// The trials.
    pub trials: Vec<Trial>,
}

/// A trial tracked with the free joint.
#[derive(Clone, Debug, Default)]
pub(super) struct Followed {
    /// What is left at its markers.
    pub residuals: Residuals,
    /// The six coordinates in each frame; `None` where laws are not to be learned from it.
    pub rows: Vec<Option<[f64; 6]>>,
    /// How many frames were tracked badly.
    pub bad: usize,
}

/// A frame whose markers are so many times farther off than in the middle frame of its trial is tracked badly.
const FAR: f64 = 3.0;

impl Followed {
    /// Tracks a trial with the free joint.
    pub(super) fn of(leg: &Leg, trial: &Trial, request: &Request) -> Result<Self, Error> {
        let tracking = track(leg.model(), &trial.recording, request, &mut |_, _| {})?;
        let residuals = Residuals::of_tracking(leg, &tracking);
        let mut rising: Vec<f64> =
            residuals.rms.iter().copied().filter(|rms| rms.is_finite()).collect();
        rising.sort_by(f64::total_cmp);
        let Some(middle) = rising.get(rising.len() / 2) else {
            let message = format!(
                "no frame of `{}` could be tracked that shows three markers of both segments",
                trial.name
            );
            return Err(Error::new("arms/not-tracked", message));
        };
        let most = FAR * middle.max(1e-6);
        let mut rows = vec![];
        let mut bad = residuals.unsolved();
        for (frame, rms) in residuals.rms.iter().enumerate() {
            let row = leg.values(tracking.answers.coordinates(frame));
            let near = *rms <= most;
            bad += usize::from(rms.is_finite() && !near);
            rows.push(near.then_some(row));
        }
        Ok(Self { residuals, rows, bad })
    }
}
