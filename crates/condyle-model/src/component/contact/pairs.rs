//! Interpolation between pairs of contact points by two drivers.
//!
//! A driver x is normalised over the range [lo, hi] of its values at the pairs, by n(x) = u²·(3 -
//! 2u) with u = (x - lo)/(hi - lo) clamped to [0, 1], so that it is constant beyond the outermost
//! pairs with a continuous slope; a driver with the same value at all pairs is ignored. With d_k
//! the distance to the normalised driver values of pair k, the weights are
//!
//! ```text
//! w_k = Π_{j≠k} d_j² / Σ_i Π_{j≠i} d_j²
//! ```
//!
//! which is inverse-distance weighting with exponent 2 (Shepard 1968), written without division by
//! zero. The weights are not negative and add up to 1, so the interpolated points stay in the
//! convex hull of the given ones. At the driver values of a pair its weight is 1 and the gradient
//! of every weight is 0; the gradient is continuous everywhere. The paper only states that pairs
//! are interpolated over two degrees of freedom.

use condyle_math::{Scalar, Vec3};

/// Two points of the scapula that are in contact with the ribs together, and the driver values at
/// which they are.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactPair {
    /// The first point in the segment's frame, in metres: the first rotation brings it to the ribs.
    pub first: Vec3,
    /// The second point in the segment's frame, in metres.
    pub second: Vec3,
    /// The values of the two drivers at which this pair is used alone; 0 for an absent driver.
    pub at: [f64; 2],
}

/// The ranges of the drivers, and the normalised driver values of the pairs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Places {
    low: [f64; 2],
    /// 1/(hi - lo), or 0 if all pairs have the same value.
    per_span: [f64; 2],
    at: [[f64; 2]; super::Gliding::MOST_PAIRS],
    count: usize,
}

impl Places {
    /// The normalised driver values of the first [`super::Gliding::MOST_PAIRS`] pairs.
    pub(super) fn new(pairs: &[ContactPair]) -> Self {
        let mut places = Self { low: [0.0; 2], per_span: [0.0; 2], at: [[0.0; 2]; 4], count: 0 };
        for axis in 0..2 {
            let of = || pairs.iter().map(|pair| pair.at[axis]);
            let low = of().fold(f64::INFINITY, f64::min);
            let per_span = 1.0 / (of().fold(f64::NEG_INFINITY, f64::max) - low);
            if per_span.is_finite() {
                (places.low[axis], places.per_span[axis]) = (low, per_span);
            }
        }
        places.count = pairs.len().min(places.at.len());
        for k in 0..places.count {
            places.at[k] = [0, 1].map(|axis| smooth(places.share(axis, pairs[k].at[axis])).0);
        }
        places
    }

    /// Two pairs (positions from 0) with the same driver values, if any.
    pub(super) fn equal(&self, pairs: &[ContactPair]) -> Option<(usize, usize)> {
        let near = |a: &ContactPair, b: &ContactPair| {
            (0..2).all(|k| (a.at[k] - b.at[k]).abs() * self.per_span[k] < 1e-6)
        };
        (0..pairs.len())
            .flat_map(|j| (0..j).map(move |i| (i, j)))
            .find(|&(i, j)| near(&pairs[i], &pairs[j]))
    }

    fn share(&self, axis: usize, x: f64) -> f64 {
        (x - self.low[axis]) * self.per_span[axis]
    }

    /// The weights of the pairs at these values of the drivers; absent drivers are 0.
    #[inline]
    pub(super) fn weights<S: Scalar>(&self, drivers: &[S]) -> [S; super::Gliding::MOST_PAIRS] {
        let mut weights = [S::zero(); 4];
        if self.count < 2 {
            weights[0] = S::one();
            return weights;
        }
        let normal = [0, 1].map(|axis| {
            let driver = drivers.get(axis).copied().unwrap_or(S::zero());
            driver.chain(|x| {
                let (value, slope) = smooth(self.share(axis, x));
                (value, slope * self.per_span[axis])
            })
        });
        let mut square = [S::one(); 4];
        for (square, at) in square.iter_mut().zip(self.at).take(self.count) {
            let off = [0, 1].map(|axis| normal[axis] - S::from_f64(at[axis]));
            *square = off[0] * off[0] + off[1] * off[1];
        }
        let mut sum = S::zero();
        for k in 0..self.count {
            let mut weight = S::one();
            for j in 0..self.count {
                if j != k {
                    weight *= square[j];
                }
            }
            weights[k] = weight;
            sum += weight;
        }
        // Not 0: the pairs differ in their driver values, so at most one squared distance is 0, and
        // the product without it is positive.
        let scale = S::one() / sum;
        weights.map(|weight| weight * scale)
    }
}

