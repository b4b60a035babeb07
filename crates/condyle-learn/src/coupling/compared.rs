//! Laws for motions of a kind beside those for all.

use super::basis::Terms;
use super::design::Design;
use super::judged::left_out;
use super::{Samples, Trial};
use std::collections::BTreeMap;

/// For which motions a law is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scope {
    /// All.
    Global,
    /// Those of a kind, such as crouches.
    Motion,
    /// A variety of a kind, such as crouches with 30 degrees between the feet.
    SubMotion,
}

impl Scope {
    /// Its name in reports.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Global => "global",
            Self::Motion => "motion",
            Self::SubMotion => "sub_motion",
        }
    }

    fn of(self, trial: &Trial) -> &str {
        match self {
            Self::Global => "",
            Self::Motion => &trial.groups.motion,
            Self::SubMotion => &trial.groups.sub_motion,
        }
    }
}

/// The errors of laws of one scope, each on its own motions.
#[derive(Clone, Debug, PartialEq)]
pub struct Scoped {
    /// The scope.
    pub scope: Scope,
    /// What each law is for.
    pub name: String,
    /// How many trials of that kind there are, and their frames.
    pub trials: usize,
    /// Frames of them.
    pub frames: usize,
    /// The intercept and the coefficients of the law of these trials alone; of the global one empty.
    pub coefficients: Vec<f64>,
    /// The mean of |error| on the frames that it was learned from (Pronost et al. 2010, Table 2).
    pub mean_deviation: f64,
    /// The root mean square error there.
    pub rmse: f64,
    /// The same on trials left out, each predicted by the law of the others of its kind; `None` of a kind with one trial.
    pub left_out_rmse: Option<f64>,
    /// The global law's root mean square error on these trials, each left out.
    pub global_left_out_rmse: Option<f64>,
}

/// The laws of every motion and variety for one dependent.
pub(super) fn compared(
    samples: &Samples,
    controls: &[usize],
    dependent: usize,
    terms: &Terms,
    ridge: f64,
    global: &(Design, Vec<f64>),
) -> Vec<Scoped> {
    let mut all = vec![];
    for scope in [Scope::Motion, Scope::SubMotion] {
        let mut groups: BTreeMap<&str, Vec<usize>> = BTreeMap::new();
        for (index, trial) in samples.trials.iter().enumerate() {
            if samples.frames_of(trial) > 0 {
                groups.entry(scope.of(trial)).or_default().push(index);
            }
        }
        if groups.len() < 2 {
            continue;
        }
        for (name, members) in groups {
            let (design, y) = design(samples, &members, controls, dependent, terms, ridge);
            if y.len() <= terms.count() + 1 {
                continue;
            }
            let fitted = design.fitted(&y);
            let parts: Vec<Vec<usize>> = (0..design.parts.len()).map(|p| vec![p]).collect();
            let left = left_out(&design, &y, &fitted, &parts).map(|left| left.rmse);
            let n = y.len() as f64;
            let sum = |f: fn(f64) -> f64| fitted.residuals.iter().map(|e| f(*e)).sum::<f64>() / n;
            all.push(Scoped {
                scope,
                name: name.to_owned(),
                trials: members.len(),
                frames: y.len(),
                coefficients: [&[fitted.intercept], &fitted.coefficients[..]].concat(),
                mean_deviation: sum(f64::abs),
                rmse: sum(|e| e * e).sqrt(),
                left_out_rmse: left,
                global_left_out_rmse: of_global(samples, &members, global),
            });
        }
    }
    all
}

/// The global law's error on some trials, each left out; its parts are the trials in their order.
fn of_global(samples: &Samples, members: &[usize], global: &(Design, Vec<f64>)) -> Option<f64> {
    let (design, y) = global;
    let used: Vec<usize> =
        (0..samples.trials.len()).filter(|t| samples.frames_of(&samples.trials[*t]) > 0).collect();
    if design.parts.len() != used.len() {
        return None;
    }
    let fitted = design.fitted(y);
    let (mut sum, mut count) = (0.0, 0usize);
    for (part, trial) in used.iter().enumerate() {
        if members.contains(trial) {
            let predicted = design.left_out(y, &fitted, &[part])?;
            let rows = y[design.parts[part].clone()].iter().zip(&predicted);
            sum += rows.map(|(y, p)| (y - p).powi(2)).sum::<f64>();
            count += predicted.len();
        }
    }
    Some((sum / count.max(1) as f64).sqrt())
}

/// The design of some trials, each of which is a part, and the values of a dependent there.
pub(super) fn design(
    samples: &Samples,
    members: &[usize],
    controls: &[usize],
    dependent: usize,
    terms: &Terms,
    ridge: f64,
) -> (Design, Vec<f64>) {
    let width = samples.columns.len().max(1);
    let (mut rows, mut y, mut parts) = (vec![], vec![], vec![]);
    let mut values = vec![0.0; controls.len()];
    for &member in members {
        let start = y.len();
        for row in samples.trials[member].values.chunks_exact(width) {
            values.iter_mut().zip(controls).for_each(|(value, column)| *value = row[*column]);
            terms.at(&values, &mut rows);
            y.push(row[dependent]);
        }
        parts.push(start..y.len());
    }
    (Design::new(&rows, terms.count(), parts, ridge), y)
}
