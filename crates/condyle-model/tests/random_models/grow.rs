//! Random models from a seed.

use std::collections::HashSet;

use condyle_math::function::{
    Curve, Function, FunctionOfSeveral, MultivariatePolynomial, Polynomial, SimmSpline,
};
use condyle_math::{Affine, EulerOrder, Mat3, Quat, Scalar, Vec3};
use condyle_model::component::{
    Along, AngleNames, Angles, Ball, Centre, ConstantCurvature, Contact, ContactPair, Correlate,
    Curve as Track, Depend, Ellipsoid, Gliding, Heading, JointCone, Law, MotionLaw, Pivot,
    Reflection, Region, Registry, RelativeOrientation, RelativePosition, Scale, Shear, SurfaceAxis,
    Swinging,
};
use condyle_model::component::{Ellipse, HalfSpace};
use condyle_model::limit::{Cone, ConePoint, Projection};
use condyle_model::model::{Closure, Condition};
use condyle_model::{
    CoordinateId, CoordinateKind, JointSetId, Model, ModelBuilder, PostureTerm, Range, SegmentId,
    Signal,
};

/// SplitMix64 (Steele, Lea & Flood 2014): reproducible everywhere, no dependency.
pub(crate) struct Dice(u64);

impl Dice {
    pub(crate) fn new(seed: u64) -> Self {
        Self(seed)
    }

    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    pub(crate) fn below(&mut self, n: usize) -> usize {
        (self.next() % n as u64) as usize
    }

    pub(crate) fn within(&mut self, size: f64) -> f64 {
        size * ((self.next() >> 11) as f64 / (1u64 << 52) as f64 - 1.0)
    }

    fn vector(&mut self, size: f64) -> Vec3 {
        Vec3::new(self.within(size), self.within(size), self.within(size))
    }

    fn frame(&mut self) -> Affine {
        match self.below(3) {
            0 => Affine::IDENTITY,
            1 => Affine::from_translation(self.vector(0.3)),
            _ => Affine::new(Quat::exp(self.vector(2.0)).to_mat3(), self.vector(0.3)),
        }
    }

    fn axis(&mut self) -> Vec3 {
        match self.below(5) {
            0 => Vec3::X,
            1 => Vec3::Y,
            2 => Vec3::Z,
            3 => -Vec3::Z,
            _ => self.vector(1.0) + Vec3::new(0.0, 2.0, 0.0),
        }
    }

    fn function(&mut self) -> Function {
        let curve = match self.below(5) {
            0 => Curve::Constant(self.within(0.5)),
            1 => Curve::Linear { slope: 1.0, intercept: 0.0 },
            2 => Curve::Linear { slope: self.within(1.0), intercept: self.within(0.2) },
            3 => Curve::Polynomial(Polynomial::from_ascending(vec![
                self.within(0.2),
                self.within(0.5),
                self.within(0.3),
            ])),
            _ => {
                let x = vec![-1.5, -0.6, 0.1, 0.7, 1.9];
                let y = x.iter().map(|_| self.within(0.4)).collect();
                Curve::SimmSpline(SimmSpline::new(x, y).unwrap())
            }
        };
        Function { factor: if self.below(3) == 0 { self.within(1.5) } else { 1.0 }, curve }
    }
}

/// A model of up to nine segments and stored numbers for it, some outside their ranges.
pub(crate) fn random_model(seed: u64) -> (Model, Vec<f64>) {
    random_model_with(seed, |_, _| ())
}

/// The same model with loops of all kinds, many of them between coordinates that follow others, and with
/// posture terms.
pub(crate) fn random_model_with_loops(seed: u64) -> (Model, Vec<f64>) {
    random_model_with(seed, |b, rigid| {
        let mut dice = Dice::new(seed ^ 0xc105e);
        grow_closures(b, &mut dice, rigid);
        grow_postures(b, &mut dice);
    })
}

