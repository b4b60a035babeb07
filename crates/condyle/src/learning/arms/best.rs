//! The constant centre that leaves the least at markers.
//!
//! The sum of squares that tracking leaves is a smooth function of three numbers. It is fitted by a quadratic through ten places
//! about the best one so far, whose lowest point is tried, until it moves by less than a tenth of a millimetre.

use super::residuals::Residuals;
use crate::tracking::{Request, track};
use condyle_diagnostics::Error;
use condyle_learn::arms::{Arm, Centre, Leg};
use condyle_learn::coupling::LawFunction;
use condyle_math::function::FunctionOfSeveral;
use condyle_model::component::Region;
use condyle_motion::Recording;

/// Frames of one person, and how many times as large that person's places are where the centre is sought.
pub(in crate::learning) struct Seen<'a> {
    pub leg: &'a Leg,
    pub recording: Recording,
    pub factors: [f64; 3],
}

/// How far apart the places of the quadratic are, in metres.
const STEP: f64 = 4e-3;
/// The farthest that the centre moves at once, in metres.
const FARTHEST: f64 = 0.03;
/// The centre is found when it moves by less, in metres.
const NEAR: f64 = 1e-4;
/// The most quadratics.
const ROUNDS: usize = 6;

/// The best constant centre, from a first guess.
///
/// # Errors
/// Those of tracking.
pub(in crate::learning) fn best(
    seen: &[Seen<'_>],
    guess: [f64; 3],
    request: &Request,
) -> Result<[f64; 3], Error> {
    let left = |centre: [f64; 3]| left(seen, centre, request);
    let moved = |at: [f64; 3], by: &[(usize, f64)]| {
        let mut at = at;
        for (axis, by) in by {
            at[*axis] += by;
        }
        at
    };
    let mut at = guess;
    let mut here = left(at)?;
    for _ in 0..ROUNDS {
        let (mut slope, mut bend) = ([0.0; 3], [[0.0; 3]; 3]);
        let mut ahead = [0.0; 3];
        for axis in 0..3 {
            let [before, after] =
                [left(moved(at, &[(axis, -STEP)]))?, left(moved(at, &[(axis, STEP)]))?];
            ahead[axis] = after;
            slope[axis] = (after - before) / (2.0 * STEP);
            bend[axis][axis] = (after + before - 2.0 * here) / (STEP * STEP);
        }
        for (i, j) in [(0, 1), (0, 2), (1, 2)] {
            let both = left(moved(at, &[(i, STEP), (j, STEP)]))?;
            let mixed = (both - ahead[i] - ahead[j] + here) / (STEP * STEP);
            bend[i][j] = mixed;
            bend[j][i] = mixed;
        }
        let Some(step) = lowest(slope, bend) else { break };
        let length = step.iter().map(|x| x * x).sum::<f64>().sqrt();
        let share = (FARTHEST / length).min(1.0);
        let next = [0, 1, 2].map(|axis| at[axis] + share * step[axis]);
        let there = left(next)?;
        if there >= here {
            break;
        }
        (at, here) = (next, there);
        if length < NEAR {
            break;
        }
    }
    Ok(at)
}

/// The step to the lowest point of a quadratic; directions in which it does not bend upwards are damped.
fn lowest(slope: [f64; 3], bend: [[f64; 3]; 3]) -> Option<[f64; 3]> {
    let trace = bend[0][0].abs() + bend[1][1].abs() + bend[2][2].abs();
    let mut damping = 1e-9 * trace;
    while damping < 1e3 * trace {
        let mut a = bend;
        (0..3).for_each(|k| a[k][k] += damping);
        if let Some(step) = solved(a, slope) {
            return Some(step);
        }
        damping *= 10.0;
    }
    None
}

/// The solution of A·x = -b by Cholesky; `None` where A is not positive definite.
fn solved(a: [[f64; 3]; 3], b: [f64; 3]) -> Option<[f64; 3]> {
    let mut l = [[0.0; 3]; 3];
    for i in 0..3 {
        for j in 0..=i {
            let sum: f64 = (0..j).map(|k| l[i][k] * l[j][k]).sum();
            if i == j {
                let pivot: f64 = a[i][i] - sum;
                if pivot <= 1e-12 * a[i][i].abs() {
                    return None;
                }
                l[i][i] = pivot.sqrt();
            } else {
                l[i][j] = (a[i][j] - sum) / l[j][j];
            }
        }
    }
    let mut x = b.map(|b| -b);
    for i in 0..3 {
        x[i] = (x[i] - (0..i).map(|k| l[i][k] * x[k]).sum::<f64>()) / l[i][i];
    }
    for i in (0..3).rev() {
        x[i] = (x[i] - (i + 1..3).map(|k| l[k][i] * x[k]).sum::<f64>()) / l[i][i];
    }
    Some(x)
}

/// The mean of squared distances over all markers, in m².
fn left(seen: &[Seen<'_>], centre: [f64; 3], request: &Request) -> Result<f64, Error> {
    let (mut sum, mut count) = (0.0, 0usize);
    for own in seen {
        let place = [0, 1, 2].map(|axis| centre[axis] / own.factors[axis]);
        let model = own.leg.arm(Arm::Fixed, Some(&constant(place)))?;
        let tracking = track(&model, &own.recording, request, &mut |_, _| {})?;
        let (squares, distances) = Residuals::squares(own.leg, &tracking);
        sum += squares;
        count += distances;
    }
    Ok(sum / count.max(1) as f64)
}

/// A centre that stays.
fn constant(place: [f64; 3]) -> Centre {
    let law = |intercept: f64| {
        LawFunction::Several(FunctionOfSeveral::Linear { slopes: vec![0.0; 3], intercept })
    };
    Centre {
        laws: place.map(law),
        mean: place,
        best: None,
        region: Region {
            low: vec![],
            high: vec![],
            centre: vec![],
            inverse: vec![],
            distance: 0.0,
        },
        frames: 0,
    }
}

#[cfg(test)]
mod tests {
    use super::lowest;

    #[test]
    fn the_lowest_point_of_a_bowl_is_found_and_a_saddle_goes_down() {
        // f = ½ xᵀAx + bx with A = [[4, 1, 0], [1, 3, 0], [0, 0, 2]], b = (1, 2, -2): A·(-1/11, -7/11, 1) = -b.
        let bowl = [[4.0, 1.0, 0.0], [1.0, 3.0, 0.0], [0.0, 0.0, 2.0]];
        let found = lowest([1.0, 2.0, -2.0], bowl).unwrap();
        for (found, expected) in found.into_iter().zip([-1.0 / 11.0, -7.0 / 11.0, 1.0]) {
            assert!((found - expected).abs() < 1e-7, "{found} {expected}");
        }
        let saddle = [[1.0, 0.0, 0.0], [0.0, -1.0, 0.0], [0.0, 0.0, 1.0]];
        let slope = [1.0, 1.0, 1.0];
        let step = lowest(slope, saddle).unwrap();
        let down: f64 = step.iter().zip(slope).map(|(x, s)| x * s).sum();
        assert!(down < 0.0);
    }
}
