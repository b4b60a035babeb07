//! What documents mean.

use super::{pose, read, try_read};
use condyle_formats::document;
use condyle_math::{Affine, EulerOrder, Vec3};
use condyle_model::CoordinateKind;

const HEAD: &str = "condyle = 1\nkind = \"model\"\n";

#[test]
fn angles_are_in_the_unit_of_their_text() {
    let text = format!(
        "{HEAD}angles = \"deg\"\ninclude = [\"part.toml\"]\nconstants = {{ most = 90 }}\n\
         [segment.a]\nturn = [90, 0, 0]\n\
         [joint.a]\ntype = \"hinge\"\nsegment = \"a\"\naxis = [0, 0, 2]\n\
         coordinate.angle = {{ range = [\"-$most\", \"none\"], default = 30, locked = true }}\n"
    );
    let part = format!("{HEAD}[joint_set.b.coordinate.q]\nrange = [-1, 1]\nenforced = false\n");
    let mut include =
        |name: &str| (name == "part.toml").then(|| part.clone()).ok_or_else(String::new);
    let model = document::read(&text, &mut include).unwrap().value.model;
    let angle = model.coordinate(model.find_coordinate("angle").unwrap());
    assert_eq!(angle.range.lower, Some(-90f64.to_radians()));
    assert_eq!((angle.range.upper, angle.range.enforced, angle.locked), (None, true, true));
    assert!((angle.default[0] - 30f64.to_radians()).abs() < 1e-16);
    let other = model.coordinate(model.find_coordinate("q").unwrap());
    assert_eq!((other.range.upper, other.range.enforced), (Some(1.0), false));
    // Rx(90°)·Rz(0.5): the child's y axis goes to (-sin 0.5, 0, cos 0.5).
    let stored: Vec<f64> =
        model.coordinates().iter().map(|c| if c.name == "angle" { 0.5 } else { 0.0 }).collect();
    let t = pose(&model, &stored)[0];
    let y = [t[1], t[5], t[9]];
    let expected = [-0.5f64.sin(), 0.0, 0.5f64.cos()];
    assert!(y.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-15), "{y:?}");
}

#[test]
fn every_plain_joint_is_what_it_says() {
    // Type and keys, the coordinates in order, and the transform at the values given.
    let (x, y, z) = (Vec3::X, Vec3::Y, Vec3::Z);
    let turn = |order: &str, a: [f64; 3]| {
        Affine::from_rotation(order.parse::<EulerOrder>().unwrap().to_mat3(a))
    };
    let slide = |v: Vec3| Affine::from_translation(v);
    let cases: Vec<(&str, Vec<f64>, Affine)> = vec![
        ("type = \"weld\"", vec![], Affine::IDENTITY),
        ("type = \"hinge\"\naxis = [0, 1, 0]", vec![0.3], turn("yxz", [0.3, 0.0, 0.0])),
        (
            "type = \"universal\"\naxes = [[1, 0, 0], [0, 1, 0]]",
            vec![0.3, 0.4],
            turn("xyz", [0.3, 0.4, 0.0]),
        ),
        ("type = \"euler\"\norder = \"zxz\"", vec![0.3, 0.4, 0.5], turn("zxz", [0.3, 0.4, 0.5])),
        (
            "type = \"euler\"\naxes = [[0, 0, 1], [1, 0, 0], [0, 1, 0]]",
            vec![0.3, 0.4, 0.5],
            turn("zxy", [0.3, 0.4, 0.5]),
        ),
        (
            "type = \"ball\"",
            vec![0.0, 0.0, 0.25f64.sin(), 0.25f64.cos()],
            turn("zxy", [0.5, 0.0, 0.0]),
        ),
        ("type = \"prismatic\"\naxis = [0, 0, 1]", vec![0.2], slide(z * 0.2)),
        (
            "type = \"prismatic\"\naxes = [[0, 1, 0], [1, 0, 0]]",
            vec![0.2, 0.3],
            slide(y * 0.2 + x * 0.3),
        ),
        (
            "type = \"planar\"",
            vec![0.2, 0.3, 0.4],
            slide(x * 0.2 + y * 0.3) * turn("zxy", [0.4, 0.0, 0.0]),
        ),
        (
            "type = \"free\"\norder = \"yzx\"",
            vec![0.1, 0.2, 0.3, 0.4, 0.5, 0.6],
            slide(Vec3::new(0.1, 0.2, 0.3)) * turn("yzx", [0.4, 0.5, 0.6]),
        ),
    ];
    for (keys, stored, expected) in cases {
        let model = read(&format!("{HEAD}[segment.s]\n[joint.j]\nsegment = \"s\"\n{keys}\n"));
        assert_eq!(model.stored_len(), stored.len(), "{keys}");
        let found = pose(&model, &stored)[0];
        let near = found.iter().zip(expected.to_rows()).all(|(a, b)| (a - b).abs() < 1e-15);
        assert!(near, "{keys}: {found:?}");
        let kinds = model.coordinates().iter().filter(|c| c.kind == CoordinateKind::Translation);
        assert_eq!(
            kinds.count(),
            keys.matches("prismatic")
                .count()
                .max(if keys.contains("planar") {
                    2
                } else if keys.contains("free") {
                    3
                } else {
                    0
                },)
                .max(if keys.contains("axes = [[0, 1, 0], [1") { 2 } else { 0 }),
            "{keys}"
        );
    }
}

