//! A model and its targets, laid out for solving frames.

use crate::branch::Branches;
use crate::guess::Limb;
use crate::problem::Buffers;
use crate::target::{Markers, Moments, PostureTarget, Targets};
use condyle_math::Vec3;
use condyle_model::evaluate::ClosureRows;
use condyle_model::{CoordinateId, CoordinateKind, Jacobian, Model, Pose, Program};
use condyle_solve::least_squares::Solver;
use std::sync::Arc;

/// Marks a direction that is not solved for.
pub(crate) const FIXED: u32 = u32::MAX;

/// How a tracking is done.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rules {
    /// Hold coordinates to their enforced ranges.
    pub limits: bool,
    /// Stop a frame when the model promises to lower what is minimised by less than this fraction of it.
    pub tolerance: f64,
}

impl Default for Rules {
    fn default() -> Self {
        Self { limits: true, tolerance: 1e-6 }
    }
}

/// One model and what is tracked with it; constant, and shared by all threads.
///
/// It owns its share of the model, so that both can live in one struct or move to another thread.
#[derive(Clone, Debug)]
pub struct Tracker {
    pub(crate) model: Arc<Model>,
    pub(crate) program: Program,
    /// The program of the segments that carry what is tracked, which frames are solved with.
    pub(crate) part: Program,
    pub(crate) targets: Targets,
    pub(crate) rules: Rules,
    pub(crate) markers: Markers,
    /// For each direction its unknown, or [`FIXED`].
    pub(crate) unknowns: Vec<u32>,
    /// For each unknown its direction and its coordinate.
    pub(crate) directions: Vec<u32>,
    pub(crate) coordinates: Vec<CoordinateId>,
    /// For each unknown of a coordinate of one number: where that is stored, and its bounds.
    pub(crate) stored: Vec<Option<(usize, f64, f64)>>,
    pub(crate) defaults: Vec<f64>,
    /// How many limit rows of the program hold; none without limits.
    pub(crate) limit_rows: usize,
    /// Coordinates that turn or orient everything: what to vary for a first guess.
    pub(crate) root_rotations: Vec<CoordinateId>,
    pub(crate) limbs: Vec<Limb>,
    pub(crate) branches: Branches,
}

impl Tracker {
    /// Prepares a model for its targets.
    ///
    /// Locked coordinates stay at their defaults, coupled ones follow their leaders, and those that move
    /// nothing that is tracked are at rest; all others are solved for. Weights that are not positive and finite are left out.
    pub fn new(model: impl Into<Arc<Model>>, mut targets: Targets, rules: Rules) -> Self {
        let model = model.into();
        targets.clean(&model);
        let program = Program::compile(&model);
        let limit_rows = if rules.limits { program.limit_row_len() } else { 0 };
        let mut defaults = model.defaults();
        let moved = targets.directions(&model, &program, limit_rows);
        let mut unknowns = vec![FIXED; model.tangent_len()];
        let (mut directions, mut coordinates, mut stored) = (vec![], vec![], vec![]);
        for id in model.coordinate_ids() {
            let coordinate = model.coordinate(id);
            if coordinate.locked || coordinate.follows.is_some() {
                continue;
            }
            if !model.tangent_range(id).any(|direction| moved[direction]) {
                // Nothing but its own rest has a say.
                let place = model.stored_range(id).start;
                let rest =
                    targets.postures.iter().rev().find(|t| t.terms.iter().any(|p| p.0 == id));
                if let Some(PostureTarget { terms, rest, .. }) = rest
                    && let [(_, factor)] = terms[..]
                    && factor != 0.0
                {
                    let (lower, upper) = coordinate.range.bounds();
                    defaults[place] = (rest / factor).max(lower).min(upper);
                }
                continue;
            }
            for direction in model.tangent_range(id) {
                unknowns[direction] = directions.len() as u32;
                directions.push(direction as u32);
                coordinates.push(id);
                stored.push((coordinate.kind != CoordinateKind::Orientation).then(|| {
                    let free = (f64::NEG_INFINITY, f64::INFINITY);
                    let (lower, upper) =
                        if rules.limits { coordinate.range.bounds() } else { free };
                    (model.stored_range(id).start, lower, upper)
                }));
            }
        }
        let moving: Vec<bool> = unknowns.iter().map(|&unknown| unknown != FIXED).collect();
        let part = Program::compile_for(&model, targets.segments(&model), &moving);
        let markers = Markers::new(&targets.markers, &model, &part, &unknowns);
        let branches = Branches::find(&model, &program, &targets, &mut stored);
        let limbs = Limb::of(&model, &markers, &unknowns, &stored);
        // Rotations that move every group of markers.
        let turns_all = |id: &CoordinateId| {
            let kind = model.coordinate(*id).kind;
            let unknown = unknowns[model.tangent_range(*id).start];
            matches!(kind, CoordinateKind::Rotation | CoordinateKind::Orientation)
                && unknown != FIXED
                && markers.groups.iter().all(|g| g.entries.iter().any(|(u, _)| *u == unknown))
        };
        let root_rotations = model.coordinate_ids().filter(turns_all).take(3).collect();
        Self {
            model,
            program,
            part,
            targets,
            rules,
            markers,
            unknowns,
            directions,
            coordinates,
            stored,
            defaults,
            limit_rows,
            root_rotations,
            limbs,
            branches,
        }
    }

