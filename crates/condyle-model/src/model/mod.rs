//! The parts of a character: segments, coordinates, joint sets, markers, closures.
//!
//! A [`Model`] is constant: it is made by a [`ModelBuilder`], which checks everything once, and is
//! then shared. Items refer to each other by typed positions (such as [`SegmentId`]); names are
//! for people and files.

mod builder;
mod check;
mod closure;
mod coordinate;
mod heading;
mod posture;
mod scaling;
mod segment;
mod shape;

pub use builder::ModelBuilder;
pub use check::{AXIS_LENGTH, CROSSING_RANGE, DEFAULT_OUTSIDE_RANGE, LOOKS_LIKE_DEGREES};
pub use closure::{Closure, Condition};
pub use coordinate::{Coordinate, CoordinateKind};
pub use posture::PostureTerm;
pub use scaling::SizeGroup;
pub use segment::Segment;
pub use shape::Shape;

pub(crate) use check::{Node, dependency_order, measured};

pub use crate::position::{ComponentId, CoordinateId, JointSetId, SegmentId};

use crate::component::{Component, PortType, Signal};
use condyle_diagnostics::{Error, Subject, nearest};
use condyle_math::{Quat, Vec3};
use std::collections::HashMap;

/// The axis of the world that points up.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum UpAxis {
    /// The second axis, as in OpenSim and glTF.
    #[default]
    Y,
    /// The third axis, as in most laboratories and in Blender.
    Z,
}

/// The axis of the world along which the character looks at rest.
///
/// It changes no pose: programs that exchange characters turn them by it. The directions are those of a world in which y is
/// up. A world in which z is up is that one turned by a quarter about x, so `PlusZ` looks against y there, as
/// Blender's figures do: [`ahead`](Self::ahead), [`name_in`](Self::name_in).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Facing {
    /// Along the first axis, as in OpenSim.
    #[default]
    PlusX,
    /// Against the first axis.
    MinusX,
    /// Along the third axis, as in glTF.
    PlusZ,
    /// Against the third axis, as in VRM 0.
    MinusZ,
}

impl Facing {
    /// All directions.
    pub const ALL: [Self; 4] = [Self::PlusX, Self::MinusX, Self::PlusZ, Self::MinusZ];

    /// The word for it in files.
    pub fn name(self) -> &'static str {
        match self {
            Self::PlusX => "+x",
            Self::MinusX => "-x",
            Self::PlusZ => "+z",
            Self::MinusZ => "-z",
        }
    }

    /// The direction of that name.
    ///
    /// ```
    /// use condyle_model::model::Facing;
    /// assert_eq!(Facing::named("-z"), Some(Facing::MinusZ));
    /// assert_eq!(Facing::named("z"), None);
    /// ```
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|facing| facing.name() == name)
    }

    /// The word for it in a world in which `up` is up: the axis that is meant.
    pub fn name_in(self, up: UpAxis) -> &'static str {
        match (up, self) {
            (UpAxis::Z, Self::PlusZ) => "-y",
            (UpAxis::Z, Self::MinusZ) => "+y",
            _ => self.name(),
        }
    }

    /// The direction of that name in a world in which `up` is up; where that is z the names of one with y up are known, too.
    ///
    /// ```
    /// use condyle_model::model::{Facing, UpAxis};
    /// assert_eq!(Facing::named_in("-y", UpAxis::Z), Some(Facing::PlusZ));
    /// assert_eq!(Facing::named_in("+z", UpAxis::Z), Some(Facing::PlusZ));
    /// assert_eq!(Facing::named_in("-y", UpAxis::Y), None);
    /// ```
    pub fn named_in(name: &str, up: UpAxis) -> Option<Self> {
        let own = Self::ALL.into_iter().find(|facing| facing.name_in(up) == name);
        own.or_else(|| Self::named(name))
    }

    /// The direction in a world in which `up` is up, as a vector of length 1.
    ///
    /// ```
    /// use condyle_math::Vec3;
    /// use condyle_model::model::{Facing, UpAxis};
    /// assert_eq!(Facing::MinusX.ahead(UpAxis::Z), -Vec3::X);
    /// assert_eq!(Facing::PlusZ.ahead(UpAxis::Y), Vec3::Z);
    /// assert_eq!(Facing::PlusZ.ahead(UpAxis::Z), -Vec3::Y);
    /// ```
    pub fn ahead(self, up: UpAxis) -> Vec3 {
        match (up, self) {
            (UpAxis::Z, Self::PlusZ) => -Vec3::Y,
            (UpAxis::Z, Self::MinusZ) => Vec3::Y,
            _ => self.direction(),
        }
    }

    /// The direction in a world in which y is up, as a vector of length 1.
    pub fn direction(self) -> Vec3 {
        match self {
            Self::PlusX => Vec3::X,
            Self::MinusX => -Vec3::X,
            Self::PlusZ => Vec3::Z,
            Self::MinusZ => -Vec3::Z,
        }
    }
}

