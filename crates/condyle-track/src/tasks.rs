//! What a tracking asks for.

use condyle_model::CoordinateId;

/// One marker of the model that should be where the recording has it.
#[derive(Clone, Debug, PartialEq)]
pub struct MarkerTask {
    /// Position among the model's markers.
    pub marker: usize,
    /// Its weight; must be positive and finite.
    pub weight: f64,
}

/// One coordinate that should have a value.
#[derive(Clone, Debug, PartialEq)]
pub struct CoordinateTask {
    /// The coordinate; one number, of any kind.
    pub coordinate: CoordinateId,
    /// Its weight, m² per rad² (or per m²).
    pub weight: f64,
    /// The value, in radians or metres: one for all frames, or one for each.
    pub target: Target,
}

/// The value that a coordinate should have.
#[derive(Clone, Debug, PartialEq)]
pub enum Target {
    /// The same in every frame.
    Constant(f64),
    /// One for each frame; not finite where there is none.
    PerFrame(Vec<f64>),
}

impl Target {
    /// The value in a frame, if there is one.
    pub fn at(&self, frame: usize) -> Option<f64> {
        let value = match self {
            Self::Constant(value) => *value,
            Self::PerFrame(values) => *values.get(frame)?,
        };
        value.is_finite().then_some(value)
    }
}

/// All that a tracking asks for.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct Tasks {
    /// Markers, in the order of the recorded positions that are passed with each frame.
    pub markers: Vec<MarkerTask>,
    /// Coordinate targets.
    pub coordinates: Vec<CoordinateTask>,
    /// Weight of squared loop errors; infinite (or `None`) closes loops exactly.
    pub closure_weight: Option<f64>,
}

/// How a tracking is done.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Options {
    /// Hold coordinates to their enforced ranges.
    pub limits: bool,
    /// Stop a frame when the model promises to lower F by less than this fraction of it.
    pub tolerance: f64,
    /// Weigh markers down that are far off where the others agree.
    pub robust: bool,
}

impl Default for Options {
    fn default() -> Self {
        Self { limits: true, tolerance: 1e-6, robust: false }
    }
}
