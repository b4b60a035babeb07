//! The arms against the numbers that they were made of, and against others that they were not.
//! Their hands: `hands.rs`.

use crate::figure::{Draws, Figure, apart, beside, between, degrees_between};
use crate::limb::{assert_hangs, assert_ranges, assert_signs, assert_smooth};
use condyle::math::Vec3;
use condyle::{Mode, shipped};

/// The arms of another person.
pub(crate) fn arms_of(stature: f64, woman: u8) -> Figure {
    Figure::of(&format!(
        "condyle = 1\nkind = \"model\"\ninclude = [\"arms.toml\"]\n\
         constants = {{ stature = {stature}, woman = {woman} }}\n"
    ))
}

#[test]
fn nothing_to_remark() {
    for arms in [Figure::shipped("arms"), arms_of(1.62, 1), arms_of(1.95, 0)] {
        arms.assert_unremarked();
        arms.assert_sourced();
    }
    // They include their hands and nothing else.
    let copy = shipped::standalone("arms").expect("it is shipped");
    assert!(copy.contains("\n# Written out with parts/hand.toml, in metres"));
}

#[test]
fn at_zero_every_joint_is_at_rest() {
    let arms = Figure::shipped("arms");
    arms.assert_at_rest(&arms.at(&[]));
    // Nor does a limit move anything there.
    let posed = arms.pose(&arms.set(&[]), Mode::Posed);
    arms.assert_at_rest(&posed);
}

#[test]
fn the_left_is_the_right_in_a_mirror() {
    let arms = Figure::shipped("arms");
    let mirror = arms.mirror(|_| false);
    let mut draws = Draws(0x9e37_79b9_7f4a_7c15);
    for _ in 0..100 {
        let stored = draws.inside(&arms.model);
        for mode in [Mode::Open, Mode::Posed] {
            let [pose, mirrored] =
                [&stored, &mirror.numbers(&stored)].map(|numbers| arms.pose(numbers, mode));
            mirror.assert_segments(&pose, &mirrored, 1e-12);
            mirror.assert_markers(&pose, &mirrored, 1e-12);
        }
    }
}

