//! A limit of a ball joint as the signed distance to the closing of a cloud by empty balls.
//!
//! ```text
//! samples -> Ground             packed             rotations as files hold them, the axes of the map
//! formulas -> Ground            shape              ends of three turns, for limits that are published as such
//! Ground -> distances at nodes  condyle-learn      what no empty ball covers, with a layer, holes carved
//!        -> a smooth function   chart, lattice     a cubic spline over all rotations
//! rotation -> Answer            projection         state, distance, nearest valid rotation, evidence
//!                               boundary           where its search begins
//! direction -> Fibre            reach              whether a bone can point there, and how far it then twists
//! ```
//!
//! Distances are angles of rotation in radians, positive inside, and go on outside everywhere. `q` and `-q` give the same
//! answer to the bit. The function is a C² spline of distances at nodes; its slope is exact, and kinks of the
//! distance (edges of the boundary, ridges) are rounded within a step of the nodes.
//!
//! - *invalid*: outside the outer boundary;
//! - *unknown*: inside it, but in a hole: farther from any sample than their density explains;
//! - *valid*: otherwise.
//!
//! The distance is that to what is valid: negative in holes too.

mod boundary;
mod chart;
pub mod dependent;
mod lattice;
mod learned;
mod outer;
mod packed;
mod projection;
mod reach;
mod shape;

pub use boundary::Boundary;
pub use chart::Chart;
pub use dependent::{Dependence, Dependent, Driver, Drivers, Given};
pub use lattice::Lattice;
pub use learned::{About, LearnedLimit, MakeDependent};
pub use packed::{packed, snapped, unpacked};
pub use reach::{Fibre, fibre};
pub use shape::{Ends, Shape, ShapeError};

use condyle_math::{Quat, Vec3};
use std::f64::consts::PI;
use std::sync::Arc;

/// How a field is learned.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// Nodes along an edge of the map, 24 to 256; with 96 neighbours are 3.7° apart in the middle.
    pub nodes: usize,
    /// The least and the greatest radius of empty balls, in radians; five spacings between them.
    pub radius: [f64; 2],
    /// The thickness of the layer about the closing, in radians; set by leaving samples out if not given.
    pub gap: Option<f64>,
    /// Radius of an empty ball that is a hole, and how deep its centre must be, in spacings; `None` closes all.
    pub hole: Option<[f64; 2]>,
}

impl Default for Settings {
    fn default() -> Self {
        let degrees = PI / 180.0;
        Self {
            nodes: 96,
            radius: [20.0 * degrees, 50.0 * degrees],
            gap: None,
            hole: Some([2.5, 2.0]),
        }
    }
}

/// Whether a rotation is possible.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum State {
    /// Inside, where there are samples.
    Valid,
    /// Outside the outer boundary.
    Invalid,
    /// Inside the outer boundary, where there are no samples.
    Unknown,
}

impl State {
    /// Its name in files.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Valid => "valid",
            Self::Invalid => "invalid",
            Self::Unknown => "unknown",
        }
    }
}

/// What is known near a rotation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Evidence {
    /// The angle to the nearest sample, in radians; NaN of what has no samples.
    pub angle: f64,
    /// That sample's position among those of [`Field::samples`].
    pub sample: usize,
    /// How many samples are within two spacings of that sample, itself among them.
    pub count: u32,
}

/// All that a field says of a rotation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Answer {
    /// Whether it is possible.
    pub state: State,
    /// The signed distance to the boundary of what is valid, in radians, positive inside.
    pub distance: f64,
    /// The nearest valid rotation; itself if it is valid.
    pub nearest: Quat,
    /// What is known near it.
    pub evidence: Evidence,
}

/// A part of the inside without samples.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hole {
    /// The middle of its largest empty ball.
    pub centre: Quat,
    /// The radius of that ball in radians.
    pub radius: f64,
    /// Its volume as a share of all rotations.
    pub share: f64,
}

/// What was learned, in numbers.
#[derive(Clone, Debug, PartialEq)]
pub struct Learned {
    /// (volume / number of samples)^(1/3), in radians.
    pub spacing: f64,
    /// The radius of empty balls, in radians.
    pub radius: f64,
    /// The mean thickness of the layer about the closing, in radians.
    pub gap: f64,
    /// How many samples touch an empty ball, those estimated that were not found among them.
    pub extreme: f64,
    /// The surface of the closing, in rad².
    pub surface: f64,
    /// The share of all rotations within the outer boundary, by Haar's measure.
    pub outer: f64,
    /// The share that is valid.
    pub valid: f64,
    /// What is unknown, the largest empty balls first.
    pub holes: Vec<Hole>,
}

