//! The outer surface of a cloud of points (section 4.1 of Herda et al. 2003).
//!
//! The space about the centroid is divided into L × L solid angles of equal intervals of the polar angle
//! θ from z and of the azimuth φ; in each the points near the farthest are kept:
//!
//! ```text
//! ρ_max(i, k) = max ρ_j        Surface(i, k) = { x_j : (1 - T) ρ_max < ρ_j ≤ ρ_max }
//! ```
//!
//! with L = 7 and T = 0.1. The text calls the solid angles overlapping, its formulas do not; they are
//! disjoint here. A cell without points has no surface. The surface of a hole is never found: only the
//! outermost points of a cell are (its Figure 7 b).

use condyle_math::Vec3;
use std::f64::consts::PI;

/// The mean of points; the origin if there are none.
pub fn centroid(points: &[Vec3]) -> Vec3 {
    let sum = points.iter().fold(Vec3::ZERO, |sum, p| sum + *p);
    sum * (1.0 / points.len().max(1) as f64)
}

/// A division of space about a centre into L × L solid angles.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SolidAngles {
    /// The centre.
    pub centre: Vec3,
    /// The number L of intervals of the polar angle, and of the azimuth.
    pub intervals: usize,
}

impl SolidAngles {
    /// The solid angle of a point, from 0 to L² - 1, and its distance ρ from the centre.
    pub fn cell(&self, point: Vec3) -> (usize, f64) {
        let from = point - self.centre;
        let rho = from.norm();
        let polar = from.x.hypot(from.y).atan2(from.z);
        let azimuth = from.y.atan2(from.x) + PI;
        let index = |share: f64| ((share * self.intervals as f64) as usize).min(self.intervals - 1);
        (index(polar / PI) * self.intervals + index(azimuth / (2.0 * PI)), rho)
    }

    /// The largest ρ in each cell; 0 where there are no points.
    pub fn largest(&self, points: &[Vec3]) -> Vec<f64> {
        let mut largest = vec![0.0f64; self.intervals * self.intervals];
        for p in points {
            let (cell, rho) = self.cell(*p);
            largest[cell] = largest[cell].max(rho);
        }
        largest
    }

    /// The positions of the surface points: those with ρ > (1 - `thickness`) ρ_max of their cell.
    ///
    /// ```
    /// use condyle_learn::limits::herda2003::SolidAngles;
    /// use condyle_math::Vec3;
    /// let points = [1.0, 0.95, 0.5].map(|x| Vec3::new(x, 0.01, 0.01));
    /// let cells = SolidAngles { centre: Vec3::ZERO, intervals: 7 };
    /// assert_eq!(cells.surface(&points, 0.1), [0, 1]);
    /// ```
    pub fn surface(&self, points: &[Vec3], thickness: f64) -> Vec<usize> {
        let largest = self.largest(points);
        let outer = |p: &Vec3| {
            let (cell, rho) = self.cell(*p);
            rho > (1.0 - thickness) * largest[cell]
        };
        points.iter().enumerate().filter(|(_, p)| outer(p)).map(|(i, _)| i).collect()
    }

    /// The distances ρ of the points in one cell: what the paper's Figure 7 counts.
    pub fn radii(&self, points: &[Vec3], cell: usize) -> Vec<f64> {
        points.iter().map(|p| self.cell(*p)).filter(|(c, _)| *c == cell).map(|(_, r)| r).collect()
    }
}

/// How many values lie in each of a number of equal bins.
#[derive(Clone, Debug, PartialEq)]
pub struct Histogram {
    /// The lower end of the first bin.
    pub from: f64,
    /// The upper end of the last bin.
    pub to: f64,
    /// The number of values in each bin; values beyond the ends are in the outermost.
    pub counts: Vec<usize>,
}

impl Histogram {
    /// Counts values between `from` and `to`.
    ///
    /// ```
    /// use condyle_learn::limits::herda2003::Histogram;
    /// assert_eq!(Histogram::of([0.1, 0.6, 0.9, 7.0], 0.0, 1.0, 2).counts, [1, 3]);
    /// ```
    pub fn of(values: impl IntoIterator<Item = f64>, from: f64, to: f64, bins: usize) -> Self {
        let mut counts = vec![0; bins.max(1)];
        let last = counts.len() - 1;
        for value in values.into_iter().filter(|value| value.is_finite()) {
            // A cast of a negative number gives 0.
            let bin = ((value - from) / (to - from) * counts.len() as f64) as usize;
            counts[bin.min(last)] += 1;
        }
        Self { from, to, counts }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_cell_of_a_ball_has_its_own_outermost_points() {
        // Points on rays: three on each, at 1, 0.92 and 0.85 of a length that depends on the ray, in
        // the middle of each of the 49 cells. The third is outside (1 - T) ρ_max = 0.9.
        let cells = SolidAngles { centre: Vec3::new(0.1, -0.2, 0.3), intervals: 7 };
        let mut points = Vec::new();
        for i in 0..7 {
            for k in 0..7 {
                let polar = (f64::from(i) + 0.5) / 7.0 * PI;
                let azimuth = (f64::from(k) + 0.5) / 7.0 * 2.0 * PI - PI;
                let ray = Vec3::new(
                    polar.sin() * azimuth.cos(),
                    polar.sin() * azimuth.sin(),
                    polar.cos(),
                );
                let length = 0.3 + 0.01 * f64::from(7 * i + k);
                points.extend([1.0, 0.92, 0.85].map(|share| cells.centre + ray * (share * length)));
            }
        }
        let expected: Vec<usize> = (0..147).filter(|i| i % 3 != 2).collect();
        assert_eq!(cells.surface(&points, 0.1), expected);
        let cell = cells.cell(points[0]).0;
        assert_eq!(cells.radii(&points, cell).len(), 3);
    }
}
