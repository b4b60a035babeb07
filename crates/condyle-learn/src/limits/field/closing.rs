//! From a cloud to signed distances at nodes: closing by empty balls, its offset, its holes.
//!
//! 1. d(x) is the angle to the nearest sample. Where d(x) ≥ R the ball about x of radius d(x) is empty; the closing
//!    C is what no empty ball covers, and g(q) = min over empty balls of (angle to the centre - radius) is
//!    the distance to its boundary from inside.
//! 2. The boundary of C goes through the outermost samples, so C is too small. Another sample of the same kind
//!    is outside C with the probability that one of the N is outside the closing of the others: those that
//!    touch an empty ball of radius R, N_extreme / N. Outside C is thus a layer of mean thickness
//!    gap = (N_extreme / N) · volume / surface, thicker in proportion where samples are sparser.
//! 3. F(q) = max over x in C of (g(x) + gap(x) - angle to x) is the signed distance to the closing with its layer.
//! 4. Empty balls of 2.5 spacings whose centres are more than 2 spacings inside are holes, each
//!    smaller by the gap.
//!
//! A spacing is (volume of C / N)^(1/3); R = 5 spacings, within 20 and 50 degrees.

use super::super::cloud::{counts, typical_spacing};
use super::nearest::{Ball, NONE, Nearest, Nodes};
use condyle_math::Quat;
use condyle_model::limit::field::{Ground, Lattice, Settings};

/// What was learned of a cloud, at the nodes and in sum.
#[derive(Clone, Debug)]
pub(super) struct Closing {
    /// The signed distance to the closing with its layer, in radians.
    pub(super) outer: Vec<f32>,
    /// The same with holes carved; `None` if there are none.
    pub(super) carved: Option<Vec<f32>>,
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
    let mut inner = inside(&nodes, &near, ball);
    for _ in 0..if known.is_some() { 0 } else { 2 } {
        let volume = volume(&nodes, &inner);
        spacing = (volume / samples.len() as f64).cbrt().clamp(1e-4, 1.0);
        let better = (5.0 * spacing).clamp(least, most);
        if (better / ball - 1.0).abs() < 0.05 {
            break;
        }
        ball = better;
        inner = inside(&nodes, &near, ball);
    }

    let (bare, _) = outward(&nodes, &inner, &samples, |_| 0.0, &near);
    let (bare_volume, surface) = (volume(&nodes, &inner), surface(&nodes, &bare));
    let extremes = extremes(&nodes, &near, &points, ball);
    let extreme = unseen(&extremes);
    let gap = match known.map(|known| known.gap).or(settings.gap) {
        Some(gap) => gap,
        None if surface > 0.0 => {
            (extreme / samples.len() as f64 * bare_volume / surface).min(1.5 * spacing)
        }
        None => 0.0,
    };
    let counts = counts(&samples, 2.0 * spacing);
    let local = local_scale(&counts, &extremes);
    let gap_at = |sample: u32| gap * local.get(sample as usize).copied().unwrap_or(1.0);
    let (outer, total) = outward(&nodes, &inner, &samples, gap_at, &near);

