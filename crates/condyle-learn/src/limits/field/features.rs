//! Features (experiment).

use super::layer::smoothed;
use super::nearest::{Ball, Nearest, Nodes};
use condyle_math::Quat;
use condyle_model::limit::field::{Chart, Lattice};

/// Distances from inside to the closing by balls of radii that follow the local spacing.
pub(super) fn inside_local(nodes: &Nodes<'_>, near: &Nearest, least: impl Fn(u32) -> f64) -> Vec<f32> {
    let (mut balls, mut at) = (vec![], vec![]);
    for (node, q) in nodes.rotations.iter().enumerate() {
        let (Some(q), value) = (q, near.value[node]) else { continue };
        if f64::from(value) >= least(near.ball[node]) {
            at.push((node, balls.len() as u32));
            balls.push(Ball::new(*q, f64::from(value)));
        }
    }
    if balls.is_empty() {
        return nodes.rotations.iter().map(|q| if q.is_some() { 4.0 } else { f32::INFINITY }).collect();
    }
    nodes.nearest(&balls, at.into_iter()).value
}

/// Weights 1, 2, 1 over neighbours so many steps away.
pub(super) fn widely(lattice: &Lattice, values: &[f32], passes: usize, wide: usize) -> Vec<f32> {
    let mut from = values.to_vec();
    let mut to = from.clone();
    for _ in 0..passes {
        for stride in [1, lattice.edge, lattice.edge * lattice.edge].map(|s| s * wide) {
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

/// The local spacing at each sample.
pub(super) fn local(nodes: &Nodes<'_>, inner: &[f32], samples: &[Quat], spacing: f64) -> (Vec<f64>, Vec<f32>) {
    let lattice = nodes.lattice;
    let cell = lattice.angle();
    let mut volume = vec![0.0f32; lattice.len()];
    let mut count = vec![0.0f32; lattice.len()];
    for (node, q) in nodes.rotations.iter().enumerate() {
        let Some(q) = q else { continue };
        let share = ((f64::from(inner[node]) + 0.3 * spacing) / cell + 0.5).clamp(0.0, 1.0);
        let square = 2.0 * (1.0 - q.w);
        volume[node] = (share * 8.0 * (1.0 - square / 4.0).max(0.0).sqrt() * lattice.step.powi(3)) as f32;
    }
    for q in samples {
        let here = lattice.corners(*q);
        let twin = lattice.corners(-*q);
        let sets = [Some(here), (q.w < 0.12).then_some(twin)];
        for set in sets.into_iter().flatten() {
            let best = set.into_iter().max_by(|a, b| {
                let d = |n: usize| nodes.rotations.get(n).copied().flatten().map_or(-1.0, |p| p.dot(*q).abs());
                d(*a).total_cmp(&d(*b))
            });
            if let Some(n) = best { count[n] += 1.0; }
        }
    }
    let wide = crate::limits::lab::get(10, 2.0) * spacing / cell;
    let fine = 2usize;
    let rest = (wide * wide - 0.5 * fine as f64).max(0.0);
    let stride = if wide > 2.5 { 2 } else { 1 };
    let passes = (2.0 * rest / (stride * stride) as f64).round() as usize;
    let spread = |v: &[f32]| widely(lattice, &smoothed(lattice, v, fine), passes, stride);
    let (volume, count) = (spread(&volume), spread(&count));
    let at_node: Vec<f32> = volume.iter().zip(&count).map(|(v, c)| {
        let s = (v / c.max(1e-9)).cbrt();
        if s.is_finite() { s.clamp(0.4 * spacing as f32, 2.5 * spacing as f32) } else { spacing as f32 }
    }).collect();
    let per = samples.iter().map(|q| {
        let mut sum = 0.0; 
        for n in lattice.corners(*q) { sum += f64::from(at_node[n]) / 8.0; }
        sum
    }).collect();
    (per, at_node)
}

pub(super) fn export(nodes: &Nodes<'_>, near: &Nearest, inner: &[f32], samples: &[Quat], spacing: f64, chart: &Chart) {
    let lattice = nodes.lattice;
    let cell = lattice.angle();
    let (local, at_node) = local(nodes, inner, samples, spacing);
    let [least, most] = [20f64.to_radians(), 50f64.to_radians()];
    let radius = |m: f64| move |s: f64| (m * s).clamp(least * m / 5.0, most.max(m / 5.0 * most));
    let of = |m: f64| inside_local(nodes, near, |sample| radius(m)(local.get(sample as usize).copied().unwrap_or(spacing)));
    let fields = [of(8.0), of(5.0), of(2.5)];
    let scales = [0.5, 1.0, 2.0];
    let mut smooth: Vec<Vec<Vec<f32>>> = vec![];
    for field in &fields {
        let mut row = vec![];
        let mut done = 0.0;
        let mut now = field.clone();
        for scale in scales {
            let wide: f64 = scale * spacing / cell;
            let rest = wide * wide - done;
            let stride = if done > 1.5 { 2 } else { 1 };
            let passes = (2.0 * rest / (stride * stride) as f64).round() as usize;
            now = widely(lattice, &now, passes, stride);
            done = wide * wide;
            row.push(now.clone());
        }
        smooth.push(row);
    }
    let edge = lattice.edge;
    let mut out: (Vec<[f32; 20]>, Vec<Quat>) = (vec![], vec![]);
    for (node, q) in nodes.rotations.iter().enumerate() {
        let Some(q) = q else { continue };
        if q.w < 0.0 { continue }
        let s = at_node[node];
        if !(fields[1][node].abs() < 2.0 * s) { continue }
        let slope = |f: &[f32]| {
            let d = [1, edge, edge * edge].map(|t| (f[node + t] - f[node - t]) * 0.5);
            (d[0] * d[0] + d[1] * d[1] + d[2] * d[2]).sqrt() / cell as f32
        };
        let r5 = radius(5.0)(f64::from(s)) as f32 / s;
        out.0.push([
            fields[0][node] / s, smooth[0][0][node] / s, smooth[0][1][node] / s, smooth[0][2][node] / s,
            fields[1][node] / s, smooth[1][0][node] / s, smooth[1][1][node] / s, smooth[1][2][node] / s,
            fields[2][node] / s, smooth[2][0][node] / s, smooth[2][1][node] / s, smooth[2][2][node] / s,
            slope(&smooth[0][1]), slope(&smooth[1][1]), slope(&smooth[2][1]),
            near.value[node] / s, (s / spacing as f32).ln(), cell as f32 / s, r5, s,
        ]);
        out.1.push(chart.outward(*q));
    }
    *crate::limits::lab::OUT.lock().unwrap() = Some(out);
}
