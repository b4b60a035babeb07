//! What is learned.

use super::{Basis, Groups, LawFunction, LeftOut, Scoped, Validity};
use condyle_diagnostics::Diagnostic;
use condyle_model::CoordinateKind;
use condyle_model::component::Region;

/// Terms with a greater condition number are nearly sums of each other (Belsley, Kuh & Welsch 1980).
const NEARLY_DEPENDENT: f64 = 30.0;

/// What people want to know of laws.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct About {
    /// A name.
    pub name: String,
    /// Where the frames come from.
    pub source: String,
    /// The model and the joint whose coordinates they are; empty where tables had them.
    pub frames: String,
}

/// One trial that laws were learned from.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct TrialOf {
    /// Its name.
    pub name: String,
    /// Who moves, and how.
    pub groups: Groups,
    /// How many frames were used.
    pub frames: usize,
    /// How many were left out because a value is missing.
    pub missing: usize,
    /// How many were left out because they were tracked badly.
    pub badly_tracked: usize,
}

/// Laws of one or more dependents on the same controls.
#[derive(Clone, Debug, PartialEq)]
pub struct Laws {
    /// What people want to know.
    pub about: About,
    /// The coordinates in control, in the order in which functions take them.
    pub controls: Vec<String>,
    /// What they are, where that is known.
    pub kinds: Vec<Option<CoordinateKind>>,
    /// The basis.
    pub basis: Basis,
    /// The ridge; 0 for ordinary least squares.
    pub ridge: f64,
    /// The names of the terms.
    pub terms: Vec<String>,
    /// The terms that are sums of others in these data, each with what it is the sum of.
    pub dropped: Vec<(String, Vec<(String, f64)>)>,
    /// The ratio of the largest to the least singular value of the standardised terms that are kept.
    pub condition: f64,
    /// Where the controls were.
    pub region: Region,
    /// The trials.
    pub trials: Vec<TrialOf>,
    /// Whether blocks of the only trial stand in for trials.
    pub blocks: bool,
    /// The laws.
    pub laws: Vec<Law>,
}

impl Laws {
    /// How many frames they were learned from.
    #[must_use]
    pub fn frames(&self) -> usize {
        self.trials.iter().map(|trial| trial.frames).sum()
    }

    /// How many terms are no sum of others.
    #[must_use]
    pub fn rank(&self) -> usize {
        self.terms.len() - self.dropped.len()
    }
}

/// The law of one dependent. Numbers are in radians and metres, or in the units of the table.
#[derive(Clone, Debug, PartialEq)]
pub struct Law {
    /// The coordinate that follows.
    pub dependent: String,
    /// What it is, where that is known.
    pub kind: Option<CoordinateKind>,
    /// Its value from the controls.
    pub function: LawFunction,
    /// The value where all terms are 0.
    pub intercept: f64,
    /// One coefficient for each term; 0 for those that are dropped.
    pub coefficients: Vec<f64>,
    /// 95 % intervals, clustered by trial: of the intercept, then of each coefficient. Of dropped terms, and with one trial
    /// alone, they are not finite.
    pub ci95: Vec<[f64; 2]>,
    /// Degrees of freedom of each interval.
    pub freedom: Vec<f64>,
    /// The share of the variance that the law explains of the data that it was learned from.
    pub r2: f64,
    /// The same, corrected for the number of terms.
    pub adjusted_r2: f64,
    /// The root mean square error there.
    pub rmse: f64,
    /// The mean of |error| there.
    pub mean_deviation: f64,
    /// For each control the share of what the others leave that it explains.
    pub partial_r2: Vec<f64>,
    /// What trials say that were left out in turn; `None` with one part alone.
    pub left_out: Option<LeftOut>,
    /// What subjects say that were left out in turn; `None` with one subject.
    pub left_out_subjects: Option<LeftOut>,
    /// What kinds of motion say that were left out in turn; `None` with one kind.
    pub left_out_motions: Option<LeftOut>,
    /// The criterion of Pronost et al. 2010; `None` of laws that were read from a document.
    pub validity: Option<Validity>,
    /// Laws for motions of a kind, beside this one for all.
    pub scoped: Vec<Scoped>,
}

impl Law {
    /// Whether it predicts trials that were left out better than the mean of the others, beyond chance: by the t test of
    /// [`LeftOut::chance`] at 2.5 %.
    #[must_use]
    pub fn accepted(&self) -> bool {
        self.left_out.as_ref().is_some_and(LeftOut::is_better)
    }
}

impl Laws {
    /// What a user should know before the laws are used.
    #[must_use]
    pub fn warnings(&self) -> Vec<Diagnostic> {
        let mut all = vec![];
        if self.blocks {
            let message = "there is one trial: intervals and left-out errors are those of blocks of time in it";
            let help = "give more trials; one says nothing about others";
            all.push(Diagnostic::warning("learn/one-trial", message).with_help(help));
        }
        for (term, parts) in &self.dropped {
            let sum: Vec<String> =
                parts.iter().map(|(name, share)| format!("{share:.4}·{name}")).collect();
            let message = match sum.is_empty() {
                true => format!("`{term}` does not move: it is left out"),
                false => format!("`{term}` is {} in all frames: it is left out", sum.join(" + ")),
            };
            all.push(Diagnostic::warning("learn/dropped", message));
        }
        if self.condition > NEARLY_DEPENDENT && self.ridge == 0.0 {
            let message = format!(
                "the controls move nearly together (condition {:.0}): single coefficients mean little",
                self.condition
            );
            let help = "use fewer controls, or a ridge such as --ridge 0.01";
            all.push(Diagnostic::warning("learn/collinear", message).with_help(help));
        }
        for law in self.laws.iter().filter(|law| !law.accepted()) {
            let message = format!(
                "the law of `{}` does not predict what was left out better than the mean, beyond chance",
                law.dependent
            );
            all.push(Diagnostic::warning("learn/not-accepted", message));
        }
        all
    }
}
