//! The hands of the arms: lengths, a fist, fingers that spread, and a thumb that opposes.

use crate::arms::arms_of;
use crate::figure::{Figure, beside, between, degrees_between};
use condyle::math::{Affine, Quat, Vec3};
use condyle::{Mode, Pose};

const FINGERS: [&str; 4] = ["index", "middle", "ring", "little"];

/// Where a marker is in the axes of the hand, in mm.
fn in_hand(arms: &Figure, pose: &Pose, name: &str) -> Vec3 {
    (pose.segment(arms.id("hand_r")).rigid_inverse() * arms.marker(pose, name)) * 1e3
}

/// Heads of metacarpals and lengths of phalanges, against a hand that they were not made from.
#[test]
fn bones_have_the_proportions_of_hands() {
    let arms = Figure::shipped("arms");
    let pose = arms.at(&[]);
    let joint = |bone: String| pose.segment(arms.id(&bone)).translation;
    // The Dutch arm model (Blana et al. 2008), 179 mm long, made 193 long: proximal and middle bone.
    let dutch = [(42.6, 25.1), (44.7, 29.1), (40.4, 24.9), (36.1, 21.0)];
    // Proximal against middle bone (An et al. 1979).
    let an = [1.85, 1.63, 1.57, 1.76];
    for ((finger, (proximal, middle)), ratio) in FINGERS.iter().zip(dutch).zip(an) {
        let bone = |from: &str, to: &str| {
            (joint(format!("{finger}_{from}_r")) - joint(format!("{finger}_{to}_r"))).norm() * 1e3
        };
        let (first, second) = (bone("proximal", "middle"), bone("middle", "distal"));
        assert!((first - proximal * 193.0 / 179.0).abs() < 4.0, "{finger} {first}");
        assert!((second - middle * 193.0 / 179.0).abs() < 5.5, "{finger} {second}");
        assert!((first / second - ratio).abs() < 0.15, "{finger} {}", first / second);
    }
    // That hand's arch: ring and little finger 5.9 and 14.9 mm more palmar than the middle one, 6.4
    // and 16.1 at this size.
    let head = |finger: &str| in_hand(&arms, &pose, &format!("{finger}_mcp_r"));
    for (finger, palmar) in [("ring", 6.4), ("little", 16.1)] {
        let arch = (head(finger) - head("middle")).x;
        assert!((arch - palmar).abs() < 1.0, "{finger} {arch}");
    }
    // Heads of bone and what covers them make the breadth, 88 mm (ANSUR II): from the joint of the
    // index to that of the little finger, a radius of 8 and 7 mm, and 7 to 16 mm of soft tissue.
    let soft = 88.0 - (head("index").z - head("little").z) - 15.0;
    assert!((7.0..16.0).contains(&soft), "{soft}");
    // A woman's hand is 180 mm long and 78 broad: no scaled man's.
    let woman = arms_of(1.62, 1);
    let hers = in_hand(&woman, &woman.at(&[]), "little_mcp_r");
    assert!((hers.y / head("little").y - 180.0 / 193.0).abs() < 1e-9);
    assert!((hers.z / head("little").z - 78.0 / 88.0).abs() < 1e-9);
}

/// Fingers of a fist turn by 11, 9 and 19 degrees beside the middle one, and point past the tubercle
/// of the scaphoid by 9, 4.3, 1.2 and -0.1 mm (index to little; thirty people, 240 fingers).
#[test]
fn a_fist_converges() {
    let arms = Figure::shipped("arms");
    let mut fist = vec![("palm_arch_r".to_owned(), 15.0)];
    for finger in FINGERS {
        fist.push((format!("{finger}_mcp_flex_r"), 90.0));
        fist.push((format!("{finger}_pip_flex_r"), 100.0));
    }
    let fist: Vec<(&str, f64)> = fist.iter().map(|(key, value)| (&**key, *value)).collect();
    let stored = arms.degrees(&fist);
    let pose = arms.pose(&stored, Mode::Posed);
    let to_hand = pose.segment(arms.id("hand_r")).rigid_inverse();
    let tubercle = in_hand(&arms, &pose, "scaphoid_tubercle_r");
    // Seen onto the palm: the way of the middle bone, and how far radial of the tubercle it passes.
    let seen = FINGERS.map(|finger| {
        let joint = |bone: &str| {
            (to_hand * pose.segment(arms.id(&format!("{finger}_{bone}_r")))).translation * 1e3
        };
        let (from, to) = (joint("middle"), joint("distal"));
        let way = Vec3::new(0.0, to.y - from.y, to.z - from.z).normalized();
        let off = tubercle - from;
        (way.z.atan2(way.y).to_degrees(), way.z * off.y - way.y * off.z)
    });
    let published = [(-11.0, 9.0), (0.0, 4.3), (9.0, 1.2), (19.0, -0.1)];
    for ((finger, (way, passes)), (turned, past)) in FINGERS.iter().zip(seen).zip(published) {
        assert!((way - seen[1].0 - turned).abs() < 1.0, "{finger} {}", way - seen[1].0);
        assert!((passes - past).abs() < 3.5, "{finger} {passes}");
    }
    // The tips come to the palm, nearer to the wrist than the knuckles.
    for finger in FINGERS {
        let [tip, knuckle] =
            ["tip", "mcp"].map(|at| in_hand(&arms, &pose, &format!("{finger}_{at}_r")).norm());
        assert!(tip < knuckle, "{finger}");
    }
}

