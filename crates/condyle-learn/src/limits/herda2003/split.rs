//! How a sphere is replaced by several (section 4.3).
//!
//! The text of the paper says "six new ones that are positioned on one axis in a symmetrical manner, so as
//! to yield a shape as close as possible to the original", the caption of its Figure 9 "two". It does not
//! say which axis, where on it, and how large. Here: the axis along which the surface points in the
//! sphere's support extend most; the outermost centres at a quarter of the radius from the old centre (at least
//! 0.05, or spheres of radius 0 would coincide for good), the others evenly between; one common radius e′
//! for which the sum of the fields is nearest to 1 on the old sphere:
//!
//! ```text
//! min over e′ ≥ 0 of  ∫ (Σ f(|p - c_m|; e′) - 1)² dp  over |p - c| = e
//! ```

use super::field::{Primitive, profile};
use condyle_math::Vec3;

/// Into how many spheres one is split.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Split {
    /// Into six: the text.
    Six,
    /// Into two: the caption of Figure 9.
    #[default]
    Two,
}

impl Split {
    /// The number of new spheres.
    pub fn parts(self) -> usize {
        match self {
            Self::Six => 6,
            Self::Two => 2,
        }
    }
}

/// The smallest distance of the outermost new centres from the old one.
const LEAST_SPREAD: f64 = 0.05;
/// Steps of the integral over the sphere, in the cosine of the angle from the axis.
const STEPS: usize = 64;

/// The direction of largest extent of points, length 1; x if there is none.
///
/// The eigenvector of the largest eigenvalue of their covariance, by powers of the matrix: after twelve
/// squarings the ratio of the eigenvalues has the exponent 4096.
pub fn principal_axis(points: &[Vec3]) -> Vec3 {
    let mean = super::surface::centroid(points);
    let mut m = [[0.0f64; 3]; 3];
    for p in points {
        let d = (*p - mean).to_array();
        for i in 0..3 {
            for j in 0..3 {
                m[i][j] += d[i] * d[j];
            }
        }
    }
    for _ in 0..12 {
        let trace = m[0][0] + m[1][1] + m[2][2];
        if trace <= 0.0 || trace.is_nan() {
            return Vec3::X;
        }
        let scaled = m.map(|row| row.map(|x| x / trace));
        for i in 0..3 {
            for j in 0..3 {
                m[i][j] = (0..3).map(|k| scaled[i][k] * scaled[k][j]).sum();
            }
        }
    }
    // Every column is a multiple of the eigenvector: the longest has lost the least.
    let columns = [0, 1, 2].map(|j| Vec3::new(m[0][j], m[1][j], m[2][j]));
    let longest = columns.into_iter().max_by(|a, b| a.norm().total_cmp(&b.norm()));
    let axis = longest.unwrap_or(Vec3::X);
    let length = axis.norm();
    if length > 0.0 { axis * (1.0 / length) } else { Vec3::X }
}

/// The new spheres of one, along an axis of length 1.
pub fn split(sphere: &Primitive, axis: Vec3, stickiness: f64, into: Split) -> Vec<Primitive> {
    let spread = (0.25 * sphere.radius).max(LEAST_SPREAD);
    let n = into.parts();
    let places: Vec<f64> =
        (0..n).map(|m| spread * (2.0 * m as f64 / (n - 1) as f64 - 1.0)).collect();
    let radius = common_radius(sphere.radius, &places, stickiness);
    places.iter().map(|at| Primitive { centre: sphere.centre + axis * *at, radius }).collect()
}

/// The common radius of spheres at these places for which their field is nearest to 1 at a distance
/// `radius` from the origin; 0 if any is too large.
fn common_radius(radius: f64, places: &[f64], stickiness: f64) -> f64 {
    // The mean square is not convex in e′ where spheres leave a point, but its derivative changes sign
    // once from below: the fields grow with e′ everywhere. Bisection of Σ (F - 1) ∂F/∂e′.
    let slope = |e: f64| {
        let mut sum = 0.0;
        for step in 0..STEPS {
            let cosine = (2.0 * step as f64 + 1.0) / STEPS as f64 - 1.0;
            let (mut value, mut change) = (0.0, 0.0);
            for at in places {
                let r = (radius * radius + at * at - 2.0 * radius * at * cosine).max(0.0).sqrt();
                let (f, slope, _) = profile(r, e, stickiness);
                value += f;
                change -= slope;
            }
            sum += (value - 1.0) * change;
        }
        sum
    };
    // No sphere needs to be larger than the old one: each alone would then reach it.
    let (mut low, mut high) = (0.0, radius.max(0.0) + 2.0 / stickiness);
    // Where no field reaches, its slope is 0: the spheres are too small there.
    if slope(low) > 0.0 {
        return low;
    }
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if slope(middle) <= 0.0 { low = middle } else { high = middle }
    }
    0.5 * (low + high)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::limits::herda2003::SphereField;

    #[test]
    fn the_axis_is_that_of_the_longest_extent() {
        let along = Vec3::new(2.0, -1.0, 2.0) * (1.0 / 3.0);
        let across = Vec3::new(1.0, 2.0, 0.0) * (1.0 / 5f64.sqrt());
        let points: Vec<Vec3> = (0..100)
            .map(|i| along * f64::from(i - 50) * 0.02 + across * f64::from(i % 7 - 3) * 0.05)
            .collect();
        // The two directions are orthogonal and their coordinates nearly uncorrelated.
        assert!(principal_axis(&points).dot(along).abs() > 0.999);
        assert_eq!(principal_axis(&[]), Vec3::X);
    }

    #[test]
    fn the_new_shape_is_near_the_old_one_and_symmetrical() {
        for (into, room) in [(Split::Two, 0.35), (Split::Six, 0.35)] {
            let old = Primitive { centre: Vec3::new(0.1, 0.2, -0.1), radius: 0.6 };
            let primitives = split(&old, Vec3::Z, 5.0, into);
            assert_eq!(primitives.len(), into.parts());
            let field = SphereField { primitives, stickiness: 5.0 };
            let n = into.parts();
            for m in 0..n {
                let (a, b) = (field.primitives[m], field.primitives[n - 1 - m]);
                assert!((a.centre + b.centre - old.centre * 2.0).norm() < 1e-14);
                assert_eq!(a.radius, b.radius);
            }
            // The mean of F over the old sphere (uniform in the cosine) is near 1, and no point of it is
            // off by as much as the field changes over 0.07, a slope of 5.
            let mut mean = 0.0;
            for step in 0..50 {
                let cosine = (2.0 * f64::from(step) + 1.0) / 50.0 - 1.0;
                let sine = (1.0 - cosine * cosine).sqrt();
                let value = field.value(old.centre + Vec3::new(sine, 0.0, cosine) * old.radius);
                assert!((value - 1.0).abs() < room, "{into:?} {cosine}: {value}");
                mean += value / 50.0;
            }
            assert!((mean - 1.0).abs() < 0.05, "{into:?}: {mean}");
        }
    }
}
