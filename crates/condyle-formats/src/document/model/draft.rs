//! A model as written: numbers are read, names are not resolved yet.

use crate::document::texts::{Name, Spot};
use condyle_math::function::Function;
use condyle_math::{Affine, Vec3};
use condyle_mesh::{Finish, Form};
use condyle_model::model::Facing;
use condyle_model::{CoordinateKind, Law, Range, UpAxis};
use std::collections::HashSet;

#[derive(Default)]
pub(super) struct Draft {
    pub(super) name: Option<String>,
    pub(super) up: UpAxis,
    pub(super) facing: Facing,
    pub(super) segments: Vec<SegmentDraft>,
    pub(super) sets: Vec<Name>,
    /// Those of them that are plain joints.
    pub(super) plain: HashSet<String>,
    pub(super) coordinates: Vec<CoordinateDraft>,
    pub(super) components: Vec<ComponentDraft>,
    pub(super) outputs: Vec<OutputDraft>,
    pub(super) markers: Vec<MarkerDraft>,
    pub(super) shapes: Vec<ShapeDraft>,
    pub(super) closures: Vec<ClosureDraft>,
    pub(super) postures: Vec<PostureDraft>,
    pub(super) sizes: Vec<SizeDraft>,
    /// Components that could not be read, by joint set and name; whole joints have an empty name.
    pub(super) broken: HashSet<(String, String)>,
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
    /// Its own table, where it has one; the name may be that of its joint.
    pub(super) table: Spot,
    pub(super) kind: CoordinateKind,
    pub(super) default: [f64; 4],
    pub(super) range: Range,
    pub(super) typical: Option<[f64; 2]>,
    pub(super) locked: bool,
    pub(super) drives: Option<String>,
    pub(super) source: Option<String>,
    pub(super) follows: Option<Name>,
    /// Its value at rest and its stiffness, if it has one.
    pub(super) held: Option<[f64; 2]>,
}

impl CoordinateDraft {
    /// A free coordinate at its neutral value.
    pub(super) fn new(set: &str, name: Name, kind: CoordinateKind) -> Self {
        let (set, default, range) = (set.to_owned(), kind.neutral(), Range::FREE);
        let table = name.spot;
        Self {
            set,
            name,
            table,
            kind,
            default,
            range,
            typical: None,
            locked: false,
            drives: None,
            source: None,
            follows: None,
            held: None,
        }
    }
}

#[derive(Clone)]
pub(super) struct ComponentDraft {
    pub(super) set: String,
    pub(super) name: Name,
    pub(super) law: Law,
    /// The names at its ports, in the order of [`Law::ports`].
    pub(super) ports: Vec<Name>,
}

#[derive(Clone)]
pub(super) struct OutputDraft {
    pub(super) set: String,
    pub(super) segment: Name,
    pub(super) ports: Vec<Name>,
    /// Whether a list was given, which makes a product.
    pub(super) listed: bool,
}

#[derive(Clone)]
pub(super) struct MarkerDraft {
    pub(super) name: Name,
    pub(super) place: PlaceDraft,
}

#[derive(Clone)]
pub(super) enum PlaceDraft {
    /// A point of a segment, or of the world.
    Point(Holder, Vec3),
    /// From the place of another marker, in the axes of its segment.
    Marker(Name, Vec3),
}

#[derive(Clone)]
pub(super) struct ShapeDraft {
    pub(super) name: Name,
    pub(super) segment: Name,
    pub(super) form: Form,
    pub(super) finish: Finish,
    pub(super) until: Option<PlaceDraft>,
}

#[derive(Clone)]
pub(super) struct ClosureDraft {
    pub(super) name: Name,
    pub(super) condition: ConditionDraft,
}

#[derive(Clone)]
pub(super) struct PostureDraft {
    pub(super) name: Name,
    pub(super) sum: Vec<(Name, f64)>,
    pub(super) rest: f64,
    /// The unit of `rest` where all coordinates are angles.
    pub(super) angle_unit: f64,
    pub(super) stiffness: f64,
    pub(super) source: Option<String>,
}

#[derive(Clone)]
pub(super) struct SizeDraft {
    pub(super) name: Name,
    pub(super) segments: Vec<Name>,
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
    /// Sorts everything by its place in the text.
    pub(super) fn sort(&mut self) {
        let at = |name: &Name| -> Spot { name.spot };
        self.segments.sort_by_key(|s| at(&s.name));
        self.sets.sort_by_key(at);
        self.coordinates.sort_by_key(|c| at(&c.name));
        self.components.sort_by_key(|c| at(&c.name));
        self.markers.sort_by_key(|m| at(&m.name));
        self.shapes.sort_by_key(|s| at(&s.name));
        self.closures.sort_by_key(|c| at(&c.name));
        self.postures.sort_by_key(|p| at(&p.name));
        self.sizes.sort_by_key(|s| at(&s.name));
    }
}
