//! Residuals of loop closures and their derivatives.

use super::jacobian::Jacobian;
use super::pose::Pose;
use super::program::Program;
use super::rotation_rate::log_rate;
use crate::model::{Condition, CoordinateId, Model};
use condyle_math::{Affine, Vec3};

/// Residual rows of all closures of a model, and their dense derivative.
///
/// In metres and radians; a closed loop has residual 0. The rows of a point closure are p₁ - p₂ in
/// the world; those of a frame closure the difference of the origins and the rotation vector
/// between the frames; the row of a distance is |p₁ - p₂| - d, and that of a coupling follower -
/// f(driver).
#[derive(Clone, Debug)]
pub struct ClosureRows {
    /// One number for each row.
    pub residuals: Vec<f64>,
    /// The derivatives, row-major: one number for each direction in each row.
    pub derivatives: Vec<f64>,
    tangents: usize,
}

impl ClosureRows {
    /// Buffers for a model.
    pub fn new(model: &Model) -> Self {
        let rows = model.closures().iter().map(|c| c.condition.rows()).sum();
        let tangents = model.tangent_len();
        Self { residuals: vec![0.0; rows], derivatives: vec![0.0; rows * tangents], tangents }
    }

    /// The number of rows.
    pub fn len(&self) -> usize {
        self.residuals.len()
    }

    /// Whether the model has no closures.
    pub fn is_empty(&self) -> bool {
        self.residuals.is_empty()
    }

    /// The derivative of one row with respect to every direction.
    pub fn row(&self, row: usize) -> &[f64] {
        &self.derivatives[row * self.tangents..(row + 1) * self.tangents]
    }

    /// Recomputes the residuals, and the derivatives if a Jacobian of the same evaluation is given.
    pub fn update(
        &mut self,
        model: &Model,
        program: &Program,
        pose: &Pose,
        jacobian: Option<&Jacobian>,
    ) {
        if jacobian.is_some() {
            self.derivatives.fill(0.0);
        }
        let tangents = self.tangents;
        let mut row = 0;
        for closure in model.closures() {
            let rows = closure.condition.rows();
            let residuals = &mut self.residuals[row..row + rows];
            let derivatives = &mut self.derivatives[row * tangents..(row + rows) * tangents];
            row += rows;
            match &closure.condition {
                Condition::Points { at } => {
                    let [p, q] = at.map(|(s, point)| pose.frame(s) * point);
                    residuals.copy_from_slice(&(p - q).to_array());
                    let Some(jacobian) = jacobian else { continue };
                    // A direction may move both points, hence the sum.
                    for ((segment, _), point, sign) in [(at[0], p, 1.0), (at[1], q, -1.0)] {
                        jacobian.visit_point(program, segment, point, |direction, velocity| {
                            for (i, v) in velocity.to_array().into_iter().enumerate() {
                                derivatives[i * tangents + direction] += sign * v;
                            }
                        });
                    }
                }
                Condition::Distance { at, distance } => {
                    let [p, q] = at.map(|(s, point)| pose.frame(s) * point);
                    let gap = p - q;
                    let length = gap.norm();
                    residuals[0] = length - distance;
                    let Some(jacobian) = jacobian else { continue };
                    // d|p - q| = (p - q)/|p - q|·(dp - dq). For coinciding points the gradient is
                    // not defined, and x is used.
                    let along = if length > 1e-12 { gap * (1.0 / length) } else { Vec3::X };
                    for ((segment, _), point, sign) in [(at[0], p, 1.0), (at[1], q, -1.0)] {
                        jacobian.visit_point(program, segment, point, |direction, velocity| {
                            derivatives[direction] += sign * along.dot(velocity);
                        });
                    }
                }
                Condition::Frames { at } => {
                    let [a, b]: [Affine; 2] = at.map(|(s, frame)| pose.frame(s) * frame);
                    // ρ = log(R_a·R_bᵀ), in the world. R_a·R_bᵀ has the angular velocity
                    // ω_a - R_a·R_bᵀ·ω_b, which log_rate maps to ρ̇. Both frames are rigid.
                    let between = a.linear * b.linear.transpose();
                    let turn = between.log();
                    let gap = a.translation - b.translation;
                    residuals[..3].copy_from_slice(&gap.to_array());
                    residuals[3..].copy_from_slice(&turn.to_array());
                    let Some(jacobian) = jacobian else { continue };
                    for ((segment, _), frame, sign) in [(at[0], a, 1.0), (at[1], b, -1.0)] {
                        let Some(segment) = segment else { continue };
                        for &(direction, twist) in program.segment_directions(segment) {
                            let twist = jacobian.twist(twist);
                            let linear = twist.velocity_at(frame.translation).to_array();
                            // ω_a as it is, ω_b rotated by R_a·R_bᵀ.
                            let spin =
                                if sign > 0.0 { twist.angular } else { between * twist.angular };
                            let angular = log_rate(turn, spin).to_array();
                            for i in 0..3 {
                                derivatives[i * tangents + direction as usize] += sign * linear[i];
                                derivatives[(i + 3) * tangents + direction as usize] +=
                                    sign * angular[i];
                            }
                        }
                    }
                }
                Condition::Coupling { follower, driver, function } => {
                    let value = |id: CoordinateId| pose.coordinate(model, id)[0];
                    // Scalar coordinates, with one stored number and one direction each.
                    let (wanted, slope) = function.value_and_slope(value(*driver));
                    residuals[0] = value(*follower) - wanted;
                    let Some(jacobian) = jacobian else { continue };
                    // Either may itself follow others: then those move it, and not its own direction.
                    for (id, factor) in [(*follower, 1.0), (*driver, -slope)] {
                        for &(direction, slot) in program.coordinate_directions(model, id) {
                            derivatives[direction as usize] += factor * jacobian.derivative(slot);
                        }
                    }
                }
            }
        }
    }
}
