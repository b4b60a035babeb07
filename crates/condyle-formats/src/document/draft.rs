//! A model as it is written: numbers read, names not yet looked up.

use super::source::{Name, Spot};
use condyle_math::function::{Function, FunctionOfSeveral};
use condyle_math::{Affine, Vec3};
use condyle_model::component::{
    Ball, Centre, Combine, Compensate, Component, ConstantCurvature, Depend, Ellipsoid, Map, Pivot,
    Place, PortType, Product, Rotate, Translate,
};
use condyle_model::{CoordinateKind, Range, SegmentId, Source, UpAxis};

#[derive(Default)]
pub(super) struct Draft {
    pub(super) name: Option<String>,
    pub(super) up: UpAxis,
    pub(super) segments: Vec<SegmentDraft>,
    pub(super) sets: Vec<Name>,
    pub(super) coordinates: Vec<CoordinateDraft>,
    pub(super) components: Vec<ComponentDraft>,
    pub(super) outputs: Vec<OutputDraft>,
    pub(super) markers: Vec<MarkerDraft>,
    pub(super) closures: Vec<ClosureDraft>,
}

#[derive(Clone)]
pub(super) struct SegmentDraft {
    pub(super) name: Name,
    pub(super) parent: Option<Name>,
    pub(super) in_parent: Affine,
    pub(super) in_itself: Affine,
}

#[derive(Clone)]
pub(super) struct CoordinateDraft {
    pub(super) set: String,
    pub(super) name: Name,
    pub(super) kind: CoordinateKind,
    pub(super) default: [f64; 4],
    pub(super) range: Range,
    pub(super) locked: bool,
    pub(super) source: Option<String>,
    pub(super) follows: Option<Name>,
}

#[derive(Clone)]
pub(super) struct ComponentDraft {
    pub(super) set: String,
    pub(super) name: Name,
    pub(super) law: Law,
    pub(super) ports: Vec<Name>,
}

/// A component without its inputs.
#[derive(Clone)]
pub(super) enum Law {
    Map(Vec<Function>),
    Combine(FunctionOfSeveral),
    Depend { lower: Option<Function>, upper: Option<Function> },
    Rotate(Vec3),
    Pivot(Vec3, Centre),
    Translate(Vec3),
    Ball,
    Place(Affine),
    Ellipsoid(Vec3),
    ConstantCurvature { neutral: [f64; 3], length: f64 },
    Compensate { segment: Name, ancestors: Vec<Name>, weight: f64 },
    Product,
}

impl Law {
    pub(super) fn inputs(&self) -> PortType {
        match self {
            Self::Ball => PortType::Orientation,
            Self::Product => PortType::Transform,
            _ => PortType::Scalar,
        }
    }

    pub(super) fn outputs(&self) -> (PortType, usize) {
        match self {
            Self::Map(functions) => (PortType::Scalar, functions.len()),
            Self::Combine(_) | Self::Depend { .. } => (PortType::Scalar, 1),
            _ => (PortType::Transform, 1),
        }
    }

    /// The component; a sentence where its parameters make none.
    pub(super) fn build(
        self,
        sources: Vec<Source>,
        segment: &mut dyn FnMut(&Name) -> Option<SegmentId>,
    ) -> Result<Component, String> {
        Ok(match (self, &sources[..]) {
            (Self::Map(functions), &[input]) => Component::Map(Map { input, functions }),
            (Self::Combine(function), _) => {
                Component::Combine(Combine { inputs: sources, function })
            }
            (Self::Depend { lower, upper }, &[passive, driver]) => {
                Component::Depend(Depend { passive, driver, lower, upper })
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
            (Self::Ellipsoid(radii), &[x, y, z]) => {
                Component::Ellipsoid(Ellipsoid { angles: [x, y, z], radii })
            }
            (Self::ConstantCurvature { neutral, length }, &[x, z, y]) => {
                let angles = [x, z, y];
                Component::ConstantCurvature(ConstantCurvature { angles, neutral, length })
            }
            (Self::Compensate { segment: moved, ancestors, weight }, []) => {
                let unknown = || "it names no segments".to_owned();
                let moved = segment(&moved).ok_or_else(unknown)?;
                let ancestors: Vec<Option<SegmentId>> = ancestors.iter().map(segment).collect();
                let ancestors: Option<Vec<SegmentId>> = ancestors.into_iter().collect();
                let ancestors = ancestors.ok_or_else(unknown)?;
                Component::Compensate(Compensate { segment: moved, ancestors, weight })
            }
            (Self::Product, _) => Component::Product(Product { factors: sources }),
            _ => return Err("it has another number of inputs".to_owned()),
        })
    }
}

#[derive(Clone)]
pub(super) struct OutputDraft {
    pub(super) set: String,
    pub(super) segment: Name,
    pub(super) ports: Vec<Name>,
    /// Whether a list was given: the product of what it names.
    pub(super) listed: bool,
}

#[derive(Clone)]
pub(super) struct MarkerDraft {
    pub(super) name: Name,
    pub(super) segment: Option<Name>,
    pub(super) point: Vec3,
}

#[derive(Clone)]
pub(super) struct ClosureDraft {
    pub(super) name: Name,
    pub(super) condition: ConditionDraft,
}

/// A segment, or the world.
pub(super) type Holder = Option<Name>;

#[derive(Clone)]
pub(super) enum ConditionDraft {
    Points([(Holder, Vec3); 2]),
    Frames([(Holder, Affine); 2]),
    Distance([(Holder, Vec3); 2], f64),
    Coupling { follower: Name, driver: Name, function: Function },
}

impl Draft {
    /// Everything in the order of the text.
    pub(super) fn sort(&mut self) {
        let at = |name: &Name| -> Spot { name.spot };
        self.segments.sort_by_key(|s| at(&s.name));
        self.sets.sort_by_key(at);
        self.coordinates.sort_by_key(|c| at(&c.name));
        self.components.sort_by_key(|c| at(&c.name));
        self.markers.sort_by_key(|m| at(&m.name));
        self.closures.sort_by_key(|c| at(&c.name));
    }
}
