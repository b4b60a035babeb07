//! Curved plates within an outline.

use crate::curve;
use crate::mesh::{Mesh, unit};
use condyle_math::Vec3;

/// A plate within a closed outline: the blade of a scapula, the wing of an ilium.
///
/// With c the centre of the outline, p a point of it and m the middle, the plate's midsurface is
/// `c + s (p - c) + (1 - s²) (m - c)`, s from 0 to 1: a flat plate where m is c, else a shell. Its thickness falls
/// to nothing at the outline.
#[derive(Clone, Debug, PartialEq)]
pub struct Plate {
    /// Points around it, in metres; the curve through them is smooth, but where a point stands twice is a corner.
    /// Every point of the outline is seen from the middle.
    pub outline: Vec<Vec3>,
    /// Where its midsurface is in the middle.
    pub middle: Vec3,
    /// How thick it is in the middle, in metres.
    pub thickness: f64,
}

/// Points of the outline to each span, and rings from the middle to the outline.
const STEPS: usize = 5;
const RINGS: usize = 6;

impl Plate {
    /// The centre of an outline: the mean of its points.
    #[must_use]
    pub fn centre(outline: &[Vec3]) -> Vec3 {
        let mut sum = Vec3::ZERO;
        for &point in outline {
            sum += point;
        }
        sum * (outline.len().max(1) as f64).recip()
    }

    /// The outline as a curve, cut at its corners.
    fn border(&self) -> Vec<Vec3> {
        let count = self.outline.len();
        let corner =
            |i: usize| (self.outline[i % count] - self.outline[(i + 1) % count]).norm() < 1e-9;
        let knot = |i: usize| (self.outline[i % count], [0.0; 2]);
        let Some(first) = (0..count).find(|&i| corner(i)) else {
            let knots: Vec<_> = (0..count).map(knot).collect();
            return curve::through(&knots, true, STEPS).into_iter().map(|(p, _)| p).collect();
        };
        let mut border = vec![];
        let mut piece = vec![];
        // From behind the first corner all the way round to it.
        for i in first + 1..=first + count {
            piece.push(knot(i));
            if corner(i % count) {
                let points = curve::through(&piece, false, STEPS);
                border.extend(points.iter().take(points.len().saturating_sub(1)).map(|(p, _)| *p));
                piece.clear();
            }
        }
        border
    }

    pub(crate) fn mesh(&self) -> Mesh {
        let border = self.border();
        if border.len() < 3 {
            return Mesh::default();
        }
        let centre = Self::centre(&self.outline);
        let rise = self.middle - centre;
        let surface = |s: f64, p: Vec3| centre + (p - centre) * s + rise * (1.0 - s * s);
        let mut normal = Vec3::ZERO;
        for i in 0..border.len() {
            normal += (border[i] - centre).cross(border[(i + 1) % border.len()] - centre);
        }
        let whole = unit(normal).unwrap_or(Vec3::X);
        // Normals of the midsurface, by its two slopes.
        let leaned = |s: f64, i: usize| {
            let (p, q) = (border[i], border[(i + 1) % border.len()]);
            let outward = (p - centre) - rise * (2.0 * s);
            unit(outward.cross(q - p)).filter(|n| n.dot(whole) > 0.1).unwrap_or(whole)
        };
        let sheet = |sign: f64, ring: usize| -> Vec<Vec3> {
            let s = ring as f64 / RINGS as f64;
            let half = sign * 0.5 * self.thickness * (1.0 - s.powi(4)).max(0.0).sqrt();
            (0..border.len()).map(|i| surface(s, border[i]) + leaned(s, i) * half).collect()
        };
        let tip = |sign: f64| self.middle + whole * (sign * 0.5 * self.thickness);
        let front = (1..=RINGS).map(|ring| sheet(1.0, ring));
        let back = (1..RINGS).rev().map(|ring| sheet(-1.0, ring));
        let rings: Vec<_> = front.chain(back).collect();
        Mesh::of_rings(&rings, tip(1.0), tip(-1.0))
    }
}
