//! The instructions of a program, the steps of chains, and the tables that they refer to.

use crate::component::{
    Along, ConstantCurvature, Curve, Custom, Ellipsoid, Gliding, JointCone, Law, Pivot,
};
use crate::position::ComponentId;
use condyle_math::function::{Function, FunctionOfSeveral};
use condyle_math::{Affine, Scalar, Vec3};

/// Marks an absent bound.
pub(super) const NO_BOUND: u32 = u32::MAX;

/// Marks a chain that starts from the identity instead of a transform register.
pub(super) const NO_BASE: u32 = u32::MAX;

impl Instruction {
    /// Whether it computes scalars from scalars only.
    pub(super) fn makes_scalars(&self) -> bool {
        use Instruction::{Combine, Cone, Function, Hold};
        matches!(self, Function { .. } | Combine { .. } | Hold { .. } | Cone { .. })
    }
}

impl Step {
    /// Whether it preserves lengths and angles; `transform` tells it for earlier transforms.
    pub(super) fn is_rigid(self, code: &Code, transform: impl Fn(u32) -> bool) -> bool {
        match self {
            Self::Fixed(index) => {
                // MᵀM = 1, within the precision of numbers in files.
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
    /// A rotation about the x axis of the frame; the number is the position in [`Code::turns`].
    TurnX(u32),
    /// A rotation about the y axis of the frame.
    TurnY(u32),
    /// A rotation about the z axis of the frame.
    TurnZ(u32),
    /// A rotation about any axis of length 1.
    Turn { axis: Vec3, turn: u32 },
    /// A translation along any axis; `distance` is a scalar register.
    Slide { axis: Vec3, distance: u32 },
    /// Translations along the three axes of the frame, by three scalar registers.
    Move([u32; 3]),
    /// A rotation by a quaternion in four consecutive scalar registers x, y, z, w.
    Ball(u32),
    /// A scale; `along` is a position in [`Code::scales`], `factor` a scalar register.
    Stretch { along: u32, factor: u32 },
    /// A shear; `directions` is a position in [`Code::shears`], `amount` a scalar register.
    Shear { directions: u32, amount: u32 },
    /// A smooth law of a few scalars, by its position in [`Code::laws`].
    Law(u32),
    /// An earlier transform, by its register.
    Transform(u32),
    /// A power of the rotation of an earlier transform; -1 is its inverse.
    Power { of: u32, exponent: f64 },
}

/// A smooth law with the registers it reads.
#[derive(Clone, Debug)]
pub(super) struct LawCall {
    pub law: AnyLaw,
    pub inputs: Vec<u32>,
}

/// The smooth laws of components.
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
    /// `scalars[output] = combines[function](scalars[inputs])`.
    Combine { function: u32, output: u32 },
    /// `scalars[output] = scalars[passive]`, clamped between two other scalars in posed mode.
    Hold { passive: u32, lower: u32, upper: u32, output: u32 },
    /// The numbers of a ball joint, moved into a cone in posed mode.
    Cone { cone: u32 },
    /// The two rotations that bring a segment into contact with an ellipsoid.
    Contact { contact: u32 },
    /// `transforms[output] = transforms[base] · shift · steps`.
    Chain { base: u32, shift: Vec3, first: u32, end: u32, output: u32 },
    /// The most common chain of character skeletons: a shift and a ball.
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
    /// The transform register of the segment in the ellipsoid's frame, before the contact.
    pub frame: u32,
    pub drivers: Vec<u32>,
    /// The transform register of the two rotations.
    pub output: u32,
    /// The first of four scalars: two angles, two gaps.
    pub report: u32,
}

/// The instructions in the order in which they run, and the tables that they refer to by position.
#[derive(Clone, Debug)]
pub(super) struct Code {
    /// The number of scalar registers; the first are the stored numbers of the coordinates.
    pub scalars: usize,
    /// The number of transform registers; the first are those of the segments.
    pub transforms: usize,
    /// Scalar instructions, then those that compute transforms.
    pub instructions: Vec<Instruction>,
    /// The number of scalar instructions.
    pub scalar_instructions: usize,
    /// The scalar registers of the angles whose sines and cosines are needed.
    pub turns: Vec<u32>,
    pub steps: Vec<Step>,
    pub fixed: Vec<Affine>,
    pub functions: Vec<Function>,
    pub combines: Vec<CombineCall>,
    pub laws: Vec<LawCall>,
    pub scales: Vec<Along>,
    /// The directions `along` and `across` of each shear.
    pub shears: Vec<[Vec3; 2]>,
    /// The scalar registers of the limit rows: not negative in a legal posture.
    pub rows: Vec<u32>,
    pub cones: Vec<ConeCall>,
    pub contacts: Vec<ContactCall>,
    /// The transform register of the model's root frame, the parent of the root segments.
    pub base: u32,
}
