//! From frames to laws.

use super::basis::{Basis, Terms};
use super::compared::{compared, design};
use super::design::Design;
use super::judged::{left_out, validity};
use super::law::{About, Law, Laws, TrialOf};
use super::{Samples, region_of, student};
use condyle_diagnostics::Error;
use condyle_model::CoordinateKind;
use condyle_solve::regression::Regression;
use std::collections::BTreeMap;
use std::ops::Range;

/// How laws are learned.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct Settings {
    /// The terms.
    pub basis: Basis,
    /// The ridge, relative to each term's sum of squares about its mean: a term that is perpendicular to the others is
    /// shrunk by 1/(1 + ridge). Intervals are then about the shrunk coefficients.
    pub ridge: f64,
}

/// Of one trial so many blocks of time stand in for trials.
const BLOCKS: usize = 8;

/// Learns how columns follow others.
///
/// ```
/// use condyle_learn::coupling::{Groups, Samples, Settings, learn};
/// // A bolt: 2 mm a turn.
/// let pitch = 0.002 / std::f64::consts::TAU;
/// let mut samples = Samples { columns: vec!["turn".into(), "along".into()], ..Samples::default() };
/// for trial in 0..3 {
///     let turn = |i: i32| f64::from(i) * 0.1 + f64::from(trial);
///     let rows: Vec<f64> = (0..50).flat_map(|i| [turn(i), 0.03 + pitch * turn(i)]).collect();
///     samples.add(&format!("bolt_{trial}"), Groups::of_name("bolt"), &rows, 0);
/// }
/// let laws = learn(&samples, &[], &[0], &[1], &Settings::default())?;
/// let law = &laws.laws[0];
/// assert!((law.coefficients[0] - pitch).abs() < 1e-15 && (law.intercept - 0.03).abs() < 1e-15);
/// assert!(law.accepted());
/// # Ok::<(), condyle_diagnostics::Error>(())
/// ```
///
/// # Errors
/// `learn/no-control` and `learn/no-follower` where one side is empty or nothing in control moves, `learn/both-sides` where a column is on both,
/// `learn/few-frames` where there are not two more frames than terms, `learn/few-values` where splines have more knots than
/// a control has values.
pub fn learn(
    samples: &Samples,
    kinds: &[Option<CoordinateKind>],
    control: &[usize],
    follow: &[usize],
    settings: &Settings,
) -> Result<Laws, Error> {
    check(samples, control, follow)?;
    let controls: Vec<Vec<f64>> = control.iter().map(|c| samples.column(*c)).collect();
    let names: Vec<String> = control.iter().map(|c| samples.columns[*c].clone()).collect();
    let frames = samples.frames();
    let terms = Terms::new(settings.basis, &controls).ok_or_else(|| {
        let message = "a control has not as many different values as its spline has knots";
        Error::new("learn/few-values", message)
            .with_help("use fewer knots, or leave coordinates that hardly move out of control")
    })?;
    if frames < terms.count() + 3 {
        let message = format!("{frames} frames for {} terms and a constant", terms.count());
        return Err(Error::new("learn/few-frames", message)
            .with_help("give more frames, or name fewer coordinates in control"));
    }
    let used: Vec<usize> = (0..samples.trials.len())
        .filter(|trial| samples.frames_of(&samples.trials[*trial]) > 0)
        .collect();
    let blocks = used.len() < 2;
    let members = |by: &dyn Fn(usize) -> String| -> Vec<Vec<usize>> {
        let mut groups: BTreeMap<String, Vec<usize>> = BTreeMap::new();
        for (part, trial) in used.iter().enumerate() {
            groups.entry(by(*trial)).or_default().push(part);
        }
        groups.into_values().collect()
    };
    let subjects = members(&|trial| samples.trials[trial].groups.subject.clone());
    let motions = members(&|trial| samples.trials[trial].groups.motion.clone());
    let (by_trial, _) = design(samples, &used, control, follow[0], &terms, settings.ridge);
    // The rows of the design, which all dependents share; parts are trials, or blocks of the only one.
    let parts = if blocks { in_blocks(frames) } else { by_trial.parts.clone() };
    let mut rows = Vec::with_capacity(frames * terms.count());
    let mut values = vec![0.0; control.len()];
    for frame in 0..frames {
        values.iter_mut().zip(&controls).for_each(|(value, column)| *value = column[frame]);
        terms.at(&values, &mut rows);
    }
    let whole = Design::new(&rows, terms.count(), parts, settings.ridge);
    if whole.fit.rank() == 0 {
        return Err(Error::new("learn/no-control", "nothing that is in control moves").with_help(
            "name other coordinates with --control, or give trials in which they move",
        ));
    }
    let clusters = whole.clusters();
    let alone: Vec<Vec<usize>> = (0..whole.parts.len()).map(|part| vec![part]).collect();
    let dropped = dropped(&whole.fit, |term| terms.name(term, &names));
    let mut by_trial = (by_trial, vec![]);
    let mut laws = vec![];
    for &dependent in follow {
        let y = samples.column(dependent);
        let fitted = whole.fitted(&y);
        let n = frames as f64;
        let mean = y.iter().sum::<f64>() / n;
        let total: f64 = y.iter().map(|y| (y - mean).powi(2)).sum();
        let left: f64 = fitted.residuals.iter().map(|e| e * e).sum();
        let r2 = if total > 0.0 { 1.0 - left / total } else { 0.0 };
        let interval = |(place, spread): (usize, &super::design::Spread)| {
            let value = match place {
                0 => fitted.intercept,
                place => fitted.coefficients[place - 1],
            };
            let is_dropped = place > 0 && whole.fit.dropped().contains(&(place - 1));
            if is_dropped || whole.parts.len() < 2 {
                return [f64::NEG_INFINITY, f64::INFINITY];
            }
            // A part that alone determines a coefficient leaves no freedom to judge it.
            if spread.freedom < 1e-6 {
                return [f64::NEG_INFINITY, f64::INFINITY];
            }
            let wide = student::quantile(0.975, spread.freedom) * spread.error;
            [value - wide, value + wide]
        };
        let spreads = clusters.spreads(&fitted);
        by_trial.1.clone_from(&y);
        let partial = (0..control.len()).map(|c| {
            let kept: Vec<usize> = (0..terms.count()).filter(|t| !terms.has(*t, c)).collect();
            partial(&rows, terms.count(), &kept, settings.ridge, &whole.parts, &y, left)
        });
        laws.push(Law {
            dependent: samples.columns[dependent].clone(),
            kind: kinds.get(dependent).copied().flatten(),
            function: terms.function(fitted.intercept, &fitted.coefficients),
            intercept: fitted.intercept,
            ci95: spreads.iter().enumerate().map(interval).collect(),
            freedom: spreads.iter().map(|spread| spread.freedom).collect(),
            r2,
            adjusted_r2: 1.0 - (1.0 - r2) * (n - 1.0) / (n - whole.fit.rank() as f64 - 1.0),
            rmse: (left / n).sqrt(),
            mean_deviation: fitted.residuals.iter().map(|e| e.abs()).sum::<f64>() / n,
            partial_r2: partial.collect(),
            left_out: left_out(&whole, &y, &fitted, &alone),
            left_out_subjects: left_out(&whole, &y, &fitted, &subjects).filter(|_| !blocks),
            left_out_motions: left_out(&whole, &y, &fitted, &motions).filter(|_| !blocks),
            validity: Some(validity(&y, &fitted.residuals)),
            scoped: match blocks {
                true => vec![],
                false => compared(samples, control, dependent, &terms, settings.ridge, &by_trial),
            },
            coefficients: fitted.coefficients,
        });
    }
    let trials = samples.trials.iter().map(|trial| TrialOf {
        name: trial.name.clone(),
        groups: trial.groups.clone(),
        frames: samples.frames_of(trial),
        missing: trial.missing,
        badly_tracked: trial.badly_tracked,
    });
    Ok(Laws {
        about: About::default(),
        terms: (0..terms.count()).map(|term| terms.name(term, &names)).collect(),
        kinds: control.iter().map(|c| kinds.get(*c).copied().flatten()).collect(),
        controls: names,
        basis: settings.basis,
        ridge: settings.ridge,
        dropped,
        condition: whole.fit.condition(),
        region: region_of(samples, control),
        trials: trials.collect(),
        blocks,
        laws,
    })
}

