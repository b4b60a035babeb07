//! The signed distance of a point from an ellipsoid.
//!
//! The point x of the ellipsoid with half axes r that is nearest to a point p satisfies
//! p - x = t·x/r²: the difference is along the normal. So x = r²·p/(r² + t), component by
//! component, and t is the root above -r_min² of
//!
//! ```text
//! F(t) = Σ (r·p / (r² + t))² - 1
//! ```
//!
//! F is decreasing and convex there, so Newton steps from below the root never pass it; the largest
//! t at which one term alone is 1 is a starting point below it. The distance is |t|·|x/r²|, outside
//! if t > 0. With lengths divided by r_min and s = t + 1 as the unknown nothing cancels, neither
//! near the centre nor for a point close to the plane perpendicular to the shortest axis. If p is
//! in that plane and so near to the centre that there is no root, t = -r_min² and the component of
//! x along the shortest axis follows from the equation of the ellipsoid.

use condyle_math::Vec3;

/// The distance of a point from an ellipsoid.
#[derive(Clone, Copy, Debug)]
pub(super) struct Distance {
    /// In metres, positive outside.
    pub(super) signed: f64,
    /// Its gradient: the outward normal at the nearest point, of length 1.
    pub(super) normal: Vec3,
}

/// The distance of a point from the ellipsoid about the origin with these half axes.
///
/// Infinite for a point that is not finite, or beyond about 1e150 times the shortest half axis.
pub(super) fn distance(point: Vec3, radii: Vec3) -> Distance {
    let shortest = radii.x.min(radii.y).min(radii.z);
    // Lengths relative to r_min; by symmetry p is moved to the first octant.
    let size = 1.0 / shortest;
    let r = radii.to_array().map(|r| r * size);
    let p = point.to_array().map(|p| p.abs() * size);
    let far = Distance { signed: f64::INFINITY, normal: Vec3::Z };
    let sum = r.iter().chain(&p).sum::<f64>();
    if sum.is_nan() || sum > 1e150 {
        return far;
    }
    // r² - 1, factored so that it is accurate near 1, and r·p. The term i of F is (rp/(s + above))²
    // and equals 1 at s = rp - above.
    let above = r.map(|r| (r - 1.0) * (r + 1.0));
    let rp = [r[0] * p[0], r[1] * p[1], r[2] * p[2]];
    let mut s: f64 = 0.0;
    for i in 0..3 {
        s = s.max(rp[i] - above[i]);
    }
    let quotient = |s: f64, i: usize| if rp[i] > 0.0 { rp[i] / (s + above[i]) } else { 0.0 };
    let excess = |s: f64| (0..3).map(|i| quotient(s, i).powi(2)).sum::<f64>() - 1.0;
    // x/r, component by component.
    let mut ratio;
    if s > 0.0 || excess(0.0) > 0.0 {
        for _ in 0..100 {
            // F(s) and -F′(s), both from the same quotients.
            let (mut value, mut slope) = (-1.0, 0.0);
            for i in 0..3 {
                let q = quotient(s, i);
                value += q * q;
                slope += 2.0 * q * q / (s + above[i]).max(f64::MIN_POSITIVE);
            }
            let next = s + value / slope;
            // The sequence increases until rounding stops it. At the start one term is 1, so the
            // slope is not 0.
            if next.is_nan() || next <= s * (1.0 + 1e-15) {
                break;
            }
            s = next;
        }
        ratio = [0, 1, 2].map(|i| quotient(s, i));
    } else {
        // No root: t = -r_min². |x/r|² = 1 gives the component along the shortest axis, where p is
        // 0; both signs are equally near.
        s = 0.0;
        ratio = [0, 1, 2].map(|i| quotient(0.0, i));
        let left = -excess(0.0);
        if let Some(i) = (0..3).find(|&i| above[i] == 0.0) {
            ratio[i] = left.max(0.0).sqrt();
        }
    }
    // x/r² is normal to the surface, and the distance is |t| times its length.
    let slope = [0, 1, 2].map(|i| ratio[i] / r[i]);
    let length = slope.iter().map(|x| x * x).sum::<f64>().sqrt();
    let signed = (s - 1.0) * length * shortest;
    let unit = [0, 1, 2].map(|i| (slope[i] / length).copysign(point.to_array()[i]));
    if !(signed.is_finite() && length > 0.0) {
        return far;
    }
    Distance { signed, normal: unit.into() }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The smallest distance over a grid on the ellipsoid that is refined around its best point.
    fn slow(p: Vec3, r: Vec3) -> f64 {
        let at = |u: f64, v: f64| {
            Vec3::new(r.x * u.cos() * v.cos(), r.y * u.sin() * v.cos(), r.z * v.sin())
        };
        let mut best = (f64::INFINITY, 0.0, 0.0);
        let (mut centre, mut reach, mut steps) = ((0.0, 0.0), 3.2, 60);
        for _ in 0..24 {
            for i in -steps..=steps {
                for j in -steps..=steps {
                    let h = reach / f64::from(steps);
                    let (u, v) = (centre.0 + f64::from(i) * h, centre.1 + f64::from(j) * h);
                    let d = (at(u, v) - p).norm();
                    if d < best.0 {
                        best = (d, u, v);
                    }
                }
            }
            centre = (best.1, best.2);
            reach *= 0.3;
            steps = 12;
        }
        best.0
    }

    fn inside(p: Vec3, r: Vec3) -> bool {
        (p.x / r.x).powi(2) + (p.y / r.y).powi(2) + (p.z / r.z).powi(2) < 1.0
    }

    #[test]
    fn distances_are_those_of_a_search_over_the_surface() {
        let radii =
            [Vec3::new(0.07, 0.15, 0.09), Vec3::new(0.1, 0.1, 0.2), Vec3::new(0.2, 0.05, 0.05)];
        let mut state = 7u64;
        let mut random = || {
            state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            (state >> 11) as f64 / (1u64 << 53) as f64 * 0.4 - 0.2
        };
        for r in radii {
            for i in 0..16 {
                let mut p = Vec3::new(random(), random(), random());
                // Also on the planes, on the axes, near the planes, near the centre.
                p = match i {
                    8 => Vec3::new(0.0, p.y, p.z),
                    9 => Vec3::new(p.x, 0.0, 0.0),
                    10 => Vec3::new(0.0, 0.0, p.z),
                    11 => Vec3::new(p.x * 1e-9, p.y * 0.1, p.z),
                    12 => p * 1e-3,
                    13 => Vec3::new(0.0, p.y * 0.1, 0.0),
                    14 => Vec3::new(0.3, 0.0, 1e-12),
                    _ => p,
                };
                let d = distance(p, r);
                let expected = slow(p, r);
                let sign = if inside(p, r) { -1.0 } else { 1.0 };
                assert!((d.signed - sign * expected).abs() < 1e-8, "{p:?} {r:?} {d:?} {expected}");
                // A step back along the normal ends on the surface.
                let foot = p - d.normal * d.signed;
                let off = foot.times(Vec3::new(1.0 / r.x, 1.0 / r.y, 1.0 / r.z)).norm();
                assert!((off - 1.0).abs() < 1e-12, "{p:?} {r:?} {d:?} {off}");
            }
        }
    }

    #[test]
    fn centre_sphere_poles_and_far_points_have_the_distances_of_geometry() {
        let r = Vec3::new(0.07, 0.15, 0.09);
        assert_eq!(distance(Vec3::ZERO, r).signed, -0.07);
        assert!((distance(Vec3::new(0.0, 0.2, 0.0), r).signed - 0.05).abs() < 1e-16);
        assert!((distance(Vec3::new(0.0, 0.15, 0.0), r).signed).abs() < 1e-16);
        let sphere = Vec3::new(0.1, 0.1, 0.1);
        let p = Vec3::new(0.01, -0.02, 0.05);
        assert!((distance(p, sphere).signed - (p.norm() - 0.1)).abs() < 1e-16);
        assert_eq!(distance(Vec3::ZERO, sphere).signed, -0.1);
        // From 1e9 m away the ellipsoid is a support function: |p| - |r·p|/|p|.
        let far = Vec3::new(1e9, 1e9, 0.0);
        let support = (0.07f64.powi(2) + 0.15f64.powi(2)).sqrt() / 2f64.sqrt();
        assert!((distance(far, r).signed - (far.norm() - support)).abs() < 1e-6);
        assert_eq!(distance(Vec3::new(f64::NAN, 0.0, 0.0), r).signed, f64::INFINITY);
    }

    #[test]
    fn no_radii_and_no_point_break_it() {
        for e in -12..=12 {
            let thin = 10f64.powi(e);
            for p in [Vec3::new(1e-20, 0.3, 1e-300), Vec3::new(0.02, 0.0, 1e9), Vec3::X * thin] {
                let d = distance(p, Vec3::new(0.1, thin, 0.1));
                assert!(d.signed.is_finite() && d.normal.is_finite(), "{thin} {p:?} {d:?}");
                assert!((d.normal.norm() - 1.0).abs() < 1e-12, "{thin} {p:?} {d:?}");
            }
        }
    }
}
