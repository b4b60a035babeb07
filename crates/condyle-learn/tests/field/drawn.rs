//! Shapes that are drawn at random, so that no method can have been set to their names: boxes of Euler angles in any axes, cones
//! and balls, joined and cut, and sheets of twist that curve.

use super::shapes::{Random, Shape};
use condyle_math::{Quat, Vec3};
use std::sync::LazyLock;

/// Looked at while the method was chosen.
pub(crate) const SEEN: [Shape; 4] = [
    Shape { name: "drawn 1: two boxes joined", holds: |q| SETS[0].holds(q) },
    Shape { name: "drawn 2: two cones cut with a box", holds: |q| SETS[1].holds(q) },
    Shape { name: "drawn 3: sheet of twist", holds: |q| SETS[2].holds(q) },
    Shape { name: "drawn 4: box and ball without a cone", holds: |q| SETS[3].holds(q) },
];

/// Looked at once, when the method was settled.
pub(crate) const UNSEEN: [Shape; 4] = [
    Shape { name: "drawn 5: two boxes joined", holds: |q| SETS[4].holds(q) },
    Shape { name: "drawn 6: two cones cut with a box", holds: |q| SETS[5].holds(q) },
    Shape { name: "drawn 7: sheet of twist", holds: |q| SETS[6].holds(q) },
    Shape { name: "drawn 8: box and ball without a cone", holds: |q| SETS[7].holds(q) },
];

/// Two more of each kind, looked at once, when edges and gaps were settled anew.
pub(crate) const LATER: [Shape; 8] = [
    Shape { name: "drawn 9: two boxes joined", holds: |q| SETS[8].holds(q) },
    Shape { name: "drawn 10: two cones cut with a box", holds: |q| SETS[9].holds(q) },
    Shape { name: "drawn 11: sheet of twist", holds: |q| SETS[10].holds(q) },
    Shape { name: "drawn 12: box and ball without a cone", holds: |q| SETS[11].holds(q) },
    Shape { name: "drawn 13: two boxes joined", holds: |q| SETS[12].holds(q) },
    Shape { name: "drawn 14: two cones cut with a box", holds: |q| SETS[13].holds(q) },
    Shape { name: "drawn 15: sheet of twist", holds: |q| SETS[14].holds(q) },
    Shape { name: "drawn 16: box and ball without a cone", holds: |q| SETS[15].holds(q) },
];

static SETS: LazyLock<[Drawn; 16]> = LazyLock::new(|| std::array::from_fn(drawn));

/// A set with between 3 and 35 % of all rotations.
fn drawn(number: usize) -> Drawn {
    let mut random = Random(0x5DEE_CE66_D1CE_4E5B ^ (number as u64 + 1) << 40);
    loop {
        let set = Drawn {
            kind: number % 4,
            boxes: std::array::from_fn(|_| Angles::drawn(&mut random)),
            cones: std::array::from_fn(|_| Cone::drawn(&mut random)),
            ball: (
                Quat::exp(random.direction() * (0.3 + 0.9 * random.unit())),
                0.7 + 0.4 * random.unit(),
            ),
            sheet: Sheet::drawn(&mut random),
        };
        let share = (0..4000).filter(|_| set.holds(random.rotation())).count() as f64 / 4000.0;
        if (0.03..0.35).contains(&share) {
            return set;
        }
    }
}

struct Drawn {
    kind: usize,
    boxes: [Angles; 2],
    cones: [Cone; 2],
    ball: (Quat, f64),
    sheet: Sheet,
}

impl Drawn {
    fn holds(&self, q: Quat) -> bool {
        let [one, other] = &self.boxes;
        let [wide, notch] = &self.cones;
        match self.kind {
            0 => one.holds(q) || other.holds(q),
            1 => wide.holds(q) && notch.holds(q) && one.holds(q),
            2 => self.sheet.holds(q),
            _ => (one.holds(q) || q.angle_to(self.ball.0) < self.ball.1) && !notch.holds(q),
        }
    }
}

/// Ranges of the angles of Rx·Rz·Ry, in axes of its own on both sides.
struct Angles {
    sides: [Quat; 2],
    most: [f64; 3],
}

impl Angles {
    fn drawn(random: &mut Random) -> Self {
        let left = Quat::exp(random.direction() * (0.5 * random.unit()));
        let most = [50.0, 40.0, 45.0].map(|least: f64| (least + 35.0 * random.unit()).to_radians());
        Self { sides: [left, Quat::exp(random.direction() * (0.8 * random.unit()))], most }
    }

    fn holds(&self, q: Quat) -> bool {
        let r = (self.sides[0] * q * self.sides[1]).to_mat3();
        let angles = [
            r.at(2, 1).atan2(r.at(1, 1)),
            (-r.at(0, 1)).clamp(-1.0, 1.0).asin(),
            r.at(0, 2).atan2(r.at(0, 0)),
        ];
        angles.iter().zip(self.most).all(|(angle, most)| angle.abs() <= most)
    }
}

/// One direction of the child stays within an angle of one of the reference.
struct Cone {
    child: Vec3,
    middle: Vec3,
    cosine: f64,
}

impl Cone {
    fn drawn(random: &mut Random) -> Self {
        let child = random.direction();
        let middle = Quat::exp(random.direction() * (0.7 + 0.5 * random.unit())).to_mat3() * child;
        Self { child, middle, cosine: (45.0 + 40.0 * random.unit()).to_radians().cos() }
    }

    fn holds(&self, q: Quat) -> bool {
        (q.to_mat3() * self.child).dot(self.middle) >= self.cosine
    }
}

/// z swings up to an angle; the twist about it is within a range whose middle waves over the directions of swing.
struct Sheet {
    swing: f64,
    half: f64,
    waves: [(f64, f64); 2],
}

impl Sheet {
    fn drawn(random: &mut Random) -> Self {
        let mut wave = || (0.5 * random.unit(), 6.0 * random.unit());
        let waves = [wave(), wave()];
        Self { swing: 1.2 + 0.6 * random.unit(), half: 0.25 + 0.3 * random.unit(), waves }
    }

    fn holds(&self, q: Quat) -> bool {
        let swing = 2.0 * q.x.hypot(q.y).atan2(q.z.hypot(q.w));
        let twist = 2.0 * (q.z / q.w).atan();
        let tip = q.to_mat3() * Vec3::Z;
        let [(a, s), (b, t)] = self.waves;
        let middle = a * (2.0 * tip.x + s).sin() + b * (2.5 * tip.y + t).sin();
        let off = (twist - middle + std::f64::consts::PI).rem_euclid(std::f64::consts::TAU)
            - std::f64::consts::PI;
        swing <= self.swing && off.abs() <= self.half
    }
}
