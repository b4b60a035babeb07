//! True knees.
//!
//! A knee takes the shank from where it is in extension: a slide in the axes of the joint, then Rz(-flexion) · Rx(adduction) · Ry(rotation)
//! with x forward, y up and z to the right, of a right leg.

use condyle_math::function::SimmSpline;
use condyle_math::{Affine, Mat3, Vec3};

/// How a person's shank moves on the thigh.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Knee {
    /// Three free angles, and a slide that is linear in them: metres per radian, a row for each of x, y and z; columns are the
    /// angle about z (negative in flexion), adduction and rotation.
    Linear([[f64; 3]; 3]),
    /// Adduction, rotation and slide follow flexion as in the average of 23 knees of Walker, Rovick & Robertson 1988, by the knots of
    /// Rajagopal et al. 2016; their size.
    Walker(f64),
    /// Flexion alone, and a slide in its plane: Yamaguchi & Zajac 1989 by the knots of gait2392 (Delp et al. 1990); their size.
    Planar(f64),
}

/// At every 10 degrees of flexion: adduction and rotation in radians, slide forward and upward in metres.
const WALKER: [[f64; 4]; 13] = [
    [0.0, 0.0, 0.0, 0.0],
    [0.0126809, 0.059461, 0.000988, 0.000479],
    [0.0226969, 0.109399, 0.001899, 0.000835],
    [0.0296054, 0.150618, 0.002734, 0.001086],
    [0.0332049, 0.18392, 0.003492, 0.001251],
    [0.0335354, 0.210107, 0.004173, 0.001346],
    [0.0308779, 0.229983, 0.004777, 0.001391],
    [0.0257548, 0.24435, 0.005305, 0.001403],
    [0.0189295, 0.254012, 0.005756, 0.0014],
    [0.011407, 0.25977, 0.00613, 0.0014],
    [0.00443314, 0.262428, 0.006427, 0.001421],
    [-0.00050475, 0.262788, 0.006648, 0.001481],
    [-0.0016782, 0.261654, 0.006792, 0.001599],
];

/// The angle about z in radians, and where the tibia then is forward in the femur, in metres.
#[allow(clippy::approx_constant, reason = "the digits of the source")]
const FORWARD: [(f64, f64); 12] = [
    (-2.0944, -0.0032),
    (-1.74533, 0.00179),
    (-1.39626, 0.00411),
    (-1.0472, 0.0041),
    (-0.698132, 0.00212),
    (-0.349066, -0.001),
    (-0.174533, -0.0031),
    (0.197344, -0.005227),
    (0.337395, -0.005435),
    (0.490178, -0.005574),
    (1.52146, -0.005435),
    (2.0944, -0.00525),
];
/// The same upward.
#[allow(clippy::approx_constant, reason = "the digits of the source")]
const UPWARD: [(f64, f64); 7] = [
    (-2.0944, -0.4226),
    (-1.22173, -0.4082),
    (-0.523599, -0.399),
    (-0.349066, -0.3976),
    (-0.174533, -0.3966),
    (0.159149, -0.395264),
    (2.0944, -0.396),
];

fn spline(knots: impl Iterator<Item = (f64, f64)>) -> SimmSpline {
    let (x, y) = knots.unzip();
    SimmSpline::new(x, y).expect("the knots of a table increase")
}

/// Where the tibia of gait2392 is in its femur, forward and upward, in metres; flexion in radians.
///
/// ```
/// use condyle_learn::study::planar_slides;
/// // A cubic through all knots (Forsythe, Malcolm & Moler 1977), linear beyond them.
/// let [forward, upward] = planar_slides(60f64.to_radians());
/// assert!((forward - 4.0999916e-3).abs() < 1e-9 && (upward + 0.40549607).abs() < 1e-8);
/// ```
#[must_use]
pub fn planar_slides(flexion: f64) -> [f64; 2] {
    [spline(FORWARD.into_iter()), spline(UPWARD.into_iter())]
        .map(|spline| spline.value_and_slope(-flexion).0)
}

impl Knee {
    /// What kind it is, in tables.
    #[must_use]
    pub fn name(&self) -> &'static str {
        match self {
            Self::Linear(_) => "linear law",
            Self::Walker(_) => "Walker 1988",
            Self::Planar(_) => "planar, Yamaguchi & Zajac 1989",
        }
    }

    /// A knee that is posed many times: its splines are made once.
    pub(super) fn made(&self) -> MadeKnee {
        let splines = match self {
            Self::Linear(_) => vec![],
            Self::Walker(_) => (0..4)
                .map(|column| {
                    spline((0..13).map(|i| {
                        (f64::to_radians(10.0 * f64::from(i)), WALKER[i as usize][column])
                    }))
                })
                .collect(),
            Self::Planar(_) => vec![spline(FORWARD.into_iter()), spline(UPWARD.into_iter())],
        };
        MadeKnee { knee: *self, splines }
    }
}

