//! Sets of rotations whose inside is known, and rotations at known distances from their boundaries.

use condyle_math::{Mat3, Quat, Vec3};

/// A set of rotations by whether it holds one.
#[derive(Clone, Copy)]
pub(crate) struct Shape {
    pub(crate) name: &'static str,
    pub(crate) holds: fn(Quat) -> bool,
}

pub(crate) const SHAPES: [Shape; 6] = [
    Shape { name: "shoulder of Lenarcic & Umek", holds: shoulder },
    Shape { name: "ball of 70 degrees", holds: ball },
    Shape { name: "Euler box, sharp edges", holds: euler_box },
    Shape { name: "swing past a hemisphere", holds: wide },
    Shape { name: "all turns about an axis, across the antipode", holds: ring },
    Shape { name: "ball of 80 degrees with a hole of 30", holds: hollow },
];

/// More shapes, looked at only when the method was settled.
#[allow(dead_code, reason = "only the example looks at them")]
pub(crate) const ASIDE: [Shape; 6] = [
    Shape { name: "two balls that overlap", holds: two_balls },
    Shape { name: "slab, 15 degrees thick", holds: slab },
    Shape { name: "all but a ball of 60 degrees", holds: all_but },
    Shape { name: "horseshoe", holds: horseshoe },
    Shape { name: "ellipsoid of 80, 45 and 30 degrees about a half turn", holds: ellipsoid },
    Shape { name: "reach of a forearm, 30 degrees thick", holds: forearm },
];

fn two_balls(q: Quat) -> bool {
    let other = Quat::from_axis_angle(Vec3::new(0.0, 0.8, 0.6), 80f64.to_radians());
    degrees(q.angle_to(Quat::IDENTITY)) <= 60.0 || degrees(q.angle_to(other)) <= 40.0
}

/// The z axis goes up to 70 degrees from rest, with a twist within 7.5 degrees.
fn slab(q: Quat) -> bool {
    let swing = degrees(2.0 * (q.x * q.x + q.y * q.y).sqrt().atan2((q.z * q.z + q.w * q.w).sqrt()));
    swing <= 70.0 && degrees(2.0 * (q.z / q.w).atan()).abs() <= 7.5
}

fn all_but(q: Quat) -> bool {
    degrees(q.angle_to(Quat::IDENTITY)) >= 60.0
}

/// Within 28 degrees of an arc of 240 degrees: turns about z of a turn of 60 degrees about x.
fn horseshoe(q: Quat) -> bool {
    let turn = Quat::from_axis_angle(Vec3::X, 60f64.to_radians());
    // Of turns about z the one for which turn(z)·turn is nearest to q: the angle of q·turn⁻¹ about z.
    let back = q * turn.conjugate();
    let angle = degrees(2.0 * (back.z / back.w).atan()).clamp(-120.0, 120.0);
    degrees((Quat::from_axis_angle(Vec3::Z, angle.to_radians()) * turn).angle_to(q)) <= 28.0
}

fn ellipsoid(q: Quat) -> bool {
    let middle = Quat { x: 0.6, y: 0.0, z: 0.8, w: 0.0 };
    let v = (middle.conjugate() * q).log();
    let [a, b, c] = [degrees(v.x) / 80.0, degrees(v.y) / 45.0, degrees(v.z) / 30.0];
    a * a + b * b + c * c <= 1.0
}

/// Flexion of 0 to 140 degrees about x, 15 to either side, then a turn of 160 degrees about y.
fn forearm(q: Quat) -> bool {
    let r: Mat3 = q.to_mat3();
    let two = degrees((-r.at(0, 1)).clamp(-1.0, 1.0).asin());
    let one = degrees(r.at(2, 1).atan2(r.at(1, 1)));
    let three = degrees(r.at(0, 2).atan2(r.at(0, 0)));
    (0.0..=140.0).contains(&one) && two.abs() <= 15.0 && three.abs() <= 80.0
}

fn degrees(radians: f64) -> f64 {
    radians.to_degrees()
}

/// Lenarčič & Umek 1994: R = Rx(φ1)·Rz(φ2)·Ry(φ3) in degrees, φ2 within 90.
fn shoulder(q: Quat) -> bool {
    let r: Mat3 = q.to_mat3();
    let two = degrees((-r.at(0, 1)).clamp(-1.0, 1.0).asin());
    let one = degrees(r.at(2, 1).atan2(r.at(1, 1)));
    let three = degrees(r.at(0, 2).atan2(r.at(0, 0)));
    let product = one * two / 810.0;
    (-9.0..=160.0).contains(&one)
        && (-43.0 + one / 3.0..=153.0 - one / 6.0).contains(&two)
        && (-90.0 + 7.0 * one / 9.0 - two / 9.0 + 2.0 * product
            ..=60.0 + 4.0 * one / 9.0 - 5.0 * two / 9.0 + 5.0 * product)
            .contains(&three)
}

fn ball(q: Quat) -> bool {
    degrees(q.angle_to(Quat::IDENTITY)) <= 70.0
}

