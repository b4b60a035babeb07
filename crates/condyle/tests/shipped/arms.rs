//! The arms against the numbers that they were made of.

use crate::figure::{Draws, Figure, apart, beside, between, degrees_between};
use crate::limb::{assert_hangs, assert_ranges, assert_signs, assert_smooth};
use condyle::Pose;
use condyle::math::Vec3;

/// The stature that the document is for, in metres.
const STATURE: f64 = 1.75;

const FINGERS: [&str; 4] = ["index", "middle", "ring", "little"];

#[test]
fn nothing_to_remark() {
    let arms = Figure::alone("arms");
    arms.assert_unremarked();
    arms.assert_sourced();
}

#[test]
fn at_zero_every_joint_is_at_rest() {
    let arms = Figure::alone("arms");
    arms.assert_at_rest(&arms.at(&[]));
}

#[test]
fn the_left_is_the_right_in_a_mirror() {
    let arms = Figure::alone("arms");
    let mirror = arms.mirror(|_| false);
    let mut draws = Draws(0x9e37_79b9_7f4a_7c15);
    for _ in 0..100 {
        let stored = draws.inside(&arms.model);
        let (pose, mirrored) = (arms.open(&stored), arms.open(&mirror.numbers(&stored)));
        mirror.assert_segments(&pose, &mirrored, 1e-12);
        mirror.assert_markers(&pose, &mirrored, 1e-12);
    }
}

/// The ends of the ranges that were published, and that the joint turns so far there.
#[test]
fn ranges_end_where_their_sources_say() {
    let table = [
        // Boone & Azen 1979.
        ("elbow_flex_r", "ulna_r", 0.0, 143.0),
        ("wrist_flex_r", "hand_r", -75.0, 76.0),
        ("wrist_dev_r", "hand_r", -22.0, 36.0),
        ("pro_sup_r", "radius_r", 0.0, 180.0),
        ("finger_spread_r", "index_proximal_r", 0.0, 25.0),
        ("index_mcp_flex_r", "index_proximal_r", -30.0, 90.0),
        ("index_pip_flex_r", "index_middle_r", 0.0, 120.0),
        ("middle_mcp_flex_r", "middle_proximal_r", -30.0, 90.0),
        ("middle_pip_flex_r", "middle_middle_r", 0.0, 120.0),
        ("ring_mcp_flex_r", "ring_proximal_r", -30.0, 90.0),
        ("ring_pip_flex_r", "ring_middle_r", 0.0, 120.0),
        ("little_mcp_flex_r", "little_proximal_r", -30.0, 90.0),
        ("little_pip_flex_r", "little_middle_r", 0.0, 120.0),
        // Dutch arm model.
        ("thumb_cmc_flex_r", "thumb_metacarpal_r", -45.0, 15.0),
        ("thumb_cmc_abd_r", "thumb_metacarpal_r", -25.0, 25.0),
        // e-hand.com.
        ("thumb_mcp_flex_r", "thumb_proximal_r", -10.0, 55.0),
        ("thumb_ip_flex_r", "thumb_distal_r", -15.0, 80.0),
    ];
    assert_ranges(&Figure::alone("arms"), &table);
}

/// What a coordinate does to a landmark when it grows from 0, as its name says.
#[test]
fn coordinates_have_the_signs_of_their_names() {
    let (x, z) = (Vec3::X, Vec3::Z);
    let table = [
        ("elbow_flex_r", "wrist_center_r", x),
        // The thumb's side comes forward and goes in.
        ("pro_sup_r", "radial_styloid_r", x),
        ("pro_sup_r", "thumb_tip_r", x),
        ("wrist_flex_r", "middle_tip_r", x),
        ("wrist_dev_r", "middle_tip_r", -z),
        ("finger_spread_r", "index_tip_r", z),
        ("finger_spread_r", "ring_tip_r", -z),
        ("finger_spread_r", "little_tip_r", -z),
        ("index_mcp_flex_r", "index_tip_r", x),
        ("little_pip_flex_r", "little_tip_r", x),
        // Bending, the thumb crosses the palm; abducted, it leaves it.
        ("thumb_cmc_flex_r", "thumb_tip_r", -z),
        ("thumb_cmc_abd_r", "thumb_tip_r", x),
        ("thumb_mcp_flex_r", "thumb_tip_r", -z),
        ("thumb_ip_flex_r", "thumb_tip_r", -z),
    ];
    assert_signs(&Figure::alone("arms"), &table);
}

