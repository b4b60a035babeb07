//! Knees compared on trials that no law has seen.

use super::{Plan, Run};
use crate::tracking::{Request, track};
use condyle_diagnostics::Error;
use condyle_learn::coupling::{LawFunction, Laws, apply};
use condyle_learn::study::{Kind, Person};
use condyle_model::Model;

/// How one kind of knee followed the markers of one kind of motion.
#[derive(Clone, Debug, PartialEq)]
pub struct Followed {
    /// The knee.
    pub knee: String,
    /// Its coordinates that are free, without the six of the thigh.
    pub free: usize,
    /// Whether these are gaits; crouches otherwise.
    pub gait: bool,
    /// For each trial the sum over frames of the RMS distance of its markers, in metres; its mean over trials is what Pronost et
    /// al. 2010 print.
    pub sums: Vec<f64>,
    /// Frames of all trials.
    pub frames: usize,
    /// The largest distance of a marker, in metres.
    pub largest: f64,
}

impl Followed {
    /// The mean over trials of their sums, in metres.
    #[must_use]
    pub fn sum(&self) -> f64 {
        self.sums.iter().sum::<f64>() / self.sums.len().max(1) as f64
    }

    /// The mean over frames of the RMS distance of the markers, in metres.
    #[must_use]
    pub fn rms(&self) -> f64 {
        self.sums.iter().sum::<f64>() / self.frames.max(1) as f64
    }
}

/// Names of knees.
pub(super) const OWN: [&str; 2] = ["learned from gait", "learned from crouch"];
pub(super) const FREE: &str = "free";

/// The model in which the centre follows laws.
pub(super) fn with_laws(free: &Model, laws: &Laws) -> Result<Model, Error> {
    let functions: Vec<(&str, &LawFunction)> =
        laws.laws.iter().map(|law| (law.dependent.as_str(), &law.function)).collect();
    apply(free, &laws.controls, None, &functions)
}

/// Tracks the trials that no law has seen with every knee.
pub(super) fn follow(
    plan: &Plan,
    people: &[Person],
    runs: &mut [Run],
    step: &mut (dyn FnMut() + Send),
) -> Result<(), Error> {
    let request = Request { threads: plan.threads, ..Request::default() };
    let mut all = vec![];
    for run in runs.iter() {
        let mut knees: Vec<(String, usize, Model)> = vec![];
        for (name, learned) in OWN.iter().zip(&run.learned) {
            knees.push(((*name).to_owned(), 3, with_laws(&run.free, &learned.laws)?));
        }
        knees.push((FREE.to_owned(), 6, run.free.clone()));
        let empty = |gait: bool| {
            knees.iter().map(move |(knee, free, _)| Followed {
                knee: knee.clone(),
                free: *free,
                gait,
                sums: vec![],
                frames: 0,
                largest: 0.0,
            })
        };
        let mut followed: Vec<Followed> = empty(true).chain(empty(false)).collect();
        for (kind, number) in plan.trials.wanted(true) {
            let take = plan.take(&people[run.person], (kind, number), true, run.skin)?;
            let first = if kind == Kind::Gait { 0 } else { knees.len() };
            for (place, (_, _, model)) in knees.iter().enumerate() {
                let tracking = track(model, &take.recording, &request, &mut |_, _| {})?;
                let followed = &mut followed[first + place];
                let frames = (0..tracking.answers.len()).filter_map(|f| tracking.answers.get(f));
                let mut sum = 0.0;
                for answer in frames {
                    sum += answer.rms();
                    followed.largest = followed.largest.max(answer.max());
                    followed.frames += 1;
                }
                followed.sums.push(sum);
            }
            step();
        }
        all.push(followed);
    }
    runs.iter_mut().zip(all).for_each(|(run, followed)| run.unseen = followed);
    Ok(())
}
