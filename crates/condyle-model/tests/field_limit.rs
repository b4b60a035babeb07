//! Learned limits in models, with fields whose distances are known: all turns by up to 40 degrees.

use condyle_math::{Affine, Quat, Vec3};
use condyle_model::component::{FieldLimit, Reflection, RelativeOrientation};
use condyle_model::limit::field::{
    About, Boundary, Chart, Field, Grid, Ground, Learned, LearnedLimit, Settings, State,
};
use condyle_model::limit::{Limit, field::Lattice};
use condyle_model::{Jacobian, Law, Mode, Model, ModelBuilder, Pose, Program, SegmentId};
use std::sync::Arc;

const HALF: f64 = 40.0 * std::f64::consts::PI / 180.0;

/// A number in -1..1 for each index.
fn draw(index: u32) -> f64 {
    ((f64::from(index) * 12.9898).sin() * 43758.5453).fract()
}

fn rotation(seed: u32) -> Quat {
    Quat::exp(Vec3::from([0, 1, 2].map(|i| 1.8 * draw(3 * seed + i))))
}

/// The distance at each node by a formula: to a ball of 40 degrees about the identity; with a hole of 10 about
/// the identity in what is valid.
fn ball(ground: &Arc<Ground>) -> Field {
    let lattice = Lattice::new(96);
    let nodes = lattice.nodes();
    let angle = |q: &Option<Quat>| q.map_or(f64::NAN, |q| q.angle_to(Quat::IDENTITY));
    let outer: Vec<f32> = nodes.iter().map(|q| (HALF - angle(q)) as f32).collect();
    let hole = 10f64.to_radians();
    let carved = nodes.iter().map(|q| (HALF - angle(q)).min(angle(q) - hole) as f32).collect();
    let near = vec![0; nodes.len()];
    let learned = Learned {
        spacing: 0.1,
        radius: 0.5,
        gap: 0.0,
        extreme: 1.0,
        surface: 1.0,
        outer: 0.02,
        valid: 0.02,
        holes: vec![],
    };
    let boundary = Boundary::default();
    let (carved, counts) = (Some(carved), vec![1]);
    let grid = Grid { lattice, outer, carved, near, counts, boundary, learned };
    Field::new(ground.clone(), grid)
}

fn limit() -> FieldLimit {
    let ground = Ground {
        samples: vec![Quat::exp(Vec3::X * 0.4)],
        takes: vec![1],
        thinned: 0.0,
        chart: Chart::new(Quat::IDENTITY, Quat::IDENTITY),
        settings: Settings::default(),
        known: None,
        shape: None,
    };
    FieldLimit::new(Arc::new(LearnedLimit::new(About::default(), Arc::new(ground), None, ball)))
}

/// A limit whose axes are not those of the segments, of the other side.
fn turned() -> FieldLimit {
    FieldLimit {
        in_reference: rotation(100),
        in_segment: rotation(101),
        mirrored: Reflection::new(2),
        ..limit()
    }
}

fn turn(numbers: &[f64]) -> Quat {
    Quat { x: numbers[0], y: numbers[1], z: numbers[2], w: numbers[3] }
}

fn numbers(q: Quat) -> [f64; 4] {
    q.to_array()
}

#[test]
fn the_nearest_is_that_of_the_ball_and_stays() {
    let law = limit();
    for seed in 0..300 {
        let asked = rotation(seed);
        let angle = asked.angle_to(Quat::IDENTITY);
        let Some(legal) = law.legal(&numbers(asked)) else {
            assert!(angle < HALF + 0.01, "{angle}");
            continue;
        };
        let found = turn(&legal);
        // The nearest of a ball is on the way to its middle. The spline of nodes 3.7° apart is off by a few
        // hundredths of a degree.
        assert!((found.angle_to(Quat::IDENTITY) - HALF).abs() < 2e-3);
        assert!((found.angle_to(asked) - (angle - HALF)).abs() < 2e-3);
        assert!((law.beyond(&numbers(asked)) - (angle - HALF)).abs() < 5e-3);
        assert!(found.dot(asked) > 0.0);
        assert_eq!(law.legal(&legal), None);
        let other = law.legal(&numbers(-asked)).map(|q| turn(&q)).unwrap();
        assert!(other.angle_to(found) < 1e-12 && other.dot(-asked) > 0.0);
    }
    // Opposite the middle the nearest jumps; near the ball it does not.
    assert!(law.margin(&numbers(Quat::exp(Vec3::Z * 3.12))) < 0.15);
    assert_eq!(law.margin(&numbers(Quat::exp(Vec3::Z * 0.9))), f64::INFINITY);
    assert_eq!(law.margin(&numbers(Quat::exp(Vec3::Z * 0.3))), f64::INFINITY);
}

