//! Models as trees of plain joints, for programs that know no joint sets.
//!
//! A [`Tree`] says a model by links, one for each segment: a chain of fixed frames, turns about axes, slides
//! along axes and balls from the parent to the segment. The value of every turn and slide is a rule
//! ([`Rule`]): a variable that a user sets, a constant, a function of one value or of several.
//!
//! ```text
//! segment_in_parent = S₁·S₂·…·Sₙ      S fixed | R(a, v) | T(a·v) | R(q),   v = rule(variables)
//! ```
//!
//! | component | here |
//! | --- | --- |
//! | rotate, translate, place, product, ball | the same |
//! | map, combine, coordinates that follow | rules |
//! | depend, cone, ellipse, half space | pass what they read: limits other than ranges are dropped, and told |
//! | pivot, curve without heading | slides by splines of the parameter, and a turn |
//! | ellipsoid | three turns, and slides by products of splines |
//! | compensate of weight 1 | the turns of the ancestors, backwards |
//! | contact, others | six values that are measured at a pose, then fitted by polynomials ([`fit()`]); those of a contact by where the segment is and how much each pair of points counts |
//! | scale, shear | nothing: told with the error that it makes |
//!
//! [`measure()`] compares a tree with its model over legal poses.

mod blend;
mod build;
mod chain;
mod fit;
mod legal;
mod measure;
mod piece;
pub mod pieces_of_one;
mod rule;
mod written;

pub use build::{Choice, build};
pub use chain::{Link, Measured, Step, simplified};
pub use fit::{ANGLE_TOLERANCE, Fit, LENGTH_TOLERANCE, fit, polynomial_of_one};
pub use legal::Legal;
pub use measure::{LinkError, measure};
pub use piece::{Piece, completed, is_still, pieces, upright};
pub use pieces_of_one::Joints;
pub use rule::{Form, Rule, Rules, Value};
pub use written::{Names, Written, escaped};

use condyle_diagnostics::Diagnostic;
use condyle_math::{Affine, EulerOrder, Quat};
use condyle_model::{CoordinateId, CoordinateKind, Model, Pose, Range, UpAxis};

/// Where the number of a variable comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Source {
    /// A coordinate of one number.
    Coordinate(CoordinateId),
    /// One of the three angles, body-fixed x, y, z, of an orientation.
    Angle(CoordinateId, usize),
}

/// A number that a user of the written model sets.
#[derive(Clone, Debug, PartialEq)]
pub struct Variable {
    /// Its name, unique in the tree.
    pub name: String,
    /// What it is of the model.
    pub source: Source,
    /// What it measures.
    pub kind: CoordinateKind,
    /// Its value unless another is given.
    pub default: f64,
    /// Its range.
    pub range: Range,
    /// Whether it is held at its default.
    pub locked: bool,
    /// What determines it, if it is coupled.
    pub follows: Option<Value>,
}

/// A model as chains of plain joints.
#[derive(Clone, Debug)]
pub struct Tree {
    /// The model's name.
    pub name: String,
    /// The axis of the world that points up.
    pub up: UpAxis,
    /// What a user sets.
    pub variables: Vec<Variable>,
    /// Orientations that stay whole.
    pub orientations: Vec<CoordinateId>,
    /// The rules of all values.
    pub rules: Rules,
    /// One for each segment, every parent before its children.
    pub links: Vec<Link>,
    /// What could not be said, or is said in another way.
    pub remarks: Vec<Diagnostic>,
}

impl Tree {
    /// The variables at stored numbers of the model's coordinates, such as the effective ones of a pose.
    pub fn variables_at(&self, model: &Model, stored: &[f64]) -> Vec<f64> {
        let angle = |id: CoordinateId, axis: usize| {
            let place = model.stored_range(id);
            let q: [f64; 4] =
                std::array::from_fn(|i| stored.get(place.start + i).copied().unwrap_or(0.0));
            EulerOrder::XYZ.from_mat3(Quat::from(q).normalized().to_mat3())[axis.min(2)]
        };
        self.variables
            .iter()
            .map(|variable| match variable.source {
                Source::Coordinate(id) => model.value(stored, id),
                Source::Angle(id, axis) => angle(id, axis),
            })
            .collect()
    }

    /// All values at variables, those that are measured from a pose of the model.
    pub fn values_at(&self, model: &Model, pose: &Pose, variables: &[f64]) -> Vec<f64> {
        let mut values = self.rules.evaluate(variables);
        for link in &self.links {
            let Some(measured) = &link.measured else { continue };
            let whole = pose.segment_in_parent(model, link.segment);
            let before = self.product(&link.steps[..measured.at], &values, pose, model);
            let after = self.product(&link.steps[measured.at + 7..], &values, pose, model);
            let left = before.rigid_inverse() * whole * after.rigid_inverse();
            let left = measured.rest.rigid_inverse() * left;
            let turns = EulerOrder::XYZ.from_mat3(left.linear);
            let parts = left.translation.to_array().into_iter().chain(turns);
            for (slot, part) in measured.slots.iter().zip(parts) {
                if matches!(self.rules.rule(*slot), Rule::Measured) {
                    values[*slot] = part;
                }
            }
        }
        values
    }

    /// The transform of a part of a chain at values.
    pub fn product(&self, steps: &[Step], values: &[f64], pose: &Pose, model: &Model) -> Affine {
        steps.iter().fold(Affine::IDENTITY, |so_far, step| {
            so_far
                * step.transform(values, &|o| {
                    let stored = self.orientations.get(o).map(|&id| pose.coordinate(model, id));
                    stored
                        .and_then(|q| q.first_chunk::<4>())
                        .map_or(Quat::IDENTITY, |q| Quat::from(*q).normalized())
                })
        })
    }

    /// The transform of a link in its parent at values.
    pub fn link_transform(
        &self,
        link: &Link,
        values: &[f64],
        pose: &Pose,
        model: &Model,
    ) -> Affine {
        self.product(&link.steps, values, pose, model)
    }
}
