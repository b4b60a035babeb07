//! Pixels that geometry determines.

use condyle_math::{Affine, Mat3, Vec3};
use condyle_render::{
    Bounds, Camera, Canvas, Ground, Label, Line, Picture, Scene, Surface, palette, render, shape,
};
use std::f64::consts::PI;

const FORWARD: [f64; 3] = [1.0, 0.0, 0.0];
const UP: [f64; 3] = [0.0, 1.0, 0.0];

/// A camera from the front (x towards the viewer, z to the left) that shows so many metres.
fn front(height: f64) -> Camera {
    Camera { height, ..Camera::looking(FORWARD, UP, 0.0, 0.0) }
}

fn only(surface: Surface) -> Scene {
    Scene { surfaces: vec![surface], ..Scene::default() }
}

/// A square across the view, `x` towards the viewer.
fn square(x: f64, size: f64, colour: palette::Colour) -> Surface {
    let mut surface = Surface::empty(colour);
    let corner = |y: f64, z: f64| Vec3::new(x, y * size, z * size);
    surface.flat([corner(-1.0, 1.0), corner(-1.0, -1.0), corner(1.0, -1.0)]);
    surface.flat([corner(-1.0, 1.0), corner(1.0, -1.0), corner(1.0, 1.0)]);
    surface
}

/// Pixels that something covers, those at edges in part: the share of the way from the background to black.
fn covered(picture: &Canvas) -> f64 {
    let [r, ..] = palette::BACKGROUND.map(|c| linear(f64::from(c)));
    let share = |pixel: &palette::Colour| (r - linear(f64::from(pixel[0]))) / r;
    picture.pixels().iter().map(share).sum()
}

/// sRGB to linear, IEC 61966-2-1.
fn linear(byte: f64) -> f64 {
    let x = byte / 255.0;
    if x <= 0.04045 { x / 12.92 } else { ((x + 0.055) / 1.055).powf(2.4) }
}

/// The share of red, green and blue.
fn hue(pixel: palette::Colour) -> [f64; 3] {
    let sum: f64 = pixel.iter().map(|&c| f64::from(c)).sum();
    pixel.map(|c| f64::from(c) / sum)
}

#[test]
fn a_sphere_covers_pi_r_squared() {
    let scene = only(shape::ball([0.0; 3], 0.4, [0, 0, 0]));
    let picture = render(&scene, &front(1.0), 400, 400);
    let differs = picture.pixels().iter().filter(|p| **p != palette::BACKGROUND).count();
    // A pixel on the edge counts as a whole one: half a pixel all around, 2·π·r/2.
    let radius = 0.4 * 400.0;
    let expected = PI * radius * radius + PI * radius;
    assert!((differs as f64 / expected - 1.0).abs() < 0.01, "{differs} {expected}");
}

#[test]
fn edges_are_covered_in_part() {
    // A black line is not lit: covered pixels are its area, 300.5 by 7.25.
    let half = 300.5 / 2.0 / 400.0;
    let points = vec![[0.0, 0.0, half], [0.0, 0.0, -half]];
    let line = Line { points, width: 7.25, colour: [0; 3], opacity: 1.0, through: 0.0 };
    let picture = render(&Scene { lines: vec![line], ..Scene::default() }, &front(1.0), 400, 400);
    let area = covered(&picture);
    assert!((area / (300.5 * 7.25) - 1.0).abs() < 0.03, "{area}");
}

#[test]
fn the_nearer_of_two_is_seen_in_either_order() {
    let (near, far) = (square(0.1, 0.2, [200, 0, 0]), square(-0.1, 0.4, [0, 0, 200]));
    for surfaces in [vec![near.clone(), far.clone()], vec![far, near]] {
        let scene = Scene { surfaces, ..Scene::default() };
        let seen = render(&scene, &front(1.0), 100, 100);
        let back = Camera::looking(FORWARD, UP, PI, 0.0);
        let behind = render(&scene, &back, 100, 100);
        assert!(hue(seen.at(50, 50).unwrap())[0] > 0.6, "the red one is in front");
        assert!(hue(seen.at(50, 15).unwrap())[2] > 0.6, "the blue one is larger");
        assert!(hue(behind.at(50, 50).unwrap())[2] > 0.6, "from behind, the blue one is in front");
    }
}

#[test]
fn two_that_cross_are_seen_on_their_sides() {
    // Planes x = z and x = -z: the one that is nearer changes in the middle.
    let plane = |slope: f64, colour| {
        let mut surface = Surface::empty(colour);
        let corner = |y: f64, z: f64| Vec3::new(slope * z, y, z);
        surface.flat([corner(-1.0, 1.0), corner(-1.0, -1.0), corner(1.0, -1.0)]);
        surface.flat([corner(-1.0, 1.0), corner(1.0, -1.0), corner(1.0, 1.0)]);
        surface
    };
    let surfaces = vec![plane(1.0, [200, 0, 0]), plane(-1.0, [0, 0, 200])];
    let picture = render(&Scene { surfaces, ..Scene::default() }, &front(1.0), 100, 100);
    // z is to the left.
    assert!(hue(picture.at(20, 50).unwrap())[0] > 0.6);
    assert!(hue(picture.at(80, 50).unwrap())[2] > 0.6);
}

