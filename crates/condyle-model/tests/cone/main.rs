//! The joint cone against a slow reference implementation, on random directions, paths and
//! rotations.

mod refusals;
mod rotations;
mod shapes;

use condyle_math::{Quat, Vec3};
use condyle_model::Projection;
use shapes::{
    Random, SCALE, angle, angle_to_boundary, around, crosses, edges, make, polar, shapes,
};
use std::f64::consts::{PI, TAU};

#[test]
fn membership_is_the_parity_of_crossings_to_a_point_inside() {
    let mut random = Random(1);
    for (name, rest, points, subdivisions) in shapes() {
        let cone = make(rest, &points, subdivisions, Projection::Nearest);
        let edges = edges(&cone);
        // Not rest itself, which the implementation uses.
        let room = angle_to_boundary(rest, &edges);
        let inner = polar(rest, 2.0, 0.4 * room);
        let mut inside = 0;
        for _ in 0..10_000 * SCALE {
            let v = random.direction();
            let even = edges.iter().filter(|&&edge| crosses(inner, v, edge)).count() % 2 == 0;
            let (distance, _) = cone.distance(v);
            for (answer, which) in [(cone.contains(v), "contains"), (distance >= 0.0, "distance")] {
                assert!(
                    answer == even || angle_to_boundary(v, &edges) < 1e-9,
                    "{name}: {which} at {v:?}"
                );
            }
            inside += usize::from(even);
        }
        assert!(inside > 100 * SCALE, "{name}: the polygon has an inside");
        assert!(!cone.contains(-rest) && cone.contains(rest));
    }
}

#[test]
fn the_nearest_projection_beats_every_sampled_point_of_the_boundary() {
    let mut random = Random(2);
    for (name, rest, points, subdivisions) in shapes() {
        let cone = make(rest, &points, subdivisions, Projection::Nearest);
        let edges = edges(&cone);
        let each = 100_000usize.div_ceil(edges.len());
        let samples = edges.iter().flat_map(|&[p, q]| {
            (0..each).map(move |k| {
                let t = k as f64 / each as f64;
                (p * (1.0 - t) + q * t).normalized()
            })
        });
        let samples: Vec<Vec3> = samples.collect();
        for _ in 0..12 * SCALE {
            let v = random.direction();
            // The largest cosine is the smallest angle; the exact angle is computed for that one
            // only.
            let best = samples.iter().copied().max_by(|a, b| a.dot(v).total_cmp(&b.dot(v)));
            let best = angle(v, best.unwrap());
            let (distance, _) = cone.distance(v);
            assert!(distance.abs() <= best + 1e-12, "{name}: {distance} {best}");
            assert!((distance.abs() - angle_to_boundary(v, &edges)).abs() < 1e-14, "{name}");
            let projected = cone.project(v);
            if distance < 0.0 {
                assert!(projected.distance <= best + 1e-12, "{name}");
                assert!((projected.distance + distance).abs() < 1e-12, "{name}");
                assert!((angle(v, projected.direction) - projected.distance).abs() < 1e-15);
                assert!(angle_to_boundary(projected.direction, &edges) < 1e-12, "{name}");
            } else {
                assert_eq!(projected.direction, v);
            }
        }
    }
}

#[test]
fn what_was_projected_is_inside_and_stays() {
    let mut random = Random(3);
    for (name, rest, points, subdivisions) in shapes() {
        for projection in [Projection::Nearest, Projection::TowardRest] {
            let cone = make(rest, &points, subdivisions, projection);
            // Exactly on corners, on edges, opposite to both, and anywhere.
            let mut directions = vec![-rest];
            for [p, q] in edges(&cone) {
                directions.extend([p, -p, q + p, -q - p, p.cross(q), q.cross(p)]);
            }
            directions.extend((0..1000 * SCALE).map(|_| random.direction()));
            for v in directions {
                let projected = cone.project(v);
                assert!(cone.contains(projected.direction), "{name} {v:?}");
                // A direction on the boundary is inside to rounding, by the edge of either side.
                let room = if projected.distance > 0.0 { 0.0 } else { 1e-15 };
                assert!(cone.distance(projected.direction).0 >= -room, "{name} {v:?}");
                let again = cone.project(projected.direction);
                assert_eq!((again.direction, again.distance), (projected.direction, 0.0));
                let toward = projection == Projection::TowardRest && angle(v, -rest) > 1e-9;
                if projected.distance > 0.0 && toward {
                    // On the meridian through v, nearer to rest, at the boundary.
                    let x = projected.direction;
                    let v = v.normalized();
                    assert!(rest.cross(v).normalized().dot(x).abs() < 1e-12, "{name}");
                    assert!((angle(rest, x) + angle(x, v) - angle(rest, v)).abs() < 1e-12);
                    // Steps of factor 4 to a depth of 1e-14, at a sine of 1e-3 or more.
                    assert!(cone.distance(x).0 < 4e-11, "{name}");
                }
            }
        }
        let toward = make(rest, &points, subdivisions, Projection::TowardRest);
        let nearest = make(rest, &points, subdivisions, Projection::Nearest);
        assert_eq!(toward.project(-rest).direction, nearest.project(-rest).direction);
        assert_eq!(toward.project(-rest).margin, 0.0);
    }
}

