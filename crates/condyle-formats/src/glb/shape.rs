//! Bones, balls and boxes as triangles.

/// A simple shape in the frame of its node; lengths in metres.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Shape {
    /// A long octahedron from the node's origin, thickest near it.
    Bone {
        /// The far end.
        to: [f64; 3],
    },
    /// A ball.
    Ball {
        /// Its centre.
        at: [f64; 3],
        /// Its radius.
        radius: f64,
        /// How it looks.
        finish: Finish,
    },
    /// A box along the node's axes.
    Box {
        /// Its centre.
        at: [f64; 3],
        /// Its whole size along x, y and z.
        size: [f64; 3],
        /// How it looks.
        finish: Finish,
    },
}

/// How a shape looks.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Default)]
pub enum Finish {
    /// Ivory, for bones.
    #[default]
    Bone,
    /// Grey-blue, for joints and ends.
    Joint,
    /// Orange, for highlights.
    Accent,
    /// Green, for recorded markers.
    Marker,
}

impl Finish {
    /// Name, linear colour and roughness.
    pub(super) fn look(self) -> (&'static str, [f32; 4], f32) {
        match self {
            Self::Bone => ("bone", [0.82, 0.76, 0.63, 1.0], 0.7),
            Self::Joint => ("joint", [0.18, 0.26, 0.36, 1.0], 0.5),
            Self::Accent => ("accent", [0.85, 0.30, 0.05, 1.0], 0.5),
            Self::Marker => ("marker", [0.05, 0.55, 0.22, 1.0], 0.4),
        }
    }
}

/// Triangles with a normal at every corner.
#[derive(Debug, Default)]
pub(super) struct Triangles {
    pub(super) positions: Vec<[f32; 3]>,
    pub(super) normals: Vec<[f32; 3]>,
    pub(super) indices: Vec<u32>,
}

impl Shape {
    pub(super) fn finish(&self) -> Finish {
        match self {
            Self::Bone { .. } => Finish::Bone,
            Self::Ball { finish, .. } | Self::Box { finish, .. } => *finish,
        }
    }

    /// Whether every number is finite and every size positive. A bone of length 0 is well formed,
    /// and not drawn.
    pub(super) fn is_well_formed(&self) -> bool {
        let finite = |v: &[f64; 3]| v.iter().all(|x| x.is_finite() && x.abs() < 1e6);
        let positive = |x: f64| (1e-6..1e6).contains(&x);
        match self {
            Self::Bone { to } => finite(to),
            Self::Ball { at, radius, .. } => finite(at) && positive(*radius),
            Self::Box { at, size, .. } => finite(at) && size.iter().all(|s| positive(*s)),
        }
    }

    /// Adds the shape's triangles, counter-clockwise from outside.
    pub(super) fn add_to(&self, triangles: &mut Triangles) {
        match self {
            Self::Bone { to } => bone(*to, triangles),
            Self::Ball { at, radius, .. } => ball(*at, *radius, triangles),
            Self::Box { at, size, .. } => cuboid(*at, *size, triangles),
        }
    }
}

impl Triangles {
    /// Adds a triangle with the normal of its plane at every corner; nothing if it has no area.
    fn flat(&mut self, corners: [[f64; 3]; 3]) {
        let [a, b, c] = corners;
        let normal = unit(cross(sub(b, a), sub(c, a)));
        let Some(normal) = normal else { return };
        for corner in corners {
            self.indices.push(self.positions.len() as u32);
            self.positions.push(corner.map(|x| x as f32));
            self.normals.push(normal.map(|x| x as f32));
        }
    }
}

