//! Making a model step by step.

use super::check;
use super::posture;
use super::scaling;
use super::{
    Closure, ComponentId, Coordinate, CoordinateId, CoordinateKind, Facing, JointSet, JointSetId,
    Marker, Model, PostureTerm, Segment, SegmentId, Shape, SizeGroup, UpAxis,
};
use crate::component::{
    Ball, Combine, Compensate, Component, ConstantCurvature, Depend, Ellipsoid, Law, Map, Pivot,
    Place, Product, Rotate, Signal, SurfaceAxis, Translate, unit,
};
use crate::limit::Range;
use condyle_diagnostics::{Error, Read, Severity};
use condyle_math::function::{Function, FunctionOfSeveral};
use condyle_math::{Affine, Vec3};

/// A model under construction.
///
/// Every method adds one thing and returns its position, to be used by the next; nothing is checked
/// before [`ModelBuilder::build`], which reports everything that is wrong at once.
#[derive(Clone, Debug)]
pub struct ModelBuilder {
    model: Model,
}

impl From<Model> for ModelBuilder {
    /// A model to which more is added, or in which something is changed; it is checked again as a whole.
    fn from(model: Model) -> Self {
        Self { model: Model { stored_offsets: vec![], tangent_offsets: vec![], ..model } }
    }
}

impl ModelBuilder {
    /// An empty model with y up.
    pub fn new(name: &str) -> Self {
        Self {
            model: Model {
                name: name.to_owned(),
                up: UpAxis::Y,
                facing: Facing::PlusX,
                segments: vec![],
                coordinates: vec![],
                joint_sets: vec![],
                components: vec![],
                markers: vec![],
                shapes: vec![],
                closures: vec![],
                postures: vec![],
                size_groups: vec![],
                stored_offsets: vec![],
                tangent_offsets: vec![],
            },
        }
    }

    /// Sets the axis of the world that points up.
    pub fn up(&mut self, up: UpAxis) {
        self.model.up = up;
    }

    /// Sets the axis of the world along which the character looks at rest; +x where it is not set.
    pub fn facing(&mut self, facing: Facing) {
        self.model.facing = facing;
    }

    /// A segment, welded to its parent (or to the world) at its own origin until that is changed.
    pub fn segment(&mut self, name: &str, parent: Option<SegmentId>) -> SegmentId {
        self.model.segments.push(Segment {
            name: name.to_owned(),
            parent,
            joint_in_parent: Affine::IDENTITY,
            joint_in_segment: Affine::IDENTITY,
            motion: None,
            joint_set: None,
        });
        SegmentId(self.model.segments.len() as u32 - 1)
    }

    /// Attaches a segment to another parent, which may have been added after it.
    pub fn set_parent(&mut self, segment: SegmentId, parent: Option<SegmentId>) {
        self.model.segments[segment.index()].parent = parent;
    }

    /// Puts the segment's joint, and its own origin, at a point of its parent (metres).
    pub fn place_joint(&mut self, segment: SegmentId, point_in_parent: Vec3) {
        self.place_joint_frames(
            segment,
            Affine::from_translation(point_in_parent),
            Affine::IDENTITY,
        );
    }

    /// Sets both ends of the segment's joint: the frame in its parent and the frame in itself.
    pub fn place_joint_frames(
        &mut self,
        segment: SegmentId,
        joint_in_parent: Affine,
        joint_in_segment: Affine,
    ) {
        let segment = &mut self.model.segments[segment.index()];
        segment.joint_in_parent = joint_in_parent;
        segment.joint_in_segment = joint_in_segment;
    }

    /// An empty joint set.
    pub fn joint_set(&mut self, name: &str) -> JointSetId {
        self.model.joint_sets.push(JointSet { name: name.to_owned() });
        JointSetId(self.model.joint_sets.len() as u32 - 1)
    }

    /// A coordinate without limits at its neutral value: the identity, 1 for a scale, or 0.
    pub fn coordinate(
        &mut self,
        set: JointSetId,
        name: &str,
        kind: CoordinateKind,
    ) -> CoordinateId {
        self.model.coordinates.push(Coordinate {
            name: name.to_owned(),
            joint_set: set,
            kind,
            default: kind.neutral(),
            range: Range::FREE,
            typical: None,
            locked: false,
            follows: None,
            drives: None,
            source: None,
        });
        CoordinateId(self.model.coordinates.len() as u32 - 1)
    }

    /// A coordinate, to be changed in place.
    pub fn coordinate_mut(&mut self, id: CoordinateId) -> &mut Coordinate {
        &mut self.model.coordinates[id.index()]
    }

    /// The coordinates made so far.
    pub fn coordinates(&self) -> &[Coordinate] {
        &self.model.coordinates
    }

