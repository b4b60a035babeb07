//! The knee of Pronost et al. 2010 and the planar knee of Yamaguchi & Zajac 1989 against what was printed.

use crate::figure::Figure;
use condyle::math::Vec3;

/// The origin of the tibia in the femur.
fn origin(knee: &Figure, values: &[(&str, f64)]) -> Vec3 {
    let pose = knee.open(&knee.set(values));
    let [femur, tibia] = ["femur_r", "tibia_r"].map(|name| pose.segment(knee.id(name)));
    (femur.rigid_inverse() * tibia).translation
}

/// Table 1 of Pronost, Sandholm & Thalmann 2010, subject 1: c₁ (adduction), c₂ (flexion), c₃ (rotation), c₄ of T_x, T_y, T_z.
const TABLE: [[f64; 4]; 3] = [
    [0.0573, 0.0361, 0.0582, 0.0748],
    [0.0306, -0.0442, -0.1055, -0.5035],
    [-0.0199, 0.0210, -0.2218, 0.0346],
];

#[test]
fn the_centre_is_where_table_1_has_it() {
    let knee = Figure::alone("knee-pronost2010");
    knee.assert_unremarked();
    knee.assert_at_rest(&knee.open(&knee.set(&[])));
    for angles in [[0.0, 0.0, 0.0], [0.1, 1.5, -0.2], [-0.05, 0.4, 0.3]] {
        let [adduction, flexion, rotation] = angles;
        let found = origin(
            &knee,
            &[
                ("knee_adduction_r", adduction),
                ("knee_angle_r", flexion),
                ("knee_rotation_r", rotation),
            ],
        );
        for (found, c) in found.to_array().into_iter().zip(TABLE) {
            let expected = c[0] * adduction + c[1] * flexion + c[2] * rotation + c[3];
            assert!((found - expected).abs() < 1e-15, "{angles:?}: {found} {expected}");
        }
    }
    // Flexed by a right angle the shank points backward.
    let pose = knee.at(&[("knee_angle_r", 90.0)]);
    let down = pose.segment(knee.id("tibia_r")).linear * -Vec3::Y;
    assert!((down + Vec3::X).norm() < 1e-12, "{down:?}");
}

/// Degrees, forward and upward in millimetres, by OpenSim's SimmSpline on the knots of gait2392. -120 degrees are just
/// within the first knot.
const GOLDEN: [[f64; 3]; 12] = [
    [-140.0, -9.645639, -427.95950],
    [-120.0, -3.199910, -422.59992],
    [-90.0, 3.258752, -413.99220],
    [-75.0, 4.319661, -409.61308],
    [-60.0, 4.0999916, -405.49607],
    [-45.0, 2.729400, -401.87857],
    [-30.0, 0.757712, -399.00000],
    [-15.0, -2.072733, -397.06109],
    [-5.0, -3.910036, -396.18837],
    [0.0, -4.499857, -395.82070],
    [5.0, -4.908674, -395.49718],
    [10.0, -5.175703, -395.21801],
];

#[test]
fn the_planar_knee_glides_by_the_splines_of_its_source() {
    let text = "condyle = 1\nkind = \"model\"\ninclude = [\"parts/knee-yamaguchi1989.toml\"]\n";
    let knee = Figure::of(text);
    for [degrees, forward, upward] in GOLDEN {
        let found = origin(&knee, &[("knee_angle_r", f64::to_radians(degrees))]);
        // Half a unit of the last digit that is given, and no more than a nanometre forward.
        assert!((found.x - 1e-3 * forward).abs() < 1e-9, "{degrees}: {found:?}");
        assert!((found.y - 1e-3 * upward).abs() < 1e-8, "{degrees}: {found:?}");
        assert!(found.z == 0.0);
    }
    knee.assert_at_rest(&knee.open(&knee.set(&[])));
}