fn sub(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

fn along(origin: [f64; 3], direction: [f64; 3], distance: f64) -> [f64; 3] {
    [0, 1, 2].map(|i| origin[i] + direction[i] * distance)
}

fn unit(v: [f64; 3]) -> Option<[f64; 3]> {
    let length = v.iter().map(|x| x * x).sum::<f64>().sqrt();
    (length > 1e-12).then(|| v.map(|x| x / length))
}

/// Adds an octahedron, widest at 15 % of its length; its width is a tenth of it, 4 to 30 mm.
fn bone(to: [f64; 3], triangles: &mut Triangles) {
    let length = to.iter().map(|x| x * x).sum::<f64>().sqrt();
    if length < 1e-4 {
        return;
    }
    let Some(axis) = unit(to) else { return };
    // Any direction that is not along the bone: the axis least aligned with it.
    let least = (0..3).min_by(|i, j| axis[*i].abs().total_cmp(&axis[*j].abs())).unwrap_or(0);
    let mut other = [0.0; 3];
    other[least] = 1.0;
    let Some(side) = unit(cross(axis, other)) else { return };
    let front = cross(axis, side);
    let half = (0.1 * length).clamp(0.004, 0.03).min(0.4 * length) / 2.0;
    let waist = along([0.0; 3], axis, 0.15 * length);
    let ring = [(side, half), (front, half), (side, -half), (front, -half)]
        .map(|(direction, distance)| along(waist, direction, distance));
    for i in 0..4 {
        let (a, b) = (ring[i], ring[(i + 1) % 4]);
        triangles.flat([a, b, to]);
        triangles.flat([b, a, [0.0; 3]]);
    }
}

/// Meridians and parallels of a ball.
const MERIDIANS: u32 = 12;
const PARALLELS: u32 = 8;

fn ball(at: [f64; 3], radius: f64, triangles: &mut Triangles) {
    use std::f64::consts::{PI, TAU};
    let first = triangles.positions.len() as u32;
    for parallel in 0..=PARALLELS {
        let (sin, cos) = (PI * f64::from(parallel) / f64::from(PARALLELS)).sin_cos();
        for meridian in 0..MERIDIANS {
            let (s, c) = (TAU * f64::from(meridian) / f64::from(MERIDIANS)).sin_cos();
            let normal = [sin * c, cos, -sin * s];
            triangles.positions.push(along(at, normal, radius).map(|x| x as f32));
            triangles.normals.push(normal.map(|x| x as f32));
        }
    }
    for parallel in 0..PARALLELS {
        for meridian in 0..MERIDIANS {
            let next = (meridian + 1) % MERIDIANS;
            let corner = |p: u32, m: u32| first + p * MERIDIANS + m;
            let (top, top_next) = (corner(parallel, meridian), corner(parallel, next));
            let (low, low_next) = (corner(parallel + 1, meridian), corner(parallel + 1, next));
            // At the poles one of the two triangles has no area.
            if parallel + 1 < PARALLELS {
                triangles.indices.extend([top, low, low_next]);
            }
            if parallel > 0 {
                triangles.indices.extend([top, low_next, top_next]);
            }
        }
    }
}

fn cuboid(at: [f64; 3], size: [f64; 3], triangles: &mut Triangles) {
    let corner = |sign: [f64; 3]| [0, 1, 2].map(|i| at[i] + sign[i] * size[i] / 2.0);
    for axis in 0..3 {
        let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
        for outward in [1.0, -1.0] {
            let [a, b, c, d] =
                [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)].map(|(p, q)| {
                    let mut sign = [0.0; 3];
                    sign[axis] = outward;
                    sign[u] = p * outward;
                    sign[v] = q;
                    corner(sign)
                });
            triangles.flat([a, b, c]);
            triangles.flat([a, c, d]);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Volume by the divergence theorem: positive only if the triangles face outwards.
    fn volume(shape: Shape) -> f64 {
        let mut triangles = Triangles::default();
        shape.add_to(&mut triangles);
        let p = |i: u32| triangles.positions[i as usize].map(f64::from);
        triangles
            .indices
            .chunks(3)
            .map(|t| {
                let (a, n) = (p(t[0]), cross(p(t[1]), p(t[2])));
                (a[0] * n[0] + a[1] * n[1] + a[2] * n[2]) / 6.0
            })
            .sum()
    }

    #[test]
    fn shapes_are_closed_and_face_outwards() {
        let size = [0.2, 0.3, 0.5];
        let brick = Shape::Box { at: [1.0, 2.0, 3.0], size, finish: Finish::Joint };
        assert!((volume(brick) - 0.03).abs() < 1e-6);

        // Two pyramids on a square of diagonal 0.03, together 0.4 m high: d^2 / 2 * h / 3.
        let octahedron = Shape::Bone { to: [0.0, -0.4, 0.0] };
        assert!((volume(octahedron) - 0.03_f64.powi(2) / 2.0 * 0.4 / 3.0).abs() < 1e-9);

        // A ball of 12 by 8 is inside the true one and not much smaller.
        let ball = volume(Shape::Ball { at: [0.5; 3], radius: 0.1, finish: Finish::Accent });
        let full = 4.0 / 3.0 * std::f64::consts::PI * 1e-3;
        assert!(ball < full && ball > 0.85 * full, "{ball} {full}");
    }

    #[test]
    fn normals_are_of_length_one_and_outwards() {
        let mut triangles = Triangles::default();
        Shape::Ball { at: [0.0; 3], radius: 2.0, finish: Finish::Bone }.add_to(&mut triangles);
        Shape::Bone { to: [0.3, 0.1, -0.2] }.add_to(&mut triangles);
        for normal in &triangles.normals {
            let length = normal.iter().map(|x| x * x).sum::<f32>().sqrt();
            assert!((length - 1.0).abs() < 1e-6);
        }
        assert_eq!(triangles.positions.len(), 9 * 12 + 24);
    }

    #[test]
    fn a_bone_of_no_length_is_nothing() {
        let mut triangles = Triangles::default();
        Shape::Bone { to: [0.0; 3] }.add_to(&mut triangles);
        assert!(triangles.indices.is_empty());
    }
}
