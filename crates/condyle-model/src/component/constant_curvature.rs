//! The end of a circular arc of fixed length, bent by two angles and twisted by a third.
//!
//! R = Rx(α)·Rz(β)·Ry(γ), where each angle is its coordinate plus its neutral angle, clamped to
//! ±(π/2 - 0.01). With t = R·y and s = √(t_x² + t_z²) the arc spans the angle θ = asin s with
//! radius L/θ, so
//!
//! ```text
//! p = L/θ · ((1 - cos θ)·t_x/s,  s,  (1 - cos θ)·t_z/s)
//! ```
//!
//! For s below 0.001 or above 0.999 a straight rod p = L·t is used instead, for agreement with
//! OpenSim. The discontinuities, at s = 0.001 by 0.0005·L to the side and at s = 0.999, are OpenSim's.

use super::{Contract, Geometry, Kind, Mirrored, MotionLaw, Port, PortType, Reflection};
use condyle_math::{Affine, Mat3, Scalar, Vec3};
use std::f64::consts::FRAC_PI_2;

/// A flexible column such as a simplified lumbar spine.
#[derive(Clone, Debug, PartialEq)]
pub struct ConstantCurvature {
    /// Neutral angles about x, z and y, in this order, in radians; added to the inputs.
    pub neutral: [f64; 3],
    /// Length of the arc in metres.
    pub length: f64,
}

impl ConstantCurvature {
    pub(crate) const KIND: Kind = Kind {
        name: "constant_curvature",
        ports: &[
            Port::one("about_x", PortType::Scalar),
            Port::one("about_z", PortType::Scalar),
            Port::one("about_y", PortType::Scalar),
        ],
    };
}

impl Contract for ConstantCurvature {
    fn geometry(&mut self) -> Vec<Geometry<'_>> {
        vec![Geometry::Length(&mut self.length, Vec3::Y)]
    }

    fn mirror(&mut self, at: Reflection) -> Result<Mirrored, String> {
        // In the order x, z, y; a turn about an axis keeps its sign if that axis is reversed.
        let signs = match at.axis() {
            0 => [1.0, -1.0, -1.0],
            2 => [-1.0, 1.0, -1.0],
            _ => return Err("its rest direction is y: write both sides, or turn its frame".into()),
        };
        self.neutral = std::array::from_fn(|i| signs[i] * self.neutral[i]);
        Ok(Mirrored { inputs: signs.map(|sign| [sign, 0.0]).to_vec(), after: None })
    }
}

impl MotionLaw for ConstantCurvature {
    fn transform<S: Scalar>(&self, inputs: &[S]) -> Affine<S> {
        let bound = S::from_f64(FRAC_PI_2 - 0.01);
        let mut turns = [(S::zero(), S::one()); 3];
        for i in 0..3 {
            let angle = inputs[i] + S::from_f64(self.neutral[i]);
            let held = angle.select_less(-bound, -bound, bound.select_less(angle, bound, angle));
            turns[i] = held.sin_cos();
        }
        let rotation = Mat3::identity().rotated_x(turns[0]).rotated_z(turns[1]).rotated_y(turns[2]);
        let tip = rotation.y;
        let length = S::from_f64(self.length);
        let (low, high) = (S::from_f64(0.001), S::from_f64(0.999));
        let square = tip.x * tip.x + tip.z * tip.z;
        // Where the rod is selected, the arc is evaluated at sin² = 0.25 to keep it finite.
        let stand_in = S::from_f64(0.25);
        let safe = square.select_less(low * low, stand_in, square);
        let safe = (high * high).select_less(safe, stand_in, safe);
        let sine = safe.sqrt();
        let cosine = (S::one() - safe).sqrt();
        let theta = sine.atan2(cosine);
        let radius = length / theta;
        let out = radius * (S::one() - cosine) / sine;
        let arc = Vec3::new(out * tip.x, radius * sine, out * tip.z);
        let rod = tip * length;
        let choose = |arc: S, rod: S| {
            let inside = square.select_less(low * low, rod, arc);
            (high * high).select_less(square, rod, inside)
        };
        let end = Vec3::new(choose(arc.x, rod.x), choose(arc.y, rod.y), choose(arc.z, rod.z));
        Affine::new(rotation, end)
    }
}
