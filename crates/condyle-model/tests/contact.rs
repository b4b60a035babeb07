//! Contact of the scapula with the ribs: the points are on the surface, at the angle nearest to
//! rest, and the derivatives are right.

use condyle_math::{Affine, Dual, Lane, Mat3, Scalar, Vec3};
use condyle_model::component::{ContactError, ContactPair, Glide, Gliding};
use std::f64::consts::{PI, TAU};

/// Numbers in [-1, 1) from a linear congruential generator.
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (self.0 >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }

    fn vector(&mut self, size: f64) -> Vec3 {
        Vec3::new(self.next(), self.next(), self.next()) * size
    }
}

/// A contact, a pose and drivers: radii of 5 to 20 cm, points within 15 cm of the joint, the joint
/// up to a third of a radius off the surface.
fn random_case(random: &mut Random, pairs: usize) -> (Gliding, Affine, [f64; 2]) {
    let radii = Vec3::from([0; 3].map(|_| 0.125 + 0.075 * random.next()));
    let on = random.vector(1.0).normalized().times(radii);
    let joint = on * (1.0 + 0.33 * random.next());
    let turn = random.vector(1.0);
    let rotation = Mat3::rotation_about(turn.normalized(), (2.0 * turn.x).sin_cos());
    let centres = [random.vector(0.07), random.vector(0.07)];
    let pairs = (0..pairs)
        .map(|_| ContactPair {
            first: centres[0] + random.vector(0.015),
            second: centres[1] + random.vector(0.015),
            at: [random.next(), random.next()],
        })
        .collect();
    let gliding = Gliding::new(Affine::IDENTITY, radii, random.vector(1.0), pairs).unwrap();
    (gliding, Affine::new(rotation, joint), [random.next(), random.next()])
}

/// |p/radii|² - 1.
fn level(p: Vec3, r: Vec3) -> f64 {
    (p.x / r.x).powi(2) + (p.y / r.y).powi(2) + (p.z / r.z).powi(2) - 1.0
}

/// The distance of a point from the surface, to first order near it.
fn off_surface(p: Vec3, r: Vec3) -> f64 {
    let per: Vec3 = r.to_array().map(|r| 1.0 / (r * r)).into();
    level(p, r).abs() / (2.0 * p.times(per).norm())
}

/// The two turns of a glide as functions of the angle: f of the first and of the second point.
fn turns<'a>(
    g: &'a Gliding,
    pose: Affine,
    drivers: &[f64],
    glide: &Glide,
) -> [Box<dyn Fn(f64) -> f64 + 'a>; 2] {
    let [first, second] = g.points(drivers);
    let axis = g.axis();
    let about_first = Mat3::rotation_about(axis, glide.angles[0].sin_cos());
    let [r, x2] = [g.radii(), first.normalized()];
    [
        Box::new(move |x| level(pose * (Mat3::rotation_about(axis, x.sin_cos()) * first), r)),
        Box::new(move |x| {
            let turn = about_first * Mat3::rotation_about(x2, x.sin_cos());
            level(pose * (turn * second), r)
        }),
    ]
}

/// The roots in (-π, π] that a scan of `steps` angles brackets, nearest to rest first.
fn scanned_roots(f: &dyn Fn(f64) -> f64, steps: usize) -> Vec<f64> {
    let at = |i: usize| i as f64 * TAU / steps as f64 - PI;
    let mut roots = vec![];
    let mut before = f(at(0));
    for i in 0..steps {
        let after = f(at(i + 1));
        if (before < 0.0) != (after < 0.0) {
            let (mut a, mut b) = (at(i), at(i + 1));
            for _ in 0..60 {
                let m = 0.5 * (a + b);
                if (f(m) < 0.0) == (before < 0.0) { a = m } else { b = m }
            }
            roots.push(a);
        }
        before = after;
    }
    roots.sort_by(|a, b| a.abs().total_cmp(&b.abs()));
    roots
}

