//! Limits that depend on another joint, beside laws that are known.

mod laws;

use condyle_learn::limits::dependent::{Asked, DependenceSettings, Driver, Drivers, Pairs, limit};
use condyle_learn::limits::{About, LearnedLimit, Settings, State};
use condyle_math::{Quat, Vec3};
use laws::{LAWS, Law, Random, accuracy};
use std::sync::OnceLock;

fn learned(law: &Law, count: usize, nodes: usize) -> LearnedLimit {
    let mut random = Random(0x9E37_79B9_7F4A_7C15);
    let (rotations, drivers) = law.samples(count, &mut random);
    let settings = DependenceSettings { nodes, ..DependenceSettings::of(&drivers) };
    let pairs = Pairs::gather(&[(&rotations, drivers)], 0.0, settings.slope).unwrap();
    let asked = Asked {
        about: About::default(),
        name: "driver".into(),
        reference: None,
        kind: None,
        settings: Some(settings),
        whole: Settings { nodes: 48, ..Settings::default() },
        curves: None,
    };
    limit(&pairs, &asked).unwrap().0
}

/// The forearm's twist that widens with its flexion, from 5000 samples.
fn twist() -> &'static LearnedLimit {
    static MADE: OnceLock<LearnedLimit> = OnceLock::new();
    MADE.get_or_init(|| learned(&LAWS[0], 5000, 48))
}

/// A small one whose driver is a rotation.
fn swung() -> &'static LearnedLimit {
    static MADE: OnceLock<LearnedLimit> = OnceLock::new();
    MADE.get_or_init(|| learned(&LAWS[1], 1200, 24))
}

fn hinge() -> &'static LearnedLimit {
    static MADE: OnceLock<LearnedLimit> = OnceLock::new();
    MADE.get_or_init(|| learned(&LAWS[3], 3000, 24))
}

#[test]
fn a_twist_that_widens_with_an_angle_is_found() {
    let mut random = Random(77);
    let points = LAWS[0].at(3f64.to_radians(), 600, &mut random);
    let given = twist().given().unwrap();
    let [both, ..] = accuracy(&points, |q, driver| given.distance(q, driver) >= 0.0);
    let [without, ..] = accuracy(&points, |q, _| given.whole_distance(q) >= 0.0);
    assert!(both >= 0.95, "{both}");
    assert!(both >= without + 0.1, "{both} {without}");
}

#[test]
fn ranges_of_hinges_follow_an_angle_and_a_rotation() {
    for (law, least) in [(&LAWS[2], 0.99), (&LAWS[3], 0.95)] {
        let limit = learned(law, 5000, 24);
        let mut random = Random(78);
        let points = law.at(3f64.to_radians(), 600, &mut random);
        let given = limit.given().unwrap();
        let [both, ..] = accuracy(&points, |q, driver| given.distance(q, driver) >= 0.0);
        let [without, ..] = accuracy(&points, |q, _| given.whole_distance(q) >= 0.0);
        assert!(both >= least, "{} {both}", law.name);
        assert!(both >= without + 0.1, "{} {both} {without}", law.name);
    }
}

/// Rotations and drivers anywhere.
fn anything(random: &mut Random, drivers: &Drivers) -> (Quat, Driver) {
    let q = random.rotation();
    match drivers {
        Drivers::Scalars(_) => (q, Driver::Scalar(4.0 * random.unit() - 1.0)),
        Drivers::Rotations(_) => (q, Driver::Rotation(random.rotation())),
    }
}

#[test]
fn slopes_are_those_of_differences() {
    let step = 1e-5;
    for limit in [twist(), swung(), hinge()] {
        let given = limit.given().unwrap();
        let mut random = Random(5);
        for _ in 0..150 {
            let (q, driver) = anything(&mut random, &given.dependence().drivers);
            let sloped = given.distance_and_slopes(q, driver);
            assert!((sloped.distance - given.distance(q, driver)).abs() < 1e-12);
            let close = |exact: f64, ends: [f64; 2]| {
                let difference = (ends[0] - ends[1]) / (2.0 * step);
                assert!(
                    (exact - difference).abs() < 1e-6 * exact.abs().max(1.0),
                    "{exact} {difference}"
                );
            };
            for (axis, slope) in Vec3::UNITS.into_iter().zip(sloped.child.to_array()) {
                let at = |sign: f64| given.distance(q * Quat::exp(axis * (sign * step)), driver);
                close(slope, [at(1.0), at(-1.0)]);
            }
            match driver {
                Driver::Scalar(value) => {
                    let at = |sign: f64| given.distance(q, Driver::Scalar(value + sign * step));
                    close(sloped.driver[0], [at(1.0), at(-1.0)]);
                }
                Driver::Rotation(p) => {
                    for (axis, slope) in Vec3::UNITS.into_iter().zip(sloped.driver) {
                        let turned = |sign: f64| p * Quat::exp(axis * (sign * step));
                        let at = |sign: f64| given.distance(q, Driver::Rotation(turned(sign)));
                        close(slope, [at(1.0), at(-1.0)]);
                    }
                }
            }
        }
    }
}

