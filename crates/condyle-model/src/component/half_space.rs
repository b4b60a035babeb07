//! A half-plane over two numbers, or a half-space over one to four.
//!
//! ```text
//! g = (bound - Σ nᵢ·xᵢ) / |n|,   nearest legal numbers: x + min(g, 0)·n/|n|
//! ```
//!
//! Over two angles it is a half-plane, which cuts off a corner of their ranges: the fist that flexes less
//! with the wrist flexed. Over the distance of a point from a plane it keeps the point on one side. No
//! kinks but the boundary.

use super::{Contract, Geometry, Kind, Port, PortType};
use crate::limit::{Limit, MOST_LIMITED, MOST_ROWS, NO_ROW, Row};
use std::fmt;

/// The numbers whose sum with these factors is at most a bound.
#[derive(Clone, Debug, PartialEq)]
pub struct HalfSpace {
    normal: Vec<f64>,
    bound: f64,
}

/// Why numbers do not make a [`HalfSpace`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct HalfSpaceError;

impl fmt::Display for HalfSpaceError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "it needs 1 to {MOST_LIMITED} finite factors, not all 0, and a finite bound")
    }
}

impl std::error::Error for HalfSpaceError {}

impl HalfSpace {
    /// The half-space Σ `normal`ᵢ·xᵢ ≤ `bound`.
    ///
    /// # Errors
    /// For no factors or more than [`MOST_LIMITED`], only zeros, or a number that is not finite.
    ///
    /// ```
    /// use condyle_model::component::HalfSpace;
    /// use condyle_model::limit::Limit;
    /// // Fingers and wrist flex by 2 radians together at most.
    /// let fist = HalfSpace::new(vec![1.0, 1.0], 2.0).unwrap();
    /// assert_eq!(fist.legal(&[1.5, 1.5]).unwrap()[..2], [1.0, 1.0]);
    /// assert_eq!(fist.legal(&[1.5, 0.25]), None);
    /// ```
    pub fn new(normal: Vec<f64>, bound: f64) -> Result<Self, HalfSpaceError> {
        let size = normal.iter().map(|n| n * n).sum::<f64>();
        let fits = (1..=MOST_LIMITED).contains(&normal.len());
        match fits && size > 1e-24 && size.is_finite() && bound.is_finite() {
            true => Ok(Self { normal, bound }),
            false => Err(HalfSpaceError),
        }
    }

    /// The factors.
    pub fn normal(&self) -> &[f64] {
        &self.normal
    }

    /// The largest sum.
    pub fn bound(&self) -> f64 {
        self.bound
    }

    /// The signed distance, positive inside, and the factors normalised.
    fn distance(&self, numbers: &[f64]) -> (f64, [f64; MOST_LIMITED]) {
        let length = self.normal.iter().map(|n| n * n).sum::<f64>().sqrt();
        let mut unit = [0.0; MOST_LIMITED];
        let mut sum = self.bound;
        for ((unit, n), x) in unit.iter_mut().zip(&self.normal).zip(numbers) {
            *unit = n / length;
            sum -= n * x;
        }
        (sum / length, unit)
    }
}

/// The most numbers in a sum.
const MOST_SUMMED: usize = 4;

impl HalfSpace {
    pub(crate) const KIND: Kind = Kind {
        name: "half_space",
        ports: &[Port::list("inputs", PortType::Scalar).at_most(MOST_SUMMED)],
    };
}

impl Contract for HalfSpace {
    fn takes(&self) -> Option<usize> {
        Some(self.normal.len())
    }

    fn outputs(&self) -> (PortType, usize) {
        (PortType::Scalar, self.normal().len())
    }

    fn geometry(&mut self) -> Vec<Geometry<'_>> {
        vec![]
    }
}

impl Limit for HalfSpace {
    fn rows(&self) -> usize {
        1
    }

    fn rows_at(&self, numbers: &[f64]) -> [Row; MOST_ROWS] {
        let (distance, unit) = self.distance(numbers);
        [(distance, unit.map(|n| -n)), NO_ROW, NO_ROW]
    }

    fn legal(&self, numbers: &[f64]) -> Option<[f64; MOST_LIMITED]> {
        let (distance, unit) = self.distance(numbers);
        // Numbers that this has moved stay: a rounding of the sum does not count.
        let room = 1e-15 * (1.0 + numbers.iter().fold(0.0f64, |most, x| most.max(x.abs())));
        if distance >= -room || distance.is_nan() {
            return None;
        }
        let mut legal = [0.0; MOST_LIMITED];
        for ((legal, x), n) in legal.iter_mut().zip(numbers).zip(unit) {
            *legal = x + distance * n;
        }
        Some(legal)
    }

    fn margin(&self, _: &[f64]) -> f64 {
        f64::INFINITY
    }
}