#[test]
fn a_hole_is_allowed_unless_it_is_closed() {
    let open = limit();
    let closed = FieldLimit { strict: true, ..limit() };
    let middle = numbers(Quat::exp(Vec3::Y * 5f64.to_radians()));
    assert_eq!(open.state(&middle), State::Unknown);
    assert_eq!(open.legal(&middle), None);
    assert!((open.rows_at(&middle)[0].0 - 35f64.to_radians()).abs() < 0.02);
    // 5 degrees to the rim of a hole of 10; rounded where nodes are 3.7° apart.
    assert!((closed.beyond(&middle).to_degrees() - 5.0).abs() < 0.5);
    let legal = turn(&closed.legal(&middle).unwrap());
    assert!((legal.angle_to(Quat::IDENTITY).to_degrees() - 10.0).abs() < 0.5);
}

#[test]
fn axes_and_sides_are_what_they_say() {
    let law = turned();
    let at = law.mirrored.unwrap();
    // The middle of the ball is where the limit's own axes agree, on the other side the mirror image.
    let middle = law.in_reference.to_mat3() * law.in_segment.to_mat3().transpose();
    let middle = at.frame(Affine::from_rotation(middle)).linear;
    let middle = Quat::from_mat3(middle);
    assert!(law.inward(middle).angle_to(Quat::IDENTITY) < 1e-7);
    for seed in 0..100 {
        let q = rotation(seed);
        assert!(law.outward(law.inward(q)).angle_to(q) < 1e-12);
        // Mirroring D·R·D keeps angles.
        let far = q.angle_to(middle);
        assert!((law.inward(q).angle_to(Quat::IDENTITY) - far).abs() < 1e-12);
        if let Some(legal) = law.legal(&numbers(q)) {
            assert!((turn(&legal).angle_to(middle) - HALF).abs() < 2e-3);
            assert_eq!(law.legal(&legal), None);
        }
    }
}

#[test]
fn slopes_are_those_of_differences() {
    let step = 1e-5;
    for law in [limit(), turned(), FieldLimit { strict: true, ..turned() }] {
        for seed in 0..200 {
            let q = rotation(seed);
            let (_, slopes) = law.rows_at(&numbers(q))[0];
            for (axis, slope) in Vec3::UNITS.into_iter().zip(slopes) {
                let at =
                    |sign: f64| law.rows_at(&numbers(q * Quat::exp(axis * (sign * step))))[0].0;
                let difference = (at(1.0) - at(-1.0)) / (2.0 * step);
                assert!((slope - difference).abs() < 1e-6, "{slope} {difference}");
            }
        }
    }
}

/// A humerus on a scapula on a clavicle, each a ball, limited in the thorax; frames turned anyhow.
fn shoulder(law: FieldLimit) -> (Model, [SegmentId; 4]) {
    let mut b = ModelBuilder::new("shoulder");
    let mut parent = None;
    let segments = ["thorax", "clavicle", "scapula", "humerus"].map(|name| {
        let segment = b.segment(name, parent);
        let seed = 10 * name.len() as u32;
        let frame =
            |k| Affine::new(rotation(seed + k).to_mat3(), Vec3::new(0.1, draw(k), 0.0) * 0.2);
        b.place_joint_frames(segment, frame(0), frame(1));
        b.ball_joint(name, segment);
        parent = Some(segment);
        segment
    });
    let set = b.joint_set("limits");
    let measure = Law::RelativeOrientation(RelativeOrientation { reference: true });
    let ends = vec![segments[3].into(), segments[0].into()];
    let measured = b.component(set, "measured", measure, ends);
    b.component(set, "held", Law::Field(law), vec![measured]);
    (b.build().unwrap(), segments)
}

