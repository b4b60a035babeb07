//! From a cloud to signed distances at nodes: closing by empty balls, its offset, its holes.
//!
//! 1. d(x) is the angle to the nearest sample. Where d(x) ≥ R the ball about x of radius d(x) is empty; the closing
//!    C is what no empty ball covers, and g(q) = min over empty balls of (angle to the centre - radius) is
//!    the distance to its boundary from inside.
//! 2. The boundary of C goes through the outermost samples, so C is too small by a layer (`layer`), thicker where samples
//!    are sparser (`density`).
//! 3. Balls a third as large find less of a boundary's place, but get into creases: where both differ by more than chance, they count.
//! 4. The roughness by chance is evened out (`even`), and F(q) = max over x inside of (distance at x - angle to x).
//! 5. Where a layer is given, it is an offset: F is that of C, and the layer added.
//! 6. Empty balls of 2.5 spacings whose centres are more than 2 spacings inside are holes, each
//!    smaller by the gap that such a ball leaves.
//!
//! A spacing is (volume of C / N)^(1/3); R = 5 spacings, within 20 and 50 degrees; of samples of uneven density
//! the spacing about the sample that is nearest.

use super::super::cloud::{counts, typical_spacing};
use super::density;
use super::even::{evened, spread};
use super::layer::{extremes, filled, surface, thickness, unseen, volume};
use super::nearest::{Ball, Nearest, Nodes};
use condyle_math::Quat;
use condyle_model::limit::field::{Boundary, Ground, Lattice, Settings};

/// What was learned of a cloud, at the nodes and in sum.
#[derive(Clone, Debug)]
pub(super) struct Closing {
    /// The signed distance to the closing with its layer, in radians.
    pub(super) outer: Vec<f32>,
    /// The same with holes carved; `None` if there are none.
    pub(super) carved: Option<Vec<f32>>,
    /// Places on the boundary of what is valid.
    pub(super) boundary: Boundary,
    /// The sample that is nearest to each node.
    pub(super) samples: Vec<u32>,
    /// How many samples are within two spacings of each sample.
    pub(super) counts: Vec<u32>,
    pub(super) spacing: f64,
    pub(super) radius: f64,
    pub(super) gap: f64,
    pub(super) extreme: f64,
    pub(super) surface: f64,
    /// Volumes in rad³: of the closing without its layer, with it, and of holes.
    pub(super) volumes: [f64; 3],
    /// Centre, radius of the largest empty ball, volume in rad³.
    pub(super) holes: Vec<(Quat, f64, f64)>,
}

/// Balls that get into creases have so much of the radius of others, but at least 1.75 spacings.
const FINE: f64 = 0.35;
/// By so many spacings both closings differ by chance, and by so many surely not.
const CHANCE: [f64; 2] = [0.15, 0.4];

/// The least of R κ: the largest empty ball is a little larger than its hole.
const CONFORMING: f64 = 0.05;

/// A little more than every angle there is, for what has no boundary.
const EVERYWHERE: f32 = 4.0;

