//! A model and its tasks, laid out for solving frames.

use crate::tasks::{Options, Tasks};
use condyle_math::Vec3;
use condyle_model::evaluate::ClosureRows;
use condyle_model::{CoordinateId, CoordinateKind, Jacobian, Model, Pose, Program, SegmentId};
use condyle_solve::least_squares::Solver;

/// Marks a direction that is not solved for.
pub(crate) const FIXED: u32 = u32::MAX;

/// One marker with its place and the group of markers on the same segment.
#[derive(Clone, Debug)]
pub(crate) struct PlacedMarker {
    pub weight: f64,
    pub point: Vec3,
    pub segment: Option<SegmentId>,
    /// Position among the groups; none for markers of the world, which nothing moves.
    pub group: Option<usize>,
}

/// The markers of one segment: which unknowns move them.
#[derive(Clone, Debug)]
pub(crate) struct Group {
    /// (unknown, twist), sorted by unknown.
    pub entries: Vec<(u32, u32)>,
    /// Whether the segment hangs below a scale or a shear, where moments do not add up.
    pub deforms: bool,
}

/// One model and what is asked of it; constant, and shared by all threads.
#[derive(Clone, Debug)]
pub struct Tracker<'m> {
    pub(crate) model: &'m Model,
    pub(crate) program: Program,
    pub(crate) tasks: Tasks,
    pub(crate) options: Options,
    pub(crate) markers: Vec<PlacedMarker>,
    pub(crate) groups: Vec<Group>,
    /// For each direction its unknown, or [`FIXED`].
    pub(crate) unknowns: Vec<u32>,
    /// For each unknown its direction.
    pub(crate) directions: Vec<u32>,
    /// For each unknown of a coordinate of one number: where that is stored, and its bounds.
    pub(crate) stored: Vec<Option<(usize, f64, f64)>>,
    pub(crate) defaults: Vec<f64>,
    /// How many limit rows of the program hold; none without limits.
    pub(crate) limit_rows: usize,
    pub(crate) closures_exact: bool,
    /// Coordinates that turn or orient everything: what to vary for a first guess.
    pub(crate) root_rotations: Vec<CoordinateId>,
}

impl<'m> Tracker<'m> {
    /// Prepares a model for its tasks.
    ///
    /// Locked coordinates stay at their defaults, coupled ones follow their leaders; all others
    /// are solved for. Weights that are not positive and finite are left out.
    pub fn new(model: &'m Model, mut tasks: Tasks, options: Options) -> Self {
        let positive = |w: f64| w > 0.0 && w.is_finite();
        for task in &mut tasks.markers {
            if !positive(task.weight) || task.marker >= model.markers().len() {
                task.weight = 0.0;
            }
        }
        tasks.coordinates.retain(|t| {
            positive(t.weight) && model.coordinate(t.coordinate).kind != CoordinateKind::Orientation
        });
        let program = Program::compile(model);
        let limit_rows = if options.limits { program.limit_row_len() } else { 0 };
        let defaults = model.defaults();
        let mut unknowns = vec![FIXED; model.tangent_len()];
        let (mut directions, mut stored) = (vec![], vec![]);
        for id in model.coordinate_ids() {
            let coordinate = model.coordinate(id);
            if coordinate.locked || coordinate.follows.is_some() {
                continue;
            }
            for direction in model.tangent_range(id) {
                unknowns[direction] = directions.len() as u32;
                directions.push(direction as u32);
                stored.push((coordinate.kind != CoordinateKind::Orientation).then(|| {
                    let free = (f64::NEG_INFINITY, f64::INFINITY);
                    let (lower, upper) =
                        if options.limits { coordinate.range.bounds() } else { free };
                    (model.stored_range(id).start, lower, upper)
                }));
            }
        }
        let mut tracker = Self {
            model,
            program,
            options,
            markers: vec![],
            groups: vec![],
            unknowns,
            directions,
            stored,
            defaults,
            limit_rows,
            closures_exact: tasks.closure_weight.is_none_or(|w| w.is_infinite()),
            root_rotations: vec![],
            tasks,
        };
        tracker.group_markers();
        tracker.find_roots();
        tracker
    }

