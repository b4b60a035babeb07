//! Subdivision of the control points to the refined polygon, counter-clockwise around the rest
//! direction.
//!
//! The four-point scheme of Dyn, Levin & Gregory 1987 inserts a point between b and c of four
//! consecutive points a, b, c, d, which doubles the number of points:
//!
//! ```text
//! q = 9/16·(b + c) - 1/16·(a + d)
//! ```
//!
//! The scheme is interpolating: every control point stays on the boundary, whereas a corner-cutting
//! scheme would tighten the limit. The formula is applied in the azimuthal equidistant chart about
//! the rest direction, q = θ·(cos φ, sin φ) with θ the angle from rest and φ the azimuth, which
//! covers more than a hemisphere. Twist bounds are interpolated linearly instead: bounds that do
//! not cross at the points then cross nowhere.

use super::{Cone, ConeError, ConePoint};
use condyle_math::Vec3;
use std::f64::consts::{PI, TAU};

/// The smallest sine of the length of an edge, and of the angle of a point to rest or its opposite.
///
/// Far above rounding, far below any measurement: 0.2 arc seconds.
const LEAST: f64 = 1e-6;
/// The smallest sine of the angle between rest and the plane of an edge, 0.06 degrees.
///
/// On an edge along a meridian the crossing of the meridian, and with it the twist bounds, change
/// abruptly with the azimuth.
const SEEN: f64 = 1e-3;

/// A point of the outline: its direction, of length 1, and its twist bounds.
#[derive(Clone, Copy)]
pub(super) struct OutlinePoint {
    pub(super) direction: Vec3,
    pub(super) twist: Option<[f64; 2]>,
}

/// The normalised vector; `None` if it is zero or not finite.
#[inline]
pub(super) fn unit(vector: Vec3) -> Option<Vec3> {
    let largest = vector.x.abs().max(vector.y.abs()).max(vector.z.abs());
    if !vector.is_finite() || largest == 0.0 {
        return None;
    }
    // The squares of very large or very small components would overflow or underflow.
    let scaled = if (1e-100..1e100).contains(&largest) {
        vector
    } else {
        Vec3::new(vector.x / largest, vector.y / largest, vector.z / largest)
    };
    Some(scaled.normalized())
}

/// Checks the points, orders them counter-clockwise and refines them.
///
/// `rest` has length 1.
pub(super) fn outline(
    rest: Vec3,
    twist_at_rest: Option<[f64; 2]>,
    points: &[ConePoint],
    subdivisions: u32,
) -> Result<Vec<OutlinePoint>, ConeError> {
    let count = points.len();
    if count < 3 {
        return Err(ConeError::TooFewPoints { count });
    }
    let refined_count = 1usize.checked_shl(subdivisions).and_then(|f| f.checked_mul(count));
    if refined_count.is_none_or(|refined| refined > Cone::MOST_POINTS) {
        return Err(ConeError::TooManyPoints { count, subdivisions });
    }
    check_twist(twist_at_rest, None)?;
    let mut line = Vec::with_capacity(count);
    for (point, given) in points.iter().enumerate() {
        let direction = unit(given.direction).ok_or(ConeError::NoDirection { point })?;
        check_twist(given.twist, Some(point))?;
        if given.twist.is_some() && twist_at_rest.is_none() {
            return Err(ConeError::NoTwistAtRest { point });
        }
        line.push(OutlinePoint { direction, twist: given.twist.or(twist_at_rest) });
    }
    check_edges(rest, &line)?;
    let clockwise = winding(rest, &line) < 0;
    if clockwise {
        line.reverse();
    }
    // The positions of an edge's ends as the caller gave the points, before the reversal.
    let edge = |index: usize, refined| {
        let next = (index + 1) % count;
        let (from, to) =
            if clockwise { (count - 1 - next, count - 1 - index) } else { (index, next) };
        ConeError::Hidden { from, to, refined }
    };
    check_visible(rest, &line).map_err(|index| match index {
        Some(index) => edge(index, false),
        None => ConeError::WoundTwice,
    })?;
    let chart = Chart::new(rest, line[0].direction);
    // After s steps, edge `index` is a part of the given edge `index >> s`.
    for step in 1..=subdivisions {
        line = refined(&chart, &line).map_err(|index| edge(index >> (step - 1), true))?;
    }
    check_visible(rest, &line).map_err(|index| match index {
        Some(index) => edge(index >> subdivisions, true),
        None => ConeError::WoundTwice,
    })?;
    Ok(line)
}

fn check_twist(bounds: Option<[f64; 2]>, point: Option<usize>) -> Result<(), ConeError> {
    let Some([lower, upper]) = bounds else { return Ok(()) };
    // NaN is in no range.
    if !(-TAU..=TAU).contains(&lower) || !(-TAU..=TAU).contains(&upper) {
        return Err(ConeError::TwistRange { point });
    }
    if lower > upper { Err(ConeError::TwistCrossing { point }) } else { Ok(()) }
}

