//! Three angles of an orientation R.
//!
//! ```text
//! euler     R = R(a₁, θ₁)·R(a₂, θ₂)·R(a₃, θ₃)       any of the twelve orders of axes
//! twist     R = swing·R(a, τ), swing = exp(s): τ, s·b, s·c     with b and c the axes after a
//! ```
//!
//! The first are the angles of Grood & Suntay for a knee with the flexion axis first and the long axis
//! last (`zxy` in ISB axes), and plane of elevation, elevation and axial rotation for a humerus (`yxy`).
//! They drive maps, contacts and laws where no coordinate is an angle: a quaternion joint, or the
//! orientation of a segment in another, from [`RelativeOrientation`](super::RelativeOrientation).
//!
//! Ranges: the outer Euler angles and the twist are in (-π, π] and jump there; the middle angle is in
//! [-π/2, π/2], or [0, π] where the third axis is the first.
//! Singular where the middle angle is at an end of its range (the third is then 0), and where the swing
//! is a half turn: [`Angles::margin`] is the distance from there. Slopes: by dual numbers along q·exp(δ).

use super::{
    Contract, Geometry, Kind, MOST_NUMBERS, Mirrored, Numbers, Port, PortType, Reflection,
};
use condyle_math::{EulerOrder, Quat, Scalar, SwingTwist, Vec3};
use std::f64::consts::{FRAC_PI_2, PI};

/// Three angles of an orientation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Angles {
    /// Which angles.
    pub names: AngleNames,
    /// The reflection before which the angles are taken: those of the other side of the body, whose
    /// values are then equal on both sides.
    pub mirrored: Option<Reflection>,
}

/// Which angles of an orientation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AngleNames {
    /// Those of three rotations in this order.
    Euler(EulerOrder),
    /// The twist about an axis (0, 1 or 2 for x, y or z), and the rotation vector of the swing along the
    /// two axes after it.
    SwingTwist(usize),
}

impl Angles {
    pub(crate) const KIND: Kind =
        Kind { name: "angles", ports: &[Port::one("orientation", PortType::Orientation)] };

    /// The three angles of an orientation x, y, z, w of length 1, in radians.
    fn of<S: Scalar>(&self, orientation: [S; 4]) -> [S; 3] {
        let mut q = Quat::from(orientation);
        if let Some(at) = self.mirrored {
            // D·R·D turns about -D·v.
            let [x, y, z] = [0, 1, 2].map(|i| if i == at.axis() { S::one() } else { -S::one() });
            q = Quat { x: q.x * x, y: q.y * y, z: q.z * z, w: q.w };
        }
        match self.names {
            AngleNames::Euler(order) => order.from_mat3(q.to_mat3()),
            AngleNames::SwingTwist(axis) => {
                let axis = axis % 3;
                let split = SwingTwist::of(q, Vec3::UNITS[axis].cast());
                let swing = split.swing.log().to_array();
                let twist = split.twist_angle(Vec3::UNITS[axis].cast());
                [twist, swing[(axis + 1) % 3], swing[(axis + 2) % 3]]
            }
        }
    }

    /// The angle in radians of these angles to the nearest singular ones.
    ///
    /// ```
    /// use condyle_model::component::{AngleNames, Angles};
    /// let knee = Angles { names: AngleNames::Euler("zxy".parse().unwrap()), mirrored: None };
    /// assert!((knee.margin([1.0, 0.2, 0.1]) - (std::f64::consts::FRAC_PI_2 - 0.2)).abs() < 1e-15);
    /// ```
    pub fn margin(&self, angles: [f64; 3]) -> f64 {
        match self.names {
            AngleNames::Euler(order) => {
                let [first, _, last] = order.axes();
                let middle = angles[1].abs();
                if first == last { middle.min(PI - middle) } else { FRAC_PI_2 - middle }
            }
            AngleNames::SwingTwist(_) => PI - angles[1].hypot(angles[2]),
        }
    }
}

impl Numbers for Angles {
    fn values<S: Scalar>(&self, orientation: [S; MOST_NUMBERS]) -> [S; MOST_NUMBERS] {
        let [a, b, c] = self.of(orientation);
        [a, b, c, S::zero()]
    }
}

impl Contract for Angles {
    fn outputs(&self) -> (PortType, usize) {
        (PortType::Scalar, 3)
    }

    fn geometry(&mut self) -> Vec<Geometry<'_>> {
        vec![]
    }

    fn mirror(&mut self, at: Reflection) -> Result<Mirrored, String> {
        self.mirrored = match self.mirrored {
            None => Some(at),
            Some(before) if before == at => None,
            Some(_) => return Err("it is mirrored at another plane: write both sides".into()),
        };
        Ok(Mirrored::default())
    }
}
