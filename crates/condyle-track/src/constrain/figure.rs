//! A model of which single poses are asked: whether they are legal, the nearest legal one, segments in their parents.

use crate::goal::{nearest_closed, nearest_legal};
use condyle_math::{Quat, Vec3};
use condyle_model::evaluate::ClosureRows;
use condyle_model::{CoordinateKind, Mode, Model, Pose, Program, SegmentId};

/// A number outside a limit by less than this, in radians or metres, is rounding.
const ROUNDING: f64 = 1e-9;
/// A solver has kept a limit to this.
const SOLVED: f64 = 1e-6;
/// A loop that is open by less than this, in metres or radians, is closed: as exactly as `.mot` files are written.
const CLOSED: f64 = 1e-4;
/// A loop that was to be closed is, to this.
const CLOSED_ANEW: f64 = 1e-5;
/// A solver's answer nearer than this to what was asked is what was asked.
const SAME: f64 = 1e-12;
/// Into how many parts a step toward a pose is divided.
const PARTS: usize = 4;

/// What a pose is, and the nearest legal one.
pub(super) enum Nearest {
    Legal,
    Moved(Vec<f64>),
    /// No legal pose was found; the one that breaks limits least, where there is one.
    Left(Option<Vec<f64>>),
}

/// Where a segment is in its parent.
#[derive(Clone, Copy, Debug)]
pub(super) struct Seat {
    pub turn: Quat,
    pub place: Vec3,
}

pub(super) struct Figure<'m> {
    pub model: &'m Model,
    program: Program,
    pose: Pose,
    rows: ClosureRows,
    held: Vec<f64>,
}

impl<'m> Figure<'m> {
    pub(super) fn new(model: &'m Model) -> Self {
        let program = Program::compile(model);
        let pose = Pose::new(&program);
        let held = vec![0.0; program.stored_len()];
        Self { model, program, pose, rows: ClosureRows::new(model), held }
    }

    /// Whether a pose keeps all limits and loops, but for rounding.
    pub(super) fn is_legal(&mut self, stored: &[f64]) -> bool {
        self.keeps(stored, SOLVED, CLOSED)
    }

    fn keeps(&mut self, stored: &[f64], limits: f64, loops: f64) -> bool {
        if self.program.evaluate(stored, Mode::Open, &mut self.pose).is_err() {
            return false;
        }
        let model = self.model;
        let inside = model.coordinate_ids().all(|id| {
            let coordinate = model.coordinate(id);
            coordinate.kind == CoordinateKind::Orientation
                || coordinate.follows.is_some()
                || (coordinate.range.nearest(model.value(stored, id)) - model.value(stored, id))
                    .abs()
                    <= limits
        });
        let kept = |row: usize| self.pose.limit_row(row) >= -limits;
        if !inside || !(0..self.program.limit_row_len()).all(kept) {
            return false;
        }
        if self.rows.is_empty() {
            return true;
        }
        self.rows.update(model, &self.program, &self.pose, None);
        self.rows.residuals.iter().all(|gap| gap.abs() <= loops)
    }

    /// The nearest legal pose.
    pub(super) fn nearest(&mut self, asked: &[f64]) -> Nearest {
        if asked.len() != self.program.stored_len() || asked.iter().any(|x| !x.is_finite()) {
            return Nearest::Left(None);
        }
        if self.keeps(asked, ROUNDING, CLOSED) {
            return Nearest::Legal;
        }
        // Limits on coordinates project.
        if self.program.evaluate(asked, Mode::Posed, &mut self.pose).is_ok() {
            self.program.held(self.model, &self.pose, &mut self.held);
            let held = self.held.clone();
            if self.keeps(&held, SOLVED, CLOSED) {
                return Nearest::Moved(held);
            }
        }
        // Those between segments, those on sums of coordinates, and loops are solved for.
        let found = match self.rows.is_empty() {
            true => nearest_legal(self.model, asked),
            false => nearest_closed(self.model, asked),
        };
        match found {
            Some(mut found) => {
                for (number, &asked) in found.iter_mut().zip(asked) {
                    if (*number - asked).abs() <= SAME {
                        *number = asked;
                    }
                }
                match self.keeps(&found, SOLVED, CLOSED_ANEW) {
                    true => Nearest::Moved(found),
                    false => Nearest::Left(Some(found)),
                }
            }
            None => Nearest::Left(None),
        }
    }