fn euler_box(q: Quat) -> bool {
    let r: Mat3 = q.to_mat3();
    let two = degrees((-r.at(0, 1)).clamp(-1.0, 1.0).asin());
    let one = degrees(r.at(2, 1).atan2(r.at(1, 1)));
    let three = degrees(r.at(0, 2).atan2(r.at(0, 0)));
    one.abs() <= 60.0 && two.abs() <= 40.0 && three.abs() <= 50.0
}

/// The z axis goes up to 110 degrees from rest, with a twist within 45 degrees.
fn wide(q: Quat) -> bool {
    let swing = degrees(2.0 * (q.x * q.x + q.y * q.y).sqrt().atan2((q.z * q.z + q.w * q.w).sqrt()));
    let twist = degrees(2.0 * (q.z / q.w).atan());
    swing <= 110.0 && twist.abs() <= 45.0
}

/// The x axis stays within 30 degrees; turns about it are free.
fn ring(q: Quat) -> bool {
    degrees(2.0 * (q.y * q.y + q.z * q.z).sqrt().atan2((q.x * q.x + q.w * q.w).sqrt())) <= 30.0
}

fn hollow(q: Quat) -> bool {
    let middle = Quat::from_axis_angle(Vec3::new(0.6, 0.0, 0.8), 30f64.to_radians());
    degrees(q.angle_to(Quat::IDENTITY)) <= 80.0 && degrees(q.angle_to(middle)) >= 30.0
}

/// Numbers that look random: xorshift.
pub(crate) struct Random(pub(crate) u64);

impl Random {
    pub(crate) fn unit(&mut self) -> f64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }

    pub(crate) fn normal(&mut self) -> f64 {
        (-2.0 * (1.0 - self.unit()).ln()).sqrt() * (std::f64::consts::TAU * self.unit()).cos()
    }

    pub(crate) fn direction(&mut self) -> Vec3 {
        Vec3::new(self.normal(), self.normal(), self.normal()).normalized()
    }

    /// Uniform over all rotations.
    pub(crate) fn rotation(&mut self) -> Quat {
        Quat { x: self.normal(), y: self.normal(), z: self.normal(), w: self.normal() }.normalized()
    }
}

impl Shape {
    /// Rotations uniform over the shape.
    pub(crate) fn samples(&self, count: usize, random: &mut Random) -> Vec<Quat> {
        let mut found = vec![];
        while found.len() < count {
            let q = random.rotation();
            if (self.holds)(q) {
                found.push(q);
            }
        }
        found
    }

    #[allow(dead_code, reason = "the example asks for it, the tests know the truth")]
    /// The share of all rotations, from 400 000.
    pub(crate) fn share(&self, random: &mut Random) -> f64 {
        let all = 400_000;
        (0..all).filter(|_| (self.holds)(random.rotation())).count() as f64 / f64::from(all)
    }

    /// Rotations on the boundary to 1e-6 rad: short ways from rotations uniform near it, halved.
    pub(crate) fn boundary(&self, count: usize, random: &mut Random) -> Boundary {
        let mut points = vec![];
        while points.len() < count {
            let from = random.rotation();
            let way = random.direction() * 0.2;
            let inside = (self.holds)(from);
            if (self.holds)(from * Quat::exp(way)) == inside {
                continue;
            }
            let (mut near, mut far) = (0.0, 1.0);
            for _ in 0..18 {
                let middle = 0.5 * (near + far);
                let same = (self.holds)(from * Quat::exp(way * middle)) == inside;
                if same { near = middle } else { far = middle }
            }
            points.push((from * Quat::exp(way * near)).normalized());
        }
        Boundary { points }
    }
}

/// Rotations on a boundary.
pub(crate) struct Boundary {
    pub(crate) points: Vec<Quat>,
}

impl Boundary {
    /// The nearest, and the angle to it.
    pub(crate) fn nearest(&self, q: Quat) -> (Quat, f64) {
        let mut best = (-1.0, Quat::IDENTITY);
        for p in &self.points {
            let dot = q.dot(*p).abs();
            if dot > best.0 {
                best = (dot, *p);
            }
        }
        (best.1, q.angle_to(best.1))
    }

    /// Rotations at an angle from the boundary, give or take a tenth, half of them inside.
    pub(crate) fn at(
        &self,
        shape: &Shape,
        angle: f64,
        count: usize,
        random: &mut Random,
    ) -> Vec<(Quat, bool)> {
        let (mut inside, mut outside) = (vec![], vec![]);
        let mut tries = 0;
        while inside.len().min(outside.len()) < count / 2 && tries < 100 * count {
            tries += 1;
            let start = self.points
                [(random.unit() * self.points.len() as f64) as usize % self.points.len()];
            let q = (start * Quat::exp(random.direction() * (angle * (1.0 + 0.2 * random.unit()))))
                .normalized();
            let held = (shape.holds)(q);
            let list = if held { &mut inside } else { &mut outside };
            if list.len() >= count / 2 || (self.nearest(q).1 / angle - 1.0).abs() > 0.1 {
                continue;
            }
            list.push((q, held));
        }
        inside.extend(outside);
        inside
    }
}

/// The part of a sorted list.
pub(crate) fn quantile(values: &mut [f64], part: f64) -> f64 {
    values.sort_by(f64::total_cmp);
    values[((values.len() as f64 * part) as usize).min(values.len() - 1)]
}
