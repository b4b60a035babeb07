//! A motion of any model within its ranges, and its marker positions.

use crate::random::Random;
use condyle_model::{CoordinateKind, Mode, Model, Pose, Program};

/// A marker's place in one frame.
pub type Seen = Option<[f64; 3]>;

/// Frames a second of the motions made here.
pub const RATE: f64 = 100.0;

/// Coordinates that oscillate about the middle of their ranges, each at its own frequency.
pub fn motion(model: &Model, frames: usize) -> Vec<Vec<f64>> {
    (0..frames)
        .map(|frame| {
            let time = frame as f64 / RATE;
            let mut stored = model.defaults();
            for (i, id) in model.coordinate_ids().enumerate() {
                let coordinate = model.coordinate(id);
                let (lower, upper) = coordinate.range.bounds();
                let swing =
                    (std::f64::consts::TAU * (0.5 + 0.05 * (i % 9) as f64) * time + i as f64).sin();
                let place = model.stored_range(id).start;
                match coordinate.kind {
                    CoordinateKind::Rotation if upper - lower < 6.0 => {
                        stored[place] = 0.5 * (lower + upper) + 0.3 * (upper - lower) * swing;
                    }
                    CoordinateKind::Rotation => stored[place] = 0.3 * swing,
                    CoordinateKind::Translation => stored[place] = 0.1 * swing,
                    CoordinateKind::Scale | CoordinateKind::Other | CoordinateKind::Orientation => {
                    }
                }
            }
            stored
        })
        .collect()
}

/// Every marker of the model in every frame, with noise of `deviation` metres on each axis.
pub fn recorded(model: &Model, motion: &[Vec<f64>], deviation: f64) -> Vec<Vec<Seen>> {
    let program = Program::compile(model);
    let mut pose = Pose::new(&program);
    let mut random = Random::new(11);
    motion
        .iter()
        .map(|stored| {
            let evaluated = program.evaluate(stored, Mode::Open, &mut pose);
            evaluated.unwrap_or_else(|error| panic!("the motion is the model's: {error}"));
            let markers = model.markers().iter();
            markers
                .map(|marker| {
                    let place = pose.frame(marker.segment) * marker.point;
                    Some(place.to_array().map(|x| x + deviation * random.normal()))
                })
                .collect()
        })
        .collect()
}
