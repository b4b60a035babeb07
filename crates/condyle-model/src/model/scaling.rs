//! Scaling of a model: every length fixed in a bone is scaled with that bone.
//!
//! With three factors for each segment along its axes, S = diag(f), 1 for the world:
//!
//! ```text
//! joint in the parent      S(parent) · translation
//! joint in the segment     S(segment) · translation
//! marker, end of a loop    S(its segment) · point
//! shape                    S(its segment) · points, |S a| · length along a
//! length inside a joint    the same with Rᵀ S(parent) R, R the joint's frame in the parent
//! translation along a      |S a| · distance, along S a/|S a|
//! ```
//!
//! Angles, other directions and everything without a unit are unchanged. A length without a direction, such as the thickness of a
//! plate, a gap or a distance of a loop, is multiplied by the mean of the three. Lengths after a rotation of the joint are scaled as where
//! the joint does not turn: with unequal factors a bone is stretched in its own rest, not in the laboratory. So with one factor for all
//! segments, the distance of every point from the root is multiplied by it, and no rotation changes.
//!
//! Lengths inside a joint are the places of [`Place`](crate::component::Place), the centres of
//! [`Pivot`](crate::component::Pivot)s, semi-axes and arcs, and what a [`Map`](crate::component::Map) or a
//! [`Combine`](crate::component::Combine) passes to a [`Translate`](crate::component::Translate). A
//! component that moves several segments is scaled with the parent of the first of them. A contact
//! has two bones: its points are scaled with the one that glides, the ellipsoid with the one below.
//!
//! A distance that is itself a coordinate, such as the position of a pelvis in a room, is given by
//! the caller and unchanged. If it is a distance between two bones, its default and its range are
//! scaled, since a patella that rests 4 cm above a joint rests higher above a larger one; so is the
//! value at rest of a posture term of such distances alone.

use super::{Condition, CoordinateKind, Model, SegmentId};
use crate::component::{Component, Correlate, Law, Signal};
use condyle_diagnostics::{Diagnostic, Subject};
use condyle_math::function::{FunctionOfSeveral, MultivariatePolynomial};
use condyle_math::{Affine, Growth, Vec3};
use std::collections::{BTreeMap, HashMap};

/// Segments with a common scale factor, such as the bones of both thighs.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SizeGroup {
    /// Its name, unique in the model.
    pub name: String,
    /// Its segments; none of them is in another group.
    pub segments: Vec<SegmentId>,
}

/// The readers of each output of a function as a length, and the factor for each.
type Lengths = BTreeMap<(usize, u32), Vec<(Reader, f64)>>;

/// What reads a number as a length.
#[derive(Clone, Copy)]
enum Reader {
    /// A translation, by its position among the components.
    Translate(usize),
    /// A coordinate that follows, by its position.
    Follower(usize),
}

impl Model {
    /// The groups of segments with a common scale factor; a segment in none has that of the body.
    pub fn size_groups(&self) -> &[SizeGroup] {
        &self.size_groups
    }

    /// The model with every length that is fixed in a segment times that segment's factor.
    ///
    /// `factors` has one for each segment, in their order; one that is missing or not a positive
    /// finite number counts as 1. A joint's frame in the parent, and the lengths inside the joint,
    /// are scaled with the parent; its frame in the segment, markers and ends of loops with their
    /// segment. A component that moves several segments is scaled with the parent of the first of
    /// them.
    ///
    /// Unchanged are angles, everything fixed in the world, every coordinate that is itself a
    /// distance (but its default and range are scaled if it is between two segments), bounds of
    /// distances that a [`Depend`](crate::component::Depend) sets, and user-defined laws.
    ///
    /// ```
    /// use condyle_math::Vec3;
    /// use condyle_model::ModelBuilder;
    ///
    /// let mut b = ModelBuilder::new("leg");
    /// let thigh = b.segment("thigh", None);
    /// let shank = b.segment("shank", Some(thigh));
    /// b.place_joint(shank, Vec3::new(0.0, -0.42, 0.0));
    /// let model = b.build().unwrap().scaled(&[1.1, 0.9]);
    /// let knee = model.segment(shank).joint_in_parent.translation;
    /// assert!((knee.y + 0.462).abs() < 1e-15);
    /// ```
    #[must_use]
    pub fn scaled(&self, factors: &[f64]) -> Self {
        let factors: Vec<[f64; 3]> = factors.iter().map(|&factor| [factor; 3]).collect();
        self.scaled_along(&factors)
    }

