//! What is measured between segments, against the transforms of the pose.

use condyle_math::{Affine, EulerOrder, Mat3, Quat, Vec3};
use condyle_model::component::{
    AngleNames, Angles, Contact, ContactPair, Gliding, HalfSpace, RelativeOrientation,
    RelativePosition,
};
use condyle_model::{Law, Mode, Model, ModelBuilder, Pose, Program, SegmentId, Signal};

/// A number in -1..1 for each index.
fn draw(index: u32) -> f64 {
    ((f64::from(index) * 12.9898).sin() * 43758.5453).fract()
}

/// Two arms of three bones each on a trunk, every joint a ball, the bones' frames turned anyhow.
fn body() -> (ModelBuilder, Vec<SegmentId>) {
    let mut b = ModelBuilder::new("body");
    let trunk = b.segment("trunk", None);
    b.ball_joint("trunk", trunk);
    let mut segments = vec![trunk];
    for arm in 0..2 {
        let mut parent = trunk;
        for bone in 0..3 {
            let name = format!("bone_{arm}_{bone}");
            let segment = b.segment(&name, Some(parent));
            let seed = 100 * arm + 10 * bone;
            let frame = |k: u32| {
                let v = Vec3::from([0, 1, 2].map(|i| draw(seed + k + i)));
                let place = Vec3::from([3, 4, 5].map(|i| 0.3 * draw(seed + k + i)));
                Affine::new(Quat::exp(v).to_mat3(), place)
            };
            b.place_joint_frames(segment, frame(0), frame(50));
            b.ball_joint(&name, segment);
            segments.push(segment);
            parent = segment;
        }
    }
    (b, segments)
}

fn posed(model: &Model, seed: u32) -> (Program, Pose) {
    let program = Program::compile(model);
    let mut pose = Pose::new(&program);
    let mut stored = model.defaults();
    for (k, q) in stored.chunks_mut(4).enumerate() {
        let v = [0, 1, 2].map(|i| 1.5 * draw(seed + 7 * k as u32 + i));
        q.copy_from_slice(&Quat::exp(v.into()).to_array());
    }
    program.evaluate(&stored, Mode::Posed, &mut pose).unwrap();
    (program, pose)
}

/// Nothing but the row reads the measure: it equals the negative of it.
fn row_of(b: &mut ModelBuilder, measure: Signal, name: &str) {
    let set = b.joint_set(name);
    let limit = Law::HalfSpace(HalfSpace::new(vec![1.0], 0.0).unwrap());
    b.component(set, "limit", limit, vec![measure]);
}

#[test]
fn points_and_orientations_are_those_of_the_pose() {
    let (mut b, segments) = body();
    let set = b.joint_set("measures");
    let point = Vec3::new(0.1, -0.2, 0.3);
    let directions = vec![Vec3::X, Vec3::Y, Vec3::Z];
    // Along one arm, from arm to arm, to the trunk, to the world, and of a segment in itself.
    let pairs = [(3, Some(1)), (1, Some(3)), (3, Some(6)), (5, Some(0)), (2, None), (4, Some(4))];
    for (k, (segment, reference)) in pairs.into_iter().enumerate() {
        let reference = reference.map(|i: usize| segments[i]);
        let ends: Vec<Signal> =
            [segments[segment]].into_iter().chain(reference).map(Signal::from).collect();
        let law =
            RelativePosition { reference: reference.is_some(), point, along: directions.clone() };
        let place =
            b.component(set, &format!("place_{k}"), Law::RelativePosition(law), ends.clone());
        let law = RelativeOrientation { reference: reference.is_some() };
        let turned = b.component(set, &format!("turned_{k}"), Law::RelativeOrientation(law), ends);
        let names = AngleNames::Euler(EulerOrder::ALL[2 * k]);
        let law = Law::Angles(Angles { names, mirrored: None });
        let angles = b.component(set, &format!("angles_{k}"), law, vec![turned]);
        for (what, signal) in [("place", place), ("angles", angles)] {
            let Signal::Output(id, _) = signal else { panic!("a component has outputs") };
            for output in 0..3 {
                row_of(&mut b, Signal::Output(id, output), &format!("{what}_{k}_{output}"));
            }
        }
    }
    let model = b.build().unwrap();
    for seed in 0..20 {
        let (program, pose) = posed(&model, 1000 * seed);
        assert_eq!(program.measured_limit_rows().len(), 36);
        let mut row = 0;
        let mut next = || {
            row += 1;
            -pose.limit_row(row - 1)
        };
        for (k, (segment, reference)) in pairs.into_iter().enumerate() {
            let reference = reference.map(|i: usize| segments[i]);
            let own = pose.frame(reference).rigid_inverse() * pose.segment(segments[segment]);
            let place = own * point;
            for expected in place.to_array() {
                let found = next();
                assert!((found - expected).abs() < 1e-12, "{k}: {found} {expected}");
            }
            // The angles make the rotation again.
            let order = EulerOrder::ALL[2 * k];
            let again = order.to_mat3([next(), next(), next()]);
            let off = Quat::from_mat3(again).angle_to(Quat::from_mat3(own.linear));
            assert!(off < 1e-11, "{k}: {off}");
        }
    }
}

