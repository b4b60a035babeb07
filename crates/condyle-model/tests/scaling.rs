//! Scaled models, including random trees.

#[allow(dead_code, reason = "the tests of the random models use more of it")]
#[path = "random_models/grow.rs"]
mod grow;

use condyle_math::function::{Function, FunctionOfSeveral};
use condyle_math::{Affine, Mat3, Vec3};
use condyle_model::component::{Component, Law, Signal};
use condyle_model::model::Condition;
use condyle_model::{
    Closure, CoordinateKind, Mode, Model, ModelBuilder, Pose, Program, Range, SegmentId,
};

fn pose(model: &Model, stored: &[f64]) -> Vec<Affine> {
    let program = Program::compile(model);
    let mut pose = Pose::new(&program);
    program.evaluate(stored, Mode::Open, &mut pose).expect("numbers of this model");
    model.segment_ids().map(|id| pose.segment(id)).collect()
}

fn root(model: &Model, id: SegmentId) -> SegmentId {
    let mut here = id;
    while let Some(parent) = model.segment(here).parent {
        here = parent;
    }
    here
}

/// Whether all lengths that move a bone are values of functions: distances that are coordinates
/// belong to the caller, and the meaning of the numbers of a user's law is unknown.
fn grows_whole(model: &Model) -> bool {
    model.components().iter().all(|component| match component.law {
        // What a measured length drives, an angle for example, changes with it.
        Law::Custom(_) | Law::RelativePosition(_) => false,
        Law::Translate(_) => match component.inputs[0] {
            Signal::Output(id, _) => {
                matches!(
                    model.components()[id.index()].law,
                    Law::Map(_) | Law::Combine(_) | Law::Correlate(_)
                )
            }
            _ => false,
        },
        _ => true,
    })
}

/// Whether a transform moves segments of which one hangs in the world: it then grows or not.
fn shared_with_the_world(model: &Model) -> bool {
    let readers: Vec<Vec<Signal>> =
        model.components().iter().map(|c: &Component| c.values().collect()).collect();
    let reach = |start: Signal| {
        let (mut open, mut met) = (vec![start], vec![]);
        while let Some(source) = open.pop() {
            if let Signal::Output(id, _) = source
                && !met.contains(&id.index())
            {
                met.push(id.index());
                open.extend(&readers[id.index()]);
            }
            if let Signal::Coordinate(id) = source {
                open.extend(model.coordinate(id).follows);
            }
        }
        met
    };
    let of = |hangs: bool| -> Vec<usize> {
        let those = model.segments().iter().filter(|s| s.parent.is_none() == hangs);
        those.filter_map(|s| s.motion).flat_map(reach).collect()
    };
    let world = of(true);
    of(false).iter().any(|c| world.contains(c))
}

#[test]
fn one_factor_for_all_multiplies_every_place_and_turns_nothing() {
    let (mut trees, mut segments) = (0, 0);
    for seed in 0..4000 {
        let (model, stored) = grow::random_model(seed);
        assert_eq!(model.scaled(&vec![1.0; model.segments().len()]), model, "seed {seed}");
        if !grows_whole(&model) || shared_with_the_world(&model) {
            continue;
        }
        let k = 1.3;
        let (before, after) =
            (pose(&model, &stored), pose(&model.scaled(&vec![k; model.segments().len()]), &stored));
        for id in model.segment_ids() {
            let from = root(&model, id);
            let seen = |all: &[Affine]| {
                let back = all[from.index()];
                let linear = back.linear.inverse();
                let own = all[id.index()];
                (linear * own.linear, linear * (own.translation - back.translation))
            };
            let ((turn, place), (turn_after, place_after)) = (seen(&before), seen(&after));
            let size = 1.0 + place.norm();
            assert!((place_after - place * k).norm() < 1e-9 * size, "seed {seed} {id:?}");
            assert!(off(turn, turn_after) < 1e-9, "seed {seed} {id:?}");
            segments += usize::from(from != id);
        }
        trees += 1;
    }
    assert!(trees > 300 && segments > 300, "{trees} trees, {segments} segments below a root");
}

fn off(a: Mat3, b: Mat3) -> f64 {
    [a.x - b.x, a.y - b.y, a.z - b.z].map(Vec3::norm).into_iter().fold(0.0, f64::max)
}

/// A knee that slides by a function, with a kneecap that slides by a coordinate.
fn leg() -> ModelBuilder {
    let mut b = ModelBuilder::new("leg");
    let pelvis = b.segment("pelvis", None);
    let thigh = b.segment("thigh", Some(pelvis));
    let shank = b.segment("shank", Some(thigh));
    let patella = b.segment("patella", Some(thigh));
    b.place_joint(thigh, Vec3::new(0.0, -0.06, 0.08));
    let (at, own) = (Vec3::new(0.0, -0.4, 0.0), Vec3::new(0.0, 0.02, 0.0));
    b.place_joint_frames(shank, Affine::from_translation(at), Affine::from_translation(own));
    let room = b.joint_set("room");
    let height = b.coordinate(room, "height", CoordinateKind::Translation);
    b.coordinate_mut(height).default[0] = 0.9;
    let lift = b.translate(room, "lift", height, Vec3::Y);
    b.output(room, pelvis, lift);
    let knee = b.joint_set("knee");
    let angle = b.coordinate(knee, "angle", CoordinateKind::Rotation);
    // Half of the angle, as a distance and as an angle.
    let half = b.map(knee, "half", angle, Function::linear(0.5, 0.1));
    let slide = b.translate(knee, "slide", half, Vec3::X);
    let turn = b.rotate(knee, "turn", half, Vec3::Z);
    let motion = b.product(knee, "motion", vec![slide, turn]);
    b.output(knee, shank, motion);
    let kneecap = b.joint_set("kneecap");
    let glide = b.coordinate(kneecap, "glide", CoordinateKind::Translation);
    b.coordinate_mut(glide).default[0] = 0.04;
    b.coordinate_mut(glide).range = Range::new(-0.05, 0.06);
    let up = b.translate(kneecap, "up", glide, Vec3::Y);
    b.output(kneecap, patella, up);
    b.marker("ankle", Some(shank), Vec3::new(0.0, -0.4, 0.03));
    b.marker("wall", None, Vec3::new(1.0, 1.0, 1.0));
    let ends =
        [(Some(thigh), Vec3::new(0.05, -0.3, 0.0)), (Some(shank), Vec3::new(0.04, 0.0, 0.0))];
    let condition = Condition::Distance { at: ends, distance: 0.07 };
    b.closure(Closure { name: "ligament".to_owned(), condition });
    b
}

