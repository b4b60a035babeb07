//! Poses by goals of which the answer is known in closed form.

use condyle_math::function::Function;
use condyle_math::{Quat, Vec3};
use condyle_model::model::{Closure, Condition};
use condyle_model::{
    CoordinateId, CoordinateKind, Mode, Model, ModelBuilder, Pose, Program, Range, SegmentId,
};
use condyle_track::goal::{Aim, Answer, By, Goal, Goals, Side, solve};
use std::f64::consts::{FRAC_PI_2, PI};

/// A planar chain about z whose links have these lengths, along x at rest.
fn chain(lengths: &[f64]) -> ModelBuilder {
    let mut b = ModelBuilder::new("chain");
    let mut parent: Option<(SegmentId, f64)> = None;
    for (i, &length) in lengths.iter().enumerate() {
        let segment = b.segment(&format!("s{i}"), parent.map(|(segment, _)| segment));
        b.place_joint(segment, Vec3::X * parent.map_or(0.0, |(_, length)| length));
        b.hinge(&format!("j{i}"), segment, &format!("q{i}"), Vec3::Z);
        parent = Some((segment, length));
    }
    b
}

fn segment(model: &Model, index: usize) -> SegmentId {
    model.segment_ids().nth(index).unwrap()
}

fn coordinate(model: &Model, index: usize) -> CoordinateId {
    model.coordinate_ids().nth(index).unwrap()
}

fn end(model: &Model, length: f64) -> (Option<SegmentId>, Vec3) {
    (model.segment_ids().last(), Vec3::X * length)
}

fn at(x: f64, y: f64) -> (Option<SegmentId>, Vec3) {
    (None, Vec3::new(x, y, 0.0))
}

fn exact(aim: Aim) -> Goal {
    Goal { aim, weight: None }
}

fn asked(model: &Model, aims: Vec<Aim>) -> Goals {
    let mut goals = Goals::of(model);
    goals.goals = aims.into_iter().map(exact).collect();
    goals
}

fn close(answer: &Answer, expected: &[f64]) {
    for (q, wanted) in answer.coordinates.iter().zip(expected) {
        assert!((q - wanted).abs() < 1e-9, "{:?}, not {expected:?}", answer.coordinates);
    }
}

/// Two links of which the end should be at a place: the law of cosines, the elbow on the side of `sign`.
fn two_links([a, b]: [f64; 2], [x, y]: [f64; 2], sign: f64) -> [f64; 2] {
    let elbow = sign * ((x * x + y * y - a * a - b * b) / (2.0 * a * b)).acos();
    let shoulder = y.atan2(x) - (b * elbow.sin()).atan2(a + b * elbow.cos());
    [shoulder, elbow]
}

#[test]
fn of_two_elbows_the_one_nearer_to_rest_is_taken() {
    let model = chain(&[0.30, 0.25]).build().unwrap();
    for place in [[0.1, 0.4], [-0.2, 0.3], [-0.35, -0.1], [0.2, -0.05]] {
        let aim = Aim::Point { point: end(&model, 0.25), at: at(place[0], place[1]) };
        let answer = solve(&model, &asked(&model, vec![aim]));
        assert!(answer.is_met(), "{answer:?}");
        // Both of the closed form within half a turn of rest; R is the sum of the squared angles.
        let wind = |q: f64| q - (q / (2.0 * PI)).round() * 2.0 * PI;
        let both = [1.0, -1.0].map(|sign| two_links([0.30, 0.25], place, sign).map(wind));
        let size = |q: &[f64; 2]| q[0] * q[0] + q[1] * q[1];
        let nearer = if size(&both[0]) < size(&both[1]) { both[0] } else { both[1] };
        close(&answer, &nearer);
        assert!(answer.misses[0].off < 1e-10);
        assert_eq!(answer.by, [By::Goals; 2]);
    }
}

