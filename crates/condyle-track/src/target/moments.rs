//! The second moments of a segment's markers.
//!
//! With the twist (ω, l) of a direction, a marker at p moves by ω × p + l. Sums of products of such
//! velocities over all markers of a segment are those of weighted points in a rigid body, so
//!
//! ```text
//! Σₘ wₘ vₘⱼ·vₘₖ = tⱼ · (I tₖ),      Σₘ wₘ vₘⱼ·eₘ = tⱼ · f
//! ```
//!
//! with the spatial inertia I of the points and the wrench f of the errors. The cost of the normal
//! equations then does not grow with the number of markers.

use condyle_math::{Twist, Vec3};

/// Weighted sums over the markers of one segment, about the world's origin.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Moments {
    mass: f64,
    first: Vec3,
    /// Σ w p pᵀ: xx, yy, zz, xy, xz, yz.
    second: [f64; 6],
    force: Vec3,
    /// Σ w p eᵀ, by columns.
    cross: [Vec3; 3],
}

impl Moments {
    pub(crate) const ZERO: Self = Self {
        mass: 0.0,
        first: Vec3::ZERO,
        second: [0.0; 6],
        force: Vec3::ZERO,
        cross: [Vec3::ZERO; 3],
    };

    /// Adds a marker at `p` whose error is `e`.
    #[inline]
    pub(crate) fn add(&mut self, weight: f64, p: Vec3, e: Vec3) {
        self.mass += weight;
        self.first += p * weight;
        let products = [p.x * p.x, p.y * p.y, p.z * p.z, p.x * p.y, p.x * p.z, p.y * p.z];
        for (sum, product) in self.second.iter_mut().zip(products) {
            *sum += weight * product;
        }
        let e = e * weight;
        self.force += e;
        for (column, e) in self.cross.iter_mut().zip(e.to_array()) {
            *column += p * e;
        }
    }

    /// Adds the markers of another segment.
    #[inline]
    pub(crate) fn join(&mut self, other: &Self) {
        self.mass += other.mass;
        self.first += other.first;
        self.second.iter_mut().zip(other.second).for_each(|(sum, x)| *sum += x);
        self.force += other.force;
        self.cross.iter_mut().zip(other.cross).for_each(|(sum, x)| *sum += x);
    }

    /// `I t`, as a wrench: force and torque.
    #[inline]
    pub(crate) fn momentum(&self, t: Twist) -> (Vec3, Vec3) {
        let force = t.linear * self.mass + t.angular.cross(self.first);
        let [xx, yy, zz, xy, xz, yz] = self.second;
        let w = t.angular;
        let spin = Vec3::new(
            (yy + zz) * w.x - xy * w.y - xz * w.z,
            (xx + zz) * w.y - xy * w.x - yz * w.z,
            (xx + yy) * w.z - xz * w.x - yz * w.y,
        );
        (force, spin + self.first.cross(t.linear))
    }

    /// `t · f` for the wrench of the errors.
    #[inline]
    pub(crate) fn power(&self, t: Twist) -> f64 {
        let [x, y, z] = self.cross;
        // Σ w p × e.
        let torque = Vec3::new(z.y - y.z, x.z - z.x, y.x - x.y);
        t.linear.dot(self.force) + t.angular.dot(torque)
    }

    /// `Σ w v × e` for the velocities v of a twist.
    ///
    /// A motion u before it in the chain turns these velocities by ω_u × v, so that the scalar product
    /// with ω_u is `Σ w e · ∂v/∂u`: what Gauss and Newton leave out of the second derivative.
    #[inline]
    pub(crate) fn lever(&self, t: Twist) -> Vec3 {
        // (ω × p) × e = p (ω·e) - ω (p·e)
        let [x, y, z] = self.cross;
        let w = t.angular;
        x * w.x + y * w.y + z * w.z - w * (x.x + y.y + z.z) + t.linear.cross(self.force)
    }
}

/// `t · (I u)` for a momentum `I u`.
#[inline]
pub(crate) fn pair(t: Twist, (force, torque): (Vec3, Vec3)) -> f64 {
    t.linear.dot(force) + t.angular.dot(torque)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn moments_equal_the_sums_over_markers() {
        let markers = [
            (1.0, Vec3::new(0.3, -0.2, 0.9), Vec3::new(0.01, 0.02, -0.01)),
            (2.5, Vec3::new(-0.1, 0.4, 1.1), Vec3::new(-0.02, 0.00, 0.03)),
            (0.7, Vec3::new(0.2, 0.1, 0.7), Vec3::new(0.00, -0.01, 0.02)),
        ];
        let t = Twist::rotation(Vec3::new(0.6, 0.0, 0.8), Vec3::new(0.1, 0.2, 0.3));
        let u = Twist { angular: Vec3::new(-0.3, 0.5, 0.2), linear: Vec3::new(0.4, -0.1, 0.7) };
        let mut moments = Moments::ZERO;
        markers.iter().for_each(|&(w, p, e)| moments.add(w, p, e));
        let sum = |f: &dyn Fn(Vec3, Vec3) -> f64| -> f64 {
            markers.iter().map(|&(w, p, e)| w * f(p, e)).sum()
        };
        let product = sum(&|p, _| t.velocity_at(p).dot(u.velocity_at(p)));
        let power = sum(&|p, e| t.velocity_at(p).dot(e));
        let lever = markers.iter().map(|&(w, p, e)| t.velocity_at(p).cross(e) * w);
        let lever = lever.fold(Vec3::ZERO, |sum, x| sum + x);
        assert!((moments.lever(t) - lever).norm() < 1e-15);
        assert!((pair(t, moments.momentum(u)) - product).abs() < 1e-14);
        assert!((moments.power(t) - power).abs() < 1e-14);
    }
}
