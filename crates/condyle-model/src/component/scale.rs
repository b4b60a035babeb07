//! Scaling of a segment: T = \[M(s) | 0\] (Rotenberg, *Skeletons*, section 2.2.5).
//!
//! ```text
//! all directions     M = s·I
//! along an axis a    M = I + (s - 1)·a·aᵀ
//! volume preserved   M = s·a·aᵀ + s^(-1/2)·(I - a·aᵀ)        det M = 1
//! ```
//!
//! A product of three scales along x, y and z is any per-axis scale. Factor 1 is the identity.
//! Factors are clamped to [10⁻⁶, 10⁶], so that every transform has an inverse and no segment is
//! mirrored; these are the only kinks. Generator: M′·M⁻¹, which is not rigid. Normals are
//! transformed by the inverse transpose M⁻ᵀ, which is M at 1/s.

use super::{Contract, Geometry, Kind, Port, PortType};
use condyle_math::{Mat3, Scalar, Vec3};

/// The smallest factor; smaller ones are clamped.
const LEAST: f64 = 1e-6;
/// The largest factor; larger ones are clamped.
const MOST: f64 = 1e6;

/// A scale by one factor, for example the stretch of a cartoon character or the growth of a child.
#[derive(Clone, Debug, PartialEq)]
pub struct Scale {
    /// The directions that are scaled.
    pub along: Along,
}

impl Scale {
    pub(crate) const KIND: Kind =
        Kind { name: "scale", ports: &[Port::one("factor", PortType::Scalar)] };
}

impl Contract for Scale {
    fn deforms(&self) -> bool {
        true
    }

    fn geometry(&mut self) -> Vec<Geometry<'_>> {
        let axis = self.along.axis_mut().into_iter();
        axis.map(|axis| Geometry::Direction("axis", axis)).collect()
    }
}

/// The directions that a [`Scale`] scales.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Along {
    /// All directions, uniformly.
    Everywhere,
    /// One axis; perpendicular directions are not scaled. The axis is normalised when the model is
    /// built.
    Axis(Vec3),
    /// One axis, with perpendicular directions scaled by 1/√s to preserve the volume.
    Volume(Vec3),
}

impl Along {
    /// The matrix M(s) for a factor.
    #[inline]
    pub fn matrix<S: Scalar>(self, factor: S) -> Mat3<S> {
        let (least, most) = (S::from_f64(LEAST), S::from_f64(MOST));
        let s = factor.select_less(least, least, factor);
        let s = s.select_less(most, s, most);
        match self {
            Self::Everywhere => uniaxial(Vec3::X, s, s),
            Self::Axis(axis) => uniaxial(axis, s, S::one()),
            Self::Volume(axis) => uniaxial(axis, s, S::one() / s.sqrt()),
        }
    }

    /// The inverse of [`Along::matrix`]; being symmetric, also its inverse transpose.
    pub fn inverse(self, factor: f64) -> Mat3 {
        self.matrix(1.0 / factor.clamp(LEAST, MOST))
    }

    /// M′·M⁻¹ per unit of the factor.
    pub fn rate(self, factor: f64) -> Mat3 {
        // A clamped factor does not vary.
        if !(LEAST..=MOST).contains(&factor) {
            return Mat3::from_columns(Vec3::ZERO, Vec3::ZERO, Vec3::ZERO);
        }
        let rate = 1.0 / factor;
        match self {
            Self::Everywhere => uniaxial(Vec3::X, rate, rate),
            Self::Axis(axis) => uniaxial(axis, rate, 0.0),
            // d/ds s^(-1/2) over s^(-1/2) is -1/(2s).
            Self::Volume(axis) => uniaxial(axis, rate, -0.5 * rate),
        }
    }

    /// The axis; `None` for a uniform scale.
    pub fn axis(self) -> Option<Vec3> {
        match self {
            Self::Everywhere => None,
            Self::Axis(axis) | Self::Volume(axis) => Some(axis),
        }
    }

