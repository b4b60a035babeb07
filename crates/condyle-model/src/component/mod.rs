//! The pieces that joint sets are made of.
//!
//! A component reads scalars (angles in radians, distances in metres), orientations or transforms
//! and makes scalars or one transform of them. Its formula stands at the top of its file. Nearly all
//! components are smooth: run on [`Dual`](condyle_math::Dual) numbers they yield their exact
//! derivative, and the generator of a transform T(x) is the twist Ṫ·T⁻¹ in the frame it maps to.
//!
//! | component | in → out |
//! | --- | --- |
//! | [`Map`] | scalar → scalars, one function each |
//! | [`Combine`] | scalars → scalar |
//! | [`Depend`] | driver, passive → passive, held between bounds that the driver sets |
//! | [`JointCone`] | angles of a ball joint, or its orientation → the legal ones |
//! | [`Contact`] | where a bone is → the two turns that put it on an ellipsoid |
//! | [`Rotate`] | angle → rotation about a fixed axis |
//! | [`Pivot`] | angle → rotation about an axis whose centre moves |
//! | [`Translate`] | distance → translation along a fixed axis |
//! | [`Ball`] | orientation → rotation |
//! | [`Place`] | nothing → a fixed transform |
//! | [`Scale`] | factor → a scale: everywhere, along an axis, or keeping the volume |
//! | [`Shear`] | amount → layers that slide over each other |
//! | [`Curve`] | parameter → a place on a curve, turning with it or not |
//! | [`Ellipsoid`] | three angles → a frame that glides on an ellipsoid |
//! | [`ConstantCurvature`] | three angles → the end of an arc of fixed length |
//! | [`Compensate`] | motions of ancestors → the rotation that undoes them |
//! | [`Custom`] | scalars → whatever a user's law makes of them |
//! | [`Product`] | transforms → their product |
//!
//! To add one: a file here with its struct and its formula, a variant of [`Component`], its ports
//! in [`Component::inputs`] and [`Component::outputs`], and its lowering in `evaluate/compile.rs`;
//! a kind that is a smooth law of scalars needs only a [`Law`] there.

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

/// Where a component's input, or a segment's motion, comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Source {
    /// The value of a coordinate, of any joint set: what was asked for, in posed mode inside its range.
    /// Where a limit component holds the coordinate, what it holds is that component's output.
    Coordinate(CoordinateId),
    /// One output of a component, of any joint set.
    Output(ComponentId, u32),
}

impl From<CoordinateId> for Source {
    fn from(id: CoordinateId) -> Self {
        Self::Coordinate(id)
    }
}

/// What flows through a port.
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
    /// A scalar held between bounds that another sets.
    Depend(Depend),
    /// A ball joint held inside a cone.
    Cone(JointCone),
    /// A bone put on an ellipsoid.
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
    /// The rotation that undoes what ancestors did.
    Compensate(Compensate),
    /// Growing and shrinking.
    Scale(Scale),
    /// Layers sliding over each other.
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

    /// The inputs: the name and type of each port, and where it is connected.
    ///
    /// A [`Compensate`] names segments and has no ports, and a [`Contact`] reads the motions on the
    /// way to its surface beside its ports: [`Model::reads`](crate::Model::reads) finds them.
    pub fn inputs(&self) -> Vec<(&'static str, PortType, Source)> {
        use PortType::{Orientation, Scalar, Transform};
        let three = |names: [&'static str; 3], sources: [Source; 3]| {
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

    /// The type of what comes out, and how many outputs of it there are.
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

/// A smooth transform-valued law of a few scalars, written once for every number.
pub trait Law {
    /// The transform at these inputs, in the order of [`Component::inputs`].
    fn transform<S: Scalar>(&self, inputs: &[S]) -> Affine<S>;

    /// Whether the transform keeps lengths and angles at all inputs.
    fn is_rigid(&self) -> bool {
        true
    }
}

/// The most inputs that a [`Law`] may have.
pub const MOST_LAW_INPUTS: usize = 4;

/// The most scalars that one [`Combine`] may read.
pub const MOST_COMBINED: usize = 16;
