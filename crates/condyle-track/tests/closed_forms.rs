//! Small problems whose minimum is known in closed form.

use condyle_math::Vec3;
use condyle_math::function::Function;
use condyle_model::model::{Closure, Condition};
use condyle_model::{
    CoordinateId, CoordinateKind, Mode, Model, ModelBuilder, Pose, Program, Range, SegmentId,
};
use condyle_track::{
    CoordinateTarget, FrameAnswer, FrameStatus, MarkerTarget, PostureTarget, Rules, Scratch,
    Stream, Targets, Tracker, Wanted,
};
use std::sync::Arc;

/// Two independent slides along x with a marker on each.
fn slides(adjust: impl FnOnce(&mut ModelBuilder, [CoordinateId; 2])) -> Model {
    let mut b = ModelBuilder::new("slides");
    let ids = ["a", "b"].map(|name| {
        let segment = b.segment(name, None);
        let set = b.joint_set(&format!("joint_{name}"));
        let x = b.coordinate(set, name, CoordinateKind::Translation);
        let motion = b.translate(set, "slide", x, Vec3::X);
        b.output(set, segment, motion);
        b.marker(&format!("marker_{name}"), Some(segment), Vec3::ZERO);
        x
    });
    adjust(&mut b, ids);
    b.build().unwrap()
}

fn markers(weights: [f64; 2]) -> Vec<MarkerTarget> {
    weights.iter().enumerate().map(|(marker, &weight)| MarkerTarget { marker, weight }).collect()
}

fn answer(model: &Model, targets: Targets, seen: &[Option<f64>]) -> FrameAnswer {
    let rules = Rules { tolerance: 1e-12, ..Rules::default() };
    let tracker = Tracker::new(model.clone(), targets, rules);
    let mut scratch = Scratch::new(&tracker);
    let seen: Vec<Option<[f64; 3]>> = seen.iter().map(|x| x.map(|x| [x, 0.0, 0.0])).collect();
    tracker.solve_frame(&mut scratch, &seen, 0, &model.defaults())
}

fn solve(model: &Model, targets: Targets, seen: &[Option<f64>]) -> (Vec<f64>, f64, FrameStatus) {
    let answer = answer(model, targets, seen);
    (answer.coordinates, answer.objective, answer.status)
}

#[test]
fn marker_part_is_divided_by_the_weights_seen_and_the_coordinate_part_is_not() {
    let model = slides(|_, _| {});
    let id = model.find_coordinate("a").unwrap();
    let wanted = |weights| Targets {
        markers: markers(weights),
        coordinates: vec![CoordinateTarget {
            coordinate: id,
            weight: 0.5,
            wanted: Wanted::Constant(0.0),
        }],
        ..Targets::default()
    };
    // Both seen, weights 1 and 3: F = (a - 1)²/4 + ½a², least at a = ¼/(¼ + ½) = 1/3.
    let (q, f, _) = solve(&model, wanted([1.0, 3.0]), &[Some(1.0), Some(2.0)]);
    assert!((q[0] - 1.0 / 3.0).abs() < 1e-9 && (q[1] - 2.0).abs() < 1e-9, "{q:?}");
    assert!((f - (4.0 / 9.0 / 4.0 + 0.5 / 9.0)).abs() < 1e-9, "{f}");
    // Only the first seen: F = (a - 1)² + ½a², least at a = 2/3; b stays at its default.
    let (q, f, status) = solve(&model, wanted([1.0, 3.0]), &[Some(1.0), None]);
    assert!((q[0] - 2.0 / 3.0).abs() < 1e-9 && q[1].abs() < 1e-9, "{q:?}");
    assert!((f - 1.0 / 3.0).abs() < 1e-9, "{f}");
    assert_eq!(status, FrameStatus::Solved);
}

#[test]
fn a_coordinate_stops_exactly_at_its_bound_and_passes_one_that_is_not_enforced() {
    for (enforced, expected) in [(true, 0.25), (false, 1.0)] {
        let model = slides(|b, [a, _]| {
            b.coordinate_mut(a).range = Range { lower: None, upper: Some(0.25), enforced };
        });
        let wanted = Targets { markers: markers([1.0, 1.0]), ..Targets::default() };
        let (q, ..) = solve(&model, wanted, &[Some(1.0), Some(0.5)]);
        if enforced {
            assert_eq!(q[0], expected);
        }
        assert!((q[0] - expected).abs() < 1e-9, "{q:?}");
    }
}

