//! Coordinates whose limits act behind maps: on f(q) instead of on the coordinate q itself.
//!
//! A limit lets through y instead of f(q). The coordinate that gives the same posture without limits is the
//! solution of f(q) = y that is nearest to what was asked, where there is one.

use super::Pose;
use super::instruction::Number;
use super::program::Program;
use crate::model::{CoordinateId, Model};
use condyle_math::function::Function;
use std::f64::consts::TAU;

/// A coordinate, the maps behind it, and the limit behind those.
#[derive(Clone, Debug)]
pub(super) struct Behind {
    /// The coordinate's stored number.
    pub coordinate: CoordinateId,
    /// The maps, in the order in which they are applied.
    pub functions: Vec<Function>,
    /// What the maps give, and what the limit lets through.
    pub before: Number,
    pub held: Number,
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
            if before == held {
                continue;
            }
            let value = &mut stored[model.stored_range(behind.coordinate).start];
            let range = model.coordinate(behind.coordinate).range.bounds();
            if let Some(found) = nearest_solution(&behind.functions, *value, held, range) {
                *value = found;
            }
        }
    }
}

/// The x nearest to `start` within the range where the functions, one after another, give y.
fn nearest_solution(functions: &[Function], start: f64, y: f64, range: (f64, f64)) -> Option<f64> {
    let off = |x: f64| functions.iter().fold(x, |x, f| f.value_and_slope(x).0) - y;
    let reach = |end: f64, sign: f64| {
        if end.is_finite() { (end - start) * sign } else { TAU }
    };
    let here = off(start);
    let mut found: Option<f64> = None;
    for (sign, far) in [(1.0, reach(range.1, 1.0)), (-1.0, reach(range.0, -1.0))] {
        let mut last = (start, here);
        for step in 1..=STEPS {
            let x = start + sign * far.max(0.0) * f64::from(step) / f64::from(STEPS);
            let value = off(x);
            if value == 0.0 || value.signum() != last.1.signum() {
                let root = halved(&off, last, (x, value));
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
        let twice = [Function::linear(2.0, 0.0), Function::linear(1.0, 0.5)];
        // 2x + 1/2 = 1.1
        let x = nearest_solution(&twice, 1.0, 1.1, (-1.0, 1.0)).unwrap();
        assert!((x - 0.3).abs() < 1e-15, "{x}");
        assert_eq!(nearest_solution(&twice, 1.0, 9.0, (-1.0, 1.0)), None);
        // A parabola has two: x² = 1/4.
        let square = condyle_math::function::Polynomial::from_ascending(vec![0.0, 0.0, 1.0]);
        let square =
            [Function { factor: 1.0, curve: condyle_math::function::Curve::Polynomial(square) }];
        let x = nearest_solution(&square, -2.0, 0.25, (-3.0, 3.0)).unwrap();
        assert!((x + 0.5).abs() < 1e-15, "{x}");
    }
}
