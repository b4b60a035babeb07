//! Numbers from a seed.

/// SplitMix64 (Steele, Lea & Flood 2014), and normal numbers of it.
#[derive(Clone, Debug)]
pub(super) struct Dice(u64);

impl Dice {
    /// The numbers of a seed and of what they are for: other words give other numbers.
    pub(super) fn of(seed: u64, words: &[u64]) -> Self {
        let mut dice = Self(seed ^ 0x6a09_e667_f3bc_c908);
        for word in words {
            dice.0 = dice.next().wrapping_add(word.wrapping_mul(0x9e37_79b9_7f4a_7c15));
        }
        dice
    }

    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// Between 0 and 1.
    pub(super) fn unit(&mut self) -> f64 {
        (self.next() >> 11) as f64 / (1u64 << 53) as f64
    }

    /// Normal with standard deviation 1 (Box & Muller 1958).
    pub(super) fn normal(&mut self) -> f64 {
        let (u, v) = (1.0 - self.unit(), self.unit());
        (-2.0 * u.ln()).sqrt() * (std::f64::consts::TAU * v).cos()
    }
}