    /// The nearest legal pose, or the pose itself.
    pub(super) fn legal(&mut self, asked: Vec<f64>) -> Vec<f64> {
        match self.nearest(&asked) {
            Nearest::Moved(nearest) | Nearest::Left(Some(nearest)) => nearest,
            Nearest::Legal | Nearest::Left(None) => asked,
        }
    }

    /// Segments in their parents, in the order of the model.
    pub(super) fn seats(&mut self, stored: &[f64], seats: &mut Vec<Seat>) {
        seats.clear();
        if self.program.evaluate(stored, Mode::Open, &mut self.pose).is_err() {
            return;
        }
        let seat = |id: SegmentId| {
            let own = self.pose.segment_in_parent(self.model, id);
            Seat { turn: Quat::from_mat3(own.linear).normalized(), place: own.translation }
        };
        seats.extend(self.model.segment_ids().map(seat));
    }

    /// A share of the way between two poses; numbers that are equal stay so to the bit.
    pub(super) fn between(&self, from: &[f64], to: &[f64], share: f64) -> Vec<f64> {
        let mut between = from.to_vec();
        self.model.interpolate(from, to, share, &mut between);
        for id in self.model.coordinate_ids() {
            let place = self.model.stored_range(id);
            if from[place.clone()] == to[place.clone()] {
                between[place.clone()].copy_from_slice(&from[place]);
            }
        }
        between
    }

    /// The legal pose that is reached from one toward another, of which each coordinate comes nearer by at most its
    /// own amount, in small steps that stay legal.
    pub(super) fn toward(&mut self, from: &[f64], to: &[f64], most: &[f64]) -> Vec<f64> {
        let mut here = from.to_vec();
        for part in (1..=PARTS).rev() {
            if here == to {
                break;
            }
            let mut next = here.clone();
            for (id, most) in self.model.coordinate_ids().zip(most) {
                let place = self.model.stored_range(id);
                let gap = gap(&here[place.clone()], &to[place.clone()]);
                // What is left of the whole way is divided among the parts that are left.
                let step = (most / PARTS as f64).max(gap / part as f64 * f64::from(gap <= *most));
                if gap <= step {
                    next[place.clone()].copy_from_slice(&to[place]);
                } else if let ([number], [to]) = (&mut next[place.clone()], &to[place.clone()]) {
                    *number += step * (to - *number).signum();
                } else if let (Some(a), Some(b)) =
                    (quat(&here[place.clone()]), quat(&to[place.clone()]))
                {
                    let turn = (a.conjugate() * b).to_mat3().log();
                    let turned = (a * Quat::exp(turn * (step / gap))).normalized();
                    next[place].copy_from_slice(&turned.to_array());
                }
            }
            here = self.legal(next);
        }
        here
    }

    /// For each coordinate by how much it differs between two poses, in radians or metres.
    pub(super) fn gaps<'a>(
        &'a self,
        from: &'a [f64],
        to: &'a [f64],
    ) -> impl Iterator<Item = (CoordinateKind, f64)> + 'a {
        self.model.coordinate_ids().map(move |id| {
            let place = self.model.stored_range(id);
            (self.model.coordinate(id).kind, gap(&from[place.clone()], &to[place]))
        })
    }
}

fn quat(stored: &[f64]) -> Option<Quat> {
    let numbers: [f64; 4] = stored.try_into().ok()?;
    Some(Quat::from(numbers).normalized())
}

fn gap(from: &[f64], to: &[f64]) -> f64 {
    match (from, to) {
        (from, to) if from == to => 0.0,
        ([from], [to]) => (from - to).abs(),
        _ => quat(from).zip(quat(to)).map_or(0.0, |(from, to)| from.angle_to(to)),
    }
}
