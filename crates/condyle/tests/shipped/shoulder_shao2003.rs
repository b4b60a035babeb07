//! The shoulder of Shao & Ng-Thow-Hing 2003 against what their paper says.
//!
//! What it has in common with the other shipped shoulder is tested beside that.

use crate::figure::Figure;
use crate::shoulder::turned;
use condyle::Mode;
use condyle::math::{Affine, EulerOrder, Mat3, Vec3};

const SHAO: &str = "shoulder-shao2003";

/// Shao & Ng-Thow-Hing 2003, section 5.2: at 0, 60, 120 and 180 degrees of abduction the clavicle
/// is raised by at least -10, -6.7, 4.85 and 23, in straight lines between.
#[test]
fn the_clavicle_of_shao_and_ng_thow_hing() {
    let figure = Figure::alone(SHAO);
    let order: EulerOrder = "yxz".parse().expect("an order");
    let raised = |abduction: f64, asked: f64, mode: Mode| {
        let asked = [("shoulder_abduction_r", abduction), ("clavicle_elevation_r", asked)];
        // The clavicle's joint stands as it rests: its axes are y, then -x.
        let motion =
            figure.motion(&figure.pose(&figure.degrees(&asked), mode), figure.id("clavicle_r"));
        -order.from_mat3(motion.linear)[1].to_degrees()
    };
    for (abduction, lowest) in
        [(0.0, -10.0), (60.0, -6.7), (120.0, 4.85), (150.0, 13.925), (30.0, -8.35), (90.0, -0.925)]
    {
        let found = raised(abduction, -18.0, Mode::Posed);
        assert!((found - lowest).abs() < 1e-11, "{abduction} {found}");
        // What is above the bound, and what is tracked, stays.
        assert!((raised(abduction, 30.0, Mode::Posed) - 30.0).abs() < 1e-11);
        assert!((raised(abduction, -18.0, Mode::Open) + 18.0).abs() < 1e-11);
    }
}

/// Shao & Ng-Thow-Hing 2003, sections 4.4 and 5.2: abduction turns about (-0.373, -0.247, -0.181)
/// up to 60 degrees and about (-0.373, 0.449, -0.181) beyond, in cm, x to the left and z forward
/// there.
#[test]
fn the_abduction_of_shao_and_ng_thow_hing_has_two_centres() {
    let figure = Figure::alone(SHAO);
    let here = |[x, y, z]: [f64; 3]| Vec3::new(z, y, -x) * 0.01;
    let centres = [here([-0.373, -0.247, -0.181]), here([-0.373, 0.449, -0.181])];
    let about = |centre: Vec3, degrees: f64| {
        let turn = Mat3::rotation_x(-degrees.to_radians());
        Affine::new(turn, centre - turn * centre)
    };
    for degrees in [20.0_f64, 60.0, 90.0, 150.0] {
        let first = about(centres[0], degrees.min(60.0));
        let expected = about(centres[1], (degrees - 60.0).max(0.0)) * first;
        let pose = figure.at(&[("shoulder_abduction_r", degrees)]);
        let found = figure.in_thorax(&pose, "humerus_r");
        assert!(turned(found.linear, expected.linear) < 1e-12, "{degrees}");
        // Seen along the thorax's axes, the head leaves its joint by as much.
        let joint = figure.model.segment(figure.id("humerus_r")).joint_in_parent.translation;
        let moved = found.translation - figure.in_thorax(&pose, "scapula_r") * joint;
        assert!((moved - expected.translation).norm() < 1e-15, "{degrees} {moved:?}");
    }
}
