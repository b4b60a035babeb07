//! Skeletons of the course CSE 169: the format's rules by hand, DART's files, and damage.

use condyle_formats::skel;
use condyle_formats::skeleton::Assumed;
use condyle_math::{Mat3, Vec3};
use condyle_mesh::Form;
use condyle_model::{Mode, Pose, Program, Range};

const METRES: Assumed = Assumed { metres_per_unit: Some(1.0), up: None, rate: None };

const FIGURE: &str = "balljoint root {\n\toffset 0 1 0\n\tboxmin -0.2 -0.1 -0.1\n\tboxmax 0.2 0.3 0.1\n\
    \trotxlimit -100000 100000\n\tballjoint arm {\n\t\toffset 0.3 0.2 0\n\t\tboxmin 0 -0.05 -0.05\n\
    \t\tboxmax 0.4 0.05 0.05\n\t\tpose 0.1 0.2 0.3\n\t\tballjoint hand { offset 0.4 0 0 rotxlimit 0 0 \
    rotylimit 0 0 rotzlimit -1 0.5 pose 0.7 0 0.9 }\n\t}\n}\n";

#[test]
fn a_figure_by_hand() {
    let read = skel::read(FIGURE.as_bytes(), &METRES).unwrap();
    let model = read.value;
    let names: Vec<&str> = model.segments().iter().map(|s| s.name.as_str()).collect();
    assert_eq!(names, ["root", "arm", "hand"]);
    let coordinate = |key: &str| {
        let id = model.coordinate_ids().find(|id| model.coordinate_key(*id) == key);
        model.coordinate(id.unwrap_or_else(|| panic!("no {key}")))
    };
    assert_eq!(coordinate("root/rx").range, Range::FREE);
    assert_eq!(coordinate("hand/rz").range, Range::new(-1.0, 0.5));
    // Poses are brought into the limits: 0.9 to 0.5, and 0.7 to 0.
    assert_eq!(coordinate("hand/rz").default[0], 0.5);
    assert_eq!(coordinate("hand/rx").default[0], 0.0);
    assert_eq!(
        read.warnings.iter().map(|s| s.code).collect::<Vec<_>>(),
        ["skel/pose", "skel/pose"]
    );
    // x, then y, then z about fixed axes: Rz·Ry·Rx for columns.
    let program = Program::compile(&model);
    let mut pose = Pose::new(&program);
    program.evaluate(&model.defaults(), Mode::Open, &mut pose).unwrap();
    let arm = Mat3::rotation_z(0.3) * Mat3::rotation_y(0.2) * Mat3::rotation_x(0.1);
    let shoulder = Vec3::new(0.3, 1.2, 0.0);
    let hand = pose.segment(model.find_segment("hand").unwrap());
    assert!((hand.translation - (shoulder + arm * Vec3::new(0.4, 0.0, 0.0))).norm() < 1e-15);
    assert!((hand.linear.x - arm * Mat3::rotation_z(0.5).x).norm() < 1e-15);
    // Boxes are shapes; the hand has the usual one, of 0.2 on each side.
    let sizes: Vec<[f64; 3]> = model
        .shapes()
        .iter()
        .map(|shape| match &shape.form {
            Form::Block(block) => block.size.to_array().map(|side| (side * 1e9).round() / 1e9),
            other => panic!("{other:?}"),
        })
        .collect();
    assert_eq!(sizes, [[0.4, 0.4, 0.2], [0.4, 0.1, 0.1], [0.2, 0.2, 0.2]]);
}

#[test]
fn darts_files_are_refused_with_the_reason() {
    let xml = "<?xml version=\"1.0\" ?>\n<skel version=\"1.0\">\n<world/></skel>\n";
    let old = "dofs {\n\tpelvis_trans_x { 0.0000, -100.0000, 100.0000 }\n}\n";
    for (text, form) in [(xml, "in XML"), (old, "in its old text")] {
        let error = skel::read(text.as_bytes(), &METRES).unwrap_err();
        assert_eq!(error.code(), "skel/dart");
        assert!(error.to_string().contains(form), "{error}");
    }
}

#[test]
fn damage_is_said_with_its_place() {
    for (text, code, line) in [
        ("", "skel/empty", 1),
        ("offset 0 0 0", "skel/grammar", 1),
        ("balljoint a\noffset 0 0 0\n", "skel/grammar", 1),
        ("balljoint a {\noffset 0 b 0\n}", "skel/number", 2),
        ("balljoint a {\nrotxlimit 0\n}", "skel/number", 3),
    ] {
        let error = skel::read(text.as_bytes(), &METRES).unwrap_err();
        assert_eq!(error.code(), code, "{text}");
        assert_eq!(error.place().map(|place| place.line), Some(line), "{text}");
    }
    for (text, code) in [
        ("balljoint a { offset 0 0 0", "skel/brace"),
        ("balljoint a { } }", "skel/brace"),
        ("balljoint a { colour 1 0 0 }", "skel/unknown"),
        ("balljoint a { rotxlimit 1 -1 }", "skel/limit"),
        ("balljoint a { balljoint a { } }", "skeleton/name"),
    ] {
        let read = skel::read(text.as_bytes(), &METRES).unwrap();
        assert!(read.warned(code), "{text}: {:?}", read.warnings);
    }
    let read = skel::read(FIGURE.as_bytes(), &Assumed::default()).unwrap();
    assert!(read.warned("skeleton/unit"));
    let deep = "balljoint a {".repeat(6000);
    assert_eq!(skel::read(deep.as_bytes(), &METRES).unwrap_err().code(), "skel/size");
}
