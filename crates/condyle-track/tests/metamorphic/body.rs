//! Random bodies as plain descriptions, so that the same body can be built in another order, by other names,
//! mirrored, or of another size.

use condyle_math::function::{Curve, Function, SimmSpline};
use condyle_math::{Affine, Quat, Vec3};
use condyle_model::model::{Closure, Condition};
use condyle_model::{
    CoordinateId, CoordinateKind, JointSetId, Model, ModelBuilder, Range, SegmentId,
};
use condyle_track::{MarkerTarget, PostureTarget, Rules, Targets, Tracker};
use std::f64::consts::PI;

/// SplitMix64 (Steele, Lea & Flood 2014): reproducible everywhere, no dependency.
#[derive(Clone)]
pub(crate) struct Dice(pub(crate) u64);

impl Dice {
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

    /// Between -1 and 1.
    pub(crate) fn unit(&mut self) -> f64 {
        (self.next() >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }

    pub(crate) fn vector(&mut self, size: f64) -> Vec3 {
        Vec3::new(self.unit(), self.unit(), self.unit()) * size
    }

    pub(crate) fn shuffled(&mut self, n: usize) -> Vec<usize> {
        let mut order: Vec<usize> = (0..n).collect();
        for i in (1..n).rev() {
            order.swap(i, self.below(i + 1));
        }
        order
    }

    fn axis(&mut self) -> Vec3 {
        let axes = [Vec3::X, Vec3::Y, Vec3::Z, -Vec3::Z];
        match self.below(6) {
            i @ 0..4 => axes[i],
            _ => (self.vector(1.0) + Vec3::new(0.1, 1.2, 0.0)).normalized(),
        }
    }
}

/// How a segment moves in its parent.
#[derive(Clone)]
enum Joint {
    /// Three slides and three turns without ends.
    Free,
    /// Three slides and a quaternion.
    Floating,
    /// Turns one after the other, each at most so far to either side.
    Turns(Vec<(Vec3, f64)>),
    /// A quaternion.
    Ball,
    /// A hinge that glides along a direction by a spline of its angle.
    Gliding { axis: Vec3, along: Vec3, by: [f64; 5], most: f64 },
    /// A hinge that turns by a share of the first angle of another joint.
    Follower { axis: Vec3, leader: usize, share: f64, offset: f64 },
}

impl Joint {
    /// Whether its first angle has one number for a posture, neither whole turns nor the other three angles:
    /// what follows it, and its rest, tell those apart.
    fn has_one_number(&self) -> bool {
        matches!(self, Self::Turns(turns) if turns[0].1 < 1.5)
    }
}

#[derive(Clone)]
struct Part {
    parent: Option<usize>,
    /// The joint in the parent, turned by a rotation vector, and in the segment.
    place: Vec3,
    turned: Vec3,
    joint: Joint,
}

/// A marker: its segment, its place, its weight.
#[derive(Clone)]
struct Point {
    part: usize,
    place: Vec3,
    weight: f64,
}

/// A posture term: coordinates by part and number, with their factors.
#[derive(Clone)]
struct Rest {
    terms: Vec<(usize, usize, f64)>,
    rest: f64,
    stiffness: f64,
}

/// A body and what is tracked of it.
#[derive(Clone)]
pub(crate) struct Body {
    parts: Vec<Part>,
    points: Vec<Point>,
    rests: Vec<Rest>,
    /// In which order segments are made, and the model's markers.
    pub(crate) order: Vec<usize>,
    pub(crate) marker_order: Vec<usize>,
    /// What each name begins with.
    pub(crate) prefix: &'static str,
    /// Whether loops are added that hold in every posture.
    pub(crate) redundant: bool,
    /// Markers that nothing tracks.
    pub(crate) unused: Vec<Vec3>,
}

impl Body {
    /// Two to seven segments, free in the world.
    pub(crate) fn random(seed: u64) -> Self {
        let mut dice = Dice(seed);
        let dice = &mut dice;
        let mut parts: Vec<Part> = vec![];
        for i in 0..2 + dice.below(6) {
            let joint = if i == 0 {
                [Joint::Free, Joint::Floating][dice.below(2)].clone()
            } else {
                Self::joint(dice, &parts)
            };
            let parent = (i > 0).then(|| i - 1 - dice.below(i.min(3)));
            let place = if i == 0 { Vec3::ZERO } else { dice.vector(0.25) };
            let turned = if i > 0 && dice.below(2) == 0 { dice.vector(1.5) } else { Vec3::ZERO };
            parts.push(Part { parent, place, turned, joint });
        }
        let mut points = vec![];
        for part in 0..parts.len() {
            // A hinge may have one or two; with so few several angles have mirrored solutions.
            let hinge = match &parts[part].joint {
                Joint::Turns(turns) => turns.len() == 1,
                Joint::Gliding { .. } | Joint::Follower { .. } => true,
                _ => false,
            };
            let count = [4, 3, 4, 3, 4, 2, 1][dice.below(7)];
            for _ in 0..if hinge { count } else { count.max(3) } {
                let weight = [1.0, 1.0, 1.0, 2.0, 0.5, 10.0][dice.below(6)];
                points.push(Point { part, place: dice.vector(0.3), weight });
            }
        }
        let (parts_len, points_len) = (parts.len(), points.len());
        let mut body = Self {
            parts,
            points,
            rests: vec![],
            order: (0..parts_len).collect(),
            marker_order: (0..points_len).collect(),
            prefix: "",
            redundant: false,
            unused: vec![],
        };
        if dice.below(2) == 0 {
            body.rests = body.random_rests(dice);
        }
        body
    }

