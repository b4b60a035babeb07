//! The knees against the numbers that they were made of.
//!
//! The tibia's motion is read as in its source: a slide in the plane of flexion, then
//! Rz(-flexion) Rx(adduction) Ry(internal rotation), in the axes of the joint.

use crate::figure::{Figure, apart, turns};
use condyle::math::function::SimmSpline;
use condyle::math::{Affine, EulerOrder, Vec3};
use condyle::{Mode, Pose};

const KNEE: &str = "knee";
const FREE: &str = "knee-three-rotations";

/// The slides of Walker, Rovick & Robertson 1988 as Rajagopal et al. 2016 have them, at every 10
/// degrees of flexion: metres upward and forward.
const SLIDES: [(f64, f64); 13] = [
    (0.0, 0.0),
    (0.000479, 0.000988),
    (0.000835, 0.001899),
    (0.001086, 0.002734),
    (0.001251, 0.003492),
    (0.001346, 0.004173),
    (0.001391, 0.004777),
    (0.001403, 0.005305),
    (0.0014, 0.005756),
    (0.0014, 0.00613),
    (0.001421, 0.006427),
    (0.001481, 0.006648),
    (0.001599, 0.006792),
];

/// How near the knots of the centre bring the slides back, as the document says.
const CENTRE: f64 = 0.2e-6;

/// Flexion alone, in radians, taken as it is.
fn bent(knee: &Figure, flexion: f64) -> Pose {
    knee.open(&knee.set(&[("knee_angle_r", flexion)]))
}

/// What the joint of a bone does in a pose.
fn motion(knee: &Figure, pose: &Pose, bone: &str) -> Affine {
    knee.motion(pose, knee.id(bone))
}

fn source() -> [SimmSpline; 2] {
    let spline = |pick: fn(&(f64, f64)) -> f64| {
        let knots = (0..13).map(|i| f64::to_radians(10.0 * f64::from(i)));
        SimmSpline::new(knots.collect(), SLIDES.iter().map(pick).collect()).expect("knots")
    };
    [spline(|row| row.1), spline(|row| row.0)]
}

#[test]
fn nothing_to_remark() {
    for name in [KNEE, FREE] {
        let knee = Figure::alone(name);
        knee.assert_unremarked();
        knee.assert_sourced();
    }
}

#[test]
fn at_zero_every_joint_is_at_rest() {
    for name in [KNEE, FREE] {
        let knee = Figure::alone(name);
        let pose = bent(&knee, 0.0);
        knee.assert_at_rest(&pose);
        // Standing straight, the axes of femur, tibia and fibula are parallel.
        for bone in ["femur_r", "tibia_r", "fibula_r"] {
            let turned = Affine::from_rotation(pose.segment(knee.id(bone)).linear);
            assert!(apart(turned, Affine::IDENTITY) < 1e-15, "{bone}");
        }
    }
}

/// Rajagopal et al. 2016: adduction and internal rotation in degrees, slides upward and forward in
/// mm, all to 0.001.
#[test]
fn the_tibia_moves_as_published() {
    let knee = Figure::alone(KNEE);
    let table = [
        (0.0, 0.0, 0.0, 0.0, 0.0),
        (15.0, 1.034, 4.903, 0.671, 1.453),
        (30.0, 1.696, 8.630, 1.086, 2.734),
        (60.0, 1.769, 13.177, 1.391, 4.777),
        (90.0, 0.654, 14.884, 1.400, 6.130),
        (120.0, -0.096, 14.992, 1.599, 6.792),
    ];
    for (flexion, adduction, rotation, up, forward) in table {
        let motion = motion(&knee, &bent(&knee, f64::to_radians(flexion)), "tibia_r");
        let [f, a, r] = turns(motion).map(f64::to_degrees);
        let t = motion.translation * 1e3;
        assert!((f - flexion).abs() < 1e-9, "{flexion} {f}");
        assert!((a - adduction).abs() < 0.0005, "{flexion} {a}");
        assert!((r - rotation).abs() < 0.0005, "{flexion} {r}");
        let slack = 0.0005 + 1e3 * CENTRE;
        assert!((t.y - up).abs() < slack && (t.x - forward).abs() < slack, "{flexion} {t:?}");
        assert!(t.z.abs() < 1e-12, "{flexion} {t:?}");
    }
    // At the knots, and between them, where the source is a cubic.
    let [forward, up] = source();
    for step in 0..=480 {
        let flexion = f64::from(step) * f64::to_radians(0.25);
        let t = motion(&knee, &bent(&knee, flexion), "tibia_r").translation;
        let expected =
            Vec3::new(forward.value_and_slope(flexion).0, up.value_and_slope(flexion).0, 0.0);
        assert!((t - expected).norm() < 1.5 * CENTRE, "{flexion} {:?}", t - expected);
    }
}

