//! The centre's path on figures whose frames are rolled and ordered at random. What is expected follows from the formulas of the paper
//! in landmark axes, never from the code under test.

use super::*;
use condyle_math::Quat;
use condyle_math::function::FunctionOfSeveral;
use condyle_model::{CoordinateKind, Mode, Model, ModelBuilder, Pose, Program};

/// Numbers from -1 to 1 that are the same in every run (a linear congruence of Knuth's MMIX).
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (self.0 >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }

    fn vector(&mut self, size: f64) -> Vec3 {
        Vec3::new(self.next(), self.next(), self.next()) * size
    }

    fn rotation(&mut self) -> Mat3 {
        let q = Quat { x: self.next(), y: self.next(), z: self.next(), w: self.next() };
        q.normalized().to_mat3()
    }

    fn frame(&mut self) -> Affine {
        Affine::new(self.rotation(), self.vector(0.3))
    }
}

const ORDER: &str = "zxy";
/// Rows x, y, z of coefficients of flexion, adduction, rotation, the hip's flexion, and the constant: of the size of Table 1 of the paper.
const LAW: [[f64; 5]; 3] = [
    [-0.035, 0.005, -0.012, 0.004, 0.048],
    [-0.044, 0.009, 0.021, -0.003, -0.503],
    [0.007, -0.024, 0.015, 0.002, -0.052],
];

fn laws() -> Vec<LawFunction> {
    let one =
        |row: &[f64; 5]| FunctionOfSeveral::Linear { slopes: row[..4].to_vec(), intercept: row[4] };
    LAW.iter().map(|row| LawFunction::Several(one(row))).collect()
}

fn value(row: &[f64; 5], at: [f64; 4]) -> f64 {
    row.iter().zip(at).map(|(c, x)| c * x).sum::<f64>() + row[4]
}

fn law_frame(left: bool) -> LawFrame {
    let side = if left { -1.0 } else { 1.0 };
    LawFrame {
        landmarks: Landmarks {
            origin: Vec3::ZERO,
            medial: Vec3::new(0.0, -0.41, -0.05 * side),
            lateral: Vec3::new(0.0, -0.41, 0.05 * side),
            left,
        },
        order: ORDER.parse().unwrap(),
        angles: ["flexion", "adduction", "rotation"].map(str::to_owned),
        centre: ["tx", "ty", "tz"].map(|name| Along::Follows(name.to_owned())),
    }
}

/// A thigh with a shank, all of whose frames are random: `canonical` is the frame of its landmarks in the thigh.
struct Figure {
    model: Model,
    canonical: Affine,
    asked: TargetJoint,
}

/// How the joint turns.
#[derive(Clone, Copy, PartialEq)]
enum Joint {
    Quaternion,
    Angles(EulerOrder),
}

fn figure(random: &mut Random, joint: Joint, left: bool, [height, width]: [f64; 2]) -> Figure {
    let mut b = ModelBuilder::new("figure");
    let pelvis = b.segment("pelvis", None);
    let thigh = b.segment("thigh", Some(pelvis));
    let frames = [random.frame(), random.frame()];
    b.place_joint_frames(thigh, frames[0], frames[1]);
    b.hinge("hip", thigh, "hip_flexion", random.vector(1.0));
    let shank = b.segment("shank", Some(thigh));
    let frames = [random.frame(), random.frame()];
    b.place_joint_frames(shank, frames[0], frames[1]);
    let set = b.joint_set("knee");
    let mut parts = vec![];
    match joint {
        Joint::Quaternion => {
            let q = b.coordinate(set, "q", CoordinateKind::Orientation);
            parts.push(b.ball(set, "ball", q));
        }
        Joint::Angles(order) => {
            // A slide that the law replaces.
            let slide = b.coordinate(set, "slide", CoordinateKind::Translation);
            parts.push(b.translate(set, "slides", slide, Vec3::X));
            for (name, axis) in ["a", "b", "c"].into_iter().zip(order.axes()) {
                let angle = b.coordinate(set, name, CoordinateKind::Rotation);
                parts.push(b.rotate(set, &format!("turn_{name}"), angle, Vec3::UNITS[axis]));
            }
        }
    }
    let motion = b.product(set, "motion", parts);
    b.output(set, shank, motion);
    let canonical = random.frame();
    let side = if left { -1.0 } else { 1.0 };
    b.marker("GT", Some(thigh), canonical.translation);
    let places = [
        LandmarkPlace::Named("GT".to_owned()),
        LandmarkPlace::InParent(canonical * Vec3::new(0.0, -height, -0.5 * width * side)),
        LandmarkPlace::InParent(canonical * Vec3::new(0.0, -height, 0.5 * width * side)),
    ];
    let asked = TargetJoint {
        joint: "shank".to_owned(),
        places,
        left,
        zero: vec![],
        drivers: vec![("hip_of_the_law".to_owned(), "hip_flexion".to_owned())],
        holds: false,
    };
    Figure { model: b.build().unwrap(), canonical, asked }
}