/// The third joint of a finger bends by 0.68 of the second (0.67 to 0.70: Rijpkema & Girard 1991,
/// Nimbarte et al. 2008), and by what its own coordinate adds, from -20 to 95 degrees in all.
#[test]
fn the_last_joint_follows_the_one_before_it_and_is_free_within() {
    let arms = Figure::shipped("arms");
    for finger in FINGERS {
        let keys = [format!("{finger}_pip_flex_r"), format!("{finger}_dip_flex_r")];
        let id = arms.id(&format!("{finger}_distal_r"));
        let bend = |second: f64, added: f64| {
            let stored = arms.degrees(&[(&keys[0], second), (&keys[1], added)]);
            arms.motion(&arms.pose(&stored, Mode::Posed), id).linear.log().z.to_degrees()
        };
        for second in [0.0, 30.0, 75.0, 110.0] {
            assert!((bend(second, 0.0) - 0.68 * second).abs() < 1e-9, "{finger}");
            // 6 to 18 degrees off the rule in daily manipulation (Roda-Sales et al. 2022).
            for added in [-18.0, -6.0, 6.0, 13.0] {
                assert!((bend(second, added) - 0.68 * second - added).abs() < 1e-9, "{finger}");
            }
            assert!((-20.0..=95.0).contains(&bend(second, -70.0)), "{finger} {second}");
            assert!((-20.0..=95.0).contains(&bend(second, 50.0)), "{finger} {second}");
        }
    }
}

/// One coordinate spreads all fingers, each has its own as well, and a finger that is bent by 90
/// degrees hardly goes aside.
#[test]
fn fingers_spread_alone_and_together() {
    let arms = Figure::shipped("arms");
    let aside = |finger: &str, set: &[(&str, f64)]| {
        let pose = arms.pose(&arms.degrees(set), Mode::Posed);
        let turned = arms.motion(&pose, arms.id(&format!("{finger}_proximal_r"))).linear.log();
        turned.x.to_degrees()
    };
    for (finger, turned) in FINGERS.iter().zip([-25.0, 0.0, 12.5, 25.0]) {
        let found = aside(finger, &[("finger_spread_r", 25.0)]);
        assert!((found - turned).abs() < 1e-9, "{finger} {found}");
    }
    for (finger, turned) in FINGERS.iter().zip([-10.0, -10.0, 10.0, 10.0]) {
        let key = format!("{finger}_spread_r");
        let found = aside(finger, &[(&key, 10.0)]);
        assert!((found - turned).abs() < 1e-9, "{finger} {found}");
        let others = FINGERS.iter().filter(|other| *other != finger);
        assert!(others.map(|other| aside(other, &[(&key, 10.0)])).all(|x| x == 0.0));
        // Bent, 2 degrees are left.
        let bent = format!("{finger}_mcp_flex_r");
        let pose = |spread: f64| {
            let stored = arms.degrees(&[(&bent, 90.0), (&key, spread)]);
            let pose = arms.pose(&stored, Mode::Posed);
            arms.motion(&pose, arms.id(&format!("{finger}_proximal_r"))).linear
        };
        let moved = (pose(0.0).transpose() * pose(20.0)).log().norm().to_degrees();
        assert!((moved - 2.0).abs() < 1e-9, "{finger} {moved}");
    }
}

