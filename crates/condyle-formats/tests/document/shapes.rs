//! Joints that change shape or follow one: what their few lines mean.

use super::{errors, pose, read};
use condyle_math::{Affine, Mat3, Vec3};
use condyle_model::{CoordinateKind, Model};
use std::f64::consts::TAU;

const HEAD: &str = "condyle = 1\nkind = \"model\"\n";

fn joint(keys: &str) -> Model {
    read(&format!("{HEAD}[segment.s]\n[joint.j]\nsegment = \"s\"\n{keys}\n"))
}

fn linear(m: Mat3) -> Affine {
    Affine::new(m, Vec3::ZERO)
}

fn diagonal(x: f64, y: f64, z: f64) -> Affine {
    linear(Mat3::from_columns(Vec3::X * x, Vec3::Y * y, Vec3::Z * z))
}

#[test]
fn every_joint_that_is_no_plain_one_is_what_it_says() {
    use CoordinateKind::{Orientation, Other, Rotation, Scale, Translation};
    let (s, c) = 0.3f64.sin_cos();
    let about_y = Mat3::rotation_y(0.3);
    let turned = |m: Mat3, p: Vec3| Affine::new(m, p);
    let straight = "path = [[[0, 0.1], [1, 0.3], [2, 0.5]], [[0, 0], [2, 0.8]], [[0, 0], [2, 0]]]";
    let slid = format!("type = \"curve\"\n{straight}");
    let steered = format!("type = \"curve\"\nforward = [1, 0, 0]\nup = [0, 0, 1]\n{straight}");
    // n = Rx(a)·Ry(b)·z, whatever the turn about z; p = r∘r∘n/|r∘n| on the surface.
    let (a, b, r) = (0.4f64, -0.3f64, Vec3::new(0.07, 0.15, 0.09));
    let n = Mat3::rotation_x(a) * Mat3::rotation_y(b) * Vec3::Z;
    let rn = r.times(n);
    let frame = Mat3::rotation_x(a) * Mat3::rotation_y(b) * Mat3::rotation_z(0.2);
    let cases: Vec<(&str, Vec<CoordinateKind>, Vec<f64>, Affine)> = vec![
        (
            "type = \"screw\"\naxis = [0, 2, 0]\npitch = 0.01",
            vec![Rotation],
            vec![0.3],
            turned(about_y, Vec3::Y * (0.01 * 0.3 / TAU)),
        ),
        ("type = \"scale\"", vec![Scale], vec![1.5], diagonal(1.5, 1.5, 1.5)),
        ("type = \"scale\"\naxis = [0, 3, 0]", vec![Scale], vec![1.5], diagonal(1.0, 1.5, 1.0)),
        (
            "type = \"scale\"\naxis = [0, 0, 1]\nvolume = true",
            vec![Scale],
            vec![4.0],
            diagonal(0.5, 0.5, 4.0),
        ),
        (
            "type = \"scale\"\naxes = [[1, 0, 0], [0, 0, 1]]",
            vec![Scale; 2],
            vec![0.5, 3.0],
            diagonal(0.5, 1.0, 3.0),
        ),
        (
            "type = \"shear\"\nalong = [1, 0, 0]\nacross = [0, 2, 0]",
            vec![Other],
            vec![0.7],
            linear(Mat3::from_columns(Vec3::X, Vec3::new(0.7, 1.0, 0.0), Vec3::Z)),
        ),
        (&slid, vec![Other], vec![1.5], Affine::from_translation(Vec3::new(0.4, 0.6, 0.0))),
        (
            // The tangent (0.2, 0.4, 0) takes the place of x, z stays up.
            &steered,
            vec![Other],
            vec![0.5],
            turned(Mat3::rotation_z(2f64.atan()), Vec3::new(0.2, 0.2, 0.0)),
        ),
        (
            "type = \"ellipsoid\"\nradii = [0.07, 0.15, 0.09]",
            vec![Rotation; 3],
            vec![a, b, 0.2],
            turned(frame, rn),
        ),
        (
            "type = \"ellipsoid\"\nradii = [0.07, 0.15, 0.09]\nsurface_axis = \"normal\"",
            vec![Rotation; 3],
            vec![a, b, 0.2],
            turned(frame, r.times(rn) * (1.0 / rn.norm())),
        ),
        (
            "type = \"free\"\nball = true",
            vec![Translation, Translation, Translation, Orientation],
            vec![0.1, 0.2, 0.3, 0.0, 0.15f64.sin(), 0.0, 0.15f64.cos()],
            turned(
                Mat3::from_columns(Vec3::new(c, 0.0, -s), Vec3::Y, Vec3::new(s, 0.0, c)),
                Vec3::new(0.1, 0.2, 0.3),
            ),
        ),
    ];
    for (keys, kinds, stored, expected) in cases {
        let model = joint(keys);
        let found: Vec<CoordinateKind> = model.coordinates().iter().map(|c| c.kind).collect();
        assert_eq!(found, kinds, "{keys}");
        assert!(model.coordinates().iter().all(|c| c.default == c.kind.neutral()), "{keys}");
        let found = pose(&model, &stored)[0];
        let near = found.iter().zip(expected.to_rows()).all(|(a, b)| (a - b).abs() < 1e-15);
        assert!(near, "{keys}: {found:?} and {:?}", expected.to_rows());
    }
}

