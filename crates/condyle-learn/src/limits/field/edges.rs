//! Edges and creases, from the faces that meet in them.
//!
//! Where the directions of slopes about a place gather about two (or more) that are far from each other, faces meet there. Hardly any
//! sample lies in an edge, so what is learned of it is round; the faces themselves are known well. So the distance there is what they
//! say when they go on: the least of their distances at an edge, the greatest in a crease.

use super::even::{Near, band, dot, offsets, spread};
use super::nearest::Nodes;

/// The deviation of the window, in spacings, and at most so many radians.
const WIDE: f64 = 2.0;
const MOST: f64 = 0.4;
/// Slopes are those of the distance spread over so many spacings.
const GUIDE: f64 = 0.4;
/// Directions gather as exp(-(1 - cos)/(1 - cos 20°)).
const AGREE: f32 = 0.060_307_4;
/// Faces whose directions are less than the first apart are one; beyond the second they surely are two: cosines of 30° and 55°.
const APART: [f32; 2] = [0.866, 0.574];
/// A face has at least the first share of what is about, and the second surely counts.
const SHARE: [f32; 2] = [0.06, 0.16];
/// Beyond so many steps from the boundary nothing is changed.
const BAND: f32 = 2.5;

/// A face that is seen from a place.
#[derive(Clone, Copy, Debug, Default)]
struct Face {
    direction: [f32; 3],
    share: f32,
    /// Its distance at the place.
    distance: f32,
    /// Where it is from there, in steps.
    at: [f32; 3],
}

