//! The nearest legal motion, on motions whose answer is known.

use condyle_math::{Quat, Vec3};
use condyle_model::component::{Ball, HalfSpace, JointCone, RelativePosition, Swinging};
use condyle_model::limit::{Cone, ConePoint, Projection, Range};
use condyle_model::model::{Closure, Condition};
use condyle_model::{CoordinateKind, Law, Model, ModelBuilder};
use condyle_motion::Motion;
use condyle_track::constrain::{Constrained, Fate, Pace, constrain};
use std::f64::consts::{FRAC_PI_2, PI, TAU};

const RATE: f64 = 120.0;

fn at_rate(frames: Vec<Vec<f64>>) -> Motion {
    Motion { times: (0..frames.len()).map(|i| i as f64 / RATE).collect(), frames }
}

fn run(model: &Model, motion: &Motion) -> Constrained {
    constrain(model, motion, Pace::default(), &mut |_| {})
}

/// A hinge with a range, and one without.
fn hinges() -> Model {
    let mut b = ModelBuilder::new("arm");
    let upper = b.segment("upper", None);
    let fore = b.segment("fore", Some(upper));
    b.place_joint(fore, Vec3::new(0.0, -0.3, 0.0));
    b.hinge("shoulder", upper, "lift", Vec3::X);
    let (_, bend) = b.hinge("elbow", fore, "bend", Vec3::Z);
    b.coordinate_mut(bend).range = Range::new(-0.2, 1.0);
    b.build().unwrap()
}

#[test]
fn a_sine_that_leaves_a_range_stands_at_its_ends_and_is_equal_elsewhere() {
    let model = hinges();
    let sine = |i: usize, rate: f64| (TAU * rate * i as f64 / RATE).sin();
    let asked: Vec<Vec<f64>> = (0..480).map(|i| vec![sine(i, 0.7), 1.3 * sine(i, 1.0)]).collect();
    let answer = run(&model, &at_rate(asked.clone()));
    let mut outside = 0;
    for (frame, (asked, found)) in asked.iter().zip(&answer.motion.frames).enumerate() {
        assert_eq!(found, &[asked[0], asked[1].clamp(-0.2, 1.0)], "{frame}");
        let out = asked[1] != found[1];
        outside += usize::from(out);
        assert_eq!(answer.fates[frame], if out { Fate::Moved } else { Fate::Kept }, "{frame}");
    }
    // Above 1.0 for acos(1/1.3)/π of the time, below -0.2 for acos(0.2/1.3)/π.
    let share = ((1.0f64 / 1.3).acos() + (0.2f64 / 1.3).acos()) / PI;
    assert!((outside as f64 / 480.0 - share).abs() < 0.02, "{outside}");
    assert_eq!(answer.changed(), outside);
    assert!(answer.seams.is_empty() && answer.alone == answer.step);
    // The fastest that a sine of 1.3 rad at 1 Hz goes, which a clamp does not exceed.
    assert!(answer.step.turn < 1.3 * TAU / RATE + 1e-12);
}

const HALF_ANGLE: f64 = 50.0 * PI / 180.0;
const CORNERS: usize = 12;

fn corner(i: usize) -> Vec3 {
    let around = TAU * i as f64 / CORNERS as f64;
    let (sin, cos) = HALF_ANGLE.sin_cos();
    Vec3::new(cos, sin * around.cos(), sin * around.sin())
}

/// A ball joint whose bone lies along x and swings by at most about 50° to every side.
fn ball() -> Model {
    let mut b = ModelBuilder::new("ball");
    let bone = b.segment("bone", None);
    let set = b.joint_set("joint");
    let orientation = b.coordinate(set, "orientation", CoordinateKind::Orientation);
    let points = (0..CORNERS).map(|i| ConePoint { direction: corner(i), twist: None }).collect();
    let cone = Cone::new(Vec3::X, None, points, 0, Projection::Nearest).unwrap();
    let limit = Law::Cone(JointCone { of: Swinging::Orientation, cone });
    let held = b.component(set, "cone", limit, vec![orientation.into()]);
    let turn = b.component(set, "ball", Law::Ball(Ball), vec![held]);
    b.output(set, bone, turn);
    b.build().unwrap()
}

fn direction(stored: &[f64]) -> Vec3 {
    let q: [f64; 4] = stored.try_into().unwrap();
    Quat::from(q).to_mat3().x
}

/// The turn that takes x to a direction on the shortest way.
fn swing(to: Vec3) -> Vec<f64> {
    let about = Vec3::X.cross(to);
    let angle = about.norm().atan2(Vec3::X.dot(to));
    let about = if about.norm() > 1e-12 { about * (1.0 / about.norm()) } else { Vec3::Y };
    Quat::exp(about * angle).to_array().to_vec()
}