/// Rajagopal et al. 2016: the axes of the joint are those of the body-fixed angles -1.64156849,
/// 1.4461808, 1.57079633 about x, y, z, and there x is that of flexion, z forward.
#[test]
fn the_knee_bends_about_the_published_axis() {
    let order: EulerOrder = "xyz".parse().expect("an order");
    let published = order.to_mat3([-1.641_568_49, 1.446_180_8, std::f64::consts::FRAC_PI_2]);
    for name in [KNEE, FREE] {
        let knee = Figure::alone(name);
        let joint = knee.model.segment(knee.id("tibia_r")).joint_in_parent.linear;
        // Angles written to 1e-5 degrees.
        assert!((joint.z + published.x).norm() < 3e-7, "{:?}", joint.z + published.x);
        assert!((joint.x - published.z).norm() < 3e-7 && (joint.y - published.y).norm() < 3e-7);
    }
}

/// The point of the plane of flexion that stands still, from the motion alone: with t the slide,
/// t' = a × (t - c) about a = -z, so c = t + a × t'.
#[test]
fn the_centre_of_flexion_runs_on_its_path() {
    let knee = Figure::alone(KNEE);
    let [forward, up] = source();
    let h = 1e-4;
    let mut path = vec![];
    for degree in 1..120 {
        let flexion = f64::from(degree).to_radians();
        let slide = |q: f64| motion(&knee, &bent(&knee, q), "tibia_r").translation;
        let slope = (slide(flexion + h) - slide(flexion - h)) * (0.5 / h);
        let centre = slide(flexion) - Vec3::Z.cross(slope);
        let ((x, dx), (y, dy)) = (forward.value_and_slope(flexion), up.value_and_slope(flexion));
        let expected = Vec3::new(x + dy, y - dx, 0.0);
        // A slide written to 1 µm every 10° has a slope to 1 µm / 0.17 rad.
        assert!((centre - expected).norm() < 6e-6, "{degree} {centre:?} {expected:?}");
        path.push(centre);
    }
    // It goes forward and up all the way, and no interval makes it jump: in the document y rises
    // fastest, by 0.93 mm in the first 10°, and x by 0.53 in the last, 6.1 mm/rad together.
    for pair in path.windows(2) {
        let step = pair[1] - pair[0];
        assert!(step.x > 0.0 && step.y > 0.0, "{step:?}");
        assert!(step.norm() < 8e-3 * 1f64.to_radians(), "{step:?}");
    }
}

