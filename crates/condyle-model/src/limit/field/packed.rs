//! Rotations in 48 bits: three numbers of 16 bits in the map x = √2 v/√(1 + w), w ≥ 0, a ball of radius √2.
//!
//! A step is 2√2/65535; rounding turns a rotation by at most 0.01 degrees. What was packed and unpacked packs to
//! the same bits: of the two signs of a half turn only that is used whose w is above 0.

use super::chart::{mapped, signed, unmapped};
use condyle_math::Quat;
use std::f64::consts::SQRT_2;

/// Beyond this w both signs round to themselves.
const ABOVE: f64 = 1e-9;
const STEP: f64 = 2.0 * SQRT_2 / 65535.0;

/// A rotation as three numbers. What is no rotation becomes the identity.
///
/// ```
/// use condyle_model::limit::field::{packed, unpacked};
/// use condyle_math::{Quat, Vec3};
/// let q = Quat::from_axis_angle(Vec3::Y, 3.0);
/// let again = unpacked(packed(q)).unwrap();
/// assert!(again.angle_to(q) < 0.01f64.to_radians());
/// assert_eq!(packed(again), packed(q));
/// ```
#[must_use]
pub fn packed(q: Quat) -> [u16; 3] {
    let q = signed(q.normalized());
    let x = mapped(q);
    if !x.iter().all(|c| c.is_finite()) {
        return packed(Quat::IDENTITY);
    }
    let near = x.map(|c| ((c + SQRT_2) / STEP).round().clamp(0.0, 65535.0) as u16);
    if unpacked(near).is_some() {
        return near;
    }
    // Beyond the half turns: the nearest of those about it that is not.
    let mut best = (f64::INFINITY, near);
    for n in 0..27u16 {
        let by = [n % 3, n / 3 % 3, n / 9];
        let code =
            std::array::from_fn(|i| (near[i] + by[i].min(65535 - near[i])).saturating_sub(1));
        if let Some(p) = unpacked(code)
            && p.angle_to(q) < best.0
        {
            best = (p.angle_to(q), code);
        }
    }
    best.1
}

/// The rotation of three numbers, w > 0; `None` if they are beyond the half turns.
#[must_use]
pub fn unpacked(code: [u16; 3]) -> Option<Quat> {
    let q = unmapped(code.map(|c| f64::from(c) * STEP - SQRT_2))?;
    (q.w > ABOVE).then(|| q.normalized())
}

/// A rotation as it is after being packed, within 0.01 degrees.
#[must_use]
pub fn snapped(q: Quat) -> Quat {
    unpacked(packed(q)).unwrap_or(Quat::IDENTITY)
}

#[cfg(test)]
mod tests {
    use super::*;
    use condyle_math::Vec3;

    #[test]
    fn packing_is_within_a_hundredth_of_a_degree_and_packs_again_to_the_same() {
        let mut state = 1u64;
        let mut unit = || {
            state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            (state >> 11) as f64 / (1u64 << 53) as f64 - 0.5
        };
        let mut worst = 0.0f64;
        for n in 0..20_000 {
            let mut q = Quat { x: unit(), y: unit(), z: unit(), w: unit() };
            if n % 4 == 0 {
                // Half turns, where both signs meet.
                q.w = 1e-5 * unit();
            }
            if n % 100 == 0 {
                q = Quat { z: 0.0, w: 0.0, ..q };
            }
            let q = q.normalized();
            let code = packed(q);
            assert_eq!(code, packed(-q), "{q:?}");
            let again = unpacked(code).unwrap();
            assert_eq!(packed(again), code);
            assert_eq!(packed(-again), code);
            worst = worst.max(again.angle_to(q).to_degrees());
        }
        assert!(worst < 0.01 && worst > 0.004, "{worst}");
    }

    #[test]
    fn nothing_is_no_rotation_and_corners_are_none() {
        assert!(unpacked([0; 3]).is_none());
        assert!(unpacked([65535; 3]).is_none());
        for broken in [[f64::NAN; 4], [0.0; 4], [f64::INFINITY; 4]] {
            assert!(snapped(Quat::from(broken)).angle_to(Quat::IDENTITY) < 2e-4);
        }
        assert!(snapped(Quat::exp(Vec3::X * 1e-7)).angle_to(Quat::IDENTITY) < 2e-4);
    }
}