/// A knee with its splines.
pub(super) struct MadeKnee {
    knee: Knee,
    splines: Vec<SimmSpline>,
}

impl MadeKnee {
    /// From flexion, adduction and rotation in radians; what the knee does not leave free is not used.
    pub(super) fn moved(&self, [flexion, adduction, rotation]: [f64; 3]) -> Affine {
        let at = |spline: usize, x: f64| self.splines[spline].value_and_slope(x).0;
        let ([adduction, rotation], slide) = match self.knee {
            Knee::Linear(slopes) => {
                let along = |s: [f64; 3]| -s[0] * flexion + s[1] * adduction + s[2] * rotation;
                ([adduction, rotation], Vec3::from(slopes.map(along)))
            }
            Knee::Walker(size) => {
                // Bent backwards it neither tilts nor turns.
                let bent = flexion.max(0.0);
                let slide = Vec3::new(at(2, bent), at(3, bent), 0.0) * size;
                ([at(0, bent), at(1, bent)], slide)
            }
            Knee::Planar(size) => {
                let step = |spline| (at(spline, -flexion) - at(spline, 0.0)) * size;
                ([0.0; 2], Vec3::new(step(0), step(1), 0.0))
            }
        };
        let turn =
            Mat3::rotation_z(-flexion) * Mat3::rotation_x(adduction) * Mat3::rotation_y(rotation);
        Affine::new(turn, slide)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Golden values of the planar knee: flexion in degrees, then forward and upward in mm, computed from its knots by
    /// another program (Forsythe, Malcolm & Moler's cubic; 140 is extrapolated).
    const PLANAR: [[f64; 3]; 12] = [
        [140.0, -9.645639, -427.95950],
        [120.0, -3.199910, -422.59992],
        [90.0, 3.258752, -413.99220],
        [75.0, 4.319661, -409.61308],
        [60.0, 4.0999916, -405.49607],
        [45.0, 2.729400, -401.87857],
        [30.0, 0.757712, -399.00000],
        [15.0, -2.072733, -397.06109],
        [5.0, -3.910036, -396.18837],
        [0.0, -4.499857, -395.82070],
        [-5.0, -4.908674, -395.49718],
        [-10.0, -5.175703, -395.21801],
    ];

    #[test]
    fn the_planar_knee_is_that_of_gait2392() {
        for [flexion, forward, upward] in PLANAR {
            let found = planar_slides(flexion.to_radians());
            assert!((1e3 * found[0] - forward).abs() < 1e-5, "{flexion}: {found:?}");
            assert!((1e3 * found[1] - upward).abs() < 1e-4, "{flexion}: {found:?}");
        }
        // A knee of that size slides as they do, from extension.
        let moved = Knee::Planar(1.0).made().moved([90f64.to_radians(), 0.3, 0.3]);
        assert!((1e3 * moved.translation.x - (3.258752 + 4.499857)).abs() < 1e-5);
        assert!((moved.linear.x.y + 1.0).abs() < 1e-12, "the shank's x points down at 90 degrees");
    }

    /// The coupled knee: flexion, adduction and rotation in degrees, slides forward and upward in mm, of Rajagopal et al. 2016.
    #[test]
    fn walkers_knee_is_that_of_rajagopal() {
        let golden = [
            [15.0, 1.034, 4.903, 1.453, 0.671],
            [30.0, 1.696, 8.630, 2.734, 1.086],
            [60.0, 1.769, 13.177, 4.777, 1.391],
            [90.0, 0.654, 14.884, 6.130, 1.400],
            [120.0, -0.096, 14.992, 6.792, 1.599],
        ];
        let knee = Knee::Walker(1.0).made();
        for [flexion, adduction, rotation, forward, upward] in golden {
            let moved = knee.moved([f64::to_radians(flexion), 9.0, 9.0]);
            let m = moved.linear;
            let found = [
                (m.y.x / m.y.y).atan().to_degrees(),
                m.y.z.asin().to_degrees(),
                (-m.x.z).atan2(m.z.z).to_degrees(),
            ];
            assert!((found[1] - adduction).abs() < 1e-3, "{flexion}: {found:?}");
            assert!((found[2] - rotation).abs() < 1e-3, "{flexion}: {found:?}");
            assert!((1e3 * moved.translation.x - forward).abs() < 1e-3);
            assert!((1e3 * moved.translation.y - upward).abs() < 1e-3);
        }
    }

    #[test]
    fn the_linear_knee_is_linear() {
        let slopes = [[0.03, 0.01, 0.0], [0.0, 0.02, 0.0], [0.0, 0.0, -0.01]];
        let moved = Knee::Linear(slopes).made().moved([0.5, 0.1, 0.2]);
        let expected = Vec3::new(-0.015 + 0.001, 0.002, -0.002);
        assert!((moved.translation - expected).norm() < 1e-15);
    }
}
