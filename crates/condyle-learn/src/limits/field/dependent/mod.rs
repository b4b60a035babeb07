//! Limits that depend on another joint: the closing of a cloud at values of the driver.
//!
//! ```text
//! pairs of driver and rotation -> Pairs      pairs      thinned together
//!                              -> cells      here       values of the driver, hinge or field
//!                              -> fields     slice      the closing at one value, by balls that shrink
//! parts left out               -> layer      layer      how far the limit goes beyond them
//!              -> trend      trend      how boundaries move with the driver on the whole, taken away first
//! ```
//!
//! A boundary is taken to move by at most `slope` radians per unit of the driver. So a sample that was taken at another value counts
//! as a place inside that is slope·(difference) farther away: the empty balls at a value of the driver, whose radius is the least of (angle +
//! slope·difference) over all samples, are slices of balls in driver and rotation together. Where the boundary moves no
//! faster than that, samples of a whole range of the driver settle it, and none widens it.

mod layer;
mod limit;
mod pairs;
mod slice;
mod trend;

pub use condyle_model::limit::field::dependent::{
    Dependence, DependenceKnown, DependenceSettings, Dependent, Driver, Drivers, Given,
    GivenAnswer, Sloped,
};
pub use layer::layer;
pub use limit::{Asked, limit};
pub use pairs::Pairs;

use super::super::cloud::typical_spacing;
use super::even::evened;
use super::layer::{filled, volume};
use super::nearest::Nodes;
use condyle_math::{Quat, Vec3};
use condyle_model::limit::field::dependent::{Cells, Child};
use condyle_model::limit::field::{Ground, Lattice};
use std::f64::consts::PI;
use trend::{BESIDE, Trend};

/// A child whose rotations are off one axis by less than this, in radians (root mean square), is a hinge: half a degree.
const HINGE: f64 = 0.5 * PI / 180.0;

/// The most values of a coordinate, and rotations of a driver with a field and with an angle each.
const MOST: [usize; 3] = [48, 160, 2000];

/// Makes what depends on a driver again, with the radius and the layer that were found.
#[must_use]
pub fn made(ground: &Ground, dependence: &Dependence) -> Dependent {
    let known = dependence.known.unwrap_or_else(|| DependenceKnown {
        radius: radius(ground, dependence, BESIDE),
        gap: dependence.settings.gap.unwrap_or(0.0),
    });
    let everything: Vec<usize> = (0..ground.samples.len()).collect();
    let bare = bare(&Question::new(ground, dependence, known.radius), &everything);
    finished(ground, bare, known)
}

/// What is asked, and of what.
struct Question<'a> {
    ground: &'a Ground,
    dependence: &'a Dependence,
    radius: f64,
    hinge: Option<(Quat, Vec3)>,
    trend: Option<Trend>,
    lattice: Lattice,
    rotations: Vec<Option<Quat>>,
}

/// What is known of the child without its layer.
enum Bare {
    Fields(Vec<Vec<f32>>),
    Bounds { middle: Quat, axis: Vec3, bounds: Vec<[f64; 2]>, whole: [f64; 2] },
}

struct Found {
    cells: Cells,
    counts: Vec<u32>,
    bare: Bare,
    lattice: Lattice,
}

impl<'a> Question<'a> {
    fn new(ground: &'a Ground, dependence: &'a Dependence, radius: f64) -> Self {
        let lattice = Lattice::new(dependence.settings.nodes.clamp(24, 128));
        let rotations = lattice.nodes();
        let hinge = hinge(ground);
        let question = Self { ground, dependence, radius, hinge, trend: None, lattice, rotations };
        Self { trend: Trend::new(&question), ..question }
    }
}

/// The middle and the axis of a child that turns about one axis.
fn hinge(ground: &Ground) -> Option<(Quat, Vec3)> {
    let [left, right] = ground.chart.sides();
    let (middle, axis) = ((right * left).conjugate().normalized(), right.to_mat3() * Vec3::X);
    let squares: f64 = ground
        .samples
        .iter()
        .map(|q| {
            let r = middle.conjugate() * *q;
            let along = r.vector().dot(axis);
            let across = (r.vector() - axis * along).norm();
            (2.0 * across.atan2((along * along + r.w * r.w).sqrt())).powi(2)
        })
        .sum();
    let off = (squares / ground.samples.len().max(1) as f64).sqrt();
    (off < HINGE).then_some((middle, axis))
}

fn angle(q: Quat, (middle, axis): (Quat, Vec3)) -> f64 {
    let r = middle.conjugate() * q;
    let r = if r.w < 0.0 { -r } else { r };
    2.0 * r.vector().dot(axis).atan2(r.w)
}

