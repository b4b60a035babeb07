//! The components of joint sets.
//!
//! A component reads scalars (angles in radians, distances in metres), orientations or transforms,
//! and computes scalars, an orientation or one transform. Its formula is at the top of its file.
//! Nearly all components are smooth: evaluated on [`Dual`](condyle_math::Dual) numbers they give
//! their exact derivatives, and the generator of a rigid transform T(x) is the twist Ṫ·T⁻¹ in the
//! frame that T maps to.
//!
//! | component | in → out |
//! | --- | --- |
//! | [`Map`] | scalar → scalars, one function each |
//! | [`Combine`] | scalars → scalar |
//! | [`Depend`] | driver, passive → passive, clamped to bounds that the driver sets |
//! | [`JointCone`] | angles of a ball joint, or its orientation → the legal ones |
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
//! To add a component: a file here with its struct and its formula, a variant of [`Component`], its
//! ports in [`Component::inputs`] and [`Component::outputs`], and its compilation in
//! `evaluate/compile/`; a smooth function of scalars only needs to implement [`Law`] for that.

mod ball;
mod combine;
mod compensate;
mod cone;
mod constant_curvature;
mod contact;
mod curve;
mod custom;
mod depend;
mod ellipsoid;
mod map;
mod pivot;
mod place;
mod product;
mod rotate;
mod scale;
pub(crate) mod shear;
mod translate;

pub use ball::Ball;
pub use combine::Combine;
pub use compensate::Compensate;
pub use cone::{JointCone, Swinging};
pub use constant_curvature::ConstantCurvature;
pub use contact::{Contact, ContactError, ContactPair, Glide, Gliding};
pub use curve::{Curve, Heading};
pub use custom::{Custom, ErasedLaw, LawDual, Parameters, Registry};
pub use depend::Depend;
pub use ellipsoid::{Ellipsoid, SurfaceAxis};
pub use map::Map;
pub use pivot::{Centre, Pivot, PivotError};
pub use place::Place;
pub use product::Product;
pub use rotate::Rotate;
pub use scale::{Along, Scale};
pub use shear::Shear;
pub use translate::Translate;

use crate::position::{ComponentId, CoordinateId};
use condyle_math::{Affine, Scalar};

/// What flows into a port of a component, or moves a segment: the value of a coordinate or an output
/// of a component.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Signal {
    /// The requested value of a coordinate, of any joint set; in posed mode clamped to its range.
    /// If a limit component acts on the coordinate, the limited value is that component's output.
    Coordinate(CoordinateId),
    /// One output of a component, of any joint set.
    Output(ComponentId, u32),
}

impl From<CoordinateId> for Signal {
    fn from(id: CoordinateId) -> Self {
        Self::Coordinate(id)
    }
}

/// The type of the value of a port.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PortType {
    /// One number: an angle, a distance, a factor.
    Scalar,
    /// A unit quaternion.
    Orientation,
    /// A transform.
    Transform,
}

/// A component of a joint set: its parameters and where its inputs come from.
#[derive(Clone, Debug, PartialEq)]
pub enum Component {
    /// Scalar to scalars.
    Map(Map),
    /// Scalars to scalar.
    Combine(Combine),
    /// A scalar clamped to bounds that another one sets.
    Depend(Depend),
    /// A ball joint limited by a cone.
    Cone(JointCone),
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

impl Component {
    /// The component's name in files and messages.
    pub fn kind(&self) -> &'static str {
        match self {
            Self::Map(_) => "map",
            Self::Combine(_) => "combine",
            Self::Depend(_) => "depend",
            Self::Cone(_) => "cone",
            Self::Contact(_) => "contact",
            Self::Rotate(_) => "rotate",
            Self::Pivot(_) => "pivot",
            Self::Translate(_) => "translate",
            Self::Ball(_) => "ball",
            Self::Place(_) => "place",
            Self::Ellipsoid(_) => "ellipsoid",
            Self::ConstantCurvature(_) => "constant_curvature",
            Self::Compensate(_) => "compensate",
            Self::Scale(_) => "scale",
            Self::Shear(_) => "shear",
            Self::Curve(_) => "curve",
            Self::Custom(_) => "custom",
            Self::Product(_) => "product",
        }
    }

