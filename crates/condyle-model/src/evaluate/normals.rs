//! Inverse transposes, by which normals are carried where segments stretch or shear (Rotenberg,
//! *Skeletons*, section 2.2.5).
//!
//! ```text
//! W⁻ᵀ = W_parent⁻ᵀ · L⁻ᵀ
//! ```
//!
//! is built along the chains as the transforms are, each step by its own inverse: a rotation is its own
//! inverse transpose, a scale by s is one by 1/s, a shear by s along a is one by -s along n. No matrix
//! is inverted but those of users' laws.

use super::chain::power;
use super::instruction::{AnyLaw, Instruction, NO_BASE, Step};
use super::pose::Pose;
use super::program::{Program, SizeMismatch};
use crate::component::{Law, MOST_LAW_INPUTS, shear};
use condyle_math::{Mat3, Quat};

impl Program {
    /// Fills `normals` with the inverse transpose of the linear part of every transform of a pose, of
    /// which the first are those of the segments, in the model's order.
    ///
    /// A normal n of a segment's surface is n′ = `normals[segment.index()]`·n in the world, of another
    /// length where the segment is stretched. For rigid segments it is the rotation itself.
    ///
    /// # Errors
    /// [`SizeMismatch`] if `normals` does not have [`Program::normal_len`] places.
    pub fn normals(&self, pose: &Pose, normals: &mut [Mat3]) -> Result<(), SizeMismatch> {
        SizeMismatch::check("the list of normals", self.normal_len(), normals.len())?;
        for (normal, transform) in normals.iter_mut().zip(&pose.transforms) {
            *normal = transform.linear;
        }
        for instruction in &self.code.instructions {
            match *instruction {
                Instruction::BallAt { base, orientation, output, .. }
                    if self.plan.deforming[output as usize] =>
                {
                    let q: [f64; 4] =
                        std::array::from_fn(|i| pose.scalars[orientation as usize + i]);
                    normals[output as usize] = normals[base as usize] * Quat::from(q).to_mat3();
                }
                Instruction::Chain { base, first, end, output, .. }
                    if self.plan.deforming[output as usize] =>
                {
                    let from =
                        if base == NO_BASE { Mat3::IDENTITY } else { normals[base as usize] };
                    let steps = &self.code.steps[first as usize..end as usize];
                    normals[output as usize] = steps
                        .iter()
                        .fold(from, |normal, &step| normal * self.carrier(step, pose, normals));
                }
                _ => {}
            }
        }
        Ok(())
    }

    /// How many places [`Program::normals`] fills: at least one for each segment.
    pub fn normal_len(&self) -> usize {
        self.code.transforms
    }

    /// The inverse transpose of one step.
    fn carrier(&self, step: Step, pose: &Pose, normals: &[Mat3]) -> Mat3 {
        let scalar = |register: u32| pose.scalars[register as usize];
        match step {
            Step::Shift(_) | Step::Slide { .. } | Step::Move(_) => Mat3::IDENTITY,
            Step::Fixed(index) => self.code.fixed[index as usize].linear.inverse().transpose(),
            Step::TurnX(turn) => Mat3::identity().rotated_x(pose.turn(turn)),
            Step::TurnY(turn) => Mat3::identity().rotated_y(pose.turn(turn)),
            Step::TurnZ(turn) => Mat3::identity().rotated_z(pose.turn(turn)),
            Step::Turn { axis, turn } => Mat3::rotation_about(axis, pose.turn(turn)),
            Step::Ball(q) => Quat::from(std::array::from_fn(|i| scalar(q + i as u32))).to_mat3(),
            Step::Stretch { along, factor } => {
                self.code.scales[along as usize].inverse(scalar(factor))
            }
            Step::Shear { directions, amount } => {
                let [along, across] = self.code.shears[directions as usize];
                shear::matrix(across, along, -scalar(amount))
            }
            Step::Law(index) => {
                let call = &self.code.laws[index as usize];
                let mut inputs = [0.0; MOST_LAW_INPUTS];
                for (value, &register) in inputs.iter_mut().zip(&call.inputs) {
                    *value = scalar(register);
                }
                let linear = call.law.transform(&inputs[..call.inputs.len()]).linear;
                match call.law {
                    AnyLaw::Custom(_) => linear.inverse().transpose(),
                    _ => linear,
                }
            }
            Step::Transform(register) => normals[register as usize],
            Step::Power { of, exponent } => power(pose.transforms[of as usize].linear, exponent),
        }
    }
}