/// Learns from the samples of a ground. What is known already is not found anew.
pub(super) fn closing(ground: &Ground, lattice: &Lattice) -> Closing {
    let Ground { settings, chart, known, .. } = ground;
    let rotations = lattice.nodes();
    let nodes = Nodes::new(lattice, &rotations);
    let samples: Vec<Quat> = ground.samples.iter().map(|q| chart.inward(*q)).collect();
    let points: Vec<Ball> = samples.iter().map(|q| Ball::new(*q, 0.0)).collect();
    let near = nodes.nearest(&points, seeds(lattice, &samples));

    let mut spacing = typical_spacing(&samples);
    let [least, most] = settings.radius;
    let mut ball = (5.0 * spacing).clamp(least, most);
    if let Some(known) = known {
        (spacing, ball) = (known.spacing, known.radius);
    }
    let mut inner = inside(&nodes, &near, |_| ball);
    for _ in 0..if known.is_some() { 0 } else { 2 } {
        let volume = volume(&nodes, &inner);
        spacing = (volume / samples.len() as f64).cbrt().clamp(1e-4, 1.0);
        let better = (5.0 * spacing).clamp(least, most);
        if (better / ball - 1.0).abs() < 0.05 {
            break;
        }
        ball = better;
        inner = inside(&nodes, &near, |_| ball);
    }

    // Frames of recordings are dense where people were long; only the density of independent samples tells about gaps.
    let mut scales = None;
    for _ in 0..if settings.gap.is_none() { 2 } else { 0 } {
        // What is sparse is held better once its balls are larger.
        let Some(found) = density::scales(&nodes, &inner, &samples, spacing) else { break };
        let radius =
            |sample: u32| (5.0 * spacing * scale_of(Some(&found), sample)).clamp(least, most);
        inner = inside(&nodes, &near, radius);
        scales = Some(found);
    }
    let scale = |sample: u32| scale_of(scales.as_deref(), sample);
    let radius = |sample: u32| {
        if scales.is_some() { (5.0 * spacing * scale(sample)).clamp(least, most) } else { ball }
    };
    let bare = outward(&nodes, &inner, &samples, |_| 0.0);
    let (bare_volume, surface) = (volume(&nodes, &inner), surface(&nodes, &bare));
    let extremes = extremes(&nodes, &near, &points, radius);
    let extreme = unseen(&extremes);
    let counts = counts(&samples, 2.0 * spacing);
    // What balls leave before a flat boundary: π R h² is the volume of a sample.
    let local: Vec<f64> = (0u32..)
        .zip(&samples)
        .map(|(sample, _)| scale(sample).powf(1.5) * (ball / radius(sample)).sqrt())
        .collect();
    let gap = match known.map(|known| known.gap).or(settings.gap) {
        Some(gap) => gap,
        None if surface > 0.0 => {
            let missing = share_by_volume(&extremes, extreme, scale);
            thickness(&nodes, (bare_volume, &bare), &near, &local, missing, 1.5 * spacing)
        }
        None => 0.0,
    };
    let gap_at = |sample: u32| gap * local.get(sample as usize).copied().unwrap_or(1.0);
    let mut outer = bare;
    if settings.gap.is_some() {
        outer.iter_mut().for_each(|d| *d += gap as f32);
    } else if surface > 0.0 {
        let mut depth: Vec<f32> =
            inner.iter().zip(&near.ball).map(|(d, sample)| d + gap_at(*sample) as f32).collect();
        let finer = |sample: u32| {
            let chance = FINE * 5.0 * spacing * scale(sample);
            (FINE * radius(sample)).max(chance).min(radius(sample))
        };
        let mut fine = inside(&nodes, &near, finer);
        let extremes = self::extremes(&nodes, &near, &points, finer);
        let missing = share_by_volume(&extremes, unseen(&extremes), scale);
        let volume = volume(&nodes, &fine);
        let gap = thickness(&nodes, (volume, &fine), &near, &local, missing, 1.5 * spacing);
        for (fine, sample) in fine.iter_mut().zip(&near.ball) {
            *fine += (gap * local.get(*sample as usize).copied().unwrap_or(1.0)) as f32;
        }
        let layered: Vec<f32> =
            outer.iter().zip(&near.ball).map(|(d, sample)| d + gap_at(*sample) as f32).collect();
        let before = self::volume(&nodes, &depth);
        let spacing = spacing * mean_by_volume(scales.as_deref());
        creased(&nodes, &mut depth, &fine, spacing);
        let share = self::volume(&nodes, &depth) / before.max(1e-9);
        depth = evened(&nodes, &depth, spacing);
        outer = outward(&nodes, &depth, &samples, |sample| 0.5 * gap_at(sample));
        joined(&nodes, &mut outer, &depth);
        filled(&nodes, &mut outer, share * self::volume(&nodes, &layered));
    }
    let total = volume(&nodes, &outer);

    let spacing_at = |sample: u32| spacing * scale(sample).max(1.0);
    let holes = hollow(&nodes, &near, &inner, (settings, ball), spacing_at, gap_at);
    let (carved, hollow_volume, holes) = match holes {
        None => (None, 0.0, vec![]),
        Some((depth, holes)) => {
            let carved: Vec<f32> = outer.iter().zip(&depth).map(|(a, b)| a.min(*b)).collect();
            let left = volume(&nodes, &carved);
            (Some(carved), total - left, holes)
        }
    };
    let boundary = boundary(&nodes, carved.as_ref().unwrap_or(&outer));
    Closing {
        outer,
        carved,
        boundary,
        samples: near.ball,
        counts,
        spacing,
        radius: ball,
        gap,
        extreme,
        surface,
        volumes: [bare_volume, total, hollow_volume],
        holes,
    }
}

