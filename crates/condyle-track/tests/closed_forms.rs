//! Small problems whose minimum is known in closed form.

use condyle_math::Vec3;
use condyle_math::function::Function;
use condyle_model::model::{Closure, Condition};
use condyle_model::{CoordinateId, CoordinateKind, Model, ModelBuilder, Range};
use condyle_track::tasks::Target;
use condyle_track::{CoordinateTask, FrameStatus, MarkerTask, Options, Scratch, Tasks, Tracker};

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

fn markers(weights: [f64; 2]) -> Vec<MarkerTask> {
    weights.iter().enumerate().map(|(marker, &weight)| MarkerTask { marker, weight }).collect()
}

fn solve(model: &Model, tasks: Tasks, targets: &[Option<f64>]) -> (Vec<f64>, f64, FrameStatus) {
    let tracker = Tracker::new(model, tasks, Options { tolerance: 1e-12, ..Options::default() });
    let mut scratch = Scratch::new(&tracker);
    let targets: Vec<Option<[f64; 3]>> = targets.iter().map(|x| x.map(|x| [x, 0.0, 0.0])).collect();
    let answer = tracker.solve_frame(&mut scratch, &targets, 0, &[]);
    (answer.coordinates, answer.objective, answer.status)
}

#[test]
fn marker_part_is_divided_by_the_weights_seen_and_the_coordinate_part_is_not() {
    let model = slides(|_, _| {});
    let id = model.find_coordinate("a").unwrap();
    let tasks = |weights| Tasks {
        markers: markers(weights),
        coordinates: vec![CoordinateTask {
            coordinate: id,
            weight: 0.5,
            target: Target::Constant(0.0),
        }],
        closure_weight: None,
    };
    // Both seen, weights 1 and 3: F = (a - 1)²/4 + ½a², least at a = ¼/(¼ + ½) = 1/3.
    let (q, f, _) = solve(&model, tasks([1.0, 3.0]), &[Some(1.0), Some(2.0)]);
    assert!((q[0] - 1.0 / 3.0).abs() < 1e-9 && (q[1] - 2.0).abs() < 1e-9, "{q:?}");
    assert!((f - (4.0 / 9.0 / 4.0 + 0.5 / 9.0)).abs() < 1e-9, "{f}");
    // Only the first seen: F = (a - 1)² + ½a², least at a = 2/3; b stays at its default.
    let (q, f, status) = solve(&model, tasks([1.0, 3.0]), &[Some(1.0), None]);
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
        let tasks = Tasks { markers: markers([1.0, 1.0]), ..Tasks::default() };
        let (q, ..) = solve(&model, tasks, &[Some(1.0), Some(0.5)]);
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
    let tasks = Tasks { markers: markers([1.0, 0.0]), ..Tasks::default() };
    let (q, _, status) = solve(&model, tasks, &[Some(1.0), None]);
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
    let tasks = |closure_weight| Tasks {
        markers: markers([1.0, 1.0]),
        coordinates: vec![],
        closure_weight,
    };
    // Exact: both in the middle of their targets 0 and 1, F = (¼ + ¼)/2.
    let (q, f, _) = solve(&model, tasks(None), &[Some(0.0), Some(1.0)]);
    assert!((q[0] - 0.5).abs() < 1e-9 && (q[0] - q[1]).abs() < 1e-9, "{q:?}");
    assert!((f - 0.25).abs() < 1e-9);
    // Weight w: with gap g, each end gives way by (1 - g)/2, so F = (1 - g)²/4 + w·g², g = 1/(1 + 4w).
    for weight in [0.25, 1.0, 10.0] {
        let (q, ..) = solve(&model, tasks(Some(weight)), &[Some(0.0), Some(1.0)]);
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
    let tasks = Tasks { markers: markers([1.0, 1.0]), ..Tasks::default() };
    let (q, ..) = solve(&model, tasks.clone(), &[Some(1.0), Some(2.0)]);
    assert_eq!(q[0], 0.3);
    assert!((q[1] - 2.0).abs() < 1e-9);
    let (_, _, status) = solve(&model, tasks, &[None, None]);
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
    let markers = (0..3).map(|marker| MarkerTask { marker, weight: 1.0 }).collect();
    let tracker = Tracker::new(&model, Tasks { markers, ..Tasks::default() }, Options::default());
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
    use condyle_model::Component;
    use condyle_model::component::{Along, Scale};
    let mut b = ModelBuilder::new("stretch");
    let bone = b.segment("bone", None);
    let set = b.joint_set("joint");
    let factor = b.coordinate(set, "factor", CoordinateKind::Scale);
    let scale = Scale { factor: factor.into(), along: Along::Axis(Vec3::X) };
    let motion = b.component(set, "stretch", Component::Scale(scale));
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
    let tasks = Tasks {
        markers: (0..3).map(|marker| MarkerTask { marker, weight: 1.0 }).collect(),
        coordinates: vec![],
        closure_weight: None,
    };
    let tracker = Tracker::new(&model, tasks, Options { tolerance: 1e-12, ..Options::default() });
    let mut scratch = Scratch::new(&tracker);
    let seen: Vec<Option<[f64; 3]>> = targets.into_iter().map(Some).collect();
    let answer = tracker.solve_frame(&mut scratch, &seen, 0, &[]);
    assert_eq!(answer.status, FrameStatus::Solved);
    // The tiny prior towards the defaults leaves its trace.
    assert!((answer.coordinates[0] - s).abs() < 1e-6, "{:?}", answer.coordinates);
    assert!((answer.coordinates[1] - t).abs() < 1e-6, "{:?}", answer.coordinates);
}
