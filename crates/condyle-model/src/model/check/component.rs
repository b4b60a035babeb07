//! Errors of components.

use super::{AXIS_LENGTH, finding, source_type};
use crate::component::{
    Compensate, Component, Contact, Curve, JointCone, Law, MOST_COMBINED, MOST_LAW_INPUTS, Shear,
    Signal, Swinging,
};
use crate::model::{Condition, Model, NamedComponent, Node, SegmentId, dependency_order};
use condyle_diagnostics::{Diagnostic, Severity, Subject};
use condyle_math::Vec3;
use std::fmt;

/// A component as named in messages and reports.
struct Part {
    sentence: String,
    subject: Subject,
}

impl Part {
    fn of(model: &Model, named: &NamedComponent) -> Self {
        let (kind, set) = (named.component.kind(), &model.joint_sets[named.joint_set.index()].name);
        Self {
            sentence: format!("component `{}` ({kind}) of joint set `{set}`", named.name),
            subject: model.component_subject(named),
        }
    }
}

impl fmt::Display for Part {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.sentence)
    }
}

pub(super) fn check_components(model: &Model, findings: &mut Vec<Diagnostic>) {
    let deforming = deforming_components(model);
    for named in &model.components {
        let place = Part::of(model, named);
        for (port, expected, source) in named.component.inputs() {
            let found = source_type(model, source);
            if let Signal::Output(id, output) = source
                && output as usize >= model.components[id.index()].component.outputs().1
            {
                findings.push(finding(
                    Severity::Error,
                    "model/no-such-output",
                    place.subject.clone(),
                    format!(
                        "port `{port}` of {place} reads output {} of `{}`",
                        output + 1,
                        model.components[id.index()].name
                    ),
                    format!("it has {}", model.components[id.index()].component.outputs().1),
                ));
            }
            if found != expected {
                findings.push(finding(
                    Severity::Error,
                    "model/port-type",
                    place.subject.clone(),
                    format!("port `{port}` of {place} gets a {found:?}").to_lowercase(),
                    format!("connect a {expected:?}").to_lowercase(),
                ));
            }
        }
        for (name, axis) in axes(&named.component) {
            check_axis(&place, name, axis, findings);
        }
        match &named.component {
            Component::Compensate(c) => check_compensate(model, &place, c, &deforming, findings),
            Component::Contact(c) => check_contact(model, &place, c, &deforming, findings),
            Component::Combine(c) => {
                check_arity(&place, c.inputs.len(), c.function.arity(), MOST_COMBINED, findings);
            }
            Component::Custom(c) => {
                check_arity(&place, c.inputs.len(), c.inputs.len(), MOST_LAW_INPUTS, findings);
            }
            Component::Cone(c) => check_cone(&place, c, findings),
            Component::Shear(c) => check_shear(&place, c, findings),
            Component::Curve(c) => check_curve(&place, c, findings),
            _ => {}
        }
    }
    check_closures(model, &deforming, findings);
}

/// The directions of a component, normalised when the model is built.
fn axes(component: &Component) -> Vec<(&'static str, Vec3)> {
    match component {
        Component::Rotate(c) => vec![("axis", c.axis)],
        Component::Translate(c) => vec![("axis", c.axis)],
        Component::Scale(c) => c.along.axis().map(|axis| ("axis", axis)).into_iter().collect(),
        Component::Shear(c) => vec![("along", c.along), ("across", c.across)],
        Component::Cone(c) => match &c.of {
            Swinging::Angles(_, axes) => axes.iter().map(|&axis| ("axes", axis)).collect(),
            Swinging::Directions(_, axes) => axes.iter().map(|&axis| ("axes", axis)).collect(),
            Swinging::Orientation(_) => vec![],
        },
        Component::Curve(c) => match c.heading {
            Some(heading) => vec![("forward", heading.forward), ("up", heading.up)],
            None => vec![],
        },
        _ => vec![],
    }
}

fn check_axis(place: &Part, name: &str, axis: Vec3, findings: &mut Vec<Diagnostic>) {
    let length = axis.norm();
    if !(length.is_finite() && length > 1e-9) {
        findings.push(finding(
            Severity::Error,
            "model/axis",
            place.subject.clone(),
            format!("the {name} of {place} has length {length}"),
            "give a direction, such as [0, 0, 1]",
        ));
    } else if (length - 1.0).abs() > 1e-6 {
        findings.push(finding(
            Severity::Warning,
            AXIS_LENGTH,
            place.subject.clone(),
            format!("the {name} of {place} has length {length}"),
            "it is normalised; write it with length 1 to avoid this warning",
        ));
    }
}

fn check_arity(
    place: &Part,
    has: usize,
    takes: usize,
    most: usize,
    findings: &mut Vec<Diagnostic>,
) {
    if has != takes {
        findings.push(finding(
            Severity::Error,
            "model/arity",
            place.subject.clone(),
            format!("{place} has {has} inputs but its function takes {takes}"),
            "connect as many inputs as the function has arguments",
        ));
    }
    if has > most {
        findings.push(finding(
            Severity::Error,
            "model/arity",
            place.subject.clone(),
            format!("{place} has {has} inputs"),
            format!("it takes at most {most}"),
        ));
    }
}

fn check_cone(place: &Part, cone: &JointCone, findings: &mut Vec<Diagnostic>) {
    let oblique = cone.obliqueness();
    if oblique.is_nan() || oblique > 1e-6 {
        findings.push(finding(
            Severity::Error,
            "model/cone-axes",
            place.subject.clone(),
            format!("the second axis of {place} is not perpendicular to the others"),
            "use axes such as z, x, y: the second perpendicular to the first and to the \
             third (with two angles: to the rest direction)",
        ));
    }
    if matches!(cone.of, Swinging::Directions(..)) && cone.cone.twist_at_rest().is_some() {
        findings.push(finding(
            Severity::Warning,
            "model/cone-twist",
            place.subject.clone(),
            format!("{place} has bounds of twist but only two angles"),
            "give it a third angle, or omit the bounds",
        ));
    }
}

