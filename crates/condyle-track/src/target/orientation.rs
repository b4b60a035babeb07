//! Segments that should have an orientation, as inertial sensors measure it: `w |ρ|²`, part of F.
//!
//! ρ = log(R Rₜᵀ) is the rotation vector from the wanted orientation Rₜ to the segment's R, both in the
//! world, so |ρ| is the geodesic angle between them. For the angular velocity ω of a direction,
//! ∂|ρ|² = 2 ρ·ω holds exactly, since what the logarithm's derivative does beside ω is perpendicular
//! to ρ. The Hessian 2 ω·ω leaves that out as well: it is too large by θ²/6 across ρ.

use super::Target;
use crate::problem::Frame;
use condyle_diagnostics::Diagnostic;
use condyle_math::{Mat3, Quat, Vec3};
use condyle_model::{Mode, Model, Pose, Program, SegmentId};
use condyle_motion::Orientations;
use condyle_solve::least_squares::LocalModel;

/// One segment that should have an orientation.
#[derive(Clone, Debug, PartialEq)]
pub struct OrientationTarget {
    /// The segment. Of one that is scaled the axes are brought to length 1; a shear is not taken account of.
    pub segment: SegmentId,
    /// Its weight, m² per rad²; positive and finite. 1e-4 makes 5.7° weigh as much as 1 mm RMS.
    pub weight: f64,
    /// For each frame the rotation that takes the segment's axes to the world's, if there is one.
    pub wanted: Vec<Option<Quat>>,
}

impl OrientationTarget {
    /// Targets from a recording of inertial sensors on a person who stands in the model's default
    /// posture in the first frame in which a sensor has a value.
    ///
    /// A sensor belongs to the segment of its name, or of its name without `_imu`; how it sits on the
    /// segment follows from that first frame. `world_of_sensors` takes the axes of the sensors' world
    /// to those of the model's. Sensors without a segment are reported.
    pub fn of_recording(
        model: &Model,
        recording: &Orientations,
        world_of_sensors: Quat,
        weight: f64,
    ) -> (Vec<Self>, Vec<Diagnostic>) {
        let program = Program::compile(model);
        let mut rest = Pose::new(&program);
        let evaluated = program.evaluate(&model.defaults(), Mode::Open, &mut rest);
        debug_assert!(evaluated.is_ok(), "buffers are made for this program");
        let (mut targets, mut warnings) = (vec![], vec![]);
        for (sensor, label) in recording.labels.iter().enumerate() {
            let name = label.strip_suffix("_imu").unwrap_or(label);
            let segment = match model.find_segment(label).or_else(|_| model.find_segment(name)) {
                Ok(segment) => segment,
                Err(error) => {
                    let message = format!("sensor `{label}` is not used: {}", error[0].sentence());
                    warnings.push(Diagnostic::warning("track/unused-sensor", message));
                    continue;
                }
            };
            let measured = |frame| Some(world_of_sensors * recording.rotation(frame, sensor)?);
            let Some(first) = (0..recording.frames()).find_map(measured) else { continue };
            let segment_in_sensor =
                first.conjugate() * Quat::from_mat3(rest.segment(segment).linear);
            let wanted = (0..recording.frames())
                .map(|frame| Some((measured(frame)? * segment_in_sensor).normalized()));
            targets.push(Self { segment, weight, wanted: wanted.collect() });
        }
        (targets, warnings)
    }

    /// The rotation vector from the wanted orientation to the segment's, in the world.
    fn off(&self, frame: &Frame<'_>) -> Option<Vec3> {
        let wanted = (*self.wanted.get(frame.index)?)?;
        let mut axes = frame.buffers.pose.segment(self.segment).linear;
        if frame.tracker.part.deforms(self.segment) {
            axes = rotation_of(axes);
        }
        let segment = Quat::from_mat3(axes);
        Some((segment * wanted.conjugate()).log())
    }
}

/// The axes of a scaled segment with length 1: the first as it points, the second perpendicular to it.
pub(crate) fn rotation_of(linear: Mat3) -> Mat3 {
    let unit = |v: Vec3| v * (1.0 / v.norm().max(1e-300));
    let x = unit(linear.x);
    let y = unit(linear.y - x * x.dot(linear.y));
    Mat3::from_columns(x, y, x.cross(y))
}

impl Target for Vec<OrientationTarget> {
    fn value(&self, frame: &mut Frame<'_>) -> f64 {
        let offs = self.iter().filter_map(|t| Some((t.weight, t.off(frame)?)));
        offs.map(|(weight, off)| weight * off.norm_squared()).sum()
    }

    fn linearise(&self, frame: &mut Frame<'_>, local: &mut LocalModel) {
        let tracker = frame.tracker;
        let n = tracker.unknown_len();
        for target in self {
            let Some(off) = target.off(frame) else { continue };
            let entries = tracker.part.segment_directions(target.segment).iter();
            let spins = || {
                entries.clone().filter_map(|&(direction, twist)| {
                    let unknown = tracker.unknowns[direction as usize] as usize;
                    (unknown < n).then(|| (unknown, frame.buffers.jacobian.twist(twist).angular))
                })
            };
            let weight = 2.0 * target.weight;
            for (row, spin) in spins() {
                local.gradient[row] += weight * off.dot(spin);
                for (column, other) in spins().filter(|(column, _)| *column <= row) {
                    local.hessian[row * n + column] += weight * spin.dot(other);
                }
            }
        }
    }
}