/// `finish` is given the segments that nothing stretches.
fn random_model_with(
    seed: u64,
    finish: impl FnOnce(&mut ModelBuilder, &[SegmentId]),
) -> (Model, Vec<f64>) {
    let mut dice = Dice::new(seed);
    let mut b = ModelBuilder::new("random");
    let mut segments: Vec<SegmentId> = vec![];
    let mut parents: Vec<Option<SegmentId>> = vec![];
    let mut scalars: Vec<Signal> = vec![];
    let mut transforms: Vec<Signal> = vec![];
    // Components whose transforms are not rigid, and segments that they move.
    let mut bent: HashSet<Signal> = HashSet::new();
    let mut bent_segments: HashSet<SegmentId> = HashSet::new();
    for i in 0..1 + dice.below(9) {
        let parent = match dice.below(segments.len() + 1) {
            0 => None,
            n => Some(segments[n - 1]),
        };
        let segment = b.segment(&format!("segment_{i}"), parent);
        parents.push(parent);
        segments.push(segment);
        let above = |from: SegmentId| {
            let mut line = vec![];
            let mut here = Some(from);
            while let Some(id) = here {
                line.push(id);
                here = parents[id.index()];
            }
            line
        };
        let frames = (dice.frame(), dice.frame());
        b.place_joint_frames(segment, frames.0, frames.1);
        let set = b.joint_set(&format!("joint_{i}"));
        for c in 0..dice.below(4) {
            grow_coordinate(&mut b, &mut dice, set, c, &mut scalars, &mut transforms);
        }
        if scalars.is_empty() {
            continue;
        }
        // What is measured between segments that are there already makes no circle.
        let mut rigid: Vec<SegmentId> = vec![];
        for (&id, parent) in segments.iter().zip(&parents).take(i) {
            if !bent_segments.contains(&id) && parent.is_none_or(|p| rigid.contains(&p)) {
                rigid.push(id);
            }
        }
        for c in 0..1 + dice.below(5) {
            if !rigid.is_empty() && dice.below(4) == 0 {
                grow_measure(&mut b, &mut dice, set, c, &rigid, &mut scalars);
                continue;
            }
            grow_component(&mut b, &mut dice, set, c, &mut scalars, &mut transforms, &mut bent);
        }
        // Cancel the rotation of the parent, or of all ancestors, before its own rotation.
        let ancestors =
            parent.map_or(vec![], |p| if dice.below(2) == 0 { vec![p] } else { above(p) });
        let rigid = ancestors.iter().all(|id| !bent_segments.contains(id));
        if dice.below(3) == 0 && rigid && !ancestors.is_empty() {
            // Glide on an ancestor instead, after a rotation of the joint itself.
            if dice.below(2) == 0 {
                let surface = ancestors[ancestors.len() - 1];
                let before = b.rotate(set, "before", scalars[0], Vec3::Z);
                let drivers: Vec<Signal> = scalars.iter().copied().take(dice.below(3)).collect();
                let law = grow_gliding(&mut dice);
                let most_gap = (dice.below(2) == 0).then_some(0.05);
                let ends = [segment.into(), surface.into(), before];
                let inputs = ends.into_iter().chain(drivers).collect();
                let contact = Law::Contact(Contact { before: true, most_gap, law });
                let glide = b.component(set, "glide", contact, inputs);
                let motion = b.product(set, "gliding", vec![before, glide]);
                b.output(set, segment, motion);
                continue;
            }
            let weight = [1.0, 1.0, 0.5][dice.below(3)];
            let undo = b.compensate(set, "compensate", segment, &ancestors, weight);
            let own = b.rotate(set, "own", scalars[0], Vec3::X);
            let motion = b.product(set, "compensated", vec![undo, own]);
            b.output(set, segment, motion);
        } else if !transforms.is_empty() && dice.below(8) > 0 {
            // Often the newest transform, sometimes one that already moves another segment.
            let pick = transforms.len() - 1 - dice.below(transforms.len().min(3));
            b.output(set, segment, transforms[pick]);
            if bent.contains(&transforms[pick]) {
                bent_segments.insert(segment);
            }
        }
    }
    // Parents are made before their children.
    let mut rigid: Vec<SegmentId> = vec![];
    for (&id, parent) in segments.iter().zip(&parents) {
        if !bent_segments.contains(&id) && parent.is_none_or(|p| rigid.contains(&p)) {
            rigid.push(id);
        }
    }
    finish(&mut b, &rigid);
    let model = b.build().unwrap_or_else(|findings| panic!("seed {seed}: {findings:?}"));
    let stored = posture(&model, &mut dice);
    (model, stored)
}

