//! What a motion within limits changed, coordinate by coordinate.

use condyle_math::Quat;
use condyle_model::{CoordinateId, CoordinateKind, Model};
use condyle_motion::Motion;

/// A coordinate that differs by less, in radians or metres, is not changed.
const UNCHANGED: f64 = 1e-9;
/// A tenth of a metre counts as a radian.
const PER_METRE: f64 = 10.0;

/// What was done to one coordinate.
#[derive(Clone, Debug, PartialEq)]
pub struct Change {
    /// The coordinate.
    pub coordinate: CoordinateId,
    /// In how many frames it was changed.
    pub frames: usize,
    /// The mean amount over these, in radians or metres; of an orientation the angle.
    pub mean: f64,
    /// The largest amount.
    pub most: f64,
    /// The frame of it.
    pub frame: usize,
}

/// What was done to each coordinate that was changed, those that follow others included, the largest change first, a
/// radian counting as a tenth of a metre.
///
/// ```
/// use condyle_math::Vec3;
/// use condyle_model::ModelBuilder;
/// use condyle_motion::Motion;
/// use condyle_track::constrain::changes;
/// let mut b = ModelBuilder::new("arm");
/// let forearm = b.segment("forearm", None);
/// b.hinge("elbow", forearm, "flexion", Vec3::Z);
/// let model = b.build()?;
/// let [before, after] = [[0.5, 0.75, 1.0], [0.5, 0.5, 0.5]].map(|values| Motion {
///     times: vec![0.0, 0.1, 0.2],
///     frames: values.map(|value| vec![value]).to_vec(),
/// });
/// let change = &changes(&model, &before, &after)[0];
/// assert_eq!((change.frames, change.mean, change.most, change.frame), (2, 0.375, 0.5, 2));
/// # Ok::<(), condyle_diagnostics::Error>(())
/// ```
pub fn changes(model: &Model, before: &Motion, after: &Motion) -> Vec<Change> {
    let mut all: Vec<Change> = vec![];
    for id in model.coordinate_ids() {
        let mut change = Change { coordinate: id, frames: 0, mean: 0.0, most: 0.0, frame: 0 };
        for (frame, (from, to)) in before.frames.iter().zip(&after.frames).enumerate() {
            let by = amount(model, id, from, to);
            if by <= UNCHANGED {
                continue;
            }
            change.frames += 1;
            change.mean += by;
            if by > change.most {
                (change.most, change.frame) = (by, frame);
            }
        }
        if change.frames > 0 {
            change.mean /= change.frames as f64;
            all.push(change);
        }
    }
    let counted = |change: &Change| match model.coordinate(change.coordinate).kind {
        CoordinateKind::Translation => PER_METRE * change.most,
        _ => change.most,
    };
    all.sort_by(|a, b| counted(b).total_cmp(&counted(a)));
    all
}

/// How far apart a coordinate is in two postures.
fn amount(model: &Model, id: CoordinateId, from: &[f64], to: &[f64]) -> f64 {
    let place = model.stored_range(id);
    let (Some(from), Some(to)) = (from.get(place.clone()), to.get(place)) else { return 0.0 };
    match (<[f64; 4]>::try_from(from), <[f64; 4]>::try_from(to)) {
        _ if from == to => 0.0,
        (Ok(from), Ok(to)) => Quat::from(from).normalized().angle_to(Quat::from(to).normalized()),
        _ => from.iter().zip(to).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max),
    }
}
