//! Functions defined by knots, and the arguments that ranges allow.
//!
//! Beyond its last knot a spline is extrapolated linearly, where nothing was measured: the range of the
//! coordinate that drives it promises more than the function knows.

use super::{Inspected, amount, finding};
use condyle_diagnostics::{Diagnostic, Severity, Subject};
use condyle_math::function::Function;
use condyle_model::component::{Centre, Component, Law, Signal};
use condyle_model::{CoordinateId, CoordinateKind};
use std::collections::BTreeMap;

/// An argument beyond the knots by less than this fraction of their span is rounding in the file.
const ROUNDING: f64 = 2e-3;

/// One function that is used beyond its knots on one side.
struct Beyond {
    /// The function's name in messages.
    function: String,
    /// The last knot there.
    knot: f64,
    /// The argument farthest beyond the knot, and the leader's value there.
    argument: f64,
    leader: f64,
    /// How far the extrapolated value is from that at the knot, and its kind.
    drift: f64,
    makes: CoordinateKind,
    /// Whether the argument is the leading coordinate's own value.
    direct: bool,
}

/// One finding for each coordinate and side of its range, with all functions that are too short.
pub(super) fn check(subject: &Inspected<'_>, findings: &mut Vec<Diagnostic>) {
    let mut found: BTreeMap<(CoordinateId, bool), Vec<Beyond>> = BTreeMap::new();
    for (index, component) in subject.model.components().iter().enumerate() {
        findings.extend(interval(subject, component));
        let uses = uses(subject, component);
        let Some(first) = uses.first() else { continue };
        let Some(taken) = subject.reach.taken(first.argument) else { continue };
        let ([leader], Some(extremes)) = (&taken.leaders[..], taken.extremes()) else { continue };
        let set = &subject.model.joint_sets()[component.joint_set.index()].name;
        for Use { function, makes, .. } in &uses {
            let Some((first, last)) = function.domain().filter(|_| !is_flat(function)) else {
                continue;
            };
            for (upper, knot) in [(false, first), (true, last)] {
                let (values, argument) = extremes[usize::from(upper)];
                let past = if upper { argument - knot } else { knot - argument };
                if past <= ROUNDING * (last - first).max(0.5) {
                    continue;
                }
                let value = |x: f64| function.value_and_slope(x).0;
                let middle = (extremes[0].0[0] + extremes[1].0[0]) / 2.0;
                found.entry((*leader, values[0] > middle)).or_default().push(Beyond {
                    function: name_of(subject, index, set),
                    knot,
                    argument: *argument,
                    leader: values[0],
                    drift: value(*argument) - value(knot),
                    makes: *makes,
                    direct: (values[0] - argument).abs() < 1e-6,
                });
            }
        }
    }
    for ((leader, _), list) in found {
        findings.push(say(subject, leader, &list));
    }
}

/// A function of a component: what it is evaluated at, and what it makes.
struct Use<'m> {
    function: &'m Function,
    argument: Signal,
    makes: CoordinateKind,
}

/// The functions of a component; all have the same argument.
fn uses<'m>(subject: &Inspected<'m>, component: &'m Component) -> Vec<Use<'m>> {
    match &component.law {
        Law::Map(map) => {
            let Some(&argument) = component.inputs.first() else { return vec![] };
            let one = |(output, function)| {
                let signal = subject.output(component, output);
                let makes = signal.map_or(CoordinateKind::Other, |signal| subject.used_as(signal));
                Use { function, argument, makes }
            };
            map.functions.iter().enumerate().map(one).collect()
        }
        Law::Depend(depend) => {
            let [passive, argument] = component.inputs[..] else { return vec![] };
            let makes = subject.kind_of(passive);
            let bounds = [&depend.lower, &depend.upper].into_iter().flatten();
            bounds.map(|function| Use { function, argument, makes }).collect()
        }
        _ => vec![],
    }
}