    let spacing_at =
        |sample: u32| spacing * local.get(sample as usize).copied().unwrap_or(1.0).max(1.0);
    let holes = hollow(&nodes, &near, &inner, settings, spacing_at, gap_at);
    let (carved, hollow_volume, holes) = match holes {
        None => (None, 0.0, vec![]),
        Some((depth, holes)) => {
            let carved: Vec<f32> = outer.iter().zip(&depth).map(|(a, b)| a.min(*b)).collect();
            let left = volume(&nodes, &carved);
            (Some(carved), total - left, holes)
        }
    };
    Closing {
        outer,
        carved,
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

fn seeds<'a>(lattice: &'a Lattice, at: &'a [Quat]) -> impl Iterator<Item = (usize, u32)> + 'a {
    (0u32..).zip(at).flat_map(|(index, q)| lattice.around(*q).map(move |node| (node, index)))
}

/// Distances from inside to the closing by balls of a radius or more.
fn inside(nodes: &Nodes<'_>, near: &Nearest, radius: f64) -> Vec<f32> {
    let (mut balls, mut at) = (vec![], vec![]);
    for (node, q) in nodes.rotations.iter().enumerate() {
        let (Some(q), value) = (q, near.value[node]) else { continue };
        if f64::from(value) >= radius {
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

/// The signed distance to all that is within C or its layer, and the volume of that.
fn outward(
    nodes: &Nodes<'_>,
    inner: &[f32],
    samples: &[Quat],
    gap: impl Fn(u32) -> f64,
    near: &Nearest,
) -> (Vec<f32>, f64) {
    let (mut balls, mut at) = (vec![], vec![]);
    for (index, q) in (0u32..).zip(samples) {
        balls.push(Ball::new(*q, gap(index)));
    }
    at.extend(seeds(nodes.lattice, samples));
    for (node, q) in nodes.rotations.iter().enumerate() {
        let Some(q) = q else { continue };
        let depth = f64::from(inner[node]) + gap(near.ball[node]);
        if depth >= 0.0 {
            at.push((node, balls.len() as u32));
            balls.push(Ball::new(*q, depth));
        }
    }
    let mut value = nodes.nearest(&balls, at.into_iter()).value;
    for (value, q) in value.iter_mut().zip(nodes.rotations) {
        *value = if q.is_some() { -*value } else { f32::NAN };
    }
    let total = volume(nodes, &value);
    (value, total)
}

/// The volume in rad³ of where a signed distance is positive; a node counts in part where its cell is cut.
fn volume(nodes: &Nodes<'_>, distance: &[f32]) -> f64 {
    let cell = nodes.lattice.angle();
    sum(nodes, distance, |d| (d / cell + 0.5).clamp(0.0, 1.0))
}

/// The area in rad² of its zero set: the volume of a layer over its thickness.
fn surface(nodes: &Nodes<'_>, distance: &[f32]) -> f64 {
    let half = 1.5 * nodes.lattice.angle();
    sum(nodes, distance, |d| (1.0 - (d / half).abs()).max(0.0) / half)
}

fn sum(nodes: &Nodes<'_>, distance: &[f32], weight: impl Fn(f64) -> f64) -> f64 {
    nodes
        .rotations
        .iter()
        .zip(distance)
        .filter_map(|(q, d)| {
            let q = (*q)?;
            // Those beyond the half turns are there under the other sign.
            (q.w > -0.1).then(|| nodes.lattice.volume(q) * weight(f64::from(*d)))
        })
        .sum()
}

/// How often each sample was found to touch an empty ball of a radius: those nearest to where the distance to
/// the samples is that radius, seen where edges between nodes cross it.
fn extremes(nodes: &Nodes<'_>, near: &Nearest, points: &[Ball], radius: f64) -> Vec<u32> {
    let mut found = vec![0u32; points.len()];
    let edge = nodes.lattice.edge;
    let strides = [1, edge, edge * edge];
    let radius = radius as f32;
    for (node, q) in nodes.rotations.iter().enumerate() {
        let Some(q) = q else { continue };
        if q.w < 0.0 {
            continue;
        }
        for stride in strides {
            let Some(Some(p)) = nodes.rotations.get(node + stride) else { continue };
            let (a, b) = (near.value[node], near.value[node + stride]);
            if (a >= radius) == (b >= radius) {
                continue;
            }
            let part = f64::from((radius - a) / (b - a));
            let (q, p) = (q.to_array(), p.to_array());
            let at = Quat::from(std::array::from_fn(|i| q[i] + part * (p[i] - q[i]))).normalized();
            let at = at.to_array().map(|c| c as f32);
            let mut best = (f32::NEG_INFINITY, NONE);
            let around = [node, node + stride].into_iter().flat_map(|n| {
                [n, n + 1, n.wrapping_sub(1), n + edge, n.wrapping_sub(edge)]
                    .into_iter()
                    .chain([n + edge * edge, n.wrapping_sub(edge * edge)])
            });
            for neighbour in around {
                let Some(&ball) = near.ball.get(neighbour) else { continue };
                let Some(candidate) = points.get(ball as usize) else { continue };
                let cosine = candidate.cosine(&at);
                if cosine > best.0 {
                    best = (cosine, ball);
                }
            }
            if let Some(count) = found.get_mut(best.1 as usize) {
                *count += 1;
            }
        }
    }
    found
}

/// How many there are when some were found once, some twice: Chao's estimate of those not found.
fn unseen(found: &[u32]) -> f64 {
    let count = |n: u32| found.iter().filter(|c| **c == n).count() as f64;
    let seen = found.iter().filter(|c| **c > 0).count() as f64;
    let (once, twice) = (count(1), count(2));
    seen + once * (once - 1.0).max(0.0) / (2.0 * (twice + 1.0))
}

/// How much sparser the cloud is at each sample than at the extreme ones on average.
fn local_scale(counts: &[u32], extremes: &[u32]) -> Vec<f64> {
    let spacing = |count: u32| 1.0 / f64::from(count.max(1)).cbrt();
    let (mut sum, mut number) = (0.0, 0.0f64);
    for (count, extreme) in counts.iter().zip(extremes) {
        if *extreme > 0 {
            sum += spacing(*count);
            number += 1.0;
        }
    }
    let mean = if number > 0.0 { sum / number } else { 1.0 };
    counts.iter().map(|count| (spacing(*count) / mean).clamp(0.4, 2.5)).collect()
}

/// Centre, radius of the largest empty ball, volume.
type Hole = (Quat, f64, f64);

/// The signed distance to holes, positive outside them, and the holes.
fn hollow(
    nodes: &Nodes<'_>,
    near: &Nearest,
    inner: &[f32],
    settings: &Settings,
    spacing: impl Fn(u32) -> f64,
    gap: impl Fn(u32) -> f64,
) -> Option<(Vec<f32>, Vec<Hole>)> {
    let [size, depth] = settings.hole?;
    let (mut balls, mut at, mut which) = (vec![], vec![], vec![]);
    for (node, q) in nodes.rotations.iter().enumerate() {
        let Some(q) = q else { continue };
        let (sample, empty) = (near.ball[node], f64::from(near.value[node]));
        let spacing = spacing(sample);
        if empty >= size * spacing && f64::from(inner[node]) > depth * spacing {
            at.push((node, balls.len() as u32));
            balls.push(Ball::new(*q, (empty - gap(sample)).max(0.0)));
            which.push((*q, empty));
        }
    }
    if balls.is_empty() {
        return None;
    }
    let found = nodes.nearest(&balls, at.into_iter());
    // A hole is named by its largest ball; balls that overlap a larger one belong to it.
    let mut order: Vec<usize> = (0..which.len()).collect();
    order.sort_by(|a, b| which[*b].1.total_cmp(&which[*a].1));
    let mut holes: Vec<Hole> = vec![];
    let mut member = vec![u32::MAX; which.len()];
    for index in order {
        let (q, empty) = which[index];
        let held = holes.iter().position(|(p, radius, _)| p.angle_to(q) < radius + empty);
        if held.is_none() && holes.len() < 100 {
            holes.push((q, empty, 0.0));
        }
        member[index] = held.unwrap_or(holes.len() - 1) as u32;
    }
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
