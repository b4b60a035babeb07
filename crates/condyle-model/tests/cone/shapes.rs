//! Test polygons, and a slow reference implementation of the geometry of their edges.

use condyle_math::{Mat3, Quat, Vec3};
use condyle_model::{Cone, ConePoint, Projection};
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// Fewer cases in unoptimised builds.
pub(crate) const SCALE: usize = if cfg!(debug_assertions) { 1 } else { 10 };

/// SplitMix64: the same numbers on every machine.
pub(crate) struct Random(pub(crate) u64);

impl Random {
    pub(crate) fn unit(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64
    }

    pub(crate) fn within(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.unit()
    }

    /// Uniform on the sphere.
    pub(crate) fn direction(&mut self) -> Vec3 {
        let (z, turn) = (self.within(-1.0, 1.0), self.within(0.0, TAU));
        let r = (1.0 - z * z).sqrt();
        Vec3::new(r * turn.cos(), r * turn.sin(), z)
    }

    pub(crate) fn rotation(&mut self) -> Mat3 {
        let angle = self.within(-PI, PI);
        Quat::from_axis_angle(self.direction(), angle).to_mat3()
    }
}

pub(crate) fn angle(a: Vec3, b: Vec3) -> f64 {
    a.cross(b).norm().atan2(a.dot(b))
}

/// The direction at an angle from rest and an azimuth about it.
pub(crate) fn polar(rest: Vec3, azimuth: f64, angle: f64) -> Vec3 {
    let side = rest.cross(Vec3::new(0.3, -0.5, 0.8)).normalized();
    let outward = side * azimuth.cos() + rest.cross(side) * azimuth.sin();
    rest * angle.cos() + outward * angle.sin()
}

pub(crate) fn around(rest: Vec3, angles: &[f64]) -> Vec<Vec3> {
    let azimuth = |i: usize| TAU * i as f64 / angles.len() as f64;
    angles.iter().enumerate().map(|(i, &angle)| polar(rest, azimuth(i), angle)).collect()
}

/// Teeth with one edge nearly along a meridian, at 0.08 degrees to it.
fn saw(rest: Vec3) -> Vec<Vec3> {
    let tooth = |i: u32| {
        let azimuth = 0.3 + f64::from(i) * 0.25 * TAU;
        [polar(rest, azimuth, 0.5), polar(rest, azimuth + 2e-3, 1.2)]
    };
    (0..4).flat_map(tooth).collect()
}

/// Named polygons with their rest directions and subdivisions.
pub(crate) fn shapes() -> Vec<(&'static str, Vec3, Vec<Vec3>, u32)> {
    let rest = Vec3::new(0.4, -0.7, 0.3).normalized();
    let star = [1.1, 0.4, 1.2, 0.5, 0.9, 0.35, 1.3, 0.6, 1.0, 0.45];
    let vast = [2.6, 1.5, 2.2, 1.9, 2.8, 1.4, 2.5];
    let mut all = vec![
        ("triangle", rest, around(rest, &[0.9, 0.6, 0.7]), 0),
        ("convex", rest, around(rest, &[0.7, 0.75, 0.8, 0.72, 0.66]), 0),
        ("hemisphere", rest, around(rest, &[FRAC_PI_2; 8]), 0),
        ("star", rest, around(rest, &star), 0),
        ("refined star", rest, around(rest, &star), 2),
        ("saw", rest, saw(rest), 0),
        ("vast", rest, around(rest, &vast), 0),
        ("refined vast", rest, around(rest, &vast), 3),
    ];
    let mut random = Random(7);
    for subdivisions in [0, 3, 6] {
        let rest = random.direction();
        let points = (0..7).map(|i| {
            let azimuth = (i as f64 + random.within(-0.2, 0.2)) * TAU / 7.0;
            polar(rest, azimuth, random.within(0.5, 1.6))
        });
        // Clockwise, to be reversed.
        let points: Vec<Vec3> = points.collect::<Vec<_>>().into_iter().rev().collect();
        all.push(("random", rest, points, subdivisions));
    }
    all
}

pub(crate) fn make(rest: Vec3, points: &[Vec3], subdivisions: u32, projection: Projection) -> Cone {
    let points = points.iter().map(|&direction| ConePoint { direction, twist: None }).collect();
    Cone::new(rest, None, points, subdivisions, projection).unwrap()
}

/// A cone with its own twist bounds at every other point.
pub(crate) fn twisted(
    rest: Vec3,
    points: &[Vec3],
    subdivisions: u32,
    projection: Projection,
) -> Cone {
    let mut random = Random(points.len() as u64);
    let points = points.iter().enumerate().map(|(i, &direction)| {
        let bounds = [random.within(-1.2, -0.1), random.within(-0.1, 1.5)];
        ConePoint { direction, twist: (i % 2 == 0).then_some(bounds) }
    });
    Cone::new(rest, Some([-0.9, 0.6]), points.collect(), subdivisions, projection).unwrap()
}

pub(crate) fn edges(cone: &Cone) -> Vec<[Vec3; 2]> {
    let corners: Vec<Vec3> = cone.boundary().collect();
    (0..corners.len()).map(|i| [corners[i], corners[(i + 1) % corners.len()]]).collect()
}

/// The angle to an arc: to its plane where the foot is on it, to the nearer end elsewhere.
pub(crate) fn angle_to_arc(v: Vec3, [p, q]: [Vec3; 2]) -> f64 {
    let normal = p.cross(q).normalized();
    let foot = v - normal * v.dot(normal);
    let on_arc = normal.dot(p.cross(foot)) >= 0.0 && normal.dot(foot.cross(q)) >= 0.0;
    let ends = angle(v, p).min(angle(v, q));
    if on_arc { ends.min(v.dot(normal).abs().atan2(foot.norm())) } else { ends }
}

pub(crate) fn angle_to_boundary(v: Vec3, edges: &[[Vec3; 2]]) -> f64 {
    edges.iter().map(|&edge| angle_to_arc(v, edge)).fold(f64::INFINITY, f64::min)
}

/// Whether the arc from a to b and an edge cross: (a × b) × (p × q) lies in both or in neither.
pub(crate) fn crosses(a: Vec3, b: Vec3, [p, q]: [Vec3; 2]) -> bool {
    let (along, edge) = (a.cross(b), p.cross(q));
    let signs = [along.dot(q), -along.dot(p), edge.dot(a), -edge.dot(b)];
    signs.iter().all(|&s| s > 0.0) || signs.iter().all(|&s| s < 0.0)
}