#[test]
fn of_three_links_the_pose_nearest_to_rest_is_stationary() {
    let lengths = [0.3, 0.25, 0.2];
    let model = chain(&lengths).build().unwrap();
    for place in [[0.3, 0.4], [0.1, 0.5], [-0.3, 0.2]] {
        let aim = Aim::Point { point: end(&model, 0.2), at: at(place[0], place[1]) };
        let answer = solve(&model, &asked(&model, vec![aim]));
        assert!(answer.is_met(), "{answer:?}");
        let q = &answer.coordinates;
        let headings = [q[0], q[0] + q[1], q[0] + q[1] + q[2]];
        let sum = |f: fn(f64) -> f64, first: usize| -> f64 {
            (first..3).map(|i| lengths[i] * f(headings[i])).sum()
        };
        assert!((sum(f64::cos, 0) - place[0]).abs() < 1e-10);
        assert!((sum(f64::sin, 0) - place[1]).abs() < 1e-10);
        // Lagrange: q is in the plane of the gradients of x and y, so q · (∂x × ∂y) = 0.
        let across: Vec<[f64; 2]> = (0..3).map(|i| [-sum(f64::sin, i), sum(f64::cos, i)]).collect();
        let [x, y] = [0, 1].map(|k| Vec3::new(across[0][k], across[1][k], across[2][k]));
        let normal = x.cross(y).normalized();
        assert!(normal.dot(Vec3::new(q[0], q[1], q[2])).abs() < 1e-9, "{q:?}");
        assert_eq!(answer.by, [By::Shared; 3]);
        // No pose on the circle of solutions is nearer: sampled by the angle of the last link.
        let size = q.iter().map(|q| q * q).sum::<f64>();
        for step in 0..3600 {
            let heading = f64::from(step) * PI / 1800.0;
            let wrist = [place[0] - 0.2 * heading.cos(), place[1] - 0.2 * heading.sin()];
            for sign in [1.0, -1.0] {
                let [a, b] = two_links([0.3, 0.25], wrist, sign);
                let wind = |q: f64| q - (q / (2.0 * PI)).round() * 2.0 * PI;
                let other = [a, b, heading - a - b].map(wind);
                let other = other.iter().map(|q| q * q).sum::<f64>();
                assert!(other.is_nan() || other > size - 1e-9, "{other} < {size}");
            }
        }
    }
}

#[test]
fn what_is_out_of_reach_is_pointed_at() {
    let lengths = [0.3, 0.25, 0.2];
    let model = chain(&lengths).build().unwrap();
    let aim = Aim::Point { point: end(&model, 0.2), at: at(0.6, 0.8) };
    let answer = solve(&model, &asked(&model, vec![aim]));
    assert!(!answer.is_met());
    // The straight chain of 0.75 m towards a place at 1 m.
    assert!((answer.misses[0].off - 0.25).abs() < 1e-9, "{answer:?}");
    close(&answer, &[0.8f64.atan2(0.6), 0.0, 0.0]);
}

#[test]
fn ranges_hold_and_say_so() {
    let mut b = chain(&[0.30, 0.25]);
    let elbow = b.coordinate_at(1).unwrap();
    b.coordinate_mut(elbow).range = Range::new(0.0, 1.0);
    let model = b.build().unwrap();
    // Nearer to the root than the elbow's range allows: with the elbow at 1 rad the end is as near as it
    // gets, at the distance d of the law of cosines, in the direction of the goal.
    let aim = Aim::Point { point: end(&model, 0.25), at: at(0.0, 0.2) };
    let answer = solve(&model, &asked(&model, vec![aim]));
    let distance = (0.3f64.powi(2) + 0.25f64.powi(2) + 2.0 * 0.3 * 0.25 * 1f64.cos()).sqrt();
    assert!((answer.misses[0].off - (distance - 0.2)).abs() < 1e-9, "{answer:?}");
    let turn = (0.25 * 1f64.sin()).atan2(0.3 + 0.25 * 1f64.cos());
    close(&answer, &[FRAC_PI_2 - turn, 1.0]);
    assert_eq!(answer.by, [By::Goals, By::Limit]);
    // Within the range only one of the two elbows is legal.
    let aim = Aim::Point { point: end(&model, 0.25), at: at(0.1, 0.5) };
    let answer = solve(&model, &asked(&model, vec![aim]));
    close(&answer, &two_links([0.30, 0.25], [0.1, 0.5], 1.0));
}

