//! Shipped models in lanes: eight postures at once.

#[allow(dead_code, reason = "the model crate's tests use more of it")]
#[path = "../../../condyle-model/tests/random_models/backend.rs"]
mod backend;

use crate::figure::Draws;
use backend::{Backend, EIGHT, PLAIN};
use condyle::{Mode, Model, shipped};

/// Stored numbers, by a tenth of its range beyond it on either side, so that limits have to hold.
fn posture(model: &Model, draws: &mut Draws) -> Vec<f64> {
    let mut stored = model.defaults();
    for id in model.coordinate_ids() {
        let range = model.coordinate(id).range;
        let (low, high) = (range.lower.unwrap_or(-1.0), range.upper.unwrap_or(1.0));
        for number in &mut stored[model.stored_range(id)] {
            *number = low + (high - low) * (1.2 * draws.share() - 0.1);
        }
    }
    stored
}

#[test]
fn eight_postures_at_once_are_the_eight_alone() {
    let mut draws = Draws(0x0dd5_eed5_0fba_7c4e);
    for name in shipped::names() {
        let model = shipped::read(name).expect(name).value.model;
        let postures: Vec<Vec<f64>> = (0..64).map(|_| posture(&model, &mut draws)).collect();
        for mode in [Mode::Open, Mode::Posed] {
            let together = EIGHT.poses(&model, mode, &postures);
            let alone = PLAIN.poses(&model, mode, &postures);
            // To the last bit: each lane does what a plain number does.
            assert!(together == alone, "{name} {mode:?}");
            // Open poses are all different, so that a lane that is read for another is found.
            let new = |i: usize| alone[..i].iter().all(|pose| pose.segments != alone[i].segments);
            assert!(mode == Mode::Posed || (0..alone.len()).all(new), "{name}");
        }
    }
}
