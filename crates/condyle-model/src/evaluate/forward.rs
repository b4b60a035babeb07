//! Running a program: coordinates in, transforms out.

use super::chain::{Silent, run_chain};
use super::instruction::{Instruction, NO_BASE, NO_BOUND};
use super::pose::Pose;
use super::program::{Mode, Program, SizeMismatch};
use crate::component::MOST_COMBINED;
use condyle_math::{Affine, Quat, Scalar};

/// Runs balls one after another: first all their own transforms, then the products along the tree.
///
/// The first loop has no step that waits for the one before it, so the divisions overlap. In the
/// second the frame stays in registers for as long as each ball hangs on the one before: what is
/// read back at once, in other pieces than it was written, has to wait for memory.
#[inline]
fn run_balls<S: Scalar>(balls: &[Instruction], pose: &mut Pose<S>) {
    for ball in balls {
        let Instruction::BallAt { shift, orientation, output, .. } = *ball else { continue };
        let q = orientation as usize;
        let q: &[S; 4] = pose.scalars[q..].first_chunk().expect("four registers");
        pose.transforms[output as usize] = Affine::new(Quat::from(*q).to_mat3(), shift.cast());
    }
    let mut rest = balls.iter().peekable();
    while let Some(Instruction::BallAt { base, .. }) = rest.peek() {
        let mut frame = pose.transforms[*base as usize];
        let mut last = *base;
        while let Some(&&Instruction::BallAt { base, output, .. }) = rest.peek()
            && base == last
        {
            frame = frame * pose.transforms[output as usize];
            pose.transforms[output as usize] = frame;
            last = output;
            rest.next();
        }
    }
}

impl Program {
    /// Computes the transforms of all segments at the requested coordinates.
    ///
    /// `requested` holds the stored numbers of all coordinates in the model's order, in radians and
    /// metres, an orientation as x, y, z, w of any length but zero. Numbers for coordinates that
    /// follow others are ignored. Nothing is allocated.
    ///
    /// # Errors
    /// [`SizeMismatch`] if `requested`, or a pose made for another program, has the wrong length.
    pub fn evaluate<S: Scalar>(
        &self,
        requested: &[S],
        mode: Mode,
        pose: &mut Pose<S>,
    ) -> Result<(), SizeMismatch> {
        self.load(requested, mode, pose)?;
        let is_ball = |i: &Instruction| matches!(i, Instruction::BallAt { .. });
        // Balls in runs, everything else one by one.
        for run in self.code.instructions.chunk_by(|a, b| is_ball(a) && is_ball(b)) {
            match run[0] {
                Instruction::BallAt { .. } => run_balls(run, pose),
                Instruction::Chain { base, first, end, output } => {
                    let from = if base == NO_BASE {
                        Affine::identity()
                    } else {
                        pose.transforms[base as usize]
                    };
                    let steps = &self.code.steps[first as usize..end as usize];
                    pose.transforms[output as usize] = run_chain(
                        &self.code,
                        steps,
                        from,
                        &pose.scalars,
                        &pose.transforms,
                        &mut Silent,
                    );
                }
                _ => self.run_scalar(&run[0], mode, &mut pose.scalars),
            }
        }
        Ok(())
    }

    /// Checks sizes and fills the registers that do not depend on an instruction.
    pub(super) fn load<S: Scalar>(
        &self,
        requested: &[S],
        mode: Mode,
        pose: &mut Pose<S>,
    ) -> Result<(), SizeMismatch> {
        SizeMismatch::check("the list of coordinates", self.stored, requested.len())?;
        SizeMismatch::check("the pose's list of scalars", self.code.scalars, pose.scalars.len())?;
        SizeMismatch::check(
            "the pose's list of transforms",
            self.code.transforms,
            pose.transforms.len(),
        )?;
        pose.scalars[..self.stored].copy_from_slice(requested);
        if mode == Mode::Posed {
            for &(register, lower, upper) in &self.limits {
                let value = &mut pose.scalars[register as usize];
                let (lower, upper) = (S::from_f64(lower), S::from_f64(upper));
                *value = value.select_less(lower, lower, *value);
                *value = upper.select_less(*value, upper, *value);
            }
        }
        for &(register, value) in &self.constants {
            pose.scalars[register as usize] = S::from_f64(value);
        }
        Ok(())
    }

    /// Runs an instruction that makes a scalar.
    #[inline(always)]
    pub(super) fn run_scalar<S: Scalar>(
        &self,
        instruction: &Instruction,
        mode: Mode,
        scalars: &mut [S],
    ) {
        match *instruction {
            Instruction::Function { function, input, output } => {
                scalars[output as usize] =
                    self.code.functions[function as usize].apply(scalars[input as usize]);
            }
            Instruction::Combine { function, output } => {
                let call = &self.code.combines[function as usize];
                let mut values = [S::zero(); MOST_COMBINED];
                let n = call.inputs.len();
                for (value, &input) in values.iter_mut().zip(&call.inputs) {
                    *value = scalars[input as usize];
                }
                scalars[output as usize] = call.function.apply(&values[..n]);
            }
            Instruction::Hold { passive, lower, upper, output } => {
                let mut value = scalars[passive as usize];
                if mode == Mode::Posed {
                    if lower != NO_BOUND {
                        let bound = scalars[lower as usize];
                        value = value.select_less(bound, bound, value);
                    }
                    if upper != NO_BOUND {
                        let bound = scalars[upper as usize];
                        value = bound.select_less(value, bound, value);
                    }
                }
                scalars[output as usize] = value;
            }
            Instruction::Chain { .. } | Instruction::BallAt { .. } => {}
        }
    }
}
