//! Where each marker lies beside its place on the model, and how far it strays from there.

use super::trial::Trial;
use condyle_math::Vec3;

/// A marker strays when it is farther from its own offset than this many scales of its deviations.
const SCALES: f64 = 4.0;
/// But never nearer than this, in metres.
const LEAST_GATE: f64 = 0.040;
/// Where the offset is not known, a marker strays from this distance on, in metres.
const UNKNOWN_GATE: f64 = 0.150;
/// A marker seen in fewer frames has no known offset: only where it is off by more than 150 mm it is
/// looked at.
pub const FEWEST_FRAMES: usize = 12;
/// The median deviation of a normal distribution's norm in three dimensions is 1.54 of one of them.
const MEDIAN_TO_SCALE: f64 = 1.0 / 1.54;

/// For each marker target its offset in the axes of its segment, and the distance from which on it strays.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Offsets {
    pub offsets: Vec<Vec3>,
    pub gates: Vec<f64>,
}

impl Offsets {
    /// No offsets, and gates for such.
    pub(super) fn unknown(markers: usize) -> Self {
        Self { offsets: vec![Vec3::ZERO; markers], gates: vec![UNKNOWN_GATE; markers] }
    }

    /// Medians over the frames given, axis by axis.
    pub(super) fn of(trial: &Trial<'_>, frames: &[usize]) -> Self {
        let (mut offsets, mut gates) = (vec![], vec![]);
        let (mut residuals, mut sorted) = (vec![], vec![]);
        for (marker, placed) in trial.tracker.markers.placed.iter().enumerate() {
            residuals.clear();
            residuals.extend(frames.iter().filter_map(|&frame| trial.residual(frame, marker)));
            if residuals.len() < FEWEST_FRAMES || placed.weight <= 0.0 {
                offsets.push(Vec3::ZERO);
                // A marker of no weight has no fault.
                gates.push(if placed.weight > 0.0 { UNKNOWN_GATE } else { f64::INFINITY });
                continue;
            }
            let axis = |of: fn(&Vec3) -> f64, sorted: &mut Vec<f64>| {
                sorted.clear();
                sorted.extend(residuals.iter().map(of));
                median(sorted)
            };
            let [x, y, z] =
                [|v: &Vec3| v.x, |v: &Vec3| v.y, |v: &Vec3| v.z].map(|of| axis(of, &mut sorted));
            let offset = Vec3::new(x, y, z);
            sorted.clear();
            sorted.extend(residuals.iter().map(|&r| (r - offset).norm()));
            let scale = MEDIAN_TO_SCALE * median(&mut sorted);
            offsets.push(offset);
            gates.push((SCALES * scale).max(LEAST_GATE));
        }
        Self { offsets, gates }
    }
}

/// The middle one; 0 of none.
pub(super) fn median(numbers: &mut [f64]) -> f64 {
    if numbers.is_empty() {
        return 0.0;
    }
    let middle = numbers.len() / 2;
    *numbers.select_nth_unstable_by(middle, f64::total_cmp).1
}
