//! Evening out of a rough boundary that keeps its edges.

use super::layer::{halved, share, smoothed, sum, volume};
use super::nearest::Nodes;
use crate::limits::lab::get;

/// Signed distances whose zero set is evened out and encloses the same volume.
pub(super) fn evened(nodes: &Nodes<'_>, distance: &[f32], spacing: f64) -> Vec<f32> {
    let cell = nodes.lattice.angle();
    let total = volume(nodes, distance);
    let sigma = get(0, 1.0) * spacing;
    let rough = get(7, 0.4) * spacing / cell;
    let passes = ((2.0 * rough * rough).round() as usize).min(40);
    let guide = smoothed(nodes.lattice, distance, passes);
    let mut even = filtered(nodes, distance, &guide, sigma);
    let moved =
        |by: f64| sum(nodes, even.iter().map(|d| d + by as f32), |d| share(nodes, d)) < total;
    let by = halved(-0.3, 0.3, 14, moved) as f32;
    even.iter_mut().for_each(|d| *d += by);
    even
}

fn filtered(nodes: &Nodes<'_>, distance: &[f32], guide: &[f32], sigma: f64) -> Vec<f32> {
    let lattice = nodes.lattice;
    let edge = lattice.edge as isize;
    let cell = lattice.angle() as f32;
    let band = 2.5 * cell;
    let wide = (sigma * 2.0 / f64::from(cell)).ceil().clamp(1.0, 8.0) as isize;
    let strides = [1, edge, edge * edge];
    let inner: Vec<(usize, [f32; 4])> = nodes
        .used
        .iter()
        .map(|(n, q)| (*n as usize, *q))
        .filter(|(n, _)| distance[*n].abs() < band + cell)
        .collect();
    let mut slot = vec![u32::MAX; guide.len()];
    // direction, norm
    let mut raw: Vec<[f32; 4]> = vec![];
    for (at, (node, _)) in inner.iter().enumerate() {
        let g = strides.map(|s| {
            let at = |n: isize| guide.get(n as usize).copied().unwrap_or(f32::NAN);
            0.5 * (at(*node as isize + s) - at(*node as isize - s))
        });
        let norm = (g[0] * g[0] + g[1] * g[1] + g[2] * g[2]).sqrt();
        if norm.is_finite() && norm > 1e-6 {
            raw.push([g[0] / norm, g[1] / norm, g[2] / norm, norm]);
            slot[*node] = at as u32;
        } else {
            raw.push([0.0; 4]);
        }
    }
    let mut offsets = vec![];
    for k in -wide..=wide {
        for j in -wide..=wide {
            for i in -wide..=wide {
                if i * i + j * j + k * k <= wide * wide {
                    offsets.push(((k * edge + j) * edge + i, [i as f32, j as f32, k as f32]));
                }
            }
        }
    }
    let tolerance = 1.0 / (1.0 - (get(1, 35.0) as f32).to_radians().cos());
    let sure = 1.0 / (1.0 - (get(9, 15.0) as f32).to_radians().cos());
    let part = get(6, 0.5) as f32;
    let narrow = (8.0 / (2.0 * sigma * sigma)) as f32; // angle² ≈ 8 (1 - dot)
    let mut normals = raw.clone();
    let dot = |g: &[f32; 4], h: &[f32; 4]| g[0] * h[0] + g[1] * h[1] + g[2] * h[2];
    for _ in 0..get(5, 2.0) as usize {
        let before = normals.clone();
        for (at, (node, q)) in inner.iter().enumerate() {
            let g = before[at];
            if g[3] == 0.0 { continue }
            let mut s = [0.0f32; 3];
            for (offset, _) in &offsets {
                let other = node.wrapping_add_signed(*offset);
                let Some(&o) = slot.get(other) else { continue };
                if o == u32::MAX { continue }
                let p = &inner[o as usize].1;
                let h = &before[o as usize];
                let near = (q[0] * p[0] + q[1] * p[1] + q[2] * p[2] + q[3] * p[3]).abs();
                let exponent = narrow * (1.0 - near) + tolerance * (1.0 - dot(&g, h));
                if exponent > 6.0 { continue }
                let weight = (-exponent).exp();
                for i in 0..3 { s[i] += weight * h[i]; }
            }
            let norm = (s[0] * s[0] + s[1] * s[1] + s[2] * s[2]).sqrt();
            if norm > 1e-6 { normals[at] = [s[0] / norm, s[1] / norm, s[2] / norm, g[3]]; }
        }
    }
    let doubt: Vec<f32> = raw.iter().zip(&normals).map(|(a, b)| sure * (1.0 - dot(a, b))).collect();
    let mut even = distance.to_vec();
    for (at, (node, q)) in inner.iter().enumerate() {
        let own = distance[*node];
        let g = normals[at];
        if g[3] == 0.0 { continue }
        let (mut total, mut value) = (0.0f32, 0.0f32);
        for (offset, by) in &offsets {
            let other = node.wrapping_add_signed(*offset);
            let Some(&o) = slot.get(other) else { continue };
            if o == u32::MAX { continue }
            let o = o as usize;
            let p = &inner[o].1;
            let h = &normals[o];
            let near = (q[0] * p[0] + q[1] * p[1] + q[2] * p[2] + q[3] * p[3]).abs();
            let exponent = narrow * (1.0 - near) + tolerance * (1.0 - dot(&g, h)) + doubt[o];
            if exponent > 8.0 { continue }
            let weight = (-exponent).exp();
            let rise = (h[0] * by[0] + h[1] * by[1] + h[2] * by[2]) * (1.0 - part) * h[3]
                + (g[0] * by[0] + g[1] * by[1] + g[2] * by[2]) * part * g[3];
            total += weight;
            value += weight * (distance[other] - rise);
        }
        if total > 1e-3 {
            let share = ((band + cell - own.abs()) / cell).clamp(0.0, 1.0);
            even[*node] = own + share * (value / total - own);
        }
    }
    even
}
