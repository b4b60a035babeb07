//! Loops that the default pose leaves open.

use super::{Inspected, finding, length};
use condyle_diagnostics::{Diagnostic, Severity, Subject};
use condyle_math::Vec3;
use condyle_model::Model;
use condyle_model::evaluate::ClosureRows;
use condyle_model::model::Condition;

/// A gap greater than this is reported, in metres.
pub(super) const OPEN: f64 = 1e-3;
/// As [`OPEN`], in radians: one degree.
pub(super) const TURNED: f64 = std::f64::consts::PI / 180.0;

/// How far a loop is from closed.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub(super) struct Gap {
    /// Metres between points.
    pub(super) metres: f64,
    /// Radians between frames.
    pub(super) radians: f64,
    /// Difference of a coupling, in the unit of its follower.
    pub(super) coupling: f64,
}

impl Gap {
    /// Whether it is large enough to be reported.
    pub(super) fn is_open(self) -> bool {
        self.metres > OPEN || self.radians > TURNED || self.coupling > OPEN
    }

    /// As part of a sentence.
    pub(super) fn shown(self) -> String {
        let turned = format!("{}°", super::rounded(self.radians.to_degrees(), 2));
        match (self.metres > OPEN, self.radians > TURNED) {
            (true, true) => format!("{} and {turned}", length(self.metres)),
            (false, true) => turned,
            (true, false) => length(self.metres),
            (false, false) if self.coupling > 0.0 => super::rounded(self.coupling, 4),
            (false, false) => length(self.metres),
        }
    }

    /// Its size as a multiple of the thresholds.
    pub(super) fn size(self) -> f64 {
        (self.metres / OPEN).max(self.radians / TURNED).max(self.coupling / OPEN)
    }
}

/// The gap of every loop of a model, from the rows of one pose.
pub(super) fn gaps(model: &Model, rows: &ClosureRows) -> Vec<Gap> {
    let mut at = 0;
    let norm = |rows: &[f64]| Vec3::new(rows[0], rows[1], rows[2]).norm();
    model
        .closures()
        .iter()
        .map(|closure| {
            let own = &rows.residuals[at..at + closure.condition.rows()];
            at += own.len();
            match closure.condition {
                Condition::Points { .. } => Gap { metres: norm(own), ..Gap::default() },
                Condition::Frames { .. } => {
                    Gap { metres: norm(own), radians: norm(&own[3..]), ..Gap::default() }
                }
                Condition::Distance { .. } => Gap { metres: own[0].abs(), ..Gap::default() },
                Condition::Coupling { .. } => Gap { coupling: own[0].abs(), ..Gap::default() },
            }
        })
        .collect()
}

pub(super) fn check(subject: &Inspected<'_>, findings: &mut Vec<Diagnostic>) {
    let model = subject.model;
    let mut rows = ClosureRows::new(model);
    rows.update(model, &subject.program, &subject.rest, None);
    for (closure, gap) in model.closures().iter().zip(gaps(model, &rows)) {
        if gap.is_open() {
            findings.push(finding(
                Severity::Warning,
                "lint/open-loop",
                [Subject::Closure(closure.name.clone())],
                format!("loop `{}` is open by {} in the default pose", closure.name, gap.shown()),
                "choose defaults that close it; tracking closes it, posing does not",
            ));
        }
    }
}