/// A few coordinates and the network of components that computes motions from them.
#[derive(Clone, Debug, PartialEq)]
pub struct JointSet {
    /// Its name, unique in the model.
    pub name: String,
}

/// A point fixed in a segment whose position is recorded.
#[derive(Clone, Debug, PartialEq)]
pub struct Marker {
    /// Its name.
    pub name: String,
    /// The segment it is fixed in; `None` for the world.
    pub segment: Option<SegmentId>,
    /// Its place in the segment, in metres.
    pub point: Vec3,
    /// The marker whose place it has, where it is another name for that.
    pub like: Option<String>,
}

/// A character, checked and constant.
#[derive(Clone, Debug, PartialEq)]
pub struct Model {
    pub(crate) name: String,
    pub(crate) up: UpAxis,
    pub(crate) facing: Facing,
    pub(crate) segments: Vec<Segment>,
    pub(crate) coordinates: Vec<Coordinate>,
    pub(crate) joint_sets: Vec<JointSet>,
    pub(crate) components: Vec<Component>,
    pub(crate) markers: Vec<Marker>,
    pub(crate) shapes: Vec<Shape>,
    pub(crate) closures: Vec<Closure>,
    pub(crate) postures: Vec<PostureTerm>,
    pub(crate) size_groups: Vec<SizeGroup>,
    /// Where each coordinate's stored numbers begin; one more for the end.
    pub(crate) stored_offsets: Vec<u32>,
    /// Where each coordinate's directions begin; one more for the end.
    pub(crate) tangent_offsets: Vec<u32>,
}

impl Model {
    /// The model's name.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Gives the model another name, which no part of it depends on.
    pub fn set_name(&mut self, name: &str) {
        name.clone_into(&mut self.name);
    }

    /// The axis of the world that points up.
    pub fn up(&self) -> UpAxis {
        self.up
    }

    /// The axis of the world along which the character looks at rest.
    pub fn facing(&self) -> Facing {
        self.facing
    }

    /// All segments, in the order in which they were made.
    pub fn segments(&self) -> &[Segment] {
        &self.segments
    }

    /// All coordinates.
    pub fn coordinates(&self) -> &[Coordinate] {
        &self.coordinates
    }

    /// All joint sets.
    pub fn joint_sets(&self) -> &[JointSet] {
        &self.joint_sets
    }

    /// All components.
    pub fn components(&self) -> &[Component] {
        &self.components
    }

    /// All markers.
    pub fn markers(&self) -> &[Marker] {
        &self.markers
    }

    /// What its bones look like; none where it does not say.
    pub fn shapes(&self) -> &[Shape] {
        &self.shapes
    }

    /// All closures.
    pub fn closures(&self) -> &[Closure] {
        &self.closures
    }

    /// The positions of all coordinates.
    pub fn coordinate_ids(
        &self,
    ) -> impl ExactSizeIterator<Item = CoordinateId> + DoubleEndedIterator + use<> {
        (0..self.coordinates.len() as u32).map(CoordinateId)
    }

    /// The positions of all components.
    pub fn component_ids(&self) -> impl ExactSizeIterator<Item = ComponentId> + use<> {
        (0..self.components.len() as u32).map(ComponentId)
    }

    /// The positions of all segments.
    pub fn segment_ids(
        &self,
    ) -> impl ExactSizeIterator<Item = SegmentId> + DoubleEndedIterator + use<> {
        (0..self.segments.len() as u32).map(SegmentId)
    }

    /// The positions of all segments, every parent before its children.
    pub fn parents_first(&self) -> Vec<SegmentId> {
        let mut placed = vec![false; self.segments.len()];
        let mut order = Vec::with_capacity(placed.len());
        for start in self.segment_ids() {
            let mut path = vec![];
            let mut here = Some(start);
            while let Some(id) = here
                && !placed[id.index()]
            {
                placed[id.index()] = true;
                path.push(id);
                here = self.segment(id).parent;
            }
            order.extend(path.into_iter().rev());
        }
        order
    }

