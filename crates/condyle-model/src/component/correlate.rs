//! Several scalars to one, learned from recordings: y = f(x₁, …, xₙ) (Pronost, Sandholm & Thalmann 2010, equations 1
//! and 2).
//!
//! It computes what [`Combine`](super::Combine) does; beside that it knows where the scalars were when it was learned, so that use
//! outside that region can be told. It is smooth and gives a value everywhere.

use super::{Contract, Fault, Geometry, Kind, Port, PortType};
use condyle_diagnostics::Severity;
use condyle_math::function::FunctionOfSeveral;

/// A learned law: one scalar as a function of several, of the same or of other joints, for example the place of the knee's
/// centre along an axis of the thigh from the three angles of the knee.
#[derive(Clone, Debug, PartialEq)]
pub struct Correlate {
    /// The function, of as many arguments as there are inputs.
    pub function: FunctionOfSeveral,
    /// Where the inputs were when it was learned; `None` where that is not known.
    pub region: Option<Region>,
}

impl Correlate {
    pub(crate) const KIND: Kind =
        Kind { name: "correlate", ports: &[Port::list("inputs", PortType::Scalar)] };
}

impl Contract for Correlate {
    fn takes(&self) -> Option<usize> {
        Some(self.function.arity())
    }

    fn outputs(&self) -> (PortType, usize) {
        (PortType::Scalar, 1)
    }

    fn faults(&self) -> Vec<Fault> {
        let fits = self.region.as_ref().is_none_or(|region| region.is_of(self.function.arity()));
        if fits {
            return vec![];
        }
        vec![Fault {
            severity: Severity::Error,
            code: "model/region",
            said: "has a region of other inputs".to_owned(),
            help: "give `low`, `high` and `centre` a number for each input, `inverse` a row of as many, low not above high",
        }]
    }

    fn geometry(&mut self) -> Vec<Geometry<'_>> {
        vec![]
    }
}

/// Where a law was learned: the box of its controls, and an ellipsoid about their mean.
///
/// A point is inside if it is in the box and √((x - c)ᵀ·C⁻¹·(x - c)) (Mahalanobis' distance) is at most `distance`: where
/// controls move together the corners of the box were never seen.
#[derive(Clone, Debug, PartialEq)]
pub struct Region {
    /// The least value of each control.
    pub low: Vec<f64>,
    /// The greatest value of each control.
    pub high: Vec<f64>,
    /// The mean c of each control.
    pub centre: Vec<f64>,
    /// C⁻¹, the inverse of the covariance of the controls, row by row.
    pub inverse: Vec<f64>,
    /// The greatest distance of a frame.
    pub distance: f64,
}

/// What is so little beyond a region, relative to its size, is inside: numbers of files are rounded.
const ROUNDED: f64 = 1e-6;

impl Region {
    /// Whether all its parts are finite and for so many controls.
    #[must_use]
    pub fn is_of(&self, controls: usize) -> bool {
        let numbers = [&self.low, &self.high, &self.centre];
        let square = controls.checked_mul(controls);
        numbers.iter().all(|list| list.len() == controls)
            && Some(self.inverse.len()) == square
            && numbers.into_iter().flatten().chain(&self.inverse).all(|x| x.is_finite())
            && self.distance >= 0.0
            && self.low.iter().zip(&self.high).all(|(low, high)| low <= high)
    }

    /// Mahalanobis' distance of a point from the mean of the training frames; without unit.
    #[must_use]
    pub fn distance_of(&self, point: &[f64]) -> f64 {
        let n = self.centre.len();
        let away = |i: usize| point.get(i).map_or(0.0, |x| x - self.centre[i]);
        let mut sum = 0.0;
        for (i, row) in self.inverse.chunks_exact(n.max(1)).take(n).enumerate() {
            for (j, entry) in row.iter().enumerate() {
                sum += away(i) * entry * away(j);
            }
        }
        sum.max(0.0).sqrt()
    }

    /// Whether the law was learned about here.
    ///
    /// ```
    /// use condyle_model::component::Region;
    /// let region = Region {
    ///     low: vec![-1.0], high: vec![1.0], centre: vec![0.0], inverse: vec![4.0], distance: 2.0,
    /// };
    /// assert!(region.contains(&[0.9]) && !region.contains(&[1.1]));
    /// ```
    #[must_use]
    pub fn contains(&self, point: &[f64]) -> bool {
        self.beyond(point).is_none() && self.distance_of(point) <= self.distance * (1.0 + ROUNDED)
    }

    /// Makes it that of controls measured in other units, or on a body of another size: each `factors` times as large.
    pub(crate) fn stretch(&mut self, factors: impl Iterator<Item = f64>) {
        let factors: Vec<f64> = factors.collect();
        for list in [&mut self.low, &mut self.high, &mut self.centre] {
            list.iter_mut().zip(&factors).for_each(|(x, factor)| *x *= factor);
        }
        let pairs = factors.iter().flat_map(|a| factors.iter().map(move |b| a * b));
        self.inverse.iter_mut().zip(pairs).for_each(|(entry, factor)| *entry /= factor);
    }

    /// The first control that is outside its bounds, and by how much.
    #[must_use]
    pub fn beyond(&self, point: &[f64]) -> Option<(usize, f64)> {
        point.iter().zip(&self.low).zip(&self.high).enumerate().find_map(|(i, ((x, low), high))| {
            let by = (low - x).max(x - high);
            (by > ROUNDED * (high - low).max(1e-6)).then_some((i, by))
        })
    }
}
