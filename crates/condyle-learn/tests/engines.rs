//! Cones with twist and reach cones for engines, beside shapes whose numbers are known.

#[path = "field/shapes.rs"]
#[allow(dead_code, reason = "what other tests ask for")]
mod shapes;

use condyle_learn::limits::engine::{Aim, ConeTwist, Law, Loss, Region, cone_twist, reach_cone};
use condyle_learn::limits::{Cloud, Field, Settings, learn, uniform};
use condyle_math::{Mat3, Quat, Vec3};
use shapes::{Random, SHAPES};

fn degrees(angle: f64) -> f64 {
    angle.to_degrees()
}

/// Random rotations of a set, found by trying.
fn samples(count: usize, random: &mut Random, holds: impl Fn(Quat) -> bool) -> Vec<Quat> {
    let mut found = Vec::with_capacity(count);
    while found.len() < count {
        let q = random.rotation();
        if holds(q) {
            found.push(q);
        }
    }
    found
}

fn field(samples: &[Quat]) -> Field {
    let cloud = Cloud::gather(&[samples], 0.0).expect("samples");
    learn(&cloud, &Settings { nodes: 64, ..Settings::default() }).expect("settings")
}

/// Where a cone allows a rotation, by matrices: the angle of the axis from the middle and where it goes, and the twist as what is
/// left of the rotation when the shortest turn of the axis is undone.
fn allowed_slowly(cone: &ConeTwist, rotation: Quat) -> bool {
    let frame = (cone.middle * cone.in_child).to_mat3();
    let c = frame.transpose() * rotation.to_mat3() * cone.in_child.to_mat3();
    let to = c * Vec3::X;
    let across = Vec3::X.cross(to);
    let angle = across.norm().atan2(to.x);
    let axis = if across.norm() > 1e-12 { across.normalized() } else { Vec3::Y };
    let swing = Mat3::rotation_about(axis, angle.sin_cos());
    let left = swing.transpose() * c;
    let twist = (left * Vec3::Y).z.atan2((left * Vec3::Y).y);
    let [y, z] = [axis.y * angle / cone.swing[0], axis.z * angle / cone.swing[1]];
    y * y + z * z <= 1.0 && twist.abs() <= cone.twist
}

/// A cone of 55 and 30 degrees with a twist of ±40 about a middle that is nothing in particular: learned from 6000 rotations in
/// it, its numbers come back within 1.5 degrees.
#[test]
fn a_known_cone_gives_back_its_numbers() {
    let bone = Vec3::new(0.1, -1.0, 0.2).normalized();
    let side = Vec3::new(1.0, 0.3, 0.4);
    let y = (side - bone * side.dot(bone)).normalized();
    let in_child = Quat::from_mat3(Mat3::from_columns(bone, y, bone.cross(y)));
    let truth = ConeTwist {
        law: Law::Angle,
        middle: Quat::exp(Vec3::new(0.5, -0.3, 0.9)),
        in_child,
        swing: [55f64.to_radians(), 30f64.to_radians()],
        twist: 40f64.to_radians(),
    };
    let mut random = Random(0x2545_F491_4F6C_DD1D);
    let inside = samples(6000, &mut random, |q| allowed_slowly(&truth, q));
    let field = field(&inside);
    let region = Region::of(&field);
    let distance = |q| field.distance(q);
    let found =
        cone_twist(&region, &distance, bone, Law::Angle, Aim::Closest, None).expect("a cone");
    let near = |found: f64, truth: f64| {
        assert!(degrees(found - truth).abs() < 1.5, "{} {}", degrees(found), degrees(truth));
    };
    let [mut a, mut b] = found.swing;
    let mut own = found.in_child.to_mat3().y;
    if a < b {
        (a, b) = (b, a);
        own = found.in_child.to_mat3().z;
    }
    near(a, truth.swing[0]);
    near(b, truth.swing[1]);
    near(found.twist, truth.twist);
    near(found.middle.angle_to(truth.middle), 0.0);
    // The wide axis, which has no sign.
    near(y.cross(own).norm().asin(), 0.0);
    // And what is lost is little: a boundary off by half a degree on a cone of 30 to 55 degrees is some 4 %.
    let loss = Loss::of(&region, |q| found.allows(q));
    assert!(loss.both() < 0.08, "{loss:?}");
    // A reach cone of 24 directions is no worse than 8 % either; its corners are those of the ellipse.
    let reach = reach_cone(&region, &distance, &found, 24, Aim::Closest).expect("a reach cone");
    let loss = Loss::of(&region, |q| reach.allows(q));
    assert!(loss.both() < 0.12, "{loss:?}");
    let frame = found.in_child.to_mat3();
    for point in reach.cone.points() {
        let v = frame.transpose() * point.direction;
        let angle = degrees(v.y.hypot(v.z).atan2(v.x));
        // A swing by (0, θ_y, θ_z) moves the bone toward (0, θ_z, -θ_y).
        let [y, z] = [-v.z, v.y].map(|c| c / v.y.hypot(v.z));
        let ellipse = 1.0 / (y / degrees(found.swing[0])).hypot(z / degrees(found.swing[1]));
        assert!((angle - ellipse).abs() < 4.0, "{angle} {ellipse}");
    }
}