/// The distance of a point from an ellipsoid by grids that are refined around their best point.
///
/// The nearest point lies in the same octant as the point; a cube's three faces cover it, without
/// the poles of longitude and latitude.
fn slow_distance(p: Vec3, r: Vec3) -> f64 {
    let p: Vec3 = p.to_array().map(f64::abs).into();
    let mut least = f64::INFINITY;
    for face in 0..3 {
        let distance = |a: f64, b: f64| {
            let mut direction = [1.0, a, b];
            direction.rotate_right(face);
            (Vec3::from(direction).normalized().times(r) - p).norm()
        };
        let mut best = (f64::INFINITY, 0.5, 0.5);
        let (mut reach, mut steps) = (0.5, 30);
        for _ in 0..45 {
            let centre = (best.1, best.2);
            for i in -steps..=steps {
                for j in -steps..=steps {
                    let h = reach / f64::from(steps);
                    let (a, b) = (centre.0 + f64::from(i) * h, centre.1 + f64::from(j) * h);
                    let d = distance(a, b);
                    if d < best.0 {
                        best = (d, a, b);
                    }
                }
            }
            (reach, steps) = (reach * 0.6, 5);
        }
        least = least.min(best.0);
    }
    least.copysign(level(p, r))
}

#[test]
fn what_glides_touches_at_the_root_nearest_to_rest_or_comes_as_near_as_it_can() {
    let mut random = Random(3);
    let (mut touching, mut apart, mut tied, mut compared) = ([0; 2], [0; 2], 0, 0);
    let (mut worst_off, mut worst_gap): (f64, f64) = (0.0, 0.0);
    for case in 0..20_000 {
        let (g, pose, drivers) = random_case(&mut random, case % 4 + 1);
        let glide = g.glide(pose, &drivers);
        let points = g.points(&drivers);
        let r = g.radii();
        // The rotation is the product of the two, and leaves the first point where the first put it.
        let first_turn = Mat3::rotation_about(g.axis(), glide.angles[0].sin_cos());
        let second_turn = Mat3::rotation_about(points[0].normalized(), glide.angles[1].sin_cos());
        let product = first_turn * second_turn;
        for (a, b) in [product.x, product.y, product.z].into_iter().zip([
            glide.rotation.x,
            glide.rotation.y,
            glide.rotation.z,
        ]) {
            assert!((a - b).norm() < 1e-14, "{case} {glide:?}");
        }
        let fs = turns(&g, pose, &drivers, &glide);
        let mut next = f64::INFINITY;
        for k in 0..2 {
            let placed = pose * (glide.rotation * points[k]);
            let f = &fs[k];
            let angle = glide.angles[k];
            assert!(angle.abs() <= PI + 1e-12, "{case} {angle}");
            if glide.gaps[k] == 0.0 {
                touching[k] += 1;
                worst_off = worst_off.max(off_surface(placed, r));
                let roots = scanned_roots(f, 500);
                // The scan misses a pair of roots closer than its step; the kernel does not.
                let Some(&nearest) = roots.first() else { continue };
                assert!(angle.abs() < nearest.abs() + 1e-9, "{case} {angle} {roots:?}");
                if (angle.abs() - nearest.abs()).abs() > 1e-9 {
                    tied += 1;
                } else {
                    next = next.min(roots[1].abs() - nearest.abs());
                }
            } else {
                apart[k] += 1;
                // f has one sign, and |f| is nowhere smaller.
                let least = (0..500)
                    .map(|i| f(f64::from(i) * TAU / 500.0) * f(angle).signum())
                    .fold(f64::INFINITY, f64::min);
                assert!(least >= f(angle).abs() * (1.0 - 1e-12) - 1e-14, "{case} {least}");
                assert_eq!(glide.gaps[k] > 0.0, f(angle) > 0.0, "{case}");
                if compared < 400 {
                    compared += 1;
                    let expected = slow_distance(placed, r);
                    worst_gap = worst_gap.max((glide.gaps[k] / expected - 1.0).abs());
                }
            }
        }
        if tied == 0 && next.is_finite() {
            // The scan may have missed a nearer pair: then the kernel's value is smaller.
            assert!(glide.next <= next + 1e-8, "{case} {} {next}", glide.next);
            if glide.next < next - 1e-8 {
                assert!(glide.next >= 0.0);
                tied += 1;
            }
        }
    }
    println!("touching {touching:?}, apart {apart:?}, seen finer than the scan: {tied}");
    println!("worst distance of a contact {worst_off:.1e} m, worst gap {worst_gap:.1e} of itself");
    assert!(touching.iter().chain(&apart).all(|&n| n > 2000), "{touching:?} {apart:?}");
    assert!(tied < 40, "{tied}");
    assert!(worst_off < 1e-9 && worst_gap < 1e-6, "{worst_off} {worst_gap}");
    assert_eq!(compared, 400);
}

