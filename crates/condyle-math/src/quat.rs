//! Unit quaternions: rotations without a singular orientation.

use crate::{Mat3, Scalar, Vec3};
use std::ops::{Mul, Neg};

/// Below this squared angle (in `exp`) or squared sine of the half angle (in `log`) the closed
/// forms, which divide by it, are replaced by their Taylor series.
///
/// The first omitted term is then below 1e-18, less than the rounding of f64.
const SERIES_BELOW: f64 = 1e-6;

/// A quaternion x i + y j + z k + w; a rotation when its length is 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Quat<S = f64> {
    /// Component of i.
    pub x: S,
    /// Component of j.
    pub y: S,
    /// Component of k.
    pub z: S,
    /// Real component.
    pub w: S,
}

impl Quat<f64> {
    /// No rotation.
    pub const IDENTITY: Self = Self { x: 0.0, y: 0.0, z: 0.0, w: 1.0 };

    /// The same quaternion as constants of another scalar.
    #[inline(always)]
    pub fn cast<S: Scalar>(self) -> Quat<S> {
        let [x, y, z, w] = self.to_array().map(S::from_f64);
        Quat { x, y, z, w }
    }

    /// The geodesic angle to another rotation in radians, in [0, π]; `q` and `-q` are the same
    /// rotation.
    ///
    /// θ = 2·acos|q·p|, computed with atan2, because acos loses half of the digits of small angles.
    ///
    /// ```
    /// use condyle_math::{Quat, Vec3};
    /// let a = Quat::from_axis_angle(Vec3::X, 0.1);
    /// let b = Quat::from_axis_angle(Vec3::X, -0.2);
    /// assert!((a.angle_to(-b) - 0.3).abs() < 1e-15);
    /// ```
    pub fn angle_to(self, other: Self) -> f64 {
        let between = self.conjugate() * other;
        2.0 * between.vector().norm().atan2(between.w.abs())
    }
}

impl<S: Copy> From<[S; 4]> for Quat<S> {
    #[inline(always)]
    fn from([x, y, z, w]: [S; 4]) -> Self {
        Self { x, y, z, w }
    }
}

impl<S: Copy> Quat<S> {
    /// The components in the order x, y, z, w.
    #[inline(always)]
    pub fn to_array(self) -> [S; 4] {
        [self.x, self.y, self.z, self.w]
    }

    /// The vector part.
    #[inline(always)]
    pub fn vector(self) -> Vec3<S> {
        Vec3::new(self.x, self.y, self.z)
    }
}

impl<S: Scalar> Quat<S> {
    /// The rotation of a matrix, by Shepperd's formulas.
    ///
    /// All four are evaluated and the one with the largest divisor is selected, so there is no
    /// branch on a value. `rotation` must be a proper rotation; normalisation removes small
    /// deviations.
    pub fn from_mat3(rotation: Mat3<S>) -> Self {
        let (a, b, c) = (rotation.x, rotation.y, rotation.z);
        let one = S::one();
        // a, b, c are the columns, so R₁₀ is a.y. With q = (x, y, z, w), from the diagonal:
        // 4x², 4y², 4z², 4w².
        let squares = [
            one + a.x - b.y - c.z,
            one - a.x + b.y - c.z,
            one - a.x - b.y + c.z,
            one + a.x + b.y + c.z,
        ];
        // 4xy, 4xz, 4yz from the symmetric part, and 4xw, 4yw, 4zw from the skew part.
        let pairs = [b.x + a.y, c.x + a.z, c.y + b.z];
        let turns = [b.z - c.y, c.x - a.z, a.y - b.x];
        // Row i is 4·qᵢ·q: each is q after normalisation, unless qᵢ is near 0.
        let candidates = [
            [squares[0], pairs[0], pairs[1], turns[0]],
            [pairs[0], squares[1], pairs[2], turns[1]],
            [pairs[1], pairs[2], squares[2], turns[2]],
            [turns[0], turns[1], turns[2], squares[3]],
        ];
        // The squares add up to 4, so the largest is at least 1 and nothing is divided by 0.
        let mut best = candidates[3];
        let mut largest = squares[3];
        for (candidate, square) in candidates.into_iter().zip(squares).take(3) {
            for (kept, new) in best.iter_mut().zip(candidate) {
                *kept = largest.select_less(square, new, *kept);
            }
            largest = largest.select_less(square, square, largest);
        }
        Self::from(best).normalized()
    }