/// Stored numbers for a model, some outside their ranges.
pub(crate) fn posture(model: &Model, dice: &mut Dice) -> Vec<f64> {
    let mut stored = model.defaults();
    for id in model.coordinate_ids() {
        let place = model.stored_range(id);
        if place.len() == 4 {
            stored[place].copy_from_slice(&Quat::exp(dice.vector(1.8)).to_array());
        } else {
            let scale = model.coordinate(id).kind == CoordinateKind::Scale;
            stored[place.start] = if scale { 1.0 + dice.within(0.5) } else { dice.within(1.2) };
        }
    }
    stored
}

fn grow_closures(b: &mut ModelBuilder, dice: &mut Dice, rigid: &[SegmentId]) {
    let scalars: Vec<CoordinateId> = (0..b.coordinates().len())
        .filter(|&i| b.coordinates()[i].kind != CoordinateKind::Orientation)
        .filter_map(|i| b.coordinate_at(i))
        .collect();
    let followers: Vec<CoordinateId> =
        scalars.iter().copied().filter(|&id| b.coordinate_mut(id).follows.is_some()).collect();
    for number in 0..4 {
        let segment = |dice: &mut Dice| b.segment_at(dice.below(10));
        let at = [(); 2].map(|()| (segment(dice), dice.vector(0.3)));
        let condition = match dice.below(5) {
            0 => Condition::Points { at },
            1 => Condition::Distance { at, distance: 0.2 },
            2 => {
                let frame = |dice: &mut Dice| {
                    Affine::new(Quat::exp(dice.vector(0.5)).to_mat3(), dice.vector(0.3))
                };
                let segment = |dice: &mut Dice| rigid.get(dice.below(rigid.len() + 1)).copied();
                Condition::Frames { at: [(); 2].map(|()| (segment(dice), frame(dice))) }
            }
            _ if scalars.len() > 1 => {
                let any = |dice: &mut Dice| {
                    let list = if dice.below(2) == 0 { &followers } else { &scalars };
                    let list = if list.is_empty() { &scalars } else { list };
                    list[dice.below(list.len())]
                };
                let (follower, driver) = (any(dice), any(dice));
                Condition::Coupling { follower, driver, function: dice.function() }
            }
            _ => continue,
        };
        b.closure(Closure { name: format!("closure_{number}"), condition });
    }
}

/// Terms of one coordinate, some of them named as a document names those of a coordinate's own, and of
/// two.
fn grow_postures(b: &mut ModelBuilder, dice: &mut Dice) {
    for index in 0..b.coordinates().len() {
        let Some(id) = b.coordinate_at(index) else { continue };
        let coordinate = &b.coordinates()[index];
        if coordinate.kind == CoordinateKind::Orientation || dice.below(3) == 0 {
            continue;
        }
        // The joint set of a segment is named for it.
        let own = format!("joint_{}.{}", coordinate.joint_set.index(), coordinate.name);
        let (name, factor) = match dice.below(4) {
            0 => (format!("posture {index}"), 1.0),
            1 => (own, dice.within(1.0)),
            _ => (own, 1.0),
        };
        let mut sum = vec![(id, factor)];
        if let Some(other) = index.checked_sub(1).and_then(|index| b.coordinate_at(index))
            && b.coordinate_mut(other).kind != CoordinateKind::Orientation
            && dice.below(4) == 0
        {
            sum.push((other, dice.within(2.0)));
        }
        let rest = if dice.below(2) == 0 { 0.0 } else { dice.within(1.0) };
        let source = (dice.below(3) == 0).then(|| "illustrative".to_owned());
        b.posture(PostureTerm { name, sum, rest, stiffness: 1e-5, source });
    }
}

