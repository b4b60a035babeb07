//! Ribs from published parameters.
//!
//! In the plane of a rib its head is the origin, X runs along the chord to the front end and Y outward, and lengths
//! are parts of the chord. The centreline is a straight neck, a logarithmic spiral up to the peak, and another from
//! the peak to (1, 0) (Holcombe, Wang & Grotberg 2017, J Anat 231:229, with the six parameters of their model):
//!
//! ```text
//! neck        from (0, 0) at the inner angle φ, tangent to the proximal spiral
//! proximal    e^(Bp t) (cos t, sin t), turned by α = atan2(Y, X) and scaled: level at the peak
//! distal      e^(Bd t) (-cos t, sin t), scaled: from its top, at the peak, to (1, 0)
//! ```
//!
//! A logarithmic spiral turns by as much as its parameter, so the ends of the proximal one are known: with
//! δ = atan2(1, Bp), it is level at the peak at t = π - δ - α, and meets the neck at t = π - δ + φ - α.

use crate::curve::Knot;
use crate::mesh::{Mesh, unit};
use crate::tube::swept;
use condyle_math::Vec3;

/// A rib by the six parameters of its shape, and how it lies.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rib {
    /// Where its head is, in metres.
    pub at: Vec3,
    /// The distance from its head to its front end, in metres.
    pub chord: f64,
    /// The point farthest from the chord, as parts of it: along and outward.
    pub peak: [f64; 2],
    /// The angle between chord and neck, radians.
    pub angle: f64,
    /// The exponent of the spiral behind the peak.
    pub proximal: f64,
    /// The exponent of the spiral before the peak.
    pub distal: f64,
    /// The direction of the chord.
    pub along: Vec3,
    /// The direction in which it bulges, as far as it is at a right angle to the chord.
    pub outward: Vec3,
    /// The semi-axes of its section: in its plane, and at a right angle to it; metres.
    pub radii: [f64; 2],
}

/// Points of each spiral.
const POINTS: usize = 16;

impl Rib {
    /// The directions of a right rib with upright axes: how far its chord falls below the horizontal, swings out of
    /// the forward direction, and how far its plane is turned about the chord, 0 where the arch is level at the
    /// side and positive up; radians. First the chord, then the direction in which it bulges.
    ///
    /// ```
    /// use condyle_math::Vec3;
    /// let [along, outward] = condyle_mesh::Rib::directions(0.0, 0.0, 0.0);
    /// assert_eq!([along, outward], [Vec3::X, Vec3::Z]);
    /// ```
    #[must_use]
    pub fn directions(pump: f64, swing: f64, plane: f64) -> [Vec3; 2] {
        let (down, level) = pump.sin_cos();
        let (side, front) = swing.sin_cos();
        let along = Vec3::new(level * front, -down, level * side);
        let beside = Vec3::new(-side, 0.0, front);
        let up = beside.cross(along);
        [along, beside * plane.cos() + up * plane.sin()]
    }

    /// The centreline in the plane of the rib, as parts of the chord, from the head to the front end.
    #[must_use]
    pub fn outline(&self) -> Vec<[f64; 2]> {
        let [x, y] = self.peak;
        let alpha = y.atan2(x);
        let delta = 1.0f64.atan2(self.proximal);
        let turn = std::f64::consts::PI - delta;
        let spiral = |exponent: f64, t: f64| {
            let (sin, cos) = t.sin_cos();
            let grown = (exponent * t).exp();
            [grown * cos, grown * sin]
        };
        let [cut, neck] = [turn - alpha, turn + self.angle - alpha];
        let peak = spiral(self.proximal, cut);
        let bend = spiral(self.proximal, neck);
        // Where the neck, drawn on, meets the line from the peak along the cut: the head.
        let head = bend[0] - (bend[1] - peak[1]) / (self.angle - alpha).tan();
        let size = x.hypot(y) / (peak[0] - head);
        let (sin, cos) = alpha.sin_cos();
        let turned = |[u, v]: [f64; 2]| {
            let (u, v) = (size * (u - head), size * (v - peak[1]));
            [u * cos - v * sin, u * sin + v * cos]
        };
        let mut points = vec![[0.0, 0.0]];
        for i in 0..=POINTS {
            let t = neck + (cut - neck) * i as f64 / POINTS as f64;
            points.push(turned(spiral(self.proximal, t)));
        }
        let top = 2.0 * ((self.distal * self.distal + 1.0).sqrt() + self.distal).atan();
        let from = spiral(self.distal, top);
        // From the top the curve only falls, the more steeply the farther, until it has the slope to (1, 0).
        let fall = |t: f64| {
            let p = spiral(self.distal, t);
            [from[0] - p[0], p[1] - from[1]]
        };
        let excess = |t: f64| {
            let [dx, dy] = fall(t);
            dy * (1.0 - x) + y * dx
        };
        let (mut low, mut high) = (top, top + std::f64::consts::PI);
        for _ in 0..80 {
            let t = 0.5 * (low + high);
            if excess(t) > 0.0 { low = t } else { high = t }
        }
        let end = fall(low);
        let size = (1.0 - x).hypot(y) / end[0].hypot(end[1]);
        for i in 1..=POINTS {
            let [dx, dy] = fall(top + (low - top) * i as f64 / POINTS as f64);
            points.push([x + size * dx, y + size * dy]);
        }
        points
    }