    /// The rotation by `angle` (radians) about an axis of length 1.
    #[inline(always)]
    pub fn from_axis_angle(axis: Vec3<S>, angle: S) -> Self {
        let (s, c) = angle.scale(0.5).sin_cos();
        Self { x: axis.x * s, y: axis.y * s, z: axis.z * s, w: c }
    }

    /// The exponential map: the rotation about `v` by its length in radians; smooth at zero.
    #[inline]
    pub fn exp(v: Vec3<S>) -> Self {
        let square = v.norm_squared();
        let small = S::from_f64(SERIES_BELOW);
        // `select_less` evaluates both branches: where the series is selected the closed form runs
        // at angle 1, so that it does not divide by 0 and the square root has a finite slope.
        let angle = square.select_less(small, S::one(), square).sqrt();
        let (s, c) = angle.scale(0.5).sin_cos();
        // sin(θ/2)/θ = 1/2 - θ²/48 + θ⁴/3840 - …
        let factor = square.select_less(
            small,
            S::from_f64(0.5) - square.scale(1.0 / 48.0) + (square * square).scale(1.0 / 3840.0),
            s / angle,
        );
        // cos(θ/2) = 1 - θ²/8 + θ⁴/384 - …; where it is selected, c is the cosine for angle 1.
        let w = square.select_less(
            small,
            S::one() - square.scale(1.0 / 8.0) + (square * square).scale(1.0 / 384.0),
            c,
        );
        Self { x: v.x * factor, y: v.y * factor, z: v.z * factor, w }
    }

    /// The logarithm map: the shortest rotation vector, of length in [0, π]; inverse of
    /// [`Quat::exp`].
    ///
    /// At exactly π both signs of the axis are valid; the one stored in the quaternion is returned.
    #[inline]
    pub fn log(self) -> Vec3<S> {
        // Of q and -q the one with w ≥ 0, whose angle is at most π.
        let near = self.w.select_less(S::zero(), -S::one(), S::one());
        let (v, w) = (self.vector() * near, self.w * near);
        let square = v.norm_squared();
        let small = S::from_f64(SERIES_BELOW);
        // θ/|v| = 2·atan2(|v|, w)/|v|, with |v| = sin(θ/2); evaluated at |v| = 1 where not
        // selected.
        let sine = square.select_less(small, S::one(), square).sqrt();
        let closed = sine.atan2(w).scale(2.0) / sine;
        // The series is that of 2·atan(√t)/|v| in t = |v|²/w². It is selected only for a small
        // vector part, where w is near 1; elsewhere w may be 0 and the division uses 1 instead.
        let w_safe = square.select_less(small, w, S::one());
        let t = square / (w_safe * w_safe);
        let series = (S::one() - t.scale(1.0 / 3.0) + (t * t).scale(1.0 / 5.0)).scale(2.0) / w_safe;
        v * square.select_less(small, series, closed)
    }

    /// The inverse rotation.
    #[inline(always)]
    pub fn conjugate(self) -> Self {
        Self { x: -self.x, y: -self.y, z: -self.z, w: self.w }
    }

    /// The inner product of the four components.
    #[inline(always)]
    pub fn dot(self, other: Self) -> S {
        self.x * other.x + self.y * other.y + self.z * other.z + self.w * other.w
    }

    /// The same rotation with length 1; not finite for the zero quaternion.
    #[inline(always)]
    pub fn normalized(self) -> Self {
        let r = S::one() / self.dot(self).sqrt();
        Self { x: self.x * r, y: self.y * r, z: self.z * r, w: self.w * r }
    }

    /// The rotation matrix of a quaternion of any length; the identity for the zero quaternion.
    #[inline(always)]
    pub fn to_mat3(self) -> Mat3<S> {
        // R depends on products of two components over |q|²: no square root is needed. Where |q|²
        // underflows, dividing by 1 leaves all products near 0, and R the identity.
        let square = self.dot(self);
        let least = S::from_f64(1e-300);
        let s = S::from_f64(2.0) / square.select_less(least, S::one(), square);
        let (xs, ys, zs) = (self.x * s, self.y * s, self.z * s);
        let (wx, wy, wz) = (self.w * xs, self.w * ys, self.w * zs);
        let (xx, xy, xz) = (self.x * xs, self.x * ys, self.x * zs);
        let (yy, yz, zz) = (self.y * ys, self.y * zs, self.z * zs);
        let one = S::one();
        Mat3::from_columns(
            Vec3::new(one - (yy + zz), xy + wz, xz - wy),
            Vec3::new(xy - wz, one - (xx + zz), yz + wx),
            Vec3::new(xz + wy, yz - wx, one - (xx + yy)),
        )
    }
}