/// Eight numbers that move a case: rotations about x, y, z, translations, the two drivers.
fn moved<S: Lane>(g: &Gliding, pose: Affine, drivers: [f64; 2], by: [S; 8]) -> Glide<S> {
    let turn = Mat3::rotation_x(by[0]) * Mat3::rotation_y(by[1]) * Mat3::rotation_z(by[2]);
    let step = Vec3::new(by[3], by[4], by[5]);
    let pose = Affine::new(turn * pose.linear.cast(), pose.translation.cast() + step);
    let drivers = [0, 1].map(|i| S::from_f64(drivers[i]) + by[6 + i]);
    g.glide(pose, &drivers)
}

fn numbers<S: Scalar>(glide: &Glide<S>) -> [S; 13] {
    let Mat3 { x, y, z } = glide.rotation;
    let ([a, b], [c, d]) = (glide.angles, glide.gaps);
    [x.x, x.y, x.z, y.x, y.y, y.z, z.x, z.y, z.z, a, b, c, d]
}

#[test]
fn slopes_by_all_motions_and_drivers_are_those_of_central_differences() {
    let mut random = Random(4);
    let (mut touching, mut apart, mut worst): (_, _, f64) = (0, 0, 0.0);
    for case in 0..6000 {
        let (g, pose, drivers) = random_case(&mut random, case % 4 + 1);
        let variables = std::array::from_fn(|i| Dual::<8>::variable(0.0, i));
        let exact = moved(&g, pose, drivers, variables);
        let plain = g.glide(pose, &drivers);
        let values = numbers(&plain);
        for (a, b) in numbers(&exact).iter().zip(values) {
            assert!((a.value - b).abs() < 1e-14 && a.partials.iter().all(|p| p.is_finite()));
        }
        // Away from where roots or extrema merge or another one is as near.
        let fs = turns(&g, pose, &drivers, &plain);
        let calm = (0..2).all(|k| {
            let (f, x, h) = (&fs[k], plain.angles[k], 1e-4);
            let steep = (f(x + h) - f(x - h)).abs() / (2.0 * h);
            let bent = (f(x + h) - 2.0 * f(x) + f(x - h)).abs() / (h * h);
            if plain.gaps[k] == 0.0 {
                steep > 0.5
            } else {
                // The curvature of gaps is large only deep inside, where the nearest point changes
                // sides.
                bent > 0.5 && plain.gaps[k].abs() > 1e-3 && plain.gaps[k] > -0.01
            }
        });
        if !calm || plain.next < 0.05 || g.points(&drivers)[0].norm() < 0.02 {
            continue;
        }
        if plain.gaps == [0.0; 2] {
            touching += 1
        } else {
            apart += 1
        }
        for i in 0..8 {
            let at = |x: f64| {
                let mut by = [0.0; 8];
                by[i] = x;
                numbers(&moved(&g, pose, drivers, by))
            };
            let h = 5e-6;
            let [a, b, c, d] = [at(-2.0 * h), at(-h), at(h), at(2.0 * h)];
            for k in 0..13 {
                // Fourth order: rounding is 1e-15/h, and the fifth derivative has h⁴ before it.
                let central = (a[k] - 8.0 * b[k] + 8.0 * c[k] - d[k]) / (12.0 * h);
                let exact = numbers(&exact)[k].partials[i];
                let off = (exact - central).abs() / (1.0 + central.abs());
                worst = worst.max(off);
                assert!(off < 1e-7, "{case} {i} {k} {exact} {central} {plain:?}");
            }
        }
    }
    println!("slopes compared: {touching} touching, {apart} apart, worst {worst:.1e}");
    assert!(touching > 200 && apart > 200, "{touching} {apart}");
}

