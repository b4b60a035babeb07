//! The shrug of Shao & Ng-Thow-Hing 2003, figure 3: shoulder bones lift, the arm keeps hanging.

use condyle_math::function::{Curve, Function, PiecewiseLinear};
use condyle_math::{Quat, Vec3};
use condyle_model::component::Depend;
use condyle_model::{CoordinateKind, Mode, Model, ModelBuilder, Pose, Program, SegmentId};

/// Thorax, clavicle, scapula and humerus, each with a hinge.
fn shoulder(weight: Option<f64>) -> (Model, [SegmentId; 4]) {
    let mut b = ModelBuilder::new("shoulder");
    let thorax = b.segment("thorax", None);
    b.hinge("waist", thorax, "lean", Vec3::X);
    let clavicle = b.segment("clavicle", Some(thorax));
    b.place_joint(clavicle, Vec3::new(0.0, 0.4, 0.02));
    b.hinge("sternoclavicular", clavicle, "lift", Vec3::new(0.8, 0.1, -0.6));
    let scapula = b.segment("scapula", Some(clavicle));
    b.place_joint(scapula, Vec3::new(0.0, 0.03, 0.15));
    b.hinge("acromioclavicular", scapula, "tilt", Vec3::Z);
    let humerus = b.segment("humerus", Some(scapula));
    b.place_joint(humerus, Vec3::new(0.0, -0.03, 0.02));
    let (set, _) = b.hinge("glenohumeral", humerus, "raise", Vec3::X);
    if let Some(weight) = weight {
        let undo = b.compensate(set, "hang", humerus, &[clavicle, scapula], weight);
        let raise = b.coordinates().len() - 1;
        let angle = b.coordinate_at(raise).unwrap();
        let own = b.rotate(set, "own", angle, Vec3::X);
        let motion = b.product(set, "motion", vec![undo, own]);
        b.output(set, humerus, motion);
    }
    (b.build().unwrap(), [thorax, clavicle, scapula, humerus])
}

fn pose(model: &Model, coordinates: [f64; 4]) -> Pose {
    let program = Program::compile(model);
    let mut pose = Pose::new(&program);
    program.evaluate(&coordinates, Mode::Open, &mut pose).unwrap();
    pose
}

fn orientation(pose: &Pose, segment: SegmentId) -> Quat {
    Quat::from_mat3(pose.segment(segment).linear)
}

#[test]
fn a_compensated_humerus_keeps_its_orientation_and_stays_attached() {
    let (model, [_, _, scapula, humerus]) = shoulder(Some(1.0));
    let rest = pose(&model, [0.0, 0.0, 0.0, 0.4]);
    let shrug = pose(&model, [0.0, 0.5, -0.3, 0.4]);
    assert!(orientation(&rest, humerus).angle_to(orientation(&shrug, humerus)) < 1e-12);
    let socket = shrug.segment(scapula) * Vec3::new(0.0, -0.03, 0.02);
    assert!((shrug.segment(humerus).translation - socket).norm() < 1e-12);
    assert!((socket - rest.segment(humerus).translation).norm() > 0.03, "the shoulder did move");
    // The thorax is not named, so the arm leans with it.
    let leaning = pose(&model, [0.2, 0.5, -0.3, 0.4]);
    let turned = orientation(&rest, humerus).angle_to(orientation(&leaning, humerus));
    assert!((turned - 0.2).abs() < 1e-12, "{turned}");
}

#[test]
fn without_compensation_the_humerus_turns_and_half_of_it_turns_half() {
    let angle = |weight| {
        let (model, [.., humerus]) = shoulder(weight);
        // The clavicle alone, so that half the weight is half of one rotation.
        let rest = orientation(&pose(&model, [0.0; 4]), humerus);
        rest.angle_to(orientation(&pose(&model, [0.0, 0.5, 0.0, 0.0]), humerus))
    };
    assert!((angle(None) - 0.5).abs() < 1e-12);
    assert!((angle(Some(0.5)) - 0.25).abs() < 1e-12);
}

#[test]
fn only_ancestors_can_be_compensated() {
    let mut b = ModelBuilder::new("wrong");
    let [a, c] = ["arm", "leg"].map(|name| b.segment(name, None));
    let set = b.joint_set("joint");
    let undo = b.compensate(set, "undo", a, &[c], 1.0);
    b.output(set, a, undo);
    let findings = b.build().unwrap_err();
    assert_eq!(findings[0].code, "model/not-an-ancestor");
    assert!(findings[0].message.contains("`leg`"), "{}", findings[0].message);
}

/// Piecewise linear bounds through points in degrees.
fn lines(points: &[(f64, f64)]) -> Function {
    let (x, y) = points.iter().map(|(x, y)| (x.to_radians(), y.to_radians())).unzip();
    Function::from(Curve::PiecewiseLinear(PiecewiseLinear::new(x, y).unwrap()))
}

#[test]
fn a_lifted_arm_lifts_the_clavicle() {
    // Shao & Ng-Thow-Hing 2003, section 5.2: abduction of 0, 60, 120, 180 degrees bounds the
    // elevation of the clavicle from below at -10, -6.7, 4.85 and 23 degrees.
    let table = [(0.0, -10.0), (60.0, -6.7), (120.0, 4.85), (180.0, 23.0)];
    let mut b = ModelBuilder::new("shoulder");
    let clavicle = b.segment("clavicle", None);
    let set = b.joint_set("shoulder");
    let abduction = b.coordinate(set, "abduction", CoordinateKind::Rotation);
    let elevation = b.coordinate(set, "elevation", CoordinateKind::Rotation);
    let bound = Depend { lower: Some(lines(&table)), upper: None };
    let held = b.depend(set, "bound", elevation, abduction, bound);
    let turn = b.rotate(set, "turn", held, Vec3::X);
    b.output(set, clavicle, turn);
    // The one-to-one form is a map of the same table.
    let follower = b.coordinate(set, "follower", CoordinateKind::Rotation);
    let led = b.map(set, "led", abduction, lines(&table));
    b.follow(follower, led);
    let model = b.build().unwrap();
    let program = Program::compile(&model);
    let mut pose = Pose::new(&program);
    let mut pose_at = |abduction: f64, elevation: f64, mode| {
        let asked = [abduction.to_radians(), elevation.to_radians(), 0.0];
        program.evaluate(&asked, mode, &mut pose).unwrap();
        let turned = pose.segment(clavicle).linear;
        let effective = pose.effective();
        assert!((turned.y.z.atan2(turned.y.y) - effective[1]).abs() < 1e-15);
        [effective[1].to_degrees(), effective[2].to_degrees(), pose.limit_row(0).to_degrees()]
    };
    for (abduction, least) in table {
        // Below the bound it is clamped, above it follows the request.
        let [low, led, _] = pose_at(abduction, -40.0, Mode::Posed);
        assert!((low - least).abs() < 1e-13 && (led - least).abs() < 1e-13, "{low} {led}");
        let [high, ..] = pose_at(abduction, 30.0, Mode::Posed);
        assert!((high - 30.0).abs() < 1e-13);
        // In open mode it passes unchanged, and the limit row is the violation.
        let [open, _, row] = pose_at(abduction, -40.0, Mode::Open);
        assert!((open + 40.0).abs() < 1e-13 && (row - (-40.0 - least)).abs() < 1e-13);
    }
    // Between two points of the table it is linear.
    let [middle, ..] = pose_at(90.0, -40.0, Mode::Posed);
    assert!((middle - 0.5 * (-6.7 + 4.85)).abs() < 1e-13, "{middle}");
}