/// The ring finger's metacarpal bends by 0.6 of the little one's, the other two do not; hollowed, the
/// palm is narrower and the little finger has turned toward the thumb.
#[test]
fn the_palm_hollows() {
    let arms = Figure::shipped("arms");
    let [flat, hollow] = [-10.0, 20.0].map(|arch| arms.at(&[("palm_arch_r", arch)]));
    let turned = |finger: &str| {
        let id = arms.id(&format!("{finger}_metacarpal_r"));
        let [a, b] = [&flat, &hollow].map(|pose| arms.motion(pose, id).linear);
        (a.transpose() * b).log().norm().to_degrees()
    };
    for (finger, by) in FINGERS.iter().zip([0.0, 0.0, 18.0, 30.0]) {
        assert!((turned(finger) - by).abs() < 1e-9, "{finger} {}", turned(finger));
    }
    let apart = |pose: &Pose| {
        (in_hand(&arms, pose, "index_mcp_r") - in_hand(&arms, pose, "little_mcp_r")).norm()
    };
    let faces = |pose: &Pose| {
        let to_hand = pose.segment(arms.id("hand_r")).rigid_inverse();
        (to_hand * pose.segment(arms.id("little_proximal_r"))).linear * Vec3::X
    };
    assert!(
        in_hand(&arms, &hollow, "little_mcp_r").x > in_hand(&arms, &flat, "little_mcp_r").x + 20.0
    );
    assert!((apart(&flat) - apart(&hollow)).abs() < 12.0);
    assert!(faces(&hollow).z > faces(&flat).z + 0.15);
}

/// Dutch arm model after Hollister et al. 1992: 80.9 degrees between the axes, 9.13 mm apart in a
/// hand of 179 mm; here it is 193 mm long.
#[test]
fn the_axes_of_the_thumb_do_not_meet() {
    let arms = Figure::shipped("arms");
    let abduction = arms.axis("thumb_cmc_abd_r", "thumb_metacarpal_r");
    let rest = arms.at(&[]);
    let metacarpal = rest.segment(arms.id("thumb_metacarpal_r"));
    let base = metacarpal.translation;
    let hand = rest.segment(arms.id("hand_r")).linear;
    // Flexion turns about its own axis, then by a third of the angle about the metacarpal.
    let turn = |degrees: f64| {
        let pose = arms.at(&[("thumb_cmc_flex_r", degrees)]);
        let motion = arms.motion(&pose, arms.id("thumb_metacarpal_r"));
        assert!(motion.translation.norm() < 1e-15);
        let pronation = Vec3::Y * (degrees / 3.0).to_radians();
        motion * Affine::from_rotation(Quat::exp(-pronation).to_mat3())
    };
    for degrees in [-30.0, 12.0, 30.0] {
        let plain = turn(degrees).linear.log();
        assert!((plain.norm().to_degrees() - f64::abs(degrees)).abs() < 1e-6);
        let axis = metacarpal.linear * plain.normalized() * degrees.signum();
        let flexion = (base, axis);
        let angle = degrees_between(axis, abduction.1);
        assert!((angle - 80.9).abs() < 0.15, "{angle}");
        let gap = between(flexion, abduction);
        assert!((gap - 9.13e-3 * 193.0 / 179.0).abs() < 0.15e-3, "{gap}");
        // Both as the source has them, in the axes of the hand, components to 0.001.
        for (found, [x, y, z]) in
            [(axis, [0.745, 0.665, 0.042]), (abduction.1, [-0.468, 0.732, 0.496])]
        {
            let off = degrees_between(hand.transpose() * found, Vec3::new(x, y, z));
            assert!(off < 0.15, "{off}");
        }
    }
    // The second is (2.5, -5.4, 7.2) mm further on in that hand.
    let further = hand * Vec3::new(2.5e-3, -5.4e-3, 7.2e-3) * (193.0 / 179.0);
    assert!(beside(base + further, abduction) < 0.1e-3);
}

/// A hundred people of 26 years abduct the thumb by 61 degrees (50 to 71) out of the palm and by 63
/// (53 to 71) in it, from the metacarpal of the index.
#[test]
fn the_thumb_abducts_as_people_do() {
    let arms = Figure::shipped("arms");
    let (mut palmar, mut radial) = (0.0_f64, 0.0_f64);
    let rest = arms.at(&[]);
    let index = in_hand(&arms, &rest, "index_mcp_r")
        - (rest.segment(arms.id("hand_r")).rigid_inverse()
            * rest.segment(arms.id("index_metacarpal_r")))
        .translation
            * 1e3;
    for flex in (-30..=30).step_by(2) {
        for abd in (-30..=30).step_by(2) {
            let set = [("thumb_cmc_flex_r", f64::from(flex)), ("thumb_cmc_abd_r", f64::from(abd))];
            let pose = arms.at(&set);
            let bone = pose.segment(arms.id("hand_r")).linear.transpose()
                * pose.segment(arms.id("thumb_metacarpal_r")).linear
                * -Vec3::Y;
            palmar = palmar.max(bone.x.atan2(-bone.y).to_degrees());
            let from = index.z.atan2(-index.y);
            radial = radial.max((bone.z.atan2(-bone.y) - from).to_degrees());
        }
    }
    assert!((palmar - 61.0).abs() < 6.0, "{palmar}");
    assert!((radial - 64.0).abs() < 6.0, "{radial}");
}

