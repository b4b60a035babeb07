//! Motions through half turns, seams and cold starts, on a generated body whose angles are known.

use condyle_math::Vec3;
use condyle_model::{CoordinateKind, Mode, Model, ModelBuilder, Pose, Program, Range, SegmentId};
use condyle_track::{FrameAnswer, MarkerTarget, Rules, Scratch, Targets, Tracker, Trust, sequence};
use std::f64::consts::PI;

/// Frames of a trial: more than three chunks.
const FRAMES: usize = 220;

/// A segment moved by three hinges of one joint, each within its range.
fn three_hinges(
    b: &mut ModelBuilder,
    name: &str,
    parent: Option<SegmentId>,
    ranges: [f64; 3],
) -> SegmentId {
    let segment = b.segment(name, parent);
    let set = b.joint_set(name);
    let axes = [Vec3::Y, Vec3::X, Vec3::Z];
    let turns =
        ["first", "second", "third"].iter().zip(axes).zip(ranges).map(|((angle, axis), most)| {
            let id = b.coordinate(set, angle, CoordinateKind::Rotation);
            if most.is_finite() {
                b.coordinate_mut(id).range = Range::new(-most, most);
            }
            b.rotate(set, &format!("turn_{angle}"), id, axis)
        });
    let turns = turns.collect();
    let motion = b.product(set, "motion", turns);
    b.output(set, segment, motion);
    let corners = [(0.3, 0.1, 0.0), (-0.1, 0.3, 0.1), (0.0, -0.3, 0.2), (0.1, 0.0, -0.3)];
    for (i, (x, y, z)) in corners.into_iter().enumerate() {
        b.marker(&format!("{name}_{i}"), Some(segment), Vec3::new(x, y, z));
    }
    segment
}

/// A trunk that turns about the world's origin, and an arm.
fn body(trunk: [f64; 3], arm: [f64; 3]) -> Model {
    let mut b = ModelBuilder::new("body");
    let trunk = three_hinges(&mut b, "trunk", None, trunk);
    let arm = three_hinges(&mut b, "arm", Some(trunk), arm);
    b.place_joint(arm, Vec3::new(0.0, 0.5, 0.2));
    b.build().unwrap()
}

/// The recorded markers of a motion, off by 2 mm in a fixed pattern, as of skin.
fn recorded(model: &Model, motion: &[Vec<f64>]) -> Vec<Vec<Option<[f64; 3]>>> {
    let program = Program::compile(model);
    let mut pose = Pose::new(&program);
    let frames = motion.iter().enumerate().map(|(frame, q)| {
        program.evaluate(q, Mode::Open, &mut pose).unwrap();
        let places = model.markers().iter().enumerate().map(|(i, marker)| {
            let phase = (7 * i) as f64 + 0.1 * frame as f64;
            let off = Vec3::new(phase.sin(), (2.3 * phase).sin(), (3.1 * phase).sin()) * 0.002;
            Some((pose.frame(marker.segment) * marker.point + off).to_array())
        });
        places.collect()
    });
    frames.collect()
}

fn tracker(model: Model) -> Tracker {
    let markers = (0..model.markers().len()).map(|marker| MarkerTarget { marker, weight: 1.0 });
    let targets = Targets { markers: markers.collect(), ..Targets::default() };
    Tracker::new(model, targets, Rules::default())
}

fn tracked(tracker: &Tracker, seen: &[Vec<Option<[f64; 3]>>]) -> Vec<FrameAnswer> {
    let recorded = |frame: usize, row: &mut Vec<Option<[f64; 3]>>| row.clone_from(&seen[frame]);
    let mut scratch = Scratch::new(tracker);
    let chunks = sequence::cut(seen.len());
    let keys = sequence::keys(tracker, &mut scratch, &recorded, &chunks);
    let solved = chunks.iter().zip(&keys).map(|(chunk, key)| {
        sequence::solve_chunk(tracker, &mut scratch, &recorded, chunk, key, seen.len())
    });
    let solved = solved.collect();
    sequence::stitch(tracker, &mut scratch, &recorded, &chunks, solved)
}

/// Largest difference of any angle from the truth, whole turns aside, in radians.
fn off(answers: &[FrameAnswer], truth: &[Vec<f64>]) -> f64 {
    let pairs = answers.iter().zip(truth).flat_map(|(a, b)| a.coordinates.iter().zip(b));
    pairs.map(|(a, b)| (a - b).sin().atan2((a - b).cos()).abs()).fold(0.0, f64::max)
}

