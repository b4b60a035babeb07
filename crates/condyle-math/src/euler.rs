//! The twelve Euler orders: from angles to a rotation matrix and back.
//!
//! An order is named by its body-fixed axes in the order of the product, so `zxy` is
//! R = Rz(a)·Rx(b)·Ry(c). With i, j the first two axes, k the remaining axis and e the sign of the
//! permutation (i, j, k), the matrix of the six Tait-Bryan orders i-j-k has
//!
//! ```text
//! R_ik = e·sin b,   R_jk = -e·sin a·cos b,  R_kk = cos a·cos b,
//! R_ij = -e·cos b·sin c,  R_ii = cos b·cos c
//! ```
//!
//! and that of the six proper Euler orders i-j-i has
//!
//! ```text
//! R_ii = cos b,  R_ji = sin a·sin b,  R_ki = -e·cos a·sin b,  R_ij = sin b·sin c,  R_ik = e·sin b·cos c
//! ```
//!
//! At the singular angle (gimbal lock: b = ±90° for i-j-k; 0° or 180° for i-j-i) only a + c or a -
//! c is determined; c = 0 is returned there.

use crate::{Mat3, Scalar, Vec3};
use std::fmt;
use std::str::FromStr;

/// Below this cosine (i-j-k) or sine (i-j-i) of the middle angle the order counts as singular.
const SINGULAR_BELOW: f64 = 1e-9;

/// One of the twelve Euler orders: rotations about three body-fixed axes.
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
pub struct EulerOrder {
    axes: [u8; 3],
}

impl EulerOrder {
    /// All twelve, Tait-Bryan orders first.
    pub const ALL: [Self; 12] = [
        Self { axes: [0, 1, 2] },
        Self { axes: [0, 2, 1] },
        Self { axes: [1, 0, 2] },
        Self { axes: [1, 2, 0] },
        Self { axes: [2, 0, 1] },
        Self { axes: [2, 1, 0] },
        Self { axes: [0, 1, 0] },
        Self { axes: [0, 2, 0] },
        Self { axes: [1, 0, 1] },
        Self { axes: [1, 2, 1] },
        Self { axes: [2, 0, 2] },
        Self { axes: [2, 1, 2] },
    ];

    /// Rx·Ry·Rz, the order of OpenSim's offset frames.
    pub const XYZ: Self = Self { axes: [0, 1, 2] };

    /// The three axes in the order of the product, each 0, 1 or 2.
    pub fn axes(self) -> [usize; 3] {
        self.axes.map(usize::from)
    }

    /// The rotation with these three angles in radians.
    ///
    /// ```
    /// use condyle_math::{EulerOrder, Mat3};
    /// let order: EulerOrder = "zxy".parse().unwrap();
    /// let m = order.to_mat3([0.1, 0.2, 0.3]);
    /// let twin = Mat3::rotation_z(0.1) * Mat3::rotation_x(0.2) * Mat3::rotation_y(0.3);
    /// assert!((m.x - twin.x).norm() < 1e-15);
    /// ```
    pub fn to_mat3(self, angles: [f64; 3]) -> Mat3 {
        let mut m = Mat3::IDENTITY;
        for (axis, angle) in self.axes.into_iter().zip(angles) {
            let turn = angle.sin_cos();
            m = match axis {
                0 => m.rotated_x(turn),
                1 => m.rotated_y(turn),
                _ => m.rotated_z(turn),
            };
        }
        m
    }

