//! Values of a driver at which limits are known, and how they are blended between these.
//!
//! Of a coordinate they are equally spaced, with quadratic B-splines as weights: three at a time, smooth to the first
//! derivative, and exact for a boundary that moves in proportion to the driver. Of a rotation they cover what was recorded, with the
//! weights (1 - sin²(θ/2)/sin²(ρ/2))³ out to an angle ρ, over their sum and a little for what is not known.

use super::Driver;
use condyle_math::Quat;
use std::f64::consts::PI;

/// The weight of what is not known beside those of rotations, which reach 1.
const LITTLE: f64 = 0.005;

/// How far the weight of a rotation reaches, in steps.
const REACH: f64 = 1.7;

/// Values of a driver.
#[derive(Clone, Debug, PartialEq)]
pub enum Cells {
    /// Equally spaced values of a coordinate, and at which of them something is known.
    Knots {
        /// The first.
        first: f64,
        /// How far they are apart.
        step: f64,
        /// At which something is known.
        known: Vec<bool>,
    },
    /// Rotations, all known, that cover what was recorded.
    Rotations {
        /// Unit quaternions.
        centres: Vec<Quat>,
        /// sin² of half the angle to which a weight reaches.
        reach: f64,
    },
}

impl Cells {
    /// Rotations a step apart.
    #[must_use]
    pub fn rotations(centres: Vec<Quat>, step: f64) -> Self {
        let half = (0.5 * REACH * step).min(0.5 * PI);
        Self::Rotations { centres, reach: half.sin().powi(2) }
    }

    /// How many there are.
    #[must_use]
    pub fn len(&self) -> usize {
        match self {
            Self::Knots { known, .. } => known.len(),
            Self::Rotations { centres, .. } => centres.len(),
        }
    }

    /// Whether there are none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The value of one, if something is known there.
    #[must_use]
    pub fn value(&self, cell: usize) -> Option<Driver> {
        match self {
            Self::Knots { first, step, known } => {
                let known = known.get(cell).copied().unwrap_or(false);
                known.then(|| Driver::Scalar(first + step * cell as f64))
            }
            Self::Rotations { centres, .. } => centres.get(cell).copied().map(Driver::Rotation),
        }
    }

    /// Calls for each that has a weight at a value of the driver, with the weight and its slopes: by the coordinate, or along
    /// turns about the driver's own axes. The answer is the weight of what is not known and its slopes; all together are 1 for
    /// coordinates and must be divided by their sum for rotations.
    #[inline]
    fn visit(
        &self,
        driver: Driver,
        mut visit: impl FnMut(usize, f64, [f64; 3]),
    ) -> (f64, [f64; 3]) {
        match (self, driver) {
            (Self::Knots { first, step, known }, Driver::Scalar(value)) if value.is_finite() => {
                let at = (value - first) / step;
                let middle = at.round();
                let t = at - middle;
                let below = 0.5 - t;
                let above = 0.5 + t;
                let weights = [0.5 * below * below, 0.75 - t * t, 0.5 * above * above];
                let slopes = [-below / step, -2.0 * t / step, above / step];
                let (mut rest, mut rate) = (1.0, 0.0);
                for (offset, (weight, slope)) in
                    [-1.0, 0.0, 1.0].into_iter().zip(weights.into_iter().zip(slopes))
                {
                    let knot = middle + offset;
                    if knot >= 0.0 && known.get(knot as usize) == Some(&true) {
                        visit(knot as usize, weight, [slope, 0.0, 0.0]);
                        rest -= weight;
                        rate -= slope;
                    }
                }
                // What is left of 1 by rounding is nothing.
                if rest < 1e-12 { (0.0, [0.0; 3]) } else { (rest, [rate, 0.0, 0.0]) }
            }
            (Self::Rotations { centres, reach }, Driver::Rotation(q)) => {
                for (cell, centre) in centres.iter().enumerate() {
                    let r = centre.conjugate() * q;
                    // sin² of half the angle, from the components that keep their digits.
                    let sine = r.x * r.x + r.y * r.y + r.z * r.z;
                    let near = 1.0 - sine / reach;
                    if near > 0.0 {
                        // d(sin²)/dω = w v.
                        let rate = -3.0 * near * near * r.w / reach;
                        visit(cell, near * near * near, [rate * r.x, rate * r.y, rate * r.z]);
                    }
                }
                (LITTLE, [0.0; 3])
            }
            _ => (1.0, [0.0; 3]),
        }
    }

    /// Numbers that are known at the cells, and `None` for what holds where nothing is known, blended at a value of
    /// the driver.
    #[inline]
    pub(super) fn blended<const N: usize>(
        &self,
        driver: Driver,
        mut of: impl FnMut(Option<usize>) -> [f64; N],
    ) -> Blended<N> {
        let mut values = [0.0; N];
        let mut slopes = [[0.0; 3]; N];
        let (mut total, mut rate) = (0.0, [0.0; 3]);
        let mut add = |numbers: [f64; N], weight: f64, slope: [f64; 3]| {
            for (number, (value, slopes)) in
                numbers.into_iter().zip(values.iter_mut().zip(&mut slopes))
            {
                *value += weight * number;
                for (sum, by) in slopes.iter_mut().zip(slope) {
                    *sum += by * number;
                }
            }
            total += weight;
            for (sum, by) in rate.iter_mut().zip(slope) {
                *sum += by;
            }
            total
        };
        let mut known = 0.0;
        let (weight, slope) =
            self.visit(driver, |cell, weight, slope| known = add(of(Some(cell)), weight, slope));
        if weight > 0.0 {
            add(of(None), weight, slope);
        }
        for (value, slopes) in values.iter_mut().zip(&mut slopes) {
            *value /= total;
            for (slope, by) in slopes.iter_mut().zip(rate) {
                *slope = (*slope - *value * by) / total;
            }
        }
        Blended { values, slopes, known: known / total }
    }
}

/// Numbers at a value of the driver.
#[derive(Clone, Copy, Debug)]
pub(super) struct Blended<const N: usize> {
    pub(super) values: [f64; N],
    /// Of each by the coordinate, or along turns about the driver's own axes.
    pub(super) slopes: [[f64; 3]; N],
    /// The share of what is known in the values.
    pub(super) known: f64,
}