/// Largest change of any angle from one frame to the next.
fn step(answers: &[FrameAnswer]) -> f64 {
    let pairs = answers.windows(2).flat_map(|w| w[0].coordinates.iter().zip(&w[1].coordinates));
    pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

/// 2 mm on levers of 0.3 m are 0.4°; four markers, but worst of 220 frames: 1°.
const CLOSE: f64 = PI / 180.0;

#[test]
fn ranges_of_a_whole_turn_have_no_ends() {
    // Both joints go round one and a half times, past 180 degrees.
    let model = body([PI, 1.2, 1.2], [PI, 1.2, 1.2]);
    let q =
        |t: f64| vec![9.0 * t, 0.3 * (5.0 * t).sin(), 0.2, -8.0 * t, 0.5, 0.4 * (9.0 * t).sin()];
    let truth: Vec<Vec<f64>> = (0..FRAMES).map(|i| q(i as f64 / FRAMES as f64)).collect();
    let answers = tracked(&tracker(model.clone()), &recorded(&model, &truth));
    assert!(off(&answers, &truth) < CLOSE, "{}", off(&answers, &truth));
    // The truth moves by 0.041 a frame at most.
    assert!(step(&answers) < 0.08, "{}", step(&answers));
    // Half a turn is an end where the range is a little less than a turn: 0.95 of it.
    let model = body([PI, 1.2, 1.2], [0.95 * PI, 1.2, 1.2]);
    let answers = tracked(&tracker(model.clone()), &recorded(&model, &truth));
    let most = |a: &FrameAnswer| a.coordinates[3].abs();
    assert_eq!(answers.iter().map(most).fold(0.0, f64::max), 0.95 * PI);
}

#[test]
fn seams_change_neither_the_turn_nor_the_other_three_angles() {
    // Cardan angles without ends, the middle one near 90 degrees, where both names are alike near.
    let free = [f64::INFINITY; 3];
    let model = body(free, free);
    let q = |t: f64| {
        let wave = (6.0 * t).sin();
        vec![0.5 * wave, 1.35 * (11.0 * t).sin(), 2.0 * wave, 7.0 * t, 1.3 * (4.0 * t).sin(), wave]
    };
    let truth: Vec<Vec<f64>> = (0..FRAMES).map(|i| q(i as f64 / FRAMES as f64)).collect();
    let answers = tracked(&tracker(model.clone()), &recorded(&model, &truth));
    // Near 90 degrees first and third angle are less sure by 1/cos 77° = 4.6.
    assert!(off(&answers, &truth) < 5.0 * CLOSE, "{}", off(&answers, &truth));
    assert!(step(&answers) < 0.3, "{}", step(&answers));
}

#[test]
fn a_cold_start_finds_what_the_whole_trial_finds() {
    // A raised arm on a turned trunk, in ranges that are no circles.
    let model = body([3.0, 1.2, 1.2], [3.0, 1.4, 3.0]);
    let q = |t: f64| {
        let wave = (6.0 * t).sin();
        vec![2.6 * wave, 0.4, -0.3 * wave, 2.8 * (4.0 * t).sin(), 0.9 * wave, 2.5 * (5.0 * t).cos()]
    };
    let truth: Vec<Vec<f64>> = (0..FRAMES).map(|i| q(i as f64 / FRAMES as f64)).collect();
    let (tracker, seen) = (tracker(model.clone()), recorded(&model, &truth));
    let whole = tracked(&tracker, &seen);
    assert!(off(&whole, &truth) < 2.0 * CLOSE, "{}", off(&whole, &truth));
    for cut in (0..FRAMES).step_by(11) {
        let part = tracked(&tracker, &seen[cut..]);
        for (a, b) in part.iter().zip(&whole[cut..]) {
            assert!((a.objective / b.objective - 1.0).abs() < 1e-6, "cut at {cut}");
            let away = off(std::slice::from_ref(a), std::slice::from_ref(&b.coordinates));
            // A tenth of a degree.
            assert!(away < 0.1 * CLOSE, "cut at {cut}: {away}");
        }
    }
    let mut scratch = Scratch::new(&tracker);
    let trust = tracker.trust(&mut scratch, &seen[0], 0, &whole[0]);
    assert!(trust.iter().all(|t| *t == Trust::Determined), "{trust:?}");
}