    /// The same with a factor along each axis of each segment.
    ///
    /// A translation along an oblique axis goes along the grown axis. Three equal factors do what one does, to the bit.
    ///
    /// ```
    /// use condyle_math::Vec3;
    /// use condyle_model::ModelBuilder;
    ///
    /// let mut b = ModelBuilder::new("leg");
    /// let thigh = b.segment("thigh", None);
    /// b.marker("knee", Some(thigh), Vec3::new(0.01, -0.4, 0.05));
    /// // Longer, and no wider.
    /// let model = b.build().unwrap().scaled_along(&[[1.0, 1.1, 1.0]]);
    /// assert!((model.markers()[0].point - Vec3::new(0.01, -0.44, 0.05)).norm() < 1e-15);
    /// ```
    #[must_use]
    pub fn scaled_along(&self, factors: &[[f64; 3]]) -> Self {
        let usable = |&f: &[f64; 3]| f.iter().all(|f| *f > 0.0 && f.is_finite());
        let of = |id: Option<SegmentId>| -> Growth {
            let own = id.and_then(|id| factors.get(id.index()).copied());
            own.filter(usable).map_or(Growth::NONE, Growth::along_axes)
        };
        let mut model = self.clone();
        for (index, segment) in model.segments.iter_mut().enumerate() {
            grow(&mut segment.joint_in_parent, of(segment.parent));
            grow(&mut segment.joint_in_segment, of(Some(SegmentId(index as u32))));
        }
        for marker in &mut model.markers {
            marker.point = of(marker.segment).point(marker.point);
        }
        for shape in &mut model.shapes {
            let growth = of(Some(shape.segment));
            if !growth.is_none() {
                shape.form = shape.form.grown(&growth);
            }
            if let Some((segment, point)) = &mut shape.until {
                *point = of(Some(*segment)).point(*point);
            }
        }
        // Seen from the joint's frame.
        let of_joint = |id: SegmentId| {
            let segment = self.segment(id);
            of(segment.parent).within(segment.joint_in_parent.linear)
        };
        let of_component: Vec<Growth> = self
            .joints_of_components()
            .iter()
            .map(|joint| joint.map_or(Growth::NONE, of_joint))
            .collect();
        for (component, growth) in model.components.iter_mut().zip(&of_component) {
            let segments = component.inputs.iter().filter_map(|signal| signal.segment());
            let segments: Vec<Growth> = segments.map(|id| of(Some(id))).collect();
            // Untouched where nothing changes, so that factor 1 keeps every bit.
            if !growth.is_none() || segments.iter().any(|growth| !growth.is_none()) {
                component.law.grow(growth, &segments);
            }
        }
        let of_coordinate = model.grow_distances(&of_component);
        for posture in &mut model.postures {
            let mut factors = posture.sum.iter().map(|(id, _)| of_coordinate[id.index()]);
            if let Some(first) = factors.next()
                && factors.all(|factor| factor == first)
            {
                posture.rest *= first;
            }
        }
        for closure in &mut model.closures {
            grow_condition(&mut closure.condition, &of, &of_coordinate);
        }
        model
    }

    /// The model with markers at other points of their segments (metres), in the order of the
    /// markers; a marker with `None`, or without an entry, is unchanged.
    #[must_use]
    pub fn with_markers_at(&self, points: &[Option<Vec3>]) -> Self {
        let mut model = self.clone();
        for (marker, point) in model.markers.iter_mut().zip(points) {
            if let Some(point) = *point {
                marker.point = point;
                // It is its own place now.
                marker.like = None;
            }
        }
        model
    }

    /// The model under another name.
    #[must_use]
    pub fn named(&self, name: &str) -> Self {
        Self { name: name.to_owned(), ..self.clone() }
    }

    /// For each component the first segment that it moves; `None` if it moves nothing.
    fn joints_of_components(&self) -> Vec<Option<SegmentId>> {
        let mut found = vec![None; self.components.len()];
        for (index, segment) in self.segments.iter().enumerate() {
            let mut open: Vec<Signal> = segment.motion.into_iter().collect();
            while let Some(source) = open.pop() {
                match source {
                    Signal::Coordinate(id) => open.extend(self.coordinate(id).follows),
                    Signal::Output(id, _) if found[id.index()].is_none() => {
                        found[id.index()] = Some(SegmentId(index as u32));
                        open.extend(self.components[id.index()].values());
                    }
                    Signal::Output(..) | Signal::Segment(_) => {}
                }
            }
        }
        found
    }

