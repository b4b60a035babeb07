//! The instructions of a program, the steps of chains, and the tables that they refer to.

use crate::component::{
    Along, ConstantCurvature, Curve, Custom, Ellipsoid, Gliding, Law, MotionLaw, Pivot,
};
use crate::position::ComponentId;
use condyle_math::function::{Function, FunctionOfSeveral};
use condyle_math::{Affine, Scalar, Vec3};
use std::ops::Range;

/// A register of one scalar.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Number(pub u32);

/// A register of a transform.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Frame(pub u32);

/// The position of an angle in [`Code::turns`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Turn(pub u32);

impl Number {
    pub(super) fn new(index: usize) -> Self {
        Self(index as u32)
    }

    #[inline(always)]
    pub(super) fn index(self) -> usize {
        self.0 as usize
    }

    /// This register and the three after it, which hold a quaternion x, y, z, w.
    #[inline(always)]
    pub(super) fn quaternion<S: Copy>(self, numbers: &[S]) -> [S; 4] {
        *numbers[self.index()..].first_chunk().expect("four registers")
    }
}

impl Frame {
    pub(super) fn new(index: usize) -> Self {
        Self(index as u32)
    }

    #[inline(always)]
    pub(super) fn index(self) -> usize {
        self.0 as usize
    }
}

/// What drives a step.
#[derive(Clone, Copy, Debug)]
pub(super) enum Driver {
    /// A scalar: one motion.
    Number(Number),
    /// An orientation in four scalars: three motions.
    Orientation(Number),
    /// An earlier transform: one motion for each direction that moves it.
    Frame(Frame),
}

