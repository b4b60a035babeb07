//! A shoulder as a network of twenty components (the structure of Shao & Ng-Thow-Hing 2003, figures
//! 9 to 11), with invented sizes of a person.

use crate::joints::{SCAPULA, cone, gliding};
use condyle_math::Vec3;
use condyle_math::function::{Curve, Function, PiecewiseLinear};
use condyle_model::component::{Centre, Contact, Depend, JointCone, Law, Pivot, Signal, Swinging};
use condyle_model::{CoordinateKind, Model, ModelBuilder};

/// Thorax, clavicle, scapula and humerus, moved by five coordinates.
pub fn network() -> Model {
    let mut b = ModelBuilder::new("shoulder");
    let thorax = b.segment("thorax", None);
    let clavicle = b.segment("clavicle", Some(thorax));
    b.place_joint(clavicle, Vec3::new(0.0, 0.0, 0.02));
    let scapula = b.segment("scapula", Some(clavicle));
    b.place_joint(scapula, SCAPULA - Vec3::new(0.0, 0.0, 0.02));
    let humerus = b.segment("humerus", Some(scapula));
    b.place_joint(humerus, Vec3::new(-0.01, -0.03, 0.01));
    let set = b.joint_set("shoulder");
    let names = ["flexion", "abduction", "twist", "elevation", "protraction"];
    let [flexion, abduction, twist, elevation, protraction] =
        names.map(|name| Signal::from(b.coordinate(set, name, CoordinateKind::Rotation)));
    let lines = |points: &[(f64, f64)]| {
        let (x, y) = points.iter().map(|(x, y)| (x.to_radians(), y.to_radians())).unzip();
        let lines = PiecewiseLinear::new(x, y).unwrap_or_else(|e| panic!("increasing: {e}"));
        Function::from(Curve::PiecewiseLinear(lines))
    };
    let output = |source: Signal, k: u32| match source {
        Signal::Output(id, _) => Signal::Output(id, k),
        other => other,
    };

    // The arm: a cone around three rotations, one of which has two centres.
    let axes = [Vec3::Z, Vec3::X, Vec3::Y];
    let arm = JointCone { of: Swinging::Angles(axes), cone: cone(-Vec3::Y, 1.9) };
    let arm = b.component(set, "arm_cone", Law::Cone(arm), vec![flexion, abduction, twist]);
    let flex = b.rotate(set, "flex", output(arm, 0), axes[0]);
    let centres = [(60.0, Vec3::Y * -0.004), (180.0, Vec3::Y * 0.006)];
    let centres = centres.map(|(to, at): (f64, Vec3)| (to.to_radians(), at));
    let abduct = Pivot::new(axes[1], Centre::Intervals(centres.to_vec()))
        .unwrap_or_else(|e| panic!("centres: {e}"));
    let abduct = b.pivot(set, "abduct", output(arm, 1), abduct);
    let turn = b.rotate(set, "turn", output(arm, 2), axes[2]);

    // Inputs from -1 to 1, mapped to angles through 0.
    let input = |b: &mut ModelBuilder, name: &str, source, ends: [f64; 2]| {
        b.map(
            set,
            name,
            source,
            lines(&[(-(1f64.to_degrees()), ends[0]), (0.0, 0.0), (1f64.to_degrees(), ends[1])]),
        )
    };
    let elevation = input(&mut b, "elevation_angle", elevation, [-10.0, 30.0]);
    let protraction = input(&mut b, "protraction_angle", protraction, [-25.0, 30.0]);

    // The clavicle: bounds that the arm sets, a cone, two rotations.
    let table = lines(&[(0.0, -10.0), (60.0, -6.7), (120.0, 4.85), (180.0, 23.0)]);
    let lower = Depend { lower: Some(table), upper: None };
    let elevation = b.depend(set, "elevation_bound", elevation, output(arm, 1), lower);
    let both = Depend {
        lower: Some(lines(&[(-60.0, -25.0), (120.0, -10.0)])),
        upper: Some(lines(&[(-60.0, 15.0), (120.0, 30.0)])),
    };
    let protraction = b.depend(set, "protraction_bound", protraction, output(arm, 0), both);
    let of = Swinging::Directions([Vec3::Y, Vec3::X]);
    let mut untwisted = cone(Vec3::Z, 0.6);
    untwisted = condyle_model::Cone::new(
        Vec3::Z,
        None,
        untwisted.points().iter().map(|p| condyle_model::ConePoint { twist: None, ..*p }).collect(),
        untwisted.subdivisions(),
        untwisted.projection(),
    )
    .unwrap_or_else(|e| panic!("the same cone: {e}"));
    let held = JointCone { of, cone: untwisted };
    let held = b.component(set, "clavicle_cone", Law::Cone(held), vec![protraction, elevation]);
    let protract = b.rotate(set, "protract", output(held, 0), Vec3::Y);
    let elevate = b.rotate(set, "elevate", output(held, 1), Vec3::X);
    let clavicle_motion = b.product(set, "clavicle_motion", vec![protract, elevate]);
    b.output(set, clavicle, clavicle_motion);

    // The scapula: the clavicle's rotation undone, rotated upward with the arm, put on the ribs.
    let undo = b.compensate(set, "scapula_stays", scapula, &[clavicle], 1.0);
    let upward = b.map(set, "rhythm", output(arm, 1), Function::linear(0.33, 0.0));
    let rotate = b.rotate(set, "upward", upward, Vec3::new(0.9, 0.1, 0.42));
    let before = b.product(set, "before_contact", vec![undo, rotate]);
    let contact = Law::Contact(Contact { before: true, most_gap: None, law: gliding() });
    let inputs = vec![scapula.into(), thorax.into(), before, output(held, 1), upward];
    let glide = b.component(set, "glide", contact, inputs);
    let scapula_motion = b.product(set, "scapula_motion", vec![before, glide]);
    b.output(set, scapula, scapula_motion);

    // The humerus does not rotate with either of them.
    let undo = b.compensate(set, "arm_stays", humerus, &[clavicle, scapula], 1.0);
    let arm_motion = b.product(set, "arm_motion", vec![undo, flex, abduct, turn]);
    b.output(set, humerus, arm_motion);
    b.build().unwrap_or_else(|findings| panic!("the shoulder is well formed: {findings:?}"))
}
