//! Limits of ball joints, and bones that should touch.

use super::{Inspected, amount, finding, length, real_range};
use condyle_diagnostics::{Diagnostic, Severity, Subject};
use condyle_math::Vec3;
use condyle_model::CoordinateKind;
use condyle_model::component::{Component, Law, Signal};
use condyle_model::limit::{Cone, Limit};
use condyle_model::model::ComponentId;

/// A posture within this distance, in radians, of a discontinuity of the projection is reported:
/// half a degree.
const NEAR: f64 = 0.0087;

/// Samples of each angle's range.
const STEPS: usize = 13;

/// A gap below this is rounding in a file: 0.01 mm.
const TOUCHING: f64 = 1e-5;

/// Limits whose projection jumps inside the declared ranges, contacts that do not touch by default, and
/// components that nothing uses, limits first of all.
pub(super) fn check(subject: &Inspected<'_>, findings: &mut Vec<Diagnostic>) {
    for component in subject.model.components() {
        if let Some(limit) = component.law.limit() {
            findings.extend(jump(subject, component, limit));
        }
        if let Law::Cone(cone) = &component.law {
            findings.extend(complement(subject, component, &cone.cone));
        }
    }
    for bound in subject.program.bounds() {
        let component = &subject.model.components()[bound.component.index()];
        findings.extend(outside_at_rest(subject, component, subject.rest.bounded(bound).collect()));
    }
    for id in subject.model.unused_components() {
        findings.push(unused(subject, id));
    }
    for (number, id) in subject.program.contacts().enumerate() {
        let Some(report) = subject.rest.contact(number) else { continue };
        let gap =
            report.gaps.into_iter().fold(0.0f64, |a, b| if b.abs() > a.abs() { b } else { a });
        if gap.abs() > TOUCHING {
            let model = subject.model;
            let named = &model.components()[id.index()];
            let name = &named.name;
            let side = if gap > 0.0 { "outside" } else { "inside" };
            findings.push(finding(
                Severity::Warning,
                "lint/no-contact",
                [model.component_subject(named)],
                format!("contact `{name}` is {} {side} its ellipsoid at rest", length(gap.abs())),
                "move its points or its ellipsoid until they meet, or accept the gap",
            ));
        }
    }
}

/// A learned limit that the default posture breaks: mostly the axes of its frames are others than those of
/// the segments.
fn outside_at_rest(
    subject: &Inspected<'_>,
    component: &Component,
    numbers: Vec<f64>,
) -> Option<Diagnostic> {
    let Law::Field(law) = &component.law else { return None };
    let by = law.beyond(&numbers);
    if by <= NEAR {
        return None;
    }
    let about = law.limit.about();
    Some(finding(
        Severity::Warning,
        "lint/outside-at-rest",
        [subject.model.component_subject(component)],
        format!(
            "field `{}` does not allow the default posture, by {}",
            component.name,
            amount(CoordinateKind::Rotation, by)
        ),
        format!(
            "its samples are rotations of `{}` in `{}`: give the axes of these in the model's segments as \
             `in_segment` and `in_reference`",
            about.child,
            about.reference.as_deref().unwrap_or("the laboratory")
        ),
    ))
}

/// Directions at which a cone is sampled.
const DIRECTIONS: usize = 2000;

/// A cone that allows more than this part of all directions, and turned round would allow less, was
/// likely given a direction at rest on the wrong side of its points.
const NEARLY_ALL: f64 = 2.0 / 3.0;

/// A cone that allows what lies outside its points.
fn complement(subject: &Inspected<'_>, component: &Component, cone: &Cone) -> Option<Diagnostic> {
    // Directions spread evenly over the sphere (Fibonacci's spiral).
    let golden = std::f64::consts::PI * (3.0 - 5f64.sqrt());
    let inside = (0..DIRECTIONS).filter(|&i| {
        let y = 1.0 - (2 * i + 1) as f64 / DIRECTIONS as f64;
        let (s, c) = (golden * i as f64).sin_cos();
        let across = (1.0 - y * y).sqrt();
        cone.contains(Vec3::new(c * across, y, s * across))
    });
    let part = inside.count() as f64 / DIRECTIONS as f64;
    let middle =
        cone.points().iter().fold(Vec3::ZERO, |sum, point| sum + point.direction.normalized());
    if part <= NEARLY_ALL || middle.dot(cone.rest()) >= 0.0 {
        return None;
    }
    Some(finding(
        Severity::Warning,
        "lint/cone-outside",
        [subject.model.component_subject(component)],
        format!(
            "cone `{}` allows {} % of all directions: `rest` is on the far side of its points, so that \
             what lies outside them is allowed",
            component.name,
            (100.0 * part).round()
        ),
        "give as `rest` the direction of the bone in the middle of the points",
    ))
}

/// A component on which no segment, coordinate or limit depends.
fn unused(subject: &Inspected<'_>, id: ComponentId) -> Diagnostic {
    let component = &subject.model.components()[id.index()];
    let (name, kind) = (&component.name, component.law.kind().name);
    let (message, help) = match component.law.bounds() {
        true => (
            format!("{kind} `{name}` limits nothing: no component reads what it lets through"),
            format!("let the components after it read `{name}` instead of what it limits"),
        ),
        false => (
            format!("{kind} `{name}` is not used: no segment, coordinate or limit depends on it"),
            "connect it, or leave it out".to_owned(),
        ),
    };
    let about = [subject.model.component_subject(component)];
    finding(Severity::Warning, "lint/unused-component", about, message, help)
}

/// The posture inside the declared ranges that is nearest to a discontinuity of the projection.
fn jump(subject: &Inspected<'_>, component: &Component, limit: &dyn Limit) -> Option<Diagnostic> {
    let name = &component.name;
    let mut ranges = vec![];
    for source in &component.inputs {
        let Signal::Coordinate(id) = *source else { return None };
        ranges.push((id, real_range(subject.model, id)?));
    }
    let mut worst = (f64::INFINITY, vec![]);
    for sample in 0..STEPS.pow(ranges.len() as u32) {
        let mut rest = sample;
        let numbers = ranges.iter().map(|(_, (lower, upper))| {
            let step = (rest % STEPS) as f64 / (STEPS - 1) as f64;
            rest /= STEPS;
            lower + (upper - lower) * step
        });
        let numbers: Vec<f64> = numbers.collect();
        let margin = limit.margin(&numbers);
        if margin < worst.0 {
            worst = (margin, numbers);
        }
    }
    if worst.0 > NEAR {
        return None;
    }
    let at = ranges.iter().zip(&worst.1).map(|((id, _), value)| {
        format!("`{}` {}", subject.key(*id), amount(CoordinateKind::Rotation, *value))
    });
    Some(finding(
        Severity::Warning,
        "lint/cone-jump",
        ranges.iter().map(|(id, _)| Subject::Coordinate(subject.key(*id))),
        format!(
            "the projection of cone `{name}` is discontinuous inside the declared ranges, near {}",
            at.collect::<Vec<_>>().join(", ")
        ),
        "narrow the ranges so that they end nearer to the cone, or use projection = \"toward_rest\"",
    ))
}