    /// The centreline in metres, from the head to the front end.
    #[must_use]
    pub fn centreline(&self) -> Vec<Vec3> {
        let along = unit(self.along).unwrap_or(Vec3::X);
        let outward = unit(self.outward - along * along.dot(self.outward)).unwrap_or(Vec3::Z);
        let place =
            |[x, y]: [f64; 2]| self.at + along * (self.chord * x) + outward * (self.chord * y);
        self.outline().into_iter().map(place).collect()
    }

    pub(crate) fn mesh(&self) -> Mesh {
        let along = unit(self.along).unwrap_or(Vec3::X);
        let normal = along.cross(self.outward);
        let [inside, up] = self.radii;
        let knots: Vec<Knot> = self.centreline().into_iter().map(|p| (p, [up, inside])).collect();
        swept(&knots, normal)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rib(chord: f64, peak: [f64; 2], degrees: f64, proximal: f64, distal: f64) -> Rib {
        let [along, outward] = [Vec3::X, Vec3::Z];
        let (at, angle, radii) = (Vec3::ZERO, degrees.to_radians(), [0.003, 0.006]);
        Rib { at, chord, peak, angle, proximal, distal, along, outward, radii }
    }

    /// The men's ribs of Holcombe et al. 2017: parameters, and the length of the centreline and the depth of the
    /// arch in mm as another implementation of their model computes them from the same parameters.
    #[test]
    fn ribs_have_the_length_and_depth_of_the_published_model() {
        let rows = [
            (71.9, [0.390, 0.523], 80.0, -0.449, 1.742, 113.0, 38.0),
            (113.4, [0.321, 0.628], 110.6, -0.341, 0.713, 213.0, 71.0),
            (170.6, [0.316, 0.533], 112.8, -0.487, -0.098, 294.0, 91.0),
            (202.7, [0.297, 0.444], 110.4, -0.425, -0.537, 314.0, 90.0),
            (215.6, [0.306, 0.372], 103.1, -0.352, -0.269, 300.0, 80.0),
            (189.7, [0.376, 0.335], 89.9, -0.524, -0.120, 248.0, 63.0),
            (97.2, [0.378, 0.179], 60.7, -0.907, 1.003, 106.0, 17.0),
        ];
        for (chord, peak, angle, proximal, distal, arc, depth) in rows {
            let line = rib(chord * 1e-3, peak, angle, proximal, distal).centreline();
            let length: f64 = line.windows(2).map(|w| (w[1] - w[0]).norm()).sum();
            let deepest = line.iter().map(|p| p.z).fold(0.0, f64::max);
            assert!((length * 1e3 - arc).abs() < 1.5, "{length} for {arc}");
            assert!((deepest * 1e3 - depth).abs() < 1.0, "{deepest} for {depth}");
            assert!((line[line.len() - 1] - Vec3::X * (chord * 1e-3)).norm() < 1e-6);
            assert_eq!(line[0], Vec3::ZERO);
        }
    }

    /// The neck leaves the head at the inner angle, and the curve is smooth where its pieces meet.
    #[test]
    fn a_rib_is_smooth_and_leaves_its_head_at_the_inner_angle() {
        let line = rib(1.0, [0.297, 0.444], 110.4, -0.425, -0.537).outline();
        let [x, y] = line[1];
        assert!((y.atan2(x).to_degrees() - 110.4).abs() < 1e-9);
        let direction = |i: usize| {
            let ([a, b], [c, d]) = (line[i], line[i + 1]);
            (d - b).atan2(c - a)
        };
        for i in 1..line.len() - 1 {
            let turn = (direction(i) - direction(i - 1)).to_degrees();
            assert!(turn <= 1e-6 && turn > -13.0, "{turn} at point {i}");
        }
    }
}