/// The joint's numbers that give the child an orientation in its parent.
fn joint_values(model: &Model, joint: Joint, child_in_parent: Mat3) -> Vec<(String, Vec<f64>)> {
    let shank = model.segment(model.find_segment("shank").unwrap());
    let turn =
        shank.joint_in_parent.linear.transpose() * child_in_parent * shank.joint_in_segment.linear;
    match joint {
        Joint::Quaternion => vec![("q".to_owned(), Quat::from_mat3(turn).to_array().to_vec())],
        Joint::Angles(order) => {
            let angles = order.from_mat3(turn);
            ["a", "b", "c"].into_iter().zip(angles).map(|(n, x)| (n.to_owned(), vec![x])).collect()
        }
    }
}

fn check(joint: Joint, law_left: bool, left: bool, rule: ScaleRule, seed: u64) {
    let mut random = Random(seed);
    let size = [0.45 + 0.1 * random.next(), 0.1 + 0.03 * random.next()];
    let mut figure = figure(&mut random, joint, left, size);
    let at = figure.asked.find(&figure.model).unwrap();
    let frame = law_frame(law_left);
    let functions = laws();
    let names = ["knee_r_tx", "knee_r_ty", "knee_r_tz"];
    let laws: Vec<(&str, &LawFunction)> = names.into_iter().zip(&functions).collect();
    let controls = ["knee_r_flexion", "knee_r_adduction", "knee_r_rotation", "hip_of_the_law"]
        .map(str::to_owned);
    let joint_laws = JointLaws { controls: &controls, laws: &laws, region: None, frame: &frame };
    let asked = figure.asked.clone();
    let elsewhere = |name: &str| asked.driver(name);
    let transfer = Transfer::new(&joint_laws, at.landmarks, at.at_zero, rule, &elsewhere).unwrap();
    let changed = transfer.onto(&figure.model, &at).unwrap();
    // Equation 3 and the ratio of each axis, from the sizes of both.
    let [own, other] = [[0.41, 0.1], size];
    let along = |[h, w]: [f64; 2]| (h * h + 0.25 * w * w).sqrt();
    let (s1, s2) = (along(other) / along(own), other[1] / own[1]);
    let mean = 0.5 * (s1 + s2);
    let factors = match rule {
        ScaleRule::Mean => [mean; 3],
        ScaleRule::PerAxis => [mean, s1, s2],
    };
    let mirror = if law_left == left { 1.0 } else { -1.0 };
    let order: EulerOrder = ORDER.parse().unwrap();
    let (program, shank) = (Program::compile(&changed), changed.find_segment("shank").unwrap());
    let mut pose = Pose::new(&program);
    let thigh = changed.find_segment("thigh").unwrap();
    let joint_in_shank = figure.model.segment(at.segment).joint_in_segment.translation;
    figure.model.set_name("before");
    for _ in 0..100 {
        let angles = [1.4 * random.next(), 0.5 * random.next(), 0.6 * random.next()];
        let hip = random.next();
        let mut turn = order.to_mat3(angles);
        if mirror < 0.0 {
            let m = Mat3::from_columns(Vec3::X, Vec3::Y, -Vec3::Z);
            turn = m * turn * m;
        }
        let canonical = figure.canonical.linear;
        let child = canonical * turn * canonical.transpose() * at.at_zero;
        let mut stored = changed.defaults();
        for (name, values) in joint_values(&figure.model, joint, child) {
            let id = changed.find_coordinate(&name).unwrap();
            stored[changed.stored_range(id)].copy_from_slice(&values);
        }
        *changed.value_mut(&mut stored, changed.find_coordinate("hip_flexion").unwrap()) = hip;
        program.evaluate(&stored, Mode::Open, &mut pose).unwrap();
        let [flexion, adduction, rotation] = angles;
        let all = [flexion, adduction, rotation, hip];
        let mut expected = [0, 1, 2].map(|k: usize| factors[k] * value(&LAW[k], all));
        expected[2] *= mirror;
        let in_thigh = pose.segment(thigh).rigid_inverse() * pose.segment(shank);
        let centre = figure.canonical.rigid_inverse() * (in_thigh * joint_in_shank);
        assert!((centre - Vec3::from(expected)).norm() < 1e-12, "{centre:?} {expected:?}");
        // The child is turned as it was before.
        assert!((in_thigh.linear * Vec3::X - child * Vec3::X).norm() < 1e-12);
        assert!((in_thigh.linear * Vec3::Y - child * Vec3::Y).norm() < 1e-12);
    }
}