/// Parts of the stature: de Leva 1996, and a hand of Drillis & Contini 1966.
#[test]
fn segments_have_their_parts_of_the_stature() {
    let arms = Figure::alone("arms");
    let pose = arms.at(&[]);
    let at = |name: &str| arms.marker(&pose, name);
    let drop = (at("shoulder_center_r") - at("elbow_center_r")).y;
    assert!((drop - 0.1618 * STATURE).abs() < 1e-12, "{drop}");
    let forearm = (at("elbow_center_r") - at("wrist_center_r")).norm();
    assert!((forearm - 0.1545 * STATURE).abs() < 1e-12, "{forearm}");
    // Proximal against middle bone (Dutch arm model): 42.6 / 25.1 and so on. Lengths have 0.1 mm.
    let published = [42.6 / 25.1, 44.7 / 29.1, 40.4 / 24.9, 36.1 / 21.0];
    for (finger, ratio) in FINGERS.iter().zip(published) {
        let joint = |bone: &str| pose.segment(arms.id(&format!("{finger}_{bone}_r"))).translation;
        let proximal = (joint("middle") - joint("proximal")).norm();
        let middle = (joint("distal") - joint("middle")).norm();
        assert!((proximal / middle - ratio).abs() < 0.005, "{finger} {}", proximal / middle);
    }
    // Half the span of 1.016 of the stature and 29 mm (ANSUR II, men) less the reach from the
    // shoulder: the shoulder would lie 165 mm beside the midline. Models have 155 to 175 (Seth et
    // al. 2019, Saul et al. 2014, Rajagopal et al. 2016).
    let reach = drop + forearm + (at("wrist_center_r") - at("middle_tip_r")).norm();
    let aside = 0.5 * (1.016 * STATURE + 0.029) - reach;
    assert!((0.155..0.2).contains(&aside), "{aside}");
}

/// Van Roy et al. 2005, men: 11.6 degrees in extension, -1.8 in full flexion. The angle is that
/// of the forearm against the plane in which the humerus bends.
#[test]
fn the_carrying_angle_falls_as_the_elbow_bends() {
    let arms = Figure::alone("arms");
    let angle = |flexion: f64| {
        let pose = arms.at(&[("elbow_flex_r", flexion)]);
        let along = arms.marker(&pose, "wrist_center_r") - arms.marker(&pose, "elbow_center_r");
        along.normalized().z.asin().to_degrees()
    };
    assert!((angle(0.0) - 11.6).abs() < 1e-9, "{}", angle(0.0));
    assert!((angle(143.0) + 1.8).abs() < 1e-5, "{}", angle(143.0));
    assert!((0..143).all(|f| angle(f64::from(f)) > angle(f64::from(f) + 1.0)));
}

