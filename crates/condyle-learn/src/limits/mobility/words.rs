//! A rotation in words of a bone: where it points and how it is turned about itself.

use condyle_math::{Quat, Vec3};
use std::f64::consts::PI;

/// Where a rotation puts a bone, in the reference segment with x forward, y up and z to the right.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Placed {
    /// The angle of the bone from where it is at the identity, in radians.
    pub elevation: f64,
    /// The direction in which it is raised, in radians: 0 to the right, a right angle forward.
    pub plane: f64,
    /// The turn about the bone itself after the shortest swing to its direction, in radians; positive about the axis
    /// against the bone, which is upward at the identity.
    pub twist: f64,
}

/// Plane, elevation and twist of a bone that points along `bone` at the identity; -y for a thigh or an upper arm in the
/// axes of the ISB.
///
/// ```
/// use condyle_learn::limits::mobility::placed;
/// use condyle_math::{Quat, Vec3};
/// // An arm that hangs, raised forward by 60 degrees: a turn about z, which points to the right.
/// let raised = Quat::from_axis_angle(Vec3::Z, 60f64.to_radians());
/// let placed = placed(raised, -Vec3::Y);
/// assert!((placed.elevation.to_degrees() - 60.0).abs() < 1e-9);
/// assert!((placed.plane.to_degrees() - 90.0).abs() < 1e-9);
/// assert!(placed.twist.abs() < 1e-12);
/// assert_eq!(placed.words(), "raised 60° forward, twist 0°");
/// ```
#[must_use]
pub fn placed(q: Quat, bone: Vec3) -> Placed {
    let bone = bone.normalized();
    let now = q.to_mat3() * bone;
    let up = -bone;
    // The plane across the bone at rest: for -y it is spanned by z, to the right, and x, forward.
    let seed = if bone.z.abs() < 0.9 { Vec3::Z } else { Vec3::X };
    let right = (seed - up * seed.dot(up)).normalized();
    let forward = up.cross(right);
    let twist = 2.0 * q.vector().dot(up).atan2(q.w);
    let twist = (twist + PI).rem_euclid(2.0 * PI) - PI;
    Placed {
        elevation: now.dot(bone).clamp(-1.0, 1.0).acos(),
        plane: now.dot(forward).atan2(now.dot(right)),
        twist,
    }
}

impl Placed {
    /// In words, with whole degrees.
    #[must_use]
    pub fn words(&self) -> String {
        let whole = |angle: f64| angle.to_degrees().round() + 0.0;
        let elevation = whole(self.elevation);
        let place = if elevation < 5.0 {
            "near rest".to_owned()
        } else {
            const WAYS: [&str; 8] = [
                "to the right",
                "forward and to the right",
                "forward",
                "forward and to the left",
                "to the left",
                "backward and to the left",
                "backward",
                "backward and to the right",
            ];
            let way = (self.plane / (0.25 * PI)).round().rem_euclid(8.0) as usize;
            format!("raised {elevation}° {}", WAYS[way.min(7)])
        };
        format!("{place}, twist {}°", whole(self.twist))
    }
}
