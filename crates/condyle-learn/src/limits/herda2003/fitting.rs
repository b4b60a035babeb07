//! Spheres are placed, split, cleaned and placed again (section 4.3, equation 7).
//!
//! 1. One sphere at the centroid of the surface points (section 4.4, step 2) with e their mean distance from
//!    it (the paper says "variance"); E is minimised.
//! 2. The sphere with the largest
//!
//!    ```text
//!    C_i = 1/m_i Σ (F(P_j) - iso)²   over the m_i surface points within e_i + 2/k of its centre
//!    ```
//!
//!    is split (`split.rs`), and E is minimised over all spheres; "until the error stabilises": until two
//!    splits in succession have lowered E by less than a share of it each, or a number of spheres is reached.
//! 3. Spheres are removed that are larger than 1, or whose centre is farther than 1 from the centroid, or
//!    in which points are sparse: the paper says "small with respect to total density". Here the density of
//!    the cloud in the sphere (its radius taken as at least 0.1) is below a tenth of that of the whole cloud in
//!    the ball about the centroid with the cubic mean of ρ_max over the solid angles as radius.
//! 4. E is minimised again, without splits.

use super::chart::{Chart, Placement};
use super::energy::{ALPHA_2, Energy};
use super::field::{ISO, Primitive, SphereField};
use super::split::{Split, principal_axis, split};
use super::surface::{SolidAngles, centroid};
use condyle_math::{Quat, Vec3};
use condyle_solve::least_squares::{Solver, Stopping};
use std::fmt;

/// What the paper fixes, and what it leaves open.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Options {
    /// Where the coordinates are centred.
    pub placement: Placement,
    /// Into how many spheres one is split.
    pub split: Split,
    /// The number L of intervals of the solid angles; 7.
    pub intervals: usize,
    /// The thickness T of the surface, a share of ρ_max; 0.1.
    pub thickness: f64,
    /// The stickiness k of the spheres; 5.
    pub stickiness: f64,
    /// The weight α₂ of the spheres' distance from the centroid; 0.01.
    pub pull: f64,
    /// Spheres in which the density of the cloud is below this share of its whole are removed; 0.1.
    pub sparse: f64,
    /// The error has stabilised when two splits in succession lower E by less than this share; 0.05. With 0
    /// only the number of spheres ends the splits.
    pub stable: f64,
    /// No split makes more spheres than this; 31.
    pub most: usize,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            placement: Placement::default(),
            split: Split::default(),
            intervals: 7,
            thickness: 0.1,
            stickiness: 5.0,
            pull: ALPHA_2,
            sparse: 0.1,
            stable: 0.05,
            most: 31,
        }
    }
}

/// Why nothing can be fitted.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum FitError {
    /// Too few rotations, or all the same.
    TooFew(usize),
    /// An option is out of range; its name and what would be right.
    Option(&'static str, &'static str),
}

impl fmt::Display for FitError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::TooFew(n) => {
                write!(f, "{n} different rotations span no volume; at least 10 are needed")
            }
            Self::Option(name, right) => write!(f, "{name} must be {right}"),
        }
    }
}

impl std::error::Error for FitError {}

/// The spheres after each minimisation.
#[derive(Clone, Debug, PartialEq)]
pub struct Stage {
    /// The spheres.
    pub field: SphereField,
    /// Their energy E.
    pub energy: f64,
}

/// What cleaning removed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Removed {
    /// Spheres with a radius over 1.
    pub large: usize,
    /// Spheres more than 1 from the centroid.
    pub far: usize,
    /// Spheres in which the cloud is sparse.
    pub sparse: usize,
}

/// A cloud being fitted.
#[derive(Clone, Debug)]
pub struct Fitting {
    options: Options,
    points: Vec<Vec3>,
    surface: Vec<Vec3>,
    centroid: Vec3,
    /// Points per volume of the whole cloud.
    density: f64,
}

