//! Frames that come one by one are answered as those of a recording, without allocating. One test alone in
//! its binary, because the allocator counts for the whole process.

use condyle::math::Vec3;
use condyle::model::CoordinateKind::{Rotation, Translation};
use condyle::tracking::{Live, Request, track};
use condyle::{Mode, Model, ModelBuilder, Motion, Range};
use stats_alloc::{INSTRUMENTED_SYSTEM, Region, StatsAlloc};
use std::alloc::System;

#[global_allocator]
static GLOBAL: &StatsAlloc<System> = &INSTRUMENTED_SYSTEM;

const FRAMES: usize = 60;

/// A free trunk with an arm of two hinges, the second of which reaches the end of its range.
fn body() -> Model {
    let mut b = ModelBuilder::new("body");
    let trunk = b.segment("trunk", None);
    let root = b.joint_set("root");
    let mut factors = vec![];
    for (name, axis) in [("x", Vec3::X), ("y", Vec3::Y), ("z", Vec3::Z)] {
        let place = b.coordinate(root, name, Translation);
        factors.push(b.translate(root, &format!("move_{name}"), place, axis));
    }
    for (name, axis) in [("heading", Vec3::Y), ("list", Vec3::X), ("tilt", Vec3::Z)] {
        let turn = b.coordinate(root, name, Rotation);
        factors.push(b.rotate(root, &format!("turn_{name}"), turn, axis));
    }
    let whole = b.product(root, "whole", factors);
    b.output(root, trunk, whole);
    let upper = b.segment("upper", Some(trunk));
    b.place_joint(upper, Vec3::new(0.0, 0.4, 0.2));
    b.hinge("shoulder", upper, "angle", Vec3::Z);
    let fore = b.segment("fore", Some(upper));
    b.place_joint(fore, Vec3::new(0.0, -0.3, 0.0));
    let (_, bend) = b.hinge("elbow", fore, "angle", Vec3::Z);
    b.coordinate_mut(bend).range = Range::new(0.0, 1.2);
    for (side, segment) in [("trunk", trunk), ("upper", upper), ("fore", fore)] {
        for (name, at) in [("x", Vec3::X), ("y", -Vec3::Y), ("z", Vec3::Z)] {
            b.marker(&format!("{side}_{name}"), Some(segment), at * 0.15);
        }
    }
    b.build().unwrap()
}

/// Allocations and reallocations during `call`.
fn allocations(call: impl FnOnce()) -> usize {
    let region = Region::new(GLOBAL);
    call();
    let change = region.change();
    change.allocations + change.reallocations
}

#[test]
fn frames_as_they_come_are_those_of_the_recording_and_allocate_nothing() {
    assert!(allocations(|| drop(std::hint::black_box(vec![1_u8; 64]))) >= 1, "the counter counts");
    let model = body();
    let angles = |frame: usize| {
        let t = 0.05 * frame as f64;
        // The elbow is bent by up to 1.25 rad, beyond its range.
        vec![t, 0.9, 0.1, 0.3 * t.sin(), 0.1, -0.1, t.cos(), 0.65 - 0.6 * (2.0 * t).cos()]
    };
    let motion = Motion {
        times: (0..FRAMES).map(|frame| frame as f64 / 100.0).collect(),
        frames: (0..FRAMES).map(angles).collect(),
    };
    let mut recording = motion.virtual_markers(&model, Mode::Open).unwrap();
    // In another order than the model's, with a label that it does not have, and gaps.
    let width = recording.labels.len();
    recording.labels.reverse();
    recording.labels[0] = "unknown".into();
    recording.positions.chunks_mut(width).for_each(<[_]>::reverse);
    let frame = |frame: usize| -> Vec<Option<[f64; 3]>> {
        let seen = recording.frame(frame).iter().enumerate();
        seen.map(|(i, p)| p.position().filter(|_| !(frame + 3 * i).is_multiple_of(17))).collect()
    };
    let frames: Vec<_> = (0..FRAMES).map(frame).collect();
    for (place, seen) in recording.positions.iter_mut().zip(frames.iter().flatten()) {
        *place = seen.map_or(condyle::Observed::MISSING, condyle::Observed::from);
    }
    let request = Request { threads: Some(1), ..Request::default() };
    let whole = track(&model, &recording, &request, &mut |_, _| {}).unwrap();
    assert!(whole.summary().failed.is_empty());
    let mut coordinates = vec![0.0; model.stored_len()];
    let mut live = Live::new(model.clone(), &recording.labels, &request).unwrap();
    assert_eq!(live.markers(), whole.markers);
    for (seen, answer) in frames.iter().zip(whole.answers.iter()) {
        let found = live.next(seen, &mut coordinates).unwrap();
        assert_eq!(&found.coordinates, &coordinates);
        for (a, b) in coordinates.iter().zip(&answer.coordinates) {
            // A trial's answers are looked at again from both sides: within the solver's tolerance.
            assert!((a - b).abs() < 1e-4, "{coordinates:?} {:?}", answer.coordinates);
        }
    }
    // The thread of the test harness may allocate meanwhile: the least of five attempts.
    let attempt = |_| {
        let mut live = Live::new(model.clone(), &recording.labels, &request).unwrap();
        let mut coordinates = vec![0.0; model.stored_len()];
        let mut solve = |frames: &[Vec<Option<[f64; 3]>>]| {
            frames.iter().all(|seen| live.next(seen, &mut coordinates).is_ok())
        };
        assert!(solve(&frames[..2]));
        allocations(|| assert!(solve(&frames[2..])))
    };
    assert_eq!((0..5).map(attempt).min(), Some(0));
    let wrong = live.next(&frames[0][1..], &mut coordinates).unwrap_err();
    assert_eq!(wrong.to_string(), "the list of positions has 8 numbers but must have 9");
    let robust = Request { robust: true, ..request };
    let warned = Live::new(model, &recording.labels, &robust).unwrap();
    assert!(warned.warnings().iter().any(|said| said.code == "track/not-robust"));
}
