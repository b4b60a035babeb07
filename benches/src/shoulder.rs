//! A shoulder as a network of twenty components (the structure of Shao & Ng-Thow-Hing 2003, figures
//! 9 to 11), with invented sizes of a person.

use crate::joints::{SCAPULA, cone, gliding};
use condyle_math::Vec3;
use condyle_math::function::{Curve, Function, PiecewiseLinear};
use condyle_model::component::{
    Centre, Compensate, Component, Contact, Depend, JointCone, Pivot, Signal, Swinging,
};
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
    let of = Swinging::Angles([flexion, abduction, twist], axes);
    let arm = JointCone { of, cone: cone(-Vec3::Y, 1.9) };
    let arm = b.component(set, "arm_cone", Component::Cone(arm));
    let flex = b.rotate(set, "flex", output(arm, 0), axes[0]);
    let centres = [(60.0, Vec3::Y * -0.004), (180.0, Vec3::Y * 0.006)];
    let centres = centres.map(|(to, at): (f64, Vec3)| (to.to_radians(), at));
    let abduct = Pivot::new(output(arm, 1), axes[1], Centre::Intervals(centres.to_vec()))
        .unwrap_or_else(|e| panic!("centres: {e}"));
    let abduct = b.pivot(set, "abduct", abduct);
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
    let driver = output(arm, 1);
    let lower = Depend { passive: elevation, driver, lower: Some(table), upper: None };
    let elevation = b.depend(set, "elevation_bound", lower);
    let both = Depend {
        passive: protraction,
        driver: output(arm, 0),
        lower: Some(lines(&[(-60.0, -25.0), (120.0, -10.0)])),
        upper: Some(lines(&[(-60.0, 15.0), (120.0, 30.0)])),
    };
    let protraction = b.depend(set, "protraction_bound", both);
    let of = Swinging::Directions([protraction, elevation], [Vec3::Y, Vec3::X]);
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
    let held = b.component(set, "clavicle_cone", Component::Cone(held));
    let protract = b.rotate(set, "protract", output(held, 0), Vec3::Y);
    let elevate = b.rotate(set, "elevate", output(held, 1), Vec3::X);
    let clavicle_motion = b.product(set, "clavicle_motion", vec![protract, elevate]);
    b.output(set, clavicle, clavicle_motion);

    // The scapula: the clavicle's rotation undone, rotated upward with the arm, put on the ribs.
    let undo = Compensate { segment: scapula, ancestors: vec![clavicle], weight: 1.0 };
    let undo = b.compensate(set, "scapula_stays", undo);
    let upward = b.map(set, "rhythm", output(arm, 1), Function::linear(0.33, 0.0));
    let rotate = b.rotate(set, "upward", upward, Vec3::new(0.9, 0.1, 0.42));
    let before = b.product(set, "before_contact", vec![undo, rotate]);
    let contact = Contact {
        segment: scapula,
        surface: thorax,
        before: Some(before),
        drivers: vec![output(held, 1), upward],
        law: gliding(),
    };
    let glide = b.component(set, "glide", Component::Contact(contact));
    let scapula_motion = b.product(set, "scapula_motion", vec![before, glide]);
    b.output(set, scapula, scapula_motion);

    // The humerus does not rotate with either of them.
    let undo = Compensate { segment: humerus, ancestors: vec![clavicle, scapula], weight: 1.0 };
    let undo = b.compensate(set, "arm_stays", undo);
    let arm_motion = b.product(set, "arm_motion", vec![undo, flex, abduct, turn]);
    b.output(set, humerus, arm_motion);
    b.build().unwrap_or_else(|findings| panic!("the shoulder is well formed: {findings:?}"))
}
