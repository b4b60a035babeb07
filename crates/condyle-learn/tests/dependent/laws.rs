//! Laws by which the rotations of a child depend on a driver, and rotations at known distances from their boundaries.

use condyle_learn::limits::dependent::{Driver, Drivers};
use condyle_math::{Quat, Vec3};

#[path = "../field/shapes.rs"]
#[allow(dead_code, reason = "the numbers that look random")]
mod shapes;
pub(crate) use shapes::Random;

/// A law.
#[derive(Clone, Copy)]
pub(crate) struct Law {
    pub(crate) name: &'static str,
    /// A value of the driver.
    pub(crate) driver: fn(&mut Random) -> Driver,
    /// Whether the child can have a rotation then.
    pub(crate) holds: fn(Driver, Quat) -> bool,
    /// Whether the child is a hinge about z.
    pub(crate) hinge: bool,
}

pub(crate) const LAWS: [Law; 4] = [
    Law { name: "twist that widens with an angle", driver: bent, holds: twist, hinge: false },
    Law {
        name: "cone that widens with the parent's swing",
        driver: swung,
        holds: cone,
        hinge: false,
    },
    Law {
        name: "hinge whose range follows an angle",
        driver: bent,
        holds: hinge_of_angle,
        hinge: true,
    },
    Law {
        name: "hinge whose range follows the parent's swing",
        driver: swung,
        holds: hinge_of_swing,
        hinge: true,
    },
];

fn degrees(radians: f64) -> f64 {
    radians.to_degrees()
}

/// Swing of z and twist about it, in degrees.
pub(crate) fn swing_and_twist(q: Quat) -> [f64; 2] {
    let swing = 2.0 * (q.x * q.x + q.y * q.y).sqrt().atan2((q.z * q.z + q.w * q.w).sqrt());
    [degrees(swing), degrees(2.0 * (q.z / q.w).atan())]
}

/// 0 to 120 degrees.
fn bent(random: &mut Random) -> Driver {
    Driver::Scalar(120f64.to_radians() * random.unit())
}

/// Swing up to 70 degrees, in all directions, with any twist up to 30.
fn swung(random: &mut Random) -> Driver {
    loop {
        let q = random.rotation();
        let [swing, twist] = swing_and_twist(q);
        if swing <= 70.0 && twist.abs() <= 30.0 {
            return Driver::Rotation(q);
        }
    }
}

fn value(driver: Driver) -> f64 {
    match driver {
        Driver::Scalar(angle) => degrees(angle),
        Driver::Rotation(q) => swing_and_twist(q)[0],
    }
}

/// Swing up to 50 degrees; twist within 20 degrees at 0, 62 at 120.
fn twist(driver: Driver, q: Quat) -> bool {
    let [swing, twist] = swing_and_twist(q);
    swing <= 50.0 && twist.abs() <= 20.0 + 0.35 * value(driver)
}

/// Twist within 45 degrees; swing up to 25 degrees at rest, 53 where the parent is swung by 70.
fn cone(driver: Driver, q: Quat) -> bool {
    let [swing, twist] = swing_and_twist(q);
    twist.abs() <= 45.0 && swing <= 25.0 + 0.4 * value(driver)
}

/// From 10 degrees to 40 at 0, to 88 at 120.
fn hinge_of_angle(driver: Driver, q: Quat) -> bool {
    let [_, twist] = swing_and_twist(q);
    (10.0..=40.0 + 0.4 * value(driver)).contains(&twist)
}

/// From 0 to 120 degrees at rest, to 92 where the parent is swung by 70.
fn hinge_of_swing(driver: Driver, q: Quat) -> bool {
    let [_, twist] = swing_and_twist(q);
    (0.0..=120.0 - 0.4 * value(driver)).contains(&twist)
}

impl Law {
    fn any(&self, random: &mut Random) -> Quat {
        if self.hinge {
            return Quat::from_axis_angle(Vec3::Z, 3.0 * (2.0 * random.unit() - 1.0));
        }
        random.rotation()
    }

    /// Drivers, and rotations uniform over what each allows.
    pub(crate) fn samples(&self, count: usize, random: &mut Random) -> (Vec<Quat>, Drivers) {
        let (mut rotations, mut scalars, mut turns) = (vec![], vec![], vec![]);
        while rotations.len() < count {
            let driver = (self.driver)(random);
            let q = loop {
                let q = self.any(random);
                if (self.holds)(driver, q) {
                    break q;
                }
            };
            rotations.push(q);
            match driver {
                Driver::Scalar(value) => scalars.push(value),
                Driver::Rotation(p) => turns.push(p),
            }
        }
        let drivers =
            if turns.is_empty() { Drivers::Scalars(scalars) } else { Drivers::Rotations(turns) };
        (rotations, drivers)
    }

    /// Rotations at an angle from the boundary at a driver, give or take a tenth, half of them inside.
    pub(crate) fn at(
        &self,
        angle: f64,
        count: usize,
        random: &mut Random,
    ) -> Vec<(Driver, Quat, bool)> {
        let mut found = [vec![], vec![]];
        while found.iter().any(|list| list.len() < count / 2) {
            let driver = (self.driver)(random);
            let holds = |q: Quat| (self.holds)(driver, q);
            let from = self.any(random);
            let about = |random: &mut Random| {
                if self.hinge { Vec3::Z * random.normal().signum() } else { random.direction() }
            };
            let way = about(random) * 0.4;
            let inside = holds(from);
            if holds(from * Quat::exp(way)) == inside {
                continue;
            }
            let (mut near, mut far) = (0.0, 1.0);
            for _ in 0..20 {
                let middle = 0.5 * (near + far);
                if holds(from * Quat::exp(way * middle)) == inside {
                    near = middle
                } else {
                    far = middle
                }
            }
            let edge = from * Quat::exp(way * near);
            let q = (edge * Quat::exp(about(random) * (angle * (1.0 + 0.2 * random.unit()))))
                .normalized();
            let inside = holds(q);
            let same = |part: f64, random: &mut Random| {
                (0..400).all(|_| holds(q * Quat::exp(about(random) * (angle * part))) == inside)
            };
            if !same(0.93, random) || same(1.07, random) {
                continue;
            }
            let list = &mut found[usize::from(inside)];
            if list.len() < count / 2 {
                list.push((driver, q, inside));
            }
        }
        found.into_iter().flatten().collect()
    }
}

/// Balanced accuracy, of what is outside, of what is inside.
pub(crate) fn accuracy(
    points: &[(Driver, Quat, bool)],
    valid: impl Fn(Quat, Driver) -> bool,
) -> [f64; 3] {
    let (mut good, mut all) = ([0.0; 2], [0.0; 2]);
    for (driver, q, inside) in points {
        all[usize::from(*inside)] += 1.0;
        good[usize::from(*inside)] += f64::from(u8::from(valid(*q, *driver) == *inside));
    }
    let [outside, inside] = [good[0] / all[0], good[1] / all[1]];
    [0.5 * (outside + inside), outside, inside]
}
