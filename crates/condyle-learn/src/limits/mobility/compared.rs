//! Two sets of rotations: of two people, two sides, or before and after.

use super::extent::climb;
use crate::limits::uniform;
use condyle_math::Quat;

/// What two sets have in common.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Compared {
    /// The share of all rotations that is in the first, and in the second.
    pub shares: [f64; 2],
    /// The share of all rotations that is in both.
    pub both: f64,
    /// Where the first goes farthest beyond the second, and the second beyond the first; `None` where it does not.
    pub beyond: [Option<Beyond>; 2],
}

/// A rotation of one set that is far from the other.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Beyond {
    /// The rotation.
    pub at: Quat,
    /// How far it is from the other set, in radians.
    pub distance: f64,
}

impl Compared {
    /// The share in common of all that is in one or the other.
    #[must_use]
    pub fn overlap(&self) -> f64 {
        let [a, b] = self.shares;
        let any = a + b - self.both;
        if any > 0.0 { self.both / any } else { 0.0 }
    }

    /// The largest distance of a rotation of one set from the other, in radians: that of Hausdorff.
    #[must_use]
    pub fn largest(&self) -> f64 {
        self.beyond.iter().flatten().map(|b| b.distance).fold(0.0, f64::max)
    }
}

/// Compares two sets by their signed distances, positive inside.
///
/// ```
/// use condyle_learn::limits::mobility::compared;
/// use condyle_math::{Quat, Vec3};
/// // Turns by 60 degrees, and those turned on by 20 about x: each goes 20 degrees beyond the other.
/// let sixty = 60f64.to_radians();
/// let on = Quat::from_axis_angle(Vec3::X, 20f64.to_radians());
/// let one = |q: Quat| sixty - q.angle_to(Quat::IDENTITY);
/// let other = |q: Quat| sixty - q.angle_to(on);
/// let found = compared(&one, &other, 100_000);
/// assert!((found.largest().to_degrees() - 20.0).abs() < 0.2);
/// assert!((found.shares[0] - found.shares[1]).abs() < 1e-3);
/// assert!(found.overlap() > 0.4 && found.overlap() < 0.8);
/// ```
#[must_use]
pub fn compared(
    first: &dyn Fn(Quat) -> f64,
    second: &dyn Fn(Quat) -> f64,
    count: usize,
) -> Compared {
    let mut inside = [0usize; 3];
    let mut far: [Option<Beyond>; 2] = [None; 2];
    for q in uniform(count) {
        let (a, b) = (first(q), second(q));
        let (in_a, in_b) = (a >= 0.0, b >= 0.0);
        inside[0] += usize::from(in_a);
        inside[1] += usize::from(in_b);
        inside[2] += usize::from(in_a && in_b);
        for (far, (own, other)) in far.iter_mut().zip([(in_a, b), (in_b, a)]) {
            if own && other < 0.0 && far.is_none_or(|f| -other > f.distance) {
                *far = Some(Beyond { at: q, distance: -other });
            }
        }
    }
    // On from there, inside of its own set, away from the other.
    for (far, (own, other)) in far.iter_mut().zip([(first, second), (second, first)]) {
        if let Some(beyond) = far {
            let value = |q: &Quat| if own(*q) >= 0.0 { -other(*q) } else { f64::NEG_INFINITY };
            climb(&mut beyond.at, &value);
            beyond.distance = value(&beyond.at);
        }
    }
    let share = |n: usize| n as f64 / count.max(1) as f64;
    Compared { shares: [share(inside[0]), share(inside[1])], both: share(inside[2]), beyond: far }
}
