//! Models in the formats of OpenSim 1 to 3, whose joints stand inside the bodies they carry.
//!
//! The numbers are what OpenSim 4.6 makes of the same text; the rest are formulas.

use condyle_formats::opensim::model::read;
use condyle_math::{Affine, EulerOrder, Mat3, Vec3};
use condyle_model::{Mode, Model, Pose, Program};

/// A file of that version with one body, `bone`, on the ground.
fn document(version: u32, joint: &str) -> String {
    format!(
        r#"<OpenSimDocument Version="{version}"><Model name="old"><BodySet><objects>
        <Body name="ground"><mass>0</mass><Joint/></Body>
        <Body name="bone"><mass>1</mass><Joint>{joint}</Joint></Body>
        </objects></BodySet></Model></OpenSimDocument>"#
    )
}

/// The fixed ends of the joint, in more digits than OpenSim keeps of them.
const ENDS: &str = "<parent_body>ground</parent_body>
    <location_in_parent>0.1 0.2 -0.3</location_in_parent>
    <orientation_in_parent>2.0943951 0.1234567 -1.0471976</orientation_in_parent>
    <location>0.01 -0.02 0.03</location><orientation>0.3 -0.2 0.1234567</orientation>";

/// Ends of a joint that adds nothing of its own.
const PLAIN: &str = "<parent_body>ground</parent_body>";

