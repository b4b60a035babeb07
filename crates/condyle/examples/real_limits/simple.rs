//! The limits that programs have today, and rotations at known distances.

use condyle::learn::limits::{Cloud, uniform};
use condyle::math::{EulerOrder, Quat, Vec3};
use std::f64::consts::PI;

/// Even pseudo-random numbers: SplitMix64 (Steele, Lea & Flood 2014).
pub(crate) struct Random(u64);

impl Random {
    pub(crate) fn new(seed: u64) -> Self {
        Self(seed)
    }

    pub(crate) fn unit(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64
    }

    fn direction(&mut self) -> Vec3 {
        let z = 2.0 * self.unit() - 1.0;
        let (around, r) = (2.0 * PI * self.unit(), (1.0 - z * z).sqrt());
        Vec3::new(r * around.cos(), r * around.sin(), z)
    }
}

/// The angle to the nearest of some rotations.
pub(crate) fn nearest(q: Quat, among: &[Quat]) -> f64 {
    let cosine = among.iter().map(|p| q.dot(*p).abs()).fold(0.0, f64::max);
    2.0 * cosine.min(1.0).acos()
}

/// Rotations whose nearest sample is at an angle, to half a degree.
pub(crate) fn quat_at(
    angle: f64,
    samples: &[Quat],
    count: usize,
    random: &mut Random,
) -> Vec<Quat> {
    let mut found = vec![];
    for _ in 0..count * 60 {
        if found.len() == count {
            break;
        }
        let from = samples[(random.unit() * samples.len() as f64) as usize % samples.len()];
        let q = from * Quat::exp(random.direction() * angle);
        let half = 0.5f64.to_radians();
        if nearest(q, samples) > angle - half {
            found.push(q);
        }
    }
    found
}

/// A range for each of three angles.
pub(crate) struct Box {
    order: EulerOrder,
    ranges: [[f64; 2]; 3],
}

impl Box {
    /// Of all twelve orders the one whose ranges hold the least of all rotations.
    pub(crate) fn smallest(frames: &[Quat]) -> Self {
        let mut best: Option<(usize, Self)> = None;
        for order in EulerOrder::ALL {
            let mut columns = [vec![], vec![], vec![]];
            for q in frames.iter().step_by(2) {
                for (column, angle) in columns.iter_mut().zip(order.from_mat3(q.to_mat3())) {
                    column.push(angle.rem_euclid(2.0 * PI));
                }
            }
            let ranges = columns.map(|mut column| arc(&mut column));
            let found = Self { order, ranges };
            let volume = uniform(20_000).filter(|q| found.holds(*q)).count();
            if best.as_ref().is_none_or(|(least, _)| volume < *least) {
                best = Some((volume, found));
            }
        }
        best.expect("there are orders").1
    }

    pub(crate) fn name(&self) -> String {
        self.order.axes().map(|axis| ["x", "y", "z"][axis]).concat()
    }

    pub(crate) fn holds(&self, q: Quat) -> bool {
        let angles = self.order.from_mat3(q.to_mat3());
        angles
            .into_iter()
            .zip(self.ranges)
            .all(|(angle, [start, length])| (angle - start).rem_euclid(2.0 * PI) <= length)
    }
}

/// The smallest arc that holds all angles: where it starts and its length.
fn arc(angles: &mut [f64]) -> [f64; 2] {
    angles.sort_by(f64::total_cmp);
    let count = angles.len();
    let mut widest = (0, 0.0);
    for i in 0..count {
        let next = if i + 1 < count { angles[i + 1] } else { angles[0] + 2.0 * PI };
        if next - angles[i] > widest.1 {
            widest = (i, next - angles[i]);
        }
    }
    [angles[(widest.0 + 1) % count], 2.0 * PI - widest.1]
}

/// A circular cone of swing and a symmetric range of twist about the reference rotation.
pub(crate) struct Ball {
    reference: Quat,
    bone: Vec3,
    swing: f64,
    twist: f64,
}

impl Ball {
    pub(crate) fn of(cloud: &Cloud, bone: Vec3) -> Self {
        let mut ball = Self { reference: cloud.reference(), bone, swing: 0.0, twist: 0.0 };
        for q in cloud.rotations() {
            let [swing, twist] = ball.parts(*q);
            ball.swing = ball.swing.max(swing);
            ball.twist = ball.twist.max(twist);
        }
        ball
    }

    fn parts(&self, q: Quat) -> [f64; 2] {
        let relative = self.reference.conjugate() * q;
        let along = relative.vector().dot(self.bone);
        let twist = 2.0 * along.atan2(relative.w);
        let twist = (twist + PI).rem_euclid(2.0 * PI) - PI;
        let swing = 2.0 * (along * along + relative.w * relative.w).sqrt().min(1.0).acos();
        [swing, twist.abs()]
    }

    pub(crate) fn holds(&self, q: Quat, scale: f64) -> bool {
        let [swing, twist] = self.parts(q);
        swing <= scale * self.swing && twist <= scale * self.twist
    }
}

/// The scale from which on a share is reached.
pub(crate) fn beyond(share: &dyn Fn(f64) -> f64, wanted: f64) -> f64 {
    let (mut low, mut high) = (0.0, 3.0);
    for _ in 0..40 {
        let middle = 0.5 * (low + high);
        if share(middle) < wanted { low = middle } else { high = middle }
    }
    high
}
