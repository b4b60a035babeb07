//! Twist, its bounds, and legal rotations, with the derivatives of all of them.

use crate::shapes::{Random, SCALE, angle, around, edges, make, polar, shapes, twisted};
use condyle_math::{Mat3, Quat, SwingTwist, Vec3};
use condyle_model::{Cone, ConePoint, Projection};
use std::f64::consts::{FRAC_PI_2, PI};

/// Central difference of several numbers along a rotation vector of the parent's frame.
fn difference<const N: usize>(
    rotation: Mat3,
    omega: Vec3,
    f: impl Fn(Mat3) -> [f64; N],
) -> [f64; N] {
    let h = 1e-6;
    let at = |h: f64| f(Quat::exp(omega * h).to_mat3() * rotation);
    let (plus, minus) = (at(h), at(-h));
    std::array::from_fn(|k| (plus[k] - minus[k]) / (2.0 * h))
}

#[test]
fn gradients_are_central_differences() {
    let mut random = Random(5);
    let (mut compared, mut kinks) = (0, 0);
    for (name, rest, points, subdivisions) in shapes() {
        let cone = twisted(rest, &points, subdivisions, Projection::Nearest);
        for _ in 0..400 * SCALE {
            let (rotation, omega) = (random.rotation(), random.direction());
            let v = rotation * rest;
            if v.dot(rest).abs() > 0.995 {
                continue;
            }
            let (_, gradient) = cone.distance(v);
            assert!((gradient.norm() - 1.0).abs() < 1e-12 && gradient.dot(v).abs() < 1e-12);
            for gradient in cone.twist_bounds(v).unwrap().1 {
                assert!(gradient.dot(v).abs() < 1e-12 * (1.0 + gradient.norm()), "{name}");
            }
            // Five numbers and their slopes along omega.
            let numbers = |r: Mat3| {
                let (bounds, rows) = (cone.twist_bounds(r * rest).unwrap().0, cone.rows(r));
                [bounds[0], bounds[1], rows[0].0, rows[1].0, rows[2].0]
            };
            let slopes = |r: Mat3| {
                let v = r * rest;
                let (bounds, rows) = (cone.twist_bounds(v).unwrap().1, cone.rows(r));
                let turned = omega.cross(v);
                let rows = rows.map(|row| row.1.dot(omega));
                [bounds[0].dot(turned), bounds[1].dot(turned), rows[0], rows[1], rows[2]]
            };
            let measured = difference(rotation, omega, numbers);
            let exact = slopes(rotation);
            // The change of the slopes over two step lengths: proportional to the length if there
            // is no kink.
            let [short, long] = [2e-6, 4e-6].map(|h| {
                let [minus, plus] =
                    [-h, h].map(|h| slopes(Quat::exp(omega * h).to_mat3() * rotation));
                [0, 1, 2, 3, 4].map(|k| plus[k] - minus[k])
            });
            for k in 0..5 {
                // A kink within the step, or the twist opposite to the middle of its bounds.
                if (long[k] - 2.0 * short[k]).abs() > 2e-8 || measured[k].abs() > 1e4 {
                    kinks += 1;
                    continue;
                }
                compared += 1;
                let off = (measured[k] - exact[k]).abs();
                assert!(off < 1e-7 * (1.0 + exact[k].abs()), "{name} {k}: {measured:?} {exact:?}");
            }
            assert!((cone.distance(v).1.dot(omega.cross(v)) - exact[2]).abs() < 1e-12);
        }
    }
    assert!(kinks * 200 < compared, "{kinks} of {compared}");
}

