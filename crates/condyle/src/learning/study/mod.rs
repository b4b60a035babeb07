//! The study of Pronost, Sandholm & Thalmann 2010 ("S3") with six virtual people, so that what is learned can be compared with what
//! is true.
//!
//! Each [person](condyle_learn::study::Person) goes through what a user does, by the same code: a standing trial gives a free knee
//! (`learn joint`), 40 trials are tracked with it, and laws are learned from the coordinates (`learn coupling`), once from gaits and once
//! from crouches. 20 trials that no law has seen are then tracked with every kind of knee. All of it with markers that are fixed to bones,
//! and with skin that moves.
//!
//! | module | what |
//! | --- | --- |
//! | `run` | one person with one kind of skin |
//! | `unseen` | knees compared on trials that no law has seen |
//! | `printed` | the numbers of S3, and what is wrong with them |
//! | `sheet` | tables as Markdown and CSV |
//! | `tables` | the tables |
//! | `report` | all tables as one text |
//! | `figure` | S3's Figure 3 |

#[cfg(feature = "picture")]
mod figure;
mod printed;
mod report;
mod run;
mod sheet;
mod tables;
mod unseen;

#[cfg(feature = "picture")]
pub use figure::figure;
pub use report::report;
pub use run::{Learned, Run};
pub use sheet::{Cell, Sheet};
pub use tables::tables;
pub use unseen::Followed;

use condyle_diagnostics::Error;
use condyle_learn::study::{Kind, Person, Skin, Take, Trials};
use condyle_motion::upkeep;

/// What is studied.
#[derive(Clone, Debug, PartialEq)]
pub struct Plan {
    /// How many of the six people, at least one.
    pub people: usize,
    /// Their trials.
    pub trials: Trials,
    /// The cut-off of the low-pass that recordings go through before they are tracked, in hertz, as laboratories have it; `None` for none.
    pub low_pass: Option<f64>,
    /// Every so many frames of a crouch one is tracked: 1 for all.
    pub every: usize,
    /// Solver threads; `None` for as many as there are cores. Results do not depend on them.
    pub threads: Option<usize>,
}

impl Default for Plan {
    fn default() -> Self {
        Self { people: 6, trials: Trials::default(), low_pass: Some(6.0), every: 1, threads: None }
    }
}

impl Plan {
    /// Three gaits, two crouches of each variety and every eighth frame of them: seconds instead of minutes, and wide
    /// intervals.
    #[must_use]
    pub fn quick(mut self) -> Self {
        self.trials.gaits = 3;
        self.trials.crouches = 2;
        self.trials.unseen = [2, 2];
        self.every = 8;
        self
    }
}

impl Plan {
    /// A trial as it is tracked: filtered, and of crouches every so many frames.
    fn take(
        &self,
        person: &Person,
        (kind, number): (Kind, usize),
        unseen: bool,
        skin: Skin,
    ) -> Result<Take, Error> {
        let mut take = self.trials.take(person, kind, number, unseen, skin);
        let upkeep = upkeep::Plan { low_pass: self.low_pass, ..upkeep::Plan::default() };
        upkeep.recording(&mut take.recording)?;
        let every = if kind == Kind::Gait { 1 } else { self.every.max(1) };
        if every > 1 {
            let width = take.recording.labels.len();
            let frames = take.recording.positions.chunks_exact(width).step_by(every);
            take.recording.positions = frames.flatten().copied().collect();
            take.recording.times = take.recording.times.iter().copied().step_by(every).collect();
            take.recording.rate /= every as f64;
            take.truth = take.truth.into_iter().step_by(every).collect();
        }
        Ok(take)
    }
}

/// What came out.
#[derive(Clone, Debug)]
pub struct Studied {
    /// What was studied.
    pub plan: Plan,
    /// The people.
    pub people: Vec<Person>,
    /// Two of each person: without artefact, then with it.
    pub runs: Vec<Run>,
}

impl Studied {
    /// What came out of a person, from 0.
    #[must_use]
    pub fn of(&self, person: usize, skin: Skin) -> Option<&Run> {
        self.runs.iter().find(|run| run.person == person && run.skin == skin)
    }
}

/// Runs the study; `progress` is told how many trials are done, and how many there are.
///
/// # Errors
/// Those of tracking and learning; none are expected of these trials.
pub fn study(
    plan: &Plan,
    progress: &mut (dyn FnMut(usize, usize) + Send),
) -> Result<Studied, Error> {
    let people: Vec<Person> =
        (0..plan.people.clamp(1, 6)).map(|index| Person::of_six(index, plan.trials.seed)).collect();
    let skins = [Skin::Rigid, Skin::Moving];
    let each = plan.trials.wanted(false).len() + plan.trials.wanted(true).len();
    let all = each * skins.len() * people.len();
    let mut done = 0;
    let mut step = || {
        done += 1;
        progress(done, all);
    };
    let mut runs = vec![];
    for (index, person) in people.iter().enumerate() {
        for skin in skins {
            runs.push(run::run(plan, person, index, skin, &mut step)?);
        }
    }
    unseen::follow(plan, &people, &mut runs, &mut step)?;
    Ok(Studied { plan: plan.clone(), people, runs })
}
