//! The angles of a ball joint, or its orientation, limited by a joint cone (Shao & Ng-Thow-Hing
//! 2003, section 4.6).
//!
//! The angles give R = R(a₁, θ₁)·R(a₂, θ₂)·R(a₃, θ₃), and the [`Cone`] limits its swing and twist.
//! In posed mode illegal angles are replaced by those of the legal rotation that the cone's
//! projection gives, so that a [`Pivot`](super::Pivot) after the cone has its centre at the legal
//! angle. Of the two triples of angles of a rotation the one on the side of gimbal lock where the
//! angles are 0 is used. In open mode the angles pass unchanged, and up to three limit rows are computed: the
//! distance of the direction from the boundary, and those of the twist from its lower and its upper
//! bound.
//!
//! If the second axis is perpendicular to both others, every rotation has angles,
//!
//! ```text
//! w = R·a₃,  λ = angle from a₁ to a₃ about a₂
//! cos(θ₂ + λ) = w·a₁,  θ₁ = atan2(±w·a₂, ∓w·(a₁ × a₂)),  θ₃ = the remaining rotation about a₃
//! ```
//!
//! Oblique axes, as those of real joints are, do not reach every rotation. Their angles are found by
//! Gauss-Newton steps from the requested ones; where the legal rotation is out of their reach, they are
//! pulled toward zero until the cone allows them.
//!
//! With two angles the bone has no third rotation: the rest direction is used for a₃.
//!
//! Kinks: in posed mode at the boundary. The derivative of moved angles is taken as 0; solvers use
//! open mode.

use super::{Contract, Fault, Geometry, Kind, Mirrored, Port, PortType, Reflection};
use crate::limit::{Cone, ConePoint, Limit, MOST_LIMITED, MOST_ROWS, Row, padded};
use condyle_diagnostics::Severity;
use condyle_math::{Mat3, Quat, Scalar, Vec3};
use std::f64::consts::{PI, TAU};

/// A ball joint limited by a cone.
#[derive(Clone, Debug, PartialEq)]
pub struct JointCone {
    /// What kind of numbers are limited.
    pub of: Swinging,
    /// The limit.
    pub cone: Cone,
}

/// The numbers that a [`JointCone`] limits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Swinging {
    /// Three angles in radians and their axes, in the order of the product; axes are normalised
    /// when the model is built.
    Angles([Vec3; 3]),
    /// Two angles in radians and their axes: the bone only swings.
    Directions([Vec3; 2]),
    /// A unit quaternion.
    Orientation,
}

impl JointCone {
    /// The three axes, with the rest direction as third for two angles; `None` for an orientation.
    fn axes(&self) -> Option<[Vec3; 3]> {
        match &self.of {
            Swinging::Angles(axes) => Some(*axes),
            Swinging::Directions([a, b]) => Some([*a, *b, self.cone.rest()]),
            Swinging::Orientation => None,
        }
    }

    /// The sine of the larger deviation of the second axis from perpendicular to the others.
    fn obliqueness(&self) -> f64 {
        self.axes().map_or(0.0, |axes| {
            let [a, b, c] = axes.map(Vec3::normalized);
            let (one, other) = (a.dot(b).abs(), c.dot(b).abs());
            if one > other || one.is_nan() { one } else { other }
        })
    }

    /// The rotation of these numbers, and for each angle (or tangent of the orientation) the axis
    /// in the parent about which it rotates.
    fn rotation(&self, numbers: &[f64]) -> (Mat3, [Vec3; 3]) {
        let Some(axes) = self.axes() else {
            let q: [f64; 4] = std::array::from_fn(|i| numbers[i]);
            let turned = Quat::from(q).to_mat3();
            return (turned, [turned.x, turned.y, turned.z]);
        };
        let mut turned = Mat3::IDENTITY;
        let mut moving = [Vec3::ZERO; 3];
        for ((angle, axis), out) in numbers.iter().zip(axes).zip(&mut moving) {
            *out = turned * axis;
            turned = turned * Mat3::rotation_about(axis, Scalar::sin_cos(*angle));
        }
        (turned, moving)
    }

