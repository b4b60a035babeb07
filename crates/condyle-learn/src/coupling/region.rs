//! Where the training angles are.

use super::Samples;
use condyle_model::component::Region;
use condyle_solve::eigen;

/// What is added to the correlations, so that controls that move together keep a region of some thickness.
const FLOOR: f64 = 1e-6;

/// The region of some columns of all trials: their box, and the ellipsoid about their mean that holds all frames.
///
/// ```
/// use condyle_learn::coupling::{Groups, Samples, region_of};
/// let mut samples = Samples { columns: vec!["a".into(), "b".into()], ..Samples::default() };
/// // Along a line: the corners of the box are far from all frames.
/// let rows: Vec<f64> = (0..50).flat_map(|i| [f64::from(i), f64::from(i) + f64::from(i % 2)]).collect();
/// samples.add("line", Groups::default(), &rows, 0);
/// let region = region_of(&samples, &[0, 1]);
/// assert!(region.contains(&[25.0, 25.0]) && !region.contains(&[1.0, 49.0]));
/// assert!(!region.contains(&[60.0, 60.0]));
/// ```
#[must_use]
pub fn region_of(samples: &Samples, controls: &[usize]) -> Region {
    let n = controls.len();
    let columns: Vec<Vec<f64>> = controls.iter().map(|c| samples.column(*c)).collect();
    let frames = columns.first().map_or(0, Vec::len).max(1) as f64;
    let centre: Vec<f64> = columns.iter().map(|c| c.iter().sum::<f64>() / frames).collect();
    let fold = |f: fn(f64, f64) -> f64, start: f64| -> Vec<f64> {
        columns.iter().map(|c| c.iter().copied().fold(start, f)).collect()
    };
    let (low, high) = (fold(f64::min, f64::INFINITY), fold(f64::max, f64::NEG_INFINITY));
    let covariance = |i: usize, j: usize| -> f64 {
        let pairs = columns[i].iter().zip(&columns[j]);
        pairs.map(|(a, b)| (a - centre[i]) * (b - centre[j])).sum::<f64>() / frames
    };
    let scales: Vec<f64> = (0..n)
        .map(|i| covariance(i, i).sqrt())
        .map(|scale| if scale > 0.0 { scale } else { 1.0 })
        .collect();
    let mut correlation = vec![0.0; n * n];
    for i in 0..n {
        for j in 0..n {
            correlation[i * n + j] = covariance(i, j) / (scales[i] * scales[j]);
        }
        correlation[i * n + i] += FLOOR;
    }
    let mut inverse = eigen::function(&correlation, n, |v| 1.0 / v.max(FLOOR));
    for i in 0..n {
        for j in 0..n {
            inverse[i * n + j] /= scales[i] * scales[j];
        }
    }
    let mut region = Region { low, high, centre, inverse, distance: 0.0 };
    let mut point = vec![0.0; n];
    for frame in 0..columns.first().map_or(0, Vec::len) {
        point.iter_mut().zip(&columns).for_each(|(x, column)| *x = column[frame]);
        region.distance = region.distance.max(region.distance_of(&point));
    }
    region
}
