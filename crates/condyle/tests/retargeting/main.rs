//! Motions between figures of our own: directions are those of the source, whatever rest postures, axes, sizes,
//! facing and names are. What is expected is computed from the places of joints alone.

mod figure;
mod limits;
mod overturned;
mod walking;

use condyle::formats::document::names;
use condyle::math::{Quat, Vec3};
use condyle::model::model::Facing;
use condyle::model::{CoordinateKind, UpAxis};
use condyle::retargeting::{
    Humanoid, Options, Part, Retargeted, Side, recognise, retarget, standing,
};
use condyle::{Mode, Model, Motion, Pose, Program, open, shipped};
use figure::{Arms, Figure, LIMBS};

fn carried(source: &Model, motion: &Motion, target: &Model, options: Options) -> Retargeted {
    let [from, to] = [source, target].map(|model| recognise(model, None).unwrap().body);
    let (source, target) =
        (Humanoid { model: source, body: &from }, Humanoid { model: target, body: &to });
    retarget(source, motion, target, options, &mut || {}).unwrap()
}

/// For each frame the places of all joints, and of the markers after them.
fn places(model: &Model, motion: &Motion) -> Vec<Vec<Vec3>> {
    let program = Program::compile(model);
    let mut pose = Pose::new(&program);
    let frames = motion.frames.iter().map(|frame| {
        program.evaluate(frame, Mode::Open, &mut pose).unwrap();
        let joints = model.segment_ids().map(|id| pose.segment(id).translation);
        let markers = model.markers().iter().map(|m| pose.frame(m.segment) * m.point);
        joints.chain(markers).collect()
    });
    frames.collect()
}

fn angle(a: Vec3, b: Vec3) -> f64 {
    a.cross(b).norm().atan2(a.dot(b)).to_degrees()
}

/// The largest angle between the limbs of two figures, each seen from its own forward, up and right.
fn limbs_apart(a: (&Figure, &[Vec<Vec3>]), b: (&Figure, &[Vec<Vec3>])) -> f64 {
    let [from, to] = [a.0, b.0].map(|figure| figure.world().transpose());
    let mut worst: f64 = 0.0;
    for (one, other) in a.1.iter().zip(b.1) {
        for (start, end) in LIMBS {
            let own = from * (one[end] - one[start]);
            worst = worst.max(angle(own, to * (other[end] - other[start])));
        }
    }
    worst
}

#[test]
fn limbs_point_where_those_of_the_source_do() {
    let source = Figure::default();
    let targets = [
        Figure { arms: Arms::A, ..source },
        Figure { arms: Arms::Hanging, odd_axes: true, ..source },
        Figure { facing: Facing::MinusZ, legs: 0.7, reach: 0.8, thigh: 0.05, ..source },
        Figure { facing: Facing::PlusX, odd_axes: true, mixamo: true, ..source },
        Figure { up: UpAxis::Z, facing: Facing::PlusX, arms: Arms::A, legs: 1.3, ..source },
        Figure { up: UpAxis::Z, facing: Facing::MinusZ, odd_axes: true, ..source },
    ];
    let model = source.model();
    let motion = source.motion(&model, 150);
    let own = places(&model, &motion);
    for target in targets {
        let other = target.model();
        let there = carried(&model, &motion, &other, Options::default()).motion;
        assert_eq!(there.times, motion.times);
        let theirs = places(&other, &there);
        // Feet that stand take a share: no foot stands in this motion, so only weights against each other do.
        let worst = limbs_apart((&source, &own), (&target, &theirs));
        assert!(worst < 1.0, "{target:?}: {worst} degrees");
        // And back.
        let back = carried(&other, &there, &model, Options::default()).motion;
        let again = limbs_apart((&source, &own), (&source, &places(&model, &back)));
        assert!(again < 1.5, "{target:?}, back: {again} degrees");
    }
}

/// All directions of all axes that may be up.
fn worlds() -> impl Iterator<Item = (UpAxis, Facing)> {
    let all = |up| Facing::ALL.into_iter().map(move |facing| (up, facing));
    all(UpAxis::Y).chain(all(UpAxis::Z))
}

