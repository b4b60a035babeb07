//! Parts of OpenSim models wherever they stand, and properties of old versions that move bodies.
//!
//! An arm of two pins: D on the forearm is at T(0, 1.4, 0)·Rz(sh)·T(0, -0.3, 0)·Rz(el)·(0.03, -0.25, 0).

use condyle_formats::opensim::model::read;
use condyle_formats::{Content, Diagnostic, Format, Severity};
use condyle_math::{Affine, EulerOrder, Mat3, Vec3};
use condyle_model::{Mode, Model, Pose, Program};

const SH: &str = r#"<PinJoint name="sh"><socket_parent_frame>sh_p</socket_parent_frame>
    <socket_child_frame>/bodyset/upper</socket_child_frame>
    <coordinates><Coordinate name="sh_flex"/></coordinates>
    <frames><PhysicalOffsetFrame name="sh_p"><socket_parent>/ground</socket_parent>
    <translation>0 1.4 0</translation></PhysicalOffsetFrame></frames></PinJoint>"#;
const EL: &str = r#"<PinJoint name="el"><socket_parent_frame>el_p</socket_parent_frame>
    <socket_child_frame>/bodyset/lower</socket_child_frame>
    <coordinates><Coordinate name="el_flex"/></coordinates>
    <frames><PhysicalOffsetFrame name="el_p"><socket_parent>/bodyset/upper</socket_parent>
    <translation>0 -0.3 0</translation></PhysicalOffsetFrame></frames></PinJoint>"#;
const D: &str = r#"<Marker name="D"><socket_parent_frame>/bodyset/lower</socket_parent_frame>
    <location>0.03 -0.25 0</location></Marker>"#;

/// The arm of these parts: components of the model, of the bodies, and what the sets hold.
fn arm(components: &str, upper: &str, lower: &str, sets: &str) -> String {
    format!(
        r#"<OpenSimDocument Version="40000"><Model name="arm"><components>{components}</components>
        <BodySet><objects><Body name="upper"><components>{upper}</components></Body>
        <Body name="lower"><components>{lower}</components></Body></objects></BodySet>
        {sets}</Model></OpenSimDocument>"#
    )
}

fn joints(list: &str) -> String {
    format!("<JointSet><objects>{list}</objects></JointSet>")
}

fn markers(list: &str) -> String {
    format!("<MarkerSet><objects>{list}</objects></MarkerSet>")
}

fn without_warnings(text: &str) -> Model {
    let read = read(text.as_bytes()).unwrap_or_else(|e| panic!("{e}\n{text}"));
    assert!(read.warnings.is_empty(), "{:?}\n{text}", read.warnings);
    read.value
}

fn stored(model: &Model, pose: &[(&str, f64)]) -> Vec<f64> {
    let mut stored = model.defaults();
    for (name, value) in pose {
        *model.value_mut(&mut stored, model.find_coordinate(name).unwrap()) = *value;
    }
    stored
}

fn body(model: &Model, name: &str, pose: &[(&str, f64)]) -> Affine {
    let program = Program::compile(model);
    let mut buffers = Pose::new(&program);
    program.evaluate(&stored(model, pose), Mode::Open, &mut buffers).unwrap();
    buffers.segment(model.find_segment(name).unwrap())
}

fn assert_near(found: Vec3, expected: Vec3, what: &str) {
    assert!((found - expected).norm() < 1e-12, "{what}: {found:?} is not {expected:?}");
}

/// D is where the formula says, at angles that tell the joints apart.
fn assert_arm(model: &Model, what: &str) {
    let (sh, el) = (0.3, 0.7);
    let marker = model.markers().iter().find(|m| m.name == "D").unwrap_or_else(|| panic!("{what}"));
    let name = &model.segment(marker.segment.unwrap()).name;
    let found = body(model, name, &[("sh_flex", sh), ("el_flex", el)]) * marker.point;
    let turn = |angle: f64| Affine::from_rotation(Mat3::rotation_z(angle));
    let slide = |y: f64| Affine::from_translation(Vec3::new(0.0, y, 0.0));
    let forearm = slide(1.4) * turn(sh) * slide(-0.3) * turn(el);
    assert_near(found, forearm * Vec3::new(0.03, -0.25, 0.0), what);
}

