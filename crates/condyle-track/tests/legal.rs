//! The nearest legal pose against a search of all poses.

use condyle_math::Vec3;
use condyle_model::component::{
    AngleNames, Angles, JointCone, RelativeOrientation, RelativePosition, Swinging,
};
use condyle_model::component::{Ellipse, HalfSpace};
use condyle_model::limit::{Cone, ConePoint, Projection};
use condyle_model::{
    CoordinateId, Law, Mode, Model, ModelBuilder, Pose, Program, Range, SegmentId, Signal,
};
use condyle_track::goal::nearest_legal;

/// Two bones of a third of a metre in the plane, each on a hinge about z with a range of ±2.5.
fn arm() -> (ModelBuilder, [SegmentId; 2], [CoordinateId; 2]) {
    let mut b = ModelBuilder::new("arm");
    let upper = b.segment("upper", None);
    let (_, shoulder) = b.hinge("shoulder", upper, "shoulder", Vec3::Z);
    let lower = b.segment("lower", Some(upper));
    b.place_joint(lower, Vec3::new(0.3, 0.0, 0.0));
    let (_, elbow) = b.hinge("elbow", lower, "elbow", Vec3::Z);
    for id in [shoulder, elbow] {
        b.coordinate_mut(id).range = Range::new(-2.5, 2.5);
    }
    (b, [upper, lower], [shoulder, elbow])
}

/// The hand at most 20 cm up, and the forearm, in the world, not more than 1.2 from where it points at rest,
/// less where the hand is far forward.
fn limited() -> Model {
    let (mut b, [_, lower], _) = arm();
    let set = b.joint_set("limits");
    let point = Vec3::new(0.3, 0.0, 0.0);
    let hand = RelativePosition { reference: false, point, along: vec![Vec3::Y, Vec3::X] };
    let hand = b.component(set, "hand", Law::RelativePosition(hand), vec![lower.into()]);
    let Signal::Output(id, _) = hand else { panic!("a component has outputs") };
    let ceiling = HalfSpace::new(vec![1.0], 0.2).unwrap();
    b.component(set, "ceiling", Law::HalfSpace(ceiling), vec![hand]);
    let turned = Law::RelativeOrientation(RelativeOrientation { reference: false });
    let turned = b.component(set, "turned", turned, vec![lower.into()]);
    let names = AngleNames::Euler("zxy".parse().unwrap());
    let angles = Law::Angles(Angles { names, mirrored: None });
    let angle = b.component(set, "angles", angles, vec![turned]);
    let ellipse = Ellipse::new([0.0, 0.0], [1.2, 0.55], 0.0).unwrap();
    b.component(set, "hollow", Law::Ellipse(ellipse), vec![angle, Signal::Output(id, 1)]);
    b.build().unwrap()
}

fn legal(program: &Program, pose: &mut Pose, stored: &[f64]) -> bool {
    program.evaluate(stored, Mode::Open, pose).unwrap();
    (0..program.limit_row_len()).all(|row| pose.limit_row(row) >= -1e-7)
}

#[test]
fn no_pose_of_a_grid_is_nearer() {
    let model = limited();
    let program = Program::compile(&model);
    let mut pose = Pose::new(&program);
    let steps = 800;
    let step = 5.0 / f64::from(steps);
    let value = |i: i32| -2.5 + step * f64::from(i);
    let mut all = vec![];
    for i in 0..=steps {
        for k in 0..=steps {
            let stored = [value(i), value(k)];
            if legal(&program, &mut pose, &stored) {
                all.push(stored);
            }
        }
    }
    assert!(all.len() > 50_000, "only {} legal poses", all.len());
    let far = |a: &[f64], b: &[f64]| (a[0] - b[0]).hypot(a[1] - b[1]);
    let mut moved = 0;
    for i in 0..100 {
        let asked =
            [f64::from(i) * 0.7, f64::from(i) * 1.1].map(|x| (x.sin() * 2.5).clamp(-2.5, 2.5));
        let nearest = all.iter().map(|at| far(at, &asked)).fold(f64::INFINITY, f64::min);
        let Some(found) = nearest_legal(&model, &asked) else {
            assert!(legal(&program, &mut pose, &asked), "{asked:?}");
            continue;
        };
        moved += 1;
        assert!(legal(&program, &mut pose, &found), "{asked:?}: {found:?}");
        let own = far(&found, &asked);
        // A grid's pose is at most half a diagonal of a cell from the nearest one along the boundary.
        assert!(own < nearest + 1e-6, "{asked:?}: {own} {nearest}");
        assert!(own > nearest - 2.0 * step, "{asked:?}: {own} {nearest}");
        assert_eq!(nearest_legal(&model, &found).map(|again| far(&again, &found) < 1e-6), None);
    }
    assert!(moved > 50, "{moved}");
}

#[test]
fn a_ball_in_a_cone_turns_the_shortest_way() {
    // A round cone of half a radian about the direction -y, measured in the world: whatever the order
    // of the hinges below it, the nearest pose of a ball is the shortest turn.
    let mut b = ModelBuilder::new("ball");
    let bone = b.segment("bone", None);
    let (set, _) = b.ball_joint("joint", bone);
    let turned = Law::RelativeOrientation(RelativeOrientation { reference: false });
    let turned = b.component(set, "turned", turned, vec![bone.into()]);
    let points = (0..64).map(|i| {
        let (s, c) = (std::f64::consts::TAU * f64::from(i) / 64.0).sin_cos();
        let half = 0.5f64;
        ConePoint { direction: Vec3::new(half.sin() * c, -half.cos(), half.sin() * s), twist: None }
    });
    let cone = Cone::new(-Vec3::Y, None, points.collect(), 2, Projection::Nearest).unwrap();
    let limit = Law::Cone(JointCone { of: Swinging::Orientation, cone });
    b.component(set, "reach", limit, vec![turned]);
    let model = b.build().unwrap();
    for (axis, angle) in [(Vec3::X, 1.3), (Vec3::Z, -0.8), (Vec3::new(0.6, 0.0, 0.8), 2.0)] {
        let asked = condyle_math::Quat::from_axis_angle(axis, angle);
        let found = nearest_legal(&model, &asked.to_array()).unwrap();
        let found: [f64; 4] = found.try_into().unwrap();
        let found = condyle_math::Quat::from(found);
        // A swing about an axis perpendicular to the bone is cut to the cone's half angle; its boundary
        // of great arcs is a little inside the circle.
        let cut = found.angle_to(asked) - (angle.abs() - 0.5);
        assert!((0.0..1e-4).contains(&(cut + 1e-9)), "{cut}");
        let swung = (found.to_mat3() * -Vec3::Y).dot(-Vec3::Y).acos();
        assert!((0.4998..0.5 + 1e-7).contains(&swung), "{swung}");
    }
}
