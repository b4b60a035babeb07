//! What a program consists of: instructions, the steps of chains, and the tables they read.

use crate::component::{ConstantCurvature, Ellipsoid, Law, Pivot};
use condyle_math::function::{Function, FunctionOfSeveral};
use condyle_math::{Affine, Scalar, Vec3};

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

/// Instructions in the order in which they run, and everything they refer to by position.
#[derive(Clone, Debug)]
pub(super) struct Code {
    /// How many scalar registers there are; the first hold the coordinates.
    pub scalars: usize,
    /// How many transform registers there are; the first hold the segments.
    pub transforms: usize,
    pub instructions: Vec<Instruction>,
    pub steps: Vec<Step>,
    pub fixed: Vec<Affine>,
    pub functions: Vec<Function>,
    pub combines: Vec<CombineCall>,
    pub laws: Vec<LawCall>,
    /// Registers that must not be negative in a legal posture, beside the bounds of coordinates.
    pub rows: Vec<u32>,
}
