//! What a limit of spheres says of a rotation, in the terms of the other methods.
//!
//! F knows no angles. Outside, the distance is minus the angle to the rotation that the dichotomy of section 5.1 finds, and none
//! where that fails. Inside, it is the angle to the first point with F = 1 against the gradient, in steps of a hundredth
//! of the unit ball. Neither is the nearest.

use super::{ISO, SphereLimit, project};
use condyle_math::Quat;

/// What spheres say of a rotation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Judged {
    /// Whether it is possible.
    pub valid: bool,
    /// The angle to the boundary that is found, in radians, positive inside; `None` where none is.
    pub distance: Option<f64>,
    /// The possible rotation that is found; itself if it is possible.
    pub nearest: Option<Quat>,
}

/// What spheres say of a unit quaternion.
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
/// let turn = |degrees: f64| Quat::from_axis_angle(Vec3::X, degrees.to_radians());
/// let inside = judge(&limit, turn(40.0)).distance.unwrap();
/// assert!((inside.to_degrees() - 20.0).abs() < 1e-6);
/// let outside = judge(&limit, turn(75.0));
/// assert!((outside.distance.unwrap().to_degrees() + 15.0).abs() < 1e-6);
/// assert_eq!(judge(&limit, turn(150.0)).distance, None);
/// ```
#[must_use]
pub fn judge(limit: &SphereLimit, rotation: Quat) -> Judged {
    let point = limit.chart.point(rotation);
    let (value, gradient) = limit.field.value_and_gradient(point);
    if value < ISO {
        let nearest = project(limit, rotation).ok();
        let distance = nearest.map(|found| -found.angle_to(rotation));
        return Judged { valid: false, distance, nearest };
    }
    let length = gradient.norm();
    let distance = (length > 0.0).then(|| {
        let step = gradient * (-0.01 / length);
        let at = |t: f64| limit.field.value(point + step * t);
        let out = (1..=200).map(f64::from).find(|t| at(*t) < ISO)?;
        let (mut inside, mut outside) = (out - 1.0, out);
        for _ in 0..50 {
            let middle = 0.5 * (inside + outside);
            if at(middle) < ISO { outside = middle } else { inside = middle }
        }
        let found = limit.chart.rotation(point + step * inside, rotation)?;
        Some(found.angle_to(rotation))
    });
    Judged { valid: true, distance: distance.flatten(), nearest: Some(rotation) }
}
