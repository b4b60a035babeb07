//! Trials of a joint whose law is known, with noise as recordings have it.

use condyle_learn::coupling::{Groups, Samples};

/// SplitMix64 (Steele, Lea & Flood 2014), and normal numbers of it.
pub(crate) struct Dice(u64);

impl Dice {
    pub(crate) fn new(seed: u64) -> Self {
        Self(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) ^ 0xabcd_1234)
    }

    pub(crate) fn unit(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64
    }

    /// Box & Muller 1958.
    pub(crate) fn normal(&mut self) -> f64 {
        let (u, v) = (1.0 - self.unit(), self.unit());
        (-2.0 * u.ln()).sqrt() * (std::f64::consts::TAU * v).cos()
    }

    /// An autoregressive sequence of order 1 with standard deviation 1.
    pub(crate) fn sequence(&mut self, length: usize, memory: f64) -> Vec<f64> {
        let mut x = self.normal();
        let fresh = (1.0 - memory * memory).sqrt();
        (0..length)
            .map(|_| {
                x = memory * x + fresh * self.normal();
                x
            })
            .collect()
    }
}

/// The law: slopes in metres per radian of flexion, adduction, rotation; and the constant, as in Table 1 of Pronost et al. 2010 (subject 1, T_x).
pub(crate) const SLOPES: [f64; 3] = [0.035, -0.01, 0.008];
pub(crate) const CONSTANT: f64 = -0.42;

/// How trials are made.
pub(crate) struct Trials {
    pub(crate) count: usize,
    pub(crate) frames: usize,
    /// Standard deviations: of what a trial adds to all its frames, and of the noise from frame to frame, metres.
    pub(crate) effect: f64,
    pub(crate) noise: f64,
    /// The correlation of the noise from one frame to the next.
    pub(crate) memory: f64,
    /// Whether the dependent has nothing to do with the angles.
    pub(crate) unrelated: bool,
    /// Whether the angles are noise, too, with an offset for each trial.
    pub(crate) wandering: bool,
}

impl Trials {
    pub(crate) fn make(&self, dice: &mut Dice) -> Samples {
        let columns = ["flexion", "adduction", "rotation", "tx"].map(str::to_owned).to_vec();
        let mut samples = Samples { columns, trials: vec![] };
        for trial in 0..self.count {
            let phase = dice.unit() * std::f64::consts::TAU;
            let (amplitude, offset) = (0.5 + 0.15 * dice.normal(), 0.5 + 0.1 * dice.normal());
            let (own, wander) = (
                [0.05 * dice.normal(), 0.05 * dice.normal()],
                [0.03, 0.04].map(|size| {
                    dice.sequence(self.frames, 0.97)
                        .into_iter()
                        .map(|x| size * x)
                        .collect::<Vec<_>>()
                }),
            );
            let noise = dice.sequence(self.frames, self.memory);
            let effect = self.effect * dice.normal();
            let random: Vec<Vec<f64>> =
                (0..3).map(|_| dice.sequence(self.frames, self.memory)).collect();
            let shift: Vec<f64> = (0..3).map(|_| dice.normal()).collect();
            let mut rows = vec![];
            for frame in 0..self.frames {
                let t = std::f64::consts::TAU * frame as f64 / 100.0 + phase;
                let mut angles = [
                    offset + amplitude * t.sin(),
                    own[0] + 0.05 * (2.0 * t).sin() + wander[0][frame],
                    own[1] + 0.1 * t.cos() + wander[1][frame],
                ];
                if self.wandering {
                    angles = std::array::from_fn(|i| 0.3 * random[i][frame] + 0.3 * shift[i]);
                }
                let law: f64 = angles.iter().zip(SLOPES).map(|(a, c)| a * c).sum();
                let law = if self.unrelated { 0.0 } else { law };
                rows.extend(angles);
                rows.push(CONSTANT + law + effect + self.noise * noise[frame]);
            }
            let name = format!("gait_{trial}");
            samples.add(&name, Groups::of_name(&name), &rows, 0);
        }
        samples
    }
}