#[test]
fn bounds_of_twist_are_those_given_and_between_them_a_smooth_step() {
    for (name, rest, points, subdivisions) in shapes() {
        let cone = twisted(rest, &points, subdivisions, Projection::Nearest);
        let at_rest = cone.twist_at_rest().unwrap();
        assert_eq!(cone.twist_bounds(rest).unwrap(), (at_rest, [Vec3::ZERO; 2]));
        for point in cone.points() {
            let reach = angle(rest, point.direction);
            let given = point.twist.unwrap_or(at_rest);
            for k in 1..=12 {
                let rho: f64 = 0.1 * f64::from(k);
                if rho * reach > 3.1 {
                    continue;
                }
                let s = if rho < 1.0 { rho * rho * (3.0 - 2.0 * rho) } else { 1.0 };
                let outward = rest.cross(point.direction).normalized().cross(rest);
                let v = rest * (rho * reach).cos() + outward * (rho * reach).sin();
                let bounds = cone.twist_bounds(v).unwrap().0;
                for side in 0..2 {
                    let expected = at_rest[side] + s * (given[side] - at_rest[side]);
                    assert!((bounds[side] - expected).abs() < 1e-11, "{name} {rho}");
                }
            }
        }
    }
    // Between two points at 1 radian and azimuths 0 and 90 degrees the chord's middle is at 45.
    let mut points: Vec<ConePoint> = around(Vec3::Z, &[1.0; 4])
        .into_iter()
        .map(|direction| ConePoint { direction, twist: None })
        .collect();
    points[1].twist = Some([-0.2, 0.4]);
    points[2].twist = Some([-0.6, 0.8]);
    let middle = points[1].direction + points[2].direction;
    let cone = Cone::new(Vec3::Z, Some([-1.0, 1.0]), points, 0, Projection::Nearest).unwrap();
    let bounds = cone.twist_bounds(middle).unwrap().0;
    assert!((bounds[0] + 0.4).abs() < 1e-14 && (bounds[1] - 0.6).abs() < 1e-14, "{bounds:?}");
    // Two subdivisions put three points on that edge, whose bounds are spread evenly between.
    let points = cone.points().to_vec();
    let finer = Cone::new(Vec3::Z, cone.twist_at_rest(), points, 2, Projection::Nearest).unwrap();
    for (k, corner) in finer.boundary().skip(4).take(5).enumerate() {
        let (bounds, t) = (finer.twist_bounds(corner).unwrap().0, 0.25 * k as f64);
        assert!((bounds[0] + 0.2 + 0.4 * t).abs() < 1e-13, "{k}: {bounds:?}");
        assert!((bounds[1] - 0.4 - 0.4 * t).abs() < 1e-13, "{k}: {bounds:?}");
    }
}

#[test]
fn legal_rotations_are_kept_and_others_become_legal_at_once() {
    let mut random = Random(9);
    let twist_of = |r: Mat3, rest| SwingTwist::of(Quat::from_mat3(r), rest).twist_angle(rest);
    let circle = |a: f64, b: f64| (a - b).sin().atan2((a - b).cos()).abs();
    for (name, rest, points, subdivisions) in shapes() {
        for projection in [Projection::Nearest, Projection::TowardRest] {
            let cone = twisted(rest, &points, subdivisions, projection);
            for _ in 0..500 * SCALE {
                let rotation = random.rotation();
                let legal = cone.legal(rotation);
                let rows = cone.rows(rotation).map(|row| row.0);
                assert_eq!(legal.moved, rows.iter().any(|&g| g < 0.0), "{name} {rows:?}");
                if !legal.moved {
                    assert!(legal.rotation == rotation && legal.margin == f64::INFINITY);
                    continue;
                }
                let Mat3 { x, y, z } = legal.rotation;
                let error = [x.dot(y), y.dot(z), z.dot(x), x.cross(y).dot(z) - 1.0];
                assert!(error.iter().all(|e| e.abs() < 1e-14) && (x.norm() - 1.0).abs() < 1e-14);
                assert!(cone.rows(legal.rotation).iter().all(|row| row.0 >= -1e-9), "{name}");
                let again = cone.legal(legal.rotation);
                assert!(!again.moved && again.rotation == legal.rotation, "{name}");
                // The direction is the projected one; the twist is unchanged, or the nearer bound.
                let (v, new) = (rotation * rest, legal.rotation * rest);
                assert!((cone.project(v).direction - new).norm() < 1e-12, "{name}");
                let bounds = cone.twist_bounds(new).unwrap().0;
                let (before, after) = (twist_of(rotation, rest), twist_of(legal.rotation, rest));
                let [lower, upper] = bounds.map(|bound| circle(before, bound));
                let expected = if bounds[0] <= before && before <= bounds[1] {
                    before
                } else if lower < upper {
                    bounds[0]
                } else {
                    bounds[1]
                };
                let room = 1e-13 / (1.0 + v.dot(rest));
                assert!(circle(after, expected) < 1e-12 + room, "{name} {after} {expected}");
            }
        }
    }
}

#[test]
fn on_and_over_edges_and_corners_an_answer_is_final_too() {
    for (name, rest, points, subdivisions) in shapes() {
        for projection in [Projection::Nearest, Projection::TowardRest] {
            let cone = twisted(rest, &points, subdivisions, projection);
            for [p, q] in edges(&cone) {
                for v in [p, (p + q).normalized(), (p * 3.0 + q).normalized()] {
                    for (turn, beyond) in [(-2.0, 1.0), (2.0, 1.0), (3.0, 1.0), (0.0, 1.02)] {
                        let swing = angle(rest, v) * beyond;
                        let swing = Quat::from_axis_angle(rest.cross(v).normalized(), swing);
                        let rotation = (swing * Quat::from_axis_angle(rest, turn)).to_mat3();
                        let legal = cone.legal(rotation);
                        assert!(legal.moved, "{name}");
                        let rows = cone.rows(legal.rotation);
                        assert!(rows.iter().all(|row| row.0 >= -1e-9), "{name} {rows:?}");
                        let again = cone.legal(legal.rotation);
                        assert!(!again.moved && again.rotation == legal.rotation, "{name}");
                        // Steps of factor 4 to a depth of 1e-14, at a sine of 1e-3 or more.
                        let off = angle(legal.rotation * rest, v);
                        let same = beyond == 1.0 || projection == Projection::TowardRest;
                        assert!(!same || off < 4e-11, "{name} {off}");
                    }
                }
            }
        }
    }
}

