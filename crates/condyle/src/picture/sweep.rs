//! A coordinate over its range, the others where they are.

use super::figure::Figure;
use condyle_model::{CoordinateId, CoordinateKind, Jacobian, Pose};

/// Buffers for poses beside the one that is drawn.
pub(super) struct Sweep<'a> {
    figure: &'a Figure<'a>,
    stored: Vec<f64>,
    pose: Pose,
    jacobian: Jacobian,
}

/// A pose with another value of one coordinate.
pub(super) struct At<'s> {
    pub(super) pose: &'s Pose,
    pub(super) jacobian: &'s Jacobian,
    /// Whether it breaks no limit that the drawn pose keeps.
    pub(super) legal: bool,
}

/// Values over a range.
const VALUES: usize = 49;

/// How far from its value a coordinate without a range is followed: 30 degrees, or 30 mm.
const REACH: [f64; 2] = [0.524, 0.03];

impl<'a> Sweep<'a> {
    pub(super) fn new(figure: &'a Figure<'a>) -> Self {
        Self {
            figure,
            stored: figure.stored.to_vec(),
            pose: Pose::new(figure.program),
            jacobian: Jacobian::new(figure.program),
        }
    }

    /// The ends of the range of a coordinate; `None` of one that is not bounded on both sides or not free.
    pub(super) fn range(&self, id: CoordinateId) -> Option<[f64; 2]> {
        let coordinate = self.figure.model.coordinate(id);
        let range = coordinate.range;
        let ends = [range.lower?, range.upper?];
        let good = ends.iter().all(|x| x.is_finite()) && ends[0] < ends[1];
        (good && coordinate.follows.is_none()).then_some(ends)
    }

    /// Values over the range of a coordinate; around its value where there is none, and the value alone of an
    /// orientation.
    pub(super) fn values(&self, id: CoordinateId) -> Vec<f64> {
        let now = self.figure.model.value(self.figure.stored, id);
        let kind = self.figure.model.coordinate(id).kind;
        if kind == CoordinateKind::Orientation {
            return vec![];
        }
        let reach = REACH[usize::from(kind == CoordinateKind::Translation)];
        let [low, high] = self.range(id).unwrap_or([now - reach, now + reach]);
        let step = (high - low) / (VALUES - 1) as f64;
        (0..VALUES).map(|index| low + index as f64 * step).collect()
    }

    /// The pose with another value of a coordinate.
    pub(super) fn at(&mut self, id: CoordinateId, value: f64) -> Option<At<'_>> {
        self.with(&[(id, value)])
    }

    /// The pose with other values of coordinates.
    pub(super) fn with(&mut self, values: &[(CoordinateId, f64)]) -> Option<At<'_>> {
        let Self { figure, stored, pose, jacobian } = self;
        stored.copy_from_slice(figure.stored);
        for &(id, value) in values {
            *figure.model.value_mut(stored, id) = value;
        }
        figure.program.evaluate_with_jacobian(stored, pose, jacobian).ok()?;
        let legal = (0..figure.program.limit_row_len()).all(|row| {
            let (now, then) = (figure.pose.limit_row(row), pose.limit_row(row));
            then >= -ROOM || then >= now - ROOM
        });
        Some(At { pose, jacobian, legal })
    }
}

/// A limit that is broken by less is kept, in radians or metres.
const ROOM: f64 = 1e-6;
