//! What is learned from what, and asked about what.

use super::best::{Seen, best};
use super::person::{Followed, Person};
use super::residuals::{Residuals, frames_of};
use crate::tracking::Request;
use condyle_diagnostics::{Diagnostic, Error, Read};
use condyle_learn::arms::{Arm, Centre};
use condyle_learn::coupling::{Groups, Samples, ScaleRule, Settings};
use std::collections::HashMap;
use std::ops::Range;

/// From what a law is learned that is asked about a trial.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Question {
    /// All other trials of the person, where one of them at least is of the same kind of motion.
    OtherTrials,
    /// Other trials of the person in which the motion is of the same kind; where there are none, the rest of the trial itself, of which
    /// blocks of time are left out in turn.
    SameMotion,
    /// Trials of the person in which the motion is of another kind: experiment 2 of Pronost et al. 2010.
    OtherMotions,
    /// All trials of all other persons, scaled by equation 3 of Pronost et al. 2010: their experiment 1.
    OtherPersons,
    /// The same, scaled per axis.
    OtherPersonsPerAxis,
}

impl Question {
    /// All of them.
    pub const ALL: [Self; 5] = [
        Self::OtherTrials,
        Self::SameMotion,
        Self::OtherMotions,
        Self::OtherPersons,
        Self::OtherPersonsPerAxis,
    ];

    /// The word for it in tables.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::OtherTrials => "other trials",
            Self::SameMotion => "same motion",
            Self::OtherMotions => "other motions",
            Self::OtherPersons => "other persons, equation 3",
            Self::OtherPersonsPerAxis => "other persons, per axis",
        }
    }

    /// How laws of other persons are scaled.
    #[must_use]
    pub fn scaling(self) -> Option<ScaleRule> {
        match self {
            Self::OtherPersons => Some(ScaleRule::Mean),
            Self::OtherPersonsPerAxis => Some(ScaleRule::PerAxis),
            _ => None,
        }
    }
}

/// How joints are compared.
#[derive(Clone, Debug, PartialEq)]
pub struct How {
    /// How laws are learned.
    pub settings: Settings,
    /// How markers are tracked.
    pub request: Request,
    /// Into how many blocks of time a trial is cut that is the only one of its kind.
    pub blocks: usize,
}

impl Default for How {
    fn default() -> Self {
        Self { settings: Settings::default(), request: Request::default(), blocks: 8 }
    }
}

/// Some frames of a trial, and what was learned for them.
#[derive(Clone, Debug)]
pub struct Part {
    /// The frames of the trial that were left out and asked about.
    pub frames: Range<usize>,
    /// What was learned from the others.
    pub centre: Centre,
}

/// One trial with every arm.
#[derive(Clone, Debug)]
pub struct Compared {
    /// From what laws are learned.
    pub question: Question,
    /// Which person.
    pub person: usize,
    /// Which of the person's trials.
    pub trial: usize,
    /// The trials that laws were learned from, by name.
    pub learned_from: Vec<String>,
    /// The frames that were left out together: all, or block by block.
    pub parts: Vec<Part>,
    /// What each arm leaves, in the order of [`Arm::COMPARED`].
    pub arms: Vec<(Arm, Residuals)>,
}

impl Compared {
    /// What an arm leaves.
    #[must_use]
    pub fn of(&self, arm: Arm) -> Option<&Residuals> {
        self.arms.iter().find(|(own, _)| *own == arm).map(|(_, residuals)| residuals)
    }
}

/// Frames that a law is learned from: whole trials of a person, or a trial without some frames.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
struct Source {
    trials: Vec<(usize, usize)>,
    without: Option<Range<usize>>,
    scaled: Option<(usize, bool)>,
}

/// The best constant centre is sought over so many frames.
const FRAMES: usize = 300;

/// Everything that was tracked so far.
struct Bench<'a> {
    persons: &'a [Person],
    how: &'a How,
    free: Vec<Vec<Followed>>,
    stiff: HashMap<(usize, usize, Arm), Residuals>,
    centres: HashMap<Source, Centre>,
    learned: HashMap<(Source, usize, usize), Vec<(Arm, Residuals)>>,
}

