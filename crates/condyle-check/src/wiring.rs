//! Components that are connected in another way than is likely meant.

use super::{Inspected, finding, rounded};
use condyle_diagnostics::{Diagnostic, Severity, Subject};
use condyle_math::Vec3;
use condyle_model::component::{Component, Law, Signal, Swinging};
use condyle_model::model::ComponentId;
use condyle_model::{CoordinateId, SegmentId};

/// Axes that differ by less than this, in degrees, are written with few digits.
const AXES_DIFFER: f64 = 1.0;

/// Axes of cones that are not those of the rotations, angles that pass by their limit, contacts that do
/// not know what is before them, compensations that come too late.
pub(super) fn check(subject: &Inspected<'_>, findings: &mut Vec<Diagnostic>) {
    let model = subject.model;
    let motions: Vec<(SegmentId, Vec<Signal>)> = model
        .segment_ids()
        .filter_map(|id| Some((id, factors(subject, model.segment(id).motion?))))
        .collect();
    for id in model.component_ids() {
        let component = &model.components()[id.index()];
        match &component.law {
            Law::Cone(_) => cone_axes(subject, id, &motions, findings),
            Law::Contact(_) => before(subject, id, &motions, findings),
            Law::Compensate(_) => late(subject, id, &motions, findings),
            _ => {}
        }
        if component.law.bounds() {
            beside(subject, id, findings);
        }
    }
}

/// The factors of a motion, products taken apart.
fn factors(subject: &Inspected<'_>, motion: Signal) -> Vec<Signal> {
    let mut list = vec![];
    let mut open = vec![motion];
    // A model has no circles of components, but products may share factors without end.
    while let Some(signal) = open.pop().filter(|_| list.len() < 1000) {
        match signal {
            Signal::Output(id, _) => {
                let component = &subject.model.components()[id.index()];
                match component.law {
                    Law::Product(_) => open.extend(component.inputs.iter().rev()),
                    _ => list.push(signal),
                }
            }
            _ => list.push(signal),
        }
    }
    list
}

fn component_of<'m>(subject: &Inspected<'m>, signal: Signal) -> Option<&'m Component> {
    match signal {
        Signal::Output(id, _) => Some(&subject.model.components()[id.index()]),
        Signal::Coordinate(_) | Signal::Segment(_) => None,
    }
}

/// The axis of a rotation about a fixed direction.
fn axis(law: &Law) -> Option<Vec3> {
    match law {
        Law::Rotate(rotate) => Some(rotate.axis.normalized()),
        Law::Pivot(pivot) => Some(pivot.axis().normalized()),
        _ => None,
    }
}

/// A cone whose axes, or their order, are not those of the rotations that its outputs drive.
fn cone_axes(
    subject: &Inspected<'_>,
    id: ComponentId,
    motions: &[(SegmentId, Vec<Signal>)],
    findings: &mut Vec<Diagnostic>,
) {
    let model = subject.model;
    let cone = &model.components()[id.index()];
    let Law::Cone(law) = &cone.law else { return };
    let axes: &[Vec3] = match &law.of {
        Swinging::Angles(axes) => axes,
        Swinging::Directions(axes) => axes,
        Swinging::Orientation => return,
    };
    for (segment, motion) in motions {
        let turns = motion.iter().filter_map(|&factor| {
            let component = component_of(subject, factor)?;
            let driver = component.values().find_map(|signal| match signal {
                Signal::Output(from, output) if from == id => Some(output as usize),
                _ => None,
            })?;
            Some((driver, component, axis(&component.law)?))
        });
        let turns: Vec<(usize, &Component, Vec3)> = turns.collect();
        for &(output, rotation, found) in &turns {
            let Some(stated) = axes.get(output).map(|axis| axis.normalized()) else { continue };
            let angle = stated.cross(found).norm().atan2(stated.dot(found)).to_degrees();
            if angle <= AXES_DIFFER {
                continue;
            }
            findings.push(finding(
                Severity::Warning,
                "lint/cone-axes",
                [model.component_subject(rotation), model.component_subject(cone)],
                format!(
                    "`{}` turns by output {} of cone `{}` about {}, but the cone's axis {} is {}: {}° \
                     apart, so that the cone limits another posture",
                    rotation.name,
                    output + 1,
                    cone.name,
                    direction(found),
                    output + 1,
                    direction(stated),
                    rounded(angle, 1)
                ),
                "give the cone the axes of the rotations, in their order, or the rotations those of the cone",
            ));
        }
        let order: Vec<usize> = turns.iter().map(|(output, ..)| *output).collect();
        if order.windows(2).any(|pair| pair[0] > pair[1]) {
            let said = order.iter().map(|output| format!("{}", output + 1)).collect::<Vec<_>>();
            findings.push(finding(
                Severity::Warning,
                "lint/cone-order",
                [Subject::Segment(model.segment(*segment).name.clone()), model.component_subject(cone)],
                format!(
                    "`{}` is turned by the outputs {} of cone `{}` in this order, but the cone limits the \
                     product of its turns in the order of its angles",
                    model.segment(*segment).name,
                    said.join(", "),
                    cone.name
                ),
                "list the rotations in the output in the order of the cone's angles",
            ));
        }
    }
}

fn direction(v: Vec3) -> String {
    let numbers = v.to_array().map(|x| rounded(x, 3));
    format!("[{}]", numbers.join(", "))
}

