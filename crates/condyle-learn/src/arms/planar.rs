//! The planar knee of Yamaguchi & Zajac 1989.
//!
//! Where the origin of the tibia is along x (forward) and y (up) of the femur, from the centre of the hip, as a function of
//! the knee's angle about z (flexion negative), in metres and radians; knots as in Delp's model of 1990 (`gait2392`). Between
//! them runs the cubic of SIMM, beyond them a straight line.

use condyle_diagnostics::Error;
use condyle_math::function::{Curve, Function, SimmSpline};

/// Angle and place forward.
#[expect(clippy::approx_constant, reason = "knots are those of the source, digit by digit")]
const FORWARD: [[f64; 2]; 12] = [
    [-2.0944, -0.0032],
    [-1.74533, 0.00179],
    [-1.39626, 0.00411],
    [-1.0472, 0.0041],
    [-0.698132, 0.00212],
    [-0.349066, -0.001],
    [-0.174533, -0.0031],
    [0.197344, -0.005227],
    [0.337395, -0.005435],
    [0.490178, -0.005574],
    [1.52146, -0.005435],
    [2.0944, -0.00525],
];

/// Angle and place upward.
#[expect(clippy::approx_constant, reason = "knots are those of the source, digit by digit")]
const UPWARD: [[f64; 2]; 7] = [
    [-2.0944, -0.4226],
    [-1.22173, -0.4082],
    [-0.523599, -0.399],
    [-0.349066, -0.3976],
    [-0.174533, -0.3966],
    [0.159149, -0.395264],
    [2.0944, -0.396],
];

/// The distance from hip to knee of that model while the knee is straight, in metres: its y at 0.
pub const PLANAR_LENGTH: f64 = 0.395_820_696_4;

/// The places forward and upward as functions of the angle about z, times a factor and moved, so that at the angle `from`, both
/// are `at`. A `sense` of -1 takes angles with flexion positive.
///
/// ```
/// use condyle_learn::arms::planar;
/// // Unmoved: the table of the source at 30 degrees of flexion, in metres.
/// let [x, y] = planar(1.0, 1.0, 0.0, None)?;
/// let flexed = -30f64.to_radians();
/// assert!((x.value_and_slope(flexed).0 - 0.757712e-3).abs() < 1e-9);
/// assert!((y.value_and_slope(flexed).0 + 399.0e-3).abs() < 1e-8);
/// # Ok::<(), condyle_diagnostics::Error>(())
/// ```
///
/// # Errors
/// `arms/planar` where a number is not finite, the factor is 0 or the sense is neither 1 nor -1.
pub fn planar(
    factor: f64,
    sense: f64,
    from: f64,
    at: Option<[f64; 2]>,
) -> Result<[Function; 2], Error> {
    let wrong = |what: &str| Error::new("arms/planar", format!("the planar knee has {what}"));
    if sense.abs() != 1.0 || factor == 0.0 {
        return Err(wrong("a factor of 0, or a sense that is neither 1 nor -1"));
    }
    let moved = |knots: &[[f64; 2]], at: Option<f64>| -> Result<Function, Error> {
        let mut knots = knots.to_vec();
        if sense < 0.0 {
            knots.reverse();
        }
        let x: Vec<f64> = knots.iter().map(|knot| sense * knot[0]).collect();
        let mut y: Vec<f64> = knots.iter().map(|knot| factor * knot[1]).collect();
        let spline = |y: Vec<f64>| {
            SimmSpline::new(x.clone(), y).map_err(|_| wrong("a number that is not finite"))
        };
        if let Some(at) = at {
            let shift = at - spline(y.clone())?.value_and_slope(from).0;
            y.iter_mut().for_each(|y| *y += shift);
        }
        Ok(Function::from(Curve::SimmSpline(spline(y)?)))
    };
    Ok([moved(&FORWARD, at.map(|at| at[0]))?, moved(&UPWARD, at.map(|at| at[1]))?])
}

#[cfg(test)]
mod tests {
    use super::{PLANAR_LENGTH, planar};

    /// Degrees of flexion, forward and upward in millimetres, as OpenSim's SimmSpline has them; -140 and -120 to the digits
    /// given are beyond the first knot and just within it.
    const GOLDEN: [[f64; 3]; 11] = [
        [-140.0, -9.645639, -427.95950],
        [-90.0, 3.258752, -413.99220],
        [-75.0, 4.319661, -409.61308],
        [-60.0, 4.0999916, -405.49607],
        [-45.0, 2.729400, -401.87857],
        [-30.0, 0.757712, -399.00000],
        [-15.0, -2.072733, -397.06109],
        [-5.0, -3.910036, -396.18837],
        [0.0, -4.499857, -395.82070],
        [5.0, -4.908674, -395.49718],
        [10.0, -5.175703, -395.21801],
    ];

    #[test]
    fn values_are_those_of_the_source() {
        let [x, y] = planar(1.0, 1.0, 0.0, None).unwrap();
        for [degrees, forward, upward] in GOLDEN {
            let angle = f64::to_radians(degrees);
            let found = [x.value_and_slope(angle).0, y.value_and_slope(angle).0];
            // Half a unit of the last digit: forward is given to 1e-9 m, upward to 1e-8.
            assert!((found[0] - 1e-3 * forward).abs() < 1e-9, "{degrees}: {found:?}");
            assert!((found[1] - 1e-3 * upward).abs() < 1e-8, "{degrees}: {found:?}");
        }
        assert!((y.value_and_slope(0.0).0 + PLANAR_LENGTH).abs() < 1e-9);
    }

    #[test]
    fn a_knee_that_is_moved_turned_and_larger_glides_alike() {
        let [x, y] = planar(1.0, 1.0, 0.0, None).unwrap();
        let [u, v] = planar(1.1, -1.0, 0.1, Some([0.01, -0.44])).unwrap();
        assert!((u.value_and_slope(0.1).0 - 0.01).abs() < 1e-15);
        assert!((v.value_and_slope(0.1).0 + 0.44).abs() < 1e-15);
        for angle in [0.0, 0.5, 1.0, 2.5] {
            for (one, other) in [(&x, &u), (&y, &v)] {
                let glide = one.value_and_slope(-angle).0 - one.value_and_slope(-0.1).0;
                let other = other.value_and_slope(angle).0 - other.value_and_slope(0.1).0;
                assert!((1.1 * glide - other).abs() < 1e-14, "{angle}: {glide} {other}");
            }
        }
    }
}