    fn joint(dice: &mut Dice, parts: &[Part]) -> Joint {
        // A circle, nearly one, arms and knees, and none.
        let mosts = [PI, 0.95 * PI, 1.2, 2.4, f64::INFINITY];
        let most = mosts[dice.below(5)];
        let angles = |part: &Part| part.joint.has_one_number();
        let leaders: Vec<usize> = (0..parts.len()).filter(|&i| angles(&parts[i])).collect();
        match dice.below(8) {
            0 => Joint::Ball,
            1 | 2 => Joint::Turns(vec![(dice.axis(), most)]),
            3 => Joint::Turns(vec![(Vec3::X, most), (Vec3::Z, mosts[dice.below(5)])]),
            4 | 5 => {
                let orders = [
                    [Vec3::Y, Vec3::X, Vec3::Z],
                    [Vec3::Z, Vec3::X, Vec3::Y],
                    [Vec3::Y, Vec3::X, Vec3::Y],
                ];
                let middle = [1.2, PI, 1.5, f64::INFINITY][dice.below(4)];
                let mosts = [most, middle, mosts[dice.below(5)]];
                Joint::Turns(orders[dice.below(3)].into_iter().zip(mosts).collect())
            }
            6 => {
                let by = [(); 5].map(|()| 0.03 * dice.unit());
                let (axis, along) = (dice.axis(), dice.axis());
                Joint::Gliding { axis, along, by, most: most.min(2.4) }
            }
            _ if !leaders.is_empty() => Joint::Follower {
                axis: dice.axis(),
                leader: leaders[dice.below(leaders.len())],
                share: dice.unit(),
                offset: 0.2 * dice.unit(),
            },
            _ => Joint::Turns(vec![(dice.axis(), most)]),
        }
    }

    fn random_rests(&self, dice: &mut Dice) -> Vec<Rest> {
        let bears = |part: &usize| self.parts[*part].joint.has_one_number();
        let bearers: Vec<usize> = (0..self.parts.len()).filter(bears).collect();
        let mut rests = vec![];
        for (i, &part) in bearers.iter().enumerate() {
            if dice.below(3) == 0 {
                continue;
            }
            let mut terms = vec![(part, 0, 1.0)];
            if i > 0 && dice.below(2) == 0 {
                terms.push((bearers[i - 1], 0, 2.0 * dice.unit()));
            }
            rests.push(Rest { terms, rest: 0.5 * dice.unit(), stiffness: 1e-5 });
        }
        rests
    }

    pub(crate) fn points_len(&self) -> usize {
        self.points.len()
    }

    pub(crate) fn parts_len(&self) -> usize {
        self.parts.len()
    }

    pub(crate) fn parent(&self, part: usize) -> Option<usize> {
        self.parts[part].parent
    }