fn check(samples: &Samples, control: &[usize], follow: &[usize]) -> Result<(), Error> {
    let listed = || condyle_diagnostics::listed(&samples.columns);
    if control.is_empty() {
        return Err(Error::new("learn/no-control", "no coordinate is in control")
            .with_help(format!("name some of {} with --control", listed())));
    }
    if follow.is_empty() {
        return Err(Error::new("learn/no-follower", "no coordinate follows")
            .with_help(format!("name some of {} with --follow", listed())));
    }
    if let Some(both) = control.iter().find(|c| follow.contains(c)) {
        let message = format!("`{}` is to control and to follow", samples.columns[*both]);
        return Err(Error::new("learn/both-sides", message).with_help("name it on one side"));
    }
    Ok(())
}

fn in_blocks(frames: usize) -> Vec<Range<usize>> {
    (0..BLOCKS).map(|k| frames * k / BLOCKS..frames * (k + 1) / BLOCKS).collect()
}

fn dropped(fit: &Regression, name: impl Fn(usize) -> String) -> Vec<(String, Vec<(String, f64)>)> {
    let of = |&term: &usize| {
        let parts = fit.dependence(term).into_iter().enumerate();
        let parts = parts.filter(|(_, share)| share.abs() > 1e-9);
        (name(term), parts.map(|(other, share)| (name(other), share)).collect())
    };
    fit.dropped().iter().map(of).collect()
}

/// The share of what the other terms leave that a control's terms explain.
fn partial(
    rows: &[f64],
    count: usize,
    kept: &[usize],
    ridge: f64,
    parts: &[Range<usize>],
    y: &[f64],
    left: f64,
) -> f64 {
    let without: f64 = if kept.is_empty() {
        let mean = y.iter().sum::<f64>() / y.len() as f64;
        y.iter().map(|y| (y - mean).powi(2)).sum()
    } else {
        let others: Vec<f64> =
            rows.chunks_exact(count).flat_map(|row| kept.iter().map(|t| row[*t])).collect();
        let design = Design::new(&others, kept.len(), parts.to_vec(), ridge);
        design.fitted(y).residuals.iter().map(|e| e * e).sum()
    };
    if without > 0.0 { (1.0 - left / without).max(0.0) } else { 0.0 }
}
