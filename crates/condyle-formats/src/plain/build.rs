//! From a model to a tree of plain joints.

use super::blend::shares;
use super::chain::{Link, Measured, Step, moving, simplified};
use super::legal::Legal;
use super::rule::{Rule, Rules, Value};
use super::{Source, Tree, Variable};
use condyle_diagnostics::{Diagnostic, listed};
use condyle_math::function::{
    Curve, Function, FunctionOfSeveral, MultivariatePolynomial, SimmSpline,
};
use condyle_math::{Affine, EulerOrder, Quat, Vec3};
use condyle_model::component::{AngleNames, MotionLaw, SurfaceAxis};
use condyle_model::model::ComponentId;
use condyle_model::{Component, CoordinateId, CoordinateKind, Law, Model, Pose, SegmentId, Signal};
use std::collections::{BTreeSet, HashMap, HashSet};
use std::rc::Rc;

/// What the target of a tree can say.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Choice {
    /// Whether orientations stay whole, as balls; else each becomes three angles, body-fixed x, y, z.
    pub balls: bool,
}

/// The most steps of all chains together; products of products could make any number.
const MOST_STEPS: usize = 200_000;

/// A model as a tree of plain joints; parts for which no rule is known are measured.
pub fn build(model: &Model, choice: Choice) -> Tree {
    let mut builder = Builder {
        model,
        choice,
        tree: Tree {
            name: model.name().to_owned(),
            up: model.up(),
            variables: vec![],
            orientations: vec![],
            rules: Rules::default(),
            links: vec![],
            remarks: vec![],
        },
        scalars: HashMap::new(),
        orientations: HashMap::new(),
        angles: HashMap::new(),
        link_of: HashMap::new(),
        steps: 0,
        dropped: vec![],
        deformed: BTreeSet::new(),
        rest: Rc::new((vec![], Legal::new(model, 1).rest().1.clone())),
    };
    builder.variables();
    let variables = builder.tree.variables_at(model, builder.rest.1.effective());
    builder.rest = Rc::new((variables, builder.rest.1.clone()));
    builder.scalars();
    for segment in model.parents_first() {
        builder.link(segment);
    }
    builder.say();
    builder.tree
}

/// A part of a chain while it is made.
enum Raw {
    Step(Step),
    /// Nothing is known of it but what it reads.
    Unknown {
        what: String,
        reads: Reads,
        at: Option<ComponentId>,
    },
}

/// What an unknown part reads.
enum Reads {
    /// These values, where all are known.
    Values(Option<Vec<Value>>),
    /// The values of all joints from this segment on, or from the root, and others.
    From(Option<SegmentId>, Vec<Value>),
}

struct Builder<'m> {
    model: &'m Model,
    choice: Choice,
    tree: Tree,
    /// The value of each signal that is a number; `None` where no rule is known.
    scalars: HashMap<Signal, Value>,
    /// The coordinate that each signal of an orientation passes on.
    orientations: HashMap<Signal, CoordinateId>,
    /// The values of the three angles of an orientation, or its number among those that stay whole.
    angles: HashMap<CoordinateId, Result<[Value; 3], usize>>,
    link_of: HashMap<SegmentId, usize>,
    steps: usize,
    /// Limits that are not said.
    dropped: Vec<String>,
    /// Segments that are stretched or sheared.
    deformed: BTreeSet<String>,
    /// The variables and the pose at rest.
    rest: Rc<(Vec<f64>, Pose)>,
}

