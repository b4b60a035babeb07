//! What is tracked: a family of targets with one contract.
//!
//! With the unknowns x (the directions of the independent coordinates, n of them), a frame minimises
//!
//! ```text
//! F(x) + P(x) + prior(x),   F = (Σₘ wₘ |eₘ|²) / (Σₘ wₘ) + Σ_c w_c (q_c - t_c)² + Σ_o w_o |ρ_o|² + Σ_d w_d |d_d - v_d|²
//!                               + Σ_p w_p |p - p*|² + w Σ_r c_r²
//!                           P = Σ_p k_p (Σᵢ a_pᵢ qᵢ - r_p)²
//! ```
//!
//! Each kind of target is a file here, and a line in [`kinds`] that says in which sum its value stands.
//! It is measured at the pose that was evaluated last, with the Jacobian of that pose, and adds to the
//! solver's local model, for its residuals ρ (row vectors of n derivatives ∂ρ) with weights w,
//!
//! ```text
//! value     Σ w ρ²                 m²
//! gradient  2 Σ w ρ ∂ρ             n numbers, m² per rad (or per m)
//! Hessian   2 Σ w ∂ρᵀ ∂ρ           the lower triangle of n × n, row-major
//! ```
//!
//! The Hessian is that of Gauss and Newton: second derivatives of ρ are left out, but for those of markers
//! where the solver asks for them ([`LocalModel::curved`]), near the minimum. Only markers are divided
//! by the sum of the weights seen. The order of the kinds is that of all sums, and the order of the
//! targets of a kind that in which they were given, so that the same question has the same bits for an
//! answer. A target that has nothing to say about a frame adds nothing.

mod closure;
mod coordinate;
mod direction;
mod marker;
mod moments;
mod orientation;
mod pairs;
mod place;
mod posture;
mod prior;
#[cfg(test)]
pub(crate) mod tests;

pub use coordinate::{CoordinateTarget, Wanted};
pub use direction::DirectionTarget;
pub use marker::MarkerTarget;
pub(crate) use marker::{Markers, Placed};
pub(crate) use moments::Moments;
pub use orientation::OrientationTarget;
pub(crate) use orientation::rotation_of;
pub use place::PlaceTarget;
pub use posture::PostureTarget;
pub use prior::PRIOR;

use crate::problem::Frame;
use crate::tracker::Tracker;
use condyle_model::model::Condition;
use condyle_model::{CoordinateId, CoordinateKind, Model, Program, SegmentId};
use condyle_solve::least_squares::LocalModel;

/// All that is tracked.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct Targets {
    /// Markers, in the order of the recorded positions that are passed with each frame.
    pub markers: Vec<MarkerTarget>,
    /// Factors on the weights of the markers, frame by frame in the order of the markers; 1 beyond their
    /// end, so that none are needed where all positions are as sure. A marker of factor 0 is not used
    /// in that frame.
    pub marker_factors: Vec<f64>,
    /// Coordinates that should have a value.
    pub coordinates: Vec<CoordinateTarget>,
    /// Segments that should have an orientation.
    pub orientations: Vec<OrientationTarget>,
    /// Lines between points that should point somewhere.
    pub directions: Vec<DirectionTarget>,
    /// Points that should be somewhere.
    pub places: Vec<PlaceTarget>,
    /// Rest values with their stiffness.
    pub postures: Vec<PostureTarget>,
    /// Weight of squared loop errors; infinite (or `None`) closes loops exactly.
    pub closure_weight: Option<f64>,
}

