//! Six people.

use super::Knee;
use super::dice::Dice;
use super::skin::Tissue;
use condyle_math::{Affine, Mat3, Vec3};

/// A virtual person's right leg.
#[derive(Clone, Debug)]
pub struct Person {
    /// A name such as `s1`.
    pub name: String,
    /// Metres.
    pub stature: f64,
    /// Metres from the knee to the marker on the great trochanter.
    pub thigh: f64,
    /// Metres between the markers on the epicondyles.
    pub width: f64,
    /// How the knee moves.
    pub knee: Knee,
    /// How the axes of the knee are turned in the frame that the landmarks give, in radians about its x and y.
    pub tilt: [f64; 2],
    /// Degrees of flexion at the deepest.
    pub depth: f64,
    /// Which of the six.
    pub(super) index: u64,
    /// Where markers are in their bones: of the thigh from the knee's centre, of the shank from there in extension.
    pub(super) places: [Vec3; 7],
    /// The joint in the thigh, which is the frame of the landmarks, turned.
    pub(super) joint: Affine,
    pub(super) tissue: Tissue,
}

/// Statures in metres: from a short woman to a tall man.
const STATURES: [f64; 6] = [1.78, 1.58, 1.72, 1.66, 1.83, 1.89];
/// Degrees of the deepest crouch; illustrative.
const DEPTHS: [f64; 6] = [98.0, 104.0, 92.0, 110.0, 96.0, 88.0];

/// Metres per radian of the angle about z (negative in flexion), adduction and rotation, for x, y and z. The first has the size
/// of Table 1 of Pronost et al. 2010, which is that of skin; the second that of bones (9 mm over 2 radians).
const LINEAR: [[[f64; 3]; 3]; 2] = [
    [[0.035, -0.012, 0.010], [-0.030, 0.040, -0.014], [0.012, -0.020, 0.016]],
    [[-0.0045, 0.010, 0.012], [0.0060, 0.015, -0.008], [0.0030, -0.012, 0.010]],
];

impl Person {
    /// The markers: three on the thigh, four on the shank, as Pronost et al. 2010 name them.
    pub const LABELS: [&'static str; 7] =
        ["RGT", "RLFE", "RMFE", "RTT", "RFH", "RMEDMAL", "RLATMAL"];
    /// How many of them are on the thigh.
    pub(super) const ON_THIGH: usize = 3;

    /// One of six people, from 0. The first two have a linear law, the next two Walker's knee, the last two the planar one; the
    /// axes of the fourth and of the sixth are not those of their landmarks, as where an epicondyle is felt 6 mm off (illustrative; 4
    /// degrees between palpated and functional axes are common, recalled). Thigh and shank are 0.245 and 0.246 of the
    /// stature (Drillis & Contini 1966, recalled), the trochanter is 2 % of it below the hip, epicondyles are 0.055 apart.
    #[must_use]
    pub fn of_six(index: usize, seed: u64) -> Self {
        let index = index.min(5);
        let stature = STATURES[index];
        let mut dice = Dice::of(seed, &[index as u64, 1]);
        let thigh = 0.245 * stature - 0.02 * stature;
        let shank = 0.246 * stature;
        let width = 0.055 * stature + 0.003 * dice.normal();
        let size = stature / 1.75;
        let knee = match index {
            0 | 1 => Knee::Linear(LINEAR[index]),
            2 | 3 => Knee::Walker(size),
            _ => Knee::Planar(size),
        };
        let tilt = if index % 2 == 1 && index > 1 { [0.07, -0.05] } else { [0.0; 2] };
        // Markers are 1.5 mm (SD) beside their landmarks: constants of T_z then spread over people by 7 mm; those of
        // Table 1 of Pronost et al. 2010 do by 5.
        let mut beside = |[x, y, z]: [f64; 3]| {
            Vec3::new(x, y, z) + Vec3::new(dice.normal(), dice.normal(), dice.normal()) * 1.5e-3
        };
        let half = 0.5 * width;
        let places = [
            [0.005, thigh, 0.065 * stature * 0.6],
            [0.004, 0.006, half],
            [-0.004, -0.004, -half],
            [0.030 * size, -0.055 * size, 0.004],
            [-0.024 * size, -0.030 * size, 0.036 * size],
            [0.006, -shank, -0.036 * size],
            [-0.010, -shank - 0.008, 0.034 * size],
        ]
        .map(&mut beside);
        let tissue = Tissue::new(&mut dice);
        let landmarks = landmark_frame([places[0], places[1], places[2]]);
        let turned = Mat3::rotation_x(tilt[0]) * Mat3::rotation_y(tilt[1]);
        let joint = landmarks * Affine::from_rotation(turned);
        Self {
            name: format!("s{}", index + 1),
            stature,
            thigh: (places[0] - landmarks.translation).norm(),
            width: (places[1] - places[2]).norm(),
            knee,
            tilt,
            depth: DEPTHS[index],
            index: index as u64,
            places,
            joint,
            tissue,
        }
    }
}

/// The frame of three landmarks, trochanter, lateral and medial epicondyle (Pronost et al. 2010, 3.1): from the middle of the epicondyles,
/// z to the lateral one, y upward in the plane of the three, x forward.
pub(super) fn landmark_frame([top, lateral, medial]: [Vec3; 3]) -> Affine {
    let middle = (lateral + medial) * 0.5;
    let z = (lateral - medial).normalized();
    let up = top - middle;
    let y = (up - z * z.dot(up)).normalized();
    Affine::new(Mat3::from_columns(y.cross(z), y, z), middle)
}
