//! What is asked of a tracking, by names.

use condyle_diagnostics::Diagnostic;
#[cfg(feature = "opensim")]
use condyle_formats::opensim::setup::{self, IkSetup, IkTasks};
use condyle_model::{CoordinateId, Model};
use condyle_motion::{BLANK, Motion, Table};
use condyle_track::{CoordinateTarget, PostureTarget, Targets, Wanted};
use std::collections::HashMap;

/// How a recording is tracked.
#[derive(Clone, Debug, PartialEq)]
pub struct Request {
    /// Weights by marker name; `None` gives every marker that model and recording share weight 1.
    pub marker_weights: Option<HashMap<String, f64>>,
    /// Coordinates that should have a value.
    pub coordinates: Vec<CoordinateRequest>,
    /// Coordinates, or sums of several, that are held near a rest value.
    pub postures: Vec<PostureRequest>,
    /// Where the values of [`CoordinateValue::PerTime`] are taken from: columns named after coordinates.
    pub coordinate_values: Option<Table>,
    /// First and last time, in seconds.
    pub time_range: Option<[f64; 2]>,
    /// Weight of squared loop errors; infinite closes loops exactly.
    pub closure_weight: f64,
    /// Hold coordinates to their enforced ranges.
    pub limits: bool,
    /// Find swapped labels, and weigh markers down that are far off.
    pub robust: bool,
    /// The largest RMS of marker errors that is plausible, in metres: 0.1, since a model that is not
    /// scaled to its person is at 0.06 to 0.07.
    pub max_rms: f64,
    /// Threads; `None` for as many as there are cores.
    pub threads: Option<usize>,
}

/// A coordinate that should have a value: `weight (q - value)²` is added to F.
#[derive(Clone, Debug, PartialEq)]
pub struct CoordinateRequest {
    /// Its name in the model.
    pub name: String,
    /// The weight, m² per rad² (or per m²).
    pub weight: f64,
    /// The value.
    pub value: CoordinateValue,
}

/// The value that a coordinate should have.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum CoordinateValue {
    /// Its default in the model.
    Default,
    /// The same in every frame, in radians or metres.
    Constant(f64),
    /// The value at the time of each frame in [`Request::coordinate_values`].
    PerTime,
}

/// A sum of coordinates that rests at a value: `stiffness (Σ factor q - rest)²` is minimised beside F
/// and reported apart from it.
#[derive(Clone, Debug, PartialEq)]
pub struct PostureRequest {
    /// The coordinates by name, each with its factor.
    pub coordinates: Vec<(String, f64)>,
    /// The value at rest, in radians (or metres).
    pub rest: f64,
    /// The stiffness, m² per rad² (or per m²): with 1e-5 a radian weighs as much as 3.2 mm RMS.
    pub stiffness: f64,
}

impl Default for Request {
    fn default() -> Self {
        Self {
            marker_weights: None,
            coordinates: vec![],
            postures: vec![],
            coordinate_values: None,
            time_range: None,
            closure_weight: f64::INFINITY,
            limits: true,
            robust: false,
            max_rms: 0.1,
            threads: None,
        }
    }
}

/// OpenSim's setups.
#[cfg(feature = "opensim")]
impl Request {
    /// What a setup of OpenSim's inverse kinematics asks for; files that it names are not opened.
    pub fn from_setup(setup: &IkSetup) -> Self {
        let mut request = Self {
            time_range: setup.time_range,
            closure_weight: setup.constraint_weight,
            ..Self::default()
        };
        if let IkTasks::Inline(tasks) = &setup.tasks {
            let on = tasks.markers.iter().filter(|t| t.apply);
            request.marker_weights = Some(on.map(|t| (t.name.clone(), t.weight)).collect());
            let on = tasks.coordinates.iter().filter(|t| t.apply && t.weight > 0.0);
            let coordinate = |t: &setup::CoordinateTask| CoordinateRequest {
                name: t.name.clone(),
                weight: t.weight,
                value: match t.target {
                    setup::CoordinateTarget::Default => CoordinateValue::Default,
                    setup::CoordinateTarget::Manual(value) => CoordinateValue::Constant(value),
                    setup::CoordinateTarget::FromFile => CoordinateValue::PerTime,
                },
            };
            request.coordinates = on.map(coordinate).collect();
        }
        request
    }
}

impl Request {
    /// Whether a coordinate should follow [`Request::coordinate_values`].
    pub fn wants_values(&self) -> bool {
        self.coordinates.iter().any(|c| c.value == CoordinateValue::PerTime)
    }

    /// Adds coordinates and postures to the targets of frames at these times; what cannot be tracked is
    /// a warning.
    pub(super) fn add_coordinates(
        &self,
        model: &Model,
        times: &[f64],
        targets: &mut Targets,
        warnings: &mut Vec<Diagnostic>,
    ) {
        let file = self.coordinate_values.as_ref().map(|table| {
            let (motion, said) = Motion::from_table(model, table);
            warnings.extend(said.into_iter().filter(|d| d.code == BLANK));
            (motion, table)
        });
        for CoordinateRequest { name, weight, value } in &self.coordinates {
            let Some(coordinate) = find(model, name, warnings) else { continue };
            let wanted = match (value, &file) {
                (CoordinateValue::Default, _) => {
                    Wanted::Constant(model.coordinate(coordinate).default[0])
                }
                (CoordinateValue::Constant(value), _) => Wanted::Constant(*value),
                (CoordinateValue::PerTime, Some((motion, table)))
                    if table.column(name).is_some() =>
                {
                    let at = |&t| motion.at(model, t).map(|q| model.value(&q, coordinate));
                    Wanted::PerFrame(times.iter().map(|t| at(t).unwrap_or(f64::NAN)).collect())
                }
                (CoordinateValue::PerTime, _) => {
                    let message = format!("no coordinate file gives values for `{name}`");
                    let said = Diagnostic::warning("track/no-coordinate-file", message);
                    warnings.push(said.with_help("the task is ignored"));
                    continue;
                }
            };
            targets.coordinates.push(CoordinateTarget { coordinate, weight: *weight, wanted });
        }
        for PostureRequest { coordinates, rest, stiffness } in &self.postures {
            let known =
                coordinates.iter().map(|(name, a)| Some((find(model, name, warnings)?, *a)));
            if let Some(terms) = known.collect() {
                targets.postures.push(PostureTarget { terms, rest: *rest, stiffness: *stiffness });
            }
        }
    }
}

/// A coordinate by its name; an unknown one is a warning.
fn find(model: &Model, name: &str, warnings: &mut Vec<Diagnostic>) -> Option<CoordinateId> {
    let ignored = |error: &dyn std::fmt::Display| {
        let said = Diagnostic::warning("track/unknown-coordinate", format!("{error}"));
        said.with_help("the task is ignored")
    };
    model.find_coordinate(name).map_err(|error| warnings.push(ignored(&error))).ok()
}