/// Places on the zero set of a distance, one on each edge between nodes that it cuts, and the nearest to each node.
fn boundary(nodes: &Nodes<'_>, distance: &[f32]) -> Boundary {
    let edge = nodes.lattice.edge;
    let mut places = vec![];
    for (node, q) in nodes.rotations.iter().enumerate() {
        let Some(q) = q else { continue };
        // What is beyond the half turns is there under the other sign.
        if q.w < -0.1 {
            continue;
        }
        for other in [node + 1, node + edge, node + edge * edge] {
            let Some(Some(p)) = nodes.rotations.get(other) else { continue };
            let (Some(a), Some(b)) = (distance.get(node), distance.get(other)) else { continue };
            if (*a >= 0.0) != (*b >= 0.0) {
                places.push(between(*q, *p, f64::from(a / (a - b))));
            }
        }
    }
    let balls: Vec<Ball> = places.iter().map(|q| Ball::new(*q, 0.0)).collect();
    let nearest = nodes.nearest(&balls, seeds(nodes.lattice, &places)).ball;
    Boundary::new(nodes.lattice, &places, &nearest)
}

/// A part of the way from one rotation to one close by.
pub(super) fn between(q: Quat, p: Quat, part: f64) -> Quat {
    let (q, p) = (q.to_array(), p.to_array());
    Quat::from(std::array::from_fn(|i| q[i] + part * (p[i] - q[i]))).normalized()
}

pub(super) fn seeds<'a>(
    lattice: &'a Lattice,
    at: &'a [Quat],
) -> impl Iterator<Item = (usize, u32)> + 'a {
    (0u32..).zip(at).flat_map(|(index, q)| lattice.around(*q).map(move |node| (node, index)))
}

/// Distances from inside to the closing by balls of at least the radius that there is about their nearest sample.
fn inside(nodes: &Nodes<'_>, near: &Nearest, radius: impl Fn(u32) -> f64) -> Vec<f32> {
    let (mut balls, mut at) = (vec![], vec![]);
    for (node, q) in nodes.rotations.iter().enumerate() {
        let (Some(q), value) = (q, near.value[node]) else { continue };
        if f64::from(value) >= radius(near.ball[node]) {
            at.push((node, balls.len() as u32));
            balls.push(Ball::new(*q, f64::from(value)));
        }
    }
    if balls.is_empty() {
        return nodes
            .rotations
            .iter()
            .map(|q| if q.is_some() { EVERYWHERE } else { f32::INFINITY })
            .collect();
    }
    nodes.nearest(&balls, at.into_iter()).value
}

/// The signed distance to all that is within C, whose depths are given, and within a gap of the samples.
fn outward(
    nodes: &Nodes<'_>,
    inner: &[f32],
    samples: &[Quat],
    gap: impl Fn(u32) -> f64,
) -> Vec<f32> {
    let (mut balls, mut at) = (vec![], vec![]);
    for (index, q) in (0u32..).zip(samples) {
        balls.push(Ball::new(*q, gap(index)));
    }
    at.extend(seeds(nodes.lattice, samples));
    for (node, q) in nodes.rotations.iter().enumerate() {
        let Some(q) = q else { continue };
        let depth = f64::from(inner[node]);
        if depth >= 0.0 {
            at.push((node, balls.len() as u32));
            balls.push(Ball::new(*q, depth));
        }
    }
    let mut value = nodes.nearest(&balls, at.into_iter()).value;
    for (value, q) in value.iter_mut().zip(nodes.rotations) {
        *value = if q.is_some() { -*value } else { f32::NAN };
    }
    value
}

/// The share of the volume that extreme samples stand for, of which there are `number` with those not found.
fn share_by_volume(extremes: &[u32], number: f64, scale: impl Fn(u32) -> f64) -> f64 {
    let (mut own, mut all, mut seen) = (0.0, 0.0, 0.0);
    for (sample, found) in (0u32..).zip(extremes) {
        let volume = scale(sample).powi(3);
        all += volume;
        if *found > 0 {
            own += volume;
            seen += 1.0;
        }
    }
    if seen > 0.0 { own / all * (number / seen) } else { 0.0 }
}

fn scale_of(scales: Option<&[f64]>, sample: u32) -> f64 {
    scales.and_then(|s| s.get(sample as usize)).copied().unwrap_or(1.0)
}

/// The mean scale over the volume.
fn mean_by_volume(scales: Option<&[f64]>) -> f64 {
    let sum = |power: i32| scales.iter().copied().flatten().map(|s| s.powi(power)).sum::<f64>();
    if scales.is_some() { sum(4) / sum(3) } else { 1.0 }
}

