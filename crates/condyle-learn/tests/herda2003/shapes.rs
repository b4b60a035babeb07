//! Limits of which every rotation is known to be inside or outside, and samples of them.

use condyle_math::{EulerOrder, Quat, Vec3};

/// A small generator of numbers that is the same everywhere (SplitMix64, Steele et al. 2014).
pub(crate) struct Random(u64);

impl Random {
    pub(crate) fn new(seed: u64) -> Self {
        Self(seed)
    }

    pub(crate) fn unit(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        (z ^ (z >> 31)) as f64 / 2f64.powi(64)
    }

    pub(crate) fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.unit()
    }

    /// A uniform rotation, by Shoemake's formula of three uniform numbers.
    pub(crate) fn rotation(&mut self) -> Quat {
        let (u, a, b) = (self.unit(), self.unit(), self.unit());
        let (sa, ca) = (std::f64::consts::TAU * a).sin_cos();
        let (sb, cb) = (std::f64::consts::TAU * b).sin_cos();
        let (p, q) = ((1.0 - u).sqrt(), u.sqrt());
        Quat { x: p * sa, y: p * ca, z: q * sb, w: q * cb }
    }
}

/// Whether a shoulder can take a rotation, in closed form (Lenarčič & Umek 1994).
///
/// The rotation is Rx(φ1)·Rz(φ2)·Ry(φ3) with φ2 within ±90 degrees; in degrees
///
/// φ1 ∈ [-9, 160], φ2 ∈ [-43 + φ1/3, 153 - φ1/6],
/// φ3 ∈ [-90 + 7φ1/9 - φ2/9 + 2φ1φ2/810, 60 + 4φ1/9 - 5φ2/9 + 5φ1φ2/810].
pub(crate) fn shoulder(rotation: Quat) -> bool {
    let order: EulerOrder = "xzy".parse().expect("an order of axes");
    let [a, b, c] = order.from_mat3(rotation.to_mat3()).map(f64::to_degrees);
    (-9.0..=160.0).contains(&a)
        && (-43.0 + a / 3.0..=153.0 - a / 6.0).contains(&b)
        && (-90.0 + 7.0 * a / 9.0 - b / 9.0 + 2.0 * a * b / 810.0
            ..=60.0 + 4.0 * a / 9.0 - 5.0 * b / 9.0 + 5.0 * a * b / 810.0)
            .contains(&c)
}

/// Uniform rotations inside a shape.
pub(crate) fn samples(
    shape: &dyn Fn(Quat) -> bool,
    count: usize,
    random: &mut Random,
) -> Vec<Quat> {
    let mut found = Vec::with_capacity(count);
    while found.len() < count {
        let q = random.rotation();
        if shape(q) {
            found.push(q);
        }
    }
    found
}

/// The mean rotation: the eigenvector of the largest eigenvalue of Σ q qᵀ, by powers.
pub(crate) fn mean(rotations: &[Quat]) -> Quat {
    let mut mean = rotations[0];
    for _ in 0..100 {
        let mut sum = [0.0; 4];
        for q in rotations {
            let along = q.dot(mean);
            for (s, x) in sum.iter_mut().zip(q.to_array()) {
                *s += along * x;
            }
        }
        mean = Quat::from(sum).normalized();
    }
    mean
}

/// Rotations by an angle in radians in directions spread evenly over the sphere.
pub(crate) fn around(angle: f64, count: usize) -> Vec<Quat> {
    let golden = std::f64::consts::PI * (3.0 - 5f64.sqrt());
    let direction = |i: usize| {
        let z = 1.0 - (2.0 * i as f64 + 1.0) / count as f64;
        let (sine, cosine) = (golden * i as f64).sin_cos();
        let ring = (1.0 - z * z).sqrt();
        Vec3::new(ring * cosine, ring * sine, z)
    };
    (0..count).map(|i| Quat::exp(direction(i) * angle)).collect()
}

/// Uniform rotations at least `from` and at most `to` (radians) from the surface of a shape, with whether
/// they are inside.
///
/// A rotation is at least so far if none of 60 rotations at that distance, nor of 20 at half of it, is on the
/// other side; it is at most so far if one of 60 at that distance is. Of a surface nearly flat over that
/// distance, the least spherical cap that can escape 60 even directions has a depth of 3 % of it.
pub(crate) fn labelled(
    shape: &dyn Fn(Quat) -> bool,
    [from, to]: [f64; 2],
    count: usize,
    random: &mut Random,
) -> Vec<(Quat, bool)> {
    let mut steps = around(from, 60);
    steps.extend(around(0.5 * from, 20));
    let beyond = around(to.min(std::f64::consts::PI), 60);
    let mut found = Vec::with_capacity(count);
    while found.len() < count {
        let q = random.rotation();
        let inside = shape(q);
        let far = steps.iter().all(|step| shape(q * *step) == inside);
        if far && (to.is_infinite() || beyond.iter().any(|step| shape(q * *step) != inside)) {
            found.push((q, inside));
        }
    }
    found
}

/// The share of the inside that a limit allows, and of the outside that it refuses.
pub(crate) fn shares(labelled: &[(Quat, bool)], allows: impl Fn(Quat) -> bool) -> [f64; 2] {
    let share = |inside: bool| {
        let of: Vec<&(Quat, bool)> =
            labelled.iter().filter(|(_, label)| *label == inside).collect();
        let right = of.iter().filter(|(q, label)| allows(*q) == *label).count();
        right as f64 / of.len() as f64
    };
    [share(true), share(false)]
}
