//! Inverse transposes, which transform surface normals where segments are scaled or sheared
//! (Rotenberg, *Skeletons*, section 2.2.5).
//!
//! ```text
//! W⁻ᵀ = W_parent⁻ᵀ · L⁻ᵀ
//! ```
//!
//! is computed along the chains, like the transforms, from the inverse transpose of each step: that
//! of a rotation is itself, that of a scale by s a scale by 1/s, that of a shear by s along a a
//! shear by
//! -s along n. Only fixed transforms and the laws of users need a matrix inversion.

use super::chain::power;
use super::instruction::{AnyLaw, Instruction, NO_BASE, Step};
use super::pose::Pose;
use super::program::{Program, SizeMismatch};
use crate::component::{Law, MOST_LAW_INPUTS, shear};
use condyle_math::{Mat3, Quat};

impl Program {
    /// Computes the inverse transpose of the linear part of every transform of a pose.
    ///
    /// The first ones are those of the segments, in the model's order. A surface normal n of a
    /// segment is n′ = `normals[segment.index()]`·n in the world; where the segment is not rigid,
    /// n′ has to be normalised. For rigid segments the matrix is the rotation itself.
    ///
    /// # Errors
    /// [`SizeMismatch`] if the length of `normals` is not [`Program::normal_len`].
    pub fn normals(&self, pose: &Pose, normals: &mut [Mat3]) -> Result<(), SizeMismatch> {
        SizeMismatch::check("the list of normals", self.normal_len(), normals.len())?;
        // Right for every rigid transform; the others are replaced below, in the order of the
        // program, so that the bases are complete before they are read.
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

    /// The number of matrices that [`Program::normals`] computes: at least one for each segment.
    pub fn normal_len(&self) -> usize {
        self.code.transforms
    }

    /// The inverse transpose of the linear part of one step.
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
            // Symmetric, so the inverse is the inverse transpose.
            Step::Stretch { along, factor } => {
                self.code.scales[along as usize].inverse(scalar(factor))
            }
            Step::Shear { directions, amount } => {
                // (I + s·a·nᵀ)⁻ᵀ = I - s·n·aᵀ, since a·n = 0.
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
                // The other laws are rotations.
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
