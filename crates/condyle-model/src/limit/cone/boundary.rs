//! The spherical polygon: where a direction stands to it.
//!
//! With the points p of the boundary counter-clockwise around the rest direction r, and the
//! normals n = p × p' / |p × p'| of its edges, each of which r sees from inside, n·r > 0:
//!
//! ```text
//! inside           v·n ≥ 0 for the edge in whose wedge of azimuth about r v lies
//! nearest on edge  its foot, where v·(n × p) ≥ 0 and v·(p' × n) ≥ 0, at the angle asin|v·n|
//! nearest corner   the p with the largest v·p; v is inside where v·(n + n') ≥ 0 there
//! crossing         x ∝ (n·r)·e - (n·e)·r, with e the direction at r of the meridian through v
//! ```
//!
//! No meridian meets the polygon twice, for r sees all of it; the direction -r is outside.

use super::block::Blocks;
use condyle_math::Vec3;

/// How deep inside a projected direction is put: above the rounding of what is done with it next.
const DEPTH: f64 = 1e-14;
/// How far it is first moved inward.
const INWARD: f64 = 1e-13;
/// Two directions nearer than this are one.
const SAME: f64 = 1e-9;
/// The cosine of 87 degrees: an edge as far as that is nearly equally far all along.
const POLE: f64 = 0.0523;

/// An edge, from its start counter-clockwise to its end.
#[derive(Clone, Copy, Debug)]
pub(super) struct Edge {
    pub(super) start: Vec3,
    pub(super) end: Vec3,
    /// Normal of the edge's plane, length 1, on the inner side.
    pub(super) normal: Vec3,
    /// The cosine of the edge's length.
    pub(super) cosine: f64,
}

/// A closed line of arcs that the rest direction sees from inside.
#[derive(Clone, Debug)]
pub(super) struct Boundary {
    pub(super) rest: Vec3,
    /// The directions of azimuth 0 and of a quarter turn.
    across: [Vec3; 2],
    /// A number that grows with the azimuth of each edge's start, in [0, 4).
    azimuths: Vec<f64>,
    pub(super) edges: Vec<Edge>,
    blocks: Blocks,
}

/// The point of the boundary that is nearest to a direction.
#[derive(Clone, Copy, Debug)]
pub(super) struct Nearest {
    /// The point, length 1.
    pub(super) point: Vec3,
    /// The angle to it: positive inside, negative outside.
    pub(super) distance: f64,
    /// How the distance grows with the direction: tangent there, length 1.
    pub(super) gradient: Vec3,
    /// The direction at the point that leads inside, length 1.
    inward: Vec3,
}

/// A number in [0, 4] that grows with the azimuth of a point; not a number at the centre.
#[inline]
fn azimuth(x: f64, y: f64) -> f64 {
    let along = x / (x.abs() + y.abs());
    if y >= 0.0 { 1.0 - along } else { 3.0 + along }
}

impl Boundary {
    /// The polygon through checked points; `rest` and the points have length 1.
    pub(super) fn new(rest: Vec3, points: &[Vec3]) -> Self {
        let second = rest.cross(points[0]).normalized();
        let across = [second.cross(rest), second];
        let azimuths = points.iter().enumerate().map(|(i, p)| {
            // Rounding must not put the first one at the end.
            if i == 0 { 0.0 } else { azimuth(p.dot(across[0]), p.dot(across[1])) }
        });
        let azimuths = azimuths.collect();
        let edges = points.iter().enumerate().map(|(i, &start)| {
            let end = points[(i + 1) % points.len()];
            let normal = start.cross(end).normalized();
            Edge { start, end, normal, cosine: start.dot(end) }
        });
        let edges: Vec<Edge> = edges.collect();
        let blocks = Blocks::new(&edges);
        Self { rest, across, azimuths, edges, blocks }
    }

    /// The edge in whose wedge of azimuth a direction lies; the first one for ±rest.
    #[inline]
    pub(super) fn wedge(&self, v: Vec3) -> usize {
        let place = azimuth(v.dot(self.across[0]), v.dot(self.across[1]));
        self.azimuths.partition_point(|&start| start <= place).saturating_sub(1)
    }

    /// Whether a direction of length 1 lies inside or on the boundary.
    #[inline]
    pub(super) fn contains(&self, v: Vec3) -> bool {
        v.dot(self.edges[self.wedge(v)].normal) >= 0.0
    }

    /// The nearest point of the boundary to a direction of length 1.
    #[inline]
    pub(super) fn nearest(&self, v: Vec3) -> Nearest {
        let found = self.blocks.search(v);
        // Squared sines keep the digits of small angles; a corner beyond 90 degrees never wins.
        let chord = (v - self.edges[found.corner].end).norm_squared();
        let corner = chord * (1.0 - 0.25 * chord);
        if found.square.is_finite() && (found.cosine <= 0.0 || corner >= found.square) {
            self.on_edge(v, found.arc)
        } else {
            self.on_corner(v, found.corner)
        }
    }

    fn on_edge(&self, v: Vec3, index: usize) -> Nearest {
        let edge = &self.edges[index];
        let sine = v.dot(edge.normal);
        let foot = v - edge.normal * sine;
        let cosine = foot.norm();
        // At the pole of the edge all of it is equally far: its middle is taken.
        let (point, gradient) = if cosine > 1e-12 {
            let point = foot * (1.0 / cosine);
            (point, edge.normal * cosine - point * sine)
        } else {
            let point = (edge.start + edge.end).normalized();
            (point, point * -sine)
        };
        Nearest { point, distance: sine.atan2(cosine), gradient, inward: edge.normal }
    }