/// The pairs and the axis of Shao & Ng-Thow-Hing 2003, section 5.2, in metres; the third pair is
/// printed without z, taken here as 0 for illustration. Where the drivers are is not printed.
fn shao() -> (Vec3, Vec<ContactPair>) {
    let pair = |first: [f64; 3], second: [f64; 3], at| {
        let [first, second] = [first, second].map(|p| Vec3::from(p) * 0.01);
        ContactPair { first, second, at }
    };
    let pairs = vec![
        pair([8.5, -4.0, -0.3], [8.7, -2.4, -0.1], [1.0, 0.0]),
        pair([8.2, 0.0, -0.1], [7.5, 2.0, 0.0], [-1.0, 0.0]),
        pair([8.2, -0.8, 0.0], [7.3, -0.6, 0.0], [0.0, 1.0]),
    ];
    (Vec3::new(0.263, -0.912, 0.314), pairs)
}

#[test]
fn the_pairs_of_shao_and_ng_thow_hing_glide_on_the_ellipsoid() {
    let (axis, pairs) = shao();
    // Half axes of 7, 15 and 7 cm (Seth et al. 2016). The place of the joint is not printed; here it
    // is 8, 5 and 6 cm from the centre, with the plate of the scapula, which the points span with x
    // and y, reaching back across x.
    let radii = Vec3::new(0.07, 0.15, 0.07);
    let g = Gliding::new(Affine::IDENTITY, radii, axis, pairs.clone()).unwrap();
    let joint = Vec3::new(0.08, 0.05, 0.06);
    let lying = Mat3::from_columns(-Vec3::X, Vec3::Y, -Vec3::Z);
    let pose = Affine::new(lying, joint);
    for (k, pair) in pairs.iter().enumerate() {
        let [first, second] = g.points(&pair.at);
        assert!((first - pair.first).norm() + (second - pair.second).norm() < 1e-16, "pair {k}");
    }
    // Lifted, then lowered, then rotated.
    let path = |s: f64| if s < 0.5 { [1.0 - 4.0 * s, 0.0] } else { [2.0 * s - 2.0, 2.0 * s - 1.0] };
    for step in 0..=400 {
        let drivers = path(f64::from(step) / 400.0);
        let glide = g.glide(pose, &drivers);
        assert_eq!(glide.gaps, [0.0; 2], "{drivers:?} {glide:?}");
        for point in g.points(&drivers) {
            assert!(off_surface(pose * (glide.rotation * point), radii) < 1e-12, "{drivers:?}");
        }
        let fs = turns(&g, pose, &drivers, &glide);
        for k in 0..2 {
            let nearest = scanned_roots(&fs[k], 2000)[0];
            assert!((glide.angles[k] - nearest).abs() < 1e-12, "{drivers:?} {glide:?} {nearest}");
        }
    }
    // No discontinuity on the way: the largest change decreases with the step size.
    let largest = |n: u32| {
        let angles = |i: u32| g.glide(pose, &path(f64::from(i) / f64::from(n))).angles;
        let step = |i: u32| {
            let (a, b) = (angles(i), angles(i + 1));
            (a[0] - b[0]).abs().max((a[1] - b[1]).abs())
        };
        (0..n).map(step).fold(0.0, f64::max)
    };
    let (coarse, fine) = (largest(400), largest(4000));
    assert!(coarse < 0.1 && fine < 0.11 * coarse, "{coarse} {fine}");
}