fn check_shear(place: &Part, shear: &Shear, findings: &mut Vec<Diagnostic>) {
    let along = shear.along.normalized().dot(shear.across.normalized());
    if along.abs() > 1e-6 {
        findings.push(finding(
            Severity::Error,
            "model/shear-axes",
            place.subject.clone(),
            format!("the two directions of {place} are not perpendicular"),
            "layers slide at a right angle to the direction in which they are stacked",
        ));
    }
}

fn check_curve(place: &Part, curve: &Curve, findings: &mut Vec<Diagnostic>) {
    if curve.least_heading() < 1e-3 {
        findings.push(finding(
            Severity::Warning,
            "model/curve-heading",
            place.subject.clone(),
            format!(
                "the curve of {place} has zero velocity or is parallel to `up` somewhere, so its heading is undefined there"
            ),
            "give another `up`, or a curve whose points differ",
        ));
    }
}

/// Which components produce transforms that stretch or shear.
fn deforming_components(model: &Model) -> Vec<bool> {
    let mut deforming = vec![false; model.components.len()];
    for node in dependency_order(model).unwrap_or_default() {
        let Node::Component(id) = node else { continue };
        deforming[id.index()] = match &model.components[id.index()].component {
            Component::Scale(_) | Component::Shear(_) => true,
            Component::Custom(c) => !c.is_rigid(),
            Component::Product(c) => c.factors.iter().any(|&factor| deforms(&deforming, factor)),
            _ => false,
        };
    }
    deforming
}

fn deforms(deforming: &[bool], source: Signal) -> bool {
    matches!(source, Signal::Output(id, _) if deforming[id.index()])
}

fn check_closures(model: &Model, deforming: &[bool], findings: &mut Vec<Diagnostic>) {
    for closure in &model.closures {
        let Condition::Frames { at } = &closure.condition else { continue };
        for (segment, _) in at {
            let mut here = *segment;
            let mut steps = 0;
            while let Some(id) = here
                && steps < model.segments.len()
            {
                let segment = model.segment(id);
                if segment.motion.is_some_and(|motion| deforms(deforming, motion)) {
                    findings.push(finding(
                        Severity::Error,
                        "model/closure-deforms",
                        Subject::Closure(closure.name.clone()),
                        format!(
                            "closure `{}` holds frames together, but `{}` stretches or shears",
                            closure.name, segment.name
                        ),
                        "hold points together instead",
                    ));
                    return;
                }
                here = segment.parent;
                steps += 1;
            }
        }
    }
}

fn check_compensate(
    model: &Model,
    place: &Part,
    c: &Compensate,
    deforming: &[bool],
    findings: &mut Vec<Diagnostic>,
) {
    if !(0.0..=1.0).contains(&c.weight) {
        findings.push(finding(
            Severity::Error,
            "model/weight",
            place.subject.clone(),
            format!("{place} has the weight {}", c.weight),
            "give a weight from 0 (nothing is undone) to 1 (all is)",
        ));
    }
    let mut ancestors = vec![];
    let mut here = model.segment(c.segment).parent;
    while let Some(id) = here
        && ancestors.len() < model.segments.len()
    {
        ancestors.push(id);
        here = model.segment(id).parent;
    }
    for id in c.ancestors.iter().filter(|id| !ancestors.contains(id)) {
        findings.push(finding(
            Severity::Error,
            "model/not-an-ancestor",
            place.subject.clone(),
            format!(
                "{place} compensates `{}`, which is not an ancestor of `{}`",
                model.segment(*id).name,
                model.segment(c.segment).name
            ),
            "name ancestors of this segment",
        ));
    }
    for id in model.compensated_path(c) {
        check_rigid(model, place, id, model.segment(id).motion, deforming, findings);
    }
}

fn check_contact(
    model: &Model,
    place: &Part,
    c: &Contact,
    deforming: &[bool],
    findings: &mut Vec<Diagnostic>,
) {
    let path = model.path_between(c.surface, c.segment);
    if path.is_empty() {
        findings.push(finding(
            Severity::Error,
            "model/not-an-ancestor",
            place.subject.clone(),
            format!(
                "{place} glides on `{}`, which is not an ancestor of `{}`",
                model.segment(c.surface).name,
                model.segment(c.segment).name
            ),
            "name an ancestor of this segment",
        ));
    }
    for id in path {
        let motion = if id == c.segment { c.before } else { model.segment(id).motion };
        check_rigid(model, place, id, motion, deforming, findings);
    }
    if c.drivers.len() > 2 {
        findings.push(finding(
            Severity::Error,
            "model/arity",
            place.subject.clone(),
            format!("{place} has {} drivers", c.drivers.len()),
            "blend its pairs over at most two",
        ));
    }
}

fn check_rigid(
    model: &Model,
    place: &Part,
    segment: SegmentId,
    motion: Option<Signal>,
    deforming: &[bool],
    findings: &mut Vec<Diagnostic>,
) {
    if motion.is_some_and(|motion| deforms(deforming, motion)) {
        findings.push(finding(
            Severity::Error,
            "model/deforms",
            place.subject.clone(),
            format!(
                "{place} needs rotations, but the motion of `{}` stretches or shears",
                model.segment(segment).name
            ),
            "put the scale or shear on a segment further out, or on one of its own",
        ));
    }
}