fn grow_coordinate(
    b: &mut ModelBuilder,
    dice: &mut Dice,
    set: JointSetId,
    number: usize,
    scalars: &mut Vec<Signal>,
    transforms: &mut Vec<Signal>,
) {
    let name = format!("c{number}");
    if dice.below(4) == 0 {
        let orientation = b.coordinate(set, &name, CoordinateKind::Orientation);
        transforms.push(b.ball(set, &format!("ball_{number}"), orientation));
        return;
    }
    let id = b.coordinate(set, &name, CoordinateKind::Rotation);
    match dice.below(4) {
        0 => b.coordinate_mut(id).range = Range::new(-0.7, 0.5),
        1 => {
            let range = Range { lower: Some(-0.3), upper: None, enforced: true };
            b.coordinate_mut(id).range = range;
        }
        2 if !scalars.is_empty() => {
            let leader = scalars[dice.below(scalars.len())];
            b.follow(id, leader);
        }
        _ => {}
    }
    scalars.push(id.into());
}

fn grow_component(
    b: &mut ModelBuilder,
    dice: &mut Dice,
    set: JointSetId,
    number: usize,
    scalars: &mut Vec<Signal>,
    transforms: &mut Vec<Signal>,
    bent: &mut HashSet<Signal>,
) {
    let name = format!("component_{number}");
    let any = |dice: &mut Dice| scalars[dice.below(scalars.len())];
    match dice.below(18) {
        11 => {
            let factor = grow_factor(b, dice, set, &name);
            let along = match dice.below(3) {
                0 => Along::Everywhere,
                1 => Along::Axis(dice.axis()),
                _ => Along::Volume(dice.axis()),
            };
            transforms.push(b.component(set, &name, Law::Scale(Scale { along }), vec![factor]));
            bent.extend(transforms.last());
        }
        12 => {
            let along = dice.axis();
            let across = along.cross(dice.vector(1.0) + Vec3::new(0.1, 0.2, 3.0)).normalized();
            let shear = Law::Shear(Shear { along, across });
            transforms.push(b.component(set, &name, shear, vec![any(dice)]));
            bent.extend(transforms.last());
        }
        13 => {
            let u = vec![-2.0, -0.8, 0.1, 0.7, 1.8];
            let path = [0.3, 0.1, 0.2].map(|slope| {
                let y = u.iter().map(|u| slope * u + dice.within(0.02)).collect();
                SimmSpline::new(u.clone(), y).unwrap()
            });
            let heading = Heading { forward: dice.axis(), up: Vec3::new(0.1, -0.9, 0.3) };
            let heading = (dice.below(2) == 0).then_some(heading);
            let track = Law::Curve(Track { path: Box::new(path), heading });
            transforms.push(b.component(set, &name, track, vec![any(dice)]));
        }
        14 => {
            let parameters = [("lift".to_owned(), vec![dice.within(0.2)])].into();
            let inputs = vec![any(dice), any(dice)];
            let cam = registry().make("cam", parameters).unwrap();
            transforms.push(b.component(set, &name, Law::Custom(cam), inputs));
            bent.extend(transforms.last());
        }
        15 => grow_cone(b, dice, set, &name, scalars, transforms),
        16 => {
            let half_axes = [0.9 + dice.within(0.5), 0.8 + dice.within(0.4)];
            let centre = [dice.within(0.2), dice.within(0.2)];
            let ellipse = Law::Ellipse(Ellipse::new(centre, half_axes, dice.within(2.0)).unwrap());
            let inputs = vec![any(dice), any(dice)];
            let limit = b.component(set, &name, ellipse, inputs);
            let Signal::Output(id, _) = limit else { return };
            scalars.extend((0..2).map(|k| Signal::Output(id, k)));
        }
        17 => {
            let count = 1 + dice.below(4);
            let normal = (0..count).map(|_| 0.5 + dice.within(1.5)).collect();
            let half_space = HalfSpace::new(normal, 1.0 + dice.within(0.8)).unwrap();
            let inputs = (0..count).map(|_| any(dice)).collect();
            let limit = b.component(set, &name, Law::HalfSpace(half_space), inputs);
            let Signal::Output(id, _) = limit else { return };
            scalars.extend((0..count as u32).map(|k| Signal::Output(id, k)));
        }
        9 => {
            let (passive, driver) = (any(dice), any(dice));
            let (lower, upper) = (dice.function(), dice.function());
            let depend = match dice.below(3) {
                0 => Depend { lower: Some(lower), upper: None },
                1 => Depend { lower: None, upper: Some(upper) },
                _ => Depend { lower: Some(lower), upper: Some(upper) },
            };
            scalars.push(b.depend(set, &name, passive, driver, depend));
        }
        0 => {
            let (input, function) = (any(dice), dice.function());
            scalars.push(b.map(set, &name, input, function));
        }
        1 => {
            let inputs = vec![any(dice), any(dice)];
            let function = if dice.below(2) == 0 {
                let slopes = vec![dice.within(0.6), dice.within(0.6)];
                FunctionOfSeveral::Linear { slopes, intercept: dice.within(0.1) }
            } else {
                let c: Vec<f64> = (0..6).map(|_| dice.within(0.3)).collect();
                let polynomial = MultivariatePolynomial::up_to_order(2, 2, &c).unwrap();
                FunctionOfSeveral::Polynomial(polynomial)
            };
            if dice.below(2) == 0 {
                scalars.push(b.combine(set, &name, inputs, function));
            } else {
                let [low, high] = [-1.0, 1.0].map(|side| vec![side * (1.0 + dice.within(0.5)); 2]);
                let inverse = vec![1.0 + dice.within(0.5), 0.1, 0.1, 2.0];
                let region = Region {
                    centre: vec![dice.within(0.2), 0.1],
                    distance: 2.0 + dice.within(1.0),
                    low,
                    high,
                    inverse,
                };
                let law = Law::Correlate(Correlate { function, region: Some(region) });
                scalars.push(b.component(set, &name, law, inputs));
            }
        }
        2 | 3 => {
            let (angle, axis) = (any(dice), dice.axis());
            transforms.push(b.rotate(set, &name, angle, axis));
        }
        4 => {
            let (distance, axis) = (any(dice), dice.axis());
            transforms.push(b.translate(set, &name, distance, axis));
        }
        5 => transforms.push(b.place(set, &name, dice.frame())),
        6 => {
            let angles = [any(dice), any(dice), any(dice)];
            let axis = [SurfaceAxis::OpenSim, SurfaceAxis::Normal][dice.below(2)];
            let glide = Law::Ellipsoid(Ellipsoid { radii: Vec3::new(0.07, 0.15, 0.09), axis });
            transforms.push(b.component(set, &name, glide, angles.to_vec()));
        }
        8 => {
            let (angle, axis) = (any(dice), dice.axis());
            let centre = if dice.below(2) == 0 {
                let ends = [-0.45, 0.35, 0.8];
                let ends = &ends[..[1, 3][dice.below(2)]];
                Centre::Intervals(ends.iter().map(|&to| (to, dice.vector(0.1))).collect())
            } else {
                let x = vec![-0.9, -0.1, 0.6, 1.0];
                Centre::Path(Box::new([0; 3].map(|_| {
                    let y = x.iter().map(|_| dice.within(0.1)).collect();
                    SimmSpline::new(x.clone(), y).unwrap()
                })))
            };
            transforms.push(b.pivot(set, &name, angle, Pivot::new(axis, centre).unwrap()));
        }
        7 => {
            // Small inputs keep the arc away from its discontinuity near a right angle.
            let angles = [any(dice), any(dice), any(dice)].map(|angle| {
                let name = format!("{name}_damped_{}", dice.below(1 << 30));
                b.map(set, &name, angle, Function::linear(0.1, 0.0))
            });
            let column = ConstantCurvature { neutral: [0.2, -0.1, 0.05], length: 0.2 };
            transforms.push(b.constant_curvature(set, &name, angles, column));
        }
        _ if !transforms.is_empty() => {
            let factors: Vec<Signal> =
                (0..1 + dice.below(3)).map(|_| transforms[dice.below(transforms.len())]).collect();
            let bends = factors.iter().any(|factor| bent.contains(factor));
            transforms.push(b.product(set, &name, factors));
            bent.extend(transforms.last().filter(|_| bends));
        }
        _ => {}
    }
}

