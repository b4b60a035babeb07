//! Limits learned from samples of shapes whose inside is known.

mod shapes;

use condyle_learn::limits::{Cloud, Field, Settings, State};
use condyle_math::{Quat, Vec3};
use shapes::{Random, SHAPES, Shape, quantile};

fn learned(shape: &Shape, count: usize, random: &mut Random) -> Field {
    let samples = shape.samples(count, random);
    Field::learn(Cloud::gather(&[&samples], 0.0).unwrap(), &Settings::default()).unwrap()
}

#[test]
fn three_degrees_from_the_boundary_it_is_right() {
    // Of all shapes the shoulder has the sharpest edges and the last one a hole.
    for shape in [SHAPES[0], SHAPES[5]] {
        let mut random = Random(7);
        let field = learned(&shape, 5000, &mut random);
        let boundary = shape.boundary(20_000, &mut random);
        let points = boundary.at(&shape, 3f64.to_radians(), 400, &mut random);
        let share = |inside: bool| {
            let own: Vec<bool> = points
                .iter()
                .filter(|(_, truth)| *truth == inside)
                .map(|(q, _)| (field.state(*q).0 == State::Valid) == inside)
                .collect();
            own.iter().filter(|right| **right).count() as f64 / own.len() as f64
        };
        let balanced = 0.5 * (share(true) + share(false));
        // 0.988 and 0.995 of other samples; two standard deviations of 400 points are 0.01.
        assert!(balanced >= 0.97, "{}: {balanced}", shape.name);
    }
}

#[test]
fn the_nearest_valid_rotation_is_at_the_true_boundary_and_stays() {
    let shape = SHAPES[1];
    let mut random = Random(11);
    let field = learned(&shape, 5000, &mut random);
    let mut off = vec![];
    for _ in 0..300 {
        // From 72 to 100 degrees about any axis; the boundary of the ball is at 70.
        let angle = (72.0 + 28.0 * random.unit()).to_radians();
        let nearest = field.nearest(Quat::exp(random.direction() * angle));
        assert!(field.distance(nearest) >= 0.0);
        assert!(field.nearest(nearest).angle_to(nearest) < 1e-9);
        off.push((nearest.angle_to(Quat::IDENTITY).to_degrees() - 70.0).abs());
    }
    assert!(quantile(&mut off, 0.5) < 1.5);
    assert!(quantile(&mut off, 0.99) < 4.0);
}

#[test]
fn the_gradient_is_that_of_differences_and_signs_of_quaternions_do_not_matter() {
    let mut random = Random(13);
    let field = learned(&SHAPES[0], 1500, &mut random);
    let step = 1e-5;
    for _ in 0..200 {
        let q = random.rotation();
        let minus = Quat { x: -q.x, y: -q.y, z: -q.z, w: -q.w };
        assert_eq!(field.distance(q).to_bits(), field.distance(minus).to_bits());
        let (_, gradient) = field.distance_and_gradient(q);
        for axis in [Vec3::X, Vec3::Y, Vec3::Z] {
            let at = |sign: f64| field.distance(q * Quat::exp(axis * (sign * step)));
            let slope = (at(1.0) - at(-1.0)) / (2.0 * step);
            // A C² spline has a jump of its third derivative at nodes, and 1e-5 squared is 1e-10.
            assert!((slope - gradient.dot(axis)).abs() < 1e-5, "{slope} {gradient:?}");
        }
    }
}

#[test]
fn the_volume_is_the_true_one() {
    let mut random = Random(17);
    let field = learned(&SHAPES[1], 5000, &mut random);
    let valid = (0..20_000).filter(|_| field.state(random.rotation()).0 == State::Valid).count();
    // A ball of 70 degrees has (θ - sin θ)/π of all rotations; the estimate's deviation is 2 % of it.
    let angle = 70f64.to_radians();
    let truth = (angle - angle.sin()) / std::f64::consts::PI;
    let share = valid as f64 / 20_000.0;
    assert!((share / truth - 1.0).abs() < 0.06, "{share} {truth}");
}
