//! Coordinates that should have a value: `w (q - t)²`, part of F.

use super::{Target, add_square};
use crate::problem::Frame;
use condyle_model::CoordinateId;
use condyle_solve::least_squares::LocalModel;

/// One coordinate that should have a value.
#[derive(Clone, Debug, PartialEq)]
pub struct CoordinateTarget {
    /// The coordinate; one number, of any kind.
    pub coordinate: CoordinateId,
    /// Its weight, m² per rad² (or per m²).
    pub weight: f64,
    /// The value, in radians or metres.
    pub wanted: Wanted,
}

/// The value that a coordinate should have.
#[derive(Clone, Debug, PartialEq)]
pub enum Wanted {
    /// The same in every frame.
    Constant(f64),
    /// One for each frame; not finite where there is none.
    PerFrame(Vec<f64>),
}

impl Wanted {
    /// The value in a frame, if there is one.
    pub fn at(&self, frame: usize) -> Option<f64> {
        let value = match self {
            Self::Constant(value) => *value,
            Self::PerFrame(values) => *values.get(frame)?,
        };
        value.is_finite().then_some(value)
    }
}

impl CoordinateTarget {
    /// How far the coordinate is from its value in a frame that has one.
    fn off(&self, frame: &Frame<'_>) -> Option<f64> {
        Some(frame.coordinate(self.coordinate) - self.wanted.at(frame.index)?)
    }
}

impl Target for Vec<CoordinateTarget> {
    fn value(&self, frame: &mut Frame<'_>) -> f64 {
        let offs = self.iter().filter_map(|t| Some((t.weight, t.off(frame)?)));
        offs.map(|(weight, off)| weight * off * off).sum()
    }

    fn linearise(&self, frame: &mut Frame<'_>, local: &mut LocalModel) {
        for target in self {
            if let Some(off) = target.off(frame) {
                add_square(frame, local, &[(target.coordinate, 1.0)], off, 2.0 * target.weight);
            }
        }
    }
}