    /// Scales functions that give distances; returns the factor of each coordinate that is a
    /// distance.
    ///
    /// A number that is read as a distance and as something else becomes two outputs.
    fn grow_distances(&mut self, of_component: &[Growth]) -> Vec<f64> {
        let mut of_coordinate: Vec<Option<f64>> = vec![None; self.coordinates.len()];
        let mut lengths = Lengths::new();
        for (index, growth) in of_component.iter().enumerate() {
            let component = &mut self.components[index];
            let Law::Translate(along) = &mut component.law else { continue };
            let factor = growth.length(along.axis);
            along.axis = growth.direction(along.axis);
            let Some(&distance) = component.inputs.first() else { continue };
            let mut source = distance;
            let mut reader = Reader::Translate(index);
            // Along followers, each of which is met once.
            while let Signal::Coordinate(id) = source {
                let coordinate = &self.coordinates[id.index()];
                let known = &mut of_coordinate[id.index()];
                if coordinate.kind != CoordinateKind::Translation || known.is_some() {
                    break;
                }
                *known = Some(factor);
                let Some(leader) = coordinate.follows else { break };
                (source, reader) = (leader, Reader::Follower(id.index()));
            }
            if let Signal::Output(id, output) = source {
                lengths.entry((id.index(), output)).or_default().push((reader, factor));
            }
        }
        self.find_led_distances(&lengths, &mut of_coordinate);
        let of_coordinate: Vec<f64> = of_coordinate.iter().map(|k| k.unwrap_or(1.0)).collect();
        for (coordinate, &factor) in self.coordinates.iter_mut().zip(&of_coordinate) {
            if factor != 1.0 {
                coordinate.default[0] *= factor;
                coordinate.range.lower = coordinate.range.lower.map(|x| x * factor);
                coordinate.range.upper = coordinate.range.upper.map(|x| x * factor);
            }
        }
        let of_input = |source: Signal| match source {
            Signal::Coordinate(id) => of_coordinate[id.index()],
            Signal::Output(..) | Signal::Segment(_) => 1.0,
        };
        // Arguments first: a function of a distance takes the scaled distance.
        for Component { law, inputs, .. } in &mut self.components {
            if let Law::Map(c) = law {
                let argument = inputs.first().map_or(1.0, |&input| of_input(input));
                c.functions.iter_mut().for_each(|f| f.stretch(1.0, argument));
                continue;
            }
            if let Some(FunctionOfSeveral::Linear { slopes, .. }) = law.several_mut() {
                for (slope, &input) in slopes.iter_mut().zip(&*inputs) {
                    *slope /= of_input(input);
                }
            }
            if let Law::Correlate(Correlate { region: Some(region), .. }) = law {
                region.stretch(inputs.iter().map(|&input| of_input(input)));
            }
        }
        let readers = self.count_readers();
        for ((index, output), users) in lengths {
            let source = Signal::Output(super::ComponentId(index as u32), output);
            let alike = users.iter().all(|(_, factor)| *factor == users[0].1);
            if alike && readers.get(&source) == Some(&users.len()) {
                grow_output(&mut self.components[index].law, output, users[0].1);
                continue;
            }
            for (reader, factor) in users.into_iter().filter(|(_, factor)| *factor != 1.0) {
                if let Some(own) = self.output_again(index, output, factor) {
                    self.connect(reader, own);
                }
            }
        }
        of_coordinate
    }

    /// Distances that reach a translation through a function only.
    fn find_led_distances(&self, lengths: &Lengths, of_coordinate: &mut [Option<f64>]) {
        for (&(index, _), users) in lengths {
            for input in self.components[index].values() {
                if let Signal::Coordinate(id) = input
                    && self.coordinate(id).kind == CoordinateKind::Translation
                    && self.coordinate(id).follows.is_none()
                {
                    of_coordinate[id.index()].get_or_insert(users[0].1);
                }
            }
        }
    }

    /// How many ports and followers read each output.
    fn count_readers(&self) -> HashMap<Signal, usize> {
        let ports = self.components.iter().flat_map(Component::values);
        let followers = self.coordinates.iter().filter_map(|c| c.follows);
        let mut count = HashMap::new();
        ports.chain(followers).for_each(|source| *count.entry(source).or_insert(0) += 1);
        count
    }