    /// Its mirror image in the plane z = 0; coordinates keep their numbers.
    pub(crate) fn mirrored(&self) -> Self {
        let mut body = self.clone();
        let flip = |v: &mut Vec3| v.z = -v.z;
        // A rotation about an axis is mirrored to one about the mirrored axis, the other way round.
        let turn = |v: &mut Vec3| *v = Vec3::new(-v.x, -v.y, v.z);
        for part in &mut body.parts {
            flip(&mut part.place);
            turn(&mut part.turned);
            match &mut part.joint {
                Joint::Turns(turns) => turns.iter_mut().for_each(|(axis, _)| turn(axis)),
                Joint::Gliding { axis, along, .. } => (turn(axis), flip(along)).0,
                Joint::Follower { axis, .. } => turn(axis),
                Joint::Free | Joint::Floating | Joint::Ball => {}
            }
        }
        body.points.iter_mut().for_each(|p| flip(&mut p.place));
        body
    }

    /// With all lengths so many times as long.
    pub(crate) fn resized(&self, factor: f64) -> Self {
        let mut body = self.clone();
        for part in &mut body.parts {
            part.place = part.place * factor;
            if let Joint::Gliding { by, .. } = &mut part.joint {
                by.iter_mut().for_each(|y| *y *= factor);
            }
        }
        body.points.iter_mut().for_each(|p| p.place = p.place * factor);
        // P is in m².
        body.rests.iter_mut().for_each(|rest| rest.stiffness *= factor * factor);
        body
    }

    /// With all weights so many times as large.
    pub(crate) fn reweighed(&self, factor: f64) -> Self {
        let mut body = self.clone();
        body.points.iter_mut().for_each(|p| p.weight *= factor);
        body
    }

    pub(crate) fn build(&self) -> Model {
        let mut b = ModelBuilder::new("body");
        let name = |kind: &str, i: usize| format!("{}{kind}{i}", self.prefix);
        let mut made: Vec<Option<(SegmentId, JointSetId, Vec<CoordinateId>)>> =
            vec![None; self.parts.len()];
        for &i in &self.order {
            let part = &self.parts[i];
            let segment = b.segment(&name("segment", i), None);
            let frame = Affine::new(Quat::exp(part.turned).to_mat3(), part.place);
            b.place_joint_frames(segment, frame, Affine::IDENTITY);
            let set = b.joint_set(&name("joint", i));
            let ids = self.coordinates(&mut b, segment, set, &part.joint);
            made[i] = Some((segment, set, ids));
        }
        let made: Vec<_> = made.into_iter().flatten().collect();
        for (part, (segment, set, ids)) in self.parts.iter().zip(&made) {
            b.set_parent(*segment, part.parent.map(|parent| made[parent].0));
            if let Joint::Follower { leader, share, offset, .. } = part.joint {
                let law = Function::linear(share, offset);
                let law = b.map(*set, "law", made[leader].2[0], law);
                b.follow(ids[0], law);
            }
        }
        if self.redundant {
            self.close(&mut b, &made);
        }
        self.unused.iter().enumerate().for_each(|(i, &place)| {
            b.marker(&name("unused", i), Some(made[i % made.len()].0), place);
        });
        for &i in &self.marker_order {
            let point = &self.points[i];
            b.marker(&name("marker", i), Some(made[point.part].0), point.place);
        }
        b.build().unwrap()
    }