    /// The inputs: the name, type and source of each port.
    ///
    /// A [`Compensate`] refers to segments and has no ports, and a [`Contact`] also reads the
    /// motions on the path to its surface: [`Model::reads`](crate::Model::reads) includes them.
    pub fn inputs(&self) -> Vec<(&'static str, PortType, Signal)> {
        use PortType::{Orientation, Scalar, Transform};
        let three = |names: [&'static str; 3], sources: [Signal; 3]| {
            names.into_iter().zip(sources).map(|(name, s)| (name, Scalar, s)).collect()
        };
        match self {
            Self::Map(c) => vec![("input", Scalar, c.input)],
            Self::Combine(c) => c.inputs.iter().map(|&s| ("inputs", Scalar, s)).collect(),
            Self::Depend(c) => vec![("passive", Scalar, c.passive), ("driver", Scalar, c.driver)],
            Self::Cone(c) => match &c.of {
                Swinging::Angles(s, _) => s.iter().map(|&s| ("angles", Scalar, s)).collect(),
                Swinging::Directions(s, _) => s.iter().map(|&s| ("angles", Scalar, s)).collect(),
                Swinging::Orientation(s) => vec![("orientation", Orientation, *s)],
            },
            Self::Contact(c) => {
                let before = c.before.map(|s| ("before", Transform, s));
                let drivers = c.drivers.iter().map(|&s| ("drivers", Scalar, s));
                before.into_iter().chain(drivers).collect()
            }
            Self::Rotate(c) => vec![("angle", Scalar, c.angle)],
            Self::Pivot(c) => vec![("angle", Scalar, c.angle)],
            Self::Translate(c) => vec![("distance", Scalar, c.distance)],
            Self::Ball(c) => vec![("orientation", Orientation, c.orientation)],
            Self::Place(_) | Self::Compensate(_) => vec![],
            Self::Ellipsoid(c) => three(["about_x", "about_y", "about_z"], c.angles),
            Self::ConstantCurvature(c) => three(["about_x", "about_z", "about_y"], c.angles),
            Self::Scale(c) => vec![("factor", Scalar, c.factor)],
            Self::Shear(c) => vec![("amount", Scalar, c.amount)],
            Self::Curve(c) => vec![("parameter", Scalar, c.parameter)],
            Self::Custom(c) => c.inputs.iter().map(|&s| ("inputs", Scalar, s)).collect(),
            Self::Product(c) => c.factors.iter().map(|&s| ("factors", Transform, s)).collect(),
        }
    }

    /// The type of the outputs, and their number.
    pub fn outputs(&self) -> (PortType, usize) {
        match self {
            Self::Map(c) => (PortType::Scalar, c.functions.len()),
            Self::Combine(_) | Self::Depend(_) => (PortType::Scalar, 1),
            Self::Cone(c) => match c.of {
                Swinging::Angles(..) => (PortType::Scalar, 3),
                Swinging::Directions(..) => (PortType::Scalar, 2),
                Swinging::Orientation(_) => (PortType::Orientation, 1),
            },
            _ => (PortType::Transform, 1),
        }
    }
}

/// A smooth transform-valued function of a few scalars, generic over the scalar type.
pub trait Law {
    /// The transform at these inputs, in the order of [`Component::inputs`].
    fn transform<S: Scalar>(&self, inputs: &[S]) -> Affine<S>;

    /// Whether the transform is rigid (preserves lengths and angles) at all inputs; `true` by
    /// default.
    fn is_rigid(&self) -> bool {
        true
    }
}

/// The largest number of inputs of a [`Law`].
pub const MOST_LAW_INPUTS: usize = 4;

/// The largest number of inputs of a [`Combine`].
pub const MOST_COMBINED: usize = 16;
