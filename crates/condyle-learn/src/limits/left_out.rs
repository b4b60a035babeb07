//! How far the limit goes beyond the data, and where data are missed, judged by takes that were left out.
//!
//! Frames of a recording lie along curves: the nearest other sample is the frame before, and tells nothing about
//! how well the whole is known. So whole takes (or, of few takes, blocks of time) are left out in turn, and the
//! closing C of the others is asked about them. With p the share of left-out rotations outside C, V and S the
//! volume and the surface of C of all takes, the layer about C has the thickness
//!
//! ```text
//! gap = p V / S
//! ```
//!
//! as if p of the volume were missed all around; for independent samples it is what leaving single samples out
//! gives. It is no thicker than what holds 95 % of the left-out
//! rotations, at least the spacing to which frames were thinned, so that frames between samples are inside, and at
//! least so thick that half of the left-out rotations are: of turns about one or two axes V is 0. What lies farther from all samples than 95 % of the left-out rotations inside C did is a hole.

use super::{Cloud, Settings, learn};
use condyle_diagnostics::Error;
use condyle_math::Quat;

/// Parts that are left out in turn, unless there are as many takes.
const PARTS: usize = 8;
/// No more than this, whatever the number of takes.
const MOST: usize = 12;
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
    /// The thickness of the layer that follows, in radians.
    pub gap: f64,
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
    let volume = learned.outer * 8.0 * std::f64::consts::PI.powi(2);
    let gap = if learned.surface > 0.0 { outside * volume / learned.surface } else { 0.0 };
    // Distances rise, so that half of them are at least the middle one.
    let half = -percentile(&distances, 0.5);
    // Who moves along the boundary shows more of it than of the inside: p is then no share of a volume, and the layer no
    // thicker than what holds nearly all.
    let gap = gap.min(-percentile(&distances, 0.05)).max(half).max(spacing);
    let [size, _] = settings.hole.or(Settings::default().hole).unwrap_or([2.5, 2.0]);
    Ok(LeftOut {
        parts: parts.len(),
        whole_takes,
        asked: distances.len(),
        outside,
        hole: percentile(&nearest, 0.95).max(size * learned.spacing),
        spacing: learned.spacing,
        distances,
        nearest,
        gap: gap.min(0.35),
    })
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