/// What a field is made of, so that the same one can be made again.
#[derive(Clone, Debug, PartialEq)]
pub struct Ground {
    /// The samples: unit quaternions of the child in the reference segment, as [`snapped`] leaves them.
    pub samples: Vec<Quat>,
    /// How many samples, in their order, are from each take.
    pub takes: Vec<u32>,
    /// The least angle between two samples that was asked for, in radians.
    pub thinned: f64,
    /// The axes of the map.
    pub chart: Chart,
    /// How it is learned.
    pub settings: Settings,
    /// What was learned before and is not to be found anew.
    pub known: Option<Known>,
    /// Formulas that say what is possible, instead of samples.
    pub shape: Option<Arc<Shape>>,
}

/// Numbers that follow from samples, and of which a rounding decides too much to find them again.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Known {
    /// (volume / number of samples)^(1/3), in radians.
    pub spacing: f64,
    /// The radius of empty balls, in radians.
    pub radius: f64,
    /// The mean thickness of the layer about the closing, in radians.
    pub gap: f64,
}

/// What a method of learning finds at the nodes of a lattice.
#[derive(Clone, Debug)]
pub struct Grid {
    /// The lattice.
    pub lattice: Lattice,
    /// Signed distances to the outer boundary at its nodes, in radians; NaN where there is no rotation.
    pub outer: Vec<f32>,
    /// The same to the boundary of what is valid, if there are holes.
    pub carved: Option<Vec<f32>>,
    /// The sample that is nearest to each node.
    pub near: Vec<u32>,
    /// How many samples are within two spacings of each sample, itself among them.
    pub counts: Vec<u32>,
    /// Places on the boundary of what is valid.
    pub boundary: Boundary,
    /// What was learned, in numbers.
    pub learned: Learned,
}

/// A limit of the rotation of a segment in another, learned from a cloud of rotations.
#[derive(Clone, Debug)]
pub struct Field {
    ground: Arc<Ground>,
    chart: Chart,
    lattice: Lattice,
    samples: Vec<Quat>,
    /// The same, to find the nearest.
    small: Vec<[f32; 4]>,
    near: Vec<u32>,
    counts: Vec<u32>,
    outer: Vec<f32>,
    carved: Option<Vec<f32>>,
    /// For each cell of the lattice a bit that says whether a hole matters in it.
    hollow: Vec<u64>,
    boundary: Boundary,
    learned: Learned,
}

impl Field {
    /// The field of distances at nodes.
    #[must_use]
    pub fn new(ground: Arc<Ground>, grid: Grid) -> Self {
        let Grid { lattice, outer, carved, near, counts, boundary, learned } = grid;
        let outer = lattice.coefficients(&outer);
        let carved = carved.map(|values| lattice.coefficients(&values));
        let samples: Vec<Quat> = ground.samples.iter().map(|q| ground.chart.inward(*q)).collect();
        let mut field = Self {
            small: samples.iter().map(|q| q.to_array().map(|c| c as f32)).collect(),
            samples,
            near,
            counts,
            hollow: carved.as_ref().map_or(vec![], |carved| lattice.differing(&outer, carved)),
            outer,
            carved,
            chart: ground.chart,
            ground,
            lattice,
            boundary: Boundary::default(),
            learned,
        };
        let spline = projection::Spline(&field.lattice, field.valid());
        let mut boundary = boundary;
        boundary.refine(&field.lattice, |q, starts| {
            projection::project(&spline, q, starts, || None).map(|(found, _)| found)
        });
        field.boundary = boundary;
        field
    }

    /// What it is made of.
    #[must_use]
    pub fn ground(&self) -> &Arc<Ground> {
        &self.ground
    }

    /// The samples that it was learned from.
    #[must_use]
    pub fn samples(&self) -> &[Quat] {
        &self.ground.samples
    }

    /// What was learned, in numbers.
    #[must_use]
    pub fn learned(&self) -> &Learned {
        &self.learned
    }

    fn valid(&self) -> &[f32] {
        self.carved.as_deref().unwrap_or(&self.outer)
    }

    /// The signed distance to the boundary of what is valid, in radians, positive inside; NaN for what is no
    /// rotation.
    #[inline]
    #[must_use]
    pub fn distance(&self, q: Quat) -> f64 {
        self.lattice.value(self.valid(), self.chart.inward(q))
    }

    /// Whether a rotation is possible, and its signed distance.
    #[inline]
    #[must_use]
    pub fn state(&self, q: Quat) -> (State, f64) {
        let q = self.chart.inward(q);
        let (distance, cells) = self.lattice.value_in_cells(self.valid(), q);
        (self.judged(q, distance, cells), distance)
    }