#[test]
fn distances_directions_planes_and_values() {
    let model = chain(&[0.30, 0.25]).build().unwrap();
    let [first, second] = [0, 1].map(|i| segment(&model, i));
    let of = |aims: Vec<Aim>| solve(&model, &asked(&model, aims));
    // |p - root|² = a² + b² + 2ab cos q₁; the first joint stays at rest.
    let points = [at(0.0, 0.0), end(&model, 0.25)];
    let answer = of(vec![Aim::Distance { points, distance: 0.4 }]);
    let elbow = ((0.16 - 0.09 - 0.0625) / (2.0 * 0.3 * 0.25_f64)).acos();
    assert!(answer.is_met() && (answer.coordinates[1].abs() - elbow).abs() < 1e-9, "{answer:?}");
    assert!(answer.coordinates[0].abs() < 1e-12);
    assert_eq!(answer.by, [By::Rest, By::Goals]);
    // A sum of two angles is shared evenly.
    let rotation = Quat::from_axis_angle(Vec3::Z, 1.2);
    let answer = of(vec![Aim::Orientation { segment: second, relative_to: None, rotation }]);
    close(&answer, &[0.6, 0.6]);
    let answer = of(vec![Aim::Orientation { segment: second, relative_to: Some(first), rotation }]);
    close(&answer, &[0.0, 1.2]);
    let along = Vec3::new(0.0, -2.0, 0.0);
    let axis = Vec3::X;
    let answer = of(vec![Aim::Axis { segment: second, axis, relative_to: None, along }]);
    close(&answer, &[-PI / 4.0; 2]);
    // y of the end of the second link is b above a straight first one: sin q₁ = 0.2/0.25 where q₀ is held.
    let plane = |side, height| Aim::Plane {
        point: end(&model, 0.25),
        origin: at(5.0, height),
        normal: Vec3::Y * 3.0,
        side,
    };
    let mut goals = asked(&model, vec![plane(Side::On, 0.2)]);
    goals.held = vec![coordinate(&model, 0)];
    let answer = solve(&model, &goals);
    close(&answer, &[0.0, 0.8f64.asin()]);
    assert_eq!(answer.by, [By::Held, By::Goals]);
    // Above a plane below it nothing has to be done; above one over it, the same as on it.
    close(&of(vec![plane(Side::Above, -0.1)]), &[0.0, 0.0]);
    goals.goals = vec![exact(plane(Side::Above, 0.2))];
    close(&solve(&model, &goals), &[0.0, 0.8f64.asin()]);
    let value = Aim::Coordinate { coordinate: coordinate(&model, 1), value: -0.7 };
    close(&of(vec![value.clone()]), &[0.0, -0.7]);
    // A plane fixed in the first link, which turns with it.
    let turned = Aim::Plane {
        point: end(&model, 0.25),
        origin: (Some(first), Vec3::ZERO),
        normal: Vec3::Y,
        side: Side::On,
    };
    let rotation = Quat::from_axis_angle(Vec3::Z, 0.4);
    let whole = Aim::Orientation { segment: second, relative_to: None, rotation };
    close(&of(vec![turned, whole]), &[0.4, 0.0]);
    // A weight w trades against rest: w (q₁ - v)² + k (q₁)², with k = 1e-6.
    let mut goals = Goals::of(&model);
    goals.goals = vec![Goal { aim: value, weight: Some(1e-6) }];
    let answer = solve(&model, &goals);
    close(&answer, &[0.0, -0.35]);
    assert!(answer.is_met() && answer.misses[0].weighted);
}

#[test]
fn a_head_looks_at_a_point() {
    // A ball at (0, 1.5, 0) with eyes at (0.1, 0.05, 0) in it; the line of sight along x.
    let mut b = ModelBuilder::new("head");
    let head = b.segment("head", None);
    b.place_joint(head, Vec3::new(0.0, 1.5, 0.0));
    b.ball_joint("neck", head);
    let model = b.build().unwrap();
    let (through, axis) = (Vec3::new(0.1, 0.05, 0.0), Vec3::X);
    for place in [Vec3::new(1.0, 1.0, 0.5), Vec3::new(-1.0, 2.0, 0.3), Vec3::new(0.2, 1.6, -2.0)] {
        let look = Aim::Look { segment: head, axis, through, at: (None, place) };
        let answer = solve(&model, &asked(&model, vec![look]));
        assert!(answer.is_met(), "{answer:?}");
        // With y = 0.05 the height of the eyes over the ball and d the distance of the place from the
        // ball, sight meets the place where its distance along x is √(d² - y²); and the pose nearest to
        // rest turns about an axis at right angles to where the place was and is.
        let d = place - Vec3::new(0.0, 1.5, 0.0);
        let seen = Vec3::new((d.norm_squared() - 0.05f64.powi(2)).sqrt(), 0.05, 0.0);
        let q = Quat::from(std::array::from_fn::<f64, 4, _>(|i| answer.coordinates[i]));
        assert!((q.to_mat3() * seen - d).norm() < 1e-9, "{answer:?}");
        let shortest = (seen.dot(d) / d.norm_squared()).acos();
        assert!((q.log().norm() - shortest).abs() < 1e-9, "{} {shortest}", q.log().norm());
    }
}

