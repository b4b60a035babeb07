//! The pose to be near, and the measure of nearness.

use crate::target::PostureTarget;
use condyle_model::{CoordinateKind, Model};

/// The stiffness of a coordinate to which the model gives none, m² per rad² (or per unit of what is no
/// length): a radian weighs as much as a millimetre of a goal of weight 1.
pub const REST_ANGLE: f64 = 1e-6;
/// The same of a distance, m² per m²: ten centimetres weigh as much as a radian.
pub const REST_LENGTH: f64 = 1e-4;

/// The pose to be near, with
/// R(q) = Σ_c k_c |q_c - rest_c|² + Σ_p k_p (Σᵢ a_pᵢ qᵢ - rest_p)².
#[derive(Clone, Debug, PartialEq)]
pub struct Rest {
    /// The stored numbers of all coordinates at rest.
    pub pose: Vec<f64>,
    /// The stiffness k_c of each coordinate, positive and finite; that of one that follows others is
    /// not used.
    pub stiffness: Vec<f64>,
    /// Sums of several coordinates with a value at rest.
    pub sums: Vec<PostureTarget>,
}

impl Rest {
    /// The rest of a model: where its postures are at rest, else its defaults, within the ranges.
    pub fn of(model: &Model) -> Self {
        let mut pose = model.defaults();
        let usual = |kind| match kind {
            CoordinateKind::Translation => REST_LENGTH,
            _ => REST_ANGLE,
        };
        let mut stiffness: Vec<f64> = model.coordinates().iter().map(|c| usual(c.kind)).collect();
        let mut sums = vec![];
        for term in model.postures() {
            let [(id, factor)] = term.sum[..] else {
                let (terms, stiffness) = (term.sum.clone(), term.stiffness);
                sums.push(PostureTarget { terms, rest: term.rest, stiffness });
                continue;
            };
            stiffness[id.index()] = term.stiffness * factor * factor;
            let rest = model.coordinate(id).range.nearest(term.rest / factor);
            *model.value_mut(&mut pose, id) = rest;
        }
        Self { pose, stiffness, sums }
    }

    /// The same stiffness about another pose, given by the stored numbers of all coordinates: sums rest
    /// at the values that they have there.
    ///
    /// # Panics
    /// If `pose` has not as many numbers as the model stores.
    #[must_use]
    pub fn around(mut self, model: &Model, pose: &[f64]) -> Self {
        self.pose.copy_from_slice(pose);
        for sum in &mut self.sums {
            sum.rest = sum.terms.iter().map(|&(id, factor)| factor * model.value(pose, id)).sum();
        }
        self
    }
}