impl<S: Scalar> Mul for Quat<S> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, b: Self) -> Self {
        let a = self;
        Self {
            x: a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y,
            y: a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x,
            z: a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w,
            w: a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z,
        }
    }
}

impl<S: Scalar> Neg for Quat<S> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self { x: -self.x, y: -self.y, z: -self.z, w: -self.w }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Dual;
    use proptest::prelude::*;
    use std::f64::consts::PI;

    fn vectors(radius: f64) -> impl Strategy<Value = Vec3> {
        [-1.0..1.0, -1.0..1.0, -1.0..1.0f64]
            .prop_filter("a direction", |v| v.iter().map(|c| c * c).sum::<f64>() > 1e-4)
            .prop_flat_map(move |v| {
                (0.0..=radius).prop_map(move |r| Vec3::from(v).normalized() * r)
            })
    }

    proptest! {
        #[test]
        fn log_inverts_exp_up_to_pi(v in vectors(PI - 1e-9)) {
            prop_assert!((Quat::exp(v).log() - v).norm() < 1e-13 * (1.0 + v.norm()));
        }

        #[test]
        fn exp_and_log_are_safe_near_zero_and_pi(v in vectors(1.0), near_pi in any::<bool>(),
                                                 tiny in -18.0..-1.0f64) {
            let size = 10f64.powf(tiny);
            let v = v.normalized() * if near_pi { PI - size } else { size };
            let back = Quat::exp(v).log();
            // At π the axis may be returned with the other sign: compare as rotations.
            prop_assert!(Quat::exp(back).angle_to(Quat::exp(v)) < 1e-14);
            if !near_pi {
                prop_assert!((back - v).norm() <= 1e-15 * v.norm());
            }
        }

        #[test]
        fn matrix_round_trip_by_shepperd(v in vectors(PI)) {
            let q = Quat::exp(v);
            prop_assert!(Quat::from_mat3(q.to_mat3()).angle_to(q) < 1e-14);
            let m = q.to_mat3();
            prop_assert!((m.determinant() - 1.0).abs() < 1e-14);
            let axis = v * (1.0 / v.norm().max(1e-300));
            if v.norm() > 1e-3 {
                let twin = Mat3::rotation_about(axis, v.norm().sin_cos());
                prop_assert!((m.x - twin.x).norm() + (m.y - twin.y).norm() < 1e-14);
            }
        }

        #[test]
        fn derivatives_of_exp_and_log_equal_central_differences(v in vectors(3.0)) {
            let h = 1e-6;
            for i in 0..3 {
                let mut step = [0.0; 3];
                step[i] = h;
                let step = Vec3::from(step);
                let mut dual = v.cast::<Dual<1>>().to_array();
                dual[i].partials[0] = 1.0;
                let exact = Quat::exp(Vec3::from(dual));
                let (a, b) = (Quat::exp(v + step).to_array(), Quat::exp(v - step).to_array());
                for (e, (a, b)) in exact.to_array().iter().zip(a.into_iter().zip(b)) {
                    prop_assert!((e.partials[0] - (a - b) / (2.0 * h)).abs() < 1e-8);
                }
                // log(exp(v)) = v, so its derivative is a unit vector.
                let back = exact.log().to_array();
                for (j, b) in back.iter().enumerate() {
                    let expected = if i == j { 1.0 } else { 0.0 };
                    prop_assert!((b.partials[0] - expected).abs() < 1e-9);
                }
            }
        }

        #[test]
        fn products_agree_with_matrices(a in vectors(3.0), b in vectors(3.0)) {
            let (p, q) = (Quat::exp(a), Quat::exp(b));
            let (m, n) = ((p * q).to_mat3(), p.to_mat3() * q.to_mat3());
            prop_assert!((m.x - n.x).norm() + (m.y - n.y).norm() + (m.z - n.z).norm() < 1e-14);
        }
    }

    #[test]
    fn half_turns_keep_their_axis() {
        for axis in [Vec3::X, Vec3::Y, Vec3::Z, Vec3::new(0.6, 0.0, -0.8)] {
            let q = Quat::from_mat3(Mat3::rotation_about(axis, PI.sin_cos()));
            assert!((q.log().norm() - PI).abs() < 1e-14);
            assert!((q.log().normalized().dot(axis).abs() - 1.0).abs() < 1e-14);
        }
    }
}
