//! What people do where nothing else tells: sums of coordinates with a value at rest and a stiffness.

use super::{CoordinateId, CoordinateKind, Model};
use condyle_diagnostics::{Diagnostic, Subject};

/// A coordinate, or a sum of several, that is held near a value where nothing else determines it.
///
/// A solver adds `stiffness (Σ factor q - rest)²` to what it minimises. It does not limit the
/// coordinates and changes no pose: evaluation does not use it. A sum of several is a rhythm, such as
/// the part of a turn of the trunk that the lumbar spine takes, or the tilt of the head in the world.
#[derive(Clone, Debug, PartialEq)]
pub struct PostureTerm {
    /// Its name, unique in the model.
    pub name: String,
    /// The coordinates, each of one number, with their factors.
    pub sum: Vec<(CoordinateId, f64)>,
    /// The value of the sum at rest, in radians (or metres).
    pub rest: f64,
    /// The stiffness, m² per rad² (or per m²): with 1e-5 a radian weighs as much as 3.2 mm RMS of all
    /// markers.
    pub stiffness: f64,
    /// Where its numbers come from.
    pub source: Option<String>,
}

/// Errors of the posture terms of a model.
pub(super) fn check_postures(model: &Model) -> Vec<Diagnostic> {
    let mut findings = vec![];
    let keys = model.coordinate_keys();
    for (index, term) in model.postures.iter().enumerate() {
        let name = &term.name;
        let mut error = |message: String, help: &str| {
            let error = Diagnostic::error("model/posture", message).with_help(help);
            findings.push(error.about(Subject::Posture(name.clone())));
        };
        if model.postures[..index].iter().any(|other| other.name == *name) {
            error(format!("two postures are named `{name}`"), "give each a name of its own");
        }
        if !(term.stiffness > 0.0 && term.stiffness.is_finite()) {
            let message = format!("the stiffness of posture `{name}` is {}", term.stiffness);
            error(message, "give a positive number in m² per rad² (or per m²), such as 1e-5");
        }
        if !term.rest.is_finite() {
            let message = format!("the rest value of posture `{name}` is {}", term.rest);
            error(message, "give a number");
        }
        if term.sum.is_empty() {
            error(format!("posture `{name}` names no coordinate"), "name one or more");
        }
        for (position, &(id, factor)) in term.sum.iter().enumerate() {
            let (Some(coordinate), Some(key)) =
                (model.coordinates.get(id.index()), keys.get(id.index()))
            else {
                let message = format!("posture `{name}` has a coordinate of another model");
                error(message, "use the coordinates that this builder made");
                continue;
            };
            if coordinate.kind == CoordinateKind::Orientation {
                let message = format!("`{key}` in posture `{name}` is an orientation");
                error(message, "name coordinates of one number");
            }
            if !factor.is_finite() || factor == 0.0 {
                let message = format!("the factor of `{key}` in posture `{name}` is {factor}");
                error(message, "give a finite number that is not 0, or leave the coordinate out");
            }
            if term.sum[..position].iter().any(|&(other, _)| other == id) {
                let message = format!("`{key}` is twice in posture `{name}`");
                error(message, "name it once, with the sum of the factors");
            }
        }
    }
    findings
}

impl Model {
    /// Coordinates, and sums of several, with a value at rest and a stiffness.
    pub fn postures(&self) -> &[PostureTerm] {
        &self.postures
    }
}