    #[inline]
    fn judged(&self, q: Quat, distance: f64, cells: [usize; 2]) -> State {
        if distance >= 0.0 {
            return State::Valid;
        }
        // Elsewhere both splines have the same coefficients.
        let hole = self.carved.is_some()
            && cells.into_iter().any(|cell| {
                self.hollow.get(cell / 64).is_some_and(|bits| bits >> (cell % 64) & 1 == 1)
            })
            && self.lattice.value(&self.outer, q) >= 0.0;
        if hole { State::Unknown } else { State::Invalid }
    }

    /// The signed distance with its slope: by how much it rises per radian of a turn about the child's own x, y
    /// and z axes, q·exp(ω).
    #[inline]
    #[must_use]
    pub fn distance_and_gradient(&self, q: Quat) -> (f64, Vec3) {
        let q = self.chart.inward(q);
        let (distance, g) = self.lattice.value_and_slope(self.valid(), q);
        (distance, self.chart.tangent_outward(projection::tangent(q, g)))
    }

    /// What is known near a rotation: the nearest of the samples near the nodes about it.
    #[must_use]
    pub fn evidence(&self, q: Quat) -> Evidence {
        self.known(self.chart.inward(q))
    }

    /// [`Field::state`] and [`Field::evidence`] at once.
    #[inline]
    #[must_use]
    pub fn state_with_evidence(&self, q: Quat) -> (State, f64, Evidence) {
        let q = self.chart.inward(q);
        let (distance, cells) = self.lattice.value_in_cells(self.valid(), q);
        (self.judged(q, distance, cells), distance, self.known(q))
    }

    fn known(&self, q: Quat) -> Evidence {
        let small = q.to_array().map(|c| c as f32);
        let (mut best, mut sample) = (-1.0, 0);
        for node in self.lattice.corners(q) {
            let index = self.near.get(node).copied().unwrap_or(u32::MAX) as usize;
            let Some(p) = self.small.get(index) else { continue };
            let dot = boundary::dot(p, &small);
            if dot > best {
                (best, sample) = (dot, index);
            }
        }
        let angle = self.samples.get(sample).map_or(f64::NAN, |p| q.angle_to(*p));
        Evidence { angle, sample, count: self.counts.get(sample).copied().unwrap_or(0) }
    }

    /// The nearest valid rotation, of length 1 and with the sign nearer to the reference; itself if it is
    /// valid.
    #[must_use]
    pub fn nearest(&self, q: Quat) -> Quat {
        let inward = self.chart.inward(q);
        let distance = self.lattice.value(self.valid(), inward);
        self.projected(q, inward, distance)
    }

    fn projected(&self, q: Quat, inward: Quat, distance: f64) -> Quat {
        self.projected_on(self.valid(), q, inward, distance)
    }

    fn projected_on(&self, spline: &[f32], q: Quat, inward: Quat, distance: f64) -> Quat {
        let same = |q: Quat| {
            let q = q.normalized();
            if (self.chart.outward(inward)).dot(q) < 0.0 { -q } else { q }
        };
        if distance >= 0.0 || distance.is_nan() {
            return same(q);
        }
        let starts = self.boundary.starts(&self.lattice, inward);
        let inside = |p: &Quat| self.lattice.value(spline, *p) >= 0.0;
        let anchor = || {
            let sample = self.known(inward).sample;
            let near = self.samples.get(sample).copied().filter(inside);
            let middle = || {
                self.ground
                    .shape
                    .as_ref()
                    .map(|shape| self.chart.inward(shape.middle()))
                    .filter(inside)
            };
            near.or_else(|| self.samples.iter().copied().find(inside)).or_else(middle)
        };
        let found =
            projection::project(&projection::Spline(&self.lattice, spline), inward, starts, anchor);
        let Some((mut found, sure)) = found else {
            return same(q);
        };
        if sure {
            return self.chart.outward(found).normalized();
        }
        // Back and forth between the axes rounds; what then is outside by that is moved in.
        for _ in 0..8 {
            let outward = self.chart.outward(found).normalized();
            let again = self.chart.inward(outward);
            if self.lattice.value(spline, again) >= 0.0 {
                return outward;
            }
            let (_, g) = self.lattice.value_and_slope(spline, again);
            let slope = projection::tangent(again, g);
            let step = slope * (1e-8 / slope.norm().max(1e-6));
            found = (again * Quat::exp(step)).normalized();
        }
        self.chart.outward(found).normalized()
    }

    /// All that is known of a rotation.
    #[must_use]
    pub fn answer(&self, q: Quat) -> Answer {
        let inward = self.chart.inward(q);
        let (distance, cells) = self.lattice.value_in_cells(self.valid(), inward);
        Answer {
            state: self.judged(inward, distance, cells),
            distance,
            nearest: self.projected(q, inward, distance),
            evidence: self.known(inward),
        }
    }
}
