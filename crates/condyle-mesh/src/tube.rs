//! Curves swept with an ellipse.

use crate::curve::{self, Knot};
use crate::mesh::{Mesh, beside, unit};
use condyle_math::Vec3;
use std::f64::consts::{FRAC_PI_2, TAU};

/// A point of a tube's axis, with its section there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Station {
    /// Where, in metres.
    pub at: Vec3,
    /// The semi-axes of the section: along [`Tube::across`], and at a right angle to it.
    pub radii: [f64; 2],
}

/// A smooth curve swept with an ellipse, with rounded ends: shafts, processes, clavicles, ribs, a skull as a stack
/// of ellipses.
#[derive(Clone, Debug, PartialEq)]
pub struct Tube {
    /// From one end to the other.
    pub stations: Vec<Station>,
    /// The direction of the first semi-axis, as far as it is at a right angle to the curve.
    pub across: Vec3,
}

/// Points of the curve to each span between stations.
const STEPS: usize = 6;

impl Tube {
    /// The axis of the tube and its sections.
    fn knots(&self) -> Vec<Knot> {
        self.stations.iter().map(|s| (s.at, s.radii)).collect()
    }

    /// The points of its axis, both ends included.
    #[must_use]
    pub fn axis(&self) -> Vec<Vec3> {
        curve::through(&self.knots(), false, STEPS).into_iter().map(|(p, _)| p).collect()
    }

    pub(crate) fn mesh(&self) -> Mesh {
        swept(&curve::through(&self.knots(), false, STEPS), self.across)
    }
}

/// How far the surface may be from the smooth one where a ring is left out, in metres.
const FLATNESS: f64 = 2e-4;

/// The curve without the points between whose neighbours it is straight, and grows evenly, all the same.
fn thinned(curve: &[Knot]) -> Vec<Knot> {
    let mut kept = curve[..1].to_vec();
    let mut from = 0;
    while from + 1 < curve.len() {
        let straight = |&to: &usize| {
            let ((start, first), (end, last)) = (curve[from], curve[to]);
            (from + 1..to).all(|i| {
                let ((at, radii), share) = (curve[i], (i - from) as f64 / (to - from) as f64);
                let on = start + (end - start) * share;
                let thick = |k: usize| first[k] + (last[k] - first[k]) * share - radii[k];
                (at - on).norm() < FLATNESS && thick(0).abs().max(thick(1).abs()) < FLATNESS
            })
        };
        // At most two spans of a tube at once: what bends with two segments needs some rings.
        let next = (from + 1..=(from + 2 * STEPS).min(curve.len() - 1)).take_while(straight).last();
        from = next.unwrap_or(from + 1);
        kept.push(curve[from]);
    }
    kept
}

