//! Cones and contacts: what their documents mean.

use super::{errors, pose, pose_in, read};
use condyle_math::{Affine, Mat3, Vec3};
use condyle_model::Mode;
use std::f64::consts::FRAC_PI_4;

const HEAD: &str = "condyle = 1\nkind = \"model\"\nangles = \"deg\"\n";

/// Four corners at 45 degrees from x, in the planes of the other axes.
const POINTS: &str = "points = [{ direction = [1, 1, 0] }, { direction = [1, 0, 1] }, \
     { direction = [1, -1, 0] }, { direction = [1, 0, -1] }]\nsubdivisions = 0\nrest = [1, 0, 0]\n";

#[test]
fn three_angles_are_held_by_swing_and_twist() {
    let text = format!(
        "{HEAD}[segment.s]\n[joint_set.j.coordinate.a]\n[joint_set.j.coordinate.b]\n\
         [joint_set.j.coordinate.c]\n[joint_set.j.component.k.cone]\nangles = [\"a\", \"b\", \
         \"c\"]\n\
         order = \"zyx\"\ntwist = [-30, 20]\n{POINTS}\
         [joint_set.j.component.u.rotate]\nangle = \"k\"\naxis = [0, 0, 1]\n\
         [joint_set.j.component.v.rotate]\nangle = \"k.2\"\naxis = [0, 1, 0]\n\
         [joint_set.j.component.w.rotate]\nangle = \"k.3\"\naxis = [1, 0, 0]\n\
         [joint_set.j.output]\ns = [\"u\", \"v\", \"w\"]\n"
    );
    let model = read(&text);
    let same = |found: [f64; 16], expected: Mat3| {
        let expected = Affine::from_rotation(expected).to_rows();
        let near = found.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-12);
        assert!(near, "{found:?} and {expected:?}");
    };
    let (z, y, x) = (Mat3::rotation_z, Mat3::rotation_y, Mat3::rotation_x);
    // Inside all is kept; the turn about x alone is the twist; beyond a corner, the corner.
    same(pose_in(Mode::Posed, &model, &[0.3, 0.2, 0.1])[0], z(0.3) * y(0.2) * x(0.1));
    same(pose_in(Mode::Posed, &model, &[0.0, 0.0, 0.9])[0], x(20f64.to_radians()));
    same(pose_in(Mode::Posed, &model, &[0.0, 0.0, -0.9])[0], x(-30f64.to_radians()));
    same(pose_in(Mode::Posed, &model, &[1.2, 0.0, 0.0])[0], z(FRAC_PI_4));
    same(pose_in(Mode::Posed, &model, &[0.0, -1.2, 0.0])[0], y(-FRAC_PI_4));
    same(pose(&model, &[1.2, 0.1, 0.9])[0], z(1.2) * y(0.1) * x(0.9));
}

#[test]
fn two_angles_and_orientations_are_held_too() {
    let text = format!(
        "{HEAD}[segment.s]\n[segment.t]\n[joint_set.j.coordinate.a]\n[joint_set.j.coordinate.b]\n\
         [joint_set.j.coordinate.q]\nkind = \"orientation\"\n\
         [joint_set.j.component.k.cone]\nangles = [\"a\", \"b\"]\norder = \"zy\"\n{POINTS}\
         projection = \"toward_rest\"\n\
         [joint_set.j.component.u.rotate]\nangle = \"k\"\naxis = [0, 0, 1]\n\
         [joint_set.j.component.v.rotate]\nangle = \"k.2\"\naxis = [0, 1, 0]\n\
         [joint_set.j.component.held.cone]\norientation = \"q\"\n{POINTS}\
         [joint_set.j.component.ball.ball]\norientation = \"held\"\n\
         [joint_set.j.output]\ns = [\"u\", \"v\"]\nt = \"ball\"\n"
    );
    let model = read(&text);
    let half = 0.6f64;
    let stored = [-1.2, 0.0, 0.0, 0.0, half.sin(), half.cos()];
    let found = pose_in(Mode::Posed, &model, &stored);
    // Either turn about z ends at the corner.
    for (found, turn) in found.iter().zip([-FRAC_PI_4, FRAC_PI_4]) {
        let expected = Affine::from_rotation(Mat3::rotation_z(turn)).to_rows();
        assert!(found.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-12), "{found:?}");
    }
}

