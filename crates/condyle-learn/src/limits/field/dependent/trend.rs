//! How boundaries move with the driver on the whole: a polynomial of second degree, taken away before samples of other values count.
//!
//! First the closing at each value of the driver is found with samples that retreat by the whole slope. At every node the distances
//! that follow are smoothed over the driver by least squares, T(q, driver) = Σ a_j(q) φ_j(driver). Then a sample counts by where the trend
//! says that it would be at the value asked for, with the change held within the slope, and retreats by a part of the slope
//! only: what moves otherwise than the trend is still found, from samples close by.

use super::super::super::Cloud;
use super::super::nearest::Nodes;
use super::Driver;
use super::{Drivers, Question, angle, cells, radius, slice};
use condyle_math::Quat;
use condyle_model::limit::field::Lattice;

/// The part of the slope by which a sample retreats beside the trend.
pub(super) const BESIDE: f64 = 0.3;

/// Nodes of the lattice on which a trend is found.
const NODES: usize = 32;

/// 1, x, y, z, and their six products.
const MOST: usize = 10;

type Terms = [f64; MOST];

/// The terms of the polynomial.
#[derive(Clone, Copy, Debug)]
pub(super) struct Features {
    middle: Driver,
    /// What is 1 in a coordinate.
    scale: f64,
    count: usize,
}

impl Features {
    fn of(drivers: &Drivers) -> Option<Self> {
        match drivers {
            Drivers::Scalars(values) => {
                let low = values.iter().copied().fold(f64::INFINITY, f64::min);
                let high = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
                let scale = 0.5 * (high - low);
                let middle = Driver::Scalar(0.5 * (low + high));
                (scale > 1e-9).then_some(Self { middle, scale, count: 3 })
            }
            Drivers::Rotations(values) => {
                let cloud = Cloud::gather(&[values], 0.1).ok()?;
                let middle = Driver::Rotation(cloud.reference());
                Some(Self { middle, scale: 1.0, count: MOST })
            }
        }
    }

    fn terms(&self, driver: Driver) -> Terms {
        match (self.middle, driver) {
            (Driver::Scalar(middle), Driver::Scalar(value)) => {
                let x = (value - middle) / self.scale;
                let mut terms = [0.0; MOST];
                terms[..3].copy_from_slice(&[1.0, x, x * x]);
                terms
            }
            (Driver::Rotation(middle), Driver::Rotation(q)) => {
                let between = middle.conjugate() * q;
                let between = if between.w < 0.0 { -between } else { between };
                let [x, y, z] = between.log().to_array();
                [1.0, x, y, z, x * x, y * y, z * z, x * y, x * z, y * z]
            }
            _ => [0.0; MOST],
        }
    }
}

/// The polynomial at each sample, or the two of a hinge's bounds.
#[derive(Clone, Debug)]
enum Moving {
    Samples(Vec<Terms>),
    Bounds([Terms; 2]),
}

/// A trend, and the terms at each sample.
#[derive(Clone, Debug)]
pub(super) struct Trend {
    features: Features,
    at: Vec<Terms>,
    moving: Moving,
}

fn sum(one: &Terms, other: &Terms) -> f64 {
    one.iter().zip(other).map(|(a, b)| a * b).sum()
}