#[test]
fn functions_are_in_the_units_they_name() {
    let text = format!(
        "{HEAD}[segment.s]\n[joint_set.j.coordinate.q]\n\
         [joint_set.j.component.glide.map]\ninput = \"q\"\nin = \"deg\"\nout = \"mm\"\n\
         functions = [{{ spline = [[0, 0], [30, 5], [60, 8], [90, 9]] }}, \
         {{ polynomial = [1, 2, 3] }}, {{ linear = [0.5, 4] }}, {{ lines = [[0, 0], [90, 90]] }}]\n\
         [joint_set.j.component.x.translate]\ndistance = \"glide\"\naxis = [1, 0, 0]\n\
         [joint_set.j.component.y.translate]\ndistance = \"glide.2\"\naxis = [0, 1, 0]\n\
         [joint_set.j.component.z.translate]\ndistance = \"j.glide.3\"\naxis = [0, 0, 1]\n\
         [joint_set.j.component.w.translate]\ndistance = \"glide.4\"\naxis = [0, 0, 1]\n\
         [joint_set.j.output]\ns = [\"x\", \"y\", \"z\", \"w\"]\n"
    );
    let t = pose(&read(&text), &[30f64.to_radians()])[0];
    let expected = [5.0, 1.0 + 60.0 + 2700.0, 15.0 + 4.0 + 30.0];
    for (found, expected) in [t[3], t[7], t[11]].into_iter().zip(expected) {
        assert!((1e3 * found - expected).abs() < 1e-9, "{found} and {expected}");
    }
}

#[test]
fn components_may_stand_in_any_order() {
    let text = format!(
        "{HEAD}[segment.s]\n[joint_set.j.output]\ns = \"all\"\n\
         [joint_set.j.component.all.product]\nfactors = [\"turn\", \"turn\"]\n\
         [joint_set.j.component.turn.rotate]\nangle = \"q\"\naxis = [0, 0, 1]\n\
         [joint_set.j.coordinate.q]\n"
    );
    let t = pose(&read(&text), &[0.4])[0];
    assert!((t[0] - 0.8f64.cos()).abs() < 1e-15);
}

#[test]
fn warnings_have_places() {
    let text = format!("{HEAD}[joint_set.j.coordinate.q]\ndefault = 3\nrange = [0, 1]\n");
    let warnings = try_read(&text).unwrap().warnings;
    assert!(
        warnings[0].to_string().starts_with("line 3, column 25: the default 3"),
        "{warnings:?}"
    );
}

#[test]
fn each_number_is_in_the_unit_of_the_text_that_has_it() {
    // A skeleton in radians whose ranges are not kept, and a document in degrees that adds to it.
    let part = format!(
        "{HEAD}[segment.hand]\n[joint_set.wrist.coordinate.turn]\nrange = [-3, 0]\ndefault = -0.5\n\
         typical = [-2, -1]\nrest = -0.25\nstiffness = 1e-5\nenforced = false\n\
         [joint_set.wrist.coordinate.bend]\nrange = [-1, 1]\nenforced = false\n\
         [joint_set.wrist.coordinate.tilt]\nrange = [-1, 1]\nenforced = false\n\
         [posture.both]\nsum = {{ turn = 1, bend = 1 }}\nrest = 0.5\nstiffness = 1e-5\n"
    );
    let text = format!(
        "{HEAD}angles = \"deg\"\ninclude = [\"part.toml\"]\n\
         [joint_set.wrist.coordinate.turn]\nlocked = true\n\
         [joint_set.wrist.coordinate.bend]\nrange = [-90, 60]\n\
         [joint_set.wrist.coordinate.tilt]\nenforced = true\n[posture.both]\nstiffness = 2e-5\n"
    );
    let model = document::read(&text, &mut |_| Ok(part.clone())).unwrap().value.model;
    let of = |name: &str| model.coordinate(model.find_coordinate(name).unwrap());
    let turn = of("turn");
    assert_eq!(
        (turn.range.lower, turn.range.upper, turn.range.enforced),
        (Some(-3.0), Some(0.0), false)
    );
    assert_eq!((turn.default[0], turn.typical, turn.locked), (-0.5, Some([-2.0, -1.0]), true));
    // The range of the document is kept, as those of all documents are; the skeleton's own are not unless it is said.
    let bend = of("bend");
    assert!((bend.range.lower.unwrap() + std::f64::consts::FRAC_PI_2).abs() < 1e-15);
    assert!(bend.range.enforced);
    assert_eq!((of("tilt").range.lower, of("tilt").range.enforced), (Some(-1.0), true));
    let rests: Vec<f64> = model.postures().iter().map(|posture| posture.rest).collect();
    assert!(rests.contains(&0.5) && rests.contains(&-0.25), "{rests:?}");
}