/// Figure 5(c) of Pronost, Sandholm & Thalmann 2010: a bow compass, whose wheel R turns both legs, the
/// rod, and moves the wheel along the rod, R_leg1 = α₁ R, R_leg2 = α₂ R, R_rod = α₃ R, T = α₄ R + α₅.
const ALPHA: [f64; 5] = [0.02, -0.02, -0.01, 0.0004, 0.012];
const LEG: f64 = 0.14;

fn compass() -> Model {
    let mut b = ModelBuilder::new("bow compass");
    let head = b.segment("head", None);
    let wheel = b.joint_set("wheel");
    let turn = b.coordinate(wheel, "R", CoordinateKind::Rotation);
    let legs = [0, 1].map(|i| {
        let leg = b.segment(&format!("leg{}", i + 1), Some(head));
        let law = b.map(wheel, &format!("law{i}"), turn, Function::linear(ALPHA[i], 0.0));
        let motion = b.rotate(wheel, &format!("open{i}"), law, Vec3::Z);
        b.output(wheel, leg, motion);
        b.marker(&format!("tip{}", i + 1), Some(leg), Vec3::new(0.0, -LEG, 0.0));
        leg
    });
    let rod = b.segment("rod", Some(legs[0]));
    b.place_joint(rod, Vec3::new(0.0, -0.05, 0.0));
    let law = b.map(wheel, "rod_law", turn, Function::linear(ALPHA[2], 0.0));
    let motion = b.rotate(wheel, "rod_turn", law, Vec3::Z);
    b.output(wheel, rod, motion);
    let nut = b.segment("nut", Some(rod));
    let law = b.map(wheel, "nut_law", turn, Function::linear(ALPHA[3], ALPHA[4]));
    let motion = b.translate(wheel, "nut_shift", law, -Vec3::X);
    b.output(wheel, nut, motion);
    b.build().unwrap()
}

#[test]
fn the_bow_compass_opens_by_its_wheel() {
    let model = compass();
    assert_eq!(model.coordinates().len(), 1, "the wheel is the only input");
    let tip = |i: usize| {
        let marker = &model.markers()[i];
        (marker.segment, marker.point)
    };
    for distance in [0.01, 0.05, 0.1, 0.2, 0.27] {
        let aim = Aim::Distance { points: [tip(0), tip(1)], distance };
        let mut goals = asked(&model, vec![aim]);
        // Of the two solutions ±R the one that opens it.
        goals.rest.pose[0] = 1.0;
        let answer = solve(&model, &goals);
        // The tips are on a circle of radius l: |p₁ - p₂| = 2 l sin((α₁ - α₂) R / 2).
        let wheel = (0.5 * distance / LEG).asin() * 2.0 / (ALPHA[0] - ALPHA[1]);
        assert!((answer.coordinates[0] - wheel).abs() < 1e-9, "{answer:?} {wheel}");
        assert!(answer.misses[0].off < 1e-12, "{answer:?}");
        assert_eq!(answer.by, [By::Goals]);
        // Where the laws put the rod and the nut at that turn of the wheel.
        let program = Program::compile(&model);
        let mut pose = Pose::new(&program);
        program.evaluate(&answer.coordinates, Mode::Open, &mut pose).unwrap();
        let nut = pose.segment(model.find_segment("nut").unwrap());
        let heading = (ALPHA[0] + ALPHA[2]) * wheel;
        let leg = ALPHA[0] * wheel;
        let along = -(ALPHA[3] * wheel + ALPHA[4]);
        let expected = Vec3::new(0.05 * leg.sin(), -0.05 * leg.cos(), 0.0)
            + Vec3::new(heading.cos(), heading.sin(), 0.0) * along;
        assert!((nut.translation - expected).norm() < 1e-9);
    }
    // Wider than two legs it does not open: the legs are in line, half a turn apart.
    let aim = Aim::Distance { points: [tip(0), tip(1)], distance: 0.3 };
    let answer = solve(&model, &asked(&model, vec![aim]));
    assert!((answer.misses[0].off - 0.02).abs() < 1e-9, "{answer:?}");
    assert!((answer.coordinates[0].abs() - PI / (ALPHA[0] - ALPHA[1])).abs() < 1e-6);
}