#[test]
fn the_range_of_a_coordinate_that_follows_holds_its_leader() {
    // b = 2a + 0.1 within [-0.2, 0.2], so a ≤ 0.05; the marker on a asks for 1.
    let model = slides(|b, [a, follower]| {
        let set = b.coordinates()[follower.index()].joint_set;
        let leader = b.map(set, "follow", a, Function::linear(2.0, 0.1));
        b.follow(follower, leader);
        b.coordinate_mut(follower).range = Range::new(-0.2, 0.2);
    });
    let wanted = Targets { markers: markers([1.0, 0.0]), ..Targets::default() };
    let (q, _, status) = solve(&model, wanted, &[Some(1.0), None]);
    assert_eq!(status, FrameStatus::Solved);
    assert!((q[0] - 0.05).abs() < 1e-7 && (q[1] - 0.2).abs() < 2e-7, "{q:?}");
}

#[test]
fn loops_close_exactly_or_at_a_price() {
    let model = slides(|b, _| {
        b.closure(Closure {
            name: "a meets b".to_owned(),
            condition: Condition::Points { at: [0, 1].map(|i| (b.segment_at(i), Vec3::ZERO)) },
        });
    });
    let wanted = |closure_weight| Targets {
        markers: markers([1.0, 1.0]),
        closure_weight,
        ..Targets::default()
    };
    // Exact: both in the middle of their targets 0 and 1, F = (¼ + ¼)/2.
    let (q, f, _) = solve(&model, wanted(None), &[Some(0.0), Some(1.0)]);
    assert!((q[0] - 0.5).abs() < 1e-9 && (q[0] - q[1]).abs() < 1e-9, "{q:?}");
    assert!((f - 0.25).abs() < 1e-9);
    // Weight w: with gap g, each end gives way by (1 - g)/2, so F = (1 - g)²/4 + w·g², g = 1/(1 + 4w).
    for weight in [0.25, 1.0, 10.0] {
        let (q, ..) = solve(&model, wanted(Some(weight)), &[Some(0.0), Some(1.0)]);
        let gap = 1.0 / (1.0 + 4.0 * weight);
        assert!((q[1] - q[0] - gap).abs() < 1e-9, "weight {weight}: {q:?}");
    }
}

#[test]
fn locked_coordinates_stay_and_frames_without_markers_say_so() {
    let model = slides(|b, [a, _]| {
        b.coordinate_mut(a).default[0] = 0.3;
        b.coordinate_mut(a).locked = true;
    });
    let wanted = Targets { markers: markers([1.0, 1.0]), ..Targets::default() };
    let (q, ..) = solve(&model, wanted.clone(), &[Some(1.0), Some(2.0)]);
    assert_eq!(q[0], 0.3);
    assert!((q[1] - 2.0).abs() < 1e-9);
    let (_, _, status) = solve(&model, wanted, &[None, None]);
    assert_eq!(status, FrameStatus::NoMarkers);
}

#[test]
fn a_quaternion_ball_turns_to_its_markers_from_any_start() {
    let mut b = ModelBuilder::new("ball");
    let bone = b.segment("bone", None);
    b.ball_joint("joint", bone);
    let points = [Vec3::X, Vec3::Y, Vec3::new(0.3, -0.2, 0.9)];
    for (i, &point) in points.iter().enumerate() {
        b.marker(&format!("m{i}"), Some(bone), point);
    }
    let model = b.build().unwrap();
    let markers = (0..3).map(|marker| MarkerTarget { marker, weight: 1.0 }).collect();
    let tracker = Tracker::new(model, Targets { markers, ..Targets::default() }, Rules::default());
    let mut scratch = Scratch::new(&tracker);
    for turn in [Vec3::new(0.1, 0.2, 0.3), Vec3::new(0.0, 3.1, 0.0), Vec3::new(-2.0, 1.0, 1.5)] {
        let truth = condyle_math::Quat::exp(turn);
        let targets: Vec<_> =
            points.iter().map(|&p| Some((truth.to_mat3() * p).to_array())).collect();
        let answer = tracker.solve_first(&mut scratch, &targets, 0, 8);
        let q: [f64; 4] = answer.coordinates[..].try_into().unwrap();
        assert!(truth.angle_to(q.into()) < 1e-5, "{turn:?}: {q:?}");
    }
}