/// Pronation turns the radius about the line from its own head to the end of the ulna, 14.5 mm
/// beside the centre of the wrist (Saul et al. 2014).
#[test]
fn the_radius_turns_and_the_ulna_stays() {
    let arms = Figure::alone("arms");
    let rest = arms.at(&[]);
    let axis = arms.axis("pro_sup_r", "radius_r");
    let head = rest.segment(arms.id("radius_r")).translation;
    let wrist = arms.marker(&rest, "wrist_center_r");
    assert!(beside(head, axis) < 1e-12);
    assert!((beside(wrist, axis) - 0.0145).abs() < 0.15e-3, "{}", beside(wrist, axis));
    let styloid = arms.marker(&rest, "radial_styloid_r");
    for turned in [45.0, 90.0, 180.0] {
        let pose = arms.at(&[("pro_sup_r", turned)]);
        assert_eq!(apart(pose.segment(arms.id("ulna_r")), rest.segment(arms.id("ulna_r"))), 0.0);
        for name in ["ulnar_styloid_r", "elbow_center_r"] {
            let moved = arms.marker(&pose, name) - arms.marker(&rest, name);
            assert_eq!(moved.norm(), 0.0, "{name}");
        }
        // A chord of the circle about the axis, and the head stays.
        let chord = (arms.marker(&pose, "radial_styloid_r") - styloid).norm();
        let expected = 2.0 * beside(styloid, axis) * (0.5 * f64::to_radians(turned)).sin();
        assert!((chord - expected).abs() < 1e-12, "{turned} {chord}");
        assert!((pose.segment(arms.id("radius_r")).translation - head).norm() < 1e-15);
    }
    // Half a turn brings the thumb's side from outside to inside, and the radius across the ulna.
    let pronated = arms.at(&[("pro_sup_r", 180.0)]);
    let ulnar = arms.marker(&rest, "ulnar_styloid_r").z;
    assert!(styloid.z > ulnar && arms.marker(&pronated, "radial_styloid_r").z < wrist.z);
}

/// Neu, Crisco & Wolfe 2001: 3.9 mm between the axes of the wrist.
#[test]
fn the_axes_of_the_wrist_do_not_meet() {
    let arms = Figure::alone("arms");
    let flexion = arms.axis("wrist_flex_r", "hand_r");
    let deviation = arms.axis("wrist_dev_r", "hand_r");
    assert!((between(flexion, deviation) - 0.0039).abs() < 1e-12);
    assert!((degrees_between(flexion.1, deviation.1) - 90.0).abs() < 1e-9);
    // Flexion goes first: deviation is about an axis that it carries along.
    let pose = |dev: f64| arms.at(&[("wrist_flex_r", 60.0), ("wrist_dev_r", dev)]);
    let [bent, both] = [0.0, 20.0].map(|dev| pose(dev).segment(arms.id("hand_r")).linear);
    let turn = (both * bent.transpose()).log().normalized();
    assert!((turn - bent * Vec3::X).norm() < 1e-12, "{turn:?}");
}

/// Dutch arm model after Hollister et al. 1992: 80.9 degrees between the axes, 9.13 mm apart in a
/// hand of 179 mm; here it is 0.108 of the stature.
#[test]
fn the_axes_of_the_thumb_do_not_meet() {
    let arms = Figure::alone("arms");
    let flexion = arms.axis("thumb_cmc_flex_r", "thumb_metacarpal_r");
    let abduction = arms.axis("thumb_cmc_abd_r", "thumb_metacarpal_r");
    // Components to 0.001, turned into a frame with angles to 0.1 degree; places to 0.1 mm.
    let angle = degrees_between(flexion.1, abduction.1);
    assert!((angle - 80.9).abs() < 0.15, "{angle}");
    let gap = between(flexion, abduction);
    assert!((gap - 9.13e-3 * (0.108 * STATURE / 0.179)).abs() < 0.15e-3, "{gap}");
    // Both as the source has them, in the axes of the hand, and the second 9.86 mm further on.
    let rest = arms.at(&[]);
    let hand = rest.segment(arms.id("hand_r")).linear.transpose();
    let published = [(flexion.1, [0.745, 0.665, 0.042]), (abduction.1, [-0.468, 0.732, 0.496])];
    for (found, [x, y, z]) in published {
        let off = degrees_between(hand * found, Vec3::new(x, y, z));
        assert!(off < 0.15, "{off}");
    }
    let further = hand.transpose() * Vec3::new(2.64e-3, -5.70e-3, 7.60e-3);
    let base = rest.segment(arms.id("thumb_metacarpal_r")).translation;
    assert!(beside(base, flexion) < 1e-12);
    assert!(beside(base + further, abduction) < 0.15e-3);
    // Abduction is about an axis of the metacarpal, flexion about one of the hand.
    let flexed = |abd: f64| arms.at(&[("thumb_cmc_flex_r", -30.0), ("thumb_cmc_abd_r", abd)]);
    let id = arms.id("thumb_metacarpal_r");
    let [a, b] = [0.0, 10.0].map(|abd| flexed(abd).segment(id).linear);
    let carried = a * rest.segment(id).linear.transpose() * abduction.1;
    assert!(((b * a.transpose()).log().normalized() - carried).norm() < 1e-12);
}