#[test]
fn a_compass_whose_rod_closes_a_loop_opens_as_far() {
    // The same without laws: both legs turn freely, the rod turns on the first and slides through a point
    // of the second; both points are 5 cm below the head.
    let mut b = ModelBuilder::new("loop");
    let legs = [1, 2].map(|i| {
        let leg = b.segment(&format!("leg{i}"), None);
        b.hinge(&format!("hinge{i}"), leg, &format!("leg{i}"), Vec3::Z);
        leg
    });
    let rod = b.segment("rod", Some(legs[0]));
    b.place_joint(rod, Vec3::new(0.0, -0.05, 0.0));
    b.hinge("pin", rod, "rod", Vec3::Z);
    let nut = b.segment("nut", Some(rod));
    let set = b.joint_set("thread");
    let shift = b.coordinate(set, "shift", CoordinateKind::Translation);
    let motion = b.translate(set, "slide", shift, -Vec3::X);
    b.output(set, nut, motion);
    let at = [(Some(nut), Vec3::ZERO), (Some(legs[1]), Vec3::new(0.0, -0.05, 0.0))];
    b.closure(Closure { name: "nut".to_owned(), condition: Condition::Points { at } });
    let model = b.build().unwrap();
    let tip = |leg| (Some(leg), Vec3::new(0.0, -LEG, 0.0));
    for distance in [0.05, 0.1, 0.2] {
        let aim = Aim::Distance { points: [tip(legs[0]), tip(legs[1])], distance };
        let mut goals = asked(&model, vec![aim]);
        goals.rest.stiffness = vec![1e-6; 4];
        goals.rest.pose = vec![0.1, -0.1, -0.1, 0.01];
        let answer = solve(&model, &goals);
        assert!(answer.is_met() && answer.closure_error < 1e-10, "{answer:?}");
        // Half the opening angle h: the tips are 2 l sin h apart, the nut 2 · 0.05 sin h along the rod, which
        // is level where both legs open alike.
        let half = (0.5 * distance / LEG).asin();
        let q = &answer.coordinates;
        assert!((q[0] - q[1] - 2.0 * half).abs() < 1e-9, "{q:?}");
        assert!((q[3] - 0.1 * half.sin()).abs() < 1e-9, "{q:?}");
        assert!((q[0] + q[2] - 0.5 * (q[0] + q[1])).abs() < 1e-9, "{q:?}");
    }
}

#[test]
fn what_cannot_move_or_be_measured_stays_at_rest() {
    let model = chain(&[0.3, 0.25]).build().unwrap();
    let point = |x| Aim::Point { point: end(&model, 0.25), at: at(x, 0.0) };
    let mut goals = asked(&model, vec![point(0.5)]);
    goals.held = model.coordinate_ids().collect();
    let answer = solve(&model, &goals);
    assert_eq!((answer.coordinates, answer.by), (vec![0.0, 0.0], vec![By::Held; 2]));
    assert!((answer.misses[0].off - 0.05).abs() < 1e-15);
    for x in [f64::NAN, f64::INFINITY, 1e300] {
        let answer = solve(&model, &asked(&model, vec![point(x)]));
        assert!(!answer.is_met() && answer.coordinates.iter().all(|q| q.is_finite()), "{answer:?}");
    }
    // Nothing asked of a model without coordinates.
    let mut b = ModelBuilder::new("block");
    b.segment("block", None);
    let block = b.build().unwrap();
    assert!(solve(&block, &Goals::of(&block)).is_met());
}
