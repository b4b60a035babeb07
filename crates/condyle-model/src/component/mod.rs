//! The components of joint sets.
//!
//! A [`Component`] is a [`Law`] and its wiring: the law says what is computed from what, with its
//! parameters; the wiring says which signals are at its ports. A law reads scalars (angles in radians,
//! distances in metres), orientations, transforms or places of segments, and computes scalars, an
//! orientation or one transform. Its formula is at the top of its file.
//!
//! Nearly all laws are smooth: evaluated on [`Dual`](condyle_math::Dual) numbers they give their exact
//! derivatives, and the generator of a rigid transform T(x) is the twist Ṫ·T⁻¹ in the frame that T maps
//! to.
//!
//! | law | in → out |
//! | --- | --- |
//! | [`Map`] | scalar → scalars, one function each |
//! | [`Combine`] | scalars → scalar |
//! | [`Correlate`] | scalars → scalar, learned, with the region where it was |
//! | [`Depend`] | driver, passive → passive, clamped to bounds that the driver sets |
//! | [`JointCone`] | angles of a ball joint, or its orientation → the legal ones |
//! | [`Ellipse`] | two scalars → the legal ones |
//! | [`HalfSpace`] | scalars → the legal ones |
//! | [`FieldLimit`] | an orientation → the nearest one that people take |
//! | [`RelativeOrientation`] | two segments → orientation |
//! | [`RelativePosition`] | two segments → scalars: where a point of one is in the other |
//! | [`Angles`] | orientation → three angles, or twist and swing |
//! | [`Contact`] | pose of a bone → the two rotations that put it on an ellipsoid |
//! | [`Rotate`] | angle → rotation about a fixed axis |
//! | [`Pivot`] | angle → rotation about an axis whose centre moves |
//! | [`Translate`] | distance → translation along a fixed axis |
//! | [`Ball`] | orientation → rotation |
//! | [`Place`] | nothing → a fixed transform |
//! | [`Scale`] | factor → a scale: everywhere, along an axis, or keeping the volume |
//! | [`Shear`] | amount → a shear |
//! | [`Curve`] | parameter → a position on a curve, with or without its heading |
//! | [`Ellipsoid`] | three angles → a frame that glides on an ellipsoid |
//! | [`ConstantCurvature`] | three angles → the end of an arc of fixed length |
//! | [`Compensate`] | motions of ancestors → the rotation that cancels them |
//! | [`Custom`] | scalars → the transform of a user's law |
//! | [`Product`] | transforms → their product |
//!
//! To add a law: a file here with its struct, its formula and its `Contract`, a variant of [`Law`], and
//! its compilation in `evaluate/compile/`; a smooth function of scalars only needs to implement
//! [`MotionLaw`] for that. The compiler names every place.

mod angles;
mod ball;
mod combine;
mod compensate;
mod cone;
mod constant_curvature;
mod contact;
mod correlate;
mod curve;
mod custom;
mod depend;
mod ellipse;
mod ellipsoid;
mod field;
mod geometry;
mod half_space;
mod map;
mod numbers;
mod pivot;
mod place;
mod port;
mod product;
mod reflection;
mod relative_orientation;
mod relative_position;
mod rotate;
mod scale;
pub(crate) mod shear;
mod translate;

pub use angles::{AngleNames, Angles};
pub use ball::Ball;
pub use combine::Combine;
pub use compensate::Compensate;
pub use cone::{JointCone, Swinging};
pub use constant_curvature::ConstantCurvature;
pub use contact::{Contact, ContactError, ContactPair, Glide, Gliding};
pub use correlate::{Correlate, Region};
pub use curve::{Curve, Heading};
pub use custom::{Custom, ErasedLaw, LawDual, Parameters, Registry};
pub use depend::Depend;
pub use ellipse::Ellipse;
pub use ellipsoid::{Ellipsoid, SurfaceAxis};
pub use field::FieldLimit;
pub use half_space::HalfSpace;
pub use map::Map;
pub use pivot::{Centre, Pivot, PivotError};
pub use place::Place;
pub use port::{Arity, Kind, Port, PortType, Signal};
pub use product::Product;
pub use reflection::{Mirrored, Reflection};
pub use relative_orientation::RelativeOrientation;
pub use relative_position::RelativePosition;
pub use rotate::Rotate;
pub use scale::{Along, Scale};
pub use shear::Shear;
pub use translate::Translate;

use geometry::Geometry;
pub(crate) use numbers::{ErasedNumbers, MOST_NUMBERS, NumberDual, Numbers};