    /// A coordinate.
    pub fn coordinate(&self, id: CoordinateId) -> &Coordinate {
        &self.coordinates[id.index()]
    }

    /// A segment.
    pub fn segment(&self, id: SegmentId) -> &Segment {
        &self.segments[id.index()]
    }

    /// How many numbers all coordinates store together.
    pub fn stored_len(&self) -> usize {
        self.stored_offsets.last().map_or(0, |&n| n as usize)
    }

    /// The total number of directions of all coordinates.
    pub fn tangent_len(&self) -> usize {
        self.tangent_offsets.last().map_or(0, |&n| n as usize)
    }

    /// The positions of a coordinate's numbers among all stored ones.
    pub fn stored_range(&self, id: CoordinateId) -> std::ops::Range<usize> {
        self.stored_offsets[id.index()] as usize..self.stored_offsets[id.index() + 1] as usize
    }

    /// The positions of a coordinate's directions among all.
    pub fn tangent_range(&self, id: CoordinateId) -> std::ops::Range<usize> {
        self.tangent_offsets[id.index()] as usize..self.tangent_offsets[id.index() + 1] as usize
    }

    /// The value of a coordinate of one number among all stored ones; of an orientation its x.
    ///
    /// # Panics
    /// If `stored` has fewer than [`Model::stored_len`] numbers.
    pub fn value(&self, stored: &[f64], id: CoordinateId) -> f64 {
        stored[self.stored_offsets[id.index()] as usize]
    }