#[test]
fn parts_are_found_wherever_they_stand() {
    let up = D.replace("/bodyset/lower", "..");
    let nested = format!(
        r#"<PhysicalOffsetFrame name="f"><components>{}</components><socket_parent>..</socket_parent>
        <translation>0.01 0 0</translation></PhysicalOffsetFrame>"#,
        up.replace("0.03 ", "0.02 ")
    );
    let both = format!("{SH}{EL}");
    let moved = EL.replace("/bodyset/lower", "..");
    for (what, text) in [
        ("in their sets", arm("", "", "", &(joints(&both) + &markers(D)))),
        ("joint of the model", arm(EL, "", "", &(joints(SH) + &markers(D)))),
        ("joint of a body", arm("", "", EL, &(joints(SH) + &markers(D)))),
        ("joint of its own body", arm("", "", &moved, &(joints(SH) + &markers(D)))),
        ("marker of the model", arm(D, "", "", &joints(&both))),
        ("marker of its body", arm("", "", &up, &joints(&both))),
        ("marker of a frame", arm("", "", &nested, &joints(&both))),
        ("everything of the model", arm(&format!("{D}{EL}{SH}"), "", "", "")),
        ("everything of a body", arm("", &format!("{both}{D}"), "", "")),
    ] {
        assert_arm(&without_warnings(&text), what);
    }
}

#[test]
fn constraints_are_found_among_components() {
    let coupler = "<CoordinateCouplerConstraint name='c'><coupled_coordinates_function>\
        <LinearFunction><coefficients>2 0.1</coefficients></LinearFunction>\
        </coupled_coordinates_function><independent_coordinate_names>sh_flex\
        </independent_coordinate_names><dependent_coordinate_name>el_flex\
        </dependent_coordinate_name></CoordinateCouplerConstraint>";
    let point = "<PointConstraint name='p'><socket_body_1>/bodyset/lower</socket_body_1>\
        <socket_body_2>/ground</socket_body_2></PointConstraint>";
    let both = joints(&format!("{SH}{EL}"));
    let constraints = format!("{coupler}{point}");
    for text in [arm(&constraints, "", "", &both), arm("", &constraints, "", &both)] {
        let model = without_warnings(&text);
        assert_eq!(model.closures().len(), 1);
        let turned = body(&model, "lower", &[("sh_flex", 0.3)]);
        let expected = Mat3::rotation_z(0.3 + 2.0 * 0.3 + 0.1);
        assert_near(turned * Vec3::X - turned * Vec3::ZERO, expected * Vec3::X, "coupled");
    }
}

#[test]
fn defaults_are_no_parts() {
    let defaults = format!("<defaults><Body name='default'/>{EL}{D}<WeldConstraint/></defaults>");
    let sets = defaults + &joints(&format!("{SH}{EL}")) + &markers(D);
    let model = without_warnings(&arm("", "", "", &sets));
    assert_eq!((model.segments().len(), model.markers().len()), (2, 1));
    assert_arm(&model, "beside defaults");
}

#[test]
fn frames_are_defined_by_stations_and_by_markers() {
    let points = |class: &str, frame: &str| {
        let point = |name: &str, place: &str| {
            format!(
                "<{class} name='{name}'><socket_parent_frame>{frame}</socket_parent_frame>\
                 <location>{place}</location></{class}>"
            )
        };
        point("P", "0 -0.3 0") + &point("Q", "0 0 0") + &point("R", "0.1 -0.3 0")
    };
    // The axes are those of the upper arm, with the elbow as origin.
    let frame = |base: &str| {
        format!(
            "<StationDefinedFrame name='elbow'><socket_point_a>{base}P</socket_point_a>\
             <socket_point_b>{base}R</socket_point_b><socket_point_c>{base}Q</socket_point_c>\
             <socket_origin_point>{base}P</socket_origin_point><ab_axis>+x</ab_axis>\
             <ab_x_ac_axis>+z</ab_x_ac_axis></StationDefinedFrame>"
        )
    };
    let elbow = EL.replace(">el_p<", ">/bodyset/upper/elbow<");
    let rest = joints(&format!("{SH}{elbow}"));
    for class in ["Station", "Marker"] {
        for base in ["/bodyset/upper/", "../", ""] {
            let upper = points(class, "..") + &frame(base);
            let model = without_warnings(&arm("", &upper, "", &(rest.clone() + &markers(D))));
            assert_arm(&model, &format!("{class} {base}"));
        }
    }
    let set = markers(&(points("Marker", "/bodyset/upper") + D));
    let model = without_warnings(&arm("", &frame("/markerset/"), "", &(rest + &set)));
    assert_arm(&model, "markers of the set");
}

