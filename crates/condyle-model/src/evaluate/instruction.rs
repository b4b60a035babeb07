//! What a program consists of: instructions, the steps of chains, and the tables they read.

use crate::component::{
    Along, ConstantCurvature, Curve, Custom, Ellipsoid, Gliding, JointCone, Law, Pivot,
};
use crate::position::ComponentId;
use condyle_math::function::{Function, FunctionOfSeveral};
use condyle_math::{Affine, Scalar, Vec3};

/// Marks a bound that is not there.
pub(super) const NO_BOUND: u32 = u32::MAX;

/// Marks a chain that starts from nothing instead of from a transform.
pub(super) const NO_BASE: u32 = u32::MAX;

impl Instruction {
    /// Whether it makes scalars, of nothing but scalars.
    pub(super) fn makes_scalars(&self) -> bool {
        use Instruction::{Combine, Cone, Function, Hold};
        matches!(self, Function { .. } | Combine { .. } | Hold { .. } | Cone { .. })
    }
}

impl Step {
    /// Whether it keeps lengths and angles, given which transforms computed before do.
    pub(super) fn is_rigid(self, code: &Code, transform: impl Fn(u32) -> bool) -> bool {
        match self {
            Self::Fixed(index) => {
                let m = code.fixed[index as usize].linear;
                let product = m.transpose() * m;
                [product.x - Vec3::X, product.y - Vec3::Y, product.z - Vec3::Z]
                    .iter()
                    .all(|column| column.norm() < 1e-6)
            }
            Self::Stretch { .. } | Self::Shear { .. } => false,
            Self::Law(index) => code.laws[index as usize].law.is_rigid(),
            Self::Transform(register) => transform(register),
            _ => true,
        }
    }
}

/// One elementary motion of a chain, multiplied from the right.
#[derive(Clone, Copy, Debug)]
pub(super) enum Step {
    /// A fixed transform.
    Fixed(u32),
    /// A fixed translation.
    Shift(Vec3),
    /// A turn about the frame's own first axis; the number is that of the turn in [`Code::turns`].
    TurnX(u32),
    /// A turn about the frame's own second axis.
    TurnY(u32),
    /// A turn about the frame's own third axis.
    TurnZ(u32),
    /// A turn about any axis.
    Turn { axis: Vec3, turn: u32 },
    /// A slide along any axis.
    Slide { axis: Vec3, distance: u32 },
    /// Slides along the frame's own three axes.
    Move([u32; 3]),
    /// A rotation by four consecutive scalars x, y, z, w.
    Ball(u32),
    /// A scale by a factor.
    Stretch { along: u32, factor: u32 },
    /// A slide of layers over each other.
    Shear { directions: u32, amount: u32 },
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
    Curve(Curve),
    Custom(Custom),
}

impl Law for AnyLaw {
    #[inline]
    fn transform<S: Scalar>(&self, inputs: &[S]) -> Affine<S> {
        match self {
            Self::Pivot(law) => law.transform(inputs),
            Self::Ellipsoid(law) => law.transform(inputs),
            Self::ConstantCurvature(law) => law.transform(inputs),
            Self::Curve(law) => law.transform(inputs),
            Self::Custom(law) => law.transform(inputs),
        }
    }

    fn is_rigid(&self) -> bool {
        match self {
            Self::Custom(law) => law.is_rigid(),
            _ => true,
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
    /// The numbers of a ball joint, held inside a cone in posed mode.
    Cone { cone: u32 },
    /// A bone put on an ellipsoid.
    Contact { contact: u32 },
    /// `transforms[output] = transforms[base] · shift · steps`.
    Chain { base: u32, shift: Vec3, first: u32, end: u32, output: u32 },
    /// The commonest chain of character skeletons: a shift and a ball.
    BallAt { base: u32, shift: Vec3, orientation: u32, output: u32 },
}

/// A function of several scalars with the registers it reads.
#[derive(Clone, Debug)]
pub(super) struct CombineCall {
    pub function: FunctionOfSeveral,
    pub inputs: Vec<u32>,
}

/// A cone with its registers.
#[derive(Clone, Debug)]
pub(super) struct ConeCall {
    pub component: JointCone,
    pub inputs: Vec<u32>,
    pub outputs: Vec<u32>,
    pub rows: Vec<u32>,
}

/// A contact with its registers.
#[derive(Clone, Debug)]
pub(super) struct ContactCall {
    pub component: ComponentId,
    pub law: Gliding,
    /// The transform of the bone in the ellipsoid, before the contact turns it.
    pub frame: u32,
    pub drivers: Vec<u32>,
    /// The transform of the two turns.
    pub output: u32,
    /// The first of four scalars: two angles, two gaps.
    pub report: u32,
}

/// Instructions in the order in which they run, and everything they refer to by position.
#[derive(Clone, Debug)]
pub(super) struct Code {
    /// How many scalar registers there are; the first hold the coordinates.
    pub scalars: usize,
    /// How many transform registers there are; the first hold the segments.
    pub transforms: usize,
    /// Those that make scalars, then those that make transforms.
    pub instructions: Vec<Instruction>,
    /// How many make scalars.
    pub scalar_instructions: usize,
    /// The register of each angle whose sine and cosine are wanted.
    pub turns: Vec<u32>,
    pub steps: Vec<Step>,
    pub fixed: Vec<Affine>,
    pub functions: Vec<Function>,
    pub combines: Vec<CombineCall>,
    pub laws: Vec<LawCall>,
    pub scales: Vec<Along>,
    /// Along and across.
    pub shears: Vec<[Vec3; 2]>,
    /// Registers that must not be negative in a legal posture, beside the bounds of coordinates.
    pub rows: Vec<u32>,
    pub cones: Vec<ConeCall>,
    pub contacts: Vec<ContactCall>,
    /// The transform register of the world, on which the roots hang.
    pub base: u32,
}