/// Lowers depths to those of a finer closing where these are less by more than chance.
fn creased(nodes: &Nodes<'_>, depth: &mut [f32], fine: &[f32], spacing: f64) {
    let far = (6.0 * spacing) as f32;
    let over: Vec<f32> =
        depth.iter().zip(fine).map(|(d, f)| if *d > -far { d - f } else { 0.0 }).collect();
    let over = spread(nodes.lattice, &over, spacing / nodes.lattice.angle());
    let [least, most] = CHANCE.map(|c| (c * spacing) as f32);
    for ((depth, fine), over) in depth.iter_mut().zip(fine).zip(over) {
        // What is empty deep inside is a hole, and told from a crease.
        let shallow = (4.0 - 2.0 * *depth / spacing as f32).clamp(0.0, 1.0);
        let sure = shallow * ((over - least) / (most - least)).clamp(0.0, 1.0);
        if sure > 0.0 {
            *depth += sure * (fine - *depth).min(0.0);
        }
    }
}

/// Near the boundary distances are those that were evened out: what is taken again from nodes inside is rounder at edges.
fn joined(nodes: &Nodes<'_>, outer: &mut [f32], depth: &[f32]) {
    let cell = nodes.lattice.angle() as f32;
    for (outer, depth) in outer.iter_mut().zip(depth) {
        let part = (depth.abs() / cell - 0.5).clamp(0.0, 1.0);
        if part < 1.0 {
            *outer = depth + (*outer - depth) * part;
        }
    }
}

/// Centre, radius of the largest empty ball, volume.
type Hole = (Quat, f64, f64);

/// The signed distance to holes, positive outside them, and the holes.
fn hollow(
    nodes: &Nodes<'_>,
    near: &Nearest,
    inner: &[f32],
    (settings, ball): (&Settings, f64),
    spacing: impl Fn(u32) -> f64,
    gap: impl Fn(u32) -> f64,
) -> Option<(Vec<f32>, Vec<Hole>)> {
    let [size, depth] = settings.hole?;
    let (mut at, mut which) = (vec![], vec![]);
    for (node, q) in nodes.rotations.iter().enumerate() {
        let Some(q) = q else { continue };
        let (sample, empty) = (near.ball[node], f64::from(near.value[node]));
        let spacing = spacing(sample);
        if empty >= size * spacing && f64::from(inner[node]) > depth * spacing {
            at.push((node, which.len() as u32));
            which.push((*q, empty, gap(sample)));
        }
    }
    if which.is_empty() {
        return None;
    }
    // A hole is named by its largest ball; balls that overlap a larger one belong to it.
    let mut order: Vec<usize> = (0..which.len()).collect();
    order.sort_by(|a, b| which[*b].1.total_cmp(&which[*a].1));
    let mut holes: Vec<Hole> = vec![];
    let mut member = vec![u32::MAX; which.len()];
    for index in order {
        let (q, empty, _) = which[index];
        let held = holes.iter().position(|(p, radius, _)| p.angle_to(q) < radius + empty);
        if held.is_none() && holes.len() < 100 {
            holes.push((q, empty, 0.0));
        }
        member[index] = held.unwrap_or(holes.len() - 1) as u32;
    }
    // What a ball leaves before a boundary is by √(R κ) of what balls of radius R leave before a flat one, with κ by how much more it is
    // curved than the boundary: of a hole that is hardly larger than the ball hardly anything.
    let balls: Vec<Ball> = which
        .iter()
        .zip(&member)
        .map(|((q, empty, gap), hole)| {
            let largest = holes.get(*hole as usize).map_or(*empty, |hole| hole.1);
            let more = (ball * (1.0 / empty - 1.0 / largest)).clamp(CONFORMING, 1.0);
            Ball::new(*q, (empty - gap * more.sqrt()).max(0.0))
        })
        .collect();
    let found = nodes.nearest(&balls, at.into_iter());
    let cell = nodes.lattice.angle();
    for (node, q) in nodes.rotations.iter().enumerate() {
        let Some(q) = q else { continue };
        let share = (0.5 - f64::from(found.value[node]) / cell).clamp(0.0, 1.0);
        if share == 0.0 || q.w <= -0.1 {
            continue;
        }
        let hole = member.get(found.ball[node] as usize).and_then(|m| holes.get_mut(*m as usize));
        if let Some(hole) = hole {
            hole.2 += share * nodes.lattice.volume(*q);
        }
    }
    Some((found.value, holes))
}
