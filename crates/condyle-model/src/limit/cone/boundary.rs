//! The spherical polygon: inside test, nearest point, and projections.
//!
//! With the points p of the boundary counter-clockwise around the rest direction r, and the inner
//! normals n = p × p' / |p × p'| of its edges. The polygon is star-shaped about r, n·r > 0 for
//! every edge:
//!
//! ```text
//! inside           v·n ≥ 0 for the edge in whose wedge of azimuth about r v lies
//! nearest on edge  its foot, where v·(n × p) ≥ 0 and v·(p' × n) ≥ 0, at the angle asin|v·n|
//! nearest corner   the p with the largest v·p; v is inside where v·(n + n') ≥ 0 there
//! crossing         x ∝ (n·r)·e - (n·e)·r, with e the direction at r of the meridian through v
//! ```
//!
//! Since the polygon is star-shaped, every meridian crosses it once; the direction -r is outside.

use super::block::Blocks;
use condyle_math::Vec3;

/// The depth inside to which a projected direction is moved: above the rounding of later
/// operations.
const DEPTH: f64 = 1e-14;
/// The first step inward.
const INWARD: f64 = 1e-13;
/// Two directions with a smaller difference count as the same.
const SAME: f64 = 1e-9;
/// The cosine of 87 degrees: all points of an edge at that distance are nearly equally far.
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

/// A closed polygon of great arcs, star-shaped about the rest direction.
#[derive(Clone, Debug)]
pub(super) struct Boundary {
    pub(super) rest: Vec3,
    /// The directions of azimuth 0 and 90 degrees, perpendicular to rest.
    across: [Vec3; 2],
    /// The pseudo-angle (see [`azimuth`]) of each edge's start, in [0, 4), increasing.
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
    /// The gradient of the distance with respect to the direction: tangent at it, length 1.
    pub(super) gradient: Vec3,
    /// The inward direction at the point, length 1.
    inward: Vec3,
}

/// A pseudo-angle in [0, 4] that increases with the azimuth, without atan2; NaN at the centre.
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
            // Exactly 0: rounding could give the first point a pseudo-angle near 4.
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
        // For ±rest the pseudo-angle is NaN: no start is below it, and the subtraction saturates.
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
        // sin² = c²·(1 - c²/4) from the chord c is accurate for small angles, unlike 1 - cos². The
        // sine falls beyond 90 degrees, but every foot is nearer than a corner that far away.
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
        // v = point·cos d + n·sin d with d the distance, so the gradient is n·cos d - point·sin d.
        let foot = v - edge.normal * sine;
        let cosine = foot.norm();
        // At the pole of the edge all its points are equally far: its middle is used.
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
        // The tangent at v that leads away from the corner: v·cos d - p, of length sin d, from the
        // difference v - p to avoid cancellation.
        let away = v - point;
        let tangent = away - v * away.dot(v);
        let sine = tangent.norm();
        let side = if v.dot(inward) < 0.0 { -1.0 } else { 1.0 };
        // At the corner, and opposite to it, the gradient is not defined: the mean normal is used.
        let gradient = if sine > 1e-12 { tangent * (side / sine) } else { inward };
        Nearest { point, distance: side * sine.atan2(v.dot(point)), gradient, inward }
    }

    /// The normalised mean of the normals of the two edges that meet at the end of an edge.
    fn inward_at_corner(&self, index: usize) -> Vec3 {
        let next = if index + 1 == self.edges.len() { 0 } else { index + 1 };
        (self.edges[index].normal + self.edges[next].normal).normalized()
    }

    /// By how many radians the second smallest local minimum of the distance exceeds the smallest.
    ///
    /// For a direction outside; infinite if there is only one. Only minima whose edges face the
    /// direction count: the others can become nearest only to a direction inside.
    pub(super) fn margin(&self, v: Vec3, nearest: &Nearest) -> f64 {
        if v.dot(nearest.point).abs() < POLE {
            return 0.0;
        }
        let other = |point: Vec3| (point - nearest.point).norm() > SAME;
        let (mut square, mut corner) = (f64::INFINITY, f64::NEG_INFINITY);
        let last = &self.edges[self.edges.len() - 1];
        let mut start = v.dot(last.end);
        // Of the previous edge: its sine, and whether its foot is beyond its end.
        let mut before = v.dot(last.normal);
        let mut beyond = v.dot(last.start) <= last.cosine * start;
        for edge in &self.edges {
            let (end, sine) = (v.dot(edge.end), v.dot(edge.normal));
            let (from_start, to_end) = (end - edge.cosine * start, start - edge.cosine * end);
            // A local minimum at a corner: both feet are beyond it, and it faces the direction.
            if beyond
                && from_start <= 0.0
                && before + sine < 0.0
                && start > corner
                && other(edge.start)
            {
                corner = start;
            }
            // A local minimum on an edge.
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

    /// The crossing of the boundary with the meridian from rest through a direction; `None` for
    /// ±rest.
    pub(super) fn crossing(&self, v: Vec3) -> Option<Vec3> {
        let outward = v - self.rest * v.dot(self.rest);
        if outward.norm() < 1e-12 {
            return None;
        }
        let outward = outward.normalized();
        // (n·r)·e - (n·e)·r is perpendicular to n and in the plane of r and e; n·r > 0 puts it on
        // the side of e.
        let normal = self.edges[self.wedge(v)].normal;
        Some((outward * normal.dot(self.rest) - self.rest * normal.dot(outward)).normalized())
    }

    /// The nearest point, moved inside by as little as makes it pass later inside tests.
    pub(super) fn settle_nearest(&self, nearest: &Nearest) -> Vec3 {
        self.settle(nearest.point, nearest.inward)
    }

    /// A direction inside, moved deeper if it is within rounding of the boundary.
    pub(super) fn settle_inside(&self, v: Vec3) -> Vec3 {
        self.settle(v, self.edges[self.wedge(v)].normal)
    }

    /// A direction at the boundary, moved inside to [`DEPTH`] if it is not that deep.
    ///
    /// Tries the inward direction, then the direction toward rest, which leads inside from every
    /// point of a star-shaped polygon. The steps grow until one succeeds.
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
    /// If rounding could select the adjacent wedge, the smaller of the two.
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