/// The shoulder of Lenarčič and Umek is no cone: what is said to be lost is counted again, on other random rotations, with the
/// cone asked by matrices and the reach cone as the rows of our own limit.
#[test]
fn what_is_lost_of_no_cone_is_counted_again() {
    let mut random = Random(0x9E37_79B9_7F4A_7C15);
    let field = field(&SHAPES[0].samples(3000, &mut random));
    let region = Region::of(&field);
    let distance = |q| field.distance(q);
    let cone = cone_twist(&region, &distance, -Vec3::Y, Law::Angle, Aim::Closest, None).unwrap();
    let reach = reach_cone(&region, &distance, &cone, 24, Aim::Closest).unwrap();
    let asked = |loss: Loss, allows: &dyn Fn(Quat) -> bool, random: &mut Random| {
        const COUNT: usize = 100_000;
        let (mut accepts, mut rejects, mut valid) = (0usize, 0usize, 0usize);
        let mut deepest = [0.0f64; 2];
        for _ in 0..COUNT {
            let q = random.rotation();
            let (distance, allowed) = (field.distance(q), allows(q));
            valid += usize::from(distance >= 0.0);
            accepts += usize::from(allowed && distance < 0.0);
            rejects += usize::from(!allowed && distance >= 0.0);
            let side = usize::from(!allowed);
            if allowed != (distance >= 0.0) {
                deepest[side] = deepest[side].max(distance.abs());
            }
        }
        // Five deviations of a count.
        let near = |count: usize, share: f64| {
            let expected = share * COUNT as f64;
            assert!(
                (count as f64 - expected).abs() < 5.0 * expected.max(4.0).sqrt(),
                "{count} {expected}"
            );
        };
        near(accepts, loss.accepts.share);
        near(rejects, loss.rejects.share);
        near(valid, loss.field);
        // Of the largest depths random rotations reach most.
        assert!(degrees(deepest[0] - loss.accepts.largest) < 3.0);
        assert!(degrees(deepest[1] - loss.rejects.largest) < 3.0);
        loss
    };
    let of_cone =
        asked(Loss::of(&region, |q| cone.allows(q)), &|q| allowed_slowly(&cone, q), &mut random);
    let of_reach = asked(
        Loss::of(&region, |q| reach.allows(q)),
        &|q| {
            let relative = (reach.middle.conjugate() * q).to_mat3();
            reach.cone.rows(relative).iter().all(|(g, _)| *g >= 0.0)
        },
        &mut random,
    );
    // No cone is this shoulder; 24 directions are much nearer.
    assert!(of_cone.both() > 0.1, "{of_cone:?}");
    assert!(of_reach.both() < 0.6 * of_cone.both(), "{of_reach:?}");
}