impl Fitting {
    /// Takes the points of a cloud and extracts its surface; points that are not finite are left out.
    ///
    /// # Errors
    /// [`FitError`] if there are fewer than 10 different points or an option is out of range.
    pub fn new(mut points: Vec<Vec3>, options: Options) -> Result<Self, FitError> {
        points.retain(|p| p.norm_squared().is_finite());
        let positive = |x: f64| x.is_finite() && x > 0.0;
        if !(1..=1000).contains(&options.intervals) {
            return Err(FitError::Option("intervals", "from 1 to 1000"));
        }
        if !(options.thickness > 0.0 && options.thickness <= 1.0) {
            return Err(FitError::Option("thickness", "above 0 and at most 1"));
        }
        if !positive(options.stickiness) {
            return Err(FitError::Option("stickiness", "positive"));
        }
        if !(1..=200).contains(&options.most) {
            return Err(FitError::Option("most", "from 1 to 200"));
        }
        let cells = SolidAngles { centre: centroid(&points), intervals: options.intervals };
        let indices = cells.surface(&points, options.thickness);
        let surface: Vec<Vec3> = indices.into_iter().map(|i| points[i]).collect();
        let largest = cells.largest(&points);
        let filled: Vec<f64> = largest.into_iter().filter(|rho| *rho > 0.0).collect();
        let cubes = filled.iter().map(|rho| rho.powi(3)).sum::<f64>() / filled.len().max(1) as f64;
        if points.len() < 10 || surface.len() < 4 || !positive(cubes) {
            return Err(FitError::TooFew(points.len()));
        }
        let density = points.len() as f64 / ball(cubes.cbrt());
        let centroid = centroid(&surface);
        Ok(Self { options, points, surface, centroid, density })
    }

    /// The outer points, over which E is summed.
    pub fn surface(&self) -> &[Vec3] {
        &self.surface
    }

    /// Their centroid.
    pub fn centroid(&self) -> Vec3 {
        self.centroid
    }

    /// The sphere from which the fit starts.
    pub fn start(&self) -> SphereField {
        let total: f64 = self.surface.iter().map(|p| (*p - self.centroid).norm()).sum();
        let radius = total / self.surface.len() as f64;
        SphereField {
            primitives: vec![Primitive { centre: self.centroid, radius }],
            stickiness: self.options.stickiness,
        }
    }

    /// The energy E of a field (equation 6).
    pub fn energy(&self, field: &SphereField) -> f64 {
        let empty = SphereField { primitives: Vec::new(), stickiness: field.stickiness };
        Energy::new(&self.surface, self.centroid, self.options.pull, empty).of(field)
    }

    /// The field at the minimum of E that is reached from a field.
    pub fn minimise(&self, field: &SphereField) -> Stage {
        let mut problem =
            Energy::new(&self.surface, self.centroid, self.options.pull, field.clone());
        // A tenth of the unit ball is a usual step of a sphere.
        let scale = vec![0.1; 4 * field.primitives.len()];
        let stopping = Stopping { tolerance: 1e-9, iterations: 300, ..Stopping::default() };
        let summary = Solver::new(&scale, 0, 0).minimise(&mut problem, &stopping);
        Stage { field: problem.into_field(), energy: summary.objective }
    }

    /// C of each sphere (equation 7); `None` for one without surface points in its support.
    pub fn misfits(&self, field: &SphereField) -> Vec<Option<f64>> {
        let mut sums = vec![(0.0, 0usize); field.primitives.len()];
        for p in &self.surface {
            let square = (field.value(*p) - ISO).powi(2);
            for (sum, sphere) in sums.iter_mut().zip(&field.primitives) {
                if (*p - sphere.centre).norm() <= field.support(sphere) {
                    *sum = (sum.0 + square, sum.1 + 1);
                }
            }
        }
        sums.into_iter().map(|(sum, m)| (m > 0).then(|| sum / m as f64)).collect()
    }

    /// The field with its worst sphere split; `None` if no sphere has a surface point in its support.
    pub fn split_worst(&self, field: &SphereField) -> Option<SphereField> {
        let misfits = self.misfits(field);
        let known = misfits.iter().enumerate().filter_map(|(i, c)| c.map(|c| (i, c)));
        let (worst, _) = known.max_by(|a, b| a.1.total_cmp(&b.1))?;
        let sphere = field.primitives[worst];
        let support = field.support(&sphere);
        let reached: Vec<Vec3> = self
            .surface
            .iter()
            .copied()
            .filter(|p| (*p - sphere.centre).norm() <= support)
            .collect();
        let axis = principal_axis(&reached);
        let mut primitives = field.primitives.clone();
        primitives.remove(worst);
        primitives.extend(split(&sphere, axis, field.stickiness, self.options.split));
        Some(SphereField { primitives, stickiness: field.stickiness })
    }