/// Angles, coordinates of a point, and limits of what is between two segments, or a segment and the world.
fn grow_measure(
    b: &mut ModelBuilder,
    dice: &mut Dice,
    set: JointSetId,
    number: usize,
    rigid: &[SegmentId],
    scalars: &mut Vec<Signal>,
) {
    let name = format!("measure_{number}");
    let segment = rigid[dice.below(rigid.len())];
    let reference = rigid.get(dice.below(rigid.len() + 1)).copied();
    let ends = |reference: Option<SegmentId>| {
        [segment].into_iter().chain(reference).map(Signal::Segment).collect()
    };
    let mut outputs = |signal: Signal, count: u32| {
        let Signal::Output(id, _) = signal else { return };
        scalars.extend((0..count).map(|k| Signal::Output(id, k)));
    };
    if dice.below(3) == 0 {
        let along = vec![dice.axis(), dice.vector(1.0) + Vec3::new(0.0, 2.0, 0.0)];
        let law =
            RelativePosition { reference: reference.is_some(), point: dice.vector(0.3), along };
        let place = b.component(set, &name, Law::RelativePosition(law), ends(reference));
        outputs(place, 2);
        let reaches = HalfSpace::new(vec![1.0], 0.3 + dice.within(0.3)).unwrap();
        b.component(set, &format!("{name}_side"), Law::HalfSpace(reaches), vec![place]);
        return;
    }
    let law = RelativeOrientation { reference: reference.is_some() };
    let turned = b.component(set, &name, Law::RelativeOrientation(law), ends(reference));
    if dice.below(2) == 0 {
        let rest = dice.vector(1.0) + Vec3::new(0.0, 2.0, 0.0);
        let cone = grow_boundary(dice, rest.normalized());
        let limit = Law::Cone(JointCone { of: Swinging::Orientation, cone });
        b.component(set, &format!("{name}_cone"), limit, vec![turned]);
        return;
    }
    let names = match dice.below(4) {
        0 => AngleNames::SwingTwist(dice.below(3)),
        _ => AngleNames::Euler(EulerOrder::ALL[dice.below(12)]),
    };
    let mirrored = Reflection::new(dice.below(4));
    let angles = Law::Angles(Angles { names, mirrored });
    let angles = b.component(set, &format!("{name}_angles"), angles, vec![turned]);
    outputs(angles, 3);
}

