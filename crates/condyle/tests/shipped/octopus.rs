//! The octopus against the formulas that it is made of.

use crate::figure::{Draws, Figure, apart};
use condyle::math::{Affine, Mat3, Quat, Vec3};
use condyle::{Mode, Motion, Pose, SegmentId, scene};

/// Links of an arm, and the length of one in metres.
const LINKS: usize = 6;
const LINK: f64 = 0.08;

/// Coordinates that a mirror turns over; all others keep their value.
const TURNED_OVER: [&str; 3] = ["head/roll", "mantle/sway", "funnel/aim"];

/// Defaults, with some coordinates set.
fn set(octopus: &Figure, values: &[(&str, f64)]) -> Vec<f64> {
    let mut stored = octopus.model.defaults();
    for (key, value) in values {
        stored[octopus.place(key)] = *value;
    }
    stored
}

/// What the joint of a segment does in a pose, where flesh stretches.
fn motion(octopus: &Figure, pose: &Pose, segment: SegmentId) -> Affine {
    let s = octopus.model.segment(segment);
    let joint = pose.frame(s.parent) * s.joint_in_parent;
    let back = joint.linear.inverse();
    let child = pose.segment(segment) * s.joint_in_segment;
    Affine::new(back * child.linear, back * (child.translation - joint.translation))
}

#[test]
fn nothing_to_remark() {
    let octopus = Figure::alone("octopus");
    octopus.assert_unremarked();
    octopus.assert_sourced();
    // Every draw of a posture relies on it.
    let mut ranges = octopus.model.coordinates().iter().map(|c| c.range);
    assert!(ranges.all(|range| range.lower.is_some() && range.upper.is_some()));
    let arms = octopus.model.joint_sets().iter().filter(|s| s.name.starts_with("arm_")).count();
    assert_eq!(arms, 8);
}

#[test]
fn at_its_defaults_every_joint_is_at_rest() {
    let octopus = Figure::alone("octopus");
    let pose = octopus.open(&octopus.model.defaults());
    for id in octopus.model.segment_ids() {
        let moved = apart(motion(&octopus, &pose, id), Affine::IDENTITY);
        assert!(moved < 1e-15, "{}: {moved}", octopus.model.segment(id).name);
    }
    // Eight arms at equal angles, 22.5 degrees from straight ahead; links of 8 cm from 3 cm on.
    for (arm, azimuth) in [(1, 22.5f64), (2, 67.5), (3, 112.5), (4, 157.5)] {
        let tip = pose.segment(octopus.id(&format!("arm_{arm}_6_r"))).translation;
        let (sin, cos) = azimuth.to_radians().sin_cos();
        let expected = Vec3::new(cos, 0.0, sin) * (0.03 + LINKS as f64 * LINK);
        // The bases are written with seven digits.
        assert!((tip - expected - Vec3::Y * -0.015).norm() < 1e-7, "arm {arm}");
    }
}

#[test]
fn links_that_bend_alike_lie_on_a_circle() {
    // A link of length s·l that bends by t about its middle carries its ends along the circle that is
    // tangent to it there: of radius r = (s·l/2)/tan(t/2), through angles 0, t, 2t, …
    let octopus = Figure::alone("octopus");
    for (curl, stretch) in [(0.9f64, 1.0), (-0.5, 1.7), (1.2, 0.7), (0.05, 1.3)] {
        let values = [("arm_2_l/curl", curl), ("arm_2_l/stretch", stretch)];
        let pose = octopus.open(&set(&octopus, &values));
        let first = octopus.model.segment(octopus.id("arm_2_1_l")).joint_in_parent;
        let base =
            pose.segment(octopus.id("head")) * first * Affine::from_translation(Vec3::X * -LINK);
        let r = 0.5 * stretch * LINK / (0.5 * curl).tan();
        for link in 1..=LINKS {
            let angle = link as f64 * curl;
            let expected = base * Vec3::new(r * angle.sin(), -r * (1.0 - angle.cos()), 0.0);
            let found = pose.segment(octopus.id(&format!("arm_2_{link}_l"))).translation;
            assert!((found - expected).norm() < 1e-14, "link {link} at {curl}, {stretch}");
        }
    }
}

#[test]
fn a_fold_travels_whole() {
    let octopus = Figure::alone("octopus");
    let rest = octopus.open(&octopus.model.defaults());
    let tip = octopus.id("arm_1_6_r");
    for at in 0..=50 {
        let (at, fold) = (0.1 * f64::from(at), 1.3);
        let values = [("arm_1_r/fold", fold), ("arm_1_r/fold_at", at)];
        let pose = octopus.open(&set(&octopus, &values));
        let turn = rest.segment(tip).linear.transpose() * pose.segment(tip).linear;
        assert!((turn.log() + Vec3::Z * fold).norm() < 1e-13, "at {at}");
        // Where it is at a link, that one bends alone.
        if at == at.round() {
            let link = octopus.id(&format!("arm_1_{}_r", at as usize + 1));
            let own = motion(&octopus, &pose, link).linear.log();
            assert!((own + Vec3::Z * fold).norm() < 1e-13, "at {at}");
        }
    }
}

