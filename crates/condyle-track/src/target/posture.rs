//! Rest values of coordinates, or of sums of several: `P = k (Σᵢ aᵢ qᵢ - r)²`, reported apart from F.
//!
//! What markers do not determine is taken from here: a spine whose parts share a bend, a scapula that
//! follows an arm. A stiffness of 1e-5 m²/rad² makes one radian weigh as much as 3.2 mm RMS of all
//! markers.

use super::{Target, add_square};
use crate::problem::Frame;
use condyle_model::CoordinateId;
use condyle_solve::least_squares::LocalModel;

/// A linear combination of coordinates that rests at a value.
#[derive(Clone, Debug, PartialEq)]
pub struct PostureTarget {
    /// The coordinates, each of one number, with their finite factors aᵢ.
    pub terms: Vec<(CoordinateId, f64)>,
    /// The value at rest r, in radians (or metres).
    pub rest: f64,
    /// The stiffness k, m² per rad² (or per m²); positive and finite.
    pub stiffness: f64,
}

impl PostureTarget {
    /// How far the combination is from its rest.
    fn off(&self, frame: &Frame<'_>) -> f64 {
        let values = self.terms.iter().map(|&(id, factor)| factor * frame.coordinate(id));
        values.sum::<f64>() - self.rest
    }
}

impl Target for Vec<PostureTarget> {
    fn value(&self, frame: &mut Frame<'_>) -> f64 {
        self.iter().map(|t| t.stiffness * t.off(frame).powi(2)).sum()
    }

    fn linearise(&self, frame: &mut Frame<'_>, local: &mut LocalModel) {
        for target in self {
            let off = target.off(frame);
            add_square(frame, local, &target.terms, off, 2.0 * target.stiffness);
        }
    }
}