#[test]
fn markers_below_a_scale_find_its_factor() {
    // Stretched along x by s; a segment that hangs at (1, 0) and is turned by t is stretched with it:
    // its point (x, y) is at (s·(1 + x cos t - y sin t), x sin t + y cos t).
    use condyle_model::Law;
    use condyle_model::component::{Along, Scale};
    let mut b = ModelBuilder::new("stretch");
    let bone = b.segment("bone", None);
    let set = b.joint_set("joint");
    let factor = b.coordinate(set, "factor", CoordinateKind::Scale);
    let scale = Law::Scale(Scale { along: Along::Axis(Vec3::X) });
    let motion = b.component(set, "stretch", scale, vec![factor.into()]);
    b.output(set, bone, motion);
    let tip = b.segment("tip", Some(bone));
    b.place_joint(tip, Vec3::X);
    b.hinge("hinge", tip, "angle", Vec3::Z);
    b.marker("near", Some(bone), Vec3::new(0.5, 0.2, 0.0));
    b.marker("far", Some(tip), Vec3::new(0.3, 0.1, 0.0));
    b.marker("farther", Some(tip), Vec3::new(0.0, 0.4, 0.0));
    let model = b.build().unwrap();
    let (s, t) = (1.3f64, 0.4f64);
    let hung =
        |x: f64, y: f64| [s * (1.0 + x * t.cos() - y * t.sin()), x * t.sin() + y * t.cos(), 0.0];
    let targets = [[0.5 * s, 0.2, 0.0], hung(0.3, 0.1), hung(0.0, 0.4)];
    let wanted = Targets {
        markers: (0..3).map(|marker| MarkerTarget { marker, weight: 1.0 }).collect(),
        ..Targets::default()
    };
    let tracker = Tracker::new(model, wanted, Rules { tolerance: 1e-12, ..Rules::default() });
    let mut scratch = Scratch::new(&tracker);
    let seen: Vec<Option<[f64; 3]>> = targets.into_iter().map(Some).collect();
    let answer = tracker.solve_frame(&mut scratch, &seen, 0, &tracker.model().defaults());
    assert_eq!(answer.status, FrameStatus::Solved);
    // The tiny prior towards the defaults leaves its trace.
    assert!((answer.coordinates[0] - s).abs() < 1e-6, "{:?}", answer.coordinates);
    assert!((answer.coordinates[1] - t).abs() < 1e-6, "{:?}", answer.coordinates);
}

#[test]
fn a_posture_gives_way_by_its_stiffness_and_is_reported_apart() {
    let model = slides(|_, _| {});
    let [a, b] = ["a", "b"].map(|name| model.find_coordinate(name).unwrap());
    let rests = |terms: &[(CoordinateId, f64)], rest, stiffness| Targets {
        markers: markers([1.0, 1.0]),
        postures: vec![PostureTarget { terms: terms.to_vec(), rest, stiffness }],
        ..Targets::default()
    };
    for k in [0.25, 1.0, 3.0] {
        // One marker: (a - 1)² + k a² is least at a = 1/(1 + k); F is the first part, P the second.
        let found = answer(&model, rests(&[(a, 1.0)], 0.0, k), &[Some(1.0), None]);
        let least = 1.0 / (1.0 + k);
        assert!((found.coordinates[0] - least).abs() < 1e-9, "{found:?}");
        assert!((found.objective - (least - 1.0).powi(2)).abs() < 1e-9, "{found:?}");
        assert!((found.posture - k * least * least).abs() < 1e-9, "{found:?}");
        // Two markers at 1 and 2: ½(a - 1)² + ½(b - 2)² + k (a - 2b + 0.5)². With s = a - 2b + 0.5,
        // a = 1 - 2ks and b = 2 + 4ks, so s = -2.5 - 10ks.
        let found = answer(&model, rests(&[(a, 1.0), (b, -2.0)], -0.5, k), &[Some(1.0), Some(2.0)]);
        let s = -2.5 / (1.0 + 10.0 * k);
        let [q, r] = [found.coordinates[0], found.coordinates[1]];
        assert!((q - (1.0 - 2.0 * k * s)).abs() < 1e-9, "{found:?}");
        assert!((r - (2.0 + 4.0 * k * s)).abs() < 1e-9, "{found:?}");
        assert!((found.posture - k * s * s).abs() < 1e-9, "{found:?}");
        assert!((found.objective - 10.0 * (k * s).powi(2)).abs() < 1e-9, "{found:?}");
    }
    // Where no marker is seen nothing says where the model is, and it stays where it was.
    let found = answer(&model, rests(&[(b, 2.0)], 0.6, 1e-5), &[None, None]);
    assert_eq!(found.coordinates, model.defaults());
    assert_eq!((found.status, found.objective), (FrameStatus::NoMarkers, 0.0));
}