use crate::limit::Limit;
use crate::position::{JointSetId, SegmentId};
use condyle_diagnostics::Severity;
use condyle_math::{Affine, Growth, Scalar, Vec3};

/// A component of a joint set: a law, and where its inputs come from.
#[derive(Clone, Debug, PartialEq)]
pub struct Component {
    /// Its name, unique in its joint set.
    pub name: String,
    /// The joint set it belongs to.
    pub joint_set: JointSetId,
    /// What it computes.
    pub law: Law,
    /// The signals at its ports, in the order of [`Law::ports`]; of a port that takes a list, all of it.
    pub inputs: Vec<Signal>,
}

impl Component {
    /// Each input with its port.
    pub fn ports(&self) -> impl Iterator<Item = (&'static Port, Signal)> {
        self.law.ports_of(self.inputs.len()).zip(self.inputs.iter().copied())
    }

    /// The signals at a port; none where it is not connected or there is no such port.
    pub fn at(&self, port: &str) -> &[Signal] {
        self.by_port().find(|(p, _)| p.name == port).map_or(&[], |(_, signals)| signals)
    }

    /// The segments at a port.
    pub fn segments_at(&self, port: &str) -> impl Iterator<Item = SegmentId> {
        self.at(port).iter().filter_map(|signal| signal.segment())
    }

    /// The inputs that are values, not places of segments.
    pub fn values(&self) -> impl Iterator<Item = Signal> {
        self.inputs.iter().copied().filter(|signal| signal.segment().is_none())
    }

    /// Each port with its signals.
    pub fn by_port(&self) -> impl Iterator<Item = (&'static Port, &[Signal])> {
        let mut rest = &self.inputs[..];
        self.law.widths(self.inputs.len()).map(move |(port, width)| {
            let (own, after) = rest.split_at(width.min(rest.len()));
            rest = after;
            (port, own)
        })
    }
}

/// What every law states about itself, beside the `KIND` of its type: its name in files and messages,
/// and its ports.
pub(crate) trait Contract {
    /// The parameters that change with the size of the body or on its other side.
    fn geometry(&mut self) -> Vec<Geometry<'_>>;

    /// Whether it has a port that only some laws of its kind have.
    fn has(&self, _port: &Port) -> bool {
        true
    }

    /// The type of its outputs, and their number.
    fn outputs(&self) -> (PortType, usize) {
        (PortType::Transform, 1)
    }

    /// Whether its transform stretches or shears what it moves, by itself.
    fn deforms(&self) -> bool {
        false
    }

    /// How many inputs it takes, where its ports do not say so.
    fn takes(&self) -> Option<usize> {
        None
    }

    /// What is wrong with its parameters, as a code, what is said of the component, and what would be
    /// right.
    fn faults(&self) -> Vec<Fault> {
        vec![]
    }

    /// Changes the lengths that it holds: with the growth of its joint, which is that of the parent of
    /// the segment that it moves seen from the joint's frame, or of the segments at its ports, in their order.
    fn grow(&mut self, joint: &Growth, segments: &[Growth]) {
        self.geometry().into_iter().for_each(|part| part.grow(joint, segments));
    }

    /// Makes it the law of the other side of the body. Values of coordinates are equal on both sides:
    /// the transform T becomes D·T·D with the reflection D.
    ///
    /// # Errors
    /// What to do, where the mirror image is no law of this kind.
    fn mirror(&mut self, at: Reflection) -> Result<Mirrored, String> {
        self.geometry().into_iter().for_each(|part| part.mirror(at));
        Ok(Mirrored::default())
    }
}