/// The largest distance between two figures' joints, each seen from its own forward, up and right, its first frame's pelvis
/// above the origin.
fn joints_apart(a: (&Figure, &[Vec<Vec3>]), b: (&Figure, &[Vec<Vec3>])) -> f64 {
    let [from, to] = [a.0, b.0].map(|figure| figure.world().transpose());
    let pairs = a.1.concat().into_iter().zip(b.1.concat());
    pairs.map(|(p, q)| (from * p - to * q).norm()).fold(0.0, f64::max)
}

#[test]
fn a_figure_expressed_in_another_world_gives_and_takes_the_same_motion() {
    // The same body with the same motion, its world turned so that y or z is up and any axis ahead: what the target does
    // cannot depend on it, but for the rounding of a search that ends at 1e-6 of what is minimised.
    let source = Figure::default();
    let model = source.model();
    let motion = source.motion(&model, 60);
    let target = Figure { arms: Arms::A, legs: 0.9, facing: Facing::PlusX, ..source };
    let other = target.model();
    let expected = places(&other, &carried(&model, &motion, &other, Options::default()).motion);
    for (up, facing) in worlds() {
        let turned = Figure { up, facing, ..source };
        let turned_model = turned.model();
        assert_eq!((turned_model.up(), turned_model.facing()), (up, facing));
        let same = turned.motion(&turned_model, 60);
        let own = (places(&model, &motion), places(&turned_model, &same));
        assert!(joints_apart((&source, &own.0), (&turned, &own.1)) < 1e-12);
        let there = carried(&turned_model, &same, &other, Options::default()).motion;
        let found = places(&other, &there);
        let limbs = limbs_apart((&target, &expected), (&target, &found)).to_radians();
        let joints = joints_apart((&target, &expected), (&target, &found));
        assert!(limbs < 1e-6 && joints < 1e-6, "from {up:?} {facing:?}: {limbs}, {joints} m");
        // The other way round it is the target that is turned.
        let turned = Figure { up, facing, ..target };
        let turned_model = turned.model();
        let there = carried(&model, &motion, &turned_model, Options::default()).motion;
        let found = places(&turned_model, &there);
        let limbs = limbs_apart((&target, &expected), (&turned, &found)).to_radians();
        let joints = joints_apart((&target, &expected), (&turned, &found));
        assert!(limbs < 1e-6 && joints < 1e-6, "onto {up:?} {facing:?}: {limbs}, {joints} m");
    }
}

#[test]
fn a_figure_that_lies_at_rest_looks_where_its_model_says() {
    // How it stands is taken from its motion, in which it turns: only the model says which way its world is turned.
    for (up, facing) in worlds() {
        let source = Figure { up, facing, lying: true, ..Figure::default() };
        let model = source.model();
        let mut motion = source.motion(&model, 60);
        let id = model.find_coordinate("turn").unwrap();
        for (frame, time) in motion.frames.iter_mut().zip(&motion.times) {
            let turn = Quat::exp(source.world() * Vec3::new(0.0, 0.5 - time, 0.0));
            frame[model.stored_range(id)].copy_from_slice(&turn.to_array());
        }
        let target = Figure { facing: Facing::PlusX, ..Figure::default() };
        let other = target.model();
        let there = carried(&model, &motion, &other, Options::default());
        assert!(there.warnings.iter().any(|warning| warning.code == "retarget/rest"));
        let (own, theirs) = (places(&model, &motion), places(&other, &there.motion));
        let worst = limbs_apart((&source, &own), (&target, &theirs));
        assert!(worst < 1.0, "{up:?} {facing:?}: {worst} degrees");
    }
}

#[test]
fn palms_face_where_those_of_the_source_do() {
    // In a T palms face the ground, beside the body the thighs: arms that go down between the two turn
    // in the frontal plane, so the same posture has the same palms.
    let source = Figure::default();
    let model = source.model();
    let motion = source.motion(&model, 150);
    let own = places(&model, &motion);
    for arms in [Arms::A, Arms::Hanging] {
        let target = Figure { arms, odd_axes: true, ..source };
        let other = target.model();
        let there = carried(&model, &motion, &other, Options::default()).motion;
        for (one, other) in own.iter().zip(places(&other, &there)) {
            for (hand, palm) in [(8, 21), (12, 22)] {
                let off = angle(one[palm] - one[hand], other[palm] - other[hand]);
                assert!(off < 2.0, "{arms:?}: {off} degrees");
            }
        }
    }
}