/// The ends of the ranges as the text has them, and that the joint turns so far there.
#[test]
fn ranges_end_where_the_text_says() {
    let mut table = vec![
        // Boone & Azen 1979: two standard deviations beyond the mean.
        ("elbow_flex_r".to_owned(), "ulna_r".to_owned(), -10.0, 155.0),
        ("pro_sup_r".to_owned(), "radius_r".to_owned(), 0.0, 175.0),
        ("wrist_flex_r".to_owned(), "hand_r".to_owned(), -85.0, 92.0),
        ("wrist_dev_r".to_owned(), "hand_r".to_owned(), -30.0, 45.0),
        // El-shennawy et al. 2001: 27 and a little more.
        ("palm_arch_r".to_owned(), "little_metacarpal_r".to_owned(), -10.0, 20.0),
        // Merck Manual.
        ("finger_spread_r".to_owned(), "index_proximal_r".to_owned(), 0.0, 25.0),
        ("middle_spread_r".to_owned(), "middle_proximal_r".to_owned(), -20.0, 20.0),
        // It turns about its length as well: `hands.rs`.
        ("thumb_cmc_flex_r".to_owned(), String::new(), -30.0, 30.0),
        ("thumb_cmc_abd_r".to_owned(), "thumb_metacarpal_r".to_owned(), -30.0, 30.0),
        // 100 people of 26 years, and some degrees.
        ("thumb_mcp_flex_r".to_owned(), "thumb_proximal_r".to_owned(), -15.0, 70.0),
        ("thumb_mcp_dev_r".to_owned(), "thumb_proximal_r".to_owned(), -12.0, 12.0),
        ("thumb_ip_flex_r".to_owned(), "thumb_distal_r".to_owned(), -20.0, 90.0),
    ];
    for finger in ["index", "middle", "ring", "little"] {
        let row = |key: &str, bone: &str, low, high| {
            (format!("{finger}_{key}_r"), format!("{finger}_{bone}_r"), low, high)
        };
        // Bain et al. 2015, AAOS.
        table.push(row("mcp_flex", "proximal", -45.0, 100.0));
        table.push(row("pip_flex", "middle", -15.0, 120.0));
        table.push(row("dip_flex", "distal", -70.0, 50.0));
        if finger != "middle" {
            table.push(row("spread", "proximal", -30.0, 30.0));
        }
    }
    let table: Vec<(&str, &str, f64, f64)> =
        table.iter().map(|(key, bone, a, b)| (&**key, &**bone, *a, *b)).collect();
    assert_ranges(&Figure::shipped("arms"), &table);
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
        ("index_spread_r", "index_tip_r", z),
        ("middle_spread_r", "middle_tip_r", z),
        ("ring_spread_r", "ring_tip_r", -z),
        ("little_spread_r", "little_tip_r", -z),
        ("index_mcp_flex_r", "index_tip_r", x),
        ("little_pip_flex_r", "little_tip_r", x),
        ("ring_dip_flex_r", "ring_tip_r", x),
        ("palm_arch_r", "little_mcp_r", x),
        ("palm_arch_r", "ring_mcp_r", x),
        // Bending, the thumb crosses the palm; abducted, it leaves it.
        ("thumb_cmc_flex_r", "thumb_tip_r", -z),
        ("thumb_cmc_abd_r", "thumb_tip_r", x),
        ("thumb_mcp_flex_r", "thumb_tip_r", -z),
        ("thumb_mcp_dev_r", "thumb_tip_r", -x),
        ("thumb_ip_flex_r", "thumb_tip_r", -z),
    ];
    assert_signs(&Figure::shipped("arms"), &table);
}

/// ANSUR II 2012, men of 1.75 and women of 1.62 m: acromion to radiale 334 and 309, radiale to
/// stylion 267 and 239, hand 193 and 180 mm; at 1.95 m by the slopes of men.
#[test]
fn segments_have_the_lengths_of_their_stature() {
    for (stature, woman, upper, fore, hand) in [
        (1.75, 0, 0.334, 0.267, 0.193),
        (1.62, 1, 0.309, 0.239, 0.180),
        (1.95, 0, 0.334 + 0.2 * 0.203, 0.267 + 0.2 * 0.161, 0.193 + 0.2 * 0.098),
    ] {
        let arms = arms_of(stature, woman);
        let pose = arms.at(&[]);
        let at = |name: &str| arms.marker(&pose, name);
        // 41 and 12 mm, of women 38 and 11, from the acromion to the shoulder and from the elbow
        // to the radiale (recalled).
        let (above, below) = if woman == 1 { (0.038, 0.011) } else { (0.041, 0.012) };
        let drop = (at("shoulder_center_r") - at("elbow_center_r")).y;
        assert!((drop - (upper - above - below)).abs() < 1e-12, "{drop}");
        let forearm = (at("elbow_center_r") - at("wrist_center_r")).norm();
        assert!((forearm - (fore + below)).abs() < 1e-12, "{forearm}");
        // From the radial styloid, level with the wrist, to the tip: 0.99 of the hand, the sum of
        // the four bones (Buchholz et al. 1992).
        let reach = (at("wrist_center_r") - at("middle_tip_r")).norm();
        assert!((reach - 0.99 * hand).abs() < 4e-4, "{reach}");
        let measured = (at("radial_styloid_r") - at("middle_tip_r")).norm();
        assert!((measured - hand).abs() < 2e-3, "{measured}");
    }
    // Not built from it: elbow to wrist of men 0.1545 of the stature (de Leva 1996, recalled).
    let arms = Figure::shipped("arms");
    let pose = arms.at(&[]);
    let forearm = arms.marker(&pose, "elbow_center_r") - arms.marker(&pose, "wrist_center_r");
    assert!((forearm.norm() - 0.1545 * 1.75).abs() < 0.010, "{}", forearm.norm());
}