#[test]
fn the_centre_travels_by_the_law_whatever_the_frames_are() {
    for seed in 1..6 {
        check(Joint::Quaternion, false, false, ScaleRule::PerAxis, seed);
        check(Joint::Quaternion, false, false, ScaleRule::Mean, seed + 10);
        check(Joint::Quaternion, false, true, ScaleRule::PerAxis, seed + 20);
        check(Joint::Quaternion, true, true, ScaleRule::PerAxis, seed + 30);
    }
    for (seed, order) in EulerOrder::ALL.iter().enumerate() {
        check(
            Joint::Angles(*order),
            seed % 2 == 0,
            seed % 3 == 0,
            ScaleRule::PerAxis,
            seed as u64 + 40,
        );
    }
}

/// A law whose numbers are in axes that are not those of the landmarks is the same law.
#[test]
fn a_law_in_other_axes_is_the_same_law() {
    let mut random = Random(7);
    let plain = law_frame(false);
    let other = random.frame();
    let turned = LawFrame {
        landmarks: Landmarks {
            origin: other * plain.landmarks.origin,
            medial: other * plain.landmarks.medial,
            lateral: other * plain.landmarks.lateral,
            left: false,
        },
        ..plain.clone()
    };
    // d' = Q·d + o has coefficients Q·c; angles stay those of R in the law's axes, so flexion alone is compared about its axis.
    let row = |k: usize, i: usize| {
        let c = other.linear * Vec3::new(LAW[0][i], LAW[1][i], LAW[2][i]);
        c.to_array()[k] + if i == 4 { other.translation.to_array()[k] } else { 0.0 }
    };
    let rotated: Vec<LawFunction> = (0..3)
        .map(|k| {
            let slopes = (0..4).map(|i| row(k, i)).collect();
            LawFunction::Several(FunctionOfSeveral::Linear { slopes, intercept: row(k, 4) })
        })
        .collect();
    let names = ["tx", "ty", "tz"];
    let controls = ["flexion", "adduction", "rotation", "hip"].map(str::to_owned);
    let target = Landmarks {
        origin: Vec3::new(0.1, 0.9, 0.1),
        medial: Vec3::new(0.1, 0.5, 0.05),
        lateral: Vec3::new(0.12, 0.5, 0.16),
        left: false,
    };
    let make = |frame: &LawFrame, functions: &[LawFunction]| {
        let laws: Vec<(&str, &LawFunction)> = names.into_iter().zip(functions).collect();
        let laws = JointLaws { controls: &controls, laws: &laws, region: None, frame };
        Transfer::new(&laws, target, Mat3::IDENTITY, ScaleRule::PerAxis, &str::to_owned).unwrap()
    };
    let (a, b) = (make(&plain, &laws()), make(&turned, &rotated));
    for _ in 0..50 {
        let at = [random.next(), random.next(), random.next(), random.next()];
        assert!((a.centre(&at) - b.centre(&at)).norm() < 1e-13);
        let angles = [at[0], 0.5 * at[1], at[2]];
        let back = b.angles_of(b.orientation(angles));
        assert!(back.iter().zip(angles).all(|(x, y)| (x - y).abs() < 1e-12));
    }
}

