//! A stream answers as the frames of a recording one by one, without allocating. One test alone in its
//! binary, because the allocator counts for the whole process.

use condyle_math::Vec3;
use condyle_math::function::Function;
use condyle_model::model::{Closure, Condition};
use condyle_model::{Mode, Model, ModelBuilder, Pose, Program, Range};
use condyle_track::{
    CoordinateTarget, DirectionTarget, FrameAnswer, MarkerTarget, PlaceTarget, PostureTarget,
    Rules, Scratch, Stream, Targets, Tracker, Wanted, cut, sequence,
};
use stats_alloc::{INSTRUMENTED_SYSTEM, Region, StatsAlloc};
use std::alloc::System;

#[global_allocator]
static GLOBAL: &StatsAlloc<System> = &INSTRUMENTED_SYSTEM;

/// A ball with a limb of five hinges, the last of which follows the first within a range, and a rod that
/// ties the limb's end to the ball, so that there are rows of both kinds.
fn limb() -> Model {
    let mut b = ModelBuilder::new("limb");
    let mut segment = b.segment("root", None);
    b.ball_joint("root", segment);
    let root = segment;
    let corners = [Vec3::X, Vec3::Y, Vec3::Z].map(|x| x * 0.1);
    let mark = |b: &mut ModelBuilder, name: &str, segment| {
        for (i, &at) in corners.iter().enumerate() {
            b.marker(&format!("{name}{i}"), Some(segment), at);
        }
    };
    mark(&mut b, "root", segment);
    for (i, axis) in [Vec3::Z, Vec3::X, Vec3::Z, Vec3::Y, Vec3::Z].into_iter().enumerate() {
        let name = format!("s{i}");
        segment = b.segment(&name, Some(segment));
        b.place_joint(segment, Vec3::new(0.05, -0.3, 0.0));
        let (_, angle) = b.hinge(&name, segment, "angle", axis);
        b.coordinate_mut(angle).range = Range::new(-0.35, 0.5);
        mark(&mut b, &name, segment);
    }
    let [leader, follower] = [1, 5].map(|i| b.coordinate_at(i).unwrap());
    let set = b.coordinates()[5].joint_set;
    let source = b.map(set, "follow", leader, Function::linear(0.8, 0.0));
    b.follow(follower, source);
    let at = [(Some(root), Vec3::X), (Some(segment), Vec3::X)];
    b.closure(Closure {
        name: "rod".to_owned(),
        condition: Condition::Distance { at, distance: 1.45 },
    });
    b.build().unwrap()
}

/// What is seen of a swinging limb; the rod is not quite of the length that the markers have, and a
/// marker is missing now and then.
fn recorded(model: &Model, frames: usize) -> Vec<Vec<Option<[f64; 3]>>> {
    let program = Program::compile(model);
    let mut pose = Pose::new(&program);
    let mut seen = |frame: usize| {
        let mut stored = model.defaults();
        let t = 0.05 * frame as f64;
        (0..5).for_each(|i| stored[4 + i] = 0.4 * (t + i as f64).sin());
        program.evaluate(&stored, Mode::Open, &mut pose).unwrap();
        let places = model.markers().iter().enumerate().map(|(i, m)| {
            let missing = (frame + 5 * i).is_multiple_of(23);
            (!missing).then(|| (pose.frame(m.segment) * m.point).to_array())
        });
        places.collect()
    };
    (0..frames).map(&mut seen).collect()
}

/// Allocations and reallocations during `call`.
fn allocations(call: impl FnOnce()) -> usize {
    let region = Region::new(GLOBAL);
    call();
    let change = region.change();
    change.allocations + change.reallocations
}

#[test]
fn a_stream_equals_its_frames_one_by_one_and_allocates_nothing() {
    assert!(allocations(|| drop(std::hint::black_box(vec![1_u8; 64]))) >= 1, "the counter counts");
    let model = limb();
    let seen = recorded(&model, 60);
    let angle = |i| model.coordinate_ids().nth(i).unwrap();
    let segment = |i| model.segment_ids().nth(i).unwrap();
    for closure_weight in [None, Some(0.1)] {
        let targets = Targets {
            marker_factors: vec![],
            markers: (0..18).map(|marker| MarkerTarget { marker, weight: 1.0 }).collect(),
            coordinates: vec![CoordinateTarget {
                coordinate: angle(2),
                weight: 1e-4,
                wanted: Wanted::PerFrame((0..60).map(|i| 0.01 * f64::from(i)).collect()),
            }],
            orientations: vec![],
            directions: vec![DirectionTarget {
                from: (segment(0), Vec3::ZERO),
                to: (segment(3), Vec3::X),
                weight: 1e-6,
                wanted: vec![Some(Vec3::Y); 60],
            }],
            places: vec![PlaceTarget {
                segment: segment(2),
                point: Vec3::Z,
                weight: 1e-7,
                wanted: vec![Some(Vec3::X); 60],
            }],
            postures: vec![PostureTarget {
                terms: vec![(angle(3), 1.0), (angle(5), -1.0)],
                rest: 0.2,
                stiffness: 1e-4,
            }],
            closure_weight,
        };
        let tracker = Tracker::new(model.clone(), targets, Rules::default());
        let mut scratch = Scratch::new(&tracker);
        let chunks = cut(60);
        let recorded = |frame: usize, to: &mut Vec<_>| to.clone_from(&seen[frame]);
        let keys = sequence::keys(&tracker, &mut scratch, &recorded, &chunks);
        let batch =
            sequence::solve_chunk(&tracker, &mut scratch, &recorded, &chunks[0], &keys[0], 60);
        assert!(batch.iter().all(|a| a.status.is_solved() && a.posture > 0.0));
        let tracker = std::sync::Arc::new(tracker);
        // The thread of the test harness may allocate meanwhile: the least of five attempts.
        let attempt = |_| {
            let mut stream = Stream::new(tracker.clone());
            let same = |a: &FrameAnswer, b: &FrameAnswer| {
                assert_eq!(a.coordinates, b.coordinates);
                assert_eq!((a.objective, a.posture), (b.objective, b.posture));
                assert_eq!((a.iterations, a.status), (b.iterations, b.status));
            };
            same(stream.next(&seen[0]), &batch[0]);
            same(stream.next(&seen[1]), &batch[1]);
            let rest = seen.iter().zip(&batch).skip(2);
            allocations(|| rest.for_each(|(seen, answer)| same(stream.next(seen), answer)))
        };
        assert_eq!((0..5).map(attempt).min(), Some(0), "{closure_weight:?}");
    }
}