/// One kind of target; the contract is in the head of this file.
pub(crate) trait Target {
    /// The value at the pose that was evaluated last.
    fn value(&self, frame: &mut Frame<'_>) -> f64;

    /// Adds gradient and Hessian at the pose that was measured last.
    fn linearise(&self, frame: &mut Frame<'_>, local: &mut LocalModel);
}

/// The sum in which a kind of target stands.
enum Part {
    /// F, divided by the sum of the markers' weights.
    Mean,
    /// F.
    Fit,
    /// P.
    Posture,
    /// Neither: minimised, not reported.
    Unreported,
}

/// The kinds, in the order in which they are summed.
fn kinds(tracker: &Tracker) -> [(Part, &dyn Target); 8] {
    let targets = &tracker.targets;
    [
        (Part::Mean, &tracker.markers),
        (Part::Fit, &targets.coordinates),
        (Part::Fit, &targets.orientations),
        (Part::Fit, &targets.directions),
        (Part::Fit, &targets.places),
        (Part::Posture, &targets.postures),
        (Part::Unreported, &prior::Prior),
        (Part::Fit, &closure::Closures),
    ]
}

/// The values of all targets of a frame.
#[derive(Default)]
pub(crate) struct Sums {
    /// Σ w |e|².
    pub squares: f64,
    /// F.
    pub objective: f64,
    /// P.
    pub posture: f64,
    /// What the solver minimises: F + P + prior.
    pub minimised: f64,
}

/// Measures all targets at the pose that was evaluated last.
pub(crate) fn measure(frame: &mut Frame<'_>) -> Sums {
    let mut sums = Sums::default();
    for (part, kind) in kinds(frame.tracker) {
        let value = kind.value(frame);
        match part {
            Part::Mean => {
                let total = frame.buffers.total_weight;
                sums.squares += value;
                sums.objective += if total > 0.0 { value / total } else { 0.0 };
                sums.minimised += value * frame.marker_scale();
                continue;
            }
            Part::Fit => sums.objective += value,
            Part::Posture => sums.posture += value,
            Part::Unreported => {}
        }
        sums.minimised += value;
    }
    sums
}

/// Adds gradient and Hessian of all targets at the pose that was measured last.
pub(crate) fn linearise(frame: &mut Frame<'_>, local: &mut LocalModel) {
    for (_, kind) in kinds(frame.tracker) {
        kind.linearise(frame, local);
    }
}

/// Adds gradient and Hessian of what was measured (markers, wanted values, loops), or of what was assumed
/// (postures and the prior).
pub(crate) fn linearise_part(frame: &mut Frame<'_>, local: &mut LocalModel, assumed: bool) {
    for (part, kind) in kinds(frame.tracker) {
        if assumed == matches!(part, Part::Posture | Part::Unreported) {
            kind.linearise(frame, local);
        }
    }
}

impl Targets {
    /// Leaves out what cannot be tracked: weights that are not positive and finite, and quaternions
    /// where one number is asked for. Markers keep their places, with weight 0.
    pub(crate) fn clean(&mut self, model: &Model) {
        let positive = |w: f64| w > 0.0 && w.is_finite();
        self.marker_factors.iter_mut().filter(|f| !positive(**f)).for_each(|f| *f = 0.0);
        let number = |id| model.coordinate(id).kind != CoordinateKind::Orientation;
        for target in &mut self.markers {
            if !positive(target.weight) || target.marker >= model.markers().len() {
                target.weight = 0.0;
            }
        }
        self.coordinates.retain(|t| positive(t.weight) && number(t.coordinate));
        self.orientations.retain(|t| positive(t.weight));
        self.directions.retain(|t| positive(t.weight));
        self.places.retain(|t| positive(t.weight));
        self.postures.retain(|t| {
            let known = t.terms.iter().all(|&(id, factor)| factor.is_finite() && number(id));
            positive(t.stiffness) && t.rest.is_finite() && known
        });
    }

    /// The factor on the weight of a marker target in a frame.
    pub(crate) fn marker_factor(&self, frame: usize, marker: usize) -> f64 {
        let place = frame.checked_mul(self.markers.len()).and_then(|p| p.checked_add(marker));
        place.and_then(|place| self.marker_factors.get(place)).copied().unwrap_or(1.0)
    }

    /// Whether something but markers says where the model should be; a posture only says how it holds
    /// itself, and leaves a frame without markers as it was.
    pub(crate) fn stand_without_markers(&self) -> bool {
        !(self.coordinates.is_empty() && self.segments_held().next().is_none())
    }

    /// The segments that carry what is tracked.
    pub(crate) fn segments(&self, model: &Model) -> Vec<SegmentId> {
        let markers = self.markers.iter().filter_map(|t| model.markers().get(t.marker)?.segment);
        let closed = model.closures().iter().flat_map(|closure| match &closure.condition {
            Condition::Points { at } | Condition::Distance { at, .. } => at.map(|(s, _)| s),
            Condition::Frames { at } => at.map(|(s, _)| s),
            Condition::Coupling { .. } => [None; 2],
        });
        markers.chain(self.segments_held()).chain(closed.flatten()).collect()
    }

    /// The segments of orientations, lines and places.
    fn segments_held(&self) -> impl Iterator<Item = SegmentId> + '_ {
        let lines = self.directions.iter().flat_map(|t| [t.from.0, t.to.0]);
        let oriented = self.orientations.iter().map(|t| t.segment);
        oriented.chain(lines).chain(self.places.iter().map(|t| t.segment))
    }

    /// For each direction whether something is tracked that it moves. The rest of a single coordinate does
    /// not count; loops may tie anything to anything.
    pub(crate) fn directions(
        &self,
        model: &Model,
        program: &Program,
        limit_rows: usize,
    ) -> Vec<bool> {
        let mut moved = vec![!model.closures().is_empty(); model.tangent_len()];
        let markers = self.markers.iter().filter(|t| t.weight > 0.0);
        let segments = markers.filter_map(|t| model.markers()[t.marker].segment);
        for segment in segments.chain(self.segments_held()) {
            program.segment_directions(segment).iter().for_each(|&(d, _)| moved[d as usize] = true);
        }
        let sums = self.postures.iter().filter(|t| t.terms.len() > 1);
        let summed = sums.flat_map(|t| t.terms.iter().map(|(id, _)| *id));
        for id in summed.chain(self.coordinates.iter().map(|t| t.coordinate)) {
            let directions = program.coordinate_directions(model, id).iter();
            directions.for_each(|&(d, _)| moved[d as usize] = true);
        }
        for row in 0..limit_rows {
            let directions = program.limit_row_directions(row).iter();
            directions.for_each(|&(d, _)| moved[d as usize] = true);
        }
        moved
    }

    /// Whether a segment, a line or a point is asked for in a frame.
    pub(crate) fn orient(&self, frame: usize) -> bool {
        self.orientations.iter().any(|t| matches!(t.wanted.get(frame), Some(Some(_))))
            || self.directions.iter().any(|t| matches!(t.wanted.get(frame), Some(Some(_))))
            || self.places.iter().any(|t| matches!(t.wanted.get(frame), Some(Some(_))))
    }

    /// Whether loops are closed by rows that must vanish.
    pub(crate) fn close_exactly(&self) -> bool {
        self.closure_weight.is_none_or(f64::is_infinite)
    }
}

/// Adds `½ weight (off + Σᵢ aᵢ ∂qᵢ)²` for a sum of coordinates, given as (coordinate, aᵢ).
fn add_square(
    frame: &Frame<'_>,
    local: &mut LocalModel,
    terms: &[(CoordinateId, f64)],
    off: f64,
    weight: f64,
) {
    let tracker = frame.tracker;
    let n = tracker.unknown_len();
    let slopes = || {
        terms.iter().flat_map(|&(id, factor)| {
            let entries = tracker.part.coordinate_directions(&tracker.model, id).iter();
            entries.map(move |&(direction, slot)| {
                let unknown = tracker.unknowns[direction as usize] as usize;
                (unknown, factor * frame.buffers.jacobian.derivative(slot))
            })
        })
    };
    for (row, slope) in slopes().filter(|(row, _)| *row < n) {
        local.gradient[row] += weight * off * slope;
        for (column, other) in slopes().filter(|(column, _)| *column <= row) {
            local.hessian[row * n + column] += weight * slope * other;
        }
    }
}