    /// The same, to be changed in place.
    ///
    /// # Panics
    /// If `stored` has fewer than [`Model::stored_len`] numbers.
    pub fn value_mut<'s>(&self, stored: &'s mut [f64], id: CoordinateId) -> &'s mut f64 {
        &mut stored[self.stored_offsets[id.index()] as usize]
    }

    /// The stored numbers of all coordinates at their defaults.
    pub fn defaults(&self) -> Vec<f64> {
        self.coordinates.iter().flat_map(|c| c.default[..c.kind.stored()].iter().copied()).collect()
    }

    /// Interpolates between two sets of stored numbers: linearly for single numbers, along the
    /// shortest arc for orientations. How a joint interpolates depends on its coordinates only.
    ///
    /// `share` runs from 0 (`from`) to 1 (`to`); all slices have [`Model::stored_len`] numbers.
    ///
    /// # Panics
    /// If a slice is too short.
    pub fn interpolate(&self, from: &[f64], to: &[f64], share: f64, between: &mut [f64]) {
        for id in self.coordinate_ids() {
            let place = self.stored_range(id);
            if place.len() == 1 {
                let (a, b) = (from[place.start], to[place.start]);
                between[place.start] = a + (b - a) * share;
                continue;
            }
            let [a, b] = [from, to].map(|list| {
                let q: [f64; 4] = std::array::from_fn(|i| list[place.start + i]);
                Quat::from_mat3(Quat::from(q).to_mat3())
            });
            let turn = (a.conjugate() * b).to_mat3().log();
            let turned = (a * Quat::exp(turn * share)).normalized();
            between[place].copy_from_slice(&turned.to_array());
        }
    }

    /// Moves coordinates along their directions: q + d, or q·exp(d) for an orientation.
    ///
    /// `stored` and `moved` have [`Model::stored_len`] numbers, `step` [`Model::tangent_len`].
    ///
    /// # Panics
    /// If a slice is too short.
    pub fn retract(&self, stored: &[f64], step: &[f64], moved: &mut [f64]) {
        for id in self.coordinate_ids() {
            let (from, along) = (self.stored_range(id), self.tangent_range(id));
            if from.len() == 1 {
                moved[from.start] = stored[from.start] + step[along.start];
                continue;
            }
            let q: [f64; 4] = std::array::from_fn(|i| stored[from.start + i]);
            let turn: [f64; 3] = std::array::from_fn(|i| step[along.start + i]);
            let turned = Quat::from(q) * Quat::exp(Vec3::from(turn));
            moved[from].copy_from_slice(&turned.normalized().to_array());
        }
    }

    /// The coordinates of a joint set.
    pub fn coordinates_of(&self, set: JointSetId) -> impl Iterator<Item = CoordinateId> {
        self.coordinate_ids().filter(move |&id| self.coordinate(id).joint_set == set)
    }

    /// The components of a joint set.
    pub fn components_of(&self, set: JointSetId) -> impl Iterator<Item = ComponentId> {
        self.component_ids().filter(move |&id| self.components[id.index()].joint_set == set)
    }

    /// The outputs of a joint set: the segments that it moves, each with its transform.
    pub fn outputs_of(&self, set: JointSetId) -> impl Iterator<Item = (SegmentId, Signal)> {
        self.segment_ids().filter_map(move |id| {
            let segment = self.segment(id);
            Some((id, segment.motion?)).filter(|_| segment.joint_set == Some(set))
        })
    }

    /// The positions of all joint sets.
    pub fn joint_set_ids(&self) -> impl ExactSizeIterator<Item = JointSetId> + use<> {
        (0..self.joint_sets.len() as u32).map(JointSetId)
    }

    /// The model with these coordinates locked at their defaults.
    #[must_use]
    pub fn with_locked(&self, ids: impl IntoIterator<Item = CoordinateId>) -> Self {
        let mut model = self.clone();
        for id in ids {
            if let Some(coordinate) = model.coordinates.get_mut(id.index()) {
                coordinate.locked = true;
            }
        }
        model
    }

    /// The model without its loops.
    #[must_use]
    pub fn without_closures(&self) -> Self {
        Self { closures: vec![], ..self.clone() }
    }

    /// The model whose learned limits allow no orientation that nobody was recorded in.
    #[must_use]
    pub fn with_strict_limits(&self) -> Self {
        let mut model = self.clone();
        for component in &mut model.components {
            if let crate::component::Law::Field(field) = &mut component.law {
                field.strict = true;
            }
        }
        model
    }

    /// Everything that a component reads: the values at its ports, and the motions between the
    /// segments there.
    pub fn reads(&self, id: ComponentId) -> Vec<Signal> {
        let component = &self.components[id.index()];
        let between = self.between(component).into_iter();
        between
            .filter_map(|segment| self.segment(segment).motion)
            .chain(component.values())
            .collect()
    }

    /// The order of evaluation: coordinates that follow others, and components by their first outputs,
    /// each after all that it reads.
    pub fn evaluation_order(&self) -> Vec<Signal> {
        let order = dependency_order(self).unwrap_or_default();
        let signal = |node: Node| match node {
            Node::Coordinate(id) => {
                self.coordinate(id).follows.is_some().then_some(Signal::Coordinate(id))
            }
            Node::Component(id) => Some(Signal::Output(id, 0)),
        };
        order.into_iter().filter_map(signal).collect()
    }

    /// The components that nothing uses: no segment, coordinate or limit depends on them. A limit on what is
    /// measured between segments is used by itself; other limits only where something reads what they let
    /// through.
    pub fn unused_components(&self) -> Vec<ComponentId> {
        let measured = measured(self, &dependency_order(self).unwrap_or_default());
        let mut used = vec![false; self.components.len()];
        let bounds =
            |id: &ComponentId| measured[id.index()] && self.components[id.index()].law.bounds();
        let limits = self.component_ids().filter(bounds).map(|id| Signal::Output(id, 0));
        let motions = self.segments.iter().filter_map(|segment| segment.motion);
        let leaders = self.coordinates.iter().filter_map(|coordinate| coordinate.follows);
        let mut open: Vec<Signal> = motions.chain(leaders).chain(limits).collect();
        while let Some(signal) = open.pop() {
            if let Signal::Output(id, _) = signal
                && !std::mem::replace(&mut used[id.index()], true)
            {
                open.extend(self.reads(id));
            }
        }
        self.component_ids().filter(|id| !used[id.index()]).collect()
    }

    /// The segments whose motions move the places at a component's ports against each other, those
    /// of each place from the root outwards.
    pub(crate) fn between(&self, component: &Component) -> Vec<SegmentId> {
        let mut paths: Vec<Vec<SegmentId>> = component
            .ports()
            .filter_map(|(port, signal)| {
                let id = signal.segment()?;
                let end =
                    if port.takes == PortType::Joint { self.segment(id).parent } else { Some(id) };
                Some(self.path_to(end))
            })
            .collect();
        // A segment that may be given and is not is the world.
        let mut ports = component.law.kind().ports.iter();
        if ports.any(|port| port.takes == PortType::Segment && !component.law.has(port)) {
            paths.push(vec![]);
        }
        let Some((first, others)) = paths.split_first() else { return vec![] };
        let shared =
            |path: &Vec<SegmentId>| first.iter().zip(path).take_while(|(a, b)| a == b).count();
        let common = others.iter().map(shared).min().unwrap_or(first.len());
        let mut between = vec![];
        for id in paths.iter().flat_map(|path| &path[common..]) {
            if !between.contains(id) {
                between.push(*id);
            }
        }
        between
    }

    /// A segment and those that it hangs from, outwards in.
    pub fn path_to_root(&self, segment: SegmentId) -> impl Iterator<Item = SegmentId> + '_ {
        let up = |&id: &SegmentId| self.segment(id).parent;
        std::iter::successors(Some(segment), up).take(self.segments.len())
    }

    /// The segments from the root to a segment, both included; none for the world.
    pub(crate) fn path_to(&self, segment: Option<SegmentId>) -> Vec<SegmentId> {
        let mut path = vec![];
        let mut here = segment;
        // A cycle of parents is reported elsewhere; here the loop only has to end.
        while let Some(id) = here
            && path.len() < self.segments.len()
        {
            path.push(id);
            here = self.segment(id).parent;
        }
        path.reverse();
        path
    }

    /// The key of a coordinate in files: its bare name where that is unique, else `joint/name`.
    pub fn coordinate_key(&self, id: CoordinateId) -> String {
        let coordinate = self.coordinate(id);
        let twins = self.coordinates.iter().filter(|c| c.name == coordinate.name).count();
        if twins == 1 {
            coordinate.name.clone()
        } else {
            format!("{}/{}", self.joint_sets[coordinate.joint_set.index()].name, coordinate.name)
        }
    }

    /// The keys of all coordinates, as [`Model::coordinate_key`] gives them.
    pub fn coordinate_keys(&self) -> Vec<String> {
        let mut count: HashMap<&str, usize> = HashMap::new();
        self.coordinates.iter().for_each(|c| *count.entry(&c.name).or_default() += 1);
        let key = |c: &Coordinate| match count[c.name.as_str()] {
            1 => c.name.clone(),
            _ => format!("{}/{}", self.joint_sets[c.joint_set.index()].name, c.name),
        };
        self.coordinates.iter().map(key).collect()
    }

    /// A component as a subject of diagnostics.
    pub fn component_subject(&self, component: &Component) -> Subject {
        Subject::component(&self.joint_sets[component.joint_set.index()].name, &component.name)
    }

    /// The segment of that name.
    ///
    /// # Errors
    /// An error with the nearest name that exists.
    pub fn find_segment(&self, name: &str) -> Result<SegmentId, Error> {
        match self.segments.iter().position(|s| s.name == name) {
            Some(index) => Ok(SegmentId(index as u32)),
            None => Err(unknown("segment", name, self.segments.iter().map(|s| s.name.clone()))),
        }
    }

    /// The coordinate with that key: a bare name where it is unique, or `joint/name`.
    ///
    /// # Errors
    /// An error with the nearest key that exists or with all that the name could mean.
    pub fn find_coordinate(&self, key: &str) -> Result<CoordinateId, Error> {
        let full =
            |c: &Coordinate| format!("{}/{}", self.joint_sets[c.joint_set.index()].name, c.name);
        let hits: Vec<CoordinateId> = self
            .coordinate_ids()
            .filter(|&id| self.coordinate(id).name == key || full(self.coordinate(id)) == key)
            .collect();
        match hits[..] {
            [id] => Ok(id),
            [] => Err(unknown("coordinate", key, self.coordinate_keys().into_iter())),
            _ => {
                let names: Vec<String> = hits.iter().map(|&id| full(self.coordinate(id))).collect();
                let message = format!(
                    "the coordinate name `{key}` is ambiguous: it could be `{}`",
                    names.join("`, `")
                );
                Err(Error::new("model/ambiguous-name", message))
            }
        }
    }
}

fn unknown(what: &str, name: &str, existing: impl Iterator<Item = String>) -> Error {
    let existing: Vec<String> = existing.collect();
    let help = match nearest(name, existing.iter().map(String::as_str)) {
        Some(near) => format!("did you mean `{near}`?"),
        None => String::new(),
    };
    Error::new("model/unknown-name", format!("unknown {what} `{name}`")).with_help(help)
}
