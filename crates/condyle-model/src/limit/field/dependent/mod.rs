//! A learned limit that depends on another joint: the elbow on the shoulder, the forearm on the elbow (Herda, Urtasun & Fua
//! 2005 divide the parent's rotations into voxels for that; decision 22).
//!
//! ```text
//! cells        values of the driver at which a limit is known, and their weights between
//! dependence   the driver at each sample, and how it is used
//! ```
//!
//! With weights w_k(driver) that are smooth and sum up to 1, the signed distance is
//!
//! ```text
//! g(q, driver) = Σ w_k(driver) F_k(q) + w_0(driver) F(q)
//! ```
//!
//! F_k a field at the value k of the driver, F the limit without its driver, with the weight of what is not known of the driver. Its
//! slope is exact by both. Of a hinge, whose samples turn about one axis, F_k is the distance of the angle from the nearer of two bounds,
//! and turns about other axes are not limited.
//!
//! What moves into the limit is the child: the driver stays.

mod cells;
mod dependence;

pub use cells::Cells;
pub use dependence::{Dependence, DependenceKnown, DependenceSettings, Driver, Drivers};

use super::projection::{self, Surface};
use super::{Chart, Lattice, LearnedLimit, State};
use cells::Blended;
use condyle_math::{Quat, Vec3};
use std::f64::consts::PI;

/// What is known of the child at each cell.
#[derive(Clone, Debug)]
pub enum Child {
    /// A field of its rotations.
    Field {
        /// The axes of the map; those of the limit without its driver.
        chart: Chart,
        /// The nodes.
        lattice: Lattice,
        /// Coefficients of the spline at each cell; none where nothing is known.
        splines: Vec<Vec<f32>>,
    },
    /// Bounds of an angle about an axis.
    Hinge {
        /// The rotation at angle 0.
        middle: Quat,
        /// The axis in the child's axes, of length 1.
        axis: Vec3,
        /// The bounds at each cell, in radians.
        bounds: Vec<[f64; 2]>,
        /// Those without the driver.
        whole: [f64; 2],
    },
}

/// A dependence that was learned.
#[derive(Clone, Debug)]
pub struct Dependent {
    /// Values of the driver.
    pub cells: Cells,
    /// How many samples are within a step of each.
    pub counts: Vec<u32>,
    /// What is known at each.
    pub child: Child,
    /// At each the share of all rotations that is valid; of a hinge of a full turn.
    pub shares: Vec<f64>,
    /// The radius of empty balls and the thickness of the layer.
    pub known: DependenceKnown,
}

impl Dependent {
    /// The signed distance by what is known of the driver alone, in radians; `None` where that is less than half.
    #[must_use]
    pub fn distance_of_cells(&self, q: Quat, driver: Driver) -> Option<f64> {
        match &self.child {
            Child::Hinge { middle, axis, bounds, .. } => {
                let of = |cell: Option<usize>| {
                    cell.and_then(|cell| bounds.get(cell)).copied().unwrap_or_default()
                };
                let blended = self.cells.blended(driver, of);
                let [low, high] = blended.values.map(|sum| sum / blended.known.max(1e-9));
                let (angle, _) = angle_about(q, *middle, *axis);
                (blended.known >= 0.5).then(|| (angle - low).min(high - angle))
            }
            Child::Field { chart, lattice, splines } => {
                let inward = chart.inward(q);
                let blended = self.cells.blended(driver, |cell| {
                    let spline = cell.and_then(|cell| splines.get(cell));
                    [spline.map_or(0.0, |spline| lattice.value(spline, inward))]
                });
                (blended.known >= 0.5).then(|| blended.values[0] / blended.known)
            }
        }
    }
}

/// The signed distance with its slopes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sloped {
    /// The distance in radians, positive inside.
    pub distance: f64,
    /// By turns about the child's own axes.
    pub child: Vec3,
    /// By the driver: of a coordinate the first, of a rotation by turns about its own axes.
    pub driver: [f64; 3],
}

/// All that a limit says of a rotation at a value of its driver.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GivenAnswer {
    /// Whether it is possible; unknown where the driver was not recorded and the limit without it allows the rotation.
    pub state: State,
    /// The signed distance to the boundary in radians, positive inside.
    pub distance: f64,
    /// The nearest valid rotation at this value of the driver; itself if it is inside.
    pub nearest: Quat,
    /// The least, over all samples, of the angle to it plus the slope times how far its driver is.
    pub evidence: f64,
    /// The share that fields at values of the driver have in the answer; the rest is the limit without it.
    pub known: f64,
}

/// A limit with its driver, made.
#[derive(Clone, Copy, Debug)]
pub struct Given<'a> {
    pub(super) limit: &'a LearnedLimit,
    pub(super) dependence: &'a Dependence,
    pub(super) made: &'a Dependent,
}

