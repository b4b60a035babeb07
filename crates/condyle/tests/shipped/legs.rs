//! The legs against the numbers that they were made of.

use crate::figure::{Draws, Figure, apart, beside, degrees_between};
use crate::limb::{assert_hangs, assert_ranges, assert_signs, assert_smooth};
use condyle::math::{Affine, Vec3};
use condyle::shipped;

/// The stature that the document is for, in metres.
const STATURE: f64 = 1.75;

#[test]
fn nothing_to_remark() {
    let legs = Figure::shipped("legs");
    legs.assert_unremarked();
    legs.assert_sourced();
    // They include the knee and nothing else.
    let copy = shipped::standalone("legs").expect("it is shipped");
    assert!(copy.contains("\n# Written out with knee.toml, in metres"));
}

#[test]
fn at_zero_every_joint_is_at_rest() {
    let legs = Figure::shipped("legs");
    let pose = legs.at(&[]);
    legs.assert_at_rest(&pose);
    // Standing, all bones of the leg but the patella have the axes of the pelvis.
    for s in legs.model.segments().iter().filter(|s| !s.name.starts_with("patella")) {
        let upright = Affine::from_rotation(pose.segment(legs.id(&s.name)).linear);
        assert!(apart(upright, Affine::IDENTITY) < 1e-15, "{}", s.name);
    }
}

#[test]
fn the_left_is_the_right_in_a_mirror() {
    let legs = Figure::shipped("legs");
    let mirror = legs.mirror(|_| false);
    let mut draws = Draws(0x9e37_79b9_7f4a_7c15);
    for _ in 0..100 {
        let stored = draws.inside(&legs.model);
        let (pose, mirrored) = (legs.open(&stored), legs.open(&mirror.numbers(&stored)));
        mirror.assert_segments(&pose, &mirrored, 1e-12);
        mirror.assert_markers(&pose, &mirrored, 1e-12);
    }
}

/// The ends of the ranges that were published, and that the joint turns so far there. All but what
/// is named are of the Merck Manual.
#[test]
fn ranges_end_where_their_sources_say() {
    let table = [
        ("hip_flexion_r", "femur_r", -15.0, 125.0),
        // Adduction: Rajagopal et al. 2016.
        ("hip_adduction_r", "femur_r", -45.0, 30.0),
        ("hip_rotation_r", "femur_r", -45.0, 45.0),
        // Rajagopal et al. 2016.
        ("knee_angle_r", "tibia_r", 0.0, 120.0),
        ("ankle_angle_r", "talus_r", -50.0, 20.0),
        ("subtalar_angle_r", "calcaneus_r", -25.0, 35.0),
        ("mtp_angle_r", "toes_r", -80.0, 30.0),
    ];
    assert_ranges(&Figure::shipped("legs"), &table);
}

/// What a coordinate does to a landmark when it grows from 0, as its name says.
#[test]
fn coordinates_have_the_signs_of_their_names() {
    let (x, y, z) = (Vec3::X, Vec3::Y, Vec3::Z);
    let table = [
        ("hip_flexion_r", "knee_center_r", x),
        ("hip_adduction_r", "knee_center_r", -z),
        ("hip_rotation_r", "toe_tip_r", -z),
        ("knee_angle_r", "ankle_center_r", -x),
        ("ankle_angle_r", "toe_tip_r", y),
        // Inversion lowers the lateral border and turns the toes in.
        ("subtalar_angle_r", "metatarsal_head_5_r", -y),
        ("subtalar_angle_r", "toe_tip_r", -z),
        ("mtp_angle_r", "toe_tip_r", -y),
    ];
    assert_signs(&Figure::shipped("legs"), &table);
}

/// Parts of the stature: Drillis & Contini 1966.
#[test]
fn segments_have_their_parts_of_the_stature() {
    let legs = Figure::shipped("legs");
    let pose = legs.at(&[]);
    let at = |name: &str| legs.marker(&pose, name);
    let drop = |upper: &str, lower: &str| (at(upper) - at(lower)).y;
    assert!((drop("hip_center_r", "knee_center_r") - 0.245 * STATURE).abs() < 1e-12);
    assert!((drop("knee_center_r", "ankle_center_r") - 0.246 * STATURE).abs() < 1e-12);
    // Heel to toe 0.152, to 0.1 mm.
    let foot = at("toe_tip_r").x - at("heel_r").x;
    assert!((foot - 0.152 * STATURE).abs() < 1e-4, "{foot}");
    // Hips 167 mm apart, 66 below and 71 behind the iliac spines (Delp et al. 1990).
    let hip = Vec3::new(-0.0707, -0.0661, 0.0835);
    assert!((at("hip_center_r") - hip).norm() < 1e-12);
}

/// Delp et al. 1990 and Rajagopal et al. 2016 after Inman 1976; Manter 1941.
#[test]
fn axes_of_the_foot_are_oblique_as_published() {
    let legs = Figure::shipped("legs");
    let lean = |a: Vec3| (a.y.atan2(a.x.hypot(a.z)).to_degrees(), (-a.z).atan2(a.x).to_degrees());
    // 80.0 degrees to the tibia, the lateral end 6.1 behind; components to 0.001, 0.06 degrees.
    let (_, ankle) = legs.axis("ankle_angle_r", "talus_r");
    assert!((degrees_between(ankle, -Vec3::Y) - 80.0).abs() < 0.06);
    assert!(((-ankle.x).atan2(ankle.z).to_degrees() - 6.1).abs() < 0.06);
    // It passes below the tips of both malleoli; theirs are on the skin.
    let pose = legs.at(&[]);
    for tip in ["lateral_malleolus_r", "medial_malleolus_r"] {
        let away = beside(legs.marker(&pose, tip), legs.axis("ankle_angle_r", "talus_r"));
        assert!(away < 0.025, "{tip} {away}");
    }
    // 42 degrees up to the front and 16 to the medial side.
    let (up, inward) = lean(legs.axis("subtalar_angle_r", "calcaneus_r").1);
    assert!((up - 42.0).abs() < 1e-4 && (inward - 16.0).abs() < 1e-4, "{up} {inward}");
    // 35.5 degrees across the foot, the lateral end behind.
    let (_, toes) = legs.axis("mtp_angle_r", "toes_r");
    assert!((toes.x.atan2(-toes.z).to_degrees() - 35.5).abs() < 0.06 && toes.y.abs() < 1e-12);
}

/// Along straight paths through the ranges no joint moves faster than its coordinates let it.
///
/// Every coordinate that moves a joint turns it at a rate of at most 1, but for the knee's
/// couplings: 0.073 of adduction and 0.341 of rotation over the first 10 degrees, the patella's 1
/// and its tilt of 7 in 90, and a fifth more for cubics. Origins of hinges stay; the knee's move by
/// what its own tests say.
#[test]
fn paths_are_smooth() {
    assert_smooth(&Figure::shipped("legs"), |name| match name.split('_').next() {
        Some("tibia") => (1.0 + 1.2 * 0.414, 8e-3),
        Some("patella") => (1.2 * 1.078, 70e-3),
        _ => (1.0, 0.0),
    });
}

/// A text that goes on with these gives a root its parent; the mirror and the constants of what is
/// included hold for it too.
#[test]
fn they_can_be_hung_on_a_trunk() {
    let at = Vec3::new(0.098, -0.071, 0.0);
    assert_hangs(&Figure::shipped("legs"), "legs.toml", "pelvis", at);
}
