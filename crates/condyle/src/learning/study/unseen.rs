//! Knees compared on trials that no law has seen.

use super::{Plan, Run};
use crate::learning::arms::Residuals;
use crate::tracking::Request;
use condyle_diagnostics::Error;
use condyle_learn::arms::{Arm, Centre, Leg};
use condyle_learn::coupling::{LawFunction, ScaleRule};
use condyle_learn::study::{Kind, Person, Skin};
use condyle_math::function::FunctionOfSeveral;
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

/// Names of knees beside those of arms: by the law of the other motion, and by the law of another person.
pub(super) const OTHER_MOTION: &str = "learned from the other motion";
pub(super) const SCALED: [&str; 3] =
    ["another's law, equation 3", "another's law, per axis", "another's slopes, per axis"];

/// A knee with its name and how many of its coordinates are free.
type Knee = (String, usize, Model);

impl super::Studied {
    /// The models of all knees that are compared on a run's gaits or crouches, by their names in [`Followed::knee`].
    ///
    /// # Errors
    /// None are expected of a study that came out.
    pub fn models(&self, run: &Run, gait: bool) -> Result<Vec<(String, Model)>, Error> {
        let leg = Leg::of(&run.free, "knee_r")?;
        let knees = knees(&self.runs, run, &leg, usize::from(!gait))?;
        Ok(knees.into_iter().map(|(name, _, model)| (name, model)).collect())
    }
}

/// All knees of a person for one kind of motion, 0 gait, 1 crouch.
fn knees(runs: &[Run], run: &Run, leg: &Leg, motion: usize) -> Result<Vec<Knee>, Error> {
    let [own, other] = [&run.learned[motion].centre, &run.learned[1 - motion].centre];
    let mut knees: Vec<Knee> = vec![];
    for arm in Arm::COMPARED {
        let model = leg.arm(arm, Some(own))?;
        knees.push((arm.name().to_owned(), arm.coordinates(), model));
    }
    let mut learned = |name: &str, centre: &Centre| -> Result<(), Error> {
        let model = leg.arm(Arm::Learned, Some(centre))?;
        knees.push((name.to_owned(), Arm::Learned.coordinates(), model));
        Ok(())
    };
    learned(OTHER_MOTION, other)?;
    if let Some(donor) = donor(runs, run.person, run.skin) {
        let ratios = donor.sizes.ratios_to(run.sizes);
        for (name, rule) in SCALED.iter().zip([ScaleRule::Mean, ScaleRule::PerAxis]) {
            let factors = ratios.factors(rule);
            learned(name, &donor.learned[motion].centre.scaled(factors))?;
        }
        let factors = ratios.factors(ScaleRule::PerAxis);
        let scaled = donor.learned[motion].centre.scaled(factors);
        learned(SCALED[2], &placed(scaled, leg.standing()))?;
    }
    Ok(knees)
}

/// A linear centre that is at a place while the person stands, where all angles are 0: the standing trial knows it of everybody.
fn placed(mut centre: Centre, standing: [f64; 3]) -> Centre {
    for (law, place) in centre.laws.iter_mut().zip(standing) {
        if let LawFunction::Several(FunctionOfSeveral::Linear { intercept, .. }) = law {
            *intercept = place;
        }
    }
    centre
}

/// Whose law is scaled to a person: the next one's; of the last the first one's.
pub(super) fn donor(runs: &[Run], person: usize, skin: Skin) -> Option<&Run> {
    let of = |index: usize| runs.iter().find(|run| run.person == index && run.skin == skin);
    of(person + 1).or_else(|| of(0)).filter(|donor| donor.person != person)
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
        let leg = Leg::of(&run.free, "knee_r")?;
        let by_motion = [knees(runs, run, &leg, 0)?, knees(runs, run, &leg, 1)?];
        let empty = |motion: usize| {
            by_motion[motion].iter().map(move |(knee, free, _)| Followed {
                knee: knee.clone(),
                free: *free,
                gait: motion == 0,
                sums: vec![],
                frames: 0,
                largest: 0.0,
            })
        };
        let mut followed: Vec<Followed> = empty(0).chain(empty(1)).collect();
        for wanted in plan.trials.wanted(true) {
            let take = plan.take(&people[run.person], wanted, true, run.skin)?;
            let motion = usize::from(wanted.0 != Kind::Gait);
            let first = motion * by_motion[0].len();
            for ((_, _, model), followed) in by_motion[motion].iter().zip(&mut followed[first..]) {
                let left = Residuals::of(&leg, model, &take.recording, &request)?;
                followed.sums.push(left.sum());
                followed.frames += left.frames();
                followed.largest = followed.largest.max(left.most());
            }
            step();
        }
        all.push(followed);
    }
    runs.iter_mut().zip(all).for_each(|(run, followed)| run.unseen = followed);
    Ok(())
}