/// A user's law that rotates, lifts and, with its second input, scales.
#[derive(Debug)]
pub(crate) struct Cam {
    pub(crate) lift: f64,
}

impl MotionLaw for Cam {
    fn transform<S: Scalar>(&self, inputs: &[S]) -> Affine<S> {
        let (s, c) = inputs[0].sin_cos();
        let turn = Mat3::rotation_about(Vec3::Z.cast(), (s, c));
        let (wave, _) = inputs[1].sin_cos();
        let stretch = Along::Axis(Vec3::X).matrix(S::one() + wave.scale(0.2));
        let lift = (S::one() - c).scale(self.lift);
        Affine::new(turn * stretch, Vec3::new(S::zero(), lift, S::zero()))
    }

    fn is_rigid(&self) -> bool {
        false
    }
}

/// An ellipsoid of the size of a rib cage, and points that may reach it.
fn grow_gliding(dice: &mut Dice) -> Gliding {
    let pose = Affine::new(Quat::exp(dice.vector(2.0)).to_mat3(), dice.vector(0.2));
    let radii = Vec3::new(0.2, 0.35, 0.25) + dice.vector(0.08);
    let mut pairs = vec![];
    for k in 0..1 + dice.below(3) {
        let first = dice.vector(0.15) + Vec3::new(0.0, 0.2, 0.0);
        let at = [k as f64 * 0.4 - 0.3, dice.within(0.5)];
        pairs.push(ContactPair { first, second: dice.vector(0.2), at });
    }
    Gliding::new(pose, radii, dice.axis(), pairs).expect("a body of ribs")
}

