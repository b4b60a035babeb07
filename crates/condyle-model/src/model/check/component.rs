//! Errors of components.

use super::{AXIS_LENGTH, finding, source_type};
use crate::component::{
    Component, Curve, JointCone, Law, MOST_LAW_INPUTS, PortType, Shear, Signal, Swinging,
};
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
        let inputs = component.inputs.len();
        match &component.law {
            Law::Compensate(c) => {
                check_weight(&place, c.weight, findings);
                check_ancestors(model, &place, component, "ancestors", findings);
                check_rigid(model, &place, component, &deforming, findings);
            }
            Law::Contact(_) => {
                check_ancestors(model, &place, component, "surface", findings);
                check_rigid(model, &place, component, &deforming, findings);
                let drivers = component.at("drivers").len();
                if drivers > 2 {
                    let message = format!("{place} has {drivers} drivers");
                    let help = "blend its pairs over at most two";
                    findings.push(place.error("model/arity", message, help));
                }
            }
            Law::Combine(c) => check_arity(&place, inputs, c.function.arity(), findings),
            Law::Custom(_) if inputs > MOST_LAW_INPUTS => {
                let message = format!("{place} has {inputs} inputs");
                let help = format!("it takes at most {MOST_LAW_INPUTS}");
                findings.push(place.error("model/arity", message, help));
            }
            Law::Cone(c) => check_cone(&place, c, component.at("angles").len(), findings),
            Law::HalfSpace(c) => check_arity(&place, inputs, c.normal().len(), findings),
            Law::RelativeOrientation(_) | Law::RelativePosition(_) => {
                check_rigid(model, &place, component, &deforming, findings);
            }
            Law::Shear(c) => check_shear(&place, c, findings),
            Law::Curve(c) => check_curve(&place, c, findings),
            Law::Map(_)
            | Law::Depend(_)
            | Law::Ellipse(_)
            | Law::Angles(_)
            | Law::Rotate(_)
            | Law::Pivot(_)
            | Law::Translate(_)
            | Law::Ball(_)
            | Law::Place(_)
            | Law::Ellipsoid(_)
            | Law::ConstantCurvature(_)
            | Law::Scale(_)
            | Law::Custom(_)
            | Law::Product(_) => {}
        }
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

fn check_arity(place: &Part, has: usize, takes: usize, findings: &mut Vec<Diagnostic>) {
    if has != takes {
        let message = format!("{place} has {has} inputs but its function takes {takes}");
        let help = "connect as many inputs as the function has arguments";
        findings.push(place.error("model/arity", message, help));
    }
}

fn check_cone(place: &Part, cone: &JointCone, angles: usize, findings: &mut Vec<Diagnostic>) {
    let axes = match cone.of {
        Swinging::Angles(_) => 3,
        Swinging::Directions(_) => 2,
        Swinging::Orientation => 0,
    };
    check_arity(place, angles, axes, findings);
    if matches!(cone.of, Swinging::Directions(_)) && cone.cone.twist_at_rest().is_some() {
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

fn check_weight(place: &Part, weight: f64, findings: &mut Vec<Diagnostic>) {
    if !(0.0..=1.0).contains(&weight) {
        let message = format!("{place} has the weight {weight}");
        let help = "give a weight from 0 (nothing is undone) to 1 (all is)";
        findings.push(place.error("model/weight", message, help));
    }
}

/// Whether the segments at a port are ancestors of the one at the port `segment`.
fn check_ancestors(
    model: &Model,
    place: &Part,
    component: &Component,
    port: &str,
    findings: &mut Vec<Diagnostic>,
) {
    let Some(moved) = component.segments_at("segment").next() else { return };
    let ancestors = model.path_to(model.segment(moved).parent);
    for id in component.segments_at(port).filter(|id| !ancestors.contains(id)) {
        let (name, moved) = (&model.segment(id).name, &model.segment(moved).name);
        let message = format!(
            "port `{port}` of {place} gets `{name}`, which is not an ancestor of `{moved}`"
        );
        let help = "name an ancestor of this segment";
        findings.push(place.error("model/not-an-ancestor", message, help));
    }
}

/// Whether everything that it reads transforms by rotations and translations alone.
fn check_rigid(
    model: &Model,
    place: &Part,
    component: &Component,
    deforming: &[bool],
    findings: &mut Vec<Diagnostic>,
) {
    let between = model.between(component).into_iter();
    let between = between.map(|id| (model.segment(id).motion, id));
    let own = component.segments_at("segment").next();
    let before = own.and_then(|id| Some((component.at("before").first().copied(), id)));
    for (motion, segment) in between.chain(before) {
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