/// The boundary, point by point: the great arcs between neighbouring corners.
fn boundary() -> Vec<Vec3> {
    let steps = 400;
    (0..CORNERS * steps)
        .map(|n| {
            let (i, share) = (n / steps, (n % steps) as f64 / steps as f64);
            let point = corner(i) * (1.0 - share) + corner((i + 1) % CORNERS) * share;
            point * (1.0 / point.norm())
        })
        .collect()
}

fn angle(a: Vec3, b: Vec3) -> f64 {
    a.cross(b).norm().atan2(a.dot(b))
}

#[test]
fn a_swing_that_leaves_a_cone_is_on_the_nearest_point_of_its_boundary() {
    let model = ball();
    let around = |i: usize| 1.1 + 0.5 * (TAU * i as f64 / 240.0).sin();
    let asked: Vec<Vec3> = (0..240)
        .map(|i| {
            let (swing, side) = (around(i) - 0.3, 0.02 * i as f64);
            Vec3::new(swing.cos(), swing.sin() * side.cos(), swing.sin() * side.sin())
        })
        .collect();
    let motion = at_rate(asked.iter().map(|d| swing(*d)).collect());
    let answer = run(&model, &motion);
    let boundary = boundary();
    let mut moved = 0;
    for (frame, asked) in asked.iter().enumerate() {
        let found = direction(&answer.motion.frames[frame]);
        let nearest = boundary.iter().map(|point| angle(*asked, *point)).fold(PI, f64::min);
        match answer.fates[frame] {
            Fate::Kept => assert_eq!(answer.motion.frames[frame], motion.frames[frame]),
            Fate::Moved => {
                moved += 1;
                let off = boundary.iter().map(|point| angle(found, *point)).fold(PI, f64::min);
                // Between two of the 400 points of an edge of 23°.
                assert!(off < 1e-3, "{frame}: {off}");
                assert!(angle(*asked, found) < nearest + 1e-9, "{frame}: {nearest}");
            }
            fate => panic!("{frame}: {fate:?}"),
        }
    }
    assert!(moved > 50 && moved < 200, "{moved}");
    assert_eq!(answer.beyond.turn, 0.0);
}

#[test]
fn past_the_far_side_of_a_cone_nothing_jumps() {
    let model = ball();
    // A great circle that passes 4° from the direction opposite to rest, at 3° a frame: the nearest point of the
    // cone goes around half of it meanwhile.
    let tilt = 4f64.to_radians();
    let asked: Vec<Vec3> = (0..121)
        .map(|i| {
            let along = (3.0 * i as f64).to_radians();
            Vec3::new(along.cos() * tilt.cos(), along.sin(), along.cos() * tilt.sin())
        })
        .collect();
    let motion = at_rate(asked.iter().map(|d| swing(*d)).collect());
    let answer = run(&model, &motion);
    assert!(answer.alone.turn > 0.4, "alone each frame jumps: {:?}", answer.alone);
    // What is stated: twice the step of the motion and one turn per second.
    let step = |frames: &[Vec<f64>], i: usize| {
        let quat = |frame: &[f64]| Quat::from(<[f64; 4]>::try_from(frame).unwrap());
        (quat(&frames[i - 1]), quat(&frames[i]))
    };
    let mut worst = 0.0f64;
    for i in 1..asked.len() {
        let (m0, m1) = step(&motion.frames, i);
        let (x0, x1) = step(&answer.motion.frames, i);
        let change = (m0.conjugate() * x0).angle_to(m1.conjugate() * x1);
        let bound = 2.0 * m0.angle_to(m1) + TAU / RATE;
        worst = worst.max(change - bound);
    }
    assert!(worst < 1e-6, "{:.3}° beyond the bound, {answer:?}", worst.to_degrees());
    assert!(answer.beyond.turn < 1e-6);
    assert_eq!(answer.seams.len(), 1);
    let edge = |d: Vec3| boundary().iter().map(|b| angle(*b, d)).fold(PI, f64::min);
    for (frame, stored) in answer.motion.frames.iter().enumerate() {
        let found = direction(stored);
        // Inside: no farther from rest than the boundary there.
        assert!(angle(Vec3::X, found) < HALF_ANGLE + 1e-9 || edge(found) < 1e-3, "{frame}");
        let [start, end] = answer.seams[0];
        if frame < start || frame > end {
            let nearest = boundary().iter().map(|b| angle(*b, asked[frame])).fold(PI, f64::min);
            let inside = answer.fates[frame] == Fate::Kept;
            assert!(inside || angle(asked[frame], found) < nearest + 1e-9, "{frame}");
        }
    }
}

#[test]
fn a_legal_motion_comes_back_to_the_bit() {
    let model = ball();
    let frames = (0..200).map(|i| {
        let (out, side) = (0.6 * (0.05 * i as f64).sin(), 0.11 * i as f64);
        swing(Vec3::new(out.cos(), out.sin() * side.cos(), out.sin() * side.sin()))
    });
    let motion = at_rate(frames.collect());
    let answer = run(&model, &motion);
    let bits =
        |motion: &Motion| motion.frames.iter().flatten().map(|x| x.to_bits()).collect::<Vec<u64>>();
    assert_eq!(bits(&answer.motion), bits(&motion));
    assert!(answer.fates.iter().all(|fate| *fate == Fate::Kept));
}