/// The radius of empty balls: five times the distance, in rotation and driver together, at which samples are apart.
/// `part` is that of the slope by which samples retreat.
fn radius(ground: &Ground, dependence: &Dependence, part: f64) -> f64 {
    const NEIGHBOURS: usize = 8;
    let count = ground.samples.len();
    let mut far: Vec<f64> = (0..count)
        .step_by(count.div_ceil(150).max(1))
        .map(|at| {
            let mut distances: Vec<f64> =
                (0..count).map(|other| apart(ground, dependence, part, at, other)).collect();
            let place = NEIGHBOURS.min(count - 1);
            *distances.select_nth_unstable_by(place, f64::total_cmp).1
        })
        .collect();
    far.sort_by(f64::total_cmp);
    let middle = far.get(far.len() / 2).copied().unwrap_or(0.0);
    // As if they were spread in space: eight in a ball of that radius.
    let spacing = middle * (4.0 / 3.0 * PI / NEIGHBOURS as f64).cbrt();
    let spacing = spacing.max(typical_spacing(&ground.samples).min(1.0));
    let [least, most] = ground.settings.radius;
    (5.0 * spacing).clamp(least, most)
}

fn apart(ground: &Ground, dependence: &Dependence, part: f64, one: usize, other: usize) -> f64 {
    let (Some(p), Some(q)) = (ground.samples.get(one), ground.samples.get(other)) else {
        return f64::INFINITY;
    };
    let drivers = &dependence.drivers;
    let far =
        drivers.get(one).zip(drivers.get(other)).map_or(f64::INFINITY, |(a, b)| a.distance(b));
    p.angle_to(*q) + part * dependence.settings.slope * far
}

/// Values of the driver that cover those of some samples, and how many samples are within a step of each.
fn cells(drivers: &Drivers, step: f64, few: u32, of: &[usize], hinge: bool) -> (Cells, Vec<u32>) {
    match drivers {
        Drivers::Scalars(values) => {
            let values = || of.iter().filter_map(|at| values.get(*at).copied());
            let low = values().fold(f64::INFINITY, f64::min);
            let high = values().fold(f64::NEG_INFINITY, f64::max);
            let span = (high - low).max(0.0);
            let count = ((span / step.max(1e-9)).ceil()).clamp(1.0, MOST[0] as f64) as usize + 1;
            let step = if span > 0.0 { span / (count - 1) as f64 } else { step };
            // One before and one behind, where what the nearest two say goes on.
            let first = low - step;
            let mut counts = vec![0u32; count + 2];
            for value in values() {
                let at = (value - first) / step;
                for (cell, count) in counts.iter_mut().enumerate() {
                    *count += u32::from((at - cell as f64).abs() <= 1.0);
                }
            }
            let inner = |cell: usize| cell >= 1 && cell <= count;
            let mut known: Vec<bool> = (0..count + 2)
                .map(|cell| inner(cell) && counts.get(cell).is_some_and(|n| *n >= few))
                .collect();
            for (end, next) in [(0, 1), (count + 1, count)] {
                known[end] = known.get(next) == Some(&true);
            }
            (Cells::Knots { first, step, known }, counts)
        }
        Drivers::Rotations(values) => {
            // Bounds of a hinge are two numbers: they are told at more values, each by what is within the same step.
            let edge = (0.5 * step).cos();
            let step = if hinge { 0.4 * step } else { step };
            let most = MOST[if hinge { 2 } else { 1 }];
            let mut centres: Vec<Quat> = vec![];
            let all: Vec<Quat> = of.iter().filter_map(|at| values.get(*at).copied()).collect();
            let near = (0.5 * step).cos();
            for q in &all {
                if centres.len() < most && centres.iter().all(|c| c.dot(*q).abs() < near) {
                    centres.push(*q);
                }
            }
            let counts: Vec<u32> = centres
                .iter()
                .map(|c| all.iter().filter(|q| c.dot(**q).abs() >= edge).count() as u32)
                .collect();
            let enough = |n: &u32| *n >= few;
            let kept = centres.iter().zip(&counts).filter(|(_, n)| enough(n)).map(|(c, _)| *c);
            let kept: Vec<Quat> = kept.collect();
            (Cells::rotations(kept, step), counts.iter().copied().filter(|n| enough(n)).collect())
        }
    }
}

