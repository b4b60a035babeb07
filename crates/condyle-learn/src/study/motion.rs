//! Gait and crouch: the angles of the knee and where the thigh is.

use super::dice::Dice;
use condyle_math::{Affine, Mat3, Vec3};
use std::f64::consts::{PI, TAU};

/// What a person does.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Stands still.
    Standing,
    /// Walks a stride.
    Gait,
    /// Bends the knees and rises, with so many degrees between the feet.
    Crouch(u16),
}

/// Degrees between the feet of the six varieties of crouch (Pronost et al. 2010, 3.1; the last is "almost 180").
pub const CROUCHES: [u16; 6] = [0, 30, 60, 90, 120, 180];

/// Frames per second.
pub(super) const RATE: f64 = 100.0;

/// One moment of a leg.
#[derive(Clone, Copy, Debug)]
pub(super) struct Moment {
    /// Flexion, adduction and rotation that are wanted of the knee, in radians.
    pub(super) angles: [f64; 3],
    /// The thigh's turn in the laboratory.
    pub(super) turn: Mat3,
    /// Where the top of the thigh is.
    pub(super) top: Vec3,
    /// How much of the weight is on the leg, 0 to 1, and seconds since the foot came to the ground; what stands has done so for long.
    pub(super) load: f64,
    pub(super) since: f64,
}

/// Degrees at every 20th of a stride from the heel strike. Means of healthy adults in round numbers, recalled: knee and thigh as
/// Winter 1991 and Perry & Burnfield 2010 draw them.
const KNEE: [f64; 20] = [
    5.0, 11.0, 17.0, 18.5, 17.0, 13.5, 10.0, 7.5, 6.0, 7.0, 12.0, 21.0, 35.0, 50.0, 59.0, 60.0,
    50.0, 33.0, 15.0, 5.0,
];
const THIGH: [f64; 20] = [
    22.0, 21.0, 19.0, 16.0, 12.0, 8.0, 4.0, 0.0, -4.0, -7.5, -10.0, -10.5, -7.0, 0.0, 8.0, 15.0,
    20.0, 23.0, 24.0, 23.5,
];
/// Adduction (positive) and inward rotation (positive), of the size of bone pins in walkers of Lafortune et al. 1992, recalled.
const ADDUCTION: [f64; 20] = [
    0.0, -0.5, -1.0, -1.2, -1.0, -0.8, -0.6, -0.5, -0.5, -0.6, -0.8, -1.0, -1.4, -2.6, -4.4, -5.0,
    -3.6, -1.6, -0.4, 0.0,
];
const ROTATION: [f64; 20] = [
    0.0, 2.0, 4.0, 4.5, 4.0, 3.0, 2.0, 1.5, 1.0, 1.5, 3.0, 4.5, 6.0, 6.0, 4.0, 1.0, -1.0, -2.0,
    -2.0, -1.0,
];

/// The trigonometric polynomial through such values, at a part of the stride.
fn cycle(values: &[f64; 20], phase: f64) -> f64 {
    let mut sum = 0.0;
    for k in 0..=10u32 {
        let (mut a, mut b) = (0.0, 0.0);
        for (i, value) in values.iter().enumerate() {
            let angle = TAU * f64::from(k) * i as f64 / 20.0;
            a += value * angle.cos();
            b += value * angle.sin();
        }
        let share = if k == 0 || k == 10 { 20.0 } else { 10.0 };
        let angle = TAU * f64::from(k) * phase;
        sum += (a * angle.cos() + b * angle.sin()) / share;
    }
    sum
}

/// What a trial adds to a curve: an offset and four harmonics with phases of their own, in degrees.
struct Harmonics {
    offset: f64,
    waves: [[f64; 2]; 4],
}

impl Harmonics {
    fn new(dice: &mut Dice, offset: f64, size: f64) -> Self {
        let offset = offset * dice.normal();
        let waves = [1.0, 2.0, 3.0, 4.0].map(|k| [size * dice.normal() / k, TAU * dice.unit()]);
        Self { offset, waves }
    }

    fn at(&self, phase: f64) -> f64 {
        let waves = self.waves.iter().zip(1..);
        self.offset
            + waves
                .map(|([size, start], k)| size * (TAU * f64::from(k) * phase + start).sin())
                .sum::<f64>()
    }
}

/// All moments of a trial of a person whose crouches go so deep, in degrees, with a thigh of such length.
pub(super) fn moments(kind: Kind, depth: f64, length: f64, dice: &mut Dice) -> Vec<Moment> {
    match kind {
        Kind::Standing => standing(length),
        Kind::Gait => gait(length, dice),
        Kind::Crouch(feet) => crouch(f64::from(feet), depth, length, dice),
    }
}

/// Half a second in which nothing moves, with legs as straight as at rest.
fn standing(length: f64) -> Vec<Moment> {
    let moment = Moment {
        angles: [0.0; 3],
        turn: Mat3::rotation_y(0.4) * Mat3::rotation_x(0.03) * Mat3::rotation_z(-0.02),
        top: Vec3::new(0.3, 2.05 * length, 0.2),
        load: 1.0,
        since: 1e3,
    };
    vec![moment; 50]
}