#[test]
fn flesh_and_mantle_keep_their_volume() {
    let octopus = Figure::alone("octopus");
    let mut draws = Draws(0x51ce);
    for _ in 0..20 {
        let stored = draws.inside(&octopus.model);
        let pose = octopus.open(&stored);
        for id in octopus.model.segment_ids() {
            let name = &octopus.model.segment(id).name;
            let breath = stored[octopus.place("mantle/breath")];
            let volume = if name == "mantle" { breath * breath } else { 1.0 };
            let found = pose.segment(id).linear.determinant();
            assert!((found - volume).abs() < 1e-13, "{name}: {found}");
        }
    }
    // Margheri et al. 2012: 70 % longer, 23 % thinner.
    let pose = octopus.open(&set(&octopus, &[("arm_3_r/stretch", 1.7)]));
    let flesh = pose.segment(octopus.id("flesh_3_4_r")).linear;
    assert!((flesh.x.norm() - 1.7).abs() < 1e-15);
    assert_eq!((100.0 * (1.0 - flesh.y.norm())).round(), 23.0);
}

#[test]
fn eyes_stay_level() {
    let octopus = Figure::alone("octopus");
    let tilt = [("head/pitch", 0.8), ("head/roll", -0.6), ("eye_l/look", 0.3)];
    let pose = octopus.open(&set(&octopus, &tilt));
    let (right, left) = (octopus.id("eye_r"), octopus.id("eye_l"));
    let turned = |id| pose.segment(id).linear.log().norm();
    assert!(turned(right) < 1e-15);
    assert!((turned(left) - 0.3).abs() < 1e-15);
    // Two turns across each other: cos(t/2) is the product of their cosines.
    let head = 2.0 * (0.4f64.cos() * 0.3f64.cos()).acos();
    assert!((turned(octopus.id("head")) - head).abs() < 1e-14);
}

#[test]
fn the_funnel_slides_on_a_circle() {
    // Knots every 15 degrees on a circle of 3 cm: (5/384)·h⁴·r = 1.8 µm between knots, some more near
    // the ends, where the spline is told nothing of the slope.
    let octopus = Figure::alone("octopus");
    let id = octopus.id("funnel");
    for step in -24..=24 {
        let aim = (2.5 * f64::from(step)).to_radians();
        let pose = octopus.open(&set(&octopus, &[("funnel/aim", aim)]));
        let motion = motion(&octopus, &pose, id);
        let expected = Vec3::new(0.03 * (aim.cos() - 1.0), 0.0, 0.03 * aim.sin());
        let off = (motion.translation - expected).norm();
        assert!(off < 5e-6, "{off} at {aim}");
        let turned = (motion.linear.transpose() * Mat3::rotation_y(-aim)).log().norm();
        assert!(turned < 2e-3, "{turned} at {aim}");
    }
}

#[test]
fn both_sides_are_mirror_images() {
    let octopus = Figure::alone("octopus");
    let mirror = octopus.mirror(|key| TURNED_OVER.contains(&key));
    let mut draws = Draws(0xb0a7);
    for _ in 0..20 {
        let stored = draws.inside(&octopus.model);
        let (here, there) = (octopus.open(&stored), octopus.open(&mirror.numbers(&stored)));
        mirror.assert_segments(&here, &there, 1e-14);
    }
}

#[test]
fn it_moves_smoothly_along_any_way() {
    // Second differences go with the square of the step: a quarter at half the step. A kink would
    // halve them, a jump would leave them as they are.
    let octopus = Figure::alone("octopus");
    let mut draws = Draws(0x0c70);
    for _ in 0..4 {
        let (from, to) = (draws.inside(&octopus.model), draws.inside(&octopus.model));
        let worst = |steps: usize| {
            let at = |step: usize| {
                let share = step as f64 / steps as f64;
                let stored: Vec<f64> =
                    from.iter().zip(&to).map(|(a, b)| a + (b - a) * share).collect();
                octopus.open(&stored).segments().to_vec()
            };
            let (mut before, mut here) = (at(0), at(1));
            let mut worst = 0f64;
            for step in 2..=steps {
                let next = at(step);
                for ((a, b), c) in before.iter().zip(&here).zip(&next) {
                    let (a, b, c) = (a.to_rows(), b.to_rows(), c.to_rows());
                    for ((a, b), c) in a.iter().zip(b).zip(c) {
                        worst = worst.max((a - 2.0 * b + c).abs());
                    }
                }
                (before, here) = (here, next);
            }
            worst
        };
        let ratio = worst(400) / worst(800);
        assert!((3.8..4.2).contains(&ratio), "{ratio}");
    }
}

#[test]
fn it_becomes_plain_bones() {
    let octopus = Figure::alone("octopus");
    let mut draws = Draws(0x61b);
    let frames: Vec<Vec<f64>> = (0..10).map(|_| draws.inside(&octopus.model)).collect();
    let times = (0..10).map(|frame| 0.1 * f64::from(frame)).collect();
    let motion = Motion { times, frames };
    let baked = scene::baked(&octopus.model, &motion, Mode::Posed, None);
    assert_eq!(baked.warnings, []);
    let scene = baked.value;
    assert!(condyle::formats::glb::write(&scene).is_ok());
    for (frame, stored) in motion.frames.iter().enumerate() {
        let pose = octopus.open(stored);
        let mut world: Vec<Affine> = vec![];
        for (node, track) in scene.nodes.iter().zip(&scene.tracks) {
            let place = &track.poses[frame];
            let r = Quat::from(place.rotation).to_mat3();
            let [x, y, z] = place.scale;
            let linear = Mat3::from_columns(r.x * x, r.y * y, r.z * z);
            let local = Affine::new(linear, Vec3::from(place.translation));
            world.push(node.parent.map_or(Affine::IDENTITY, |p| world[p]) * local);
            let off = apart(world[world.len() - 1], pose.segment(octopus.id(&node.name)));
            assert!(off < 1e-13, "{} in frame {frame}: {off}", node.name);
        }
    }
}
