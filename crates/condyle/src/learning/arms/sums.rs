//! Trials of a kind together, and the gains of one arm over another.

use super::compared::{Compared, Question};
use super::person::Person;
use condyle_learn::arms::Arm;

/// What an arm leaves in several trials.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct Sum {
    /// The mean over all frames of the root mean square over markers, in metres.
    pub mean: f64,
    /// The largest distance of a marker, in metres.
    pub most: f64,
    /// The mean over trials of the sum over frames of the root mean square, in metres: what Table 3 of Pronost et al. 2010 prints.
    pub sum: f64,
    /// Frames that are counted.
    pub frames: usize,
    /// Frames that could not be solved.
    pub unsolved: usize,
    /// Frames in which a segment shows fewer than three markers.
    pub unseen: usize,
}

/// Trials of one person and one kind of motion, of which the same was asked.
#[derive(Clone, Debug, PartialEq)]
pub struct Group {
    /// From what laws are learned.
    pub question: Question,
    /// Which person.
    pub person: usize,
    /// The kind of motion.
    pub motion: String,
    /// How many trials.
    pub trials: usize,
    /// How many of them are cut into blocks of time.
    pub in_blocks: usize,
    /// What each arm leaves.
    pub arms: Vec<(Arm, Sum)>,
}

impl Group {
    /// The mean root mean square of an arm, in metres; not a number without it.
    #[must_use]
    pub fn mean(&self, arm: Arm) -> f64 {
        self.arms.iter().find(|(own, _)| *own == arm).map_or(f64::NAN, |(_, sum)| sum.mean)
    }

    /// The gain of one arm over another in this group.
    #[must_use]
    pub fn gain(&self, gain: Gain) -> f64 {
        let [from, to] = gain.arms();
        1.0 - self.mean(to) / self.mean(from)
    }
}

/// A step from one arm to a freer or a learned one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Gain {
    /// From the hinge to three rotations about the mean centre: freer rotation.
    Rotation,
    /// From there to the learned centre.
    Centre,
    /// From the constant centre that is best for the markers to the learned one.
    OverBest,
    /// From the planar knee to the learned one: both together, as Pronost et al. 2010 have it (3DOF to 3⁺DOF).
    OverPlanar,
    /// From the hinge to the learned one (1DOF to 3⁺DOF).
    OverHinge,
}

impl Gain {
    /// All of them.
    pub const ALL: [Self; 5] =
        [Self::Rotation, Self::Centre, Self::OverBest, Self::OverPlanar, Self::OverHinge];

    /// From which arm to which.
    #[must_use]
    pub fn arms(self) -> [Arm; 2] {
        match self {
            Self::Rotation => [Arm::Hinge, Arm::Fixed],
            Self::Centre => [Arm::Fixed, Arm::Learned],
            Self::OverBest => [Arm::FixedBest, Arm::Learned],
            Self::OverPlanar => [Arm::Planar, Arm::Learned],
            Self::OverHinge => [Arm::Hinge, Arm::Learned],
        }
    }

    /// The words for it in tables.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Rotation => "freer rotation (hinge to fixed)",
            Self::Centre => "learned centre (fixed to learned)",
            Self::OverBest => "fixed-best to learned",
            Self::OverPlanar => "planar to learned",
            Self::OverHinge => "hinge to learned",
        }
    }
}

/// A gain over persons.
#[derive(Clone, Debug, PartialEq)]
pub struct Gains {
    /// From what laws are learned.
    pub question: Question,
    /// The kind of motion.
    pub motion: String,
    /// Which step.
    pub gain: Gain,
    /// The share by which the mean root mean square falls, for each person who shows the motion.
    pub shares: Vec<f64>,
}

impl Gains {
    /// The mean over persons.
    #[must_use]
    pub fn mean(&self) -> f64 {
        self.shares.iter().sum::<f64>() / self.shares.len().max(1) as f64
    }

    /// The standard deviation over persons; `None` of one.
    #[must_use]
    pub fn deviation(&self) -> Option<f64> {
        let (n, mean) = (self.shares.len(), self.mean());
        let squares: f64 = self.shares.iter().map(|share| (share - mean).powi(2)).sum();
        (n > 1).then(|| (squares / (n - 1) as f64).sqrt())
    }
}

/// Trials of one person and one kind of motion together, in the order of questions.
#[must_use]
pub fn groups(persons: &[Person], compared: &[Compared]) -> Vec<Group> {
    let mut groups: Vec<(Group, Vec<&Compared>)> = vec![];
    for one in compared {
        let Some(trial) = persons.get(one.person).and_then(|p| p.trials.get(one.trial)) else {
            continue;
        };
        let motion = &trial.groups.motion;
        let is_same = |(group, _): &&mut (Group, Vec<&Compared>)| {
            group.question == one.question && group.person == one.person && group.motion == *motion
        };
        match groups.iter_mut().find(is_same) {
            Some((_, all)) => all.push(one),
            None => {
                let group = Group {
                    question: one.question,
                    person: one.person,
                    motion: motion.clone(),
                    trials: 0,
                    in_blocks: 0,
                    arms: vec![],
                };
                groups.push((group, vec![one]));
            }
        }
    }
    let finished = groups.into_iter().map(|(mut group, all)| {
        group.trials = all.len();
        group.in_blocks = all.iter().filter(|one| one.parts.len() > 1).count();
        group.arms = Arm::COMPARED
            .into_iter()
            .map(|arm| {
                let own: Vec<_> = all.iter().filter_map(|one| one.of(arm)).collect();
                let frames: usize = own.iter().map(|r| r.frames()).sum();
                let total: f64 = own.iter().map(|r| r.sum()).sum();
                let sum = Sum {
                    mean: total / frames.max(1) as f64,
                    most: own.iter().map(|r| r.most()).fold(0.0, f64::max),
                    sum: total / own.len().max(1) as f64,
                    frames,
                    unsolved: own.iter().map(|r| r.unsolved()).sum(),
                    unseen: own.iter().map(|r| r.unseen()).sum(),
                };
                (arm, sum)
            })
            .collect();
        group
    });
    finished.collect()
}

/// The gains of groups over persons, in the order of questions and motions.
#[must_use]
pub fn gains(groups: &[Group]) -> Vec<Gains> {
    let mut all: Vec<Gains> = vec![];
    for group in groups {
        for gain in Gain::ALL {
            let share = group.gain(gain);
            let is_same = |own: &&mut Gains| {
                own.question == group.question && own.motion == group.motion && own.gain == gain
            };
            match all.iter_mut().find(is_same) {
                Some(own) => own.shares.push(share),
                None => all.push(Gains {
                    question: group.question,
                    motion: group.motion.clone(),
                    gain,
                    shares: vec![share],
                }),
            }
        }
    }
    all
}
