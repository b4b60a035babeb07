//! From rotations to the three numbers in which the cloud of Herda et al. 2003 lives, and back.
//!
//! ```text
//! q = [qx, qy, qz, qw] = [sin(θ/2) v, cos(θ/2)]      p = (qx, qy, qz)        equation 1, section 3
//! ```
//!
//! Of q and -q the one on the side of the reference rotation m is taken, q·m ≥ 0: the sign-consistent
//! copy of section 3.2. The paper keeps the components of the rotations as they were recorded; there the
//! sign of qw is lost, and rotations of more and of less than 180 degrees share points. The second reading
//! first turns the cloud so that m is the identity, where the three numbers are least distorted:
//!
//! ```text
//! as recorded   p = vec(±q)          q = ±[p, ±√(1 - |p|²)], the sign of qw from a rotation near by
//! centred       p = vec(m⁻¹ q)       q = m·[p, √(1 - |p|²)]
//! ```

use condyle_math::{Quat, Vec3};

/// Where the three coordinates of the cloud are centred.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Placement {
    /// The vector part of the recorded quaternions, as the paper has it.
    AsRecorded,
    /// The vector part of the rotations relative to the reference rotation.
    #[default]
    Centred,
}

/// The map from rotations to points p in the unit ball and back.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Chart {
    reference: Quat,
    placement: Placement,
}

impl Chart {
    /// The chart of a cloud with this reference rotation, of any length except zero.
    ///
    /// ```
    /// use condyle_learn::limits::herda2003::{Chart, Placement};
    /// use condyle_math::{Quat, Vec3};
    /// let chart = Chart::new(Quat::IDENTITY, Placement::AsRecorded);
    /// let point = chart.point(Quat::from_axis_angle(Vec3::Y, 1.0));
    /// assert!((point.y - 0.5f64.sin()).abs() < 1e-15);
    /// ```
    pub fn new(reference: Quat, placement: Placement) -> Self {
        let unit = reference.normalized();
        let usable = unit.dot(unit).is_finite();
        Self { reference: if usable { unit } else { Quat::IDENTITY }, placement }
    }

    /// The reference rotation, of length 1.
    pub fn reference(&self) -> Quat {
        self.reference
    }

    /// Which reading of the paper it is.
    pub fn placement(&self) -> Placement {
        self.placement
    }

    /// The point of a unit quaternion; q and -q have the same.
    #[inline]
    pub fn point(&self, rotation: Quat) -> Vec3 {
        match self.placement {
            Placement::AsRecorded => self.near_side(rotation).vector(),
            Placement::Centred => {
                let relative = self.reference.conjugate() * rotation;
                if relative.w < 0.0 { (-relative).vector() } else { relative.vector() }
            }
        }
    }

    /// The rotation of a point; `None` outside the unit ball, where the point is no rotation.
    ///
    /// `near` decides the sign of qw in the reading as recorded, which the point does not contain.
    pub fn rotation(&self, point: Vec3, near: Quat) -> Option<Quat> {
        let square = 1.0 - point.norm_squared();
        if square < 0.0 || square.is_nan() {
            return None;
        }
        let w = square.sqrt();
        let [x, y, z] = point.to_array();
        Some(match self.placement {
            Placement::AsRecorded => {
                let negative = self.near_side(near).w < 0.0;
                Quat { x, y, z, w: if negative { -w } else { w } }
            }
            Placement::Centred => self.reference * Quat { x, y, z, w },
        })
    }

    /// Of q and -q the one with a product with the reference that is not negative.
    fn near_side(&self, rotation: Quat) -> Quat {
        if rotation.dot(self.reference) < 0.0 { -rotation } else { rotation }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_charts_return_the_rotation_of_a_point() {
        let reference = Quat::exp(Vec3::new(0.4, -1.1, 0.7));
        for placement in [Placement::AsRecorded, Placement::Centred] {
            let chart = Chart::new(reference, placement);
            for i in 0..60 {
                let t = f64::from(i);
                // Within 2.9 rad of the reference.
                let turn = Vec3::new(t.sin(), (2.3 * t).cos(), (1.7 * t).sin()) * 1.6;
                let q = reference * Quat::exp(turn);
                let point = chart.point(q);
                assert_eq!(point.to_array(), chart.point(-q).to_array());
                let back = chart.rotation(point, q).expect("points of rotations are in the ball");
                assert!(back.angle_to(q) < 1e-7, "{placement:?} {i}: {}", back.angle_to(q));
            }
        }
    }

    #[test]
    fn rotations_about_a_half_turn_share_points_as_recorded() {
        // 170 and 190 degrees about one axis: sin 85° = sin 95°.
        let chart = Chart::new(Quat::from_axis_angle(Vec3::X, 2.0), Placement::AsRecorded);
        let [a, b] = [170.0f64, 190.0].map(|deg| Quat::from_axis_angle(Vec3::X, deg.to_radians()));
        assert!((chart.point(a) - chart.point(b)).norm() < 1e-15);
        assert!((a.angle_to(b).to_degrees() - 20.0).abs() < 1e-12);
    }

    #[test]
    fn a_point_outside_the_ball_is_no_rotation() {
        let chart = Chart::new(Quat::IDENTITY, Placement::Centred);
        assert_eq!(chart.rotation(Vec3::new(1.1, 0.0, 0.0), Quat::IDENTITY), None);
    }
}