#[test]
fn who_walks_forward_walks_forward_as_far_as_legs_are_long() {
    let source = Figure::default();
    let model = source.model();
    let mut motion = source.motion(&model, 100);
    let tz = model.find_coordinate("tz").unwrap();
    for (frame, time) in motion.frames.iter_mut().zip(&motion.times) {
        *model.value_mut(frame, tz) += 1.2 * time;
    }
    let target = Figure { facing: Facing::PlusX, legs: 0.5, ..source };
    let other = target.model();
    let there = carried(&model, &motion, &other, Options::default());
    // Both have thigh and shank of 0.84 m times what `legs` says.
    assert!((there.report.size - 0.5).abs() < 1e-9);
    let (own, theirs) = (places(&model, &motion), places(&other, &there.motion));
    let hips = |frame: &Vec<Vec3>| (frame[13] + frame[17]) * 0.5;
    let [a, b] = [&own, &theirs].map(|all| hips(&all[99]) - hips(&all[0]));
    // Forward is +z in the source and +x in the target; right -x and +z.
    assert!((b.x - 0.5 * a.z).abs() < 2e-3, "{b:?}");
    assert!((b.z + 0.5 * a.x).abs() < 2e-3, "{b:?}");
}

#[test]
fn the_tree_tells_where_no_names_do() {
    let source = Figure::default();
    let model = source.model();
    let motion = source.motion(&model, 60);
    // Its feet are as steep as those of some characters, and say all the same which way it looks.
    let target =
        Figure { unnamed: true, arms: Arms::A, facing: Facing::MinusZ, foot: 0.02, ..source };
    let other = target.model();
    let known = recognise(&other, None).unwrap();
    assert_eq!(known.table, None);
    assert_eq!(known.warnings.len(), 1);
    let forearm = known.body.get(Part::Forearm(Side::Left)).unwrap();
    assert_eq!(other.segment(forearm.segment).name, "node 7");
    let there = carried(&model, &motion, &other, Options::default()).motion;
    let (own, theirs) = (places(&model, &motion), places(&other, &there));
    let worst = limbs_apart((&source, &own), (&target, &theirs));
    assert!(worst < 1.0, "{worst} degrees");
}

#[test]
fn a_table_of_ones_own_is_used() {
    let model = Figure { unnamed: true, ..Figure::default() }.model();
    let mut rows = String::from("condyle = 1\nkind = \"names\"\n[names]\n");
    for (part, node) in [
        ("pelvis", 0),
        ("spine", 2),
        ("upper_arm_l", 6),
        ("forearm_l", 7),
        ("upper_arm_r", 10),
        ("forearm_r", 11),
        ("thigh_l", 13),
        ("thigh_r", 17),
    ] {
        rows += &format!("{part} = [\"node {node}\"]\n");
    }
    let table = names::read(&rows, &mut |_| Err(String::new())).unwrap().value;
    let known = recognise(&model, Some(&table)).unwrap();
    assert_eq!(known.table.as_deref(), Some("--names"));
    assert!(known.body.get(Part::Shank(Side::Left)).is_none());
    let chest = known.body.get(Part::Chest).unwrap();
    assert_eq!(model.segment(chest.segment).name, "node 2");
}

#[test]
fn figures_without_a_human_shape_are_refused() {
    let octopus = open::model("octopus".as_ref()).unwrap().value;
    let error = recognise(&octopus, None).unwrap_err();
    assert_eq!(error[0].code, "retarget/names");
}