#[test]
fn many_points_on_a_circle_are_the_circular_cone() {
    let rest = Vec3::new(-0.2, 0.9, 0.4).normalized();
    let mut random = Random(4);
    for (count, radius) in [(16usize, 0.6), (512, 0.6), (512, 1.2), (16, 1.4)] {
        let cone = make(rest, &around(rest, &vec![radius; count]), 0, Projection::Nearest);
        // tan a = tan r · cos(π/n) is the inscribed circle; the sagitta r - a bounds the loss.
        let apothem = (radius.tan() * (PI / count as f64).cos()).atan();
        for _ in 0..1000 {
            let v = random.direction();
            let circular = radius - angle(rest, v);
            let ours = cone.distance(v).0;
            assert!(ours <= circular.abs().copysign(circular) + 1e-12, "inside the circle");
            assert!(circular - ours <= radius - apothem + 1e-12, "{circular} {ours}");
            // On the meridians of edge middles inside, and of corners outside, it is exact.
            let at = random.within(0.0, apothem);
            let middle = polar(rest, TAU * 2.5 / count as f64, at);
            assert!((cone.distance(middle).0 - (apothem - at)).abs() < 1e-12);
            let at = random.within(radius, PI);
            let beyond = polar(rest, TAU * 3.0 / count as f64, at);
            assert!((cone.distance(beyond).0 - (radius - at)).abs() < 1e-12);
        }
    }
}

#[test]
fn control_points_stay_on_the_refined_boundary() {
    for (name, rest, points, _) in shapes() {
        // The refined boundary through such teeth is not star-shaped.
        let most = if name == "saw" { 0 } else { 3 };
        for subdivisions in 0..=most {
            let cone = make(rest, &points, subdivisions, Projection::Nearest);
            assert_eq!(cone.boundary().len(), points.len() << subdivisions);
            for &p in &points {
                let off = cone.boundary().map(|q| (p - q).norm()).fold(f64::INFINITY, f64::min);
                assert!(off < 1e-15 && cone.distance(p).0.abs() < 1e-15, "{name} {off}");
            }
        }
    }
    // One point between two, by the weights -1/16, 9/16, 9/16, -1/16 in the chart about z: with
    // q = θ·(cos φ, sin φ) at φ = 0, 90, 180, 270 degrees and θ = 1.0, 0.8, 0.6, 0.8.
    let corner = |x: f64, y: f64| {
        let angle = x.hypot(y);
        Vec3::new(x / angle * angle.sin(), y / angle * angle.sin(), angle.cos())
    };
    let points = [corner(1.0, 0.0), corner(0.0, 0.8), corner(-0.6, 0.0), corner(0.0, -0.8)];
    let cone = make(Vec3::Z, &points, 1, Projection::Nearest);
    let expected = corner(9.0 / 16.0 + 0.6 / 16.0, 9.0 / 16.0 * 0.8 + 0.8 / 16.0);
    assert!(cone.boundary().any(|q| (q - expected).norm() < 1e-15));
}

/// Steps along a random path: pairs of consecutive directions and the angle between them.
fn path(random: &mut Random, steps: usize, mut visit: impl FnMut(Vec3, Vec3)) {
    let step = 0.05f64.to_radians();
    let mut v = random.direction();
    let mut axis = v.cross(random.direction()).normalized();
    for _ in 0..steps {
        let next = (Quat::from_axis_angle(axis, step).to_mat3() * v).normalized();
        visit(v, next);
        v = next;
        let turn = random.within(-0.02, 0.02);
        axis = (Quat::from_axis_angle(v, turn).to_mat3() * axis).normalized();
        axis = (axis - v * axis.dot(v)).normalized();
    }
}