impl Bench<'_> {
    fn samples(&self, source: &Source) -> Result<Samples, Error> {
        let mut samples = Samples::default();
        for &(person, trial) in &source.trials {
            let of = &self.persons[person];
            if samples.columns.is_empty() {
                samples.columns = of.leg.keys().to_vec();
            }
            let factors = self.factors(source, person);
            let followed = &self.free[person][trial];
            let left_out =
                |frame: &usize| !source.without.as_ref().is_some_and(|w| w.contains(frame));
            let rows: Vec<f64> = (0..followed.rows.len())
                .filter(left_out)
                .filter_map(|frame| followed.rows[frame])
                .flat_map(|[a, b, c, x, y, z]| {
                    [a, b, c, x * factors[0], y * factors[1], z * factors[2]]
                })
                .collect();
            let own = &of.trials[trial];
            let groups = Groups { subject: of.name.clone(), ..own.groups.clone() };
            samples.add(&own.name, groups, &rows, followed.bad);
        }
        Ok(samples)
    }

    /// The frames of a source, thinned, by the persons who move in them.
    fn seen(&self, source: &Source) -> Vec<Seen<'_>> {
        let each = (FRAMES / source.trials.len().max(1)).max(10);
        let trials = source.trials.iter().map(|&(person, trial)| {
            let of = &self.persons[person];
            let left_out =
                |frame: &usize| !source.without.as_ref().is_some_and(|w| w.contains(frame));
            let rows = &self.free[person][trial].rows;
            let used: Vec<usize> =
                (0..rows.len()).filter(left_out).filter(|frame| rows[*frame].is_some()).collect();
            let used: Vec<usize> =
                used.iter().copied().step_by(used.len().div_ceil(each).max(1)).collect();
            Seen {
                leg: &of.leg,
                recording: frames_of(&of.trials[trial].recording, &used),
                factors: self.factors(source, person),
            }
        });
        trials.collect()
    }

    /// How many times as large the places of a person are in a source.
    fn factors(&self, source: &Source, person: usize) -> [f64; 3] {
        let Some((to, per_axis)) = source.scaled else { return [1.0; 3] };
        let rule = if per_axis { ScaleRule::PerAxis } else { ScaleRule::Mean };
        match (self.persons[person].sizes, self.persons[to].sizes) {
            (Some(from), Some(to)) => from.ratios_to(to).factors(rule),
            _ => [1.0; 3],
        }
    }

    fn centre(&mut self, source: &Source) -> Result<Centre, Error> {
        if let Some(known) = self.centres.get(source) {
            return Ok(known.clone());
        }
        let mut centre = Centre::of(&self.samples(source)?, &self.how.settings)?;
        centre.best = Some(best(&self.seen(source), centre.mean, &self.how.request)?);
        self.centres.insert(source.clone(), centre.clone());
        Ok(centre)
    }

    /// What an arm leaves that takes nothing from recordings.
    fn stiff(&mut self, person: usize, trial: usize, arm: Arm) -> Result<Residuals, Error> {
        if arm == Arm::Free {
            return Ok(self.free[person][trial].residuals.clone());
        }
        if let Some(known) = self.stiff.get(&(person, trial, arm)) {
            return Ok(known.clone());
        }
        let leg = &self.persons[person].leg;
        let recording = &self.persons[person].trials[trial].recording;
        let residuals = Residuals::of(leg, &leg.arm(arm, None)?, recording, &self.how.request)?;
        self.stiff.insert((person, trial, arm), residuals.clone());
        Ok(residuals)
    }

    /// What the arms leave that take from recordings, in some frames of a trial.
    fn learned(
        &mut self,
        source: &Source,
        person: usize,
        trial: usize,
        frames: &Range<usize>,
    ) -> Result<Vec<(Arm, Residuals)>, Error> {
        let key = (source.clone(), person, trial);
        if let Some(known) = self.learned.get(&key) {
            return Ok(known.clone());
        }
        let centre = self.centre(source)?;
        let leg = &self.persons[person].leg;
        let recording = &self.persons[person].trials[trial].recording;
        let whole = *frames == (0..recording.frames());
        let cut = (!whole).then(|| frames_of(recording, &Vec::from_iter(frames.clone())));
        let recording = cut.as_ref().unwrap_or(recording);
        let mut all = vec![];
        for arm in Arm::COMPARED.into_iter().filter(|arm| arm.is_learned()) {
            let model = leg.arm(arm, Some(&centre))?;
            all.push((arm, Residuals::of(leg, &model, recording, &self.how.request)?));
        }
        self.learned.insert(key, all.clone());
        Ok(all)
    }
}

