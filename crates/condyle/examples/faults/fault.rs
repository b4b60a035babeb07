//! Faults that are written into recordings, and the random numbers for them.

use condyle::Observed;
use condyle::formats::Recording;
use condyle::math::Vec3;
use std::ops::Range;

/// A fault written into a recording.
pub(crate) struct Fault {
    pub(crate) kind: &'static str,
    pub(crate) labels: Vec<usize>,
    pub(crate) frames: Range<usize>,
}

pub(crate) const KINDS: [&str; 8] =
    ["1 pair", "2 pairs", "3 pairs", "4 pairs", "three-cycle", "ghost", "frozen", "at 0 0 0"];

impl Fault {
    /// From one frame to half of the trial, anywhere in it; lengths are spread over their logarithm.
    pub(crate) fn cast(kind: &'static str, used: &[usize], frames: usize, dice: &mut Dice) -> Self {
        let length = ((frames as f64 / 2.0).powf(dice.even()) as usize).max(1);
        let start = dice.below(frames - length + 1);
        let count = match kind {
            "1 pair" => 2,
            "2 pairs" => 4,
            "3 pairs" => 6,
            "4 pairs" => 8,
            "three-cycle" => 3,
            _ => 1,
        };
        let mut labels = vec![];
        while labels.len() < count.min(used.len() / 2 * 2) {
            let label = used[dice.below(used.len())];
            if !labels.contains(&label) {
                labels.push(label);
            }
        }
        Self { kind, labels, frames: start..start + length }
    }

    pub(crate) fn write(&self, recording: &mut Recording, dice: &mut Dice) {
        let width = recording.labels.len();
        let away = dice.vector();
        let away = away * ((0.06 + 0.44 * dice.even()) / away.norm());
        let frozen = recording.positions[self.frames.start * width + self.labels[0]];
        for frame in self.frames.clone() {
            let row = &mut recording.positions[frame * width..(frame + 1) * width];
            match self.kind {
                "three-cycle" => {
                    row.swap(self.labels[0], self.labels[1]);
                    row.swap(self.labels[1], self.labels[2]);
                }
                "ghost" => {
                    let place = row[self.labels[0]].position();
                    let moved = place.map(|p| (Vec3::from(p) + away).to_array());
                    row[self.labels[0]] = Observed::from(moved);
                }
                "frozen" => row[self.labels[0]] = frozen,
                "at 0 0 0" => row[self.labels[0]] = Observed::from([0.0; 3]),
                _ => self.labels.chunks_exact(2).for_each(|pair| row.swap(pair[0], pair[1])),
            }
        }
    }
}

/// SplitMix64 (Steele, Lea & Flood 2014): the same numbers everywhere.
pub(crate) struct Dice(pub(crate) u64);

impl Dice {
    /// Uniform in [0, 1).
    pub(crate) fn even(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64
    }

    pub(crate) fn below(&mut self, n: usize) -> usize {
        (self.even() * n as f64) as usize
    }

    /// Three numbers with mean 0 and deviation 1: sums of twelve.
    pub(crate) fn vector(&mut self) -> Vec3 {
        let mut normal = || (0..12).map(|_| self.even()).sum::<f64>() - 6.0;
        Vec3::new(normal(), normal(), normal())
    }
}
