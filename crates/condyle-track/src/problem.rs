//! One frame as a least-squares problem.

use crate::moments::{Moments, pair};
use crate::tracker::{Buffers, Tracker};
use condyle_math::Vec3;
use condyle_model::evaluate::ClosureRows;
use condyle_model::{Jacobian, Pose};
use condyle_solve::least_squares::{LocalModel, Problem};

/// Weight of the pull of every unknown towards its default, m² per rad² (or per m²).
///
/// With 35 unknowns a radian off their defaults it adds 4e-12 m² to F, where a mean marker error of
/// 2 mm makes 4e-6; a direction that the markers feel by a tenth of a millimetre per radian moves by
/// 1e-5 rad.
pub const PRIOR: f64 = 1e-13;

/// The frame's problem, over buffers of a scratch.
pub(crate) struct FrameProblem<'a, 'm> {
    pub tracker: &'a Tracker<'m>,
    pub targets: &'a [Option<[f64; 3]>],
    pub frame: usize,
    pub pose: &'a mut Pose,
    pub jacobian: &'a mut Jacobian,
    pub closures: &'a mut ClosureRows,
    pub buffers: &'a mut Buffers,
    /// Sum of the weights of the markers seen.
    pub total_weight: f64,
}

impl FrameProblem<'_, '_> {
    /// Weighs the markers of the frame: zero where one is not seen.
    pub(crate) fn weigh(&mut self, factors: Option<&[f64]>) {
        self.total_weight = 0.0;
        for (i, marker) in self.tracker.markers.iter().enumerate() {
            let seen = self.targets.get(i).copied().flatten().is_some();
            let factor = factors.map_or(1.0, |f| f[i]);
            self.buffers.weights[i] = if seen { marker.weight * factor } else { 0.0 };
            self.total_weight += self.buffers.weights[i];
        }
    }

    /// Distances of the markers at the pose that was evaluated last; Σ w |e|².
    pub(crate) fn measure(&mut self) -> f64 {
        let mut sum = 0.0;
        for (i, marker) in self.tracker.markers.iter().enumerate() {
            let weight = self.buffers.weights[i];
            let Some(target) = self.targets.get(i).copied().flatten() else { continue };
            let point = self.pose.frame(marker.segment) * marker.point;
            let error = point - Vec3::from(target);
            self.buffers.points[i] = point;
            self.buffers.errors[i] = error;
            sum += weight * error.norm_squared();
        }
        sum
    }

    /// Σ w_c (q_c - t_c)² at the pose that was evaluated last.
    pub(crate) fn task_cost(&self) -> f64 {
        let model = self.tracker.model;
        let tasks = self.tracker.tasks.coordinates.iter();
        tasks
            .filter_map(|task| {
                let target = task.target.at(self.frame)?;
                let off = self.pose.coordinate(model, task.coordinate)[0] - target;
                Some(task.weight * off * off)
            })
            .sum()
    }

    fn marker_scale(&self) -> f64 {
        if self.total_weight > 0.0 { 1.0 / self.total_weight } else { 0.0 }
    }
}

impl Problem for FrameProblem<'_, '_> {
    fn evaluate(&mut self, step: &[f64], equalities: &mut [f64], inequalities: &mut [f64]) -> f64 {
        let tracker = self.tracker;
        for (unknown, &direction) in tracker.directions.iter().enumerate() {
            self.buffers.tangent[direction as usize] = step[unknown];
        }
        let Buffers { current, trial, tangent, .. } = &mut *self.buffers;
        tracker.model.retract(current, tangent, trial);
        // Rounding must not carry a coordinate over its bound.
        for &(place, lower, upper) in tracker.stored.iter().flatten() {
            trial[place] = trial[place].max(lower).min(upper);
        }
        let evaluated =
            tracker.program.evaluate_with_jacobian(&self.buffers.trial, self.pose, self.jacobian);
        debug_assert!(evaluated.is_ok(), "buffers are made for this program");
        let mut objective = self.measure() * self.marker_scale() + self.task_cost();
        let mut prior = 0.0;
        for &(place, ..) in tracker.stored.iter().flatten() {
            let off = self.buffers.trial[place] - tracker.defaults[place];
            prior += off * off;
        }
        objective += PRIOR * prior;
        if !self.closures.is_empty() {
            self.closures.update(tracker.model, &tracker.program, self.pose, Some(self.jacobian));
            if tracker.closures_exact {
                equalities.copy_from_slice(&self.closures.residuals);
            } else {
                let weight = tracker.tasks.closure_weight.unwrap_or(0.0);
                objective += weight * self.closures.residuals.iter().map(|c| c * c).sum::<f64>();
            }
        }
        for (row, value) in inequalities.iter_mut().enumerate() {
            *value = self.pose.limit_row(row);
        }
        objective
    }

    fn accept(&mut self) {
        std::mem::swap(&mut self.buffers.current, &mut self.buffers.trial);
    }

