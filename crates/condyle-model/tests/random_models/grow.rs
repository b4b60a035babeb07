//! Models grown at random from a seed.

use condyle_math::function::{
    Curve, Function, FunctionOfSeveral, MultivariatePolynomial, Polynomial, SimmSpline,
};
use condyle_math::{Affine, Quat, Vec3};
use condyle_model::component::{Centre, Compensate, ConstantCurvature, Depend, Pivot};
use condyle_model::{CoordinateKind, JointSetId, Model, ModelBuilder, Range, SegmentId, Source};

/// SplitMix64 (Steele, Lea & Flood 2014): reproducible everywhere, no dependency.
pub(crate) struct Dice(u64);

impl Dice {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    fn below(&mut self, n: usize) -> usize {
        (self.next() % n as u64) as usize
    }

    fn within(&mut self, size: f64) -> f64 {
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
    let mut dice = Dice(seed);
    let mut b = ModelBuilder::new("random");
    let mut segments: Vec<SegmentId> = vec![];
    let mut parents: Vec<Option<SegmentId>> = vec![];
    let mut scalars: Vec<Source> = vec![];
    let mut transforms: Vec<Source> = vec![];
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
        for c in 0..1 + dice.below(5) {
            grow_component(&mut b, &mut dice, set, c, &mut scalars, &mut transforms);
        }
        if let Some(parent) = parent
            && dice.below(3) == 0
        {
            // Undo the parent, or all, before a turn of its own.
            let ancestors = if dice.below(2) == 0 { vec![parent] } else { above(parent) };
            let weight = [1.0, 1.0, 0.5][dice.below(3)];
            let compensate = Compensate { segment, ancestors, weight };
            let undo = b.compensate(set, "compensate", compensate);
            let own = b.rotate(set, "own", scalars[0], Vec3::X);
            let motion = b.product(set, "compensated", vec![undo, own]);
            b.output(set, segment, motion);
        } else if !transforms.is_empty() && dice.below(8) > 0 {
            // Often the newest transform, sometimes one that moves another segment already.
            let pick = transforms.len() - 1 - dice.below(transforms.len().min(3));
            b.output(set, segment, transforms[pick]);
        }
    }
    let model = b.build().unwrap_or_else(|findings| panic!("seed {seed}: {findings:?}"));
    let mut stored = model.defaults();
    for id in model.coordinate_ids() {
        let place = model.stored_range(id);
        if place.len() == 4 {
            stored[place].copy_from_slice(&Quat::exp(dice.vector(1.8)).to_array());
        } else {
            stored[place.start] = dice.within(1.2);
        }
    }
    (model, stored)
}

fn grow_coordinate(
    b: &mut ModelBuilder,
    dice: &mut Dice,
    set: JointSetId,
    number: usize,
    scalars: &mut Vec<Source>,
    transforms: &mut Vec<Source>,
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
    scalars: &mut Vec<Source>,
    transforms: &mut Vec<Source>,
) {
    let name = format!("component_{number}");
    let any = |dice: &mut Dice| scalars[dice.below(scalars.len())];
    match dice.below(11) {
        9 => {
            let (passive, driver) = (any(dice), any(dice));
            let (lower, upper) = (dice.function(), dice.function());
            let depend = match dice.below(3) {
                0 => Depend { passive, driver, lower: Some(lower), upper: None },
                1 => Depend { passive, driver, lower: None, upper: Some(upper) },
                _ => Depend { passive, driver, lower: Some(lower), upper: Some(upper) },
            };
            scalars.push(b.depend(set, &name, depend));
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
            scalars.push(b.combine(set, &name, inputs, function));
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
            transforms.push(b.ellipsoid(set, &name, angles, Vec3::new(0.07, 0.15, 0.09)));
        }
        8 => {
            let (angle, axis) = (any(dice), dice.axis());
            let centre = if dice.below(2) == 0 {
                Centre::Intervals([-0.45, 0.35, 0.8].map(|to| (to, dice.vector(0.1))).to_vec())
            } else {
                let x = vec![-0.9, -0.1, 0.6, 1.0];
                Centre::Path(Box::new([0; 3].map(|_| {
                    let y = x.iter().map(|_| dice.within(0.1)).collect();
                    SimmSpline::new(x.clone(), y).unwrap()
                })))
            };
            transforms.push(b.pivot(set, &name, Pivot::new(angle, axis, centre).unwrap()));
        }
        7 => {
            // Damped inputs keep the arc away from its declared jump at a right angle.
            let angles = [any(dice), any(dice), any(dice)].map(|angle| {
                let name = format!("{name}_damped_{}", dice.below(1 << 30));
                b.map(set, &name, angle, Function::linear(0.1, 0.0))
            });
            let column = ConstantCurvature { angles, neutral: [0.2, -0.1, 0.05], length: 0.2 };
            transforms.push(b.constant_curvature(set, &name, column));
        }
        _ if !transforms.is_empty() => {
            let factors =
                (0..1 + dice.below(3)).map(|_| transforms[dice.below(transforms.len())]).collect();
            transforms.push(b.product(set, &name, factors));
        }
        _ => {}
    }
}