#[test]
fn what_is_seen_through_is_mixed_from_back_to_front() {
    let glass = |x, colour| square(x, 0.3, colour).with_opacity(0.5);
    let (red, blue) = (glass(0.1, [255, 0, 0]), glass(-0.1, [0, 0, 255]));
    for surfaces in [vec![red.clone(), blue.clone()], vec![blue, red]] {
        let picture = render(&Scene { surfaces, ..Scene::default() }, &front(1.0), 60, 60);
        let [r, _, b] = hue(picture.at(30, 30).unwrap());
        assert!(r > b, "half of red over half of blue is redder");
        let [.., blue_behind] = picture.at(30, 30).unwrap();
        assert!(blue_behind > 60, "and blue is seen through it");
    }
}

#[test]
fn triangles_that_share_a_side_neither_gap_nor_overlap() {
    // A translucent fan around a point: a gap would be lighter, an overlap darker than the rest.
    let mut fan = Surface::empty([40, 40, 40]).with_opacity(0.5);
    let at = |i: u32| {
        let (s, c) = (f64::from(i) / 17.0 * 2.0 * PI).sin_cos();
        Vec3::new(0.0, 0.45 * s, 0.45 * c)
    };
    (0..17).for_each(|i| fan.flat([Vec3::new(0.0, 0.013, -0.021), at(i), at(i + 1)]));
    let picture = render(&only(fan), &front(1.0), 301, 301);
    let middle = picture.at(150, 150).unwrap();
    assert_ne!(middle, palette::BACKGROUND);
    for y in 50..250 {
        for x in 50..250 {
            let off = ((x as f64 - 150.0).powi(2) + (y as f64 - 150.0).powi(2)).sqrt();
            if off < 125.0 {
                assert_eq!(picture.at(x, y).unwrap(), middle, "{x} {y}");
            }
        }
    }
}

#[test]
fn a_mirrored_scene_is_covered_as_the_mirrored_picture() {
    let mut bone = Surface::empty(palette::BONE);
    shape::add_ball(&mut bone, Vec3::new(0.1, 0.2, 0.17), 0.12, (24, 16));
    shape::add_cone(&mut bone, Vec3::new(0.0, -0.3, 0.3), Vec3::new(0.2, 0.1, -0.35), 0.1);
    let mut mirrored = bone.clone();
    for p in mirrored.positions.iter_mut().chain(&mut mirrored.normals) {
        p[2] = -p[2];
    }
    mirrored.triangles.iter_mut().for_each(|t| t.swap(1, 2));
    let [one, other] = [bone, mirrored].map(|s| render(&only(s), &front(1.0), 200, 160));
    let mut seen = 0;
    for y in 0..160 {
        for x in 0..200 {
            let covers = |p: &Canvas, x: usize| p.at(x, y) != Some(palette::BACKGROUND);
            seen += usize::from(covers(&one, x));
            assert_eq!(covers(&one, x), covers(&other, 199 - x), "{x} {y}");
        }
    }
    assert!(seen > 2000);
}

#[test]
fn a_cone_is_as_wide_as_its_angle() {
    // From the side, a cone of radius 0.2 and length 0.4 is a triangle: its outline is at 0.2·(1 - t) there.
    let mut cone = Surface::empty([0; 3]);
    shape::add_cone(&mut cone, Vec3::ZERO, Vec3::new(0.0, 0.4, 0.0), 0.2);
    let picture = render(&only(cone), &front(1.0), 500, 500);
    for share in [0.1, 0.3, 0.5, 0.7, 0.9] {
        let row = 250 - (0.4 * share * 500.0) as usize;
        let wide = (0..500).filter(|&x| picture.at(x, row) != Some(palette::BACKGROUND)).count();
        let expected = 2.0 * 0.2 * (1.0 - share) * 500.0;
        // 20 sides are inside the circle by at most 1 - cos 9° = 1.2 %; edges take a pixel each.
        assert!((wide as f64 - expected).abs() < 0.013 * expected + 2.0, "{wide} {expected}");
    }
}

#[test]
fn normals_of_a_stretched_ball_are_across_it() {
    let frame = Affine::from_rotation(Mat3::rotation_z(0.4));
    let radii = [0.1, 0.3, 0.2];
    let surface = shape::ellipsoid(&frame, radii, palette::CONTACT);
    for (p, n) in surface.positions.iter().zip(&surface.normals) {
        // The gradient of Σ (x/r)² in the ellipsoid's own axes.
        let own = frame.linear.transpose() * Vec3::from(*p);
        let steep = Vec3::new(own.x / 0.01, own.y / 0.09, own.z / 0.04);
        let expected = frame.linear * steep.normalized();
        assert!((Vec3::from(*n).normalized() - expected).norm() < 1e-12);
    }
}