impl Builder<'_> {
    fn variables(&mut self) {
        let keys = self.model.coordinate_keys();
        for (id, key) in self.model.coordinate_ids().zip(keys) {
            let coordinate = self.model.coordinate(id);
            if coordinate.kind != CoordinateKind::Orientation {
                let value = self.variable(Variable {
                    name: key,
                    source: Source::Coordinate(id),
                    kind: coordinate.kind,
                    default: coordinate.default[0],
                    range: coordinate.range,
                    locked: coordinate.locked,
                    follows: None,
                });
                self.scalars.insert(Signal::Coordinate(id), value);
                continue;
            }
            self.orientations.insert(Signal::Coordinate(id), id);
            if self.choice.balls {
                self.tree.orientations.push(id);
                self.angles.insert(id, Err(self.tree.orientations.len() - 1));
                continue;
            }
            let q = Quat::from(coordinate.default).normalized();
            let defaults = EulerOrder::XYZ.from_mat3(q.to_mat3());
            let values = [0, 1, 2].map(|axis: usize| {
                self.variable(Variable {
                    name: format!("{key}_{}", ["x", "y", "z"][axis]),
                    source: Source::Angle(id, axis),
                    kind: CoordinateKind::Rotation,
                    default: defaults[axis],
                    range: condyle_model::Range::FREE,
                    locked: coordinate.locked,
                    follows: None,
                })
            });
            self.angles.insert(id, Ok(values));
            self.tree.remarks.push(Diagnostic::note(
                "plain/angles",
                format!("the orientation `{key}` becomes the angles {key}_x, {key}_y, {key}_z (body-fixed x, y, z)"),
            ));
        }
    }

    fn variable(&mut self, variable: Variable) -> Value {
        self.tree.variables.push(variable);
        self.tree.rules.push(Rule::Variable(self.tree.variables.len() - 1))
    }

    /// The values of all scalar components, each after those that it reads.
    fn scalars(&mut self) {
        for signal in self.model.evaluation_order() {
            let (id, component) = match signal {
                Signal::Output(id, _) => (id, &self.model.components()[id.index()]),
                Signal::Coordinate(id) => {
                    self.follower(id);
                    continue;
                }
                Signal::Segment(_) => continue,
            };
            let output = |k: usize| Signal::Output(id, k as u32);
            let inputs: Option<Vec<Value>> =
                component.values().map(|input| self.scalars.get(&input).copied()).collect();
            let mut found: Vec<Option<Value>> = vec![];
            let rules = &mut self.tree.rules;
            match &component.law {
                Law::Map(map) => {
                    let input = inputs.and_then(|inputs| inputs.first().copied());
                    for function in &map.functions {
                        found.push(input.map(|input| rules.one(function.clone(), input)));
                    }
                }
                Law::Angles(law) => {
                    let from =
                        component.inputs.first().and_then(|from| self.orientations.get(from));
                    let angles = from.and_then(|from| self.angles.get(from));
                    if let (AngleNames::Euler(EulerOrder::XYZ), None, Some(Ok(values))) =
                        (law.names, law.mirrored, angles)
                    {
                        found.extend(values.map(Some));
                    }
                }
                law if law.several().is_some() => {
                    let function = law.several().zip(inputs);
                    found.push(function.map(|(f, inputs)| rules.several(f.clone(), &inputs)));
                }
                law if law.bounds() => {
                    self.dropped.push(name_of(self.model, component));
                    for (k, input) in component.values().enumerate() {
                        if let Some(&coordinate) = self.orientations.get(&input) {
                            self.orientations.insert(output(k), coordinate);
                        }
                        found.push(self.scalars.get(&input).copied());
                    }
                }
                _ => {}
            }
            for (k, value) in found.into_iter().enumerate() {
                if let Some(value) = value {
                    self.scalars.insert(output(k), value);
                }
            }
        }
    }

    /// A coordinate that follows others.
    fn follower(&mut self, id: CoordinateId) {
        let Some(leader) = self.model.coordinate(id).follows else { return };
        let value = self.scalars.get(&leader).copied();
        let place = self.tree.variables.iter().position(|v| v.source == Source::Coordinate(id));
        if let Some(variable) = place.and_then(|place| self.tree.variables.get_mut(place)) {
            variable.follows = value;
            if value.is_none() {
                let name = variable.name.clone();
                self.tree.remarks.push(Diagnostic::warning(
                    "plain/not-said",
                    format!("what `{name}` follows cannot be said: it is free"),
                ));
            }
        }
    }

    fn link(&mut self, id: SegmentId) {
        let segment = self.model.segment(id);
        let fixed = |frame: Affine| Raw::Step(Step::Fixed(frame));
        let mut raw = vec![fixed(self.rigid(segment.joint_in_parent, &segment.name))];
        if let Some(motion) = segment.motion {
            self.motion(id, motion, &mut raw);
        }
        raw.push(fixed(self.rigid(segment.joint_in_segment, &segment.name).rigid_inverse()));
        let (steps, measured) = self.joined(id, raw);
        self.steps += steps.len();
        let set = segment.joint_set;
        let alone = set.is_none_or(|set| self.model.outputs_of(set).count() == 1);
        let joint = match set.map(|set| self.model.joint_sets()[set.index()].name.clone()) {
            Some(name) if alone => name,
            _ => format!("{}_joint", segment.name),
        };
        let link = Link {
            segment: id,
            name: segment.name.clone(),
            joint,
            parent: segment.parent.and_then(|parent| self.link_of.get(&parent).copied()),
            steps,
            measured,
        };
        self.tree.links.push(link);
        self.link_of.insert(id, self.tree.links.len() - 1);
    }

    /// Steps as they are, and everything from the first to the last unknown one as six measured values.
    fn joined(&mut self, id: SegmentId, raw: Vec<Raw>) -> (Vec<Step>, Option<Measured>) {
        let unknown = |part: &Raw| matches!(part, Raw::Unknown { .. });
        let (Some(first), Some(last)) =
            (raw.iter().position(unknown), raw.iter().rposition(unknown))
        else {
            let steps: Vec<Step> = raw.into_iter().filter_map(Raw::step).collect();
            return (simplified(&steps, &self.tree.rules), None);
        };
        let (mut before, mut after, mut names, mut components) = (vec![], vec![], vec![], vec![]);
        let mut drivers: Option<BTreeSet<Value>> = Some(BTreeSet::new());
        for (place, part) in raw.into_iter().enumerate() {
            match part {
                Raw::Step(step) if place < first => before.push(step),
                Raw::Step(step) if place > last => after.push(step),
                Raw::Step(step) => {
                    if let (Some(all), Some(value)) = (&mut drivers, step.value()) {
                        all.insert(value);
                    }
                }
                Raw::Unknown { what, reads, at } => {
                    names.push(what);
                    components.extend(at);
                    match reads {
                        Reads::Values(Some(values)) => {
                            if let Some(all) = &mut drivers {
                                all.extend(values);
                            }
                        }
                        Reads::Values(None) => drivers = None,
                        Reads::From(surface, others) => {
                            let path = self.model.path_to_root(id).skip(1);
                            let path = path.take_while(|&above| Some(above) != surface);
                            let mut links: Vec<usize> = path
                                .filter_map(|above| self.link_of.get(&above).copied())
                                .collect();
                            links.reverse();
                            let above =
                                links.iter().flat_map(|&link| self.tree.links[link].steps.iter());
                            let chain: Vec<Step> = above.chain(&before).cloned().collect();
                            if let Some(all) = &mut drivers {
                                all.extend(moving(&chain, self.tree.rules.len()));
                                all.extend(others);
                            }
                        }
                    }
                }
            }
        }
        let drivers = drivers.unwrap_or_else(|| self.all_read(id)).into_iter();
        let drivers: Vec<Value> =
            drivers.filter(|&v| self.tree.rules.as_constant(v).is_none()).collect();
        let before = simplified(&before, &self.tree.rules);
        let after = simplified(&after, &self.tree.rules);
        let slots = [0; 6].map(|_| self.tree.rules.push(Rule::Measured));
        let rest = self.rest(id, &before, &after);
        let at = before.len();
        let mut steps = before;
        steps.push(Step::Fixed(rest));
        let [x, y, z, turn_x, turn_y, turn_z] = slots;
        let axes = [Vec3::X, Vec3::Y, Vec3::Z];
        steps.extend(
            axes.into_iter().zip([x, y, z]).map(|(axis, value)| Step::Slide { axis, value }),
        );
        let turns = axes.into_iter().zip([turn_x, turn_y, turn_z]);
        steps.extend(turns.map(|(axis, value)| Step::Turn { axis, value }));
        steps.extend(after);
        let what = names.join(", ");
        (steps, Some(Measured { at, rest, slots, drivers, components, what }))
    }

    /// The values of all variables that the motion of a segment depends on.
    fn all_read(&self, id: SegmentId) -> BTreeSet<Value> {
        let (mut seen, mut values) = (HashSet::new(), BTreeSet::new());
        let mut open: Vec<Signal> = self.model.segment(id).motion.into_iter().collect();
        while let Some(signal) = open.pop() {
            if !seen.insert(signal) {
                continue;
            }
            match signal {
                Signal::Output(component, _) => open.extend(self.model.reads(component)),
                Signal::Coordinate(id) => match self.model.coordinate(id).follows {
                    Some(leader) => open.push(leader),
                    None => {
                        values.extend(self.scalars.get(&signal));
                        values.extend(
                            self.angles.get(&id).and_then(|a| a.ok()).into_iter().flatten(),
                        );
                    }
                },
                Signal::Segment(_) => {}
            }
        }
        values
    }

    /// Appends the steps of a transform.
    fn motion(&mut self, id: SegmentId, motion: Signal, raw: &mut Vec<Raw>) {
        let mut open = vec![motion];
        while let Some(signal) = open.pop() {
            let Signal::Output(at, _) = signal else { continue };
            if self.steps + raw.len() + open.len() > MOST_STEPS {
                raw.push(Raw::Unknown {
                    what: "a product of too many parts".into(),
                    reads: Reads::Values(None),
                    at: None,
                });
                return;
            }
            let model = self.model;
            let component = &model.components()[at.index()];
            if component.law == Law::Product(condyle_model::component::Product) {
                open.extend(component.inputs.iter().rev());
                continue;
            }
            self.law(id, at, component, raw);
        }
    }

    fn law(&mut self, id: SegmentId, at: ComponentId, component: &Component, raw: &mut Vec<Raw>) {
        let inputs: Option<Vec<Value>> =
            component.values().map(|input| self.scalars.get(&input).copied()).collect();
        let what = || format!("{} `{}`", component.law.kind().name, name_of(self.model, component));
        let unknown = |inputs: Option<Vec<Value>>| Raw::Unknown {
            what: what(),
            reads: Reads::Values(inputs),
            at: Some(at),
        };
        let steps = match (&component.law, inputs.as_deref()) {
            (Law::Rotate(law), Some(&[value])) => vec![Step::Turn { axis: law.axis, value }],
            (Law::Translate(law), Some(&[value])) => vec![Step::Slide { axis: law.axis, value }],
            (Law::Place(law), _) => {
                let name = self.model.segment(id).name.clone();
                vec![Step::Fixed(self.rigid(law.child_in_parent, &name))]
            }
            (Law::Ball(_), _) => {
                let from = component.inputs.first().and_then(|from| self.orientations.get(from));
                match from.and_then(|from| self.angles.get(from)) {
                    Some(Err(orientation)) => {
                        vec![Step::Ball { orientation: *orientation, inverse: false }]
                    }
                    Some(Ok([x, y, z])) => [(Vec3::X, *x), (Vec3::Y, *y), (Vec3::Z, *z)]
                        .map(|(axis, value)| Step::Turn { axis, value })
                        .to_vec(),
                    None => return raw.push(unknown(None)),
                }
            }
            (Law::Pivot(law), Some(&[value])) => {
                let axis = law.axis().normalized();
                let turn = Step::Turn { axis, value };
                match law.fixed_centre() {
                    Some(centre) => vec![
                        Step::Fixed(Affine::from_translation(centre)),
                        turn,
                        Step::Fixed(Affine::from_translation(-centre)),
                    ],
                    None => {
                        let mut steps = self.path(value, &|x| law.transform(&[x]).translation);
                        steps.push(turn);
                        steps
                    }
                }
            }
            (Law::Curve(law), Some(&[value])) if law.heading.is_none() => {
                let axes = [Vec3::X, Vec3::Y, Vec3::Z].into_iter().zip(law.path.iter());
                let rules = &mut self.tree.rules;
                axes.map(|(axis, spline)| {
                    let value = rules.one(Curve::SimmSpline(spline.clone()).into(), value);
                    Step::Slide { axis, value }
                })
                .collect()
            }
            (Law::Ellipsoid(law), Some(&[a, b, c])) if law.axis == SurfaceAxis::OpenSim => {
                self.surface(law.radii, [a, b, c])
            }
            (Law::Scale(_) | Law::Shear(_), _) => {
                self.deformed.insert(self.model.segment(id).name.clone());
                return;
            }
            (Law::Compensate(law), _) => match self.compensation(component, law.weight) {
                Some(steps) => steps,
                None => return raw.push(unknown(None)),
            },
            (Law::Contact(contact), _) => {
                let drivers = component.by_port().find(|(port, _)| port.name == "drivers");
                let drivers = drivers.map_or(&[][..], |(_, signals)| signals);
                let drivers: Option<Vec<Value>> =
                    drivers.iter().map(|driver| self.scalars.get(driver).copied()).collect();
                let shares = match drivers {
                    Some(drivers) => shares(&mut self.tree.rules, &contact.law, &drivers),
                    None => vec![],
                };
                return raw.push(Raw::Unknown {
                    what: what(),
                    reads: Reads::From(component.segments_at("surface").next(), shares),
                    at: Some(at),
                });
            }
            _ => return raw.push(unknown(inputs)),
        };
        raw.extend(steps.into_iter().map(Raw::Step));
    }

    /// Slides along x, y and z by splines through a path of one value.
    fn path(&mut self, value: Value, path: &dyn Fn(f64) -> Vec3) -> Vec<Step> {
        let (lower, upper) = self.reach(value);
        let knots: Vec<f64> = (0..PATH_KNOTS)
            .map(|i| lower + (upper - lower) * i as f64 / (PATH_KNOTS - 1) as f64)
            .collect();
        let points: Vec<Vec3> = knots.iter().map(|&x| path(x)).collect();
        let mut steps = vec![];
        for (i, axis) in [Vec3::X, Vec3::Y, Vec3::Z].into_iter().enumerate() {
            let y: Vec<f64> = points.iter().map(|p| p.to_array()[i]).collect();
            if y.iter().all(|y| y.abs() < 1e-12) {
                continue;
            }
            if let Ok(spline) = SimmSpline::new(knots.clone(), y) {
                let value = self.tree.rules.one(Curve::SimmSpline(spline).into(), value);
                steps.push(Step::Slide { axis, value });
            }
        }
        steps
    }

    /// The interval that a value can be in while variables are in theirs, at most a turn either way.
    fn reach(&self, value: Value) -> (f64, f64) {
        let drivers = self.tree.rules.forms()[value].drivers.clone();
        let intervals: Vec<(f64, f64)> = self
            .tree
            .variables
            .iter()
            .map(|variable| match variable.source {
                Source::Coordinate(id) => Legal::interval(self.model, id),
                Source::Angle(..) => (-3.2, 3.2),
            })
            .collect();
        let mut variables: Vec<f64> = self.tree.variables.iter().map(|v| v.default).collect();
        let (mut lower, mut upper) = (0.0f64, 0.0f64);
        let mut note = |variables: &[f64]| {
            let x = self.tree.rules.evaluate(variables)[value];
            lower = lower.min(x);
            upper = upper.max(x);
        };
        note(&variables);
        // Corners and lines between them in a pattern that reaches all of few drivers.
        for step in 0..256usize {
            for (place, &driver) in drivers.iter().enumerate() {
                let (l, u) = intervals[driver];
                let share = match step % 4 {
                    0 => ((step >> 2 >> (place % 6)) & 1) as f64,
                    _ => ((step * (place + 1) * 37) % 101) as f64 / 100.0,
                };
                variables[driver] = l + (u - l) * share;
            }
            note(&variables);
        }
        let margin = 0.05 * (upper - lower).max(0.1);
        ((lower - margin).max(-6.4), (upper + margin).min(6.4))
    }

    /// Gliding on an ellipsoid: the third axis of the frame, stretched by the half axes, and three turns.
    fn surface(&mut self, radii: Vec3, [a, b, c]: [Value; 3]) -> Vec<Step> {
        let rules = &mut self.tree.rules;
        let knots: Vec<f64> = (0..TURN_KNOTS)
            .map(|i| (2.0 * i as f64 / (TURN_KNOTS - 1) as f64 - 1.0) * std::f64::consts::PI * 1.1)
            .collect();
        let spline = |f: &dyn Fn(f64) -> f64| -> Option<Function> {
            let y = knots.iter().map(|&x| f(x)).collect();
            SimmSpline::new(knots.clone(), y).ok().map(|s| Curve::SimmSpline(s).into())
        };
        let mut wave = |f: &dyn Fn(f64) -> f64, of: Value| match spline(f) {
            Some(function) => rules.one(function, of),
            None => of,
        };
        let (sin_a, cos_a) = (wave(&f64::sin, a), wave(&f64::cos, a));
        let (sin_b, cos_b) = (wave(&f64::sin, b), wave(&f64::cos, b));
        let mut product = |factor: f64, x: Value, y: Value| {
            let terms = [0.0, 0.0, 0.0, 0.0, factor, 0.0];
            match MultivariatePolynomial::up_to_order(2, 2, &terms) {
                Ok(polynomial) => rules.several(FunctionOfSeveral::Polynomial(polynomial), &[x, y]),
                Err(_) => x,
            }
        };
        let y = product(-radii.y, sin_a, cos_b);
        let z = product(radii.z, cos_a, cos_b);
        let x = self.tree.rules.one(Function::linear(radii.x, 0.0), sin_b);
        let slide = |axis, value| Step::Slide { axis, value };
        let turn = |axis, value| Step::Turn { axis, value };
        vec![
            slide(Vec3::X, x),
            slide(Vec3::Y, y),
            slide(Vec3::Z, z),
            turn(Vec3::X, a),
            turn(Vec3::Y, b),
            turn(Vec3::Z, c),
        ]
    }

    /// F⁻¹·A⁻¹·A′·F, the rotations of the path backwards and those that are not undone forwards.
    fn compensation(&self, component: &Component, weight: f64) -> Option<Vec<Step>> {
        if weight == 0.0 {
            return Some(vec![]);
        }
        if weight != 1.0 {
            return None;
        }
        let segment = component.segments_at("segment").next()?;
        let named: Vec<SegmentId> = component.segments_at("ancestors").collect();
        let mut path: Vec<SegmentId> = self.model.path_to_root(segment).skip(1).collect();
        let top = path.iter().rposition(|id| named.contains(id))?;
        path.truncate(top + 1);
        let (mut back, mut forth) = (vec![], vec![]);
        for id in path.iter().rev() {
            let link = self.tree.links.get(*self.link_of.get(id)?)?;
            back.extend(link.steps.iter().filter_map(Step::rotation));
            if named.contains(id) {
                let own = self.model.segment(*id);
                let fixed = |frame: Affine| Step::Fixed(Affine::from_rotation(frame.linear));
                forth.push(fixed(own.joint_in_parent));
                forth.push(fixed(own.joint_in_segment.rigid_inverse()));
            } else {
                forth.extend(link.steps.iter().filter_map(Step::rotation));
            }
        }
        let frame = Affine::from_rotation(self.model.segment(segment).joint_in_parent.linear);
        let mut steps = vec![Step::Fixed(frame.rigid_inverse())];
        steps.extend(back.iter().rev().map(Step::inverse));
        steps.extend(forth);
        steps.push(Step::Fixed(frame));
        Some(simplified(&steps, &self.tree.rules))
    }

    /// What is left of a segment's motion at rest, rigid.
    fn rest(&mut self, id: SegmentId, before: &[Step], after: &[Step]) -> Affine {
        let shared = Rc::clone(&self.rest);
        let (variables, pose) = &*shared;
        // What is measured before is at its own rest there: 0.
        let values = self.tree.rules.evaluate(variables);
        let [before, after] =
            [before, after].map(|s| self.tree.product(s, &values, pose, self.model));
        let whole = pose.segment_in_parent(self.model, id);
        let rest = before.rigid_inverse() * whole * after.rigid_inverse();
        Affine::new(Quat::from_mat3(rest.linear).normalized().to_mat3(), rest.translation)
    }

    /// A fixed frame, or the rigid one next to it.
    fn rigid(&mut self, frame: Affine, name: &str) -> Affine {
        let rotation = Quat::from_mat3(frame.linear).normalized().to_mat3();
        let apart = |a: Vec3, b: Vec3| (a - b).norm();
        let off = apart(rotation.x, frame.linear.x)
            .max(apart(rotation.y, frame.linear.y))
            .max(apart(rotation.z, frame.linear.z));
        if off < 1e-9 {
            return frame;
        }
        self.deformed.insert(name.to_owned());
        Affine::new(rotation, frame.translation)
    }

    fn say(&mut self) {
        let remarks = &mut self.tree.remarks;
        if !self.dropped.is_empty() {
            let count = self.dropped.len();
            let names = listed(&self.dropped);
            remarks.push(Diagnostic::warning(
                "plain/limits-dropped",
                format!("{count} limits other than ranges are not written: {names}"),
            ));
        }
        if !self.deformed.is_empty() {
            let names = listed(&self.deformed);
            remarks.push(Diagnostic::warning(
                "plain/deformed-dropped",
                format!("scales and shears are not written: they move {names}"),
            ));
        }
    }
}

/// Knots of the path of a moving centre: with 129 over a turn a smooth path is kept to about 1e-8 of its size.
const PATH_KNOTS: usize = 129;
/// Knots of sine and cosine: over 2.2 half turns h = 0.027, and h⁴/384 = 1.4e-9.
const TURN_KNOTS: usize = 257;

impl Raw {
    fn step(self) -> Option<Step> {
        match self {
            Self::Step(step) => Some(step),
            Self::Unknown { .. } => None,
        }
    }
}

fn name_of(model: &Model, component: &Component) -> String {
    format!("{}/{}", model.joint_sets()[component.joint_set.index()].name, component.name)
}