/// Checks that azimuths and edges are well defined and that rest is inside.
fn check_edges(rest: Vec3, line: &[OutlinePoint]) -> Result<(), ConeError> {
    let count = line.len();
    for (from, point) in line.iter().enumerate() {
        let to = (from + 1) % count;
        let (p, q) = (point.direction, line[to].direction);
        if rest.cross(p).norm() < LEAST {
            return Err(if rest.dot(p) > 0.0 {
                ConeError::RestOutside
            } else {
                ConeError::OppositeRest { point: from }
            });
        }
        let normal = p.cross(q);
        if normal.norm() < LEAST {
            return Err(if p.dot(q) > 0.0 {
                ConeError::Coincident { from, to }
            } else {
                ConeError::HalfTurn { from, to }
            });
        }
        let normal = normal.normalized();
        // The foot of rest is on the arc: rest must not be on the edge itself.
        let between = rest.dot(normal.cross(p)) > 0.0 && rest.dot(q.cross(normal)) > 0.0;
        if between && rest.dot(normal).abs() < LEAST {
            return Err(ConeError::RestOutside);
        }
    }
    if winding(rest, line) == 0 { Err(ConeError::RestOutside) } else { Ok(()) }
}

/// The winding number of the line around the rest direction, counter-clockwise.
fn winding(rest: Vec3, line: &[OutlinePoint]) -> i64 {
    let mut turned = 0.0;
    for (i, point) in line.iter().enumerate() {
        let (p, q) = (point.direction, line[(i + 1) % line.len()].direction);
        // The change of azimuth, from sine and cosine of the projections across rest.
        turned += rest.dot(p.cross(q)).atan2(p.dot(q) - rest.dot(p) * rest.dot(q));
    }
    (turned / TAU).round() as i64
}

/// Checks that every edge of a counter-clockwise line is visible from rest and that it winds once;
/// the error is the first hidden edge, or `None` for another winding number.
fn check_visible(rest: Vec3, line: &[OutlinePoint]) -> Result<(), Option<usize>> {
    for (i, point) in line.iter().enumerate() {
        let (p, q) = (point.direction, line[(i + 1) % line.len()].direction);
        let normal = p.cross(q);
        // The given points are distinct; refined ones may coincide.
        if normal.norm() < LEAST * LEAST || rest.dot(normal) < SEEN * normal.norm() {
            return Err(Some(i));
        }
    }
    if winding(rest, line) == 1 { Ok(()) } else { Err(None) }
}

/// One subdivision step; the error is the first edge whose new point is outside the chart.
fn refined(chart: &Chart, line: &[OutlinePoint]) -> Result<Vec<OutlinePoint>, usize> {
    let count = line.len();
    let flat: Vec<[f64; 2]> = line.iter().map(|point| chart.flat(point.direction)).collect();
    let mut finer = Vec::with_capacity(2 * count);
    for i in 0..count {
        let [a, b, c, d] = [count - 1, 0, 1, 2].map(|k| flat[(i + k) % count]);
        let middle = [0, 1].map(|k| 9.0 / 16.0 * (b[k] + c[k]) - 1.0 / 16.0 * (a[k] + d[k]));
        let direction = chart.direction(middle).ok_or(i)?;
        let next = line[(i + 1) % count];
        let twist = line[i].twist.zip(next.twist).map(|(p, q)| [0, 1].map(|k| 0.5 * (p[k] + q[k])));
        finer.push(line[i]);
        finer.push(OutlinePoint { direction, twist });
    }
    Ok(finer)
}

/// The azimuthal equidistant chart about the rest direction.
struct Chart {
    rest: Vec3,
    across: [Vec3; 2],
}

impl Chart {
    /// The chart with azimuth 0 toward a direction.
    fn new(rest: Vec3, toward: Vec3) -> Self {
        let second = rest.cross(toward).normalized();
        Self { rest, across: [second.cross(rest), second] }
    }

    fn flat(&self, direction: Vec3) -> [f64; 2] {
        let [x, y] = self.across.map(|axis| direction.dot(axis));
        let sine = x.hypot(y);
        let angle = sine.atan2(direction.dot(self.rest));
        [x / sine * angle, y / sine * angle]
    }

    /// The direction at a point of the chart; `None` at rest, and at or beyond the opposite
    /// direction.
    fn direction(&self, [x, y]: [f64; 2]) -> Option<Vec3> {
        let angle = x.hypot(y);
        if !(LEAST..PI - LEAST).contains(&angle) {
            return None;
        }
        let (sine, cosine) = angle.sin_cos();
        let outward = (self.across[0] * x + self.across[1] * y) * (1.0 / angle);
        Some((self.rest * cosine + outward * sine).normalized())
    }
}