#[test]
fn joints_have_names_and_units_of_their_own() {
    let model = joint(
        "type = \"screw\"\naxis = [0, 1, 0]\npitch = 0.002\ncoordinates = [\"turns.of it\"]\n\
         coordinate.\"turns.of it\" = { range = [0, 360], unit = \"deg\" }",
    );
    assert_eq!(model.coordinates()[0].range.upper, Some(360f64.to_radians()));
    assert!((pose(&model, &[TAU])[0][7] - 0.002).abs() < 1e-18);
    let model = joint("type = \"scale\"\ncoordinate.factor = { default = 1.2, range = [0.5, 2] }");
    assert_eq!(model.defaults(), [1.2]);
    // Radians of the parameter, degrees of its path.
    let path = "path = [[[0, 0], [90, 0.9]], [[0, 0], [90, 0]], [[0, 0], [90, 0]]]";
    let model = joint(&format!("type = \"curve\"\nin = \"deg\"\n{path}"));
    assert!((pose(&model, &[30f64.to_radians()])[0][3] - 0.3).abs() < 1e-15);
}

#[test]
fn a_law_gets_its_parameters_as_they_are() {
    // The law of the random models: about z by the first input, up by lift·(1 - cos), along the
    // turned x stretched by 1 + 0.2·sin of the second.
    let text = format!(
        "{HEAD}angles = \"deg\"\n[segment.s]\n[joint_set.j.coordinate.q]\n\
         [joint_set.j.coordinate.w]\n[joint_set.j.component.cam.custom]\nlaw = \"cam\"\n\
         inputs = [\"q\", \"w\"]\nparameters = {{ lift = 0.03, unused = [1, 2] }}\n\
         [joint_set.j.output]\ns = \"cam\"\n"
    );
    let t = pose(&read(&text), &[0.4, 0.9])[0];
    let stretch = 1.0 + 0.2 * 0.9f64.sin();
    let expected = [0.4f64.cos() * stretch, 0.4f64.sin() * stretch, 0.03 * (1.0 - 0.4f64.cos())];
    for (found, expected) in [t[0], t[4], t[7]].into_iter().zip(expected) {
        assert!((found - expected).abs() < 1e-15, "{found} and {expected}");
    }
}

#[test]
fn keys_of_other_joints_are_refused() {
    let found = errors(
        "[segment.s]\n[joint.a]\ntype = \"scale\"\nsegment = \"s\"\naxes = [[1, 0, 0]]\nvolume = \
         true\n\
         pitch = 1\n[joint.b]\ntype = \"curve\"\nsegment = \"s\"\nforward = [1, 0, 0]\n\
         [joint.c]\ntype = \"scale\"\nsegment = \"s\"\nvolume = true\n\
         [joint.d]\ntype = \"ellipsoid\"\nsegment = \"s\"\nsurface_axis = \"norml\"\n\
         [joint_set.e.coordinate.f]\nkind = \"scale\"\nunit = \"mm\"\n",
    );
    assert_eq!(
        found,
        [
            "line 8, column 10: `axes` excludes `axis` and `volume` (give `axes`; or one `axis`, \
             with or without \
             `volume`)",
            "line 9, column 1: a scale joint has no `pitch` (omit it)",
            "line 10, column 8: [joint.b] has no `path` (give three lists of [parameter, place]: \
             for \
             x, y and z)",
            "line 13, column 11: `forward` is given without `up` (give both: the axis along the \
             curve and the axis that stays up; or neither, for no turn)",
            "line 14, column 8: [joint.c] has no `axis` (give the axis of the stretch)",
            "line 18, column 8: [joint.d] has no `radii` (give three half axes in metres)",
            "line 21, column 16: unknown value `norml` of `surface_axis` (did you mean `normal`?)",
            "line 24, column 8: a coordinate of kind scale has no unit `mm` (omit it)",
        ]
    );
}
