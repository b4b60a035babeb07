//! The layer that samples leave before a boundary: how thick it is, and how its surface is evened out.
//!
//! The share of a shape that is outside the closing C of N samples is that of samples that are outside the closing of
//! the others, p = N_extreme / N (leave one out, and no truth is needed). So the volume with the layer is that of C
//! over 1 - p, and the thickness is what gives that volume; thicker in proportion where samples are sparser.
//!
//! The outermost samples lie at depths that differ by chance, so the surface is rough over about a spacing. A Gaussian of
//! half a spacing over the signed distances takes most of that away; where the boundary is curved or has an edge it
//! also moves it inward. Half of what a second one would take is given back, and a constant gives back the volume.

use super::closing::between;
use super::nearest::{Ball, NONE, Nearest, Nodes};
use condyle_model::limit::field::Lattice;

/// Of the thickness that gives the volume back, the share that is taken: nodes count what is cut by halves, and what is
/// missing in the deepest gaps is not worth as much farther out. With it volumes are within 2 % of the true ones.
const SHARE: f64 = 0.97;
/// The deviation of the Gaussian, in spacings.
const EVEN: f64 = 0.5;
/// Of what a second Gaussian takes away, the share that is given back: that is edges and curvature more than chance.
const EDGES: f32 = 0.5;

/// The mean thickness of the layer about a closing, from its volume in rad³ and signed distances `bare` to its boundary.
pub(super) fn thickness(
    nodes: &Nodes<'_>,
    (inner, bare): (f64, &[f32]),
    near: &Nearest,
    local: &[f64],
    missing: f64,
    most: f64,
) -> f64 {
    let target = inner / (1.0 - missing.min(0.5));
    let local: Vec<f32> = near
        .ball
        .iter()
        .map(|sample| local.get(*sample as usize).copied().unwrap_or(1.0) as f32)
        .collect();
    let with = |gap: f64| {
        let gap = gap as f32;
        let distance = bare.iter().zip(&local).map(|(d, scale)| d + gap * scale);
        sum(nodes, distance, |d| share(nodes, d))
    };
    // To 2⁻¹⁴ of the most: far below a thousandth of the volume.
    let gap = halved(0.0, most, 14, |gap| with(gap) < target);
    crate::limits::lab::get(2, SHARE) * gap
}

/// Signed distances whose zero set is evened out over half a spacing and encloses the same volume.
pub(super) fn evened(nodes: &Nodes<'_>, distance: &[f32], spacing: f64) -> Vec<f32> {
    if crate::limits::lab::get(8, 1.0) > 0.0 { return super::even::evened(nodes, distance, spacing) }
    let sigma = crate::limits::lab::get(0, EVEN) * spacing / nodes.lattice.angle();
    // A pass has the variance of half a step²; the most is a deviation of 4.5 steps.
    let passes = ((2.0 * sigma * sigma).round() as usize).min(400);
    if passes == 0 {
        return distance.to_vec();
    }
    let total = volume(nodes, distance);
    let mut even = smoothed(nodes.lattice, distance, passes);
    let again = smoothed(nodes.lattice, &even, passes);
    even.iter_mut().zip(again).for_each(|(once, twice)| *once += (crate::limits::lab::get(1, f64::from(EDGES)) as f32) * (*once - twice));
    let moved =
        |by: f64| sum(nodes, even.iter().map(|d| d + by as f32), |d| share(nodes, d)) < total;
    let by = halved(-0.3, 0.3, 14, moved) as f32;
    even.iter_mut().for_each(|d| *d += by);
    even
}

/// The middle of what is left of an interval after halving it towards where `below` ends.
pub(super) fn halved(mut low: f64, mut high: f64, times: usize, below: impl Fn(f64) -> bool) -> f64 {
    for _ in 0..times {
        let middle = 0.5 * (low + high);
        if below(middle) { low = middle } else { high = middle }
    }
    0.5 * (low + high)
}

/// Weights 1, 2, 1 along each axis, so many times; what has no two neighbours is kept.
pub(super) fn smoothed(lattice: &Lattice, values: &[f32], passes: usize) -> Vec<f32> {
    let mut from = values.to_vec();
    let mut to = from.clone();
    for _ in 0..passes {
        for stride in [1, lattice.edge, lattice.edge * lattice.edge] {
            let inner = stride..from.len().saturating_sub(stride);
            let below = &from[..inner.len()];
            let above = &from[2 * stride.min(from.len() / 2)..];
            for ((to, at), (a, b)) in
                to[inner.clone()].iter_mut().zip(&from[inner]).zip(below.iter().zip(above))
            {
                let mean = 0.25 * (a + b) + 0.5 * at;
                *to = if mean.is_finite() { mean } else { *at };
            }
            std::mem::swap(&mut from, &mut to);
        }
    }
    from
}

pub(super) fn share(nodes: &Nodes<'_>, distance: f64) -> f64 {
    (distance / nodes.lattice.angle() + 0.5).clamp(0.0, 1.0)
}

/// The volume in rad³ of where a signed distance is positive; a node counts in part where its cell is cut.
pub(super) fn volume(nodes: &Nodes<'_>, distance: &[f32]) -> f64 {
    sum(nodes, distance.iter().copied(), |d| share(nodes, d))
}

/// The area in rad² of its zero set: the volume of a layer over its thickness.
pub(super) fn surface(nodes: &Nodes<'_>, distance: &[f32]) -> f64 {
    let half = 1.5 * nodes.lattice.angle();
    sum(nodes, distance.iter().copied(), |d| (1.0 - (d / half).abs()).max(0.0) / half)
}

pub(super) fn sum(nodes: &Nodes<'_>, distance: impl Iterator<Item = f32>, weight: impl Fn(f64) -> f64) -> f64 {
    nodes
        .rotations
        .iter()
        .zip(distance)
        .filter_map(|(q, d)| {
            let q = (*q)?;
            // Those beyond the half turns are there under the other sign.
            if q.w <= -0.1 {
                return None;
            }
            let weight = weight(f64::from(d));
            (weight > 0.0).then(|| nodes.lattice.volume(q) * weight)
        })
        .sum()
}

/// How often each sample was found to touch an empty ball of a radius: those nearest to where the distance to
/// the samples is that radius, seen where edges between nodes cross it.
pub(super) fn extremes(
    nodes: &Nodes<'_>,
    near: &Nearest,
    points: &[Ball],
    radius: f64,
) -> Vec<u32> {
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
            let at = between(*q, *p, part);
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
pub(super) fn unseen(found: &[u32]) -> f64 {
    let count = |n: u32| found.iter().filter(|c| **c == n).count() as f64;
    let seen = found.iter().filter(|c| **c > 0).count() as f64;
    let (once, twice) = (count(1), count(2));
    seen + once * (once - 1.0).max(0.0) / (2.0 * (twice + 1.0))
}

/// How much sparser the cloud is at each sample than at the extreme ones on average.
pub(super) fn local_scale(counts: &[u32], extremes: &[u32]) -> Vec<f64> {
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
