//! Every kind of target on random trees: its gradient against central differences of its value, its
//! Hessian, where residuals vanish and Gauss and Newton's is exact, against those of its gradient.

use super::*;
use crate::{Rules, Scratch};
use condyle_math::function::Function;
use condyle_math::{Quat, Vec3};
use condyle_model::component::{Along, Scale};
use condyle_model::model::{Closure, Condition};
use condyle_model::{Law, Mode, ModelBuilder, Pose, Program, SegmentId};
use condyle_solve::least_squares::Problem;

/// Numbers between -1 and 1: SplitMix64 (Steele, Lea & Flood 2014).
pub(crate) struct Dice(pub u64);

impl Dice {
    pub(crate) fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }

    pub(crate) fn vector(&mut self) -> Vec3 {
        Vec3::new(self.next(), self.next(), self.next())
    }
}

/// A tree of a ball, hinges, a slide, a hinge that follows another and a stretch, with two markers a
/// segment, and the end of a limb tied to a point of the world.
pub(crate) fn tree(seed: u64, tied_to: Vec3) -> Model {
    let mut dice = Dice(seed);
    let mut b = ModelBuilder::new("tree");
    let mut segments: Vec<SegmentId> = vec![];
    for i in 0..9_usize {
        let branch = (dice.next().abs() * i as f64) as usize;
        let segment = b.segment(&format!("s{i}"), (i > 0).then(|| segments[branch]));
        b.place_joint(segment, dice.vector());
        let (joint, axis) = (format!("j{i}"), dice.vector().normalized());
        match i {
            0 => drop(b.ball_joint(&joint, segment)),
            1 => {
                let set = b.joint_set(&joint);
                let slide = b.coordinate(set, "q", CoordinateKind::Translation);
                let motion = b.translate(set, "slide", slide, axis);
                b.output(set, segment, motion);
            }
            2 => {
                let set = b.joint_set(&joint);
                let factor = b.coordinate(set, "q", CoordinateKind::Scale);
                let scale = Law::Scale(Scale { along: Along::Axis(axis) });
                let motion = b.component(set, "stretch", scale, vec![factor.into()]);
                b.output(set, segment, motion);
            }
            _ => drop(b.hinge(&joint, segment, "q", axis)),
        }
        (0..2).for_each(|k| b.marker(&format!("m{i}_{k}"), Some(segment), dice.vector()));
        segments.push(segment);
    }
    let [leader, follower] = [6, 7].map(|i| b.coordinate_at(i).unwrap());
    let set = b.coordinates()[7].joint_set;
    let source = b.map(set, "follow", leader, Function::linear(-0.7, 0.1));
    b.follow(follower, source);
    let at = [(Some(segments[8]), Vec3::Y), (None, tied_to)];
    b.closure(Closure { name: "tie".to_owned(), condition: Condition::Points { at } });
    b.build().unwrap()
}

/// A tracker for which one posture is at rest in every way, and that posture.
fn at_rest(seed: u64) -> (Tracker, Vec<f64>, Vec<Option<[f64; 3]>>) {
    let mut dice = Dice(!seed);
    let model = tree(seed, Vec3::ZERO);
    let (mut rest, mut step) = (model.defaults(), vec![0.0; model.tangent_len()]);
    step.iter_mut().for_each(|x| *x = 0.6 * dice.next());
    model.retract(&model.defaults(), &step, &mut rest);
    let program = Program::compile(&model);
    let mut pose = Pose::new(&program);
    program.evaluate(&rest, Mode::Open, &mut pose).unwrap();
    let ids: Vec<_> = model.coordinate_ids().skip(1).collect();
    let value = |&id: &CoordinateId| pose.coordinate(&model, id)[0];
    let terms: Vec<_> = ids[1..].iter().map(|&id| (id, dice.next())).collect();
    let sum = terms.iter().map(|(id, factor)| factor * value(id)).sum();
    let wanted = |id| CoordinateTarget {
        coordinate: id,
        weight: 0.5 + dice.next().abs(),
        wanted: Wanted::Constant(value(&id)),
    };
    let oriented = |id| OrientationTarget {
        segment: id,
        weight: 0.7,
        wanted: vec![Some(Quat::from_mat3(pose.segment(id).linear))],
    };
    let rigid = model.segment_ids().filter(|&id| !program.deforms(id));
    // Lines across the tree, the stretched segment among them, and a point of each segment.
    let all: Vec<SegmentId> = model.segment_ids().collect();
    let ends = all.iter().zip(all.iter().rev()).filter(|(a, b)| a != b);
    let line = |(&a, &b): (&SegmentId, &SegmentId)| {
        let ends = [(a, Vec3::X), (b, Vec3::Z)];
        let [from, to] = ends.map(|(id, point)| pose.segment(id) * point);
        let wanted = vec![Some((to - from).normalized())];
        DirectionTarget { from: ends[0], to: ends[1], weight: 0.9, wanted }
    };
    let place = |&segment: &SegmentId| PlaceTarget {
        segment,
        point: Vec3::Y,
        weight: 1.3,
        wanted: vec![Some(pose.segment(segment) * Vec3::Y)],
    };
    let targets = Targets {
        directions: ends.map(line).collect(),
        places: all.iter().map(place).collect(),
        marker_factors: vec![],
        orientations: rigid.map(oriented).collect(),
        coordinates: ids.iter().copied().map(wanted).collect(),
        markers: (0..18).map(|i| MarkerTarget { marker: i, weight: 1.0 + i as f64 }).collect(),
        postures: vec![PostureTarget { terms, rest: sum, stiffness: 0.3 }],
        closure_weight: Some(2.0),
    };
    let at = |m: &condyle_model::model::Marker| Some((pose.frame(m.segment) * m.point).to_array());
    let seen = model.markers().iter().map(at).collect();
    let end = model.segment_ids().last().unwrap();
    let tied = tree(seed, pose.segment(end) * Vec3::Y);
    (Tracker::new(tied, targets, Rules::default()), rest, seen)
}