#[test]
fn the_angle_is_continuous_as_the_point_leaves_the_surface_and_the_gap_opens_from_0() {
    // The point turns about z on a circle of 0.1 about (0.15, 0, 0): it comes to x = 0.05 at most,
    // so a sphere of radius r > 0.05 is met where r² = 0.0325 - 0.03·cos(π - θ)...
    let pairs = |first| vec![ContactPair { first, second: Vec3::Z * 0.1, at: [0.0; 2] }];
    let pose = Affine::from_translation(Vec3::new(0.15, 0.0, 0.0));
    let first = Vec3::new(-0.08, 0.06, 0.0);
    let rest = (0.6f64).atan2(0.8);
    for miss in [1e-2, 1e-4, 1e-6, 1e-8, 1e-10, 1e-13, 0.0] {
        for sign in [-1.0, 1.0] {
            let radius = 0.05 + sign * miss;
            let g = Gliding::new(
                Affine::IDENTITY,
                Vec3::new(1.0, 1.0, 1.0) * radius,
                Vec3::Z,
                pairs(first),
            );
            let glide = g.unwrap().glide(pose, &[]);
            // |p|² = 0.0225 + 0.01 - 0.03·cos ε with ε the angle from the nearest place.
            let cos = ((0.0325 - radius * radius) / 0.03f64).min(1.0);
            let expected = rest - cos.acos();
            // The square root of the rounding of the cosine.
            assert!((glide.angles[0] - expected).abs() < 1e-7, "{radius} {glide:?} {expected}");
            let gap = (0.05 - radius).max(0.0);
            assert!((glide.gaps[0] - gap).abs() < 1e-15, "{radius} {glide:?}");
        }
    }
}

#[test]
fn two_sphere_contacts_are_those_worked_out_by_hand() {
    // Unit-free: joint at (2, 0, 0) of a sphere of radius 1, first point (-√3, 0, 0) turned about
    // z: |p|² = 4 + 3 - 4√3·cos θ = 1 gives cos θ = √3/2, 30 degrees either way.
    let arm = 3f64.sqrt();
    let pair = ContactPair {
        first: Vec3::new(-arm, 0.1, 0.0) * (arm / (arm * arm + 0.01).sqrt()),
        second: Vec3::new(-1.6, 0.0, 0.9),
        at: [0.0; 2],
    };
    let offset = (0.1f64 / arm).atan();
    let g = Gliding::new(Affine::IDENTITY, Vec3::new(1.0, 1.0, 1.0), Vec3::Z, vec![pair]).unwrap();
    let pose = Affine::from_translation(Vec3::X * 2.0);
    let glide = g.glide(pose, &[]);
    // The point starts above the line to the centre by `offset`, so the root above is nearer: it is
    // reached by turning on clockwise, and the other one by twice the offset more.
    assert!((glide.angles[0] + (PI / 6.0 - offset)).abs() < 1e-14, "{glide:?}");
    assert!(glide.next <= 2.0 * offset + 1e-14, "{glide:?}");
    assert_eq!(glide.gaps, [0.0; 2]);
}