/// A pivot whose last interval ends before the range of its angle does.
fn interval(subject: &Inspected<'_>, component: &Component) -> Option<Diagnostic> {
    let Law::Pivot(pivot) = &component.law else { return None };
    let Centre::Intervals(list) = pivot.centre() else { return None };
    let (end, _) = *list.last().filter(|(end, _)| end.is_finite())?;
    let (_, most) = subject.range_of(*component.inputs.first()?)?;
    if most - end <= 0.01 {
        return None;
    }
    let kind = CoordinateKind::Rotation;
    Some(finding(
        Severity::Warning,
        "lint/beyond-intervals",
        [subject.model.component_subject(component)],
        format!(
            "the angle of pivot `{}` may reach {}, but its last interval ends at {}: its last centre is used \
             for the last {}",
            component.name,
            amount(kind, most),
            amount(kind, end),
            amount(kind, most - end)
        ),
        "add an interval up to the end of the range, or leave out the last `to`",
    ))
}

/// The name of a function: the coordinate that follows it, or its component.
fn name_of(subject: &Inspected<'_>, component: usize, set: &str) -> String {
    let follower = subject.model.coordinate_ids().find(|&id| {
        matches!(subject.model.coordinate(id).follows, Some(Signal::Output(made, _))
            if made.index() == component)
    });
    match follower {
        Some(id) => subject.key(id),
        None => format!("{set}/{}", subject.model.components()[component].name),
    }
}

/// Whether a function is constant, whatever its knots.
fn is_flat(function: &Function) -> bool {
    let Some((first, last)) = function.domain() else { return true };
    let slope = |x: f64| function.value_and_slope(x).1.abs();
    (0..=16).all(|i| slope(first + (last - first) * f64::from(i) / 16.0) < 1e-12)
}

fn say(subject: &Inspected<'_>, leader: CoordinateId, list: &[Beyond]) -> Diagnostic {
    let key = subject.key(leader);
    let kind = subject.kind(leader);
    let worst = list
        .iter()
        .max_by(|a, b| (a.argument - a.knot).abs().total_cmp(&(b.argument - b.knot).abs()))
        .unwrap_or(&list[0]);
    let mut names: Vec<String> = list.iter().map(|b| b.function.clone()).collect();
    names.sort();
    names.dedup();
    // Degrees of an argument make sense only if it is a coordinate's own value.
    let unit = if worst.direct { kind } else { CoordinateKind::Other };
    let past = (worst.argument - worst.knot).abs();
    let argument = match worst.direct {
        true => String::new(),
        false => format!(" (its argument is then {})", amount(unit, worst.argument)),
    };
    let drifts: Vec<String> =
        [CoordinateKind::Rotation, CoordinateKind::Translation, CoordinateKind::Other]
            .into_iter()
            .filter_map(|kind| {
                let own = list.iter().filter(|b| b.makes == kind).map(|b| b.drift.abs());
                own.max_by(f64::total_cmp).map(|most| amount(kind, most))
            })
            .collect();
    let functions = match names.len() {
        1 => format!("the function of `{}`", names[0]),
        n => format!("{n} functions ({})", super::listed(&names)),
    };
    let enforced = subject.model.coordinate(leader).range.enforced;
    let mut subjects = vec![key.clone()];
    subjects.extend(names.iter().cloned());
    finding(
        if enforced { Severity::Warning } else { Severity::Note },
        "lint/beyond-knots",
        subjects.into_iter().map(Subject::Coordinate),
        format!(
            "`{key}` may reach {}{argument}, but {functions} that it drives end{} at {}: the last {} \
             {} extrapolated, by up to {}",
            amount(kind, worst.leader),
            if names.len() == 1 { "s" } else { "" },
            amount(unit, worst.knot),
            amount(unit, past),
            if worst.direct { "are" } else { "of its argument are" },
            drifts.join(" and "),
        ),
        "narrow the range to the knots, or add knots",
    )
}
