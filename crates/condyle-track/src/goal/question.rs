//! A model and what is asked of it, laid out for descents: unknowns, bounds, rows.

use super::{Aim, Goals};
use crate::tracker::FIXED;
use condyle_model::{CoordinateId, CoordinateKind, Model, Program};

/// A model and what is asked of it, laid out for descents.
pub(super) struct Question<'a> {
    pub model: &'a Model,
    pub program: Program,
    pub goals: &'a Goals,
    /// For each direction its unknown, or [`FIXED`]; for each unknown its direction and coordinate.
    pub unknowns: Vec<u32>,
    pub directions: Vec<usize>,
    pub coordinates: Vec<CoordinateId>,
    /// For each unknown of a coordinate of one number: where that is stored, and its bounds.
    pub stored: Vec<Option<(usize, f64, f64)>>,
    /// The first row of each goal, and the number of all rows.
    pub first_rows: Vec<usize>,
    pub limit_rows: usize,
}

impl<'a> Question<'a> {
    pub(super) fn new(model: &'a Model, goals: &'a Goals) -> Self {
        let program = Program::compile(model);
        let limit_rows = if goals.limits { program.limit_row_len() } else { 0 };
        let moved = moved(model, &program, goals, limit_rows);
        let mut question = Self {
            model,
            program,
            goals,
            unknowns: vec![FIXED; model.tangent_len()],
            directions: vec![],
            coordinates: vec![],
            stored: vec![],
            first_rows: vec![0],
            limit_rows,
        };
        for goal in &goals.goals {
            let next = question.rows() + goal.aim.rows();
            question.first_rows.push(next);
        }
        for id in model.coordinate_ids() {
            let coordinate = model.coordinate(id);
            let still = coordinate.locked || coordinate.follows.is_some();
            if still || goals.held.contains(&id) || !model.tangent_range(id).any(|d| moved[d]) {
                continue;
            }
            let free = (f64::NEG_INFINITY, f64::INFINITY);
            let (lower, upper) = if goals.limits { coordinate.range.bounds() } else { free };
            for direction in model.tangent_range(id) {
                question.unknowns[direction] = question.directions.len() as u32;
                question.directions.push(direction);
                question.coordinates.push(id);
                let place = model.stored_range(id).start;
                let number = coordinate.kind != CoordinateKind::Orientation;
                question.stored.push(number.then_some((place, lower, upper)));
            }
        }
        question
    }

    pub(super) fn unknown_len(&self) -> usize {
        self.directions.len()
    }

    /// The number of residuals of all goals.
    pub(super) fn rows(&self) -> usize {
        *self.first_rows.last().unwrap_or(&0)
    }

    /// The residuals of a goal among all.
    pub(super) fn rows_of(&self, goal: usize) -> std::ops::Range<usize> {
        self.first_rows[goal]..self.first_rows[goal + 1]
    }

    /// Puts the coordinates that are solved for within their bounds.
    pub(super) fn clamp(&self, stored: &mut [f64]) {
        for &(place, lower, upper) in self.stored.iter().flatten() {
            stored[place] = stored[place].max(lower).min(upper);
        }
    }
}

/// For each direction whether it moves something that a goal, a loop, a limit or a sum of coordinates is
/// about; all others are at rest.
fn moved(model: &Model, program: &Program, goals: &Goals, limit_rows: usize) -> Vec<bool> {
    let mut moved = vec![!model.closures().is_empty(); model.tangent_len()];
    let mut mark = |entries: &[(u32, u32)]| {
        entries.iter().for_each(|&(direction, _)| moved[direction as usize] = true);
    };
    for goal in &goals.goals {
        goal.aim.segments().for_each(|segment| mark(program.segment_directions(segment)));
        if let Aim::Coordinate { coordinate, .. } = goal.aim {
            mark(program.coordinate_directions(model, coordinate));
        }
    }
    let summed = goals.rest.sums.iter().flat_map(|sum| &sum.terms);
    summed.for_each(|&(id, _)| mark(program.coordinate_directions(model, id)));
    (0..limit_rows).for_each(|row| mark(program.limit_row_directions(row)));
    moved
}