#[test]
fn no_input_breaks_it() {
    let mut random = Random(5);
    let numbers_of = [0.0, 1e-300, 1e-12, 0.1, 1.0, 1e9, -1e9, 1e160, 1e300];
    let odd = [f64::NAN, f64::INFINITY, f64::NEG_INFINITY];
    let mut pick = |list: &[f64]| {
        let at = (random.next() * 0.5 + 0.5) * list.len() as f64;
        list[(at as usize).min(list.len() - 1)]
    };
    let mut made = 0;
    for case in 0..30_000 {
        let mut vector = |list: &[f64]| Vec3::new(pick(list), pick(list), pick(list));
        let radii = vector(&[1e-12, 1e-3, 0.1, 0.1, 1.0, 1e9]);
        let usual = [0.0, 0.0, 0.1, -0.1, 1e-12, 1e9];
        let pairs = [[0.0, 0.0], [1.0, 0.0], [0.0, 1e-5]].map(|at| ContactPair {
            first: vector(&usual),
            second: vector(&usual),
            at,
        });
        let axis = vector(&[0.0, 1.0]);
        let mut drivers = [0.0, 1.0, 0.3, 1e300].map(|_| 0.0);
        let source = if case % 3 == 0 { &odd[..] } else { &numbers_of[..] };
        let at = vector(source);
        drivers[0] = at.x;
        let linear = match case % 5 {
            0 => Mat3::from_columns(Vec3::ZERO, Vec3::ZERO, Vec3::ZERO),
            1 => Mat3::from_columns(at, Vec3::Y, Vec3::Z),
            _ => Mat3::IDENTITY,
        };
        let translation = if case % 2 == 0 { at } else { vector(&usual) };
        let pairs = pairs[..case % 3 + 1].to_vec();
        let Ok(g) = Gliding::new(Affine::IDENTITY, radii, axis, pairs) else { continue };
        made += 1;
        let glide = g.glide(Affine::new(linear, translation), &drivers[..case % 4]);
        let all = numbers(&glide);
        assert!(all[..11].iter().all(|x| x.is_finite()), "{case} {g:?} {glide:?}");
        assert!(!all[11].is_nan() && !all[12].is_nan() && !glide.next.is_nan(), "{case} {glide:?}");
        let off = (glide.rotation.transpose() * glide.rotation).x - Vec3::X;
        assert!(off.norm() < 1e-12, "{case} {glide:?}");
        // Finite slopes as well, at any tangency.
        if translation.is_finite() && translation.norm() < 1e10 && linear == Mat3::IDENTITY {
            let variables = std::array::from_fn(|i| Dual::<8>::variable(0.0, i));
            let exact = moved(&g, Affine::new(linear, translation), [0.3, 0.0], variables);
            let finite = numbers(&exact).iter().all(|x| x.partials.iter().all(|p| p.is_finite()));
            assert!(finite, "{case} {g:?} {exact:?}");
        }
    }
    assert!(made > 10_000, "{made}");
}

#[test]
fn points_on_their_axes_do_not_turn_and_tell_their_distance() {
    // The first point on the axis, the second on the line to the first: rotations have no effect.
    let pair = ContactPair { first: Vec3::Z * 0.1, second: Vec3::Z * 0.05, at: [0.0; 2] };
    let radii = Vec3::new(0.07, 0.15, 0.07);
    let g = Gliding::new(Affine::IDENTITY, radii, Vec3::Z, vec![pair]).unwrap();
    let glide = g.glide(Affine::IDENTITY, &[]);
    assert_eq!((glide.angles, glide.rotation), ([0.0; 2], Mat3::IDENTITY));
    assert!((glide.gaps[0] - 0.03).abs() < 1e-16 && (glide.gaps[1] + 0.02).abs() < 1e-16);
    assert_eq!(glide.next, f64::INFINITY);
    // Between a pair and its mirror image the first point passes the joint: there ψ is 0.
    let mirrored = |sign: f64, at: f64| ContactPair {
        first: Vec3::X * (0.1 * sign),
        second: Vec3::new(0.0, 0.1, 0.05),
        at: [at, 0.0],
    };
    let pairs = vec![mirrored(1.0, 0.0), mirrored(-1.0, 1.0)];
    let g = Gliding::new(Affine::IDENTITY, radii, Vec3::Z, pairs).unwrap();
    let glide = g.glide(Affine::from_translation(Vec3::Y * 0.2), &[0.5]);
    assert_eq!(glide.angles, [0.0; 2]);
    let expected = slow_distance(Vec3::new(0.0, 0.3, 0.05), radii);
    assert!((glide.gaps[1] / expected - 1.0).abs() < 1e-6, "{glide:?} {expected}");
}