/// The laws that the compiler treats alike; within a family it names each.
pub(crate) enum Family<'a> {
    /// Computes numbers, each in its own way.
    Scalars(Scalars<'a>),
    /// A smooth function from few numbers to few.
    Numbers(&'a dyn ErasedNumbers),
    /// Passes numbers, within a limit in posed mode.
    Limit(&'a dyn Limit),
    /// Computes a transform.
    Motion(Motion<'a>),
}

macro_rules! laws {
    (
        scalars { $($(#[doc = $s_doc:literal])* $scalar:ident($s:ident),)* }
        numbers { $($(#[doc = $n_doc:literal])* $number:ident($n:ident),)* }
        limits { $($(#[doc = $l_doc:literal])* $limit:ident($l:ident),)* }
        motions { $($(#[doc = $m_doc:literal])* $motion:ident($m:ident),)* }
    ) => {
        /// What a component computes: one of the laws, with its parameters.
        #[derive(Clone, Debug, PartialEq)]
        pub enum Law {
            $($(#[doc = $s_doc])* $scalar($s),)*
            $($(#[doc = $n_doc])* $number($n),)*
            $($(#[doc = $l_doc])* $limit($l),)*
            $($(#[doc = $m_doc])* $motion($m),)*
        }

        /// The laws that compute numbers, each in its own way.
        #[allow(dead_code, reason = "a law without parameters has nothing to read")]
        pub(crate) enum Scalars<'a> { $($scalar(&'a $s),)* }

        /// The laws that compute a transform.
        #[allow(dead_code, reason = "a law without parameters has nothing to read")]
        pub(crate) enum Motion<'a> { $($motion(&'a $m),)* }

        impl Law {
            /// All kinds of laws.
            pub const KINDS: &[Kind] = &[$($s::KIND,)* $($n::KIND,)* $($l::KIND,)* $($m::KIND,)*];

            /// Its kind: its name and all ports that such a law can have.
            pub fn kind(&self) -> &'static Kind {
                match self {
                    $(Self::$scalar(_) => const { &$s::KIND },)*
                    $(Self::$number(_) => const { &$n::KIND },)*
                    $(Self::$limit(_) => const { &$l::KIND },)*
                    $(Self::$motion(_) => const { &$m::KIND },)*
                }
            }

            /// Its family.
            pub(crate) fn family(&self) -> Family<'_> {
                match self {
                    $(Self::$scalar(law) => Family::Scalars(Scalars::$scalar(law)),)*
                    $(Self::$number(law) => Family::Numbers(law),)*
                    $(Self::$limit(law) => Family::Limit(law),)*
                    $(Self::$motion(law) => Family::Motion(Motion::$motion(law)),)*
                }
            }

            fn contract(&self) -> &dyn Contract {
                match self {
                    $(Self::$scalar(law) => law,)*
                    $(Self::$number(law) => law,)*
                    $(Self::$limit(law) => law,)*
                    $(Self::$motion(law) => law,)*
                }
            }

            fn contract_mut(&mut self) -> &mut dyn Contract {
                match self {
                    $(Self::$scalar(law) => law,)*
                    $(Self::$number(law) => law,)*
                    $(Self::$limit(law) => law,)*
                    $(Self::$motion(law) => law,)*
                }
            }
        }
    };
}

laws! {
    scalars {
        /// Scalar to scalars.
        Map(Map),
        /// Scalars to scalar.
        Combine(Combine),
        /// Scalars to scalar, learned from recordings.
        Correlate(Correlate),
        /// A scalar clamped to bounds that another one sets.
        Depend(Depend),
        /// The orientation of a segment in another.
        RelativeOrientation(RelativeOrientation),
        /// The position of a point of a segment in another.
        RelativePosition(RelativePosition),
    }
    numbers {
        /// An orientation to three angles.
        Angles(Angles),
    }
    limits {
        /// A ball joint limited by a cone.
        Cone(JointCone),
        /// Two scalars limited by an ellipse.
        Ellipse(Ellipse),
        /// Scalars of which a sum is limited.
        HalfSpace(HalfSpace),
        /// An orientation limited by a learned field.
        Field(FieldLimit),
    }
    motions {
        /// Contact of a segment with an ellipsoid.
        Contact(Contact),
        /// Rotation about a fixed axis.
        Rotate(Rotate),
        /// Rotation about an axis whose centre moves.
        Pivot(Pivot),
        /// Translation along a fixed axis.
        Translate(Translate),
        /// Rotation by an orientation.
        Ball(Ball),
        /// A fixed transform.
        Place(Place),
        /// Gliding on an ellipsoid.
        Ellipsoid(Ellipsoid),
        /// Bending along an arc.
        ConstantCurvature(ConstantCurvature),
        /// The rotation that cancels those of ancestors.
        Compensate(Compensate),
        /// A scale.
        Scale(Scale),
        /// A shear.
        Shear(Shear),
        /// Motion along a curve.
        Curve(Curve),
        /// A user's law.
        Custom(Custom),
        /// Product of transforms.
        Product(Product),
    }
}

impl Law {
    /// Its ports, in the order of [`Component::inputs`].
    pub fn ports(&self) -> impl Iterator<Item = &'static Port> {
        self.kind().ports.iter().filter(|port| self.has(port))
    }

    /// Whether it has a port that only some laws of its kind have.
    pub(crate) fn has(&self, port: &Port) -> bool {
        self.contract().has(port)
    }

    /// The port of each of so many inputs: one for a port, and for a list all that the others do not
    /// take.
    pub fn ports_of(&self, inputs: usize) -> impl Iterator<Item = &'static Port> {
        self.widths(inputs).flat_map(|(port, width)| std::iter::repeat_n(port, width))
    }

    fn widths(&self, inputs: usize) -> impl Iterator<Item = (&'static Port, usize)> {
        let single = self.ports().filter(|port| !port.is_list()).count();
        let listed = inputs.saturating_sub(single);
        self.ports().map(move |port| (port, if port.is_list() { listed } else { 1 }))
    }

    /// The type of the outputs, and their number.
    pub fn outputs(&self) -> (PortType, usize) {
        self.contract().outputs()
    }

    /// Whether it bounds what it reads.
    pub fn bounds(&self) -> bool {
        matches!(self, Self::Depend(_)) || self.limit().is_some()
    }

    /// The function of few numbers that it is, if it is one.
    pub(crate) fn numbers(&self) -> Option<&dyn ErasedNumbers> {
        match self.family() {
            Family::Numbers(law) => Some(law),
            Family::Scalars(_) | Family::Limit(_) | Family::Motion(_) => None,
        }
    }

    /// The function of several scalars that it is, where it is [`Combine`] or [`Correlate`].
    pub fn several(&self) -> Option<&condyle_math::function::FunctionOfSeveral> {
        match self {
            Self::Combine(law) => Some(&law.function),
            Self::Correlate(law) => Some(&law.function),
            _ => None,
        }
    }

    /// The same, to be changed in place.
    pub(crate) fn several_mut(&mut self) -> Option<&mut condyle_math::function::FunctionOfSeveral> {
        match self {
            Self::Combine(law) => Some(&mut law.function),
            Self::Correlate(law) => Some(&mut law.function),
            _ => None,
        }
    }

    /// How many inputs it takes, where its ports do not say so.
    pub(crate) fn takes(&self) -> Option<usize> {
        self.contract().takes()
    }

    /// What is wrong with its parameters.
    pub(crate) fn faults(&self) -> Vec<Fault> {
        self.contract().faults()
    }

    /// Whether its transform stretches or shears what it moves, by itself.
    pub(crate) fn deforms(&self) -> bool {
        self.contract().deforms()
    }

    /// The limit of all its inputs together, which its outputs keep.
    pub fn limit(&self) -> Option<&dyn Limit> {
        match self.family() {
            Family::Limit(limit) => Some(limit),
            Family::Scalars(_) | Family::Numbers(_) | Family::Motion(_) => None,
        }
    }

    /// The directions among its parameters, by their names in files.
    pub(crate) fn directions(&mut self) -> impl Iterator<Item = (&'static str, &mut Vec3)> {
        self.contract_mut().geometry().into_iter().filter_map(Geometry::direction)
    }

    /// Changes the lengths that it holds with the growth of its joint, or of the segments at its ports.
    pub(crate) fn grow(&mut self, joint: &Growth, segments: &[Growth]) {
        self.contract_mut().grow(joint, segments);
    }

    /// Makes it the law of the other side of the body, for equal values of coordinates: its transform T
    /// becomes D·T·D with the reflection D.
    ///
    /// The result says what else has to change: the values at its ports, and a transform after it.
    ///
    /// # Errors
    /// A sentence that says what to do, where the mirror image is no law of this kind.
    pub fn mirror(&mut self, at: Reflection) -> Result<Mirrored, String> {
        self.contract_mut().mirror(at)
    }
}

/// A direction with length 1. One that has it keeps its bits, so that a written model is read as it was.
pub(crate) fn unit(direction: Vec3) -> Vec3 {
    if (direction.norm() - 1.0).abs() > 1e-15 { direction.normalized() } else { direction }
}

/// A fault of a law's parameters: its severity and code, what is said of the component, what would be right.
pub(crate) struct Fault {
    pub severity: Severity,
    pub code: &'static str,
    /// The rest of a sentence that begins with the component.
    pub said: String,
    pub help: &'static str,
}

/// A smooth transform-valued function of a few scalars, generic over the scalar type.
pub trait MotionLaw {
    /// The transform at these inputs, in the order of its ports.
    fn transform<S: Scalar>(&self, inputs: &[S]) -> Affine<S>;

    /// Whether the transform is rigid (preserves lengths and angles) at all inputs; `true` by
    /// default.
    fn is_rigid(&self) -> bool {
        true
    }
}

/// The largest number of inputs of a [`MotionLaw`].
pub const MOST_LAW_INPUTS: usize = 4;
