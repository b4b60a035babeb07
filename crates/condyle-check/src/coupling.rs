//! Coordinates that follow others, and coordinates that move nothing.

use super::{Inspected, finding, real_range, tolerance};
use condyle_diagnostics::{Diagnostic, Severity, Subject};
use condyle_model::component::Signal;
use condyle_model::model::Condition;
use condyle_model::{CoordinateId, CoordinateKind};
use std::collections::HashSet;

pub(super) fn check(subject: &Inspected<'_>, findings: &mut Vec<Diagnostic>) {
    for id in subject.model.coordinate_ids() {
        if let Some(source) = subject.model.coordinate(id).follows {
            findings.extend(range_left(subject, id, source));
            findings.extend(default_ignored(subject, id));
            findings.extend(chain(subject, id, source));
        }
    }
    idle(subject, findings);
}

/// A follower that its leaders take out of its own range.
fn range_left(subject: &Inspected<'_>, id: CoordinateId, source: Signal) -> Option<Diagnostic> {
    let (lower, upper) = real_range(subject.model, id)?;
    let taken = subject.reach.taken(source)?;
    let outside = |value: f64| (lower - value).max(value - upper);
    let slack = tolerance(subject.kind(id)) * 10.0;
    let (values, worst) =
        taken.samples.iter().max_by(|a, b| outside(a.1).total_cmp(&outside(b.1)))?;
    if outside(*worst) <= slack {
        return None;
    }
    let key = subject.key(id);
    let limit = if *worst < lower { lower } else { upper };
    let posture: Vec<String> = taken
        .leaders
        .iter()
        .zip(values)
        .take(4)
        .map(|(&leader, &value)| {
            format!("`{}` = {}", subject.keys[leader.index()], subject.shown(leader, value))
        })
        .collect();
    let first = first_outside(&taken.samples, |value| outside(value) > slack);
    let from = match (first, &taken.leaders[..]) {
        (Some(value), [leader]) => {
            format!("; it leaves its range at {}", subject.shown(*leader, value))
        }
        _ => String::new(),
    };
    let enforced = subject.model.coordinate(id).range.enforced;
    let mut subjects = vec![key.clone()];
    subjects.extend(taken.leaders.iter().map(|&leader| subject.key(leader)));
    Some(finding(
        if enforced { Severity::Warning } else { Severity::Note },
        "lint/follower-range",
        subjects.into_iter().map(Subject::Coordinate),
        format!(
            "`{key}` is driven to {} at {}, {} past its limit {}{from}",
            subject.shown(id, *worst),
            posture.join(", "),
            subject.shown(id, outside(*worst)),
            subject.shown(id, limit),
        ),
        "widen the follower's range, or narrow that of its leaders",
    ))
}

/// The leader's value where the follower first enters or leaves its range, on the outer side.
fn first_outside(samples: &[(Vec<f64>, f64)], out: impl Fn(f64) -> bool) -> Option<f64> {
    let step = samples.windows(2).find(|pair| out(pair[0].1) != out(pair[1].1))?;
    let left = if out(step[0].1) { &step[0] } else { &step[1] };
    left.0.first().copied()
}

/// A default that differs from the value that the leaders' defaults determine: it has no effect.
fn default_ignored(subject: &Inspected<'_>, id: CoordinateId) -> Option<Diagnostic> {
    let coordinate = subject.model.coordinate(id);
    let (stated, made) = (coordinate.default[0], subject.rest.coordinate(subject.model, id)[0]);
    let visible = match coordinate.kind {
        CoordinateKind::Translation => 1e-3,
        _ => 1f64.to_radians(),
    };
    if !made.is_finite() || (stated - made).abs() <= visible {
        return None;
    }
    let key = subject.key(id);
    Some(finding(
        Severity::Note,
        "lint/follower-default",
        [Subject::Coordinate(key.clone())],
        format!(
            "the default of `{key}`, {}, has no effect: its leaders set it to {} at their defaults",
            subject.shown(id, stated),
            subject.shown(id, made)
        ),
        "write the value that it takes, so that other programs are not misled",
    ))
}

/// Of longer chains only the first members are named.
const LONGEST_NAMED: usize = 8;

/// A follower of a follower.
fn chain(subject: &Inspected<'_>, id: CoordinateId, source: Signal) -> Option<Diagnostic> {
    let mut path = vec![id];
    let mut seen = HashSet::new();
    let mut open = vec![source];
    while let Some(source) = open.pop().filter(|_| path.len() < LONGEST_NAMED) {
        if !seen.insert(source) {
            continue;
        }
        match source {
            Signal::Coordinate(leader) => {
                path.push(leader);
                open = subject.model.coordinate(leader).follows.into_iter().collect();
            }
            Signal::Output(component, _) => {
                open.extend(subject.model.components()[component.index()].values());
            }
            Signal::Segment(_) => {}
        }
    }
    if path.len() < 3 {
        return None;
    }
    let names: Vec<String> = path.iter().map(|&id| subject.key(id)).collect();
    Some(finding(
        Severity::Note,
        "lint/coupling-chain",
        names.iter().cloned().map(Subject::Coordinate),
        format!("`{}`", names.join("` follows `")),
        "other programs solve such chains less exactly; couple to the first leader where possible",
    ))
}

/// Free coordinates that move no segment.
fn idle(subject: &Inspected<'_>, findings: &mut Vec<Diagnostic>) {
    let model = subject.model;
    let mut moves = vec![false; model.tangent_len()];
    for segment in model.segment_ids() {
        for &(direction, _) in subject.program.segment_directions(segment) {
            moves[direction as usize] = true;
        }
    }
    for closure in model.closures() {
        if let Condition::Coupling { follower, driver, .. } = &closure.condition {
            for id in [*follower, *driver] {
                moves[model.tangent_range(id)].fill(true);
            }
        }
    }
    for id in model.coordinate_ids() {
        let directions = model.tangent_range(id);
        if model.coordinate(id).follows.is_some() || moves[directions].iter().any(|&m| m) {
            continue;
        }
        let follows = |other: &CoordinateId| {
            let follows = model.coordinate(*other).follows;
            follows.is_some_and(|source| subject.reach.leaders(source).contains(&id))
        };
        let followers: Vec<CoordinateId> = model.coordinate_ids().filter(follows).collect();
        // What it drives outside the model, itself or by one that follows it, is its use.
        if followers.iter().chain([&id]).any(|&one| model.coordinate(one).drives.is_some()) {
            continue;
        }
        let key = subject.key(id);
        let also = if !followers.is_empty() { ", and neither do those that follow it" } else { "" };
        findings.push(finding(
            Severity::Warning,
            "lint/moves-nothing",
            [Subject::Coordinate(key.clone())],
            format!("`{key}` moves no segment{also}"),
            "let an axis of its joint use it, say with `drives` what it drives outside the model, or remove it",
        ));
    }
}