/// With the aim `Inside` none of a million random rotations is allowed by a cone of any law, or by the reach cone, and outside the
/// field; and of a ball of 60 degrees MuJoCo's ball joint keeps most.
#[test]
fn inside_means_that_nothing_outside_is_allowed() {
    let mut random = Random(0x1234_5678_9ABC_DEF1);
    let field = field(&SHAPES[0].samples(3000, &mut random));
    let region = Region::of(&field);
    let distance = |q| field.distance(q);
    let bone = -Vec3::Y;
    let first = cone_twist(&region, &distance, bone, Law::Angle, Aim::Inside, None).unwrap();
    let mut cones = vec![first];
    for law in [Law::JoltCone, Law::PhysxPyramid, Law::MujocoBall, Law::MujocoHinges] {
        cones.push(cone_twist(&region, &distance, bone, law, Aim::Inside, Some(&first)).unwrap());
    }
    let reach = reach_cone(&region, &distance, &first, 16, Aim::Inside).unwrap();
    let mut allowed = vec![0usize; cones.len() + 1];
    for _ in 0..400_000 {
        let q = random.rotation();
        let mut asked: Vec<bool> = cones.iter().map(|cone| cone.allows(q)).collect();
        asked.push(reach.allows(q));
        if asked.contains(&true) {
            assert!(field.distance(q) >= 0.0, "{asked:?}: {}", degrees(field.distance(q)));
            allowed.iter_mut().zip(asked).for_each(|(sum, yes)| *sum += usize::from(yes));
        }
    }
    // They are not small: a sixth of the field and more.
    for (allowed, law) in allowed.iter().zip(Law::ALL) {
        let share = *allowed as f64 / 400_000.0;
        assert!(
            share > region.share() / 6.0,
            "{law:?} and following: {share} of {}",
            region.share()
        );
    }
}

/// MuJoCo's own joints and the frames of its sites, asked by `oracles/engines/mujoco_limits.py`, say of 10 000 rotations what we
/// say: the frames, signs and orders of the numbers that the command writes are right.
#[test]
fn mujoco_allows_the_same_rotations() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../oracles/engines/mujoco.json");
    let text = std::fs::read_to_string(path).expect("the kept answers");
    let answers: serde_json::Value = serde_json::from_str(&text).expect("JSON");
    let laws = answers["laws"].as_array().expect("laws");
    assert_eq!(laws.len(), Law::ALL.len());
    for (law, answer) in Law::ALL.into_iter().zip(laws) {
        assert_eq!(answer["law"], law.name());
        let number = |value: &serde_json::Value| value.as_f64().expect("a number");
        let quat = |name: &str| Quat::from([0, 1, 2, 3].map(|i| number(&answer[name][i])));
        let radians = |value: &serde_json::Value| number(value).to_radians();
        let cone = ConeTwist {
            law,
            middle: quat("middle"),
            in_child: quat("frame_in_child"),
            swing: [radians(&answer["swing_y_deg"]), radians(&answer["swing_z_deg"])],
            twist: radians(&answer["twist_deg"][1]),
        };
        assert!(cone.in_reference().angle_to(quat("frame_in_reference")) < 1e-12);
        let bits = answer["bits"].as_str().expect("hexadecimal");
        let digit = |at: usize| bits[at..=at].parse::<char>().ok().and_then(|c| c.to_digit(16));
        let (mut inside, mut wrong) = (0, 0);
        for (index, q) in uniform(10_000).enumerate() {
            let near = Quat::exp(q.log() * 0.55);
            let theirs = digit(index / 4).expect("a digit") >> (3 - index % 4) & 1 == 1;
            inside += usize::from(theirs);
            wrong += usize::from(cone.allows(cone.middle * near) != theirs);
        }
        // Both kinds are well represented.
        assert!((1000..9000).contains(&inside), "{law:?}: {inside}");
        assert_eq!(wrong, 0, "{law:?}");
    }
}