/// A joint as versions 3.05.00 to 3.05.04 wrote it, with its frames by name and its ends in numbers.
fn connected(name: &str, ends: [&str; 2], numbers: [&str; 4], plain: bool) -> String {
    let connector = |socket: &str, end: &str| match plain {
        true => format!("<{socket}>{end}</{socket}>"),
        false => format!(
            "<Connector_PhysicalFrame_ name='{socket}'><connectee_name>{end}</connectee_name>\
             </Connector_PhysicalFrame_>"
        ),
    };
    let list = connector("parent_body", ends[0]) + &connector("child_body", ends[1]);
    let list = if plain { list } else { format!("<connectors>{list}</connectors>") };
    let [place, turn, place_in_child, turn_in_child] = numbers;
    format!(
        "<PinJoint name='{name}'>{list}<location_in_parent>{place}</location_in_parent>\
         <orientation_in_parent>{turn}</orientation_in_parent>\
         <location_in_child>{place_in_child}</location_in_child>\
         <orientation_in_child>{turn_in_child}</orientation_in_child><CoordinateSet><objects>\
         <Coordinate name='{name}_flex'/></objects></CoordinateSet></PinJoint>"
    )
}

#[test]
fn joints_of_version_3_05_have_connectors_and_ends_in_numbers() {
    let numbers = [
        ["0 1.4 0", "0.1 -0.2 0.3", "0.01 0.02 -0.03", "0.3 0.2 0.1"],
        ["0 -0.3 0.01", "-0.4 0.1 0", "0 0.05 0", "0 0 0.2"],
    ];
    // The forearm in ground as OpenSim 4.6 has it, at sh_flex = 0.3 and el_flex = 0.7.
    let expected = [
        [0.6932286793178064, -0.5198512420865841, -0.4991880249688745, 0.1075040992183096],
        [0.720587973404469, 0.5130742710414333, 0.466377277512683, 1.0857627585842746],
        [0.013673725027590317, -0.683014991414052, 0.7302763523129668, 0.1532113087961829],
    ];
    for plain in [false, true] {
        let joints = joints(&format!(
            "{}{}",
            connected("sh", ["ground", "upper"], numbers[0], plain),
            connected("el", ["upper", "lower"], numbers[1], plain)
        ));
        let text = arm("", "", "", &joints).replace("40000", "30501");
        let model = without_warnings(&text);
        let found = body(&model, "lower", &[("sh_flex", 0.3), ("el_flex", 0.7)]).to_rows();
        for (a, b) in found.iter().zip(expected.as_flattened()) {
            assert!((a - b).abs() < 1e-12, "{found:?}");
        }
    }
}

#[test]
fn ends_in_numbers_of_a_new_joint_are_told() {
    let el =
        EL.replace("<coordinates>", "<location_in_parent>0 1 0</location_in_parent><coordinates>");
    let text = arm("", "", "", &(joints(&format!("{SH}{el}")) + &markers(D)));
    let read = read(text.as_bytes()).unwrap();
    assert!(read.warned("osim/unused-property"), "{:?}", read.warnings);
    assert_arm(&read.value, "the frames count");
}

/// An arm of version 1.9 whose elbow slides by a function and turns.
fn old(function: &str, axis: &str, factors: &str, version: u32) -> String {
    format!(
        r#"<OpenSimDocument Version="{version}"><Model name="old"><BodySet><objects>
        <Body name="ground"/><Body name="bone"><Joint><CustomJoint name="j">
        <parent_body>ground</parent_body><CoordinateSet><objects><Coordinate name="q"/>
        </objects></CoordinateSet><TransformAxisSet><objects><TransformAxis name="t">
        {function}<coordinate>q</coordinate><is_rotation>false</is_rotation><axis>{axis}</axis>
        </TransformAxis><TransformAxis name="r"><function/><coordinate>q</coordinate>
        <is_rotation>true</is_rotation><axis>0 0 1</axis></TransformAxis></objects>
        </TransformAxisSet><scale_factors>{factors}</scale_factors></CustomJoint></Joint></Body>
        </objects></BodySet></Model></OpenSimDocument>"#
    )
}