/// An angle that a limit holds, and that moves a segment beside it as it is asked for.
fn beside(subject: &Inspected<'_>, id: ComponentId, findings: &mut Vec<Diagnostic>) {
    let model = subject.model;
    let limit = &model.components()[id.index()];
    // Only what a limit passes on can pass by it; of a dependency that is the passive angle.
    let held: Vec<CoordinateId> = limit
        .values()
        .take(limit.law.outputs().1)
        .filter_map(|signal| match signal {
            Signal::Coordinate(id) => Some(id),
            Signal::Output(..) | Signal::Segment(_) => None,
        })
        .collect();
    let through = |component: &&Component| {
        component.values().any(|s| matches!(s, Signal::Output(from, _) if from == id))
    };
    // A limit that nothing reads has a finding of its own.
    if !model.components().iter().any(|component| through(&component)) {
        return;
    }
    for component in model.components() {
        if !matches!(
            component.law,
            Law::Rotate(_) | Law::Pivot(_) | Law::Translate(_) | Law::Ball(_)
        ) {
            continue;
        }
        for &coordinate in &held {
            if !component.values().any(|signal| signal == Signal::Coordinate(coordinate)) {
                continue;
            }
            let (key, kind) = (subject.key(coordinate), limit.law.kind().name);
            findings.push(finding(
                Severity::Warning,
                "lint/limit-bypassed",
                [model.component_subject(component), Subject::Coordinate(key.clone())],
                format!(
                    "`{}` moves by `{key}` as it is asked for, beside {kind} `{}` that limits it",
                    component.name, limit.name
                ),
                format!("let it read what `{}` lets through", limit.name),
            ));
        }
    }
}

/// A contact that is not told what moves its segment before it, or is told something else.
fn before(
    subject: &Inspected<'_>,
    id: ComponentId,
    motions: &[(SegmentId, Vec<Signal>)],
    findings: &mut Vec<Diagnostic>,
) {
    let model = subject.model;
    let contact = &model.components()[id.index()];
    let said: Vec<Signal> =
        contact.at("before").iter().flat_map(|&signal| factors(subject, signal)).collect();
    for (segment, motion) in motions {
        let is_it = |signal: &Signal| matches!(signal, Signal::Output(from, _) if *from == id);
        let Some(place) = motion.iter().position(is_it) else { continue };
        // What compensates ancestors is before the joint's own motion.
        let really = &motion[..place];
        if really == said {
            continue;
        }
        let name = |signal: &Signal| match component_of(subject, *signal) {
            Some(component) => component.name.clone(),
            None => "?".to_owned(),
        };
        let list = |signals: &[Signal]| match signals {
            [] => "nothing".to_owned(),
            some => condyle_diagnostics::listed(some.iter().map(name)),
        };
        let segment = &model.segment(*segment).name;
        findings.push(finding(
            Severity::Warning,
            "lint/contact-before",
            [model.component_subject(contact), Subject::Segment(segment.clone())],
            format!(
                "contact `{}` reckons with {} before it, but the output of `{segment}` has {} there: its \
                 points will miss the surface",
                contact.name,
                list(&said),
                list(really)
            ),
            "let `before` name what stands before the contact in the output, several as a product",
        ));
    }
}

/// A compensation that comes after other factors: it is no longer about the joint.
fn late(
    subject: &Inspected<'_>,
    id: ComponentId,
    motions: &[(SegmentId, Vec<Signal>)],
    findings: &mut Vec<Diagnostic>,
) {
    let model = subject.model;
    let own = &model.components()[id.index()];
    for (segment, motion) in motions {
        let is_it = |signal: &Signal| matches!(signal, Signal::Output(from, _) if *from == id);
        let Some(place) = motion.iter().position(is_it) else { continue };
        let ahead = motion[..place].iter().filter_map(|&signal| component_of(subject, signal));
        let ahead: Vec<&Component> = ahead.collect();
        let segment_name = &model.segment(*segment).name;
        let moves = |c: &&&Component| !matches!(c.law, Law::Compensate(_) | Law::Place(_));
        if let Some(first) = ahead.iter().find(moves) {
            findings.push(finding(
                Severity::Warning,
                "lint/compensate-late",
                [model.component_subject(own), Subject::Segment(segment_name.clone())],
                format!(
                    "compensate `{}` comes after `{}` in the output of `{segment_name}`: it cancels the \
                     ancestors' rotations only where it comes first",
                    own.name, first.name
                ),
                format!("put `{}` first in the output", own.name),
            ));
        }
        // Each is computed from the parent's pose alone: A⁻¹·A′ after another one cancels what it should only
        // if what the other one cancels is further out.
        let outermost = |c: &Component| {
            c.segments_at("ancestors").map(|id| model.path_to_root(id).count()).min().unwrap_or(0)
        };
        let wrong =
            |c: &&&Component| matches!(c.law, Law::Compensate(_)) && outermost(c) >= outermost(own);
        if let Some(other) = ahead.iter().find(wrong) {
            findings.push(finding(
                Severity::Warning,
                "lint/compensate-order",
                [model.component_subject(own), model.component_subject(other)],
                format!(
                    "`{segment_name}` is compensated by `{}` and then by `{}`, whose ancestor is further out: \
                     together they leave a rotation",
                    other.name, own.name
                ),
                "list the compensation of the outer ancestor first, or name all ancestors in one compensate",
            ));
        }
    }
}