/// The laws that random models use.
pub(crate) fn registry() -> Registry {
    let mut registry = Registry::default();
    registry.register("cam", &["angle", "wave"], |parameters| {
        let lift = parameters.get("lift").and_then(|v| v.first());
        Ok(Cam { lift: *lift.ok_or("it needs a `lift` in metres")? })
    });
    registry
}

fn grow_factor(b: &mut ModelBuilder, dice: &mut Dice, set: JointSetId, name: &str) -> Signal {
    let id = b.coordinate(set, &format!("{name}_factor"), CoordinateKind::Scale);
    if dice.below(2) == 0 {
        b.coordinate_mut(id).range = Range::new(0.8, 1.3);
    }
    id.into()
}

/// A cone about a random direction, concave as often as not, now and then larger than a hemisphere.
fn grow_boundary(dice: &mut Dice, rest: Vec3) -> Cone {
    let across = rest.cross(Vec3::new(0.31, -0.72, 0.62)).normalized();
    let beside = rest.cross(across);
    let size = [0.5, 0.9, 1.9][dice.below(3)];
    let n = 5 + dice.below(6);
    let twist = (dice.below(4) > 0).then_some([-0.5, 0.6]);
    let points = (0..n).map(|i| {
        let (s, c) = (std::f64::consts::TAU * i as f64 / n as f64).sin_cos();
        let (far, near) = (size + dice.within(0.3 * size)).sin_cos();
        let direction = rest * near + (across * c + beside * s) * far;
        let own = twist.is_some() && dice.below(3) > 0;
        let twist = own.then(|| [-0.4 + dice.within(0.2), 0.5 + dice.within(0.2)]);
        ConePoint { direction, twist }
    });
    let points: Vec<ConePoint> = points.collect();
    let projection = [Projection::Nearest, Projection::TowardRest][dice.below(2)];
    let subdivisions = dice.below(3) as u32;
    Cone::new(rest, twist, points.clone(), subdivisions, projection)
        .or_else(|_| Cone::new(rest, twist, points, 0, projection))
        .expect("the points go around their rest direction")
}

fn grow_cone(
    b: &mut ModelBuilder,
    dice: &mut Dice,
    set: JointSetId,
    name: &str,
    scalars: &mut Vec<Signal>,
    transforms: &mut Vec<Signal>,
) {
    if dice.below(3) == 0 {
        let rest = dice.vector(1.0) + Vec3::new(0.0, 2.0, 0.0);
        let cone = grow_boundary(dice, rest.normalized());
        let q = b.coordinate(set, &format!("{name}_q"), CoordinateKind::Orientation);
        let limit = Law::Cone(JointCone { of: Swinging::Orientation, cone });
        let orientation = b.component(set, name, limit, vec![q.into()]);
        let ball = Law::Ball(Ball);
        transforms.push(b.component(set, &format!("{name}_ball"), ball, vec![orientation]));
        return;
    }
    let orders = EulerOrder::ALL;
    let order = orders[dice.below(orders.len())];
    let axes = [0, 1, 2].map(|i| order.axis(i));
    let angles = [(); 3].map(|()| scalars[dice.below(scalars.len())]);
    let (of, rest) = if dice.below(3) == 0 {
        let of = Swinging::Directions([axes[0], axes[1]]);
        (of, axes[2])
    } else {
        (Swinging::Angles(axes), dice.axis().normalized())
    };
    let count = if matches!(of, Swinging::Directions(_)) { 2 } else { 3 };
    let cone = grow_boundary(dice, rest);
    let inputs = angles[..count as usize].to_vec();
    let limit = b.component(set, name, Law::Cone(JointCone { of, cone }), inputs);
    let Signal::Output(id, _) = limit else { return };
    for k in 0..count {
        let turn = b.rotate(set, &format!("{name}_{k}"), Signal::Output(id, k), axes[k as usize]);
        transforms.push(turn);
        scalars.push(Signal::Output(id, k));
    }
}