    /// The rotation of these numbers.
    fn turned(&self, numbers: &[f64]) -> Mat3 {
        let Some(axes) = self.axes() else { return self.rotation(numbers).0 };
        let turn = |i: usize| Mat3::rotation_about(axes[i], Scalar::sin_cos(numbers[i]));
        let swing = turn(0) * turn(1);
        if numbers.len() > 2 { swing * turn(2) } else { swing }
    }

    /// The angles that rotate the third axis to `w` (and give `rotation`): of the two sets that do, the one on the
    /// side of gimbal lock where they are 0.
    fn angles(&self, w: Vec3, rotation: Option<Mat3>, asked: &[f64]) -> [f64; 4] {
        let Some([a, b, c]) = self.axes() else { return [0.0, 0.0, 0.0, 1.0] };
        if self.obliqueness() > 1e-6 {
            return self.oblique_angles(w, rotation, asked);
        }
        // a, b and a × b are a right-handed basis, because b is perpendicular to a.
        let beside = a.cross(b);
        let lead = b.dot(a.cross(c)).atan2(a.dot(c));
        let (along, up, side) = (w.dot(a), w.dot(b), w.dot(beside));
        let sine = up.hypot(side);
        let solve = |sign: f64| {
            // If w is along the first axis, that angle is undetermined (gimbal lock): the requested
            // one is kept.
            let first = if sine > 1e-9 { (sign * up).atan2(-sign * side) } else { asked[0] };
            let second = (sign * sine).atan2(along) - lead;
            let mut found = [near(first, asked[0]), near(second, asked[1]), 0.0, 0.0];
            if let Some(rotation) = rotation {
                let swung = Mat3::rotation_about(a, first.sin_cos())
                    * Mat3::rotation_about(b, second.sin_cos());
                // The rotation that remains is about c, which is perpendicular to b: its angle is
                // that from b to the image of b.
                let left = swung.transpose() * rotation * b;
                found[2] = near(c.dot(b.cross(left)).atan2(b.dot(left)), asked[2]);
            }
            let far: f64 = found.iter().zip(asked).map(|(x, y)| (x - y) * (x - y)).sum();
            (far, found)
        };
        // Angles are on the side of gimbal lock where they are 0: beyond it, two angles that give the same direction
        // turn the bone about it by half a turn, and leave any range. Where 0 is itself at gimbal lock, they stay on
        // the side where they were asked.
        let side = if lead.sin().abs() > 1e-6 { lead.sin() } else { (asked[1] + lead).sin() };
        if side.abs() > 1e-6 {
            return solve(side.signum()).1;
        }
        let ((far, found), (other_far, other)) = (solve(1.0), solve(-1.0));
        if other_far < far { other } else { found }
    }
}

/// Two angles whose distances differ by less than this are equally near.
const ALIKE: f64 = 1e-9;

/// The angle plus the whole turns that bring it nearest to what was asked.
///
/// Half a turn away there are two: that nearer to 0 is taken, of ±π the positive one. That is no rare
/// case: where angles asked for beyond gimbal lock give a legal direction with an illegal twist, the
/// legal ones on the other side differ from them by exactly half a turn, and rounding must not decide.
fn near(angle: f64, asked: f64) -> f64 {
    let near = angle - ((angle - asked) / TAU).round() * TAU;
    if (near - asked).abs() < PI - ALIKE {
        return near;
    }
    let other = near - TAU.copysign(near - asked);
    let closer = near.abs() - other.abs();
    if closer > ALIKE || (closer > -ALIKE && other > near) { other } else { near }
}

