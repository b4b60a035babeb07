//! Files before and after version 3.5, read again by our reader: what is expected follows from the formulas.

use super::*;
use crate::opensim::scale::model_of;
use condyle_math::{Affine, EulerOrder, Vec3};
use condyle_model::{Mode, Pose, Program};

const NEW: &str = r#"<?xml version="1.0"?><OpenSimDocument Version="40000"><Model name="leg">
<BodySet><objects><Body name="femur_r"><mass>8</mass></Body><Body name="tibia_r"><mass>3</mass></Body></objects></BodySet>
<JointSet><objects><WeldJoint name="hip"><socket_parent_frame>/ground</socket_parent_frame>
<socket_child_frame>/bodyset/femur_r</socket_child_frame></WeldJoint>
<PinJoint name="knee_r"><socket_parent_frame>femur_r_offset</socket_parent_frame><socket_child_frame>/bodyset/tibia_r</socket_child_frame>
<coordinates><Coordinate name="knee_angle_r"><range>-2 0.1</range><!-- mine --></Coordinate></coordinates>
<frames><PhysicalOffsetFrame name="femur_r_offset"><socket_parent>/bodyset/femur_r</socket_parent>
<translation>0 -0.4 0</translation></PhysicalOffsetFrame></frames></PinJoint></objects></JointSet>
<ForceSet><objects><Millard2012EquilibriumMuscle name="vastus"/></objects></ForceSet></Model></OpenSimDocument>"#;

const OLD: &str = r#"<OpenSimDocument Version="20302"><Model name="leg"><BodySet><objects>
<Body name="ground"/><Body name="femur_r"><Joint><WeldJoint name="hip"><parent_body>ground</parent_body></WeldJoint></Joint></Body>
<Body name="tibia_r"><Joint><CustomJoint name="knee_r"><parent_body>femur_r</parent_body><location_in_parent>0 -0.4 0</location_in_parent>
<CoordinateSet><objects><Coordinate name="knee_angle_r"><range>-2 0.1</range></Coordinate></objects></CoordinateSet>
<SpatialTransform><TransformAxis name="rotation1"><coordinates>knee_angle_r</coordinates><axis>0 0 1</axis>
<function><LinearFunction><coefficients>1 0</coefficients></LinearFunction></function></TransformAxis></SpatialTransform>
</CustomJoint></Joint></Body></objects></BodySet></Model></OpenSimDocument>"#;

fn linear(slopes: &[f64], intercept: f64) -> FunctionOfSeveral {
    FunctionOfSeveral::Linear { slopes: slopes.to_vec(), intercept }
}

fn joint() -> JointInPlace {
    let names = ["knee_angle_r", "knee_adduction_r", "knee_rotation_r"].map(str::to_owned);
    let turn = |name: &String, axis| TurnOf {
        axis,
        drivers: vec![name.clone()],
        angle: linear(&[1.0], 0.0),
    };
    let slide = |along, row: [f64; 4]| SlideOf {
        along,
        drivers: names.to_vec(),
        distance: linear(&row[..3], row[3]),
    };
    JointInPlace {
        child: "tibia_r".into(),
        in_parent: Affine::new(
            EulerOrder::XYZ.to_mat3([0.1, -0.2, 0.3]),
            Vec3::new(0.01, 0.02, 0.03),
        ),
        in_child: Affine::new(EulerOrder::XYZ.to_mat3([-0.2, 0.1, 0.2]), Vec3::new(0.0, 0.05, 0.0)),
        turns: [turn(&names[0], Vec3::Z), turn(&names[1], Vec3::X), turn(&names[2], Vec3::Y)],
        slides: [
            slide(Vec3::X, [-0.035, 0.005, -0.012, 0.048]),
            slide(Vec3::Y, [-0.044, 0.009, 0.021, -0.4]),
            slide(Vec3::Z, [0.007, -0.024, 0.015, -0.05]),
        ],
        coordinates: names
            .iter()
            .map(|name| NewCoordinate { name: name.clone(), default: 0.0, range: [-0.5, 0.5] })
            .collect(),
        couplers: vec![],
    }
}

#[test]
fn a_joint_in_place_moves_by_its_functions() {
    for text in [NEW, OLD] {
        let new = joint();
        let read = with_joint(text, &new).unwrap();
        assert!(read.warnings.is_empty(), "{:?}", read.warnings);
        let model = model_of(&read.value).unwrap().value;
        assert!(read.value.contains("<range>-2 0.1</range>"), "the old coordinate stays");
        let program = Program::compile(&model);
        let mut pose = Pose::new(&program);
        let (femur, tibia) =
            (model.find_segment("femur_r").unwrap(), model.find_segment("tibia_r").unwrap());
        for angles in [[0.0, 0.0, 0.0], [-1.2, 0.2, -0.3], [0.4, -0.1, 0.25]] {
            let mut stored = model.defaults();
            let names = ["knee_angle_r", "knee_adduction_r", "knee_rotation_r"];
            for (name, angle) in names.into_iter().zip(angles) {
                *model.value_mut(&mut stored, model.find_coordinate(name).unwrap()) = angle;
            }
            program.evaluate(&stored, Mode::Open, &mut pose).unwrap();
            let along = |row: [f64; 4]| {
                row[0] * angles[0] + row[1] * angles[1] + row[2] * angles[2] + row[3]
            };
            let shift = Vec3::new(
                along([-0.035, 0.005, -0.012, 0.048]),
                along([-0.044, 0.009, 0.021, -0.4]),
                along([0.007, -0.024, 0.015, -0.05]),
            );
            let order: EulerOrder = "zxy".parse().unwrap();
            let expected = new.in_parent
                * Affine::new(order.to_mat3(angles), shift)
                * new.in_child.rigid_inverse();
            let found = pose.segment(femur).rigid_inverse() * pose.segment(tibia);
            assert!((found.translation - expected.translation).norm() < 1e-14);
            assert!((found.linear * Vec3::X - expected.linear * Vec3::X).norm() < 1e-14);
        }
    }
    assert!(with_joint(NEW, &joint()).unwrap().value.contains("<!-- mine -->"));
    assert!(with_joint(NEW, &joint()).unwrap().value.contains("name=\"vastus\""));
    let other = JointInPlace { child: "patella".into(), ..joint() };
    assert!(with_joint(NEW, &other).unwrap_err().to_string().contains("no joint moves"));
}

#[test]
fn a_coupler_takes_the_place_of_an_old_one() {
    let coupler = |name: &str, slope| Coupler {
        dependent: name.into(),
        drivers: vec!["hip/knee_angle_r".into()],
        function: linear(&[slope], 0.0),
    };
    let three = with_joint(NEW, &joint()).unwrap().value;
    let once = with_couplers(&three, &[coupler("knee_rotation_r", 0.1)]).unwrap();
    let twice = with_couplers(&once, &[coupler("knee_rotation_r", 0.2)]).unwrap();
    assert_eq!(twice.matches("<CoordinateCouplerConstraint").count(), 1);
    let model = model_of(&twice).unwrap().value;
    let id = model.find_coordinate("knee_rotation_r").unwrap();
    assert!(model.coordinate(id).follows.is_some());
    let said = with_couplers(&three, &[coupler("knee_rotation", 0.1)]).unwrap_err().to_string();
    assert!(said.contains("did you mean `knee_rotation_r`?"), "{said}");
}
