//! Evening out of a rough boundary that keeps its edges.
//!
//! The outermost samples lie at depths that differ by chance, so the surface through them is rough over one or two
//! spacings. Taking means of distances over that width would evens it out, but moves curved parts inward and rounds
//! edges off. So each neighbour tells the distance that its own tangent plane has, as far as the slopes of both agree:
//!
//! ```text
//! F(q) = Σ w (F(p) - ½ (∇F(p) + ∇F(q))·(p - q)) / Σ w,   w = exp(-angle²/2σ² - (1 - cos ∠(∇F(p), ∇F(q)))/(1 - cos 20°))
//! ```
//!
//! which is exact where the boundary is curved evenly, and does not look around edges. What the closing itself takes
//! off edges, for hardly any sample lies in them, is given back by what the faces about them say (`edges`).

use super::nearest::Nodes;
use condyle_model::limit::field::Lattice;

/// σ, in spacings, and at most so many radians: what is curved on that scale is no chance.
const WIDE: f64 = 1.5;
const MOST: f64 = 0.26;
/// 1 - cos of 20°.
const AGREE: f32 = 0.060_307_4;
/// Slopes are those of the distance spread over so many spacings.
const GUIDE: f64 = 0.4;
/// Beyond so many steps from the boundary nothing is changed.
const BAND: f32 = 3.0;

/// Signed distances whose zero set is evened out.
pub(super) fn evened(nodes: &Nodes<'_>, distance: &[f32], spacing: f64) -> Vec<f32> {
    let cell = nodes.lattice.angle();
    let guide = spread(nodes.lattice, distance, GUIDE * spacing / cell);
    let even = filtered(nodes, distance, &guide, (WIDE * spacing).min(MOST));
    super::edges::edged(nodes, &even, spacing)
}

/// A node near the boundary: its number, its rotation, the direction and length of the slope per step, the distance.
pub(super) struct Near {
    pub(super) node: usize,
    pub(super) at: [f32; 4],
    pub(super) slope: [f32; 3],
    pub(super) steep: f32,
    pub(super) distance: f32,
}

pub(super) fn dot(a: &[f32; 3], b: &[f32; 3]) -> f32 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// The nodes near the boundary, and for each node its position among them.
pub(super) fn band(nodes: &Nodes<'_>, distance: &[f32], guide: &[f32]) -> (Vec<u32>, Vec<Near>) {
    let edge = nodes.lattice.edge;
    let cell = nodes.lattice.angle() as f32;
    let mut slot = vec![u32::MAX; guide.len()];
    let mut near: Vec<Near> = vec![];
    for (node, at) in &nodes.used {
        let node = *node as usize;
        if distance[node].abs() >= BAND * cell {
            continue;
        }
        let g = [1, edge, edge * edge].map(|stride| {
            let at = |n: usize| guide.get(n).copied().unwrap_or(f32::NAN);
            0.5 * (at(node + stride) - at(node.wrapping_sub(stride)))
        });
        let steep = dot(&g, &g).sqrt();
        if steep.is_finite() && steep > 1e-6 {
            slot[node] = near.len() as u32;
            let slope = g.map(|c| c / steep);
            near.push(Near { node, at: *at, slope, steep, distance: distance[node] });
        }
    }
    (slot, near)
}

fn filtered(nodes: &Nodes<'_>, distance: &[f32], guide: &[f32], sigma: f64) -> Vec<f32> {
    let edge = nodes.lattice.edge;
    let cell = nodes.lattice.angle() as f32;
    let (slot, near) = band(nodes, distance, guide);
    let offsets = offsets(edge, 1.6 * sigma / f64::from(cell));
    // angle² is nearly 8 (1 - |p·q|).
    let narrow = (4.0 / (sigma * sigma)) as f32;
    let mut even = distance.to_vec();
    for own in &near {
        let (mut total, mut value) = (0.0, 0.0);
        for (offset, by) in &offsets {
            let other = slot.get(own.node.wrapping_add_signed(*offset)).copied();
            let Some(p) = near.get(other.unwrap_or(u32::MAX) as usize) else { continue };
            let cosine: f32 = own.at.iter().zip(&p.at).map(|(a, b)| a * b).sum();
            let apart = narrow * (1.0 - cosine.abs()) + (1.0 - dot(&own.slope, &p.slope)) / AGREE;
            // exp(-x) as (1 - x/8)⁸, which ends.
            let root = 1.0 - apart / 8.0;
            if root <= 0.0 {
                continue;
            }
            let square = root * root;
            let weight = square * square * square * square;
            let rise = 0.5 * (dot(&p.slope, by) * p.steep + dot(&own.slope, by) * own.steep);
            total += weight;
            value += weight * (p.distance - rise);
        }
        if total > 0.0 {
            let part = (BAND - own.distance.abs() / cell).clamp(0.0, 1.0);
            even[own.node] = own.distance + part * (value / total - own.distance);
        }
    }
    even
}

/// Steps to the nodes within a radius in steps; every other one along each axis where there are many.
pub(super) fn offsets(edge: usize, radius: f64) -> Vec<(isize, [f32; 3])> {
    let every = if radius > 3.5 { 2 } else { 1 };
    let (most, edge) = ((radius / f64::from(every)) as i32, edge as isize);
    let mut found = vec![];
    for k in -most..=most {
        for j in -most..=most {
            for i in -most..=most {
                let by = [i, j, k].map(|n| f64::from(n * every));
                if by.iter().map(|c| c * c).sum::<f64>() <= radius * radius {
                    let [i, j, k] = [i, j, k].map(|n| (n * every) as isize);
                    found.push(((k * edge + j) * edge + i, by.map(|c| c as f32)));
                }
            }
        }
    }
    found
}

/// A Gaussian of a deviation in steps over values at nodes: of at most 9 steps. What has no two neighbours is kept.
pub(super) fn spread(lattice: &Lattice, values: &[f32], sigma: f64) -> Vec<f32> {
    let variance = sigma.min(9.0).powi(2);
    // A pass of weights 1, 2, 1 has the variance of half a step². Passes over every other node, with four times
    // that, follow on some over all.
    let wide = if variance > 3.0 { ((variance - 1.0) / 2.0).round() as usize } else { 0 };
    let narrow = ((variance - 2.0 * wide as f64) * 2.0).round().max(0.0) as usize;
    let mut from = values.to_vec();
    let mut to = from.clone();
    for pass in 0..narrow + wide {
        let every = if pass < narrow { 1 } else { 2 };
        for stride in [1, lattice.edge, lattice.edge * lattice.edge].map(|s| s * every) {
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