#[test]
fn a_model_its_tracker_and_a_stream_move_together_and_find_back_after_a_gap() {
    struct Laboratory {
        model: Arc<Model>,
        stream: Stream,
    }
    let mut b = ModelBuilder::new("arm");
    let arm = b.segment("arm", None);
    b.hinge("joint", arm, "turn", Vec3::Z);
    let points = [Vec3::X, Vec3::Y * 0.3];
    points.iter().for_each(|&p| b.marker(&format!("m{p:?}"), Some(arm), p));
    let model = Arc::new(b.build().unwrap());
    let tracker = Tracker::new(
        Arc::clone(&model),
        Targets { markers: markers([1.0, 1.0]), ..Targets::default() },
        Rules::default(),
    );
    let mut laboratory = Laboratory { model, stream: Stream::new(tracker) };
    let turned = std::thread::spawn(move || {
        let seen = |turn: f64| {
            let turn = condyle_math::Quat::exp(Vec3::Z * turn).to_mat3();
            points.map(|p| Some((turn * p).to_array()))
        };
        let mut turned = vec![];
        let mut look = |seen: &[Option<[f64; 3]>]| {
            let answer = laboratory.stream.next(seen);
            turned.push((answer.coordinates[0], answer.status));
        };
        // Nothing, then a turn; a gap in which the arm goes to the other side.
        look(&[None, None]);
        look(&seen(0.2));
        (0..3).for_each(|_| look(&[None, None]));
        look(&seen(-3.0));
        assert!(Arc::ptr_eq(&laboratory.model, laboratory.stream.tracker().model()));
        turned
    })
    .join()
    .unwrap();
    let lost = FrameStatus::NoMarkers;
    let expected = [(0.0, lost), (0.2, FrameStatus::Solved), (0.2, lost), (0.2, lost), (0.2, lost)];
    for (found, expected) in turned.iter().zip(expected) {
        assert!((found.0 - expected.0).abs() < 1e-6 && found.1 == expected.1, "{turned:?}");
    }
    // From 0.2 a turn by -3 is nearer as 2π - 3.
    let (back, status) = turned[5];
    assert!(
        (back - (std::f64::consts::TAU - 3.0)).abs() < 1e-6 && status.is_solved(),
        "{turned:?}"
    );
}

/// A chain of five hinges about z, some of which follow others, with a marker on each link.
fn chain(adjust: impl FnOnce(&mut ModelBuilder, &[CoordinateId], &[SegmentId])) -> Model {
    let mut b = ModelBuilder::new("chain");
    let (mut angles, mut links) = (vec![], vec![]);
    for i in 0..5 {
        let link = b.segment(&format!("link_{i}"), links.last().copied());
        if i > 0 {
            b.place_joint(link, Vec3::new(0.0, -0.3, 0.0));
        }
        let (_, angle) = b.hinge(&format!("joint_{i}"), link, &format!("angle_{i}"), Vec3::Z);
        b.marker(&format!("marker_{i}"), Some(link), Vec3::new(0.1, -0.25, 0.05));
        angles.push(angle);
        links.push(link);
    }
    // The second and the fourth follow, the fourth through the third, which is free.
    b.follow(angles[1], angles[0].into());
    let set = b.joint_set("laws");
    let half = b.map(set, "half", angles[2], Function::linear(0.5, 0.1));
    b.follow(angles[3], half);
    adjust(&mut b, &angles, &links);
    b.build().unwrap()
}