    fn group_markers(&mut self) {
        let mut group_of: Vec<Option<usize>> = vec![None; self.model.segments().len()];
        for task in &self.tasks.markers {
            let Some(marker) = self.model.markers().get(task.marker) else {
                let nowhere =
                    PlacedMarker { weight: 0.0, point: Vec3::ZERO, segment: None, group: None };
                self.markers.push(nowhere);
                continue;
            };
            let group = marker.segment.map(|segment| {
                *group_of[segment.index()].get_or_insert_with(|| {
                    let entries = self.program.segment_directions(segment);
                    let entries = entries.iter().filter_map(|&(direction, twist)| {
                        let unknown = self.unknowns[direction as usize];
                        (unknown != FIXED).then_some((unknown, twist))
                    });
                    let deforms = self.program.deforms(segment);
                    self.groups.push(Group { entries: entries.collect(), deforms });
                    self.groups.len() - 1
                })
            });
            self.markers.push(PlacedMarker {
                weight: task.weight,
                point: marker.point,
                segment: marker.segment,
                group,
            });
        }
    }

    /// Rotations that move every group of markers.
    fn find_roots(&mut self) {
        for id in self.model.coordinate_ids() {
            let kind = self.model.coordinate(id).kind;
            let unknown = self.unknowns[self.model.tangent_range(id).start];
            let turns = matches!(kind, CoordinateKind::Rotation | CoordinateKind::Orientation);
            let everywhere = unknown != FIXED
                && self.groups.iter().all(|g| g.entries.iter().any(|(u, _)| *u == unknown));
            if turns && everywhere && self.root_rotations.len() < 3 {
                self.root_rotations.push(id);
            }
        }
    }

    /// The model.
    pub fn model(&self) -> &'m Model {
        self.model
    }

    /// The model's program.
    pub fn program(&self) -> &Program {
        &self.program
    }

    /// What is asked.
    pub fn tasks(&self) -> &Tasks {
        &self.tasks
    }

    /// How many numbers are solved for.
    pub fn unknown_len(&self) -> usize {
        self.directions.len()
    }
}

/// The buffers of one thread.
#[derive(Debug)]
pub struct Scratch {
    pub(crate) pose: Pose,
    pub(crate) jacobian: Jacobian,
    pub(crate) closures: ClosureRows,
    pub(crate) solver: Solver,
    pub(crate) buffers: Buffers,
}

/// Per-frame numbers of a problem.
#[derive(Debug, Default)]
pub(crate) struct Buffers {
    pub current: Vec<f64>,
    pub trial: Vec<f64>,
    pub tangent: Vec<f64>,
    pub weights: Vec<f64>,
    pub points: Vec<Vec3>,
    pub errors: Vec<Vec3>,
    pub moments: Vec<crate::moments::Moments>,
}

impl Scratch {
    /// Buffers for a tracker.
    pub fn new(tracker: &Tracker<'_>) -> Self {
        let program = &tracker.program;
        let closures = ClosureRows::new(tracker.model);
        let equalities = if tracker.closures_exact { closures.len() } else { 0 };
        // A natural step: half a radian; lengths are linear, so a metre or two at a time.
        let scale: Vec<f64> = tracker
            .directions
            .iter()
            .map(|&direction| {
                let id = tracker
                    .model
                    .coordinate_ids()
                    .find(|&id| tracker.model.tangent_range(id).contains(&(direction as usize)));
                match id.map(|id| tracker.model.coordinate(id).kind) {
                    Some(CoordinateKind::Translation) => 4.0,
                    _ => 1.0,
                }
            })
            .collect();
        let stored = program.stored_len();
        Self {
            pose: Pose::new(program),
            jacobian: Jacobian::new(program),
            solver: Solver::new(&scale, equalities, tracker.limit_rows),
            closures,
            buffers: Buffers {
                current: vec![0.0; stored],
                trial: vec![0.0; stored],
                tangent: vec![0.0; program.tangent_len()],
                weights: vec![0.0; tracker.markers.len()],
                points: vec![Vec3::ZERO; tracker.markers.len()],
                errors: vec![Vec3::ZERO; tracker.markers.len()],
                moments: vec![crate::moments::Moments::ZERO; tracker.groups.len()],
            },
        }
    }
}