/// The third joint of a finger bends by 2/3 of the second (Rijpkema & Girard 1991): 80 degrees at
/// 120, the Merck Manual's ends of both.
#[test]
fn the_last_joint_follows_the_one_before_it() {
    let arms = Figure::alone("arms");
    for finger in FINGERS {
        let key = format!("{finger}_pip_flex_r");
        let bend = |pose: &Pose, bone: &str| {
            let turn = arms.motion(pose, arms.id(&format!("{finger}_{bone}_r"))).linear.log();
            assert!(turn.x.abs() + turn.y.abs() < 1e-15);
            turn.z.to_degrees()
        };
        for (second, third) in [(0.0, 0.0), (30.0, 20.0), (75.0, 50.0), (120.0, 80.0)] {
            let pose = arms.at(&[(&key, second)]);
            assert!((bend(&pose, "middle") - second).abs() < 1e-12, "{finger}");
            assert!((bend(&pose, "distal") - third).abs() < 1e-12, "{finger}");
            assert_eq!(bend(&pose, "proximal"), 0.0);
        }
        // A fist brings the tip back to the palm: nearer to the wrist than its own first joint.
        let fist = arms.at(&[(&key, 120.0), (&format!("{finger}_mcp_flex_r"), 90.0)]);
        let wrist = arms.marker(&fist, "wrist_center_r");
        let knuckle = fist.segment(arms.id(&format!("{finger}_proximal_r"))).translation - wrist;
        let tip = arms.marker(&fist, &format!("{finger}_tip_r")) - wrist;
        assert!(tip.norm() < knuckle.norm(), "{finger}");
    }
    let spread = arms.at(&[("finger_spread_r", 25.0)]);
    for (finger, turned) in FINGERS.iter().zip([-25.0, 0.0, 12.5, 25.0]) {
        let id = arms.id(&format!("{finger}_proximal_r"));
        let turn = arms.motion(&spread, id).linear.log().x.to_degrees();
        assert!((turn - turned).abs() < 1e-12, "{finger} {turn}");
    }
}

/// Along straight paths through the ranges no joint moves faster than its coordinates let it.
///
/// Every coordinate that moves a joint turns it at a rate of at most 1 (shares are at most 1).
/// Origins move by a lever: none for hinges, and the offsets between the axes of wrist and thumb.
#[test]
fn paths_are_smooth() {
    assert_smooth(&Figure::alone("arms"), |name| match name.split('_').next() {
        Some("hand") => (1.0, 3.9e-3),
        // 9.9 mm along the metacarpal.
        Some("thumb") if name.starts_with("thumb_metacarpal") => (1.0, 10e-3),
        _ => (1.0, 0.0),
    });
}

/// A text that goes on with these gives a root its parent; the mirror and the constants of what is
/// included hold for it too.
#[test]
fn they_can_be_hung_on_a_trunk() {
    let at = Vec3::new(-0.02, 0.4, 0.17);
    assert_hangs(&Figure::alone("arms"), "arms.toml", "humerus_r", at);
}