    /// All stages from one sphere on, before cleaning.
    pub fn stages(&self) -> Vec<Stage> {
        let mut stages = vec![self.minimise(&self.start())];
        let added = self.options.split.parts() - 1;
        let mut calm = 0;
        while let Some(last) = stages.last() {
            if last.field.primitives.len() + added > self.options.most {
                break;
            }
            let Some(field) = self.split_worst(&last.field) else { break };
            let next = self.minimise(&field);
            let still = last.energy - next.energy < self.options.stable * last.energy;
            calm = if still { calm + 1 } else { 0 };
            stages.push(next);
            if calm == 2 && self.options.stable > 0.0 {
                break;
            }
        }
        stages
    }

    /// The field without the spheres that the paper removes, minimised again.
    ///
    /// If all would be removed, the one with the most points is kept.
    pub fn clean(&self, field: &SphereField) -> (Stage, Removed) {
        let mut removed = Removed::default();
        let inside = |s: &Primitive, radius: f64| {
            self.points.iter().filter(|p| (**p - s.centre).norm() <= radius).count()
        };
        let mut kept = Vec::new();
        for s in &field.primitives {
            let radius = s.radius.max(0.1);
            if s.radius > 1.0 {
                removed.large += 1;
            } else if (s.centre - self.centroid).norm() > 1.0 {
                removed.far += 1;
            } else if (inside(s, radius) as f64) < self.options.sparse * self.density * ball(radius)
            {
                removed.sparse += 1;
            } else {
                kept.push(*s);
            }
        }
        if kept.is_empty() {
            kept.extend(field.primitives.iter().max_by_key(|s| inside(s, s.radius.max(0.1))));
        }
        let field = SphereField { primitives: kept, stickiness: field.stickiness };
        (self.minimise(&field), removed)
    }
}

fn ball(radius: f64) -> f64 {
    4.0 / 3.0 * std::f64::consts::PI * radius.powi(3)
}

/// A learned limit: possible where the field is at least 1.
#[derive(Clone, Debug, PartialEq)]
pub struct SphereLimit {
    /// From rotations to points.
    pub chart: Chart,
    /// The spheres.
    pub field: SphereField,
    /// E at the end.
    pub energy: f64,
    /// The number of spheres and E after each minimisation before cleaning.
    pub history: Vec<(usize, f64)>,
    /// What cleaning removed.
    pub removed: Removed,
}

impl SphereLimit {
    /// Learns the limit of a cloud of unit quaternions with this reference rotation (their mean).
    ///
    /// The result depends on the order of the rotations only by rounding.
    ///
    /// # Errors
    /// As [`Fitting::new`].
    ///
    /// ```
    /// use condyle_learn::limits::herda2003::{Options, SphereLimit};
    /// use condyle_math::{Quat, Vec3};
    /// // All rotations by at most 1 rad, on a grid.
    /// let grid = || (-5..=5).map(|i| f64::from(i) * 0.2);
    /// let vectors = grid().flat_map(|x| grid().flat_map(move |y| grid().map(move |z| Vec3::new(x, y, z))));
    /// let cloud: Vec<Quat> = vectors.filter(|v| v.norm() <= 1.0).map(Quat::exp).collect();
    /// let limit = SphereLimit::learn(&cloud, Quat::IDENTITY, Options::default()).unwrap();
    /// assert!(limit.allows(Quat::exp(Vec3::X * 0.8)));
    /// assert!(!limit.allows(Quat::exp(Vec3::X * 1.3)));
    /// ```
    pub fn learn(rotations: &[Quat], reference: Quat, options: Options) -> Result<Self, FitError> {
        let chart = Chart::new(reference, options.placement);
        let points = rotations.iter().map(|q| chart.point(*q)).collect();
        let fitting = Fitting::new(points, options)?;
        let stages = fitting.stages();
        let history = stages.iter().map(|s| (s.field.primitives.len(), s.energy)).collect();
        let last = stages.into_iter().next_back().map_or_else(|| fitting.start(), |s| s.field);
        let (stage, removed) = fitting.clean(&last);
        Ok(Self { chart, field: stage.field, energy: stage.energy, history, removed })
    }

    /// F at a rotation: at least 1 if it is possible.
    pub fn value(&self, rotation: Quat) -> f64 {
        self.field.value(self.chart.point(rotation))
    }

    /// Whether a rotation is possible.
    pub fn allows(&self, rotation: Quat) -> bool {
        self.value(rotation) >= ISO
    }
}
