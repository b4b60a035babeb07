//! Soft-tissue artefact: how far skin takes each marker from its bone.
//!
//! ```text
//! artefact = size · (bend(φ) · A + (1 - load) · B + shake(since) · C) + wander(trial)
//! bend(φ) = sin(0.75 φ) / sin(0.75 π/2)          A: at 90 degrees of flexion, relative to standing
//! ```
//!
//! Sizes follow what was measured, directions and shares among markers are illustrative. Six knees with prostheses seen
//! by fluoroscopy in walking have, of the cluster as a whole, 18 mm and 10 degrees on the thigh and 17 mm and 7 degrees on the shank, the latter mainly
//! in swing, and single markers 4 to 16 mm beside it (PMC8631460, its abstract). Of the lower limb the thigh has most,
//! artefact depends on the task, is not the same in two people, and has frequencies of the motion itself (Leardini et
//! al. 2005, abstract). Markers on the epicondyles are said to move by 20 to 40 mm, that on the trochanter by 10 to 30
//! (Cappozzo et al. 1996, recalled).

use super::dice::Dice;
use condyle_math::Vec3;
use std::f64::consts::{PI, TAU};

/// Millimetres in the axes of the bone, forward, up and to the lateral side, of the markers of [`super::Person::LABELS`]: at 90
/// degrees of flexion.
const BENT: [[f64; 3]; 7] = [
    [-12.0, 10.0, 5.0],
    [-20.0, 11.0, -4.0],
    [-8.0, 9.0, 4.0],
    [4.0, -7.0, 1.0],
    [8.0, 6.0, -3.0],
    [3.0, -6.0, 2.0],
    [4.0, -5.0, -2.0],
];
/// The same without weight on the leg.
const UNLOADED: [[f64; 3]; 7] = [
    [3.0, -4.0, 2.0],
    [2.0, -3.0, 3.0],
    [3.0, -2.0, -1.0],
    [2.0, -5.0, 1.0],
    [-4.0, -6.0, 4.0],
    [1.0, -4.0, 0.0],
    [1.0, -3.0, 1.0],
];
/// Millimetres by which skin shakes after the foot came down: it dies away in 50 ms and swings at 12 Hz (illustrative).
const SHAKEN: [f64; 7] = [5.0, 4.0, 4.0, 2.0, 4.0, 1.0, 1.0];

/// Whether skin moves.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Skin {
    /// Markers are fixed to bones.
    Rigid,
    /// They move on them.
    Moving,
}

impl Skin {
    /// What it is called in tables.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Rigid => "without artefact",
            Self::Moving => "with artefact",
        }
    }
}

/// The skin of a person: sizes and directions of its own.
#[derive(Clone, Debug)]
pub(super) struct Tissue {
    bent: [Vec3; 7],
    unloaded: [Vec3; 7],
    size: f64,
}

impl Tissue {
    /// Of a person: all is as large as 0.7 to 1.3 times the numbers, and each marker's vector differs by a third of its length.
    pub(super) fn new(dice: &mut Dice) -> Self {
        let size = 0.7 + 0.6 * dice.unit();
        let mut own = |[x, y, z]: [f64; 3]| {
            let mean = Vec3::new(x, y, z) * 1e-3;
            let other = Vec3::new(dice.normal(), dice.normal(), dice.normal());
            mean + other * (mean.norm() / (3.0 * 3f64.sqrt()))
        };
        Self { bent: BENT.map(&mut own), unloaded: UNLOADED.map(&mut own), size }
    }

    /// Of one trial: skin is never twice at the same place (2 mm at most, in slow waves).
    pub(super) fn wander(dice: &mut Dice) -> Wander {
        let mut wave = || [0.6e-3 * dice.normal(), 0.5 + dice.unit(), TAU * dice.unit()];
        Wander(std::array::from_fn(|_| std::array::from_fn(|_| wave())))
    }

    /// A marker's artefact in its bone's axes, in metres.
    pub(super) fn moved(&self, marker: usize, flexion: f64, load: f64, since: f64) -> Vec3 {
        let bend = (0.75 * flexion).sin() / (0.375 * PI).sin();
        let shake = (-since / 0.05).exp() * (TAU * 12.0 * since).sin();
        let shaken = Vec3::new(0.3, -0.9, 0.3) * (1e-3 * SHAKEN[marker] * shake);
        (self.bent[marker] * bend + self.unloaded[marker] * (1.0 - load) + shaken) * self.size
    }
}

/// Waves by marker and axis: size in metres, turns in a trial, phase.
pub(super) struct Wander([[[f64; 3]; 3]; 7]);

impl Wander {
    /// At a part of the trial.
    pub(super) fn at(&self, marker: usize, part: f64) -> Vec3 {
        let wave = |[size, turns, phase]: [f64; 3]| size * (TAU * turns * part + phase).sin();
        Vec3::from(self.0[marker].map(wave))
    }
}
