//! A law carried to another figure: against Blender, which evaluates the driver script, and through the text of an `.osim`.

use condyle::formats::document::{landmarks, law};
use condyle::formats::opensim::scale::model_of;
use condyle::learn::coupling::ScaleRule;
use condyle::math::{Affine, EulerOrder, Mat3, Vec3};
use condyle::transferring::{Ready, blender_driver, coupled_text, expressions, joint_text, ready};
use condyle::{Mode, Model, Pose, Program};

const LAW: &str = include_str!("../../../oracles/transfer/law.toml");
const FIGURE: &str = include_str!("../../../oracles/transfer/figure.toml");
const LANDMARKS: &str = include_str!("../../../oracles/transfer/landmarks.toml");

fn alone(_: &str) -> Result<String, String> {
    Err("it stands alone".to_owned())
}

fn figure() -> (Model, Ready) {
    let model = condyle::formats::document::read(FIGURE, &mut alone).unwrap().value.model;
    let law = law::read(LAW, &mut alone).unwrap().value;
    let places = landmarks::read(LANDMARKS, &mut alone).unwrap().value;
    let made = ready(&model, &law, &places, ScaleRule::PerAxis).unwrap();
    (model, made)
}

/// `oracles/transfer/blender.py`: Blender's bones have single precision, so that a metre is known to 1e-6.
#[test]
fn blender_moves_the_bone_as_we_do() {
    let (model, made) = figure();
    let driver = blender_driver(&made, &model).unwrap();
    // The answers are those of this very script.
    let kept = include_str!("../../../oracles/transfer/driver.py");
    assert_eq!(driver, kept, "run oracles/transfer/blender.py again");
    let carried = made.transfer.onto(&model, &made.standing).unwrap();
    let program = Program::compile(&carried);
    let mut pose = Pose::new(&program);
    let find = |name: &str| carried.find_segment(name).unwrap();
    let answers: serde_json::Value =
        serde_json::from_str(include_str!("../../../oracles/transfer/answers.json")).unwrap();
    let poses = answers["poses"].as_array().unwrap();
    assert_eq!(poses.len(), 20);
    let mut travelled = 0.0f64;
    let mut first = None;
    for answer in poses {
        let mut stored = carried.defaults();
        let q: Vec<f64> =
            answer["quaternion"].as_array().unwrap().iter().map(|x| x.as_f64().unwrap()).collect();
        let ball =
            carried.coordinate_ids().find(|id| carried.stored_range(*id).len() == 4).unwrap();
        stored[carried.stored_range(ball)].copy_from_slice(&q);
        let hip = carried.find_coordinate("hip_flexion").unwrap();
        *carried.value_mut(&mut stored, hip) = answer["hip"].as_f64().unwrap();
        program.evaluate(&stored, Mode::Open, &mut pose).unwrap();
        let ours = pose.segment(find("thigh")).rigid_inverse() * pose.segment(find("shank"));
        let rows = answer["shank_in_thigh"].as_array().unwrap();
        for (i, row) in rows.iter().take(3).enumerate() {
            for j in 0..3 {
                assert!((row[j].as_f64().unwrap() - ours.linear.at(i, j)).abs() < 2e-6);
            }
            let at = row[3].as_f64().unwrap() - ours.translation.to_array()[i];
            assert!(at.abs() < 1e-6, "{at}");
        }
        let start = *first.get_or_insert(ours.translation);
        travelled = travelled.max((ours.translation - start).norm());
    }
    assert!(travelled > 0.005, "the bone travels, by {travelled} m");
}

const OSIM: &str = r#"<OpenSimDocument Version="40000"><Model name="leg"><BodySet><objects>
<Body name="pelvis"><mass>11</mass></Body><Body name="femur_r"><mass>8</mass></Body><Body name="tibia_r"><mass>3</mass></Body></objects></BodySet>
<JointSet><objects><WeldJoint name="ground_pelvis"><socket_parent_frame>/ground</socket_parent_frame>
<socket_child_frame>/bodyset/pelvis</socket_child_frame></WeldJoint>
<PinJoint name="hip_r"><socket_parent_frame>/bodyset/pelvis</socket_parent_frame><socket_child_frame>/bodyset/femur_r</socket_child_frame>
<coordinates><Coordinate name="hip_flexion_r"/></coordinates></PinJoint>
<CustomJoint name="knee_r"><socket_parent_frame>femur_offset</socket_parent_frame><socket_child_frame>/bodyset/tibia_r</socket_child_frame>
<coordinates><Coordinate name="knee_angle_r"><range>0 2</range></Coordinate></coordinates>
<frames><PhysicalOffsetFrame name="femur_offset"><socket_parent>/bodyset/femur_r</socket_parent><translation>0 -0.4 0</translation>
<orientation>0 0.05 0</orientation></PhysicalOffsetFrame></frames><SpatialTransform><TransformAxis name="rotation1"><coordinates>knee_angle_r</coordinates>
<axis>0 0 -1</axis><function><LinearFunction><coefficients>1 0</coefficients></LinearFunction></function></TransformAxis></SpatialTransform>
</CustomJoint></objects></JointSet><!-- kept --><ForceSet><objects><Thelen2003Muscle name="vasti"/></objects></ForceSet></Model></OpenSimDocument>"#;

