//! The possible rotation for an impossible one, by dichotomy (section 5.1, Figure 15).
//!
//! ```text
//! S_i   the sphere with the largest f_i(p)            d = |p - c_i| - e_i
//! p′ = p + d ∇F/|∇F|                                  "should be inside"
//! halve [p, p′] until F = 1
//! ```
//!
//! It fails where F = 0, for then no sphere has any influence and there is no gradient; where p′ is not
//! inside, for the gradient of a sum points at no centre; and where the point found is outside the unit
//! ball, where it is no rotation. The result is neither the nearest point nor the nearest rotation.

use super::field::{ISO, profile};
use super::fitting::SphereLimit;
use condyle_math::Quat;

/// Why a rotation could not be projected.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Failure {
    /// The field is 0 there: no sphere reaches it.
    NoField,
    /// The point at the distance of the strongest sphere along the gradient is not inside.
    NotInside,
    /// The point found is outside the unit ball.
    NoRotation,
}

impl Failure {
    /// What happened, in a few words.
    pub fn text(self) -> &'static str {
        match self {
            Self::NoField => "the field is zero there",
            Self::NotInside => "the ray along the gradient ends outside",
            Self::NoRotation => "the point found is no rotation",
        }
    }
}

/// The rotation itself if it is possible, otherwise the one that the paper's dichotomy finds.
///
/// # Errors
/// [`Failure`] where the method has no answer.
///
/// ```
/// use condyle_learn::limits::herda2003::*;
/// use condyle_math::{Quat, Vec3};
/// let chart = Chart::new(Quat::IDENTITY, Placement::Centred);
/// let primitives = vec![Primitive { centre: Vec3::ZERO, radius: 0.5 }];
/// let field = SphereField { primitives, stickiness: 5.0 };
/// let removed = Removed::default();
/// let limit = SphereLimit { chart, field, energy: 0.0, history: Vec::new(), removed };
/// // sin(θ/2) = 0.5 at 60 degrees.
/// let answer = project(&limit, Quat::from_axis_angle(Vec3::X, 1.5)).unwrap();
/// let sixty = Quat::from_axis_angle(Vec3::X, 60f64.to_radians());
/// assert!(answer.angle_to(sixty) < 1e-9);
/// // sin(θ/2) > 0.5 + 2/k = 0.9: nothing is known.
/// assert_eq!(project(&limit, Quat::from_axis_angle(Vec3::X, 2.5)), Err(Failure::NoField));
/// ```
pub fn project(limit: &SphereLimit, rotation: Quat) -> Result<Quat, Failure> {
    let field = &limit.field;
    let p = limit.chart.point(rotation);
    let (value, gradient) = field.value_and_gradient(p);
    if value >= ISO {
        return Ok(rotation);
    }
    let strength = |i: usize| {
        let s = &field.primitives[i];
        profile((p - s.centre).norm(), s.radius, field.stickiness).0
    };
    let strongest =
        (0..field.primitives.len()).max_by(|a, b| strength(*a).total_cmp(&strength(*b)));
    let length = gradient.norm();
    let Some(strongest) = strongest.filter(|_| value > 0.0 && length > 0.0) else {
        return Err(Failure::NoField);
    };
    let sphere = field.primitives[strongest];
    let distance = (p - sphere.centre).norm() - sphere.radius;
    let step = gradient * (distance / length);
    if field.value(p + step) < ISO {
        return Err(Failure::NotInside);
    }
    let (mut outside, mut inside) = (0.0, 1.0);
    for _ in 0..60 {
        let middle = 0.5 * (outside + inside);
        if field.value(p + step * middle) < ISO { outside = middle } else { inside = middle }
    }
    limit.chart.rotation(p + step * inside, rotation).ok_or(Failure::NoRotation)
}