/// Van Roy et al. 2005: men 11.6 degrees in extension, -1.8 in full flexion, women 16.7 and -1.6.
/// The angle is that of the forearm against the plane in which the humerus bends.
#[test]
fn the_carrying_angle_falls_as_the_elbow_bends() {
    for (stature, woman, straight, bent) in [(1.75, 0, 11.6, -1.8), (1.62, 1, 16.7, -1.6)] {
        let arms = arms_of(stature, woman);
        let angle = |flexion: f64| {
            let pose = arms.at(&[("elbow_flex_r", flexion)]);
            let along = arms.marker(&pose, "wrist_center_r") - arms.marker(&pose, "elbow_center_r");
            along.normalized().z.asin().to_degrees()
        };
        assert!((angle(0.0) - straight).abs() < 1e-9, "{}", angle(0.0));
        assert!((angle(143.0) - bent).abs() < 1e-4, "{}", angle(143.0));
        assert!((0..143).all(|f| angle(f64::from(f)) > angle(f64::from(f) + 1.0)));
        // Not built from it: 600 students, 11.0 +- 4.3 and 15.1 +- 5.0 (Paraskevas et al. 2004).
        let (mean, deviation) = if woman == 1 { (15.1, 5.0) } else { (11.0, 4.3) };
        assert!((angle(0.0) - mean).abs() < deviation);
    }
}

/// Pronation turns the radius about the line from its own head to the fovea of the ulna, 20 mm
/// beside the centre of the wrist and 13 mm above it.
#[test]
fn the_radius_turns_and_the_ulna_stays() {
    let arms = Figure::shipped("arms");
    let rest = arms.at(&[]);
    let axis = arms.axis("pro_sup_r", "radius_r");
    let head = rest.segment(arms.id("radius_r")).translation;
    assert!(beside(head, axis) < 1e-12);
    let fovea = rest.segment(arms.id("ulna_r")) * Vec3::new(-0.002, -0.279 + 0.013, -0.020);
    assert!(beside(fovea, axis) < 1e-12);
    // Not built from them: the axes of two models, 8 degrees from each other in their forearms.
    // Saul et al. 2014 has (-0.017, 0.993, -0.120) in an ulna that hangs straight down from an elbow
    // of its own; along the forearm that leans by 11.6 degrees it is 7 degrees from its length.
    let along =
        (arms.marker(&rest, "elbow_center_r") - arms.marker(&rest, "wrist_center_r")).normalized();
    let lean = degrees_between(axis.1, along);
    assert!((6.0..10.0).contains(&lean), "{lean}");
    let styloid = arms.marker(&rest, "radial_styloid_r");
    for turned in [45.0, 90.0, 175.0] {
        let pose = arms.at(&[("pro_sup_r", turned)]);
        assert_eq!(apart(pose.segment(arms.id("ulna_r")), rest.segment(arms.id("ulna_r"))), 0.0);
        for name in ["ulnar_styloid_r", "elbow_center_r", "olecranon_r"] {
            let moved = arms.marker(&pose, name) - arms.marker(&rest, name);
            assert_eq!(moved.norm(), 0.0, "{name}");
        }
        // A chord of the circle about the axis, and the head stays.
        let chord = (arms.marker(&pose, "radial_styloid_r") - styloid).norm();
        let expected = 2.0 * beside(styloid, axis) * (0.5 * f64::to_radians(turned)).sin();
        assert!((chord - expected).abs() < 1e-12, "{turned} {chord}");
        assert!((pose.segment(arms.id("radius_r")).translation - head).norm() < 1e-15);
    }
    // It brings the thumb's side from outside to inside, and the radius across the ulna.
    let pronated = arms.at(&[("pro_sup_r", 170.0)]);
    let inside = arms.marker(&pronated, "radial_styloid_r").z;
    assert!(styloid.z > arms.marker(&rest, "ulnar_styloid_r").z);
    assert!(inside < arms.marker(&pronated, "ulnar_styloid_r").z);
}

