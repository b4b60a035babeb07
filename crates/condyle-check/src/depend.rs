//! Bounds of one angle by another: where they cross, and where they leave the angle nothing.

use super::{Inspected, amount, finding, tolerance};
use condyle_diagnostics::{Diagnostic, Severity};
use condyle_model::CoordinateKind;
use condyle_model::component::{Component, Depend, Law};

/// Samples of the driver.
const STEPS: usize = 200;

pub(super) fn check(subject: &Inspected<'_>, findings: &mut Vec<Diagnostic>) {
    for component in subject.model.components() {
        if let Law::Depend(depend) = &component.law {
            findings.extend(contradiction(subject, component, depend));
        }
    }
}

/// The driver's values: its range, or else the knots of the bounds.
fn driven(subject: &Inspected<'_>, component: &Component, depend: &Depend) -> Option<(f64, f64)> {
    let driver = *component.at("driver").first()?;
    subject.range_of(driver).or_else(|| {
        let domains: Vec<(f64, f64)> = [&depend.lower, &depend.upper]
            .into_iter()
            .flatten()
            .filter_map(|f| f.domain())
            .collect();
        let low = domains.iter().map(|d| d.0).reduce(f64::min)?;
        Some((low, domains.iter().map(|d| d.1).reduce(f64::max)?))
    })
}

/// Where the bounds leave nothing: the lower above the upper, or both outside the passive's own range.
fn contradiction(
    subject: &Inspected<'_>,
    component: &Component,
    depend: &Depend,
) -> Option<Diagnostic> {
    let model = subject.model;
    let passive = *component.at("passive").first()?;
    let driver = *component.at("driver").first()?;
    let (kind, driver_kind) = (subject.kind_of(passive), subject.kind_of(driver));
    let kind = if kind == CoordinateKind::Other { driver_kind } else { kind };
    let (from, to) = driven(subject, component, depend)?;
    let own = subject.range_of(passive);
    // (driver, lower, upper, whether the passive's own range is one of the two)
    let mut worst: Option<(f64, f64, f64, bool)> = None;
    for step in 0..=STEPS {
        let d = from + (to - from) * step as f64 / STEPS as f64;
        let bound = |f: &Option<condyle_math::function::Function>| {
            f.as_ref().map(|f| f.value_and_slope(d).0)
        };
        let (lower, upper) = (bound(&depend.lower), bound(&depend.upper));
        let pairs = [
            (lower, upper, false),
            (lower, own.map(|own| own.1), true),
            (own.map(|own| own.0), upper, true),
        ];
        for (lower, upper, outer) in pairs {
            let (Some(lower), Some(upper)) = (lower, upper) else { continue };
            if lower - upper <= 10.0 * tolerance(kind) {
                continue;
            }
            // Between its two bounds first: a range is the simpler thing to widen.
            if worst.is_none_or(|(_, l, u, known)| (!outer, lower - upper) > (!known, l - u)) {
                worst = Some((d, lower, upper, outer));
            }
        }
    }
    let (d, lower, upper, outer) = worst?;
    let what = match outer {
        true => "its bound and the range of what it bounds exclude each other",
        false => "its bounds cross",
    };
    Some(finding(
        Severity::Warning,
        "lint/bounds-cross",
        [model.component_subject(component)],
        format!(
            "depend `{}`: {what}: where its driver is {}, the lower is {} and the upper {}",
            component.name,
            amount(driver_kind, d),
            amount(kind, lower),
            amount(kind, upper)
        ),
        "bring the bounds apart, or narrow the driver's range; where they cross the upper one holds",
    ))
}