    fn on_corner(&self, v: Vec3, index: usize) -> Nearest {
        let point = self.edges[index].end;
        let inward = self.inward_at_corner(index);
        let away = v - point;
        let tangent = away - v * away.dot(v);
        let sine = tangent.norm();
        let side = if v.dot(inward) < 0.0 { -1.0 } else { 1.0 };
        // At the corner itself, and opposite to it, the mean of the normals is the choice.
        let gradient = if sine > 1e-12 { tangent * (side / sine) } else { inward };
        Nearest { point, distance: side * sine.atan2(v.dot(point)), gradient, inward }
    }

    /// The mean of the normals of the edges that meet at an edge's end, length 1.
    fn inward_at_corner(&self, index: usize) -> Vec3 {
        let next = if index + 1 == self.edges.len() { 0 } else { index + 1 };
        (self.edges[index].normal + self.edges[next].normal).normalized()
    }

    /// How much farther than the nearest point is the best other local minimum of the distance.
    ///
    /// For a direction outside; infinite where there is none. Only points seen from outside count:
    /// the others can become nearest only to a direction inside.
    pub(super) fn margin(&self, v: Vec3, nearest: &Nearest) -> f64 {
        if v.dot(nearest.point).abs() < POLE {
            return 0.0;
        }
        let other = |point: Vec3| (point - nearest.point).norm() > SAME;
        let (mut square, mut corner) = (f64::INFINITY, f64::NEG_INFINITY);
        let last = &self.edges[self.edges.len() - 1];
        let mut start = v.dot(last.end);
        // Of the edge before: its sine, and whether its foot lies beyond its end.
        let mut before = v.dot(last.normal);
        let mut beyond = v.dot(last.start) <= last.cosine * start;
        for edge in &self.edges {
            let (end, sine) = (v.dot(edge.end), v.dot(edge.normal));
            let (from_start, to_end) = (end - edge.cosine * start, start - edge.cosine * end);
            // The corner at the start is nearer than both edges, and seen from outside.
            if beyond
                && from_start <= 0.0
                && before + sine < 0.0
                && start > corner
                && other(edge.start)
            {
                corner = start;
            }
            if from_start >= 0.0 && to_end >= 0.0 && sine < 0.0 && sine * sine < square {
                let foot = v - edge.normal * sine;
                if other(foot * (1.0 / foot.norm())) {
                    square = sine * sine;
                }
            }
            (start, before, beyond) = (end, sine, to_end <= 0.0);
        }
        let by_edge = if square.is_finite() { square.sqrt().min(1.0).asin() } else { square };
        let by_corner = if corner.is_finite() { corner.clamp(-1.0, 1.0).acos() } else { -corner };
        (by_edge.min(by_corner) - nearest.distance.abs()).max(0.0)
    }

    /// Where the meridian from rest through a direction crosses the boundary; none for ±rest.
    pub(super) fn crossing(&self, v: Vec3) -> Option<Vec3> {
        let outward = v - self.rest * v.dot(self.rest);
        if outward.norm() < 1e-12 {
            return None;
        }
        let outward = outward.normalized();
        let normal = self.edges[self.wedge(v)].normal;
        Some((outward * normal.dot(self.rest) - self.rest * normal.dot(outward)).normalized())
    }

    /// The nearest point, moved so little inside that it passes every later test.
    pub(super) fn settle_nearest(&self, nearest: &Nearest) -> Vec3 {
        self.settle(nearest.point, nearest.inward)
    }

    /// A direction inside, moved deeper where it is nearly outside.
    pub(super) fn settle_inside(&self, v: Vec3) -> Vec3 {
        self.settle(v, self.edges[self.wedge(v)].normal)
    }

    /// A direction at the boundary or inside, moved inside by rounding's worth if it is not.
    ///
    /// Tries the inward direction, then toward rest, which leads inside from every point.
    pub(super) fn settle(&self, point: Vec3, inward: Vec3) -> Vec3 {
        if self.depth(point) >= DEPTH {
            return point;
        }
        let toward_rest = (self.rest - point * self.rest.dot(point)).normalized();
        let mut step = INWARD;
        while step < 1.0 {
            for direction in [inward, toward_rest] {
                let moved = (point + direction * step).normalized();
                if self.depth(moved) >= DEPTH {
                    return moved;
                }
            }
            step *= 4.0;
        }
        self.rest
    }

    /// The sine of the distance to the great circle of the wedge's edge.
    ///
    /// Where rounding could choose the wedge beside it, the smaller of the two.
    fn depth(&self, v: Vec3) -> f64 {
        let i = self.wedge(v);
        let count = self.edges.len();
        let edge = &self.edges[i];
        let mut depth = v.dot(edge.normal);
        let meridian = self.rest.cross(v);
        if meridian.dot(edge.start).abs() < 1e-12 {
            depth = depth.min(v.dot(self.edges[(i + count - 1) % count].normal));
        }
        if meridian.dot(edge.end).abs() < 1e-12 {
            depth = depth.min(v.dot(self.edges[(i + 1) % count].normal));
        }
        depth
    }
}
