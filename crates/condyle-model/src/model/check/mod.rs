//! Validity of a model: names, types, places and cycles, checked once when it is built.

mod component;
mod order;

pub(crate) use order::{Node, dependency_order, measured};

use super::{CoordinateKind, Model, SegmentId};
use crate::component::{PortType, Signal};
use component::check_components;
use condyle_diagnostics::{Diagnostic, Severity, Subject};
use std::collections::HashMap;

/// A range whose lower limit lies above its upper one.
pub const CROSSING_RANGE: &str = "model/crossing-range";
/// A default value outside its range.
pub const DEFAULT_OUTSIDE_RANGE: &str = "model/default-outside-range";
/// A range in radians that looks like degrees.
pub const LOOKS_LIKE_DEGREES: &str = "model/degrees";
/// An axis whose length is not 1.
pub const AXIS_LENGTH: &str = "model/axis-length";

fn finding(
    severity: Severity,
    code: &'static str,
    subject: Subject,
    message: impl Into<String>,
    help: impl Into<String>,
) -> Diagnostic {
    Diagnostic::new(severity, code, message).about(subject).with_help(help)
}

/// All findings about a model whose parts refer to each other only by position.
pub(super) fn check(model: &Model) -> Vec<Diagnostic> {
    let mut findings = Vec::new();
    check_names(model, &mut findings);
    check_segments(model, &mut findings);
    check_coordinates(model, &mut findings);
    check_components(model, &mut findings);
    if let Err((first, circle)) = dependency_order(model) {
        findings.push(finding(
            Severity::Error,
            "model/cycle",
            first,
            format!("components depend on each other in a circle: {}", circle.join(" -> ")),
            "break the circle by removing one of these links",
        ));
    }
    findings
}

fn duplicates<'a>(names: impl Iterator<Item = &'a str>) -> Vec<&'a str> {
    let mut seen: HashMap<&str, usize> = HashMap::new();
    let mut twice = Vec::new();
    for name in names {
        let count = seen.entry(name).or_default();
        *count += 1;
        if *count == 2 {
            twice.push(name);
        }
    }
    twice
}

fn check_names(model: &Model, findings: &mut Vec<Diagnostic>) {
    let mut report = |what: &str, subject: fn(String) -> Subject, names: Vec<&str>| {
        for name in names {
            findings.push(finding(
                Severity::Error,
                "model/duplicate-name",
                subject(name.to_owned()),
                format!("two {what}s are named `{name}`"),
                format!("give each {what} a name of its own"),
            ));
        }
    };
    report("segment", Subject::Segment, duplicates(model.segments.iter().map(|s| s.name.as_str())));
    report(
        "joint set",
        Subject::JointSet,
        duplicates(model.joint_sets.iter().map(|s| s.name.as_str())),
    );
    report("marker", Subject::Marker, duplicates(model.markers.iter().map(|m| m.name.as_str())));
    report("shape", Subject::Shape, duplicates(model.shapes.iter().map(|s| s.name.as_str())));
    let keys: Vec<String> = model
        .coordinates
        .iter()
        .map(|c| format!("{}/{}", model.joint_sets[c.joint_set.index()].name, c.name))
        .collect();
    report("coordinate", Subject::Coordinate, duplicates(keys.iter().map(String::as_str)));
}