/// A joint that holds stays where the target has it, and moves by the law from there.
#[test]
fn a_joint_that_holds_begins_where_it_was() {
    let mut random = Random(3);
    let figure = figure(&mut random, Joint::Quaternion, false, [0.5, 0.11]);
    let at = figure.asked.find(&figure.model).unwrap();
    let frame = law_frame(false);
    let functions = laws();
    let laws: Vec<(&str, &LawFunction)> = ["tx", "ty", "tz"].into_iter().zip(&functions).collect();
    let controls = ["flexion", "adduction", "rotation", "hip_of_the_law"].map(str::to_owned);
    let laws = JointLaws { controls: &controls, laws: &laws, region: None, frame: &frame };
    let asked = figure.asked.clone();
    let elsewhere = |name: &str| asked.driver(name);
    let mut transfer =
        Transfer::new(&laws, at.landmarks, at.at_zero, ScaleRule::PerAxis, &elsewhere).unwrap();
    let free = transfer.centre(&[0.4, 0.1, 0.2, 0.3]) - transfer.centre(&[0.0; 4]);
    transfer.hold(at.centre, &[0.0; 4]);
    let changed = transfer.onto(&figure.model, &at).unwrap();
    let place = |model: &Model| {
        let program = Program::compile(model);
        let mut pose = Pose::new(&program);
        program.evaluate(&model.defaults(), Mode::Open, &mut pose).unwrap();
        pose.segment(model.find_segment("shank").unwrap())
    };
    let (before, after) = (place(&figure.model), place(&changed));
    assert!((before.translation - after.translation).norm() < 1e-13);
    let moved = transfer.centre(&[0.4, 0.1, 0.2, 0.3]) - transfer.centre(&[0.0; 4]);
    assert!((moved - free).norm() < 1e-15);
}

#[test]
fn what_a_law_does_not_say_is_asked_for() {
    let frame = law_frame(false);
    let functions = laws();
    let laws: Vec<(&str, &LawFunction)> =
        ["tx", "ty", "shift"].into_iter().zip(&functions).collect();
    let controls = ["flexion", "adduction", "rotation", "hip"].map(str::to_owned);
    let make = |frame: &LawFrame, laws: &[(&str, &LawFunction)]| {
        let laws = JointLaws { controls: &controls, laws, region: None, frame };
        let target = frame.landmarks;
        Transfer::new(&laws, target, Mat3::IDENTITY, ScaleRule::PerAxis, &str::to_owned)
    };
    let said = make(&frame, &laws).unwrap_err().to_string();
    assert!(said.contains("no law gives the translation `tz`"), "{said}");
    let fixed = LawFrame {
        centre: [Along::Follows("tx".into()), Along::Follows("ty".into()), Along::Fixed(0.01)],
        ..frame.clone()
    };
    let said = make(&fixed, &laws).unwrap_err().to_string();
    assert!(said.contains("`shift` is no angle and no translation"), "{said}");
    let transfer = make(&fixed, &laws[..2]).unwrap();
    assert!((transfer.centre(&[0.0; 4]).z - 0.01).abs() < 1e-15);
    let flat = LawFrame {
        landmarks: Landmarks { origin: Vec3::new(0.0, -0.41, 0.3), ..frame.landmarks },
        ..frame
    };
    assert!(make(&flat, &laws[..2]).unwrap_err().to_string().contains("on a line"));
}