/// Learns for each trial from others and tracks it with every arm. `progress` is told what is done.
///
/// Which questions are asked follows from the trials: other trials where a person has two or more of a kind, other motions where they are of two
/// kinds or more, other persons where there are two or more whose sizes are known.
///
/// # Errors
/// `arms/none` where there is no trial; those of tracking and of learning.
pub fn compare(
    persons: &[Person],
    how: &How,
    progress: &mut dyn FnMut(&str),
) -> Result<Read<Vec<Compared>>, Error> {
    if persons.iter().all(|person| person.trials.is_empty()) {
        return Err(Error::new("arms/none", "there is no trial to track"));
    }
    let mut free = vec![];
    for person in persons {
        let mut own = vec![];
        for trial in &person.trials {
            progress(&format!("{} {}", person.name, trial.name));
            own.push(Followed::of(&person.leg, trial, &how.request)?);
        }
        free.push(own);
    }
    let mut bench = Bench {
        persons,
        how,
        free,
        stiff: HashMap::new(),
        centres: HashMap::new(),
        learned: HashMap::new(),
    };
    let mut warnings = vec![];
    let mut all = vec![];
    for question in Question::ALL {
        for person in 0..persons.len() {
            for trial in 0..persons[person].trials.len() {
                let Some(sources) = sources(persons, how, question, person, trial) else {
                    continue;
                };
                let own = &persons[person].trials[trial];
                progress(&format!("{}: {} {}", question.name(), persons[person].name, own.name));
                match asked(&mut bench, question, person, trial, &sources) {
                    Ok(compared) => all.push(compared),
                    // A law that cannot be learned from what is left is no reason to give up the others.
                    Err(error) if error.code().starts_with("learn/") => {
                        let message = format!("`{}`, {}: {error}", own.name, question.name());
                        warnings.push(Diagnostic::warning("arms/not-learned", message));
                    }
                    Err(error) => return Err(error),
                }
            }
        }
    }
    Ok(Read { value: all, warnings })
}

fn asked(
    bench: &mut Bench<'_>,
    question: Question,
    person: usize,
    trial: usize,
    sources: &[(Source, Range<usize>)],
) -> Result<Compared, Error> {
    let mut arms: Vec<(Arm, Residuals)> =
        Arm::COMPARED.into_iter().map(|arm| (arm, Residuals::default())).collect();
    let mut parts = vec![];
    for (source, frames) in sources {
        let learned = bench.learned(source, person, trial, frames)?;
        for (arm, residuals) in &mut arms {
            match learned.iter().find(|(own, _)| own == arm) {
                Some((_, found)) => residuals.extend(found),
                None => residuals.extend(&bench.stiff(person, trial, *arm)?.part(frames.clone())),
            }
        }
        parts.push(Part { frames: frames.clone(), centre: bench.centre(source)? });
    }
    let mut learned_from: Vec<String> = vec![];
    for (person, trial) in sources.iter().flat_map(|(source, _)| &source.trials) {
        let name = &bench.persons[*person].trials[*trial].name;
        if !learned_from.contains(name) {
            learned_from.push(name.clone());
        }
    }
    Ok(Compared { question, person, trial, learned_from, parts, arms })
}

/// What laws are learned from for the frames of a trial; `None` where the question is not asked.
fn sources(
    persons: &[Person],
    how: &How,
    question: Question,
    person: usize,
    trial: usize,
) -> Option<Vec<(Source, Range<usize>)>> {
    let own = &persons[person];
    let kind = |trial: usize| &own.trials[trial].groups.motion;
    let kinds = (0..own.trials.len()).any(|other| kind(other) != kind(trial));
    let others = || (0..own.trials.len()).filter(|other| *other != trial);
    let of_own = |trials: Vec<usize>| -> Vec<(usize, usize)> {
        trials.into_iter().map(|trial| (person, trial)).collect()
    };
    let frames = own.trials[trial].recording.frames();
    let whole = |trials: Vec<(usize, usize)>, scaled| {
        let source = Source { trials, without: None, scaled };
        (!source.trials.is_empty()).then(|| vec![(source, 0..frames)])
    };
    match question {
        // Where all others are of other kinds this is what those say.
        Question::OtherTrials => others()
            .any(|other| kind(other) == kind(trial))
            .then(|| whole(of_own(others().collect()), None))
            .flatten(),
        Question::SameMotion => {
            let same: Vec<usize> = others().filter(|other| kind(*other) == kind(trial)).collect();
            match (same.is_empty(), kinds) {
                // Where all trials are of one kind this is what other trials say.
                (false, false) => None,
                (false, true) => whole(of_own(same), None),
                (true, _) => {
                    let blocks = how.blocks.clamp(2, frames.max(2));
                    let block = |k: usize| {
                        let left_out = frames * k / blocks..frames * (k + 1) / blocks;
                        let source = Source {
                            trials: of_own(vec![trial]),
                            without: Some(left_out.clone()),
                            scaled: None,
                        };
                        (source, left_out)
                    };
                    Some((0..blocks).map(block).collect())
                }
            }
        }
        Question::OtherMotions => {
            let other = others().filter(|other| kind(*other) != kind(trial)).collect();
            whole(of_own(other), None)
        }
        Question::OtherPersons | Question::OtherPersonsPerAxis => {
            own.sizes?;
            let known = |other: &usize| *other != person && persons[*other].sizes.is_some();
            let all = (0..persons.len()).filter(known).flat_map(|other| {
                (0..persons[other].trials.len()).map(move |trial| (other, trial))
            });
            let per_axis = question == Question::OtherPersonsPerAxis;
            whole(all.collect(), Some((person, per_axis)))
        }
    }
}
