//! Invalid cones and their errors.

use crate::shapes::polar;
use condyle_math::Vec3;
use condyle_model::{Cone, ConeError, ConePoint, Projection};

#[test]
fn what_is_no_cone_is_refused_with_its_points_and_a_remedy() {
    let at = |azimuths: &[f64], angles: &[f64]| -> Vec<ConePoint> {
        let pairs = azimuths.iter().zip(angles);
        pairs
            .map(|(a, &angle)| ConePoint {
                direction: polar(Vec3::Z, a.to_radians(), angle),
                twist: None,
            })
            .collect()
    };
    let square = at(&[0.0, 90.0, 180.0, 270.0], &[1.0; 4]);
    let with = |i: usize, direction, twist| {
        let mut points = square.clone();
        points[i] = ConePoint { direction, twist };
        points
    };
    let one = square[1].direction;
    let bounds = Some([-1.0, 1.0]);
    let refuse = |rest, twist, points: &[ConePoint], n, expected: ConeError, word: &str| {
        let error = Cone::new(rest, twist, points.to_vec(), n, Projection::Nearest).unwrap_err();
        assert_eq!(error, expected);
        assert!(error.to_string().contains(word), "{error}");
    };
    let z = Vec3::Z;
    refuse(Vec3::ZERO, None, &square, 0, ConeError::NoRest, "long axis");
    refuse(Vec3::new(f64::NAN, 0.0, 1.0), None, &square, 0, ConeError::NoRest, "not finite");
    let bad = with(2, Vec3::ZERO, None);
    refuse(z, None, &bad, 0, ConeError::NoDirection { point: 2 }, "point 2");
    refuse(z, None, &square[..2], 0, ConeError::TooFewPoints { count: 2 }, "at least 3");
    let many = |subdivisions| ConeError::TooManyPoints { count: 4, subdivisions };
    refuse(z, None, &square, 8, many(8), "512");
    refuse(z, None, &square, u32::MAX, many(u32::MAX), "less often");
    let crossing = |point| ConeError::TwistCrossing { point };
    refuse(z, Some([0.2, 0.1]), &square, 0, crossing(None), "at rest");
    let bad = with(1, one, Some([0.2, 0.1]));
    refuse(z, bounds, &bad, 0, crossing(Some(1)), "at point 1");
    let bad = with(1, one, Some([-30.0, 40.0]));
    refuse(z, bounds, &bad, 0, ConeError::TwistRange { point: Some(1) }, "radians");
    let nan = Some([f64::NAN, 0.0]);
    refuse(z, nan, &square, 0, ConeError::TwistRange { point: None }, "at rest");
    let bad = with(1, one, bounds);
    refuse(z, None, &bad, 0, ConeError::NoTwistAtRest { point: 1 }, "bounds at rest");
    let bad = with(2, one * 3.0, None);
    refuse(z, None, &bad, 0, ConeError::Coincident { from: 1, to: 2 }, "points 1 and 2");
    let bad = with(2, -one, None);
    refuse(z, None, &bad, 0, ConeError::HalfTurn { from: 1, to: 2 }, "opposite ways");
    let bad = with(3, -Vec3::Z, None);
    refuse(z, None, &bad, 0, ConeError::OppositeRest { point: 3 }, "toward the rest");
    for rest in [square[1].direction, square[0].direction + square[1].direction, Vec3::X] {
        refuse(rest, None, &square, 0, ConeError::RestOutside, "strictly inside");
    }
    // A hook: seen from rest, the second point is behind the third.
    let hook = at(&[0.0, 120.0, 100.0, 240.0], &[1.0, 1.2, 0.5, 1.0]);
    let hidden = |from, to, refined| ConeError::Hidden { from, to, refined };
    refuse(z, None, &hook, 0, hidden(1, 2, false), "from point 1 to point 2");
    let reversed: Vec<ConePoint> = hook.iter().rev().copied().collect();
    refuse(z, None, &reversed, 0, hidden(1, 2, false), "from point 1 to point 2");
    // At 0.01 degrees to a meridian.
    let steep = at(&[0.0, 120.0, 120.01, 240.0], &[1.0, 0.5, 1.0, 1.0]);
    refuse(z, None, &steep, 0, hidden(1, 2, false), "does not see");
    // The refined boundary passes the direction opposite to rest, the arcs between the points do
    // not.
    let wide = at(&[0.0, 90.0, 95.0, 180.0, 270.0], &[0.2, 3.0, 3.1, 0.2, 0.2]);
    refuse(z, None, &wide, 2, hidden(1, 2, true), "after subdivision");
    let twice = at(&[0.0, 144.0, 288.0, 72.0, 216.0], &[1.0; 5]);
    refuse(z, None, &twice, 0, ConeError::WoundTwice, "more than once");
}