impl Step {
    /// What drives it, in the order in which its motions are recorded, and whether it does not preserve
    /// lengths and angles (an earlier transform may not either).
    pub(super) fn drivers(self, code: &Code) -> (Vec<Driver>, bool) {
        let numbers = |numbers: &[Number]| numbers.iter().map(|&n| Driver::Number(n)).collect();
        match self {
            Self::Fixed(index) => {
                // MᵀM = 1, within the precision of numbers in files.
                let m = code.fixed[index as usize].linear;
                let product = m.transpose() * m;
                let off = [product.x - Vec3::X, product.y - Vec3::Y, product.z - Vec3::Z];
                (vec![], !off.iter().all(|column| column.norm() < 1e-6))
            }
            Self::Shift(_) => (vec![], false),
            Self::TurnX(turn)
            | Self::TurnY(turn)
            | Self::TurnZ(turn)
            | Self::TurnAbout { turn, .. } => (numbers(&[code.turns[turn.0 as usize]]), false),
            Self::Slide { distance, .. } => (numbers(&[distance]), false),
            Self::Move(distances) => (numbers(&distances), false),
            Self::Ball(orientation) => (vec![Driver::Orientation(orientation)], false),
            Self::Stretch { factor, .. } => (numbers(&[factor]), true),
            Self::Shear { amount, .. } => (numbers(&[amount]), true),
            Self::Law(index) => {
                let call = &code.laws[index as usize];
                (numbers(&call.inputs), !call.law.is_rigid())
            }
            Self::Transform(of) | Self::Inverse(of) | Self::Power { of, .. } => {
                (vec![Driver::Frame(of)], false)
            }
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
    /// A rotation about the x axis of the frame.
    TurnX(Turn),
    /// A rotation about the y axis of the frame.
    TurnY(Turn),
    /// A rotation about the z axis of the frame.
    TurnZ(Turn),
    /// A rotation about any axis of length 1.
    TurnAbout { axis: Vec3, turn: Turn },
    /// A translation along any axis.
    Slide { axis: Vec3, distance: Number },
    /// Translations along the three axes of the frame.
    Move([Number; 3]),
    /// A rotation by a quaternion in four consecutive registers x, y, z, w.
    Ball(Number),
    /// A scale; `along` is a position in [`Code::scales`].
    Stretch { along: u32, factor: Number },
    /// A shear; `directions` is a position in [`Code::shears`].
    Shear { directions: u32, amount: Number },
    /// A smooth law of a few scalars, by its position in [`Code::laws`].
    Law(u32),
    /// An earlier transform.
    Transform(Frame),
    /// The inverse of an earlier transform, which is rigid.
    Inverse(Frame),
    /// A power of the rotation of an earlier transform; -1 is its inverse.
    Power { of: Frame, exponent: f64 },
}

/// A smooth law with the registers it reads.
#[derive(Clone, Debug)]
pub(super) struct LawCall {
    pub law: AnyLaw,
    pub inputs: Vec<Number>,
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

impl MotionLaw for AnyLaw {
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
    /// `output = functions[function](input)`.
    Function { function: u32, input: Number, output: Number },
    /// `output = combines[function](its inputs)`.
    Combine { function: u32, output: Number },
    /// `output = passive`, clamped between two other scalars in posed mode.
    Hold { passive: Number, lower: Option<Number>, upper: Option<Number>, output: Number },
    /// Numbers with a limit, moved into it in posed mode, and its rows.
    Limit { limit: u32 },
    /// Four scalars: the quaternion of an earlier transform.
    Orientation { frame: Frame, output: Number },
    /// Scalars: where a point of an earlier transform is along directions.
    Position { position: u32 },
    /// A smooth function of few numbers.
    Numbers { numbers: u32 },
    /// The two rotations that bring a segment into contact with an ellipsoid.
    Contact { contact: u32 },
    /// `output = base · shift · steps`.
    Chain { base: Frame, shift: Vec3, first: u32, end: u32, output: Frame },
    /// The most common chain of character skeletons: a shift and a ball.
    BallAt { base: Frame, shift: Vec3, orientation: Number, output: Frame },
}

/// The registers that an instruction reads and writes.
#[derive(Clone, Debug, Default)]
pub(super) struct Registers {
    pub read: Vec<Number>,
    pub read_frames: Vec<Frame>,
    pub written: Vec<Number>,
    /// The transform that it computes; the others compute scalars only.
    pub frame: Option<Frame>,
}

impl Instruction {
    /// The registers that it reads and writes; of an orientation the first of four.
    pub(super) fn registers(&self, code: &Code) -> Registers {
        let mut registers = Registers::default();
        match *self {
            Self::Function { input, output, .. } => {
                registers.read.push(input);
                registers.written.push(output);
            }
            Self::Combine { function, output } => {
                registers.read.extend(&code.combines[function as usize].inputs);
                registers.written.push(output);
            }
            Self::Hold { passive, lower, upper, output } => {
                registers.read.extend([Some(passive), lower, upper].into_iter().flatten());
                registers.written.push(output);
            }
            Self::Limit { limit } => {
                let call = &code.limits[limit as usize];
                registers.read.extend(&call.inputs);
                registers.written.extend(call.outputs.iter().chain(&call.rows));
            }
            Self::Orientation { frame, output } => {
                registers.read_frames.push(frame);
                registers.written.extend((0..4).map(|k| Number(output.0 + k)));
            }
            Self::Position { position } => {
                let call = &code.positions[position as usize];
                registers.read_frames.push(call.frame);
                registers.written.extend(&call.outputs);
            }
            Self::Numbers { numbers } => {
                let call = &code.numbers[numbers as usize];
                registers.read.extend(&call.inputs);
                registers.written.extend(&call.outputs);
            }
            Self::Contact { contact } => {
                let call = &code.contacts[contact as usize];
                registers.read.extend(&call.drivers);
                registers.read_frames.push(call.frame);
                registers.written.extend((0..4).map(|k| Number(call.report.0 + k)));
                registers.frame = Some(call.output);
            }
            Self::Chain { base, first, end, output, .. } => {
                registers.read_frames.push(base);
                for step in &code.steps[first as usize..end as usize] {
                    for driver in step.drivers(code).0 {
                        match driver {
                            Driver::Number(n) | Driver::Orientation(n) => registers.read.push(n),
                            Driver::Frame(frame) => registers.read_frames.push(frame),
                        }
                    }
                }
                registers.frame = Some(output);
            }
            Self::BallAt { base, orientation, output, .. } => {
                registers.read_frames.push(base);
                registers.read.push(orientation);
                registers.frame = Some(output);
            }
        }
        registers
    }
}

/// A function of several scalars with the registers it reads.
#[derive(Clone, Debug)]
pub(super) struct CombineCall {
    pub function: FunctionOfSeveral,
    pub inputs: Vec<Number>,
}

/// A limit with its registers.
#[derive(Clone, Debug)]
pub(super) struct LimitCall {
    pub law: Law,
    /// How many orientations its numbers begin with; what follows are scalars.
    pub orientations: usize,
    /// Whether its numbers are measured between segments: they are then not moved.
    pub measured: bool,
    pub inputs: Vec<Number>,
    pub outputs: Vec<Number>,
    pub rows: Vec<Number>,
}

/// A point of an earlier transform, measured along directions.
#[derive(Clone, Debug)]
pub(super) struct PositionCall {
    pub frame: Frame,
    pub point: Vec3,
    pub along: Vec<Vec3>,
    pub outputs: Vec<Number>,
}

/// A smooth function of few numbers with its registers.
#[derive(Clone, Debug)]
pub(super) struct NumbersCall {
    pub law: Law,
    /// Whether its inputs are the four numbers of an orientation.
    pub orientation: bool,
    pub inputs: Vec<Number>,
    pub outputs: Vec<Number>,
}

/// A contact with its registers.
#[derive(Clone, Debug)]
pub(super) struct ContactCall {
    pub component: ComponentId,
    pub law: Gliding,
    /// The segment in the ellipsoid's frame, before the contact.
    pub frame: Frame,
    pub drivers: Vec<Number>,
    /// The two rotations.
    pub output: Frame,
    /// The first of four scalars: two angles, two gaps.
    pub report: Number,
    /// Whether the gaps are bounded, so that their derivatives are needed.
    pub bounded: bool,
}

/// Instructions that run together: first those that compute scalars, then the sines and cosines of
/// angles, then those that compute transforms.
#[derive(Clone, Debug)]
pub(super) struct Stage {
    pub scalars: Range<usize>,
    pub turns: Range<usize>,
    pub transforms: Range<usize>,
}

/// The instructions in the order in which they run, and the tables that they refer to by position.
#[derive(Clone, Debug)]
pub(super) struct Code {
    /// The number of scalar registers; the first are the stored numbers of the coordinates.
    pub scalars: usize,
    /// The number of transform registers; the first are those of the segments.
    pub transforms: usize,
    pub instructions: Vec<Instruction>,
    /// All instructions and turns, in order.
    pub stages: Vec<Stage>,
    /// The angles whose sines and cosines are needed.
    pub turns: Vec<Number>,
    pub steps: Vec<Step>,
    pub fixed: Vec<Affine>,
    pub functions: Vec<Function>,
    pub combines: Vec<CombineCall>,
    pub laws: Vec<LawCall>,
    pub scales: Vec<Along>,
    /// The directions `along` and `across` of each shear.
    pub shears: Vec<[Vec3; 2]>,
    /// The limit rows: not negative in a legal posture.
    pub rows: Vec<Number>,
    pub limits: Vec<LimitCall>,
    pub positions: Vec<PositionCall>,
    pub numbers: Vec<NumbersCall>,
    pub contacts: Vec<ContactCall>,
    /// The model's root frame, the parent of the root segments.
    pub base: Frame,
    /// A transform that stays the identity.
    pub identity: Frame,
}
