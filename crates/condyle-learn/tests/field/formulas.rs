//! Fields of limits by formulas against the formulas themselves.

use condyle_learn::limits::field::{made, shaped};
use condyle_learn::limits::{Field, State, uniform};
use condyle_math::{Mat3, Quat, Vec3};
use condyle_model::limit::field::{Ends, Shape};
use std::sync::Arc;

fn radians(degrees: &[f64]) -> Vec<f64> {
    degrees.iter().map(|angle| angle.to_radians()).collect()
}

/// Lenarčič & Umek 1994 for a right arm in the axes of the ISB, as tables.
fn shoulder(beyond: f64) -> Shape {
    let second = Ends::new(
        radians(&[0.0, 180.0]),
        vec![],
        radians(&[-43.0, 17.0]),
        radians(&[153.0, 123.0]),
    );
    let third = Ends::new(
        radians(&[0.0, 90.0]),
        radians(&[0.0, 90.0]),
        radians(&[-90.0, -100.0, -20.0, -10.0]),
        radians(&[60.0, 10.0, 100.0, 100.0]),
    );
    let first = [-9.0, 160.0].map(f64::to_radians);
    let axes = [-Vec3::X, Vec3::Z, -Vec3::Y];
    Shape::new(axes, first, second.unwrap(), third.unwrap(), beyond.to_radians()).unwrap()
}

fn field(shape: Shape, nodes: usize) -> Field {
    made(&Arc::new(shaped(shape, Some(nodes))))
}

/// The formulas as they are printed, with both triples of angles of a rotation found from its matrix.
fn printed(q: Quat) -> bool {
    let m: Mat3 = q.to_mat3();
    let column = |axis: Vec3| m * axis;
    let [x, y, z] = [column(Vec3::X), column(Vec3::Y), column(Vec3::Z)];
    // R = Rx(-a)·Rz(f)·Ry(-t): row x is (cos f cos t, -sin f, -cos f sin t), column y below it cos f·(cos a, -sin a).
    let flexion = (-y.x).asin().to_degrees();
    let abduction = (-y.z).atan2(y.y).to_degrees();
    let turn = (-z.x).atan2(x.x).to_degrees();
    let around = |angle: f64| [angle - 360.0, angle, angle + 360.0];
    [(abduction, flexion, turn), (abduction + 180.0, 180.0 - flexion, turn + 180.0)]
        .into_iter()
        .flat_map(|(a, f, t)| around(a).into_iter().flat_map(move |a| around(f).map(|f| (a, f, t))))
        .filter(|(a, f, _)| {
            (-9.0..=160.0).contains(a) && (-43.0 + a / 3.0..=153.0 - a / 6.0).contains(f)
        })
        .any(|(a, f, t)| {
            let low = -90.0 + 7.0 * a / 9.0 - f / 9.0 + 2.0 * a * f / 810.0;
            let high = 60.0 + 4.0 * a / 9.0 - 5.0 * f / 9.0 + 5.0 * a * f / 810.0;
            [t - 720.0, t - 360.0, t, t + 360.0].iter().any(|t| (low..=high).contains(t))
        })
}

#[test]
fn tables_of_two_rows_and_columns_are_the_printed_formulas() {
    let shape = shoulder(0.0);
    let inside = uniform(20_000).filter(|q| {
        assert_eq!(shape.contains(*q), printed(*q), "{q:?}");
        printed(*q)
    });
    // Of all rotations 13 % are inside: by Haar's measure, ∫ cos f (high - low) over the ends, over 8π².
    let share = inside.count() as f64 / 2e4;
    let (mut sum, step) = (0.0, 0.25);
    for i in 0..676 {
        let a = -9.0 + (f64::from(i) + 0.5) * step;
        let mut f = -43.0 + a / 3.0 + 0.5 * step;
        while f < 153.0 - a / 6.0 {
            let low = -90.0 + 7.0 * a / 9.0 - f / 9.0 + 2.0 * a * f / 810.0;
            let high = 60.0 + 4.0 * a / 9.0 - 5.0 * f / 9.0 + 5.0 * a * f / 810.0;
            sum +=
                f.to_radians().cos().abs() * (high - low).to_radians() * step.to_radians().powi(2);
            f += step;
        }
    }
    let by_formula = sum / (8.0 * std::f64::consts::PI.powi(2));
    assert!((share - by_formula).abs() < 0.005, "{share} {by_formula}");
    let learned = field(shoulder(0.0), 56).learned().valid;
    assert!((learned - by_formula).abs() < 0.001, "{learned} {by_formula}");
}

#[test]
fn distances_are_those_to_the_boundary_of_the_formulas() {
    let shape = shoulder(0.0);
    let at = |parts: [f64; 3]| shape.rotation(shape.angles_at(parts)).to_array().map(|c| c as f32);
    // Places a degree apart, which are nearer than the nearest by half a degree where that is 0 and by 0.01 at 20.
    let mut places = vec![];
    for (i, j) in (0..=170).flat_map(|i| (0..=170).map(move |j| (i, j))) {
        let (u, v) = (f64::from(i) / 170.0, f64::from(j) / 170.0);
        for end in [0.0, 1.0] {
            places.extend([at([end, u, v]), at([u, end, v]), at([u, v, end])]);
        }
    }
    let (field, margin) = (field(shoulder(0.0), 56), field(shoulder(15.0), 56));
    let (mut off, mut wrong) = (vec![], 0);
    for q in uniform(1500) {
        let p = q.to_array().map(|c| c as f32);
        let cosine = |r: &[f32; 4]| (p[0] * r[0] + p[1] * r[1] + p[2] * r[2] + p[3] * r[3]).abs();
        let nearest = places.iter().map(cosine).fold(0.0, f32::max);
        let away = 2.0 * f64::from(nearest.min(1.0)).acos();
        let truth = if shape.contains(q) { away } else { -away };
        off.push((field.distance(q) - truth).abs().to_degrees());
        wrong += usize::from(away > 0.035 && (field.distance(q) > 0.0) != (truth > 0.0));
        // What is outside by less than 15 degrees is inside what goes 15 degrees beyond.
        if truth < 0.0 {
            let beyond = (margin.distance(q) - truth).to_degrees();
            assert!((beyond - 15.0).abs() < 4.0, "{beyond}");
        }
    }
    off.sort_by(f64::total_cmp);
    let quantile = |part: f64| off[(part * (off.len() - 1) as f64) as usize];
    assert!(
        quantile(0.5) < 0.2 && quantile(0.95) < 1.0 && quantile(0.99) < 2.0,
        "{}",
        quantile(0.99)
    );
    assert!(wrong <= 1, "{wrong}");
}