/// The joint in the text and the law in our own model are one: the centre and the orientation for the same angles, for a law of the knee
/// alone, which the joint holds itself, and one that the hip drives too, which needs couplers.
#[test]
fn the_joint_of_an_osim_is_the_law() {
    let before = model_of(OSIM).unwrap().value;
    let places = LANDMARKS.split("[target]").next().unwrap().to_owned()
        + "[target]\njoint = \"tibia_r\"\norigin = [0, 0, 0.08]\nmedial = [0.01, -0.42, -0.06]\nlateral = [-0.01, -0.4, 0.07]\n\
           drivers = { hip = \"hip_flexion_r\" }\n";
    let places = landmarks::read(&places, &mut alone).unwrap().value;
    let with_hip = law::read(LAW, &mut alone).unwrap().value;
    // Without the hip's slopes; first that of y, since the row of x ends alike when its own is gone.
    let knee =
        LAW.replace(", -0.003], i", "], i").replace(", \"hip\"]", "]").replace(", 0.004]", "]");
    let knee = knee.replace(", 0.002], intercept = -0.05", "], intercept = -0.05");
    let knee = law::read(&knee, &mut alone).unwrap().value;
    let square = knee.clone();
    let squared = |mut law: law::LawDocument| {
        let coefficients = [-0.41, 0.002, 0.01, -0.006, 0.003, 0.004, 0.001, -0.002, 0.005, 0.006];
        let p = condyle::math::function::MultivariatePolynomial::up_to_order(3, 2, &coefficients);
        law.laws[1].function = condyle::learn::coupling::LawFunction::Several(
            condyle::math::function::FunctionOfSeveral::Polynomial(p.unwrap()),
        );
        law
    };
    for (law, couplers) in [(with_hip, 3), (knee, 0), (squared(square), 0)] {
        let made = ready(&before, &law, &places, ScaleRule::PerAxis).unwrap();
        let read = joint_text(OSIM, &before, &made).unwrap();
        assert!(read.warnings.is_empty(), "{:?}", read.warnings);
        assert!(read.value.contains("<!-- kept -->") && read.value.contains("vasti"));
        assert!(read.value.contains("<range>0 2</range>"), "the knee's own angle stays");
        assert_eq!(read.value.matches("<CoordinateCouplerConstraint").count(), couplers);
        let after = model_of(&read.value).unwrap().value;
        let program = Program::compile(&after);
        let mut pose = Pose::new(&program);
        let find = |name: &str| after.find_segment(name).unwrap();
        for i in 0..100 {
            let wave = |k: f64, most: f64| (k * f64::from(i) + k).sin() * most;
            let [flexion, adduction, rotation, hip] =
                [wave(1.1, 1.2), wave(0.7, 0.3), wave(2.3, 0.4), wave(3.1, 0.9)];
            let mut stored = after.defaults();
            // The file's knee turns the other way about the law's axis.
            for (name, value) in [
                ("knee_angle_r", -flexion),
                ("knee_r_adduction", adduction),
                ("knee_r_rotation", rotation),
                ("hip_flexion_r", hip),
            ] {
                *after.value_mut(&mut stored, after.find_coordinate(name).unwrap()) = value;
            }
            program.evaluate(&stored, Mode::Open, &mut pose).unwrap();
            let at: Vec<f64> = law
                .controls
                .iter()
                .map(|name| match name.as_str() {
                    "adduction" => adduction,
                    "flexion" => flexion,
                    "rotation" => rotation,
                    _ => hip,
                })
                .collect();
            // By the formulas: scaled laws along the landmarks' axes, which follow from the three points.
            let [o, m, l] = [
                Vec3::new(0.0, 0.0, 0.08),
                Vec3::new(0.01, -0.42, -0.06),
                Vec3::new(-0.01, -0.4, 0.07),
            ];
            let z = (l - m).normalized();
            let up = o - (m + l) * 0.5;
            let y = (up - z * z.dot(up)).normalized();
            let axes = Mat3::from_columns(y.cross(z), y, z);
            let s1 = (o - l).norm() / 0.41;
            let s2 = (m - l).norm() / 0.1;
            let values: Vec<f64> = law.laws.iter().map(|law| law.function.value(&at)).collect();
            let centre = Vec3::new(0.5 * (s1 + s2) * values[0], s1 * values[1], s2 * values[2]);
            let order: EulerOrder = "zxy".parse().unwrap();
            // The frame of the joint is turned by 0.05 about y, and with it the child at rest.
            let rest = Mat3::rotation_y(0.05);
            let turned =
                axes * order.to_mat3([flexion, adduction, rotation]) * axes.transpose() * rest;
            let found =
                pose.segment(find("femur_r")).rigid_inverse() * pose.segment(find("tibia_r"));
            let expected = Affine::new(turned, o + axes * centre);
            assert!(
                (found.translation - expected.translation).norm() < 1e-9,
                "{found:?} {expected:?}"
            );
            for axis in Vec3::UNITS {
                assert!((found.linear * axis - expected.linear * axis).norm() < 1e-9);
            }
        }
    }
}

#[test]
fn a_law_goes_into_a_model_that_has_its_coordinates() {
    let (_, made) = figure();
    assert!(expressions(&made, "shank").unwrap().contains("hip is the coordinate hip_flexion"));
    let law = r#"
condyle = 1
kind = "law"
control = ["hip_flexion_r"]
[law.knee_angle_r]
function = { slopes = [-2], intercept = 0.1 }
"#;
    let law = law::read(law, &mut alone).unwrap().value;
    let text = coupled_text(OSIM, &law).unwrap();
    assert!(text.contains("<!-- kept -->") && text.contains("vasti"));
    let model = model_of(&text).unwrap().value;
    let program = Program::compile(&model);
    let mut pose = Pose::new(&program);
    let mut stored = model.defaults();
    *model.value_mut(&mut stored, model.find_coordinate("hip_flexion_r").unwrap()) = 0.3;
    program.evaluate(&stored, Mode::Open, &mut pose).unwrap();
    let knee = model.find_coordinate("knee_angle_r").unwrap();
    assert!((pose.coordinate(&model, knee)[0] - (0.1 - 0.6)).abs() < 1e-12);
}