    /// The position of the coordinate that was made as number `index`, counted from 0.
    pub fn coordinate_at(&self, index: usize) -> Option<CoordinateId> {
        (index < self.model.coordinates.len()).then_some(CoordinateId(index as u32))
    }

    /// The position of the segment that was made as number `index`, counted from 0.
    pub fn segment_at(&self, index: usize) -> Option<SegmentId> {
        (index < self.model.segments.len()).then_some(SegmentId(index as u32))
    }

    /// A component: a law with its inputs, in the order of its ports. Its first output is returned.
    pub fn component(
        &mut self,
        set: JointSetId,
        name: &str,
        law: Law,
        inputs: Vec<Signal>,
    ) -> Signal {
        let (name, joint_set) = (name.to_owned(), set);
        self.model.components.push(Component { name, joint_set, law, inputs });
        Signal::Output(ComponentId(self.model.components.len() as u32 - 1), 0)
    }

    /// A component that was made before, to be changed in place: for networks whose components are
    /// read in any order.
    pub fn component_mut(&mut self, id: ComponentId) -> &mut Component {
        &mut self.model.components[id.index()]
    }

    /// A function of a scalar.
    pub fn map(
        &mut self,
        set: JointSetId,
        name: &str,
        input: impl Into<Signal>,
        function: Function,
    ) -> Signal {
        let map = Map { functions: vec![function] };
        self.component(set, name, Law::Map(map), vec![input.into()])
    }

    /// A function of several scalars.
    pub fn combine(
        &mut self,
        set: JointSetId,
        name: &str,
        inputs: Vec<Signal>,
        function: FunctionOfSeveral,
    ) -> Signal {
        self.component(set, name, Law::Combine(Combine { function }), inputs)
    }

    /// A `passive` scalar held between bounds that a `driver` sets.
    pub fn depend(
        &mut self,
        set: JointSetId,
        name: &str,
        passive: impl Into<Signal>,
        driver: impl Into<Signal>,
        depend: Depend,
    ) -> Signal {
        self.component(set, name, Law::Depend(depend), vec![passive.into(), driver.into()])
    }

    /// A rotation about a fixed axis.
    pub fn rotate(
        &mut self,
        set: JointSetId,
        name: &str,
        angle: impl Into<Signal>,
        axis: Vec3,
    ) -> Signal {
        self.component(set, name, Law::Rotate(Rotate { axis }), vec![angle.into()])
    }

    /// A rotation about an axis whose centre moves.
    pub fn pivot(
        &mut self,
        set: JointSetId,
        name: &str,
        angle: impl Into<Signal>,
        pivot: Pivot,
    ) -> Signal {
        self.component(set, name, Law::Pivot(pivot), vec![angle.into()])
    }

    /// A translation along a fixed axis.
    pub fn translate(
        &mut self,
        set: JointSetId,
        name: &str,
        distance: impl Into<Signal>,
        axis: Vec3,
    ) -> Signal {
        self.component(set, name, Law::Translate(Translate { axis }), vec![distance.into()])
    }

    /// A rotation by an orientation coordinate.
    pub fn ball(&mut self, set: JointSetId, name: &str, orientation: CoordinateId) -> Signal {
        self.component(set, name, Law::Ball(Ball), vec![orientation.into()])
    }

    /// A fixed transform.
    pub fn place(&mut self, set: JointSetId, name: &str, child_in_parent: Affine) -> Signal {
        self.component(set, name, Law::Place(Place { child_in_parent }), vec![])
    }

    /// A frame that glides on an ellipsoid with these semi-axes (metres), as in OpenSim.
    pub fn ellipsoid(
        &mut self,
        set: JointSetId,
        name: &str,
        angles: [Signal; 3],
        radii: Vec3,
    ) -> Signal {
        let law = Law::Ellipsoid(Ellipsoid { radii, axis: SurfaceAxis::OpenSim });
        self.component(set, name, law, angles.to_vec())
    }

    /// The end of an arc of constant curvature, bent about x, z and y.
    pub fn constant_curvature(
        &mut self,
        set: JointSetId,
        name: &str,
        angles: [Signal; 3],
        column: ConstantCurvature,
    ) -> Signal {
        self.component(set, name, Law::ConstantCurvature(column), angles.to_vec())
    }

    /// The rotation that undoes the fraction `weight` of what ancestors did, for the joint of a
    /// segment.
    pub fn compensate(
        &mut self,
        set: JointSetId,
        name: &str,
        segment: SegmentId,
        ancestors: &[SegmentId],
        weight: f64,
    ) -> Signal {
        let inputs = [segment].iter().chain(ancestors).map(|&id| id.into()).collect();
        self.component(set, name, Law::Compensate(Compensate { weight }), inputs)
    }