/// Rajagopal et al. 2016: angle about z in rad, place forward and up from the centre of the knee in
/// m. Amis, Senavongse & Bull 2006: 4 mm medial at 20 degrees, 7 mm lateral and 7 degrees tilted at
/// 90.
#[test]
fn the_patella_moves_as_published() {
    let knee = Figure::alone(KNEE);
    // The femur stands at the origin of the world.
    let (_, centre) = knee.landmark("knee_center_r");
    let rest = bent(&knee, 0.0).segment(knee.id("patella_r"));
    let tipped = rest.linear.at(1, 0).atan2(rest.linear.at(0, 0));
    let table = [
        (0.0, 0.001137, 0.0524, -0.0108),
        (45.0, -0.496173, 0.025628, -0.038302),
        (90.0, -1.263786, -0.0088, -0.0349),
        (120.0, -1.786335, -0.0227, -0.0187),
    ];
    for (flexion, angle, x, y) in table {
        let pose = bent(&knee, f64::to_radians(flexion));
        let [turned, swayed, tilted] = turns(motion(&knee, &pose, "patella_r"));
        let place = pose.segment(knee.id("patella_r")).translation - centre;
        assert!((tipped - turned - angle).abs() < 0.6e-6, "{flexion} {}", tipped - turned);
        assert!(swayed.abs() < 1e-15);
        assert!(
            (place.x - x).abs() < 0.6e-6 && (place.y - y).abs() < 0.6e-6,
            "{flexion} {place:?}"
        );
        let tilt = -7.0 / 90.0 * f64::to_radians(flexion);
        assert!((tilted - tilt).abs() < 1e-12, "{flexion} {tilted}");
    }
    for (flexion, across) in [(0.0, 0.0), (20.0, -0.004), (90.0, 0.007)] {
        let place = bent(&knee, f64::to_radians(flexion)).segment(knee.id("patella_r")).translation;
        assert!((place.z - rest.translation.z - across).abs() < 1e-12, "{flexion} {place:?}");
    }
}

/// The fibula goes with the tibia.
#[test]
fn the_fibula_stays_with_the_tibia() {
    let knee = Figure::alone(KNEE);
    let between = |pose: &Pose| {
        pose.segment(knee.id("tibia_r")).rigid_inverse() * pose.segment(knee.id("fibula_r"))
    };
    assert!(apart(between(&bent(&knee, 0.0)), between(&bent(&knee, 2.0))) < 1e-15);
}

/// Bending unlocks the knee; beyond extension nothing is left to lock.
#[test]
fn rotation_and_adduction_have_one_side() {
    let knee = Figure::alone(KNEE);
    for degrees in [-20.0, -5.0, -0.01] {
        let [f, a, r] = turns(motion(&knee, &bent(&knee, f64::to_radians(degrees)), "tibia_r"));
        assert!((f.to_degrees() - degrees).abs() < 1e-9);
        assert!(a.abs() < 1e-15 && r.abs() < 1e-15, "{degrees} {a} {r}");
    }
    let mut before = 0.0;
    for degree in 1..=105 {
        let flexion = f64::from(degree).to_radians();
        let [_, _, r] = turns(motion(&knee, &bent(&knee, flexion), "tibia_r"));
        // Internal, and growing as far as the source's does (its last rise is at 100° to 110°).
        assert!(r > before, "{degree} {r}");
        before = r;
    }
    // Posed, the knee does not leave its range.
    let beyond = knee.pose(&[f64::to_radians(140.0)], Mode::Posed);
    let end = bent(&knee, f64::to_radians(120.0));
    assert!(apart(beyond.segment(knee.id("tibia_r")), end.segment(knee.id("tibia_r"))) < 1e-15);
}

