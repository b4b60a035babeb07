//! Axes and centres of joints from a motion, against the place that the motion was made about.

use condyle::learn::calibration::{Cluster, FreeJoint, Functional};
use condyle::math::{Affine, Quat, Vec3};
use condyle::{Observed, Recording, open};
use std::path::Path;

/// Markers of a person who stands; the malleoli are turned outward by about 20 degrees.
const MARKERS: [(&str, [f64; 3]); 7] = [
    ("RGT", [0.02, 0.90, 0.17]),
    ("RLFE", [0.01, 0.48, 0.14]),
    ("RMFE", [0.00, 0.47, 0.05]),
    ("RTT", [0.06, 0.41, 0.10]),
    ("RFH", [-0.03, 0.42, 0.15]),
    ("RMEDMAL", [-0.01, 0.08, 0.06]),
    ("RLATMAL", [-0.03, 0.07, 0.13]),
];

/// The first three go with the thigh, the others with the shank; both from where the person stands.
fn recording(motions: &[(Affine, Affine)]) -> Recording {
    let place = |(thigh, shank): &(Affine, Affine)| {
        let (thigh, shank) = (*thigh, *shank);
        MARKERS.iter().enumerate().map(move |(index, (_, place))| {
            let carried = if index < 3 { thigh } else { thigh * shank };
            Observed::from((carried * Vec3::from(*place)).to_array())
        })
    };
    Recording {
        labels: MARKERS.iter().map(|(name, _)| (*name).to_owned()).collect(),
        rate: 100.0,
        times: (0..motions.len()).map(|frame| 0.01 * frame as f64).collect(),
        positions: motions.iter().flat_map(place).collect(),
        ..Recording::default()
    }
}

fn about(place: Vec3, turn: Vec3) -> Affine {
    Affine::from_translation(place)
        * Affine::from_rotation(Quat::exp(turn).to_mat3())
        * Affine::from_translation(-place)
}

/// The thigh goes anywhere.
fn carried(t: f64) -> Affine {
    about(Vec3::new(0.1 * t, 0.3, -0.2), Vec3::new(0.3 * t.sin(), 0.2 * t, 0.4 * (1.7 * t).cos()))
}

#[test]
fn the_axis_of_a_motion_takes_the_place_of_the_ends() {
    // 9 degrees off the line of the epicondyles, 12 mm below their middle.
    let direction = Vec3::new(0.2, -0.05, 1.0).normalized();
    let place = Vec3::new(-0.01, 0.463, 0.08);
    let motions: Vec<(Affine, Affine)> = (0..60)
        .map(|frame| {
            let t = 0.05 * f64::from(frame);
            (carried(t), about(place, direction * (-0.9 * (1.3 * t).sin())))
        })
        .collect();
    let (standing, motion) =
        (recording(&[(Affine::IDENTITY, Affine::IDENTITY)]), recording(&motions));
    let joint = FreeJoint::knee_pronost2010();
    let found = Functional::axis(&standing, &motion, &joint.markers).unwrap();
    let Functional::Axis(axis) = &found else { panic!("no axis") };
    assert!(axis.rms < 1e-12 && axis.wobble < 1e-10 && axis.frames == 60, "{axis:?}");
    let frames = joint.frames(&standing, Some(&found)).unwrap();
    let z = frames.child.linear * Vec3::Z;
    assert!((z - direction).norm() < 1e-10, "{z:?}");
    // The centre is on the axis, where it is nearest to the middle of the epicondyles.
    let middle = Vec3::new(0.005, 0.475, 0.095);
    let nearest = place + direction * direction.dot(middle - place);
    assert!((frames.child.translation - nearest).norm() < 1e-10);
    // A joint that hardly bends has no axis.
    let still: Vec<_> = motions.iter().map(|(thigh, _)| (*thigh, Affine::IDENTITY)).collect();
    let error = Functional::axis(&standing, &recording(&still), &joint.markers).unwrap_err();
    assert!(error.code() == "calibration/turn", "{error}");
}

#[test]
fn the_centre_of_a_motion_takes_the_place_of_the_middle() {
    let place = Vec3::new(0.02, 0.45, 0.11);
    let motions: Vec<(Affine, Affine)> = (0..60)
        .map(|frame| {
            let t = 0.05 * f64::from(frame);
            let turn = Vec3::new(0.4 * t.sin(), 0.3 * (1.9 * t).cos(), 0.8 * (0.7 * t).sin());
            (carried(t), about(place, turn))
        })
        .collect();
    let standing = recording(&[(Affine::IDENTITY, Affine::IDENTITY)]);
    let joint = FreeJoint::knee_pronost2010();
    let found = Functional::centre(&standing, &recording(&motions), &joint.markers).unwrap();
    let frames = joint.frames(&standing, Some(&found)).unwrap();
    assert!((frames.child.translation - place).norm() < 1e-10);
    // About one axis a centre is anywhere along it: that is refused, not answered.
    let hinge: Vec<_> = (0..60)
        .map(|frame| {
            let t = 0.05 * f64::from(frame);
            (carried(t), about(place, Vec3::Z * t.sin()))
        })
        .collect();
    let error = Functional::centre(&standing, &recording(&hinge), &joint.markers).unwrap_err();
    assert!(error.code() == "calibration/axis", "{error}");
}

#[test]
fn a_recipe_gives_both_segments_their_axes() {
    let recipe = open::recipe(Path::new("knee-isb")).unwrap().value;
    let joint = FreeJoint { axes: Some(recipe), ..FreeJoint::knee_pronost2010() };
    let standing = recording(&[(Affine::IDENTITY, Affine::IDENTITY)]);
    let frames = joint.frames(&standing, None).unwrap();
    let at = |name: &str| Cluster::standing(&standing, &[name]).point(name).unwrap();
    let middle = |a: &str, b: &str| (at(a) + at(b)) * 0.5;
    let (knee, ankle) = (middle("RLFE", "RMFE"), middle("RLATMAL", "RMEDMAL"));
    // By the sentences of the recipe: y of the shank from the ankle to the knee, x perpendicular to the malleoli too.
    let shank = frames.child.linear;
    assert!((shank * Vec3::Y - (knee - ankle).normalized()).norm() < 1e-12);
    assert!((shank * Vec3::X).dot(at("RLATMAL") - at("RMEDMAL")).abs() < 1e-12);
    assert!((shank * Vec3::Z).z > 0.9 && (shank * Vec3::X).x > 0.9);
    let thigh = frames.parent.linear;
    assert!((thigh * Vec3::Y - (at("RGT") - knee).normalized()).norm() < 1e-12);
    // Angles of the standing person are those between the axes: the malleoli are turned outward by atan(0.02/0.07) = 16 degrees, the
    // epicondyles by -atan(0.01/0.09) = -6.
    let model = joint.model(&standing).unwrap();
    let default = |name: &str| model.coordinate(model.find_coordinate(name).unwrap()).default[0];
    let rotation = default("knee_r_rotation").to_degrees();
    assert!((rotation + 22.3).abs() < 1.0, "{rotation}");
}