impl JointCone {
    /// As [`JointCone::angles`], for axes of which the second is not perpendicular to the others.
    fn oblique_angles(&self, w: Vec3, rotation: Option<Mat3>, asked: &[f64]) -> [f64; 4] {
        let count = asked.len().min(3);
        let mut angles = [0.0; 4];
        angles[..count].copy_from_slice(&asked[..count]);
        for _ in 0..50 {
            let (turned, mut moving) = self.rotation(&angles[..count]);
            // The rotation that is left, about an axis in the parent.
            let left = match rotation {
                Some(rotation) => (rotation * turned.transpose()).log(),
                None => {
                    let at = turned * self.cone.rest();
                    let about = at.cross(w);
                    about * (about.norm().atan2(at.dot(w)) / about.norm().max(1e-300))
                }
            };
            if left.norm() < 1e-14 {
                break;
            }
            if rotation.is_none() {
                // Turning about the bone itself does not move its direction.
                let at = turned * self.cone.rest();
                moving = moving.map(|axis| axis - at * at.dot(axis));
            }
            moving[count..].fill(Vec3::ZERO);
            // Damped a little, where the axes are nearly parallel.
            let normal = |k: usize| Vec3::from(moving.map(|axis| axis.dot(moving[k])));
            let damped = Vec3::UNITS.map(|unit| unit * 1e-9);
            let matrix = Mat3::from_columns(
                normal(0) + damped[0],
                normal(1) + damped[1],
                normal(2) + damped[2],
            );
            let step = matrix.inverse() * Vec3::from(moving.map(|axis| axis.dot(left)));
            for (angle, step) in angles[..count].iter_mut().zip(step.to_array()) {
                *angle += step.clamp(-0.5, 0.5);
            }
        }
        let allowed = |angles: &[f64]| {
            self.rows_at(angles).iter().take(self.rows()).all(|(value, _)| *value >= -1e-9)
        };
        if allowed(&angles[..count]) {
            return angles;
        }
        let (mut low, mut high) = (0.0, 1.0);
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if allowed(&angles.map(|angle| angle * middle)[..count]) {
                low = middle;
            } else {
                high = middle;
            }
        }
        angles.map(|angle| angle * low)
    }
}

impl Limit for JointCone {
    fn rows(&self) -> usize {
        let twisting = !matches!(self.of, Swinging::Directions(_));
        if twisting && self.cone.twist_at_rest().is_some() { 3 } else { 1 }
    }

    /// The distance of the direction from the boundary, of the twist from its lower and from its upper
    /// bound.
    fn rows_at(&self, numbers: &[f64]) -> [Row; MOST_ROWS] {
        let (rotation, moving) = self.rotation(numbers);
        self.cone.rows(rotation).map(|(value, along)| {
            let [a, b, c] = moving.map(|axis| along.dot(axis));
            (value, padded([a, b, c]))
        })
    }

    fn legal(&self, asked: &[f64]) -> Option<[f64; MOST_LIMITED]> {
        let rotation = self.turned(asked);
        if let Swinging::Directions(_) = self.of {
            let direction = rotation * self.cone.rest();
            if self.cone.contains(direction) {
                return None;
            }
            let direction = self.cone.project(direction).direction;
            return Some(padded(self.angles(direction, None, asked)));
        }
        let legal = self.cone.legal(rotation);
        if !legal.moved {
            return None;
        }
        Some(padded(match self.axes() {
            Some([.., third]) => self.angles(legal.rotation * third, Some(legal.rotation), asked),
            None => {
                // Of q and -q the one nearer to the requested quaternion.
                let q = Quat::from_mat3(legal.rotation).to_array();
                let same: f64 = q.iter().zip(asked).map(|(a, b)| a * b).sum();
                if same < 0.0 { q.map(|x| -x) } else { q }
            }
        }))
    }

    fn beyond(&self, numbers: &[f64]) -> f64 {
        let rows = self.rows_at(numbers);
        rows[..self.rows()].iter().map(|(value, _)| -value).fold(0.0, f64::max)
    }

    fn margin(&self, numbers: &[f64]) -> f64 {
        let rotation = self.turned(numbers);
        if let Swinging::Directions(_) = self.of {
            let direction = rotation * self.cone.rest();
            return match self.cone.contains(direction) {
                true => f64::INFINITY,
                false => self.cone.project(direction).margin,
            };
        }
        self.cone.legal(rotation).margin
    }
}

impl JointCone {
    pub(crate) const KIND: Kind = Kind {
        name: "cone",
        ports: &[
            Port::perhaps_list("angles", PortType::Scalar),
            Port::perhaps("orientation", PortType::Orientation),
        ],
    };
}

