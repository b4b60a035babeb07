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
//! A limit that depends on another joint has its driver at a second port, a coordinate or the rotation of a segment in another:
//! the row has slopes by both, and what moves in posed mode is the orientation alone.
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
use crate::limit::field::{Driver, Drivers, LearnedLimit, State};
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
    /// Of a limit that depends on a rotation, the axes of its driver's reference in those of the model's.
    pub driver_in_reference: Quat,
    /// The axes of its driver in those of the model's segment.
    pub driver_in_segment: Quat,
    /// Of a limit of the other side of the body, the plane between the sides.
    pub mirrored: Option<Reflection>,
    /// Whether holes, where nothing was seen, are not allowed either.
    pub strict: bool,
}

impl FieldLimit {
    /// A limit whose axes are those of the segments.
    #[must_use]
    pub fn new(limit: Arc<LearnedLimit>) -> Self {
        let same = Quat::IDENTITY;
        Self {
            limit,
            in_reference: same,
            in_segment: same,
            driver_in_reference: same,
            driver_in_segment: same,
            mirrored: None,
            strict: false,
        }
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

    /// The driver as the limit has it, of what is at the component's ports: the orientation, then the driver.
    #[must_use]
    pub fn driver(&self, numbers: &[f64]) -> Option<Driver> {
        match &self.limit.dependence()?.drivers {
            Drivers::Scalars(_) => numbers.get(4).copied().map(Driver::Scalar),
            Drivers::Rotations(_) => {
                let q = self.reflected(orientation(numbers.get(4..8)?));
                let q = self.driver_in_reference.conjugate() * q * self.driver_in_segment;
                Some(Driver::Rotation(q.normalized()))
            }
        }
    }

    /// Whether an orientation is possible, as the field has it, of what is at the component's ports.
    #[must_use]
    pub fn state(&self, numbers: &[f64]) -> State {
        let p = self.inward(orientation(numbers));
        match self.limit.given().zip(self.driver(numbers)) {
            Some((given, driver)) => given.state(p, driver),
            None if self.within(p).is_some() => State::Valid,
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

    /// The distance and its slopes: three of the orientation, then those of the driver.
    fn distance_and_slopes(&self, numbers: &[f64]) -> (f64, [f64; MOST_LIMITED]) {
        let mut slopes = [0.0; MOST_LIMITED];
        let turned = |slope: Vec3| self.mirrored.map_or(slope, |at| at.turning(slope));
        let Some((given, driver)) = self.limit.given().zip(self.driver(numbers)) else {
            let (distance, slope) = self.distance_and_slope(orientation(numbers));
            slopes[..3].copy_from_slice(&slope.to_array());
            return (distance, slopes);
        };
        let sloped = given.distance_and_slopes(self.inward(orientation(numbers)), driver);
        let slope = turned(self.in_segment.to_mat3() * sloped.child);
        slopes[..3].copy_from_slice(&slope.to_array());
        let of_driver = match driver {
            Driver::Scalar(_) => sloped.driver,
            Driver::Rotation(_) => {
                let slope = self.driver_in_segment.to_mat3() * Vec3::from(sloped.driver);
                turned(slope).to_array()
            }
        };
        slopes[3..6].copy_from_slice(&of_driver);
        (sloped.distance, slopes)
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

    /// The signed distance of what is at the component's ports to the boundary that is enforced, in radians, positive
    /// inside: the limit's row without its slopes.
    #[must_use]
    pub fn distance(&self, numbers: &[f64]) -> f64 {
        let p = self.inward(orientation(numbers));
        if let Some((given, driver)) = self.limit.given().zip(self.driver(numbers)) {
            return given.distance(p, driver);
        }
        self.within(p).unwrap_or_else(|| {
            let field = self.limit.field();
            let distance = if self.strict { field.distance(p) } else { field.outer_distance(p) };
            self.beyond_ends().map_or(distance, |way| distance.min(way))
        })
    }

    /// The nearest that is allowed, with the sign nearer to the given one.
    fn nearest(&self, q: Quat, driver: Option<Driver>) -> Quat {
        let p = self.inward(q);
        let nearest = match (self.limit.given().zip(driver), self.strict) {
            (Some((given, driver)), _) => given.nearest(p, driver),
            (None, true) => self.limit.field().nearest(p),
            (None, false) => self.limit.field().outer_nearest(p),
        };
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
        [self.distance_and_slopes(numbers), NO_ROW, NO_ROW]
    }

    fn legal(&self, numbers: &[f64]) -> Option<[f64; MOST_LIMITED]> {
        let distance = self.distance(numbers);
        if distance >= -ROUNDING || distance.is_nan() {
            return None;
        }
        // The driver stays.
        let mut legal = [0.0; MOST_LIMITED];
        for (to, from) in legal.iter_mut().zip(numbers) {
            *to = *from;
        }
        let nearest = self.nearest(orientation(numbers), self.driver(numbers));
        legal[..4].copy_from_slice(&nearest.to_array());
        Some(legal)
    }

    fn beyond(&self, numbers: &[f64]) -> f64 {
        (-self.distance(numbers)).max(0.0)
    }

    /// The least of 1, 2, 4 and 8 degrees within which the nearest rotation was found to jump.
    fn margin(&self, numbers: &[f64]) -> f64 {
        let (q, driver) = (orientation(numbers), self.driver(numbers));
        if self.distance(numbers) >= -ROUNDING {
            return f64::INFINITY;
        }
        let here = self.nearest(q, driver);
        let jumps = |angle: &f64| {
            Vec3::UNITS.into_iter().flat_map(|axis| [axis, -axis]).any(|axis| {
                let there = self.nearest(q * Quat::exp(axis * *angle), driver);
                here.angle_to(there) > 10.0 * angle
            })
        };
        PROBES.into_iter().find(jumps).unwrap_or(f64::INFINITY)
    }
}

impl FieldLimit {
    pub(crate) const KIND: Kind = Kind {
        name: "field",
        ports: &[
            Port::one("orientation", PortType::Orientation),
            Port::perhaps("driver", PortType::Scalar),
            Port::perhaps("driver_orientation", PortType::Orientation),
        ],
    };
}

impl Contract for FieldLimit {
    fn has(&self, port: &Port) -> bool {
        let drivers = self.limit.dependence().map(|dependence| &dependence.drivers);
        match port.name {
            "driver" => matches!(drivers, Some(Drivers::Scalars(_))),
            "driver_orientation" => matches!(drivers, Some(Drivers::Rotations(_))),
            _ => true,
        }
    }

    fn faults(&self) -> Vec<Fault> {
        let unit = |q: Quat| (q.dot(q) - 1.0).abs() < 1e-6;
        let axes =
            [self.in_reference, self.in_segment, self.driver_in_reference, self.driver_in_segment];
        if axes.into_iter().all(unit) {
            return vec![];
        }
        vec![Fault {
            severity: Severity::Error,
            code: "model/rotation",
            said: "has axes that are no rotation".to_owned(),
            help: "give `in_reference`, `in_segment` and those of the driver as unit quaternions, x, y, z, w",
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