/// Value, gradient and Hessian of one kind.
fn of_kind(
    tracker: &Tracker,
    seen: &[Option<[f64; 3]>],
    kind: usize,
    stored: &[f64],
) -> (f64, LocalModel) {
    let mut scratch = Scratch::new(tracker);
    let buffers = &mut scratch.buffers;
    let (pose, jacobian) = (&mut buffers.pose, &mut buffers.jacobian);
    tracker.part.evaluate_with_jacobian(stored, pose, jacobian).unwrap();
    buffers.closures.update(&tracker.model, &tracker.part, pose, Some(jacobian));
    let mut frame = Frame { tracker, seen, index: 0, buffers };
    frame.weigh();
    let mut local = scratch.solver.local().clone();
    local.hessian.fill(0.0);
    let (part, target) = kinds(tracker).into_iter().nth(kind).unwrap();
    let value = target.value(&mut frame);
    target.linearise(&mut frame, &mut local);
    (value * if matches!(part, Part::Mean) { frame.marker_scale() } else { 1.0 }, local)
}

#[test]
fn a_rejected_step_leaves_the_model_of_the_current_posture() {
    for seed in 0..10 {
        let (tracker, rest, seen) = at_rest(seed);
        let mut scratch = Scratch::new(&tracker);
        scratch.buffers.current.copy_from_slice(&rest);
        let mut local = scratch.solver.local().clone();
        local.curved = true;
        let n = tracker.unknown_len();
        let mut limits = vec![0.0; tracker.limit_rows];
        let buffers = &mut scratch.buffers;
        let mut frame = Frame { tracker: &tracker, seen: &seen, index: 0, buffers };
        frame.weigh();
        frame.evaluate(&vec![0.0; n], &mut [], &mut limits);
        frame.accept();
        frame.linearise(&mut local);
        let before = local.clone();
        frame.evaluate(&vec![0.1; n], &mut [], &mut limits);
        frame.linearise(&mut local);
        assert_eq!(local.gradient, before.gradient, "{seed}");
        assert_eq!(local.hessian, before.hessian, "{seed}");
    }
}

#[test]
fn gradients_and_hessians_are_those_of_the_values() {
    let step = 1e-5;
    for seed in 0..40 {
        let (tracker, rest, seen) = at_rest(seed);
        let n = tracker.unknown_len();
        let moved = |from: &[f64], steps: &mut dyn FnMut(usize) -> f64| {
            let mut along = vec![0.0; tracker.model.tangent_len()];
            (0..n).for_each(|i| along[tracker.directions[i] as usize] = steps(i));
            let mut to = from.to_vec();
            tracker.model.retract(from, &along, &mut to);
            to
        };
        let mut dice = Dice(seed + 1000);
        let away = moved(&rest, &mut |_| 0.3 * dice.next());
        for kind in 0..kinds(&tracker).len() {
            let at = |stored: &[f64]| of_kind(&tracker, &seen, kind, stored);
            let (value, local) = at(&away);
            assert!(value > 0.0, "kind {kind} says nothing");
            let exact = at(&rest).1.hessian;
            let largest = |list: &[f64]| list.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
            for i in 0..n {
                let near = |from: &[f64]| {
                    let unit = |h: f64| move |j| if i == j { h } else { 0.0 };
                    [step, -step].map(|h| at(&moved(from, &mut unit(h))))
                };
                let slope = |a: f64, b: f64| (a - b) / (2.0 * step);
                let [ahead, behind] = near(&away);
                let off = (slope(ahead.0, behind.0) - local.gradient[i]).abs();
                assert!(off < 1e-7 * largest(&local.gradient), "{seed} kind {kind} {i}: {off}");
                // The prior of a quaternion is a ridge without a value.
                if matches!(kinds(&tracker)[kind].0, Part::Unreported)
                    && tracker.stored[i].is_none()
                {
                    continue;
                }
                let [ahead, behind] = near(&rest).map(|(_, local)| local.gradient);
                for row in i..n {
                    let off = (slope(ahead[row], behind[row]) - exact[row * n + i]).abs();
                    assert!(off < 1e-7 * largest(&exact), "{seed} kind {kind} {row}, {i}: {off}");
                }
            }
        }
    }
}
