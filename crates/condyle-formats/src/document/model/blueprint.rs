//! Components before their inputs are known.

use crate::document::texts::Name;
use condyle_math::function::{Function, FunctionOfSeveral, SimmSpline};
use condyle_math::{Affine, Vec3};
use condyle_model::component::{
    Along, Ball, Centre, Combine, Compensate, Component, ConstantCurvature, Contact, Curve, Custom,
    Depend, Ellipsoid, Gliding, Heading, JointCone, Map, Pivot, Place, PortType, Product, Rotate,
    Scale, Shear, SurfaceAxis, Swinging, Translate,
};
use condyle_model::{Cone, SegmentId, Signal};

/// A component without its inputs.
#[derive(Clone)]
pub(super) enum Blueprint {
    Map(Vec<Function>),
    Combine(FunctionOfSeveral),
    Depend {
        lower: Option<Function>,
        upper: Option<Function>,
    },
    Cone(Held, Cone),
    Contact {
        segment: Name,
        surface: Name,
        before: bool,
        gliding: Gliding,
    },
    Rotate(Vec3),
    Pivot(Vec3, Centre),
    Translate(Vec3),
    Ball,
    Place(Affine),
    Ellipsoid(Vec3, SurfaceAxis),
    ConstantCurvature {
        neutral: [f64; 3],
        length: f64,
    },
    Compensate {
        segment: Name,
        ancestors: Vec<Name>,
        weight: f64,
    },
    Scale(Along),
    Shear {
        along: Vec3,
        across: Vec3,
    },
    Curve {
        path: Box<[SimmSpline; 3]>,
        heading: Option<Heading>,
    },
    /// Complete except for its inputs: made early to check its parameters.
    Custom(Custom),
    Product,
}

/// What a cone limits: angles about axes, or an orientation.
#[derive(Clone)]
pub(super) enum Held {
    Three([Vec3; 3]),
    Two([Vec3; 2]),
    Orientation,
}

impl Blueprint {
    /// The type of the input at a position.
    pub(super) fn input(&self, position: usize) -> PortType {
        match self {
            Self::Ball | Self::Cone(Held::Orientation, _) => PortType::Orientation,
            Self::Product => PortType::Transform,
            Self::Contact { before: true, .. } if position == 0 => PortType::Transform,
            _ => PortType::Scalar,
        }
    }

    pub(super) fn outputs(&self) -> (PortType, usize) {
        match self {
            Self::Map(functions) => (PortType::Scalar, functions.len()),
            Self::Combine(_) | Self::Depend { .. } => (PortType::Scalar, 1),
            Self::Cone(Held::Three(_), _) => (PortType::Scalar, 3),
            Self::Cone(Held::Two(_), _) => (PortType::Scalar, 2),
            Self::Cone(Held::Orientation, _) => (PortType::Orientation, 1),
            _ => (PortType::Transform, 1),
        }
    }

    /// The component, or why its parameters are invalid.
    pub(super) fn build(
        self,
        connected: Vec<Signal>,
        segment: &mut dyn FnMut(&Name) -> Option<SegmentId>,
    ) -> Result<Component, String> {
        let unknown = || "it names an unknown segment".to_owned();
        Ok(match (self, &connected[..]) {
            (Self::Map(functions), &[input]) => Component::Map(Map { input, functions }),
            (Self::Combine(function), _) => {
                Component::Combine(Combine { inputs: connected, function })
            }
            (Self::Depend { lower, upper }, &[passive, driver]) => {
                Component::Depend(Depend { passive, driver, lower, upper })
            }
            (Self::Cone(held, cone), inputs) => {
                let of = match (held, inputs) {
                    (Held::Three(axes), &[a, b, c]) => Swinging::Angles([a, b, c], axes),
                    (Held::Two(axes), &[a, b]) => Swinging::Directions([a, b], axes),
                    (Held::Orientation, &[one]) => Swinging::Orientation(one),
                    _ => return Err("it has the wrong number of inputs".to_owned()),
                };
                Component::Cone(JointCone { of, cone })
            }
            (Self::Contact { segment: moved, surface, before, gliding }, inputs) => {
                let (moved, surface) = (segment(&moved), segment(&surface));
                let (segment, surface) = (moved.ok_or_else(unknown)?, surface.ok_or_else(unknown)?);
                let (before, drivers) = inputs.split_at(usize::from(before).min(inputs.len()));
                let (before, drivers) = (before.first().copied(), drivers.to_vec());
                Component::Contact(Contact { segment, surface, before, drivers, law: gliding })
            }
            (Self::Rotate(axis), &[angle]) => Component::Rotate(Rotate { angle, axis }),
            (Self::Pivot(axis, centre), &[angle]) => Component::Pivot(
                Pivot::new(angle, axis, centre).map_err(|error| error.to_string())?,
            ),
            (Self::Translate(axis), &[distance]) => {
                Component::Translate(Translate { distance, axis })
            }
            (Self::Ball, &[orientation]) => Component::Ball(Ball { orientation }),
            (Self::Place(child_in_parent), []) => Component::Place(Place { child_in_parent }),
            (Self::Ellipsoid(radii, axis), &[x, y, z]) => {
                Component::Ellipsoid(Ellipsoid { angles: [x, y, z], radii, axis })
            }
            (Self::ConstantCurvature { neutral, length }, &[x, z, y]) => {
                let angles = [x, z, y];
                Component::ConstantCurvature(ConstantCurvature { angles, neutral, length })
            }
            (Self::Compensate { segment: moved, ancestors, weight }, []) => {
                let moved = segment(&moved).ok_or_else(unknown)?;
                let ancestors: Vec<Option<SegmentId>> = ancestors.iter().map(segment).collect();
                let ancestors: Option<Vec<SegmentId>> = ancestors.into_iter().collect();
                let ancestors = ancestors.ok_or_else(unknown)?;
                Component::Compensate(Compensate { segment: moved, ancestors, weight })
            }
            (Self::Scale(along), &[factor]) => Component::Scale(Scale { factor, along }),
            (Self::Shear { along, across }, &[amount]) => {
                Component::Shear(Shear { amount, along, across })
            }
            (Self::Curve { path, heading }, &[parameter]) => {
                Component::Curve(Curve { parameter, path, heading })
            }
            (Self::Custom(mut custom), _) => {
                custom.inputs = connected;
                Component::Custom(custom)
            }
            (Self::Product, _) => Component::Product(Product { factors: connected }),
            _ => return Err("it has the wrong number of inputs".to_owned()),
        })
    }
}