/// u²·(3 - 2u) for u clamped to [0, 1], and its slope; 0 for NaN.
#[inline(always)]
fn smooth(u: f64) -> (f64, f64) {
    if u >= 1.0 {
        (1.0, 0.0)
    } else if u > 0.0 {
        (u * u * (3.0 - 2.0 * u), 6.0 * u * (1.0 - u))
    } else {
        (0.0, 0.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use condyle_math::Dual;

    fn places(at: &[[f64; 2]]) -> Places {
        let pair = |&at: &[f64; 2]| ContactPair { first: Vec3::X, second: Vec3::Y, at };
        Places::new(&at.iter().map(pair).collect::<Vec<_>>())
    }

    const THREE: [[f64; 2]; 3] = [[0.5, 0.0], [-0.2, 0.1], [0.1, 1.0]];
    const FOUR: [[f64; 2]; 4] = [[0.5, 0.0], [-0.2, 0.1], [0.1, 1.0], [0.3, 0.7]];

    #[test]
    fn weights_are_a_partition_of_unity_that_interpolates() {
        for at in [&THREE[..1], &THREE[..2], &THREE, &FOUR] {
            let places = places(at);
            for i in -20..=30 {
                for j in -20..=30 {
                    let w = places.weights(&[f64::from(i) * 0.05, f64::from(j) * 0.05]);
                    assert!(w.iter().all(|&w| (0.0..=1.0).contains(&w)), "{w:?}");
                    assert!((w.iter().sum::<f64>() - 1.0).abs() < 1e-15, "{w:?}");
                }
            }
            for (k, place) in at.iter().enumerate() {
                let w = places.weights(place);
                assert!((w[k] - 1.0).abs() < 1e-15, "{k} {w:?}");
            }
        }
    }

    #[test]
    fn weights_are_those_of_inverse_squared_distances() {
        let places = places(&FOUR);
        let normal = |x: f64, lo: f64, hi: f64| {
            let u = ((x - lo) / (hi - lo)).clamp(0.0, 1.0);
            3.0 * u * u - 2.0 * u * u * u
        };
        let point = |at: [f64; 2]| (normal(at[0], -0.2, 0.5), normal(at[1], 0.0, 1.0));
        for x in [[0.0, 0.3], [0.31, 0.9], [0.49, 0.02], [-3.0, 0.4]] {
            let (a, b) = point(x);
            let inverse = FOUR.map(|at| {
                let (c, d) = point(at);
                1.0 / ((a - c).powi(2) + (b - d).powi(2))
            });
            let sum: f64 = inverse.iter().sum();
            let w = places.weights(&x);
            for k in 0..4 {
                assert!((w[k] - inverse[k] / sum).abs() < 1e-14, "{x:?} {k}");
            }
        }
    }

    #[test]
    fn slopes_are_exact_and_continuous_across_the_ends_of_the_range_and_at_the_pairs() {
        let places = places(&FOUR);
        let slopes = |x: [f64; 2]| {
            let [a, b] = [0, 1].map(|i| Dual::<2>::variable(x[i], i));
            places.weights(&[a, b]).map(|w| w.partials)
        };
        let h = 1e-6;
        for i in -10..=30 {
            for j in -6..=26 {
                let x = [f64::from(i) * 0.037 - 0.2, f64::from(j) * 0.0493];
                let exact = slopes(x);
                for axis in 0..2 {
                    let moved = |by: f64| {
                        let mut x = x;
                        x[axis] += by;
                        x
                    };
                    let [up, down] = [h, -h].map(|by| places.weights(&moved(by)));
                    // The slope is Lipschitz, so that a step of h moves it by no more than C·h.
                    let after = slopes(moved(h));
                    for k in 0..4 {
                        let central = (up[k] - down[k]) / (2.0 * h);
                        let off = (central - exact[k][axis]).abs();
                        assert!(off < 1e-3, "{x:?} {k} {off}");
                        assert!((after[k][axis] - exact[k][axis]).abs() < 2e3 * h, "{x:?} {k}");
                    }
                }
            }
        }
        for place in FOUR {
            assert!(slopes(place).iter().flatten().all(|s| s.abs() < 1e-12), "{place:?}");
        }
    }

    #[test]
    fn drivers_that_are_absent_or_no_numbers_leave_weights() {
        let places = places(&THREE);
        assert_eq!(places.weights::<f64>(&[]), places.weights(&[0.0, 0.0]));
        for x in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 1e300] {
            let w = places.weights(&[x, 0.3]);
            assert!((w.iter().sum::<f64>() - 1.0).abs() < 1e-15, "{w:?}");
        }
    }
}
