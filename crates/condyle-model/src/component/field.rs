//! A rotation limited by a field learned from recordings (Herda, Urtasun, Fua & Hanson 2003 asked for one; design in
//! `docs/learned-limits.md`).
//!
//! The rotation may be a coordinate of a ball joint, which in posed mode becomes the nearest valid one, or that of any
//! segment in any other, through [`RelativeOrientation`](super::RelativeOrientation): the humerus in the thorax,
//! whatever clavicle and scapula do. Then it gives its row and moves nothing.
//!
//! ```text
//! p = A⁻¹ · q · B      A, B: axes of the limit in those of the reference and of the segment
//! g = d(p)             signed distance to the boundary, radians, positive inside
//! ∂g/∂δ = B · ∂d/∂ω    along q·exp(δ)
//! ```
//!
//! Of the other side of a body the mirror image is asked: of q = (v, w) it is (-D·v, w).
//!
//! Of a limit by formulas that goes some way beyond its ends, g is at most that way, and within the ends no field is asked and
//! none is made: there g is that way, and its slope 0.
//!
//! Holes of the field, where nothing was seen inside the outer boundary, are allowed unless `strict`.
//! Kinks: none in g but where the nearest boundary changes, which the field rounds, and at the ends of formulas; in posed mode
//! at the boundary.

use super::{Contract, Fault, Geometry, Kind, Mirrored, Port, PortType, Reflection};
use crate::limit::field::{LearnedLimit, State};
use crate::limit::{Limit, MOST_LIMITED, MOST_ROWS, NO_ROW, Row};
use condyle_diagnostics::Severity;
use condyle_math::{Quat, Vec3};
use std::sync::Arc;

/// An orientation limited by a learned field.
#[derive(Clone, Debug, PartialEq)]
pub struct FieldLimit {
    /// What was learned.
    pub limit: Arc<LearnedLimit>,
    /// The axes of the limit's reference in those of the model's reference segment, a unit quaternion.
    pub in_reference: Quat,
    /// The axes of the limit's child in those of the model's segment, a unit quaternion.
    pub in_segment: Quat,
    /// Of a limit of the other side of the body, the plane between the sides.
    pub mirrored: Option<Reflection>,
    /// Whether holes, where nothing was seen, are not allowed either.
    pub strict: bool,
}

impl FieldLimit {
    /// A limit whose axes are those of the segments.
    #[must_use]
    pub fn new(limit: Arc<LearnedLimit>) -> Self {
        let (in_reference, in_segment) = (Quat::IDENTITY, Quat::IDENTITY);
        Self { limit, in_reference, in_segment, mirrored: None, strict: false }
    }

    /// A rotation of the segment in its reference as one of the limit.
    #[must_use]
    pub fn inward(&self, q: Quat) -> Quat {
        self.in_reference.conjugate() * self.reflected(q) * self.in_segment
    }

    /// Back from one of the limit.
    #[must_use]
    pub fn outward(&self, p: Quat) -> Quat {
        self.reflected(self.in_reference * p * self.in_segment.conjugate())
    }

    fn reflected(&self, q: Quat) -> Quat {
        match self.mirrored {
            None => q,
            Some(at) => {
                let v = at.turning(q.vector());
                Quat { x: v.x, y: v.y, z: v.z, w: q.w }
            }
        }
    }

    /// Whether an orientation is possible, as the field has it.
    #[must_use]
    pub fn state(&self, q: Quat) -> State {
        let p = self.inward(q);
        match self.within(p) {
            Some(_) => State::Valid,
            None => self.limit.field().state(p).0,
        }
    }

    /// Of a limit by formulas how far it goes beyond their ends, if at all.
    fn beyond_ends(&self) -> Option<f64> {
        self.limit.ground().shape.as_ref().map(|shape| shape.beyond()).filter(|way| *way > 0.0)
    }

    /// The same, of a rotation that is within the ends: at least so far it is inside.
    fn within(&self, p: Quat) -> Option<f64> {
        let shape = self.limit.ground().shape.as_ref()?;
        self.beyond_ends().filter(|_| shape.contains(p))
    }

