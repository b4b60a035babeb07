//! Orientation targets against minima in closed form, and a recording of sensors whose motion is known.

use condyle_math::{Quat, Vec3};
use condyle_model::{Mode, Model, ModelBuilder, Pose, Program};
use condyle_motion::Orientations;
use condyle_track::{FrameStatus, OrientationTarget, Rules, Scratch, Stream, Targets, Tracker};

fn hinge() -> Model {
    let mut b = ModelBuilder::new("hinge");
    let shank = b.segment("shank", None);
    b.hinge("knee", shank, "flexion", Vec3::Z);
    b.build().unwrap()
}

fn about_z(angle: f64) -> Quat {
    Quat::from_axis_angle(Vec3::Z, angle)
}

#[test]
fn two_wishes_meet_at_their_weighted_mean_and_a_tilt_out_of_reach_is_left() {
    let model = hinge();
    let segment = model.find_segment("shank").unwrap();
    let target = |weight, wanted| OrientationTarget { segment, weight, wanted: vec![Some(wanted)] };
    // F = w₁ (q - a)² + w₂ (q - b)², least at the weighted mean with F = w₁ w₂ (a - b)² / (w₁ + w₂).
    let orientations = vec![target(1.0, about_z(0.2)), target(3.0, about_z(1.0))];
    let solve = |orientations| {
        let targets = Targets { orientations, ..Targets::default() };
        let tracker =
            Tracker::new(model.clone(), targets, Rules { tolerance: 1e-12, ..Rules::default() });
        tracker.solve_frame(&mut Scratch::new(&tracker), &[], 0, &tracker.model().defaults())
    };
    let answer = solve(orientations);
    assert_eq!(answer.status, FrameStatus::Solved);
    assert!((answer.coordinates[0] - 0.8).abs() < 1e-9, "{:?}", answer.coordinates);
    assert!((answer.objective - 0.75 * 0.64).abs() < 1e-9, "{}", answer.objective);
    // A tilt about x by t cannot be followed. With the angle 2·acos(cos(t/2) cos((q - a)/2)) between
    // the two, the least is at q = a, where it is t.
    let tilt = Quat::from_axis_angle(Vec3::X, 0.5);
    let answer = solve(vec![target(2.0, about_z(-0.4) * tilt)]);
    assert!((answer.coordinates[0] + 0.4).abs() < 1e-7, "{:?}", answer.coordinates);
    assert!((answer.objective - 2.0 * 0.25).abs() < 1e-9, "{}", answer.objective);
}

/// A pelvis on a ball, a thigh on a ball below it, a shank on a hinge.
fn leg() -> Model {
    let mut b = ModelBuilder::new("leg");
    let pelvis = b.segment("pelvis", None);
    b.ball_joint("root", pelvis);
    let thigh = b.segment("femur_r", Some(pelvis));
    b.place_joint(thigh, Vec3::new(0.0, -0.1, 0.1));
    b.ball_joint("hip_r", thigh);
    let shank = b.segment("tibia_r", Some(thigh));
    b.place_joint(shank, Vec3::new(0.0, -0.4, 0.0));
    b.hinge("knee_r", shank, "flexion", -Vec3::Z);
    b.build().unwrap()
}

#[test]
fn sensors_on_a_leg_give_its_motion_back_frame_by_frame() {
    let model = leg();
    let program = Program::compile(&model);
    let mut pose = Pose::new(&program);
    // The motion begins in the default posture; after it everything turns smoothly.
    let stored = |frame: usize| -> Vec<f64> {
        let t = 0.03 * frame as f64;
        let root = Quat::exp(Vec3::new(0.3 * t, t, -0.2 * t)).to_array();
        let hip = Quat::exp(Vec3::new(0.5 * t.sin(), 0.2 * t, t.sin())).to_array();
        [&root[..], &hip[..], &[1.2 * t.sin()]].concat()
    };
    // Sensors sit anyhow on their segments, in a world whose z is up.
    let names = ["pelvis", "femur_r", "tibia_r"];
    let mounts = [Vec3::new(0.4, -1.0, 0.2), Vec3::new(2.0, 0.1, 0.3), Vec3::ZERO].map(Quat::exp);
    let world_of_sensors = Quat::from_axis_angle(Vec3::X, -std::f64::consts::FRAC_PI_2);
    let mut recording = Orientations {
        labels: names.iter().map(|name| format!("{name}_imu")).chain(["toe_imu".into()]).collect(),
        rate: 100.0,
        ..Orientations::default()
    };
    let frames = 60;
    for frame in 0..frames {
        program.evaluate(&stored(frame), Mode::Open, &mut pose).unwrap();
        recording.times.push(0.01 * frame as f64);
        for (name, mount) in names.iter().zip(mounts) {
            let segment = pose.segment(model.find_segment(name).unwrap());
            let in_world = Quat::from_mat3(segment.linear) * mount;
            recording.rotations.push(Some(world_of_sensors.conjugate() * in_world));
        }
        recording.rotations.push(None);
    }
    let (orientations, warnings) =
        OrientationTarget::of_recording(&model, &recording, world_of_sensors, 1e-3);
    assert_eq!((orientations.len(), warnings.len()), (3, 1));
    assert!(warnings[0].message.contains("`toe_imu`"), "{}", warnings[0].message);
    let targets = Targets { orientations, ..Targets::default() };
    let mut stream = Stream::new(Tracker::new(model, targets, Rules::default()));
    for frame in 0..frames {
        let answer = stream.next(&[]);
        assert_eq!(answer.status, FrameStatus::Solved, "frame {frame}");
        let truth = stored(frame);
        let quat = |list: &[f64]| Quat::from(<[f64; 4]>::try_from(&list[..4]).unwrap());
        for first in [0, 4] {
            let off = quat(&answer.coordinates[first..]).angle_to(quat(&truth[first..]));
            assert!(off < 1e-5, "frame {frame}: {off}");
        }
        assert!((answer.coordinates[8] - truth[8]).abs() < 1e-5, "frame {frame}");
    }
}

#[test]
fn a_frame_without_any_orientation_keeps_its_posture_and_is_marked() {
    let model = hinge();
    let segment = model.find_segment("shank").unwrap();
    let wanted = vec![Some(about_z(0.3)), None, Some(about_z(0.5))];
    let orientations = vec![OrientationTarget { segment, weight: 1.0, wanted }];
    let targets = Targets { orientations, ..Targets::default() };
    let mut stream = Stream::new(Tracker::new(model, targets, Rules::default()));
    let found: Vec<(f64, FrameStatus)> = (0..3)
        .map(|_| {
            let a = stream.next(&[]);
            (a.coordinates[0], a.status)
        })
        .collect();
    assert_eq!(found[1].1, FrameStatus::NoMarkers);
    assert!((found[0].0 - 0.3).abs() < 1e-6 && (found[2].0 - 0.5).abs() < 1e-6, "{found:?}");
}
