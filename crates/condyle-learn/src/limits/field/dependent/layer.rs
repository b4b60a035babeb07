//! How far a limit that depends on a driver goes beyond its samples, from parts of them that are left out.
//!
//! With p the share of left-out samples that are outside what the others say, the layer has the thickness that makes the volume
//! V/(1 - p), V the mean over the values of the driver, each weighted by its samples. Frames of recordings are no independent
//! samples: then it is no thicker than what holds 95 % of the left-out ones, and at least what holds half of them.

use super::super::super::percentile;
use super::super::layer::volume;
use super::super::nearest::Nodes;
use super::trend::BESIDE;
use super::{Bare, Found, Question, bare, finished, radius};
use condyle_model::limit::field::Ground;
use condyle_model::limit::field::dependent::{
    Cells, Dependence, DependenceKnown, DependenceSettings,
};

/// Nodes along an edge of the maps of parts.
const NODES: usize = 36;

/// Radius and thickness of the layer, and the distances of left-out samples to what the others say, in radians, rising.
///
/// `parts` is the part of each sample, counted from 0; of recordings (`curves`) `least` is the spacing to which they were thinned.
#[must_use]
pub fn layer(
    ground: &Ground,
    dependence: &Dependence,
    parts: &[usize],
    curves: bool,
    least: f64,
) -> (DependenceKnown, Vec<f64>) {
    let radius = radius(ground, dependence, BESIDE);
    // Distances to a tenth of a degree are not needed here.
    let coarse =
        DependenceSettings { nodes: dependence.settings.nodes.min(NODES), ..dependence.settings };
    let coarse = Dependence { settings: coarse, ..dependence.clone() };
    let question = Question::new(ground, &coarse, radius);
    let number = parts.iter().max().map_or(0, |last| last + 1);
    let unmoved = DependenceKnown { radius, gap: 0.0 };
    let mut distances = vec![];
    for part in 0..number {
        let (mut others, mut asked) = (vec![], vec![]);
        for (sample, own) in parts.iter().enumerate() {
            if *own == part { asked.push(sample) } else { others.push(sample) }
        }
        if others.is_empty() || asked.is_empty() {
            continue;
        }
        let without = finished(ground, bare(&question, &others), unmoved);
        let distance = |sample: &usize| {
            let (q, driver) = (ground.samples.get(*sample)?, dependence.drivers.get(*sample)?);
            without.distance_of_cells(*q, driver)
        };
        distances.extend(asked.iter().filter_map(distance));
    }
    distances.sort_by(f64::total_cmp);
    let outside = distances.iter().filter(|d| **d < 0.0).count() as f64;
    // Fewer samples miss more: with one part of n left out, by about (n/(n - 1))^0.4.
    let fewer = ((number.max(2) - 1) as f64 / number.max(2) as f64).powf(0.4);
    let missing = (fewer * outside / distances.len().max(1) as f64).min(0.5);
    let everything: Vec<usize> = (0..ground.samples.len()).collect();
    let found = bare(&question, &everything);
    let mut gap = thickness(&question, &found, missing, 0.35);
    if curves {
        let most = -percentile(&distances, 0.05);
        let half = -percentile(&distances, 0.5);
        gap = gap.min(most).max(half).max(least).min(0.35);
    }
    let gap = dependence.settings.gap.unwrap_or(gap);
    (DependenceKnown { radius, gap }, distances)
}

/// The layer with which the mean volume is what is there over 1 - `missing`.
fn thickness(question: &Question<'_>, found: &Found, missing: f64, most: f64) -> f64 {
    let weights = || {
        (0..found.cells.len()).map(|cell| {
            let known = found.cells.value(cell).is_some() && !end(&found.cells, cell);
            f64::from(if known { found.counts.get(cell).copied().unwrap_or(0) } else { 0 })
        })
    };
    let with = |gap: f64| -> f64 {
        match &found.bare {
            Bare::Bounds { bounds, .. } => weights()
                .zip(bounds)
                .map(|(weight, [low, high])| weight * (high - low + 2.0 * gap))
                .sum(),
            Bare::Fields(fields) => {
                let nodes = Nodes::new(&question.lattice, &question.rotations);
                let grown = |field: &Vec<f32>| -> Vec<f32> {
                    field.iter().map(|d| d + gap as f32).collect()
                };
                weights()
                    .zip(fields)
                    .filter(|(weight, _)| *weight > 0.0)
                    .map(|(weight, field)| weight * volume(&nodes, &grown(field)))
                    .sum()
            }
        }
    };
    let target = with(0.0) / (1.0 - missing);
    let (mut low, mut high) = (0.0, most);
    // To 2⁻¹⁰ of the most: 0.02 degrees.
    for _ in 0..10 {
        let middle = 0.5 * (low + high);
        if with(middle) < target { low = middle } else { high = middle }
    }
    0.5 * (low + high)
}

/// Whether a value only goes on with what others say.
fn end(cells: &Cells, cell: usize) -> bool {
    matches!(cells, Cells::Knots { .. }) && (cell == 0 || cell + 1 == cells.len())
}
