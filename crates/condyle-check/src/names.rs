//! Names that people, and programs that ignore case, may confuse.

use super::{Inspected, finding};
use condyle_diagnostics::{Diagnostic, Severity, Subject};
use std::collections::BTreeMap;

pub(super) fn check(subject: &Inspected<'_>, findings: &mut Vec<Diagnostic>) {
    let model = subject.model;
    let set = |index: usize| &model.joint_sets()[index].name;
    type Family<'n> = (&'n str, fn(String) -> Subject, Vec<String>);
    let families: [Family<'_>; 4] = [
        ("segments", Subject::Segment, model.segments().iter().map(|s| s.name.clone()).collect()),
        (
            "joint sets",
            Subject::JointSet,
            model.joint_sets().iter().map(|s| s.name.clone()).collect(),
        ),
        (
            "coordinates",
            Subject::Coordinate,
            model
                .coordinates()
                .iter()
                .map(|c| format!("{}/{}", set(c.joint_set.index()), c.name))
                .collect(),
        ),
        ("markers", Subject::Marker, model.markers().iter().map(|m| m.name.clone()).collect()),
    ];
    for (what, of, names) in families {
        let mut alike: BTreeMap<String, Vec<String>> = BTreeMap::new();
        for name in names {
            let plain: String = name.chars().filter(|c| !c.is_whitespace()).collect();
            alike.entry(plain.to_lowercase()).or_default().push(name);
        }
        let one_place = |names: &[String]| {
            let places = model.markers().iter().filter(|m| names.contains(&m.name));
            let mut places = places.map(|m| (m.segment, m.point));
            places.next().is_some_and(|first| places.all(|place| place == first))
        };
        for names in alike.into_values().filter(|names| names.len() > 1) {
            // Confusing two names of the same point does no harm.
            if what == "markers" && one_place(&names) {
                continue;
            }
            findings.push(finding(
                Severity::Warning,
                "lint/alike-names",
                names.iter().cloned().map(of),
                format!("the {what} {} differ by case or spaces only", super::listed(&names)),
                "give them different names: labels are matched ignoring case",
            ));
        }
    }
}
