//! A limit of a ball joint as the signed distance to the closing of a cloud by empty balls.
//!
//! ```text
//! Cloud -> distances at nodes   closing, nearest   what no empty ball covers, with a layer, holes carved
//!       -> a smooth function    chart, lattice     a cubic spline over all rotations
//! rotation -> Answer            projection         state, distance, nearest valid rotation, evidence
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

mod chart;
mod closing;
mod lattice;
mod nearest;
mod projection;

use super::Cloud;
use chart::Chart;
use condyle_diagnostics::Error;
use condyle_math::{Quat, Vec3};
use lattice::Lattice;
use std::f64::consts::PI;

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
    /// The angle to the nearest sample, in radians.
    pub angle: f64,
    /// That sample's position in the cloud.
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

/// A limit learned from a cloud.
///
/// ```
/// use condyle_learn::limits::{Cloud, Field, Settings, State};
/// use condyle_math::{Quat, Vec3};
/// // All turns by up to 60 degrees, from points of a lattice.
/// let range = -10..=10;
/// let mut take = vec![];
/// for (i, j, k) in range.clone().flat_map(|i| range.clone().map(move |j| (i, j)))
///     .flat_map(|(i, j)| (-10..=10).map(move |k| (i, j, k)))
/// {
///     let turn = Vec3::new(f64::from(i), f64::from(j), f64::from(k)) * 0.12;
///     if turn.norm() < 60f64.to_radians() {
///         take.push(Quat::exp(turn));
///     }
/// }
/// let cloud = Cloud::gather(&[&take], 0.0)?;
/// let field = Field::learn(cloud, &Settings { nodes: 48, ..Settings::default() })?;
/// let answer = field.answer(Quat::from_axis_angle(Vec3::Y, 80f64.to_radians()));
/// assert_eq!(answer.state, State::Invalid);
/// assert!((answer.distance.to_degrees() + 20.0).abs() < 3.0);
/// assert!((answer.nearest.log().y.to_degrees() - 60.0).abs() < 3.0);
/// # Ok::<(), condyle_diagnostics::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct Field {
    cloud: Cloud,
    chart: Chart,
    lattice: Lattice,
    samples: Vec<Quat>,
    near: Vec<u32>,
    counts: Vec<u32>,
    outer: Vec<f32>,
    carved: Option<Vec<f32>>,
    learned: Learned,
}

impl Field {
    /// Learns the limit of a cloud.
    ///
    /// # Errors
    /// `field/settings` for settings that make no sense.
    pub fn learn(cloud: Cloud, settings: &Settings) -> Result<Self, Error> {
        let [least, most] = settings.radius;
        if !((24..=256).contains(&settings.nodes) && least > 0.0 && least <= most && most < PI) {
            let message = "nodes are not 24 to 256, or radii not rising between 0 and half a turn";
            return Err(Error::new("field/settings", message));
        }
        let chart = Chart::of(&cloud);
        let lattice = Lattice::new(settings.nodes);
        let found = closing::closing(&cloud, &chart, &lattice, settings);
        let all = 8.0 * PI * PI;
        let [_, outer, hollow] = found.volumes;
        let holes = found.holes.iter().map(|(q, radius, volume)| Hole {
            centre: chart.outward(*q),
            radius: *radius,
            share: volume / all,
        });
        let learned = Learned {
            spacing: found.spacing,
            radius: found.radius,
            gap: found.gap,
            extreme: found.extreme,
            surface: found.surface,
            outer: outer / all,
            valid: (outer - hollow) / all,
            holes: holes.collect(),
        };
        Ok(Self {
            samples: cloud.rotations().iter().map(|q| chart.inward(*q)).collect(),
            near: found.samples,
            counts: found.counts,
            outer: lattice.coefficients(&found.outer),
            carved: found.carved.map(|values| lattice.coefficients(&values)),
            cloud,
            chart,
            lattice,
            learned,
        })
    }

    /// The samples that it was learned from.
    #[must_use]
    pub fn cloud(&self) -> &Cloud {
        &self.cloud
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
        let distance = self.lattice.value(self.valid(), q);
        (self.judged(q, distance), distance)
    }

    #[inline]
    fn judged(&self, q: Quat, distance: f64) -> State {
        if distance >= 0.0 {
            return State::Valid;
        }
        let hole = self.carved.is_some() && self.lattice.value(&self.outer, q) >= 0.0;
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

    fn known(&self, q: Quat) -> Evidence {
        let (mut best, mut sample, mut last) = (-1.0, 0, u32::MAX);
        for node in self.lattice.corners(q) {
            let Some(&index) = self.near.get(node) else { continue };
            if index == last {
                continue;
            }
            last = index;
            let Some(p) = self.samples.get(index as usize) else { continue };
            let dot = q.dot(*p).abs();
            if dot > best {
                (best, sample) = (dot, index as usize);
            }
        }
        let angle = self.samples.get(sample).map_or(PI, |p| q.angle_to(*p));
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
        let same = |q: Quat| {
            let q = q.normalized();
            if (self.chart.outward(inward)).dot(q) < 0.0 { -q } else { q }
        };
        if distance >= 0.0 || distance.is_nan() {
            return same(q);
        }
        let spline = self.valid();
        let inside = |p: &Quat| self.lattice.value(spline, *p) >= 0.0;
        let anchor = || {
            let sample = self.known(inward).sample;
            let near = self.samples.get(sample).copied().filter(inside);
            near.or_else(|| self.samples.iter().copied().find(inside))
        };
        let Some(mut found) = projection::project(&self.lattice, spline, inward, anchor) else {
            return same(q);
        };
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
        let distance = self.lattice.value(self.valid(), inward);
        Answer {
            state: self.judged(inward, distance),
            distance,
            nearest: self.projected(q, inward, distance),
            evidence: self.known(inward),
        }
    }
}
