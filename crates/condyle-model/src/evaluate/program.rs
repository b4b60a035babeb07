//! A model flattened for evaluation.

use super::chain::{Silent, run_chain};
use super::derivative_plan::DerivativePlan;
use super::pose::Pose;
use crate::component::{ConstantCurvature, Ellipsoid, Law, MOST_COMBINED, Pivot};
use crate::model::{CoordinateId, Model, SegmentId};
use condyle_math::function::{Function, FunctionOfSeveral};
use condyle_math::{Affine, Quat, Scalar, Vec3};
use std::fmt;

/// Whether limits move the coordinates.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mode {
    /// Every coordinate is first moved into its range: the pose is always legal.
    Posed,
    /// Coordinates are taken as given.
    Open,
}

/// Marks a bound that is not there.
pub(super) const NO_BOUND: u32 = u32::MAX;

/// Marks a chain that starts from nothing instead of from a transform.
pub(super) const NO_BASE: u32 = u32::MAX;

/// One elementary motion of a chain, multiplied from the right.
#[derive(Clone, Copy, Debug)]
pub(super) enum Step {
    /// A fixed transform.
    Fixed(u32),
    /// A fixed translation.
    Shift(Vec3),
    /// A turn about the frame's own first axis.
    TurnX(u32),
    /// A turn about the frame's own second axis.
    TurnY(u32),
    /// A turn about the frame's own third axis.
    TurnZ(u32),
    /// A turn about any axis.
    Turn { axis: Vec3, angle: u32 },
    /// A slide along any axis.
    Slide { axis: Vec3, distance: u32 },
    /// A rotation by four consecutive scalars x, y, z, w.
    Ball(u32),
    /// A smooth law of a few scalars.
    Law(u32),
    /// A transform computed before.
    Transform(u32),
    /// A power of the rotation of a transform computed before; -1 is its inverse.
    Power { of: u32, exponent: f64 },
}

/// A smooth law with the registers it reads.
#[derive(Clone, Debug)]
pub(super) struct LawCall {
    pub law: AnyLaw,
    pub inputs: Vec<u32>,
}

/// The laws that components bring.
#[derive(Clone, Debug)]
pub(super) enum AnyLaw {
    Pivot(Pivot),
    Ellipsoid(Ellipsoid),
    ConstantCurvature(ConstantCurvature),
}

impl Law for AnyLaw {
    #[inline]
    fn transform<S: Scalar>(&self, inputs: &[S]) -> Affine<S> {
        match self {
            Self::Pivot(law) => law.transform(inputs),
            Self::Ellipsoid(law) => law.transform(inputs),
            Self::ConstantCurvature(law) => law.transform(inputs),
        }
    }
}

/// One line of a program.
#[derive(Clone, Debug)]
pub(super) enum Instruction {
    /// `scalars[output] = functions[function](scalars[input])`.
    Function { function: u32, input: u32, output: u32 },
    /// `scalars[output] = several[function](scalars[inputs])`.
    Combine { function: u32, output: u32 },
    /// `scalars[output] = scalars[passive]`, held between other scalars in posed mode.
    Hold { passive: u32, lower: u32, upper: u32, output: u32 },
    /// `transforms[output] = transforms[base] · steps`.
    Chain { base: u32, first: u32, end: u32, output: u32 },
    /// The commonest chain of character skeletons: a shift and a ball.
    BallAt { base: u32, shift: Vec3, orientation: u32, output: u32 },
}

/// A function of several scalars with the registers it reads.
#[derive(Clone, Debug)]
pub(super) struct CombineCall {
    pub function: FunctionOfSeveral,
    pub inputs: Vec<u32>,
}