/// The surface of a curve with its sections.
pub(crate) fn swept(curve: &[Knot], across: Vec3) -> Mesh {
    if curve.is_empty() {
        return Mesh::default();
    }
    let widest = curve.iter().flat_map(|(_, r)| *r).fold(0.0, f64::max);
    // About 5 mm from corner to corner, 8 to 24 of them.
    let around = ((TAU * widest / 0.005) as usize).clamp(8, 24);
    let curve = &thinned(curve)[..];
    let tangent = |i: usize| {
        let (a, b) = (i.saturating_sub(1), (i + 1).min(curve.len() - 1));
        unit(curve[b].0 - curve[a].0)
    };
    let mut side = across;
    let mut before = tangent(0).unwrap_or(Vec3::Y);
    let mut sections = vec![];
    for (i, &(at, radii)) in curve.iter().enumerate() {
        let along = tangent(i).unwrap_or(before);
        // Where the curve runs along `across`, the section keeps the direction that it had.
        let wanted = unit(across - along * along.dot(across))
            .filter(|_| unit(across).is_some_and(|across| along.cross(across).norm() > 0.2));
        side = wanted
            .or_else(|| unit(side - along * along.dot(side)))
            .unwrap_or_else(|| beside(along));
        before = along;
        sections.push((at, along, side, radii));
    }
    let ring = |at: Vec3, along: Vec3, side: Vec3, radii: [f64; 2]| -> Vec<Vec3> {
        let other = along.cross(side);
        let angles = (0..around).map(|i| TAU * i as f64 / around as f64);
        angles.map(|a| at + side * (radii[0] * a.cos()) + other * (radii[1] * a.sin())).collect()
    };
    let mut rings = vec![];
    // An end is half an ellipsoid, as long as the section is narrow.
    const CAP: usize = 3;
    let cap = |&(at, along, side, radii): &(Vec3, Vec3, Vec3, [f64; 2]), out: f64, step: usize| {
        let (sin, cos) = (FRAC_PI_2 * step as f64 / CAP as f64).sin_cos();
        let reach = radii[0].min(radii[1]) * sin * out;
        (at + along * reach, along, side, radii.map(|r| r * cos))
    };
    let tip = |section: &(Vec3, Vec3, Vec3, [f64; 2]), out: f64| cap(section, out, CAP).0;
    let (Some(start), Some(end)) = (sections.first(), sections.last()) else {
        return Mesh::default();
    };
    for step in (1..CAP).rev() {
        let (at, along, side, radii) = cap(start, -1.0, step);
        rings.push(ring(at, along, side, radii));
    }
    for &(at, along, side, radii) in &sections {
        rings.push(ring(at, along, side, radii));
    }
    for step in 1..CAP {
        let (at, along, side, radii) = cap(end, 1.0, step);
        rings.push(ring(at, along, side, radii));
    }
    Mesh::of_rings(&rings, tip(start, -1.0), tip(end, 1.0))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn tube(points: &[([f64; 3], f64)]) -> Vec<Knot> {
        let stations: Vec<Knot> = points.iter().map(|&(at, r)| (at.into(), [r, r])).collect();
        curve::through(&stations, false, STEPS)
    }

    /// How far a point is from the line through kept points, and its radius from the one there.
    fn off(kept: &[Knot], (at, radii): Knot) -> [f64; 2] {
        let to = |pair: &[Knot]| {
            let ((start, first), (end, last)) = (pair[0], pair[1]);
            let way = end - start;
            let share = ((at - start).dot(way) / way.dot(way)).clamp(0.0, 1.0);
            let radius = first[0] + (last[0] - first[0]) * share;
            [(start + way * share - at).norm(), (radius - radii[0]).abs()]
        };
        kept.windows(2).map(to).min_by(|a, b| a[0].total_cmp(&b[0])).unwrap()
    }

    #[test]
    fn straight_tubes_need_few_rings_and_bent_ones_keep_their_shape() {
        let straight = tube(&[
            ([0.0, 0.0, 0.0], 0.01),
            ([0.0, 0.1, 0.0], 0.01),
            ([0.0, 0.2, 0.0], 0.01),
            ([0.0, 0.3, 0.0], 0.01),
            ([0.0, 0.4, 0.0], 0.01),
        ]);
        // One ring at each end and one every two spans.
        assert_eq!(thinned(&straight).len(), 3);
        let bent = tube(&[
            ([0.0, 0.0, 0.0], 0.004),
            ([0.03, 0.05, 0.0], 0.012),
            ([0.0, 0.11, 0.02], 0.005),
            ([0.0, 0.2, 0.02], 0.005),
        ]);
        let kept = thinned(&bent);
        assert!(kept.len() < bent.len() && kept[0] == bent[0] && kept.last() == bent.last());
        for knot in bent {
            let [away, thicker] = off(&kept, knot);
            // The nearest place on a line is no farther than the one at the same share of the way, but has
            // a slightly different radius.
            assert!(away < FLATNESS && thicker < 2.0 * FLATNESS, "{away} {thicker}");
        }
        // Straight, but swelling between its ends: the swelling stays.
        let swelling =
            tube(&[([0.0; 3], 0.005), ([0.0, 0.05, 0.0], 0.015), ([0.0, 0.1, 0.0], 0.005)]);
        let widest = thinned(&swelling).iter().map(|(_, radii)| radii[0]).fold(0.0, f64::max);
        assert!((widest - 0.015).abs() < FLATNESS, "{widest}");
        assert_eq!(thinned(&swelling[..1]), swelling[..1]);
    }
}
