//! Limits and defaults of single coordinates.

use super::{Inspected, NO_LIMIT, finding, tolerance};
use condyle_diagnostics::{Diagnostic, Severity, Subject};
use condyle_model::{CoordinateId, CoordinateKind};
use std::f64::consts::PI;

/// Limits that cross, limits without effect, limits in degrees, defaults outside their range.
pub(super) fn check(subject: &Inspected<'_>, findings: &mut Vec<Diagnostic>) {
    for id in subject.model.coordinate_ids() {
        if subject.kind(id) == CoordinateKind::Orientation {
            continue;
        }
        let range = subject.model.coordinate(id).range;
        if let (Some(lower), Some(upper)) = (range.lower, range.upper)
            && lower > upper
        {
            findings.push(crossing(subject, id, lower, upper));
            continue;
        }
        findings.extend(typical(subject, id));
        let odd = size(subject, id);
        let dummy = odd.is_some();
        findings.extend(odd);
        if !dummy && !subject.circles.contains(&id) {
            findings.extend(default(subject, id));
        }
    }
}

fn crossing(subject: &Inspected<'_>, id: CoordinateId, lower: f64, upper: f64) -> Diagnostic {
    let (key, lower, upper) = (subject.key(id), subject.shown(id, lower), subject.shown(id, upper));
    finding(
        Severity::Error,
        "lint/crossing-range",
        [Subject::Coordinate(key.clone())],
        format!("`{key}` has its lower limit {lower} above its upper limit {upper}"),
        "exchange the two",
    )
}

/// What people reach on average is within what a body can do.
fn typical(subject: &Inspected<'_>, id: CoordinateId) -> Option<Diagnostic> {
    let coordinate = subject.model.coordinate(id);
    let [low, high] = coordinate.typical?;
    let range = coordinate.range;
    let allowed = tolerance(coordinate.kind);
    let beyond = range.lower.is_some_and(|lower| low < lower - allowed)
        || range.upper.is_some_and(|upper| high > upper + allowed);
    let key = subject.key(id);
    beyond.then(|| {
        finding(
            Severity::Warning,
            "lint/typical-beyond-range",
            [Subject::Coordinate(key.clone())],
            format!(
                "people reach {} to {} in `{key}`, which its range does not allow",
                subject.shown(id, low),
                subject.shown(id, high)
            ),
            "widen `range`: it says what a body can do, `typical` what people reach on average",
        )
    })
}

/// Whether limits look like degrees: too large for a joint, whole numbers, and at most 360.
fn degrees(limits: &[f64]) -> bool {
    let most = limits.iter().fold(0.0f64, |most, l| most.max(l.abs()));
    let whole = |l: &f64| (l - l.round()).abs() < 1e-9;
    most > 2.0 * PI * 1.001 && most <= 360.0 && limits.iter().all(whole)
}

fn size(subject: &Inspected<'_>, id: CoordinateId) -> Option<Diagnostic> {
    let coordinate = subject.model.coordinate(id);
    let limits: Vec<f64> =
        [coordinate.range.lower, coordinate.range.upper].into_iter().flatten().collect();
    let key = subject.key(id);
    let rotation = coordinate.kind == CoordinateKind::Rotation;
    let text = match limits[..] {
        [lower, upper] => format!("{lower} to {upper}"),
        [one] => one.to_string(),
        _ => return None,
    };
    if rotation && degrees(&limits) {
        return Some(finding(
            Severity::Warning,
            "lint/degrees",
            [Subject::Coordinate(key.clone())],
            format!("the range of `{key}`, {text} radians, looks like degrees"),
            "angles are in radians: write `angles = \"deg\"` at the top of a text, or divide by 57.29578",
        ));
    }
    let far = limits.iter().any(|l| l.is_finite() && l.abs() > NO_LIMIT);
    let wide = rotation && limits.len() == 2 && limits[1] - limits[0] > 4.0 * PI * 1.001;
    if !far && !wide {
        return None;
    }
    let unit = match coordinate.kind {
        CoordinateKind::Rotation => " radians",
        CoordinateKind::Translation => " metres",
        _ => "",
    };
    let follows = coordinate.follows.is_some();
    let harmless = follows || !coordinate.range.enforced;
    Some(finding(
        if harmless { Severity::Note } else { Severity::Warning },
        "lint/dummy-range",
        [Subject::Coordinate(key.clone())],
        format!("the range of `{key}`, {text}{unit}, limits nothing"),
        match (follows, harmless) {
            (true, _) => "a coordinate that follows needs no range; omit it",
            (false, true) => "it is not clamped, so the range has no effect; omit it",
            (false, false) => {
                "it is clamped, but the range does not limit it: give a real range, or do not clamp it"
            }
        },
    ))
}

/// A default outside its own range, of a coordinate that follows no other.
fn default(subject: &Inspected<'_>, id: CoordinateId) -> Option<Diagnostic> {
    let coordinate = subject.model.coordinate(id);
    let value = coordinate.default[0];
    let range = coordinate.range;
    let (lower, upper) =
        (range.lower.unwrap_or(f64::NEG_INFINITY), range.upper.unwrap_or(f64::INFINITY));
    let nearest = value.max(lower).min(upper);
    let by = (value - nearest).abs();
    if coordinate.follows.is_some() || by <= tolerance(coordinate.kind) {
        return None;
    }
    let key = subject.key(id);
    let side = if value < lower { "below" } else { "above" };
    Some(finding(
        if range.enforced { Severity::Warning } else { Severity::Note },
        "lint/default-outside-range",
        [Subject::Coordinate(key.clone())],
        format!(
            "the default of `{key}`, {}, lies {} {side} its {}range, which ends at {}",
            subject.shown(id, value),
            subject.shown(id, by),
            if range.enforced { "clamped " } else { "" },
            subject.shown(id, nearest)
        ),
        "move the default into the range, or widen the range",
    ))
}