/// Signed distances with their edges and creases as faces about them say.
pub(super) fn edged(nodes: &Nodes<'_>, distance: &[f32], spacing: f64) -> Vec<f32> {
    let cell = nodes.lattice.angle();
    let guide = spread(nodes.lattice, distance, GUIDE * spacing / cell);
    let (slot, near) = band(nodes, distance, &guide);
    let sigma = (WIDE * spacing).min(MOST);
    let offsets = offsets(nodes.lattice.edge, 1.6 * sigma / cell);
    let narrow = (4.0 / (sigma * sigma)) as f32;
    let mut found = distance.to_vec();
    let mut about: Vec<(f32, [f32; 3], &Near)> = vec![];
    for own in &near {
        let part = (BAND - own.distance.abs() / cell as f32).clamp(0.0, 1.0);
        if part == 0.0 {
            continue;
        }
        about.clear();
        let (mut total, mut mean) = (0.0f32, [0.0f32; 3]);
        for (offset, by) in &offsets {
            let other = slot.get(own.node.wrapping_add_signed(*offset)).copied();
            let Some(p) = near.get(other.unwrap_or(u32::MAX) as usize) else { continue };
            let cosine: f32 = own.at.iter().zip(&p.at).map(|(a, b)| a * b).sum();
            let weight = fading(narrow * (1.0 - cosine.abs()));
            total += weight;
            for (mean, c) in mean.iter_mut().zip(p.slope) {
                *mean += weight * c;
            }
            about.push((weight, *by, p));
        }
        let mean = mean.map(|c| c / total.max(1e-9));
        if dot(&mean, &mean) > 0.9 {
            continue;
        }
        let axis = widest(&about, &mean);
        let mut faces = [Face::default(); 2];
        for (face, side) in faces.iter_mut().zip([1.0f32, -1.0]) {
            *face = gathered(&about, &mean, axis.map(|c| c * side), total);
        }
        let [one, other] = &faces;
        let apart = dot(&one.direction, &other.direction);
        let sure = ((APART[0] - apart) / (APART[0] - APART[1])).clamp(0.0, 1.0);
        let least = one.share.min(other.share);
        let seen = ((least - SHARE[0]) / (SHARE[1] - SHARE[0])).clamp(0.0, 1.0);
        if sure * seen <= 0.0 {
            continue;
        }
        let [a, b] = [one.direction, other.direction];
        let along =
            [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
        let length = dot(&along, &along).sqrt();
        let along = if length > 1e-3 { along.map(|c| c / length) } else { [0.0; 3] };
        let by = faces.map(|face| curved(&about, &face, &along));
        for (face, by) in faces.iter_mut().zip(by) {
            face.distance += by;
        }
        let [one, other] = &faces;
        let turn: f32 = (0..3)
            .map(|i| (one.direction[i] - other.direction[i]) * (one.at[i] - other.at[i]))
            .sum();
        let change = if turn < 0.0 {
            (one.distance.min(other.distance) - own.distance).max(0.0)
        } else {
            (one.distance.max(other.distance) - own.distance).min(0.0)
        };
        found[own.node] += part * sure * seen * change;
    }
    found
}

/// The direction in which slopes differ most.
fn widest(about: &[(f32, [f32; 3], &Near)], mean: &[f32; 3]) -> [f32; 3] {
    let mut moments = [[0.0f32; 3]; 3];
    for (weight, _, p) in about {
        let off: [f32; 3] = std::array::from_fn(|i| p.slope[i] - mean[i]);
        for i in 0..3 {
            for j in 0..3 {
                moments[i][j] += weight * off[i] * off[j];
            }
        }
    }
    let longest = (0..3).max_by(|&i, &j| moments[i][i].total_cmp(&moments[j][j])).unwrap_or(0);
    let mut axis = moments[longest];
    for _ in 0..8 {
        let length = dot(&axis, &axis).sqrt().max(1e-20);
        axis = axis.map(|c| c / length);
        axis = std::array::from_fn(|i| dot(&moments[i], &axis));
    }
    let length = dot(&axis, &axis).sqrt().max(1e-20);
    axis.map(|c| c / length)
}

/// The face about which slopes on one side of their mean gather.
fn gathered(about: &[(f32, [f32; 3], &Near)], mean: &[f32; 3], axis: [f32; 3], total: f32) -> Face {
    let mut direction = [0.0f32; 3];
    for (weight, _, p) in about {
        let beyond = dot(&p.slope, &axis) - dot(mean, &axis);
        if beyond > 0.0 {
            for (sum, c) in direction.iter_mut().zip(p.slope) {
                *sum += weight * beyond * beyond * c;
            }
        }
    }
    let unit = |v: [f32; 3]| {
        let length = dot(&v, &v).sqrt().max(1e-20);
        v.map(|c| c / length)
    };
    direction = unit(direction);
    let mut face = Face::default();
    for _ in 0..3 {
        face = Face::default();
        let mut sum = [0.0f32; 3];
        for (weight, by, p) in about {
            let weight = weight * alike(&direction, p);
            face.share += weight;
            face.distance += weight * (p.distance - p.steep * dot(&p.slope, by));
            for i in 0..3 {
                sum[i] += weight * p.slope[i];
                face.at[i] += weight * by[i];
            }
        }
        let all = face.share.max(1e-9);
        face.distance /= all;
        face.at = face.at.map(|c| c / all);
        direction = unit(sum);
    }
    face.share /= total.max(1e-9);
    face.direction = direction;
    face
}

/// How well a slope agrees with a direction.
fn alike(direction: &[f32; 3], p: &Near) -> f32 {
    fading((1.0 - dot(direction, &p.slope)) / AGREE)
}

/// exp(-x) as (1 - x/8)⁸, which ends.
fn fading(x: f32) -> f32 {
    let root = (1.0 - x / 8.0).max(0.0);
    let square = root * root;
    square * square * square * square
}

/// By how much the tangent planes of a face are off where it is curved along an edge, as the mean of ½ h x²: h from a regression of slopes
/// on places along the edge. How it is curved across, what is round about the edge would tell wrong.
fn curved(about: &[(f32, [f32; 3], &Near)], face: &Face, along: &[f32; 3]) -> f32 {
    let (mut all, mut x, mut g, mut xx, mut xg) = (0.0f32, 0.0, 0.0, 0.0, 0.0);
    for (weight, by, p) in about {
        let weight = weight * alike(&face.direction, p);
        let (at, slope) = (dot(by, along), p.steep * dot(&p.slope, along));
        all += weight;
        x += weight * at;
        g += weight * slope;
        xx += weight * at * at;
        xg += weight * at * slope;
    }
    let all = all.max(1e-9);
    let square = xx / all;
    let spread = square - (x / all) * (x / all);
    let bent = (xg / all - x * g / (all * all)) / spread.max(0.1);
    0.5 * bent * square
}