/// One stride: a person walks 1.25 m/s toward x, 0.4 rad off the laboratory's axis.
fn gait(length: f64, dice: &mut Dice) -> Vec<Moment> {
    let seconds = 1.1 + 0.05 * dice.normal();
    let size = 1.0 + 0.06 * dice.normal();
    let [knee, thigh] = [1.0; 2].map(|sd| Harmonics::new(dice, 1.2 * sd, sd));
    let [adduction, rotation] = [0.6, 1.0].map(|sd| Harmonics::new(dice, sd, 0.6 * sd));
    let frames = (seconds * RATE).round() as usize;
    let way = Mat3::rotation_y(0.4);
    (0..frames)
        .map(|frame| {
            let time = frame as f64 / RATE;
            let phase = time / seconds;
            // Strides end where the next begin, so that harmonics of a stride change nothing there.
            let flexion = size * cycle(&KNEE, phase) + knee.at(phase);
            let lean = size * cycle(&THIGH, phase) + thigh.at(phase);
            let sway = 3.0 * (TAU * phase + 0.3).sin();
            let turned = 4.0 * (TAU * phase + 1.0).cos();
            let bounce = 0.02 * (2.0 * TAU * phase).cos();
            // Weight comes in a tenth and goes before the toes leave at 0.62 of the stride (recalled).
            let load = ramp(phase / 0.1) * ramp((0.62 - phase) / 0.1);
            Moment {
                angles: [
                    flexion,
                    cycle(&ADDUCTION, phase) + adduction.at(phase),
                    cycle(&ROTATION, phase) + rotation.at(phase),
                ]
                .map(f64::to_radians),
                turn: way * turned_by(turned, sway, lean),
                top: way * Vec3::new(1.25 * time - 0.6, 2.0 * length - 0.01 + bounce, 0.1),
                load,
                since: time,
            }
        })
        .collect()
}

/// Down and up again in 9.6 s, most of which is on the way; what no law of the knee says of its two other angles grows with
/// the angle between the feet (illustrative: outward rotation of 9 degrees and 3 of abduction at 180).
fn crouch(feet: f64, depth: f64, length: f64, dice: &mut Dice) -> Vec<Moment> {
    let seconds = 9.6 + 0.3 * dice.normal();
    // The wider the feet stand, the less deep it goes (illustrative).
    let depth = depth * (1.0 - feet / 900.0) + 3.0 * dice.normal();
    let knee = Harmonics::new(dice, 1.0, 1.5);
    let [adduction, rotation] = [0.5, 0.9].map(|sd| Harmonics::new(dice, sd, sd));
    let [lean, sway] = [1.5, 0.8].map(|sd| Harmonics::new(dice, sd, sd));
    let out = 0.5 * feet;
    let frames = (seconds * RATE).round() as usize;
    (0..frames)
        .map(|frame| {
            let phase = (frame as f64 / RATE) / seconds;
            let down = 0.5 - 0.5 * (TAU * phase).cos();
            let flexion = 4.0 + (depth - 4.0) * down + knee.at(phase) * down.sqrt();
            let own = |harmonics: &Harmonics| harmonics.at(phase);
            Moment {
                angles: [
                    flexion,
                    -(0.5 + out / 36.0) * down + own(&adduction) - 1.0 * (PI * down).sin(),
                    (3.0 - out / 10.0) * (0.3 + 0.7 * down) + 5.0 * down.powi(2) + own(&rotation),
                ]
                .map(f64::to_radians),
                turn: turned_by(
                    -out,
                    (0.4 * out + 2.0) * down + own(&sway),
                    0.58 * flexion + own(&lean),
                ),
                top: Vec3::new(0.1 - 0.25 * down * length, (2.0 - 0.75 * down) * length, 0.1),
                load: 1.0,
                since: 1e3,
            }
        })
        .collect()
}

/// A thigh whose lower end is turned outward, spread and forward, by degrees.
fn turned_by(inward: f64, spread: f64, forward: f64) -> Mat3 {
    let [y, x, z] = [inward, -spread, forward].map(f64::to_radians);
    Mat3::rotation_y(y) * Mat3::rotation_x(x) * Mat3::rotation_z(z)
}

/// 0 below 0, 1 above 1, smooth between.
fn ramp(x: f64) -> f64 {
    let x = x.clamp(0.0, 1.0);
    x * x * (3.0 - 2.0 * x)
}

/// The thigh's frame, whose origin is the knee's, from its top.
pub(super) fn hung(moment: &Moment, top_in_thigh: Vec3) -> Affine {
    Affine::new(moment.turn, moment.top - moment.turn * top_in_thigh)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cycle_passes_through_its_values() {
        for (i, value) in KNEE.iter().enumerate() {
            assert!((cycle(&KNEE, i as f64 / 20.0) - value).abs() < 1e-9);
        }
        assert!((cycle(&KNEE, 0.37) - cycle(&KNEE, 1.37)).abs() < 1e-9);
    }
}