#[test]
fn what_is_constrained_is_legal_when_asked_again() {
    let model = ball();
    let frames = (0..60).map(|i| {
        let out = 0.05 * i as f64;
        swing(Vec3::new(out.cos(), out.sin() * 0.6, out.sin() * 0.8))
    });
    let once = run(&model, &at_rate(frames.collect()));
    assert!(once.changed() > 30);
    let twice = run(&model, &once.motion);
    for (one, other) in once.motion.frames.iter().zip(&twice.motion.frames) {
        let [one, other] = [one, other].map(|q| Quat::from(<[f64; 4]>::try_from(&q[..]).unwrap()));
        assert!(one.angle_to(other) < 1e-9);
    }
}

#[test]
fn loops_stay_closed() {
    // A parallelogram: crank and rocker of 10 cm, 20 cm apart, with a rod between their ends. All its poses are
    // (a, -a, a), so where the crank must not pass 100° all stand at 100°.
    let mut b = ModelBuilder::new("parallelogram");
    let crank = b.segment("crank", None);
    let (_, turn) = b.hinge("crank", crank, "crank_angle", Vec3::Z);
    let rod = b.segment("rod", Some(crank));
    b.place_joint(rod, Vec3::new(0.1, 0.0, 0.0));
    b.hinge("pin", rod, "rod_angle", Vec3::Z);
    let rocker = b.segment("rocker", None);
    b.place_joint(rocker, Vec3::new(0.2, 0.0, 0.0));
    b.hinge("rocker", rocker, "rocker_angle", Vec3::Z);
    let at = [(Some(rod), Vec3::new(0.2, 0.0, 0.0)), (Some(rocker), Vec3::new(0.1, 0.0, 0.0))];
    b.closure(Closure { name: "pin".to_owned(), condition: Condition::Points { at } });
    let most = 100f64.to_radians();
    b.coordinate_mut(turn).range = Range::new(0.5, most);
    let model = b.build().unwrap();
    let angles: Vec<f64> = (0..60).map(|i| 1.5 + 0.6 * (0.1 * i as f64).sin()).collect();
    let motion = at_rate(angles.iter().map(|a| vec![*a, -a, *a]).collect());
    let answer = run(&model, &motion);
    for (frame, (asked, found)) in angles.iter().zip(&answer.motion.frames).enumerate() {
        if *asked <= most {
            assert_eq!(found, &motion.frames[frame]);
            continue;
        }
        for (found, expected) in found.iter().zip([most, -most, most]) {
            assert!((found - expected).abs() < 1e-6, "{frame}: {found} {expected}");
        }
    }
    assert!(answer.changed() > 10 && answer.left().count() == 0);
}

#[test]
fn a_frame_without_numbers_is_left_alone() {
    let model = hinges();
    let motion = at_rate(vec![vec![0.0, 0.5], vec![f64::NAN, 0.5], vec![0.0, 2.0]]);
    let answer = run(&model, &motion);
    assert_eq!(answer.fates, [Fate::Kept, Fate::Left, Fate::Moved]);
    assert_eq!(answer.motion.frames[2], [0.0, 1.0]);
    assert!(run(&model, &Motion::default()).motion.frames.is_empty());
}

/// A limit between two segments of a figure leaves all coordinates that it does not move as they were.
#[test]
fn what_a_limit_does_not_move_stays_to_the_bit() {
    let mut b = ModelBuilder::new("figure");
    let arm = b.segment("arm", None);
    let other = b.segment("other", None);
    b.hinge("shoulder", arm, "lift", Vec3::X);
    b.hinge("elsewhere", other, "turn", Vec3::Z);
    let set = b.joint_set("limits");
    let depth = RelativePosition { reference: false, point: -Vec3::Y, along: vec![Vec3::Z] };
    let depth = b.component(set, "depth", Law::RelativePosition(depth), vec![arm.into()]);
    // The hand is at most 0.5 m behind the shoulder: a lift of 30 degrees.
    let wall = Law::HalfSpace(HalfSpace::new(vec![-1.0], 0.5).unwrap());
    b.component(set, "wall", wall, vec![depth]);
    let model = b.build().unwrap();
    let mut asked: Vec<Vec<f64>> = (0..40).map(|i| vec![0.1 * f64::from(i), 0.7]).collect();
    // Where the limit has no slope only another start leads on: the defaults.
    asked.push(vec![FRAC_PI_2, 0.7]);
    let answer = run(&model, &at_rate(asked));
    assert!(answer.motion.frames.iter().all(|frame| frame[1] == 0.7));
    assert!(answer.motion.frames.iter().all(|frame| frame[0].sin() < 0.5 + 1e-6));
    assert!(answer.changed() > 10);
}