    fn distance_and_slope(&self, q: Quat) -> (f64, Vec3) {
        let p = self.inward(q);
        if let Some(way) = self.within(p) {
            return (way, Vec3::ZERO);
        }
        let field = self.limit.field();
        let (distance, gradient) = match self.strict {
            true => field.distance_and_gradient(p),
            false => field.outer_distance_and_gradient(p),
        };
        if let Some(way) = self.beyond_ends().filter(|way| distance > *way) {
            return (way, Vec3::ZERO);
        }
        let slope = self.in_segment.to_mat3() * gradient;
        (distance, self.mirrored.map_or(slope, |at| at.turning(slope)))
    }

    fn distance(&self, q: Quat) -> f64 {
        let p = self.inward(q);
        self.within(p).unwrap_or_else(|| {
            let field = self.limit.field();
            let distance = if self.strict { field.distance(p) } else { field.outer_distance(p) };
            self.beyond_ends().map_or(distance, |way| distance.min(way))
        })
    }

    /// The nearest that is allowed, with the sign nearer to the given one.
    fn nearest(&self, q: Quat) -> Quat {
        let (field, p) = (self.limit.field(), self.inward(q));
        let nearest = if self.strict { field.nearest(p) } else { field.outer_nearest(p) };
        let nearest = self.outward(nearest).normalized();
        if nearest.dot(q) < 0.0 { -nearest } else { nearest }
    }
}

fn orientation(numbers: &[f64]) -> Quat {
    let number = |i: usize| numbers.get(i).copied().unwrap_or(0.0);
    Quat { x: number(0), y: number(1), z: number(2), w: number(3) }
}

/// What rounding takes from the distance of a rotation that was moved to the boundary, in radians.
const ROUNDING: f64 = 1e-9;

/// How far projections are probed for jumps, in radians: 1, 2, 4, 8 degrees.
const PROBES: [f64; 4] = [0.017_453, 0.034_907, 0.069_813, 0.139_626];

impl Limit for FieldLimit {
    fn rows(&self) -> usize {
        1
    }

    fn rows_at(&self, numbers: &[f64]) -> [Row; MOST_ROWS] {
        let (distance, slope) = self.distance_and_slope(orientation(numbers));
        [(distance, [slope.x, slope.y, slope.z, 0.0]), NO_ROW, NO_ROW]
    }

    fn legal(&self, numbers: &[f64]) -> Option<[f64; MOST_LIMITED]> {
        let q = orientation(numbers);
        let distance = self.distance(q);
        if distance >= -ROUNDING || distance.is_nan() {
            return None;
        }
        Some(self.nearest(q).to_array())
    }

    fn beyond(&self, numbers: &[f64]) -> f64 {
        (-self.distance(orientation(numbers))).max(0.0)
    }

    /// The least of 1, 2, 4 and 8 degrees within which the nearest rotation was found to jump.
    fn margin(&self, numbers: &[f64]) -> f64 {
        let q = orientation(numbers);
        if self.distance(q) >= -ROUNDING {
            return f64::INFINITY;
        }
        let here = self.nearest(q);
        let jumps = |angle: &f64| {
            Vec3::UNITS.into_iter().flat_map(|axis| [axis, -axis]).any(|axis| {
                let there = self.nearest(q * Quat::exp(axis * *angle));
                here.angle_to(there) > 10.0 * angle
            })
        };
        PROBES.into_iter().find(jumps).unwrap_or(f64::INFINITY)
    }
}

impl FieldLimit {
    pub(crate) const KIND: Kind =
        Kind { name: "field", ports: &[Port::one("orientation", PortType::Orientation)] };
}

impl Contract for FieldLimit {
    fn faults(&self) -> Vec<Fault> {
        let unit = |q: Quat| (q.dot(q) - 1.0).abs() < 1e-6;
        if unit(self.in_reference) && unit(self.in_segment) {
            return vec![];
        }
        vec![Fault {
            severity: Severity::Error,
            code: "model/rotation",
            said: "has axes that are no rotation".to_owned(),
            help: "give `in_reference` and `in_segment` as unit quaternions, x, y, z, w",
        }]
    }

    fn outputs(&self) -> (PortType, usize) {
        (PortType::Orientation, 1)
    }

    fn geometry(&mut self) -> Vec<Geometry<'_>> {
        vec![]
    }

    /// The same limit, asked for the mirror image; of two mirrorings in one plane none is left.
    fn mirror(&mut self, at: Reflection) -> Result<Mirrored, String> {
        self.mirrored = match self.mirrored {
            None => Some(at),
            Some(other) if other == at => None,
            Some(_) => return Err("write both sides".to_owned()),
        };
        Ok(Mirrored::default())
    }
}