/// A limit at one value of its driver, in the axes of the map.
struct Slice<'a> {
    given: &'a Given<'a>,
    driver: Driver,
    lattice: &'a Lattice,
    splines: &'a [Vec<f32>],
}

impl Slice<'_> {
    fn spline(&self, cell: usize) -> &[f32] {
        self.splines.get(cell).map_or(&[], Vec::as_slice)
    }

    #[inline]
    fn blended(&self, q: Quat) -> Blended<5> {
        self.given.made.cells.blended(self.driver, |cell| {
            let (value, [x, y, z, w]) = match cell {
                Some(cell) => self.lattice.value_and_slope(self.spline(cell), q),
                None => {
                    let whole = self.given.limit.field();
                    whole.lattice.value_and_slope(&whole.outer, q)
                }
            };
            [value, x, y, z, w]
        })
    }
}

impl Surface for Slice<'_> {
    fn value(&self, q: Quat) -> f64 {
        let blended = self.given.made.cells.blended(self.driver, |cell| match cell {
            Some(cell) => [self.lattice.value(self.spline(cell), q)],
            None => {
                let whole = self.given.limit.field();
                [whole.lattice.value(&whole.outer, q)]
            }
        });
        blended.values[0]
    }

    fn value_and_slope(&self, q: Quat) -> (f64, [f64; 4]) {
        let [value, x, y, z, w] = self.blended(q).values;
        (value, [x, y, z, w])
    }
}

/// The angle about an axis of a rotation seen from a middle, and its slope by turns about its own axes.
fn angle_about(q: Quat, middle: Quat, axis: Vec3) -> (f64, Vec3) {
    let r = super::chart::signed(middle.conjugate() * q);
    let (v, along) = (r.vector(), r.vector().dot(axis));
    let square = (along * along + r.w * r.w).max(1e-300);
    let slope = (axis * r.w + axis.cross(v)) * (r.w / square) + v * (along / square);
    (2.0 * along.atan2(r.w), slope)
}

