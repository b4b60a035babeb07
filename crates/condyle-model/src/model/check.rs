//! What makes a model whole: names, types, places and circles, checked once when it is built.

use super::{ComponentId, CoordinateId, CoordinateKind, Model, SegmentId};
use crate::component::{Compensate, Component, MOST_COMBINED, PortType, Source};
use std::collections::HashMap;
use std::fmt;

/// How bad a finding is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Severity {
    /// Allowed, but unlikely to be meant.
    Warning,
    /// The model cannot be built.
    Error,
}

/// Something that is wrong, or odd, in a model.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Finding {
    /// How bad it is.
    pub severity: Severity,
    /// A short stable name of the rule.
    pub code: &'static str,
    /// What is wrong, with the names of what is concerned.
    pub message: String,
    /// What would be right.
    pub help: String,
}

impl fmt::Display for Finding {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let severity = if self.severity == Severity::Error { "error" } else { "warning" };
        write!(f, "{severity} [{}]: {}; {}", self.code, self.message, self.help)
    }
}

fn finding(
    severity: Severity,
    code: &'static str,
    message: impl Into<String>,
    help: impl Into<String>,
) -> Finding {
    Finding { severity, code, message: message.into(), help: help.into() }
}

/// All findings about a model whose parts refer to each other only by position.
pub(super) fn check(model: &Model) -> Vec<Finding> {
    let mut findings = Vec::new();
    check_names(model, &mut findings);
    check_segments(model, &mut findings);
    check_coordinates(model, &mut findings);
    check_components(model, &mut findings);
    if let Err(circle) = dependency_order(model) {
        findings.push(finding(
            Severity::Error,
            "model/cycle",
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

fn check_names(model: &Model, findings: &mut Vec<Finding>) {
    let mut report = |what: &str, names: Vec<&str>| {
        for name in names {
            findings.push(finding(
                Severity::Error,
                "model/duplicate-name",
                format!("two {what}s are named `{name}`"),
                format!("give each {what} a name of its own"),
            ));
        }
    };
    report("segment", duplicates(model.segments.iter().map(|s| s.name.as_str())));
    report("joint set", duplicates(model.joint_sets.iter().map(|s| s.name.as_str())));
    report("marker", duplicates(model.markers.iter().map(|m| m.name.as_str())));
    let keys: Vec<String> = model
        .coordinates
        .iter()
        .map(|c| format!("{}/{}", model.joint_sets[c.joint_set.index()].name, c.name))
        .collect();
    report("coordinate", duplicates(keys.iter().map(String::as_str)));
}

fn check_segments(model: &Model, findings: &mut Vec<Finding>) {
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
                    format!("segments are their own ancestors: {}", names.join(" -> ")),
                    "let one of them hang on the world, or close the loop with a constraint",
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
                format!("segment `{}` is moved by a scalar, not by a transform", segment.name),
                "connect the output of a rotate, translate, ball or product component",
            ));
        }
    }
}

fn check_coordinates(model: &Model, findings: &mut Vec<Finding>) {
    for (index, c) in model.coordinates.iter().enumerate() {
        let key = model.coordinate_key(CoordinateId(index as u32));
        if !c.default.iter().all(|v| v.is_finite()) {
            findings.push(finding(
                Severity::Error,
                "model/not-finite",
                format!("the default of coordinate `{key}` is not finite"),
                "give a number",
            ));
        }
        let (lower, upper) = (c.range.lower, c.range.upper);
        if lower.is_some_and(f64::is_nan) || upper.is_some_and(f64::is_nan) {
            findings.push(finding(
                Severity::Error,
                "model/not-finite",
                format!("a limit of coordinate `{key}` is not a number"),
                "leave a limit away where there is none",
            ));
        } else if let (Some(lower), Some(upper)) = (lower, upper)
            && lower > upper
        {
            findings.push(finding(
                if c.range.enforced { Severity::Error } else { Severity::Warning },
                "model/crossing-range",
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
                "model/default-outside-range",
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
                format!("coordinate `{key}` follows something that is not a scalar"),
                "let it follow the output of a map or combine component",
            ));
        }
    }
}

