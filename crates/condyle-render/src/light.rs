//! Light in linear numbers, and what screens take.

use crate::palette::Colour;
use condyle_math::Vec3;

/// Red, green and blue in proportion to light.
pub(crate) type Linear = [f32; 3];

/// sRGB to linear (IEC 61966-2-1).
pub(crate) fn linear(colour: Colour) -> Linear {
    colour.map(|byte| {
        let share = f32::from(byte) / 255.0;
        if share <= 0.040_45 { share / 12.92 } else { ((share + 0.055) / 1.055).powf(2.4) }
    })
}

/// Linear to sRGB by a table.
pub(crate) struct Screen(Vec<u8>);

const STEPS: usize = 4096;

impl Screen {
    pub(crate) fn new() -> Self {
        let byte = |step: usize| {
            let x = step as f32 / (STEPS - 1) as f32;
            let share =
                if x <= 0.003_130_8 { 12.92 * x } else { 1.055 * x.powf(1.0 / 2.4) - 0.055 };
            (255.0 * share).round() as u8
        };
        Self((0..STEPS).map(byte).collect())
    }

    pub(crate) fn colour(&self, light: Linear) -> Colour {
        light.map(|x| self.0[((x.clamp(0.0, 1.0) * (STEPS - 1) as f32).round()) as usize])
    }
}

/// Directions to the lights, as seen: right, up, toward the viewer. Each with its strength.
const KEY: ([f64; 3], f32) = ([-0.45, 0.65, 0.61], 0.72);
const FILL: ([f64; 3], f32) = ([0.80, 0.10, 0.59], 0.22);
/// From all around: more from above than from below.
const AMBIENT: (f32, f32) = (0.26, 0.10);
/// Along outlines.
const RIM: f32 = 0.10;
const GLOSS: f32 = 0.07;

/// The light of a surface with a normal (as seen, of any length) that faces the viewer.
pub(crate) fn lit(colour: Linear, normal: Vec3) -> Linear {
    let length = normal.norm();
    if length < 1e-12 || !length.is_finite() {
        return colour;
    }
    let normal = normal * (1.0 / length);
    let from = |light: [f64; 3]| normal.dot(light.into()).max(0.0) as f32;
    let key = from(KEY.0);
    let sky = 0.5 + 0.5 * normal.y as f32;
    let light = KEY.1 * key + FILL.1 * from(FILL.0) + AMBIENT.1 + (AMBIENT.0 - AMBIENT.1) * sky;
    let grazing = 1.0 - normal.z.clamp(0.0, 1.0) as f32;
    // Halfway between the key light and the viewer.
    let half = Vec3::new(-0.2508, 0.3622, 0.8977);
    let shine = (normal.dot(half).max(0.0) as f32).powi(24);
    let white = RIM * grazing * grazing * grazing + GLOSS * shine;
    colour.map(|c| c * light + white)
}