fn coordinates(names: &[&str]) -> String {
    let list: String = names.iter().map(|n| format!(r#"<Coordinate name="{n}"/>"#)).collect();
    format!("<CoordinateSet><objects>{list}</objects></CoordinateSet>")
}

fn model(text: &str) -> Model {
    let read = read(text.as_bytes()).unwrap_or_else(|e| panic!("{e}"));
    assert!(read.warnings.is_empty(), "{:?}", read.warnings);
    read.value
}

fn bone(model: &Model, pose: &[(&str, f64)]) -> Affine {
    let program = Program::compile(model);
    let mut stored = model.defaults();
    for (name, value) in pose {
        stored[model.stored_range(model.find_coordinate(name).unwrap()).start] = *value;
    }
    let mut buffers = Pose::new(&program);
    program.evaluate(&stored, Mode::Open, &mut buffers).unwrap();
    buffers.segment(model.find_segment("bone").unwrap())
}

fn assert_near(found: Affine, expected: &[f64]) {
    for (a, b) in found.to_rows().iter().zip(expected) {
        assert!((a - b).abs() < 1e-13, "{:?} is not {expected:?}", found.to_rows());
    }
}

#[test]
#[expect(
    clippy::approx_constant,
    reason = "the six digits that OpenSim keeps of a sixth of a turn"
)]
fn a_pin_inside_its_body_stands_on_frames_of_six_digits() {
    let joint = format!(r#"<PinJoint name="hip">{ENDS}{}</PinJoint>"#, coordinates(&["flexion"]));
    for version in [10905, 20303, 30000] {
        let model = model(&document(version, &joint));
        assert_eq!(model.joint_sets()[0].name, "hip");
        #[rustfmt::skip]
        assert_near(bone(&model, &[("flexion", 0.4)]), &[
            0.6733352079300221, 0.5829610096744295, 0.45472646608835465, 0.09128407413153773,
            0.5870938570778806, -0.047760541219456526, -0.8081087387745794, 0.21741711276806946,
            -0.44937790415556805, 0.8110951805440556, -0.3744116816486296, -0.2680519668981043,
        ]);
    }
    // By formula: 2.0943951 is read as 2.0944, and 0.1234567 as 0.123457.
    let end = |turn: [f64; 3], place| Affine::new(EulerOrder::XYZ.to_mat3(turn), place);
    let parent = end([2.0944, 0.123457, -1.0472], Vec3::new(0.1, 0.2, -0.3));
    let child = end([0.3, -0.2, 0.123457], Vec3::new(0.01, -0.02, 0.03));
    let turn = Affine::from_rotation(Mat3::rotation_z(0.4));
    let expected = parent * turn * child.rigid_inverse();
    let found = bone(&model(&document(30000, &joint)), &[("flexion", 0.4)]);
    assert_near(found, &expected.to_rows());
}

#[test]
fn a_reversed_joint_moves_by_the_inverse() {
    let axis = |name: &str, coordinate: &str, axis: &str, line: &str| {
        format!(
            r#"<TransformAxis name="{name}"><coordinates>{coordinate}</coordinates>
            <axis>{axis}</axis><LinearFunction><coefficients>{line}</coefficients></LinearFunction>
            </TransformAxis>"#
        )
    };
    let joint = format!(
        r#"<CustomJoint name="hip">{ENDS}<reverse>true</reverse>{}
        <SpatialTransform>{}{}</SpatialTransform></CustomJoint>"#,
        coordinates(&["flexion", "glide"]),
        axis("rotation1", "flexion", "0.6 0 0.8", "1 0"),
        axis("translation1", "glide", "1 0.5 0", "1 0.05"),
    );
    for version in [10905, 20303, 30000] {
        #[rustfmt::skip]
        assert_near(bone(&model(&document(version, &joint)), &[("flexion", 0.4), ("glide", 0.1)]), &[
            0.02422805679564414, 0.790484461242042, 0.6120027106139202, 0.0077538700541830985,
            0.6097636855026202, 0.4734362025115343, -0.6356464504689059, 0.14437367185998423,
            -0.7922128811791491, 0.38857750666544777, -0.47053827921593705, -0.1785187358184177,
        ]);
    }
}

#[test]
fn splines_of_any_name_are_the_same_also_in_a_multiplier() {
    for (version, spline) in
        [(20001, "natCubicSpline"), (20303, "NaturalCubicSpline"), (30000, "SimmSpline")]
    {
        let joint = format!(
            r#"<CustomJoint name="knee">{ENDS}{}<SpatialTransform>
            <TransformAxis name="rotation3"><coordinates>flexion</coordinates><axis>0 0.2 1</axis>
            <LinearFunction><coefficients>1 0</coefficients></LinearFunction></TransformAxis>
            <TransformAxis name="translation2"><coordinates>flexion</coordinates><axis>0 1 0</axis>
            <function><MultiplierFunction><function><{spline}><x> -1 0 1 2</x>
            <y>0.3 0 0.2 0.1</y></{spline}></function><scale>0.5</scale></MultiplierFunction>
            </function></TransformAxis></SpatialTransform></CustomJoint>"#,
            coordinates(&["flexion"]),
        );
        #[rustfmt::skip]
        assert_near(bone(&model(&document(version, &joint)), &[("flexion", 0.7)]), &[
            0.7944879073558859, 0.33034847013874485, 0.5095673197353374, 0.14142991697860754,
            0.5854348969315138, -0.19360654216950487, -0.787262655207241, 0.20324258327636285,
            -0.16141544696853724, 0.9237891507839646, -0.3472155791058184, -0.2366418062464764,
        ]);
    }
}

#[test]
fn the_oldest_axis_sets_say_themselves_what_turns() {
    // Before 1.9 the axes had names of their own, in any order; OpenSim 4 reads these no more.
    let joint = format!(
        r#"<CustomJoint name="knee">{PLAIN}{}<TransformAxisSet><objects>
        <TransformAxis name="slide"><is_rotation>false</is_rotation>
        <coordinate>flexion</coordinate><axis>0 2 0</axis>
        <function><natCubicSpline><x>0 1</x><y>0.1 0.3</y></natCubicSpline></function>
        </TransformAxis>
        <TransformAxis name="bend"><is_rotation>true</is_rotation>
        <coordinate>flexion</coordinate><axis>0 0 1</axis><function/></TransformAxis>
        </objects></TransformAxisSet></CustomJoint>"#,
        coordinates(&["flexion"]),
    );
    let found = bone(&model(&document(10900, &joint)), &[("flexion", 0.5)]);
    let expected = Affine::new(Mat3::rotation_z(0.5), Vec3::new(0.0, 0.2, 0.0));
    assert_near(found, &expected.to_rows());
}

#[test]
fn an_axis_with_an_empty_function_takes_its_coordinate_and_one_without_stands_still() {
    let joint = |function: &str| {
        format!(
            r#"<CustomJoint name="hip">{PLAIN}{}<SpatialTransform>
            <TransformAxis name="rotation1"><coordinates>flexion</coordinates><axis>1 0 0</axis>
            {function}</TransformAxis></SpatialTransform></CustomJoint>"#,
            coordinates(&["flexion"]),
        )
    };
    let turned = Affine::from_rotation(Mat3::rotation_x(0.4));
    let found = bone(&model(&document(10901, &joint("<function/>"))), &[("flexion", 0.4)]);
    assert_near(found, &turned.to_rows());
    let read = read(document(10901, &joint("")).as_bytes()).unwrap();
    assert_eq!(read.warnings.len(), 1);
    assert!(read.warnings[0].to_string().contains("has coordinates but no function"));
    assert_near(bone(&read.value, &[("flexion", 0.4)]), &Affine::IDENTITY.to_rows());
}

#[test]
fn axes_of_a_spatial_transform_go_by_name_not_by_place() {
    let axis = |name: &str, axis: &str, coordinate: &str| {
        format!(
            r#"<TransformAxis name="{name}"><coordinates>{coordinate}</coordinates>
            <axis>{axis}</axis><function><LinearFunction><coefficients>1 0</coefficients>
            </LinearFunction></function></TransformAxis>"#
        )
    };
    let joint = format!(
        r#"<CustomJoint name="hip">{PLAIN}{}<SpatialTransform>{}{}{}</SpatialTransform>
        </CustomJoint>"#,
        coordinates(&["a", "b", "c"]),
        axis("translation1", "1 0 0", "c"),
        axis("rotation2", "0 1 0", "b"),
        axis("rotation1", "0 0 1", "a"),
    );
    let found = bone(&model(&document(30000, &joint)), &[("a", 0.3), ("b", 0.5), ("c", 0.7)]);
    let turn = Mat3::rotation_z(0.3) * Mat3::rotation_y(0.5);
    assert_near(found, &Affine::new(turn, Vec3::new(0.7, 0.0, 0.0)).to_rows());
}

#[test]
fn a_body_without_a_joint_is_free() {
    let text = document(30000, "");
    let read = read(text.as_bytes()).unwrap();
    assert_eq!(read.warnings.len(), 1);
    assert!(read.warnings[0].to_string().starts_with("line 3"), "{}", read.warnings[0]);
    // The names that OpenSim gives.
    let pose = [("free_bone_coord_0", 0.3), ("free_bone_coord_4", 0.2)];
    let expected = Affine::new(Mat3::rotation_x(0.3), Vec3::new(0.0, 0.2, 0.0));
    assert_near(bone(&read.value, &pose), &expected.to_rows());
}