    /// The model.
    pub fn model(&self) -> &Arc<Model> {
        &self.model
    }

    /// The model's program.
    pub fn program(&self) -> &Program {
        &self.program
    }

    /// What is tracked; what cannot be is left out, markers with weight 0.
    pub fn targets(&self) -> &Targets {
        &self.targets
    }

    /// The coordinates, neither locked nor coupled, that move nothing that is tracked.
    pub fn unmoved(&self) -> impl Iterator<Item = CoordinateId> + '_ {
        self.model.coordinate_ids().filter(|&id| {
            let coordinate = self.model.coordinate(id);
            let solved = self.model.tangent_range(id).any(|d| self.unknowns[d] != FIXED);
            !solved && !coordinate.locked && coordinate.follows.is_none()
        })
    }

    /// How many numbers are solved for.
    pub fn unknown_len(&self) -> usize {
        self.directions.len()
    }
}

/// The buffers of one thread.
#[derive(Debug)]
pub struct Scratch {
    pub(crate) solver: Solver,
    pub(crate) buffers: Buffers,
}

impl Scratch {
    /// Buffers for a tracker.
    pub fn new(tracker: &Tracker) -> Self {
        let (model, program) = (&tracker.model, &tracker.part);
        let closures = ClosureRows::new(model);
        let equalities = if tracker.targets.close_exactly() { closures.len() } else { 0 };
        // A natural step: half a radian; lengths are linear, so a metre or two at a time.
        let natural = |&id: &CoordinateId| match model.coordinate(id).kind {
            CoordinateKind::Translation => 4.0,
            _ => 1.0,
        };
        let scale: Vec<f64> = tracker.coordinates.iter().map(natural).collect();
        let (stored, markers) = (program.stored_len(), tracker.markers.placed.len());
        Self {
            solver: Solver::new(&scale, equalities, tracker.limit_rows),
            buffers: Buffers {
                pose: Pose::new(program),
                jacobian: Jacobian::new(program),
                at: vec![0.0; stored],
                differentiated: false,
                closures,
                current: vec![0.0; stored],
                trial: vec![0.0; stored],
                tangent: vec![0.0; program.tangent_len()],
                weights: vec![0.0; markers],
                points: vec![Vec3::ZERO; markers],
                errors: vec![Vec3::ZERO; markers],
                total_weight: 0.0,
                moments: vec![Moments::ZERO; tracker.markers.groups.len()],
                summed: vec![Moments::ZERO; tracker.markers.pairs.sets.len()],
                velocities: vec![None; tracker.unknown_len()],
                touched: Vec::with_capacity(tracker.unknown_len()),
            },
        }
    }
}
