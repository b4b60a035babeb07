//! Positions of joints and markers.

use super::{Inspected, finding, length};
use condyle_diagnostics::{Diagnostic, Severity, Subject};
use condyle_model::SegmentId;
use std::collections::HashMap;

/// Joints farther than this from their segment's origin, in metres, were probably given in
/// millimetres.
const FARTHEST_JOINT: f64 = 10.0;

/// Markers farther than this from their segment's origin, in metres, are implausible.
const FARTHEST_MARKER: f64 = 1.0;

pub(super) fn check(subject: &Inspected<'_>, findings: &mut Vec<Diagnostic>) {
    joints(subject, findings);
    markers(subject, findings);
    twins(subject, findings);
}

fn joints(subject: &Inspected<'_>, findings: &mut Vec<Diagnostic>) {
    for segment in subject.model.segments() {
        let places =
            [(segment.joint_in_parent, segment.parent.is_some()), (segment.joint_in_segment, true)];
        let far = places.into_iter().filter(|(_, in_body)| *in_body);
        let far = far.map(|(frame, _)| frame.translation.norm()).fold(0.0, f64::max);
        if far <= FARTHEST_JOINT {
            continue;
        }
        findings.push(finding(
            Severity::Warning,
            "lint/millimetres",
            [Subject::Segment(segment.name.clone())],
            format!("the joint of `{}` lies {} from an origin", segment.name, length(far)),
            "lengths of a model are in metres: were these millimetres?",
        ));
    }
}

fn markers(subject: &Inspected<'_>, findings: &mut Vec<Diagnostic>) {
    for marker in subject.model.markers() {
        let Some(segment) = marker.segment else { continue };
        let far = marker.point.norm();
        if far <= FARTHEST_MARKER {
            continue;
        }
        let segment = &subject.model.segment(segment).name;
        findings.push(finding(
            Severity::Warning,
            "lint/far-marker",
            [Subject::Marker(marker.name.clone()), Subject::Segment(segment.clone())],
            format!("marker `{}` lies {} from the origin of `{segment}`", marker.name, length(far)),
            "is it on another segment, or in millimetres?",
        ));
    }
}

/// Markers of one segment at the same point.
fn twins(subject: &Inspected<'_>, findings: &mut Vec<Diagnostic>) {
    type Spot = (Option<SegmentId>, [i64; 3]);
    let mut at: HashMap<Spot, Vec<&str>> = HashMap::new();
    let mut order = vec![];
    // Another name for a marker is meant.
    for marker in subject.model.markers().iter().filter(|marker| marker.like.is_none()) {
        // Ten micrometres: equal in the digits of a file.
        let spot = (marker.segment, marker.point.to_array().map(|v| (v * 1e5).round() as i64));
        let here = at.entry(spot).or_default();
        if here.is_empty() {
            order.push(spot);
        }
        here.push(&marker.name);
    }
    for spot in order {
        let names: Vec<String> = at[&spot].iter().map(|&name| name.to_owned()).collect();
        if names.len() < 2 {
            continue;
        }
        let segment = spot.0.map_or("the world", |id| &subject.model.segment(id).name);
        findings.push(finding(
            Severity::Note,
            "lint/marker-twins",
            names.iter().cloned().map(Subject::Marker),
            format!("markers {} of `{segment}` are at the same point", super::listed(&names)),
            "give each its own place, or keep one",
        ));
    }
}