#[test]
fn each_length_grows_with_the_bone_that_it_is_fixed_in() {
    let model = leg().build().expect("a leg");
    let [pelvis, thigh, shank, patella] = [1.5, 1.2, 0.8, 3.0];
    let scaled = model.scaled(&[pelvis, thigh, shank, patella]);
    let (height, angle, glide) = (0.95, 0.7, 0.03);
    let found = pose(&scaled, &[height, angle, glide]);
    // The position of the pelvis is in the world and not scaled; that of the hip is in the pelvis.
    let hip = Vec3::new(0.0, height - 0.06 * pelvis, 0.08 * pelvis);
    let near = |a: Vec3, b: Vec3| assert!((a - b).norm() < 1e-15, "{a:?} {b:?}");
    near(found[0].translation, Vec3::new(0.0, height, 0.0));
    near(found[1].translation, hip);
    // The translation is in the thigh and scaled; the angle by the same function is unchanged.
    let half: f64 = 0.5 * angle + 0.1;
    let knee = hip + Vec3::new(half, -0.4, 0.0) * thigh;
    let own = Vec3::new(-half.sin(), half.cos(), 0.0) * (0.02 * shank);
    near(found[2].translation, knee - own);
    assert!(off(found[2].linear, Mat3::rotation_z(half)) < 1e-15);
    near(found[3].translation, hip + Vec3::new(0.0, glide, 0.0));
    let of = |name: &str| {
        let id = scaled.find_coordinate(name).expect(name);
        scaled.coordinate(id).clone()
    };
    assert_eq!(of("height").default[0], 0.9);
    assert_eq!(of("glide").default[0], 0.04 * thigh);
    assert_eq!(of("glide").range, Range::new(-0.05 * thigh, 0.06 * thigh));
    near(scaled.markers()[0].point, Vec3::new(0.0, -0.4, 0.03) * shank);
    near(scaled.markers()[1].point, Vec3::new(1.0, 1.0, 1.0));
    let Condition::Distance { at, distance } = &scaled.closures()[0].condition else {
        panic!("it was a distance")
    };
    near(at[0].1, Vec3::new(0.05, -0.3, 0.0) * thigh);
    near(at[1].1, Vec3::new(0.04, 0.0, 0.0) * shank);
    assert!((distance - 0.07 * (thigh * shank).sqrt()).abs() < 1e-15);
}

#[test]
fn factors_that_are_no_sizes_change_nothing() {
    let model = leg().build().expect("a leg");
    assert_eq!(model.scaled(&[f64::NAN, 0.0, -1.0, f64::INFINITY]), model);
    assert_eq!(model.scaled(&[]), model);
}

#[test]
fn a_law_of_a_distance_holds_at_the_larger_one() {
    // y = 0.3·x + 0.02 between two lengths: at 1.5·x it is 1.5·y.
    let mut b = ModelBuilder::new("shoulder");
    let thorax = b.segment("thorax", None);
    let scapula = b.segment("scapula", Some(thorax));
    let set = b.joint_set("glide");
    let x = b.coordinate(set, "x", CoordinateKind::Translation);
    let along = b.translate(set, "along", x, Vec3::X);
    let y = b.map(set, "y", x, Function::linear(0.3, 0.02));
    let off = b.translate(set, "off", y, Vec3::Y);
    let function = FunctionOfSeveral::Linear { slopes: vec![0.5], intercept: -0.01 };
    let z = b.combine(set, "z", vec![x.into()], function);
    let out = b.translate(set, "out", z, Vec3::Z);
    let motion = b.product(set, "motion", vec![along, off, out]);
    b.output(set, scapula, motion);
    let model = b.build().expect("a shoulder");
    let (before, after) = (pose(&model, &[0.1]), pose(&model.scaled(&[1.5, 1.0]), &[0.15]));
    assert!((before[1].translation - Vec3::new(0.1, 0.05, 0.04)).norm() < 1e-15);
    assert!((after[1].translation - before[1].translation * 1.5).norm() < 1e-15);
}

#[test]
fn a_segment_is_in_one_size_group() {
    let mut b = leg();
    let of = |b: &ModelBuilder, i| b.segment_at(i).expect("a segment");
    let (thigh, shank) = (of(&b, 1), of(&b, 2));
    b.size_group("thigh", vec![thigh, shank]);
    let model = b.clone().build().expect("one group");
    assert_eq!(model.size_groups()[0].segments, [thigh, shank]);
    b.size_group("shank", vec![shank]);
    b.size_group("thigh", vec![]);
    let said: Vec<String> = b.build().expect_err("two").iter().map(|f| f.message.clone()).collect();
    let expected = [
        "segment `shank` is in size group `thigh` and in `shank`",
        "two size groups are named `thigh`",
    ];
    assert_eq!(said, expected);
}