/// Ends of the bones of living forearms are 51 to 66 mm apart and nearly stay so: between 55 and 60
/// in mid-pronation, with a change of at most 8 mm over the range.
#[test]
fn the_styloids_keep_their_distance() {
    let arms = Figure::shipped("arms");
    let apart = |turned: f64| {
        let pose = arms.at(&[("pro_sup_r", turned)]);
        (arms.marker(&pose, "radial_styloid_r") - arms.marker(&pose, "ulnar_styloid_r")).norm()
    };
    assert!((0.055..0.060).contains(&apart(87.5)), "{}", apart(87.5));
    let all: Vec<f64> = (0..=175).map(|turned| apart(f64::from(turned))).collect();
    let (least, most) = all.iter().fold((1.0_f64, 0.0_f64), |(a, b), d| (a.min(*d), b.max(*d)));
    assert!(most - least < 0.008, "{least} {most}");
}

/// Neu, Crisco & Wolfe 2001: 3.9 mm between the axes of the wrist.
#[test]
fn the_axes_of_the_wrist_do_not_meet() {
    let arms = Figure::shipped("arms");
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

/// What a wrist does, it is let do: the means of Boone & Azen's men in four directions, and a dart
/// that is thrown. Corners of that box on the other diagonal it does not reach.
#[test]
fn the_wrist_stays_in_its_ellipse() {
    let arms = Figure::shipped("arms");
    let let_through = |flex: f64, dev: f64| {
        let stored = arms.degrees(&[("wrist_flex_r", flex), ("wrist_dev_r", dev)]);
        let hand = |mode| arms.pose(&stored, mode).segment(arms.id("hand_r"));
        apart(hand(Mode::Open), hand(Mode::Posed)) < 1e-12
    };
    // The last four: functional motion, 40 in flexion and extension (Ryu et al. 1991, recalled), and
    // the dart thrower's path at both ends, 30 to one side of it (Crisco et al. 2011).
    for (flex, dev) in [
        (76.0, 0.0),
        (-75.0, 0.0),
        (0.0, 36.0),
        (0.0, -22.0),
        (40.0, 20.0),
        (-40.0, -10.0),
        (60.0, 30.0),
        (-50.0, -15.0),
    ] {
        assert!(let_through(flex, dev), "{flex} {dev}");
    }
    for (flex, dev) in [(76.0, -22.0), (-75.0, 36.0), (60.0, -20.0)] {
        assert!(!let_through(flex, dev), "{flex} {dev}");
    }
}

/// Along straight paths through the ranges no joint moves faster than its coordinates let it.
///
/// Every coordinate that moves a joint turns it at a rate of at most 1 (shares are at most 1), but
/// for the thumb, whose metacarpal turns about itself by a third of its flexion as well. Origins move
/// by a lever: none for hinges, and the offsets between the axes of wrist and thumb.
#[test]
fn paths_are_smooth() {
    assert_smooth(&Figure::shipped("arms"), |name| match name.split('_').next() {
        Some("hand") => (1.0, 3.9e-3),
        // 9.9 mm along the metacarpal.
        Some("thumb") if name.starts_with("thumb_metacarpal") => (4.0 / 3.0, 10e-3),
        _ => (1.0, 0.0),
    });
}

/// A text that goes on with these gives a root its parent; the mirror and the constants of what is
/// included hold for it too.
#[test]
fn they_can_be_hung_on_a_trunk() {
    let at = Vec3::new(-0.02, 0.4, 0.17);
    assert_hangs(&Figure::shipped("arms"), "arms.toml", "humerus_r", at);
}