/// What some samples say without a layer.
fn bare(question: &Question<'_>, of: &[usize]) -> Found {
    let Question { ground, dependence, radius, hinge, trend, lattice, rotations } = question;
    let settings = &dependence.settings;
    let (cells, counts) =
        cells(&dependence.drivers, settings.step, settings.few, of, hinge.is_some());
    let retreats = |at: Driver| -> Vec<f64> {
        let drivers = &dependence.drivers;
        let far = |sample: &usize| drivers.get(*sample).map_or(f64::INFINITY, |d| d.distance(at));
        let retreat = |sample: &usize| {
            let most = settings.slope * far(sample);
            match trend {
                Some(trend) => BESIDE * most - trend.moved(*sample, at, most),
                None => most,
            }
        };
        of.iter().map(retreat).collect()
    };
    let samples: Vec<Quat> = of.iter().filter_map(|at| ground.samples.get(*at).copied()).collect();
    let bare = if let Some(hinge) = hinge {
        let angles: Vec<f64> = samples.iter().map(|q| angle(*q, *hinge)).collect();
        let drives: Vec<Option<Driver>> = of.iter().map(|s| dependence.drivers.get(*s)).collect();
        let ends = |at: Option<Driver>| {
            let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
            for ((angle, sample), own) in angles.iter().zip(of).zip(&drives) {
                let most = at.zip(*own).map_or(0.0, |(at, own)| settings.slope * own.distance(at));
                let (retreat, [below, above]) = match trend.as_ref().zip(at) {
                    Some((trend, at)) => (BESIDE * most, trend.higher(*sample, at, most)),
                    None => (most, [0.0; 2]),
                };
                low = low.min(angle + below + retreat);
                high = high.max(angle + above - retreat);
            }
            if low <= high { [low, high] } else { [0.5 * (low + high); 2] }
        };
        let whole = ends(None);
        let bounds = (0..cells.len()).map(|cell| match cells.value(cell) {
            Some(at) => ends(Some(at)),
            None => whole,
        });
        let bounds = bounds.collect();
        Bare::Bounds { middle: hinge.0, axis: hinge.1, bounds, whole }
    } else {
        let nodes = Nodes::new(lattice, rotations);
        let inward: Vec<Quat> = samples.iter().map(|q| ground.chart.inward(*q)).collect();
        let fields = (0..cells.len()).map(|cell| match cells.value(cell) {
            Some(at) => slice::slice(&nodes, &inward, &retreats(at), *radius),
            None => vec![],
        });
        Bare::Fields(fields.collect())
    };
    let mut found = Found { cells, counts, bare, lattice: lattice.clone() };
    found.go_on_at_the_ends();
    found
}

impl Found {
    /// Before the first and behind the last value of a coordinate, what the nearest two say goes on.
    fn go_on_at_the_ends(&mut self) {
        let Cells::Knots { known, .. } = &self.cells else { return };
        let last = known.len() - 1;
        for (end, one, two) in [(0, 1, 2), (last, last - 1, last - 2)] {
            let both = known.get(one) == Some(&true);
            let two = if known.get(two) == Some(&true) && two != end { two } else { one };
            if !both {
                continue;
            }
            match &mut self.bare {
                Bare::Fields(fields) => {
                    let on = fields[one].iter().zip(&fields[two]).map(|(a, b)| 2.0 * a - b);
                    fields[end] = on.collect();
                }
                Bare::Bounds { bounds, .. } => {
                    let (a, b) = (bounds[one], bounds[two]);
                    bounds[end] = [2.0 * a[0] - b[0], 2.0 * a[1] - b[1]];
                }
            }
        }
    }
}

/// With its layer, evened out, as a spline.
fn finished(ground: &Ground, found: Found, known: DependenceKnown) -> Dependent {
    let Found { cells, counts, bare, lattice } = found;
    let mut shares = vec![];
    let child = match bare {
        Bare::Bounds { middle, axis, bounds, whole } => {
            let wider = |[low, high]: [f64; 2]| [low - known.gap, high + known.gap];
            let bounds: Vec<[f64; 2]> = bounds.into_iter().map(wider).collect();
            shares.extend(bounds.iter().map(|[low, high]| (high - low) / (2.0 * PI)));
            Child::Hinge { middle, axis, bounds, whole: wider(whole) }
        }
        Bare::Fields(fields) => {
            let rotations = lattice.nodes();
            let nodes = Nodes::new(&lattice, &rotations);
            let splines = fields.into_iter().map(|mut field| {
                if field.is_empty() {
                    shares.push(0.0);
                    return field;
                }
                field.iter_mut().for_each(|d| *d += known.gap as f32);
                let mut even = evened(&nodes, &field, known.radius / 5.0);
                filled(&nodes, &mut even, volume(&nodes, &field));
                shares.push(volume(&nodes, &even) / (8.0 * PI * PI));
                lattice.coefficients(&even)
            });
            let splines = splines.collect();
            Child::Field { chart: ground.chart, lattice: lattice.clone(), splines }
        }
    };
    Dependent { cells, counts, child, shares, known }
}

/// Whether the rotations of a limit are turns about one axis, so that bounds of an angle are learned.
#[must_use]
pub fn is_hinge(ground: &Ground) -> bool {
    hinge(ground).is_some()
}
