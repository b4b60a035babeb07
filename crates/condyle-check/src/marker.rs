//! Markers on a segment where they most likely do not belong.

use super::{Inspected, finding};
use condyle_diagnostics::{Diagnostic, Severity, Subject, listed};
use condyle_model::{Model, SegmentId};
use std::collections::BTreeMap;

/// Joints between two segments of one body part: a cluster may bridge one of them.
const NEIGHBOURS: usize = 1;

pub(super) fn check(subject: &Inspected<'_>, findings: &mut Vec<Diagnostic>) {
    fixed(subject.model, findings);
    strays(subject.model, findings);
    sides(subject.model, findings);
}

/// Markers on ground between markers on segments.
fn fixed(model: &Model, findings: &mut Vec<Diagnostic>) {
    let (moving, still): (Vec<_>, Vec<_>) =
        model.markers().iter().partition(|marker| marker.segment.is_some());
    // A name that says so is meant; markers of a laboratory may be many.
    let slips = still.iter().map(|marker| marker.name.as_str());
    let names: Vec<&str> = slips.filter(|name| !name.to_lowercase().contains("ground")).collect();
    if names.is_empty() || moving.len() < 2 * names.len() {
        return;
    }
    let (s, is) = if names.len() == 1 { ("", "is") } else { ("s", "are") };
    findings.push(finding(
        Severity::Warning,
        "lint/ground-marker",
        names.iter().map(|&name| Subject::Marker(name.to_owned())),
        format!(
            "marker{s} {} {is} on the ground, unlike {} others: no posture moves it",
            listed(&names),
            moving.len()
        ),
        "name the segment on which it is",
    ));
}

/// The name of a cluster: that of its markers without their numbers at the end.
fn cluster(name: &str) -> Option<&str> {
    let stem = name.trim_end_matches(|c: char| c.is_ascii_digit());
    let stem = stem.trim_end_matches(['_', '.', '-', ' ']);
    (stem.len() < name.len() && stem.len() > 1).then_some(stem)
}

/// A marker of a numbered cluster on a segment far from that of the others.
fn strays(model: &Model, findings: &mut Vec<Diagnostic>) {
    let mut clusters: BTreeMap<&str, Vec<(&str, SegmentId)>> = BTreeMap::new();
    for marker in model.markers() {
        if let (Some(stem), Some(segment)) = (cluster(&marker.name), marker.segment) {
            clusters.entry(stem).or_default().push((&marker.name, segment));
        }
    }
    for (stem, members) in clusters {
        let count = |of: SegmentId| members.iter().filter(|(_, segment)| *segment == of).count();
        let Some(most) = members.iter().map(|(_, segment)| *segment).max_by_key(|&s| count(s))
        else {
            continue;
        };
        // Two against one at least, else nothing says which of them is right.
        for &(name, segment) in members.iter().filter(|(_, segment)| *segment != most) {
            if count(most) < 2
                || 2 * count(most) < members.len()
                || joints(model, segment, most) <= NEIGHBOURS
            {
                continue;
            }
            let [here, there] = [segment, most].map(|id| model.segment(id).name.clone());
            findings.push(finding(
                Severity::Warning,
                "lint/stray-marker",
                [Subject::Marker(name.to_owned()), Subject::Segment(here.clone())],
                format!(
                    "marker `{name}` is on `{here}`, the other markers `{stem}...` are on `{there}`, {} joints \
                     away",
                    joints(model, segment, most)
                ),
                format!("is it on `{there}`?"),
            ));
        }
    }
}

/// How many joints are between two segments.
fn joints(model: &Model, one: SegmentId, other: SegmentId) -> usize {
    let (a, b): (Vec<_>, Vec<_>) =
        (model.path_to_root(one).collect(), model.path_to_root(other).collect());
    let shared = a.iter().rev().zip(b.iter().rev()).take_while(|(x, y)| x == y).count();
    a.len() + b.len() - 2 * shared
}

/// A marker named for one side on a segment of the other.
fn sides(model: &Model, findings: &mut Vec<Diagnostic>) {
    for marker in model.markers() {
        let Some(segment) = marker.segment else { continue };
        let segment = &model.segment(segment).name;
        let (Some((own, _)), Some((on, _))) =
            (super::symmetry::mirrored(&marker.name), super::symmetry::mirrored(segment))
        else {
            continue;
        };
        if own == on {
            continue;
        }
        let side = |right: bool| if right { "right" } else { "left" };
        findings.push(finding(
            Severity::Warning,
            "lint/marker-side",
            [Subject::Marker(marker.name.clone()), Subject::Segment(segment.clone())],
            format!(
                "marker `{}` is named for the {} side, but is on `{segment}`, of the {}",
                marker.name,
                side(own),
                side(on)
            ),
            "is its segment that of the other side?",
        ));
    }
}

#[cfg(test)]
mod tests {
    use super::cluster;

    #[test]
    fn a_cluster_is_a_name_without_its_number() {
        assert_eq!(cluster("RTHI2"), Some("RTHI"));
        assert_eq!(cluster("thigh_r_3"), Some("thigh_r"));
        assert_eq!((cluster("C7"), cluster("RKNE")), (None, None));
    }
}