#[test]
fn along_paths_the_nearest_projection_jumps_only_where_its_margin_says() {
    let mut random = Random(6);
    let step = 0.05f64.to_radians();
    for (name, rest, points, subdivisions) in shapes() {
        let cone = make(rest, &points, subdivisions, Projection::Nearest);
        let corners: Vec<Vec3> = cone.boundary().collect();
        let convex =
            edges(&cone).iter().all(|[p, q]| corners.iter().all(|c| p.cross(*q).dot(*c) > -1e-12));
        let (mut jumps, mut outside) = (0, 0);
        let mut visit = |v: Vec3, next: Vec3| {
            let (a, b) = (cone.project(v), cone.project(next));
            if cone.contains(v) {
                assert!(a.direction == v && a.distance == 0.0 && a.margin == f64::INFINITY);
            } else {
                outside += 1;
            }
            let moved = (a.direction - b.direction).norm();
            if moved > 20.0 * step {
                jumps += 1;
                assert!(a.margin.max(b.margin) < 2.0 * step, "{name}: {moved} {a:?} {b:?}");
            }
            // The nearest point of a convex polygon is the nearest point of the convex cone over
            // it, drawn out to length 1. The first is no longer step than that of v; the second
            // divides by the length of the point in the cone, the cosine of the distance.
            let far = a.distance.max(b.distance);
            if convex && far < 89f64.to_radians() {
                assert!(moved <= (v - next).norm() / far.cos() + 1e-11, "{name}: {moved} {far}");
                assert!(far > 87f64.to_radians() || a.margin == f64::INFINITY, "{name}");
            }
        };
        path(&mut random, 15_000 * SCALE, &mut visit);
        // Past the pole of each edge, along it: the nearest point moves from one end to the other.
        for [p, q] in edges(&cone) {
            let (normal, middle) = (p.cross(q).normalized(), (p + q).normalized());
            let at = |k: i32| {
                let turned = Quat::from_axis_angle(middle, f64::from(k) * step).to_mat3();
                (middle * 0.01 - turned * normal).normalized()
            };
            (-80..80).for_each(|k| visit(at(k), at(k + 1)));
        }
        assert!(outside > 1000);
        assert_eq!(convex, ["triangle", "convex", "hemisphere"].contains(&name), "{name}");
        if name.contains("star") {
            assert!(jumps > 0, "{name}: the path crosses where two tips are equally near");
        }
    }
}

#[test]
fn along_paths_the_projection_toward_rest_never_jumps() {
    let mut random = Random(8);
    for (name, rest, points, subdivisions) in shapes() {
        let cone = make(rest, &points, subdivisions, Projection::TowardRest);
        let turned = |a: Vec3, b: Vec3| {
            let (a, b) = (rest.cross(a).normalized(), rest.cross(b).normalized());
            angle(a, b)
        };
        // The largest change of the boundary per azimuth.
        let mut steepest: f64 = 0.0;
        for [p, q] in edges(&cone) {
            let at =
                |k: usize| (p * (1.0 - k as f64 / 500.0) + q * (k as f64 / 500.0)).normalized();
            for k in 0..500 {
                steepest = steepest.max((at(k + 1) - at(k)).norm() / turned(at(k), at(k + 1)));
            }
        }
        path(&mut random, 15_000 * SCALE, |v, next| {
            let (a, b) = (cone.project(v), cone.project(next));
            if cone.contains(v) {
                assert!(a.direction == v && a.distance == 0.0);
            } else if !cone.contains(next) && angle(v, -rest) > 1f64.to_radians() {
                let moved = (a.direction - b.direction).norm();
                let bound = 1.02 * steepest * turned(v, next) + 1e-11;
                assert!(moved <= bound, "{name}: {moved} {bound}");
                assert!((a.margin - angle(v, -rest)).abs() < 1e-12);
            } else if !cone.contains(next) || angle(v, -rest) > 1f64.to_radians() {
                // Into the polygon or out of it: the projection follows the edge to v.
                let moved = angle(a.direction, b.direction);
                assert!(moved <= angle(v, next) + a.distance + b.distance + 1e-12, "{name}");
            }
        });
    }
}