#[test]
fn the_nearest_is_inside_and_as_far_as_the_distance_says() {
    let field = field(shoulder(15.0), 56);
    let mut off = vec![];
    for q in uniform(3000).filter(|q| field.state(*q).0 == State::Invalid) {
        let nearest = field.nearest(q);
        assert!(field.distance(nearest) >= 0.0);
        assert!(field.nearest(nearest).angle_to(nearest) < 1e-9);
        assert!(field.evidence(q).angle.is_nan());
        off.push((q.angle_to(nearest) + field.distance(q)).to_degrees().abs());
    }
    off.sort_by(f64::total_cmp);
    assert!(off.len() > 1000);
    assert!(off[off.len() / 2] < 0.2 && off[off.len() * 95 / 100] < 1.0, "{}", off[off.len() / 2]);
}

/// A box of angles far from where first and third turn meet, about axes of no one's.
#[test]
fn axes_may_be_any_and_of_either_hand() {
    let turned = Quat::from_axis_angle(Vec3::new(1.0, 2.0, 3.0).normalized(), 1.0);
    let axes = Vec3::UNITS.map(|axis| turned.to_mat3() * axis);
    let ends = |low: f64, high: f64| Ends::fixed([low.to_radians(), high.to_radians()]);
    let first = [-50.0, 40.0].map(f64::to_radians);
    for hand in [1.0, -1.0] {
        let axes = [axes[0], axes[1], axes[2] * hand];
        let shape = Shape::new(axes, first, ends(-20.0, 30.0), ends(-10.0, 60.0), 0.0).unwrap();
        let at = |angles: [f64; 3]| shape.rotation(angles.map(f64::to_radians));
        for (angles, inside) in [
            ([-49.0, -19.0, -9.0], true),
            ([39.0, 29.0, 59.0], true),
            ([41.0, 0.0, 0.0], false),
            ([0.0, 31.0, 0.0], false),
            ([0.0, 0.0, 61.0], false),
            ([0.0, 0.0, -11.0], false),
        ] {
            assert_eq!(shape.contains(at(angles)), inside, "{angles:?}");
        }
        // Along one turn alone its end is the nearest boundary; inside, 5 degrees from where another end is as near, the spline
        // is off by a tenth of a step.
        let field = field(shape.clone(), 56);
        for (angles, distance, most) in
            [([0.0, 0.0, 20.0], 20.0, 0.7), ([60.0, 0.0, 20.0], -20.0, 0.1)]
        {
            let found = field.distance(at(angles)).to_degrees();
            assert!((found - distance).abs() < most, "{found} {distance}");
        }
    }
}

#[test]
fn what_is_no_shape_is_refused() {
    let ends = |low: f64, high: f64| Ends::fixed([low, high]);
    let says = |shape: Result<Shape, condyle_model::limit::field::ShapeError>| {
        shape.err().map(|error| error.message).unwrap_or_default()
    };
    let oblique = [Vec3::X, Vec3::new(1.0, 1.0, 0.0), Vec3::Z];
    let shape = |axes, first, second, third, beyond| Shape::new(axes, first, second, third, beyond);
    let right = Vec3::UNITS;
    for (shape, said) in [
        (shape(oblique, [-1.0, 1.0], ends(-1.0, 1.0), ends(-1.0, 1.0), 0.0), "perpendicular"),
        (shape(right, [1.0, -1.0], ends(-1.0, 1.0), ends(-1.0, 1.0), 0.0), "do not rise"),
        (shape(right, [-1.0, 1.0], ends(-4.0, 1.0), ends(-1.0, 1.0), 0.0), "ends of the second"),
        (shape(right, [-1.0, 1.0], ends(-1.0, 1.0), ends(-4.0, 4.0), 0.0), "ends of the third"),
        (shape(right, [-1.0, 1.0], ends(-1.0, 1.0), ends(-1.0, 1.0), -0.1), "beyond"),
    ] {
        assert!(says(shape).contains(said), "{said}");
    }
    // Lines that cross between rows, and rows that are not there.
    let crossing = Ends::new(vec![0.0, 0.5], vec![], vec![-1.0, 0.4], vec![1.0, 0.5]).unwrap();
    let crossed = Shape::new(right, [-1.0, 1.0], crossing, ends(-1.0, 1.0), 0.0);
    assert!(says(crossed).contains("ends of the second"));
    assert!(Ends::new(vec![0.0, 0.5], vec![], vec![-1.0], vec![1.0]).is_err());
    assert!(Ends::new(vec![0.5, 0.0], vec![], vec![-1.0; 2], vec![1.0; 2]).is_err());
    assert!(Ends::new(vec![0.0], vec![], vec![1.0], vec![-1.0]).is_err());
    assert!(Ends::new(vec![0.0], vec![], vec![f64::NAN], vec![1.0]).is_err());
}
