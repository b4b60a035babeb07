//! Axes of one joint that are parallel, so that it loses a rotational degree of freedom.

use super::{Inspected, finding};
use condyle_diagnostics::{Diagnostic, Severity, Subject};
use condyle_math::{Mat3, Vec3};
use condyle_model::component::{Law, Signal};
use std::f64::consts::PI;

/// Axes at less than this angle, in degrees, are nearly parallel.
const NEARLY_PARALLEL: f64 = 5.0;

/// Consecutive axes within this of a right angle, in degrees, form an Euler triple.
const NEARLY_RIGHT: f64 = 0.5;

/// One rotation of a product, its axis in the frame of the joint when every angle is zero.
struct Turn {
    angle: Signal,
    axis: Vec3,
}

pub(super) fn check(subject: &Inspected<'_>, findings: &mut Vec<Diagnostic>) {
    for component in subject.model.components() {
        let Law::Product(_) = component.law else { continue };
        let set = &subject.model.joint_sets()[component.joint_set.index()].name;
        let turns = turns(subject, &component.inputs);
        for pair in turns.windows(2) {
            findings.extend(parallel(subject, set, &pair[0], &pair[1]));
        }
        for triple in turns.windows(3) {
            findings.extend(singular(subject, set, triple));
        }
    }
}

/// The turns of a product that vary; fixed frames between them turn the axes after them.
fn turns(subject: &Inspected<'_>, factors: &[Signal]) -> Vec<Turn> {
    let mut frame = Mat3::IDENTITY;
    let mut turns = vec![];
    for factor in factors {
        let Signal::Output(id, _) = factor else { continue };
        let component = &subject.model.components()[id.index()];
        match &component.law {
            Law::Place(place) => frame = frame * place.child_in_parent.linear,
            Law::Rotate(turn) => {
                let source = component.inputs[0];
                if subject.reach.leaders(source).is_empty() {
                    let angle = subject.reach.at_rest(source);
                    if angle.is_finite() {
                        frame = frame * Mat3::rotation_about(turn.axis, angle.sin_cos());
                    }
                } else {
                    turns.push(Turn { angle: source, axis: frame * turn.axis });
                }
            }
            Law::Translate(_) => {}
            // After any other rotation the directions of the axes are unknown.
            _ => turns.clear(),
        }
    }
    turns
}

/// The angle between two axes regardless of their sense, in degrees.
fn between(a: Vec3, b: Vec3) -> f64 {
    a.cross(b).norm().atan2(a.dot(b).abs()).to_degrees()
}

fn names(subject: &Inspected<'_>, turns: &[&Turn]) -> Vec<String> {
    let mut names: Vec<String> = vec![];
    for turn in turns {
        for &leader in subject.reach.leaders(turn.angle) {
            let key = subject.key(leader);
            if !names.contains(&key) {
                names.push(key);
            }
        }
    }
    names
}

fn parallel(subject: &Inspected<'_>, set: &str, a: &Turn, b: &Turn) -> Option<Diagnostic> {
    let angle = between(a.axis, b.axis);
    // Two rotations by one coordinate, or by a follower and its leader, lose no freedom.
    let own = |turn: &Turn| subject.reach.leaders(turn.angle);
    let shared = own(a).iter().any(|leader| own(b).contains(leader));
    if angle >= NEARLY_PARALLEL || shared {
        return None;
    }
    let names = names(subject, &[a, b]);
    Some(finding(
        Severity::Warning,
        "lint/parallel-axes",
        names.iter().cloned().map(Subject::Coordinate),
        format!(
            "two axes of joint `{set}` ({}) are only {}° apart: they are nearly the same axis",
            super::listed(&names),
            super::rounded(angle, 2)
        ),
        "choose axes that differ more, or remove one of the two",
    ))
}

/// Three rotations whose outer axes become parallel inside the range of the middle one.
fn singular(subject: &Inspected<'_>, set: &str, triple: &[Turn]) -> Option<Diagnostic> {
    let [a, m, c] = triple else { return None };
    let right = |a: Vec3, b: Vec3| (90.0 - between(a, b)).abs() < NEARLY_RIGHT;
    if !right(a.axis, m.axis) || !right(m.axis, c.axis) {
        return None;
    }
    let leaders = [a, m, c].map(|turn| subject.reach.leaders(turn.angle));
    if leaders[0] == leaders[1] || leaders[1] == leaders[2] || leaders[0] == leaders[2] {
        return None;
    }
    // a · R(m, t) c = A cos t + B sin t, which is ±1 where the outer axes are parallel.
    let at = a.axis.dot(m.axis.cross(c.axis)).atan2(a.axis.dot(c.axis));
    let taken = subject.reach.taken(m.angle)?;
    let [least, greatest] = taken.extremes()?;
    let (least, greatest) = (least.1, greatest.1);
    if greatest - least > 4.0 * PI {
        return None;
    }
    let slack = 1e-3;
    let first = ((least - slack - at) / PI).ceil();
    let hits = (0..5).map(|k| at + (first + f64::from(k)) * PI).filter(|&t| t <= greatest + slack);
    let mut hits: Vec<f64> = hits.map(f64::to_degrees).collect();
    hits.sort_by(|a, b| a.abs().total_cmp(&b.abs()).then(b.total_cmp(a)));
    let shown = match hits[..] {
        [] => return None,
        [one, other, ..] if (one + other).abs() < 0.1 => {
            format!("±{}", super::rounded(one.abs(), 1))
        }
        [one, ..] => super::rounded(one, 1),
    };
    let names = names(subject, &[a, m, c]);
    let middle = super::listed(self::names(subject, &[m]));
    Some(finding(
        Severity::Note,
        "lint/singular-triple",
        names.into_iter().map(Subject::Coordinate),
        format!(
            "the three rotations of joint `{set}` lose a degree of freedom where {middle} is \
             {shown}°, which lies inside its range"
        ),
        "near that posture only the sum or difference of the outer two angles is determined",
    ))
}
