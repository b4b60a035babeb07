//! The field of spheres whose level set is the limit (section 4.2, equation 5).
//!
//! ```text
//!            -k (r - e) + 1             0 ≤ r ≤ e
//! f(r)  =    ¼ (k (r - e) - 2)²         e < r ≤ e + 2/k          F(p) = Σ f_i(|p - c_i|)
//!            0                          beyond
//! ```
//!
//! f(0) = k e + 1, f(e) = 1, f(e + 1/k) = ¼, with the slope -k on both sides of e. A rotation is possible
//! where F ≥ iso = 1. Beyond 2/k = 0.4 of every sphere F and its gradient are exactly 0.

use condyle_math::Vec3;

/// The level of the surface: F = 1.
pub const ISO: f64 = 1.0;

/// One sphere: where its own field alone is 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Primitive {
    /// The centre c.
    pub centre: Vec3,
    /// The radius e, not negative.
    pub radius: f64,
}

/// f, its slope and its curvature along r, for a sphere of radius e and stickiness k.
#[inline(always)]
pub fn profile(r: f64, e: f64, k: f64) -> (f64, f64, f64) {
    let u = k * (r - e);
    if u <= 0.0 {
        (1.0 - u, -k, 0.0)
    } else if u <= 2.0 {
        (0.25 * (u - 2.0) * (u - 2.0), 0.5 * k * (u - 2.0), 0.5 * k * k)
    } else {
        (0.0, 0.0, 0.0)
    }
}

/// A sum of spheres.
#[derive(Clone, Debug, PartialEq)]
pub struct SphereField {
    /// The spheres.
    pub primitives: Vec<Primitive>,
    /// The stickiness k of all of them.
    pub stickiness: f64,
}

impl SphereField {
    /// The field F at a point: at least 1 inside.
    ///
    /// ```
    /// use condyle_learn::limits::herda2003::{Primitive, SphereField};
    /// use condyle_math::Vec3;
    /// let primitives = vec![Primitive { centre: Vec3::ZERO, radius: 0.5 }];
    /// let field = SphereField { primitives, stickiness: 5.0 };
    /// assert_eq!(field.value(Vec3::ZERO), 3.5);
    /// assert_eq!(field.value(Vec3::X * 0.5), 1.0);
    /// ```
    #[inline]
    pub fn value(&self, point: Vec3) -> f64 {
        let k = self.stickiness;
        self.primitives.iter().map(|s| profile((point - s.centre).norm(), s.radius, k).0).sum()
    }

    /// The field and its gradient; a sphere adds no gradient at its own centre.
    pub fn value_and_gradient(&self, point: Vec3) -> (f64, Vec3) {
        let (mut value, mut gradient) = (0.0, Vec3::ZERO);
        for s in &self.primitives {
            let from = point - s.centre;
            let r = from.norm();
            let (f, slope, _) = profile(r, s.radius, self.stickiness);
            value += f;
            if r > 0.0 {
                gradient += from * (slope / r);
            }
        }
        (value, gradient)
    }

    /// The distance e + 2/k beyond which a sphere has no influence.
    #[inline(always)]
    pub fn support(&self, primitive: &Primitive) -> f64 {
        primitive.radius + 2.0 / self.stickiness
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_profile_has_the_values_of_equation_5() {
        for k in [5.0, 2.0, 8.0] {
            for e in [0.0, 0.25, 0.5, 1.0] {
                assert!((profile(0.0, e, k).0 - (k * e + 1.0)).abs() < 1e-14);
                assert!((profile(e, e, k).0 - 1.0).abs() < 1e-14);
                assert!((profile(e + 1.0 / k, e, k).0 - 0.25).abs() < 1e-14);
                assert!(profile(e + 2.0 / k, e, k).0.abs() < 1e-14);
                assert_eq!(profile(e + 2.0 / k + 1e-9, e, k), (0.0, 0.0, 0.0));
                // The slope on both sides of e, from the formula's own differences: the second piece is
                // quadratic, so its one-sided difference is off by curvature · step / 2 = k² h / 4.
                let h = 1e-6;
                let outside = (profile(e + h, e, k).0 - profile(e, e, k).0) / h;
                assert!((outside + k).abs() < 0.25 * k * k * h + 1e-8, "{outside}");
                if e > 0.0 {
                    let inside = (profile(e, e, k).0 - profile(e - h, e, k).0) / h;
                    assert!((inside + k).abs() < 1e-8, "{inside}");
                }
                assert!((profile(e + 1e-12, e, k).1 + k).abs() < 1e-9);
                assert!((profile(e, e, k).1 + k).abs() < 1e-14);
            }
        }
    }

    #[test]
    fn the_gradient_is_that_of_differences() {
        let sphere = |x, y, z, radius| Primitive { centre: Vec3::new(x, y, z), radius };
        let field = SphereField {
            primitives: vec![
                sphere(0.0, 0.1, 0.0, 0.3),
                sphere(0.3, -0.1, 0.2, 0.2),
                sphere(-0.4, 0.0, 0.1, 0.1),
            ],
            stickiness: 5.0,
        };
        for i in 0..200 {
            let t = f64::from(i);
            let p = Vec3::new(0.5 * t.sin(), 0.5 * (1.3 * t).cos(), 0.5 * (0.7 * t).sin());
            let (value, gradient) = field.value_and_gradient(p);
            assert_eq!(value, field.value(p));
            let h = 1e-6;
            for (axis, slope) in [Vec3::X, Vec3::Y, Vec3::Z].into_iter().zip(gradient.to_array()) {
                let ahead = field.value(p + axis * h);
                let difference = (ahead - field.value(p - axis * h)) / (2.0 * h);
                // Where the step crosses a kink of the slope: curvature k²/2 times the step, per sphere.
                assert!((difference - slope).abs() < 4e-5, "{i}: {difference} {slope}");
            }
        }
    }
}