fn posture(model: &Model, seed: u32) -> Vec<f64> {
    let mut stored = model.defaults();
    for (k, q) in stored.chunks_mut(4).enumerate() {
        q.copy_from_slice(&rotation(17 * seed + k as u32).to_array());
    }
    stored
}

#[test]
fn through_other_segments_a_row_has_its_slope_and_moves_nothing() {
    let law = turned();
    let (model, segments) = shoulder(law.clone());
    let program = Program::compile(&model);
    let (mut pose, mut jacobian) = (Pose::new(&program), Jacobian::new(&program));
    let mut posed = Pose::new(&program);
    assert_eq!(program.measured_limit_rows(), [0]);
    let step = 1e-5;
    for seed in 0..40 {
        let stored = posture(&model, seed);
        program.evaluate_with_jacobian(&stored, &mut pose, &mut jacobian).unwrap();
        let [thorax, .., humerus] = segments.map(|id| pose.segment(id).linear);
        let own = Quat::from_mat3(thorax.transpose() * humerus);
        let expected = law.rows_at(&numbers(own))[0].0;
        assert!((pose.limit_row(0) - expected).abs() < 1e-12);
        program.evaluate(&stored, Mode::Posed, &mut posed).unwrap();
        for id in segments {
            assert_eq!(posed.segment(id), pose.segment(id));
        }
        for direction in 0..program.tangent_len() {
            let at = |sign: f64| {
                let mut moved = stored.clone();
                let (joint, axis) = (direction / 3, direction % 3);
                let q: [f64; 4] = moved[4 * joint..4 * joint + 4].try_into().unwrap();
                let q = Quat::from(q) * Quat::exp(Vec3::UNITS[axis] * (sign * step));
                moved[4 * joint..4 * joint + 4].copy_from_slice(&q.to_array());
                let mut pose = Pose::new(&program);
                program.evaluate(&moved, Mode::Open, &mut pose).unwrap();
                pose.limit_row(0)
            };
            let exact: f64 = program
                .limit_row_directions(0)
                .iter()
                .filter(|(d, _)| *d as usize == direction)
                .map(|(_, slot)| jacobian.derivative(*slot))
                .sum();
            let difference = (at(1.0) - at(-1.0)) / (2.0 * step);
            assert!((exact - difference).abs() < 1e-6, "{direction}: {exact} {difference}");
        }
    }
}

#[test]
fn a_ball_joint_is_posed_at_the_nearest_and_legal_poses_are_the_same_in_both_modes() {
    let mut b = ModelBuilder::new("hip");
    let femur = b.segment("femur", None);
    let set = b.joint_set("hip");
    let orientation = b.coordinate(set, "hip", condyle_model::CoordinateKind::Orientation);
    let held = b.component(set, "held", Law::Field(limit()), vec![orientation.into()]);
    let turn = b.component(set, "turn", Law::Ball(condyle_model::component::Ball), vec![held]);
    b.output(set, femur, turn);
    let model = b.build().unwrap();
    let program = Program::compile(&model);
    let (mut posed, mut open) = (Pose::new(&program), Pose::new(&program));
    assert!(program.measured_limit_rows().is_empty());
    let mut moved = 0;
    for seed in 0..100 {
        let asked = rotation(seed);
        program.evaluate(&numbers(asked), Mode::Posed, &mut posed).unwrap();
        program.evaluate(&numbers(asked), Mode::Open, &mut open).unwrap();
        let effective: [f64; 4] = posed.effective()[..4].try_into().unwrap();
        let effective = Quat::from(effective);
        if open.limit_row(0) >= 0.0 {
            assert!(posed.segment(femur).linear == open.segment(femur).linear);
        } else {
            moved += 1;
            assert!((effective.angle_to(Quat::IDENTITY) - HALF).abs() < 2e-3);
        }
        let shown = Quat::from_mat3(posed.segment(femur).linear);
        assert!(shown.angle_to(effective) < 1e-7);
        // What is effective is legal, and posing it again changes nothing.
        program.evaluate(&numbers(effective), Mode::Open, &mut open).unwrap();
        assert!(open.limit_row(0) > -1e-9);
        program.evaluate(&numbers(effective), Mode::Posed, &mut posed).unwrap();
        let again: [f64; 4] = posed.effective()[..4].try_into().unwrap();
        assert!(Quat::from(again).angle_to(effective) < 1e-12);
    }
    assert!(moved > 50);
}