    /// A second output of a function, `factor` times the first.
    fn output_again(&mut self, index: usize, output: u32, factor: f64) -> Option<Signal> {
        let component = self.components[index].clone();
        match &mut self.components[index].law {
            Law::Map(c) => {
                let mut function = c.functions.get(output as usize)?.clone();
                function.stretch(factor, 1.0);
                c.functions.push(function);
                let last = c.functions.len() as u32 - 1;
                Some(Signal::Output(super::ComponentId(index as u32), last))
            }
            Law::Combine(_) | Law::Correlate(_) => {
                let name = format!("{}_length", component.name);
                let mut again = Component { name, ..component };
                grow_output(&mut again.law, output, factor);
                self.components.push(again);
                let last = self.components.len() as u32 - 1;
                Some(Signal::Output(super::ComponentId(last), 0))
            }
            _ => None,
        }
    }

    fn connect(&mut self, reader: Reader, source: Signal) {
        match reader {
            Reader::Translate(index) => {
                self.components[index].inputs = vec![source];
            }
            Reader::Follower(index) => self.coordinates[index].follows = Some(source),
        }
    }
}

fn grow(frame: &mut Affine, by: Growth) {
    frame.translation = by.point(frame.translation);
}

/// One output of a function, `factor` times as large.
fn grow_output(law: &mut Law, output: u32, factor: f64) {
    match law {
        Law::Map(c) => {
            if let Some(function) = c.functions.get_mut(output as usize) {
                function.stretch(factor, 1.0);
            }
        }
        law if factor != 1.0 => match law.several_mut() {
            Some(FunctionOfSeveral::Linear { slopes, intercept }) => {
                slopes.iter_mut().for_each(|slope| *slope *= factor);
                *intercept *= factor;
            }
            Some(FunctionOfSeveral::Polynomial(p)) => {
                let all: Vec<f64> = p.coefficients().iter().map(|c| c * factor).collect();
                let (dimension, order) = (p.dimension(), p.order());
                if let Ok(larger) = MultivariatePolynomial::up_to_order(dimension, order, &all) {
                    *p = larger;
                }
            }
            None => {}
        },
        _ => {}
    }
}

fn grow_condition(
    condition: &mut Condition,
    of: &impl Fn(Option<SegmentId>) -> Growth,
    of_coordinate: &[f64],
) {
    match condition {
        Condition::Points { at } => at.iter_mut().for_each(|(id, p)| *p = of(*id).point(*p)),
        Condition::Frames { at } => at.iter_mut().for_each(|(id, frame)| grow(frame, of(*id))),
        Condition::Distance { at, distance } => {
            at.iter_mut().for_each(|(id, p)| *p = of(*id).point(*p));
            let of = |id| of(id).mean();
            // A ligament between two bones is scaled with both, one to the world with its bone.
            *distance *= match at.each_ref().map(|(id, _)| *id) {
                [Some(a), Some(b)] => (of(Some(a)) * of(Some(b))).sqrt(),
                [one, other] => of(one.or(other)),
            };
        }
        Condition::Coupling { follower, driver, function } => {
            let [result, argument] = [*follower, *driver].map(|id| of_coordinate[id.index()]);
            function.stretch(result, argument);
        }
    }
}

/// Errors of the groups of a model: duplicate names, segments in two groups.
pub(super) fn check_groups(model: &Model) -> Vec<Diagnostic> {
    let mut findings = vec![];
    let mut error = |group: &SizeGroup, message: String, help: &str| {
        let error = Diagnostic::error("model/size-group", message).with_help(help);
        findings.push(error.about(Subject::SizeGroup(group.name.clone())));
    };
    let mut group_of: Vec<Option<&str>> = vec![None; model.segments.len()];
    for (index, group) in model.size_groups.iter().enumerate() {
        if model.size_groups[..index].iter().any(|other| other.name == group.name) {
            let message = format!("two size groups are named `{}`", group.name);
            error(group, message, "give each size group a name of its own");
        }
        for id in &group.segments {
            let Some(known) = group_of.get_mut(id.index()) else { continue };
            if let Some(other) = known.replace(&group.name) {
                let segment = &model.segment(*id).name;
                let message = format!(
                    "segment `{segment}` is in size group `{other}` and in `{}`",
                    group.name
                );
                error(group, message, "list each segment once, in one size group");
            }
        }
    }
    findings
}