    /// A product of transforms, the factor nearest to the parent first.
    pub fn product(&mut self, set: JointSetId, name: &str, factors: Vec<Signal>) -> Signal {
        self.component(set, name, Law::Product(Product), factors)
    }

    /// Makes a coordinate follow a scalar instead of what is asked for it.
    pub fn follow(&mut self, coordinate: CoordinateId, leader: Signal) {
        self.model.coordinates[coordinate.index()].follows = Some(leader);
    }

    /// Lets a transform of a joint set move a segment.
    pub fn output(&mut self, set: JointSetId, segment: SegmentId, motion: Signal) {
        let segment = &mut self.model.segments[segment.index()];
        segment.motion = Some(motion);
        segment.joint_set = Some(set);
    }

    /// A joint set of one hinge that moves `segment`: its name, and that of its angle.
    pub fn hinge(
        &mut self,
        name: &str,
        segment: SegmentId,
        coordinate: &str,
        axis: Vec3,
    ) -> (JointSetId, CoordinateId) {
        let set = self.joint_set(name);
        let angle = self.coordinate(set, coordinate, CoordinateKind::Rotation);
        let turn = self.rotate(set, coordinate, angle, axis);
        self.output(set, segment, turn);
        (set, angle)
    }

    /// A joint set of one quaternion ball that moves `segment`.
    pub fn ball_joint(&mut self, name: &str, segment: SegmentId) -> (JointSetId, CoordinateId) {
        let set = self.joint_set(name);
        let orientation = self.coordinate(set, "orientation", CoordinateKind::Orientation);
        let turn = self.ball(set, "ball", orientation);
        self.output(set, segment, turn);
        (set, orientation)
    }

    /// A marker at a point of a segment (metres).
    pub fn marker(&mut self, name: &str, segment: Option<SegmentId>, point: Vec3) {
        self.model.markers.push(Marker { name: name.to_owned(), segment, point, like: None });
    }

    /// Another name for the place of a marker that stands, or will stand, at this point of a segment.
    pub fn marker_like(&mut self, name: &str, like: &str, segment: Option<SegmentId>, point: Vec3) {
        let like = Some(like.to_owned());
        self.model.markers.push(Marker { name: name.to_owned(), segment, point, like });
    }

    /// What a bone looks like.
    pub fn shape(&mut self, shape: Shape) {
        self.model.shapes.push(shape);
    }

    /// A loop that tracking closes.
    pub fn closure(&mut self, closure: Closure) {
        self.model.closures.push(closure);
    }

    /// A coordinate, or a sum of several, that is held near a value where nothing else determines it.
    pub fn posture(&mut self, posture: PostureTerm) {
        self.model.postures.push(posture);
    }

    /// Segments with a common factor when the model is scaled; a segment is in one group at most.
    pub fn size_group(&mut self, name: &str, segments: Vec<SegmentId>) {
        self.model.size_groups.push(SizeGroup { name: name.to_owned(), segments });
    }

    /// Checks everything and freezes the model.
    ///
    /// # Errors
    /// Everything that was found, errors first; at least one of the diagnostics is an error.
    pub fn build(self) -> Result<Model, Error> {
        self.build_with_warnings().map(|read| read.value)
    }

    /// As [`ModelBuilder::build`], with the warnings beside the model.
    ///
    /// # Errors
    /// Everything that was found, errors first; at least one of the diagnostics is an error.
    pub fn build_with_warnings(mut self) -> Result<Read<Model>, Error> {
        let mut findings = check::check(&self.model);
        findings.extend(scaling::check_groups(&self.model));
        findings.extend(posture::check_postures(&self.model));
        findings.sort_by_key(|f| std::cmp::Reverse(f.severity));
        let broken = findings.first().is_some_and(|f| f.severity == Severity::Error);
        let warnings = match Error::of(findings) {
            Some(error) if broken => return Err(error.contradiction()),
            warnings => warnings.map(Error::into_diagnostics).unwrap_or_default(),
        };
        for component in &mut self.model.components {
            for (_, direction) in component.law.directions() {
                *direction = unit(*direction);
            }
        }
        let (mut stored, mut tangent) = (0u32, 0u32);
        self.model.stored_offsets.push(0);
        self.model.tangent_offsets.push(0);
        for coordinate in &self.model.coordinates {
            stored += coordinate.kind.stored() as u32;
            tangent += coordinate.kind.tangent() as u32;
            self.model.stored_offsets.push(stored);
            self.model.tangent_offsets.push(tangent);
        }
        Ok(Read { value: self.model, warnings })
    }
}