/// A model compiled for evaluation: flat, sorted, and shared by all poses.
#[derive(Clone, Debug)]
pub struct Program {
    pub(super) stored: usize,
    pub(super) scalars: usize,
    pub(super) segments: usize,
    pub(super) transforms: usize,
    /// Registers that hold the same number at every evaluation.
    pub(super) constants: Vec<(u32, f64)>,
    pub(super) instructions: Vec<Instruction>,
    pub(super) steps: Vec<Step>,
    pub(super) fixed: Vec<Affine>,
    pub(super) functions: Vec<Function>,
    pub(super) combines: Vec<CombineCall>,
    pub(super) laws: Vec<LawCall>,
    /// Register, lower and upper bound of every coordinate that posed mode holds.
    pub(super) limits: Vec<(u32, f64, f64)>,
    /// Registers that must not be negative in a legal posture, beside those bounds.
    pub(super) rows: Vec<u32>,
    pub(super) plan: DerivativePlan,
}

/// A buffer of the wrong length.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SizeMismatch {
    /// Which buffer.
    pub buffer: &'static str,
    /// The length it must have.
    pub expected: usize,
    /// The length it has.
    pub found: usize,
}

impl fmt::Display for SizeMismatch {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} has {} numbers but must have {}", self.buffer, self.found, self.expected)
    }
}

impl std::error::Error for SizeMismatch {}

impl SizeMismatch {
    /// Checks one buffer.
    pub(super) fn check(
        buffer: &'static str,
        expected: usize,
        found: usize,
    ) -> Result<(), SizeMismatch> {
        if expected == found { Ok(()) } else { Err(Self { buffer, expected, found }) }
    }
}

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
    /// Flattens a model. Models are checked when they are built, so this cannot fail.
    pub fn compile(model: &Model) -> Self {
        super::compile::compile(model)
    }

    /// How many numbers [`Program::evaluate`] takes: one for each coordinate, four for an
    /// orientation.
    pub fn stored_len(&self) -> usize {
        self.stored
    }

    /// How many directions the coordinates move in.
    pub fn tangent_len(&self) -> usize {
        self.plan.tangents
    }

    /// How many segments there are.
    pub fn segment_len(&self) -> usize {
        self.segments
    }

    /// Directions that move a segment, each with the number of its twist in a [`Jacobian`].
    ///
    /// [`Jacobian`]: super::Jacobian
    pub fn segment_directions(&self, segment: SegmentId) -> &[(u32, u32)] {
        self.plan.segment_entries(segment.index())
    }

    /// Directions that move the effective value of a coordinate of one number, each with the slot
    /// of its derivative in a [`Jacobian`]: itself, or the leaders of one that follows.
    ///
    /// [`Jacobian`]: super::Jacobian
    pub fn coordinate_directions(&self, model: &Model, coordinate: CoordinateId) -> &[(u32, u32)] {
        self.plan.coordinate_entries(model.stored_range(coordinate).start)
    }

    /// How many limits there are that bounds of single coordinates do not express.
    ///
    /// Each is a number that a legal posture does not make negative, in radians or metres: the
    /// distance of a passive angle from the bound that its driver sets, or of a coordinate that
    /// follows others from its range. [`Pose::limit_row`] has the number of the last evaluation.
    pub fn limit_row_len(&self) -> usize {
        self.rows.len()
    }

    /// Directions that move a limit row, each with the slot of its derivative in a [`Jacobian`].
    ///
    /// [`Jacobian`]: super::Jacobian
    pub fn limit_row_directions(&self, row: usize) -> &[(u32, u32)] {
        self.plan.row_entries(row)
    }

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
        for run in self.instructions.chunk_by(|a, b| is_ball(a) && is_ball(b)) {
            match run[0] {
                Instruction::BallAt { .. } => run_balls(run, pose),
                Instruction::Chain { base, first, end, output } => {
                    let from = if base == NO_BASE {
                        Affine::identity()
                    } else {
                        pose.transforms[base as usize]
                    };
                    let steps = &self.steps[first as usize..end as usize];
                    pose.transforms[output as usize] =
                        run_chain(self, steps, from, &pose.scalars, &pose.transforms, &mut Silent);
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
        SizeMismatch::check("the pose's list of scalars", self.scalars, pose.scalars.len())?;
        SizeMismatch::check(
            "the pose's list of transforms",
            self.transforms,
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
                    self.functions[function as usize].apply(scalars[input as usize]);
            }
            Instruction::Combine { function, output } => {
                let call = &self.combines[function as usize];
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
