//! What each coordinate of an answer follows from.
//!
//! With the rows A of all goals, loops and limits that hold, over the unknowns that are not at a bound,
//! and the stiffness K at rest, the part of a coordinate that goals determine is
//! (K⁻¹Aᵀ (A K⁻¹ Aᵀ)⁻¹ A)ᵢᵢ: 1 where they alone say where it is, 0 where they say nothing.

use super::answer::By;
use super::problem::Descent;
use super::question::Question;
use crate::tracker::FIXED;
use condyle_model::CoordinateId;

/// From which part on a coordinate is determined by goals, and up to which by rest.
const ALL: f64 = 0.99;
const NOTHING: f64 = 0.01;
/// A bound presses where to leave it would lower what is minimised by more than this share per radian.
const PRESSING: f64 = 1e-6;
/// A row counts as dependent if its part orthogonal to the others is below this share of the longest.
const DEPENDENT: f64 = 1e-7;

/// Judges every coordinate at the current pose, which is evaluated.
pub(super) fn judge(descent: &Descent<'_>) -> Vec<By> {
    let question = descent.question;
    let n = question.unknown_len();
    let (rows, multipliers, active) = descent.multipliers();
    let (equal, _) = descent.shape();
    let mut pushed = vec![0.0; n];
    descent.gradient(&mut pushed);
    let largest = pushed.iter().fold(0.0, |m: f64, g| m.max(g.abs()));
    for (row, y) in rows.chunks_exact(n.max(1)).zip(&multipliers) {
        pushed.iter_mut().zip(row).for_each(|(entry, slope)| *entry -= y * slope);
    }
    let mut by = vec![By::Rest; n];
    let mut free = vec![true; n];
    for unknown in 0..n {
        let [below, above] = descent.at_bounds(unknown);
        let pressed = (below && pushed[unknown] > PRESSING * largest)
            || (above && pushed[unknown] < -PRESSING * largest);
        free[unknown] = !pressed;
        if pressed {
            by[unknown] = By::Limit;
        }
    }
    let mut all = rows.clone();
    descent.squared_rows(&mut all);
    let stiffness = |i: usize| question.goals.rest.stiffness[question.coordinates[i].index()];
    let scale: Vec<f64> =
        (0..n).map(|i| if free[i] { 1.0 / stiffness(i).sqrt() } else { 0.0 }).collect();
    all.chunks_exact_mut(n.max(1)).for_each(|row| {
        row.iter_mut().zip(&scale).for_each(|(entry, s)| *entry *= s);
    });
    let parts = projected(&mut all, n);
    for unknown in (0..n).filter(|&i| free[i]) {
        by[unknown] = match parts[unknown] {
            part if part >= ALL => By::Goals,
            part if part > NOTHING => By::Shared,
            _ => By::Rest,
        };
    }
    // The coordinates that an active limit bounds.
    let first_limit = equal;
    for (i, &row) in active.iter().enumerate().filter(|(_, row)| **row < question.limit_rows) {
        let strength = multipliers[first_limit + i];
        if strength > PRESSING * largest {
            for &(direction, _) in question.program.limit_row_directions(row) {
                let unknown = question.unknowns[direction as usize];
                if unknown != FIXED && by[unknown as usize] != By::Rest {
                    by[unknown as usize] = By::Limit;
                }
            }
        }
    }
    of_coordinates(question, &by)
}

/// From what is said of the unknowns, what each coordinate follows from.
pub(super) fn of_coordinates(question: &Question<'_>, by: &[By]) -> Vec<By> {
    let model = question.model;
    let of = |id: CoordinateId| {
        let coordinate = model.coordinate(id);
        if coordinate.follows.is_some() {
            return By::Follows;
        }
        if coordinate.locked || question.goals.held.contains(&id) {
            return By::Held;
        }
        let own = model.tangent_range(id).map(|d| match question.unknowns[d] {
            FIXED => By::Rest,
            unknown => by[unknown as usize],
        });
        let own: Vec<By> = own.collect();
        match () {
            () if own.contains(&By::Limit) => By::Limit,
            () if own.iter().all(|by| *by == own[0]) => own[0],
            () => By::Shared,
        }
    };
    model.coordinate_ids().map(of).collect()
}

/// The diagonal of the projection on the span of some rows, which become orthonormal.
fn projected(rows: &mut [f64], n: usize) -> Vec<f64> {
    let mut parts = vec![0.0; n];
    let count = rows.len() / n.max(1);
    let square = |row: &[f64]| row.iter().map(|v| v * v).sum::<f64>();
    // Rows of other units are compared by their own length.
    for row in rows.chunks_exact_mut(n.max(1)) {
        let length = square(row).sqrt();
        if length > 0.0 {
            row.iter_mut().for_each(|v| *v /= length);
        }
    }
    for i in 0..count {
        let longest = (i..count).max_by(|&a, &b| {
            square(&rows[a * n..(a + 1) * n]).total_cmp(&square(&rows[b * n..(b + 1) * n]))
        });
        let Some(pick) = longest else { break };
        (0..n).for_each(|j| rows.swap(i * n + j, pick * n + j));
        let (done, rest) = rows.split_at_mut((i + 1) * n);
        let unit = &mut done[i * n..];
        let length = square(unit).sqrt();
        if length <= DEPENDENT {
            break;
        }
        unit.iter_mut().for_each(|v| *v /= length);
        parts.iter_mut().zip(&*unit).for_each(|(part, v)| *part += v * v);
        for row in rest.chunks_exact_mut(n) {
            let along: f64 = row.iter().zip(&*unit).map(|(a, b)| a * b).sum();
            row.iter_mut().zip(&*unit).for_each(|(a, b)| *a -= along * b);
        }
    }
    parts
}