#[test]
fn scale_factors_of_version_1_9_stretch_the_functions() {
    let constant = "<function><Constant><value>-0.25</value></Constant></function>";
    let spline = "<function><natCubicSpline><x>-2 -1 0 1 2</x><y>-0.25 -0.25 -0.25 -0.25 -0.25</y>\
                  </natCubicSpline></function>";
    let multiple = "<function><MultiplierFunction><scale>0.5</scale><function><Constant>\
                    <value>-0.5</value></Constant></function></MultiplierFunction></function>";
    // The translation f·a is stretched in each direction: (s₁ f a₁, s₂ f a₂, s₃ f a₃).
    for (function, axis, value) in [
        (constant, "0 1 0", Vec3::new(0.0, -0.25, 0.0)),
        (spline, "0 1 0", Vec3::new(0.0, -0.25, 0.0)),
        (multiple, "0 1 0", Vec3::new(0.0, -0.25, 0.0)),
        (spline, "0 -1 0", Vec3::new(0.0, 0.25, 0.0)),
        (spline, "0.6 0 0.8", Vec3::new(-0.15, 0.0, -0.2)),
        ("<function/>", "0 1 0", Vec3::new(0.0, 0.4, 0.0)),
    ] {
        let model = without_warnings(&old(function, axis, "1.1 1.2 0.5", 10900));
        let found = body(&model, "bone", &[("q", 0.4)]) * Vec3::ZERO;
        // What the coordinate slides by itself is in metres.
        let scale = if function.len() > 12 { [1.1, 1.2, 0.5] } else { [1.0; 3] };
        let expected = Vec3::new(value.x * scale[0], value.y * scale[1], value.z * scale[2]);
        assert_near(found, expected, function);
    }
    let read = read(old(spline, "0 1 0", "1.1 1.2 0.5", 20303).as_bytes()).unwrap();
    assert!(read.warned("osim/unused-property"), "{:?}", read.warnings);
}

#[test]
fn a_constant_prescription_is_the_value_of_its_coordinate() {
    let prescribed = |function: &str| {
        let inside = format!(
            "<Coordinate name='el_flex'><default_value>0.1</default_value><prescribed>true\
             </prescribed><prescribed_function>{function}</prescribed_function></Coordinate>"
        );
        let el = EL.replace("<Coordinate name=\"el_flex\"/>", &inside);
        read(arm("", "", "", &joints(&format!("{SH}{el}"))).as_bytes()).unwrap()
    };
    let constant = prescribed("<Constant><value>0.7</value></Constant>");
    assert!(constant.warnings.is_empty(), "{:?}", constant.warnings);
    let coordinate =
        |model: &Model| model.coordinate(model.find_coordinate("el_flex").unwrap()).clone();
    let found = coordinate(&constant.value);
    assert_eq!((found.default[0], found.locked), (0.7, true));
    for varying in
        ["<GCVSpline/>", "<LinearFunction><coefficients>1 0</coefficients></LinearFunction>"]
    {
        let varying = prescribed(varying);
        assert!(varying.warned("osim/prescribed"));
        let found = coordinate(&varying.value);
        assert_eq!((found.default[0], found.locked), (0.1, true));
    }
}

#[test]
fn what_is_not_used_is_told_once_for_each_class() {
    let ghosts: String = (1..=7).map(|i| format!("<Coordinate name='g{i}'/>")).collect();
    let el = EL.replace("</coordinates>", &format!("{ghosts}</coordinates>"));
    let rolling = "<RollingOnSurfaceConstraint name='r1'/><RollingOnSurfaceConstraint name='r2'/>\
                   <PointOnLineConstraint/>";
    let sets = joints(&format!("{SH}{el}")) + &markers(D);
    let read = read(arm("", rolling, "", &sets).as_bytes()).unwrap();
    let said: Vec<(&str, &str)> =
        read.warnings.iter().map(|w| (w.code, w.message.as_str())).collect();
    assert_eq!(
        said,
        [
            ("osim/unknown-constraint", "1 <PointOnLineConstraint> ignored"),
            ("osim/unknown-constraint", "2 <RollingOnSurfaceConstraint> ignored: `r1`, `r2`"),
            ("osim/unused", "7 <Coordinate> not used: `g1`, `g2`, `g3`, `g4`, `g5`, …"),
        ]
    );
    assert_arm(&read.value, "with ghosts");
}