#[test]
fn the_points_of_the_pair_that_is_due_touch() {
    // At the place of a pair its weight is 1, so its own points lie on the ellipsoid.
    let text = format!(
        "{HEAD}[segment.ribs]\n[segment.blade]\nparent = \"ribs\"\nat = [0.05, 0.1, 0.12]\n\
         [joint_set.j.coordinate.lift]\n[joint_set.j.coordinate.slide]\nkind = \"translation\"\n\
         [joint_set.j.component.before.rotate]\nangle = \"lift\"\naxis = [0, 0, 1]\n\
         [joint_set.j.component.touch.contact]\nsegment = \"blade\"\nsurface = \"ribs\"\n\
         at = [0.01, 0.05, 0]\nturn = [0, 30, 10]\norder = \"zyx\"\nradii = [0.15, 0.2, 0.14]\n\
         axis = [0, 2, 0]\nbefore = \"before\"\ndrivers = [\"lift\", \"slide\"]\nin = [\"deg\", \
         \"mm\"]\n\
         pairs = [{{ first = [0.08, 0.0, -0.01], second = [0.07, -0.1, -0.01], at = [0, 0] }}, \
         {{ first = [0.09, 0.01, -0.01], second = [0.06, -0.11, -0.01], at = [40, 25] }}]\n\
         [joint_set.j.output]\nblade = [\"before\", \"touch\"]\n"
    );
    let model = read(&text);
    let turn = Mat3::rotation_z(0.0) * Mat3::rotation_y(30f64.to_radians());
    let turn = turn * Mat3::rotation_x(10f64.to_radians());
    let ellipsoid = Affine::new(turn, Vec3::new(0.01, 0.05, 0.0));
    let blade = model.find_segment("blade").unwrap().index();
    let pairs = [
        ([0.0, 0.0], [Vec3::new(0.08, 0.0, -0.01), Vec3::new(0.07, -0.1, -0.01)]),
        (
            [40f64.to_radians(), 0.025],
            [Vec3::new(0.09, 0.01, -0.01), Vec3::new(0.06, -0.11, -0.01)],
        ),
    ];
    for (stored, points) in pairs {
        let t = pose(&model, &stored)[blade];
        for p in points {
            let [x, y, z] =
                [0, 4, 8].map(|i| t[i] * p.x + t[i + 1] * p.y + t[i + 2] * p.z + t[i + 3]);
            let local = ellipsoid.rigid_inverse() * Vec3::new(x, y, z);
            let scaled = Vec3::new(local.x / 0.15, local.y / 0.2, local.z / 0.14);
            assert!((scaled.norm() - 1.0).abs() < 1e-12, "{stored:?}: {}", scaled.norm());
        }
    }
}

#[test]
fn every_reason_against_a_cone_has_its_place() {
    let cone = |keys: &str| {
        let found = errors(&format!(
            "[joint_set.j.coordinate.q]\nkind = \"orientation\"\n[joint_set.j.component.k.cone]\n\
             orientation = \"q\"\n{keys}\n"
        ));
        assert_eq!(found.len(), 1, "{found:?}");
        found[0].clone()
    };
    let corners =
        "{ direction = [1, 1, 0] }, { direction = [1, 0, 1] }, { direction = [1, -1, 0] }";
    let cases = [
        (format!("rest = [0, 0, 0]\npoints = [{corners}]"), "line 7, column 8: the rest direction"),
        (
            format!("rest = [1, 0, 0]\npoints = [{corners}, {{ direction = [0, 0, 0] }}]"),
            "line 8, column 93: the direction of point 4 has length 0",
        ),
        (
            format!("rest = [1, 0, 0]\nsubdivisions = 8\npoints = [{corners}]"),
            "line 8, column 16: 3 points doubled 8 times are more than 512",
        ),
        (
            format!("rest = [1, 0, 0]\ntwist = [-7, 7]\npoints = [{corners}]"),
            "line 8, column 9: a twist limit is beyond a full turn",
        ),
        (
            format!("rest = [1, 0, 0]\npoints = [{corners}, {{ direction = [-1, 1, 0] }}]"),
            "line 8, column 93: points 3 and 4 have opposite directions",
        ),
        (
            format!("rest = [1, 0, 0]\npoints = [{corners}, {{ direction = [-1, 0, 0] }}]"),
            "line 8, column 93: point 4 is opposite to the rest direction",
        ),
    ];
    for (keys, expected) in cases {
        let found = cone(&keys);
        assert!(found.starts_with(expected), "{found} should begin with {expected}");
        assert!(found.ends_with(')'), "{found} says no remedy");
    }
}