impl Contract for JointCone {
    fn faults(&self) -> Vec<Fault> {
        let twisting = self.cone.twist_at_rest().is_some();
        if !twisting || !matches!(self.of, Swinging::Directions(_)) {
            return vec![];
        }
        vec![Fault {
            severity: Severity::Warning,
            code: "model/cone-twist",
            said: "has bounds of twist but only two angles".to_owned(),
            help: "give it a third angle, or omit the bounds",
        }]
    }

    /// As many angles as axes.
    fn takes(&self) -> Option<usize> {
        match self.of {
            Swinging::Angles(_) => Some(3),
            Swinging::Directions(_) => Some(2),
            Swinging::Orientation => Some(1),
        }
    }

    fn has(&self, port: &Port) -> bool {
        (port.name == "orientation") == matches!(self.of, Swinging::Orientation)
    }

    fn outputs(&self) -> (PortType, usize) {
        match self.of {
            Swinging::Angles(_) => (PortType::Scalar, 3),
            Swinging::Directions(_) => (PortType::Scalar, 2),
            Swinging::Orientation => (PortType::Orientation, 1),
        }
    }

    fn geometry(&mut self) -> Vec<Geometry<'_>> {
        let axes: &mut [Vec3] = match &mut self.of {
            Swinging::Angles(axes) => axes,
            Swinging::Directions(axes) => axes,
            Swinging::Orientation => &mut [],
        };
        axes.iter_mut().map(|axis| Geometry::Turning("axes", axis)).collect()
    }

    fn mirror(&mut self, at: Reflection) -> Result<Mirrored, String> {
        self.geometry().into_iter().for_each(|part| part.mirror(at));
        // D·R(r, τ)·D = R(D·r, -τ).
        let cone = &self.cone;
        let twist = |bounds: Option<[f64; 2]>| bounds.map(|[low, high]| [-high, -low]);
        let point =
            |p: &ConePoint| ConePoint { direction: at.point(p.direction), twist: twist(p.twist) };
        let points = cone.points().iter().map(point).collect();
        let (rest, at_rest) = (at.point(cone.rest()), twist(cone.twist_at_rest()));
        // Rounding can make a cone invalid that barely is one.
        self.cone = Cone::new(rest, at_rest, points, cone.subdivisions(), cone.projection())
            .map_err(|_| "write both sides".to_owned())?;
        Ok(Mirrored::default())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::limit::Projection;

    fn cone(half: f64, twist: Option<[f64; 2]>) -> Cone {
        let points = (0..24).map(|i| {
            let (s, c) = (TAU * f64::from(i) / 24.0).sin_cos();
            let direction = Vec3::new(half.sin() * c, -half.cos(), half.sin() * s);
            ConePoint { direction, twist }
        });
        Cone::new(-Vec3::Y, twist, points.collect(), 0, Projection::Nearest).unwrap()
    }

    #[test]
    fn legal_angles_make_the_legal_rotation_and_stay_near() {
        let axes = [Vec3::Z, Vec3::X, Vec3::Y];
        let of = Swinging::Angles(axes);
        let limit = JointCone { of, cone: cone(0.7, Some([-0.5, 0.4])) };
        for asked in [[1.2, 0.3, 0.1], [-0.4, 1.1, 0.9], [0.2, 0.1, -1.5], [2.0, -1.0, 0.0]] {
            let found = limit.legal(&asked).expect("outside");
            let product = Mat3::rotation_z(found[0])
                * Mat3::rotation_x(found[1])
                * Mat3::rotation_y(found[2]);
            let turned = Mat3::rotation_z(asked[0])
                * Mat3::rotation_x(asked[1])
                * Mat3::rotation_y(asked[2]);
            let expected = limit.cone.legal(turned).rotation;
            for i in 0..9 {
                let off = product.at(i / 3, i % 3) - expected.at(i / 3, i % 3);
                assert!(off.abs() < 1e-12, "{asked:?} {off}");
            }
            for row in limit.rows_at(&found) {
                assert!(row.0 > -1e-9, "{row:?}");
            }
        }
        assert_eq!(limit.legal(&[0.3, 0.2, 0.1]), None);
        // A hinge motion beyond the cone stops at its boundary: 0.7 rad less the sagitta of a
        // 24-gon.
        let [first, second, ..] = limit.legal(&[1.5, 0.0, 0.0]).unwrap();
        assert!((0.69..=0.7).contains(&first) && second.abs() < 1e-9, "{first} {second}");
    }

    #[test]
    fn rounding_does_not_choose_between_angles_half_a_turn_away() {
        let limit = JointCone {
            of: Swinging::Angles([Vec3::Z, -Vec3::X, Vec3::Y]),
            cone: cone(2.9, Some([-0.5, 0.4])),
        };
        // The second angle is beyond gimbal lock and the twist illegal: the first angle has to change by
        // half a turn, to that nearer to 0.
        let asked = [0.5, 2.1, -1.5];
        let expected = limit.legal(&asked).expect("its twist is illegal");
        assert!((expected[0] - (asked[0] - PI)).abs() < 1e-9, "{expected:?}");
        for i in 0..200 {
            let moved = [0.7, 1.3, 2.1].map(|k| (f64::from(i) * k).sin() * 1e-14);
            let asked = std::array::from_fn::<f64, 3, _>(|k| asked[k] + moved[k]);
            let found = limit.legal(&asked).expect("its twist is illegal");
            for (found, expected) in found.iter().zip(expected) {
                assert!((found - expected).abs() < 1e-9, "{asked:?} {found} {expected}");
            }
        }
        // 0 and half a turn: the positive one of ±π.
        assert_eq!((near(-PI, 0.0), near(PI, 0.0), near(0.1, 6.3)), (PI, PI, 0.1 + TAU));
    }

    #[test]
    fn two_angles_swing_without_a_twist() {
        let of = Swinging::Directions([Vec3::Z, Vec3::X]);
        let limit = JointCone { of, cone: cone(0.5, None) };
        assert_eq!(limit.rows(), 1);
        let found = limit.legal(&[0.9, 0.6]).unwrap();
        let bone = Mat3::rotation_z(found[0]) * Mat3::rotation_x(found[1]) * -Vec3::Y;
        let asked = Mat3::rotation_z(0.9) * Mat3::rotation_x(0.6) * -Vec3::Y;
        assert!((bone - limit.cone.project(asked).direction).norm() < 1e-12);
    }

    #[test]
    fn oblique_axes_stay_in_the_cone() {
        // Axes as far from perpendicular as those of a thumb.
        let axes =
            [Vec3::new(0.1, 0.2, 1.0), Vec3::new(1.0, 0.3, 0.2), Vec3::Y].map(Vec3::normalized);
        let limit = JointCone { of: Swinging::Angles(axes), cone: cone(0.7, Some([-0.5, 0.4])) };
        let mut reached = 0;
        for i in 0..200 {
            let at = |k: f64| (f64::from(i) * k).sin() * 1.3;
            let asked = [at(0.7), at(1.3), at(2.1)];
            let Some(found) = limit.legal(&asked) else { continue };
            for row in limit.rows_at(&found[..3]) {
                assert!(row.0 > -1e-8, "{asked:?} {row:?}");
            }
            let wanted = limit.cone.legal(limit.turned(&asked)).rotation;
            let off = Quat::from_mat3(limit.turned(&found[..3])).angle_to(Quat::from_mat3(wanted));
            reached += usize::from(off < 1e-9);
        }
        // Most legal rotations are within reach of the three axes.
        assert!(reached > 100, "only {reached}");
    }

    #[test]
    fn rows_change_as_their_slopes_say() {
        let axes = [Vec3::X, Vec3::Z, Vec3::Y];
        let three = Swinging::Angles(axes);
        let limit = JointCone { of: three, cone: cone(0.9, Some([-0.5, 0.4])) };
        let at = [0.31, -0.42, 0.23];
        let h = 1e-6;
        for k in 0..3 {
            let moved = |step: f64| {
                let mut angles = at;
                angles[k] += step;
                limit.rows_at(&angles).map(|(value, _)| value)
            };
            let (ahead, behind) = (moved(h), moved(-h));
            for row in 0..3 {
                let slope = (ahead[row] - behind[row]) / (2.0 * h);
                let exact = limit.rows_at(&at)[row].1[k];
                assert!((slope - exact).abs() < 1e-7, "{row} {k}: {slope} {exact}");
            }
        }
    }
}