fn with_files(
    text: &str,
    give: &mut dyn FnMut(&str) -> Result<String, String>,
) -> Result<(Model, Vec<Diagnostic>), String> {
    let format = Format::of_ending("osim").unwrap();
    let read = format.read(text.as_bytes(), give).map_err(|error| error.to_string())?;
    match read.value {
        Content::Model(model) => Ok((model, read.warnings)),
        other => panic!("{other:?}"),
    }
}

#[test]
fn sets_in_files_of_their_own_are_read() {
    let both = format!("{SH}{EL}");
    let sets = "<JointSet file='j.xml'/><MarkerSet file=' sub/m.xml '/><ForceSet file='f.xml'/>";
    let text = arm("", "", "", sets);
    let mut asked = vec![];
    let (model, warnings) = with_files(&text, &mut |name| {
        asked.push(name.to_owned());
        Ok(match name {
            "j.xml" => {
                format!("<OpenSimDocument Version='40000'>{}</OpenSimDocument>", joints(&both))
            }
            _ => markers(D),
        })
    })
    .unwrap();
    assert_eq!((asked, warnings), (vec!["j.xml".to_owned(), "sub/m.xml".to_owned()], vec![]));
    assert_arm(&model, "of files");
    // Without its markers a model still moves; without its joints it does not.
    let lost = |name: &str| match name {
        "j.xml" => Ok(joints(&both)),
        _ => Err("no such file".to_owned()),
    };
    let (model, warnings) = with_files(&text, &mut |name| lost(name)).unwrap();
    assert!(model.markers().is_empty());
    assert_eq!((warnings[0].code, warnings[0].severity), ("osim/include", Severity::Warning));
    assert!(warnings[0].message.contains("`sub/m.xml`: no such file"), "{warnings:?}");
    let error = with_files(&text, &mut |_| Err("no such file".to_owned())).unwrap_err();
    assert!(error.contains("<JointSet> is in the file `j.xml`: no such file"), "{error}");
    let error = with_files(&text, &mut |_| Ok("<a/>".to_owned())).unwrap_err();
    assert!(error.contains("the file `j.xml` holds no <JointSet>"), "{error}");
    let error = with_files(&text, &mut |_| Ok("<a>".to_owned())).unwrap_err();
    assert!(error.contains("in `j.xml`:"), "{error}");
    // Bytes alone have no files beside them.
    assert!(
        read(arm("", "", "", "<MarkerSet file='m.xml'/>").as_bytes())
            .unwrap()
            .warned("osim/include")
    );
}

#[test]
fn a_subject_of_version_1_9_is_that_of_version_3() {
    // OpenSim 3 multiplied the functions of the same subject's knee when it read version 1.9.
    let data = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data");
    let old = data.join("models/osim/subject01_simbody_v10900.osim");
    let new = data.join("ik/core_subject01/subject01_simbody.osim");
    let (Ok(old), Ok(new)) = (std::fs::read(old), std::fs::read(new)) else {
        println!("skipped: shared data absent");
        return;
    };
    let [old, new] = [old, new].map(|bytes| read(&bytes).unwrap().value);
    for angle in [-2.0, -1.0, -0.3, 0.0] {
        let knee = |model: &Model| {
            let pose = [("knee_angle_r", angle)];
            body(model, "femur_r", &pose).rigid_inverse() * body(model, "tibia_r", &pose)
        };
        let (found, expected) = (knee(&old) * Vec3::ZERO, knee(&new) * Vec3::ZERO);
        assert!((found - expected).norm() < 1e-6, "{angle}: {found:?} is not {expected:?}");
    }
}

#[test]
fn a_scaled_orientation_is_left_alone() {
    // Scale factors stretch places, not angles.
    let model = without_warnings(&old("<function/>", "0 1 0", "2 2 2", 10900));
    let found = body(&model, "bone", &[("q", 0.4)]);
    let expected = EulerOrder::XYZ.to_mat3([0.0, 0.0, 0.4]) * Vec3::X;
    assert_near(found * Vec3::X - found * Vec3::ZERO, expected, "turned");
}