/// Kapandji's opposition from stage 3, the tip of the index, to 10, the distal crease of the palm:
/// the thumb comes to within 5 mm of each place, and pulps face each other to 55 degrees.
///
/// The poses were found with `condyle pose`; they keep all limits.
#[test]
fn the_thumb_opposes() {
    let arms = Figure::shipped("arms");
    let head = arms.at(&[]);
    // On the skin of the little finger, in front of its joints: 5.5, 7, 9 and 13 mm.
    let crease = |stage: u8| match stage {
        7 => ("little_distal_r", Vec3::new(0.0055, 0.0, 0.0)),
        8 => ("little_middle_r", Vec3::new(0.007, 0.0, 0.0)),
        // The base of the finger, 0.45 of the proximal bone from its joint.
        9 => ("little_proximal_r", Vec3::new(0.009, -0.45 * 0.204 * 0.193, 0.0)),
        // 6 mm on the near side of the head.
        _ => {
            let to_bone = head.segment(arms.id("little_metacarpal_r")).rigid_inverse();
            let joint = to_bone * head.segment(arms.id("little_proximal_r")).translation;
            ("little_metacarpal_r", joint + Vec3::new(0.013, 0.006, 0.0))
        }
    };
    for (stage, finger, set) in OPPOSITION {
        let names = ["mcp_flex", "pip_flex", "dip_flex", "spread"];
        let mut values: Vec<(String, f64)> =
            ["cmc_flex", "cmc_abd", "mcp_flex", "mcp_dev", "ip_flex"]
                .iter()
                .zip(set)
                .map(|(name, value)| (format!("thumb_{name}_r"), value))
                .collect();
        values.push(("palm_arch_r".to_owned(), set[5]));
        values.push(("finger_spread_r".to_owned(), set[6]));
        values.extend(
            names.iter().zip(&set[7..]).map(|(name, value)| (format!("{finger}_{name}_r"), *value)),
        );
        let values: Vec<(&str, f64)> = values.iter().map(|(key, value)| (&**key, *value)).collect();
        let stored = arms.degrees(&values);
        let pose = arms.pose(&stored, Mode::Posed);
        // Legal: no limit moves it.
        let open = arms.open(&stored);
        for name in ["thumb_tip_r", "index_tip_r", "little_tip_r"] {
            let moved = arms.marker(&pose, name) - arms.marker(&open, name);
            assert!(moved.norm() < 1e-3, "stage {stage}: {name} {moved:?}");
        }
        if stage <= 6 {
            let gap = arms.marker(&pose, "thumb_pulp_r")
                - arms.marker(&pose, &format!("{finger}_pulp_r"));
            assert!(gap.norm() < 5e-3, "stage {stage}: {}", gap.norm());
            let way = |bone: &str| pose.segment(arms.id(bone)).linear * Vec3::X;
            let facing =
                degrees_between(way("thumb_distal_r"), -way(&format!("{finger}_distal_r")));
            assert!(facing < 55.0, "stage {stage}: {facing}");
        } else {
            let (bone, at) = crease(stage);
            let gap = arms.marker(&pose, "thumb_tip_r") - pose.segment(arms.id(bone)) * at;
            assert!(gap.norm() < 5e-3, "stage {stage}: {}", gap.norm());
        }
    }
}

/// Stage, finger, and degrees of the thumb (base: flexion, abduction; second joint: flexion,
/// deviation; last joint), the palm's arch, the spread of all fingers, and of that finger flexion of
/// three joints and spread.
const OPPOSITION: [(u8, &str, [f64; 11]); 8] = [
    (3, "index", [28.9, 10.1, -15.0, 2.3, -13.9, 0.0, 7.3, 65.8, 23.6, -7.8, 2.3]),
    (4, "middle", [30.0, 24.2, -1.1, -1.8, -11.3, 0.0, 5.0, 73.4, 23.0, -11.6, 5.3]),
    (5, "ring", [30.0, 30.0, -0.6, -8.9, -8.9, 12.6, 2.0, 68.7, 22.9, -12.5, -6.1]),
    (6, "little", [30.0, 30.0, 16.3, -12.0, -15.4, 20.0, 0.0, 34.6, 44.2, -33.9, -10.0]),
    (7, "little", [30.0, 24.1, 30.4, -7.4, 8.1, 16.0, 0.0, 38.8, 0.7, -7.8, -9.4]),
    (8, "little", [30.0, 6.9, 48.4, -3.2, 19.7, 7.8, 0.0, 11.6, -9.3, 0.0, -12.2]),
    (9, "little", [30.0, 2.2, 65.4, -5.1, 27.0, 1.9, 0.4, -6.6, 23.3, 0.0, -4.6]),
    (10, "little", [30.0, -10.2, 70.0, -12.0, 51.0, -10.0, 5.0, 22.0, 23.3, 0.0, 0.0]),
];