#[test]
fn the_margin_of_a_twist_is_twice_the_angle_to_where_the_bounds_are_equally_far() {
    let rest = Vec3::new(0.6, 0.0, -0.8);
    let cone = twisted(rest, &around(rest, &[1.0; 6]), 1, Projection::Nearest);
    // Opposite to the middle of [-0.9, 0.6].
    let opposite = PI - 0.15;
    for (off, bound) in [(-0.01, 0.6), (0.01, -0.9), (-0.5, 0.6), (0.5, -0.9)] {
        let turned = Mat3::rotation_about(rest, (f64::sin(opposite + off), (opposite + off).cos()));
        let legal = cone.legal(turned);
        let twist = SwingTwist::of(Quat::from_mat3(legal.rotation), rest).twist_angle(rest);
        assert!((twist - bound).abs() < 1e-14 && angle(legal.rotation * rest, rest) < 1e-14);
        assert!((legal.margin - 2.0 * f64::abs(off)).abs() < 1e-14);
    }
}

#[test]
fn at_the_half_turn_the_twist_is_zero_and_the_nearest_point_is_taken() {
    for (_, rest, points, subdivisions) in shapes() {
        let cone = make(rest, &points, subdivisions, Projection::Nearest);
        let half = Mat3::rotation_about(polar(rest, 1.0, FRAC_PI_2), (0.0, -1.0));
        let legal = cone.legal(half);
        assert!(legal.moved && legal.margin < 1e-12);
        let direction = legal.rotation * rest;
        assert!((angle(direction, -rest) + cone.distance(-rest).0).abs() < 1e-12);
        assert!(SwingTwist::of(Quat::from_mat3(legal.rotation), rest).twist_angle(rest) < 1e-12);
    }
}

#[test]
fn nonsense_breaks_no_limit_and_never_becomes_a_nan() {
    let columns = [
        Vec3::ZERO,
        Vec3::X,
        Vec3::new(1e300, -1e300, 1e308),
        Vec3::new(1e-310, 0.0, -1e-300),
        Vec3::new(f64::NAN, 0.0, 1.0),
        Vec3::new(f64::INFINITY, 1.0, 0.0),
        Vec3::new(-1e20, 1.0, -3.0),
    ];
    for (name, rest, points, subdivisions) in shapes() {
        for projection in [Projection::Nearest, Projection::TowardRest] {
            let cone = twisted(rest, &points, subdivisions, projection);
            for v in columns {
                let says_nothing = v == Vec3::ZERO || !v.is_finite();
                let (distance, gradient) = cone.distance(v);
                assert!(
                    gradient.is_finite() && distance.is_finite() != says_nothing,
                    "{name} {v:?}"
                );
                let projected = cone.project(v);
                if says_nothing {
                    assert!(cone.contains(v) && cone.twist_bounds(v).is_none());
                    assert_eq!(format!("{:?}", projected.direction), format!("{v:?}"));
                } else {
                    assert!(projected.direction.is_finite() && projected.distance.is_finite());
                    let (bounds, gradients) = cone.twist_bounds(v).unwrap();
                    assert!(bounds.iter().all(|b| b.abs() < 1.6));
                    assert!(gradients.iter().all(|g| g.is_finite()));
                }
            }
            for n in 0..columns.len().pow(3) {
                let [x, y, z] = [1, 7, 49].map(|place| columns[n / place % columns.len()]);
                let matrix = Mat3::from_columns(x, y, z);
                let legal = cone.legal(matrix);
                let same = format!("{:?}", legal.rotation) == format!("{matrix:?}");
                let finite = [legal.rotation.x, legal.rotation.y, legal.rotation.z]
                    .iter()
                    .all(|column| column.is_finite());
                assert!(if legal.moved { finite } else { same }, "{name} {matrix:?}");
                assert!(!legal.margin.is_nan());
                for (g, gradient) in cone.rows(matrix) {
                    assert!(!g.is_nan() && gradient.is_finite(), "{name} {matrix:?}");
                }
            }
        }
    }
}