#[test]
fn a_redundant_loop_never_changes_the_answer() {
    let coupling = |follower, driver, slope, intercept| Closure {
        name: "again".to_owned(),
        condition: Condition::Coupling {
            follower,
            driver,
            function: Function::linear(slope, intercept),
        },
    };
    // The end of the chain is held where it is in the pose that the markers are made from.
    let truth = [0.4, 0.4, -0.3, -0.05, -0.05];
    let model = chain(|_, _, _| ());
    let program = Program::compile(&model);
    let mut pose = Pose::new(&program);
    program.evaluate(&truth, Mode::Open, &mut pose).unwrap();
    let end = pose.segments()[4] * Vec3::new(0.0, -0.3, 0.0);
    let places: Vec<Vec3> =
        model.markers().iter().map(|m| pose.frame(m.segment) * m.point).collect();
    let pin = |link| Closure {
        name: "pin".to_owned(),
        condition: Condition::Points { at: [(Some(link), Vec3::new(0.0, -0.3, 0.0)), (None, end)] },
    };
    type Add<'a> = &'a dyn Fn(&mut ModelBuilder, &[CoordinateId], &[SegmentId]);
    let nothing: Add<'_> = &|_, _, _| ();
    let pinned: Add<'_> = &|b, _, links| b.closure(pin(links[4]));
    let led: Add<'_> = &|b, angles, _| b.closure(coupling(angles[4], angles[3], 1.0, 0.0));
    // Each adds what holds already: a coupling of a follower with its leader, in both directions, with
    // a leader of a leader, the same loop again, one that the first two imply.
    let cases: [(Add<'_>, Add<'_>); 6] = [
        (nothing, &|b, angles, _| b.closure(coupling(angles[1], angles[0], 1.0, 0.0))),
        (nothing, &|b, angles, _| b.closure(coupling(angles[2], angles[3], 2.0, -0.2))),
        (nothing, &|b, angles, _| b.closure(coupling(angles[1], angles[1], 1.0, 0.0))),
        (pinned, &|b, _, links| b.closure(pin(links[4]))),
        (pinned, &|b, angles, _| b.closure(coupling(angles[0], angles[1], 1.0, 0.0))),
        (led, &|b, angles, _| b.closure(coupling(angles[4], angles[2], 0.5, 0.1))),
    ];
    for seed in 0..40u32 {
        let noise = |k: usize| 0.05 * (f64::from(seed) * 1.7 + k as f64 * 2.3).sin();
        for (number, (base, more)) in cases.iter().enumerate() {
            let models = [
                chain(|b, angles, links| base(b, angles, links)),
                chain(|b, angles, links| {
                    base(b, angles, links);
                    more(b, angles, links);
                }),
            ];
            let seen: Vec<Option<[f64; 3]>> = (0..5)
                .map(|i| {
                    let off = Vec3::new(noise(3 * i), noise(3 * i + 1), noise(3 * i + 2));
                    Some((places[i] + off).to_array())
                })
                .collect();
            let [plain, again] = models.map(|model| {
                let markers = (0..5).map(|marker| MarkerTarget { marker, weight: 1.0 }).collect();
                let targets = Targets { markers, ..Targets::default() };
                let rules = Rules { tolerance: 1e-12, ..Rules::default() };
                let tracker = Tracker::new(model, targets, rules);
                let mut scratch = Scratch::new(&tracker);
                tracker.solve_first(&mut scratch, &seen, 0, 1)
            });
            let case = format!("case {number}, seed {seed}");
            assert!(plain.objective > 1e-4, "{case}: the markers are not to fit: {plain:?}");
            assert_eq!(plain.status, FrameStatus::Solved, "{case}");
            assert_eq!(again.status, FrameStatus::Solved, "{case}");
            let off = (plain.objective - again.objective).abs();
            assert!(off < 1e-9, "{case}: {} and {}", plain.objective, again.objective);
        }
    }
}