fn check_components(model: &Model, findings: &mut Vec<Finding>) {
    for named in &model.components {
        let place = format!(
            "component `{}` ({}) of joint set `{}`",
            named.name,
            named.component.kind(),
            model.joint_sets[named.joint_set.index()].name
        );
        for (port, expected, source) in named.component.inputs() {
            let found = source_type(model, source);
            if found != expected {
                findings.push(finding(
                    Severity::Error,
                    "model/port-type",
                    format!("port `{port}` of {place} gets a {found:?}").to_lowercase(),
                    format!("connect a {expected:?}").to_lowercase(),
                ));
            }
        }
        let axis = match &named.component {
            Component::Rotate(c) => Some(c.axis),
            Component::Translate(c) => Some(c.axis),
            _ => None,
        };
        if let Some(axis) = axis {
            let length = axis.norm();
            if !(length.is_finite() && length > 1e-9) {
                findings.push(finding(
                    Severity::Error,
                    "model/axis",
                    format!("the axis of {place} has length {length}"),
                    "give a direction, such as [0, 0, 1]",
                ));
            } else if (length - 1.0).abs() > 1e-6 {
                findings.push(finding(
                    Severity::Warning,
                    "model/axis-length",
                    format!("the axis of {place} has length {length}"),
                    "it is normalised; write it with length 1 to silence this",
                ));
            }
        }
        if let Component::Compensate(c) = &named.component {
            check_compensate(model, &place, c, findings);
        }
        if let Component::Combine(c) = &named.component
            && c.inputs.len() != c.function.arity()
        {
            findings.push(finding(
                Severity::Error,
                "model/arity",
                format!(
                    "{place} has {} inputs but its function takes {}",
                    c.inputs.len(),
                    c.function.arity()
                ),
                "connect as many inputs as the function has arguments",
            ));
        }
        if let Component::Combine(c) = &named.component
            && c.inputs.len() > MOST_COMBINED
        {
            findings.push(finding(
                Severity::Error,
                "model/arity",
                format!("{place} has {} inputs", c.inputs.len()),
                format!("combine at most {MOST_COMBINED} scalars at a time"),
            ));
        }
    }
}

fn check_compensate(model: &Model, place: &str, c: &Compensate, findings: &mut Vec<Finding>) {
    if !(0.0..=1.0).contains(&c.weight) {
        findings.push(finding(
            Severity::Error,
            "model/weight",
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
            format!(
                "{place} compensates `{}`, which is no ancestor of `{}`",
                model.segment(*id).name,
                model.segment(c.segment).name
            ),
            "name segments on the way from this one to the root",
        ));
    }
}

fn source_type(model: &Model, source: Source) -> PortType {
    match source {
        Source::Coordinate(id) => match model.coordinate(id).kind {
            CoordinateKind::Orientation => PortType::Orientation,
            _ => PortType::Scalar,
        },
        Source::Output(id, _) => model.components[id.index()].component.outputs().0,
    }
}

/// One thing that is computed: a coordinate's effective value, or a component.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Node {
    Coordinate(CoordinateId),
    Component(ComponentId),
}

/// Coordinates and components in an order in which each comes after what it reads.
///
/// Order and circles are settled over the whole model, per component and never per bone.
///
/// # Errors
/// The names along a circle, the first one repeated at the end.
pub(crate) fn dependency_order(model: &Model) -> Result<Vec<Node>, Vec<String>> {
    let coordinates = model.coordinates.len();
    let number = |source: Source| match source {
        Source::Coordinate(id) => id.index(),
        Source::Output(id, _) => coordinates + id.index(),
    };
    let reads = |node: usize| -> Vec<usize> {
        if node < coordinates {
            model.coordinates[node].follows.into_iter().map(number).collect()
        } else {
            let id = ComponentId((node - coordinates) as u32);
            model.reads(id).into_iter().map(number).collect()
        }
    };
    let name = |node: usize| {
        if node < coordinates {
            model.coordinate_key(CoordinateId(node as u32))
        } else {
            let named = &model.components[node - coordinates];
            format!("{}.{}", model.joint_sets[named.joint_set.index()].name, named.name)
        }
    };
    #[derive(Clone, Copy, PartialEq)]
    enum Mark {
        New,
        Open,
        Done,
    }
    let total = coordinates + model.components.len();
    let mut marks = vec![Mark::New; total];
    let mut order = Vec::with_capacity(total);
    // Depth first with an explicit stack: a node, what it reads, and how much of that is done.
    let mut stack: Vec<(usize, Vec<usize>, usize)> = Vec::new();
    for root in 0..total {
        if marks[root] != Mark::New {
            continue;
        }
        marks[root] = Mark::Open;
        stack.push((root, reads(root), 0));
        while let Some((node, inputs, done)) = stack.last_mut() {
            let Some(&next) = inputs.get(*done) else {
                marks[*node] = Mark::Done;
                order.push(if *node < coordinates {
                    Node::Coordinate(CoordinateId(*node as u32))
                } else {
                    Node::Component(ComponentId((*node - coordinates) as u32))
                });
                stack.pop();
                continue;
            };
            *done += 1;
            match marks[next] {
                Mark::Done => {}
                Mark::New => {
                    marks[next] = Mark::Open;
                    stack.push((next, reads(next), 0));
                }
                Mark::Open => {
                    let from = stack.iter().position(|(n, ..)| *n == next).unwrap_or(0);
                    let mut names: Vec<String> =
                        stack[from..].iter().map(|(n, ..)| name(*n)).collect();
                    names.reverse();
                    names.insert(0, name(next));
                    return Err(names);
                }
            }
        }
    }
    Ok(order)
}
