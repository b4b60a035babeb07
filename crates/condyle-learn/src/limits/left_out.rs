//! How far the limit goes beyond the data, and where data are missed, judged by takes that were left out.
//!
//! Frames of a recording lie along curves: the nearest other sample is the frame before, and tells nothing about
//! how well the whole is known. So whole takes (or, of few takes, blocks of time) are left out in turn, and the
//! closing C of the others is asked about them. The limit goes as far beyond C as it takes to hold 95 of 100
//! rotations of what was left out: that is what the next recording may be expected to show.
//!
//! Of turns that no other take comes near that would be half of all rotations; so it is at most 15 degrees, and what is 20 degrees from
//! every sample stays outside. It is at least the spacing to which frames were thinned, so that frames between samples are inside.
//!
//! The share that misses of the volume, p V / S as for independent samples, is a third to a half of that: it holds what these takes
//! show all over again, but of another person half and less.
//!
//! What lies farther from all samples than 95 % of the left-out rotations inside C did is a hole.

use super::{Cloud, Settings, learn};
use condyle_diagnostics::Error;
use condyle_math::Quat;
use std::f64::consts::PI;

/// Parts that are left out in turn, unless there are as many takes.
const PARTS: usize = 8;
/// No more than this, whatever the number of takes.
const MOST: usize = 12;
/// The share of left-out rotations that a limit holds, unless another is asked for.
pub const COVER: f64 = 0.95;
/// The most that a limit goes beyond recordings: 15 degrees.
const FARTHEST: f64 = PI / 12.0;
/// Nodes of the fields of parts: neighbours are 5.6 degrees apart.
const NODES: usize = 64;

/// What takes tell that were left out.
#[derive(Clone, Debug, PartialEq)]
pub struct LeftOut {
    /// How many parts were left out, one after another.
    pub parts: usize,
    /// Whether the parts are whole takes; otherwise they are blocks of time.
    pub whole_takes: bool,
    /// How many rotations were asked about, thinned within their parts.
    pub asked: usize,
    /// The share of them outside the closing of the others.
    pub outside: f64,
    /// The angle from each to the closing of the others, in radians, positive inside, rising.
    pub distances: Vec<f64>,
    /// The angle to the nearest sample of the others of those that are inside, in radians, rising.
    pub nearest: Vec<f64>,
    /// How far the limit goes beyond the closing, in radians: [`LeftOut::reaching`] 95 %.
    pub gap: f64,
    /// It goes at least so far, in radians: what samples are apart.
    pub least: f64,
    /// (volume / number)^(1/3) of all samples, in radians.
    pub spacing: f64,
    /// From what distance to the nearest sample on a place inside is a hole, in radians.
    pub hole: f64,
}

/// Whether the rotations of a take are independent of each other: those that follow each other are not nearer than
/// any two.
///
/// ```
/// use condyle_learn::limits::independent;
/// use condyle_math::{Quat, Vec3};
/// let curve: Vec<Quat> =
///     (0..200).map(|i| Quat::from_axis_angle(Vec3::X, 0.01 * f64::from(i))).collect();
/// assert!(!independent(&curve));
/// // The same in another order: every 83rd, around and around.
/// let mixed: Vec<Quat> = (0..200).map(|i| curve[i * 83 % 200]).collect();
/// assert!(independent(&mixed));
/// ```
#[must_use]
pub fn independent(take: &[Quat]) -> bool {
    let usable: Vec<Quat> = take.iter().copied().filter(|q| q.dot(*q) > 1e-12).collect();
    let count = usable.len();
    if count < 8 {
        return false;
    }
    let step = (count / 200).max(1);
    let apart = |by: usize| {
        let angles = (0..count).step_by(step).map(|i| {
            // Beyond the end it goes on at the start, which is no neighbour in time.
            usable[i].normalized().angle_to(usable[(i + by) % count].normalized())
        });
        let mut angles: Vec<f64> = angles.collect();
        angles.sort_by(f64::total_cmp);
        angles[angles.len() / 2]
    };
    apart(1) > 0.5 * apart(count / 2).max(apart(count / 3))
}

