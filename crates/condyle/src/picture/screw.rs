//! Instantaneous motions: the axis about which, or the direction along which, a segment moves now.

use condyle_math::{Twist, Vec3};
use condyle_model::{CoordinateId, Jacobian, Model, Program, SegmentId};

/// What a segment does when one number changes, in the world.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Motion {
    /// It turns about an axis, and may glide along it.
    Turn {
        /// The direction of the axis, of length 1.
        axis: Vec3,
        /// A point on the axis.
        centre: Vec3,
        /// Radians for each unit of the number.
        rate: f64,
    },
    /// It glides.
    Glide {
        /// Metres for each unit of the number.
        velocity: Vec3,
    },
}

/// A motion whose axis is farther away than this is a glide, in metres.
const FARTHEST: f64 = 20.0;

impl Motion {
    /// The motion of a twist; the centre is the axis' point nearest to a place. `None` of none.
    ///
    /// With angular velocity ω and the velocity v of the place o, the axis goes through o + ω × v/|ω|².
    pub(super) fn of(twist: Twist, place: Vec3) -> Option<Self> {
        let velocity = twist.velocity_at(place);
        let rate = twist.angular.norm();
        if !velocity.is_finite() || !rate.is_finite() || rate.max(velocity.norm()) < 1e-7 {
            return None;
        }
        let off = twist.angular.cross(velocity) * rate.powi(-2);
        if rate < 1e-7 || off.norm() > FARTHEST {
            return Some(Self::Glide { velocity });
        }
        Some(Self::Turn { axis: twist.angular * rate.recip(), centre: place + off, rate })
    }

    /// How much it does for each unit: radians, or metres.
    pub(super) fn size(&self) -> f64 {
        match self {
            Self::Turn { rate, .. } => *rate,
            Self::Glide { velocity } => velocity.norm(),
        }
    }
}

/// The directions that move a segment in another, each with the twist per unit of it. Stretches are left out.
pub(super) fn twists(
    program: &Program,
    jacobian: &Jacobian,
    segment: SegmentId,
    base: Option<SegmentId>,
) -> Vec<(usize, Twist)> {
    let of_base = base.map_or(&[][..], |base| program.segment_directions(base));
    let own = program.segment_directions(segment).iter();
    own.filter_map(|&(direction, number)| {
        let twist = jacobian.twist(number);
        let of_base = of_base.iter().find(|(d, _)| *d == direction).map(|&(_, number)| number);
        match of_base {
            Some(same) if same == number => None,
            Some(other) => Some((direction as usize, twist + jacobian.twist(other) * -1.0)),
            None => Some((direction as usize, twist)),
        }
    })
    .collect()
}

/// The coordinate of every direction.
pub(super) fn coordinates(model: &Model) -> Vec<CoordinateId> {
    let of = |id| std::iter::repeat_n(id, model.tangent_range(id).len());
    model.coordinate_ids().flat_map(of).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_screw_has_the_axis_that_it_was_made_of() {
        let axis = Vec3::new(2.0, -1.0, 0.5).normalized();
        let centre = Vec3::new(0.3, 0.2, -0.7);
        // A turn by 0.4 that glides by 5 mm along its axis.
        let twist = Twist::rotation(axis, centre) * 0.4 + Twist::translation(axis * 0.005);
        let place = Vec3::new(-0.1, 0.9, 0.4);
        let Some(Motion::Turn { axis: found, centre: at, rate }) = Motion::of(twist, place) else {
            panic!("it turns")
        };
        assert!((found - axis).norm() < 1e-14 && (rate - 0.4).abs() < 1e-15);
        // On the axis, and as near to the place as can be.
        assert!((at - centre).cross(axis).norm() < 1e-14);
        assert!((at - place).dot(axis).abs() < 1e-14);
    }

    #[test]
    fn a_glide_has_no_axis() {
        let velocity = Vec3::new(0.0, 1.0, 0.5);
        let found = Motion::of(Twist::translation(velocity), Vec3::X);
        assert_eq!(found, Some(Motion::Glide { velocity }));
        assert_eq!(Motion::of(Twist::zero(), Vec3::X), None);
    }
}