impl Trend {
    /// The trend of all samples; `None` where there are too few values of the driver to tell.
    pub(super) fn new(question: &Question<'_>) -> Option<Self> {
        let Question { ground, dependence, hinge, .. } = question;
        let (drivers, settings) = (&dependence.drivers, &dependence.settings);
        let features = Features::of(drivers)?;
        let all: Vec<usize> = (0..ground.samples.len()).collect();
        let (cells, counts) = cells(drivers, settings.step, settings.few, &all, false);
        let ends = matches!(drivers, Drivers::Scalars(_));
        let used: Vec<(Driver, f64)> = (0..cells.len())
            .filter(|cell| !ends || (*cell > 0 && cell + 1 < cells.len()))
            .filter_map(|cell| Some((cells.value(cell)?, f64::from(*counts.get(cell)?))))
            .collect();
        if used.len() < features.count + 2 {
            return None;
        }
        let solved = solved(&features, &used)?;
        let drive = |sample: usize| drivers.get(sample);
        let at: Vec<Terms> =
            all.iter().filter_map(|s| drive(*s)).map(|driver| features.terms(driver)).collect();
        let retreats = |value: Driver| -> Vec<f64> {
            all.iter()
                .map(|s| settings.slope * drive(*s).map_or(f64::INFINITY, |d| d.distance(value)))
                .collect()
        };
        if let Some(hinge) = hinge {
            let angles: Vec<f64> = ground.samples.iter().map(|q| angle(*q, *hinge)).collect();
            let mut bounds = [[0.0; MOST]; 2];
            for ((value, _), weights) in used.iter().zip(&solved) {
                let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
                for (angle, retreat) in angles.iter().zip(retreats(*value)) {
                    (low, high) = (low.min(angle + retreat), high.max(angle - retreat));
                }
                for (term, weight) in weights.iter().enumerate() {
                    bounds[0][term] += weight * low;
                    bounds[1][term] += weight * high;
                }
            }
            return Some(Self { features, at, moving: Moving::Bounds(bounds) });
        }
        let lattice = Lattice::new(NODES);
        let rotations = lattice.nodes();
        let nodes = Nodes::new(&lattice, &rotations);
        let inward: Vec<Quat> = ground.samples.iter().map(|q| ground.chart.inward(*q)).collect();
        let ball = radius(ground, dependence, 1.0);
        let mut corners = vec![[0.0; MOST]; inward.len()];
        for ((value, _), weights) in used.iter().zip(&solved) {
            let field = slice::slice(&nodes, &inward, &retreats(*value), ball);
            for (q, terms) in inward.iter().zip(&mut corners) {
                let about = lattice.corners(*q);
                let here =
                    about.iter().filter_map(|node| field.get(*node)).filter(|d| d.is_finite());
                let (mut total, mut count) = (0.0, 0.0f64);
                here.for_each(|d| (total, count) = (total + f64::from(*d), count + 1.0));
                for (term, weight) in terms.iter_mut().zip(weights) {
                    *term += weight * total / count.max(1.0);
                }
            }
        }
        Some(Self { features, at, moving: Moving::Samples(corners) })
    }

    /// How much farther out the boundary about a sample is at a value of the driver than at its own, held within `most`.
    pub(super) fn moved(&self, sample: usize, value: Driver, most: f64) -> f64 {
        let Moving::Samples(terms) = &self.moving else { return 0.0 };
        let (Some(terms), Some(own)) = (terms.get(sample), self.at.get(sample)) else { return 0.0 };
        let moved = sum(terms, &self.features.terms(value)) - sum(terms, own);
        moved.clamp(-most, most)
    }

    /// By how much the bounds of a hinge are higher at a value of the driver than at that of a sample, held within `most`.
    pub(super) fn higher(&self, sample: usize, value: Driver, most: f64) -> [f64; 2] {
        let Moving::Bounds(bounds) = &self.moving else { return [0.0; 2] };
        let Some(own) = self.at.get(sample) else { return [0.0; 2] };
        let there = self.features.terms(value);
        bounds.map(|terms| (sum(&terms, &there) - sum(&terms, own)).clamp(-most, most))
    }
}

/// For each value of the driver how much a number there counts in each coefficient of the polynomial, by weighted least squares.
fn solved(features: &Features, used: &[(Driver, f64)]) -> Option<Vec<Terms>> {
    let count = features.count;
    let terms: Vec<Terms> = used.iter().map(|(value, _)| features.terms(*value)).collect();
    let mut normal = [[0.0; MOST]; MOST];
    for (terms, (_, weight)) in terms.iter().zip(used) {
        for i in 0..count {
            for j in 0..count {
                normal[i][j] += weight * terms[i] * terms[j];
            }
        }
    }
    // A little toward 0, where samples tell nothing of a term.
    let size = (0..count).map(|i| normal[i][i]).fold(0.0, f64::max);
    for (i, row) in normal.iter_mut().enumerate() {
        row[i] += if i < count { 1e-3 * size } else { 1.0 };
    }
    normal[0][0] -= 0.999e-3 * size;
    let inverse = inverse(normal)?;
    let weighted = terms.iter().zip(used).map(|(terms, (_, weight))| {
        let mut row = [0.0; MOST];
        for (i, value) in row.iter_mut().enumerate().take(count) {
            *value = weight * sum(&inverse[i], terms);
        }
        row
    });
    Some(weighted.collect())
}

/// By Gauss and Jordan; of a positive definite matrix no pivot has to be sought.
fn inverse(mut a: [[f64; MOST]; MOST]) -> Option<[[f64; MOST]; MOST]> {
    let mut b = [[0.0; MOST]; MOST];
    for (i, row) in b.iter_mut().enumerate() {
        row[i] = 1.0;
    }
    for i in 0..MOST {
        let pivot = a[i][i];
        if !(pivot.abs() > 1e-12 && pivot.is_finite()) {
            return None;
        }
        for k in 0..MOST {
            a[i][k] /= pivot;
            b[i][k] /= pivot;
        }
        for j in 0..MOST {
            if j == i {
                continue;
            }
            let factor = a[j][i];
            for k in 0..MOST {
                a[j][k] -= factor * a[i][k];
                b[j][k] -= factor * b[i][k];
            }
        }
    }
    Some(b)
}
