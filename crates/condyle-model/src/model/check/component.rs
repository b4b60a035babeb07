//! Errors of components.

use super::{AXIS_LENGTH, finding, source_type};
use crate::component::{Component, Fault, Law, PortType, Signal};
use crate::model::{Condition, Model, Node, dependency_order};
use condyle_diagnostics::{Diagnostic, Severity, Subject};
use condyle_math::Vec3;
use std::fmt;

/// A component as named in messages and reports.
struct Part {
    sentence: String,
    subject: Subject,
}

impl Part {
    fn of(model: &Model, component: &Component) -> Self {
        let (kind, name) = (component.law.kind().name, &component.name);
        let set = &model.joint_sets[component.joint_set.index()].name;
        Self {
            sentence: format!("component `{name}` ({kind}) of joint set `{set}`"),
            subject: model.component_subject(component),
        }
    }
}

impl Part {
    fn error(
        &self,
        code: &'static str,
        message: impl Into<String>,
        help: impl Into<String>,
    ) -> Diagnostic {
        finding(Severity::Error, code, self.subject.clone(), message, help)
    }
}

impl fmt::Display for Part {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.sentence)
    }
}

pub(super) fn check_components(model: &Model, findings: &mut Vec<Diagnostic>) {
    let deforming = deforming_components(model);
    for component in &model.components {
        let place = Part::of(model, component);
        check_ports(model, &place, component, findings);
        for (name, axis) in component.law.clone().directions() {
            check_axis(&place, name, *axis, findings);
        }
        let (has, takes) = (component.inputs.len(), component.law.takes());
        if let Some(takes) = takes.filter(|&takes| takes != has) {
            let message = format!("{place} has {has} inputs but its function takes {takes}");
            let help = "connect as many inputs as the function has arguments";
            findings.push(place.error("model/arity", message, help));
        }
        for Fault { severity, code, said, help } in component.law.faults() {
            let subject = place.subject.clone();
            findings.push(finding(severity, code, subject, format!("{place} {said}"), help));
        }
        check_segments(model, &place, component, &deforming, findings);
    }
    check_closures(model, &deforming, findings);
}

/// Types and numbers of what is at the ports.
fn check_ports(model: &Model, place: &Part, component: &Component, findings: &mut Vec<Diagnostic>) {
    let (mut single, mut listed) = (0, false);
    for port in component.law.ports() {
        single += usize::from(!port.is_list());
        listed |= port.is_list();
    }
    let inputs = component.inputs.len();
    if inputs < single || (inputs > single && !listed) {
        let message = format!("{place} has {inputs} inputs");
        let help = format!("connect {single}, one to each of its ports");
        findings.push(place.error("model/arity", message, help));
    }
    for (port, signals) in component.by_port() {
        let (has, most) = (signals.len(), port.most);
        if has > most {
            let message = format!("{place} has {has} {}", port.name);
            let help = format!("it takes at most {most}");
            findings.push(place.error("model/arity", message, help));
        }
    }
    for (port, source) in component.ports() {
        let (name, found) = (port.name, source_type(model, source));
        if let Signal::Output(id, output) = source {
            let read = &model.components[id.index()];
            let outputs = read.law.outputs().1;
            if output as usize >= outputs {
                let output = output + 1;
                let message =
                    format!("port `{name}` of {place} reads output {output} of `{}`", read.name);
                findings.push(place.error(
                    "model/no-such-output",
                    message,
                    format!("it has {outputs}"),
                ));
            }
        }
        let fits = match port.takes {
            PortType::Joint => found == PortType::Segment,
            takes => found == takes,
        };
        if !fits {
            let message = format!("port `{name}` of {place} gets a {found:?}").to_lowercase();
            let help = format!("connect a {:?}", port.takes).to_lowercase();
            findings.push(place.error("model/port-type", message, help));
        }
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

/// Which components produce transforms that stretch or shear.
fn deforming_components(model: &Model) -> Vec<bool> {
    let mut deforming = vec![false; model.components.len()];
    for node in dependency_order(model).unwrap_or_default() {
        let Node::Component(id) = node else { continue };
        let component = &model.components[id.index()];
        deforming[id.index()] = component.law.deforms()
            || matches!(component.law, Law::Product(_))
                && component.values().any(|factor| deforms(&deforming, factor));
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

/// Whether the segments at the ports can be used: ancestors of the one whose joint is at a port, and moved
/// by rotations and translations alone.
fn check_segments(
    model: &Model,
    place: &Part,
    component: &Component,
    deforming: &[bool],
    findings: &mut Vec<Diagnostic>,
) {
    let mut segments = component
        .ports()
        .filter_map(|(port, signal)| signal.segment().map(|segment| (port, segment)));
    let Some((own, moved)) = segments.next() else { return };
    if own.takes == PortType::Joint {
        let ancestors = model.path_to(model.segment(moved).parent);
        for (port, id) in segments.filter(|(_, id)| !ancestors.contains(id)) {
            let (port, name) = (port.name, &model.segment(id).name);
            let moved = &model.segment(moved).name;
            let message = format!(
                "port `{port}` of {place} gets `{name}`, which is not an ancestor of `{moved}`"
            );
            let help = "name an ancestor of this segment";
            findings.push(place.error("model/not-an-ancestor", message, help));
        }
    }
    let between = model.between(component).into_iter();
    let between = between.map(|id| (model.segment(id).motion, id));
    let before = (component.at("before").first().copied(), moved);
    for (motion, segment) in between.chain([before]) {
        if motion.is_some_and(|motion| deforms(deforming, motion)) {
            let segment = &model.segment(segment).name;
            let message = format!(
                "{place} needs rotations, but the motion of `{segment}` stretches or shears"
            );
            let help = "put the scale or shear on a segment further out, or on one of its own";
            findings.push(place.error("model/deforms", message, help));
        }
    }
}
