//! What is minimised (section 4.3, equation 6), and how.
//!
//! ```text
//! E = 1/N Σ_j (F(P_j) - iso)²  +  α₁/M Σ_i exp(β₁ e_i)  +  α₂/M Σ_i |c_i - c|²
//! ```
//!
//! over the N surface points and the M spheres, c being the centroid of the surface points. Equation 6
//! prints f for F. α₁ = 0, so that the second term is absent (the paper gives no β₁), and α₂ = 0.01.
//!
//! The paper does not say which method minimises E. Here it is the solver of `condyle-solve`:
//! Gauss-Newton in a box-shaped trust region, with the second derivatives near the minimum; centres are free,
//! radii at least 0. With d = (c, e), u = (p - c)/r and f of `field.rs`:
//!
//! ```text
//! ∂f/∂c = -f′ u      ∂f/∂e = -f′      ∂²f/∂d² = f″ (u, 1)(u, 1)ᵀ + f′ (I - u uᵀ)/r (in c)
//! ```

use super::field::{ISO, Primitive, SphereField, profile};
use condyle_math::Vec3;
use condyle_solve::least_squares::{LocalModel, Problem};

/// The weight α₂ of the distance of spheres from the centroid.
pub const ALPHA_2: f64 = 0.01;

/// E as a problem of least squares, whose unknowns are c and e of each sphere, one after another.
#[derive(Debug)]
pub struct Energy<'a> {
    points: &'a [Vec3],
    centroid: Vec3,
    pull: f64,
    field: SphereField,
    trial: SphereField,
    /// Of one point: the spheres that reach it, with ∂F/∂(c, e) and the parts of its second derivative.
    reached: Vec<Reached>,
}

#[derive(Clone, Copy, Debug)]
struct Reached {
    sphere: usize,
    slope: [f64; 4],
    /// u, f′/r, f″.
    along: [f64; 3],
    bend: f64,
    curvature: f64,
}

impl<'a> Energy<'a> {
    /// The energy of a field over surface points with this centroid, with α₂ = `pull`.
    pub fn new(points: &'a [Vec3], centroid: Vec3, pull: f64, field: SphereField) -> Self {
        let reached = Vec::with_capacity(field.primitives.len());
        Self { points, centroid, pull, trial: field.clone(), field, reached }
    }

    /// The field at the current point.
    pub fn into_field(self) -> SphereField {
        self.field
    }

    /// E of a field.
    pub fn of(&self, field: &SphereField) -> f64 {
        let squares: f64 = self.points.iter().map(|p| (field.value(*p) - ISO).powi(2)).sum();
        let away: f64 =
            field.primitives.iter().map(|s| (s.centre - self.centroid).norm_squared()).sum();
        squares / self.points.len().max(1) as f64
            + self.pull * away / field.primitives.len().max(1) as f64
    }

    /// Fills `reached` for a point; returns F there.
    fn reach(&mut self, point: Vec3) -> f64 {
        self.reached.clear();
        let mut value = 0.0;
        for (i, s) in self.field.primitives.iter().enumerate() {
            let from = point - s.centre;
            let r = from.norm();
            let (f, slope, curvature) = profile(r, s.radius, self.field.stickiness);
            value += f;
            if slope == 0.0 {
                continue;
            }
            // At the centre the direction is undefined: no slope along c.
            let inverse = if r > 0.0 { 1.0 / r } else { 0.0 };
            let along = (from * inverse).to_array();
            let slopes = [-slope * along[0], -slope * along[1], -slope * along[2], -slope];
            self.reached.push(Reached {
                sphere: i,
                slope: slopes,
                along,
                bend: slope * inverse,
                curvature,
            });
        }
        value
    }
}

/// The sphere at position i of a field after a step.
fn stepped(sphere: &Primitive, step: &[f64]) -> Primitive {
    Primitive {
        centre: sphere.centre + Vec3::new(step[0], step[1], step[2]),
        radius: sphere.radius + step[3],
    }
}

impl Problem for Energy<'_> {
    fn evaluate(&mut self, step: &[f64], _: &mut [f64], _: &mut [f64]) -> f64 {
        let moved = self.field.primitives.iter().zip(step.chunks_exact(4));
        for (trial, (sphere, step)) in self.trial.primitives.iter_mut().zip(moved) {
            *trial = stepped(sphere, step);
        }
        self.of(&self.trial)
    }

    fn accept(&mut self) {
        self.field.primitives.copy_from_slice(&self.trial.primitives);
    }

    fn linearise(&mut self, local: &mut LocalModel) {
        let n = 4 * self.field.primitives.len();
        local.hessian.fill(0.0);
        local.gradient.fill(0.0);
        let weight = 2.0 / self.points.len().max(1) as f64;
        for j in 0..self.points.len() {
            let residual = self.reach(self.points[j]) - ISO;
            for (a, first) in self.reached.iter().enumerate() {
                let row = 4 * first.sphere;
                for i in 0..4 {
                    local.gradient[row + i] += weight * residual * first.slope[i];
                }
                // Spheres are in ascending order: only the lower triangle is filled.
                for second in &self.reached[..=a] {
                    let column = 4 * second.sphere;
                    for i in 0..4 {
                        for k in 0..4 {
                            local.hessian[(row + i) * n + column + k] +=
                                weight * first.slope[i] * second.slope[k];
                        }
                    }
                }
                if local.curved {
                    let u = [first.along[0], first.along[1], first.along[2], 1.0];
                    for i in 0..4 {
                        for k in 0..=i {
                            let mut second = first.curvature * u[i] * u[k];
                            if i < 3 {
                                let unit = if i == k { 1.0 } else { 0.0 };
                                second += first.bend * (unit - u[i] * u[k]);
                            }
                            local.hessian[(row + i) * n + row + k] += weight * residual * second;
                        }
                    }
                }
            }
        }
        let pull = 2.0 * self.pull / self.field.primitives.len().max(1) as f64;
        for (i, sphere) in self.field.primitives.iter().enumerate() {
            let away = (sphere.centre - self.centroid).to_array();
            for axis in 0..3 {
                local.gradient[4 * i + axis] += pull * away[axis];
                local.hessian[(4 * i + axis) * n + 4 * i + axis] += pull;
            }
            local.lower[4 * i..4 * i + 4].fill(f64::NEG_INFINITY);
            local.upper[4 * i..4 * i + 4].fill(f64::INFINITY);
            local.lower[4 * i + 3] = -sphere.radius;
        }
    }
}