    fn axis_mut(&mut self) -> Option<&mut Vec3> {
        match self {
            Self::Everywhere => None,
            Self::Axis(axis) | Self::Volume(axis) => Some(axis),
        }
    }
}

/// `across`·I + (`along` - `across`)·a·aᵀ.
#[inline]
fn uniaxial<S: Scalar>(axis: Vec3, along: S, across: S) -> Mat3<S> {
    let a: Vec3<S> = axis.cast();
    let k = along - across;
    let column = |unit: Vec3, part: S| unit.cast::<S>() * across + a * (part * k);
    Mat3::from_columns(column(Vec3::X, a.x), column(Vec3::Y, a.y), column(Vec3::Z, a.z))
}

#[cfg(test)]
mod tests {
    use super::*;
    use condyle_math::Dual;

    #[test]
    fn principal_axes_give_the_diagonals_of_the_source() {
        let s = 1.7;
        let diagonal = |m: Mat3| [m.x.x, m.y.y, m.z.z];
        assert_eq!(diagonal(Along::Everywhere.matrix(s)), [s, s, s]);
        assert_eq!(diagonal(Along::Axis(Vec3::Y).matrix(s)), [1.0, s, 1.0]);
        let thin = 1.0 / s.sqrt();
        assert_eq!(diagonal(Along::Volume(Vec3::Z).matrix(s)), [thin, thin, s]);
    }

    #[test]
    fn any_axis_is_a_principal_one_in_a_turned_frame() {
        // M(a) = R·M(x)·Rᵀ for the rotation R that maps x to a.
        let axis = Vec3::new(0.6, -0.48, 0.64);
        let turn = Mat3::from_columns(axis, Vec3::new(0.8, 0.36, -0.48), Vec3::new(0.0, 0.8, 0.6));
        for (oblique, plain) in [
            (Along::Axis(axis), Along::Axis(Vec3::X)),
            (Along::Volume(axis), Along::Volume(Vec3::X)),
        ] {
            let expected = turn * plain.matrix(0.4) * turn.transpose();
            let found = oblique.matrix(0.4);
            for i in 0..9 {
                assert!((found.at(i / 3, i % 3) - expected.at(i / 3, i % 3)).abs() < 1e-15);
            }
        }
        assert!((Along::Volume(axis).matrix::<f64>(0.4).determinant() - 1.0).abs() < 1e-15);
    }

    #[test]
    fn rate_and_inverse_belong_to_the_matrix() {
        let axis = Vec3::new(0.6, -0.48, 0.64);
        for along in [Along::Everywhere, Along::Axis(axis), Along::Volume(axis)] {
            let dual = along.matrix(Dual::<1>::variable(0.7, 0));
            let derivative = Mat3::from_columns(
                Vec3::new(dual.x.x.partials[0], dual.x.y.partials[0], dual.x.z.partials[0]),
                Vec3::new(dual.y.x.partials[0], dual.y.y.partials[0], dual.y.z.partials[0]),
                Vec3::new(dual.z.x.partials[0], dual.z.y.partials[0], dual.z.z.partials[0]),
            );
            let expected = derivative * along.matrix(0.7f64).inverse();
            let found = along.rate(0.7);
            let unit = along.matrix(0.7) * along.inverse(0.7);
            for i in 0..9 {
                let (row, column) = (i / 3, i % 3);
                assert!((found.at(row, column) - expected.at(row, column)).abs() < 1e-14);
                assert!((unit.at(row, column) - f64::from(u8::from(row == column))).abs() < 1e-15);
            }
        }
    }

    #[test]
    fn a_segment_neither_vanishes_nor_turns_inside_out() {
        for factor in [0.0, -2.0, 1e-300, f64::NEG_INFINITY] {
            let m = Along::Volume(Vec3::X).matrix(factor);
            assert!((m.x.x - 1e-6).abs() < 1e-12 && (m.y.y - 1e3).abs() < 1e-9);
        }
    }
}