#[test]
fn both_signs_give_the_same_bits() {
    for limit in [twist(), swung(), hinge()] {
        let given = limit.given().unwrap();
        let mut random = Random(6);
        for _ in 0..200 {
            let (q, driver) = anything(&mut random, &given.dependence().drivers);
            let other = match driver {
                Driver::Rotation(p) => Driver::Rotation(-p),
                scalar => scalar,
            };
            let one = given.distance_and_slopes(q, driver);
            assert_eq!(one, given.distance_and_slopes(-q, driver));
            assert_eq!(one, given.distance_and_slopes(q, other));
            assert_eq!(given.state(q, driver), given.state(-q, other));
        }
    }
}

#[test]
fn the_nearest_is_inside_stays_and_is_not_far() {
    for limit in [twist(), swung(), hinge()] {
        let given = limit.given().unwrap();
        let mut random = Random(7);
        let mut moved = 0;
        for _ in 0..300 {
            let sample = (random.unit() * limit.ground().samples.len() as f64) as usize;
            let driver = given.dependence().drivers.get(sample).unwrap();
            let q = limit.ground().samples[sample]
                * Quat::exp(random.direction() * (0.6 * random.unit()));
            let q = q.normalized();
            let distance = given.distance(q, driver);
            let nearest = given.nearest(q, driver);
            if distance >= 0.0 {
                assert!(nearest.angle_to(q) < 1e-9);
                continue;
            }
            moved += 1;
            assert!(given.distance(nearest, driver) > -1e-9);
            assert!(given.nearest(nearest, driver).angle_to(nearest) < 1e-9);
            // A blend of distances rises by at most 1 a radian: nothing inside is nearer than the distance says, and a way back
            // to the sample is inside if the sample is.
            let far = nearest.angle_to(q);
            assert!(far > -0.9 * distance, "{far} {distance}");
            let own = limit.ground().samples[sample];
            if given.distance(own, driver) >= 0.0 {
                assert!(far <= own.angle_to(q) + 1e-6, "{far}");
            }
        }
        assert!(moved > 20, "{moved}");
    }
}

#[test]
fn nothing_is_known_where_nobody_was_recorded() {
    let given = twist().given().unwrap();
    let middle = Quat::IDENTITY;
    assert_eq!(given.state(middle, Driver::Scalar(1.0)), State::Valid);
    // 120 degrees are the most; at 4 rad the limit without the driver holds.
    let far = Driver::Scalar(4.0);
    assert_eq!(given.state(middle, far), State::Unknown);
    assert!(given.known(far) < 1e-12);
    let turned = Quat::from_axis_angle(Vec3::X, 2.5);
    assert_eq!(given.state(turned, far), State::Invalid);
    assert_eq!(given.distance(turned, far), given.whole_distance(turned));
}

#[test]
fn the_same_limit_is_made_again() {
    let limit = hinge();
    let dependence = limit.dependence().unwrap().clone();
    let made = condyle_learn::limits::dependent::made(limit.ground(), &dependence);
    let first = limit.given().unwrap().made();
    assert_eq!(made.cells, first.cells);
    assert_eq!(made.shares, first.shares);
}

#[test]
fn rotations_without_a_driver_are_an_error_or_left_out() {
    let turn = Quat::from_axis_angle(Vec3::Z, 0.3);
    let short = Pairs::gather(&[(&[turn, turn], Drivers::Scalars(vec![0.0]))], 0.0, 0.5);
    assert_eq!(short.unwrap_err().code(), "given/pairs");
    let broken = Drivers::Scalars(vec![0.0, f64::NAN, 1.0]);
    let pairs = Pairs::gather(&[(&[turn, turn, turn], broken)], 0.0, 0.5).unwrap();
    // The same rotation at another value of the driver is another sample.
    assert_eq!((pairs.rotations.len(), pairs.gathered.unusable), (2, 1));
}