    fn linearise(&mut self, local: &mut LocalModel) {
        let tracker = self.tracker;
        let n = tracker.unknown_len();
        local.hessian.fill(0.0);
        local.gradient.fill(0.0);
        self.buffers.moments.fill(Moments::ZERO);
        for (i, marker) in tracker.markers.iter().enumerate() {
            let weight = self.buffers.weights[i];
            if let Some(group) = marker.group
                && weight > 0.0
            {
                let (p, e) = (self.buffers.points[i], self.buffers.errors[i]);
                self.buffers.moments[group].add(weight, p, e);
            }
        }
        let scale = 2.0 * self.marker_scale();
        for (group, moments) in tracker.groups.iter().zip(&self.buffers.moments) {
            if group.deforms {
                continue;
            }
            for (position, &(row, twist)) in group.entries.iter().enumerate() {
                let twist = self.jacobian.twist(twist);
                let (force, torque) = moments.momentum(twist);
                let momentum = (force * scale, torque * scale);
                local.gradient[row as usize] += scale * moments.power(twist);
                let line = &mut local.hessian[row as usize * n..(row as usize + 1) * n];
                for &(column, other) in &group.entries[..=position] {
                    line[column as usize] += pair(self.jacobian.twist(other), momentum);
                }
            }
        }
        self.add_deforming(local, scale);
        for task in &tracker.tasks.coordinates {
            let Some(target) = task.target.at(self.frame) else { continue };
            let off = self.pose.coordinate(tracker.model, task.coordinate)[0] - target;
            self.add_row(local, task.coordinate, off, 2.0 * task.weight);
        }
        for (unknown, stored) in tracker.stored.iter().enumerate() {
            local.hessian[unknown * n + unknown] += 2.0 * PRIOR;
            (local.lower[unknown], local.upper[unknown]) = match *stored {
                Some((place, lower, upper)) => {
                    let q = self.buffers.current[place];
                    local.gradient[unknown] += 2.0 * PRIOR * (q - tracker.defaults[place]);
                    (lower - q, upper - q)
                }
                None => (f64::NEG_INFINITY, f64::INFINITY),
            };
        }
        self.add_closures(local);
        for row in 0..tracker.limit_rows {
            let line = &mut local.inequality_rows[row * n..(row + 1) * n];
            line.fill(0.0);
            for &(direction, slot) in tracker.program.limit_row_directions(row) {
                if let Some(entry) = line.get_mut(tracker.unknowns[direction as usize] as usize) {
                    *entry += self.jacobian.derivative(slot);
                }
            }
        }
    }
}

impl FrameProblem<'_, '_> {
    /// Adds ½·weight·(off + ∂q)² of a coordinate to the model.
    fn add_row(
        &self,
        local: &mut LocalModel,
        coordinate: condyle_model::CoordinateId,
        off: f64,
        weight: f64,
    ) {
        let tracker = self.tracker;
        let n = tracker.unknown_len();
        let entries = tracker.program.coordinate_directions(tracker.model, coordinate);
        for &(direction, slot) in entries {
            let row = tracker.unknowns[direction as usize] as usize;
            if row >= n {
                continue;
            }
            let slope = self.jacobian.derivative(slot);
            local.gradient[row] += weight * off * slope;
            for &(other, other_slot) in entries {
                let column = tracker.unknowns[other as usize] as usize;
                if column <= row {
                    local.hessian[row * n + column] +=
                        weight * slope * self.jacobian.derivative(other_slot);
                }
            }
        }
    }

    /// Markers of segments below a scale or a shear, one by one.
    fn add_deforming(&self, local: &mut LocalModel, scale: f64) {
        let tracker = self.tracker;
        let n = tracker.unknown_len();
        for (i, marker) in tracker.markers.iter().enumerate() {
            let Some(group) = marker.group.map(|group| &tracker.groups[group]) else { continue };
            let weight = scale * self.buffers.weights[i];
            if !group.deforms || weight <= 0.0 {
                continue;
            }
            let (point, error) = (self.buffers.points[i], self.buffers.errors[i]);
            let velocity = |twist| self.jacobian.velocity_at(&tracker.program, twist, point);
            for (position, &(row, twist)) in group.entries.iter().enumerate() {
                let along = velocity(twist) * weight;
                local.gradient[row as usize] += along.dot(error);
                let line = &mut local.hessian[row as usize * n..(row as usize + 1) * n];
                for &(column, other) in &group.entries[..=position] {
                    line[column as usize] += along.dot(velocity(other));
                }
            }
        }
    }

    /// Loops: rows that must vanish, or a weighted residual.
    fn add_closures(&self, local: &mut LocalModel) {
        let tracker = self.tracker;
        let n = tracker.unknown_len();
        for row in 0..self.closures.len() {
            let derivatives = self.closures.row(row);
            if tracker.closures_exact {
                let line = &mut local.equality_rows[row * n..(row + 1) * n];
                for (entry, &direction) in line.iter_mut().zip(&tracker.directions) {
                    *entry = derivatives[direction as usize];
                }
                continue;
            }
            let weight = 2.0 * tracker.tasks.closure_weight.unwrap_or(0.0);
            let residual = self.closures.residuals[row];
            for (i, &direction) in tracker.directions.iter().enumerate() {
                let slope = derivatives[direction as usize];
                if slope == 0.0 {
                    continue;
                }
                local.gradient[i] += weight * residual * slope;
                for (j, &other) in tracker.directions[..=i].iter().enumerate() {
                    local.hessian[i * n + j] += weight * slope * derivatives[other as usize];
                }
            }
        }
    }
}