/// A figure that stands, sways and slides one foot by 4 mm.
#[test]
fn feet_that_stand_slide_as_in_the_source_or_not_at_all() {
    let source = Figure::default();
    let model = source.model();
    let mut motion = source.motion(&model, 200);
    // Standing: only the root turns and moves, little, and knees bend.
    let still = model.defaults();
    let [tx, tz] = ["tx", "tz"].map(|name| model.find_coordinate(name).unwrap());
    for (frame, time) in motion.frames.iter_mut().zip(&motion.times) {
        frame.copy_from_slice(&still);
        *model.value_mut(frame, tx) += 0.002 * (2.0 * time).sin();
        *model.value_mut(frame, tz) += 0.004 * (1.5 * time).sin();
        for (number, id) in model.coordinate_ids().enumerate() {
            if model.coordinate(id).kind == CoordinateKind::Orientation
                && [13, 17].contains(&(number - 3))
            {
                // Right is -x where the figure faces +z.
                let bend = 0.02 * (3.0 * time).sin();
                let turn = condyle::math::Quat::exp(Vec3::new(bend, 0.0, 0.0));
                frame[model.stored_range(id)].copy_from_slice(&turn.to_array());
            }
        }
    }
    let target = Figure { legs: 0.8, thigh: 0.06, facing: Facing::PlusX, ..source };
    let other = target.model();
    let slid = |model: &Model, motion: &Motion| {
        let all = places(model, motion);
        let far = |joint: usize| {
            let away = all.iter().map(|frame| {
                let way = frame[joint] - all[0][joint];
                Vec3::new(way.x, 0.0, way.z).norm()
            });
            away.fold(0.0, f64::max)
        };
        far(15).max(far(19))
    };
    let own = slid(&model, &motion);
    let free = carried(&model, &motion, &other, Options::default());
    assert!(free.report.sliding.stands > 0);
    assert!(slid(&other, &free.motion) < own + 0.005);
    let pinned = carried(&model, &motion, &other, Options { pin_feet: true, ..Options::default() });
    let left = slid(&other, &pinned.motion);
    assert!(own > 0.005 && left < 0.001, "{own} {left}");
}

#[test]
fn a_foot_stands_while_it_is_low_and_slow() {
    // 0.2 m/s is too fast, 4 cm too high, five hundredths of a second too short.
    let times: Vec<f64> = (0..300).map(|frame| f64::from(frame) * 0.01).collect();
    let place = |t: f64| match t {
        t if t < 0.5 => Vec3::new(0.0, 0.05, 0.0),
        t if t < 1.0 => Vec3::new(0.2 * (t - 0.5), 0.05, 0.0),
        t if t < 2.0 => Vec3::new(0.1, 0.09, 0.0),
        t if t < 2.045 => Vec3::new(0.1, 0.05, 0.0),
        _ => Vec3::new(0.1, 0.20, 0.0),
    };
    let points: Vec<Vec3> = times.iter().map(|t| place(*t)).collect();
    let stands = standing(&points, &times, Vec3::Y);
    assert_eq!(stands.len(), 1, "{stands:?}");
    assert!(stands[0].start == 0 && (47..=51).contains(&stands[0].end));
}

#[test]
fn every_row_of_a_shipped_table_is_a_part() {
    for (name, text) in shipped::skeletons() {
        let table = names::read(text, &mut |_| Err(String::new())).unwrap().value;
        assert!(table.len() >= 15, "{name}");
        for (part, _) in table {
            assert!(part == "spine" || Part::named(&part).is_some(), "{name}: {part}");
        }
    }
}

#[test]
fn the_whole_man_is_recognised_and_stands_as_he_does() {
    let human = open::model("human".as_ref()).unwrap().value;
    let motion = Motion { times: vec![0.0], frames: vec![human.defaults()] };
    let carried = carried(&human, &motion, &human, Options::default());
    let (a, b) = (places(&human, &motion), places(&human, &carried.motion));
    let hip = human.find_segment("femur_r").unwrap().index();
    let wrist = human.find_segment("hand_r").unwrap().index();
    assert!((a[0][hip] - b[0][hip]).norm() < 1e-3);
    assert!((a[0][wrist] - b[0][wrist]).norm() < 5e-3);
}

#[test]
fn a_neck_of_several_bones_bends_no_more_than_head_and_neck_turn() {
    let human = open::model("human".as_ref()).unwrap().value;
    let figure = Figure::default();
    let source = figure.model();
    let motion = figure.motion(&source, 120);
    let carried = carried(&source, &motion, &human, Options::default()).motion;
    // Neck and head of the figure turn by at most |(0.1, 0.1, 0.15)| = 0.206 rad each about one axis; that the man bends
    // more would be a neck that goes one way and a head that comes back.
    let most = 2.0 * 0.206f64.to_degrees() + 3.0;
    for joint in ["cervical", "head"] {
        for turn in ["flexion", "bending", "rotation"] {
            let id = human.find_coordinate(&format!("{joint}_{turn}")).unwrap();
            let at = human.stored_range(id).start;
            for (frame, stored) in carried.frames.iter().enumerate() {
                let found = stored[at].to_degrees();
                assert!(found.abs() < most, "{joint}_{turn} in frame {frame}: {found}");
            }
        }
    }
}