/// Steps of 0.05°: no speed above what the steepest pieces of the sources have, and no jump of the
/// speed.
#[test]
fn bending_is_smooth() {
    let knee = Figure::alone(KNEE);
    let step = 0.05_f64.to_radians();
    // Speeds per radian. Tibia: flexion 1, adduction 0.073 and rotation 0.341 over the first 10°, and
    // a fifth more, for cubics are steepest at the end; slides 2.8 and 5.7 mm over the first 10°.
    // Patella: 0.174 rad in 10° and the tilt of 7 in 90; 36 and 47 mm forward and up over 10°, 21
    // mm across, together below 70. Then how fast they change: the tibia's rotation from 0.341 to
    // 0.286, its slides from 5.7 to 5.2 mm over 10°; the patella's angle from 0.04 to 0.57 over 10°,
    // and its way across by 11 mm, all with a factor of 2 for cubics.
    let bounds = [
        ("tibia_r", 1.0 + 1.2 * 0.414, 8e-3, 2.0 * 0.35, 2.0 * 4e-3),
        ("patella_r", 1.2 * (1.0 + 0.078), 70e-3, 2.0 * 3.1, 2.0 * 0.1),
    ];
    for (name, turning, moving, bending, swerving) in bounds {
        let motions: Vec<Affine> =
            (0..=2400).map(|i| motion(&knee, &bent(&knee, f64::from(i) * step), name)).collect();
        let rate = |pair: &[Affine]| {
            let turned = (pair[0].linear.transpose() * pair[1].linear).log();
            (turned, pair[1].translation - pair[0].translation)
        };
        let rates: Vec<(Vec3, Vec3)> = motions.windows(2).map(rate).collect();
        let mut used = [0.0_f64; 2];
        for (turned, moved) in &rates {
            used[0] = used[0].max(turned.norm() / (turning * step));
            used[1] = used[1].max(moved.norm() / (moving * step));
        }
        // Kept, and near.
        assert!(used.iter().all(|part| (0.6..=1.0).contains(part)), "{name} {used:?}");
        for pair in rates.windows(2) {
            let (turned, moved) = (pair[1].0 - pair[0].0, pair[1].1 - pair[0].1);
            assert!(turned.norm() < bending * step * step, "{name} {turned:?}");
            assert!(moved.norm() < swerving * step * step, "{name} {moved:?}");
        }
    }
}

/// Given the adduction and the rotation that the other knee makes, both knees stand alike.
#[test]
fn three_rotations_can_stand_as_one() {
    let (knee, free) = (Figure::alone(KNEE), Figure::alone(FREE));
    for degree in 0..=120 {
        let flexion = f64::from(degree).to_radians();
        let one = bent(&knee, flexion);
        let [_, adduction, rotation] = turns(motion(&knee, &one, "tibia_r"));
        let stored = free.set(&[
            ("knee_angle_r", flexion),
            ("knee_adduction_r", adduction),
            ("knee_rotation_r", rotation),
        ]);
        for mode in [Mode::Open, Mode::Posed] {
            let three = free.pose(&stored, mode);
            for id in knee.model.segment_ids() {
                let name = &knee.model.segment(id).name;
                let gap = apart(one.segment(id), three.segment(free.id(name)));
                assert!(gap < 1e-12, "{name} {degree} {gap}");
            }
        }
    }
}

/// Zarins et al. 1983: external and internal rotation of 23 and 10 degrees at 5 of flexion, 45 and
/// 25 from 30 to 90. Masouros et al. 2010: adduction of 6 to 8 in all.
#[test]
fn rotation_is_held_to_the_laxity_at_its_flexion() {
    let free = Figure::alone(FREE);
    let held = |flexion: f64, adduction: f64, rotation: f64| {
        let stored = free.degrees(&[
            ("knee_angle_r", flexion),
            ("knee_adduction_r", adduction),
            ("knee_rotation_r", rotation),
        ]);
        turns(motion(&free, &free.pose(&stored, Mode::Posed), "tibia_r")).map(f64::to_degrees)
    };
    for (flexion, external, internal) in [(5.0, 23.0, 10.0), (30.0, 45.0, 25.0), (90.0, 45.0, 25.0)]
    {
        // Knots are written to 1e-7 rad.
        let slack = 1e-5;
        assert!((held(flexion, 0.0, -60.0)[2] + external).abs() < slack, "{flexion}");
        assert!((held(flexion, 0.0, 60.0)[2] - internal).abs() < slack, "{flexion}");
        assert!((held(flexion, 0.0, 5.0)[2] - 5.0).abs() < 1e-9, "{flexion}");
    }
    // The arc grows all the way to 30.
    let arc = |flexion: f64| held(flexion, 0.0, 60.0)[2] - held(flexion, 0.0, -60.0)[2];
    assert!((0..30).all(|f| arc(f64::from(f)) < arc(f64::from(f) + 1.0)));
    let sway = held(10.0, 20.0, 0.0)[1] - held(10.0, -20.0, 0.0)[1];
    assert!((6.0..=8.0).contains(&sway), "{sway}");
}