#[test]
fn what_nothing_can_glide_with_is_refused_with_a_remedy() {
    let (axis, pairs) = shao();
    let radii = Vec3::new(0.07, 0.15, 0.07);
    let make = |radii, axis, pairs| {
        let error = Gliding::new(Affine::IDENTITY, radii, axis, pairs).unwrap_err();
        (error, error.to_string())
    };
    let with = |i: usize, pair: ContactPair| {
        let mut pairs = pairs.clone();
        pairs[i] = pair;
        pairs
    };
    let (error, text) = make(Vec3::new(0.07, 0.0, 0.07), axis, pairs.clone());
    assert_eq!(error, ContactError::Radii);
    assert!(text.contains("three half axes in metres"), "{text}");
    assert_eq!(make(radii, Vec3::ZERO, pairs.clone()).0, ContactError::Axis);
    assert_eq!(make(radii, axis, vec![]).0, ContactError::NoPairs);
    let five = [0, 1, 2, 3, 4].map(|i| ContactPair { at: [f64::from(i), 0.0], ..pairs[0] });
    let (error, text) = make(radii, axis, five.to_vec());
    assert_eq!(error, ContactError::TooManyPairs(5));
    assert!(text.contains("4 are the most"), "{text}");
    let (error, text) = make(radii, axis, with(2, ContactPair { at: pairs[1].at, ..pairs[2] }));
    assert_eq!(error, ContactError::EqualPlaces(1, 2));
    assert!(text.contains("pairs 2 and 3"), "{text}");
    let (error, text) = make(radii, axis, with(1, ContactPair { first: Vec3::ZERO, ..pairs[1] }));
    assert_eq!(error, ContactError::FirstOnOrigin(1));
    assert!(text.contains("pair 2"), "{text}");
    let bad = with(0, ContactPair { at: [f64::NAN, 0.0], ..pairs[0] });
    assert_eq!(make(radii, axis, bad).0, ContactError::NotFinite);
    assert_eq!(make(Vec3::X * f64::INFINITY, axis, pairs).0, ContactError::NotFinite);
}

/// The smallest time of one call in nanoseconds over all cases, without and with eight derivatives.
fn clock(cases: &[&(Gliding, Affine, [f64; 2])]) -> [f64; 2] {
    let mut best = [f64::INFINITY; 2];
    let per = 1.0 / cases.len() as f64;
    for _ in 0..200 {
        let start = std::time::Instant::now();
        for (g, pose, drivers) in cases {
            std::hint::black_box(g.glide(*pose, drivers));
        }
        best[0] = best[0].min(start.elapsed().as_nanos() as f64 * per);
        let start = std::time::Instant::now();
        for (g, pose, drivers) in cases {
            let variables = std::array::from_fn(|i| Dual::<8>::variable(0.0, i));
            std::hint::black_box(moved(g, *pose, *drivers, variables));
        }
        best[1] = best[1].min(start.elapsed().as_nanos() as f64 * per);
    }
    best
}

/// `cargo test --release -p condyle-model --test contact -- --ignored --nocapture`
#[test]
#[ignore = "a clock, for release builds"]
fn nanoseconds_of_one_glide() {
    let (axis, pairs) = shao();
    let g = Gliding::new(Affine::IDENTITY, Vec3::new(0.07, 0.15, 0.07), axis, pairs).unwrap();
    let lying = Mat3::from_columns(-Vec3::X, Vec3::Y, -Vec3::Z);
    let pose = Affine::new(lying, Vec3::new(0.08, 0.05, 0.06));
    let motion: Vec<_> = (0..300)
        .map(|i| (g.clone(), pose, [f64::from(i) / 150.0 - 1.0, f64::from(i) / 300.0]))
        .collect();
    let [plain, slopes] = clock(&motion.iter().collect::<Vec<_>>());
    println!("along a motion, three pairs: {plain:.0} ns, with 8 derivatives {slopes:.0} ns");
    let mut random = Random(6);
    let all: Vec<_> = (0..1000).map(|i| random_case(&mut random, i % 4 + 1)).collect();
    for touching in [2, 1, 0] {
        let count = |gaps: [f64; 2]| gaps.iter().filter(|&&gap| gap == 0.0).count();
        let of = |case: &&(Gliding, Affine, [f64; 2])| {
            count(case.0.glide(case.1, &case.2).gaps) == touching
        };
        let [plain, slopes] = clock(&all.iter().filter(of).collect::<Vec<_>>());
        println!(
            "at random, {touching} touching: {plain:.0} ns, with 8 derivatives {slopes:.0} ns"
        );
    }
}