    /// The coordinates and the motion of a joint.
    fn coordinates(
        &self,
        b: &mut ModelBuilder,
        segment: SegmentId,
        set: JointSetId,
        joint: &Joint,
    ) -> Vec<CoordinateId> {
        let name = |kind: &str, i: usize| format!("{}{kind}{i}", self.prefix);
        let (mut ids, mut factors) = (vec![], vec![]);
        if let Joint::Free | Joint::Floating = joint {
            for (i, axis) in [Vec3::X, Vec3::Y, Vec3::Z].into_iter().enumerate() {
                let id = b.coordinate(set, &name("slide", i), CoordinateKind::Translation);
                factors.push(b.translate(set, &name("move", i), id, axis));
                ids.push(id);
            }
        }
        let free = [(Vec3::Y, f64::INFINITY), (Vec3::X, f64::INFINITY), (Vec3::Z, f64::INFINITY)];
        let turns = match joint {
            Joint::Free => free.to_vec(),
            Joint::Turns(turns) => turns.clone(),
            Joint::Gliding { axis, most, .. } => vec![(*axis, *most)],
            Joint::Follower { axis, .. } => vec![(*axis, f64::INFINITY)],
            Joint::Floating | Joint::Ball => {
                let id = b.coordinate(set, &name("ball", 0), CoordinateKind::Orientation);
                factors.push(b.ball(set, &name("turn", 0), id));
                ids.push(id);
                vec![]
            }
        };
        for (i, (axis, most)) in turns.into_iter().enumerate() {
            let id = b.coordinate(set, &name("angle", i), CoordinateKind::Rotation);
            if most.is_finite() {
                b.coordinate_mut(id).range = Range::new(-most, most);
            }
            if let Joint::Gliding { along, by, .. } = joint {
                let x = [-2.5, -1.0, 0.0, 1.0, 2.5].to_vec();
                let curve = Curve::SimmSpline(SimmSpline::new(x, by.to_vec()).unwrap());
                let by = b.map(set, &name("by", i), id, Function { factor: 1.0, curve });
                factors.push(b.translate(set, &name("glide", i), by, *along));
            }
            factors.push(b.rotate(set, &name("turn", i), id, axis));
            ids.push(id);
        }
        let motion = b.product(set, &name("motion", 0), factors);
        b.output(set, segment, motion);
        ids
    }

    /// Loops that hold in every posture: the centre of each joint is one point of both segments, and a
    /// follower follows.
    fn close(&self, b: &mut ModelBuilder, made: &[(SegmentId, JointSetId, Vec<CoordinateId>)]) {
        for (i, part) in self.parts.iter().enumerate() {
            let condition = match part.joint {
                Joint::Turns(_) | Joint::Ball => {
                    let parent = part.parent.map(|parent| made[parent].0);
                    Condition::Points { at: [(Some(made[i].0), Vec3::ZERO), (parent, part.place)] }
                }
                Joint::Follower { leader, share, offset, .. } => Condition::Coupling {
                    follower: made[i].2[0],
                    driver: made[leader].2[0],
                    function: Function::linear(share, offset),
                },
                _ => continue,
            };
            b.closure(Closure { name: format!("{}loop{i}", self.prefix), condition });
        }
    }

    /// All markers in this order are tracked; `twice` are there twice, at half their weight.
    pub(crate) fn tracker(&self, tracked: &[usize], twice: &[usize]) -> Tracker {
        let model = self.build();
        let place = |i: usize| {
            let name = format!("{}marker{i}", self.prefix);
            model.markers().iter().position(|m| m.name == name).unwrap()
        };
        let mut markers = vec![];
        for &i in tracked {
            let half = if twice.contains(&i) { 0.5 } else { 1.0 };
            let target = MarkerTarget { marker: place(i), weight: half * self.points[i].weight };
            markers.push(target);
        }
        markers.extend(
            twice
                .iter()
                .map(|&i| MarkerTarget { marker: place(i), weight: 0.5 * self.points[i].weight }),
        );
        let postures = self.rests.iter().map(|rest| PostureTarget {
            terms: rest.terms.iter().map(|&(part, i, f)| (self.find(&model, part, i), f)).collect(),
            rest: rest.rest,
            stiffness: rest.stiffness,
        });
        let postures = postures.collect();
        let targets = Targets { markers, postures, ..Targets::default() };
        Tracker::new(model, targets, Rules::default())
    }

    fn find(&self, model: &Model, part: usize, angle: usize) -> CoordinateId {
        let (set, name) =
            (format!("{}joint{part}", self.prefix), format!("{}angle{angle}", self.prefix));
        let named = |id: &CoordinateId| {
            let coordinate = model.coordinate(*id);
            model.joint_sets()[coordinate.joint_set.index()].name == set && coordinate.name == name
        };
        model.coordinate_ids().find(named).unwrap()
    }

    /// The segment of a part, and the coordinates of its joint, in a model built from this body.
    pub(crate) fn joint_of(&self, model: &Model, part: usize) -> (SegmentId, Vec<CoordinateId>) {
        let segment = model.find_segment(&format!("{}segment{part}", self.prefix)).unwrap();
        let set = model.segment(segment).joint_set.unwrap();
        let ids = model.coordinate_ids().filter(|&id| model.coordinate(id).joint_set == set);
        (segment, ids.collect())
    }
}