    /// The three angles of a rotation, in radians.
    ///
    /// The outer two are in (-π, π]. The middle one is in [-π/2, π/2] for three different axes, and
    /// in [0, π] where the third axis equals the first. At a singular angle the third is 0.
    pub fn from_mat3<S: Scalar>(self, rotation: Mat3<S>) -> [S; 3] {
        let [i, j, last] = self.axes();
        let k = 3 - i - j;
        // j follows i cyclically for an even permutation.
        let e = S::from_f64(if (j + 3 - i) % 3 == 1 { 1.0 } else { -1.0 });
        let columns = [rotation.x, rotation.y, rotation.z].map(|column| column.to_array());
        let m = |r: usize, c: usize| columns[c][r];
        let least = S::from_f64(SINGULAR_BELOW);
        // The length of (a, b), with a derivative at 0 as well, which is not used.
        let length = |a: S, b: S| {
            let square = a * a + b * b;
            let tiny = S::from_f64(1e-300);
            let root = square.select_less(tiny, S::one(), square).sqrt();
            square.select_less(tiny, S::zero(), root)
        };
        // With c = 0, R = Ri(a)·Rj(b). Rj keeps its own axis, so column j of R is that of Ri(a):
        // R_jj = cos a, R_kj = e·sin a.
        let alone = || (e * m(k, j)).atan2(m(j, j));
        if last == k {
            // |cos b| from two entries, and atan2 instead of asin: asin loses digits near ±90°.
            let cosine = length(m(i, i), m(i, j));
            let b = (e * m(i, k)).atan2(cosine);
            let first = (-e * m(j, k)).atan2(m(k, k));
            let third = (-e * m(i, j)).atan2(m(i, i));
            let pick = |singular: S, plain: S| cosine.select_less(least, singular, plain);
            [pick(alone(), first), b, pick(S::zero(), third)]
        } else {
            // |sin b| likewise: acos loses digits near 0° and 180°.
            let sine = length(m(i, j), m(i, k));
            let b = sine.atan2(m(i, i));
            let first = m(j, i).atan2(-e * m(k, i));
            let third = m(i, j).atan2(e * m(i, k));
            let pick = |singular: S, plain: S| sine.select_less(least, singular, plain);
            [pick(alone(), first), b, pick(S::zero(), third)]
        }
    }

    /// The direction of axis `index` (0, 1 or 2) of the order, before any rotation.
    ///
    /// # Panics
    /// If `index` is above 2.
    pub fn axis(self, index: usize) -> Vec3 {
        [Vec3::X, Vec3::Y, Vec3::Z][self.axes()[index]]
    }
}

impl fmt::Display for EulerOrder {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.axes().iter().try_for_each(|&a| f.write_str(["x", "y", "z"][a]))
    }
}

impl fmt::Debug for EulerOrder {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(self, f)
    }
}

/// A name that is not one of the twelve orders.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct UnknownOrder(String);

impl fmt::Display for UnknownOrder {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "unknown rotation order `{}`: expected three of x, y, z with no axis twice in a row, \
             such as `zxy` or `yxy`",
            self.0
        )
    }
}

impl std::error::Error for UnknownOrder {}

impl FromStr for EulerOrder {
    type Err = UnknownOrder;

    fn from_str(name: &str) -> Result<Self, UnknownOrder> {
        Self::ALL
            .into_iter()
            .find(|order| order.to_string().eq_ignore_ascii_case(name))
            .ok_or_else(|| UnknownOrder(name.to_owned()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Quat;
    use proptest::prelude::*;
    use std::f64::consts::{FRAC_PI_2, PI};

    fn distance(a: Mat3, b: Mat3) -> f64 {
        Quat::from_mat3(a).angle_to(Quat::from_mat3(b))
    }

    proptest! {
        #[test]
        fn angles_round_trip_in_every_order(a in -PI..PI, b in 0.01..FRAC_PI_2 - 0.01, c in -PI..PI) {
            for order in EulerOrder::ALL {
                let [p, q, r] = order.from_mat3(order.to_mat3([a, b, c]));
                prop_assert!((p - a).abs() + (q - b).abs() + (r - c).abs() < 1e-12, "{order}");
            }
        }

        #[test]
        fn rotations_round_trip_at_and_near_the_singular_angle(
            a in -PI..PI, c in -PI..PI, tiny in -17.0..-1.0f64, at in 0usize..4,
        ) {
            let b = [0.0, FRAC_PI_2, -FRAC_PI_2, PI][at] + 10f64.powf(tiny);
            for order in EulerOrder::ALL {
                let m = order.to_mat3([a, b, c]);
                let again = order.to_mat3(order.from_mat3(m));
                // In the singular band the third angle is set to 0: an error of the band's width.
                prop_assert!(distance(m, again) < 4.0 * SINGULAR_BELOW, "{order}");
            }
        }
    }

    #[test]
    fn there_are_twelve_names() {
        let mut names: Vec<String> = EulerOrder::ALL.iter().map(ToString::to_string).collect();
        names.dedup();
        assert_eq!(names.len(), 12);
        assert!("xxy".parse::<EulerOrder>().is_err());
        assert_eq!("ZXY".parse::<EulerOrder>().unwrap().axes(), [2, 0, 1]);
    }
}