impl<'a> Given<'a> {
    /// What it depends on.
    #[must_use]
    pub fn dependence(&self) -> &'a Dependence {
        self.dependence
    }

    /// What was learned of it.
    #[must_use]
    pub fn made(&self) -> &'a Dependent {
        self.made
    }

    /// The bounds of a hinge at a value of the driver, in radians about the axis from its middle, with the axis; `None` where the
    /// child is no hinge.
    #[must_use]
    pub fn bounds(&self, driver: Driver) -> Option<[f64; 2]> {
        let Child::Hinge { bounds, whole, .. } = &self.made.child else { return None };
        Some(self.blended_bounds(bounds, *whole, driver).values)
    }

    fn blended_bounds(&self, bounds: &[[f64; 2]], whole: [f64; 2], driver: Driver) -> Blended<2> {
        let of =
            |cell: Option<usize>| cell.and_then(|cell| bounds.get(cell)).copied().unwrap_or(whole);
        self.made.cells.blended(driver, of)
    }

    fn slice<'s>(&'s self, driver: Driver) -> Option<(Chart, Slice<'s>)> {
        let Child::Field { chart, lattice, splines } = &self.made.child else { return None };
        Some((*chart, Slice { given: self, driver, lattice, splines }))
    }

    /// The signed distance to the boundary at a value of the driver, in radians, positive inside.
    #[must_use]
    pub fn distance(&self, q: Quat, driver: Driver) -> f64 {
        match (&self.made.child, self.slice(driver)) {
            (Child::Hinge { middle, axis, bounds, whole }, _) => {
                let (angle, _) = angle_about(q, *middle, *axis);
                let [low, high] = self.blended_bounds(bounds, *whole, driver).values;
                (angle - low).min(high - angle)
            }
            (Child::Field { .. }, Some((chart, slice))) => slice.value(chart.inward(q)),
            _ => f64::NAN,
        }
    }

    /// The signed distance without the driver, in radians: of a hinge to the bounds of all samples.
    #[must_use]
    pub fn whole_distance(&self, q: Quat) -> f64 {
        match &self.made.child {
            Child::Hinge { middle, axis, whole: [low, high], .. } => {
                let (angle, _) = angle_about(q, *middle, *axis);
                (angle - low).min(high - angle)
            }
            Child::Field { .. } => self.limit.field().outer_distance(q),
        }
    }

    /// The same with its slopes.
    #[must_use]
    pub fn distance_and_slopes(&self, q: Quat, driver: Driver) -> Sloped {
        match (&self.made.child, self.slice(driver)) {
            (Child::Hinge { middle, axis, bounds, whole }, _) => {
                let (angle, slope) = angle_about(q, *middle, *axis);
                let blended = self.blended_bounds(bounds, *whole, driver);
                let [low, high] = blended.values;
                if angle - low <= high - angle {
                    let driver = blended.slopes[0].map(|s| -s);
                    Sloped { distance: angle - low, child: slope, driver }
                } else {
                    let driver = blended.slopes[1];
                    Sloped { distance: high - angle, child: -slope, driver }
                }
            }
            (_, Some((chart, slice))) => {
                let inward = chart.inward(q);
                let blended = slice.blended(inward);
                let [distance, x, y, z, w] = blended.values;
                let child = chart.tangent_outward(projection::tangent(inward, [x, y, z, w]));
                Sloped { distance, child, driver: blended.slopes[0] }
            }
            _ => Sloped { distance: f64::NAN, child: Vec3::ZERO, driver: [0.0; 3] },
        }
    }

    /// The nearest rotation that is inside at a value of the driver, which stays; itself if it is inside.
    #[must_use]
    pub fn nearest(&self, q: Quat, driver: Driver) -> Quat {
        let distance = self.distance(q, driver);
        let q = q.normalized();
        if distance >= 0.0 || distance.is_nan() {
            return q;
        }
        match &self.made.child {
            Child::Hinge { middle, axis, bounds, whole } => {
                let (angle, _) = angle_about(q, *middle, *axis);
                let [low, high] = self.blended_bounds(bounds, *whole, driver).values;
                let held = if low <= high { angle.clamp(low, high) } else { 0.5 * (low + high) };
                (q * Quat::exp(*axis * (held - angle))).normalized()
            }
            Child::Field { .. } => self.nearest_in_slice(q, driver).unwrap_or(q),
        }
    }

    fn nearest_in_slice(&self, q: Quat, driver: Driver) -> Option<Quat> {
        let (chart, slice) = self.slice(driver)?;
        let inward = chart.inward(q);
        // Where the limit without its driver has its nearest, and the nearest sample at a driver close by.
        let whole = chart.inward(self.limit.field().outer_nearest(q));
        let sample = self.nearest_sample(q, driver).map(|(sample, _)| chart.inward(sample));
        let inside = |p: &Quat| slice.value(*p) >= 0.0;
        let samples = &self.limit.ground().samples;
        let anchor = || {
            let all = || samples.iter().map(|p| chart.inward(*p)).find(inside);
            sample.filter(inside).or_else(all)
        };
        let (mut found, _) =
            projection::project(&slice, inward, [Some(whole), sample, None], anchor)?;
        // Back and forth between the axes rounds; what then is outside by that is moved in.
        for _ in 0..8 {
            let outward = chart.outward(found).normalized();
            let again = chart.inward(outward);
            if slice.value(again) >= 0.0 {
                return Some(if outward.dot(q) < 0.0 { -outward } else { outward });
            }
            let (_, g) = slice.value_and_slope(again);
            let slope = projection::tangent(again, g);
            let step = slope * (1e-8 / slope.norm().max(1e-6));
            found = super::chart::signed((again * Quat::exp(step)).normalized());
        }
        let outward = chart.outward(found).normalized();
        Some(if outward.dot(q) < 0.0 { -outward } else { outward })
    }

    /// The sample for which the angle plus the slope times how far its driver is is least, and that sum.
    fn nearest_sample(&self, q: Quat, driver: Driver) -> Option<(Quat, f64)> {
        let slope = self.dependence.settings.slope;
        let mut best: Option<(Quat, f64)> = None;
        for (index, sample) in self.limit.ground().samples.iter().enumerate() {
            let Some(at) = self.dependence.drivers.get(index) else { continue };
            let far = q.angle_to(*sample) + slope * driver.distance(at);
            if best.is_none_or(|(_, least)| far < least) {
                best = Some((*sample, far));
            }
        }
        best
    }

    /// The share that fields at values of the driver have in an answer; the rest is the limit without its driver.
    #[must_use]
    pub fn known(&self, driver: Driver) -> f64 {
        self.made.cells.blended(driver, |_| [0.0]).known
    }

    /// Whether a rotation is possible at a value of the driver.
    #[must_use]
    pub fn state(&self, q: Quat, driver: Driver) -> State {
        self.judged(q, driver, self.distance(q, driver))
    }

    fn judged(&self, q: Quat, driver: Driver, distance: f64) -> State {
        if distance < 0.0 {
            return State::Invalid;
        }
        let hole = || {
            matches!(self.made.child, Child::Field { .. })
                && self.limit.field().state(q).0 == State::Unknown
        };
        if self.known(driver) < 0.5 || hole() { State::Unknown } else { State::Valid }
    }

    /// All that is known of a rotation at a value of the driver.
    #[must_use]
    pub fn answer(&self, q: Quat, driver: Driver) -> GivenAnswer {
        let distance = self.distance(q, driver);
        GivenAnswer {
            state: self.judged(q, driver, distance),
            distance,
            nearest: self.nearest(q, driver),
            evidence: self.nearest_sample(q, driver).map_or(PI, |(_, far)| far),
            known: self.known(driver),
        }
    }
}
