//! Coordinates whose limits act behind maps: on f(q) instead of on the coordinate q itself.
//!
//! A limit lets through y instead of f(q). The coordinate that gives the same posture without limits is the
//! solution of f(q) = y that is nearest to what was asked, where there is one. A sum of several coordinates
//! is such a function of one of them where limits have settled the others.

use super::Pose;
use super::instruction::Number;
use super::program::Program;
use crate::model::{CoordinateId, Model};
use condyle_math::function::{Function, FunctionOfSeveral};
use std::f64::consts::TAU;

/// A coordinate, the maps behind it, and the limit behind those.
#[derive(Clone, Debug)]
pub(super) struct Behind {
    /// The coordinate's stored number.
    pub coordinate: CoordinateId,
    /// What is between it and the limit, in the order in which it is applied.
    pub steps: Vec<Between>,
    /// What the maps give, and what the limit lets through.
    pub before: Number,
    pub held: Number,
}

/// What a coordinate goes through before it is limited.
#[derive(Clone, Debug)]
pub(super) enum Between {
    /// A function of it alone.
    Map(Function),
    /// A function of several coordinates, of which it is the one at a position; the others are where their
    /// limits have put them.
    Several { function: FunctionOfSeveral, coordinates: Vec<CoordinateId>, at: usize },
}

impl Between {
    fn apply(&self, x: f64, value: &impl Fn(CoordinateId) -> f64) -> f64 {
        match self {
            Self::Map(function) => function.value_and_slope(x).0,
            Self::Several { function, coordinates, at } => {
                let one = |(k, id): (usize, &CoordinateId)| if k == *at { x } else { value(*id) };
                function.apply_to(coordinates.iter().enumerate().map(one))
            }
        }
    }
}

/// Steps of the search for a solution, on each side of what was asked.
const STEPS: u32 = 128;

/// Halvings of an interval: to the last bit of any range.
const HALVINGS: u32 = 100;

impl Program {
    /// The stored numbers that give the evaluated posture: the effective ones, and for a coordinate whose
    /// limit acts behind maps the one whose maps give what the limit lets through.
    ///
    /// After an evaluation in posed mode. Where no value of a coordinate gives what its limits let through,
    /// its effective number stands.
    pub fn held(&self, model: &Model, pose: &Pose, stored: &mut [f64]) {
        stored.copy_from_slice(pose.effective());
        for behind in &self.behind {
            let scalars = &pose.scalars;
            let (before, held) = (scalars[behind.before.index()], scalars[behind.held.index()]);
            // A sum has to be met again where a limit has moved another of its coordinates.
            let alone = behind.steps.iter().all(|step| matches!(step, Between::Map(_)));
            if before == held && alone {
                continue;
            }
            let place = model.stored_range(behind.coordinate).start;
            let range = model.coordinate(behind.coordinate).range.bounds();
            let value = |id: CoordinateId| stored[model.stored_range(id).start];
            let off = |x: f64| behind.steps.iter().fold(x, |x, step| step.apply(x, &value)) - held;
            if let Some(found) = nearest_root(&off, stored[place], range) {
                stored[place] = found;
            }
        }
    }
}

/// The x nearest to `start` within the range where a function is 0.
fn nearest_root(off: &impl Fn(f64) -> f64, start: f64, range: (f64, f64)) -> Option<f64> {
    let reach = |end: f64, sign: f64| {
        if end.is_finite() { (end - start) * sign } else { TAU }
    };
    let here = off(start);
    let mut found: Option<f64> = None;
    for (sign, far) in [(1.0, reach(range.1, 1.0)), (-1.0, reach(range.0, -1.0))] {
        let mut last = (start, here);
        if here == 0.0 {
            return Some(start);
        }
        for step in 1..=STEPS {
            let x = start + sign * far.max(0.0) * f64::from(step) / f64::from(STEPS);
            let value = off(x);
            if value == 0.0 || value.signum() != last.1.signum() {
                let root = halved(off, last, (x, value));
                if found.is_none_or(|known| (root - start).abs() < (known - start).abs()) {
                    found = Some(root);
                }
                break;
            }
            last = (x, value);
        }
    }
    found
}

/// A root between two points with values of different signs.
fn halved(off: &impl Fn(f64) -> f64, mut a: (f64, f64), mut b: (f64, f64)) -> f64 {
    for _ in 0..HALVINGS {
        let middle = 0.5 * (a.0 + b.0);
        let value = off(middle);
        if value.signum() == a.1.signum() {
            a = (middle, value);
        } else {
            b = (middle, value);
        }
    }
    if a.1.abs() < b.1.abs() { a.0 } else { b.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_nearest_solution_is_found() {
        // 2x + 1/2 = 1.1
        let x = nearest_root(&|x| 2.0 * x - 0.6, 1.0, (-1.0, 1.0)).unwrap();
        assert!((x - 0.3).abs() < 1e-15, "{x}");
        assert_eq!(nearest_root(&|x| 2.0 * x - 8.5, 1.0, (-1.0, 1.0)), None);
        // A parabola has two: x² = 1/4.
        let x = nearest_root(&|x| x * x - 0.25, -2.0, (-3.0, 3.0)).unwrap();
        assert!((x + 0.5).abs() < 1e-15, "{x}");
    }
}