fn check_segments(model: &Model, findings: &mut Vec<Diagnostic>) {
    let n = model.segments.len();
    // A walk of more than n steps towards the root has met a segment twice.
    let mut rooted = vec![false; n];
    for start in 0..n {
        let mut path = Vec::new();
        let mut here = Some(SegmentId(start as u32));
        while let Some(id) = here {
            if rooted[id.index()] {
                break;
            }
            path.push(id);
            if path.len() > n {
                let from = path.iter().position(|p| *p == id).unwrap_or(0);
                let mut names: Vec<&str> =
                    path[from..].iter().map(|p| model.segment(*p).name.as_str()).collect();
                if let Some(again) = names[1..].iter().position(|name| *name == names[0]) {
                    names.truncate(again + 2);
                }
                findings.push(finding(
                    Severity::Error,
                    "model/segment-cycle",
                    Subject::Segment(names[0].to_owned()),
                    format!("segments are their own ancestors: {}", names.join(" -> ")),
                    "give one of them no parent, or close the loop with a constraint",
                ));
                return;
            }
            here = model.segment(id).parent;
        }
        for id in path {
            rooted[id.index()] = true;
        }
    }
    for segment in &model.segments {
        for (frame, name) in
            [(segment.joint_in_parent, "in its parent"), (segment.joint_in_segment, "in itself")]
        {
            if !frame.to_rows().iter().all(|v| v.is_finite()) {
                findings.push(finding(
                    Severity::Error,
                    "model/not-finite",
                    Subject::Segment(segment.name.clone()),
                    format!("the joint frame of segment `{}` {name} is not finite", segment.name),
                    "give numbers that are neither NaN nor infinite",
                ));
            }
        }
        if let Some(motion) = segment.motion
            && source_type(model, motion) != PortType::Transform
        {
            findings.push(finding(
                Severity::Error,
                "model/port-type",
                Subject::Segment(segment.name.clone()),
                format!("segment `{}` is moved by something that is no transform", segment.name),
                "connect the output of a rotate, translate, ball or product component",
            ));
        }
    }
}

fn check_coordinates(model: &Model, findings: &mut Vec<Diagnostic>) {
    for (c, key) in model.coordinates.iter().zip(model.coordinate_keys()) {
        if !c.default.iter().all(|v| v.is_finite()) {
            findings.push(finding(
                Severity::Error,
                "model/not-finite",
                Subject::Coordinate(key.clone()),
                format!("the default of coordinate `{key}` is not finite"),
                "give a number",
            ));
        }
        let (lower, upper) = (c.range.lower, c.range.upper);
        if lower.is_some_and(f64::is_nan) || upper.is_some_and(f64::is_nan) {
            findings.push(finding(
                Severity::Error,
                "model/not-finite",
                Subject::Coordinate(key.clone()),
                format!("a limit of coordinate `{key}` is not a number"),
                "omit a limit that does not exist",
            ));
        } else if let (Some(lower), Some(upper)) = (lower, upper)
            && lower > upper
        {
            findings.push(finding(
                if c.range.enforced { Severity::Error } else { Severity::Warning },
                CROSSING_RANGE,
                Subject::Coordinate(key.clone()),
                format!(
                    "coordinate `{key}` has a lower limit {lower} above its upper limit {upper}"
                ),
                "exchange the two",
            ));
        } else if c.kind != CoordinateKind::Orientation
            && c.follows.is_none()
            && c.range.distance(c.default[0]) < 0.0
        {
            findings.push(finding(
                Severity::Warning,
                DEFAULT_OUTSIDE_RANGE,
                Subject::Coordinate(key.clone()),
                format!(
                    "the default {} of coordinate `{key}` lies outside its range {} to {}",
                    c.default[0],
                    lower.unwrap_or(f64::NEG_INFINITY),
                    upper.unwrap_or(f64::INFINITY)
                ),
                "move the default into the range or widen the range",
            ));
        }
        if let Some(leader) = c.follows
            && source_type(model, leader) != PortType::Scalar
        {
            findings.push(finding(
                Severity::Error,
                "model/port-type",
                Subject::Coordinate(key.clone()),
                format!("coordinate `{key}` follows something that is not a scalar"),
                "let it follow the output of a map or combine component",
            ));
        }
    }
}

fn source_type(model: &Model, source: Signal) -> PortType {
    match source {
        Signal::Coordinate(id) => match model.coordinate(id).kind {
            CoordinateKind::Orientation => PortType::Orientation,
            _ => PortType::Scalar,
        },
        Signal::Output(id, _) => model.components[id.index()].law.outputs().0,
        Signal::Segment(_) => PortType::Segment,
    }
}