/// Asks about each part what the others know.
///
/// `spacing` is that of the clouds, in radians.
///
/// # Errors
/// Those of [`Cloud::gather`] and [`learn`].
pub fn left_out(takes: &[&[Quat]], spacing: f64, settings: &Settings) -> Result<LeftOut, Error> {
    let (parts, whole_takes) = parts(takes);
    let bare =
        Settings { nodes: settings.nodes.min(NODES), gap: Some(0.0), hole: None, ..*settings };
    let (mut distances, mut nearest) = (vec![], vec![]);
    for (number, own) in parts.iter().enumerate() {
        let others: Vec<&[Quat]> = parts
            .iter()
            .enumerate()
            .filter(|(other, _)| *other != number)
            .flat_map(|(_, pieces)| pieces.iter().copied())
            .collect();
        let (Ok(cloud), Ok(asked)) = (Cloud::gather(&others, spacing), Cloud::gather(own, spacing))
        else {
            continue;
        };
        let field = learn(&cloud, &bare)?;
        for q in asked.rotations() {
            let distance = field.distance(*q);
            distances.push(distance);
            if distance >= 0.0 {
                nearest.push(field.evidence(*q).angle);
            }
        }
    }
    distances.sort_by(f64::total_cmp);
    nearest.sort_by(f64::total_cmp);
    let whole = learn(&Cloud::gather(takes, spacing)?, &bare)?;
    let learned = whole.learned();
    let outside = distances.iter().filter(|d| **d < 0.0).count() as f64;
    let outside = outside / distances.len().max(1) as f64;
    let [size, _] = settings.hole.or(Settings::default().hole).unwrap_or([2.5, 2.0]);
    let mut left = LeftOut {
        parts: parts.len(),
        whole_takes,
        asked: distances.len(),
        outside,
        hole: percentile(&nearest, 0.95).max(size * learned.spacing),
        spacing: learned.spacing,
        distances,
        nearest,
        least: spacing,
        gap: 0.0,
    };
    left.gap = left.reaching(COVER);
    Ok(left)
}

impl LeftOut {
    /// The settings with which a limit is learned from all takes; a layer that is given stays.
    #[must_use]
    pub fn settings(&self, settings: &Settings) -> Settings {
        let hole = settings.hole.map(|[size, depth]| {
            let wider = (self.hole / self.spacing.max(1e-4)).max(size);
            [wider, depth.max(depth / size * wider)]
        });
        Settings { gap: Some(settings.gap.unwrap_or(self.gap)), hole, ..*settings }
    }

    /// How far a limit must go beyond the closing to hold a share of left-out rotations, in radians: not less than samples are
    /// apart, and at most 15 degrees.
    #[must_use]
    pub fn reaching(&self, share: f64) -> f64 {
        // Distances rise, so that this share of them is at least what is at the rest.
        let beyond = -percentile(&self.distances, 1.0 - share.clamp(0.0, 1.0));
        beyond.clamp(self.least.min(FARTHEST), FARTHEST)
    }

    /// The share of left-out rotations that a closing holds with a layer of a thickness in radians.
    #[must_use]
    pub fn held(&self, gap: f64) -> f64 {
        let held = self.distances.iter().filter(|d| **d >= -gap).count();
        held as f64 / self.distances.len().max(1) as f64
    }
}

/// A value below which a share of rising values lies; 0 without any.
#[must_use]
pub fn percentile(rising: &[f64], share: f64) -> f64 {
    let last = rising.len().saturating_sub(1);
    rising.get((share * last as f64).round() as usize).copied().unwrap_or(0.0)
}

/// The parts that are left out, each of pieces of takes, and whether they are whole takes.
fn parts<'t>(takes: &[&'t [Quat]]) -> (Vec<Vec<&'t [Quat]>>, bool) {
    let takes: Vec<&[Quat]> = takes.iter().copied().filter(|take| !take.is_empty()).collect();
    if takes.len() >= 4 {
        let mut parts = vec![vec![]; takes.len().min(MOST)];
        for (index, take) in takes.iter().enumerate() {
            parts[index % takes.len().min(MOST)].push(*take);
        }
        return (parts, true);
    }
    let blocks = PARTS.div_ceil(takes.len().max(1));
    let blocks = takes
        .iter()
        .flat_map(|take| take.chunks(take.len().div_ceil(blocks).max(1)).map(|block| vec![block]));
    (blocks.collect(), false)
}