#[test]
fn what_is_framed_fits_and_fills() {
    let bounds = Bounds { low: [-0.3, 0.0, -0.9], high: [0.2, 1.7, 0.8] };
    for (azimuth, elevation) in [(0.0, 0.0), (0.6, 0.3), (PI, PI / 2.0), (-1.2, -0.4)] {
        for aspect in [0.4, 1.0, 3.0] {
            let camera = Camera::looking(FORWARD, UP, azimuth, elevation);
            let camera = camera.framing(&bounds, aspect, 0.05);
            let seen: Vec<[f64; 3]> = bounds.corners().iter().map(|&c| camera.seen(c)).collect();
            let most = |i: usize| seen.iter().map(|p| p[i].abs()).fold(0.0, f64::max);
            let free = [0.5 * aspect - most(0) / camera.height, 0.5 - most(1) / camera.height];
            let least = free[0].min(free[1]);
            assert!((least - 0.05).abs() < 1e-12, "{free:?} of {aspect}");
        }
    }
}

#[test]
fn the_ground_hides_what_is_below_it_and_nothing_above() {
    let ground = Ground { up: UP, forward: FORWARD, middle: [0.0; 3], radius: 5.0 };
    let camera = Camera::looking(FORWARD, UP, 0.0, 0.5);
    let at = |y: f64, ground: Option<Ground>| {
        let ball = shape::ball([0.0, y, 0.0], 0.1, [250, 0, 0]);
        let scene = Scene { surfaces: vec![ball], ground, ..Scene::default() };
        let row = 50.0 - camera.seen([0.0, y, 0.0])[1] * 100.0;
        render(&scene, &camera, 100, 100).at(50, row as usize).unwrap()
    };
    assert_eq!(at(0.2, Some(ground)), at(0.2, None));
    assert!(hue(at(-0.2, Some(ground)))[0] < 0.5 * (1.0 / 3.0 + hue(at(-0.2, None))[0]));
}

#[test]
fn bands_in_any_order_make_the_same_picture() {
    let mut surface = Surface::empty(palette::BONE);
    for i in 0..20 {
        let x = f64::from(i) * 0.05 - 0.5;
        shape::add_ball(&mut surface, Vec3::new(x * x, x, 0.3 * x), 0.05, (12, 8));
    }
    let mut scene = only(surface.clone());
    scene.surfaces.push(shape::ball([0.3, 0.0, 0.0], 0.4, palette::LIMIT).with_opacity(0.3));
    scene.labels.push(Label { at: [0.0; 3], text: "here".into(), colour: palette::TEXT });
    let camera = front(1.2);
    let picture = Picture::new(&scene, &camera, 123, 201);
    let mut bands: Vec<_> = (0..picture.bands()).rev().map(|band| picture.band(band)).collect();
    bands.reverse();
    assert_eq!(picture.finish(&bands), render(&scene, &camera, 123, 201));
}

#[test]
fn numbers_that_are_none_draw_nothing_and_do_not_panic() {
    let mut broken = shape::ball([0.0; 3], 0.3, palette::BONE);
    broken.positions[40] = [f64::NAN, 0.0, 0.0];
    broken.positions[41] = [f64::INFINITY, 0.0, 0.0];
    broken.positions[42] = [1e300, -1e300, 1e300];
    broken.triangles.push([0, 1, 4_000_000]);
    let far = Line {
        points: vec![[0.0; 3], [f64::NAN; 3], [1e12, 1e12, 0.0]],
        width: f64::NAN,
        colour: [0; 3],
        opacity: f64::NAN,
        through: 2.0,
    };
    let label = |at| Label { at, text: "é→x".repeat(40), colour: [0; 3] };
    let scene = Scene {
        surfaces: vec![broken, square(f64::NAN, 0.1, [0; 3]).with_opacity(f64::NAN)],
        lines: vec![far],
        labels: vec![label([f64::NAN; 3]), label([0.0; 3])],
        ground: Some(Ground { up: UP, forward: FORWARD, middle: [f64::NAN; 3], radius: 0.0 }),
    };
    for (width, height) in [(0, 0), (1, 1), (3, 0), (200, 2), (64, 64)] {
        for height_shown in [1.0, 0.0, -1.0, f64::NAN, 1e-300, 1e300] {
            let picture = render(&scene, &front(height_shown), width, height);
            assert_eq!(picture.pixels().len(), width * height);
        }
    }
    assert_eq!(Bounds::of([[f64::NAN; 3]]), None);
}