#[test]
fn angles_of_a_ball_are_those_of_three_hinges() {
    // A knee by Grood & Suntay (1983): flexion about the femur's z, adduction about the floating axis,
    // rotation about the tibia's y; and a mirrored one, where the same values turn the other way.
    let order: EulerOrder = "zxy".parse().unwrap();
    let angles = [1.1, -0.15, 0.25];
    let q = Quat::from_mat3(order.to_mat3(angles));
    let mirrored = condyle_model::component::Reflection::new(2).unwrap();
    let across = Affine::from_rotation(q.to_mat3());
    let q_across = Quat::from_mat3(mirrored.frame(across).linear);
    for (q, mirrored) in [(q, None), (q_across, Some(mirrored))] {
        let mut b = ModelBuilder::new("knee");
        let tibia = b.segment("tibia", None);
        let (set, orientation) = b.ball_joint("knee", tibia);
        let law = Law::Angles(Angles { names: AngleNames::Euler(order), mirrored });
        let Signal::Output(id, _) = b.component(set, "angles", law, vec![orientation.into()])
        else {
            panic!("a component has outputs")
        };
        let followers = [0, 1, 2].map(|k| {
            let follower =
                b.coordinate(set, &format!("angle_{k}"), condyle_model::CoordinateKind::Rotation);
            b.follow(follower, Signal::Output(id, k));
            follower
        });
        let model = b.build().unwrap();
        let program = Program::compile(&model);
        let mut pose = Pose::new(&program);
        let mut stored = model.defaults();
        stored[..4].copy_from_slice(&q.to_array());
        program.evaluate(&stored, Mode::Open, &mut pose).unwrap();
        for (follower, expected) in followers.into_iter().zip(angles) {
            let found = pose.coordinate(&model, follower)[0];
            assert!((found - expected).abs() < 1e-14, "{found} {expected}");
        }
    }
}

#[test]
fn twist_and_swing_make_the_rotation_again() {
    for (axis, unit) in Vec3::UNITS.into_iter().enumerate() {
        let swing_axis = Vec3::UNITS[(axis + 1) % 3] * 0.6 + Vec3::UNITS[(axis + 2) % 3] * 0.8;
        let swing = Quat::from_axis_angle(swing_axis, 0.9);
        let q = swing * Quat::from_axis_angle(unit, -0.7);
        let mut b = ModelBuilder::new("bone");
        let bone = b.segment("bone", None);
        let (set, orientation) = b.ball_joint("joint", bone);
        let law = Law::Angles(Angles { names: AngleNames::SwingTwist(axis), mirrored: None });
        let angles = b.component(set, "angles", law, vec![orientation.into()]);
        let Signal::Output(id, _) = angles else { panic!("a component has outputs") };
        let turn = b.rotate(set, "turn", Signal::Output(id, 0), unit);
        let other = b.segment("other", None);
        b.output(set, other, turn);
        for k in [1, 2] {
            let name = format!("swing_{k}");
            let follower = b.coordinate(set, &name, condyle_model::CoordinateKind::Rotation);
            b.follow(follower, Signal::Output(id, k));
        }
        let model = b.build().unwrap();
        let program = Program::compile(&model);
        let mut pose = Pose::new(&program);
        let mut stored = model.defaults();
        stored[..4].copy_from_slice(&q.to_array());
        program.evaluate(&stored, Mode::Open, &mut pose).unwrap();
        let twist = Mat3::rotation_about(unit, (-0.7f64).sin_cos());
        let found = pose.segment(other).linear;
        assert!(Quat::from_mat3(found).angle_to(Quat::from_mat3(twist)) < 1e-14);
        assert!(
            (pose.effective()[4] - 0.54).abs() < 1e-14
                && (pose.effective()[5] - 0.72).abs() < 1e-14
        );
    }
}

#[test]
fn what_measures_or_allows_nothing_is_an_error() {
    let (mut b, segments) = body();
    let set = b.joint_set("measures");
    let nothing = RelativePosition { reference: false, point: Vec3::ZERO, along: vec![] };
    let law = Law::RelativePosition(nothing);
    b.component(set, "nothing", law, vec![segments[1].into()]);
    let pair = ContactPair { first: Vec3::Y * 0.1, second: Vec3::Z * 0.1, at: [0.0; 2] };
    let ribs = Gliding::new(Affine::IDENTITY, Vec3::new(0.1, 0.1, 0.1), Vec3::Z, vec![pair]);
    let contact =
        Law::Contact(Contact { before: false, most_gap: Some(-0.01), law: ribs.unwrap() });
    b.component(set, "glide", contact, vec![segments[1].into(), segments[0].into()]);
    let errors = b.build().unwrap_err();
    let codes: Vec<&str> = errors.iter().map(|said| said.code).collect();
    assert_eq!(codes, ["model/measure", "model/gap"]);
}
